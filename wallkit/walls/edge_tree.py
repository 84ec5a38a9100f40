"""The straight edges of many polylines with a tree of their boxes, for all who ask which edges are near."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import shapely
from numpy.typing import NDArray

from wallkit.geometry.arrays import FloatArray, IntArray

_FIRST_PORTION = 16  # edges; the next portions are as large as the pairs found let expect
_PAIRS_AT_ONCE = 200_000  # about so many a portion: bounds the memory


@dataclass(eq=False)
class Edges:
    """Straight edges of polylines that are laid out as in Walls.

    Attributes:
        vertices: (V, 2).
        offsets: (W + 1,).
        closed: (W,) bool.
    """

    vertices: FloatArray
    offsets: IntArray
    closed: NDArray[np.bool_]

    def __len__(self) -> int:
        return len(self.start)

    @cached_property
    def following(self) -> IntArray:
        """(V,) the vertex after each, around the end of its polyline."""
        following = np.arange(1, len(self.vertices) + 1)
        full = np.diff(self.offsets) > 0
        following[self.offsets[1:][full] - 1] = self.offsets[:-1][full]
        return following

    @cached_property
    def before(self) -> IntArray:
        """(V,) the vertex before each, around the start of its polyline."""
        before = np.empty_like(self.following)
        before[self.following] = np.arange(len(before))
        return before

    @cached_property
    def start(self) -> IntArray:
        """(E,) the vertex each edge starts at; the last vertex of an open polyline starts none."""
        keep = np.ones(len(self.vertices), dtype=np.bool_)
        keep[self.offsets[1:][~self.closed] - 1] = False
        return np.flatnonzero(keep)

    @cached_property
    def stop(self) -> IntArray:
        """(E,) the vertex each edge ends at."""
        return self.following[self.start]

    @cached_property
    def wall(self) -> IntArray:
        """(E,) the polyline each edge belongs to."""
        return self.wall_of[self.start]

    @cached_property
    def wall_of(self) -> IntArray:
        """(V,) the polyline each vertex belongs to."""
        return np.repeat(np.arange(len(self.closed)), np.diff(self.offsets))

    @cached_property
    def a(self) -> FloatArray:
        """(E, 2) start points."""
        return self.vertices[self.start]

    @cached_property
    def b(self) -> FloatArray:
        """(E, 2) end points."""
        return self.vertices[self.stop]

    @cached_property
    def boxes(self) -> Any:
        """(E,) the edges' boxes, as shapely geometry."""
        low, high = np.minimum(self.a, self.b), np.maximum(self.a, self.b)
        return shapely.box(low[:, 0], low[:, 1], high[:, 0], high[:, 1])

    @cached_property
    def tree(self) -> Any:
        """The tree of the boxes."""
        return shapely.STRtree(self.boxes)

    def near_pairs(self, rows: IntArray | None = None) -> Iterator[tuple[IntArray, IntArray]]:
        """All pairs of edges (first < second) whose boxes meet, neighbours along a polyline left out; in portions.

        Args:
            rows: (n,) the edges among which pairs are looked for, in rising order; all by default.
        """
        tree = self.tree if rows is None else shapely.STRtree(self.boxes[rows])
        chosen = np.arange(len(self)) if rows is None else rows
        begin, portion = 0, _FIRST_PORTION
        while begin < len(chosen):
            first, second = tree.query(self.boxes[chosen[begin : begin + portion]])
            found = len(first)
            first += begin
            begin += portion
            portion = int(min(8 * portion, max(portion * _PAIRS_AT_ONCE // max(found, 1), 1)))
            keep = first < second
            first, second = chosen[first[keep]], chosen[second[keep]]
            joined = (self.stop[first] == self.start[second]) | (self.stop[second] == self.start[first])
            yield first[~joined], second[~joined]
