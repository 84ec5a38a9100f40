"""Scene: walls, balls, and only what acts. What a scene lacks costs nothing."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike, NDArray

from importers.errors import WallkitError
from wallkit.walls import Walls

FloatArray = NDArray[np.float64]


class SceneError(WallkitError):
    """A scene that cannot be simulated; the message says which part, and where."""


@dataclass(slots=True, eq=False)
class Balls:
    """Balls that do not meet one another: discs, or points where the radius is 0.

    Attributes:
        position: (n, 2) float64, centres, in the walls' units.
        velocity: (n, 2) float64, units per second.
        radius: (n,) float64, each >= 0; one number given stands for all.
    """

    position: ArrayLike
    velocity: ArrayLike
    radius: ArrayLike = 0.0


@dataclass(slots=True, eq=False)
class Scene:
    """What is simulated.

    Attributes:
        walls: see :class:`wallkit.walls.Walls`.
        balls: see :class:`Balls`.
        gravity: (gx, gy) in units per second squared, or None.
    """

    walls: Walls
    balls: Balls = field(default_factory=lambda: Balls(np.empty((0, 2)), np.empty((0, 2))))
    gravity: tuple[float, float] | None = None
