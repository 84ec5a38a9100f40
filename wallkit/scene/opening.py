"""From FILE and wishes to a scene: one way for the command line, scene files, the page and the library.

FILE is a drawing, walls or a scene, told by its content. Whatever nobody said is assumed, and said in ``assumed``.
"""

from __future__ import annotations

import io
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from importers.drawing import Drawing
from importers.problems import Problem
from wallkit import arguments
from wallkit.scene.asked_balls import walls_and_balls
from wallkit.scene.ball_findings import ball_findings
from wallkit.scene.drawn_scene import Drawn, apart, drawn_scene
from wallkit.scene.file_kinds import kind_of
from wallkit.scene.scene import Scene, downwards, falls
from wallkit.scene.wishes import USUAL, UsageError, Wishes
from wallkit.walls import Walls
from wallkit.walls.import_options import REPAIRS, ImportOptions, as_option

if TYPE_CHECKING:
    from wallkit.scene.lesson import Lesson
    from wallkit.scene.scene_files import SceneFile
    from wallkit.walls.met_lines import MetLines

BOUNCES = 100


@dataclass(slots=True, eq=False)
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
        found_place: no ball was given: the one in the scene, if there is one, was put where there is most room.
        importing: how the drawing became walls.
        lesson: what a scene file says to a class, or None.
        lines: of the walls, with how they touch, where these were looked for on the way.
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
    met: MetLines | None = None


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
    kind = kind_of(source)
    if kind == "drawing":
        from importers.read import read_drawing

        stream = io.BytesIO(source)
        stream.name = name
        return _of_drawing(read_drawing(stream, page=wishes.importing.page, via=wishes.importing.via), wishes)
    if kind == "walls":
        from wallkit.walls.walls_json import loads

        return _of_walls(loads(source, name), wishes)
    from wallkit.scene.scene_files import read_scene

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
    opened.drawing, opened.importing, opened.met = drawing, wishes.importing, drawn.met
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
    walls, balls = walls_and_balls(opened, drawn, wishes)
    if walls.solid is not None and walls.solid.how != "asked" and (walls.solid.room or walls.solid.how == "balls"):
        opened.assumed.insert(0, walls.solid.sentence())  # that filled shapes are solid needs no words
    if wishes.until is not None or wishes.bounces is not None:
        opened.until, opened.bounces = wishes.until, wishes.bounces
    if opened.until is None and opened.bounces is None:
        opened.bounces = BOUNCES
        opened.assumed.append(f"{BOUNCES} bounces a ball (--bounces, --until)")
    meets = scene.meeting if wishes.meeting is None else wishes.meeting
    if wishes.ball_restitution is not None and not meets:
        raise UsageError("--ball-restitution: only with --meeting", code="usage", fix="add --meeting, or leave it out")
    if meets and len(balls) and not balls.radius.any():
        opened.assumed.append("balls are points, which never meet (--radius)")
    opened.scene = replace(
        scene,
        walls=_with_material(walls, wishes),
        balls=balls,
        gravity=scene.gravity if wishes.gravity is None else _gravity_of(wishes.gravity, walls),
        rolling_friction=scene.rolling_friction if wishes.friction is None else wishes.friction,
        drag=scene.drag if wishes.drag is None else wishes.drag,
        meeting=meets,
        ball_restitution=scene.ball_restitution if wishes.ball_restitution is None else wishes.ball_restitution,
    )
    about_balls = [] if opened.found_place else ball_findings(walls, balls)
    acting = [*_bumpers(opened.scene.walls), *_hops(opened.scene)]
    opened.problems = [*walls.problems, *opened.problems, *about_balls, *acting]
    return opened


def _bumpers(walls: Walls) -> list[Problem]:
    """Say that energy grows, where it does."""
    count = sum(material.restitution > 1.0 for material in walls.materials)
    if not count:
        return []
    words = "1 wall has" if count == 1 else f"{count} walls have"
    message = f"{words} a restitution above 1: each bounce there adds energy, and without an end a ball may collapse"
    return [Problem("energy-grows", "info", message, "nothing to do for a bumper; else give 1 or less")]


def _hops(scene: Scene) -> list[Problem]:
    """Say that discs that meet under gravity do not lie still, where something would let them."""
    loses = min([scene.ball_restitution, *(material.restitution for material in scene.walls.materials)]) < 1.0
    if not (scene.meeting and falls(scene) and loses and scene.balls.radius.any()):
        return []
    message = "discs that meet do not come to lie under gravity: they hop, too low to be seen (1/4096 of a radius)"
    return [Problem("meeting-hops", "info", message, "nothing to do; a disc alone, without meeting, slides and rests")]


def _with_material(walls: Walls, wishes: Wishes) -> Walls:
    given = {"restitution": wishes.restitution, "tangential_restitution": wishes.tangential_restitution}
    changes = {key: value for key, value in given.items() if value is not None}
    if not changes:
        return walls
    return replace(walls, materials=tuple(replace(material, **changes) for material in walls.materials))


def _gravity_of(gravity: tuple[float, float] | float, walls: Walls) -> tuple[float, float]:
    return downwards(gravity, walls) if isinstance(gravity, float) else gravity
