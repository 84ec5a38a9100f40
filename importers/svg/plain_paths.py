"""Path data of a whole document at once: the numbers of its long, plain paths, read in whole arrays.

Plain is what drawing programs write most: one subpath of M, L and C, all of them absolute or all relative, closed by Z
or open, and numbers without an exponent and of at most 15 digits. Anything else, a fault above all, is left to
``path_data``, which reads letter by letter, knows all of the grammar, and says what is wrong where. Both give the same
numbers to the bit.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Iterator

import numpy as np
from numpy.typing import NDArray

from importers.drawing import Subpath
from importers.limits import MAX_ELEMENTS

LEAST = 100
"""Letters of path data from which on whole arrays are quicker."""
_MOST = 1 << 21  # letters of a path, which bound the memory
_AT_ONCE = 1 << 17  # letters: what is made of them stays in the cache
_MOST_DIGITS = 15
"""A mantissa of so many is below 2^53 and exact, as is the power of ten below it: their quotient is rounded once."""
_TENS = 10.0 ** np.arange(_MOST_DIGITS + 1)
_BETWEEN = b"\0"

# What a byte is
_OTHER, _SPACE, _COMMA, _LETTER, _DIGIT, _POINT, _MINUS = range(7)
_SIGNS = {b" \t\r\n\f": _SPACE, b",": _COMMA, b"MmLlCcZz" + _BETWEEN: _LETTER}
_SIGNS |= {b"0123456789": _DIGIT, b".": _POINT, b"-": _MINUS}
_KINDS = bytes(next((kind for signs, kind in _SIGNS.items() if byte in signs), _OTHER) for byte in range(256))
# Numbers that a letter takes at a time; 0 for none
_TAKES = np.zeros(256, dtype=np.int64)
_TAKES[list(b"MmLlCc")] = 2, 2, 2, 2, 6, 6
_RELATIVE = np.zeros(256, dtype=np.int64)
_RELATIVE[list(b"LlCc")] = -1, 1, -1, 1
_CASE = 0x20  # what makes a letter a small one

_Bools = NDArray[np.bool_]
_Ints = NDArray[np.int64]
_Floats = NDArray[np.float64]
_Plain = tuple[bytes, _Floats, bool, float]
"""Letters of segments, their numbers, whether they close, and what no number is larger than."""


class PlainPaths:
    """The plain ones of some path data, read."""

    def __init__(self, texts: Iterable[str]) -> None:
        """Read those that are long enough."""
        self._read: dict[str, _Plain] = {}
        segments = 0
        long_enough = (text for text in texts if LEAST <= len(text) <= _MOST and _BETWEEN.decode() not in text)
        for some in _portions(long_enough):
            found = dict(_read(some))
            self._read.update(found)
            segments += sum(len(letters) for letters, _, _, _ in found.values())
            if segments > MAX_ELEMENTS:  # more than may be drawn: no memory for them
                break

    def get(self, text: str) -> Subpath | None:
        """Give what path data draw; None where they are not among the plain ones."""
        found = self._read.get(text)
        return None if found is None else Subpath.of_columns(*found)


def _portions(texts: Iterable[str]) -> Iterator[list[str]]:
    """Give texts some at a time."""
    some: list[str] = []
    letters = 0
    for text in texts:
        some.append(text)
        letters += len(text)
        if letters > _AT_ONCE:
            yield some
            some, letters = [], 0
    if some:
        yield some


def _read(texts: list[str]) -> Iterator[tuple[str, _Plain]]:
    """Read texts: each plain one with what it draws."""
    joined = "".join(_BETWEEN.decode() + text for text in texts)
    raw = joined.encode("ascii", "replace")  # letter by letter
    data, kinds = (np.frombuffer(part, dtype=np.uint8) for part in (raw, raw.translate(_KINDS)))
    in_number = kinds >= _DIGIT
    starts, stops = _numbers(kinds, in_number)
    numbers, broken = _values(data, starts, stops)
    letters = np.flatnonzero(kinds == _LETTER)
    begins = np.cumsum([0, *(len(text) + 1 for text in texts)])  # of each text, and of what is behind all
    first = np.searchsorted(letters, begins)  # letter of each text
    taken = np.searchsorted(starts, letters)  # the number behind each letter
    counts = np.diff(taken, append=len(starts))
    plain = np.logical_and.reduceat(_in_order(data[letters], counts), first[:-1])
    drawing = _RELATIVE[data[letters]]
    relative = np.add.reduceat(drawing, first[:-1])
    plain &= np.abs(relative) == np.add.reduceat(np.abs(drawing), first[:-1])
    wrong = np.concatenate([_misplaced(kinds), starts[broken]])
    plain[np.searchsorted(begins, wrong, side="right") - 1] = False
    takes = np.maximum(_TAKES[data[letters]], 1)
    drawn = counts // takes  # segments of each letter
    words = np.repeat(data[letters] & ~np.uint8(_CASE), drawn).tobytes()
    at = np.concatenate([[0], np.cumsum(drawn)])[first].tolist()
    ends = np.append(taken, len(starts))[first].tolist()
    closed = (data[letters[first[1:] - 1]] | _CASE) == ord("z")
    reach = np.maximum.reduceat(np.append(np.abs(numbers), 0.0), taken[first[:-1]])
    told = texts, plain.tolist(), (relative > 0).tolist(), closed.tolist(), reach.tolist()
    for text, good, moves, closes, most, (low, high), (begin, end) in zip(
        *told, itertools.pairwise(at), itertools.pairwise(ends), strict=True
    ):
        if good and high - low > 1:
            own = numbers[begin:end]
            if moves:
                own = _absolute(words[low:high], own)
                most = float(np.abs(own).max())
            yield text, (words[low:high], own, closes, most)


def _absolute(words: bytes, numbers: _Floats) -> _Floats:
    """Add to the numbers of relative segments, all but the first, where each begins: sums in the order of the file."""
    pairs = numbers.reshape(-1, 2)
    sizes = _TAKES[np.frombuffer(words, dtype=np.uint8)] // 2
    ends = np.add.accumulate(pairs[np.cumsum(sizes) - 1], axis=0)
    begins = np.repeat(ends[:-1], sizes[1:], axis=0)
    return np.concatenate([pairs[:1], pairs[1:] + begins]).ravel()


def _numbers(kinds: NDArray[np.uint8], in_number: _Bools) -> tuple[_Ints, _Ints]:
    """Where numbers begin, and where they end: at what no number has in it, or where a sign begins the next one."""
    before = np.concatenate([[False], in_number[:-1]])
    begins = in_number & (~before | (kinds == _MINUS))
    goes_on = np.concatenate([in_number[1:] & ~begins[1:], [False]])
    return np.flatnonzero(begins), np.flatnonzero(in_number & ~goes_on) + 1


def _values(data: NDArray[np.uint8], starts: _Ints, stops: _Ints) -> tuple[_Floats, _Bools]:
    """Give the numbers, and mark those that are none or need more care."""
    sizes = stops - starts
    negative = data[starts] == ord("-")
    whole, point = np.zeros(len(starts), dtype=np.int64), np.full(len(starts), -1, dtype=np.int64)
    points = np.zeros(len(starts), dtype=np.int64)
    at, last = starts + negative, stops - 1
    read = data - np.uint8(ord("0"))  # a point is above 9
    for _ in range(min(int(sizes.max(initial=0)), _MOST_DIGITS + 1)):  # and a point
        digit = read[np.minimum(at, last)]
        inside, is_digit = at <= last, digit <= 9
        is_point = inside & ~is_digit
        whole = np.where(inside & is_digit, 10 * whole + digit, whole)
        point = np.where(is_point, at, point)
        points += is_point
        at += 1
    digits = sizes - negative - points
    places = np.where(points > 0, last - point, 0)
    broken = (points > 1) | (digits < 1) | (digits > _MOST_DIGITS) | (data[last] == ord("."))
    broken |= negative & (whole == 0)  # -0, which is 0 or -0 by what is around it
    numbers = whole / _TENS[np.where(broken, 0, places)]
    return np.where(negative, -numbers, numbers), broken


def _misplaced(kinds: NDArray[np.uint8]) -> _Ints:
    """Where a byte is that plain path data have not, or a comma that is not between two numbers, one space behind."""
    padded = np.concatenate([kinds, [_LETTER, _LETTER]]).astype(np.uint8)
    begins = padded >= _DIGIT
    between = (padded[:-3] == _DIGIT) & begins[2:-1]  # before the first comma is at least what is between
    odd = np.flatnonzero((kinds[1:] == _COMMA) & ~between) + 1
    good = (kinds[odd - 1] == _DIGIT) & (padded[odd + 1] == _SPACE) & begins[odd + 2]
    return np.concatenate([np.flatnonzero(kinds == _OTHER), odd[~good]])


def _in_order(letters: NDArray[np.uint8], counts: _Ints) -> _Bools:
    """Mark letters that stand, and have as many numbers, as in one plain subpath."""
    between, move = letters == _BETWEEN[0], (letters | _CASE) == ord("m")
    ends = np.append(between[1:], True)
    takes = _TAKES[letters]
    curves = (takes > 0) & (counts > 0) & (counts % np.maximum(takes, 1) == 0)
    draws = curves & np.where(move, counts == 2, True)
    closes = (takes == 0) & ~between & (counts == 0) & ends
    after = np.concatenate([[False], between[:-1]])
    result: _Bools = np.where(between, counts == 0, (move == after) & (draws | closes))
    return result
