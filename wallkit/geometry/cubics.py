"""Cubic Bezier curves: values, cuts, how far they lie from their chords."""

from __future__ import annotations

import numpy as np

from wallkit.geometry.arrays import FloatArray, IntArray


def evaluate(cubics: FloatArray, t: FloatArray) -> FloatArray:
    """Give the point of each cubic at its t: (n, 4, 2) and (n,) to (n, 2)."""
    s = 1 - t
    w0, w1, w2, w3 = s * s * s, 3 * s * s * t, 3 * s * t * t, t * t * t
    points = np.empty((len(cubics), 2))
    for axis in (0, 1):
        p0, p1, p2, p3 = (cubics[:, i, axis] for i in range(4))
        points[:, axis] = w0 * p0 + w1 * p1 + w2 * p2 + w3 * p3
    return points


def split(cubics: FloatArray, t: FloatArray | float = 0.5) -> tuple[FloatArray, FloatArray]:
    """Cut cubics (n, 4, 2) at t by de Casteljau: the two halves."""
    left, right = _by_columns(len(cubics)), _by_columns(len(cubics))
    for axis in (0, 1):
        p0, p1, p2, p3 = (cubics[:, i, axis] for i in range(4))
        a, b, c = p0 + (p1 - p0) * t, p1 + (p2 - p1) * t, p2 + (p3 - p2) * t
        d, e = a + (b - a) * t, b + (c - b) * t
        middle = d + (e - d) * t
        for i, column in enumerate((p0, a, d, middle)):
            left[:, i, axis] = column
        for i, column in enumerate((middle, e, c, p3)):
            right[:, i, axis] = column
    return left, right


def _by_columns(count: int) -> FloatArray:
    """Give an empty array (count, 4, 2) of which each coordinate of each control point lies in one piece of memory."""
    return np.moveaxis(np.empty((4, 2, count)), -1, 0)


def by_columns(cubics: FloatArray) -> FloatArray:
    """Give the same cubics (n, 4, 2), each coordinate of each control point in one piece of memory."""
    return np.moveaxis(np.ascontiguousarray(np.moveaxis(cubics, 0, -1)), -1, 0)


def chosen(cubics: FloatArray, rows: IntArray) -> FloatArray:
    """Give the cubics ``rows`` of some that lie by columns, by columns again."""
    return np.moveaxis(np.moveaxis(cubics, 0, -1).take(rows, axis=-1), -1, 0)


def cut_between(cubics: FloatArray, low: FloatArray, high: FloatArray) -> FloatArray:
    """Give the piece of each cubic from t = low to t = high, as a cubic (blossoming; exact up to rounding)."""
    piece = _by_columns(len(cubics))
    for axis in (0, 1):
        p = [cubics[:, i, axis] for i in range(4)]
        first = {end: [p[i] + (p[i + 1] - p[i]) * at for i in range(3)] for end, at in (("low", low), ("high", high))}
        for i, (start, b, c) in enumerate((("low", low, low), ("low", low, high), ("low", high, high))):
            piece[:, i, axis] = _blossom(first[start], b, c)
        piece[:, 3, axis] = _blossom(first["high"], high, high)
    return piece


def _blossom(q: list[FloatArray], b: FloatArray, c: FloatArray) -> FloatArray:
    r = [q[i] + (q[i + 1] - q[i]) * b for i in range(2)]
    return r[0] + (r[1] - r[0]) * c


def chord_bound(cubics: FloatArray) -> FloatArray:
    """Bound the distance between each cubic and its chord (the module's first paragraph): (n,)."""
    x0, y0 = cubics[:, 0, 0], cubics[:, 0, 1]
    x, y = cubics[:, 3, 0] - x0, cubics[:, 3, 1] - y0
    length = np.hypot(x, y)
    there = length > 0
    safe = np.where(there, length, 1.0)
    arms = [(cubics[:, i, 0] - x0, cubics[:, i, 1] - y0) for i in (1, 2)]
    across = [(x * v - y * u) / safe for u, v in arms]
    along = [(x * u + y * v) / safe for u, v in arms]
    beyond = [np.maximum(np.maximum(-part, part - length), 0.0) for part in along]
    bound: FloatArray = np.abs(_heights(*across)).max(axis=0)
    rest = np.flatnonzero(there & ((beyond[0] != 0) | (beyond[1] != 0)))
    bound[rest] = 0.75 * np.maximum(*(np.hypot(a[rest], b[rest]) for a, b in zip(across, beyond, strict=True)))
    rest = np.flatnonzero(~there)
    bound[rest] = 0.75 * np.maximum(*(np.hypot(u[rest], v[rest]) for u, v in arms))
    return bound


def _heights(d1: FloatArray, d2: FloatArray) -> FloatArray:
    """The extreme values of 3 t (1-t) ((1-t) d1 + t d2) on [0, 1]: (2, n), 0 where there is no root inside.

    f'/3 = 3 (d1 - d2) t^2 + 2 (d2 - 2 d1) t + d1; the roots by the form without cancellation.
    """
    a, b, c = 3 * (d1 - d2), d2 - 2 * d1, d1  # a t^2 + 2 b t + c
    q = -(b + np.copysign(np.sqrt(np.maximum(b * b - a * c, 0.0)), b))
    with np.errstate(divide="ignore", invalid="ignore"):
        t = np.stack([q / a, c / q])
    t = np.where((t > 0) & (t < 1), t, 0.0)  # also turns the nan of 0 / 0 into 0
    heights: FloatArray = 3 * t * (1 - t) * ((1 - t) * d1 + t * d2)
    return heights


def extreme_parameters(d1: FloatArray, d2: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Where 3 t (1-t) ((1-t) d1 + t d2) is extreme; 1/2 where that is nowhere inside."""
    a, b, c = 3 * (d1 - d2), d2 - 2 * d1, d1
    q = -(b + np.copysign(np.sqrt(np.maximum(b * b - a * c, 0.0)), b))
    with np.errstate(divide="ignore", invalid="ignore"):
        one, two = q / a, c / q
    return np.where((one > 0) & (one < 1), one, 0.5), np.where((two > 0) & (two < 1), two, 0.5)
