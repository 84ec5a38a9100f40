"""Declarations of one block or ``style`` attribute, reduced to what they come to."""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import Any, NamedTuple

from importers.svg.style import Declaration, Declared, TooLarge, Unread
from importers.svg.values import MISSED, Fault

_NAME = re.compile(r"(?:^|(?<=[;\s{]))([-a-zA-Z]++)\s*+:")


class Winners(NamedTuple):
    """What a list of declarations comes to: of each property the last one.

    Attributes:
        normal: without ``!important``.
        important: with it.
        faults: properties that cannot be read, each once, with what is wrong.
    """

    normal: Declared
    important: Declared
    faults: tuple[tuple[str, Fault], ...] = ()


def fault_of(name: str, value: Any) -> Fault | None:
    """Say what is wrong with the value of a declaration; None where nothing is."""
    if isinstance(value, TooLarge):
        if name.startswith("stroke-dash") or name == "stroke-miterlimit":
            return Fault("bad-number", "info", "has a number that is too large; it changes no outline")
        used = "is not used" if value.instead is None else "counts as the nearest that browsers take"
        return Fault("bad-number", "error", f"has a number that is too large, and {used}")
    return MISSED[name] if isinstance(value, Unread) else None


def used(value: Any) -> Any:
    """Give what stands for the value of a declaration; None where it is as if it were not there."""
    return value.instead if isinstance(value, TooLarge) else None if isinstance(value, Unread) else value


def winners(declarations: Iterable[Declaration]) -> Winners:
    """Give the normal and the important ones, each with what comes last winning."""
    normal: Declared = {}
    important: Declared = {}
    faults: dict[str, Fault] = {}
    for name, value, is_important in declarations:
        fault = fault_of(name, value)
        if fault is not None:
            faults[name] = fault
            value = used(value)
        if value is not None:
            (important if is_important else normal)[name] = value
    return Winners(normal, important, tuple(faults.items()))


def place_of(name: str, text: str) -> int:
    """Give the index at which a property is last declared in a ``style`` attribute, 0 where it is not found."""
    return max((match.start(1) for match in _NAME.finditer(text) if match[1].lower() == name), default=0)
