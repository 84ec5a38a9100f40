"""Repair passes on single lines: zero length, join, duplicates, simplify.

Each takes lines and gives lines, how many things changed, how far at most anything moved, words, and a place.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import shapely

from wallkit.geometry.arrays import FloatArray
from wallkit.walls.copies import copies
from wallkit.walls.repairing.loose_walls import LooseWall, edges_of

Repaired = tuple[list[LooseWall], int, float, str, "FloatArray | None"]
_ROUNDS = 30


def drop_zero_length(lines: list[LooseWall]) -> Repaired:
    """Drop edges without length; lines that are a point alone go."""
    kept: list[LooseWall] = []
    count, at = 0, None
    for line in lines:
        following = np.roll(line.vertices, -1, axis=0)
        empty = (line.vertices == following).all(axis=1)
        if not line.closed:
            empty[-1] = False
        if empty.any():
            count += int(empty.sum())
            at = line.vertices[int(empty.argmax())] if at is None else at
            line = replace(line, vertices=line.vertices[~empty], bulges=line.bulges[~empty])
        if len(line.vertices) > 1:
            kept.append(line)
    return kept, count, 0.0, f"{count} edges without length dropped", at


def join_ends(lines: list[LooseWall]) -> Repaired:
    """Join open lines where exactly two ends meet; a line whose ends meet becomes closed."""
    pool: dict[int, LooseWall] = dict(enumerate(lines))
    count, at = 0, None
    waiting = True
    while waiting:
        waiting = False
        meeting: dict[bytes, list[tuple[int, int]]] = {}
        for index, line in pool.items():
            if not line.closed:
                for end in (0, -1):
                    meeting.setdefault((line.vertices[end] + 0.0).tobytes(), []).append((index, end))
        used: set[int] = set()
        for ends in meeting.values():
            if len(ends) != 2 or {index for index, _ in ends} & used:
                continue
            (one, one_end), (two, two_end) = ends
            if (pool[one].material, pool[one].sides) != (pool[two].material, pool[two].sides):
                continue
            joined = _close(pool[one]) if one == two else _append(pool[one], one_end, pool[two], two_end)
            if joined is None:
                continue
            at = pool[one].vertices[one_end] if at is None else at
            used |= {one, two}
            pool[min(one, two)] = joined
            if one != two:
                del pool[max(one, two)]
            count, waiting = count + 1, True
    return list(pool.values()), count, 0.0, f"{count} times ends that meet were joined", at


def _close(line: LooseWall) -> LooseWall | None:
    if len(line.vertices) < 3 + (not line.bulges.any()):
        return None  # there and back: nothing to enclose
    return replace(line, vertices=line.vertices[:-1], bulges=line.bulges[:-1], closed=True)


def _append(one: LooseWall, one_end: int, two: LooseWall, two_end: int) -> LooseWall:
    """Put ``two`` behind ``one``, each turned so that the meeting ends meet."""
    one = _reverse(one) if one_end == 0 else one
    two = _reverse(two) if two_end == -1 else two
    return replace(
        one,
        vertices=np.concatenate([one.vertices, two.vertices[1:]]),
        bulges=np.concatenate([one.bulges[:-1], two.bulges]),
        name=one.name or two.name,
        layer=one.layer or two.layer,
    )


def _reverse(line: LooseWall) -> LooseWall:
    """An open line the other way round: the edges' bulges change sign and place."""
    bulges = np.concatenate([0.0 - line.bulges[:-1][::-1], [0.0]])
    return replace(line, vertices=line.vertices[::-1].copy(), bulges=bulges)


def drop_duplicates(lines: list[LooseWall]) -> Repaired:
    """Drop closed lines drawn before, and edges of open lines that are drawn already."""
    rings = [line for line in lines if line.closed]
    edges = edges_of(rings)
    # arcs over the same chords are the same ring only with the same bulges: compared by their middles as well
    whole = edges_of([_with_middles(line) for line in rings])
    first = copies(whole, np.ones(len(rings), dtype=np.bool_)) if len(edges) else np.empty(0, dtype=np.int64)
    double = {id(ring) for index, ring in enumerate(rings) if first[index] != index}
    known: set[tuple[bytes, bytes, float]] = set()
    for line in rings:
        if id(line) not in double:
            known |= set(_edge_keys(line))
    kept: list[LooseWall] = []
    count, at = len(double), next((ring.vertices[0] for ring in rings if id(ring) in double), None)
    for line in lines:
        if line.closed:
            kept += [line] if id(line) not in double else []
            continue
        keys = _edge_keys(line)
        new = []
        for key in keys:
            new.append(key not in known)
            known.add(key)
        count += len(new) - sum(new)
        if at is None and not all(new):
            at = line.vertices[new.index(False)]
        kept += [line] if all(new) else _runs(line, new)
    return kept, count, 0.0, f"{count} walls or edges drawn twice dropped", at


def _with_middles(line: LooseWall) -> LooseWall:
    """The line with the middle of each arc as a vertex more: chord bows to the right by bulge / 2 of its length."""
    chord = np.roll(line.vertices, -1, axis=0) - line.vertices
    right = np.stack([chord[:, 1], -chord[:, 0]], axis=1)
    middle = line.vertices + chord / 2 + right * line.bulges[:, None] / 2
    if not line.bulges.any():
        return line
    both = np.stack([line.vertices, middle], axis=1).reshape(-1, 2)
    return replace(line, vertices=both, bulges=np.zeros(len(both)))


def _edge_keys(line: LooseWall) -> list[tuple[bytes, bytes, float]]:
    """The edges of a line, the same whichever way they run."""
    ends = line.vertices + 0.0
    following = np.roll(ends, -1, axis=0)
    count = len(ends) - (not line.closed)
    keys = []
    for index in range(count):
        a, b, bulge = ends[index].tobytes(), following[index].tobytes(), float(line.bulges[index])
        keys.append((a, b, bulge + 0.0) if a <= b else (b, a, 0.0 - bulge))
    return keys


def _runs(line: LooseWall, keep: list[bool]) -> list[LooseWall]:
    """The parts of an open line whose edges are kept."""
    parts = []
    begin = None
    for index, wanted in enumerate([*keep, False]):
        if wanted and begin is None:
            begin = index
        if not wanted and begin is not None:
            bulges = line.bulges[begin : index + 1].copy()
            bulges[-1] = 0.0
            parts.append(replace(line, vertices=line.vertices[begin : index + 1], bulges=bulges))
            begin = None
    return parts


def simplify(lines: list[LooseWall], tolerance: float) -> Repaired:
    """Drop vertices by Douglas and Peucker, rings between two fixed corners; lines with arcs stay as they are.

    Lines that would cross something then are left as they were.
    """
    from wallkit.walls.crossings import find_touches

    made = [_simplified(line, tolerance) for line in lines]
    for _ in range(_ROUNDS):
        crossing = find_touches(edges_of(made)).crossing_walls
        new = set(np.unique(crossing).tolist()) - set(np.unique(find_touches(edges_of(lines)).crossing_walls).tolist())
        again = [index for index in new if made[index] is not lines[index]]
        if not again:
            break
        for index in again:
            made[index] = lines[index]
    count = sum(len(line.vertices) - len(new.vertices) for line, new in zip(lines, made, strict=True))
    moved = max((_off(line, new) for line, new in zip(lines, made, strict=True) if new is not line), default=0.0)
    at = next((line.vertices[0] for line, new in zip(lines, made, strict=True) if new is not line), None)
    return made, count, moved, f"{count} vertices dropped", at


def _simplified(line: LooseWall, tolerance: float) -> LooseWall:
    if line.bulges.any() or len(line.vertices) < 3 + line.closed:
        return line
    if not line.closed:
        points = shapely.get_coordinates(
            shapely.simplify(shapely.linestrings(line.vertices), tolerance, preserve_topology=False)
        )
    else:
        # fixed corners that stay: the smallest vertex and the farthest from it, so that a second run finds the same
        start = int(np.lexsort((line.vertices[:, 1], line.vertices[:, 0]))[0])
        ring = np.roll(line.vertices, -start, axis=0)
        far = int(np.hypot(*(ring - ring[0]).T).argmax())
        halves = [ring[: far + 1], np.concatenate([ring[far:], ring[:1]])]
        cut = [
            shapely.get_coordinates(shapely.simplify(shapely.linestrings(h), tolerance, preserve_topology=False))
            for h in halves
        ]
        points = np.concatenate([cut[0][:-1], cut[1][:-1]])
    if len(points) == len(line.vertices) or len(points) < 2 + line.closed:
        return line
    return replace(line, vertices=points, bulges=np.zeros(len(points)))


def _off(line: LooseWall, new: LooseWall) -> float:
    """Largest distance of the old vertices from the new line."""
    points = new.vertices if not new.closed else np.concatenate([new.vertices, new.vertices[:1]])
    return float(shapely.distance(shapely.points(line.vertices), shapely.linestrings(points)).max())
