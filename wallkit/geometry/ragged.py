"""Rows of different lengths in flat arrays."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from wallkit.geometry.arrays import IntArray


def numbered(counts: IntArray) -> tuple[IntArray, IntArray]:
    """For rows of ``counts`` entries: the row of each entry, and its rank in the row from 0."""
    which = np.repeat(np.arange(len(counts)), counts)
    return which, np.arange(len(which)) - np.repeat(np.cumsum(counts) - counts, counts)


AT_ONCE = 1 << 14
"""Entries that are worked on at once: what they need stays in the cache, and is no fresh memory, which takes longer."""


def slices(count: int, about: int) -> Iterator[slice]:
    """Cut so many rows into slices of ``about`` that are worked on one after the other; one at least."""
    return (slice(begin, begin + about) for begin in range(0, max(count, 1), about))


def portions(offsets: IntArray, about: int = AT_ONCE) -> Iterator[tuple[int, int]]:
    """Give ranges of rows (first, stop) that have about so many entries together, all rows in order.

    Args:
        offsets: (r + 1,) row k has the entries ``offsets[k]`` to ``offsets[k + 1]``.
        about: so many; a row that has more stands in a range of its own or ends one.
    """
    rows = len(offsets) - 1
    cuts = np.flatnonzero(np.diff(offsets[:-1] // about)) + 1
    for first, stop in zip([0, *cuts.tolist()], [*cuts.tolist(), rows], strict=True):
        if first < stop:
            yield first, stop


def spread(first: IntArray, last: IntArray) -> tuple[IntArray, IntArray]:
    """Give for each range all its numbers: (which range, number)."""
    counts = last - first + 1
    which = np.repeat(np.arange(len(first)), counts)
    start = np.cumsum(counts) - counts
    return which, np.arange(len(which)) - start[which] + first[which]
