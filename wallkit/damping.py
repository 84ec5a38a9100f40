"""Rolling friction and linear drag: the path is that of a ball without them, only the clock and the speed differ.

Along a flight of length l a ball of speed u slows down to w:

* rolling friction, du/dt = -a: w^2 = u^2 - 2 a l, in the time 2 l / (u + w); it stops after u^2 / (2 a), at u / a;
* drag, du/dt = -k u: w = u - k l, in the time ln(u / w) / k; it comes to rest after u / k, but never quite.

A contact changes the speed by the same factor with and without them.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from wallkit.scene import Scene, SceneError


@dataclass(frozen=True, slots=True)
class Damping:
    """What slows a ball down between contacts; one of the two is 0.

    Attributes:
        friction: deceleration by rolling, units per second squared.
        drag: rate at which speed is lost, per second.
    """

    friction: float = 0.0
    drag: float = 0.0

    def way(self, speed: float) -> float:
        """Length of the path on which a ball comes to rest."""
        return speed * speed / (2.0 * self.friction) if self.friction > 0.0 else speed / self.drag

    def after(self, speed: float, length: float) -> float:
        """Speed after a length of path, which is shorter than ``way``."""
        if self.friction > 0.0:
            return math.sqrt(max(speed * speed - 2.0 * self.friction * length, 0.0))
        return max(speed - self.drag * length, 0.0)

    def time(self, speed: float, length: float) -> float:
        """Time that a length of path takes."""
        end = self.after(speed, length)
        if self.friction > 0.0:
            return 2.0 * length / (speed + end) if speed > 0.0 else math.inf
        return -math.log1p(-self.drag * length / speed) / self.drag if end > 0.0 else math.inf

    def length(self, speed: float, time: float) -> float:
        """Length of the path after a time."""
        if self.friction > 0.0:
            time = min(time, speed / self.friction)
            return time * (speed - 0.5 * self.friction * time)
        return -speed * math.expm1(-self.drag * time) / self.drag


def damping_of(scene: Scene) -> Damping | None:
    """What slows the balls of a scene down, or None.

    Raises:
        SceneError: a value is negative or not finite, or two things act that have no joint closed form.
    """
    friction, drag = scene.rolling_friction or 0.0, scene.drag or 0.0
    for name, value in (("rolling_friction", friction), ("drag", drag)):
        if not (math.isfinite(value) and value >= 0.0):
            raise SceneError(f"{name} is {value!r}", code="bad-damping", fix="give a number, 0 or more")
    if friction == 0.0 and drag == 0.0:
        return None
    if friction > 0.0 and drag > 0.0:
        raise SceneError("rolling friction and drag act together", code="bad-damping", fix="give one of them")
    if scene.gravity is not None and any(scene.gravity):
        raise SceneError(
            "rolling friction and drag are for a plane without gravity", code="bad-damping", fix="leave one of them out"
        )
    return Damping(friction, drag)


def refuse_damping(scene: Scene) -> None:
    """Refuse friction and drag where only ``simulate`` knows them.

    Raises:
        SceneError: the scene has one of them.
    """
    if damping_of(scene) is not None:
        raise SceneError(
            "only simulate knows rolling friction and drag", code="not-yet", fix="use simulate, or leave them out"
        )


class Slowed:
    """One ball's clock: contacts of the ball that is not slowed down go in, in order, and come out slowed.

    Attributes:
        state: x, y, vx, vy, time of the ball now.
        at_rest: the ball has come to rest (with drag: at the end of its path, in infinite time).
        done: nothing more can come: it rests, or its time is up.
    """

    def __init__(self, damping: Damping, start: Any, until: float) -> None:
        self.damping = damping
        self.until = until
        self.state = [*(float(value) for value in start), 0.0]
        self.speed = self.free_speed = math.hypot(self.state[2], self.state[3])
        self.at_rest = self.done = self.speed == 0.0

    def contact(self, x: float, y: float, vx: float, vy: float) -> tuple[float, float, float] | None:
        """Go on to the next contact of the ball that is not slowed: (time, vx, vy) of this one, or None if it ends."""
        length = math.hypot(x - self.state[0], y - self.state[1])
        far = length >= self.damping.way(self.speed)
        time = math.inf if far else self.state[4] + self.damping.time(self.speed, length)
        if far or time > self.until:
            self.stop()
            return None
        after = self.damping.after(self.speed, length)
        free_speed = math.hypot(vx, vy)
        self.speed = after * (free_speed / self.free_speed)
        factor = self.speed / free_speed if free_speed > 0.0 else 0.0
        self.free_speed = free_speed
        self.state = [x, y, vx * factor, vy * factor, time]
        self.at_rest = self.done = self.speed == 0.0
        return time, self.state[2], self.state[3]

    def stop(self) -> None:
        """End on the flight that is under way, by the time or at rest."""
        x, y, vx, vy, time = self.state
        self.done = True
        if self.speed == 0.0:
            self.at_rest = True
            return
        length = self.damping.length(self.speed, self.until - time)
        self.at_rest = self.damping.friction > 0.0 and self.until - time >= self.speed / self.damping.friction
        self.at_rest = self.at_rest or (self.damping.drag > 0.0 and self.until == math.inf)
        end = self.until
        if self.at_rest:
            length = self.damping.way(self.speed)
            end = time + self.speed / self.damping.friction if self.damping.friction > 0.0 else math.inf
        after = 0.0 if self.at_rest else self.damping.after(self.speed, length)
        ux, uy = vx / self.speed, vy / self.speed
        self.state = [x + length * ux, y + length * uy, after * ux, after * uy, end]


def slowed_between(damping: Damping, state: NDArray[np.float64], span: float) -> NDArray[np.float64]:
    """Give x, y, vx, vy a time after a contact."""
    speed = math.hypot(state[2], state[3])
    if speed == 0.0:
        return state
    length = damping.length(speed, span)
    after = damping.after(speed, length) if length < damping.way(speed) else 0.0
    way = state[2:4] / speed
    return np.concatenate([state[0:2] + length * way, after * way])
