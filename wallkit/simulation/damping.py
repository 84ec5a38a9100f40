"""Rolling friction and linear drag: what a scene may ask for, and where a slowed ball is between contacts."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from wallkit.geometry.arrays import FloatArray
from wallkit.kernels.flight.damping import AS_GOOD_AS_NONE, last_flight
from wallkit.kernels.impact.drag_motion import eased
from wallkit.scene.scene import Scene, SceneError, falls

LEAST = 2.0**-500
"""A smaller friction or drag changes no digit of a run, and products with it would lose theirs."""
LEAST_FALLING = 1e-70
"""The same under gravity, where speeds and gravity are known to work from there on, see ``modelled.FALLING``."""


class Slowing(NamedTuple):
    """What slows balls down under gravity."""

    rolling: float | None
    """Coefficient of rolling friction: what presses a ball on a wall, times this, slows it down; or None."""
    drag: float | None
    """Rate k of dv/dt = g - k v, or None."""


def damping_of(scene: Scene) -> FloatArray | None:
    """What slows the balls of a scene without gravity down: (rolling friction, drag), one of them 0; or None.

    Raises:
        SceneError: a value is negative or not finite, or both act, which have no joint closed form.
    """
    friction, drag = _rates(scene)
    if falls(scene) or (friction == 0.0 and drag == 0.0):
        return None
    if friction > 0.0 and drag > 0.0:
        raise SceneError("rolling friction and drag act together", code="bad-damping", fix="give one of them")
    return np.array([friction, drag])


def slowing_of(scene: Scene) -> Slowing:
    """What slows the balls of a scene under gravity down; nothing without gravity.

    There a ball is pressed on the walls, not on the plane in which it moves: rolling friction acts on one that keeps
    to a wall, and is what slows it down on a level one. So N / |g| of it acts where N presses the ball on the wall.

    Raises:
        SceneError: a value is negative or not finite.
    """
    friction, drag = _rates(scene)
    if not falls(scene):
        return Slowing(None, None)
    pull = float(np.hypot(*np.ravel(scene.gravity or (0.0, 0.0))))
    return Slowing(friction / pull if friction > 0.0 else None, drag if drag > 0.0 else None)


def _rates(scene: Scene) -> tuple[float, float]:
    """Rolling friction and drag, 0 where they change no digit."""
    friction, drag = scene.rolling_friction or 0.0, scene.drag or 0.0
    for name, value in (("rolling_friction", friction), ("drag", drag)):
        if not (math.isfinite(value) and value >= 0.0):
            raise SceneError(f"{name} is {value!r}", code="bad-damping", fix="give a number, 0 or more")
    least = LEAST_FALLING if falls(scene) else LEAST
    return friction if friction >= least else 0.0, drag if drag >= least else 0.0


def carried_on(damping: FloatArray, state: FloatArray, span: float) -> FloatArray:
    """Give x, y, vx, vy a time after a contact, or after an infinite one: where the ball comes to rest.

    Args:
        damping: of :func:`damping_of`.
        state: (4,) x, y, vx, vy just after the contact.
        span: seconds since then.
    """
    x, y, vx, vy = state.tolist()
    energy = vx * vx + vy * vy
    if energy == 0.0:
        return state
    t, kept, _time, _lost = last_flight(damping.tolist(), energy, 0.0, 0.0, span)
    return np.array([x + t * vx, y + t * vy, kept * vx, kept * vy])


def flown_on(
    drag: float | None, position: FloatArray, velocity: FloatArray, pull: FloatArray, time: FloatArray
) -> FloatArray:
    """(n, 4) x, y, vx, vy of (n, 2) positions and velocities after (n, 1) times of flight, see ``drag_motion``."""
    if drag is None:
        return np.hstack([position + time * (velocity + 0.5 * time * pull), velocity + time * pull])
    left, free, second = np.array([eased(drag, float(t)) for t in time[:, 0]]).reshape(-1, 3).T[:, :, None]
    return np.hstack([position + (velocity * free + pull * second), velocity * left + pull * free])


def on_a_free_clock(damping: FloatArray, start: FloatArray, own: Any) -> tuple[FloatArray, FloatArray]:
    """Give the contacts of one slowed ball the times and velocities that they had if nothing slowed it down.

    Args:
        damping: of :func:`damping_of`.
        start: (4,) x, y, vx, vy at time 0.
        own: (n,) its contacts, of ``wallkit.simulation.run.CONTACT``, in order.

    Returns:
        (n,) times, and (n, 2) velocities after the contacts.
    """
    friction, drag = damping.tolist()
    velocity = np.stack([own["vx"], own["vy"]], axis=1)
    length = np.hypot(np.diff(own["x"], prepend=start[0]), np.diff(own["y"], prepend=start[1]))
    speed = np.hypot(*np.concatenate([start[None, 2:4], velocity])[:-1].T)
    lost = drag * length / speed if drag > 0.0 else 2.0 * friction * length / (speed * speed)
    left = np.maximum(1.0 - lost, AS_GOOD_AS_NONE)
    kept = np.cumprod(left if drag > 0.0 else np.sqrt(left))
    before = np.concatenate([[1.0], kept])[:-1]
    return np.cumsum(length / speed * before), velocity / kept[:, None]
