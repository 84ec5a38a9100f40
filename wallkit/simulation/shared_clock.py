"""One clock for all balls that the same drag slows down: on it they fly as if nothing did.

With dv/dt = -c v a ball that has the speed u at the time 0 has e^(-c t) u at t, whatever it met on the way, and has
flown s u with the *free time* s = (1 - e^(-c t)) / c. On that clock all fly straight at constant speeds, as seen from
one another too; what a contact does to velocities it does to all in proportion. So only times and speeds are to be
told anew: t = -ln(1 - c s) / c, v = (1 - c s) u. After 50 halvings of the speed the way left is below rounding.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from wallkit.geometry.arrays import FloatArray
from wallkit.kernels.flight.damping import AS_GOOD_AS_NONE


@dataclass(frozen=True, slots=True)
class SharedClock:
    """Times and free times under a drag, its rate c per second above 0."""

    drag: float

    @property
    def whole(self) -> float:
        """Free time after which the balls count as stopped."""
        return (1.0 - AS_GOOD_AS_NONE) / self.drag

    def free(self, time: float) -> float:
        """Free time of a time, which may be inf; ``whole`` at most."""
        return min(-math.expm1(-self.drag * time) / self.drag, self.whole)

    def kept(self, free: FloatArray) -> FloatArray:
        """Part of the speed that is left after free times."""
        return 1.0 - self.drag * free

    def time(self, free: FloatArray) -> FloatArray:
        """Times of free times."""
        times: FloatArray = -np.log1p(-self.drag * free) / self.drag
        return times
