"""From FILE and options to a scene: what `simulate` and `play` share. Whatever is assumed is said."""

from __future__ import annotations

import io
import math
import sys
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from importers.errors import WallkitError
from importers.problems import Problem

if TYPE_CHECKING:
    from importers.drawing import Drawing
    from wallkit.scene import Balls, Scene
    from wallkit.scene_files import SceneFile
    from wallkit.walls import Walls

SPEED, ANGLE = 50.0, 30.0
BOUNCES = 100


class UsageError(WallkitError):
    """Options that do not go together, or a value that is none."""


@dataclass(slots=True)
class Wishes:
    """What the options say; None is what they do not say.

    Attributes:
        ball: places ``X,Y``.
        velocity: ``VX,VY`` of every ball.
        speed: units per second.
        angle: degrees from the x axis towards the y axis of the drawing.
        radius: of every ball.
        balls: so many balls at random places.
        seed: of that randomness.
        gravity: ``GX,GY``.
        restitution: of every wall.
        tangential_restitution: the same along the wall.
        friction: deceleration of a rolling ball, units per second squared.
        drag: rate k of dv/dt = -k v, per second.
        until: end in seconds.
        bounces: end in bounces a ball.
        importing: options of ``import_walls``.
    """

    ball: list[str] = field(default_factory=list)
    velocity: str | None = None
    speed: float | None = None
    angle: float | None = None
    radius: float | None = None
    balls: int | None = None
    seed: int = 0
    gravity: str | None = None
    restitution: float | None = None
    tangential_restitution: float | None = None
    friction: float | None = None
    drag: float | None = None
    until: float | None = None
    bounces: int | None = None
    importing: dict[str, Any] = field(default_factory=dict)


@dataclass(slots=True)
class Prepared:
    """A scene that is ready to fly.

    Attributes:
        scene: what is simulated.
        until: end in seconds, or None.
        bounces: end in bounces a ball, or None.
        kind: what the file was, for people.
        problems: what was found on the way.
        assumed: what nobody said, a sentence each.
    """

    scene: Scene
    until: float | None
    bounces: int | None
    kind: str
    problems: list[Problem]
    assumed: list[str]


def read_input(file: str) -> bytes:
    """Read FILE, or standard input for ``-``, up to the limit on input.

    Raises:
        UsageError: there is no such file, or it cannot be read.
    """
    from importers.limits import MAX_INPUT_BYTES, check_input_size

    try:
        if file == "-":
            data = sys.stdin.buffer.read(MAX_INPUT_BYTES + 1)
        else:
            with Path(file).open("rb") as stream:
                data = stream.read(MAX_INPUT_BYTES + 1)
    except OSError as error:
        raise UsageError(f"cannot read it: {error.strerror}", code="cannot-read", file=file) from error
    check_input_size(len(data), file)
    return data


def prepare(file: str, wishes: Wishes) -> Prepared:
    """Read FILE, whatever it is, and make the scene that the options ask for."""
    return prepare_data(read_input(file), file, wishes, Path() if file == "-" else Path(file).parent)


def prepare_data(data: bytes, file: str, wishes: Wishes, folder: Path | None) -> Prepared:
    """Make the scene of a file's bytes; a scene finds the files that it names in ``folder``, None forbids any."""
    from wallkit.scene_files import kind_of, read_scene

    kind = kind_of(data)
    if kind == "drawing":
        return _of_drawing(data, file, wishes)
    _no_import_options(wishes, kind)
    if kind == "walls":
        from wallkit.walls.files import loads

        walls = loads(data, file)
        return _complete(walls, _Given(), wishes, "walls", [])
    read = read_scene(data, file=file, folder=folder)
    return _complete(read.scene.walls, _Given(scene=read), wishes, "scene", [])


def prepare_drawing(drawing: Drawing, wishes: Wishes) -> Prepared:
    """Make the scene of a drawing that is read already."""
    from wallkit.curves import in_material
    from wallkit.starts import drawn_balls
    from wallkit.walls.build import import_walls

    options = {"curves": "arcs", **wishes.importing}
    walls = import_walls(drawing, **options)
    found, problems = drawn_balls(drawing, options.get("scale", 1.0), options.get("flip_y", False))
    given = _Given(drawn=[(ball.x, ball.y, ball.radius, ball.velocity) for ball in found])
    kind = drawing.kind or "drawing"
    prepared = _complete(walls, given, wishes, kind, problems)
    balls = prepared.scene.balls
    if options.get("arena") or not len(balls) or not in_material(walls, np.asarray(balls.position)).all():
        return prepared
    # All balls start in what would be material: then the outermost walls are meant as rooms.
    prepared = _complete(import_walls(drawing, **options, arena=True), given, wishes, kind, problems)
    prepared.assumed.insert(0, "the outermost walls are a room, since all balls are in it (--arena)")
    return prepared


def _of_drawing(data: bytes, file: str, wishes: Wishes) -> Prepared:
    from importers.read import read_drawing

    stream = io.BytesIO(data)
    stream.name = file
    return prepare_drawing(read_drawing(stream), wishes)


def _no_import_options(wishes: Wishes, kind: str) -> None:
    if wishes.importing:
        names = ", ".join(f"--{name.rstrip('s') if name == 'layers' else name}" for name in wishes.importing)
        raise UsageError(
            f"{names}: only for drawings, and this is {'walls' if kind == 'walls' else 'a scene'}",
            code="usage",
            fix="leave it out, or give the drawing",
        )


@dataclass(slots=True)
class _Given:
    """What the file itself says of balls and ends."""

    drawn: list[tuple[float, float, float, tuple[float, float] | None]] = field(default_factory=list)
    scene: SceneFile | None = None


def _complete(walls: Walls, given: _Given, wishes: Wishes, kind: str, problems: list[Problem]) -> Prepared:
    from wallkit.scene import Scene

    assumed: list[str] = []
    walls = _with_material(walls, wishes)
    balls = _balls(walls, given, wishes, assumed)
    gravity = given.scene.scene.gravity if given.scene else None
    if wishes.gravity is not None:
        gravity = pair(wishes.gravity, "--gravity")
    until, bounces = wishes.until, wishes.bounces
    if until is None and bounces is None and given.scene:
        until, bounces = given.scene.until, given.scene.bounces
    if until is None and bounces is None:
        bounces = BOUNCES
        assumed.append(f"{BOUNCES} bounces a ball (--bounces, --until)")
    base = given.scene.scene if given.scene else Scene(walls)
    friction = base.rolling_friction if wishes.friction is None else wishes.friction
    drag = base.drag if wishes.drag is None else wishes.drag
    scene = replace(base, walls=walls, balls=balls, gravity=gravity, rolling_friction=friction, drag=drag)
    return Prepared(scene, until, bounces, kind, [*walls.problems, *problems], assumed)


def _with_material(walls: Walls, wishes: Wishes) -> Walls:
    if wishes.restitution is None and wishes.tangential_restitution is None:
        return walls
    given = {"restitution": wishes.restitution, "tangential_restitution": wishes.tangential_restitution}
    changes = {key: value for key, value in given.items() if value is not None}
    return replace(walls, materials=tuple(replace(material, **changes) for material in walls.materials))


def _balls(walls: Walls, given: _Given, wishes: Wishes, assumed: list[str]) -> Balls:
    from wallkit.scene import Balls

    if wishes.ball and wishes.balls is not None:
        raise UsageError("--ball and --balls do not go together", code="usage", fix="give places or a number")
    if wishes.balls is not None:
        return _scattered(walls, wishes, assumed)
    if wishes.ball:
        places = np.array([pair(text, "--ball") for text in wishes.ball])
        if wishes.radius is None:
            assumed.append("radius 0: a point (--radius)")
        velocity = _velocity(wishes, assumed)
        return Balls(places, np.tile(velocity, (len(places), 1)), wishes.radius or 0.0)
    if given.scene and len(np.asarray(given.scene.scene.balls.position)):
        return _changed(given.scene.scene.balls, wishes)
    if given.drawn:
        return _drawn(given, wishes, assumed)
    return _at_the_roomiest_spot(walls, wishes, assumed)


def _changed(balls: Balls, wishes: Wishes) -> Balls:
    """Let options say otherwise than the scene file."""
    if any(value is not None for value in (wishes.velocity, wishes.speed, wishes.angle)):
        velocity = np.tile(_velocity(wishes, []), (len(np.asarray(balls.position)), 1))
        balls = replace(balls, velocity=velocity)
    return replace(balls, radius=np.full(len(balls), wishes.radius)) if wishes.radius is not None else balls


def _drawn(given: _Given, wishes: Wishes, assumed: list[str]) -> Balls:
    from wallkit.scene import Balls

    asked = any(value is not None for value in (wishes.velocity, wishes.speed, wishes.angle))
    still = [ball[3] is None for ball in given.drawn]
    otherwise = _velocity(wishes, assumed) if asked or any(still) else (0.0, 0.0)
    velocity = [otherwise if asked or ball[3] is None else ball[3] for ball in given.drawn]
    count = len(given.drawn)
    assumed.append(f"{count} {'ball' if count == 1 else 'balls'} drawn on the layer 'balls'")
    radius = [ball[2] if wishes.radius is None else wishes.radius for ball in given.drawn]
    return Balls(np.array([ball[:2] for ball in given.drawn]), np.array(velocity), np.array(radius))


def _at_the_roomiest_spot(walls: Walls, wishes: Wishes, assumed: list[str]) -> Balls:
    from wallkit.scene import Balls
    from wallkit.starts import roomiest

    spot = roomiest(walls)
    if spot is None:
        raise UsageError("there is no room for a ball inside these walls", code="no-room", fix="give --ball X,Y")
    radius = _sensible_radius(spot.room) if wishes.radius is None else wishes.radius
    assumed.append(
        f"one ball of radius {radius:g} at the roomiest spot, ({spot.x:.6g}, {spot.y:.6g}) (--ball, --radius)"
    )
    return Balls([[spot.x, spot.y]], [_velocity(wishes, assumed)], radius)


def _scattered(walls: Walls, wishes: Wishes, assumed: list[str]) -> Balls:
    from wallkit.scene import Balls
    from wallkit.starts import roomiest, scattered

    count = wishes.balls or 0
    if count < 1:
        raise UsageError(f"--balls is {count}", code="usage", fix="give 1 or more")
    spot = roomiest(walls)
    if spot is None:
        raise UsageError("there is no room for a ball inside these walls", code="no-room", fix="give --ball X,Y")
    radius = _sensible_radius(spot.room) / 2 if wishes.radius is None else wishes.radius
    random = np.random.default_rng(wishes.seed)
    places = scattered(walls, spot, count, radius, random)
    assumed.append(f"{count} balls of radius {radius:g} at random places (seed {wishes.seed}) around the roomiest spot")
    if wishes.velocity is not None or wishes.angle is not None:
        return Balls(places, np.tile(_velocity(wishes, assumed), (count, 1)), radius)
    angle = random.uniform(0.0, math.tau, count)
    speed = SPEED if wishes.speed is None else wishes.speed
    return Balls(places, speed * np.stack([np.cos(angle), np.sin(angle)], axis=1), radius)


def _sensible_radius(room: float) -> float:
    """Give a twelfth of the room, rounded to one digit, so that the ball is seen and fits through most gaps."""
    return float(f"{room / 12:.0e}")


def _velocity(wishes: Wishes, assumed: list[str]) -> tuple[float, float]:
    if wishes.velocity is not None:
        if wishes.speed is not None or wishes.angle is not None:
            raise UsageError("--velocity and --speed or --angle do not go together", code="usage", fix="give one way")
        return pair(wishes.velocity, "--velocity")
    speed, angle = wishes.speed, wishes.angle
    if speed is None:
        speed = SPEED
        assumed.append(f"{SPEED:g} units/s (--speed)")
    if angle is None:
        angle = ANGLE
        assumed.append(f"direction {ANGLE:g} degrees (--angle)")
    return speed * math.cos(math.radians(angle)), speed * math.sin(math.radians(angle))


def pair(text: str, option: str) -> tuple[float, float]:
    """Read ``X,Y``.

    Raises:
        UsageError: it is not two finite numbers.
    """
    parts = text.split(",")
    try:
        x, y = (float(part) for part in parts)
    except ValueError:
        x = y = math.nan
    if not (math.isfinite(x) and math.isfinite(y)):
        raise UsageError(f"{option} is {text!r}", code="usage", fix="give two numbers with a comma, such as 10,20")
    return x, y
