"""CSS custom properties: ``var(--name, fallback)`` put in, within a bound on what comes out."""

from __future__ import annotations

import re
from collections.abc import Mapping

from importers.limits import Work

MAX_LETTERS = 10_000  # of a value once its variables are put in; two that name each other twice would double it
_MAX_DEPTH = 32  # fallbacks in fallbacks, variables in variables
_VAR = re.compile(r"(?<![\w-])var\(", re.IGNORECASE)
_NAMED = re.compile(_VAR.pattern + r"([^,()]*+)", re.IGNORECASE)
_SIGN = re.compile(r"[()\"',]")


class UnresolvedError(Exception):
    """A variable that is not there, names itself, or becomes too long: the declaration is invalid."""


def resolve_all(own: Mapping[str, str], around: Mapping[str, str], work: Work) -> dict[str, str]:
    """Give the custom properties of an element: its own, with theirs put in, over those it inherits.

    One that cannot be resolved is as if it were not declared anywhere.

    Args:
        own: name to text.
        around: those of the parent.
        work: the budget.
    """
    found: dict[str, str | None] = {name: text for name, text in around.items() if name not in own}
    work.charge("custom properties", len(found) + len(own))
    for name in own:
        _resolve_one(name, own, found, set(), work)
    return {name: text for name, text in found.items() if text is not None}


def _resolve_one(
    name: str, own: Mapping[str, str], found: dict[str, str | None], open_now: set[str], work: Work
) -> None:
    """Put one's own variables in, those it needs first; None is found for one that needs itself."""
    if name in found or name in open_now or name not in own or len(open_now) >= _MAX_DEPTH:
        return
    open_now.add(name)
    for needed in _names(own[name]):
        _resolve_one(needed, own, found, open_now, work)
    open_now.discard(name)
    try:
        found[name] = put_in(own[name], found, work)
    except UnresolvedError:
        found[name] = None


def _names(text: str) -> list[str]:
    """Give the names in a value, those in fallbacks too; where each ``var()`` ends is not looked for."""
    return [match[1].strip() for match in _NAMED.finditer(text)]


def put_in(text: str, variables: Mapping[str, str | None], work: Work, depth: int = 0) -> str:
    """Give a value with each ``var()`` replaced.

    Raises:
        UnresolvedError: one has no value and no fallback, or what comes out is too long or too deep.
        LimitError: the budget is used up.
    """
    pieces: list[str] = []
    position = size = 0
    while match := _VAR.search(text, position):
        name, fallback, end = _parts(text, match.end())
        value = variables.get(name)
        if value is None:
            if fallback is None or depth >= _MAX_DEPTH:
                raise UnresolvedError
            value = put_in(fallback, variables, work, depth + 1)
        pieces += (text[position : match.start()], value)
        size += match.start() - position + len(value)
        work.charge("custom properties", 1 + (end - position + len(value)) // 8)
        if size > MAX_LETTERS:
            raise UnresolvedError
        position = end
    return "".join((*pieces, text[position:]))


def _parts(text: str, start: int) -> tuple[str, str | None, int]:
    """Give the name and the fallback of a ``var(`` whose inside begins at ``start``, and the place behind it."""
    depth, comma, position = 1, -1, start
    while match := _SIGN.search(text, position):
        position = match.end()
        if match[0] in "\"'":
            closed = text.find(match[0], position)
            position = closed + 1 if closed >= 0 else len(text)
        elif match[0] == "," and depth == 1 and comma < 0:
            comma = match.start()
        elif match[0] == "(":
            depth += 1
        elif match[0] == ")":
            depth -= 1
            if depth == 0:
                break
    end = position - 1 if depth == 0 else len(text)
    name = text[start : comma if comma >= 0 else end].strip()
    return name, (text[comma + 1 : end].strip() if comma >= 0 else None), position if depth == 0 else len(text)
