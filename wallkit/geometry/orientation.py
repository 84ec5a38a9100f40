"""On which side of a line a point lies: exact for the numbers as given (unless products underflow), vectorised.

det = (ax - cx)(by - cy) - (ay - cy)(bx - cx) in floating point has the right sign where
|det| > (3 + 16 u) u (|l| + |r|), u = 2^-53 (J. R. Shewchuk, Adaptive Precision Floating-Point Arithmetic and Fast
Robust Geometric Predicates, 1997). Those that fail are computed exactly: each difference and product is split
into two floats without error, and ``math.fsum`` rounds their sum only once.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from wallkit.geometry.arrays import FloatArray
from wallkit.geometry.double_double import two_difference, two_product

_BOUND = (3 + 16 * 2.0**-53) * 2.0**-53
"""Of |l| + |r|: a determinant l - r that is beyond has the right sign."""
_CIRCLE_BOUND = (10 + 96 * 2.0**-53) * 2.0**-53
_Place = tuple[float, float]


def side(a: FloatArray, b: FloatArray, c: FloatArray) -> NDArray[np.int8]:
    """1 where c is left of the line from a to b (y up), -1 where right, 0 where on it; each (n, 2)."""
    left = (a[:, 0] - c[:, 0]) * (b[:, 1] - c[:, 1])
    right = (a[:, 1] - c[:, 1]) * (b[:, 0] - c[:, 0])
    det = left - right
    sign = np.sign(det).astype(np.int8)
    unsure = np.flatnonzero(np.abs(det) < _BOUND * (np.abs(left) + np.abs(right)))
    if len(unsure):
        sign[unsure] = _closer(a[unsure], b[unsure], c[unsure])
    return sign


def side_of(a: _Place, b: _Place, c: _Place) -> int:
    """As :func:`side` of one point, which takes an array of one twenty times as long."""
    left, right = (a[0] - c[0]) * (b[1] - c[1]), (a[1] - c[1]) * (b[0] - c[0])
    det = left - right
    if abs(det) >= _BOUND * (abs(left) + abs(right)):
        return (det > 0) - (det < 0)
    return _exact_side(a, b, c)


def in_circle(a: _Place, b: _Place, c: _Place, d: _Place) -> int:
    """1 where d is in the circle through a, b and c, counter-clockwise with y up; -1 where outside, 0 where on it.

    |ax ay ax^2+ay^2; bx ..; cx ..|, all less d, has the right sign where it is more than (10 + 96 u) u times the same
    with absolute values (Shewchuk); else it is computed in fractions.
    """
    ax, ay, bx, by, cx, cy = a[0] - d[0], a[1] - d[1], b[0] - d[0], b[1] - d[1], c[0] - d[0], c[1] - d[1]
    p, q, r = ax * ax + ay * ay, bx * bx + by * by, cx * cx + cy * cy
    det = p * (bx * cy - cx * by) + q * (cx * ay - ax * cy) + r * (ax * by - bx * ay)
    most = p * (abs(bx * cy) + abs(cx * by)) + q * (abs(cx * ay) + abs(ax * cy)) + r * (abs(ax * by) + abs(bx * ay))
    if abs(det) > _CIRCLE_BOUND * most:
        return (det > 0) - (det < 0)
    from fractions import Fraction  # late: it is rarely asked for

    dx, dy = Fraction(d[0]), Fraction(d[1])
    rows = [(Fraction(x) - dx, Fraction(y) - dy) for x, y in (a, b, c)]
    (px, py, p2), (qx, qy, q2), (rx, ry, r2) = ((x, y, x * x + y * y) for x, y in rows)
    exact = p2 * (qx * ry - rx * qy) + q2 * (rx * py - px * ry) + r2 * (px * qy - qx * py)
    return (exact > 0) - (exact < 0)


def _exact_side(a: _Place, b: _Place, c: _Place) -> int:
    ax, ay = two_difference(a[0], c[0]), two_difference(a[1], c[1])
    bx, by = two_difference(b[0], c[0]), two_difference(b[1], c[1])
    terms = [part for p in ax for q in by for part in two_product(p, q)]
    total = math.fsum(terms + [-part for p in ay for q in bx for part in two_product(p, q)])
    return (total > 0) - (total < 0)


def _closer(a: FloatArray, b: FloatArray, c: FloatArray) -> NDArray[np.int8]:
    """Exact with two floats a number where that is enough (whole numbers, tidy drawings), else by the full sum."""
    ax, ay = two_difference(a[:, 0], c[:, 0]), two_difference(a[:, 1], c[:, 1])
    bx, by = two_difference(b[:, 0], c[:, 0]), two_difference(b[:, 1], c[:, 1])
    left, right = two_product(ax[0], by[0]), two_product(ay[0], bx[0])
    high, low = two_difference(left[0], right[0]), two_difference(left[1], right[1])
    sign = np.sign(high[0] + low[0]).astype(np.int8)
    lost = (ax[1] != 0) | (ay[1] != 0) | (bx[1] != 0) | (by[1] != 0) | (high[1] != 0) | (low[1] != 0)
    rest = np.flatnonzero(lost)
    if len(rest):
        sign[rest] = _exact(a[rest], b[rest], c[rest])
    return sign


def _exact(a: FloatArray, b: FloatArray, c: FloatArray) -> NDArray[np.int8]:
    ax, ay = two_difference(a[:, 0], c[:, 0]), two_difference(a[:, 1], c[:, 1])
    bx, by = two_difference(b[:, 0], c[:, 0]), two_difference(b[:, 1], c[:, 1])
    terms = [part for p in ax for q in by for part in two_product(p, q)]
    terms += [-part for p in ay for q in bx for part in two_product(p, q)]
    rows = np.stack(terms, axis=1).tolist()
    return np.array([math.copysign(1, total) if (total := math.fsum(row)) else 0 for row in rows], dtype=np.int8)
