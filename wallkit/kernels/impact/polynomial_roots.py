"""When does a polynomial in time first fall through zero? Quadratics in closed form, quartics by their derivatives.

One question serves every wall under gravity: f(t) is a gap (or a gap times something positive), the ball touches
where f <= 0, and only a falling f is an approach. So the kernels below return the first t >= 0 at which f(t) <= 0
and f falls: f'(t) < 0, or f'(t) = 0 and f falls from there on. A gap that is negative and growing is no event; a gap
that is negative and shrinking is one at t = 0. Only + - * / and sqrt are used, each correctly rounded, so that
interpreted and compiled kernels agree to the bit.
"""

from __future__ import annotations

import math

from wallkit.kernels.jit import kernel, rare_kernel

NEVER = math.inf


@kernel
def first_fall_quadratic(a: float, b: float, c: float, t_max: float) -> float:
    """Give the first t in [0, t_max] where f(t) = a t^2 + b t + c is <= 0 and falls; NEVER if there is none.

    The roots are taken as q / a and c / q with q = -(b + sign(b) sqrt(b^2 - 4 a c)) / 2, which loses no digits as a
    vanishes (no gravity, grazing gravity) and as c does (a ball on the wall). A double root touches zero without
    falling through it and does not count. Nearly touching, the answer has the error that rounding a, b and c has:
    about sqrt(eps) times the time of the vertex.
    """
    if c <= 0.0:
        if b < 0.0 or (b == 0.0 and a < 0.0):
            return 0.0
        if a >= 0.0:  # it overlaps and recedes for ever
            return NEVER
        discriminant = b * b - 4.0 * a * c
        # with no clear stretch between (discriminant <= 0) it begins to approach at the vertex
        t = -0.5 * (b + math.sqrt(max(discriminant, 0.0))) / a
    elif a == 0.0:
        if b >= 0.0:
            return NEVER
        t = -c / b
    else:
        discriminant = b * b - 4.0 * a * c
        if a > 0.0:
            if b >= 0.0 or discriminant <= 0.0:
                return NEVER
            t = 2.0 * c / (math.sqrt(discriminant) - b)
        elif b > 0.0:
            t = -0.5 * (b + math.sqrt(discriminant)) / a
        else:
            t = 2.0 * c / (math.sqrt(discriminant) - b)
    return t if t <= t_max else NEVER


@rare_kernel
def first_fall_quartic(c4: float, c3: float, c2: float, c1: float, c0: float, t_max: float) -> float:
    """Give the first t in [0, t_max] where f(t) = c4 t^4 + ... + c0 is <= 0 and falls; NEVER if there is none.

    The times at which f turns cut [0, t_max] into pieces on which it only rises or only falls; they are the roots
    of f', found in turn between the roots of f'' (a quadratic). On a falling piece there is at most one root, and its
    ends show whether there is one: none can be missed and none can be found twice, whatever the coefficients. Each
    is then closed in on by Newton steps kept inside a bracket. That is the plan of Yuksel, "High-performance
    polynomial root finding for graphics" (2022), reduced to the one root that is asked for. A cubic, a quadratic or
    less (leading coefficients 0) needs no special case.

    t_max may be infinite: all roots lie below Fujiwara's bound. Degenerate cases: f constant gives NEVER; a touch
    (double root) counts when the rounded f at the turning time is <= 0, which is as much as its coefficients say.
    """
    limit = min(t_max, _root_bound(c4, c3, c2, c1, c0))
    low, high = _quadratic_roots(12.0 * c4, 6.0 * c3, 2.0 * c2)
    start = 0.0
    f_start = c0
    falls = _falls_from_zero(c4, c3, c2, c1)
    cut = 0.0
    for piece in range(3):  # f' is monotone between 0, low, high and the limit
        if piece == 0:
            end = low
        elif piece == 1:
            end = high
        else:
            end = limit
        end = min(end, limit)
        if end <= cut and piece < 2:
            continue
        end = max(end, cut)
        slope_end = _cubic(4.0 * c4, 3.0 * c3, 2.0 * c2, c1, end)
        if falls != (slope_end < 0.0):  # f turns inside
            turn = _bracketed_root(0.0, 4.0 * c4, 3.0 * c3, 2.0 * c2, c1, cut, end, falls)
            if falls:
                t = _fall_between(c4, c3, c2, c1, c0, start, f_start, turn)
                if t < NEVER:
                    return t
            start = turn
            f_start = _quartic(c4, c3, c2, c1, c0, turn)
        falls = slope_end < 0.0
        cut = end
    if _cubic(4.0 * c4, 3.0 * c3, 2.0 * c2, c1, 0.5 * (start + limit)) < 0.0:
        return _fall_between(c4, c3, c2, c1, c0, start, f_start, limit)
    return NEVER


@rare_kernel
def _falls_from_zero(c4: float, c3: float, c2: float, c1: float) -> bool:
    """Tell whether f falls just after t = 0: the first coefficient that is not 0 decides."""
    if c1 != 0.0:
        return c1 < 0.0
    if c2 != 0.0:
        return c2 < 0.0
    return c3 < 0.0 or (c3 == 0.0 and c4 < 0.0)


@rare_kernel
def _fall_between(
    c4: float, c3: float, c2: float, c1: float, c0: float, start: float, f_start: float, end: float
) -> float:
    """Give where the falling piece [start, end] of f is first <= 0; NEVER if it stays positive."""
    if f_start <= 0.0:
        return start
    if _quartic(c4, c3, c2, c1, c0, end) > 0.0:
        return NEVER
    return _bracketed_root(c4, c3, c2, c1, c0, start, end, False)


@rare_kernel
def _bracketed_root(
    c4: float, c3: float, c2: float, c1: float, c0: float, low: float, high: float, rising: bool
) -> float:
    """Give the root of a quartic between low and high, through which it rises or falls as told.

    Newton's step where it stays inside the bracket and the bracket at least halves every two steps, else bisection.
    It ends when the step is no longer seen in t: the loop's bound is never met in practice (a bisection of doubles
    takes at most about 1,100 steps in all, 64 once the bracket spans a factor of two).
    """
    t = 0.5 * (low + high)
    width = high - low
    for _ in range(1200):
        f = _quartic(c4, c3, c2, c1, c0, t)
        if (f <= 0.0) == rising:
            low = t
        else:
            high = t
        slope = _cubic(4.0 * c4, 3.0 * c3, 2.0 * c2, c1, t)
        following = t - f / slope if slope != 0.0 else low
        halved = high - low <= 0.5 * width
        width = high - low
        if not (halved and low < following < high):
            if following == t:  # Newton stands still: nothing below the last digit is left
                return t
            following = 0.5 * (low + high)
        if following in (low, high, t):
            return following
        t = following
    return t


@kernel
def _quadratic_roots(a: float, b: float, c: float) -> tuple[float, float]:
    """Give the roots of a t^2 + b t + c in rising order; (NEVER, NEVER) without real ones, NEVER for a missing one."""
    if a == 0.0:
        return (-c / b, NEVER) if b != 0.0 else (NEVER, NEVER)
    discriminant = b * b - 4.0 * a * c
    if discriminant < 0.0:
        return NEVER, NEVER
    root = math.sqrt(discriminant)
    q = -0.5 * (b + root) if b >= 0.0 else -0.5 * (b - root)
    first = q / a
    second = c / q if q != 0.0 else first
    return (first, second) if first <= second else (second, first)


@kernel
def _root_bound(c4: float, c3: float, c2: float, c1: float, c0: float) -> float:
    """Bound the size of all roots: 2 max |c(n-k) / c(n)|^(1/k) (Fujiwara 1916), of the degree that is there.

    The cube root is replaced by the larger of the square root and the fourth root, which is never smaller.
    """
    if c4 != 0.0:
        third = math.sqrt(abs(c1 / c4))
        bound = max(abs(c3 / c4), math.sqrt(abs(c2 / c4)), third, math.sqrt(third), math.sqrt(math.sqrt(abs(c0 / c4))))
    elif c3 != 0.0:
        third = math.sqrt(abs(c0 / c3))
        bound = max(abs(c2 / c3), math.sqrt(abs(c1 / c3)), third, math.sqrt(third))
    elif c2 != 0.0:
        bound = max(abs(c1 / c2), math.sqrt(abs(c0 / c2)))
    elif c1 != 0.0:
        bound = abs(c0 / c1)
    else:
        bound = 0.0
    return min(2.0 * bound, 1.0e300)  # a root beyond 1e300 s is none, and infinity would spoil the arithmetic


@kernel
def _quartic(c4: float, c3: float, c2: float, c1: float, c0: float, t: float) -> float:
    return (((c4 * t + c3) * t + c2) * t + c1) * t + c0


@kernel
def _cubic(c3: float, c2: float, c1: float, c0: float, t: float) -> float:
    return ((c3 * t + c2) * t + c1) * t + c0
