"""Loose ends: open ends that were meant to meet another end or a wall, and how to mend each without bending a wall.

An end is moved along its own line only: on to the first wall, back to the wall that it sticks out of, or to where its
line crosses that of another end. Where that leads nowhere near, a straight edge is added from end to end or from the
end to the nearest wall. What would cross a wall on its way is left alone.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Literal

import numpy as np
import shapely
from numpy.typing import NDArray

from wallkit.walls.meetings import meetings, on_edge, part_of
from wallkit.walls.nearest import ComplexArray, ExactEdges
from wallkit.walls.orientation import side
from wallkit.walls.strokes import FloatArray, IntArray
from wallkit.walls.walls import Walls

BoolArray = NDArray[np.bool_]
Kind = Literal["corner", "middle", "bridge", "extend", "foot", "trim"]

ROUNDING = 1e-14  # of the largest coordinate: an end so near a wall was put onto it
_OWN = 4.0  # a wall comes back to itself where the way along it is so many times the distance; else it only bends
_ASKEW = 3.0  # a move along the own line is taken up to so many times the distance, else an edge is added
_SECTIONS = 8  # edges at the end of a wall that are looked at for what sticks out


@dataclass(frozen=True, slots=True)
class LooseEnd:
    """A loose end, or two, and what mends it.

    Attributes:
        kind: ``corner`` both ends move to where their lines cross; ``middle`` both lie on one line and meet in the
            middle; ``bridge`` an edge leads from end to end; ``extend`` the end moves on to a wall; ``foot`` an edge
            leads to the nearest wall; ``trim`` what sticks out of a wall goes.
        ends: one or two vertices.
        distance: between the two, to the wall, or how far it sticks out.
        need: how far an end moves, or how long the edge is; infinite where a wall is in the way.
        at: where the ends meet; for a bridge the second end.
        sections: whole edges that are trimmed away.
        back: where the first end moves back to before the bridge is added, if it reaches past the second.
    """

    kind: Kind
    ends: tuple[int, ...]
    distance: float
    need: float
    at: complex
    sections: int = 0
    back: complex | None = None


@dataclass(slots=True)
class _Ends:
    """Open ends: vertex, the vertex before, wall, edge, and the line that leads to them."""

    vertex: IntArray
    wall: IntArray
    edge: IntArray
    step: IntArray  # 1 where the wall goes on at the next vertex, -1 at the one before
    at: ComplexArray
    line: ExactEdges
    straight: BoolArray
    towards: ComplexArray = field(init=False)

    def __post_init__(self) -> None:
        d = self.line.b - self.line.a
        self.towards = d / np.maximum(np.abs(d), 1e-300)

    def take(self, index: IntArray) -> _Ends:
        """Give those at ``index``."""
        return _Ends(
            self.vertex[index], self.wall[index], self.edge[index], self.step[index], self.at[index],
            self.line.take(index), self.straight[index],
        )  # fmt: skip


@dataclass(slots=True)
class _Scene:
    """Walls with what the search asks of them again and again."""

    walls: Walls
    edges: ExactEdges
    edge_wall: IntArray
    starts: IntArray
    stops: IntArray
    boxes: NDArray[np.object_]
    tree: shapely.STRtree
    along: FloatArray  # (V,) way along its wall to each vertex
    total: FloatArray  # (W,) length of each wall
    there: float

    @classmethod
    def of(cls, walls: Walls) -> _Scene:
        edges = ExactEdges.of(walls)
        length = np.where(edges.radius > 0, np.abs(edges.angle) * edges.radius, np.abs(edges.b - edges.a))
        bow = np.abs(np.tan(edges.angle / 4)) * np.abs(edges.b - edges.a) / 2
        a, b = walls.vertices[walls.edge_starts], walls.vertices[walls.edge_ends]
        low, high = np.minimum(a, b) - bow[:, None], np.maximum(a, b) + bow[:, None]
        boxes = shapely.box(low[:, 0], low[:, 1], high[:, 0], high[:, 1])
        wall_of = np.repeat(np.arange(len(walls)), np.diff(walls.offsets))
        step = np.zeros(len(walls.vertices))
        step[walls.edge_starts] = length
        along = np.cumsum(step) - step
        along -= along[walls.offsets[:-1]][wall_of]
        edge_wall = wall_of[walls.edge_starts]
        there = ROUNDING * float(np.abs(walls.vertices).max(initial=0.0))
        total = np.bincount(edge_wall, length, len(walls)).astype(np.float64)
        starts, stops = walls.edge_starts, walls.edge_ends
        return cls(walls, edges, edge_wall, starts, stops, boxes, shapely.STRtree(boxes), along, total, there)

    def ends(self) -> _Ends:
        """All open ends."""
        walls = self.walls
        open_ = np.flatnonzero(~walls.closed & (np.diff(walls.offsets) > 1))
        first, last = walls.offsets[:-1][open_], walls.offsets[1:][open_] - 1
        edge_at = np.full(len(walls.vertices) + 1, -1)
        edge_at[self.starts] = np.arange(len(self.starts))
        vertex = np.concatenate([first, last])
        edge = np.concatenate([edge_at[first], edge_at[last - 1]])
        step = np.repeat([1, -1], len(open_))
        z = walls.vertices[:, 0] + 1j * walls.vertices[:, 1]
        zero = np.zeros(len(vertex))
        line = ExactEdges(z[vertex + step], z[vertex], zero.astype(np.complex128), zero, zero)
        return _Ends(vertex, np.tile(open_, 2), edge, step, z[vertex], line, self.edges.radius[edge] == 0)

    def own_bend(self, ends: _Ends, edge: IntArray, distance: FloatArray) -> BoolArray:
        """Where an edge is the end's own, or the wall does no more than bend on its way to it."""
        here = self.along[ends.vertex]
        way = np.minimum(np.abs(here - self.along[self.starts[edge]]), np.abs(here - self.along[self.stops[edge]]))
        own: BoolArray = (self.edge_wall[edge] == ends.wall) & ((ends.edge == edge) | (way <= _OWN * distance))
        return own


@dataclass(slots=True)
class _Near:
    """Pairs of an end (its row) and an edge within reach of it."""

    end: IntArray
    edge: IntArray
    distance: FloatArray
    foot: ComplexArray


def loose_ends(walls: Walls, reach: float) -> list[LooseEnd]:
    """Find loose ends and what mends each; each end at most once, those that need least first.

    Args:
        walls: any walls; arcs are taken as they are.
        reach: how far ends may move, and how long an added edge may be.
    """
    if not len(walls.edge_starts) or walls.closed.all() or reach <= 0:
        return []
    scene = _Scene.of(walls)
    ends = scene.ends()
    near = _near(scene, ends, reach)
    settled = np.bincount(near.end[near.distance <= scene.there], minlength=len(ends.at)) > 0
    _, spot, shared = np.unique(ends.at, return_inverse=True, return_counts=True)
    settled |= shared[spot.reshape(-1)] > 1
    loose = np.flatnonzero(~settled)
    found = _pairs(scene, ends, loose, near, reach) + _to_walls(scene, ends, near, ~settled, reach)
    return _chosen(found)


def settled_places(walls: Walls) -> ComplexArray:
    """The open ends that lie on another wall, as complex numbers."""
    scene = _Scene.of(walls)
    ends = scene.ends()
    near = _near(scene, ends, scene.there)
    places: ComplexArray = ends.at[np.unique(near.end[near.distance <= scene.there])]
    return places


def _chosen(found: list[tuple[int, LooseEnd]]) -> list[LooseEnd]:
    """Each end once, by rank, then by need; ranks: crossed corners, pairs, moves to walls, edges to walls, blocked."""
    used: set[int] = set()
    chosen = []
    for _, loose in sorted(found, key=lambda pair: (pair[0], pair[1].need, pair[1].distance, pair[1].ends)):
        if used.isdisjoint(loose.ends):
            used.update(loose.ends)
            chosen.append(loose)
    return chosen


def _near(scene: _Scene, ends: _Ends, reach: float) -> _Near:
    x, y = ends.at.real, ends.at.imag
    end, edge = scene.tree.query(shapely.box(x - reach, y - reach, x + reach, y + reach))
    e = scene.edges.take(edge)
    foot = e.nearest(ends.at[end])
    distance = np.abs(foot - ends.at[end])
    keep = (distance <= reach) & ~scene.own_bend(ends.take(end), edge, distance)
    return _Near(end[keep], edge[keep], distance[keep], foot[keep])


def _pairs(scene: _Scene, ends: _Ends, loose: IntArray, near: _Near, reach: float) -> list[tuple[int, LooseEnd]]:
    """What mends two ends: a corner where both lines cross near by, the middle on one line, an edge else."""
    points = shapely.points(ends.at.real[loose], ends.at.imag[loose])
    pair = shapely.STRtree(points).query(points, predicate="dwithin", distance=2 * reach)
    i, j = loose[pair[:, pair[0] < pair[1]]]
    one, two = ends.take(i), ends.take(j)
    distance = np.abs(one.at - two.at)
    way = np.abs(scene.along[one.vertex] - scene.along[two.vertex])
    apart = (one.wall != two.wall) | (way > _OWN * distance)
    beside = _beside(near, ends, i, j)
    corner = _crossing(one.line, two.line)
    with np.errstate(invalid="ignore"):
        moves = [((corner - e.at) * e.towards.conj()).real for e in (one, two)]
        need = np.maximum(np.abs(moves[0]), np.abs(moves[1]))
        short = np.minimum(*[m + np.abs(e.line.b - e.line.a) for m, e in zip(moves, (one, two), strict=True)])
        crossed = (moves[0] < 0) & (moves[1] < 0)
        is_corner = one.straight & two.straight & (need <= reach) & (short > scene.there)
        is_corner &= crossed | (need <= _ASKEW * np.minimum(distance, beside))
    nearest = (distance <= reach) & (distance <= beside * (1 + 1e-9) + scene.there)
    flat = one.straight & two.straight & _on_one_line(one, two)
    rows = {
        "corner": np.flatnonzero(apart & is_corner & ~flat),
        "middle": np.flatnonzero(apart & nearest & flat),
        "bridge": np.flatnonzero(apart & nearest & ~flat),
    }
    found = []
    for kind, row in rows.items():
        target = corner[row] if kind == "corner" else two.at[row]
        length = need[row] if kind == "corner" else distance[row]
        if kind == "middle":
            target = (one.at[row] + two.at[row]) / 2
        blocked = _blocked(scene, one.at[row], target) | _blocked(scene, two.at[row], target)
        rank = np.where(blocked, 4, np.where(crossed[row] & (kind == "corner"), 0, 1))
        for r, k, need_, at, no in zip(
            row.tolist(), rank.tolist(), length.tolist(), target.tolist(), blocked, strict=True
        ):
            both = int(one.vertex[r]), int(two.vertex[r])
            back = _back(one, two, r) if kind == "bridge" else None
            found.append((k, LooseEnd(kind, both, float(distance[r]), np.inf if no else need_, at, 0, back)))  # type: ignore[arg-type]
    return found


def _back(one: _Ends, two: _Ends, row: int) -> complex | None:
    """Where to shorten the first end to, if it reaches past the second: abreast of it."""
    past = -float(((two.at[row] - one.at[row]) * one.towards[row].conjugate()).real)
    if not one.straight[row] or not 0 < past < abs(one.line.b[row] - one.line.a[row]):
        return None
    return complex(one.at[row] - past * one.towards[row])


def _beside(near: _Near, ends: _Ends, i: IntArray, j: IntArray) -> FloatArray:
    """The distance of the nearest edge to two ends, but for the edges that the two are the ends of."""
    order = np.lexsort((near.distance, near.end))
    edge = np.full((len(ends.at), 2), -1)
    distance = np.full((len(ends.at), 2), np.inf)
    rank = np.arange(len(order)) - np.searchsorted(near.end[order], near.end[order])
    for place in (0, 1):
        row = order[rank == place]
        edge[near.end[row], place], distance[near.end[row], place] = near.edge[row], near.distance[row]
    one = np.where(edge[i, 0] == ends.edge[j], distance[i, 1], distance[i, 0])
    two = np.where(edge[j, 0] == ends.edge[i], distance[j, 1], distance[j, 0])
    beside: FloatArray = np.minimum(one, two)
    return beside


def _crossing(one: ExactEdges, two: ExactEdges) -> ComplexArray:
    """Where lines cross; with the very coordinate of a line that is level or upright."""
    point = meetings(one, two)[:, 0]
    for e in (one, two):
        point.real = np.where(e.a.real == e.b.real, e.a.real, point.real)
        point.imag = np.where(e.a.imag == e.b.imag, e.a.imag, point.imag)
    return point


def _on_one_line(one: _Ends, two: _Ends) -> BoolArray:
    """Both lines are one, exactly."""
    a, b, c, d = (np.stack([z.real, z.imag], axis=1) for z in (one.line.a, one.line.b, two.line.a, two.line.b))
    flat: BoolArray = (side(a, b, c) == 0) & (side(a, b, d) == 0)
    return flat


def _to_walls(scene: _Scene, ends: _Ends, near: _Near, loose: BoolArray, reach: float) -> list[tuple[int, LooseEnd]]:
    """What mends an end at a wall: back to the wall that it sticks out of, on to the first wall, an edge else."""
    keep = loose[near.end]
    end, edge, distance, foot = near.end[keep], near.edge[keep], near.distance[keep], near.foot[keep]
    mine = ends.take(end)
    ahead = _ahead(scene, mine, edge)
    out = _sticking_out(scene, ends, np.flatnonzero(loose), reach)
    order = np.lexsort((distance, end))
    first = order[np.unique(end[order], return_index=True)[1]] if len(order) else order
    on = np.full(len(ends.at), -1)
    forward = np.full(len(ends.at), np.inf)
    np.minimum.at(forward, end, ahead)
    rows = np.flatnonzero(ahead == forward[end])
    on[end[rows]] = rows
    found = [(2, loose_end) for row, loose_end in out.items() if loose_end.need <= forward[row]]
    trimmed = {loose_end.ends[0] for _, loose_end in found}
    blocked = _blocked(scene, mine.at[first], foot[first])
    for row, no in zip(first.tolist(), blocked.tolist(), strict=True):
        vertex, far = int(mine.vertex[row]), float(forward[end[row]])
        if vertex in trimmed:
            continue
        if far <= min(reach, _ASKEW * float(distance[row])):
            at = complex(mine.at[row] + far * mine.towards[row])
            at = _put_on(scene, int(edge[on[end[row]]]), at, complex(mine.line.a[row]), complex(mine.at[row]))
            found.append((2, LooseEnd("extend", (vertex,), float(distance[row]), far, at)))
        else:
            need = np.inf if no else float(distance[row])
            at = _put_on(scene, int(edge[row]), complex(foot[row]), complex(mine.at[row]))
            found.append((4 if no else 3, LooseEnd("foot", (vertex,), float(distance[row]), need, at)))
    return found


def _ahead(scene: _Scene, mine: _Ends, edge: IntArray) -> FloatArray:
    """How far ahead of each end its line meets an edge; infinite where it does not, and for ends of arcs."""
    f = scene.edges.take(edge)
    met = meetings(mine.line, f)
    best = np.full(len(edge), np.inf)
    for point in met.T:
        with np.errstate(invalid="ignore"):
            t = ((point - mine.at) * mine.towards.conj()).real
            good = mine.straight & on_edge(f, point) & (t > scene.there)
        best = np.where(good, np.minimum(best, np.where(good, t, np.inf)), best)
    return best


def _sticking_out(scene: _Scene, ends: _Ends, rows: IntArray, reach: float) -> dict[int, LooseEnd]:
    """For each loose end (by row) the farthest crossing with another wall within reach along the own wall."""
    best: dict[int, LooseEnd] = {}
    done = np.zeros(len(rows))
    open_end = np.zeros(len(scene.walls.vertices), dtype=np.bool_)
    open_end[ends.vertex] = True
    for k in range(_SECTIONS):
        here = ends.take(rows)
        inner = here.vertex + (k + 1) * here.step
        first, last = scene.walls.offsets[here.wall], scene.walls.offsets[here.wall + 1] - 1
        keep = (inner >= first) & (inner <= last) & (done < reach)
        rows, done, here, inner = rows[keep], done[keep], here.take(np.flatnonzero(keep)), inner[keep]
        if not len(rows):
            break
        edge = here.edge + k * here.step
        source, other = scene.tree.query(scene.boxes[edge])
        apart = scene.edge_wall[other] != here.wall[source]
        source, other = source[apart], other[apart]
        e, f = scene.edges.take(edge[source]), scene.edges.take(other)
        length = np.abs(scene.along[scene.starts[edge]] - scene.along[scene.stops[edge]])
        for point in meetings(e, f).T:
            with np.errstate(invalid="ignore"):
                part = part_of(e, point)
                part = np.where(here.step[source] > 0, part, 1 - part)  # from the end on
                out = done[source] + part * length[source]
                good = on_edge(e, point) & on_edge(f, point) & (out > scene.there) & (out <= reach)
                good &= out <= scene.total[here.wall[source]] / 4
                for tip, z in ((scene.starts[other], f.a), (scene.stops[other], f.b)):
                    good &= ~(open_end[tip] & (np.abs(point - z) <= scene.there))  # an end on this wall: no crossing
            for index in np.flatnonzero(good).tolist():
                row, far = int(rows[source[index]]), float(out[index])
                if row not in best or best[row].need < far:
                    before = complex(*scene.walls.vertices[inner[source[index]]])
                    straight = scene.edges.radius[edge[source[index]]] == 0
                    tip = complex(*scene.walls.vertices[inner[source[index]] - here.step[source[index]]])
                    at = _put_on(scene, int(other[index]), complex(point[index]), before, tip if straight else None)
                    best[row] = LooseEnd("trim", (int(ends.vertex[row]),), far, far, at, k)
        done = done + length
    return best


def _put_on(scene: _Scene, edge: int, at: complex, before: complex, end: complex | None = None) -> complex:
    """A point on an edge, by rounding on the side that the wall comes from: a touch, not a crossing.

    On a line from ``before`` to ``end`` that is level or upright it stays so.
    """
    one = scene.edges.take(np.array([edge]))
    at = complex(one.nearest(np.array([at]))[0])
    if end is not None:
        at = complex(end.real if end.real == before.real else at.real, end.imag if end.imag == before.imag else at.imag)
    if one.radius[0] > 0 or at == before:
        return at
    a, b, source = (np.array([[z.real, z.imag]]) for z in (one.a[0], one.b[0], before))
    origin = int(side(a, b, source)[0])
    back = (before - at) / abs(before - at) * scene.there / 64
    for k in range(7):
        point: complex = at + (2.0**k - 1) * back
        if int(side(a, b, np.array([[point.real, point.imag]]))[0]) * origin >= 0:
            return point
    return at


def _blocked(scene: _Scene, start: ComplexArray, stop: ComplexArray) -> BoolArray:
    """Whether a wall is in the way from start to stop: met farther from both than rounding."""
    zero = np.zeros(len(start))
    low_x, high_x = np.minimum(start.real, stop.real), np.maximum(start.real, stop.real)
    low_y, high_y = np.minimum(start.imag, stop.imag), np.maximum(start.imag, stop.imag)
    piece, edge = scene.tree.query(shapely.box(low_x, low_y, high_x, high_y))
    way = ExactEdges(start[piece], stop[piece], zero.astype(np.complex128)[piece], zero[piece], zero[piece])
    f = scene.edges.take(edge)
    result = np.zeros(len(start), dtype=np.bool_)
    for point in meetings(way, f).T:
        with np.errstate(invalid="ignore"):
            inner = np.minimum(np.abs(point - way.a), np.abs(point - way.b)) > scene.there
            result[piece[inner & on_edge(way, point) & on_edge(f, point)]] = True
    return result
