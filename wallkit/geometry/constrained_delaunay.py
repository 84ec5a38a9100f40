"""The constrained Delaunay triangulation of points and segments, without any new point.

Each edge has a circle through its ends with no point in it that is seen from the edge, segments being opaque. It begins
as the Delaunay triangulation; a segment that is missing takes the place of all edges that it crosses at once, and what
is left and right of it is triangulated anew. Segments come in an order by chance: then even those that cross the same
edges are n log^2 n steps together (J. R. Shewchuk and B. C. Brown, Fast segment insertion and incremental construction
of constrained Delaunay triangulations, 2015). All questions of side are answered exactly.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from wallkit.geometry.arrays import FloatArray, IntArray, distinct
from wallkit.geometry.cavities import Triangle, filled
from wallkit.geometry.delaunay import delaunay
from wallkit.geometry.half_edges import HalfEdges
from wallkit.geometry.orientation import side_of

Edge = tuple[int, int]


class Mesh(NamedTuple):
    """Triangles, counter-clockwise with y up. Half-edge 3 t + i is the edge opposite corner i of triangle t.

    Attributes:
        points: (P, 2).
        corners: (3 T,) point at each corner, triangle by triangle.
        across: (3 T,) half-edge of the neighbour at each half-edge, -1 on the border.
        segment: (3 T,) the segment that a half-edge lies on, or -1.
    """

    points: FloatArray
    corners: IntArray
    across: IntArray
    segment: IntArray


def triangulate(points: FloatArray, segments: IntArray) -> Mesh:
    """Triangulate (P, 2) different points, with the (S, 2) segments among the edges.

    The last four points are the corners of a box around all, counter-clockwise from the lowest, and ends of no segment.
    Segments meet at their ends only, but for rounding: one that passes through a point, or crosses another one, is led
    through that point, or through the nearest end of the other one.
    """
    mesh = constrained(points, segments)
    assert mesh is not None  # without a limit
    return Mesh(points, mesh.corner, mesh.across, mesh.label)


def constrained(points: FloatArray, segments: IntArray, most: float = math.inf) -> HalfEdges | None:
    """Do the same, and label edges with the number of the segment; None where segments cross more edges than ``most``.

    Args:
        points: as above.
        segments: ends of each.
        most: how many edges may give way.
    """
    mesh = delaunay(points)
    missing = _label(mesh, segments)
    if not len(missing):
        return mesh
    insertion = _Insertion(mesh, most)
    for number in np.random.default_rng(0).permutation(missing).tolist():
        insertion.insert(int(segments[number, 0]), int(segments[number, 1]), number)
    if insertion.left < 0:
        return None
    insertion.finish()
    return mesh


def _label(mesh: HalfEdges, segments: IntArray) -> IntArray:
    """Label the segments that are edges, of those that are the same the first; give the numbers of the others."""
    count = len(mesh.points)
    begin, end = mesh.corner[mesh.after], mesh.corner[mesh.before]
    h = np.flatnonzero(begin < end)
    key = begin[h] * count + end[h]
    order = np.argsort(key)
    h, key = h[order], key[order]
    wanted = segments.min(axis=1) * count + segments.max(axis=1)
    place = np.minimum(np.searchsorted(key, wanted), len(key) - 1)
    there = key[place] == wanted
    number = np.flatnonzero(there)[::-1]
    mesh.label[h[place[number]]] = number
    inner = h[mesh.label[h] >= 0]
    mesh.label[mesh.across[inner]] = mesh.label[inner]
    return np.flatnonzero(~there)


class _Insertion:
    """Segments on their way into a triangulation, whose arrays are lists meanwhile."""

    def __init__(self, mesh: HalfEdges, most: float) -> None:
        """Take how many edges may be crossed."""
        self._mesh = mesh
        self._at: list[tuple[float, float]] = [*map(tuple, mesh.points.tolist())]
        self._corner, self._across = mesh.corner.tolist(), mesh.across.tolist()
        self._label = mesh.label.tolist()
        slot = np.zeros(len(mesh.points), dtype=np.int64)
        slot[mesh.corner] = np.arange(len(mesh.corner))
        self._slot: list[int] = slot.tolist()  # of each point, one corner of a triangle
        self._changed: list[int] = []
        self.left = most  # below 0: more edges had to give way

    def finish(self) -> None:
        """Write the arrays, and turn edges where rounding has left some to be turned."""
        mesh = self._mesh
        mesh.corner[:], mesh.across[:], mesh.label[:] = self._corner, self._across, self._label
        changed = distinct(np.array(self._changed, dtype=np.int64))
        mesh.legalise((3 * changed[:, None] + np.arange(3)).ravel())

    def insert(self, a: int, b: int, number: int) -> None:
        """Make the segment from a to b an edge, or the edges of a chain where it passes through points."""
        waiting = [(a, b)]
        while waiting and self.left >= 0:
            self.left -= 1
            a, b = waiting.pop()
            crossed, through = self._crossed(a, b)
            self.left -= len(crossed)
            if through >= 0:
                waiting += [(a, through), (through, b)] if through not in (a, b) else []
            elif crossed:
                self._clear(a, b, crossed, number)
            else:
                self._label_edge(a, b, number)

    def _around(self, a: int) -> list[int]:
        """The corners of triangles at a point inside the box, counter-clockwise."""
        first = slot = self._slot[a]
        found = []
        while True:
            found.append(slot)
            slot = _after(self._across[_after(slot)])
            if slot == first:
                return found

    def _label_edge(self, a: int, b: int, number: int) -> None:
        """Label an edge, if it has no label."""
        for slot in self._around(a):
            h = _before(slot)  # from a to the corner after it
            if self._corner[_after(slot)] == b and self._label[h] < 0:
                self._label[h] = self._label[self._across[h]] = number

    def _crossed(self, a: int, b: int) -> tuple[list[int], int]:
        """List the half-edges that the segment crosses, each as seen from a, or give a point that it passes through.

        Returns:
            The half-edges, none where it is an edge; and that point, else -1.
        """
        h = -1
        for slot in self._around(a):
            right, left = self._corner[_after(slot)], self._corner[_before(slot)]
            if b in (right, left):
                return [], -1
            turn = self._side(a, b, right)
            if turn == 0 and self._ahead(a, b, right):
                return [], right
            if turn < 0 < self._side(a, b, left):
                h = slot
                break
        found: list[int] = []
        while True:
            right, left = self._corner[_after(h)], self._corner[_before(h)]
            if self._label[h] >= 0:
                return found, min((left, right), key=lambda point: self._off(a, b, point))
            found.append(h)
            g = self._across[h]
            apex = self._corner[g]
            if apex == b:
                return found, -1
            turn = self._side(a, b, apex)
            if turn == 0:
                return found, apex
            h = _after(g) if turn > 0 else _before(g)

    def _clear(self, a: int, b: int, crossed: list[int], number: int) -> None:
        """Triangulate anew what is left and right of a segment that crosses half-edges.

        The edges that stay are kept by their ends; one that hangs in the cavity is there twice, from both sides.
        """
        right, left = [self._corner[_after(crossed[0])]], [self._corner[_before(crossed[0])]]
        border = {(a, right[0]): _before(crossed[0]), (left[0], a): _after(crossed[0])}
        triangles = [crossed[0] // 3]
        for h, following in zip(crossed, [*crossed[1:], -1], strict=True):
            g = self._across[h]
            triangles.append(g // 3)
            apex = self._corner[g]
            if following != _after(g):  # the apex is b, or on the right
                border[right[-1], apex] = _after(g)
                right += [apex]
            if following != _before(g):
                border[apex, left[-1]] = _before(g)
                left += [apex]
        kept = {edge: (self._across[h], self._label[h]) for edge, h in border.items()}
        new = filled(self._at, a, b, left[-2::-1]) + filled(self._at, b, a, right[:-1])
        self._put(triangles, new, kept)
        for slot in self._around(a):
            if self._corner[_after(slot)] == b:
                self._label[_before(slot)] = self._label[self._across[_before(slot)]] = number
        self._changed += triangles

    def _put(self, numbers: list[int], triangles: list[Triangle], kept: dict[Edge, tuple[int, int]]) -> None:
        """Write triangles under numbers, joined to one another and to what is around them."""
        inner: dict[Edge, int] = {}
        for number, corners in zip(numbers, triangles, strict=True):
            for i, point in enumerate(corners):
                h = 3 * number + i
                self._corner[h], self._slot[point] = point, h
                inner[corners[(i + 1) % 3], corners[(i + 2) % 3]] = h
        for (p, q), h in inner.items():
            across, self._label[h] = kept.get((p, q), (-1, -1))
            self._across[h] = inner.get((q, p), across)
            if self._across[h] >= 0:
                self._across[self._across[h]] = h

    def _side(self, a: int, b: int, c: int) -> int:
        return side_of(self._at[a], self._at[b], self._at[c])

    def _ahead(self, a: int, b: int, point: int) -> bool:
        (ax, ay), (bx, by), (x, y) = self._at[a], self._at[b], self._at[point]
        return (x - ax) * (bx - ax) + (y - ay) * (by - ay) > 0.0

    def _off(self, a: int, b: int, point: int) -> float:
        (ax, ay), (bx, by), (x, y) = self._at[a], self._at[b], self._at[point]
        return abs((bx - ax) * (y - ay) - (by - ay) * (x - ax))


def _after(h: int) -> int:
    return h + 1 if h % 3 < 2 else h - 2


def _before(h: int) -> int:
    return h - 1 if h % 3 else h + 2
