"""A triangulation of points that has given segments among its edges, without any new point.

It begins as the Delaunay triangulation (GEOS); a segment that is missing takes the place of the edges that it crosses:
they are flipped, one after the other, until none is left (S. W. Sloan, A fast algorithm for generating constrained
Delaunay triangulations, 1993). All questions of side are answered exactly, so that what comes out is a triangulation.
"""

from __future__ import annotations

from collections import deque
from typing import NamedTuple

import numpy as np

from wallkit.geometry.arrays import FloatArray, IntArray
from wallkit.geometry.conforming_delaunay import delaunay
from wallkit.geometry.orientation import side

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

    Segments meet at their ends only, but for rounding: one that passes through a point, or crosses another one, is led
    through that point, or through the nearest end of the other one.
    """
    corners = _counter_clockwise(points, delaunay(points))
    edges = np.concatenate([corners[:, [1, 2]], corners[:, [2, 0]], corners[:, [0, 1]]])
    wanted = np.sort(segments, axis=1)
    there = np.isin(_keys(wanted, len(points)), _keys(np.sort(edges, axis=1), len(points)))
    parts: dict[Edge, int] = dict(zip(map(tuple, wanted[there].tolist()), np.flatnonzero(there).tolist(), strict=True))
    missing = np.flatnonzero(~there).tolist()
    if missing:
        flips = _Flips(points, corners, parts)
        for number in missing:
            flips.insert(int(wanted[number, 0]), int(wanted[number, 1]), number)
        corners = flips.corners()
    return _meshed(points, corners, parts)


def _keys(pairs: IntArray, count: int) -> IntArray:
    """One number for each pair of points of so many."""
    keys: IntArray = pairs[:, 0] * count + pairs[:, 1]
    return keys


def _counter_clockwise(points: FloatArray, corners: IntArray) -> IntArray:
    turn = side(points[corners[:, 0]], points[corners[:, 1]], points[corners[:, 2]])
    corners = np.where((turn < 0)[:, None], corners[:, [0, 2, 1]], corners)
    kept: IntArray = corners[turn != 0]
    return kept


def _meshed(points: FloatArray, corners: IntArray, parts: dict[Edge, int]) -> Mesh:
    """Find what is across each half-edge, and which segment it lies on."""
    count = len(points)
    begin, end = np.roll(corners, -1, axis=1).ravel(), np.roll(corners, -2, axis=1).ravel()
    key, back = begin * count + end, end * count + begin
    order = np.argsort(key)
    place = np.minimum(np.searchsorted(key[order], back), len(key) - 1)
    across = np.where(key[order][place] == back, order[place], -1)
    segment = np.full(len(key), -1, dtype=np.int64)
    if parts:
        ends = np.array(list(parts), dtype=np.int64)
        known, number = ends[:, 0] * count + ends[:, 1], np.array(list(parts.values()), dtype=np.int64)
        rank = np.argsort(known)
        lowest = np.minimum(key, back)
        place = np.minimum(np.searchsorted(known[rank], lowest), len(known) - 1)
        on = known[rank][place] == lowest
        segment[on] = number[rank][place][on]
    return Mesh(points, corners.ravel(), across, segment)


class _Flips:
    """A triangulation on its way: from each directed edge to the corner opposite, on the left of it."""

    def __init__(self, points: FloatArray, corners: IntArray, parts: dict[Edge, int]) -> None:
        self._points = points
        self._parts = parts
        self._apex: dict[Edge, int] = {}
        self._near: dict[int, int] = {}
        for a, b, c in corners.tolist():
            self._put(a, b, c)

    def corners(self) -> IntArray:
        """Give (T, 3) the corners of the triangles."""
        return np.array([(a, b, c) for (a, b), c in self._apex.items() if a < b and a < c], dtype=np.int64)

    def insert(self, a: int, b: int, number: int) -> None:
        """Make the segment from a to b an edge, or the edges of a chain where it passes through points."""
        waiting = [(a, b)]
        while waiting:
            a, b = waiting.pop()
            if (a, b) in self._apex or (b, a) in self._apex:
                self._parts.setdefault((min(a, b), max(a, b)), number)
                continue
            crossed, through = self._crossed(a, b)
            if through >= 0:
                waiting += [(a, through), (through, b)]
                continue
            self._flip(a, b, crossed)
            self._parts[min(a, b), max(a, b)] = number

    def _put(self, a: int, b: int, c: int) -> None:
        self._apex[a, b], self._apex[b, c], self._apex[c, a] = c, a, b
        self._near[a], self._near[b], self._near[c] = b, c, a

    def _side(self, a: int, b: int, c: int) -> int:
        p = self._points
        return int(side(p[a : a + 1], p[b : b + 1], p[c : c + 1])[0])

    def _crossed(self, a: int, b: int) -> tuple[deque[Edge], int]:
        """List the edges that the segment crosses, or give the point that it passes through, else -1."""
        right = self._near[a]
        for _ in range(len(self._near)):  # around a, until the triangle through which the segment leaves it
            left = self._apex.get((a, right), -1)
            if left < 0:  # a point inside has triangles all around; the frame's corners are in no segment
                break
            if (before := self._side(a, b, right)) == 0 and self._ahead(a, b, right):
                return deque(), right
            if before < 0 < self._side(a, b, left):
                break
            right = left
        found: deque[Edge] = deque()
        while True:
            if (min(left, right), max(left, right)) in self._parts:
                return found, min((left, right), key=lambda point: self._off(a, b, point))
            found.append((left, right))
            apex = self._apex[left, right]
            if apex == b:
                return found, -1
            turn = self._side(a, b, apex)
            if turn == 0:
                return found, apex
            left, right = (apex, right) if turn > 0 else (left, apex)

    def _ahead(self, a: int, b: int, point: int) -> bool:
        p = self._points
        return bool((p[point] - p[a]) @ (p[b] - p[a]) > 0.0)

    def _off(self, a: int, b: int, point: int) -> float:
        (ax, ay), (bx, by), (x, y) = self._points[[a, b, point]].tolist()
        return abs(float((bx - ax) * (y - ay) - (by - ay) * (x - ax)))

    def _flip(self, a: int, b: int, crossed: deque[Edge]) -> None:
        """Turn the edges crossed until none crosses the segment; one whose two triangles form a hollow waits."""
        while crossed:
            left, right = crossed.popleft()
            ahead, behind = self._apex[left, right], self._apex[right, left]
            hollow = self._side(behind, ahead, left) <= 0 or self._side(behind, ahead, right) >= 0
            if hollow:
                crossed.append((left, right))
                continue
            del self._apex[left, right], self._apex[right, left]
            self._put(behind, right, ahead)
            self._put(ahead, left, behind)
            if {ahead, behind} == {a, b} or a in (ahead, behind) or b in (ahead, behind):
                continue
            one, other = self._side(a, b, behind), self._side(a, b, ahead)
            if one * other < 0:
                crossed.append((ahead, behind) if other > 0 else (behind, ahead))
