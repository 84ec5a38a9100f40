"""Scene: walls, balls, and only what acts. What a scene lacks costs nothing."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike, NDArray

from importers.errors import WallkitError
from importers.pictured import Pictured
from wallkit.walls import Walls

FloatArray = NDArray[np.float64]


class SceneError(WallkitError):
    """A scene that cannot be simulated; the message says which part, and where."""


@dataclass(slots=True, eq=False)
class Balls:
    """Balls that do not meet one another: discs, or points where the radius is 0.

    Attributes:
        position: (n, 2) float64, centres, in the walls' units; one pair stands for one ball.
        velocity: (n, 2) float64, units per second.
        radius: (n,) float64, each >= 0; one number given stands for all.

    Raises:
        SceneError: a shape is wrong, a number is not finite, or a radius is negative.
    """

    position: ArrayLike
    velocity: ArrayLike
    radius: ArrayLike = 0.0

    def __post_init__(self) -> None:
        position, velocity = (_pairs(getattr(self, name), name) for name in ("position", "velocity"))
        if len(position) != len(velocity):
            raise SceneError(
                f"{len(position)} positions for {len(velocity)} velocities",
                code="bad-balls",
                fix="give one velocity a ball",
            )
        radius = np.asarray(self.radius, dtype=np.float64)
        if radius.ndim > 1 or (radius.ndim == 1 and len(radius) != len(position)):
            raise SceneError(f"radius has the shape {radius.shape} for {len(position)} balls", code="bad-balls")
        if not (np.isfinite(radius).all() and (radius >= 0).all()):
            raise SceneError("a radius is negative or not finite", code="bad-balls", fix="give 0 for a point")
        self.position, self.velocity = position, velocity
        self.radius = np.ascontiguousarray(np.broadcast_to(radius, (len(position),)))

    def __len__(self) -> int:
        return len(np.asarray(self.position))


@dataclass(slots=True, eq=False)
class Scene(Pictured):
    """What is simulated.

    Attributes:
        walls: see :class:`wallkit.walls.Walls`.
        balls: see :class:`Balls`.
        gravity: (gx, gy) in units per second squared, or None.
        rolling_friction: constant deceleration of a rolling ball, units per second squared, or None.
        drag: rate k of dv/dt = -k v, per second, or None; neither acts together with the other or with gravity. Drag
            takes for ever to stop a ball; at 2^-50 of the speed with which its flight began the ball is at rest.
        sensors: walls that report each crossing of a ball's centre and do not bounce it, or None.
    """

    walls: Walls
    balls: Balls = field(default_factory=lambda: Balls(np.empty((0, 2)), np.empty((0, 2))))
    gravity: tuple[float, float] | None = None
    rolling_friction: float | None = None
    drag: float | None = None
    sensors: Walls | None = None


def _pairs(values: ArrayLike, name: str) -> FloatArray:
    array = np.array(values, dtype=np.float64, order="C")
    if array.shape == (2,):
        array = array.reshape(1, 2)
    if array.ndim != 2 or array.shape[1] != 2:
        raise SceneError(f"{name} has the shape {array.shape}", code="bad-balls", fix="give an (n, 2) array")
    if not np.isfinite(array).all():
        raise SceneError(f"a {name} is not finite", code="bad-balls")
    return array
