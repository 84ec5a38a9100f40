"""Values of properties: each read to what is used of it, None where browsers do not take it."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Literal, NamedTuple

import tinycss2

from importers.problems import Severity
from importers.svg.colour import parse_colour, split_url
from importers.svg.path_data import parse_path_data
from importers.svg.transforms import parse_transform_attribute, parse_transform_property
from importers.svg.units import ROOT_FONT, Terms, check_numbers, parse_length, to_px, units_of

# Where a declaration stands: browsers read an attribute, a ``style`` attribute and a style sheet each a little
# differently (numbers without units).
Origin = Literal["attribute", "inline", "sheet"]


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


_KEYWORDS = {
    "visibility": frozenset(("visible", "hidden", "collapse")),
    "fill-rule": frozenset(("nonzero", "evenodd")),
    "clip-rule": frozenset(("nonzero", "evenodd")),
    "overflow": frozenset(("visible", "hidden", "scroll", "auto", "overlay", "clip")),
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


# What a box is for the others, what it is within, and what says both in one word
_OUTSIDE = frozenset(("block", "inline"))
_INSIDE = frozenset(("flow", "flow-root", "table", "flex", "grid", "ruby", "math"))
_DISPLAYS = frozenset(
    (
        *("none", "contents", "ruby-text", "table-cell", "table-caption", "table-column", "table-column-group"),
        *("table-row", "table-row-group", "table-header-group", "table-footer-group"),
        *("inline-block", "inline-table", "inline-flex", "inline-grid"),
        *("-webkit-box", "-webkit-inline-box", "-webkit-flex", "-webkit-inline-flex"),
    )
)


def _display(text: str, origin: Origin) -> str | None:
    """Read ``display``: one word, or what a box is outside, inside, and whether a list item, in any order."""
    words = text.lower().split()
    if len(words) == 1 and words[0] in _DISPLAYS:
        return words[0]
    outside, inside, listed = (sum(word in kind for word in words) for kind in (_OUTSIDE, _INSIDE, ("list-item",)))
    if not words or max(outside, inside, listed) > 1 or outside + inside + listed < len(words):
        return None
    if listed and inside and not {"flow", "flow-root"} & set(words):
        return None
    return " ".join(words)


def _paint(text: str, origin: Origin) -> str | None:
    """Read fill or stroke: ``none``, a colour, ``currentcolor``, or ``url(...)`` with what stands in for it."""
    word = text.strip()
    low = word.lower()
    if low in ("none", "currentcolor", "context-fill", "context-stroke"):
        return low
    parts = split_url(word)
    if parts is not None:
        _, instead = parts
        right = instead.lower() in ("", "none", "currentcolor") or parse_colour(instead) is not None
        return word if right else None
    return word if low.startswith("url(") else parse_colour(word)


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
    if len(arguments) != 1 or arguments[0].type != "string":
        return None
    data = str(arguments[0].value)
    _, fault = parse_path_data(data)
    return data if fault is None else None  # unlike an attribute, which is drawn as far as it is right


OPACITIES = ("opacity", "fill-opacity", "stroke-opacity", "stop-opacity")
PARSERS: dict[str, Callable[[str, Origin], Any]] = {
    **{name: _keyword(name) for name in _KEYWORDS},
    **dict.fromkeys(("x", "y", "cx", "cy"), _length),
    **dict.fromkeys(("rx", "ry"), _radius),
    **dict.fromkeys(("width", "height"), _size),
    "r": _positive,
    "display": _display,
    "fill": _paint,
    "stroke": _paint,
    "color": lambda text, origin: parse_colour(text),
    **dict.fromkeys(OPACITIES, _opacity),
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
_TRANSFORMS = ("transform", "translate", "rotate", "scale", "transform-origin", "transform-box")
# Properties that are missed where they cannot be read
MISSED = {
    **dict.fromkeys(
        (*_KEYWORDS, "display"), Fault("bad-value", "warning", "is no word that it can have, and is not used")
    ),
    **dict.fromkeys(_TRANSFORMS, Fault("bad-transform", "warning", "is wrong, so none of it is used")),
    **dict.fromkeys(OPACITIES, Fault("bad-length", "warning", "is no number and is not used")),
    **dict.fromkeys(
        ("x", "y", "cx", "cy", "r", "rx", "ry", "width", "height", "stroke-width"),
        Fault("bad-length", "warning", "is no length that it can have, and is not used"),
    ),
    **dict.fromkeys(
        ("font-size", "line-height"),  # which change an outline only where it is measured in them
        Fault("bad-length", "info", "is no size of a font or a line that can be read, and is not used"),
    ),
    **dict.fromkeys(
        ("fill", "stroke", "color", "stop-color"),
        Fault("bad-value", "warning", "is no colour that can be read, and is not used"),
    ),
    "d": Fault("bad-value", "warning", "is neither none nor path() with right data in quotes, and is not used"),
}
# Attributes that are not declarations by themselves: geometry is looked up on the element that has it
