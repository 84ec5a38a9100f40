"""Strokes: what a pen covers along polylines, by the distance of each pixel near them.

That costs as much as the lines are long, however large the picture is.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from wallkit.geometry.arrays import FloatArray, IntArray
from wallkit.geometry.ragged import numbered, slices
from wallkit.view.cover import Spots

_OFF = 0.1
"""Pixels that a corner may be off the line beside it and be left out."""
_AT_ONCE = 14_000
"""Pixels that are looked at together: numbers of 8 bytes for them are less than a C library takes fresh memory for."""
_SHADES = 16
"""Covers that are told apart, which eyes cannot; with all 255 the picture of a small run is a quarter larger."""
_COVERS = np.rint(np.arange(_SHADES + 1) * (255 / _SHADES)).astype(np.uint8)
Narrow = NDArray[np.float32]


def strokes(
    groups: list[list[FloatArray]], width: float, size: tuple[int, int], *, round_ends: bool = True
) -> list[Spots]:
    """Draw groups of polylines (n, 2) with round joints, each group as one area.

    A pixel whose middle is d away from the nearest line is covered by 1/2 + (width / 2 - d) / s, between 0 and 1, where
    s is the length of a pixel's shadow across the line, 1 along an axis and sqrt(2) along a diagonal: what a half plane
    covers of pixels adds up to its area for each direction. It is not more than width / s, and beyond an end that is
    not round, by e, than 1/2 - e.

    Args:
        groups: each with one line at least; one that ends where it began has a joint there.
        width: of the pen.
        size: width and height of the picture.
        round_ends: put half a disc behind ends, which shows twice where faint lines follow each other.
    """
    segments = _segments(groups, round_ends)
    lines, of, rank = _lines(segments, width, size)
    step = np.arange(math.floor(2.0 * lines.reach.max(initial=0.0)) + 1.0)
    near, groups_of = list[Spots](), list[NDArray[np.uint16]]()
    for some in slices(len(of), _AT_ONCE // len(step)):
        columns = _columns(lines, segments.cut, of[some], rank[some])
        found, spots = _near(columns, step, width)
        near.append(spots)
        if len(groups) > 1:
            groups_of.append(segments.group[of[some]][found % len(columns.top)])
    place, cover = map(np.concatenate, zip(*near, strict=True))
    if len(groups) == 1:
        return [Spots(place, cover)]
    group = np.concatenate(groups_of)
    order = np.argsort(group, kind="stable")
    stops = np.cumsum(np.bincount(group, minlength=len(groups)))
    return [Spots(place[some], cover[some]) for some in np.split(order, stops[:-1])]


class _Segments(NamedTuple):
    """Segments (n,): begin (2, n), way to the end (2, n), the group of each, and which begins and ends are cut off.

    The last is (2, n), or None where none is.
    """

    begin: FloatArray
    way: FloatArray
    group: NDArray[np.uint16]
    cut: NDArray[np.bool_] | None


def _segments(groups: list[list[FloatArray]], round_ends: bool) -> _Segments:
    """Cut polylines into segments, without the corners that nobody sees and what has no place."""
    lines = [line for group in groups for line in group]
    points, lengths = np.concatenate(lines), [len(line) for line in lines]
    stop = np.cumsum(lengths)
    first, last = np.zeros((2, len(points)), dtype=np.bool_)
    first[stop - lengths], last[stop - 1] = True, True
    kept = np.flatnonzero(first | last | _telling(points))
    begin = np.flatnonzero(first[kept] | ~last[kept])  # a point alone is a segment of no length
    end = kept[begin + ~last[kept][begin]]
    begin = kept[begin]
    with np.errstate(invalid="ignore", over="ignore"):
        placed = np.isfinite(np.hypot(*(points[end] - points[begin]).T))
    begin, end = begin[placed], end[placed]
    group = np.repeat(np.arange(len(groups), dtype=np.uint16), [sum(map(len, group)) for group in groups])[begin]
    cut = None
    if not round_ends:
        opened = (points[stop - lengths] != points[stop - 1]).any(axis=1)
        first[first], last[last] = opened, opened
        cut = np.stack([first[begin], last[end]])
    return _Segments(points[begin].T, points[end].T - points[begin].T, group, cut)


def _telling(points: FloatArray) -> NDArray[np.bool_]:
    """Which points of a curve to keep.

    A corner that turns by a, with sides of length s, is s a / 2 from the line beside it; of a curve of such corners one
    in n is n^2 s a / 8 from its chord. So sqrt(s a / (2 OFF)) is added up, and points are kept where that passes a
    whole number: what is left is nowhere more than OFF away. From a point to the same one there is no direction, and
    so no turn: of such a corner the first alone is asked.
    """
    kept = np.ones(len(points), dtype=np.bool_)
    if len(points) < 3:
        return kept
    with np.errstate(invalid="ignore", over="ignore"):  # what has no place is left out later
        x, y = np.diff(points, axis=0).T
        length = np.hypot(x, y)
        if not length.all():
            kept[1:] = length != 0.0
            kept[kept] = _telling(points[kept])
            return kept
        turn = np.abs(np.arctan2(x[:-1] * y[1:] - y[:-1] * x[1:], x[:-1] * x[1:] + y[:-1] * y[1:]))
    passed = np.floor(np.cumsum(np.sqrt(turn * np.maximum(length[1:], length[:-1]) / (2 * _OFF))))
    kept[1:-1] = np.diff(passed, prepend=0.0) != 0.0
    return kept


class _Lines(NamedTuple):
    """What columns of pixels need to know of their segment; along the axis that it is nearer to, which is called x.

    Attributes:
        first: the first column; they are ``aside`` places apart.
        x: where it begins, and ``y``.
        u: its direction, and ``v``: a unit vector.
        shadow: of a pixel across it: |u| + |v|.
        reach: how far above and below it a column has pixels near it.
        length: how long it is.
        stride: places from one pixel of a column to the next, of ``rows`` that the picture has.
    """

    first: FloatArray
    aside: FloatArray
    x: FloatArray
    y: FloatArray
    u: FloatArray
    v: FloatArray
    shadow: FloatArray
    reach: FloatArray
    length: FloatArray
    stride: FloatArray
    rows: FloatArray


def _lines(segments: _Segments, width: float, size: tuple[int, int]) -> tuple[_Lines, IntArray, IntArray]:
    """Give all segments, and the columns of pixels within reach of them: of which segment each is, and its rank."""
    steep = np.abs(segments.way[1]) > np.abs(segments.way[0])
    x, y = np.where(steep, segments.begin[::-1], segments.begin)
    along, across = np.where(steep, segments.way[::-1], segments.way)
    length = np.hypot(along, across)
    some = length > 0.0  # a point alone has no direction: any will do
    u, v = np.divide([along, across], length, out=np.array([some * 0.0 + 1.0, some * 0.0]), where=some)
    shadow = np.abs(u) + np.abs(v)
    reach = (width + shadow) / 2
    wide, high = float(size[0]), float(size[1])
    columns, rows = np.where(steep, [[high], [wide]], [[wide], [high]])
    aside, stride = np.where(steep, [[wide], [1.0]], [[1.0], [wide]])
    first = _pixel(x + np.minimum(along, 0.0) - reach, columns)
    count = _pixel(x + np.maximum(along, 0.0) + reach, columns) - first
    lines = _Lines(first, aside, x, y, u, v, shadow, reach / np.abs(u), length, stride, rows)
    return lines, *numbered(count.astype(np.int64))


def _pixel(place: FloatArray, count: FloatArray) -> FloatArray:
    """The first of ``count`` pixels in a row whose middle is not before a place; ``count`` if there is none."""
    return np.asarray(np.ceil(np.minimum(np.maximum(place - 0.5, 0.0), count)))


class _Columns(NamedTuple):
    """Columns of pixels (n,) across a segment each, of which some are near it.

    Attributes:
        place: of the first pixel, and ``stride`` from one to the next.
        top: which of the ``rows`` pixels of the picture's column the first is; negative above the picture.
        off: how far the first pixel's middle is from the line, and how much farther each is than the one before.
        past: the same of how far it is along the segment.
        shadow: of a pixel across the segment.
        length: of the segment.
        cut: (2, n) whether its begin, and its end, is cut off; None: none is.
    """

    place: FloatArray
    stride: FloatArray
    top: FloatArray
    rows: FloatArray
    off: tuple[FloatArray, FloatArray]
    past: tuple[FloatArray, FloatArray]
    shadow: FloatArray
    length: FloatArray
    cut: NDArray[np.bool_] | None


def _columns(lines: _Lines, cut: NDArray[np.bool_] | None, of: IntArray, rank: IntArray) -> _Columns:
    first, aside, x, y, u, v, shadow, reach, length, stride, rows = [each[of] for each in lines]
    column = first + rank
    dx = column + 0.5 - x
    top = np.ceil(y + dx * v / u - reach - 0.5)
    dy = top + 0.5 - y
    place = column * aside + top * stride
    return _Columns(place, stride, top, rows, (dy * u - dx * v, u), (dx * u + dy * v, v), shadow, length,
                    None if cut is None else cut[:, of])  # fmt: skip


def _near(columns: _Columns, step: FloatArray, width: float) -> tuple[IntArray, Spots]:
    """Cover those pixels of columns that are near: which they are, of the rows of columns one after the other."""
    off = _down(columns.off, step)
    np.multiply(off, off, out=off)
    ends, over, behind = _beyond_ends(columns, step)
    off[:, ends] += over * over
    # In shades, and half of one more, which makes whole numbers of them the nearest ones.
    part = np.subtract(np.float32(width / 2), np.sqrt(off, out=off), out=off)
    part *= (_SHADES / columns.shadow).astype(np.float32)
    part += np.float32(0.5 * _SHADES + 0.5)
    if behind is not None:
        part[:, ends] = np.minimum(part[:, ends], np.float32(_SHADES) * (np.float32(0.5) - behind) + np.float32(0.5))
    _leave_out(part, columns)
    np.minimum(part, (np.minimum(width / columns.shadow, 1.0) * _SHADES + 0.5).astype(np.float32), out=part)
    found = np.flatnonzero(part >= 1.0)
    place = step[:, None] * columns.stride
    place += columns.place
    cover = _COVERS[part.reshape(-1)[found].astype(np.uint8)]
    return found, Spots(place.reshape(-1)[found].astype(np.int64), cover)


def _down(line: tuple[FloatArray, FloatArray], step: FloatArray) -> Narrow:
    """Give values down columns (k, n) that grow by the same from row to row; 24 bits tell 1e-4 of a pixel."""
    first, growth = (each.astype(np.float32) for each in line)
    values = step.astype(np.float32)[:, None] * growth
    values += first
    return values


def _beyond_ends(columns: _Columns, step: FloatArray) -> tuple[IntArray, Narrow, Narrow | None]:
    """Where pixels may be beyond an end of their segment, or near it; and how far they are.

    Returns:
        Which columns (m,); how far their pixels are beyond a round end (k, m), 0 if they are not; and beyond one that
        is cut off, None if none is.
    """
    first, growth = columns.past
    most = len(step) * np.abs(growth) + 0.5
    some = np.flatnonzero((first < most) | (first > columns.length - most))
    first, growth = first[some], growth[some]
    before, after = _down((-first, -growth), step), _down((first - columns.length[some], growth), step)
    none, never = np.float32(0.0), np.float32(-1.0)
    if columns.cut is None:
        return some, np.maximum(np.maximum(before, after), none), None
    begin, end = columns.cut[:, some]
    over = np.maximum(np.maximum(np.where(begin, none, before), np.where(end, none, after)), none)
    return some, over, np.maximum(np.where(begin, before, never), np.where(end, after, never))


def _leave_out(part: Narrow, columns: _Columns) -> None:
    """Cover nothing above and below the picture; few columns reach beyond it."""
    count = len(part)
    some = np.flatnonzero((columns.top < 0.0) | (columns.top + count > columns.rows))
    if len(some):
        place = columns.top[some] + np.arange(count)[:, None]
        part[:, some] *= (place >= 0.0) & (place < columns.rows[some])
