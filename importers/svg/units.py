"""Lengths: CSS text to numbers of user units (CSS px).

A length is kept as terms (factor, unit) until the element that uses it is known: ``calc(50% - 1em)`` is
``((50, "%"), (-1, "em"))``. Percentages and font units need the viewport and the font there. Where a term is
``min()``, ``max()`` or ``clamp()``, its unit is that word with the terms of its arguments.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterator
from functools import lru_cache
from typing import Any, NamedTuple

import tinycss2

from importers.limits import limit_error
from importers.numbers import finite

Terms = tuple[tuple[float, Any], ...]

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
DEGREES = {"deg": 1.0, "grad": 0.9, "rad": 180 / math.pi, "turn": 360.0}
NUMBERS = {"": 1.0}
# The longest length of browsers, either way: what is longer, or infinite, is this long there
LONGEST = float(2**25)

# Proportions of DejaVu Sans, the font of a browser on a bare machine, whatever a file asks for
_FONT = {"em": 1.0, "ic": 1.0, "ex": 0.547, "ch": 0.63623, "cap": 0.7322}

_MOST_BRACKETS = 50
_BRACKET = re.compile(r"[()\[\]{}]")

_DIGITS = re.compile(r"[0-9]++")
_MOST_DIGITS = 4000  # of a number in CSS; Python turns no more than 4300 into an integer

_SIMPLE = re.compile(
    r"\s*+([-+]?+(?:[0-9]++(?:\.[0-9]++)?+|\.[0-9]++)(?:[eE][-+]?+[0-9]++)?+)([a-zA-Z]++|%)?+\s*+", re.ASCII
)
_ANY_NUMBER = re.compile(r"([-+]?+(?:[0-9]++(?:\.[0-9]*+)?+|\.[0-9]++)(?:[eE][-+]?+[0-9]++)?+)([a-zA-Z]*+)", re.ASCII)
_LONG_NUMBER = 300  # letters; the largest double has 309 digits
# A length is worked out again on every element that has it or inherits it.
MAX_LENGTH_LETTERS = 256


class Font(NamedTuple):
    """What font units need.

    Attributes:
        size: in px.
        line_height: the used height of a line in px, None for "normal".
    """

    size: float = ROOT_FONT_SIZE
    line_height: float | None = None


ROOT_FONT = Font()


class Viewport(NamedTuple):
    """What percentages refer to: the size of the nearest viewport in its user units."""

    width: float
    height: float

    @property
    def diagonal(self) -> float:
        """The normalised diagonal, sqrt((width^2 + height^2) / 2), for lengths that are neither x nor y."""
        return math.hypot(self.width, self.height) / math.sqrt(2)


def parse_length(text: str, unitless: bool = True) -> Terms | None:
    """Read a length or percentage; None for what is none.

    Args:
        text: such as ``12``, ``5mm``, ``50%``, ``calc(1em + 2px)``.
        unitless: numbers without a unit are px (attributes); else only 0 is a length (style sheets).

    Raises:
        LimitError: more than MAX_LENGTH_LETTERS of ``calc()`` or the like.
        NumberError: a number in it is too large.
    """
    return _parse_short(text, unitless) if len(text) <= MAX_LENGTH_LETTERS else _parse_length(text, unitless)


@lru_cache(maxsize=4096)
def _parse_short(text: str, unitless: bool) -> Terms | None:
    return _parse_length(text, unitless)


def _parse_length(text: str, unitless: bool) -> Terms | None:
    match = _SIMPLE.fullmatch(text)
    if match is None:
        if text.partition("(")[0].strip().lower() not in _FUNCTIONS or unreadable(text):
            return None
        if len(text) > MAX_LENGTH_LETTERS:
            raise limit_error("letters of a length", f"{MAX_LENGTH_LETTERS:,}")
        return _parse_calc(text, unitless)
    value, unit = float(match[1]), (match[2] or "").lower()
    if unit not in UNITS or (not unit and not unitless and value != 0):
        return None
    return ((finite(value), unit),)


def unreadable(text: str) -> bool:
    """Tell whether CSS has more brackets in brackets, or digits in a number, than its parser can take."""
    if len(text) > _MOST_DIGITS and any(len(digits[0]) > _MOST_DIGITS for digits in _DIGITS.finditer(text)):
        return True
    if text.count("(") + text.count("[") + text.count("{") <= _MOST_BRACKETS:
        return False
    depth = 0
    for bracket in _BRACKET.finditer(text):
        depth += 1 if bracket[0] in "([{" else -1
        if depth > _MOST_BRACKETS:
            return True
        depth = max(depth, 0)
    return False


def check_numbers(text: str) -> None:
    """Look at the numbers of a text that is not read further.

    Raises:
        NumberError: one of them is too large, by itself or with its unit.
    """
    if "e" not in text and "E" not in text and len(text) < _LONG_NUMBER:
        return  # no number of so few digits overflows
    for match in _ANY_NUMBER.finditer(text):
        unit = (match[2] or "").lower()
        value = float(match[1]) * (_PX.get(unit) or DEGREES.get(unit, 1.0))
        finite(value, "", match.start())
    if "(" in text and len(text) <= MAX_LENGTH_LETTERS and not unreadable(text):
        for token in tinycss2.parse_component_value_list(text, skip_comments=True):
            if token.type == "function":
                to_px(parse_length(tinycss2.serialize([token])) or (), 0.0, ROOT_FONT)


def to_px(terms: Terms, percent_of: float, font: Font) -> float:
    """Give a length in px.

    Args:
        terms: as :func:`parse_length` gives them.
        percent_of: what 100 % is, in px.
        font: the font at the element.

    Raises:
        NumberError: it is infinite.
    """

    def px(unit: str) -> float:
        factor = _PX.get(unit)
        if factor is None:
            factor = percent_of / 100 if unit == "%" else _WINDOW_UNITS.get(unit)
        return factor if factor is not None else _font_unit(unit, font)

    return _total(terms, px)


def _total(terms: Terms, factor: Callable[[str], float]) -> float:
    """Add up terms, each unit being worth a factor; NumberError where that, or an argument, is infinite."""
    total = 0.0
    for value, unit in terms:
        if isinstance(unit, tuple):
            total += value * _PICKS[unit[0]]([_total(argument, factor) for argument in unit[1]])
        else:
            total += value * factor(unit)
    return finite(total)


_FUNCTIONS = frozenset(("calc", "min", "max", "clamp"))
_PICKS: dict[str, Callable[[list[float]], float]] = {
    "min": min,
    "max": max,
    "clamp": lambda values: max(values[0], min(values[1], values[2])),
}


def needs_window(terms: Terms) -> bool:
    """Tell whether a length depends on the browser's window."""
    return any(unit in _WINDOW_UNITS for unit in units_of(terms))


def needs_metrics(terms: Terms) -> bool:
    """Tell whether a length depends on the proportions of a font that is not at hand."""
    return any(unit in _FONT_UNITS and unit not in ("em", "rem") for unit in units_of(terms))


def units_of(terms: Terms) -> Iterator[str]:
    """Give the units of a length, those within ``min()`` and the like too."""
    for _, unit in terms:
        if isinstance(unit, tuple):
            for argument in unit[1]:
                yield from units_of(argument)
        else:
            yield unit


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


_Sum = dict[Any, float]  # unit to factor
_CONSTANTS = {"pi": math.pi, "e": math.e, "infinity": math.inf, "-infinity": -math.inf, "nan": math.nan}


def _parse_calc(text: str, unitless: bool) -> Terms | None:
    tokens = [t for t in tinycss2.parse_component_value_list(text, skip_comments=True) if t.type != "whitespace"]
    terms = _terms(tokens[0]) if len(tokens) == 1 and tokens[0].type == "function" else None
    if terms is None or not all(unit in UNITS for unit in units_of(terms)):
        return None
    if not unitless and any(unit == "" for _, unit in terms):
        return None
    return tuple((finite(value), unit) for value, unit in terms)


def parse_calc(token: Any, factors: dict[str, float]) -> float | None:
    """Give the value of ``calc()`` and the like where it is no length; None for what is none.

    Args:
        token: of tinycss2.
        factors: what one of each unit is (DEGREES, NUMBERS); no other unit may occur.

    Raises:
        LimitError: more than MAX_LENGTH_LETTERS.
        NumberError: it is too large.
    """
    if token.type != "function" or token.lower_name not in _FUNCTIONS:
        return None
    if len(tinycss2.serialize([token])) > MAX_LENGTH_LETTERS:
        raise limit_error("letters of a length", f"{MAX_LENGTH_LETTERS:,}")
    terms = _terms(token)
    if terms is None or not all(unit in factors for unit in units_of(terms)):
        return None
    return _total(terms, factors.__getitem__)


def _terms(token: Any) -> Terms | None:
    """Add up what a function says, unit by unit; None where it makes no sense."""
    try:
        return tuple((value, unit) for unit, value in _value(token).items())
    except (ValueError, LookupError, ZeroDivisionError, RecursionError, OverflowError):
        return None


def _solid(tokens: list[Any]) -> list[Any]:
    return [token for token in tokens if token.type not in ("whitespace", "comment")]


def _sum(tokens: list[Any]) -> _Sum:
    total, place = _product(tokens, 0)
    while place < len(tokens):
        sign = {"+": 1.0, "-": -1.0}[_operator(tokens[place])]
        part, place = _product(tokens, place + 1)
        for unit, value in part.items():
            total[unit] = total.get(unit, 0.0) + sign * value
    return total


def _product(tokens: list[Any], place: int) -> tuple[_Sum, int]:
    """Read a product that begins at a place; give it and the place behind it."""
    left, place = _value(tokens[place]), place + 1
    while place < len(tokens) and _operator(tokens[place]) in "*/":
        divide, right = _operator(tokens[place]) == "/", _value(tokens[place + 1])
        if set(right) != {""} and not divide:
            left, right = right, left
        if set(right) != {""}:
            raise ValueError("a length times a length is no length")
        factor = 1 / right[""] if divide else right[""]
        left = {unit: value * factor for unit, value in left.items()}
        place += 2
    return left, place


def _value(token: Any) -> _Sum:
    if token.type == "number":
        return {"": token.value}
    if token.type == "percentage":
        return {"%": token.value}
    if token.type == "dimension":
        return {token.lower_unit: token.value}
    if token.type == "ident":
        return {"": _CONSTANTS[token.lower_value]}
    if token.type == "() block":
        return _sum(_solid(token.content))
    if token.type != "function":
        raise ValueError(token.type)
    if token.lower_name == "calc":
        return _sum(_solid(token.arguments))
    if token.lower_name not in _PICKS:
        raise ValueError(token.lower_name)
    arguments: list[list[Any]] = [[]]
    for argument in _solid(token.arguments):
        if argument.type == "literal" and argument.value == ",":
            arguments.append([])
        else:
            arguments[-1].append(argument)
    if token.lower_name == "clamp" and len(arguments) != 3:
        raise ValueError("clamp takes three")
    sums = tuple(tuple((value, unit) for unit, value in _sum(one).items()) for one in arguments)
    return {(token.lower_name, sums): 1.0}


def _operator(token: Any) -> str:
    if token.type != "literal" or token.value not in "+-*/":
        raise ValueError(token.type)
    return str(token.value)
