"""Curves as short chords, for what is looked at or measured roughly; walls are made by ``wallkit.walls``."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from wallkit.walls import Walls

FloatArray = NDArray[np.float64]

ARC_STEP = math.pi / 32
"""Radians of a wall's arc that one chord spans: it is off by 0.12 % of the radius; in proportion to its square."""
_CURVE = 24  # chords a Bezier curve, half as many as an arc of a drawing


def flattened(walls: Walls, index: int, step: float = ARC_STEP) -> FloatArray:
    """Give one wall's points with arcs cut into short chords; a closed wall does not repeat its first point."""
    span = slice(walls.offsets[index], walls.offsets[index + 1])
    vertices, bulges = walls.vertices[span], walls.bulges[span]
    if not bulges.any():
        return vertices
    ends = np.roll(vertices, -1, axis=0)  # the last of an open wall has the bulge 0 and gives its point alone
    return np.concatenate([arc_points(a, b, float(k), step) for a, b, k in zip(vertices, ends, bulges, strict=True)])


def arc_points(a: FloatArray, b: FloatArray, bulge: float, step: float = ARC_STEP) -> FloatArray:
    """Give points along the edge from a to b, a included and b not.

    With d = b - a and the bulge k = tan(angle / 4), the centre is m + (1 - k^2) / (4 k) (-dy, dx) for the middle m
    of the chord: left of it for a short left turn, since the arc then bows to the right.
    """
    if bulge == 0.0:
        return a[None, :]
    angle = 4.0 * math.atan(bulge)
    d = b - a
    centre = (a + b) / 2 + (1.0 - bulge * bulge) / (4.0 * bulge) * np.array([-d[1], d[0]])
    turn = np.linspace(0.0, angle, max(2, math.ceil(abs(angle) / step) + 1))[:-1]
    cos, sin = np.cos(turn), np.sin(turn)
    arm = a - centre
    turned: FloatArray = np.stack([cos * arm[0] - sin * arm[1], sin * arm[0] + cos * arm[1]], axis=1)
    return centre + turned


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


def in_material(walls: Walls, points: FloatArray) -> NDArray[np.bool_]:
    """Tell for each of (n, 2) points whether an odd number of closed walls goes around it."""
    inside = np.zeros(len(points), dtype=np.bool_)
    for index in np.flatnonzero(walls.closed):
        inside ^= contains(flattened(walls, int(index)), points)
    return inside


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
