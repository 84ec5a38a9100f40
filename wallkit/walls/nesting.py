"""Nesting: how many closed walls are around each wall; even depth is a solid, odd depth a hole.

The parent of a ring B is the smallest ring around it. Take a point p inside B just below its highest vertex and
look straight up, among the rings larger than B only: none of them is inside B, so p and B are in the same face
of theirs. The first edge met belongs to a ring X with p either inside (then X is the parent) or outside (then
the parent of X is the parent of B). Copies of a ring stand for one ring. One look per ring, in a tree of boxes:
n log n for any depth of nesting.

The point is taken close below the top, and the look goes four times as far whenever it met nothing: rings may
be many and close together above and below.

Rings that cross another are no part of faces. They are around a ring when they contain its point p, are larger
and do not cross it.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from wallkit.geometry.arrays import FloatArray, IntArray, distinct
from wallkit.walls.copies import copies
from wallkit.walls.edge_tree import Edges, EdgeTree

_PAIRS_AT_ONCE = 4_000_000  # of a point and an edge: bounds the memory
_FRACTION = 0.41421  # of the chord below the top; no simple fraction, so that rays miss the vertices of tidy drawings


def depths(edges: Edges, crossing: IntArray | None = None, group: IntArray | None = None) -> tuple[IntArray, IntArray]:
    """Find depth and parent of every wall.

    Args:
        edges: straight edges of all walls, none without length.
        crossing: (n, 2) pairs of walls that cross; both may be the same one.
        group: (W,) only walls of the same group are around one another; None for one group.

    Returns:
        Depth (W,): closed walls around each wall, copies counted once. Parent (W,): the smallest of them among
        those that cross no other, or -1.
    """
    count = len(edges.closed)
    areas = np.abs(edges.areas)
    ring = edges.closed & (np.diff(edges.offsets) >= 3) & (areas > 0)
    copy_of = copies(edges, ring, group)
    whole = copy_of if group is None else copies(edges, ring)  # a copy crosses what the first one does
    pairs = np.empty((0, 2), dtype=np.int64) if crossing is None else whole[crossing]
    pairs = _distinct(pairs[(pairs[:, 0] != pairs[:, 1]) & ring[pairs].any(axis=1)], count)
    tangled = np.zeros(count, dtype=np.bool_)
    tangled[pairs.ravel()] = True
    tangled = tangled[whole]
    points = _inner_points(edges, ring)
    # a strict order by size; open walls come last, so that every ring is larger than they are
    size = np.empty(count, dtype=np.int64)
    size[np.lexsort((np.arange(count), np.where(ring, areas, -1.0)))] = np.arange(count)
    surrounds = ring & ~tangled & (copy_of == np.arange(count))
    parent = _parents(edges, points, size, surrounds, copy_of, group)
    depth = _levels(parent)
    if tangled.any():
        outer = tangled & ring & (copy_of == np.arange(count))
        depth += _tangled_around(edges, points, size, outer, whole[pairs], whole, group)
    return depth[copy_of], parent[copy_of]


def _inner_points(edges: Edges, ring: NDArray[np.bool_]) -> FloatArray:
    """A point inside each ring, between its highest vertices and the next lower; else an edge's middle.

    A 2^20th of the way down, but not so little that rounding of the coordinates could tell it from the top.
    """
    points, least = np.empty((len(ring), 2)), 1e-9 * edges.size
    for wall, _, some in edges.portions():
        rows = slice(wall, wall + len(some.closed))
        points[rows] = _inner_points_of(some, ring[rows], least)
    return points


def _inner_points_of(edges: Edges, ring: NDArray[np.bool_], least: float) -> FloatArray:
    """The same for some polylines: ``least`` below the top, or half the way where that is less."""
    first = edges.offsets[:-1]
    result = edges.vertices[np.minimum(first, len(edges.vertices) - 1)].copy()
    more = np.diff(edges.offsets) > 1
    result[more] = (edges.vertices[first[more]] + edges.vertices[first[more] + 1]) / 2
    y = edges.vertices[:, 1]
    if not ring.any():
        return result
    top = np.maximum.reduceat(y, first)
    below = np.where(y < top[edges.wall_of], y, -np.inf)
    drop = top - np.maximum(np.maximum.reduceat(below, first), -1e300)
    level = top - np.minimum(np.maximum(drop * 2.0**-20, least), drop / 2)
    a, b, at = edges.a, edges.b, level[edges.wall]
    crosses = (np.minimum(a[:, 1], b[:, 1]) <= at) & (at < np.maximum(a[:, 1], b[:, 1])) & ring[edges.wall]
    a, b, at, wall = a[crosses], b[crosses], at[crosses], edges.wall[crosses]
    x = a[:, 0] + (at - a[:, 1]) / (b[:, 1] - a[:, 1]) * (b[:, 0] - a[:, 0])
    order = np.lexsort((x, wall))
    x, wall = x[order], wall[order]
    new = np.flatnonzero(np.concatenate([[True], wall[1:] != wall[:-1]])) if len(wall) else np.empty(0, dtype=np.int64)
    new = new[new + 1 < len(wall)]
    result[wall[new], 0] = x[new] + (x[new + 1] - x[new]) * _FRACTION
    result[wall[new], 1] = level[wall[new]]
    return result


def _parents(
    edges: Edges,
    points: FloatArray,
    size: IntArray,
    surrounds: NDArray[np.bool_],
    copy_of: IntArray,
    group: IntArray | None,
) -> IntArray:
    """Look up from each point: (W,) parent or -1."""
    count = len(points)
    parent = np.full(count, -1, dtype=np.int64)
    beside = np.full(count, -1, dtype=np.int64)  # the ring next to it, whose parent is its parent
    looking = np.flatnonzero(copy_of == np.arange(count))
    if not len(edges) or not surrounds.any():
        return parent
    tops = np.maximum.reduceat(edges.vertices[:, 1], edges.offsets[:-1])
    ceiling = _ceiling(tops, surrounds, group)
    reached = np.zeros(count)
    reach = 2 * np.abs(tops - points[:, 1]) + 1e-9 * (edges.vertices[:, 1].max() - edges.vertices[:, 1].min())
    while len(looking):
        x, y = points[looking].T
        way = np.stack([x, y + reached[looking]]), np.stack([x, y + reach[looking]])
        hit, edge = edges.tree.meeting(*way)
        source = looking[hit]
        wall = edges.wall[edge]
        fits = surrounds[wall] & (size[wall] > size[source])
        if group is not None:
            fits &= group[wall] == group[source]
        found = _first_above(edges, points, reach, source[fits], edge[fits])
        _settle(edges, points, size, *found, parent, beside)
        done = np.zeros(count, dtype=np.bool_)
        done[found[0]] = True
        looking = looking[~done[looking] & (points[looking, 1] + reach[looking] < ceiling[looking])]
        reached[looking] = reach[looking]
        reach[looking] *= 4
    return _follow(parent, beside)


def _ceiling(tops: FloatArray, surrounds: NDArray[np.bool_], group: IntArray | None) -> FloatArray:
    """Above which no edge can be met: (W,)."""
    highest = np.where(surrounds, tops, -np.inf)
    if group is None:
        return np.full(len(tops), highest.max())
    by_group = np.full(int(group.max()) + 1, -np.inf)
    np.maximum.at(by_group, group, highest)
    return by_group[group]


def _first_above(
    edges: Edges, points: FloatArray, reach: FloatArray, source: IntArray, edge: IntArray
) -> tuple[IntArray, IntArray]:
    """Keep, for each source, the edges that are first met going up (more than one where they lie on each other)."""
    p, a, b = points[source], edges.starts_of(edge), edges.stops_of(edge)
    spans = (np.minimum(a[:, 0], b[:, 0]) <= p[:, 0]) & (p[:, 0] < np.maximum(a[:, 0], b[:, 0]))
    source, edge, p, a, b = source[spans], edge[spans], p[spans], a[spans], b[spans]
    slope = (b[:, 1] - a[:, 1]) / (b[:, 0] - a[:, 0])
    y = a[:, 1] + (p[:, 0] - a[:, 0]) * slope
    above = (y >= p[:, 1]) & (y <= p[:, 1] + reach[source])
    source, edge, slope, y = source[above], edge[above], slope[above], y[above]
    # edges on one line are met at heights that differ by rounding: a few ulp of the coordinates
    slack = 16 * np.finfo(float).eps * max(edges.size, 1.0)
    lowest = np.full(len(points), np.inf)
    np.minimum.at(lowest, source, y)
    tied = y <= lowest[source] + slack
    source, edge, slope = source[tied], edge[tied], slope[tied]
    flattest = np.full(len(points), np.inf)  # just right of p the edge with the least slope is the lowest
    np.minimum.at(flattest, source, slope)
    tied = slope <= flattest[source] + 1e-9 * (1 + np.abs(flattest[source]))
    return source[tied], edge[tied]


def _settle(
    edges: Edges,
    points: FloatArray,
    size: IntArray,
    source: IntArray,
    edge: IntArray,
    parent: IntArray,
    beside: IntArray,
) -> None:
    """Tell parent or neighbour from the first edges met: the smallest ring that is around, else the largest beside."""
    if not len(source):
        return
    area = edges.areas
    wall = edges.wall[edge]
    # the left of an edge that goes leftward, where the solid is, is below
    leftward = edges.stops_of(edge)[:, 0] < edges.starts_of(edge)[:, 0]
    around = leftward == (area[wall] > 0)
    order = np.argsort(-size[wall], kind="stable")
    inside = order[around[order]]
    parent[source[inside]] = wall[inside]  # the last written is the smallest
    outside = order[::-1][~around[order[::-1]]]
    beside[source[outside]] = wall[outside]  # the last written is the largest
    beside[source[inside]] = -1


def _follow(parent: IntArray, beside: IntArray) -> IntArray:
    """Give each ring the parent of the last ring in its chain of neighbours, doubling the steps."""
    link = np.where(beside >= 0, beside, np.arange(len(beside)))
    while True:
        further = link[link]
        if (further == link).all():
            return parent[link]
        link = further


def _levels(parent: IntArray) -> IntArray:
    """Count ancestors, doubling the steps."""
    depth = (parent >= 0).astype(np.int64)
    link = parent.copy()
    while (link >= 0).any():
        up = link >= 0
        depth[up] += depth[link[up]]
        further = link.copy()
        further[up] = link[link[up]]
        link = further
    return depth


def _distinct(pairs: IntArray, count: int) -> IntArray:
    """Each pair once, the smaller first."""
    keys = distinct(pairs.min(axis=1) * count + pairs.max(axis=1))
    return np.stack([keys // count, keys % count], axis=1)


def _tangled_around(
    edges: Edges,
    points: FloatArray,
    size: IntArray,
    tangled: NDArray[np.bool_],
    crossing: IntArray,
    whole: IntArray,
    group: IntArray | None,
) -> IntArray:
    """Count, for each wall, the rings among ``tangled`` that are around its point, are larger and do not cross it.

    A ring is around a point when it is met an odd number of times straight above it.
    """
    count = len(points)
    result = np.zeros(count, dtype=np.int64)
    keys = crossing.min(axis=1) * count + crossing.max(axis=1)
    rows = np.flatnonzero(tangled[edges.wall])
    tree = EdgeTree(edges, rows)
    top = float(edges.vertices[:, 1].max()) + 1
    portion = max(_PAIRS_AT_ONCE // len(rows), 1)
    for begin in range(0, count, portion):
        x, y = points[begin : begin + portion].T
        source, edge = tree.meeting(np.stack([x, y]), np.stack([x, np.maximum(y, top)]))
        source = source + begin
        p, a, b = points[source], edges.a[edge], edges.b[edge]
        spans = (np.minimum(a[:, 0], b[:, 0]) <= p[:, 0]) & (p[:, 0] < np.maximum(a[:, 0], b[:, 0]))
        source, edge, p, a, b = source[spans], edge[spans], p[spans], a[spans], b[spans]
        height = a[:, 1] + (p[:, 0] - a[:, 0]) / (b[:, 0] - a[:, 0]) * (b[:, 1] - a[:, 1])
        above = height > p[:, 1]
        met, times = np.unique(source[above] * count + edges.wall[edge[above]], return_counts=True)
        inner, outer = np.divmod(met[times % 2 == 1], count)
        one, two = whole[inner], whole[outer]
        fits = (size[outer] > size[inner]) & ~np.isin(np.minimum(one, two) * count + np.maximum(one, two), keys)
        if group is not None:
            fits &= group[outer] == group[inner]
        result += np.bincount(inner[fits], minlength=count)
    return result
