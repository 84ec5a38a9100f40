"""Values of options that are plain: texts, numbers, words of a few, flags, so that nothing is imported to convert them.

Typer converts all values of a command with pydantic, text to text and what nobody gave included. Importing that takes
as long as importing numpy, and a good part of what a small simulation takes. What is not plain, or is not allowed, is
left to Typer, errors included.
"""

from __future__ import annotations

import inspect
import re
from collections.abc import Callable
from functools import cached_property
from types import UnionType
from typing import Annotated, Any, Literal, Union, get_args, get_origin, get_type_hints

from typer.core import TyperCommand, TyperGroup

_NOT_PLAIN = object()
_WHOLE = re.compile(r"[+-]?[0-9]{1,15}")
_NUMBER = re.compile(r"[+-]?[0-9]{1,15}(\.[0-9]{1,15})?(e[+-]?[0-9]{1,2})?")


class _Plain:
    """What commands and groups share."""

    callback: Callable[..., Any] | None

    @cached_property
    def _hints(self) -> dict[str, Any]:
        """Types that the command says for its parameters, by name, with what is said about them.

        Typer wraps the command. From Python 3.14 on that loses annotations which were set by hand, as those of commands
        that are given the options of the import are.
        """
        return {} if self.callback is None else get_type_hints(inspect.unwrap(self.callback), include_extras=True)

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
    said, limits = (get_args(hint)[0], get_args(hint)[1]) if get_origin(hint) is Annotated else (hint, None)
    alternatives = [one for one in _alternatives(said) if one is not type(None)]
    kind = alternatives[0] if len(alternatives) == 1 else None

    def process_value(context: Any, value: Any) -> Any:
        plain = _plain(value, kind, limits)
        if plain is _NOT_PLAIN:
            if not _stands_for_none(value, parameter):
                return converted(context, value)
            plain = value
        if parameter.multiple or parameter.nargs != 1:
            plain = tuple(plain or ())
        return plain if parameter.callback is None else parameter.callback(context, parameter, plain)

    parameter.process_value = process_value


def _alternatives(said: Any) -> tuple[Any, ...]:
    return get_args(said) if get_origin(said) in (Union, UnionType) else (said,)


def _plain(value: Any, kind: Any, limits: Any) -> Any:
    """Give a value of the kind that is asked for, or _NOT_PLAIN.

    Args:
        value: as it was typed, or a flag's.
        kind: str, int, float, bool, a Literal of texts, or a list of texts; of others nothing is plain.
        limits: has ``min`` and ``max`` of numbers, or None.
    """
    if kind == list[str]:
        texts = isinstance(value, list | tuple) and value and all(isinstance(one, str) for one in value)
        return value if texts else _NOT_PLAIN
    if kind is bool:
        return value if isinstance(value, bool) else _NOT_PLAIN
    if not isinstance(value, str):
        return _NOT_PLAIN
    if kind is str or (get_origin(kind) is Literal and value in get_args(kind)):
        return value
    if (kind is int and _WHOLE.fullmatch(value)) or (kind is float and _NUMBER.fullmatch(value)):
        number = kind(value)
        low, high = getattr(limits, "min", None), getattr(limits, "max", None)
        return number if (low is None or number >= low) and (high is None or number <= high) else _NOT_PLAIN
    return _NOT_PLAIN


def _stands_for_none(value: Any, parameter: Any) -> bool:
    """Tell whether nobody gave a value: it is missing, or the default."""
    if parameter.required:
        return False
    return value is None or (isinstance(value, bool | int | float | str) and value is parameter.default)
