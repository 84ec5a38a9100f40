"""Elliptic arcs: from end points, as files have them, to centre and half axes.

``P(a) = centre + u cos(a) + v sin(a)`` for a from ``start`` to ``start + turn``.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from wallkit.geometry.arrays import FloatArray


@dataclass(slots=True, eq=False, repr=False)
class Arcs:
    """Elliptic arcs in centre form.

    Attributes:
        centre: (n, 2).
        u: (n, 2) the ellipse's first half axis, from the centre.
        v: (n, 2) the second, a quarter turn counter-clockwise from ``u``.
        start: (n,) angle of the first point in radians.
        turn: (n,) angle to the last point, negative when clockwise; 0 for an arc without extent.
    """

    centre: FloatArray
    u: FloatArray
    v: FloatArray
    start: FloatArray
    turn: FloatArray

    def take(self, index: NDArray[np.generic]) -> Arcs:
        """Give the arcs at ``index``."""
        return Arcs(self.centre[index], self.u[index], self.v[index], self.start[index], self.turn[index])

    def points(self, angle: FloatArray) -> FloatArray:
        """Give the point of each arc at its angle: (n, 2)."""
        return self.centre + self.u * np.cos(angle)[:, None] + self.v * np.sin(angle)[:, None]

    @property
    def radii(self) -> tuple[FloatArray, FloatArray]:
        """The lengths of the two half axes, each (n,)."""
        return np.hypot(self.u[:, 0], self.u[:, 1]), np.hypot(self.v[:, 0], self.v[:, 1])


def centre_form(rows: FloatArray) -> Arcs:
    """Turn end-point form into centre form (the SVG specification, implementation notes F.6.5).

    Args:
        rows: (n, 9) of x0, y0, rx, ry, rotation in degrees, large, sweep, x1, y1; radii that reach.

    Degenerate: equal end points give ``turn`` 0. Radii that only just reach (a half ellipse) leave
    1 - k within rounding of 0, whose root would move the centre by 1e-8 radii: it counts as 0.
    """
    x0, y0, rx, ry, rotation, large, sweep, x1, y1 = rows.T
    cos, sin = _turns(rotation)
    dx, dy = (x0 - x1) / 2, (y0 - y1) / 2
    with np.errstate(divide="ignore", invalid="ignore"):
        a, b = (cos * dx + sin * dy) / rx, (cos * dy - sin * dx) / ry
        k = a * a + b * b
        spare = np.where(np.abs(1 - k) <= 8 * np.finfo(float).eps, 0.0, np.maximum(1 - k, 0.0) / k)
    empty = ~(k > 0)
    off = np.where(empty, 0.0, np.where(large != sweep, 1.0, -1.0) * np.sqrt(np.where(empty, 0.0, spare)))
    ca, cb = off * b, -off * a  # the centre in units of the radii, from the chord's middle
    u, v = np.stack([rx * cos, rx * sin], axis=1), np.stack([-ry * sin, ry * cos], axis=1)
    middle = np.stack([x0 + x1, y0 + y1], axis=1) / 2
    start = np.arctan2(b - cb, a - ca)
    turn = np.arctan2(-b - cb, -a - ca) - start
    turn = np.where((sweep != 0) & (turn <= 0), turn + 2 * math.pi, turn)
    turn = np.where((sweep == 0) & (turn >= 0), turn - 2 * math.pi, turn)
    return Arcs(middle + ca[:, None] * u + cb[:, None] * v, u, v, start, np.where(empty, 0.0, turn))


def _turns(degrees: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Cosine and sine of angles in degrees, exact at quarter turns."""
    radians = np.radians(degrees)
    cos, sin = np.cos(radians), np.sin(radians)
    quarter = np.mod(degrees, 90.0) == 0
    return np.where(quarter, np.rint(cos), cos), np.where(quarter, np.rint(sin), sin)
