"""How a ball moves under a constant pull and linear drag: dv/dt = g - k v, in closed form.

With E = e^(-k t), the free time f = (1 - E) / k and the second one s = (t - f) / k, which are t and t^2 / 2 for k = 0,

    p(t) = p + v f + g s,    v(t) = v E + g f,    a(t) = (g - k v) E.

The acceleration keeps its direction, so a component of the velocity changes its sign once at most, the path bends to
one side, and against any line it rises once and falls once at most. ``drag`` is k, or None: then this is a parabola.
"""

from __future__ import annotations

import math
from typing import Any

from wallkit.kernels.impact.polynomial_roots import NEVER
from wallkit.kernels.jit import kernel, rare_kernel

SHORT = 0.5
"""Below this k t the second time is summed as a series: by the closed form t - f would cancel."""
TERMS = 18
"""Of that series: the next one, x^18 / 20!, is below 2^-53 of the first."""
CLOSE = 2.0**-30
"""Of a time, Newton's step that is so small is the last: the next one would be of its square."""
GENERAL = 2.0
"""The k t from which on the second time s is taken for at least t / 2 k: see ``beyond``."""


@rare_kernel
def eased(drag: float, t: float) -> tuple[float, float, float]:
    """Give (E, f, s) for a time t >= 0: the part of the speed that is left, the free time and the second one."""
    x = drag * t
    left = math.exp(-x)
    if x == 0.0:
        return left, t, 0.5 * t * t
    lost = -math.expm1(-x)
    free = lost / drag
    if x >= SHORT:
        return left, free, (t - free) / drag
    # (x - 1 + e^-x) / x^2 = 1/2 - x/6 + x^2/24 - ..., each term -x / (n + 2) times the one before.
    term = total = 0.5
    for n in range(1, TERMS):
        term *= -x / (n + 2)
        before, total = total, total + term
        if total == before:  # the terms that follow are smaller still
            break
    return left, free, t * t * total


@kernel
def along(drag, u, vu, gu, t):
    """Where a coordinate u is after a time: u + vu t + gu t^2 / 2 without drag."""
    if drag is None:
        return u + t * (vu + 0.5 * t * gu)
    _left, free, second = eased(drag, t)
    return u + (vu * free + gu * second)


@kernel
def speed_after(drag, v, g, t):
    """What a component of the velocity is after a time."""
    if drag is None:
        return v + t * g
    left, free, _second = eased(drag, t)
    return v * left + g * free


@kernel
def pulled(drag, v, g):
    """A component of the acceleration at once."""
    if drag is None:
        return g
    return g - drag * v


@kernel
def carried(drag: Any, x: float, y: float, vx: float, vy: float, gx: float, gy: float, t: float) -> Any:
    """Where a ball is after a time of flight, and its velocity: p + v f + g s, v E + g f."""
    if drag is None:
        # t (v + t g / 2): one rounding fewer than v t + g t^2 / 2.
        return x + t * (vx + 0.5 * t * gx), y + t * (vy + 0.5 * t * gy), vx + t * gx, vy + t * gy
    left, free, second = eased(drag, t)
    return (
        x + (vx * free + gx * second),
        y + (vy * free + gy * second),
        vx * left + gx * free,
        vy * left + gy * free,
    )


@kernel
def standstill(drag, v, g, now):
    """When a component of the velocity changes its sign, if after now; else NEVER."""
    if drag is None:
        t = -v / g if g != 0.0 else NEVER
        return t if t > now else NEVER
    # v E + g (1 - E) / k = 0 where e^(k t) - 1 = -k v / g.
    if v * g >= 0.0:
        return NEVER
    t = math.log1p(-drag * v / g) / drag
    return t if t > now else NEVER


@rare_kernel
def time_of_way(drag: float, v: float, a: float, way: float) -> float:
    """When a coordinate that does not turn back before has come by ``way`` > 0: v f + a s = way; NEVER if it stops.

    Its velocity keeps its sign until then, v > 0 or v = 0 < a. The acceleration does too, so Newton's steps end: from
    the left where the way bends down (a < k v), from the right where it bends up; a bracket halves what they leave.
    """
    if not (v > 0.0 or a > 0.0):
        return NEVER
    if a == 0.0:  # v (1 - E) / k = way: it comes to v / k at most
        part = way * drag / v
        return -math.log1p(-part) / drag if part < 1.0 else NEVER
    low = 0.0
    if a < 0.0:  # it turns where its speed is 0
        high = math.log1p(-drag * v / a) / drag
        if along(drag, 0.0, v, a, high) < way:
            return NEVER
    else:
        high = way / v if v > 0.0 else math.sqrt(2.0 * way / a)
        for _ in range(1100):  # doubled until it is beyond
            if not along(drag, 0.0, v, a, high) < way:
                break
            low, high = high, 2.0 * high
    t = high
    for _ in range(1200):
        _left, free, second = eased(drag, t)
        late = (v * free + a * second) - way
        if late == 0.0:
            break
        if late > 0.0:
            high = t
        else:
            low = t
        slope = speed_after(drag, v, a, t)
        following = t - late / slope if slope > 0.0 else low
        if not low < following < high:
            following = 0.5 * (low + high)
            if following in (low, high):
                break
        if abs(following - t) <= 2.0**-53 * t:
            break
        t = following
    return t


@rare_kernel
def time_to_border(drag: float, v: float, a: float, way: float) -> float:
    """``time_of_way`` for the walk from cell to cell, to within some roundings and from a better start.

    A parabola bounds the way from one side, so Newton's steps begin there: two or three do.
    """
    if not (v > 0.0 or a > 0.0):
        return NEVER
    if a == 0.0:  # v (1 - E) / k = way: it comes to v / k at most
        part = way * drag / v
        return -math.log1p(-part) / drag if part < 1.0 else NEVER
    # The way is v t + a0 s with a0 = a - k v, and s <= t^2 / 2: up to the parabola if it speeds up, else beyond it.
    bend, low = a - drag * v, 0.0
    square = v * v + 2.0 * bend * way
    if square > 0.0:
        t = 2.0 * way / (v + math.sqrt(square))
        high = NEVER if bend > 0.0 else t
    elif a > 0.0:  # it slows down, but to a speed that lasts
        t, high = way / v, NEVER
    else:  # it turns where its speed is 0
        t = high = math.log1p(-drag * v / a) / drag
        if along(drag, 0.0, v, a, high) < way:
            return NEVER
    for _ in range(1200):
        left, free, second = eased(drag, t)
        late, slope = (v * free + a * second) - way, v * left + a * free
        if late == 0.0:
            break
        if late > 0.0:
            high = t
        else:
            low = t
        following = t - late / slope if slope > 0.0 else low
        if not low < following < high:
            following = 0.5 * (low + high) if high < NEVER else 2.0 * low
            if following in (low, high):
                break
        elif abs(following - t) <= CLOSE * t:
            return following
        t = following
    return t


@rare_kernel
def beyond(drag: float, vx: float, vy: float, gx: float, gy: float, size: float) -> float:
    """Time after which a ball is farther than ``size`` from where it is, down the pull, for good.

    Down the pull it comes by |g| s - |v| f at least, and s >= 0.28 t^2, f <= t up to k t = 2, after that s >= t / 2 k,
    f <= 1 / k.
    """
    pull, speed = math.sqrt(gx * gx + gy * gy), math.sqrt(vx * vx + vy * vy)
    if pull == 0.0:  # it comes to a stop: after 64 / k, e^-64 of its way is left
        return 64.0 / drag
    early = (speed + math.sqrt(speed * speed + 1.12 * pull * size)) / (0.56 * pull)
    late, slow = 2.0 * (drag * size + speed) / pull, GENERAL / drag
    return early if early <= slow and late <= slow else max(slow, late)
