"""The room in each triangle of free space: a circle around a place in it, as far as the nearest wall."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from wallkit.geometry.arrays import FloatArray, IntArray
from wallkit.geometry.ragged import slices
from wallkit.geometry.triangulation import Triangulation
from wallkit.walls.checking.wall_distance import wall_distance

_AT_ONCE = 1 << 14  # triangles whose circles are looked at together: bounds the memory
TOO_SMALL = 1.5
"""Times the radius of a circle in a triangle: a larger one may be found above it."""


def triangle_circles(mesh: Triangulation, least: float, where: NDArray[np.bool_]) -> tuple[FloatArray, FloatArray]:
    """Give radius and centre of the roomier of two circles of each triangle, (T,) and (T, 2).

    The centres are that of the circle through the corners, if it is inside, and that of the inscribed one. The radius
    is 0 where the circle is not asked for: beside the frame, outside of the triangles ``where`` (T,), where it is no
    larger than ``least``, and where a disc as large as it could be gets over an edge into a triangle with a larger one,
    which is the room then.
    """
    size, place = np.zeros(len(mesh.corners)), mesh.points[mesh.corners].mean(axis=1)
    if not where.any():
        return size, place
    parts = [_candidates(mesh, mesh.corners[some]) for some in slices(len(size), _AT_ONCE)]
    centres, most = (np.concatenate([part[k] for part in parts], axis=1) for k in (0, 1))
    bound: FloatArray = np.where(where & (mesh.corners < len(mesh.points) - 4).all(axis=1), most.max(axis=0), 0.0)
    known = bound.copy()
    asked = np.zeros(len(bound), dtype=np.bool_)
    asked[bound <= least] = True
    while True:  # a circle that comes out smaller than it could be is no larger one to its neighbours
        rows = np.flatnonzero(~asked & ~_beside_larger(mesh, bound, known))
        if not len(rows):
            return size, place
        asked[rows] = True
        for centre, limit in zip(centres, most, strict=True):
            some = rows[limit[rows] > size[rows]]
            distance = wall_distance(mesh, some, centre[some])
            some, distance = some[distance > size[some]], distance[distance > size[some]]
            size[some], place[some] = distance, centre[some]
        known[rows] = size[rows]


def _beside_larger(mesh: Triangulation, bound: FloatArray, known: FloatArray) -> NDArray[np.bool_]:
    """Tell from which triangles a disc as large as their bound gets over an edge to a larger circle: (T,)."""
    passes = ~mesh.wall[mesh.edge] & (mesh.length[mesh.edge] > 2 * bound[:, None]) & (mesh.neighbours >= 0)
    larger: NDArray[np.bool_] = (passes & (known[mesh.neighbours] > bound[:, None])).sum(axis=1) > 0
    return larger


def _candidates(mesh: Triangulation, corners: IntArray) -> tuple[FloatArray, FloatArray]:
    """Two centres (2, n, 2) for some triangles, and how far they are (2, n) from the nearest corner, so from a wall.

    One is the centre of the circle around the triangle, if inside, the other that of the circle in it.
    """
    p, q, r = (mesh.points[corner] for corner in corners.T)
    centres = _centres(p, q, r)
    far = (np.hypot(*(centres - corner).transpose(2, 0, 1)) for corner in (p, q, r))
    nearest: FloatArray = np.minimum(np.minimum(next(far), next(far)), next(far))
    return centres, nearest


def _centres(p: FloatArray, q: FloatArray, r: FloatArray) -> FloatArray:
    u, v = q - p, r - p
    double = 2 * (u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0])
    uu, vv, ww = (u * u).sum(axis=1), (v * v).sum(axis=1), ((r - q) ** 2).sum(axis=1)
    sides = np.sqrt(np.stack([ww, vv, uu], axis=1))
    inner = (sides[:, :1] * p + sides[:, 1:2] * q + sides[:, 2:] * r) / np.maximum(sides.sum(axis=1), 1e-300)[:, None]
    with np.errstate(divide="ignore", invalid="ignore"):
        around = p + np.stack([v[:, 1] * uu - u[:, 1] * vv, u[:, 0] * vv - v[:, 0] * uu], axis=1) / double[:, None]
    largest = np.sort(np.stack([uu, vv, ww], axis=1), axis=1)
    acute = (largest[:, 2] <= (largest[:, 0] + largest[:, 1]) * (1 + 1e-9)) & np.isfinite(around).all(axis=1)
    around = np.where(acute[:, None], around, inner)
    for a, b in ((p, q), (q, r), (r, p)):  # of a needle the centre is anywhere, by rounding
        (x, y), (s, t) = (b - a).T, (around - a).T
        acute &= x * t - y * s >= -1e-9 * (x * x + y * y)
    return np.stack([np.where(acute[:, None], around, inner), inner])
