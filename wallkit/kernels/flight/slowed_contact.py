"""What rolling friction and drag do to a ball that keeps to a wall.

Rolling friction slows it by mu N, where N is what presses it on the wall and mu is ``rolling``; drag by k v. On a line
N is -g.n and the motion that of ``drag_motion``, or with constant acceleration. On a circle of radius rho, with W the
angular speed and phi the angle from a direction e towards t,

    W' = (g.t - mu N) / rho - k W,    N = -away (g.e + rho W^2),

which has a closed form for W^2 alone, and only without drag. So it is integrated: with u = tan(phi / 2) the right side
is rational, and a *leap* is Gragg's midpoint rule with 2, 4, ..., 12 steps, extrapolated to none (Hairer, Norsett and
Wanner, Solving Ordinary Differential Equations I, II.9): of order 12, and at a quarter of the time in which anything
changes by its own size the first term left out, of the size (1/4)^13 / (2 4 6 8 10 12)^2 of the change, is rounding.

``rolling`` and ``drag`` are None where they do not act.
"""

from __future__ import annotations

import math
from typing import Any

from wallkit.kernels.flight.damping import HALVINGS
from wallkit.kernels.flight.gravity import LEVEL
from wallkit.kernels.flight.pendulum import STEPS
from wallkit.kernels.impact.drag_motion import along, speed_after, time_of_way
from wallkit.kernels.impact.polynomial_roots import NEVER
from wallkit.kernels.jit import kernel, rare_kernel
from wallkit.kernels.records import GOES_ON, LIFTS, TIME_IS_UP, TURNS

LEAPS = 64
"""Leaps of a stretch, at most: a quarter of a circle takes some ten."""
LEAP = 0.25
"""Of the time in which the speed, or what pulls the ball, changes by its own size."""
ANGLE, SPEED, PRESS, PRESSES_MORE = 0, 1, 2, 3


@kernel
def slows(rolling: Any, drag: Any) -> bool:
    """Tell whether anything slows a ball down that keeps to a wall."""
    if drag is None:
        return rolling is not None
    return True


@kernel
def pull_ahead(rolling: Any, drag: Any, tx: float, ty: float, gx: float, gy: float) -> Any:
    """Acceleration at no speed of a ball that moves in the direction t on a straight guide: g.t less mu |g.n|."""
    pull = gx * tx + gy * ty
    if not slows(rolling, drag):
        return pull
    # On a level wall nothing but rounding would move it for ever.
    if abs(pull) <= LEVEL * (abs(gx) + abs(gy)):
        pull = 0.0
    return pull - or_none(rolling) * abs(gx * ty - gy * tx)


@kernel
def or_none(rate):
    """A rate, or 0 for None."""
    if rate is None:
        return 0.0
    return rate


@kernel
def way_to_turn(drag, speed, pull):
    """How far a ball comes on a straight guide before it stands still; NEVER if it does not."""
    if drag is None:
        # v^2 + 2 (g.t) s = 0.
        return speed * speed / (-2.0 * pull) if pull < 0.0 else NEVER
    return NEVER if pull > 0.0 else along(drag, 0.0, speed, pull, _time_to_turn(drag, speed, pull))


@kernel
def _time_to_turn(drag, speed, pull):
    """When a ball that drag and a pull back slow down stands still: by drag alone after 50 halvings of its speed."""
    return HALVINGS / drag if pull == 0.0 else math.log1p(-drag * speed / pull) / drag


@rare_kernel
def slide_with_drag(drag, tx, ty, pull, x, y, speed, way, event, span):
    """Go ``way`` in the direction t, or as far as in the time ``span``: see ``contact_state.stretch``."""
    if event == TURNS:
        time, then = _time_to_turn(drag, speed, pull), 0.0
    elif way == NEVER:
        time, then = NEVER, speed
    else:
        time = time_of_way(drag, speed, pull, way)
        if time == NEVER:  # it stops there, but for rounding
            time = _time_to_turn(drag, speed, pull)
        then = max(speed_after(drag, speed, pull, time), 0.0)
    if way == 0.0:
        time = 0.0
    if time > span or (time == NEVER and span == NEVER):
        if span == NEVER:
            return x, y, speed * tx, speed * ty, 0.0, TIME_IS_UP
        way, then = along(drag, 0.0, speed, pull, span), max(speed_after(drag, speed, pull, span), 0.0)
        time, event = span, TIME_IS_UP
    return x + way * tx, y + way * ty, then * tx, then * ty, time, event


@rare_kernel
def swing_on(
    rolling: Any, drag: Any, rho: float, away: float, ex: float, ey: float, tx: float, ty: float, gx: float, gy: float,
    speed: float, way: float, span: float,
) -> Any:  # fmt: skip
    """Let a ball go round from e towards t, up to ``way`` = tan(phi / 2) <= 1, or for a time.

    Returns:
        (tan(phi / 2), speed, time, what ended it: GOES_ON, TURNS, LIFTS or TIME_IS_UP); GOES_ON before ``way``, too,
        after so many leaps.
    """
    mu, k = away * or_none(rolling), or_none(drag)
    along_t, along_e = gx * tx + gy * ty, gx * ex + gy * ey
    law = (along_t, along_e, rho, away, mu, k)
    pull = math.sqrt(gx * gx + gy * gy)
    u, w, time = 0.0, speed / rho, 0.0
    level = LEVEL * (abs(gx) + abs(gy))
    if away < 0.0 and abs(along_t) <= level and speed <= LEVEL * math.sqrt(pull * rho):
        return 0.0, 0.0, 0.0, TURNS  # at the bottom, with next to no speed: there it rests
    if _value(PRESS, law, u, w) <= 0.0 and _value(PRESSES_MORE, law, u, w) < 0.0:
        return u, speed, time, LIFTS
    for _leap in range(LEAPS):
        if time >= span:
            return u, w * rho, span, TIME_IS_UP
        rate = (1.0 + abs(mu)) * (w + math.sqrt(pull / rho)) + k
        step, event = LEAP / rate, GOES_ON
        if time + step >= span:
            step, event = span - time, TIME_IS_UP
        done, event = _first_event(law, u, w, step, way, event)
        more, faster = _leap_of(law, u, w, done)
        u, w, time = u + more, w + faster, time + done
        if event == TURNS:
            return u, 0.0, time, TURNS
        if event in (LIFTS, TIME_IS_UP):
            return min(u, way), max(w, 0.0) * rho, span if event == TIME_IS_UP else time, event
        if u >= way or done < step:
            return way, max(w, 0.0) * rho, time, GOES_ON
    return u, w * rho, time, GOES_ON


@rare_kernel
def _first_event(law, u, w, step, way, event):
    """Look what happens within a step: (time until then, event); GOES_ON for ``way``, or for nothing."""
    more, faster = _leap_of(law, u, w, step)
    # In a step that is short beside a swing the ball turns once at most: what turns it does not let go so soon.
    if w + faster <= 0.0:
        step, event = _when(SPEED, law, u, w, 0.0, step), TURNS
        more, faster = _leap_of(law, u, w, step)
    if u + more >= way:
        step, event = _when(ANGLE, law, u, w, way, step), GOES_ON
        more, faster = _leap_of(law, u, w, step)
    if _value(PRESS, law, u, w) > 0.0:
        if _value(PRESS, law, u + more, w + faster) <= 0.0:
            return _when(PRESS, law, u, w, 0.0, step), LIFTS
        if _value(PRESSES_MORE, law, u, w) < 0.0 < _value(PRESSES_MORE, law, u + more, w + faster):
            least = _when(PRESSES_MORE, law, u, w, 0.0, step)
            more, faster = _leap_of(law, u, w, least)
            if _value(PRESS, law, u + more, w + faster) <= 0.0:
                return _when(PRESS, law, u, w, 0.0, least), LIFTS
    return step, event


@rare_kernel
def _when(what, law, u, w, level, step):
    """When within a step a value comes to a level on whose other side it is at the end: Newton in a bracket."""
    more, faster = _leap_of(law, u, w, step)
    rises = _value(what, law, u + more, w + faster) >= level
    low, high, t = 0.0, step, 0.5 * step
    for _step in range(STEPS):
        more, faster = _leap_of(law, u, w, t)
        off = _value(what, law, u + more, w + faster) - level
        if (off >= 0.0) == rises:
            high = t
        else:
            low = t
        slope = _slope(what, law, u + more, w + faster)
        following = t - off / slope if slope != 0.0 else low
        if not low < following < high:
            following = 0.5 * (low + high)
        if abs(following - t) <= 2.0**-53 * step or following in (low, high):
            return following
        t = following
    return t


@kernel
def _value(what, law, u, w):
    """The angle u, the angular speed, what presses the ball, or the rate at which that grows."""
    along_t, along_e, rho, away, _mu, _k = law
    if what == ANGLE:
        return u
    if what == SPEED:
        return w
    per = 1.0 / (1.0 + u * u)
    c, s = (1.0 - u) * (1.0 + u) * per, 2.0 * u * per
    if what == PRESS:
        return -away * (along_e * c + along_t * s + rho * w * w)
    return -away * w * (along_t * c - along_e * s + 2.0 * rho * _faster(law, u, w))


@kernel
def _slope(what, law, u, w):
    """How fast a value changes; 0 where that is not known."""
    if what == ANGLE:
        return 0.5 * w * (1.0 + u * u)
    if what == SPEED:
        return _faster(law, u, w)
    return _value(PRESSES_MORE, law, u, w) if what == PRESS else 0.0


@kernel
def _faster(law, u, w):
    """W' = ((g.t + mu g.e) cos + (mu g.t - g.e) sin) / rho + mu W^2 - k W, with mu turned round in a hollow."""
    along_t, along_e, rho, _away, mu, k = law
    per = 1.0 / (1.0 + u * u)
    c, s = (1.0 - u) * (1.0 + u) * per, 2.0 * u * per
    return ((along_t + mu * along_e) * c + (mu * along_t - along_e) * s) / rho + w * (mu * w - k)


@rare_kernel
def _leap_of(law, u, w, step):
    """By how much u and W change in a step: see above."""
    # The weights of the extrapolation in the squares of the steps: the product of n^2 / (n^2 - m^2) over the others m.
    a, b = _midpoint(law, u, w, step, 2)
    u_sum, w_sum = a * (-1.0 / 302400.0), b * (-1.0 / 302400.0)
    a, b = _midpoint(law, u, w, step, 4)
    u_sum, w_sum = u_sum + a * (8.0 / 945.0), w_sum + b * (8.0 / 945.0)
    a, b = _midpoint(law, u, w, step, 6)
    u_sum, w_sum = u_sum - a * (2187.0 / 4480.0), w_sum - b * (2187.0 / 4480.0)
    a, b = _midpoint(law, u, w, step, 8)
    u_sum, w_sum = u_sum + a * (65536.0 / 14175.0), w_sum + b * (65536.0 / 14175.0)
    a, b = _midpoint(law, u, w, step, 10)
    u_sum, w_sum = u_sum - a * (9765625.0 / 798336.0), w_sum - b * (9765625.0 / 798336.0)
    a, b = _midpoint(law, u, w, step, 12)
    return u_sum + a * (17496.0 / 1925.0), w_sum + b * (17496.0 / 1925.0)


@kernel
def _midpoint(law, u, w, step, count):
    """The change of u and W in a step, by Gragg's midpoint rule in ``count`` parts, smoothed at the end."""
    part = step / count
    # Sums of changes, not places: a step is short, and so is the rounding of its change.
    a0 = b0 = 0.0
    a, b = part * 0.5 * w * (1.0 + u * u), part * _faster(law, u, w)
    for _part in range(count - 1):
        now, speed = u + a, w + b
        a, a0 = a0 + part * speed * (1.0 + now * now), a
        b, b0 = b0 + 2.0 * part * _faster(law, now, speed), b
    now, speed = u + a, w + b
    return 0.5 * (a + a0 + part * 0.5 * speed * (1.0 + now * now)), 0.5 * (b + b0 + part * _faster(law, now, speed))
