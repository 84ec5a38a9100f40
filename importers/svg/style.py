"""Style: what CSS and presentation attributes say about an element, property by property.

Only what changes geometry, visibility or the marks of a path is looked at. tinycss2 and cssselect2 read the
style sheets; what it comes to on an element is for importers.svg.cascade, what its children inherit for
importers.svg.inheritance.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from typing import Any, Literal, NamedTuple

import tinycss2

from importers.numbers import NumberError
from importers.problems import Severity
from importers.svg.colour import parse_colour
from importers.svg.transforms import parse_transform_attribute, parse_transform_property
from importers.svg.units import LONGEST, ROOT_FONT, Terms, check_numbers, parse_length, to_px, units_of, unreadable

# Where a declaration stands: browsers read an attribute, a ``style`` attribute and a style sheet each a little
# differently (numbers without units).
Origin = Literal["attribute", "inline", "sheet"]
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


class Fault(NamedTuple):
    """What is wrong with a declaration.

    Attributes:
        code: of the problem.
        severity: of the problem.
        message: what is the case, without the property's name.
    """

    code: str
    severity: Severity
    message: str


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
_KEYWORDS = {
    "visibility": frozenset(("visible", "hidden", "collapse")),
    "fill-rule": frozenset(("nonzero", "evenodd")),
    "clip-rule": frozenset(("nonzero", "evenodd")),
    "overflow": frozenset(("visible", "hidden", "scroll", "auto", "clip")),
    "transform-box": frozenset(("content-box", "border-box", "fill-box", "stroke-box", "view-box")),
}
_FONT_SIZES = {
    "xx-small": 9.0,
    "x-small": 10.0,
    "small": 13.0,
    "medium": 16.0,
    "large": 18.0,
    "x-large": 24.0,
    "xx-large": 32.0,
    "xxx-large": 48.0,
}


# Sizes that browsers work out from a content or a container, which no shape has
_AUTO = frozenset(("auto", "max-content", "min-content", "fit-content", "stretch", "-webkit-fill-available"))


def _keyword(name: str) -> Callable[[str, Origin], Any]:
    allowed = _KEYWORDS[name]

    def parse(text: str, origin: Origin) -> str | None:
        word = text.strip().lower()
        return word if word in allowed else None

    return parse


def _length(text: str, origin: Origin) -> Terms | None:  # browsers take numbers for these in style sheets too
    return parse_length(text, True)


def _positive(text: str, origin: Origin) -> Terms | None:  # a negative one is invalid
    terms = parse_length(text, True)
    return None if terms is None or (len(terms) == 1 and terms[0][0] < 0) else terms


def _radius(text: str, origin: Origin) -> Terms | str | None:
    if text.strip().lower() == "auto":
        return ((0.0, "px"),) if origin == "attribute" else "auto"  # as an attribute it is 0 in browsers
    return _positive(text, origin)


def _size(text: str, origin: Origin) -> Terms | str | None:
    """Read width, height or font-size: numbers need a unit in a style sheet, but not in a ``style`` attribute."""
    if text.strip().lower() in _AUTO:
        return "auto"
    terms = parse_length(text, origin != "sheet")
    return None if terms is None or (len(terms) == 1 and terms[0][0] < 0) else terms


def _display(text: str, origin: Origin) -> str | None:
    word = text.strip().lower()
    return word if word and word.replace("-", "").replace(" ", "").isalpha() else None


def _paint(text: str, origin: Origin) -> str | None:
    """Read fill or stroke: ``none``, a colour, ``currentcolor``, or ``url(...)`` with what stands in for it."""
    word = text.strip()
    low = word.lower()
    if low in ("none", "currentcolor", "context-fill", "context-stroke"):
        return low
    if low.startswith("url("):
        return word
    return parse_colour(word)


def _opacity(text: str, origin: Origin) -> float | None:
    """Read an opacity: a number or a percentage."""
    terms = parse_length(text, True)
    if terms is None or any(unit not in ("", "%") for unit in units_of(terms)):
        return None
    return to_px(terms, 1.0, ROOT_FONT)


def _font_size(text: str, origin: Origin) -> Any:
    word = text.strip().lower()
    if word in _FONT_SIZES:
        return ((_FONT_SIZES[word], "px"),)
    if word in ("larger", "smaller"):
        return ((1.2 if word == "larger" else 1 / 1.2, "em"),)
    value = _size(text, origin)
    return None if value == "auto" else value


def _line_height(text: str, origin: Origin) -> Any:
    word = text.strip().lower()
    if word == "normal":
        return "normal"
    terms = parse_length(word, True)
    return None if terms is None or terms[0][0] < 0 else terms


def _marks(text: str, origin: Origin) -> None:
    """Look at numbers that change no outline, as those of dashes, for one that is too large."""
    check_numbers(text)


def _words(text: str, origin: Origin) -> str | None:
    return text.strip() or None


def _transform(text: str, origin: Origin) -> Any:
    return parse_transform_attribute(text) if origin == "attribute" else parse_transform_property(text)


def _single(name: str) -> Callable[[str, Origin], Any]:
    """Make the reader of a property that is one transform function: ``rotate: 45deg`` is ``rotate(45deg)``."""

    def parse(text: str, origin: Origin) -> Any:
        if text.strip().lower() == "none":
            return ()
        tokens = tinycss2.parse_component_value_list(text.strip(), skip_comments=True)
        words = [tinycss2.serialize([token]) for token in tokens if token.type != "whitespace"]
        return parse_transform_property(f"{name}({', '.join(words)})")

    return parse


def _origin(text: str, origin: Origin) -> tuple[Terms, Terms] | None:
    """Read ``transform-origin``: one or two of a length, a percentage and a word; a third (z) is dropped."""
    words = {
        "left": ("x", 0.0),
        "right": ("x", 100.0),
        "top": ("y", 0.0),
        "bottom": ("y", 100.0),
        "center": ("", 50.0),
    }
    parts: list[tuple[str | None, Terms]] = []
    for token in tinycss2.parse_component_value_list(text.strip(), skip_comments=True):
        if token.type == "whitespace":
            continue
        if token.type == "ident" and token.lower_value in words:
            axis, percent = words[token.lower_value]
            parts.append((axis, ((percent, "%"),)))
            continue
        terms = parse_length(tinycss2.serialize([token]), origin == "attribute")
        if terms is None:
            return None
        parts.append((None, terms))
    if not 1 <= len(parts) <= 3:
        return None
    if len(parts) == 1:
        parts.append(("", ((50.0, "%"),)))  # as if it were "center"
        if parts[0][0] == "y":
            parts.reverse()
    (first_axis, first), (second_axis, second) = parts[:2]
    if first_axis == "y" or second_axis == "x":  # only two words may change places
        if first_axis in ("x", None) or second_axis in ("y", None):
            return None
        first, second = second, first
    return first, second


def _path(text: str, origin: Origin) -> str | None:
    if origin == "attribute":
        return text
    tokens = [t for t in tinycss2.parse_component_value_list(text, skip_comments=True) if t.type != "whitespace"]
    if len(tokens) == 1 and tokens[0].type == "ident" and tokens[0].lower_value == "none":
        return ""
    if len(tokens) != 1 or tokens[0].type != "function" or tokens[0].lower_name != "path":
        return None
    arguments = [t for t in tokens[0].arguments if t.type != "whitespace"]
    return str(arguments[0].value) if len(arguments) == 1 and arguments[0].type == "string" else None


_OPACITIES = ("opacity", "fill-opacity", "stroke-opacity", "stop-opacity")
_PARSERS: dict[str, Callable[[str, Origin], Any]] = {
    **{name: _keyword(name) for name in _KEYWORDS},
    **dict.fromkeys(("x", "y", "cx", "cy"), _length),
    **dict.fromkeys(("rx", "ry"), _radius),
    **dict.fromkeys(("width", "height"), _size),
    "r": _positive,
    "display": _display,
    "fill": _paint,
    "stroke": _paint,
    "color": lambda text, origin: parse_colour(text),
    **dict.fromkeys(_OPACITIES, _opacity),
    "stop-color": lambda text, origin: parse_colour(text),
    "stroke-width": _positive,
    "font-size": _font_size,
    "line-height": _line_height,
    "transform": _transform,
    "transform-origin": _origin,
    **{name: _single(name) for name in ("translate", "rotate", "scale")},
    "d": _path,
    "clip-path": _words,
    "mask": _words,
    **dict.fromkeys(("stroke-dasharray", "stroke-dashoffset", "stroke-miterlimit"), _marks),
}
PROPERTIES = frozenset(_PARSERS)
_TRANSFORMS = ("transform", "translate", "rotate", "scale", "transform-origin", "transform-box")
# Properties that are missed where they cannot be read
MISSED = {
    **dict.fromkeys(_TRANSFORMS, Fault("bad-transform", "warning", "is wrong, so none of it is used")),
    **dict.fromkeys(_OPACITIES, Fault("bad-length", "warning", "is no number and is not used")),
    **dict.fromkeys(
        ("x", "y", "cx", "cy", "r", "rx", "ry", "width", "height", "stroke-width"),
        Fault("bad-length", "warning", "is no length that it can have, and is not used"),
    ),
}
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
        value = _PARSERS[name](text, origin)
    except NumberError as error:
        return TooLarge(error.offset, _instead(name, error.value))
    missed = value is None and name in MISSED and not (origin == "attribute" and name in _LAZY)
    return Unread() if missed and text.strip() else value


def _instead(name: str, value: float) -> Any:
    """Give what browsers take for a value that is infinite, or none (which counts as 0)."""
    if name in _OPACITIES:
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
        if not colon or not (custom or name in _PARSERS):
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
    if name not in _PARSERS:
        return []
    value = parse_declaration(name, text, origin)
    return [] if value is None else [(name, value, declaration.important)]


def _font_shorthand(declaration: Any, origin: Origin) -> list[Declaration]:
    tokens = [token for token in declaration.value if token.type != "whitespace"]
    for index, token in enumerate(tokens):
        size = parse_declaration("font-size", tinycss2.serialize([token]), origin)
        if size is None or isinstance(size, Pending) or token.type == "number":
            continue
        rest = tokens[index + 1 :]
        found: list[Declaration] = [("font-size", size, declaration.important)]
        height: Any = "normal"
        if len(rest) >= 2 and rest[0].type == "literal" and rest[0].value == "/":
            height = parse_declaration("line-height", tinycss2.serialize([rest[1]]), origin)
            rest = rest[2:]
        if height is None:
            return []
        found.append(("line-height", height, declaration.important))
        return found if rest else []
    return []
