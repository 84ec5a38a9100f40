"""Touches: where walls cross, touch and lie on one another; exact for the numbers as given."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from wallkit.geometry.arrays import FloatArray, IntArray, distinct
from wallkit.geometry.orientation import side
from wallkit.walls.copies import copies
from wallkit.walls.edge_tree import Edges


@dataclass(slots=True, eq=False, repr=False)
class Touches:
    """What was found, each kind as arrays of the same length.

    Attributes:
        crossing_walls: (n, 2) the two walls (the same twice for a wall that crosses itself), first <= second.
        crossing_at: (n, 2) where.
        overlap_edges: (m, 2) pairs of edges that share a piece of their length.
        overlap_at: (m, 2) the middle of that piece.
        overlap_length: (m,) its length.
        touch_walls: (k, 2) walls that touch at a point without crossing there.
        touch_at: (k, 2) where.
        cut_edge: (c,) edges that something else meets between their ends; copies are not asked.
        cut_at: (c, 2) where that is.
        copy_of: (W,) the first wall with the same edges. Only that one is told to cross or touch others; its copies
            lie on it, told as one overlap each.
        complete: false when there were more touches, or more pairs of near edges, than are looked at.
    """

    crossing_walls: IntArray
    crossing_at: FloatArray
    overlap_edges: IntArray
    overlap_at: FloatArray
    overlap_length: FloatArray
    touch_walls: IntArray
    touch_at: FloatArray
    cut_edge: IntArray
    cut_at: FloatArray
    copy_of: IntArray
    complete: bool


# Of near edges that are looked at, and of those that meet; a tangle beyond that is reported as one.
MOST_PAIRS = 10_000_000
MOST_CONTACTS = 500_000


def find_touches(edges: Edges) -> Touches:
    """Find all touches of edges that are not neighbours, and neighbours that fold back onto each other."""
    kinds: list[list[IntArray]] = [[], [], []]
    copy_of = copies(edges, np.diff(edges.offsets) >= np.where(edges.closed, 3, 2))
    again = copy_of != np.arange(len(copy_of))
    looked_at = met_so_far = 0
    complete = True
    for first, second in edges.near_pairs(np.flatnonzero(~again[edges.wall]) if again.any() else None):
        looked_at += len(first)
        if looked_at > MOST_PAIRS or met_so_far > MOST_CONTACTS:
            complete = False
            break
        for kind, rows in zip(kinds, _classify(edges, first, second), strict=True):
            kind.append(np.stack([first[rows], second[rows]], axis=1))
            met_so_far += len(kind[-1])
    none = np.empty((0, 2), dtype=np.int64)
    proper, flat, touch = (np.concatenate([none, *kind]) for kind in kinds)
    at = _meeting(*(ends(row) for row in proper.T for ends in (edges.starts_of, edges.stops_of)))
    met = np.concatenate([touch, flat])
    passages = _passages(edges, met[:, 0], met[:, 1])
    more_walls, more_at, touch_walls, touch_at = _through_vertices(edges, *passages)
    walls = np.sort(np.concatenate([edges.wall[proper], more_walls]), axis=1)
    folds = _folds(edges)
    cuts = _cuts(edges, proper, at, passages, folds)
    overlaps = _with_copies(edges, copy_of, *_overlaps(edges, flat[:, 0], flat[:, 1], folds))
    return Touches(walls, np.concatenate([at, more_at]), *overlaps, touch_walls, touch_at, *cuts, copy_of, complete)


def _cuts(
    edges: Edges,
    proper: IntArray,
    at: FloatArray,
    passages: tuple[IntArray, IntArray, FloatArray],
    folds: tuple[IntArray, IntArray],
) -> tuple[IntArray, FloatArray]:
    """Where something meets edges between their ends: crossings, and vertices that lie on them, folds among them."""
    count = len(edges.vertices)
    vertex, partner, _ = passages
    inside = partner >= count
    first, second = folds
    back = np.concatenate([first, second])  # the end of the shorter one lies on the longer
    end = np.concatenate([edges.stop[second], edges.start[first]])
    one, two = (np.hypot(*(edges.stops_of(part) - edges.starts_of(part)).T) for part in folds)
    longer = np.concatenate([one > two, one < two])
    edge = np.concatenate([proper.T.ravel(), partner[inside] - count, back[longer]])
    return edge, np.concatenate([at, at, edges.vertices[vertex[inside]], edges.vertices[end[longer]]])


def _with_copies(
    edges: Edges, copy_of: IntArray, pairs: IntArray, at: FloatArray, length: FloatArray
) -> tuple[IntArray, FloatArray, FloatArray]:
    """Add the copies of walls to the overlaps: the first edges of both, and the length of the whole wall."""
    copy = np.flatnonzero(copy_of != np.arange(len(copy_of)))
    if not len(copy):
        return pairs, at, length
    own = np.hypot(*(edges.b - edges.a).T)
    first_edge = np.searchsorted(edges.wall, np.stack([copy_of[copy], copy], axis=1))
    whole = np.bincount(edges.wall, own, len(copy_of))[copy]
    middle = (edges.a[first_edge[:, 1]] + edges.b[first_edge[:, 1]]) / 2
    return np.concatenate([pairs, first_edge]), np.concatenate([at, middle]), np.concatenate([length, whole])


def _classify(edges: Edges, first: IntArray, second: IntArray) -> tuple[NDArray[np.bool_], ...]:
    """Which pairs cross inside both edges, lie on one line, or touch with an end."""
    a, b = edges.starts_of(first), edges.stops_of(first)
    c, d = edges.starts_of(second), edges.stops_of(second)
    one = side(a, b, c) * side(a, b, d)
    two = side(c, d, a) * side(c, d, b)
    flat = (one == 0) & (two == 0)
    rows = np.flatnonzero(flat)
    a, b, c, d = a[rows], b[rows], c[rows], d[rows]
    flat[rows] = (side(a, b, c) == 0) & (side(a, b, d) == 0)
    return (one < 0) & (two < 0), flat, ~flat & (one <= 0) & (two <= 0) & (one * two == 0)


def _meeting(a: FloatArray, b: FloatArray, c: FloatArray, d: FloatArray) -> FloatArray:
    """Where segments that cross properly meet: a + (b - a) ((c - a) x (d - c)) / ((b - a) x (d - c))."""
    u, v, w = b - a, d - c, c - a
    with np.errstate(divide="ignore", invalid="ignore"):
        t = (w[:, 0] * v[:, 1] - w[:, 1] * v[:, 0]) / (u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0])
    return a + u * np.clip(np.nan_to_num(t, nan=0.5), 0.0, 1.0)[:, None]


def _overlaps(
    edges: Edges, first: IntArray, second: IntArray, folds: tuple[IntArray, IntArray]
) -> tuple[IntArray, FloatArray, FloatArray]:
    """Pieces shared by edges on one line, and by neighbours that fold back."""
    first, second = np.concatenate([first, folds[0]]), np.concatenate([second, folds[1]])
    a, b = edges.starts_of(first), edges.stops_of(first)
    c, d = edges.starts_of(second), edges.stops_of(second)
    axis = (np.abs(b - a)[:, 1] > np.abs(b - a)[:, 0]).astype(np.int64)[:, None]  # the wider one orders exactly
    ends = np.stack([a, b, c, d], axis=1)
    key = np.take_along_axis(ends, axis[:, :, None].repeat(4, axis=1), axis=2)[..., 0]
    low = np.maximum(key[:, :2].min(axis=1), key[:, 2:].min(axis=1))
    high = np.minimum(key[:, :2].max(axis=1), key[:, 2:].max(axis=1))
    keep = high > low
    order = np.argsort(key, axis=1, kind="stable")
    inner = np.take_along_axis(ends, order[:, 1:3, None], axis=1)[keep]
    length = np.hypot(*(inner[:, 1] - inner[:, 0]).T)
    return np.stack([first[keep], second[keep]], axis=1), inner.mean(axis=1), length


def _folds(edges: Edges) -> tuple[IntArray, IntArray]:
    """Neighbours along a polyline of which the second goes back over the first."""
    found = [np.empty((2, 0), dtype=np.int64)]
    for _, begin, some in edges.portions():
        edge_at = np.full(len(some.vertices), -1, dtype=np.int64)
        edge_at[some.start] = np.arange(len(some))
        second = edge_at[some.stop]
        x, y = (some.b - some.a).T
        back = np.flatnonzero((x * x[second] + y * y[second] < 0) & (second >= 0))
        found.append(np.stack([begin + back, begin + second[back]]))
    first, second = np.concatenate(found, axis=1)
    on_line = side(edges.starts_of(first), edges.stops_of(first), edges.stops_of(second)) == 0
    return first[on_line], second[on_line]


def _passages(edges: Edges, first: IntArray, second: IntArray) -> tuple[IntArray, IntArray, FloatArray]:
    """How two walls pass the points where an end of one edge lies on the other.

    A passage is a vertex (its number) or the inside of an edge (its number + V). Each pair of passages once.
    """
    count = len(edges.vertices)
    total = count + len(edges)
    keys = []
    for own, other in ((second, first), (first, second)):
        for vertex in (edges.start[own], edges.stop[own]):
            point, a, b = edges.vertices[vertex], edges.starts_of(other), edges.stops_of(other)
            within = ((point >= np.minimum(a, b)) & (point <= np.maximum(a, b))).all(axis=1)
            at_a, at_b = (point == a).all(axis=1), (point == b).all(axis=1)
            rows = np.flatnonzero(within)
            rows = rows[(side(a[rows], b[rows], point[rows]) == 0) | at_a[rows] | at_b[rows]]
            partner = np.where(at_a, edges.start[other], np.where(at_b, edges.stop[other], other + count))
            keys.append(np.minimum(vertex, partner)[rows] * total + np.maximum(vertex, partner)[rows])
    one, two = np.divmod(distinct(np.concatenate(keys)), total)
    different = one != two
    one, two = one[different], two[different]
    return one, two, edges.vertices[one]


def _arms(edges: Edges, passage: IntArray) -> tuple[FloatArray, FloatArray, IntArray, NDArray[np.bool_]]:
    """Points before and after a passage, its wall, and whether it has both (the end of an open wall has not)."""
    count = len(edges.vertices)
    inside = passage >= count
    edge = np.where(inside, passage - count, 0)
    vertex = np.where(inside, edges.start[edge], passage)
    before = np.where(inside, vertex, edges.before[vertex])
    after = np.where(inside, edges.stop[edge], edges.following[vertex])
    wall = edges.wall_of[vertex]
    first, last = edges.offsets[wall], edges.offsets[wall + 1] - 1
    whole = inside | edges.closed[wall] | ((vertex != first) & (vertex != last))
    return edges.vertices[before], edges.vertices[after], wall, whole


def _through_vertices(
    edges: Edges, one: IntArray, two: IntArray, at: FloatArray
) -> tuple[IntArray, FloatArray, IntArray, FloatArray]:
    """Which touching walls go from one side of the other to its other side.

    At one point: the arms of the second lie strictly on different sides of the first. Along a shared edge the
    arms at one end lie on the first wall; but a closed wall has its inside on one side everywhere, so arms on
    both sides at any two touches of two closed walls mean a crossing too.
    """
    if not len(one):
        none = np.empty((0, 2), dtype=np.int64)
        return none, np.empty((0, 2)), none, np.empty((0, 2))
    a_in, a_out, a_wall, a_whole = _arms(edges, one)
    b_in, b_out, b_wall, b_whole = _arms(edges, two)
    whole = a_whole & b_whole
    b_sides = np.stack([_side_of_bend(a_in, at, a_out, arm) for arm in (b_in, b_out)], axis=1)
    a_sides = np.stack([_side_of_bend(b_in, at, b_out, arm) for arm in (a_in, a_out)], axis=1)
    crossing = whole & (b_sides[:, 0] * b_sides[:, 1] < 0)
    crossing |= _shared_runs(edges, a_wall, b_wall, a_sides, b_sides, whole)
    walls = np.stack([a_wall, b_wall], axis=1)
    touch = ~crossing
    return walls[crossing], at[crossing], np.sort(walls[touch], axis=1), at[touch]


def _side_of_bend(before: FloatArray, at: FloatArray, after: FloatArray, arm: FloatArray) -> NDArray[np.int8]:
    """1 where the arm leaves to the left of the bend before-at-after, -1 right, 0 along one of its legs."""
    turn = side(before, at, after)
    leg1, leg2 = side(before, at, arm), side(at, after, arm)
    left = np.where(turn > 0, (leg1 > 0) & (leg2 > 0), (leg1 > 0) | (leg2 > 0))
    right = np.where(turn >= 0, (leg1 < 0) | (leg2 < 0), (leg1 < 0) & (leg2 < 0))
    along = ((leg1 == 0) & (((before - at) * (arm - at)).sum(axis=1) > 0)) | (
        (leg2 == 0) & (((after - at) * (arm - at)).sum(axis=1) > 0)
    )
    return np.where(along, 0, np.where(left, 1, np.where(right, -1, 0))).astype(np.int8)


def _shared_runs(
    edges: Edges,
    a_wall: IntArray,
    b_wall: IntArray,
    a_sides: NDArray[np.int8],
    b_sides: NDArray[np.int8],
    whole: NDArray[np.bool_],
) -> NDArray[np.bool_]:
    """Mark one contact of each pair of closed walls of which one has arms on both sides of the other."""
    marked = np.zeros(len(a_wall), dtype=np.bool_)
    contact = np.flatnonzero(whole & edges.closed[a_wall] & edges.closed[b_wall] & (a_wall != b_wall))
    if not len(contact):
        return marked
    rows = np.concatenate([contact, contact])
    told = np.concatenate([a_wall[contact], b_wall[contact]])  # whose arms the sides are
    about = np.concatenate([b_wall[contact], a_wall[contact]])
    sides = np.concatenate([a_sides[contact], b_sides[contact]])
    unique, group = np.unique(told * len(edges.closed) + about, return_inverse=True)
    seen = [np.bincount(group, (sides == sign).any(axis=1), len(unique)) > 0 for sign in (1, -1)]
    both = (seen[0] & seen[1])[group] & (sides != 0).any(axis=1)
    pair = np.minimum(told, about)[both] * len(edges.closed) + np.maximum(told, about)[both]
    marked[rows[both][np.unique(pair, return_index=True)[1]]] = True
    return marked
