"""What one instruction of the machine, or a few, do better than what the compiler makes of Python.

Each is a function that does the same in Python; what stands in for it in machine code is in ``compiler.instructions``.
"""

from __future__ import annotations

from typing import Any

AT_ONCE = 8
"""Numbers looked up, or paired up, together."""
FIRST, SECOND = 3, 2
"""The caches L1 and L2, as LLVM numbers them."""


def claim(counter: Any, count: int) -> int:
    """Take the next ``count`` numbers of a counter in an array, which threads may share: the first of them."""
    first = int(counter[0])
    counter[0] += count
    return first


def prefetch(_records: Any, _place: int) -> None:
    """Prefetch an item of an array that is read soon into the L1 cache.

    It changes no result, and the place may be anywhere, also beyond the array.
    """


def prefetch_far(_records: Any, _place: int) -> None:
    """Prefetch an item into the L2 cache, where there are so many that they come from memory.

    L1 has few miss buffers, and stalls when all are in use: random cache lines come up to twice as fast through L2.
    """


def lowest(bits: int) -> int:
    """Give the place of the lowest bit that is set in an integer; there must be one."""
    # bits & -bits keeps the lowest bit, as two's complement has it.
    return (bits & -bits).bit_length() - 1


def look_up(table: Any, places: Any, first: int, found: Any, to: int) -> None:
    """Look up eight numbers of a table together: that at ``places[first + j]`` goes to ``found[to + j]``."""
    for j in range(AT_ONCE):
        found[to + j] = table[places[first + j]]


def pair_up(ids: Any, at: int, who: int, pairs: Any, to: int, to_who: int) -> None:
    """Write the next eight ids of a list one after the other, and as often who asks them."""
    for k in range(AT_ONCE):
        pairs[to + k] = ids[at + k]
        pairs[to_who + k] = who


def fetch(
    records: Any, ids: Any, first: int, columns: Any, to: int, wanted: tuple[tuple[int, int], ...]
) -> None:  # fmt: skip
    """Turn some records into columns, as many at once as a record has floats (a power of two).

    The record of the id ``ids[first + j]`` fills place ``to + j`` of columns: for each (k, begin) that is ``wanted``
    the one that begins there gets its k-th number, counted from 1, or for k = 0 the id.
    """
    for j in range(len(records[0])):
        number = ids[first + j]
        numbers = (float(number), *records[number])
        for k, begin in wanted:
            columns[begin + to + j] = numbers[k]


def numbers_of(record: Any, **columns: int) -> tuple[tuple[int, int], ...]:
    """Say which numbers of a record :func:`fetch` writes into which columns: by name, where each column begins."""
    return tuple((1 + record._fields.index(name), begin) for name, begin in columns.items())
