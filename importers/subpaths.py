"""Subpaths: one pen stroke each, as a list of segments or in columns, which are read and moved many at once."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    FloatArray = NDArray[np.float64]
    Columns = tuple[bytes, FloatArray]

Matrix = tuple[float, float, float, float, float, float]

# One segment of a subpath, in the words of SVG path data, always absolute:
#   ("M", x, y)                                      start; only ever the first of a subpath
#   ("L", x, y)                                      line
#   ("Q", x1, y1, x, y)                              quadratic Bezier curve
#   ("C", x1, y1, x2, y2, x, y)                      cubic Bezier curve
#   ("A", rx, ry, rotation, large, sweep, x, y)      elliptic arc; rotation in degrees, large and sweep 0 or 1,
#                                                    rx, ry > 0 and large enough to reach (never scaled up later)
Segment = tuple[Any, ...]


class Subpath:
    """One pen stroke: a start point and the segments from it.

    Attributes:
        segments: ``("M", x, y)`` first, then any of L, Q, C and A. A closing edge is not repeated: a closed
            triangle is M L L with ``closed`` true. Where the file itself draws back to the start and closes
            as well, the last segment is kept as written.
        closed: the file closes it (``Z``, a closing paint operator, a shape that is closed by nature).
    """

    __slots__ = ("_columns", "_matrix", "_reach", "_segments", "closed")
    __hash__ = None  # type: ignore[assignment]  # it may change

    def __init__(self, segments: list[Segment], closed: bool) -> None:
        self._segments: list[Segment] | None = segments
        self._columns: Columns | None = None
        self._matrix: Matrix | None = None  # what the numbers of the columns are still to be put through
        self._reach = math.inf
        self.closed = closed

    @classmethod
    def of_columns(cls, letters: bytes, numbers: FloatArray, closed: bool, reach: float = math.inf) -> Subpath:
        """Make one of columns, see :attr:`columns`; its segments are made when somebody asks for them.

        Args:
            letters: of the segments; none is an arc.
            numbers: of them, which are taken as they are.
            closed: as :attr:`closed`.
            reach: no number is larger.
        """
        subpath = cls.__new__(cls)
        subpath._segments, subpath._columns, subpath._matrix = None, (letters, numbers), None
        subpath._reach, subpath.closed = reach, closed
        return subpath

    def moved(self, matrix: Matrix) -> Subpath:
        """Give one of columns through a matrix; :func:`settle` does the arithmetic for many at once."""
        letters, numbers = self._settled()
        a, b, c, d, e, f = matrix
        if matrix[:4] == _STILL:
            if e == f == 0.0:
                return Subpath.of_columns(letters, numbers, self.closed, self._reach)
            e, f = e + 0.0, f + 0.0  # 0 for -0: -0 moved by 0 is 0
        reach = max(abs(a) + abs(c), abs(b) + abs(d)) * self._reach + max(abs(e), abs(f))
        subpath = Subpath.of_columns(letters, numbers, self.closed, reach)
        subpath._matrix = a, b, c, d, e, f
        return subpath

    def surely_within(self, most: float) -> bool:
        """Tell without a look at the numbers that none is larger; by half, so that rounding does not matter."""
        return self._segments is None and self._reach <= most / 2

    def within(self, most: float) -> bool:
        """Tell whether every number is finite and none larger."""
        if self.surely_within(most):
            return True
        if self.columns is not None:
            return bool(abs(self.columns[1]).max(initial=0.0) <= most)
        return all(-most <= number <= most for segment in self.segments for number in segment[1:])

    @property
    def segments(self) -> list[Segment]:
        """The segments; from then on they are what the subpath is, for a list may be changed."""
        if self._segments is None:
            self._segments, self._columns = list(_unpacked(*self._settled())), None
        return self._segments

    @segments.setter
    def segments(self, segments: list[Segment]) -> None:
        self._segments, self._columns, self._matrix = segments, None, None

    @property
    def in_columns(self) -> bool:
        """It has :attr:`columns`."""
        return self._segments is None

    @property
    def columns(self) -> Columns | None:
        """The letters and the numbers of all segments one after the other; None where it is a list."""
        return None if self._segments is not None else self._settled()

    def __len__(self) -> int:
        """How many segments it has, the start counted."""
        if self._segments is not None:
            return len(self._segments)
        assert self._columns is not None
        return len(self._columns[0])

    @property
    def start(self) -> tuple[float, float]:
        """Where it starts."""
        if self._segments is not None:
            _, x, y = self._segments[0]
            return x, y
        assert self._columns is not None
        x, y = self._columns[1][:2].tolist()
        if self._matrix is None:
            return x, y
        still = self._matrix[:4] == _STILL
        return (x + self._matrix[4], y + self._matrix[5]) if still else _through(self._matrix, x, y)

    def _settled(self) -> Columns:
        if self._matrix is not None:
            settle([self])
        assert self._columns is not None
        return self._columns

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Subpath):
            return NotImplemented
        return self.closed == other.closed and self.segments == other.segments

    def __repr__(self) -> str:
        return f"Subpath(segments={self.segments!r}, closed={self.closed!r})"


def settle(subpaths: Iterable[Subpath]) -> None:
    """Put the numbers of subpaths through the matrices that these wait for, many at once."""
    waiting = [subpath for subpath in subpaths if subpath._matrix is not None]
    for begin in range(0, len(waiting), _AT_ONCE):
        _settle(waiting[begin : begin + _AT_ONCE])


_AT_ONCE = 128  # subpaths: what is made of them stays in the cache


def _settle(waiting: list[Subpath]) -> None:
    import numpy as np  # late, for those who read drawings without it

    columns = [subpath._columns or (b"", np.empty(0)) for subpath in waiting]
    pairs = np.array([len(numbers) // 2 for _, numbers in columns])
    numbers = np.concatenate([numbers for _, numbers in columns])
    matrices = np.array([subpath._matrix for subpath in waiting])
    still = (matrices[:, :4] == _STILL).all(axis=1)
    a, b, c, d, e, f = np.repeat(matrices.T, pairs, axis=1)
    x, y = numbers[0::2], numbers[1::2]
    if still.all():
        x += e
        y += f
    else:
        still = np.repeat(still, pairs)
        with np.errstate(over="ignore", invalid="ignore"):  # what is too large is told by whoever draws it
            moved = _through((a, b, c, d, e, f), x, y)
        x[:], y[:] = np.where(still, x + e, moved[0]), np.where(still, y + f, moved[1])
    stop = 0
    for subpath, (letters, own) in zip(waiting, columns, strict=True):
        start, stop = stop, stop + len(own)
        subpath._columns, subpath._matrix = (letters, numbers[start:stop]), None


_STILL = (1.0, 0.0, 0.0, 1.0)  # a matrix that only moves: it adds, for 0 times what is not finite is no number


def _through(matrix: Any, x: Any, y: Any) -> tuple[Any, Any]:
    """Put points through a matrix."""
    a, b, c, d, e, f = matrix
    return a * x + c * y + e, b * x + d * y + f


NUMBERS = {"M": 2, "L": 2, "Q": 4, "C": 6, "A": 7}
"""Numbers of a segment, by its letter."""


def _unpacked(letters: bytes, numbers: FloatArray) -> Iterator[Segment]:
    """Make segments of columns."""
    flat, at = numbers.tolist(), 0
    for letter in letters.decode():
        yield (letter, *flat[at : at + NUMBERS[letter]])
        at += NUMBERS[letter]
