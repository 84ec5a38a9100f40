"""Straight segments: their nearest points, and distances from points."""

from __future__ import annotations

import numpy as np

from wallkit.geometry.arrays import FloatArray


def foot_part(along: FloatArray, square: FloatArray) -> FloatArray:
    """Where on a segment d its point nearest to another one w is, 0 to 1: from w.d and d.d; 0 where d has no length."""
    part: FloatArray = np.clip(along / np.where(square > 0, square, 1.0), 0.0, 1.0)
    return part


def segment_distance(p: FloatArray, a: FloatArray, b: FloatArray) -> FloatArray:
    """Distance of points p from segments a to b, each (n, 2) or one of them (2,): (n,)."""
    d, w = b - a, p - a
    square = d[..., 0] ** 2 + d[..., 1] ** 2
    t = foot_part(w[..., 0] * d[..., 0] + w[..., 1] * d[..., 1], square)
    return np.hypot(w[..., 0] - t * d[..., 0], w[..., 1] - t * d[..., 1])
