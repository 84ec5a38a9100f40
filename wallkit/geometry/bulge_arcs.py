"""The circular arc of an edge, told by its bulge: centre, radius, points along it, how far it bows."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from wallkit.geometry.arrays import FloatArray

ARC_STEP = math.pi / 32
"""Radians of a wall's arc that one chord spans: it is off by 0.12 % of the radius; in proportion to its square."""


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


def circles(a: FloatArray, b: FloatArray, bulge: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Centre and radius of the circles of arcs; of lines (bulge 0) something harmless."""
    k = np.where(bulge == 0, 1.0, bulge)
    d = b - a
    length = np.hypot(d[:, 0], d[:, 1])
    radius = length * (1 + k * k) / (4 * np.abs(k))
    back = (1 - k * k) / (4 * k)  # from the middle of the chord, to the left, in chord lengths
    centre = (a + b) / 2 + back[:, None] * np.stack([-d[:, 1], d[:, 0]], axis=1)
    return centre, radius


def radius_of(a: Sequence[float], b: Sequence[float], bulge: float) -> float:
    """Radius of the arc from a to b, bulge not 0: with the chord c = 2 r sin(angle / 2), r = c (1 + k^2) / (4 |k|)."""
    return math.hypot(b[0] - a[0], b[1] - a[1]) * (1 + bulge * bulge) / (4 * abs(bulge))


def edge_points(a: FloatArray, b: FloatArray, bulge: FloatArray, part: FloatArray) -> FloatArray:
    """Give the place at a part of each edge's length from a to b: (n, 2) twice, (n,) twice, to (n, 2).

    The arc over the angle p A is a chord of 2 r sin(p A / 2), and the whole one is d = b - a of 2 r sin(A / 2). It
    starts A / 2 to the right of d and turns left with half its angle, so that the place is
    a + d sin(p A / 2) / sin(A / 2) e^(i (p - 1) A / 2); the quotient of the sines is p for a line.
    """
    half = 2.0 * np.arctan(bulge)
    curved = half != 0
    sine = np.sin(half)
    ratio = np.where(curved, np.divide(np.sin(part * half), sine, out=part.copy(), where=curved), part)
    turn = (part - 1.0) * half
    cos, sin = ratio * np.cos(turn), ratio * np.sin(turn)
    d = b - a
    return a + np.stack([cos * d[:, 0] - sin * d[:, 1], sin * d[:, 0] + cos * d[:, 1]], axis=1)
