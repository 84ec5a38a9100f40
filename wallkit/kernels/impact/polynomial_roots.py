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
STEPS = 1200
"""More than any of the loops below takes: half of a bracket of doubles is taken at most some 1,100 times."""


@kernel
def first_fall_quadratic(a: float, b: float, c: float, t_max: float) -> float:
    """Give the first t in [0, t_max] where f(t) = a t^2 + b t + c is <= 0 and falls; NEVER if there is none.

    The roots are taken as q / a and c / q with q = -(b + sign(b) sqrt(b^2 - 4 a c)) / 2, which loses no digits as a
    vanishes (no gravity, grazing gravity) and as c does (a ball on the wall). A double root touches zero without
    falling through it and does not count. Nearly touching, the answer has the error that rounding a, b and c has:
    about sqrt(eps) times the time of the vertex.
    """
    discriminant = b * b - 4.0 * a * c  # selects in place of branches, which no processor could foresee
    root = math.sqrt(discriminant if discriminant > 0.0 else 0.0)
    # Falling at the start, the first root is 2 c / (root - b); rising, the one after the top is (b + root) / (-2 a).
    above, rises = c > 0.0, b > 0.0
    numerator, denominator = b + root if rises else 2.0 * c, -2.0 * a if rises else root - b
    # Above and falling it comes down if it is not turned before. Rising it comes back if it is turned, also from an
    # overlap; with no clear stretch between (no root) it begins to approach at the vertex.
    meets = (denominator > 0.0) & (rises | (above & ((a <= 0.0) | (discriminant > 0.0))))
    t = numerator / (denominator if meets else 1.0)
    t = t if meets else NEVER
    t = 0.0 if (not above) & ((b < 0.0) | ((b == 0.0) & (a < 0.0))) else t  # an overlap that approaches
    return t if t <= t_max else NEVER


@kernel
def fall_after_rise(a: float, b: float, c: float) -> float:
    """Give the first t above 0 where a t^2 + b t + c falls through 0 after it has risen above; NEVER if it does not."""
    discriminant = b * b - 4.0 * a * c
    rises = (a < 0.0) & (b > 0.0) & (discriminant > 0.0)
    # a < 0 < b: the larger root, (-b - root) / 2 a, whose terms are of one sign.
    t = -0.5 * (b + math.sqrt(discriminant if rises else 0.0)) / (a if rises else 1.0)
    return t if rises else NEVER


@rare_kernel
def first_fall_quartic(c4: float, c3: float, c2: float, c1: float, c0: float, t_max: float, behind: bool) -> float:
    """Give the first t in [0, t_max] where f(t) = c4 t^4 + ... + c0 is <= 0 and falls; NEVER if there is none.

    If f begins ``behind`` it must rise above 0 before a fall counts.

    The roots of f'' (a quadratic) cut time into pieces on which f bends one way. Where it bends up, Newton's steps from
    the left end come ever closer to the first root and never pass it; where it bends down, those from a place right of
    the last root do. So a root needs no bracket and the times at which f turns need not be known, and yet none is
    missed or found twice, whatever the coefficients: the plan of Yuksel, "High-performance polynomial root finding for
    graphics" (2022), with f'' in place of f'. A cubic, a quadratic or less (leading coefficients 0) needs no special
    case. ``t_max`` only saves work: an earlier time has the same bits whatever it is.

    Degenerate cases: f constant gives NEVER; a touch (double root) counts when the rounded f is <= 0 on the way to it,
    which is as much as its coefficients say; f that is <= 0 all the way up to where it turns falls from there on.
    """
    # f'' = 12 c4 t^2 + 6 c3 t + 2 c2. Pieces: up to its first root, between the two, and after, without end.
    low, high = _quadratic_roots(12.0 * c4, 6.0 * c3, 2.0 * c2)
    start, f, slope, falls = 0.0, c0, c1, _falls_from_zero(c4, c3, c2, c1)
    rose = not behind or (f >= 0.0 and not falls)
    for piece in range(3):
        end = low if piece == 0 else (high if piece == 1 else NEVER)
        if end <= start:
            continue
        if start > t_max:
            return NEVER
        if rose and falls and f <= 0.0:
            return start
        f_end, slope_end = -NEVER, -NEVER
        if end < NEVER:
            f_end, slope_end = _quartic(c4, c3, c2, c1, c0, end), _cubic(4.0 * c4, 3.0 * c3, 2.0 * c2, c1, end)
        t = NEVER
        if not _bends_down(c4, c3, c2, start, end):
            if rose and falls:
                t = _from_left(c4, c3, c2, c1, c0, start, end)
        elif f_end <= 0.0 and (rose or not falls):
            if f > 0.0:
                t = _from_right(c4, c3, c2, c1, c0, start, f, slope, end)
            elif slope_end < 0.0:
                t = _over_the_top(c4, c3, c2, c1, c0, start, f, slope, end, rose)
        if t < NEVER or end == NEVER:
            return t if t <= t_max else NEVER
        rose = rose or (f_end > 0.0 and not (falls and slope_end < 0.0))
        start, f, slope, falls = end, f_end, slope_end, slope_end < 0.0
    return NEVER


@rare_kernel
def _falls_from_zero(c4: float, c3: float, c2: float, c1: float) -> bool:
    """Tell whether f falls just after t = 0: the first coefficient that is not 0 decides."""
    if c1 != 0.0:
        return c1 < 0.0
    if c2 != 0.0:
        return c2 < 0.0
    return c3 < 0.0 or (c3 == 0.0 and c4 < 0.0)


@kernel
def _bends_down(c4: float, c3: float, c2: float, start: float, end: float) -> bool:
    """Tell whether f'' < 0 on a piece; on one without end its leading coefficient says so."""
    if end < NEVER:
        t = 0.5 * (start + end)
        return (6.0 * c4 * t + 3.0 * c3) * t + c2 < 0.0
    return c4 < 0.0 or (c4 == 0.0 and (c3 < 0.0 or (c3 == 0.0 and c2 < 0.0)))


@rare_kernel
def _from_left(c4: float, c3: float, c2: float, c1: float, c0: float, start: float, end: float) -> float:
    """Give where f, above 0 and falling at ``start``, first falls through 0 before ``end``; it bends up all the way.

    A tangent lies below f, so its root comes before that of f. Near a double root a step halves the distance.
    """
    t = start
    for _ in range(STEPS):
        f, slope = _quartic(c4, c3, c2, c1, c0, t), _cubic(4.0 * c4, 3.0 * c3, 2.0 * c2, c1, t)
        if f <= 0.0:
            return t
        # The root of the tangent at t; f lies above the tangent, so its own root is not passed.
        following = t - f / slope if slope < 0.0 else NEVER
        if following >= end:
            return NEVER
        if not following > t:
            return t
        t = following
    return t


@rare_kernel
def _from_right(
    c4: float, c3: float, c2: float, c1: float, c0: float, start: float, f: float, slope: float, end: float
) -> float:
    """Give where f falls through 0 for the last time before ``end``, where it is below; it bends down all the way.

    A tangent lies above f, so from the right of the root steps stay there, and from the left one step leads there.
    They begin near the root of the parabola that f is at ``start``.
    """
    t = end
    bend = 2.0 * ((6.0 * c4 * start + 3.0 * c3) * start + c2)
    # f + f' h + f'' h^2 / 2 = 0 at h = 2 f / (root - f') = (f' + root) / -f'': the form whose terms add up.
    if bend < 0.0:
        root = math.sqrt(max(slope * slope - 2.0 * f * bend, 0.0))
        near = start + (2.0 * f / (root - slope) if slope < 0.0 else (slope + root) / -bend)
        f, slope = _quartic(c4, c3, c2, c1, c0, near), _cubic(4.0 * c4, 3.0 * c3, 2.0 * c2, c1, near)
        if near < end and slope < 0.0:
            t = min(end, near - f / slope)
    if t == NEVER:
        t = max(start, _root_bound(c4, c3, c2, c1, c0))
    for _ in range(STEPS):
        f, slope = _quartic(c4, c3, c2, c1, c0, t), _cubic(4.0 * c4, 3.0 * c3, 2.0 * c2, c1, t)
        following = t - f / slope if slope < 0.0 else t
        if not following < t:
            return t
        t = following
    return t


@rare_kernel
def _over_the_top(
    c4: float, c3: float, c2: float, c1: float, c0: float, start: float, f: float, slope: float, end: float, rose: bool
) -> float:
    """Give where f falls through 0 that is not above 0 at both ends, rises and then falls; it bends down all the way.

    Where it does not come above 0 in between it falls from where it turns, or never if it has to rise before.
    """
    bend = 2.0 * ((6.0 * c4 * start + 3.0 * c3) * start + c2)
    # The top of the parabola at the start is a guess. If f is not above 0 there, its own top is looked for.
    top = start - slope / bend if bend < 0.0 else start
    if not (top < end and _quartic(c4, c3, c2, c1, c0, top) > 0.0):
        last = end if end < NEVER else max(start, _root_bound(c4, c3, c2, c1, c0))
        top = _turn_between(4.0 * c4, 3.0 * c3, 2.0 * c2, c1, start, last)
        if not _quartic(c4, c3, c2, c1, c0, top) > 0.0:
            return top if rose else NEVER
    return _from_right(c4, c3, c2, c1, c0, start, f, slope, end)


@rare_kernel
def _turn_between(c3: float, c2: float, c1: float, c0: float, low: float, high: float) -> float:
    """Give the root of a cubic that falls from low to high: Newton's step, or half the bracket where it leaves it.

    A step that does not halve the one before the last is replaced too, so that it ends, as bisection does.
    """
    t = 0.5 * (low + high)
    before = last = high - low
    for _ in range(STEPS):
        f, slope = _cubic(c3, c2, c1, c0, t), (3.0 * c3 * t + 2.0 * c2) * t + c1
        if f >= 0.0:
            low = t
        else:
            high = t
        following = t - f / slope if slope < 0.0 else low
        # Newton while it at least halves the step before the last, else bisection: so it ends.
        if not low < following < high or abs(following - t) > 0.5 * before:
            following = 0.5 * (low + high)
        before, last = last, abs(following - t)
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
    # q = -(b + sign(b) root) / 2; the roots are q / a and c / q, since their product is c / a: no difference cancels.
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
