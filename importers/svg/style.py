"""Style: what CSS and presentation attributes say about an element, property by property.

Only what changes geometry, visibility or the marks of a path is looked at. tinycss2 and cssselect2 read the
style sheets; what it comes to on an element is for importers.svg.cascade, what its children inherit for
importers.svg.inheritance.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import tinycss2

from importers.numbers import NumberError
from importers.svg.units import LONGEST, unreadable
from importers.svg.values import MISSED, OPACITIES, PARSERS, Origin

# Property, value, important
Declaration = tuple[str, Any, bool]
# Declarations of one element that are valid: property name to parsed value.
Declared = dict[str, Any]

INHERIT = "inherit"  # also stands for "unset" of an inherited property
INITIAL = "initial"
VARIABLES = "--"  # a Declared has the custom properties of its element under this name


@dataclass(frozen=True, slots=True)
class TooLarge:
    """The value of a declaration with a number that is beyond what a double holds.

    Attributes:
        offset: of the number, in the value.
        instead: what browsers then take, None where the declaration is as if it were not there.
    """

    offset: int = 0
    instead: Any = None


@dataclass(frozen=True, slots=True)
class Unread:
    """The value of a declaration that is as if it were not there, but is missed: of a property in MISSED."""


@dataclass(frozen=True, slots=True)
class Pending:
    """The value of a declaration that waits for the custom properties of its element: it has a ``var()``.

    Attributes:
        text: as written.
        origin: where it stands.
    """

    text: str
    origin: Origin


_WIDE = {"inherit": INHERIT, "initial": INITIAL, "unset": "unset", "revert": "unset", "revert-layer": "unset"}
INHERITED = frozenset(
    (
        "fill",
        "stroke",
        "stroke-width",
        "fill-rule",
        "clip-rule",
        "fill-opacity",
        "stroke-opacity",
        "color",
        "visibility",
        "font-size",
        "line-height",
    )
)
PROPERTIES = frozenset(PARSERS)
# Attributes that are not declarations by themselves: geometry is looked up on the element that has it
_LAZY = frozenset(("x", "y", "cx", "cy", "r", "rx", "ry", "width", "height", "d"))
PRESENTATION = PROPERTIES - _LAZY - {"line-height", "translate", "rotate", "scale"}


def parse_declaration(name: str, text: str, origin: Origin) -> Any:
    """Give the parsed value of a declaration, None when it is invalid (and so is as if it were not there).

    A TooLarge, an Unread or a Pending stand for what they say. An attribute of geometry is no declaration by
    itself, so it is None where it cannot be read.
    """
    return _parse_short(name, text, origin) if len(text) < SHORT else _parse(name, text, origin)


SHORT = 500  # letters of a value that is worth keeping


@lru_cache(maxsize=8192)
def _parse_short(name: str, text: str, origin: Origin) -> Any:
    return _parse(name, text, origin)


def _parse(name: str, text: str, origin: Origin) -> Any:
    if name not in ("transform", "d") or origin != "attribute":
        if "(" in text and "var(" in text.lower():
            return Pending(text, origin)
        if unreadable(text):
            return None
    wide = _WIDE.get(text.strip().lower()) if len(text) < SHORT else None
    if wide is not None:
        return unset(name) if wide == "unset" else wide
    try:
        value = PARSERS[name](text, origin)
    except NumberError as error:
        return TooLarge(error.offset, _instead(name, error.value))
    missed = value is None and name in MISSED and not (origin == "attribute" and name in _LAZY)
    return Unread() if missed and text.strip() else value


def _instead(name: str, value: float) -> Any:
    """Give what browsers take for a value that is infinite, or none (which counts as 0)."""
    if name in OPACITIES:
        return 1.0 if value > 0 else 0.0
    return ((LONGEST, "px"),) if name == "stroke-width" and value > 0 else None


def unset(name: str) -> str:
    """Give what ``unset`` means for a property."""
    return INHERIT if name in INHERITED else INITIAL


def parse_inline(text: str) -> list[Declaration] | None:
    """Read a plain ``style`` attribute to (property, value, important), invalid and unknown ones left out.

    None when it is not plain: escapes, comments, blocks, or a semicolon within quotes or brackets. Those need
    tinycss2 (:func:`parse_any_inline`), which is a hundred times slower.
    """
    if "\\" in text or "/*" in text or "{" in text or "[" in text:
        return None
    found = []
    for piece in text.split(";"):
        if piece.count("(") != piece.count(")") or piece.count("'") % 2 or piece.count('"') % 2:
            return None
        name, colon, value = piece.partition(":")
        own = name.strip()
        name = own.lower()
        if name == "font" and colon:
            return None
        custom = own[:2] == "--"
        if not colon or not (custom or name in PARSERS):
            continue
        plain, mark, word = value.rpartition("!")
        important = bool(mark) and word.strip().lower() == "important"
        text = plain if important else value
        if custom:
            found.append((own, text.strip(), important))
            continue
        parsed = parse_declaration(name, text, "inline")
        if parsed is not None:
            found.append((name, parsed, important))
    return found


def parse_any_inline(text: str) -> list[Declaration]:
    """Read any ``style`` attribute to (property, value, important), invalid and unknown ones left out."""
    if unreadable(text):
        return []
    found = []
    for declaration in tinycss2.parse_blocks_contents(text, skip_comments=True, skip_whitespace=True):
        if declaration.type == "declaration":
            found += known_declarations(declaration, "inline")
    return found


def known_declarations(declaration: Any, origin: Origin) -> list[Declaration]:
    """Give what one tinycss2 declaration sets; the ``font`` shorthand gives its size and line height."""
    name, text = declaration.lower_name, tinycss2.serialize(declaration.value)
    if name[:2] == "--":
        return [(declaration.name, text.strip(), declaration.important)]
    if name == "font":
        return _font_shorthand(declaration, origin)
    if name not in PARSERS:
        return []
    value = parse_declaration(name, text, origin)
    return [] if value is None else [(name, value, declaration.important)]


def _font_shorthand(declaration: Any, origin: Origin) -> list[Declaration]:
    tokens = [token for token in declaration.value if token.type != "whitespace"]
    for index, token in enumerate(tokens):
        size = parse_declaration("font-size", tinycss2.serialize([token]), origin)
        if size is None or isinstance(size, Pending | Unread) or token.type == "number":
            continue
        rest = tokens[index + 1 :]
        found: list[Declaration] = [("font-size", size, declaration.important)]
        height: Any = "normal"
        if len(rest) >= 2 and rest[0].type == "literal" and rest[0].value == "/":
            height = parse_declaration("line-height", tinycss2.serialize([rest[1]]), origin)
            rest = rest[2:]
        if height is None or isinstance(height, Unread):
            return []
        found.append(("line-height", height, declaration.important))
        return found if rest else []
    return []
