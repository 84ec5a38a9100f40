"""`wallkit report`: speed against error, the horizon's table, what things cost; `--hard` the known answers."""

from __future__ import annotations

import json
import sys
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

import typer

from wallkit.cli import import_options as options

if TYPE_CHECKING:
    from wallkit.accuracy.contest import Effort, Subject
    from wallkit.accuracy.report import Report
    from wallkit.scene.scene import Scene
    from wallkit.walls.import_options import ImportOptions

ENDINGS = (".svg", ".html", ".json")


def register(app: typer.Typer) -> None:
    """Attach the command."""
    app.command("report", rich_help_panel="Balls")(report)


@options.with_import_options()
def report(
    file: Annotated[
        str | None, typer.Argument(metavar="FILE", help="Drawing, walls or scene; without one the built-in scenes.")
    ] = None,
    out: Annotated[
        list[str] | None,
        typer.Option("-o", "--out", metavar="OUT", help=f"Picture, page or data: {' '.join(ENDINGS)}. Repeatable."),
    ] = None,
    as_json: Annotated[bool, typer.Option("--json", help="Write the figures as JSON on standard output.")] = False,
    quick: Annotated[
        bool, typer.Option("--quick", help="Fewer scenes and settings: some 15 s, more on first use without a wheel.")
    ] = False,
    hard: Annotated[bool, typer.Option("--hard", help="Run the cases with known answers instead.")] = False,
    scene: Annotated[
        list[str] | None, typer.Option("--scene", metavar="NAME", help="Only this built-in scene. Repeatable.")
    ] = None,
    precision: Annotated[
        int | None,
        typer.Option(
            metavar="BITS",
            min=53,
            max=100_000,
            help="Bits of the reference, such as 106 (default: as many as it takes).",
        ),
    ] = None,
    importing: dict[str, Any] | None = None,
) -> None:
    """Measure speed against error, here: the exact simulator, frame stepping, other engines if installed."""
    _check(file, out or [], hard, scene)
    if hard:
        _hard(as_json, quick)
        return
    from wallkit.accuracy.report import measure
    from wallkit.cli.progress import progress_words

    effort = _effort(quick, precision)
    subjects = [_of_file(file, options.options_of(importing or {}))] if file else _built_in(scene, quick)
    with progress_words() as told:
        measured = measure(subjects, effort, tables=file is None and not scene, told=told)
    for target in out or []:
        _write(target, measured)
    if as_json:
        print(json.dumps(measured.to_json(), indent=1))
    else:
        from wallkit.cli.report_tables import lines

        print("\n".join(lines(measured)))


def _check(file: str | None, out: list[str], hard: bool, scene: list[str] | None) -> None:
    from wallkit.scene.wishes import UsageError

    for target in out:
        if Path(target).suffix.lower() not in ENDINGS:
            raise UsageError(
                "a report cannot be written like this",
                code="unknown-ending",
                fix=f"use an ending of these: {', '.join(ENDINGS)}",
                file=target,
            )
    if hard and (file or out or scene):
        raise UsageError("--hard runs the cases with known answers and takes no FILE, --scene or -o", code="usage")
    if file and scene:
        raise UsageError("--scene names a built-in scene, and FILE is another", code="usage", fix="give one of them")


def _effort(quick: bool, precision: int | None) -> Effort:
    from wallkit.accuracy.contest import QUICK, Effort

    effort = QUICK if quick else Effort()
    if precision is None:
        return effort
    return replace(effort, digits=max(16, round(precision * 0.30103)), fixed=True)


def _built_in(names: list[str] | None, quick: bool) -> list[Subject]:
    from wallkit.accuracy.contest import subjects
    from wallkit.scene.wishes import UsageError

    scenes = subjects()
    unknown = [name for name in names or [] if name not in scenes]
    if unknown:
        raise UsageError(
            f"there is no built-in scene {unknown[0]!r}", code="unknown-scene", fix=f"one of {', '.join(scenes)}"
        )
    chosen = names or (["box", "star", "curve", "sinai"] if quick else list(scenes))
    return [scenes[name] for name in chosen]


def _of_file(file: str, importing: ImportOptions) -> Subject:
    from wallkit.accuracy.contest import Subject
    from wallkit.accuracy.own import first_ball, of_scene
    from wallkit.cli.scene_input import opened
    from wallkit.scene.wishes import UsageError, Wishes

    name = "standard input" if file == "-" else Path(file).name
    try:
        found = opened(file, Wishes(importing=importing))
    except UsageError as error:
        if error.code == "no-room":  # it speaks of options that simulate has
            error.fix = "draw a ball: a circle on a layer named balls; or give a scene file that has one"
        raise
    drawing = found.drawing
    if drawing is None or found.kind == "scene":
        return of_scene(name, found.scene)
    decided = found.scene.walls.solid
    room = decided is not None and decided.room
    importing = replace(importing, arena=room, solid=not room, room="")
    balls = first_ball(found.scene.balls)

    def walls(curves: Literal["lines", "arcs"], tolerance: float) -> Scene:
        from wallkit.walls.importing.pipeline import build_walls

        imported = build_walls(drawing, replace(importing, curves=curves, tolerance=tolerance))
        return replace(found.scene, walls=imported, balls=balls)

    curved = walls("arcs", 1e-3).walls.has_arcs
    arcs = (lambda tolerance: walls("arcs", tolerance)) if curved else None
    return Subject(name, "a drawing", lambda tolerance: walls("lines", tolerance), arcs, curved)


def _write(target: str, measured: Report) -> None:
    from wallkit.write_file import write_whole

    ending = Path(target).suffix.lower()
    if ending == ".json":
        write_whole(target, json.dumps(measured.to_json(), indent=1) + "\n")
    elif ending == ".svg":
        from wallkit.view.work_precision import work_precision_svg

        write_whole(target, work_precision_svg(measured.contests, measured.foot()))
    else:
        from wallkit.view.report_page import report_html

        write_whole(target, report_html(measured))
    print(f"wrote {target}", file=sys.stderr)


def _hard(as_json: bool, quick: bool) -> None:
    """Run the known answers: a line each as they come; exit 1 where one does not hold."""
    from wallkit.accuracy.cases import run_cases
    from wallkit.cli.report_tables import case_line, case_row

    rows, failed = [], 0
    for case, outcome, seconds in run_cases(slow=not quick):
        failed += not outcome.holds
        if as_json:
            rows.append(case_row(case, outcome, seconds))
        else:
            print(case_line(case, outcome, seconds), flush=True)
    if as_json:
        print(json.dumps({"format": "wallkit-cases", "version": 1, "cases": rows}, indent=1))
    else:
        print(f"\n{failed} of the answers above do not hold" if failed else "\nall answers hold")
    if failed:
        raise typer.Exit(1)
