"""Scene: walls, balls, and only what acts. What a scene lacks costs nothing."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from importers.errors import WallkitError
from importers.pictured import Pictured
from wallkit import arguments
from wallkit.geometry.arrays import FloatArray
from wallkit.walls import Walls


class SceneError(WallkitError):
    """A scene that cannot be simulated; the message says which part, and where."""


@dataclass(slots=True, eq=False, repr=False, init=False, frozen=True)
class Balls:
    """Balls: discs, or points where the radius is 0. Discs meet one another where their scene says ``meeting``.

    The constructor takes anything that NumPy makes such arrays of, one pair for one ball, and one radius for all.

    Attributes:
        position: (n, 2) float64, centres, in the walls' units.
        velocity: (n, 2) float64, units per second.
        radius: (n,) float64, each >= 0.
        mass: (n,) float64, in any unit; by default the area of each disc, pi r^2. Only the masses of discs that meet
            matter, and each of them is above 0.

    Raises:
        SceneError: a shape is wrong, something is no number or not finite, a radius is negative, or the mass given for
            a disc is not above 0.
    """

    position: FloatArray
    velocity: FloatArray
    radius: FloatArray
    mass: FloatArray

    def __init__(
        self, position: ArrayLike, velocity: ArrayLike, radius: ArrayLike = 0.0, mass: ArrayLike | None = None
    ) -> None:
        positions, velocities = _pairs(position, "position"), _pairs(velocity, "velocity")
        if len(positions) != len(velocities):
            raise SceneError(
                f"{len(positions)} positions for {len(velocities)} velocities",
                code="bad-balls",
                fix="give one velocity a ball",
            )
        radii = _one_a_ball(radius, "radius", "one number, or one a ball, 0 for a point", len(positions))
        if not (np.isfinite(radii).all() and (radii >= 0).all()):
            raise SceneError("a radius is negative or not finite", code="bad-balls", fix="give 0 for a point")
        object.__setattr__(self, "position", positions)
        object.__setattr__(self, "velocity", velocities)
        object.__setattr__(self, "radius", radii)
        masses = area_of(radii) if mass is None else _one_a_ball(mass, "mass", "one number, or one a ball", len(radii))
        if mass is not None:
            check_masses(radii, masses)
        object.__setattr__(self, "mass", masses)

    def __len__(self) -> int:
        return len(self.position)

    def __repr__(self) -> str:
        speed = np.hypot(*self.velocity.T)
        return f"<Balls: {len(self):,}{_range(', radius', self.radius)}{_range(', speed', speed)}>"

    def take(self, balls: ArrayLike | slice) -> Balls:
        """Choose balls: their numbers in the order wanted, a mask of n truth values, or a slice.

        Raises:
            SceneError: there is no such ball, or the mask has another length.
        """
        chosen = arguments.chosen(balls, len(self), "balls", error=SceneError, code="bad-ball")
        return Balls(self.position[chosen], self.velocity[chosen], self.radius[chosen], self.mass[chosen])


def area_of(radius: FloatArray) -> FloatArray:
    """Give the area of discs, which is their mass where nobody says another."""
    with np.errstate(over="ignore"):  # of discs so large that nothing can be said of them, see ``check_masses``
        return math.pi * radius * radius


def check_masses(radii: FloatArray, masses: FloatArray) -> None:
    """Refuse masses that no disc can have.

    Raises:
        SceneError: one is not above 0, or not finite; areas are so for radii beyond 1e-162 and 1e153.
    """
    if not (np.isfinite(masses).all() and (masses[radii > 0.0] > 0.0).all() and (masses >= 0.0).all()):
        raise SceneError("the mass of a disc is not above 0, or not finite", code="bad-balls", fix="give its mass")


def no_balls() -> Balls:
    """Give no balls at all."""
    return Balls(np.empty((0, 2)), np.empty((0, 2)))


@dataclass(slots=True, eq=False, repr=False)
class Scene(Pictured):
    """What is simulated.

    Each value is checked when the scene is made, and again when an attribute is set.

    Attributes:
        walls: see :class:`wallkit.walls.Walls`.
        balls: see :class:`Balls`.
        gravity: (gx, gy) in units per second squared, or None.
        rolling_friction: constant deceleration of a rolling ball, units per second squared, 0 or more, or None. Without
            gravity a ball rolls on the plane of the drawing, all the time. Under gravity g it rolls on the walls to
            which it keeps, and this is what it loses on a level one: where N presses it on a wall, N / |g| of it.
        drag: rate k of dv/dt = -k v, per second, 0 or more, or None; under gravity of dv/dt = g - k v, in flight and on
            the walls. Without gravity it does not act together with rolling friction. Drag takes for ever to stop a
            ball; at 2^-50 of the speed with which its flight began, or its slide on a level wall, the ball is at rest.
        sensors: walls that report each crossing of a ball's centre and do not bounce it, or None.
        meeting: whether discs meet one another; points never do.
        ball_restitution: part of the relative speed along the line of centres that a contact of two discs leaves, 0
            to 1.
        ball_tangential_restitution: the same across it, 0 to 1; discs have no spin.

    Raises:
        SceneError: a value is of the wrong kind, out of range or not finite.
    """

    walls: Walls
    balls: Balls = field(default_factory=no_balls)
    gravity: tuple[float, float] | None = None
    rolling_friction: float | None = None
    drag: float | None = None
    sensors: Walls | None = None
    meeting: bool = False
    ball_restitution: float = 1.0
    ball_tangential_restitution: float = 1.0

    def __setattr__(self, name: str, value: Any) -> None:
        object.__setattr__(self, name, _CHECKS[name](value) if name in _CHECKS else value)

    def save(self, path: str | Path) -> None:
        """Write the scene as JSON, walls and materials included: the ``wallkit-scene`` format of docs/files.md.

        Raises:
            WallkitError: the file cannot be written.
        """
        import json

        from wallkit.scene.scene_files import scene_to_json
        from wallkit.write_file import write_whole

        arguments.of_type(path, "path", (str, Path), "a path", error=SceneError, code="bad-path")
        write_whole(path, json.dumps(scene_to_json(self), ensure_ascii=False, allow_nan=False) + "\n")

    @staticmethod
    def load(path: str | Path) -> Scene:
        """Read a scene from a TOML or JSON file; see :func:`wallkit.scene.scene_files.load_scene`.

        Raises:
            SceneError: it cannot be read, or says what a scene cannot; the message lists every such place.
        """
        from wallkit.scene.scene_files import load_scene

        arguments.of_type(path, "path", (str, Path), "a path", error=SceneError, code="bad-path")
        return load_scene(path).scene

    def __repr__(self) -> str:
        parts = [repr(self.walls), repr(self.balls)]
        acting = [(name, getattr(self, name)) for name in ("gravity", "rolling_friction", "drag")]
        parts += [f"{name.replace('_', ' ')} {value}" for name, value in acting if value is not None]
        if self.meeting:
            parts.append("meeting")
        if self.sensors is not None:
            parts.append(f"sensors {self.sensors!r}")
        return f"<Scene: {', '.join(parts)}>"


def _walls(value: Any) -> Walls:
    may_be = "Walls, such as import_walls('level.svg') or Walls.from_polylines([...])"
    arguments.of_type(value, "walls", Walls, may_be, error=SceneError, code="bad-scene")
    walls: Walls = value
    return walls


def _balls(value: Any) -> Balls:
    arguments.of_type(value, "balls", Balls, "Balls(position, velocity, radius)", error=SceneError, code="bad-scene")
    balls: Balls = value
    return balls


def _gravity(value: Any) -> tuple[float, float] | None:
    if value is None:
        return None
    may_be = "two finite numbers, (GX, GY), or None"
    array = arguments.floats(value, "gravity", may_be, error=SceneError, code="bad-gravity")
    if array.shape != (2,) or not np.isfinite(array).all():
        raise arguments.refused("gravity", value, may_be, SceneError, "bad-gravity")
    return float(array[0]), float(array[1])


def falls(scene: Scene) -> bool:
    """Tell whether gravity acts."""
    return scene.gravity is not None and any(scene.gravity)


def downwards(gravity: float, walls: Walls) -> tuple[float, float]:
    """Give the gravity of this size that pulls down on the screen: (0, -g) with y upwards, (0, g) with y downwards."""
    return 0.0, gravity if walls.y_axis == "down" else -gravity


def _slowing(name: str) -> Callable[[Any], float | None]:
    def checked(value: Any) -> float | None:
        if value is None:
            return None
        may_be = "a finite number, 0 or more, or None"
        return arguments.number(value, name, may_be, error=SceneError, code="bad-damping", least=0.0)

    return checked


def _meeting(value: Any) -> bool:
    return arguments.flag(value, "meeting", error=SceneError, code="bad-scene")


def _part(name: str) -> Callable[[Any], float]:
    may_be = "a number from 0 to 1"
    return lambda value: arguments.number(
        value, name, may_be, error=SceneError, code="bad-restitution", least=0.0, most=1.0
    )


def _sensors(value: Any) -> Walls | None:
    if value is not None:
        arguments.of_type(value, "sensors", Walls, "Walls, or None", error=SceneError, code="bad-scene")
    sensors: Walls | None = value
    return sensors


_CHECKS: dict[str, Callable[[Any], Any]] = {
    "walls": _walls,
    "balls": _balls,
    "gravity": _gravity,
    "rolling_friction": _slowing("rolling_friction"),
    "drag": _slowing("drag"),
    "sensors": _sensors,
    "meeting": _meeting,
    "ball_restitution": _part("ball_restitution"),
    "ball_tangential_restitution": _part("ball_tangential_restitution"),
}


def _pairs(values: ArrayLike, name: str) -> FloatArray:
    may_be = "an (n, 2) array of numbers"
    array = np.array(arguments.floats(values, name, may_be, error=SceneError, code="bad-balls"), order="C")
    if array.shape == (2,):
        array = array.reshape(1, 2)
    if array.ndim != 2 or array.shape[1] != 2:
        raise SceneError(f"{name} has the shape {array.shape}", code="bad-balls", fix=f"give {may_be}")
    if not np.isfinite(array).all():
        raise SceneError(f"a {name} is not finite", code="bad-balls", fix="give finite numbers")
    return array


def _one_a_ball(values: ArrayLike, name: str, may_be: str, count: int) -> FloatArray:
    """Give (n,) numbers: as given, or one for all."""
    array = arguments.floats(values, name, may_be, error=SceneError, code="bad-balls")
    if array.ndim > 1 or (array.ndim == 1 and len(array) != count):
        raise SceneError(
            f"{name} has the shape {array.shape} for {count} balls",
            code="bad-balls",
            fix="give one number, or one a ball",
        )
    return np.ascontiguousarray(np.broadcast_to(array, (count,)))


def _range(words: str, values: FloatArray) -> str:
    if not len(values):
        return ""
    low, high = f"{values.min():.6g}", f"{values.max():.6g}"
    return f"{words} {low}" if low == high else f"{words} {low} to {high}"
