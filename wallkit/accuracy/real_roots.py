"""Real roots of polynomials with any number of digits, for the references."""

from __future__ import annotations

import itertools
import math
from typing import Any

Real = Any  # an mpmath.mpf of the context in use


def real_roots(mp: Any, coefficients: list[Real]) -> list[Real]:
    """List the real roots at which a polynomial changes its sign, and 0 where it is one; none of a constant.

    Args:
        mp: the mpmath context.
        coefficients: the leading one first.
    """
    while coefficients and coefficients[0] == 0:
        coefficients = coefficients[1:]
    if len(coefficients) <= 1:
        return []
    if len(coefficients) == 2:
        return [-coefficients[1] / coefficients[0]]
    if len(coefficients) == 3:
        return _quadratic_roots(mp, *coefficients)
    if coefficients[-1] == 0:  # the root 0 is known, the others are found without it
        return [mp.mpf(0), *real_roots(mp, coefficients[:-1])]
    return _roots_between_extremes(mp, coefficients)


def _roots_between_extremes(mp: Any, coefficients: list[Real]) -> list[Real]:
    """A polynomial is monotone between the roots of its derivative: at most one root in each stretch."""
    degree = len(coefficients) - 1
    slope = [(degree - k) * c for k, c in enumerate(coefficients[:-1])]
    bound = 1 + max(abs(c / coefficients[0]) for c in coefficients)  # Cauchy: no root is larger
    stops = [-bound, *sorted(real_roots(mp, slope)), bound]
    found = []
    for low, high in itertools.pairwise(stops):
        if _value(coefficients, low) * _value(coefficients, high) < 0:
            found.append(_root_in(mp, coefficients, slope, low, high))
    return found


def _root_in(mp: Any, coefficients: list[Real], slope: list[Real], low: Real, high: Real) -> Real:
    """The one root between two places where the signs differ: sought in doubles first, which only tells a start."""
    rough = [float(c) for c in coefficients]
    sizes = [abs(c) for c in rough]
    start = low
    if all(map(math.isfinite, (float(low), float(high), *rough))):
        rough_slope = [float(c) for c in slope]
        start = mp.mpf(_root_between(rough, rough_slope, float(low), float(high), sizes, 2.0**-53, 200))
    if not low < start < high:
        start = (low + high) / 2
    return _root_between(coefficients, slope, low, high, sizes, mp.eps, 20 * mp.prec, start)


def _quadratic_roots(mp: Any, a: Real, b: Real, c: Real) -> list[Real]:
    if c == 0:
        return [mp.mpf(0), -b / a]
    discriminant = b * b - 4 * a * c
    if discriminant < 0:
        return []
    root = mp.sqrt(discriminant)
    q = -(b + root) / 2 if b >= 0 else (root - b) / 2
    return [q / a, c / q] if q != 0 else [mp.mpf(0)]


def _value(coefficients: list[Real], at: Real) -> Real:
    total = coefficients[0]
    for c in coefficients[1:]:
        total = total * at + c
    return total


def _root_between(
    coefficients: list[Real],
    slope: list[Real],
    low: Real,
    high: Real,
    sizes: list[float],
    eps: Real,
    most: int,
    start: Real | None = None,
) -> Real:
    """Newton's steps, halving the bracket instead whenever one leaves it or shrinks too little.

    It ends where the value is its own rounding, 8 eps of the sum of |c t^k| (four products and sums, each of eps at
    most): these digits tell no nearer root.
    """
    rising = _value(coefficients, high) > 0
    middle = (low + high) / 2 if start is None else start
    least = 8 * float(eps)
    for _ in range(most):
        value = _value(coefficients, middle)
        noise = least * _value(sizes, abs(float(middle)))
        if value == 0 or (abs(value) <= noise and math.isfinite(noise)):
            break
        low, high = (low, middle) if (value > 0) == rising else (middle, high)
        steep = _value(slope, middle)
        following = middle - value / steep if steep != 0 else low
        if not low < following < high:
            following = (low + high) / 2
        if abs(following - middle) <= eps * abs(following):
            break
        middle = following
    return middle
