"""Declarations of one block or ``style`` attribute, reduced to what they come to."""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

from importers.svg.style import Declaration, Declared, TooLarge, Unread


class Winners(NamedTuple):
    """What a list of declarations comes to: of each property the last one.

    Attributes:
        normal: without ``!important``.
        important: with it.
        too_large: properties with a number that is too large.
        unread: transforms that are wrong.
    """

    normal: Declared
    important: Declared
    too_large: tuple[str, ...] = ()
    unread: tuple[str, ...] = ()


def winners(declarations: Iterable[Declaration]) -> Winners:
    """Give the normal and the important ones, each with what comes last winning."""
    normal: Declared = {}
    important: Declared = {}
    too_large, unread = [], []
    for name, value, is_important in declarations:
        if isinstance(value, TooLarge):
            too_large.append(name)
        elif isinstance(value, Unread):
            unread.append(name)
        else:
            (important if is_important else normal)[name] = value
    return Winners(normal, important, tuple(too_large), tuple(unread))
