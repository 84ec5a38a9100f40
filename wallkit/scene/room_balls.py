"""Balls anywhere in a room, evenly, each drawn from its own number."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np

from wallkit.arguments import floats, number, of_type, refused, whole_number
from wallkit.geometry.arrays import FloatArray
from wallkit.scene.scene import Balls, SceneError
from wallkit.scene.starting_places import Spot, room_for, roomiest
from wallkit.walls import Walls


@dataclass(frozen=True, slots=True, eq=False)
class RoomBalls:
    """Balls evenly in a room and in all directions, each drawn from its own number by a counter-based generator.

    Ball i is the same whatever is drawn with it: block i of Philox (Salmon et al., "Parallel random numbers: as easy as
    1, 2, 3", 2011) with the seed as key has four numbers u from 0 to 1. The first chooses a triangle by area; the next
    two the place a + sqrt(u) ((b - a) + w (c - b)), which is even over a triangle a, b, c (Turk, "Generating random
    points in triangles", Graphics Gems, 1990); the last the direction.

    Attributes:
        triangles: (T, 3, 2) float64, that together are where a centre may be.
        speed: of all, units per second.
        radius: of all.
        seed: any whole number, 0 or more.

    Raises:
        SceneError: there is no triangle with an area, or a number is out of range.
    """

    triangles: FloatArray
    speed: float = 1.0
    radius: float = 0.0
    seed: int = 0
    _shares: FloatArray = field(init=False, repr=False)

    def __post_init__(self) -> None:
        may_be = "(T, 3, 2) finite numbers: triangles, one of them at least with an area"
        corners = floats(self.triangles, "triangles", may_be, error=SceneError, code="bad-balls")
        if corners.ndim != 3 or corners.shape[1:] != (3, 2) or not np.isfinite(corners).all():
            raise refused("triangles", self.triangles, may_be, SceneError, "bad-balls")
        (x1, y1), (x2, y2) = (corners[:, 1] - corners[:, 0]).T, (corners[:, 2] - corners[:, 0]).T
        shares = np.cumsum(0.5 * np.abs(x1 * y2 - y1 * x2))
        if not len(shares) or not shares[-1] > 0.0:
            raise refused("triangles", self.triangles, may_be, SceneError, "bad-balls")
        for name in ("speed", "radius"):
            may_be = "a finite number, 0 or more"
            number(getattr(self, name), name, may_be, error=SceneError, code="bad-balls", least=0.0)
        whole_number(self.seed, "seed", "a whole number, 0 or more", error=SceneError, code="bad-balls", least=0)
        object.__setattr__(self, "triangles", corners)
        object.__setattr__(self, "_shares", shares / shares[-1])

    @staticmethod
    def of(walls: Walls, speed: float = 1.0, radius: float = 0.0, seed: int = 0, spot: Spot | None = None) -> RoomBalls:
        """Draw balls wherever one of this radius fits in the room around a spot: the roomiest, where none is given.

        Places keep away from curved walls by 2e-5 of the room's size: the room is made of lines here.

        Raises:
            SceneError: a ball of that radius has no room, or a number is out of range.
        """
        import shapely

        of_type(walls, "walls", Walls, "Walls", error=SceneError, code="bad-balls")
        radius = number(radius, "radius", "a finite number, 0 or more", error=SceneError, code="bad-balls", least=0.0)
        spot = roomiest(walls) if spot is None else spot
        if spot is None:
            fix = "close the walls, or give places"
            raise SceneError("there is no room for a ball inside these walls", code="no-room", fix=fix)
        parts = shapely.get_parts(shapely.constrained_delaunay_triangles(room_for(spot, radius)))
        corners = shapely.get_coordinates(parts).reshape(-1, 4, 2)[:, :3]
        return RoomBalls(np.ascontiguousarray(corners), speed, radius, seed)

    def __call__(self, first: int, count: int) -> Balls:
        """Draw balls ``first`` to ``first + count``."""
        block = np.random.Generator(np.random.Philox(key=self.seed).advance(first)).random((count, 4))
        which = np.minimum(np.searchsorted(self._shares, block[:, 0], side="right"), len(self._shares) - 1)
        a, b, c = (self.triangles[which, corner] for corner in range(3))
        out, across = np.sqrt(block[:, 1:2]), block[:, 2:3]
        angle = 2.0 * math.pi * block[:, 3]
        velocity = self.speed * np.stack([np.cos(angle), np.sin(angle)], axis=1)
        return Balls(a + out * ((b - a) + across * (c - b)), velocity, self.radius)
