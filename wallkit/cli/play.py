"""`wallkit play`: a local page to see walls and to shoot balls at them."""

from __future__ import annotations

import io
import re
import webbrowser
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from importers.errors import WallkitError

if TYPE_CHECKING:
    from importers.drawing import Drawing
    from wallkit.cli.scene_input import Prepared
    from wallkit.view.page.answers import Answers
    from wallkit.view.page.documents import Opened, Reader


def register(app: typer.Typer) -> None:
    """Attach the command."""
    app.command("play")(play)


def play(
    file: Annotated[
        str, typer.Argument(metavar="FILE", help="Drawing, walls or scene to open; without one, the samples.")
    ] = "",
    port: Annotated[int, typer.Option(help="Port on this machine; 0 is any free one.", min=0, max=65535)] = 0,
    browser: Annotated[bool, typer.Option("--browser/--no-browser", help="Open it in the browser.")] = True,
) -> None:
    """Open the local page: see walls, aim, shoot, step from bounce to bounce."""
    from wallkit.view.page.answers import Answers
    from wallkit.view.page.server import PageServer

    answers = Answers(reader())
    document = _first(answers, file) if file else None
    try:
        server = PageServer(answers, port, document)
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


def _first(answers: Answers, file: str) -> dict[str, Any]:
    from wallkit.cli.scene_input import read_input

    if file == "-":
        return answers.open(read_input(file), "standard input", Path())
    return answers.open(read_input(file), Path(file).name, Path(file).parent)


def reader() -> Reader:
    """Give the page the command line's own ways of reading and of saying what is wrong."""
    from wallkit.cli.messages import format_problem
    from wallkit.view.page.documents import Reader

    return Reader(open=_open, again=_again, describe=_described, describe_problem=format_problem)


def _open(data: bytes, name: str, folder: Path | None) -> Opened:
    from importers.read import read_drawing
    from wallkit.cli.scene_input import Wishes, prepare_data
    from wallkit.scene_files import kind_of

    if kind_of(data) == "drawing":
        stream = io.BytesIO(data)
        stream.name = name
        return _again(read_drawing(stream), {})
    return _opened(prepare_data(data, name, Wishes(), folder), None)


def _again(drawing: Drawing, options: dict[str, Any]) -> Opened:
    from wallkit.cli.scene_input import UsageError, Wishes, prepare_drawing

    try:
        return _opened(prepare_drawing(drawing, Wishes(importing=options)), drawing)
    except UsageError as error:
        if error.code != "no-room":
            raise
    x0, y0, x1, y1 = drawing.control_box() or (0.0, 0.0, 0.0, 0.0)  # shown all the same; the person places the ball
    return _opened(
        prepare_drawing(drawing, Wishes(ball=[f"{(x0 + x1) / 2!r},{(y0 + y1) / 2!r}"], importing=options)), drawing
    )


def _opened(prepared: Prepared, drawing: Drawing | None) -> Opened:
    from wallkit.view.page.documents import Opened

    return Opened(prepared.scene, prepared.kind, prepared.problems, drawing)


def _described(error: WallkitError) -> str:
    from wallkit.cli.messages import show_error

    stream = io.StringIO()
    show_error(error, stream)
    return re.sub(r"\x1b\[[0-9;]*m", "", stream.getvalue()).strip()  # FORCE_COLOR means the terminal
