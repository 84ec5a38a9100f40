"""A packed tree of boxes: which boxes meet which, for many questions at once.

The boxes stand in the order of Hilbert's curve through their middles, and every _WIDTH of them in a row have a box
around them, level by level, until one is around all. The questions of a call go down together, a level at a time, so
that the work is done in whole arrays.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from wallkit.geometry.arrays import FloatArray, IntArray

_WIDTH = 16
_BITS = 16  # of each coordinate, which tell the order
_AT_ONCE = 4096  # rows that are looked at together: what they need stays in the cache


class BoxTree:
    """Boxes to be asked for.

    Attributes:
        frame: (2, 2) the lowest and highest middle of a box, which the order goes by.
        order: (n,) the boxes in the order of the leaves.
        levels: the boxes from the leaves up, in rows of _WIDTH: row k holds the children of the k-th box above.
    """

    def __init__(self, low: FloatArray, high: FloatArray) -> None:
        """Take the lowest and highest corners, (2, n) each."""
        middle = low / 2 + high / 2
        self.frame = np.stack([middle.min(axis=1, initial=np.inf), middle.max(axis=1, initial=-np.inf)])
        self.order = np.argsort(_along_hilbert(middle, self.frame))
        level = _Level.of(low[:, self.order], high[:, self.order])
        self.levels = [level]
        while level.rows > 1:
            level = level.above()
            self.levels.append(level)

    def query(self, low: FloatArray, high: FloatArray) -> tuple[IntArray, IntArray]:
        """Pairs of a box in question, (2, m) lowest and highest corners, and a box of the tree that meet: both rising.

        Questions go down in rows as well, each row as the box around it, to the last rows; one by one from there.
        """
        asked = np.argsort(_along_hilbert(low / 2 + high / 2, self.frame))
        return self._answers(asked, low[:, asked], high[:, asked])

    def among(self, first: int, stop: int) -> tuple[IntArray, IntArray]:
        """The same for the boxes of the tree itself from the number ``first`` to before ``stop``."""
        places = np.flatnonzero((self.order >= first) & (self.order < stop))
        row, place = places // _WIDTH, places % _WIDTH
        x0, y0, x1, y1 = (part[row, place] for part in self.levels[0].corners)
        return self._answers(self.order[places], np.stack([x0, y0]), np.stack([x1, y1]))

    def _answers(self, asked: IntArray, low: FloatArray, high: FloatArray) -> tuple[IntArray, IntArray]:
        """Answer questions of the numbers ``asked`` (m,), in the order of the leaves."""
        questions = _Level.of(low, high)
        around = questions.above()
        group = np.arange(questions.rows)
        row = np.zeros(len(group), dtype=np.int64)
        for level in self.levels[:0:-1]:
            group, row = level.below(row, around, group)
        question, row = questions.below(group, self.levels[1] if len(self.levels) > 1 else around, row)[::-1]
        question, box = self.levels[0].below(row, questions, question)
        count = len(self.order)
        key = np.sort(asked[question] * count + self.order[box])
        question = key // max(count, 1)
        return question, key - question * count


@dataclass(frozen=True, slots=True)
class _Level:
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
    """How far along Hilbert's curve points (2, n) are: (n,).

    The curve visits the four quarters of a square one after the other; it enters the first transposed and the last
    transposed about the other diagonal. So each bit of the coordinates, from the highest, gives a quarter, and turns
    the bits below.
    """
    size = np.maximum(frame[1] - frame[0], 1e-300)[:, None]
    x, y = (np.clip((middle - frame[0][:, None]) / size, 0.0, 1.0) * (2**_BITS - 1)).astype(np.int64)
    along = np.zeros(len(x), dtype=np.int64)
    for begin in range(0, len(x), _AT_ONCE):
        part = slice(begin, begin + _AT_ONCE)
        along[part] = _hilbert(x[part], y[part])
    return along


def _hilbert(x: IntArray, y: IntArray) -> IntArray:
    """Give the places of some of them."""
    along = np.zeros(len(x), dtype=np.int64)
    for bit in reversed(range(_BITS)):
        right, top = (x >> bit) & 1, (y >> bit) & 1
        along = 4 * along + ((3 * right) ^ top)
        lower = top - 1  # all ones where the first or the last quarter is entered
        mirrored = lower & -right
        x, y = x ^ mirrored, y ^ mirrored
        turn = (x ^ y) & lower
        x, y = x ^ turn, y ^ turn
    return along
