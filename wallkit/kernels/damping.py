"""Rolling friction and linear drag: the path is that of a ball without them, only the clock and the speed differ.

What a ball of speed u flies in its *free time* t, that is to say u t, takes a slowed one longer, and leaves it k u:

* rolling friction, du/dt = -a, which stops the ball after s = u / a, in the free time s / 2: k^2 = 1 - 2 t / s, and it
  takes 2 t / (1 + k);
* drag, du/dt = -c u, which all but stops it in the free time 1 / c: k = 1 - c t, and it takes -ln(k) / c.

``damping`` is (a, c), one of them 0, or None: then a free time is a time.
"""

from __future__ import annotations

import math

from wallkit.kernels.jit import kernel
from wallkit.kernels.motion import advance

ALL_BUT = 1.0 - 2.0**-52
"""The part of its way after which drag counts as having stopped a ball: 1 would take for ever; the rest is rounding."""


@kernel
def free_time(damping, energy, span):
    """Free time of a ball of squared speed ``energy`` in a span of time, which may be inf."""
    if damping is None:
        return span
    if damping[1] > 0.0:
        return min(-math.expm1(-damping[1] * span), ALL_BUT) / damping[1]
    stop = math.sqrt(energy) / damping[0]
    if span >= stop:
        return 0.5 * stop
    return span * (1.0 - 0.5 * (span / stop))


@kernel
def slowed(damping, energy, t, most):
    """What a free time t, less than that of the span ``most``, takes, and the part of the speed that it leaves."""
    if damping is None:
        return t, 1.0
    if damping[1] > 0.0:
        part = damping[1] * t
        return min(-math.log1p(-part) / damping[1], most), 1.0 - part
    kept = math.sqrt(1.0 - 2.0 * t / (math.sqrt(energy) / damping[0]))
    return min(2.0 * t / (1.0 + kept), most), kept


@kernel
def last_flight(damping, energy, time, lost, until):
    """How a flight without a contact ends, as time is up or the ball stops.

    Returns:
        (free time, part of the speed that is left, time and what it lost to rounding then).
    """
    span = (until - time) - lost
    t = free_time(damping, energy, span)
    if damping is None:
        return t, 1.0, until, 0.0
    if damping[1] > 0.0:
        return t, math.exp(-damping[1] * span), until, 0.0
    stop = math.sqrt(energy) / damping[0]
    if span < stop:
        return t, 1.0 - span / stop, until, 0.0
    time, lost = advance(time, lost, stop)
    return t, 0.0, time, lost
