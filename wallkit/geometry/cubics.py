"""Cubic Bezier curves: values, cuts, how far they lie from their chords."""

from __future__ import annotations

import numpy as np

from wallkit.geometry.arrays import FloatArray


def evaluate(cubics: FloatArray, t: FloatArray) -> FloatArray:
    """Give the point of each cubic at its t: (n, 4, 2) and (n,) to (n, 2)."""
    s, t = (1 - t)[:, None], t[:, None]
    p0, p1, p2, p3 = (cubics[:, i] for i in range(4))
    return s * s * s * p0 + 3 * s * s * t * p1 + 3 * s * t * t * p2 + t * t * t * p3


def split(cubics: FloatArray, t: FloatArray | float = 0.5) -> tuple[FloatArray, FloatArray]:
    """Cut cubics (n, 4, 2) at t by de Casteljau: the two halves."""
    t = np.broadcast_to(np.asarray(t, dtype=np.float64), len(cubics))[:, None, None]
    first = cubics[:, :-1] + (cubics[:, 1:] - cubics[:, :-1]) * t
    second = first[:, :-1] + (first[:, 1:] - first[:, :-1]) * t
    third = second[:, :-1] + (second[:, 1:] - second[:, :-1]) * t
    left = np.concatenate([cubics[:, :1], first[:, :1], second[:, :1], third], axis=1)
    right = np.concatenate([third, second[:, 1:], first[:, 2:], cubics[:, 3:]], axis=1)
    return left, right


def cut_between(cubics: FloatArray, low: FloatArray, high: FloatArray) -> FloatArray:
    """Give the piece of each cubic from t = low to t = high, as a cubic (blossoming; exact up to rounding)."""
    lo, hi = low[:, None], high[:, None]
    p = [cubics[:, i] for i in range(4)]

    def blossom(a: FloatArray, b: FloatArray, c: FloatArray) -> FloatArray:
        q = [p[i] + (p[i + 1] - p[i]) * a for i in range(3)]
        r = [q[i] + (q[i + 1] - q[i]) * b for i in range(2)]
        return r[0] + (r[1] - r[0]) * c

    return np.stack([blossom(lo, lo, lo), blossom(lo, lo, hi), blossom(lo, hi, hi), blossom(hi, hi, hi)], axis=1)


def chord_bound(cubics: FloatArray) -> FloatArray:
    """Bound the distance between each cubic and its chord (the module's first paragraph): (n,)."""
    chord = cubics[:, 3] - cubics[:, 0]
    length = np.hypot(chord[:, 0], chord[:, 1])
    arms = cubics[:, 1:3] - cubics[:, :1]
    safe = np.where(length > 0, length, 1.0)[:, None]
    across = (chord[:, None, 0] * arms[..., 1] - chord[:, None, 1] * arms[..., 0]) / safe
    along = (chord[:, None, 0] * arms[..., 0] + chord[:, None, 1] * arms[..., 1]) / safe
    beyond = np.maximum(np.maximum(-along, along - length[:, None]), 0.0)
    hull = 0.75 * np.hypot(across, beyond).max(axis=1)
    hull = np.where(length > 0, hull, 0.75 * np.hypot(arms[..., 0], arms[..., 1]).max(axis=1))
    exact: FloatArray = np.abs(_heights(across[:, 0], across[:, 1])).max(axis=0)
    bound: FloatArray = np.where((length > 0) & (beyond.max(axis=1) == 0), exact, hull)
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
