"""How a small error is carried along a circle to which a ball keeps: the derivative of a pendulum.

With the direction e from the circle's middle, the unit t a quarter to the left of it, and the speed v along t, an error
is a way xi = rho da along t and a change eta of v, that is dx = xi t and dv = eta t - (v xi / rho) e, for t turns with
the place. After a time it is M (xi, eta), M the derivative of the closed motion by its start (the solution of
xi'' = -(g.e / rho) xi, the variational equation). That is taken as the difference of two such motions that start apart
by 2 h: off by h^2, parts in 10^10, which is far nearer than any promise needs, through turns and whole periods alike.

Where friction or drag acts, a ball's way ends where it turns, and so does that of a motion that starts apart from it:
so the difference is taken shortly before, and goes on from there as in a flight. One that sets out from where it has
turned does not set out the other way, so that only one motion starts apart from it, quicker by h: off by h, parts in
10^5.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from wallkit.geometry.arrays import FloatArray
from wallkit.kernels.flight.slowed_contact import slows
from wallkit.scene.scene import Scene
from wallkit.simulation.damping import Slowing, slowing_of
from wallkit.simulation.gliding import glide, guides

APART = 2.0**-17
"""h: in radians, and in parts of sqrt(g rho)."""
COLUMNS = 13
"""Velocity and its change in time at the end, t at the start and at the end, M by rows, and -v / rho at the end."""


def glides_of(scene: Scene, own: NDArray[Any], gravity: FloatArray) -> FloatArray:
    """(n, COLUMNS) what :func:`wallkit.kernels.flight.error_growth.carry` needs of the way to each contact.

    Args:
        scene: what was run.
        own: (n,) contacts of one ball, in order.
        gravity: (2,).

    Returns:
        Not-a-number in rows to which the ball came no circle along.
    """
    found = np.full((len(own), COLUMNS), math.nan)
    slowing, bent = slowing_of(scene), guides(scene.walls, own)
    for row in np.flatnonzero(bent[:-1]).tolist() if len(own) else ():
        span = float(own["time"][row + 1] - own["time"][row])
        stops = slows(*slowing) and own["vx"][row + 1] == 0.0 and own["vy"][row + 1] == 0.0
        found[row + 1] = _Glide.of(own[row], float(bent[row]), gravity, slowing).row(span, stops)
    return found


class _Glide(NamedTuple):
    """A ball at the start of its way along a circle: radius, signed as of ``guides``, e, t, v and the place."""

    bent: float
    out: FloatArray
    ahead: FloatArray
    speed: float
    place: FloatArray
    gravity: FloatArray
    slowing: Slowing

    @staticmethod
    def of(contact: Any, bent: float, gravity: FloatArray, slowing: Slowing) -> _Glide:
        out = np.array([contact["nx"], contact["ny"]]) * math.copysign(1.0, bent)
        ahead = np.array([-out[1], out[0]])
        speed = float(contact["vx"] * ahead[0] + contact["vy"] * ahead[1])
        return _Glide(bent, out, ahead, speed, np.array([contact["x"], contact["y"]]), gravity, slowing)

    def after(self, span: float, turn: float = 0.0, more: float = 0.0) -> tuple[FloatArray, FloatArray, float]:
        """Directions e and t and the speed after a time, from a start turned by an angle and quicker by ``more``."""
        c, s, rho = math.cos(turn), math.sin(turn), abs(self.bent)
        e, t = c * self.out + s * self.ahead, c * self.ahead - s * self.out
        state = np.concatenate([self.place + rho * (e - self.out), (self.speed + more) * t])
        there = glide(self.gravity, self.slowing, state, math.copysign(1.0, self.bent) * e, self.bent, span)
        e = (there[:2] - self.place) / rho + self.out
        t = np.array([-e[1], e[0]])
        return e, t, float(there[2:4] @ t)

    def row(self, span: float, stops: bool = False) -> list[float]:
        """Give the columns of :func:`glides_of`; it ``stops`` where something that slows it down has it turn."""
        rho, pull = abs(self.bent), float(np.hypot(*self.gravity))
        quick = APART * math.sqrt(pull * rho)
        e, t, then = self.after(span)
        force = self._force(e, t, 0.0 if stops else then)
        # it is quicker than `quick` until then, unless it hardly moves at all
        left = min(4.0 * quick / abs(force), span) if stops and force != 0.0 else 0.0
        turned = [self.after(span - left, turn) for turn in (APART, -APART)]
        if self.speed == 0.0 and slows(*self.slowing):
            quick = math.copysign(quick, float(self.gravity @ self.ahead))
            quicker, most = [self.after(span - left, 0.0, more) for more in (quick, 0.0)], quick
        else:
            quicker, most = [self.after(span - left, 0.0, more) for more in (quick, -quick)], 2.0 * quick
        columns = []
        for ((one, _, fast), (other, _, slow)), apart in ((turned, 2.0 * rho * APART), (quicker, most)):
            angle = math.atan2(other[0] * one[1] - other[1] * one[0], float(other @ one))
            way, change = rho * angle / apart, (fast - slow) / apart
            columns.append((way + change * left, change))
        (a, c), (b, d) = columns
        changes = force * t - then * then / rho * e
        return [*(then * t), *changes, *self.ahead, *t, a, b, c, d, -then / rho]

    def _force(self, e: FloatArray, t: FloatArray, speed: float) -> float:
        """Acceleration along t at a speed along t; at none it has come against what pulls it."""
        along, away = float(self.gravity @ t), math.copysign(1.0, self.bent)
        pressed = -away * (float(self.gravity @ e) + speed * speed / abs(self.bent))
        ahead = math.copysign(1.0, speed if speed != 0.0 else -along)
        return along - ahead * (self.slowing.rolling or 0.0) * pressed - (self.slowing.drag or 0.0) * speed
