"""The typer application and the one place where an error becomes words and an exit code."""

from __future__ import annotations

import os
import sys
from typing import Annotated

import typer

from importers.errors import WallkitError

app = typer.Typer(
    name="wallkit",
    help="Turn a drawing into walls, and shoot balls at them with the exact answer.",
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)


def _show_version(wanted: bool) -> None:
    if wanted:
        from wallkit.version import __version__

        typer.echo(f"wallkit {__version__}")
        raise typer.Exit


@app.callback()
def _root(
    version: Annotated[
        bool,
        typer.Option("--version", callback=_show_version, is_eager=True, help="Show the version and exit."),
    ] = False,
) -> None:
    """Turn a drawing into walls, and shoot balls at them with the exact answer."""


def _register_commands() -> None:
    """Attach one module a command. The modules import what is heavy only when their command runs."""
    from wallkit.cli import aim, check, export, import_, inkscape, inspect, play, report, simulate, warm

    inspect.register(app)
    import_.register(app)
    check.register(app)
    simulate.register(app)
    aim.register(app)
    export.register(app)
    play.register(app)
    report.register(app)
    inkscape.register(app)
    warm.register(app)


def main() -> None:
    """Run the command line; end with 0 fine, 1 findings, 2 unreadable input or usage, 3 a limit, 130 interrupted."""
    _register_commands()
    try:
        app()
    except WallkitError as error:
        from wallkit.cli.messages import show_error

        show_error(error)
        sys.exit(error.exit_code)
    except KeyboardInterrupt:
        typer.echo("wallkit: interrupted", err=True)
        sys.exit(130)
    except BrokenPipeError:  # the reader of our output (head, less) has seen enough
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        sys.exit(0)
