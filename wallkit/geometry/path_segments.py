"""Segments of path data (lines, Bezier curves, elliptic arcs) as short chords, for what is looked at."""

from __future__ import annotations

import math

import numpy as np

from wallkit.geometry.arrays import FloatArray

_CURVE = 24  # chords a Bezier curve, half as many as an arc of a drawing


def chords(start: FloatArray, kind: str, numbers: tuple[float, ...]) -> FloatArray:
    """Sample one segment of path data (L, Q, C or A, absolute) from ``start``, its end included and start not."""
    end = np.array(numbers[-2:], dtype=np.float64)
    t: FloatArray = np.linspace(0.0, 1.0, _CURVE + 1)[1:, None]
    if kind == "Q":
        return np.asarray((1 - t) ** 2 * start + 2 * t * (1 - t) * np.array(numbers[:2]) + t * t * end)
    if kind == "C":
        first, second = np.array(numbers[:2]), np.array(numbers[2:4])
        outer = (1 - t) ** 3 * start + t**3 * end
        return np.asarray(outer + 3 * t * (1 - t) ** 2 * first + 3 * t * t * (1 - t) * second)
    if kind == "A":
        return _arc(start, numbers)
    return end[None, :]


def _arc(start: FloatArray, numbers: tuple[float, ...]) -> FloatArray:
    """Sample an elliptic arc in end-point form by its centre (SVG specification, appendix B.2.4), end included."""
    rx, ry, rotation, large, sweep, *rest = numbers
    end = np.array(rest, dtype=np.float64)
    phi = math.radians(rotation)
    turn = np.array([[math.cos(phi), math.sin(phi)], [-math.sin(phi), math.cos(phi)]])
    if not rx or not ry:
        return end[None, :]
    half = turn @ ((start - end) / 2) / (rx, ry)
    square = float(half @ half)
    arm = math.sqrt(max(0.0, 1.0 - square) / square) if square else 0.0
    centre = (arm if large != sweep else -arm) * np.array([half[1], -half[0]])
    first, last = (math.atan2(point[1], point[0]) for point in (half - centre, -half - centre))
    span = last - first
    if sweep and span <= 0:
        span += math.tau
    elif not sweep and span >= 0:
        span -= math.tau
    angles = first + span * np.linspace(0.0, 1.0, 2 * _CURVE + 1)[1:]
    points: FloatArray = ((np.stack([np.cos(angles), np.sin(angles)], axis=1) + centre) * (rx, ry)) @ turn
    points = points + (start + end) / 2
    points[-1] = end
    return points
