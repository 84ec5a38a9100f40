"""Lengths: CSS text to numbers of user units (CSS px).

A length is kept as terms (factor, unit) until the element that uses it is known: ``calc(50% - 1em)`` is
``((50, "%"), (-1, "em"))``. Percentages and font units need the viewport and the font there.
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from functools import lru_cache

import tinycss2

Terms = tuple[tuple[float, str], ...]

# A file has no window, no screen and no fonts. These are those of the browser that the tests measure with:
# headless Chromium opened at 1600 by 1600 (143 of them are its own frame), a page with the default font.
WINDOW = (1600.0, 1457.0)
ROOT_FONT_SIZE = 16.0

_PX = {
    "": 1.0,
    "px": 1.0,
    "pt": 96 / 72,
    "pc": 16.0,
    "mm": 96 / 25.4,
    "cm": 96 / 2.54,
    "in": 96.0,
    "q": 96 / 101.6,
}
_WINDOW_UNITS = {
    "vw": WINDOW[0] / 100,
    "vi": WINDOW[0] / 100,
    "vmax": WINDOW[0] / 100,
    "vh": WINDOW[1] / 100,
    "vb": WINDOW[1] / 100,
    "vmin": WINDOW[1] / 100,
}
_WINDOW_UNITS |= {size + unit: px for size in "sld" for unit, px in _WINDOW_UNITS.items()}
_FONT_UNITS = {"em", "ex", "ch", "cap", "ic", "lh", "rem", "rex", "rch", "rcap", "ric", "rlh"}
UNITS = frozenset(_PX) | frozenset(_WINDOW_UNITS) | _FONT_UNITS | {"%"}

# Proportions of DejaVu Sans, the font of a browser on a bare machine, whatever a file asks for
_FONT = {"em": 1.0, "ic": 1.0, "ex": 0.547, "ch": 0.63623, "cap": 0.7322}

_SIMPLE = re.compile(r"\s*([-+]?(?:[0-9]+(?:\.[0-9]+)?|\.[0-9]+)(?:[eE][-+]?[0-9]+)?)([a-zA-Z]+|%)?\s*", re.ASCII)


@dataclass(frozen=True, slots=True)
class Font:
    """What font units need.

    Attributes:
        size: in px.
        line_height: the used height of a line in px, None for "normal".
    """

    size: float = ROOT_FONT_SIZE
    line_height: float | None = None


ROOT_FONT = Font()


@dataclass(frozen=True, slots=True)
class Viewport:
    """What percentages refer to: the size of the nearest viewport in its user units."""

    width: float
    height: float

    @property
    def diagonal(self) -> float:
        """The normalised diagonal, sqrt((width^2 + height^2) / 2), for lengths that are neither x nor y."""
        return math.hypot(self.width, self.height) / math.sqrt(2)


@lru_cache(maxsize=4096)
def parse_length(text: str, unitless: bool = True) -> Terms | None:
    """Read a length or percentage; None for what is none.

    Args:
        text: such as ``12``, ``5mm``, ``50%``, ``calc(1em + 2px)``.
        unitless: numbers without a unit are px (attributes); else only 0 is a length (style sheets).
    """
    match = _SIMPLE.fullmatch(text)
    if match is None:
        return _parse_calc(text, unitless) if "(" in text else None
    value, unit = float(match[1]), (match[2] or "").lower()
    if unit not in UNITS or not math.isfinite(value) or (not unit and not unitless and value != 0):
        return None
    return ((value, unit),)


def to_px(terms: Terms, percent_of: float, font: Font) -> float:
    """Give a length in px.

    Args:
        terms: as :func:`parse_length` gives them.
        percent_of: what 100 % is, in px.
        font: the font at the element.
    """
    total = 0.0
    for value, unit in terms:
        factor = _PX.get(unit)
        if factor is None:
            factor = percent_of / 100 if unit == "%" else _WINDOW_UNITS.get(unit)
        total += value * (factor if factor is not None else _font_unit(unit, font))
    return total


def needs_window(terms: Terms) -> bool:
    """Tell whether a length depends on the browser's window."""
    return any(unit in _WINDOW_UNITS for _, unit in terms)


def needs_metrics(terms: Terms) -> bool:
    """Tell whether a length depends on the proportions of a font that is not at hand."""
    return any(unit in _FONT_UNITS and unit not in ("em", "rem") for _, unit in terms)


def _font_unit(unit: str, font: Font) -> float:
    if unit[0] == "r" and unit != "rem":
        unit, font = unit[1:], ROOT_FONT
    size = font.size
    if unit == "lh":
        return font.line_height if font.line_height is not None else _normal_line_height(font)
    if unit == "rem":
        return ROOT_FONT_SIZE
    if unit == "ex":  # browsers take it from the hinted font, whose heights are whole px
        return float(round(_FONT["ex"] * size))
    return _FONT[unit] * size


def _normal_line_height(font: Font) -> float:  # ascent and descent are each rounded to whole px, as browsers do
    return float(round(0.928 * font.size) + round(0.236 * font.size))


def _parse_calc(text: str, unitless: bool) -> Terms | None:
    tokens = [t for t in tinycss2.parse_component_value_list(text, skip_comments=True) if t.type != "whitespace"]
    if len(tokens) != 1 or tokens[0].type != "function" or tokens[0].lower_name != "calc":
        return None
    try:
        terms = _sum([t for t in tokens[0].arguments if t.type not in ("whitespace", "comment")])
    except (ValueError, IndexError, ZeroDivisionError, RecursionError, OverflowError):
        return None
    if not all(math.isfinite(value) and unit in UNITS for unit, value in terms.items()):
        return None
    if "" in terms and not unitless:
        return None
    return tuple((value, unit) for unit, value in terms.items())


def _sum(tokens: list[tinycss2.ast.Node]) -> dict[str, float]:
    total, rest = _product(tokens)
    while rest:
        sign = {"+": 1.0, "-": -1.0}[_operator(rest[0])]
        part, rest = _product(rest[1:])
        for unit, value in part.items():
            total[unit] = total.get(unit, 0.0) + sign * value
    return total


def _product(tokens: list[tinycss2.ast.Node]) -> tuple[dict[str, float], list[tinycss2.ast.Node]]:
    left, rest = _value(tokens[0]), tokens[1:]
    while rest and _operator(rest[0]) in "*/":
        divide, right = _operator(rest[0]) == "/", _value(rest[1])
        if set(right) != {""} and not divide:
            left, right = right, left
        if set(right) != {""}:
            raise ValueError("a length times a length is no length")
        factor = 1 / right[""] if divide else right[""]
        left = {unit: value * factor for unit, value in left.items()}
        rest = rest[2:]
    return left, rest


def _value(token: tinycss2.ast.Node) -> dict[str, float]:
    if token.type == "number":
        return {"": token.value}
    if token.type == "percentage":
        return {"%": token.value}
    if token.type == "dimension":
        return {token.lower_unit: token.value}
    if token.type == "() block":
        return _sum([t for t in token.content if t.type not in ("whitespace", "comment")])
    if token.type == "function" and token.lower_name == "calc":
        return _sum([t for t in token.arguments if t.type not in ("whitespace", "comment")])
    raise ValueError(token.type)


def _operator(token: tinycss2.ast.Node) -> str:
    if token.type != "literal" or token.value not in "+-*/":
        raise ValueError(token.type)
    return str(token.value)
