"""Viewports: from a viewBox and preserveAspectRatio to a matrix."""

from __future__ import annotations

import re
from typing import NamedTuple

from importers.numbers import NumberError
from importers.svg.matrix import IDENTITY, Matrix
from importers.svg.transforms import parse_numbers

Box = tuple[float, float, float, float]  # x, y, width, height

_ALIGN = re.compile(r"none|x(Min|Mid|Max)Y(Min|Mid|Max)")
_PART = {"Min": 0.0, "Mid": 0.5, "Max": 1.0}


def parse_view_box(text: str | None) -> Box | None:
    """Read a viewBox; None when it is missing or wrong (a negative size is wrong, 0 is not).

    Raises:
        NumberError: a number in it is too large.
    """
    if text is None:
        return None
    try:
        numbers = parse_numbers(text)
    except NumberError as error:
        raise NumberError("viewBox", error.offset) from None
    if numbers is None or len(numbers) != 4:
        return None
    x, y, width, height = numbers
    if width < 0 or height < 0:
        return None
    return x, y, width, height


class Aspect(NamedTuple):
    """How a viewBox goes into a viewport.

    Attributes:
        along: where it is put along x and y, 0 to 1; None where it is stretched to the whole viewport.
        slice: it covers the viewport, and does not just fit into it.
    """

    along: tuple[float, float] | None
    slice: bool


def parse_aspect(text: str) -> Aspect | None:
    """Read a preserveAspectRatio, which is ``xMidYMid meet`` where it is empty; None when it is wrong."""
    words = (text.strip() or "xMidYMid").split(maxsplit=2)
    good = len(words) == 1 or (len(words) == 2 and words[1] in ("meet", "slice"))
    match = _ALIGN.fullmatch(words[0]) if good else None
    if match is None:
        return None
    along = None if match[0] == "none" else (_PART[match[1]], _PART[match[2]])
    return Aspect(along, words[-1] == "slice")


def fit(box: Box | None, aspect: str | None, width: float, height: float) -> Matrix:
    """Give the matrix that puts a viewBox into a viewport of width and height at (0, 0).

    Args:
        box: the viewBox, width and height above 0; None for no change.
        aspect: preserveAspectRatio; what is wrong counts as ``xMidYMid meet``.
        width: of the viewport.
        height: of the viewport.
    """
    if box is None:
        return IDENTITY
    x, y, box_width, box_height = box
    sx, sy = width / box_width, height / box_height
    along, covers = parse_aspect(aspect or "") or Aspect((0.5, 0.5), False)
    if along is None:
        return (sx, 0.0, 0.0, sy, -x * sx, -y * sy)
    scale = max(sx, sy) if covers else min(sx, sy)
    left = along[0] * (width - box_width * scale) - x * scale
    top = along[1] * (height - box_height * scale) - y * scale
    return (scale, 0.0, 0.0, scale, left, top)
