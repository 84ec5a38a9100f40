"""Numbers with twice the digits, as sums of two floats: high + low, with |low| at most half a rounding of high.

A sum and a product of two floats are the rounded result and an error that is a float itself (Knuth; Dekker, with
Veltkamp's split into halves of 26 bits). So a ``Double`` of arrays knows some 106 bits: each operation is off by a few
2^-104 of its result, a sum by that of its larger part. Products beyond 1e290 overflow to what is no number.
"""

from __future__ import annotations

from typing import NamedTuple, TypeVar

import numpy as np

from wallkit.geometry.arrays import FloatArray

_SPLITTER = 2.0**27 + 1
Number = TypeVar("Number", float, FloatArray)


def two_difference(x: Number, y: Number) -> tuple[Number, Number]:
    """X - y as a rounded difference and its error (Knuth)."""
    d = x - y
    back = d - x
    return d, (x - (d - back)) - (y + back)


def two_product(x: Number, y: Number) -> tuple[Number, Number]:
    """X y as a rounded product and its error (Dekker, Veltkamp)."""
    p = x * y
    xh = x * _SPLITTER - (x * _SPLITTER - x)
    yh = y * _SPLITTER - (y * _SPLITTER - y)
    xl, yl = x - xh, y - yh
    return p, xl * yl - (((p - xh * yh) - xl * yh) - xh * yl)


class Double(NamedTuple):
    """An array of numbers with twice the digits; broadcasts as arrays do."""

    high: FloatArray
    low: FloatArray

    @staticmethod
    def of(value: FloatArray) -> Double:
        """Floats, as they are."""
        value = np.asarray(value, dtype=np.float64)
        return Double(value, np.zeros_like(value))

    def plus(self, other: Double) -> Double:
        """The sum."""
        s, e = two_difference(self.high, -other.high)
        t, f = two_difference(self.low, -other.low)
        high, low = _normal(s, e + t)
        return Double(*_normal(high, low + f))

    def minus(self, other: Double) -> Double:
        """The difference."""
        return self.plus(other.scaled(-1.0))

    def times(self, other: Double) -> Double:
        """The product."""
        p, e = two_product(self.high, other.high)
        return Double(*_normal(p, e + (self.high * other.low + self.low * other.high)))

    def over(self, other: Double) -> Double:
        """The quotient: one of floats, and what it leaves, divided again."""
        first = Double.of(self.high / other.high)
        rest = self.minus(first.times(other))
        second = Double.of(rest.high / other.high)
        return first.plus(second)

    def scaled(self, power: float) -> Double:
        """Times a power of two, or its negative: exact."""
        return Double(power * self.high, power * self.low)

    def root(self) -> Double:
        """The square root, by one of Newton's steps from that of floats; of 0 it is 0."""
        near = np.sqrt(self.high)
        rest = self.minus(Double.of(near).times(Double.of(near)))
        step = np.divide(rest.high, 2.0 * near, out=np.zeros_like(near), where=near > 0.0)
        return Double(*_normal(near, step))

    def rounded(self) -> FloatArray:
        """The nearest floats."""
        return self.high + self.low


def _normal(high: FloatArray, low: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Move what is more than a rounding of the sum from low to high, |low| <= |high| (Dekker)."""
    s = high + low
    return s, low - (s - high)
