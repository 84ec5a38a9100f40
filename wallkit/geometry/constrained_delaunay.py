"""A triangulation of points that has given segments among its edges, without any new point.

It begins as the Delaunay triangulation (GEOS); a segment that is missing takes the place of the edges that it crosses:
they are flipped, one after the other, until none is left (S. W. Sloan, A fast algorithm for generating constrained
Delaunay triangulations, 1993). All questions of side are answered exactly, so that what comes out is a triangulation.
What the flips leave is no Delaunay triangulation beside the segments; where that matters, edges are turned until it is
(:func:`constrained`).
"""

from __future__ import annotations

import math
from collections import deque
from typing import NamedTuple

import numpy as np

from wallkit.geometry.arrays import FloatArray, IntArray
from wallkit.geometry.delaunay import SURE, delaunay, edge_keys
from wallkit.geometry.orientation import BOUND, exact_side, side

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
    corners, parts, missing = _begun(points, segments)
    if missing:
        flips = _Flips(points, corners, parts)
        for number in missing:
            flips.insert(int(segments[number, 0]), int(segments[number, 1]), number)
        corners = flips.corners()
    return _meshed(points, corners, parts)


def constrained(points: FloatArray, segments: IntArray, most: int) -> tuple[IntArray, IntArray] | None:
    """Give the constrained Delaunay triangulation, of the same as :func:`triangulate` takes.

    Each edge has a circle through its ends with no point in it that is seen from the edge, segments being opaque.

    Args:
        points: the outermost are ends of no segment.
        segments: ends of each.
        most: how many edges may be turned.

    Returns:
        (T, 3) corners, and (N, 2) the edges on segments, the smaller number first; None where it takes more turns.
    """
    corners, parts, missing = _begun(points, segments)
    if missing:
        flips = _Flips(points, corners, parts, most)
        for number in missing:
            flips.insert(int(segments[number, 0]), int(segments[number, 1]), number)
        flips.restore()
        if flips.left < 0:
            return None
        corners = flips.corners()
    return corners, np.array(list(parts), dtype=np.int64).reshape(-1, 2)


def _begun(points: FloatArray, segments: IntArray) -> tuple[IntArray, dict[Edge, int], list[int]]:
    """Give the Delaunay triangles, the segments among their edges by their number, and the segments that are not."""
    corners = _counter_clockwise(points, delaunay(points))
    edges = np.concatenate([corners[:, [1, 2]], corners[:, [2, 0]], corners[:, [0, 1]]])
    wanted = np.sort(segments, axis=1)
    there = np.isin(edge_keys(wanted, len(points)), edge_keys(edges, len(points)))
    known: dict[Edge, int] = dict(zip(map(tuple, wanted[there].tolist()), np.flatnonzero(there).tolist(), strict=True))
    return corners, known, np.flatnonzero(~there).tolist()


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

    def __init__(self, points: FloatArray, corners: IntArray, parts: dict[Edge, int], most: float = math.inf) -> None:
        """Take triangles, the edges on segments, and how many edges may be turned."""
        self._points = points
        self._at: list[tuple[float, float]] = [*map(tuple, points.tolist())]
        self._parts = parts
        self._suspect: list[Edge] = []  # edges of triangles that are new
        self.left = most  # below 0: more edges had to be turned
        begin, end = np.roll(corners, -1, axis=1).ravel().tolist(), np.roll(corners, -2, axis=1).ravel().tolist()
        self._apex: dict[Edge, int] = dict(zip(zip(begin, end, strict=True), corners.ravel().tolist(), strict=True))
        self._near: dict[int, int] = dict(zip(begin, end, strict=True))

    def corners(self) -> IntArray:
        """Give (T, 3) the corners of the triangles."""
        return np.array([(a, b, c) for (a, b), c in self._apex.items() if a < b and a < c], dtype=np.int64)

    def insert(self, a: int, b: int, number: int) -> None:
        """Make the segment from a to b an edge, or the edges of a chain where it passes through points."""
        waiting = [(a, b)]
        while waiting and self.left >= 0:
            self.left -= 1
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

    def restore(self) -> None:
        """Turn edges, but those on segments, until none has the opposite corner in the circle of a triangle (Lawson).

        Beside an edge of new triangles alone there can be one.
        """
        while self._suspect and self.left >= 0:
            left, right = self._suspect.pop()
            ahead, behind = self._apex.get((left, right), -1), self._apex.get((right, left), -1)
            if ahead < 0 or behind < 0 or (min(left, right), max(left, right)) in self._parts:
                continue
            if not self._sees_too_much(left, right, ahead, behind):
                continue
            if self._side(behind, ahead, left) <= 0 or self._side(behind, ahead, right) >= 0:
                continue
            self.left -= 1
            self._turn(left, right, ahead, behind)

    def _sees_too_much(self, left: int, right: int, ahead: int, behind: int) -> bool:
        """Tell whether the two angles that see an edge are more than a half turn, as in :func:`delaunay`."""
        (px, py), (qx, qy) = self._at[left], self._at[right]
        (ux, uy), (vx, vy) = self._at[ahead], self._at[behind]
        a, b, c, d = px - ux, py - uy, qx - ux, qy - uy
        e, f, g, h = px - vx, py - vy, qx - vx, qy - vy
        total = abs(a * d - b * c) * (e * g + f * h) + (a * c + b * d) * abs(e * h - f * g)
        if total >= 0:
            return False
        size = math.hypot(a, b) * math.hypot(c, d) * math.hypot(e, f) * math.hypot(g, h)
        return total < -SURE * size

    def _turn(self, left: int, right: int, ahead: int, behind: int) -> None:
        """Take the other diagonal of the two triangles at an edge."""
        del self._apex[left, right], self._apex[right, left]
        self._put(behind, right, ahead)
        self._put(ahead, left, behind)
        self._suspect += [(behind, right), (right, ahead), (ahead, left), (left, behind), (ahead, behind)]

    def _put(self, a: int, b: int, c: int) -> None:
        self._apex[a, b], self._apex[b, c], self._apex[c, a] = c, a, b
        self._near[a], self._near[b], self._near[c] = b, c, a

    def _side(self, a: int, b: int, c: int) -> int:
        """Tell the side, exactly where rounding might."""
        (ax, ay), (bx, by), (cx, cy) = self._at[a], self._at[b], self._at[c]
        left, right = (ax - cx) * (by - cy), (ay - cy) * (bx - cx)
        det = left - right
        if abs(det) >= BOUND * (abs(left) + abs(right)):
            return (det > 0) - (det < 0)
        return exact_side(self._at[a], self._at[b], self._at[c])

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
        while crossed and self.left >= 0:
            self.left -= 1
            left, right = crossed.popleft()
            ahead, behind = self._apex[left, right], self._apex[right, left]
            hollow = self._side(behind, ahead, left) <= 0 or self._side(behind, ahead, right) >= 0
            if hollow:
                crossed.append((left, right))
                continue
            self._turn(left, right, ahead, behind)
            if {ahead, behind} == {a, b} or a in (ahead, behind) or b in (ahead, behind):
                continue
            one, other = self._side(a, b, behind), self._side(a, b, ahead)
            if one * other < 0:
                crossed.append((ahead, behind) if other > 0 else (behind, ahead))
