"""Many small polygons in two arrays: an array of its own for each would cost more than its points."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from wallkit.geometry.arrays import FloatArray, IntArray


@dataclass(frozen=True, slots=True, eq=False)
class Pieces:
    """Polygons one after the other.

    Attributes:
        vertices: (k, 2).
        offsets: (m + 1,) polygon i has the vertices ``offsets[i]`` to ``offsets[i + 1]``.
    """

    vertices: FloatArray
    offsets: IntArray

    @staticmethod
    def joined(parts: Sequence[Pieces]) -> Pieces:
        """Give the polygons of all parts, in order."""
        counts = [np.diff(part.offsets) for part in parts]
        offsets = np.concatenate([[0], *counts]).cumsum().astype(np.int64)
        vertices = np.concatenate([part.vertices for part in parts]) if parts else np.empty((0, 2))
        return Pieces(vertices, offsets)

    def __len__(self) -> int:
        return len(self.offsets) - 1

    def __iter__(self) -> Iterator[FloatArray]:
        for start, end in zip(self.offsets[:-1].tolist(), self.offsets[1:].tolist(), strict=True):
            yield self.vertices[start:end]

    def cut(self, first: int, last: int) -> Pieces:
        """Give the polygons ``first`` to ``last``, without the last."""
        start, end = int(self.offsets[first]), int(self.offsets[last])
        return Pieces(self.vertices[start:end], self.offsets[first : last + 1] - start)

    def blocks(self, size: int) -> Iterator[Pieces]:
        """Give them in order, at most ``size`` at a time."""
        for first in range(0, len(self), size):
            yield self.cut(first, min(first + size, len(self)))

    def turned(self) -> Pieces:
        """Give each polygon with its vertices from the last to the first."""
        rank = np.arange(len(self.vertices)) - np.repeat(self.offsets[:-1], np.diff(self.offsets))
        return Pieces(self.vertices[np.repeat(self.offsets[1:], np.diff(self.offsets)) - 1 - rank], self.offsets)
