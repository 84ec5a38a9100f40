"""Curves in axes of their own, for measuring: real numbers, a curve a column, the quick way round for NumPy."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from wallkit.geometry.arrays import FloatArray

ComplexArray = NDArray[np.complex128]


class Moved(Protocol):
    """Curves in axes of their own, n of them."""

    def places(self, t: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Coordinates x and y of the curves at ``t`` (k, n): (k, n) each."""
        ...

    def motion(self, t: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
        """The same, and their derivatives by t."""
        ...


@dataclass(slots=True, eq=False, repr=False)
class MovedCubics:
    """Cubics in axes of their own.

    Attributes:
        x: (7, n) coefficients of 1, t, t^2 and t^3, and the three control points of the derivative.
        y: the same.
    """

    x: FloatArray
    y: FloatArray

    @classmethod
    def of(cls, start: ComplexArray, control: ComplexArray) -> MovedCubics:
        """Take first points (n,), and the other control points relative to them (3, n)."""
        return cls(_columns(start.real, control.real), _columns(start.imag, control.imag))

    def places(self, t: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Points."""
        return _cubic(self.x, t), _cubic(self.y, t)

    def motion(self, t: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
        """Points and first derivatives, these by Bernstein's form as for single ones."""
        s, double, square = 1 - t, 2 * t, t * t
        velocity = []
        for column in (self.x, self.y):
            sum_ = column[4] * s
            sum_ += column[5] * double
            sum_ *= s
            sum_ += column[6] * square
            velocity.append(sum_)
        return _cubic(self.x, t), _cubic(self.y, t), velocity[0], velocity[1]


def _columns(start: FloatArray, control: FloatArray) -> FloatArray:
    p1, p2, p3 = control
    c, b = 3 * p1, 3 * (p2 - 2 * p1)
    return np.stack([start, c, b, p3 - c - b, c, 3 * (p2 - p1), 3 * (p3 - p2)])


def _cubic(column: FloatArray, t: FloatArray) -> FloatArray:
    sum_: FloatArray = column[3] * t
    sum_ += column[2]
    sum_ *= t
    sum_ += column[1]
    sum_ *= t
    sum_ += column[0]
    return sum_


@dataclass(slots=True, eq=False, repr=False)
class MovedEllipses:
    """Arcs in axes of their own: first point, conjugate half axes p and q, turn; (n,) each."""

    start: ComplexArray
    p: ComplexArray
    q: ComplexArray
    turn: FloatArray

    def places(self, t: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Points."""
        x, y, _, _ = self.motion(t)
        return x, y

    def motion(self, t: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
        """Points p (cos a - 1) + q sin a, a the part of the turn, and first derivatives."""
        angle = self.turn * t
        cos, sin, bow = np.cos(angle), np.sin(angle), 2 * np.sin(angle / 2) ** 2
        start, p, q = self.start, self.p, self.q
        x, y = (part(q) * sin - part(p) * bow + part(start) for part in (np.real, np.imag))
        vx, vy = ((part(q) * cos - part(p) * sin) * self.turn for part in (np.real, np.imag))
        return x, y, vx, vy
