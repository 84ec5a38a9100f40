"""The straight edges of many polylines with a tree of their boxes, for all who ask which edges are near."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from wallkit.geometry.arrays import FloatArray, IntArray
from wallkit.geometry.ragged import AT_ONCE, numbered, portions, slices
from wallkit.geometry.rings import signed_areas
from wallkit.walls.near_boxes import NearBoxes

_RUN = 8  # edges at most: long enough that runs are few, short enough that their boxes are small
_FIRST_PORTION = 16  # runs; the next portions are as large as the pairs found let expect
_PAIRS_AT_ONCE = 200_000  # about so many a portion: bounds the memory


@dataclass(eq=False, repr=False)
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
        return self._at_starts(self.following)

    @cached_property
    def wall(self) -> IntArray:
        """(E,) the polyline each edge belongs to."""
        return self._at_starts(self.wall_of)

    @cached_property
    def wall_of(self) -> IntArray:
        """(V,) the polyline each vertex belongs to."""
        return np.repeat(np.arange(len(self.closed)), np.diff(self.offsets))

    @cached_property
    def a(self) -> FloatArray:
        """(E, 2) start points."""
        return self._at_starts(self.vertices)

    @cached_property
    def b(self) -> FloatArray:
        """(E, 2) end points."""
        return self.vertices[self.stop]

    def starts_of(self, rows: IntArray) -> FloatArray:
        """(n, 2) the points that edges ``rows`` start at."""
        return self.vertices.take(self.start[rows], axis=0)

    def stops_of(self, rows: IntArray) -> FloatArray:
        """(n, 2) the points that edges ``rows`` end at; ``b`` is fresh memory for those of all."""
        return self.vertices.take(self.stop[rows], axis=0)

    def portions(self) -> Iterator[tuple[int, int, Edges]]:
        """The edges of some polylines after others: the first polyline and the first edge of each portion, and it."""
        edge = 0
        for wall, stop in portions(self.offsets):
            first, last = int(self.offsets[wall]), int(self.offsets[stop])
            offsets, closed = self.offsets[wall : stop + 1] - first, self.closed[wall:stop]
            some = Edges(self.vertices[first:last], offsets, closed)
            yield wall, edge, some
            edge += len(some)

    def _at_starts(self, of_vertices: NDArray[Any]) -> NDArray[Any]:
        """Take of what vertices have what edges begin at: all of it, and no copy, where all polylines are closed."""
        return of_vertices if len(self.start) == len(of_vertices) else of_vertices[self.start]

    @cached_property
    def areas(self) -> FloatArray:
        """(W,) the signed area of each polyline, taken as a ring."""
        return signed_areas(self.vertices, None, self.offsets)

    @cached_property
    def size(self) -> float:
        """The largest absolute value of a coordinate; 0 without any."""
        return float(max(-self.vertices.min(initial=0.0), self.vertices.max(initial=0.0)))

    @cached_property
    def tree(self) -> EdgeTree:
        """The tree of all edges."""
        return EdgeTree(self, np.arange(len(self)))

    def near_pairs(self, rows: IntArray | None = None) -> Iterator[tuple[IntArray, IntArray]]:
        """All pairs of edges (first < second) whose boxes meet, neighbours along a polyline left out; in portions.

        Args:
            rows: (n,) the edges among which pairs are looked for, in rising order; all by default.
        """
        tree = self.tree if rows is None else EdgeTree(self, rows)
        for first, second in tree.pairs():
            joined = (self.stop[first] == self.start[second]) | (self.stop[second] == self.start[first])
            yield first[~joined], second[~joined]


class EdgeTree:
    """A tree of runs: up to _RUN edges one after the other along a polyline, which all go the same way in x and in y.

    Such edges lie corner to corner, so of one run no two boxes meet but those of neighbours, and there are several
    times fewer runs than edges. An edge without length is a run of its own; all are where runs would be nearly as many,
    or their boxes lie over one another, as of rings in rings.
    """

    def __init__(self, edges: Edges, rows: IntArray) -> None:
        """Make runs of the edges ``rows`` (n,), in rising order."""
        self.rows = rows
        self.low, self.high = np.empty((2, len(rows))), np.empty((2, len(rows)))
        way = np.empty(len(rows), dtype=np.int8)
        for some in slices(len(rows), AT_ONCE):
            a, b = edges.starts_of(rows[some]).T, edges.stops_of(rows[some]).T
            np.minimum(a, b, out=self.low[:, some])
            np.maximum(a, b, out=self.high[:, some])
            way[some] = np.where((a == b).all(axis=0), -1, 2 * (b[0] < a[0]) + (b[1] < a[1]))
        start, stop = edges.start, edges.stop
        if len(rows) < len(edges):
            start, stop = start[rows], stop[rows]
        self.first, self.goes_on = self._runs(way, stop[:-1] == start[1:])
        self.run_low, self.run_high = self._boxes()
        if not self._pay():
            self.first, self.goes_on = np.arange(len(rows)), np.zeros(len(rows), dtype=np.bool_)
            self.run_low, self.run_high = self.low, self.high
        self.sizes = np.diff(self.first, append=len(rows))
        self.tree = NearBoxes(self.run_low, self.run_high)

    def _boxes(self) -> tuple[FloatArray, FloatArray]:
        """Lowest and highest corner of each run: (2, m) each."""
        if not len(self.rows):
            return self.low, self.high
        return np.minimum.reduceat(self.low, self.first, 1), np.maximum.reduceat(self.high, self.first, 1)

    def _pay(self) -> bool:
        """Tell whether runs are fewer than half as many as edges, and few pairs of them are to be looked into.

        Two boxes of w by h, thrown into a large one of the area A, meet with the chance 4 w h / A.
        """
        count, runs = len(self.rows), len(self.first)
        if 2 * runs >= count:
            return False
        width, height = self.run_high - self.run_low
        all_width, all_height = self.high.max(axis=1) - self.low.min(axis=1)
        with np.errstate(over="ignore", invalid="ignore"):
            covered, area = float((width * height).sum()), float(all_width * all_height)
        return 4 * runs * covered < area * (count / _RUN)

    @staticmethod
    def _runs(way: NDArray[np.int8], follows: NDArray[np.bool_]) -> tuple[IntArray, NDArray[np.bool_]]:
        """Give the first edge of each run, and whether it goes on as the run before it, which was full.

        Args:
            way: (n,) which way each edge goes in x and in y, -1 for one without length.
            follows: (n - 1,) the edge after each begins where it ends.
        """
        turns = np.ones(len(way), dtype=np.bool_)
        turns[1:] = ~follows | (way[1:] != way[:-1]) | (way[1:] < 0)
        straight = np.flatnonzero(turns)
        which, rank = numbered(-(-np.diff(straight, append=len(way)) // _RUN))
        first = straight[which] + _RUN * rank
        return first, ~turns[first]

    def query(self, boxes: Any) -> tuple[IntArray, IntArray]:
        """Pairs of a shapely geometry, one of (m,), and an edge whose boxes meet: number of each, geometries rising."""
        import shapely

        x0, y0, x1, y1 = shapely.bounds(boxes).T
        return self.meeting(np.stack([x0, y0]), np.stack([x1, y1]))

    def meeting(self, low: FloatArray, high: FloatArray) -> tuple[IntArray, IntArray]:
        """Pairs of a box, one of (2, m) lowest and highest corners, and an edge whose box meets it, boxes rising."""
        source, run = self.tree.query(low, high)
        if len(self.first) == len(self.rows):
            return source, self.rows[run]
        which, edge = self._within(run, low[:, source], high[:, source])
        return source[which], self.rows[edge]

    def pairs(self) -> Iterator[tuple[IntArray, IntArray]]:
        """All pairs of edges (first < second) of different runs whose boxes meet, in portions.

        A run and the one that goes on as it did are left out: only neighbours meet there.
        """
        begin, portion = 0, _FIRST_PORTION
        while begin < len(self.first):
            one, two = self.tree.among(begin, begin + portion)
            found = len(one)
            begin += portion
            most = _PAIRS_AT_ONCE * len(self.first) // len(self.rows)
            portion = int(min(8 * portion, max(portion * most // max(found, 1), 1)))
            keep = one < two
            one, two = one[keep], two[keep]
            if len(self.first) == len(self.rows):
                yield self.rows[one], self.rows[two]
                continue
            same = (two == one + 1) & self.goes_on[two]
            for first, second in self._edges_of(one[~same], two[~same]):
                order = np.lexsort((second, first))
                yield self.rows[first[order]], self.rows[second[order]]

    def _edges_of(self, one: IntArray, two: IntArray) -> Iterator[tuple[IntArray, IntArray]]:
        """Edges whose boxes meet of pairs of runs: those of each first run that meet the second's box are compared."""
        pair, first = self._within(one, self.run_low[:, two], self.run_high[:, two])
        for begin in range(0, len(first), _PAIRS_AT_ONCE // _RUN):
            some = slice(begin, begin + _PAIRS_AT_ONCE // _RUN)
            which, second = self._within(two[pair[some]], self.low[:, first[some]], self.high[:, first[some]])
            yield first[some][which], second

    def _within(self, run: IntArray, low: FloatArray, high: FloatArray) -> tuple[IntArray, IntArray]:
        """Of the edges of each run (m,) those that meet a box from ``low`` to ``high`` (2, m): which box, the edge."""
        which, rank = numbered(self.sizes[run])
        edge = self.first[run][which] + rank
        meets = (self.low[0, edge] <= high[0, which]) & (self.high[0, edge] >= low[0, which])
        meets &= (self.low[1, edge] <= high[1, which]) & (self.high[1, edge] >= low[1, which])
        return which[meets], edge[meets]
