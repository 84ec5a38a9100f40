"""The ``transform`` attribute and the CSS ``transform`` property, to a matrix."""

from __future__ import annotations

import math
import re
from typing import Any

import tinycss2

from importers.limits import limit_error
from importers.numbers import finite
from importers.svg.matrix import IDENTITY, Matrix, multiply, rotation, translation
from importers.svg.path_data import COMMA, NUMBER
from importers.svg.units import DEGREES, NUMBERS, Font, Terms, parse_calc, parse_length, to_px

MAX_FUNCTIONS = 10_000
_WS = r"[ \t\r\n\f]*+"
_FUNCTION = re.compile(rf"{_WS}(matrix|translate|scale|rotate|skewX|skewY){_WS}\(([^()]*+)\){_WS}")
_COUNTS = {"matrix": (6,), "translate": (1, 2), "scale": (1, 2), "rotate": (1, 3), "skewX": (1,), "skewY": (1,)}

# A transform of a style sheet: functions with their arguments, lengths unresolved (percentages need a box)
Functions = tuple[tuple[str, tuple[Any, ...]], ...]


def parse_transform_attribute(text: str) -> Matrix | None:
    """Read a ``transform`` attribute; None when any of it is wrong (browsers then use none of it).

    Raises:
        LimitError: it has more than MAX_FUNCTIONS.
        NumberError: a number in it, or in the matrix, is too large.
    """
    if text.count("(") > MAX_FUNCTIONS:
        raise limit_error("functions of a transform", f"{MAX_FUNCTIONS:,}")
    matrix, position = IDENTITY, 0
    if text.strip() in ("", "none"):
        return IDENTITY
    while position < len(text):
        match = _FUNCTION.match(text, position)
        numbers = parse_numbers(match[2], match.start(2)) if match else None
        if match is None or numbers is None or len(numbers) not in _COUNTS[match[1]]:
            return None
        matrix = multiply(matrix, _matrix(match[1], numbers))
        for number in matrix:
            finite(number, "transform", position)
        position = match.end()
        if position < len(text) and text[position] == ",":
            position += 1
            if not text[position:].strip():
                return None
    return matrix


def parse_numbers(text: str, offset: int = 0) -> list[float] | None:
    """Read numbers separated by white space, one comma, or nothing where none is needed; None when not.

    Args:
        text: of the numbers.
        offset: where it begins in the value of an attribute.

    Raises:
        NumberError: one of them is too large.
    """
    numbers = []
    position = len(text) - len(text.lstrip(" \t\r\n\f"))
    text = text.rstrip(" \t\r\n\f")
    while position < len(text):
        match = NUMBER.match(text, position)
        if match is None:
            return None
        numbers.append(finite(float(match[0]), "transform", offset + position))
        gap = COMMA.match(text, match.end())
        position = gap.end() if gap else match.end()
        if position == len(text) and gap and "," in gap[0]:
            return None
    return numbers


def _matrix(name: str, v: list[float]) -> Matrix:
    if name == "matrix":
        return (v[0], v[1], v[2], v[3], v[4], v[5])
    if name == "translate":
        return translation(v[0], v[1] if len(v) > 1 else 0.0)
    if name == "scale":
        return (v[0], 0.0, 0.0, v[1] if len(v) > 1 else v[0], 0.0, 0.0)
    if name == "rotate":
        if len(v) == 1:
            return rotation(v[0])
        return multiply(multiply(translation(v[1], v[2]), rotation(v[0])), translation(-v[1], -v[2]))
    slope = math.tan(math.radians(v[0]))
    return (1.0, 0.0, slope, 1.0, 0.0, 0.0) if name == "skewX" else (1.0, slope, 0.0, 1.0, 0.0, 0.0)


def parse_transform_property(text: str) -> Functions | None:
    """Read a ``transform`` of a style sheet; None when it is not valid CSS for the plane.

    Raises:
        LimitError: it has more than MAX_FUNCTIONS, or a length in it has too many letters.
        NumberError: a number in it is too large.
    """
    if text.count("(") > MAX_FUNCTIONS:
        raise limit_error("functions of a transform", f"{MAX_FUNCTIONS:,}")
    functions = []
    for token in tinycss2.parse_component_value_list(text, skip_comments=True):
        if token.type == "whitespace":
            continue
        if token.type == "ident" and token.lower_value == "none":
            return ()
        parsed = _css_function(token) if token.type == "function" else None
        if parsed is None:
            return None
        functions.append(parsed)
    return tuple(functions) or None


def _css_function(token: Any) -> tuple[str, tuple[Any, ...]] | None:
    name = token.lower_name
    groups: list[list[Any]] = [[]]
    for argument in token.arguments:
        if argument.type == "literal" and argument.value == ",":
            groups.append([])
        elif argument.type not in ("whitespace", "comment"):
            groups[-1].append(argument)
    if any(len(group) != 1 for group in groups):
        return None
    arguments = [group[0] for group in groups]
    kinds = {
        "matrix": "n" * 6,
        "translate": "ll",
        "translatex": "l",
        "translatey": "l",
        "scale": "nn",
        "scalex": "n",
        "scaley": "n",
        "rotate": "a",
        "rotatez": "a",
        "skew": "aa",
        "skewx": "a",
        "skewy": "a",
        "translate3d": "lll",
        "translatez": "l",
        "scale3d": "nnn",
        "scalez": "n",
        "rotatex": "a",
        "rotatey": "a",
        "matrix3d": "n" * 16,
    }.get(name)
    optional = name in ("translate", "scale", "skew")
    if kinds is None or not (len(arguments) == len(kinds) or (optional and len(arguments) == 1)):
        return None
    values = tuple(_css_argument(kind, token) for kind, token in zip(kinds, arguments, strict=False))
    return None if any(value is None for value in values) else _flat(name, values)


def _flat(name: str, v: tuple[Any, ...]) -> tuple[str, tuple[Any, ...]]:
    """Give what a function does within the plane; depth does not show without perspective."""
    if name in ("translate3d", "scale3d"):
        return name[:-2], v[:2]
    if name in ("translatez", "scalez"):
        return "scale", (1.0,)
    if name in ("rotatex", "rotatey"):
        cosine = math.cos(math.radians(v[0]))
        return "scale", (1.0, cosine) if name == "rotatex" else (cosine, 1.0)
    if name == "matrix3d":
        return "matrix", (v[0], v[1], v[4], v[5], v[12], v[13])
    return name, v


def _css_argument(kind: str, token: Any) -> float | Terms | None:
    if kind == "l":
        return parse_length(tinycss2.serialize([token]), False)
    if kind == "n":
        if token.type == "percentage":
            return finite(float(token.value)) / 100
        return finite(float(token.value)) if token.type == "number" else parse_calc(token, NUMBERS)
    if token.type == "number" and token.value == 0:
        return 0.0
    if token.type == "dimension" and token.lower_unit in DEGREES:
        return finite(float(token.value) * DEGREES[token.lower_unit])
    return parse_calc(token, DEGREES)


def resolve(functions: Functions, width: float, height: float, font: Font) -> Matrix:
    """Give the matrix of CSS transform functions.

    Args:
        functions: as :func:`parse_transform_property` gives them.
        width: of the reference box, for percentages.
        height: of the reference box.
        font: at the element.

    Raises:
        NumberError: a length in them is too large.
    """
    matrix = IDENTITY
    for name, v in functions:
        if name.startswith("translate"):
            zero: Terms = ((0.0, "px"),)
            along_x = v[0] if name != "translatey" else zero
            along_y = v[0] if name == "translatey" else (v[1] if len(v) > 1 else zero)
            step = translation(to_px(along_x, width, font), to_px(along_y, height, font))
        elif name in ("scale", "scalex", "scaley"):
            sx = v[0] if name != "scaley" else 1.0
            sy = v[0] if name == "scaley" else (v[1] if len(v) > 1 else (v[0] if name == "scale" else 1.0))
            step = (sx, 0.0, 0.0, sy, 0.0, 0.0)
        elif name in ("rotate", "rotatez"):
            step = rotation(v[0])
        elif name.startswith("skew"):
            ax = v[0] if name != "skewy" else 0.0
            ay = v[0] if name == "skewy" else (v[1] if len(v) > 1 else 0.0)
            step = (1.0, math.tan(math.radians(ay)), math.tan(math.radians(ax)), 1.0, 0.0, 0.0)
        else:
            step = (v[0], v[1], v[2], v[3], v[4], v[5])
        matrix = multiply(matrix, step)
    for number in matrix:
        finite(number)
    return matrix
