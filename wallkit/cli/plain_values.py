"""Values of options that are what the command asks for already, so that nothing has to be imported that converts them.

Typer converts all values of a command with pydantic, text to text and what nobody gave included. Importing that takes
as long as importing numpy, and a good part of what a small simulation takes.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property
from typing import Any, get_type_hints

from typer.core import TyperCommand, TyperGroup

_TEXTS = (str, str | None)
_LISTS_OF_TEXTS = (list[str], list[str] | None)


class _Plain:
    """What commands and groups share."""

    callback: Callable[..., Any] | None

    @cached_property
    def _hints(self) -> dict[str, Any]:
        """Types that the command says for its parameters, by name."""
        return get_type_hints(self.callback) if self.callback is not None else {}

    def get_params(self, ctx: Any) -> list[Any]:
        """Give the parameters, --help among them; each leaves plain values as they are."""
        parameters: list[Any] = super().get_params(ctx)  # type: ignore[misc]
        for parameter in parameters:
            if "process_value" not in vars(parameter):
                _leave_plain(parameter, self._hints.get(parameter.name))
        return parameters


class PlainCommand(_Plain, TyperCommand):
    """A command that lets Typer convert and check only those values that need it."""


class PlainGroup(_Plain, TyperGroup):
    """The same for a command that has others."""


def _leave_plain(parameter: Any, hint: Any) -> None:
    """Let a parameter take what is plain as it is.

    Args:
        parameter: an option or an argument, of Typer's own class or of Click's.
        hint: the type that the command says for it, or None.
    """
    converted: Callable[[Any, Any], Any] = parameter.process_value

    def process_value(context: Any, value: Any) -> Any:
        if not _is_plain(value, parameter, hint):
            return converted(context, value)
        several = parameter.multiple or parameter.nargs != 1
        plain = tuple(value or ()) if several else value
        return plain if parameter.callback is None else parameter.callback(context, parameter, plain)

    parameter.process_value = process_value


def _is_plain(value: Any, parameter: Any, hint: Any) -> bool:
    """Tell whether a value is of the right type: text where text is asked for, or what stands for no value."""
    if isinstance(value, str) and hint in _TEXTS:
        return True
    if isinstance(value, list | tuple) and value and hint in _LISTS_OF_TEXTS:
        return all(isinstance(one, str) for one in value)
    if parameter.required:
        return False
    return value is None or (isinstance(value, bool | int | float | str) and value is parameter.default)
