"""Where the many balls of a survey or a check start: anywhere in the room, or from one place in all directions."""

from __future__ import annotations

from dataclasses import dataclass, field

from importers.errors import WallkitError
from wallkit.scene.drawn_scene import SPEED
from wallkit.scene.opening import OpenedScene
from wallkit.scene.room_balls import RoomBalls
from wallkit.scene.starting_places import face_around
from wallkit.simulation.streams import RandomBalls
from wallkit.simulation.work import Draw


@dataclass(slots=True)
class Starts:
    """How the balls are drawn, the radius of all, and what was assumed."""

    draw: Draw
    radius: float
    assumed: list[str] = field(default_factory=list)


def starts_of(
    opened: OpenedScene,
    start: str | tuple[float, float] | None = None,
    *,
    speed: float | None = None,
    radius: float | None = None,
    seed: int = 0,
) -> Starts:
    """Say how balls are drawn for a scene.

    Args:
        opened: the scene.
        start: the name of a spawn or a target of the drawing, or (x, y): all start there, in all directions. None for
            anywhere in the room in which the scene's first ball is, evenly, in all directions.
        speed: of all; None for 50 units per second.
        radius: of all; None for that of the smallest ball that is given, or else for points.
        seed: of the randomness.

    Raises:
        WallkitError: there is no such place, or no room.
    """
    assumed = []
    if speed is None:
        speed = SPEED
        assumed.append(f"{SPEED:g} units/s (--speed)")
    if radius is None:
        given = () if opened.found_place else opened.scene.balls.radius.tolist()
        radius = min(given, default=0.0)
        words = f"radius {radius:g}, as the smallest ball that is given" if given else "points"
        assumed.append(f"{words} (--radius)")
    if start is not None:
        x, y = place_of(opened, start)
        return Starts(RandomBalls((x, y, x, y), speed, radius, seed), radius, assumed)
    walls, balls = opened.scene.walls, opened.scene.balls
    face = None if opened.found_place or not len(balls) else face_around(walls, *balls.position[0].tolist())
    if face is None:
        assumed.append(f"balls anywhere in the room around the roomiest spot (--from), seed {seed}")
    else:
        assumed.append(f"balls anywhere in the room of the ball that is given (--from), seed {seed}")
    return Starts(RoomBalls.of(walls, speed, radius, seed, face), radius, assumed)


def place_of(opened: OpenedScene, place: str | tuple[float, float]) -> tuple[float, float]:
    """Give the place that a marker's name means, or (x, y) as it is.

    Raises:
        WallkitError: no marker is called so.
    """
    if not isinstance(place, str):
        return place
    markers = opened.scene.walls.markers
    for marker in markers:
        if marker.name == place:
            return marker.x, marker.y
    names = ", ".join(repr(marker.name) for marker in markers if marker.name) or "none"
    fix = f"give X,Y, or a name that the drawing gives a spawn or a target: {names}"
    raise WallkitError(f"there is no place called {place!r}", code="no-place", fix=fix)
