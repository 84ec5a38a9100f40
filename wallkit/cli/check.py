"""`wallkit check`: everything that is doubtful about a drawing or walls; exit code 1 when there is any."""

from __future__ import annotations

import json
import math
import sys
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Annotated, Any

import typer

from wallkit.cli import import_options as options
from wallkit.cli.watching import watchable

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from importers.drawing import Drawing
    from importers.problems import Problem
    from wallkit.scene.opening import OpenedScene
    from wallkit.walls import Walls
    from wallkit.walls.checking.audit import Audit
    from wallkit.walls.checking.free_space import FreeSpace
    from wallkit.walls.checking.leaks import Reach
    from wallkit.walls.import_options import ImportOptions

FORMAT, VERSION = "wallkit-check", 1


def register(app: typer.Typer) -> None:
    """Attach the command."""
    app.command("check", rich_help_panel="Drawings and walls")(check)


@options.with_import_options()
@watchable
def check(
    file: options.File,
    radius: Annotated[
        float | None,
        typer.Option(metavar="R", help="Look for leaks of a ball this large [default: the smallest drawn, else any]."),
    ] = None,
    as_json: Annotated[bool, typer.Option("--json", help="Write the findings as JSON to standard output.")] = False,
    preview: Annotated[str, typer.Option(metavar="PICTURE", help="Draw the walls, findings and leaks (.svg).")] = "",
    audit: Annotated[
        int,
        typer.Option(
            metavar="N",
            min=0,
            max=1_000_000,
            help="Hold N points of the walls against the curves as svgpathtools has them.",
        ),
    ] = 0,
    importing: dict[str, Any] | None = None,
) -> None:
    """Find problems and leaks, with places and fixes; exit with 1 when there are findings."""
    from wallkit.cli.scene_input import opened
    from wallkit.scene.opening import Wishes

    _check_radius(radius)
    given = given_of(opened(file, Wishes(importing=options.options_of(importing or {}), may_be_empty=True)))
    audited = _audited(given, audit, file) if audit else None
    given.problems += [] if audited is None else audited.problems()
    look = look_over(given, radius)
    walls, problems, space, reach = look.walls, look.problems, look.space, look.reach
    findings = [problem for problem in problems if problem.severity != "info"]
    if preview:
        _draw(walls, problems, [gap.path for gap in reach.leaks], preview)
    if as_json:
        report = _report(walls, problems, space, reach, len(findings))
        report |= {} if audited is None else {"audit": audited.to_json()}
        print(json.dumps(report, ensure_ascii=False))
    else:
        _tell(walls, problems, space, reach, given.assumed)
        if audited is not None:
            print(audited.sentence())
    raise typer.Exit(1 if findings else 0)


@dataclass(frozen=True, slots=True)
class Look:
    """What was found about what FILE holds: problems with the severe first, free space, and where balls get to."""

    walls: Walls
    problems: list[Problem]
    space: FreeSpace
    reach: Reach


def look_over(given: Given, radius: float | None) -> Look:
    """Look for leaks of a ball of a radius (None: the smallest given, else any), and whatever else is doubtful."""
    from wallkit.walls.checking.ball_places import ball_problems, goal_problems
    from wallkit.walls.checking.free_space import free_space
    from wallkit.walls.checking.leaks import leak_problems, reach_of

    walls = given.walls
    if radius is None and len(given.radii):
        radius = float(given.radii.min())
        given.assumed.append(f"a ball of radius {radius:.6g}, the smallest that is given (--radius)")
    space = free_space(walls)
    reach = reach_of(space, walls, radius, given.places)
    found = ball_problems(space, walls, given.places, given.radii)
    found += [] if given.sensors is None else goal_problems(space, given.sensors, given.places)
    found += [*leak_problems(space, reach), *given.problems, *_without_walls(walls)]
    return Look(walls, sorted(_once(found), key=_rank), space, reach)


def _without_walls(walls: Walls) -> list[Problem]:
    from importers.problems import Problem

    if len(walls):
        return []
    fix = "see what the file holds with: wallkit inspect; take other layers (--layer) or hidden paths (--hidden)"
    return [Problem("no-walls", "warning", "there is nothing in it that makes a wall", fix)]


def _once(problems: list[Problem]) -> list[Problem]:
    """Leave out what was told before of the same place: the opening tells some of what is looked at closer here."""
    told: dict[Any, Problem] = {}
    for index, problem in enumerate(problems):
        placed = problem.code in ("ball-in-material", "shut-in")
        told.setdefault((problem.code, problem.x, problem.y) if placed else index, problem)
    return list(told.values())


def _rank(problem: Problem) -> int:
    """The severe first, and among those in the order of coming: a picture has no room for all."""
    return ("error", "warning", "info").index(problem.severity)


def _check_radius(radius: float | None) -> None:
    from wallkit.walls.walls import WallsError

    if radius is not None and not (math.isfinite(radius) and radius >= 0):
        raise WallsError(f"radius is {radius!r}", code="bad-option", fix="give a number from 0")


@dataclass(slots=True)
class Given:
    """What FILE holds: walls, places and radii of its balls, all that was found in it, and what was assumed."""

    walls: Walls
    places: NDArray[np.float64]
    radii: NDArray[np.float64]
    problems: list[Problem] = field(default_factory=list)
    assumed: list[str] = field(default_factory=list)
    sensors: Walls | None = None
    drawing: Drawing | None = None
    importing: ImportOptions | None = None


def given_of(found: OpenedScene) -> Given:
    """Take what FILE holds, opened as `simulate` does; a ball that would only be put somewhere does not count."""
    import numpy as np

    walls, balls = found.scene.walls, found.scene.balls
    assumed = [] if walls.solid is None or walls.solid.how == "asked" else [walls.solid.sentence()]
    places, radii = np.asarray(balls.position), np.asarray(balls.radius)
    if found.found_place:
        places, radii = np.empty((0, 2)), np.empty(0)
    sensors, drawing = found.scene.sensors, found.drawing
    return Given(walls, places, radii, found.problems, assumed, sensors, drawing, found.importing)


def _audited(given: Given, count: int, file: str) -> Audit:
    """Ask svgpathtools whether the walls are where the curves are."""
    from wallkit.scene.opening import UsageError
    from wallkit.walls.checking.audit import audit
    from wallkit.walls.importing.placing import placed

    if given.drawing is None or given.importing is None:
        fix = "give the drawing that they were made of"
        raise UsageError("--audit holds walls against a drawing, and this has none", code="usage", fix=fix, file=file)
    if given.importing.outline_strokes:
        raise UsageError("--audit and --outline-strokes do not go together: outlines are not drawn", code="usage")
    return audit(given.walls, placed(given.drawing, given.importing), count, given.importing)


def _report(walls: Walls, problems: list[Problem], space: FreeSpace, reach: Reach, findings: int) -> dict[str, Any]:
    from wallkit.walls.checking.leaks import gap_json

    return {
        "format": FORMAT,
        "version": VERSION,
        "source": {"file": walls.source_file, "sha256": walls.source_sha256},
        **({"solid": walls.solid.to_json()} if walls.solid is not None else {}),
        "walls": len(walls),
        "edges": len(walls.edge_starts),
        "radius": reach.radius,
        "findings": findings,
        "leaks": [gap_json(gap) for gap in reach.leaks],
        "unreachable": [gap_json(gap) for gap in reach.shut],
        "holding": [gap_json(gap) for gap in reach.holding],
        "gaps": [gap_json(gap) for gap in space.gaps],
        "rooms": space.closed_rooms.tolist(),
        "problems": [problem.to_json() for problem in problems],
    }


def _tell(walls: Walls, problems: list[Problem], space: FreeSpace, reach: Reach, assumed: list[str]) -> None:
    from wallkit.cli.import_ import summarise
    from wallkit.cli.messages import show_problems
    from wallkit.walls.checking.leaks import middle

    show_problems(problems, walls.source_file, sys.stdout)
    for sentence in assumed:
        print(f"assumed: {sentence}")
    summarise(walls, sys.stdout)
    ball = "any ball" if reach.radius is None else f"a ball of radius {reach.radius:g}"
    leaks, shut = reach.leaks, reach.shut
    if not space.complete:
        print(f"whether {ball} leaks is not known")
    elif leaks:
        print(f"leaks for {ball}: {len(leaks)}, the narrowest gap {leaks[0].width:.6g} wide")
    else:
        print(f"no leak for {ball}")
    if shut:
        print(f"out of reach: {len(shut)} {'room' if len(shut) == 1 else 'rooms'}")
    rest = [gap for gap in space.gaps if gap not in leaks]
    if rest:
        print(f"narrowest gap between rooms: {rest[0].width:.6g} wide, at ({_at(middle(rest[0]))})")
    rooms = [*space.closed_rooms.tolist(), *((*gap.room, gap.room_radius) for gap in space.gaps)]
    if rooms:
        x, y, largest = max(rooms, key=lambda room: room[2])
        print(f"largest ball that fits in a room: radius {largest:.5g}, at ({_at((x, y))})")


def _at(place: tuple[float, float]) -> str:
    return f"{place[0]:.6g}, {place[1]:.6g}"


def _draw(walls: Walls, problems: list[Problem], ways: list[Any], picture: str) -> None:
    """Write the picture with the ways through the leaks."""
    from wallkit.view.picture import walls_canvas
    from wallkit.view.write import write_picture

    write_picture(picture, walls_canvas(walls, problems, ways=ways))
