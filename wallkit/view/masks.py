"""Coverage masks: how much of each pixel a stroke, a fill or a disc covers, 0 to 255, with the place of the mask.

Coordinates are pixels; pixel (i, j) is the square from (i, j) to (i + 1, j + 1), x to the right and y down. No mask is
larger than the picture. A mask that would be empty is None.
"""

from __future__ import annotations

import functools
import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageDraw

from wallkit.geometry.arrays import FloatArray, IntArray

_FINE = 2  # strokes are drawn at twice the size and averaged
_ROWS = 4  # rows of samples a pixel of a fill
_PARTS = 64  # of a pixel's width that a sample of a fill tells apart; a whole pixel is _ROWS * _PARTS = 256
_THIN = 10  # fine pixels: strokes up to that are hatched
_MANY = 12  # points of a faint line, a film's trail: of fewer it costs more to hatch them than to draw areas
_STEP = 5.0  # fine pixels between points of a curve, at least


class Mask(NamedTuple):
    """How much of each pixel is covered, from the pixel (left, top) on."""

    cover: NDArray[np.uint8]
    left: int
    top: int


def _box(x0: float, y0: float, x1: float, y1: float, size: tuple[int, int]) -> tuple[int, int, int, int] | None:
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


def _box_of(points: FloatArray, reach: float, size: tuple[int, int]) -> tuple[int, int, int, int] | None:
    (x0, y0), (x1, y1) = points.min(axis=0).tolist(), points.max(axis=0).tolist()
    return _box(x0 - reach, y0 - reach, x1 + reach, y1 + reach, size)


def stroke(lines: list[FloatArray], width: float, size: tuple[int, int], *, round_ends: bool = True) -> Mask | None:
    """Draw polylines (n, 2) with round joints, all together as one area.

    Args:
        lines: at least one; one that ends where it began has a joint there.
        width: of the pen.
        size: width and height of the picture.
        round_ends: put half a disc behind ends, which shows twice where faint lines follow each other.
    """
    every = lines[0] if len(lines) == 1 else np.concatenate(lines)
    box = _box_of(every, width, size)
    if box is None:
        return None
    left, top, right, bottom = box
    if 2 * (right - left) > size[0]:  # rows as a whole are found again without division
        left, right = 0, size[0]
    fine = Image.new("L", ((right - left) * _FINE, (bottom - top) * _FINE), 0)
    pen, thick = ImageDraw.Draw(fine), max(1, round(width * _FINE))
    near = np.array(size) * 4  # lines that go on far beyond the picture are clipped as areas
    for line in lines:
        rounded = round_ends or bool((line[0] == line[-1]).all())
        many = round_ends or len(line) >= _MANY
        if many and thick <= _THIN and (np.abs(line) < near).all():
            path: Any = _hatched((line - (left, top)) * _FINE, thick, rounded)  # Pillow takes float32 as it lies there
            pen.line(path, 255, 1)
        else:
            _as_areas(pen, (line - (left, top)) * _FINE, thick, rounded)
    return Mask(np.asarray(fine.reduce(_FINE)), left, top)


def _as_areas(pen: ImageDraw.ImageDraw, line: FloatArray, width: int, rounded: bool) -> None:
    """Draw a polygon a segment, its corners rounded to whole pixels by Pillow, and a disc a joint."""
    half, places = (width - 1) / 2, line - 0.5  # Pillow counts from the middles of pixels
    pen.line(places.ravel().tolist(), 255, width)
    for x, y in (places if rounded else places[1:-1]).tolist():
        pen.ellipse((x - half, y - half, x + half, y + half), 255)


def _hatched(line: FloatArray, width: int, rounded: bool) -> NDArray[np.float32]:
    """Give a polyline, one pixel wide, that goes to and fro until it has filled the stroke of a pen.

    Wide lines are polygons to Pillow, of which each row is found anew; thin ones cost a step a pixel. A line that goes
    along x more than along y is drawn width / cos(angle) times, each a row below the other, so no pixel is left out;
    one along y likewise. Before each line, and at the end, the disc of the pen is hatched row by row.
    """
    line = _thinned(line)
    first, second, aside, copies = _first_rows(line, width)
    disc, counts = _hatched_disc(width), 2 * copies + 2 * width
    ends = np.cumsum(counts)
    path = np.empty((int(counts.sum()) + len(disc), 2), dtype=np.float32)
    at = np.append(ends - counts, len(path) - len(disc))
    # A pen of 5 pixels is about the middle of one, of 6 about a corner.
    discs = np.floor(line + (0.5 if width % 2 == 0 else 0.0))[:, None] + disc
    if not rounded:
        discs[[0, -1]] = np.floor(line[[0, -1]])[:, None]
    path[at[:, None] + np.arange(len(disc))] = discs
    segment = np.repeat(np.arange(len(copies)), copies)
    rank = np.arange(len(segment)) - np.repeat(np.cumsum(copies) - copies, copies)
    shift = rank[:, None] * aside[segment]
    begin, end, back = first[segment] + shift, second[segment] + shift, (rank % 2 == 1)[:, None]
    place = (ends - 2 * copies)[segment] + 2 * rank
    path[place], path[place + 1] = np.where(back, end, begin), np.where(back, begin, end)
    return path


def _first_rows(line: FloatArray, width: int) -> tuple[FloatArray, FloatArray, FloatArray, IntArray]:
    """Of each segment the first of its copies: begin and end (n, 2), whole numbers; the step to the next; how many.

    There and back must take the same pixels, or holes are left. They differ where a line passes exactly between two
    pixels: 2 i dy = (2 j + 1) dx for whole numbers i and j, which no odd dx allows. So an even one, dx being larger
    than dy, is made shorter by 1.
    """
    way = np.diff(line, axis=0)
    ahead = np.abs(way)
    cosine = ahead.max(axis=1) / np.maximum(np.hypot(way[:, 0], way[:, 1]), 1e-9)  # of the angle to the nearer axis
    copies = np.rint(width / np.maximum(cosine, 0.7)).astype(np.int64)
    aside = np.where((ahead[:, 0] >= ahead[:, 1])[:, None], (0.0, 1.0), (1.0, 0.0))
    before = (0.5 - copies / 2)[:, None] * aside
    first, second = np.floor(line[:-1] + before), np.floor(line[1:] + before)
    steps = np.abs(second - first)
    for axis, other in ((0, 1), (1, 0)):
        even = (steps[:, axis] > steps[:, other]) & (steps[:, axis] % 2 == 0)
        second[even, axis] += np.sign(first - second)[even, axis]
    return first, second, aside, copies


def _thinned(line: FloatArray) -> FloatArray:
    """Leave out points of curves that lie within some pixels of each other; corners stay.

    Steps of a pixel or two have one of few directions. One of _STEP pixels that turns by less than 25 degrees is off by
    half a pixel.
    """
    if len(line) < 3:
        return line
    way = np.diff(line, axis=0)
    length = np.hypot(way[:, 0], way[:, 1])
    dot = (way[1:] * way[:-1]).sum(axis=1)
    corner = dot < 0.9 * length[1:] * length[:-1]
    place = np.floor(np.cumsum(length) / _STEP)
    keep = np.ones(len(line), dtype=np.bool_)
    keep[1:-1] = corner | (place[1:] != place[:-1])
    return line[keep]


@functools.lru_cache(maxsize=32)
def _hatched_disc(width: int) -> FloatArray:
    """Rows of a disc about a pixel, or about its corner where the width is even, to and fro."""
    middle = (width - 1) / 2
    row = np.arange(width) - middle
    half = np.maximum(np.floor(np.sqrt(np.maximum(width * width / 4 - row * row, 0.0)) - middle % 1) + middle % 1, 0.0)
    side = np.where(np.arange(width) % 2 == 0, -half, half)
    ends = np.stack([np.stack([side, row], axis=1), np.stack([-side, row], axis=1)], axis=1)
    return ends.reshape(-1, 2) - middle % 1


def fill(lines: list[FloatArray], size: tuple[int, int]) -> Mask | None:
    """Fill closed polylines even-odd.

    Each pixel has four rows of samples; along each the inside begins and ends where edges cross it, to a part of a
    pixel. What begins in a pixel adds what it covers there, and the rest in the next; sums along the row do the rest.
    """
    if not lines:
        return None
    a = np.concatenate(lines)
    b = np.concatenate([np.roll(line, -1, axis=0) for line in lines])
    box = _box_of(a, 0.0, size)
    if box is None:
        return None
    left, top, right, bottom = box
    width, height = right - left, bottom - top
    row, x = _crossings(a - (left, top), b - (left, top), height * _ROWS)
    # Along a row crossings are taken in order, two by two: inside lies between them.
    stride = width * _PARTS + 1
    key = np.sort(row * stride + np.clip(np.rint(x * _PARTS), 0, stride - 1).astype(np.int64))
    row, x = np.divmod(key, stride)
    cell, part = np.divmod(x, _PARTS)
    sign = np.where(np.arange(len(key)) % 2 == 0, 1, -1)
    change = np.zeros((height, width + 2), dtype=np.int16)
    place = row // _ROWS * (width + 2) + cell
    np.add.at(change.reshape(-1), place, (sign * (_PARTS - part)).astype(np.int16))
    np.add.at(change.reshape(-1), place + 1, (sign * part).astype(np.int16))
    flat = change.reshape(-1)
    np.cumsum(flat, out=flat)  # each row ends at 0
    return Mask(np.minimum(change[:, :width], 255).astype(np.uint8), left, top)


def _crossings(a: FloatArray, b: FloatArray, rows: int) -> tuple[IntArray, FloatArray]:
    """Where edges cross the middles of rows of samples: the row and x of each."""
    down = (a[:, 1] < b[:, 1])[:, None]
    low, high = np.where(down, a, b), np.where(down, b, a)
    first = np.clip(np.ceil(low[:, 1] * _ROWS - 0.5), 0, rows).astype(np.int64)
    count = np.maximum(0, np.clip(np.ceil(high[:, 1] * _ROWS - 0.5), 0, rows).astype(np.int64) - first)
    edge = np.repeat(np.arange(len(a)), count)
    row = first[edge] + np.arange(len(edge)) - np.repeat(np.cumsum(count) - count, count)
    with np.errstate(divide="ignore", invalid="ignore"):
        lean = (high[:, 0] - low[:, 0]) / (high[:, 1] - low[:, 1])
    return row, low[edge, 0] + ((row + 0.5) / _ROWS - low[edge, 1]) * lean[edge]


def ring(x: float, y: float, outer: float, inner: float, size: tuple[int, int]) -> Mask | None:
    """A ring between two radii, or the disc where ``inner`` is 0: by the distance of each pixel's middle."""
    box = _box(x - outer - 1, y - outer - 1, x + outer + 1, y + outer + 1, size)
    if box is None or outer <= 0.0:
        return None
    left, top, right, bottom = box
    across, down = np.arange(left, right) + (0.5 - x), np.arange(top, bottom) + (0.5 - y)
    distance = np.sqrt((across * across)[None, :] + (down * down)[:, None])
    cover = np.minimum(np.maximum(outer + 0.5 - distance, 0.0), 1.0)
    if inner > 0.0:
        cover -= np.minimum(np.maximum(inner + 0.5 - distance, 0.0), 1.0)
    return Mask((cover * 255.0 + 0.5).astype(np.uint8), left, top)
