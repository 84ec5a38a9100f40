"""When does a gap under gravity and drag first fall through zero? By the signs of its derivatives.

A gap is F(t) = q w.w + 2 s.w + off + lin t + bend t^2 / 2, with w(t) = w + v f + g s of ``drag_motion``: q = 0 for a
line (s is half its normal), q = 1 or -1 for a circle. ``lin`` and ``bend`` are 0 but for a ball that has just left what
is asked of: they take away what is rounding. As the acceleration is a = (g - k v) E = a0 E,

    F'   = 2 (q w + s).v + lin + bend t,        F'' = 2 (q v.v + (q w + s).a) + bend,
    F''' = 2 E h,    h = a0.(3 q v - k (q w + s)),    h' = q a0.(4 a0 E - g).

q h' falls with E, so h has one turn at most, in closed form, and two roots; between them F'' is monotone, so it has
three roots at most; between these F bends one way, where Newton's steps from the right side neither miss the root nor
pass it, as in ``polynomial_roots.first_fall_quartic``, whose plan and rules these are.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from wallkit.kernels.impact.drag_motion import carried, eased
from wallkit.kernels.impact.polynomial_roots import NEVER, STEPS
from wallkit.kernels.jit import kernel, rare_kernel


class Gap(NamedTuple):
    """A gap, see above, and the flight in which it is asked."""

    q: float
    sx: float
    sy: float
    off: float
    lin: float
    bend: float
    wx: float
    wy: float
    vx: float
    vy: float
    gx: float
    gy: float
    drag: float


@rare_kernel
def derivative_at(gap: Gap, order: int, t: float) -> float:
    """Give F, F', F'' at a time, or for the order 3 h, whose sign is that of F''', and for 4 its slope h'."""
    left, free, second = eased(gap.drag, t)
    return _derivative(gap, order, t, left, free, second)


@rare_kernel
def with_slope(gap: Gap, order: int, t: float) -> tuple[float, float]:
    """Give what ``derivative_at`` gives, and its slope."""
    left, free, second = eased(gap.drag, t)
    slope = _derivative(gap, order + 1, t, left, free, second)
    # h has lost the factor 2 E of F'''.
    return _derivative(gap, order, t, left, free, second), slope * (2.0 * left) if order == 2 else slope


@kernel
def _derivative(gap: Gap, order: int, t: float, left: float, free: float, second: float) -> float:
    ax, ay = gap.gx - gap.drag * gap.vx, gap.gy - gap.drag * gap.vy
    if order == 4:
        return gap.q * (4.0 * left * (ax * ax + ay * ay) - (ax * gap.gx + ay * gap.gy))
    wx = gap.wx + (gap.vx * free + gap.gx * second)
    wy = gap.wy + (gap.vy * free + gap.gy * second)
    if order == 0:
        square = wx * (gap.q * wx + 2.0 * gap.sx) + wy * (gap.q * wy + 2.0 * gap.sy)
        return square + (gap.off + t * (gap.lin + 0.5 * t * gap.bend))
    vx, vy = gap.vx * left + gap.gx * free, gap.vy * left + gap.gy * free
    nx, ny = gap.q * wx + gap.sx, gap.q * wy + gap.sy
    if order == 1:
        return 2.0 * (nx * vx + ny * vy) + (gap.lin + t * gap.bend)
    if order == 2:
        return 2.0 * (gap.q * (vx * vx + vy * vy) + left * (nx * ax + ny * ay)) + gap.bend
    return ax * (3.0 * gap.q * vx - gap.drag * nx) + ay * (3.0 * gap.q * vy - gap.drag * ny)


@rare_kernel
def first_fall(gap: Gap, far: float, t_max: float, behind: bool) -> float:
    """Give the first t in [0, t_max] where F(t) <= 0 and falls; NEVER if there is none.

    If F begins ``behind`` it must rise above 0 before a fall counts. ``far`` is a time after which none does; a root
    does not depend on ``t_max`` but only on ``far``.
    """
    first, second, third = _bends(gap, far)
    start, (f, slope) = 0.0, with_slope(gap, 0, 0.0)
    falls = _falls_at_first(gap, slope)
    rose = not behind or (f >= 0.0 and not falls)
    for piece in range(4):
        end = first if piece == 0 else (second if piece == 1 else (third if piece == 2 else far))
        if end <= start:
            continue
        if start > t_max:
            return NEVER
        if rose and falls and f <= 0.0:
            return start
        f_end, slope_end = with_slope(gap, 0, end)
        t = NEVER
        if _bends_up(gap, start, end):
            if rose and falls:
                t = _from_left(gap, start, end)
        elif f_end <= 0.0 and (rose or not falls):
            if f > 0.0:
                t = _from_right(gap, start, end)
            elif slope_end < 0.0:
                t = _over_the_top(gap, start, end, rose)
        if t < NEVER:
            return t if t <= t_max else NEVER
        rose = rose or (f_end > 0.0 and not (falls and slope_end < 0.0))
        start, f, slope, falls = end, f_end, slope_end, slope_end < 0.0
    return NEVER


@rare_kernel
def first_fall_after(gap: Gap, far: float, after: float, t_max: float, behind: bool) -> float:
    """Give the first fall after a time at which F falls through 0, before which it rises; from 0 on see above."""
    if after == 0.0:
        return first_fall(gap, far, t_max, behind)
    wx, wy, vx, vy = carried(gap.drag, gap.wx, gap.wy, gap.vx, gap.vy, gap.gx, gap.gy, after)
    off, lin = gap.off + after * (gap.lin + 0.5 * after * gap.bend), gap.lin + after * gap.bend
    later = Gap(gap.q, gap.sx, gap.sy, off, lin, gap.bend, wx, wy, vx, vy, gap.gx, gap.gy, gap.drag)
    return after + first_fall(later, far, t_max, True)


@rare_kernel
def _falls_at_first(gap: Gap, slope: float) -> bool:
    """Tell whether F falls just after t = 0: the first derivative that is not 0 decides."""
    if slope != 0.0:
        return slope < 0.0
    for order in range(2, 5):
        rate = derivative_at(gap, order, 0.0)
        if rate != 0.0:
            return rate < 0.0
    return False


@rare_kernel
def _bends_up(gap: Gap, start: float, end: float) -> bool:
    """Tell whether F'' > 0 on a piece: by its middle, or its start where that is so late that F'' is rounded to 0."""
    middle = derivative_at(gap, 2, 0.5 * (start + end))
    return (middle if middle != 0.0 else derivative_at(gap, 2, start)) >= 0.0


@rare_kernel
def _bends(gap: Gap, far: float) -> tuple[float, float, float]:
    """Times before ``far`` at which F'' changes its sign, in order; ``far`` in place of those that are missing."""
    turn = _turn_of_third(gap, far)
    if gap.q == 0.0:  # F'' = 2 E s.a0 keeps its sign
        return turn, far, far
    # h is monotone up to its turn, and after it; F'' is so between the roots of h.
    a, b, c = derivative_at(gap, 3, 0.0), derivative_at(gap, 3, turn), derivative_at(gap, 3, far)
    one, two = _sign_change(gap, 3, 0.0, turn, a, b), _sign_change(gap, 3, turn, far, b, c)
    a, b = derivative_at(gap, 2, 0.0), derivative_at(gap, 2, one)
    c, d = derivative_at(gap, 2, two), derivative_at(gap, 2, far)
    first, second, third = (
        _sign_change(gap, 2, 0.0, one, a, b),
        _sign_change(gap, 2, one, two, b, c),
        _sign_change(gap, 2, two, far, c, d),
    )
    return first, second, third


@rare_kernel
def _turn_of_third(gap: Gap, far: float) -> float:
    """When h' = 0: E = a0.g / 4 a0.a0; ``far`` where that is at no time before."""
    ax, ay = gap.gx - gap.drag * gap.vx, gap.gy - gap.drag * gap.vy
    along, square = ax * gap.gx + ay * gap.gy, 4.0 * (ax * ax + ay * ay)
    if not 0.0 < along < square:
        return far
    return min(-math.log(along / square) / gap.drag, far)


@rare_kernel
def _sign_change(gap: Gap, order: int, low: float, high: float, begins: float, ends: float) -> float:
    """Give where a derivative that goes from ``begins`` at low to ``ends`` at high is 0; ``high`` if nowhere between.

    Newton's step, or half the bracket where it leaves it or does not halve the step before the last.
    """
    if not low < high:
        return high
    if not (begins > 0.0 > ends or begins < 0.0 < ends):
        return high
    falls = begins > 0.0
    t = 0.5 * (low + high)
    before = last = high - low
    for _ in range(STEPS):
        value, slope = with_slope(gap, order, t)
        if (value > 0.0) == falls:
            low = t
        else:
            high = t
        following = t - value / slope if slope != 0.0 else low
        if not low < following < high or abs(following - t) > 0.5 * before:
            following = 0.5 * (low + high)
        before, last = last, abs(following - t)
        if following in (low, high, t):
            return following
        t = following
    return t


@rare_kernel
def _from_left(gap: Gap, start: float, end: float) -> float:
    """Give where F, above 0 and falling at ``start``, first falls through 0 before ``end``; it bends up all the way."""
    t = start
    for _ in range(STEPS):
        f, slope = with_slope(gap, 0, t)
        if f <= 0.0:
            return t
        # F lies above its tangent, so its root is not passed.
        following = t - f / slope if slope < 0.0 else NEVER
        if following >= end:
            return NEVER
        if not following > t:
            return t
        t = following
    return t


@rare_kernel
def _from_right(gap: Gap, start: float, end: float) -> float:
    """Give where F falls through 0 for the last time before ``end``, where it is below; it bends down all the way."""
    t = end
    for _ in range(STEPS):
        f, slope = with_slope(gap, 0, t)
        # F lies below its tangent: from the right of the root steps stay there.
        following = t - f / slope if slope < 0.0 else t
        if not following < t:
            return t
        t = max(following, start)
    return t


@rare_kernel
def _over_the_top(gap: Gap, start: float, end: float, rose: bool) -> float:
    """Give where F falls through 0 that is not above 0 at both ends, rises and then falls; it bends down all the way.

    Where it does not come above 0 in between it falls from where it turns, or never if it has to rise before.
    """
    top = _top_between(gap, start, end)
    if not derivative_at(gap, 0, top) > 0.0:
        return top if rose else NEVER
    return _from_right(gap, top, end)


@kernel
def _top_between(gap: Gap, start: float, end: float) -> float:
    """Where F, which bends down and falls at the end, is highest."""
    rises = derivative_at(gap, 1, start)
    return start if rises <= 0.0 else _sign_change(gap, 1, start, end, rises, derivative_at(gap, 1, end))
