"""Rolling friction and linear drag: the path is that of a ball without them, only the clock and the speed differ.

What a ball of speed u flies in its *free time* t, that is to say u t, takes a slowed one longer, and leaves it k u:

* rolling friction, du/dt = -a, which stops the ball after s = u / a, in the free time s / 2: k^2 = 1 - 2 t / s, and it
  takes 2 t / (1 + k);
* drag, du/dt = -c u, which takes for ever to stop it, in the free time 1 / c: k = 1 - c t, and it takes -ln(k) / c.

``damping`` is (a, c), one of them 0, or None: then a free time is a time.
"""

from __future__ import annotations

import math

from wallkit.kernels.flight.motion import advance
from wallkit.kernels.jit import kernel

AS_GOOD_AS_NONE = 2.0**-50
"""Of a flight that drag slows down, the part of the speed, and of the whole way, that is left when the ball counts as
stopped: some roundings of that way. What is left is never 0, so that its logarithm is a number."""
HALVINGS = 50.0 * math.log(2.0)


@kernel
def stopping(damping, energy):
    """Time after which a ball of squared speed ``energy`` stops, and the free time of that."""
    if damping[1] > 0.0:
        # Drag never stops it quite: after 50 halvings of the speed the way that is left is below rounding.
        return HALVINGS / damping[1], (1.0 - AS_GOOD_AS_NONE) / damping[1]
    # u - a T = 0; the way u^2 / 2 a takes half that time at the speed u.
    stop = rolling_stop(damping, energy)
    return stop, 0.5 * stop


@kernel
def rolling_stop(damping, energy):
    """Time after which rolling friction has stopped a ball of squared speed ``energy``."""
    return math.sqrt(energy) / damping[0]


@kernel
def free_time(damping, energy, span):
    """Free time of a ball of squared speed ``energy`` in a span of time, which may be inf."""
    if damping is None:
        return span
    if damping[1] > 0.0:
        stop, whole = stopping(damping, energy)
        if span >= stop:
            return whole
        # The way in T is u (1 - e^(-c T)) / c.
        return min(-math.expm1(-damping[1] * span) / damping[1], whole)
    return free_time_rolling(rolling_stop(damping, energy), span)


@kernel
def free_time_rolling(stop, span):
    """``free_time`` of a ball that rolling friction stops after a time."""
    # The way in T is u T - a T^2 / 2 = u T (1 - T / 2 stop).
    return 0.5 * stop if span >= stop else span * (1.0 - 0.5 * (span / stop))


@kernel
def slowed(damping, energy, t, most):
    """What a free time t, less than that of the span ``most``, takes, and the part of the speed that it leaves."""
    if damping is None:
        return t, 1.0
    if damping[1] > 0.0:
        # c t = 1 - e^(-c T), so T = -ln(1 - c t) / c, and e^(-c T) = 1 - c t of the speed is left.
        part = damping[1] * t
        return min(-math.log1p(-part) / damping[1], most), 1.0 - part
    return slowed_rolling(rolling_stop(damping, energy), t, most)


@kernel
def slowed_rolling(stop, t, most):
    """``slowed`` of a ball that rolling friction stops after a time."""
    # u'^2 = u^2 - 2 a u t, and the way u t at the mean speed (u + u') / 2 takes 2 t / (1 + k), k = u' / u.
    kept = math.sqrt(1.0 - 2.0 * t / stop)
    taken = 2.0 * t / (1.0 + kept)
    return taken if taken < most else most, kept


@kernel
def last_flight(damping, energy, time, lost, until):
    """How a flight without a contact ends, as time is up or the ball stops.

    Returns:
        (free time, part of the speed that is left, time and what it lost to rounding then).
    """
    span = (until - time) - lost
    if damping is None:
        return span, 1.0, until, 0.0
    stop, whole = stopping(damping, energy)
    if span >= stop:
        time, lost = advance(time, lost, stop)
        return whole, 0.0, time, lost
    kept = math.exp(-damping[1] * span) if damping[1] > 0.0 else 1.0 - span / stop
    return free_time(damping, energy, span), kept, until, 0.0
