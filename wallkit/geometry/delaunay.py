"""The Delaunay triangulation of points: GEOS's, mended where rounding made it none."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import shapely
from numpy.typing import NDArray

from wallkit.geometry.arrays import FloatArray, IntArray
from wallkit.geometry.orientation import side

_TURNS = 40  # rounds of taking the other diagonal; four or so are enough
SURE = 2.0**-46
"""Of the product of four lengths: so far beyond a half turn, rounding is not what makes two angles so."""


def delaunay(points: FloatArray) -> IntArray:
    """The corners of the Delaunay triangles of points that are all different: (T, 3).

    By GEOS, which takes many points on one circle or line as they come. Where points are nearly on one line, as feet
    on a wall are, some of its triangles have others in their circles: those edges are turned until none has (C. L.
    Lawson, Software for C1 surface interpolation, 1977).
    """
    rings = shapely.get_coordinates(shapely.get_parts(shapely.delaunay_triangles(shapely.multipoints(points))))
    z = points[:, 0] + 1j * points[:, 1]
    order = np.argsort(z)
    found = rings.reshape(-1, 4, 2)[:, :3]
    corners: IntArray = order[np.searchsorted(z, found[..., 0] + 1j * found[..., 1], sorter=order)]
    for _ in range(_TURNS):
        inner = _Inner.of(corners, len(points))
        wrong = inner.sees_too_much(points)
        turned = inner.turned(corners, points, wrong) if wrong.any() else None
        if turned is None:
            break
        corners = turned
    return corners


@dataclass(slots=True)
class _Inner:
    """Edges between two triangles, arrays of one length.

    Attributes:
        one: the first triangle, times 3, and which of its corners is opposite.
        two: the same of the second.
        p: an end.
        q: the other end.
        apex: the corner of the first triangle that is opposite.
        opposite: that of the second.
    """

    one: IntArray
    two: IntArray
    p: IntArray
    q: IntArray
    apex: IntArray
    opposite: IntArray

    @classmethod
    def of(cls, corners: IntArray, count: int) -> _Inner:
        sides = np.stack([corners[:, [1, 2]], corners[:, [2, 0]], corners[:, [0, 1]]], axis=1).reshape(-1, 2)
        keys = edge_keys(sides, count)
        order = np.argsort(keys, kind="stable")
        same = np.flatnonzero(keys[order][1:] == keys[order][:-1])
        one, two = order[same], order[same + 1]
        p, q = sides[one].T
        return cls(one, two, p, q, corners.ravel()[one], corners.ravel()[two])

    def sees_too_much(self, points: FloatArray) -> NDArray[np.bool_]:
        """Tell where the two angles that see an edge are more than a half turn: the circles hold each other's corner.

        sin(a + b) = sin a cos b + cos a sin b < 0, from cross and dot products, off by some 2^-50 of the lengths.
        """
        p, q = points[self.p], points[self.q]
        (sine, cosine, size), (other_sine, other_cosine, other_size) = (
            _angle(p - points[seen], q - points[seen]) for seen in (self.apex, self.opposite)
        )
        wrong: NDArray[np.bool_] = sine * other_cosine + cosine * other_sine < -SURE * size * other_size
        return wrong

    def turned(self, corners: IntArray, points: FloatArray, wanted: NDArray[np.bool_]) -> IntArray | None:
        """Take the other diagonal where that is wanted and can be, each triangle once; None where there is none."""
        one, two, p, q, apex, opposite = (
            part[wanted] for part in (self.one, self.two, self.p, self.q, self.apex, self.opposite)
        )
        convex = side(points[apex], points[opposite], points[p]) * side(points[apex], points[opposite], points[q]) < 0
        t = np.stack([one // 3, two // 3], axis=1)[convex]
        first = np.full(len(corners), len(t))
        np.minimum.at(first, t.ravel(), np.repeat(np.arange(len(t)), 2))
        alone = (first[t] == np.arange(len(t))[:, None]).all(axis=1)
        if not alone.any():
            return None
        rows = np.flatnonzero(convex)[alone]
        corners = corners.copy()
        corners[t[alone, 0]] = np.stack([apex[rows], opposite[rows], p[rows]], axis=1)
        corners[t[alone, 1]] = np.stack([opposite[rows], apex[rows], q[rows]], axis=1)
        return corners


def _angle(u: FloatArray, v: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Sine and cosine of the angle between vectors, times their lengths, and the product of these."""
    size = np.hypot(*u.T) * np.hypot(*v.T)
    return np.abs(u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]), (u * v).sum(axis=1), size


def edge_keys(pairs: IntArray, count: int) -> IntArray:
    """One number for each pair of points of so many, whatever its order."""
    keys: IntArray = pairs.min(axis=1) * count + pairs.max(axis=1)
    return keys
