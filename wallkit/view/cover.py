"""How much of each pixel an item of a picture covers, 0 to 255, in the form that costs least.

Coordinates are pixels; pixel (i, j) is the square from (i, j) to (i + 1, j + 1), x to the right and y down. A place is
a pixel's number, row by row: j * width + i. Nothing reaches beyond the picture. A cover that would be empty is None.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from wallkit.geometry.arrays import FloatArray, IntArray


class Mask(NamedTuple):
    """A rectangle of pixels from (left, top) on."""

    cover: NDArray[np.uint8]
    left: int
    top: int


class Spots(NamedTuple):
    """Pixels one by one (n,); one that is there several times is covered as its largest cover says."""

    place: IntArray
    cover: NDArray[np.uint8]


class Runs(NamedTuple):
    """Runs of pixels (n,), each from place ``begin`` to before ``end`` and of one cover; no two share a pixel."""

    begin: IntArray
    end: IntArray
    cover: NDArray[np.uint8]


Cover = Mask | Spots | Runs


def box_at(x0: float, y0: float, x1: float, y1: float, size: tuple[int, int]) -> tuple[int, int, int, int] | None:
    """The pixels of a picture that meet a box: left, top, right, bottom; None without any."""
    width, height = size
    if not (x0 < width and y0 < height and x1 > 0.0 and y1 > 0.0):  # nor if one is not a number
        return None
    return (
        math.floor(max(x0, 0.0)),
        math.floor(max(y0, 0.0)),
        math.ceil(min(x1, float(width))),
        math.ceil(min(y1, float(height))),
    )


def box_of(points: FloatArray, reach: float, size: tuple[int, int]) -> tuple[int, int, int, int] | None:
    """The pixels that meet the box of points (n, 2), ``reach`` wider on each side."""
    (x0, y0), (x1, y1) = points.min(axis=0).tolist(), points.max(axis=0).tolist()
    return box_at(x0 - reach, y0 - reach, x1 + reach, y1 + reach, size)
