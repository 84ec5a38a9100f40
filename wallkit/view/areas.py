"""Areas: what polygons, discs and rings cover of each pixel."""

from __future__ import annotations

import numpy as np

from wallkit.geometry.arrays import FloatArray, IntArray
from wallkit.geometry.ragged import numbered
from wallkit.view.cover import Mask, Runs, box_at, box_of

_ROWS = 4  # rows of samples a pixel of a fill
_PARTS = 64  # of a pixel's width that a sample of a fill tells apart; a whole pixel is _ROWS * _PARTS = 256


def fill(lines: list[FloatArray], size: tuple[int, int]) -> Runs | None:
    """Fill closed polylines even-odd.

    Each pixel has four rows of samples; along each the inside begins and ends where edges cross it, to a part of a
    pixel. What begins in a pixel adds what it covers there, and the rest in the next; sums along the row do the rest.
    They change only where something begins or ends, so what lies between is one run.
    """
    if not lines:
        return None
    a = np.concatenate(lines)
    b = np.concatenate([np.roll(line, -1, axis=0) for line in lines])
    box = box_of(a, 0.0, size)
    if box is None:
        return None
    left, top, right, bottom = box
    width = right - left
    row, x = _crossings(a - (left, top), b - (left, top), (bottom - top) * _ROWS)
    # Along a row crossings are taken in order, two by two: inside lies between them.
    stride = width * _PARTS + 1
    key = np.sort(row * stride + np.clip(np.rint(x * _PARTS), 0, stride - 1).astype(np.int64))
    row, x = np.divmod(key, stride)
    cell, part = np.divmod(x, _PARTS)
    sign = np.where(np.arange(len(key)) % 2 == 0, 1, -1)
    # Rows here are a pixel longer than the box, so what reaches to its right side ends in its own row.
    begin, end, cover = _sums(row // _ROWS * (width + 1) + cell, sign * (_PARTS - part), sign * part)
    down, across = np.divmod(begin, width + 1)
    place = (down + top) * size[0] + across + left
    return Runs(place, place + (end - begin), np.minimum(cover, 255).astype(np.uint8))


def _sums(place: IntArray, here: IntArray, next_to: IntArray) -> tuple[IntArray, IntArray, IntArray]:
    """Sum up what begins at each place (n,), and what does in the place behind it: runs of the same positive sum."""
    order = np.argsort(place, kind="stable")
    place = place[order]
    first = np.flatnonzero(np.diff(place, prepend=-1))
    if not len(first):
        return place, place, here
    place, here, next_to = place[first], np.add.reduceat(here[order], first), np.add.reduceat(next_to[order], first)
    after = np.cumsum(here + next_to)
    begin, end = np.concatenate([place, place + 1]), np.concatenate([place + 1, place[1:], place[-1:] + 1])
    cover = np.concatenate([after - next_to, after])
    kept = np.flatnonzero((cover > 0) & (end > begin))
    return begin[kept], end[kept], cover[kept]


def _crossings(a: FloatArray, b: FloatArray, rows: int) -> tuple[IntArray, FloatArray]:
    """Where edges cross the middles of rows of samples: the row and x of each."""
    down = (a[:, 1] < b[:, 1])[:, None]
    low, high = np.where(down, a, b), np.where(down, b, a)
    first = np.clip(np.ceil(low[:, 1] * _ROWS - 0.5), 0, rows).astype(np.int64)
    count = np.maximum(0, np.clip(np.ceil(high[:, 1] * _ROWS - 0.5), 0, rows).astype(np.int64) - first)
    edge, rank = numbered(count)
    row = first[edge] + rank
    with np.errstate(divide="ignore", invalid="ignore"):
        lean = (high[:, 0] - low[:, 0]) / (high[:, 1] - low[:, 1])
    return row, low[edge, 0] + ((row + 0.5) / _ROWS - low[edge, 1]) * lean[edge]


def ring(x: float, y: float, outer: float, inner: float, size: tuple[int, int]) -> Mask | None:
    """A ring between two radii, or the disc where ``inner`` is 0: by the distance of each pixel's middle."""
    box = box_at(x - outer - 1, y - outer - 1, x + outer + 1, y + outer + 1, size)
    if box is None or outer <= 0.0:
        return None
    left, top, right, bottom = box
    across, down = np.arange(left, right) + (0.5 - x), np.arange(top, bottom) + (0.5 - y)
    distance = np.sqrt((across * across)[None, :] + (down * down)[:, None])
    cover = np.minimum(np.maximum(outer + 0.5 - distance, 0.0), 1.0)
    if inner > 0.0:
        cover -= np.minimum(np.maximum(inner + 0.5 - distance, 0.0), 1.0)
    return Mask((cover * 255.0 + 0.5).astype(np.uint8), left, top)
