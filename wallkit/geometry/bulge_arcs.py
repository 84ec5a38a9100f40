"""The edge from a to b that is told by its bulge k = tan(angle / 4): the circle of an arc, and points along it.

For the chord d = b - a of length c, as in DXF:

    R = c (1 + k^2) / (4 |k|),    centre = (a + b) / 2 + (1 - k^2) / (4 k) (-dy, dx):

left of the chord for a left turn (k > 0) of less than half a circle, since the arc then bows to the right. This is the
one place where that stands in Python, but for ``wallkit.accuracy.reference``, which shares nothing; the page has it in
JavaScript.
"""

from __future__ import annotations

import math
from typing import TypeVar

import numpy as np

from wallkit.geometry.arrays import FloatArray

ARC_STEP = math.pi / 32
"""Radians of a wall's arc that one chord spans: it is off by 0.12 % of the radius; in proportion to its square."""
Number = TypeVar("Number", float, FloatArray)


def radius_of(chord: Number, bulge: Number) -> Number:
    """Radius of arcs over chords of these lengths; bulges are not 0."""
    return chord * (1.0 + bulge * bulge) / (4.0 * abs(bulge))


def offset_of(chord: Number, bulge: Number) -> Number:
    """How far to the left of the middle of chords of these lengths the centre is; bulges are not 0."""
    return chord * (1.0 - bulge * bulge) / (4.0 * bulge)


def circles(a: FloatArray, b: FloatArray, bulge: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Centre and radius of the circles of arcs, (n, 2) and (n,); of lines (bulge 0) something harmless."""
    k = np.where(bulge == 0, 1.0, bulge)
    d = b - a
    back = (1 - k * k) / (4 * k)  # in chord lengths
    centre = (a + b) / 2 + back[:, None] * np.stack([-d[:, 1], d[:, 0]], axis=1)
    length: FloatArray = np.hypot(d[:, 0], d[:, 1])
    return centre, radius_of(length, k)


def arc_points(a: FloatArray, b: FloatArray, bulge: float, step: float = ARC_STEP) -> FloatArray:
    """Give points along the edge from a to b, (2,) each, a included and b not: turned about the centre by ``step``."""
    if bulge == 0.0:
        return a[None, :]
    angle = 4.0 * math.atan(bulge)
    centre: FloatArray = circles(a[None], b[None], np.array([bulge]))[0][0]
    turn = np.linspace(0.0, angle, max(2, math.ceil(abs(angle) / step) + 1))[:-1]
    cos, sin = np.cos(turn), np.sin(turn)
    arm = a - centre
    turned: FloatArray = np.stack([cos * arm[0] - sin * arm[1], sin * arm[0] + cos * arm[1]], axis=1)
    return centre + turned


def edge_points(a: FloatArray, b: FloatArray, bulge: FloatArray, part: FloatArray) -> FloatArray:
    """Give the point of each edge at a part (0 to 1) of its length: (n, 2) twice and (n,) twice, to (n, 2).

    With half angle h = 2 atan(bulge) and c the chord, the point at angle f = h (2 part - 1) from the middle is
    middle + c sin f / (2 sin h) + (c turned right) (cos f - cos h) / (2 sin h), where
    cos f - cos h = 2 sin((h + f) / 2) sin((h - f) / 2) loses no digits for a flat arc.
    """
    half = 2 * np.arctan(bulge)
    turn = half * (2 * part - 1)
    sin = np.sin(half)
    flat = sin == 0
    along = np.where(flat, part - 0.5, np.sin(turn) / np.where(flat, 1.0, 2 * sin))
    across = np.where(flat, 0.0, np.sin((half + turn) / 2) * np.sin((half - turn) / 2) / np.where(flat, 1.0, sin))
    chord = b - a
    right = np.stack([chord[:, 1], -chord[:, 0]], axis=1)
    points: FloatArray = (a + b) / 2 + chord * along[:, None] + right * across[:, None]
    return points
