"""A Delaunay triangulation of wall vertices that has every wall edge among its edges, cut where need be."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from wallkit.walls.strokes import FloatArray, IntArray

MOST_POINTS = 600_000
_ROUNDS = 40
_TIES = 6  # rounds for points on one circle, whose triangles are a matter of taste
_FRAME = 4.0  # the frame around everything, in diagonals: far enough to count as outside


@dataclass(slots=True)
class Triangulation:
    """Triangles of points, the walls among their edges.

    Attributes:
        points: (P, 2); the last four are the frame.
        corners: (T, 3) points of each triangle.
        neighbours: (T, 3) the triangle opposite each corner, or -1.
        edge: (T, 3) number of the edge opposite each corner.
        ends: (N, 2) points of each edge, the smaller number first.
        wall: (N,) the edge is a piece of a wall.
        outer: (N,) the edge is on the frame.
        complete: every piece of a wall is an edge.
    """

    points: FloatArray
    corners: IntArray
    neighbours: IntArray
    edge: IntArray
    ends: IntArray
    wall: NDArray[np.bool_]
    outer: NDArray[np.bool_]
    complete: bool


def triangulate(a: FloatArray, b: FloatArray) -> Triangulation:
    """Triangulate segments from ``a`` to ``b``, (n, 2) each, that meet at their ends only.

    A segment is an edge of the triangulation when the circle over it is empty. A point in the circle cuts the
    segment: at its foot; but at its own distance from the shared end when a segment leads from there to it, since
    cuts at feet would chase each other into the corner for ever (J. Ruppert, A Delaunay refinement algorithm,
    1995, on small angles).
    """
    from scipy.spatial import Delaunay  # late: scipy is slow to import

    points, which = np.unique(np.concatenate([a, b]), axis=0, return_inverse=True)
    segments = np.sort(which.reshape(-1).reshape(2, -1).T, axis=1)
    segments = np.unique(segments[segments[:, 0] != segments[:, 1]], axis=0)
    low, high = points.min(axis=0), points.max(axis=0)
    origin, size = (low + high) / 2, float(np.hypot(*(high - low))) or 1.0
    points = points - origin
    frame = _FRAME * size * np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]])
    for _ in range(_TIES):
        points, segments, complete = _conform(points, segments, 1e-7 * size)
        everything = np.concatenate([points, frame])
        found = Delaunay(everything)
        corners = found.simplices.astype(np.int64)
        count = len(everything)
        sides = np.sort(np.stack([corners[:, [1, 2]], corners[:, [2, 0]], corners[:, [0, 1]]], axis=1), axis=2)
        keys, edge = np.unique(sides[..., 0] * count + sides[..., 1], return_inverse=True)
        walls = segments.min(axis=1) * count + segments.max(axis=1)
        missing = ~np.isin(walls, keys)
        if not complete or not missing.any():
            break
        # four points on one circle: the other diagonal was taken, so the wall gets a point in its middle
        cut, number = segments[missing], len(points) + np.arange(int(missing.sum()))
        points = np.concatenate([points, points[cut].mean(axis=1)])
        halves = [np.stack([cut[:, 0], number], axis=1), np.stack([cut[:, 1], number], axis=1)]
        segments = np.concatenate([segments[~missing], *halves])
    neighbours = found.neighbors.astype(np.int64)
    edge = edge.reshape(-1, 3)
    outer = np.zeros(len(keys), dtype=np.bool_)
    outer[edge[neighbours < 0]] = True
    ends = np.stack(np.divmod(keys, count), axis=1)
    complete = complete and not missing.any()
    return Triangulation(everything + origin, corners, neighbours, edge, ends, np.isin(keys, walls), outer, complete)


def _conform(points: FloatArray, segments: IntArray, shortest: float) -> tuple[FloatArray, IntArray, bool]:
    """Cut segments until no point lies in the circle over one of them."""
    from scipy.spatial import cKDTree

    for _ in range(_ROUNDS):
        p, q = points[segments[:, 0]], points[segments[:, 1]]
        middle, half = (p + q) / 2, np.hypot(*(q - p).T) / 2
        distance, nearest = cKDTree(points).query(middle, k=min(3, len(points)))
        own = (nearest == segments[:, :1]) | (nearest == segments[:, 1:])
        distance = np.where(own, np.inf, distance)
        column = distance.argmin(axis=1)
        rows = np.arange(len(segments))
        inside = (distance[rows, column] < half * (1 - 1e-9)) & (half > shortest)
        if not inside.any():
            return points, segments, True
        cut = segments[inside]
        if len(points) + len(cut) > MOST_POINTS:
            break
        new = _cut_points(points, segments, cut, nearest[rows, column][inside])
        number = len(points) + np.arange(len(cut))
        points = np.concatenate([points, new])
        halves = [np.stack([cut[:, 0], number], axis=1), np.stack([cut[:, 1], number], axis=1)]
        segments = np.concatenate([segments[~inside], *halves])
    return points, segments, False


def _cut_points(points: FloatArray, segments: IntArray, cut: IntArray, intruder: IntArray) -> FloatArray:
    """Where to cut each segment: the intruder's foot, or its distance from a shared end."""
    count = len(points)
    known = np.sort(segments, axis=1)
    keys = known[:, 0] * count + known[:, 1]
    p, q, v = points[cut[:, 0]], points[cut[:, 1]], points[intruder]
    d = q - p
    length = np.hypot(d[:, 0], d[:, 1])
    part = ((v - p) * d).sum(axis=1) / (length * length)
    for end, towards in ((0, 1.0), (1, -1.0)):
        pair = np.sort(np.stack([cut[:, end], intruder], axis=1), axis=1)
        joined = np.isin(pair[:, 0] * count + pair[:, 1], keys)
        far = np.hypot(*(v - points[cut[:, end]]).T) / length
        part = np.where(joined & (far < 1), far if towards > 0 else 1 - far, part)
    cut_at: FloatArray = p + d * np.clip(part, 0.05, 0.95)[:, None]
    return cut_at
