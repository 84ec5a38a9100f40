"""Balls that threads share out among themselves: each takes some when it has none left."""

from __future__ import annotations

from typing import Any, NamedTuple

from wallkit.kernels.intrinsics import claim
from wallkit.kernels.jit import kernel
from wallkit.kernels.records import NO_HIT

BLOCK = 64
"""Balls taken at a time: few enough to end together, enough to keep threads off one another's memory."""
NO_BALL = NO_HIT


class Queue(NamedTuple):
    """Which balls are still to fly."""

    counter: Any
    """One integer, shared by all threads: the first ball that no thread has taken."""
    taken: Any
    """Two integers of one thread: balls from the first to before the second it has taken and not flown."""


@kernel
def next_ball(queue, stop):
    """Number of a ball below ``stop`` that is not flown yet, or NO_BALL."""
    taken = queue.taken
    if taken[0] == taken[1]:
        # One atomic addition for BLOCK balls, so that threads seldom meet at the counter.
        taken[0] = claim(queue.counter, BLOCK)
        taken[1] = taken[0] + BLOCK
    if taken[0] >= stop:
        return NO_BALL
    taken[0] += 1
    return taken[0] - 1
