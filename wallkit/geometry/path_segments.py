"""Segments of path data (lines, Bezier curves, elliptic arcs) as short chords, for what is looked at."""

from __future__ import annotations

import numpy as np

from wallkit.geometry.arrays import FloatArray
from wallkit.geometry.ellipse_arcs import centre_form

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
    """Sample an elliptic arc in end-point form, end included; a line where it has no radius."""
    rx, ry, rotation, large, sweep, x, y = numbers
    if not rx or not ry:
        return np.array([[x, y]])
    arc = centre_form(np.array([[*start.tolist(), rx, ry, rotation, large, sweep, x, y]]))
    part = np.linspace(0.0, 1.0, 2 * _CURVE + 1)[1:]
    points = arc.take(np.zeros(len(part), dtype=np.int64)).points(arc.start + arc.turn * part)
    points[-1] = x, y
    return points
