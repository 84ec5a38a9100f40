"""Loose ends: open ends that were meant to meet another end or a wall, and how to mend each without bending a wall.

An end is moved along its own line only: on to the first wall, back to the wall that it sticks out of, or to where its
line crosses that of another end. Where that leads nowhere near, a straight edge is added from end to end or from the
end to the nearest wall. What would cross a wall on its way is left alone.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Literal, NamedTuple

import numpy as np

from importers.limits import limit_error
from wallkit.geometry.arrays import FloatArray, IntArray, distinct
from wallkit.geometry.exact_edges import ComplexArray, ExactEdges
from wallkit.geometry.orientation import side
from wallkit.walls.checking.meetings import meetings, on_edge
from wallkit.walls.checking.open_ends import OWN, BoolArray, OpenEnds, Surroundings, in_the_way, portions, put_on
from wallkit.walls.checking.overshoots import Overshoots, overshoots
from wallkit.walls.near_boxes import NearBoxes
from wallkit.walls.walls import Walls

EndKind = Literal["corner", "middle", "bridge", "extend", "foot", "trim"]

MOST_NEAR = 2_000_000
"""Pairs of an open end and an edge, or of two ends, within reach of each other: more are not looked at."""
_AT_FIRST, _AT_ONCE = 64, 1 << 16  # ends that are asked about, and answers
_ASKEW = 3.0  # a move along the own line is taken up to so many times the distance, else an edge is added


class LooseEnd(NamedTuple):
    """A loose end, or two, and what mends it.

    Attributes:
        kind: ``corner`` both ends move to where their lines cross; ``middle`` both lie on one line and meet in the
            middle; ``bridge`` an edge leads from end to end; ``extend`` the end moves on to a wall; ``foot`` an edge
            leads to the nearest wall; ``trim`` what sticks out of a wall goes.
        ends: one or two vertices.
        distance: between the two, to the wall, or how far it sticks out.
        need: how far an end moves, or how long the edge is; infinite where a wall is in the way.
        at: where the ends meet; for a bridge the second end.
        edge: the edge that the end is led to; -1 for pairs.
        before: where the line comes from that is drawn on, or trimmed, or added.
        tip: where the line ends that is drawn on or trimmed; None for an arc or an added edge.
        sections: whole edges that are trimmed away.
        back: where the first end moves back to before the bridge is added, if it reaches past the second.
    """

    kind: EndKind
    ends: tuple[int, ...]
    distance: float
    need: float
    at: complex
    edge: int = -1
    before: complex = 0j
    tip: complex | None = None
    sections: int = 0
    back: complex | None = None


@dataclass(slots=True, eq=False, repr=False)
class _Near:
    """Pairs of an end (its row) and an edge within reach of it."""

    end: IntArray
    edge: IntArray
    distance: FloatArray
    foot: ComplexArray


@dataclass(slots=True, eq=False, repr=False)
class _Offers:
    """What could mend ends, in columns; only what is chosen is made.

    Attributes:
        rank: (n,) 0 crossed corners, 1 pairs, 2 moves to walls, 3 edges to walls, 4 what a wall is in the way of.
        need: (n,) as of a LooseEnd, and so the others.
        distance: (n,).
        ends: (n, 2) vertices; the second is -1 where there is one.
        make: makes the one of a row.
    """

    rank: IntArray
    need: FloatArray
    distance: FloatArray
    ends: IntArray
    make: Callable[[int], LooseEnd]


def loose_ends(walls: Walls, reach: float, scene: Surroundings | None = None) -> list[LooseEnd]:
    """Find loose ends and what mends each; each end at most once, those that need least first.

    Args:
        walls: any walls; arcs are taken as they are.
        reach: how far ends may move, and how long an added edge may be.
        scene: the surroundings of the walls, if they are at hand.

    Raises:
        LimitError: more than MOST_NEAR pairs of an end and an edge, or of two ends, are that near.
    """
    if not len(walls.edge_starts) or walls.closed.all() or reach <= 0:
        return []
    scene = Surroundings.of(walls) if scene is None else scene
    ends = scene.ends()
    near = _near(scene, ends, reach)
    settled = np.bincount(near.end[near.distance <= scene.there], minlength=len(ends.at)) > 0
    _, spot, shared = np.unique(ends.at, return_inverse=True, return_counts=True)
    settled |= shared[spot.reshape(-1)] > 1
    loose = np.flatnonzero(~settled)
    return _chosen([*_pairs(scene, ends, loose, near, reach), *_to_walls(scene, ends, near, ~settled, reach)])


def landed(walls: Walls, found: list[LooseEnd]) -> list[LooseEnd]:
    """The same with ``at`` to the bit: on the edge that the end is led to, and not beyond it."""
    scene = Surroundings.of(walls)
    return [
        loose if loose.edge < 0 else loose._replace(at=put_on(scene, loose.edge, loose.at, loose.before, loose.tip))
        for loose in found
    ]


def settled_places(walls: Walls) -> ComplexArray:
    """The open ends that lie on another wall, as complex numbers."""
    scene = Surroundings.of(walls)
    ends = scene.ends()
    near = _near(scene, ends, scene.there)
    places: ComplexArray = ends.at[distinct(near.end[near.distance <= scene.there])]
    return places


def _chosen(offers: list[_Offers]) -> list[LooseEnd]:
    """Mend each end once: by rank, then by need, by distance, and by the number of the end."""
    ends = np.concatenate([np.empty((0, 2), dtype=np.int64), *(offer.ends for offer in offers)])
    rank, need, distance = (
        np.concatenate([np.empty(0), *(getattr(offer, name) for offer in offers)])
        for name in ("rank", "need", "distance")
    )
    batch = np.repeat(np.arange(len(offers)), [len(offer.rank) for offer in offers])
    row = np.concatenate([np.empty(0, dtype=np.int64), *(np.arange(len(offer.rank)) for offer in offers)])
    order = np.lexsort((ends[:, 1], ends[:, 0], distance, need, rank))
    mended, chosen = set[int](), []
    for one, two, number, k in zip(*(column[order].tolist() for column in (*ends.T, batch, row)), strict=True):
        if one not in mended and two not in mended:
            mended.update((one,) if two < 0 else (one, two))
            chosen.append(offers[number].make(k))
    return chosen


def _near(scene: Surroundings, ends: OpenEnds, reach: float) -> _Near:
    parts, count = [], 0
    for end, edge in _beside_each(scene.boxes, ends.at, reach):
        count = _bounded(count + len(end))
        parts.append(_near_among(scene, ends, end, edge, reach))
    return _Near(
        np.concatenate([part.end for part in parts]),
        np.concatenate([part.edge for part in parts]),
        np.concatenate([part.distance for part in parts]),
        np.concatenate([part.foot for part in parts]),
    )


def _near_among(scene: Surroundings, ends: OpenEnds, end: IntArray, edge: IntArray, reach: float) -> _Near:
    """Of pairs of an end and an edge those that are within reach of each other."""
    maybe = _by_the_line(scene, ends.at[end], edge, reach)
    end, edge = end[maybe], edge[maybe]
    e = scene.edges.take(edge)
    foot = e.nearest(ends.at[end])
    distance = np.abs(foot - ends.at[end])
    keep = (distance <= reach) & ~scene.own_bend(ends.take(end), edge, distance)
    return _Near(end[keep], edge[keep], distance[keep], foot[keep])


def _beside_each(boxes: NearBoxes, at: ComplexArray, reach: float) -> Iterator[tuple[IntArray, IntArray]]:
    """Give the boxes within reach of each place, across and up: numbers of places and boxes, both rising.

    So many places at a time as will have some _AT_ONCE answers, which bounds the memory.
    """
    places, start, some = np.stack([at.real, at.imag]), 0, _AT_FIRST
    while start < len(at) or not start:
        asked = places[:, start : start + some]
        place, box = boxes.query(asked - reach, asked + reach)
        yield place + start, box
        start += some
        some = max(some * _AT_ONCE // max(len(box), _AT_ONCE // 4), 1)


def _bounded(count: int) -> int:
    """Give the number of pairs that were found if they are no more than MOST_NEAR."""
    if count > MOST_NEAR:
        fix = "give a smaller reach (--snap), or take fewer layers"
        raise limit_error("pairs of an open end and what is near it", f"{MOST_NEAR:,}", fix=fix)
    return count


def _by_the_line(scene: Surroundings, at: ComplexArray, edge: IntArray, reach: float) -> BoolArray:
    """Tell where the line that a straight edge is on is within reach: the boxes of long edges are met far from them."""
    a = scene.edges.a[edge]
    d, v = scene.edges.b[edge] - a, at - a
    off = np.abs(d.real * v.imag - d.imag * v.real)
    within: BoolArray = off <= (reach * (1 + 1e-9) + scene.there) * np.abs(d)
    return within | (scene.edges.radius[edge] > 0)


def _pairs(scene: Surroundings, ends: OpenEnds, loose: IntArray, near: _Near, reach: float) -> list[_Offers]:
    """What mends two ends: a corner where both lines cross near by, the middle on one line, an edge else."""
    at, beside = ends.at[loose], _two_nearest(near, len(ends.at))
    places = np.stack([at.real, at.imag])
    found, count = [], 0
    for i, j in _beside_each(NearBoxes(places, places), at, 2 * reach):
        within = np.abs(at[i] - at[j]) <= 2 * reach
        count = _bounded(count + int(np.count_nonzero(within)))
        i, j = loose[i[within & (i < j)]], loose[j[within & (i < j)]]
        found += _pairs_among(scene, ends, i, j, beside, reach)
    return found


def _pairs_among(
    scene: Surroundings,
    ends: OpenEnds,
    i: IntArray,
    j: IntArray,
    nearest_edges: tuple[IntArray, FloatArray],
    reach: float,
) -> list[_Offers]:
    """What mends the ends ``i`` with the ends ``j``."""
    one, two = ends.take(i), ends.take(j)
    distance = np.abs(one.at - two.at)
    way = np.abs(scene.along[one.vertex] - scene.along[two.vertex])
    apart = (one.wall != two.wall) | (way > OWN * distance)
    beside = _beside(nearest_edges, ends, i, j)
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
    rows: dict[EndKind, IntArray] = {
        "corner": np.flatnonzero(apart & is_corner & ~flat),
        "middle": np.flatnonzero(apart & nearest & flat),
        "bridge": np.flatnonzero(apart & nearest & ~flat),
    }
    target = {"corner": corner, "middle": (one.at + two.at) / 2, "bridge": two.at}
    found = []
    for kind, row in rows.items():
        at, length = target[kind][row], need[row] if kind == "corner" else distance[row]
        blocked = in_the_way(scene, one.at[row], at) | in_the_way(scene, two.at[row], at)
        rank = np.where(blocked, 4, np.where(crossed[row] & (kind == "corner"), 0, 1))
        found.append(_of_pairs(kind, ends, i[row], j[row], at, rank, np.where(blocked, np.inf, length), distance[row]))
    return found


def _of_pairs(
    kind: EndKind, ends: OpenEnds, i: IntArray, j: IntArray, at: ComplexArray,
    rank: IntArray, need: FloatArray, distance: FloatArray,
) -> _Offers:  # fmt: skip
    """Offer to mend ends ``i`` with ``j`` at some places."""
    both = np.stack([ends.vertex[i], ends.vertex[j]], axis=1)

    def make(row: int) -> LooseEnd:
        pair = int(both[row, 0]), int(both[row, 1])
        back = _back(ends, i[row], j[row]) if kind == "bridge" else None
        return LooseEnd(kind, pair, float(distance[row]), float(need[row]), complex(at[row]), back=back)

    return _Offers(rank, need, distance, both, make)


def _back(ends: OpenEnds, one: int, two: int) -> complex | None:
    """Where to shorten the first end to, if it reaches past the second: abreast of it."""
    past = -float(((ends.at[two] - ends.at[one]) * ends.towards[one].conjugate()).real)
    if not ends.straight[one] or not 0 < past < abs(ends.line.b[one] - ends.line.a[one]):
        return None
    return complex(ends.at[one] - past * ends.towards[one])


def _two_nearest(near: _Near, count: int) -> tuple[IntArray, FloatArray]:
    """The two nearest edges of each end, (count, 2), -1 where there are fewer, and how far they are."""
    order = np.lexsort((near.distance, near.end))
    edge = np.full((count, 2), -1)
    distance = np.full((count, 2), np.inf)
    rank = np.arange(len(order)) - np.searchsorted(near.end[order], near.end[order])
    for place in (0, 1):
        row = order[rank == place]
        edge[near.end[row], place], distance[near.end[row], place] = near.edge[row], near.distance[row]
    return edge, distance


def _beside(nearest_edges: tuple[IntArray, FloatArray], ends: OpenEnds, i: IntArray, j: IntArray) -> FloatArray:
    """The distance of the nearest edge to two ends, but for the edges that the two are the ends of."""
    edge, distance = nearest_edges
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


def _on_one_line(one: OpenEnds, two: OpenEnds) -> BoolArray:
    """Both lines are one, exactly."""
    a, b, c, d = (np.stack([z.real, z.imag], axis=1) for z in (one.line.a, one.line.b, two.line.a, two.line.b))
    flat: BoolArray = (side(a, b, c) == 0) & (side(a, b, d) == 0)
    return flat


def _to_walls(scene: Surroundings, ends: OpenEnds, near: _Near, loose: BoolArray, reach: float) -> list[_Offers]:
    """What mends an end at a wall: back to the wall that it sticks out of, on to the first wall, an edge else."""
    keep = loose[near.end]
    end, edge, distance, foot = near.end[keep], near.edge[keep], near.distance[keep], near.foot[keep]
    ahead = np.concatenate([_ahead(scene, ends.take(end[at]), edge[at]) for at in portions(len(end))])
    out = overshoots(scene, ends, np.flatnonzero(loose), (near.end, near.edge), reach)
    order = np.lexsort((distance, end))
    first = order[np.unique(end[order], return_index=True)[1]] if len(order) else order
    on = np.full(len(ends.at), -1)
    forward = np.full(len(ends.at), np.inf)
    np.minimum.at(forward, end, ahead)
    rows = np.flatnonzero(ahead == forward[end])
    on[end[rows]] = edge[rows]
    trims = (out.length > 0) & (out.length <= forward)
    first = first[~trims[end[first]]]
    end, edge, foot, short = end[first], edge[first], foot[first], distance[first]
    far = forward[end]
    goes_on = far <= np.minimum(reach, _ASKEW * short)
    blocked = in_the_way(scene, ends.at[end], foot) & ~goes_on
    need = np.where(goes_on, far, np.where(blocked, np.inf, short))

    def make(row: int) -> LooseEnd:
        at, vertex = end[row], (int(ends.vertex[end[row]]),)
        tip, where = complex(ends.at[at]), complex(foot[row])
        if not goes_on[row]:
            return LooseEnd("foot", vertex, float(short[row]), float(need[row]), where, int(edge[row]), tip)
        where, before = tip + float(far[row]) * complex(ends.towards[at]), complex(ends.line.a[at])
        return LooseEnd("extend", vertex, float(short[row]), float(far[row]), where, int(on[at]), before, tip)

    rank = np.where(goes_on, 2, np.where(blocked, 4, 3))
    return [_trims(scene, ends, out, np.flatnonzero(trims)), _Offers(rank, need, short, _alone(ends, end), make)]


def _alone(ends: OpenEnds, rows: IntArray) -> IntArray:
    """The vertices of ends that are mended by themselves."""
    return np.stack([ends.vertex[rows], np.full(len(rows), -1)], axis=1)


def _trims(scene: Surroundings, ends: OpenEnds, out: Overshoots, rows: IntArray) -> _Offers:
    """Offer to trim ends that stick out."""
    length = out.length[rows]
    rank = np.full(len(rows), 2)
    return _Offers(rank, length, length, _alone(ends, rows), lambda row: _trim(scene, ends, out, int(rows[row])))


def _trim(scene: Surroundings, ends: OpenEnds, out: Overshoots, row: int) -> LooseEnd:
    vertex, step, sections = int(ends.vertex[row]), int(ends.step[row]), int(out.sections[row])
    tip, before = (complex(*scene.walls.vertices[vertex + (sections + k) * step]) for k in (0, 1))
    straight = scene.edges.radius[int(ends.edge[row]) + sections * step] == 0
    length = float(out.length[row])
    at, edge = complex(out.at[row]), int(out.edge[row])
    return LooseEnd("trim", (vertex,), length, length, at, edge, before, tip if straight else None, sections)


def _ahead(scene: Surroundings, mine: OpenEnds, edge: IntArray) -> FloatArray:
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
