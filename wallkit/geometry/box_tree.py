"""A packed tree of boxes: which boxes meet which, for many questions at once.

The boxes stand in the order of Hilbert's curve through their middles, and every _WIDTH of them in a row have a box
around them, level by level, until one is around all. The questions of a call go down together, a level at a time, so
that the work is done in whole arrays.
"""

from __future__ import annotations

from functools import cache, cached_property
from typing import NamedTuple

import numpy as np

from wallkit.geometry.arrays import FloatArray, IntArray

_WIDTH = 16
_BITS = 16  # of each coordinate, which tell the order
_STEP = 4  # so many of them are looked up together
_LOW = (1 << _STEP) - 1
_FEW = 1 << 15  # pairs of a question and a box
_AT_ONCE = 4096  # rows that are looked at together: what they need stays in the cache


class BoxTree:
    """Boxes to be asked for.

    Attributes:
        low: (2, n) their lowest corners.
        high: (2, n) their highest corners.
    """

    def __init__(self, low: FloatArray, high: FloatArray) -> None:
        self.low, self.high = low, high

    def query(self, low: FloatArray, high: FloatArray) -> tuple[IntArray, IntArray]:
        """Pairs of a box in question and a box of the tree that meet, both rising.

        Args:
            low: (2, m) lowest corners of those in question.
            high: (2, m) their highest corners.
        """
        count, asked = self.low.shape[1], low.shape[1]
        if count * asked <= _FEW:
            meets = (self.low[:, None] <= high[:, :, None]) & (self.high[:, None] >= low[:, :, None])
            question, box = np.nonzero(meets[0] & meets[1])
            return question, box
        order = np.argsort(_along_hilbert(low / 2 + high / 2, self._frame))
        return self._answers(order, low[:, order], high[:, order])

    def among(self, first: int, stop: int) -> tuple[IntArray, IntArray]:
        """The same for the boxes of the tree itself from the number ``first`` to before ``stop``."""
        count = self.low.shape[1]
        if count * (stop - first) <= _FEW:
            question, box = self.query(self.low[:, first:stop], self.high[:, first:stop])
            return question + first, box
        places = np.flatnonzero((self._order >= first) & (self._order < stop))
        row, place = places // _WIDTH, places % _WIDTH
        x0, y0, x1, y1 = (part[row, place] for part in self._levels[0].corners)
        return self._answers(self._order[places], np.stack([x0, y0]), np.stack([x1, y1]))

    @cached_property
    def _frame(self) -> FloatArray:
        """The lowest and highest middle of a box, which the order goes by: (2, 2)."""
        middle = self.low / 2 + self.high / 2
        return np.stack([middle.min(axis=1), middle.max(axis=1)])

    @cached_property
    def _order(self) -> IntArray:
        """The boxes in the order of the leaves: (n,)."""
        return np.argsort(_along_hilbert(self.low / 2 + self.high / 2, self._frame))

    @cached_property
    def _levels(self) -> list[_Level]:
        """The boxes from the leaves up, in rows of _WIDTH: row k holds the children of the k-th box above."""
        levels = [_Level.of(self.low[:, self._order], self.high[:, self._order])]
        while len(levels) == 1 or levels[-1].rows > 1:
            levels.append(levels[-1].above())
        return levels

    def _answers(self, asked: IntArray, low: FloatArray, high: FloatArray) -> tuple[IntArray, IntArray]:
        """Answer questions of the numbers ``asked`` (m,), along Hilbert's curve.

        They go down in rows as well, each row as the box around it, to the last rows; one by one from there.
        """
        questions = _Level.of(low, high)
        around = questions.above()
        group = np.arange(questions.rows)
        row = np.zeros(len(group), dtype=np.int64)
        for level in self._levels[:0:-1]:
            group, row = level.below(row, around, group)
        question, row = questions.below(group, self._levels[1], row)[::-1]
        question, box = self._levels[0].below(row, questions, question)
        count = len(self._order)
        key = np.sort(asked[question] * count + self._order[box])
        question = key // count
        return question, key - question * count


class _Level(NamedTuple):
    """Boxes in rows of _WIDTH; the last row is filled up with boxes that nothing meets.

    Attributes:
        rows: their number.
        low_x: (rows, _WIDTH); the others alike.
    """

    rows: int
    low_x: FloatArray
    low_y: FloatArray
    high_x: FloatArray
    high_y: FloatArray

    @property
    def corners(self) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
        """Lowest x and y, highest x and y."""
        return self.low_x, self.low_y, self.high_x, self.high_y

    @classmethod
    def of(cls, low: FloatArray, high: FloatArray) -> _Level:
        """Take corners in order, (2, n) each."""
        rows = max(-(-low.shape[1] // _WIDTH), 1)
        filled = np.full((4, rows * _WIDTH), np.inf)
        filled[2:] = -np.inf
        filled[:2, : low.shape[1]], filled[2:, : low.shape[1]] = low, high
        return cls(rows, *filled.reshape(4, rows, _WIDTH))

    def above(self) -> _Level:
        """Give the boxes around the rows."""
        low = np.stack([self.low_x.min(axis=1), self.low_y.min(axis=1)])
        return _Level.of(low, np.stack([self.high_x.max(axis=1), self.high_y.max(axis=1)]))

    def below(self, row: IntArray, others: _Level, other: IntArray) -> tuple[IntArray, IntArray]:
        """Pairs of a box of ``others`` and one of a row here that meet.

        Args:
            row: (m,) rows here.
            others: other boxes.
            other: (m,) the number of one of them, which is compared with all boxes of the row.
        """
        found: list[tuple[IntArray, IntArray]] = [(row[:0], row[:0])]
        for begin in range(0, len(row), _AT_ONCE):
            here, there = row[begin : begin + _AT_ONCE], other[begin : begin + _AT_ONCE]
            meets = self.low_x[here] <= others.high_x.ravel()[there, None]
            meets &= self.low_y[here] <= others.high_y.ravel()[there, None]
            meets &= self.high_x[here] >= others.low_x.ravel()[there, None]
            meets &= self.high_y[here] >= others.low_y.ravel()[there, None]
            place = np.flatnonzero(meets)
            which = place // _WIDTH
            found.append((there[which], _WIDTH * here[which] + place % _WIDTH))
        return np.concatenate([one for one, _ in found]), np.concatenate([two for _, two in found])


def _along_hilbert(middle: FloatArray, frame: FloatArray) -> IntArray:
    """How far along Hilbert's curve points (2, n) are: (n,)."""
    size = np.maximum(frame[1] - frame[0], 1e-300)[:, None]
    x, y = (np.clip((middle - frame[0][:, None]) / size, 0.0, 1.0) * (2**_BITS - 1)).astype(np.int64)
    along = np.zeros(len(x), dtype=np.int64)
    for begin in range(0, len(x), _AT_ONCE):
        part = slice(begin, begin + _AT_ONCE)
        along[part] = _hilbert(x[part], y[part])
    return along


def _hilbert(x: IntArray, y: IntArray) -> IntArray:
    """Give the places of some of them."""
    places, states = _hilbert_steps()
    along, state = np.zeros(len(x), dtype=np.int64), np.zeros(len(x), dtype=np.int64)
    for shift in range(_BITS - _STEP, -1, -_STEP):
        row = state + ((x >> shift & _LOW) << _STEP) + (y >> shift & _LOW)
        along = (along << 2 * _STEP) + places[row]
        state = states[row]
    return along


@cache
def _hilbert_steps() -> tuple[IntArray, IntArray]:
    """Give what _STEP bits of x and y add to the place, and the state that follows, by state, bits of x and bits of y.

    The curve visits the four quarters of a square one after the other; it enters the first transposed and the last
    transposed about the other diagonal. So each bit of the coordinates, from the highest, gives a quarter, and says
    whether the bits below are swapped, and whether all are flipped: that is the state.
    """
    number = np.arange(4 << 2 * _STEP)
    flip, swap = -(number >> 2 * _STEP & 1), number >> 2 * _STEP + 1
    x, y = (number >> _STEP ^ flip) & _LOW, (number ^ flip) & _LOW
    x, y = np.where(swap, y, x), np.where(swap, x, y)
    flip, place = -flip, np.zeros_like(number)
    for bit in reversed(range(_STEP)):
        right, top = x >> bit & 1, y >> bit & 1
        place = 4 * place + (3 * right ^ top)
        lower = 1 - top  # the first or the last quarter is entered
        flip, swap = flip ^ (lower & right), swap ^ lower
        x, y = x ^ -(lower & right), y ^ -(lower & right)
        x, y = np.where(lower, y, x), np.where(lower, x, y)
    return place, (2 * swap + flip) << 2 * _STEP
