"""From FILE and wishes to a scene: one way for the command line, scene files, the page and the library.

FILE is a drawing, walls or a scene, told by its content. Whatever nobody said is assumed, and said in ``assumed``.
"""

from __future__ import annotations

import io
import math
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from importers.drawing import Drawing
from importers.errors import WallkitError
from importers.problems import Problem
from wallkit import arguments
from wallkit.scene.ball_findings import ball_findings
from wallkit.scene.drawn_scene import ANGLE, SPEED, Drawn, apart, drawn_scene
from wallkit.scene.lesson import Lesson
from wallkit.scene.scene import Balls, Scene, downwards
from wallkit.walls import Walls
from wallkit.walls.import_options import REPAIRS, ImportOptions, as_option
from wallkit.walls.origins import Marker

if TYPE_CHECKING:
    from wallkit.scene.scene_files import SceneFile

BOUNCES = 100
USUAL = ImportOptions(curves="arcs")
"""How a drawing is imported to be simulated, unless somebody says otherwise."""


class UsageError(WallkitError):
    """Wishes that do not go together, or a value that is none."""


@dataclass(frozen=True, slots=True)
class Wishes:
    """What is asked of a scene; None is what is not asked.

    Attributes:
        ball: places (x, y) of balls, instead of those in the file.
        velocity: (vx, vy) of every ball.
        speed: units per second, of every ball.
        angle: degrees from the x axis towards the y axis of the drawing.
        radius: of every ball.
        balls: so many balls at random places.
        seed: of that randomness.
        gravity: (gx, gy), or one number: it pulls down on the screen.
        restitution: of every wall.
        tangential_restitution: the same along the wall.
        friction: deceleration of a rolling ball, units per second squared.
        drag: rate k of dv/dt = -k v, per second.
        meeting: discs meet one another.
        ball_restitution: part of the speed along the line of centres that a contact of two discs leaves.
        until: end in seconds.
        bounces: end in bounces a ball.
        importing: how a drawing becomes walls; over what a scene file says of its drawing.
        may_be_empty: a scene without a ball is fine, where there is no room for one.
    """

    ball: tuple[tuple[float, float], ...] = ()
    velocity: tuple[float, float] | None = None
    speed: float | None = None
    angle: float | None = None
    radius: float | None = None
    balls: int | None = None
    seed: int = 0
    gravity: tuple[float, float] | float | None = None
    restitution: float | None = None
    tangential_restitution: float | None = None
    friction: float | None = None
    drag: float | None = None
    meeting: bool | None = None
    ball_restitution: float | None = None
    until: float | None = None
    bounces: int | None = None
    importing: ImportOptions = USUAL
    may_be_empty: bool = False

    def __post_init__(self) -> None:
        for name, check in _WISHES.items():
            if (value := getattr(self, name)) is not None:
                object.__setattr__(self, name, check(value, as_option(name)))
        if self.ball and self.balls is not None:
            raise UsageError("--ball and --balls do not go together", code="usage", fix="give places or a number")
        if self.velocity is not None and (self.speed is not None or self.angle is not None):
            raise UsageError("--velocity and --speed or --angle do not go together", code="usage", fix="give one way")

    @property
    def moves(self) -> bool:
        """A velocity is asked for, or a part of one."""
        return not (self.velocity is None and self.speed is None and self.angle is None)


def _number(least: float = -math.inf, most: float = math.inf) -> Callable[[Any, str], float]:
    above = "" if least == -math.inf else f" from {least:g}"
    may_be = f"a finite number{above}" + ("" if most == math.inf else f" to {most:g}")
    return lambda value, name: arguments.number(
        value, name, may_be, error=UsageError, code="usage", least=least, most=most
    )


def _whole(least: int) -> Callable[[Any, str], int]:
    may_be = f"a whole number, {least} or more"
    return lambda value, name: arguments.whole_number(value, name, may_be, error=UsageError, code="usage", least=least)


def _pair(value: Any, name: str) -> tuple[float, float]:
    may_be = "two finite numbers"
    pair = arguments.floats(value, name, may_be, error=UsageError, code="usage")
    if pair.shape != (2,) or not np.isfinite(pair).all():
        raise arguments.refused(name, value, may_be, UsageError, "usage")
    return float(pair[0]), float(pair[1])


def _gravity(value: Any, name: str) -> tuple[float, float] | float:
    return _number()(value, name) if isinstance(value, int | float) else _pair(value, name)


def _gravity_of(gravity: tuple[float, float] | float, walls: Walls) -> tuple[float, float]:
    return downwards(gravity, walls) if isinstance(gravity, float) else gravity


def _places(value: Any, name: str) -> tuple[tuple[float, float], ...]:
    arguments.of_type(value, name, (tuple, list, np.ndarray), "a list of (x, y)", error=UsageError, code="usage")
    return tuple(_pair(place, name) for place in value)


def _importing(value: Any, name: str) -> ImportOptions:
    arguments.of_type(value, name, ImportOptions, "ImportOptions", error=UsageError, code="usage")
    options: ImportOptions = value
    return options


_WISHES: dict[str, Callable[[Any, str], Any]] = {
    "ball": _places,
    "velocity": _pair,
    "speed": _number(),
    "angle": _number(),
    "radius": _number(least=0.0),
    "balls": _whole(1),
    "seed": _whole(0),
    "gravity": _gravity,
    "restitution": _number(0.0, 1.0),
    "tangential_restitution": _number(0.0, 1.0),
    "friction": _number(least=0.0),
    "drag": _number(least=0.0),
    "meeting": lambda value, name: arguments.flag(value, name, error=UsageError, code="usage"),
    "ball_restitution": _number(0.0, 1.0),
    "until": _number(least=0.0),
    "bounces": _whole(0),
    "importing": _importing,
    "may_be_empty": lambda value, name: arguments.flag(value, name, error=UsageError, code="usage"),
}


@dataclass(slots=True)
class OpenedScene:
    """A scene that is ready to fly.

    Attributes:
        scene: what is simulated.
        until: end in seconds, or None.
        bounces: end in bounces a ball, or None.
        kind: what the file was, for people.
        problems: what was found on the way: by the reader, in the walls, about the balls.
        assumed: what nobody said, a sentence each.
        drawing: the drawing, where the file was one.
        found_place: no ball was given: the one in the scene was put where there is most room.
        importing: how the drawing became walls.
        lesson: what a scene file says to a class, or None.
    """

    scene: Scene
    until: float | None
    bounces: int | None
    kind: str
    problems: list[Problem]
    assumed: list[str] = field(default_factory=list)
    drawing: Drawing | None = None
    found_place: bool = False
    importing: ImportOptions | None = None
    lesson: Lesson | None = None


def open_scene(
    source: str | Path | bytes | Drawing,
    wishes: Wishes | None = None,
    *,
    name: str = "",
    folder: Path | None = None,
) -> OpenedScene:
    """Make a scene of a drawing, walls or a scene file.

    Args:
        source: a path, the bytes of a file, or a drawing that is read already.
        wishes: what is asked of it; by default nothing.
        name: of the file whose bytes are given, for messages.
        folder: where a scene file of which the bytes are given finds the files that it names; None forbids any.

    Raises:
        WallkitError: it cannot be read, a wish cannot be met, or there is no room for a ball.
    """
    may_be = "a path, bytes or a Drawing"
    arguments.of_type(source, "source", (str, Path, bytes, Drawing), may_be, error=UsageError, code="usage")
    arguments.of_type(wishes, "wishes", (Wishes, type(None)), "Wishes or None", error=UsageError, code="usage")
    arguments.text(name, "name", error=UsageError, code="usage")
    arguments.of_type(folder, "folder", (Path, type(None)), "a pathlib.Path or None", error=UsageError, code="usage")
    wishes = wishes or Wishes()
    if isinstance(source, Drawing):
        return _of_drawing(source, wishes)
    if isinstance(source, str | Path):
        return open_scene(read_file(source), wishes, name=str(source), folder=Path(source).parent)
    from wallkit.scene.scene_files import kind_of, read_scene

    kind = kind_of(source)
    if kind == "drawing":
        from importers.read import read_drawing

        stream = io.BytesIO(source)
        stream.name = name
        return _of_drawing(read_drawing(stream, page=wishes.importing.page, via=wishes.importing.via), wishes)
    if kind == "walls":
        from wallkit.walls.walls_json import loads

        return _of_walls(loads(source, name), wishes)
    said = wishes.importing.said(USUAL)
    return _of_scene_file(read_scene(source, file=name, folder=folder, importing=said, balls=_given(wishes)), wishes)


def read_file(path: str | Path) -> bytes:
    """Read a file, up to the limit on input.

    Raises:
        UsageError: there is no such file, or it cannot be read.
    """
    from importers.limits import MAX_INPUT_BYTES, check_input_size

    try:
        with Path(path).open("rb") as stream:
            data = stream.read(MAX_INPUT_BYTES + 1)
    except OSError as error:
        raise UsageError(f"cannot read it: {error.strerror}", code="cannot-read", file=str(path)) from error
    check_input_size(len(data), str(path))
    return data


def _given(wishes: Wishes) -> np.ndarray | None:
    return np.array(wishes.ball, dtype=np.float64) if wishes.ball else None


def _of_drawing(drawing: Drawing, wishes: Wishes) -> OpenedScene:
    drawn = drawn_scene(drawing, wishes.importing, _given(wishes))
    scene = Scene(drawn.walls, drawn.balls, sensors=drawn.sensors)
    opened = OpenedScene(scene, None, None, drawing.kind or "drawing", drawn.problems)
    opened.drawing, opened.importing = drawing, wishes.importing
    return _completed(opened, drawn, wishes)


def _of_walls(walls: Walls, wishes: Wishes) -> OpenedScene:
    walls, sensors = apart(_repaired(walls, wishes.importing, "walls"))
    return _completed(OpenedScene(Scene(walls, sensors=sensors), None, None, "walls", []), None, wishes)


def _of_scene_file(read: SceneFile, wishes: Wishes) -> OpenedScene:
    scene = read.scene
    if read.drawn is None:
        scene = replace(scene, walls=_repaired(scene.walls, wishes.importing, "a scene without a drawing"))
    problems = [] if read.drawn is None else read.drawn.problems
    opened = OpenedScene(
        scene, read.until, read.bounces, "scene", problems, drawing=read.drawing, importing=read.importing,
        lesson=read.lesson,
    )  # fmt: skip
    return _completed(opened, read.drawn, wishes)


def _repaired(walls: Walls, options: ImportOptions, what: str) -> Walls:
    """Look at walls anew, which somebody may have edited, and repair them if asked to; a drawing's options are none."""
    from wallkit.walls.checking.self_check import validate
    from wallkit.walls.repairing.passes import repair

    other = [name for name in options.said(USUAL) if name not in REPAIRS]
    if other:
        raise UsageError(
            f"{', '.join(map(as_option, other))}: only for drawings, and this is {what}",
            code="usage",
            fix="leave it out, or give the drawing",
        )
    found = validate(walls)
    codes = {problem.code for problem in found}
    said = [problem for problem in walls.problems if problem.code not in codes]
    if options.repairs is None:
        return replace(walls, problems=said + found)
    done = repair(walls, options.repairs)
    codes = {problem.code for problem in done.violations}
    said = [problem for problem in said if problem.code not in codes]
    return replace(done.walls, problems=[*said, *(change.to_problem() for change in done.changes), *done.violations])


def _completed(opened: OpenedScene, drawn: Drawn | None, wishes: Wishes) -> OpenedScene:
    """Give the scene its balls, materials and what acts, and say what was assumed and what is doubtful."""
    scene = opened.scene
    walls, balls = _walls_and_balls(opened, drawn, wishes)
    if walls.solid is not None and walls.solid.how != "asked" and (walls.solid.room or walls.solid.how == "balls"):
        opened.assumed.insert(0, walls.solid.sentence())  # that filled shapes are solid needs no words
    if wishes.until is not None or wishes.bounces is not None:
        opened.until, opened.bounces = wishes.until, wishes.bounces
    if opened.until is None and opened.bounces is None:
        opened.bounces = BOUNCES
        opened.assumed.append(f"{BOUNCES} bounces a ball (--bounces, --until)")
    opened.scene = replace(
        scene,
        walls=_with_material(walls, wishes),
        balls=balls,
        gravity=scene.gravity if wishes.gravity is None else _gravity_of(wishes.gravity, walls),
        rolling_friction=scene.rolling_friction if wishes.friction is None else wishes.friction,
        drag=scene.drag if wishes.drag is None else wishes.drag,
        meeting=scene.meeting if wishes.meeting is None else wishes.meeting,
        ball_restitution=scene.ball_restitution if wishes.ball_restitution is None else wishes.ball_restitution,
    )
    about_balls = [] if opened.found_place else ball_findings(walls, balls)
    opened.problems = [*walls.problems, *opened.problems, *about_balls, *_bumpers(opened.scene.walls)]
    return opened


def _bumpers(walls: Walls) -> list[Problem]:
    """Say that energy grows, where it does."""
    count = sum(material.restitution > 1.0 for material in walls.materials)
    if not count:
        return []
    words = "1 wall has" if count == 1 else f"{count} walls have"
    message = f"{words} a restitution above 1: each bounce there adds energy, and without an end a ball may collapse"
    return [Problem("energy-grows", "info", message, "nothing to do for a bumper; else give 1 or less")]


def _with_material(walls: Walls, wishes: Wishes) -> Walls:
    given = {"restitution": wishes.restitution, "tangential_restitution": wishes.tangential_restitution}
    changes = {key: value for key, value in given.items() if value is not None}
    if not changes:
        return walls
    return replace(walls, materials=tuple(replace(material, **changes) for material in walls.materials))


def _walls_and_balls(opened: OpenedScene, drawn: Drawn | None, wishes: Wishes) -> tuple[Walls, Balls]:
    """Give the balls asked for, those in the file, or one where there is most room; the walls turned if it says so."""
    walls, balls, assumed = opened.scene.walls, opened.scene.balls, opened.assumed
    if wishes.ball:
        if wishes.radius is None:
            assumed.append("radius 0: a point (--radius)")
        velocity = _velocity(wishes, assumed)
        return walls, Balls(np.array(wishes.ball), np.tile(velocity, (len(wishes.ball), 1)), wishes.radius or 0.0)
    if wishes.balls is None and len(balls):
        return walls, _changed(balls, drawn, wishes, assumed)
    spawns = [marker for marker in walls.markers if marker.kind == "spawn"]
    if spawns and wishes.balls is None:
        return walls, _at_the_spawn(spawns[0], wishes, assumed)
    if spawns and wishes.balls is not None:
        return walls, _at_spawns(spawns, wishes.balls, wishes, assumed)
    return _at_the_roomiest_spot(opened, wishes)


def _changed(balls: Balls, drawn: Drawn | None, wishes: Wishes, assumed: list[str]) -> Balls:
    """Let wishes say otherwise than the file, and say what the file left open."""
    if wishes.moves:
        velocity = np.tile(_velocity(wishes, assumed), (len(balls), 1))
        balls = replace(balls, velocity=velocity)
    elif drawn is not None and drawn.still:
        assumed += [f"{SPEED:g} units/s (--speed)", f"direction {ANGLE:g} degrees (--angle)"]
    if drawn is not None and drawn.used:
        assumed.append(f"{len(balls)} {'ball' if len(balls) == 1 else 'balls'} drawn on the layer 'balls'")
    return Balls(balls.position, balls.velocity, wishes.radius) if wishes.radius is not None else balls


def _at_the_spawn(spawn: Marker, wishes: Wishes, assumed: list[str]) -> Balls:
    """Give one ball where the drawing says that balls start, as large as the circle that says so."""
    radius = spawn.radius if wishes.radius is None else wishes.radius
    called = f"the spawn {spawn.name!r}" if spawn.name else "the spawn"
    assumed.append(f"one ball of radius {radius:g} at {called}, ({spawn.x:.6g}, {spawn.y:.6g}) (--ball, --radius)")
    return Balls([[spawn.x, spawn.y]], [_velocity(wishes, assumed)], radius)


def _at_spawns(spawns: list[Marker], count: int, wishes: Wishes, assumed: list[str]) -> Balls:
    """Give balls in random directions, at the spawns in turn.

    A ball is as large as the circle of its spawn; one that is asked to be smaller starts anywhere in that circle:
    evenly over the disc of radius R = (circle - ball), at R sqrt(u) for an even u.
    """
    random = np.random.default_rng(wishes.seed)
    turn = np.arange(count) % len(spawns)
    circle = np.array([spawn.radius for spawn in spawns])[turn]
    radius = circle if wishes.radius is None else np.full(count, wishes.radius)
    reach = np.maximum(circle - radius, 0.0) * np.sqrt(random.uniform(size=count))
    around = random.uniform(0.0, math.tau, count)
    middle = np.array([(spawn.x, spawn.y) for spawn in spawns])[turn]
    places = middle + reach[:, None] * np.stack([np.cos(around), np.sin(around)], axis=1)
    where = "the spawn" if len(spawns) == 1 else f"{len(spawns)} spawns in turn"
    assumed.append(f"{count} balls at {where} (seed {wishes.seed})")
    return Balls(places, _random_velocities(count, wishes, random, assumed), radius)


def _random_velocities(count: int, wishes: Wishes, random: np.random.Generator, assumed: list[str]) -> np.ndarray:
    """Give (count, 2) velocities in random directions, or all the one that is asked for."""
    if wishes.velocity is not None or wishes.angle is not None:
        return np.tile(_velocity(wishes, assumed), (count, 1))
    angle = random.uniform(0.0, math.tau, count)
    speed = SPEED if wishes.speed is None else wishes.speed
    return speed * np.stack([np.cos(angle), np.sin(angle)], axis=1)


def _at_the_roomiest_spot(opened: OpenedScene, wishes: Wishes) -> tuple[Walls, Balls]:
    from wallkit.scene.starting_places import roomiest, scattered
    from wallkit.walls.orient import inside_out
    from wallkit.walls.solid import Solid

    walls, assumed = opened.scene.walls, opened.assumed
    opened.found_place = True
    spot = roomiest(walls)
    decided = walls.solid is not None and walls.solid.how in ("balls", "asked")
    if spot is None and not decided and (walls.solid is not None or "outward" not in walls.sides):
        spot = roomiest(walls, anywhere=True)  # all that is bounded is solid: then it is meant as rooms
        if spot is not None and walls.solid is not None:
            why = "there is no other place for a ball"
            walls = replace(inside_out(walls), solid=Solid(not walls.solid.room, "start", why))
    if spot is None:
        if wishes.may_be_empty:
            return walls, Balls(np.empty((0, 2)), np.empty((0, 2)))
        raise UsageError("no room for a ball was found inside these walls", code="no-room", fix="give --ball X,Y")
    count = wishes.balls
    radius = wishes.radius
    meeting = opened.scene.meeting if wishes.meeting is None else wishes.meeting
    if radius is None:
        radius = _sensible_radius(spot.room) / (1 if count is None else 2)
        if meeting and count is not None:  # discs that meet take a tenth of the room at most
            radius = min(radius, float(f"{math.sqrt(0.1 * spot.face.area / (math.pi * count)):.0e}"))
    if count is None:
        assumed.append(
            f"one ball of radius {radius:g} at the roomiest spot, ({spot.x:.6g}, {spot.y:.6g}) (--ball, --radius)"
        )
        return walls, Balls([[spot.x, spot.y]], [_velocity(wishes, assumed)], radius)
    random = np.random.default_rng(wishes.seed)
    places = scattered(walls, spot, count, radius, random, apart=meeting and radius > 0.0)
    assumed.append(f"{count} balls of radius {radius:g} at random places (seed {wishes.seed}) around the roomiest spot")
    return walls, Balls(places, _random_velocities(count, wishes, random, assumed), radius)


def _sensible_radius(room: float) -> float:
    """Give a twelfth of the room, rounded to one digit, so that the ball is seen and fits through most gaps."""
    return float(f"{room / 12:.0e}")


def _velocity(wishes: Wishes, assumed: list[str]) -> tuple[float, float]:
    if wishes.velocity is not None:
        return wishes.velocity
    speed, angle = wishes.speed, wishes.angle
    if speed is None:
        speed = SPEED
        assumed.append(f"{SPEED:g} units/s (--speed)")
    if angle is None:
        angle = ANGLE
        assumed.append(f"direction {ANGLE:g} degrees (--angle)")
    return speed * math.cos(math.radians(angle)), speed * math.sin(math.radians(angle))
