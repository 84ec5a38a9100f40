"""The typer application and the one place where an error becomes words and an exit code."""

from __future__ import annotations

import importlib
import os
import sys
from typing import Annotated

import typer

from importers.errors import WallkitError
from wallkit.cli.plain_values import PlainCommand, PlainGroup

app = typer.Typer(
    name="wallkit",
    cls=PlainGroup,
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


_MODULES = {
    "inspect": "inspect",
    "import": "import_",
    "check": "check",
    "simulate": "simulate",
    "survey": "survey",
    "aim": "aim",
    "export": "export",
    "play": "play",
    "report": "report",
    "inkscape": "inkscape",
    "warm": "warm",
}
"""Which module of this folder has each command, in the order of the help."""


def _register_commands(wanted: str = "") -> None:
    """Attach the command that is wanted, or all, as far as they are not there yet.

    To make one takes milliseconds, most of them for its options. The modules import what is heavy only when their
    command runs.
    """
    there = {command.name for command in app.registered_commands}
    for name in [wanted] if wanted in _MODULES else _MODULES:
        if name not in there:
            importlib.import_module(f"wallkit.cli.{_MODULES[name]}").register(app)
    names = list(_MODULES)
    app.registered_commands.sort(key=lambda command: names.index(str(command.name)))
    for command in app.registered_commands:
        command.cls = PlainCommand


def run() -> None:
    """Run the command that the command line names, and put errors into words."""
    _register_commands("".join(sys.argv[1:2]))
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
