"""A triangulation of points in a box as half-edges, changed at many places at once: points put in, edges turned."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from wallkit.geometry.arrays import FloatArray, IntArray
from wallkit.geometry.orientation import side

SURE = 2.0**-46
"""Of the product of four lengths: so far beyond a half turn, rounding is not what makes two angles so."""


class HalfEdges:
    """Triangles, counter-clockwise with y up. Half-edge 3 t + i is opposite corner i of triangle t.

    It leads from the corner after to the corner before it. Changes keep numbers where they can; what leads between
    other points afterwards is said.

    Attributes:
        points: (P, 2); the last four are the corners of a box around all, counter-clockwise from the lowest.
        corner: (3 T,) point at each corner.
        across: (3 T,) half-edge of the neighbour, -1 on the border.
        label: (3 T,) number of the segment that a half-edge lies on, the same on both sides, or -1.
        count: triangles so far; rows from there on are room for more.
        turned: edges turned so far.
        waiting: (n,) points to be put in.
        home: (n,) the triangle that each of them is in, or on the border of.
    """

    def __init__(self, points: FloatArray) -> None:
        """Begin with the box, and all other points waiting, in an order by chance."""
        self.points = points
        self.corner, self.across, self.label = np.full((3, 3 * (2 * len(points) - 6)), -1)
        first = len(points) - 4
        self.corner[:6] = first + np.array([0, 1, 2, 0, 2, 3])
        self.across[[1, 5]] = 5, 1
        self.count, self.turned = 2, 0
        self._random = np.random.default_rng(0)  # any order is right
        self.waiting = self._random.permutation(first)
        box = np.broadcast_to(points[first:, None], (4, first, 2))
        self.home = (side(box[0], box[2], points[self.waiting]) > 0).astype(np.int64)
        self._follow(len(self.corner))

    def _follow(self, size: int) -> None:
        """Number the corners after and before each; and make room for marks."""
        rows = np.arange(size)
        self.after, self.before = rows + np.tile([1, 1, -2], size // 3), rows + np.tile([2, -1, -1], size // 3)
        self._place, self._mark = rows.copy(), np.full(size, -1)

    def rest(self) -> None:
        """Forget what only changes need, four of its seven columns; ``grow`` makes its own."""
        del self.after, self.before, self._place, self._mark

    def grow(self, points: FloatArray) -> HalfEdges:
        """Give the same with (n, 2) more points, before the last four, and room for their triangles."""
        new, more = HalfEdges.__new__(HalfEdges), len(points)
        first = len(self.points) - 4
        new.points = np.concatenate([self.points[:first], points, self.points[first:]])
        used = 3 * self.count
        new.corner, new.across, new.label = np.full((3, 3 * (2 * len(new.points) - 6)), -1)
        new.corner[:used] = self.corner[:used] + more * (self.corner[:used] >= first)
        new.across[:used], new.label[:used] = self.across[:used], self.label[:used]
        new.count, new.turned, new._random = self.count, 0, self._random
        new.waiting = new.home = np.empty(0, dtype=np.int64)
        new._follow(len(new.corner))
        return new

    def alone(self, *sets: IntArray) -> NDArray[np.bool_]:
        """Choose rows, (n,) numbers of each set, so that none of those chosen shares a number: some, if there are any.

        Row by row writes its name on its numbers; who finds it on all of them afterwards is chosen, as the last is.
        """
        names = np.arange(len(sets[0]))
        self._mark[np.stack(sets, axis=1).ravel()] = np.repeat(names, len(sets))
        chosen = np.ones(len(names), dtype=np.bool_)
        for numbers in sets:
            chosen &= self._mark[numbers] == names
        return chosen

    def split(self, h: IntArray, point: IntArray) -> IntArray:
        """Put points (n,) into the triangles of half-edges (n,), each triangle once: (3, n) the edges around them.

        A point may be on the half-edge itself: its triangle there is flat until that is turned.
        """
        n, m = self.after[h], self.before[h]
        a, p, q = self.corner[h], self.corner[n], self.corner[m]
        one = 3 * (self.count + np.arange(len(h)))
        two = one + 3 * len(h)
        self.count += 2 * len(h)
        beyond = np.concatenate([self.across[n], self.across[m]]), np.concatenate([self.label[n], self.label[m]])
        self.corner[h] = point
        self.corner[one], self.corner[one + 1], self.corner[one + 2] = a, point, q
        self.corner[two], self.corner[two + 1], self.corner[two + 2] = a, p, point
        self._move(np.concatenate([n, m]), np.concatenate([one + 1, two + 2]), *beyond)
        for here, there in ((n, one), (m, two), (one + 2, two + 1)):
            self.across[here], self.across[there] = there, here
            self.label[here] = self.label[there] = -1
        if len(self.waiting):
            self._rehome_split(h // 3, point, a, p, q, one // 3)
        return np.stack([h, one + 1, two + 2])

    def _move(self, old: IntArray, new: IntArray, beyond: IntArray, label: IntArray) -> None:
        """Let what was across half-edges ``old`` be across ``new``; it may be one of ``old`` itself."""
        self._place[old] = new
        beyond = np.where(beyond >= 0, self._place[beyond], -1)
        self._place[old] = old
        self.across[new], self.label[new] = beyond, label
        inner = beyond >= 0
        self.across[beyond[inner]] = new[inner]

    def flip(self, h: IntArray) -> IntArray:
        """Take the other diagonal of the two triangles at half-edges (n,), each triangle once: (4, n) their borders.

        With a opposite p q on one side and b on the other: triangles a p b and b q a.
        """
        g = self.across[h]
        n, m, gn, gm = self.after[h], self.before[h], self.after[g], self.before[g]
        a, b = self.corner[h], self.corner[g]
        old = np.concatenate([gn, n])
        beyond, label = self.across[old], self.label[old]
        self.corner[m], self.corner[gm] = b, a
        self._move(old, np.concatenate([h, g]), beyond, label)
        self.across[n], self.across[gn] = gn, n
        self.label[n] = self.label[gn] = -1
        self.turned += len(h)
        if len(self.waiting):
            self._rehome_flipped(h // 3, g // 3, a, b)
        return np.stack([h, m, g, gm])

    def _rehome_split(
        self, triangle: IntArray, point: IntArray, a: IntArray, p: IntArray, q: IntArray, one: IntArray
    ) -> None:
        """Find the new triangles of waiting points: between p and q, q and a, or a and p around the new point."""
        rows, k = self._waiting_in(triangle)
        x, centre = self.points[self.waiting[rows]], self.points[point[k]]
        by_p, by_q, by_a = (side(centre, self.points[end[k]], x) for end in (p, q, a))
        first = (by_p >= 0) & (by_q <= 0)
        second = ~first & (by_q >= 0) & (by_a <= 0)
        self.home[rows] = np.where(first, triangle[k], np.where(second, one[k], one[k] + len(triangle)))

    def _rehome_flipped(self, t: IntArray, u: IntArray, a: IntArray, b: IntArray) -> None:
        rows, k = self._waiting_in(np.concatenate([t, u]))
        k = k % max(len(t), 1)
        left = side(self.points[a[k]], self.points[b[k]], self.points[self.waiting[rows]]) > 0
        self.home[rows] = np.where(left, u[k], t[k])

    def _waiting_in(self, triangle: IntArray) -> tuple[IntArray, IntArray]:
        """Rows of waiting points that are in one of some triangles, and in the how manieth."""
        self._mark[: self.count] = -1
        self._mark[triangle] = np.arange(len(triangle))
        k = self._mark[self.home]
        rows = np.flatnonzero(k >= 0)
        return rows, k[rows]

    def legalise(self, suspects: IntArray) -> None:
        """Turn edges without label until none has the opposite corner in the circle of a triangle.

        Among half-edges that are no suspects none has (C. L. Lawson, Software for C1 surface interpolation, 1977).
        All turns are sure, and each lowers the surface that the triangles make of x^2 + y^2: there is an end.
        """
        while len(suspects):
            g = self.across[suspects]
            h = np.minimum(suspects, g)[(g >= 0) & (self.label[suspects] < 0)]
            h = h[self.alone(h)]
            h = self._random.permutation(h[self._sees_too_much(h)])
            free = self.alone(h // 3, self.across[h] // 3)
            suspects = np.concatenate([h[~free], self.flip(h[free]).ravel()])

    def _sees_too_much(self, h: IntArray) -> NDArray[np.bool_]:
        """Tell where the two angles that see an edge are more than a half turn: the circles hold each other's corner.

        sin(a + b) = sin a cos b + cos a sin b < 0, from cross and dot products, off by some 2^-50 of the lengths. Where
        all four corners are nearly on one line that is 0; there both angles are obtuse.
        """
        g = self.across[h]
        x, y = self.points[:, 0], self.points[:, 1]
        first, last = self.corner[self.after[h]], self.corner[self.before[h]]
        px, py, qx, qy = x[first], y[first], x[last], y[last]
        (sine, cosine, size), (other_sine, other_cosine, other_size) = (
            _angle(px - x[seen], py - y[seen], qx - x[seen], qy - y[seen]) for seen in (self.corner[h], self.corner[g])
        )
        wrong: NDArray[np.bool_] = sine * other_cosine + cosine * other_sine < -SURE * size * other_size
        wrong |= (cosine < -SURE * size) & (other_cosine < -SURE * other_size)
        return wrong


def _angle(a: FloatArray, b: FloatArray, c: FloatArray, d: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Sine and cosine of the angle between vectors (a, b) and (c, d), times their lengths, and the product of these."""
    return np.abs(a * d - b * c), a * c + b * d, np.sqrt((a * a + b * b) * (c * c + d * d))
