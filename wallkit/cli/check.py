"""`wallkit check`: everything that is doubtful about a drawing or walls; exit code 1 when there is any."""

from __future__ import annotations

import json
import math
import sys
from typing import TYPE_CHECKING, Annotated, Any

import typer

from wallkit.cli import import_options as options
from wallkit.cli.check_balls import Flown, Wanted, fly_balls, lines, write_page
from wallkit.cli.simulate import Gravity, Speed, Until
from wallkit.cli.survey import Checkpoint, From, Where, Workers
from wallkit.cli.watching import watchable

if TYPE_CHECKING:
    from wallkit.scene.look_over import Given, Look
    from wallkit.walls.checking.audit import Audit

FORMAT, VERSION = "wallkit-check", 1

Points = Annotated[
    int,
    typer.Option(
        metavar="N",
        min=0,
        max=1_000_000,
        help="Hold N points of the walls against the curves as svgpathtools has them.",
    ),
]
Many = Annotated[
    str | None, typer.Option("--balls", metavar="N", help="Fly N balls, and tell what they find out; 1e6 is a number.")
]
To = Annotated[
    str | None,
    typer.Option("--to", metavar="NAME|X,Y,R", help="What is to be reached: sensor, target, wall, WALL:EDGE, circle."),
]
Bounces = Annotated[
    int | None, typer.Option(metavar="N", help="End after N bounces a ball (default, without --until: 2000).", min=0)
]


def register(app: typer.Typer) -> None:
    """Attach the command."""
    app.command("check", rich_help_panel="Drawings and walls")(check)


@options.with_import_options()
@watchable
def check(
    file: options.File,
    radius: Annotated[
        float | None,
        typer.Option(metavar="R", help="Look for leaks of a ball this large (default: the smallest drawn, else any)."),
    ] = None,
    as_json: Annotated[bool, typer.Option("--json", help="Write the findings as JSON to standard output.")] = False,
    preview: Annotated[str, typer.Option(metavar="PICTURE", help="Draw the walls, findings and leaks (.svg).")] = "",
    audit: Points = 0,
    balls: Many = None,
    start: From = None,
    target: To = None,
    until: Until = None,
    bounces: Bounces = None,
    speed: Speed = None,
    gravity: Gravity = None,
    seed: Annotated[int | None, typer.Option(metavar="K", help="Seed of --balls (default: 0).", min=0)] = None,
    out: Annotated[
        str | None, typer.Option("-o", "--out", metavar="OUT.html", help="Write a page about --balls, with pictures.")
    ] = None,
    executor: Where = "threads",
    workers: Workers = None,
    checkpoint: Checkpoint = None,
    importing: dict[str, Any] | None = None,
) -> None:
    """Find problems and leaks, with places and fixes, and what many balls find out; exit with 1 on findings."""
    from wallkit.cli.scene_input import opened
    from wallkit.scene.look_over import given_of, look_over

    _check_radius(radius)
    wanted = Wanted(balls, start, target, until, bounces, speed, gravity, seed, out, executor, workers, checkpoint)
    wanted.check()
    found = opened(file, wanted.wishes(options.options_of(importing or {})))
    given = given_of(found)
    audited = _audited(given, audit, file) if audit else None
    given.problems += [] if audited is None else audited.problems()
    flown = None if wanted.balls is None else fly_balls(found, radius, wanted)
    given.problems += [] if flown is None else flown.check.problems()
    look = look_over(given, radius)
    if preview:
        _draw(look, preview)
    if flown is not None and out is not None:
        write_page(out, flown, file)
    if as_json:
        print(json.dumps(_report(look, audited, flown), ensure_ascii=False))
    else:
        _tell(look, given.assumed)
        told = [] if audited is None else [audited.sentence()]
        for line in told if flown is None else [*told, *lines(flown, out)]:
            print(line)
    raise typer.Exit(1 if look.findings else 0)


def _check_radius(radius: float | None) -> None:
    from wallkit.walls.walls import WallsError

    if radius is not None and not (math.isfinite(radius) and radius >= 0):
        raise WallsError(f"radius is {radius!r}", code="bad-option", fix="give a number from 0")


def _audited(given: Given, count: int, file: str) -> Audit:
    """Ask svgpathtools whether the walls are where the curves are."""
    from wallkit.scene.wishes import UsageError
    from wallkit.walls.checking.audit import audit
    from wallkit.walls.importing.placing import placed

    if given.drawing is None or given.importing is None:
        fix = "give the drawing that they were made of"
        raise UsageError("--audit holds walls against a drawing, and this has none", code="usage", fix=fix, file=file)
    if given.importing.outline_strokes:
        raise UsageError("--audit and --outline-strokes do not go together: outlines are not drawn", code="usage")
    return audit(given.walls, placed(given.drawing, given.importing), count, given.importing)


def _report(look: Look, audited: Audit | None, flown: Flown | None) -> dict[str, Any]:
    from wallkit.walls.checking.leaks import gap_json

    walls, reach = look.walls, look.reach
    report = {
        "format": FORMAT,
        "version": VERSION,
        "source": {"file": walls.source_file, "sha256": walls.source_sha256},
        **({"solid": walls.solid.to_json()} if walls.solid is not None else {}),
        "walls": len(walls),
        "edges": len(walls.edge_starts),
        "radius": reach.radius,
        "findings": look.findings,
        "leaks": [gap_json(gap) for gap in reach.leaks],
        "unreachable": [gap_json(gap) for gap in reach.shut],
        "holding": [gap_json(gap) for gap in reach.holding],
        "gaps": [gap_json(gap) for gap in look.space.gaps],
        "rooms": look.space.closed_rooms.tolist(),
        "problems": [problem.to_json() for problem in look.problems],
    }
    report |= {} if audited is None else {"audit": audited.to_json()}
    return report if flown is None else report | {"balls": flown.check.to_json()}


def _tell(look: Look, assumed: list[str]) -> None:
    from wallkit.cli.import_ import summarise
    from wallkit.cli.messages import show_problems
    from wallkit.walls.checking.leaks import middle

    walls, space, reach = look.walls, look.space, look.reach
    show_problems(look.problems, walls.source_file, sys.stdout)
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
    told = set(leaks)
    rest = [gap for gap in space.gaps if gap not in told]
    if rest:
        print(f"narrowest gap between rooms: {rest[0].width:.6g} wide, at ({_at(middle(rest[0]))})")
    rooms = [*space.closed_rooms.tolist(), *((*gap.room, gap.room_radius) for gap in space.gaps)]
    if rooms:
        x, y, largest = max(rooms, key=lambda room: room[2])
        print(f"largest ball that fits in a room: radius {largest:.5g}, at ({_at((x, y))})")


def _at(place: tuple[float, float]) -> str:
    return f"{place[0]:.6g}, {place[1]:.6g}"


def _draw(look: Look, picture: str) -> None:
    """Write the picture with the ways through the leaks."""
    from wallkit.view.picture import walls_canvas
    from wallkit.view.write import write_picture

    ways = [gap.path for gap in look.reach.leaks]
    write_picture(picture, walls_canvas(look.walls, look.problems, ways=ways))
