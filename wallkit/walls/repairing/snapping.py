"""Snapping: the repair pass that mends loose ends, as ``loose_ends`` says how."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from wallkit.geometry.arrays import FloatArray
from wallkit.walls.checking.loose_ends import LooseEnd, landed, loose_ends
from wallkit.walls.repairing.ends import Repaired
from wallkit.walls.repairing.loose_walls import LooseWall, from_lines
from wallkit.walls.walls import Walls

_ROUNDS = 30


def snap_ends(lines: list[LooseWall], reach: float) -> Repaired:
    """Mend every loose end that needs at most ``reach``; no wall is bent, and none is led across another.

    Repeated until nothing is left within reach, so that a second run finds nothing.
    """
    moved, count, at = 0.0, 0, None
    for _ in range(_ROUNDS):
        walls = from_lines(Walls.from_polylines([]), lines)
        found = landed(walls, [loose for loose in loose_ends(walls, reach) if loose.need <= reach])
        if not found:
            break
        lines = list(lines)
        for loose in found:
            for vertex in loose.ends:
                place = walls.vertices[vertex]
                if loose.kind not in ("bridge", "foot"):
                    moved = max(moved, float(abs(complex(*place) - loose.at)))
                at = place if at is None else at
            count += len(loose.ends)
        for wall, end, loose in _changes(walls, found):
            lines[wall] = _mended(lines[wall], end, loose)
    return lines, count, moved, f"{count} open ends snapped", at


def _changes(walls: Walls, found: list[LooseEnd]) -> list[tuple[int, int, LooseEnd]]:
    """Wall, end (0 or -1) and mending of each line that changes; a bridge changes its first end's line alone."""
    changes = []
    for loose in found:
        for vertex in loose.ends[:1] if loose.kind == "bridge" else loose.ends:
            wall = int(np.searchsorted(walls.offsets, vertex, side="right")) - 1
            changes.append((wall, 0 if vertex == walls.offsets[wall] else -1, loose))
    return changes


def _mended(line: LooseWall, end: int, loose: LooseEnd) -> LooseWall:
    """The line with one of its ends mended; the end is made the last for the while."""
    if end == 0:
        return _reversed(_mended(_reversed(line), -1, loose))
    at = np.array([[loose.at.real, loose.at.imag]])
    if loose.kind in ("bridge", "foot"):
        vertices = line.vertices.copy()
        if loose.back is not None:
            vertices[-1] = loose.back.real, loose.back.imag
        return replace(line, vertices=np.concatenate([vertices, at]), bulges=np.append(line.bulges, 0.0))
    kept = len(line.vertices) - loose.sections
    vertices, bulges = line.vertices[:kept].copy(), line.bulges[:kept].copy()
    bulges[-1] = 0.0
    if bulges[-2]:
        bulges[-2] = _shortened(vertices[-2], vertices[-1], bulges[-2], at[0])
    vertices[-1] = at[0]
    return replace(line, vertices=vertices, bulges=bulges)


def _shortened(a: FloatArray, b: FloatArray, bulge: float, at: FloatArray) -> float:
    """The bulge of an arc from a to b that ends at a point of it: tan of a quarter of the angle up to there.

    The angle between two chords from the arc's start is half of the angle that the arc turns by between their ends.
    """
    whole, part = complex(*b) - complex(*a), complex(*at) - complex(*a)
    between = float(np.angle(part / whole))
    return float(np.tan(np.arctan(bulge) + between / 2))


def _reversed(line: LooseWall) -> LooseWall:
    """An open line the other way round: the edges' bulges change sign and place."""
    bulges = np.concatenate([0.0 - line.bulges[:-1][::-1], [0.0]])
    return replace(line, vertices=line.vertices[::-1].copy(), bulges=bulges)
