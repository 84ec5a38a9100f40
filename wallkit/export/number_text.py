"""Many numbers as text: rows by a template, a block at a time, made as they are written."""

from __future__ import annotations

import io
from dataclasses import dataclass
from typing import TextIO

import numpy as np

from wallkit.geometry.arrays import FloatArray

BLOCK = 2048  # rows that are Python's numbers at the same time: a number takes 24 bytes there, and a list's place


@dataclass(frozen=True, slots=True, eq=False)
class Rows:
    """Rows of numbers with all their digits. Their text is several times as large, and never stands in memory whole.

    Attributes:
        template: of a row, with a ``%r`` for each of its numbers.
        values: (n, k) rows, or (n,) for one number each.
        separator: between rows.
        before: text before the first row.
        after: text behind the last.
    """

    template: str
    values: FloatArray
    separator: str = ", "
    before: str = ""
    after: str = ""

    def write(self, stream: TextIO) -> None:
        """Write all of it."""
        array = np.asarray(self.values, dtype=np.float64)
        whole = self.separator.join([self.template] * min(BLOCK, len(array)))
        length = len(self.template) + len(self.separator)
        stream.write(self.before)
        for start in range(0, len(array), BLOCK):
            block = array[start : start + BLOCK]
            if start:
                stream.write(self.separator)
            stream.write(whole[: len(block) * length - len(self.separator)] % tuple(block.ravel().tolist()))
        stream.write(self.after)

    def __str__(self) -> str:
        stream = io.StringIO()
        self.write(stream)
        return stream.getvalue()
