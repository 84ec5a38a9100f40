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
    from wallkit.view.page.documents import Reader
    from wallkit.view.page.workers import Workers
    from wallkit.walls.import_options import ImportOptions


def register(app: typer.Typer) -> None:
    """Attach the command."""
    app.command("play", rich_help_panel="Balls")(play)


@options.with_import_options()
def play(
    file: Annotated[
        str, typer.Argument(metavar="FILE", help="Drawing, walls or scene to open; without one, the samples.")
    ] = "",
    port: Annotated[int, typer.Option(help="Port on this machine; 0 is any free one.", min=0, max=65535)] = 0,
    browser: Annotated[bool, typer.Option("--browser/--no-browser", help="Open it in the browser.")] = True,
    importing: dict[str, Any] | None = None,
) -> None:
    """Open the local page: see walls, aim, shoot, step from bounce to bounce. It follows FILE when that is saved."""
    from wallkit.view.page.server import PageServer
    from wallkit.view.page.workers import Workers

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
