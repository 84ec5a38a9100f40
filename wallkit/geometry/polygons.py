"""Polygons of straight edges: which points they go around."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from wallkit.geometry.arrays import FloatArray


def contains(ring: FloatArray, points: FloatArray) -> NDArray[np.bool_]:
    """Tell for each of (n, 2) points whether a closed ring of points goes around it (even-odd)."""
    low, high = ring.min(axis=0), ring.max(axis=0)
    near = np.flatnonzero(((points >= low) & (points <= high)).all(axis=1))
    result = np.zeros(len(points), dtype=np.bool_)
    a, b = ring, np.roll(ring, -1, axis=0)
    rise = b[:, 1] - a[:, 1]
    slope = np.divide(b[:, 0] - a[:, 0], rise, out=np.zeros_like(rise), where=rise != 0)
    for index in near:
        x, y = points[index]
        spans = (a[:, 1] > y) != (b[:, 1] > y)
        crossings = np.count_nonzero(spans & (a[:, 0] + (y - a[:, 1]) * slope > x))
        result[index] = crossings % 2 == 1
    return result
