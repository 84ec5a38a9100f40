"""Rows of different lengths in flat arrays."""

from __future__ import annotations

import numpy as np

from wallkit.geometry.arrays import IntArray


def numbered(counts: IntArray) -> tuple[IntArray, IntArray]:
    """For rows of ``counts`` entries: the row of each entry, and its rank in the row from 0."""
    which = np.repeat(np.arange(len(counts)), counts)
    return which, np.arange(len(which)) - np.repeat(np.cumsum(counts) - counts, counts)


def spread(first: IntArray, last: IntArray) -> tuple[IntArray, IntArray]:
    """Give for each range all its numbers: (which range, number)."""
    counts = last - first + 1
    which = np.repeat(np.arange(len(first)), counts)
    start = np.cumsum(counts) - counts
    return which, np.arange(len(which)) - start[which] + first[which]
