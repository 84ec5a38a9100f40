"""The self-check: everything that is doubtful about walls, each with its place and what to do."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from importers.errors import LimitError
from importers.problems import Problem, Severity
from wallkit.geometry.arrays import FloatArray, IntArray
from wallkit.walls.as_shapely import check_tolerance, straightened
from wallkit.walls.checking.loose_ends import LooseEnd, loose_ends, settled_places
from wallkit.walls.checking.open_ends import Surroundings
from wallkit.walls.copies import copies
from wallkit.walls.crossings import Touches, find_touches
from wallkit.walls.edge_tree import Edges
from wallkit.walls.walls import Walls

MOST_PLACES = 1000  # of one code; further ones are counted
_SHORTER = 8  # times a reach for gaps is tried, each a quarter of the one before
_NEAR = 0.02  # ends farther apart than this part of the drawing's diagonal are no gap but two ends


@dataclass(slots=True, eq=False)
class Findings:
    """Problems in the making, at most MOST_PLACES of a code, the rest counted."""

    walls: Walls
    lines: Sequence[int | None]
    problems: list[Problem] = field(default_factory=list)
    listed: Counter[str] = field(default_factory=Counter)
    hidden: Counter[str] = field(default_factory=Counter)

    def add(self, wall: int, code: str, severity: Severity, message: str, fix: str, at: FloatArray) -> None:
        """Note one finding about a wall at a place, if it is listed."""
        if self.is_listed(code):
            self.put(wall, code, severity, message, fix, at)

    def put(self, wall: int, code: str, severity: Severity, message: str, fix: str, at: FloatArray) -> None:
        """Put one into the list."""
        name, layer = self.walls.names[wall], self.walls.layers[wall]
        line = self.lines[wall] if self.lines else None
        x, y = float(at[0]), float(at[1])
        self.problems.append(Problem(code, severity, message, fix, layer, name, line, None, x, y))

    def is_listed(self, code: str) -> bool:
        """Count one more of a code, and tell whether it is listed; many walls have more than anybody reads."""
        self.listed[code] += 1
        self.hidden[code] += self.listed[code] > MOST_PLACES
        return self.listed[code] <= MOST_PLACES

    def first(self, rows: IntArray, code: str) -> list[int]:
        """The rows that are listed under a code; the others are only counted."""
        self.hidden[code] += max(len(rows) - MOST_PLACES, 0)
        listed: list[int] = rows[:MOST_PLACES].tolist()
        return listed

    def closed(self) -> list[Problem]:
        """Give all, with a count of those that are not told one by one."""
        more = [
            Problem(code, "warning", f"{count} more of these are not listed one by one", "solve the first ones")
            for code, count in self.hidden.items()
            if count
        ]
        return self.problems + more

    def called(self, wall: int) -> str:
        """Call a wall by number and name."""
        name = self.walls.names[wall]
        return f"wall {wall} ({name!r})" if name else f"wall {wall}"


def validate(
    walls: Walls,
    *,
    lines: Sequence[int | None] = (),
    edges: Edges | None = None,
    touches: Touches | None = None,
) -> list[Problem]:
    """Find every violation: crossings, doubled edges and walls, slivers, gaps between open ends.

    Args:
        walls: any walls; arcs are looked at as lines within a tenth of the tolerance.
        lines: line in the file of each wall, for the report.
        edges: the straight edges of the walls, if they are at hand.
        touches: those of these edges, if they are at hand.

    Returns:
        Problems in the order crossings, duplicates, slivers, gaps; empty means valid. A crossing that an open end
        only sticks out of is told as that end, not as a crossing too.
    """
    edges = straight_edges(walls) if edges is None else edges
    touches = find_touches(edges) if touches is None else touches
    findings = Findings(walls, lines)
    loose = _loose_ends(findings, _NEAR * diagonal(edges.vertices)) if touches.complete else []
    _crossings(findings, touches, _at_ends(walls, touches, loose))
    _duplicates(findings, edges, touches)
    _slivers(findings, edges)
    _gaps(findings, edges, loose)
    return findings.closed()


def straight_edges(walls: Walls) -> Edges:
    """The walls' edges, arcs as lines within :func:`check_tolerance`."""
    vertices, offsets = straightened(walls, check_tolerance(walls, walls.tolerance))
    return Edges(vertices, offsets, walls.closed)


def diagonal(vertices: FloatArray) -> float:
    """The diagonal of the points' box; 0 without any."""
    return float(np.hypot(*(column.max() - column.min() for column in vertices.T))) if len(vertices) else 0.0


def _loose_ends(findings: Findings, reach: float) -> list[LooseEnd]:
    """Find loose ends, within a shorter reach where very many ends are close together, which is told."""
    walls, within = findings.walls, reach
    if not len(walls.edge_starts) or walls.closed.all():
        return []
    scene = Surroundings.of(walls)
    for _ in range(_SHORTER):
        try:
            found = loose_ends(walls, within, scene)
        except LimitError:
            within /= 4
            continue
        if within < reach:
            message = f"very many ends are close together: gaps are looked for up to {within:.3g} only"
            findings.problems.append(Problem("tangled", "warning", message, "take fewer layers"))
        return found
    message = "too many ends lie on one another: gaps are not looked for"
    findings.problems.append(Problem("tangled", "warning", message, "take fewer layers"))
    return []


def _at_ends(walls: Walls, touches: Touches, loose: Sequence[LooseEnd]) -> NDArray[np.bool_]:
    """Which crossings are where an end sticks out, or where an end lies on an arc that lines stand for here."""
    places = np.array([end.at for end in loose if end.kind == "trim"], dtype=np.complex128)
    if walls.has_arcs and not walls.closed.all():
        places = np.concatenate([places, settled_places(walls)])
    result = np.zeros(len(touches.crossing_at), dtype=np.bool_)
    if len(places) and len(result):
        size = float(np.abs(walls.vertices).max())
        import shapely

        within = 1e-9 * size + (walls.tolerance / 5 if walls.has_arcs else 0.0)
        across = np.sort(places.real)
        x = touches.crossing_at[:, 0]
        beside = np.flatnonzero(np.searchsorted(across, x - within) < np.searchsorted(across, x + within, "right"))
        tree = shapely.STRtree(shapely.points(places.real, places.imag))
        found, _ = tree.query(shapely.points(touches.crossing_at[beside]), predicate="dwithin", distance=within)
        result[beside[found]] = True
    return result


def _crossings(findings: Findings, touches: Touches, known: NDArray[np.bool_]) -> None:
    """Crossings but those that are ``known`` otherwise."""
    own = touches.crossing_walls[:, 0] == touches.crossing_walls[:, 1]
    for row in findings.first(np.flatnonzero(own), "self-crossing"):
        wall, at = int(touches.crossing_walls[row, 0]), touches.crossing_at[row]
        fix = "redraw the path, or resolve its crossings (--resolve)"
        findings.add(wall, "self-crossing", "warning", f"{findings.called(wall)} crosses itself", fix, at)
    for row in findings.first(np.flatnonzero(~own & ~known), "crossing"):
        one, two = touches.crossing_walls[row].tolist()
        message = f"{findings.called(one)} and {findings.called(two)} cross"
        solids = findings.walls.closed[one] and findings.walls.closed[two]
        fix = "draw them apart, or unite the solids (--union)" if solids else "draw them apart, or end one at the other"
        findings.add(one, "crossing", "warning", message, fix, touches.crossing_at[row])
    if not touches.complete:
        message = "more edges meet or lie close together than are looked at: not all crossings and gaps are known"
        findings.problems.append(Problem("tangled", "warning", message, "take fewer layers, or a larger tolerance"))


def _duplicates(findings: Findings, edges: Edges, touches: Touches) -> None:
    """Walls drawn twice, walls that run over themselves, walls that share edges."""
    first = copies(edges, edges.closed & (np.diff(edges.offsets) >= 3))
    for wall in np.flatnonzero(first != np.arange(len(first))).tolist():
        message = f"{findings.called(wall)} is the same as {findings.called(int(first[wall]))}"
        fix = "delete one of them, or drop duplicates (--drop-duplicates)"
        findings.add(wall, "duplicate-wall", "warning", message, fix, edges.vertices[edges.offsets[wall]])
    pairs = np.sort(edges.wall[touches.overlap_edges], axis=1)
    pairs = pairs.reshape(-1, 2)
    same = first[pairs[:, 0]] == first[pairs[:, 1]] if len(first) else np.empty(0, dtype=np.bool_)
    doubled = ~same | (pairs[:, 0] == pairs[:, 1])
    _shared(findings, pairs[doubled], touches.overlap_at[doubled], touches.overlap_length[doubled])


def _shared(findings: Findings, pairs: IntArray, at: FloatArray, length: FloatArray) -> None:
    if not len(pairs):
        return
    unique, row, which = np.unique(pairs, axis=0, return_index=True, return_inverse=True)
    total = np.bincount(which.reshape(-1), length)
    for (one, two), index, whole in zip(unique.tolist(), row.tolist(), total.tolist(), strict=True):
        if one == two:
            message = f"{findings.called(one)} runs over itself along {whole:.6g}"
            fix = "redraw it, or resolve its crossings (--resolve)"
            findings.add(one, "doubled-edge", "warning", message, fix, at[index])
        elif findings.walls.closed[one] and findings.walls.closed[two]:
            message = f"{findings.called(one)} and {findings.called(two)} share an edge along {whole:.6g}"
            fix = "nothing to do if they are meant to touch; --union makes one solid of them"
            findings.add(one, "shared-edge", "info", message, fix, at[index])
        else:
            message = f"{findings.called(one)} and {findings.called(two)} lie on each other along {whole:.6g}"
            fix = "delete one of them, or drop duplicates (--drop-duplicates)"
            findings.add(one, "doubled-edge", "warning", message, fix, at[index])


def _slivers(findings: Findings, edges: Edges) -> None:
    """Closed walls that no disc as wide as the tolerance fits into.

    The largest disc in a ring has at least the radius area / perimeter, so only rings below that are looked at. Of a
    ring that crosses itself the signed area is no area, but not more than that.
    """
    if not len(edges.closed) or not len(edges):
        return
    area = np.abs(edges.areas)
    lengths = [
        np.bincount(some.wall, np.hypot(*(some.b - some.a).T), len(some.closed)) for _, _, some in edges.portions()
    ]
    perimeter = np.concatenate(lengths)
    width = 2 * area / np.where(perimeter > 0, perimeter, 1.0)
    limit = findings.walls.tolerance or 1e-6 * diagonal(edges.vertices)
    narrow = np.flatnonzero(edges.closed & (width < limit)).tolist()
    if not narrow:
        return
    from wallkit.walls.checking.widths import is_thin

    for wall in narrow:
        if not is_thin(edges.vertices[edges.offsets[wall] : edges.offsets[wall + 1]], limit):
            continue
        message = f"{findings.called(wall)} is a sliver about {width[wall]:.3g} wide"
        fix = f"delete it, or remove slivers (--min-width {at_least(limit)})"
        findings.add(wall, "sliver", "warning", message, fix, edges.vertices[edges.offsets[wall]])


def _gaps(findings: Findings, edges: Edges, loose: Sequence[LooseEnd]) -> None:
    """Open ends that meet, nearly meet another end or a wall, or stick out of one."""
    walls = np.flatnonzero(~edges.closed)
    if not len(walls):
        return
    ends = np.concatenate([edges.offsets[walls], edges.offsets[walls + 1] - 1])
    spots, spot = np.unique(edges.vertices[ends], axis=0, return_inverse=True)
    ends_at = np.bincount(spot.reshape(-1))
    some_end = np.zeros(len(spots), dtype=np.int64)
    some_end[spot.reshape(-1)] = ends
    for index in findings.first(np.flatnonzero(ends_at > 1), "ends-meet"):
        message = f"{ends_at[index]} ends of open walls meet"
        wall = int(edges.wall_of[some_end[index]])
        findings.add(wall, "ends-meet", "info", message, "join them to one wall (--join)", spots[index])
    offsets = findings.walls.offsets
    for end in loose:
        sticks_out = end.kind == "trim"
        code = "overshoot" if sticks_out else "gap"
        if findings.is_listed(code):
            wall = int(np.searchsorted(offsets, end.ends[0], side="right")) - 1
            message, fix = _told(end)
            findings.put(wall, code, "warning", message, fix, findings.walls.vertices[end.ends[0]])


def _told(end: LooseEnd) -> tuple[str, str]:
    """Message and fix of a loose end."""
    snap = f"--snap {at_least(end.need)}" if np.isfinite(end.need) else ""
    if end.kind == "trim":
        fix = f"trim it at the wall, in the drawing or with {snap}"
        return f"an open end sticks out {end.distance:.6g} beyond another wall", fix
    if end.kind in ("corner", "middle", "bridge"):
        fix = f"close it in the drawing, or with {snap}" if snap else "close it in the drawing: a wall is in the way"
        return f"a gap of {end.distance:.6g} to the nearest open end", fix
    fix = f"draw it on, or snap it with {snap}" if snap else "draw it on; a third wall is in the way"
    return f"an open end stops {end.distance:.6g} short of another wall", fix


def at_least(length: float) -> str:
    """A short figure that is not below ``length``."""
    text = f"{length:.3g}"
    if float(text) >= length:
        return text
    return f"{float(text) + 10.0 ** (np.floor(np.log10(length)) - 2):.3g}"
