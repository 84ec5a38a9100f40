"""Many numbers as text: rows by a template, a block at a time."""

from __future__ import annotations

import numpy as np

from wallkit.geometry.arrays import FloatArray

BLOCK = 2048  # rows that are Python's numbers at the same time: a number takes 24 bytes there, and a list's place


def rows(template: str, values: FloatArray, separator: str = ", ") -> str:
    """Write rows of numbers with all their digits.

    Args:
        template: of a row, with a ``%r`` for each of its numbers.
        values: (n, k) rows, or (n,) for one number each.
        separator: between rows.
    """
    array = np.asarray(values, dtype=np.float64)
    blocks = [array[start : start + BLOCK] for start in range(0, len(array), BLOCK)]
    whole = separator.join([template] * min(BLOCK, len(array)))
    length = len(template) + len(separator)
    return separator.join(
        whole[: len(block) * length - len(separator)] % tuple(block.ravel().tolist()) for block in blocks
    )
