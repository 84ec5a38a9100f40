"""`wallkit play`: a local page to see walls and to shoot balls at them."""

from __future__ import annotations

import io
import json
import re
import webbrowser
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from importers.errors import WallkitError
from wallkit.cli import import_options as options

if TYPE_CHECKING:
    from wallkit.view.export_pages import Exhibit
    from wallkit.view.page.documents import Reader
    from wallkit.view.page.workers import Workers
    from wallkit.walls.import_options import ImportOptions


def register(app: typer.Typer) -> None:
    """Attach the command."""
    app.command("play", rich_help_panel="Balls")(play)


@options.with_import_options()
def play(
    files: Annotated[
        list[str] | None,
        typer.Argument(metavar="FILE", help="Drawing, walls or scene to open; without one, lessons and samples."),
    ] = None,
    port: Annotated[int, typer.Option(help="Port on this machine; 0 is any free one.", min=0, max=65535)] = 0,
    browser: Annotated[bool, typer.Option("--browser/--no-browser", help="Open it in the browser.")] = True,
    export_page: Annotated[
        str,
        typer.Option(
            metavar="DIR",
            help="Open nothing: write a folder of pages, one a FILE (or one a lesson), that needs no server.",
        ),
    ] = "",
    importing: dict[str, Any] | None = None,
) -> None:
    """Open the local page: see walls, aim, shoot, step from bounce to bounce. It follows FILE when that is saved."""
    if export_page:
        _export(Path(export_page), files or [], options.options_of(importing or {}))
        return
    if len(files or []) > 1:
        from wallkit.scene.wishes import UsageError

        fix = "give one, or a folder for the pages of all: --export-page DIR"
        raise UsageError("the page opens one FILE", code="usage", fix=fix)
    from wallkit.view.page.server import PageServer
    from wallkit.view.page.workers import Workers

    file = files[0] if files else ""
    workers = Workers(reader())
    document = _first(workers, file, options.options_of(importing or {})) if file else None
    try:
        server = PageServer(workers, port, document)
    except OSError as error:
        raise WallkitError(
            f"cannot listen on port {port}: {error.strerror}", code="no-port", fix="give another --port, or none"
        ) from error
    typer.echo(f"wallkit is at {server.url}")
    typer.echo("Only this computer can open it. Stop it with Ctrl+C.", err=True)
    if browser:
        webbrowser.open(server.url)
    with server:
        server.serve_forever(poll_interval=0.2)


def _export(folder: Path, files: list[str], importing: ImportOptions) -> None:
    """Fly each file as `wallkit simulate` does, and write the pages."""
    from wallkit.cli.messages import plain
    from wallkit.scene.samples import lessons
    from wallkit.view.export_pages import write_pages

    exhibits = [_exhibit(file, importing) for file in files or [str(lesson.path) for lesson in lessons()]]
    for path in write_pages(folder, exhibits):
        typer.echo(f"wrote {plain(str(path))}")


def _exhibit(file: str, importing: ImportOptions) -> Exhibit:
    from wallkit.cli.scene_input import opened
    from wallkit.scene.wishes import Wishes
    from wallkit.simulation.simulate import simulate
    from wallkit.view.export_pages import Exhibit

    try:
        found = opened(file, Wishes(importing=importing))
        run = simulate(found.scene, found.until, found.bounces)
    except WallkitError as error:
        error.file = error.file or file  # of several files the one that it is about
        raise
    return Exhibit("standard input" if file == "-" else Path(file).name, run, found.lesson)


def _first(workers: Workers, file: str, importing: ImportOptions) -> dict[str, Any]:
    from wallkit.cli.scene_input import read_input
    from wallkit.view.page.questions import Opening
    from wallkit.watch_file import Watch

    watch = None if file == "-" else Watch(file)
    name = "standard input" if file == "-" else Path(file).name
    opening = Opening(read_input(file), name, Path() if file == "-" else Path(file).parent, importing)
    table: dict[str, Any] = json.loads(workers.open(opening, bounded=False, watch=watch).content)
    return table


def reader() -> Reader:
    """Give the page the command line's own ways of saying what is wrong."""
    from wallkit.cli.messages import format_problem
    from wallkit.view.page.documents import Reader

    return Reader(describe=_described, describe_problem=format_problem)


def _described(error: WallkitError) -> str:
    from wallkit.cli.messages import show_error

    stream = io.StringIO()
    show_error(error, stream)
    return re.sub(r"\x1b\[[0-9;]*m", "", stream.getvalue()).strip()  # FORCE_COLOR means the terminal
