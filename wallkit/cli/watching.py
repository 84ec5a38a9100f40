"""`--watch`: run a command again whenever its file is saved."""

from __future__ import annotations

import functools
import inspect
import sys
import time
from collections.abc import Callable
from typing import Annotated, Any, get_type_hints

import typer

from importers.errors import WallkitError

_Option = Annotated[bool, typer.Option("--watch", help="Do it again whenever FILE is saved; Ctrl+C ends it.")]


def watchable(command: Callable[..., None]) -> Callable[..., None]:
    """Give a command that takes ``file`` the option ``--watch``."""
    own = inspect.signature(command)
    hints = get_type_hints(command, include_extras=True)
    given = [p.replace(annotation=hints[p.name]) for p in own.parameters.values()]
    watch = inspect.Parameter("watch", inspect.Parameter.KEYWORD_ONLY, default=False, annotation=_Option)

    @functools.wraps(command)
    def run(*, file: str, watch: bool = False, **values: Any) -> None:
        if watch:
            repeat(file, lambda: command(file=file, **values))
        else:
            command(file=file, **values)

    parameters = [*(p.replace(kind=inspect.Parameter.KEYWORD_ONLY) for p in given), watch]
    run.__signature__ = own.replace(parameters=parameters)  # type: ignore[attr-defined]
    run.__annotations__ = {p.name: p.annotation for p in parameters}
    del run.__wrapped__
    return run


def repeat(file: str, act: Callable[[], None], wait: Callable[[float], None] = time.sleep) -> None:
    """Act, and again after each change of a file, until an interrupt; an error is told and waits for the next change.

    Args:
        file: what is watched, with the files that it names.
        act: the command.
        wait: for so many seconds.

    Raises:
        WallkitError: the file is standard input.
    """
    from wallkit.watch_file import EVERY, Watch

    if file == "-":
        raise WallkitError("standard input cannot be watched", code="usage", fix="give a file, or leave out --watch")
    watch = Watch(file)
    _once(act)
    try:
        while True:
            wait(EVERY)
            if watch.changed():
                print(f"{file} has changed", file=sys.stderr, flush=True)
                _once(act)
    except KeyboardInterrupt:
        return


def _once(act: Callable[[], None]) -> None:
    from wallkit.cli.messages import show_error

    try:
        act()
    except typer.Exit:  # findings of a check: they are told
        pass
    except WallkitError as error:
        show_error(error)
    sys.stdout.flush()
