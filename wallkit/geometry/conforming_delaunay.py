"""A Delaunay triangulation of wall vertices that has every wall edge among its edges, cut where need be."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import shapely
from numpy.typing import NDArray

from wallkit.geometry.arrays import FloatArray, IntArray
from wallkit.geometry.orientation import side
from wallkit.geometry.same_points import SAME, merged

MOST_POINTS = 30_000  # that walls may be cut to, and MOST_CUTS more for each piece that is given
MOST_CUTS = 2
_ROUNDS = 40
SHORTEST = 1e-7  # of the size of everything: shorter pieces of walls are not cut further, and may be no edges
_MOST_LOOKED_AT = 1_000_000  # points, in all rounds for ties together
_TIES = 20  # rounds for points on one circle, whose triangles are a matter of taste; feet make many
_FLAT = 1 / 8  # of a segment: with an intruder nearer than that it is halved
_MANY = 2**31  # more points than there can be
_FLIPS = 8  # rounds of taking the other diagonal
_TURNS = 40  # rounds of the same where triangles are none of Delaunay's; four or so are enough
_SURE = 2.0**-46  # of the product of four lengths: so far beyond a half turn, rounding is not what makes it so
_FRAME = 4.0  # the frame around everything, in diagonals: far enough to count as outside


@dataclass(slots=True)
class Triangulation:
    """Triangles of points, the walls among their edges.

    Attributes:
        points: (P, 2); the last four are the frame.
        corners: (T, 3) points of each triangle.
        neighbours: (T, 3) the triangle opposite each corner, or -1.
        edge: (T, 3) number of the edge opposite each corner.
        ends: (N, 2) points of each edge, the smaller number first.
        wall: (N,) the edge is a piece of a wall.
        outer: (N,) the edge is on the frame.
        given: how many points, the first, are ends of given segments.
        cut: the pieces of walls, to be cut further.
    """

    points: FloatArray
    corners: IntArray
    neighbours: IntArray
    edge: IntArray
    ends: IntArray
    wall: NDArray[np.bool_]
    outer: NDArray[np.bool_]
    given: int
    cut: _Cut


def triangulate(a: FloatArray, b: FloatArray) -> Triangulation | None:
    """Triangulate segments from ``a`` to ``b``, (n, 2) each, that meet at their ends only; None for a tangle.

    Every piece of a segment is an edge then, but for pieces of 2e-7 of the whole and less. A tangle is what is not
    done in 40 rounds of cuts, or with 30,000 points and two more for each segment.

    A segment is an edge of the triangulation when the circle over it is empty. A point in the circle cuts the
    segment: at its foot; but at its own distance from the shared end when a segment leads from there to it, since
    cuts at feet would chase each other into the corner for ever (J. Ruppert, A Delaunay refinement algorithm,
    1995, on small angles).
    """
    points, which = np.unique(np.concatenate([a, b]), axis=0, return_inverse=True)
    low, high = points.min(axis=0), points.max(axis=0)
    origin, size = (low + high) / 2, float(np.hypot(*(high - low))) or 1.0
    which = merged(points)[which.reshape(-1)]
    kept, which = np.unique(which, return_inverse=True)
    points = points[kept]
    segments = np.sort(which.reshape(2, -1).T, axis=1)
    segments = np.unique(segments[segments[:, 0] != segments[:, 1]], axis=0)
    owner, nowhere = np.arange(len(segments)), np.full(len(points), -1)
    pairs = np.sort(_keys(segments, _MANY))
    return _triangulated(_Cut(points - origin, segments, owner, segments, pairs, nowhere, points, origin, size))


def cut_further(mesh: Triangulation, edge: IntArray, at: FloatArray) -> Triangulation | None:
    """Triangulate once more, with (n, 2) places ``at`` on edges that are pieces of walls among the points."""
    work = replace(mesh.cut)
    work.split_often(mesh.ends[edge], at - work.origin, SAME * work.size)
    return _triangulated(work)


def _triangulated(work: _Cut) -> Triangulation | None:
    """Triangulate pieces of segments, cut as far as need be; None for a tangle."""
    size = work.size
    frame = _FRAME * size * np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]])
    looked_at = 0
    for _ in range(_TIES):
        if not _conform(work, SHORTEST * size, SAME * size):
            return None
        everything = np.concatenate([work.points, frame])
        looked_at += len(everything)
        count = len(everything)
        corners = _with_diagonals(delaunay(everything), everything, _keys(work.segments, count))
        sides = np.stack([corners[:, [1, 2]], corners[:, [2, 0]], corners[:, [0, 1]]], axis=1)
        keys, edge = np.unique(_keys(sides.reshape(-1, 2), count), return_inverse=True)
        walls = _keys(work.segments, count)
        length = np.hypot(*(work.points[work.segments[:, 0]] - work.points[work.segments[:, 1]]).T)
        missing = ~np.isin(walls, keys) & (length > 2 * SHORTEST * size)
        if not missing.any():
            break
        if looked_at > _MOST_LOOKED_AT:
            return None
        # of many points on one circle other diagonals were taken: the wall gets a point in its middle
        work.split(missing, work.points[work.segments[missing]].mean(axis=1))
    else:
        return None
    edge = edge.reshape(-1, 3)
    neighbours = _neighbours(edge)
    outer = np.zeros(len(keys), dtype=np.bool_)
    outer[edge[neighbours < 0]] = True
    ends = np.stack(np.divmod(keys, count), axis=1)
    given = len(work.given)
    everything += work.origin
    everything[:given] = work.given  # to the bit
    return Triangulation(everything, corners, neighbours, edge, ends, np.isin(keys, walls), outer, given, work)


def delaunay(points: FloatArray) -> IntArray:
    """The corners of the Delaunay triangles of points that are all different: (T, 3).

    By GEOS, which takes many points on one circle or line as they come. Where points are nearly on one line, as feet
    on a wall are, some of its triangles have others in their circles: those edges are turned until none has (C. L.
    Lawson, Software for C1 surface interpolation, 1977).
    """
    rings = shapely.get_coordinates(shapely.get_parts(shapely.delaunay_triangles(shapely.multipoints(points))))
    z = points[:, 0] + 1j * points[:, 1]
    order = np.argsort(z)
    found = rings.reshape(-1, 4, 2)[:, :3]
    corners: IntArray = order[np.searchsorted(z, found[..., 0] + 1j * found[..., 1], sorter=order)]
    for _ in range(_TURNS):
        inner = _Inner.of(corners, len(points))
        wrong = inner.sees_too_much(points)
        turned = inner.turned(corners, points, wrong) if wrong.any() else None
        if turned is None:
            break
        corners = turned
    return corners


def _with_diagonals(corners: IntArray, points: FloatArray, walls: IntArray) -> IntArray:
    """Where two triangles have four corners on one circle, take the diagonal that is a wall (given by its key)."""
    for _ in range(_FLIPS):
        inner = _Inner.of(corners, len(points))
        across = _keys(np.stack([inner.apex, inner.opposite], axis=1), len(points))
        turned = inner.turned(corners, points, np.isin(across, walls) & ~np.isin(inner.keys, walls))
        if turned is None:
            break
        corners = turned
    return corners


@dataclass(slots=True)
class _Inner:
    """Edges between two triangles, arrays of one length.

    Attributes:
        keys: the edge's.
        one: the first triangle, times 3, and which of its corners is opposite.
        two: the same of the second.
        p: an end.
        q: the other end.
        apex: the corner of the first triangle that is opposite.
        opposite: that of the second.
    """

    keys: IntArray
    one: IntArray
    two: IntArray
    p: IntArray
    q: IntArray
    apex: IntArray
    opposite: IntArray

    @classmethod
    def of(cls, corners: IntArray, count: int) -> _Inner:
        sides = np.stack([corners[:, [1, 2]], corners[:, [2, 0]], corners[:, [0, 1]]], axis=1).reshape(-1, 2)
        keys = _keys(sides, count)
        order = np.argsort(keys, kind="stable")
        same = np.flatnonzero(keys[order][1:] == keys[order][:-1])
        one, two = order[same], order[same + 1]
        p, q = sides[one].T
        return cls(keys[one], one, two, p, q, corners.ravel()[one], corners.ravel()[two])

    def sees_too_much(self, points: FloatArray) -> NDArray[np.bool_]:
        """Tell where the two angles that see an edge are more than a half turn: the circles hold each other's corner.

        sin(a + b) = sin a cos b + cos a sin b < 0, from cross and dot products, off by some 2^-50 of the lengths.
        """
        p, q = points[self.p], points[self.q]
        (sine, cosine, size), (other_sine, other_cosine, other_size) = (
            _angle(p - points[seen], q - points[seen]) for seen in (self.apex, self.opposite)
        )
        wrong: NDArray[np.bool_] = sine * other_cosine + cosine * other_sine < -_SURE * size * other_size
        return wrong

    def turned(self, corners: IntArray, points: FloatArray, wanted: NDArray[np.bool_]) -> IntArray | None:
        """Take the other diagonal where that is wanted and can be, each triangle once; None where there is none."""
        one, two, p, q, apex, opposite = (
            part[wanted] for part in (self.one, self.two, self.p, self.q, self.apex, self.opposite)
        )
        convex = side(points[apex], points[opposite], points[p]) * side(points[apex], points[opposite], points[q]) < 0
        t = np.stack([one // 3, two // 3], axis=1)[convex]
        first = np.full(len(corners), len(t))
        np.minimum.at(first, t.ravel(), np.repeat(np.arange(len(t)), 2))
        alone = (first[t] == np.arange(len(t))[:, None]).all(axis=1)
        if not alone.any():
            return None
        rows = np.flatnonzero(convex)[alone]
        corners = corners.copy()
        corners[t[alone, 0]] = np.stack([apex[rows], opposite[rows], p[rows]], axis=1)
        corners[t[alone, 1]] = np.stack([opposite[rows], apex[rows], q[rows]], axis=1)
        return corners


def _angle(u: FloatArray, v: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Sine and cosine of the angle between vectors, times their lengths, and the product of these."""
    size = np.hypot(*u.T) * np.hypot(*v.T)
    return np.abs(u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]), (u * v).sum(axis=1), size


def _neighbours(edge: IntArray) -> IntArray:
    """The triangle on the other side of each edge of each triangle, -1 without one: (T, 3)."""
    order = np.argsort(edge.ravel(), kind="stable")
    same = edge.ravel()[order][1:] == edge.ravel()[order][:-1]
    one, two = order[:-1][same], order[1:][same]
    beyond = np.full(edge.size, -1, dtype=np.int64)
    beyond[one], beyond[two] = two // 3, one // 3
    return beyond.reshape(-1, 3)


def _most_points(work: _Cut) -> int:
    return MOST_POINTS + MOST_CUTS * len(work.original)


@dataclass(slots=True)
class _Cut:
    """Segments on their way to be edges, each a piece of an original one.

    Attributes:
        points: (P, 2).
        segments: (S, 2) ends.
        owner: (S,) the original segment that each is a piece of.
        original: (O, 2) ends of the original segments.
        pairs: (O,) the same as numbers in rising order.
        of_point: (P,) the original segment that a point was put on, or -1.
        given: (G, 2) the first of the points where they were given.
        origin: (2,) what was taken off all points, for the sake of their digits.
        size: of everything.
    """

    points: FloatArray
    segments: IntArray
    owner: IntArray
    original: IntArray
    pairs: IntArray
    of_point: IntArray
    given: FloatArray
    origin: FloatArray
    size: float

    def split(self, where: NDArray[np.bool_], at: FloatArray, known: IntArray | None = None) -> None:
        """Cut the segments ``where`` at new points, one each, or at the points ``known`` where that is not -1."""
        cut, owner = self.segments[where], self.owner[where]
        new = np.ones(len(cut), dtype=np.bool_) if known is None else known < 0
        number = len(self.points) + np.cumsum(new) - 1
        if known is not None:
            number = np.where(new, number, known)
        self.points = np.concatenate([self.points, at[new]])
        self.of_point = np.concatenate([self.of_point, owner[new]])
        halves = [np.stack([cut[:, 0], number], axis=1), np.stack([number, cut[:, 1]], axis=1)]
        self.segments = np.concatenate([self.segments[~where], *halves])
        self.owner = np.concatenate([self.owner[~where], owner, owner])

    def split_often(self, ends: IntArray, at: FloatArray, same: float) -> None:
        """Cut the segments with these ends, (n, 2), at new points, any number each; points as near as same are one."""
        keys = _keys(self.segments, len(self.points))
        order = np.argsort(keys)
        on = order[np.searchsorted(keys, _keys(ends, len(self.points)), sorter=order)]
        p, q = (self.points[self.segments[:, k]] for k in (0, 1))
        d = q - p
        length = np.hypot(*d.T)
        along = ((at - p[on]) * d[on]).sum(axis=1) / length[on]
        order = np.lexsort((along, on))
        on, at, along = on[order], at[order], along[order]
        again = np.append(False, (on[1:] == on[:-1]) & (along[1:] - along[:-1] <= same))
        new = ~again & (along > same) & (along < length[on] - same)
        on, at, along = on[new], at[new], along[new]
        rows, number = np.arange(len(self.segments)), len(self.points) + np.arange(len(on))
        row = np.concatenate([rows, on, rows])
        order = np.lexsort((np.concatenate([np.full(len(rows), -1.0), along, length + 1]), row))
        row = row[order]
        vertex = np.concatenate([self.segments[:, 0], number, self.segments[:, 1]])[order]
        joined = row[1:] == row[:-1]
        self.points = np.concatenate([self.points, at])
        self.of_point = np.concatenate([self.of_point, self.owner[on]])
        self.segments = np.stack([vertex[:-1][joined], vertex[1:][joined]], axis=1)
        self.owner = self.owner[row[:-1][joined]]


def _conform(work: _Cut, shortest: float, same: float) -> bool:
    """Cut segments until no point lies in the circle over one of them; tell whether that came to an end.

    A segment is looked at once against all points, and after that against the points that each round adds.
    """
    from scipy.spatial import cKDTree

    unsure = np.ones(len(work.segments), dtype=np.bool_)
    for _ in range(_ROUNDS):
        points, rows = work.points, np.flatnonzero(unsure)
        segments = work.segments[rows]
        middle, half = _circles_over(points, segments)
        distance, nearest = cKDTree(points).query(middle, k=min(3, len(points)))
        own = (nearest == segments[:, :1]) | (nearest == segments[:, 1:])
        distance = np.where(own, np.inf, distance)
        column = distance.argmin(axis=1)
        each = np.arange(len(rows))
        pierced = (distance[each, column] < half * (1 - 1e-9)) & (half > shortest)
        if not pierced.any():
            return True
        if len(points) + int(pierced.sum()) > _most_points(work):
            break
        intruder = nearest[each, column][pierced]
        inside = np.zeros(len(unsure), dtype=np.bool_)
        inside[rows[pierced]] = True
        new = _cut_points(work, inside, intruder)
        touches = np.hypot(*(new - points[intruder]).T) <= same  # it lies on the segment, but for rounding
        work.split(inside, new, np.where(touches, intruder, -1))
        unsure = np.ones(len(work.segments), dtype=np.bool_)
        unsure[: np.count_nonzero(~inside)] = False
        added = work.points[len(points) :]
        if len(added):
            middle, half = _circles_over(work.points, work.segments)
            unsure |= cKDTree(added).query(middle)[0] < half
    return False


def _circles_over(points: FloatArray, segments: IntArray) -> tuple[FloatArray, FloatArray]:
    """Centres and radii of the circles that have segments as diameters."""
    p, q = points[segments[:, 0]], points[segments[:, 1]]
    return (p + q) / 2, np.hypot(*(q - p).T) / 2


def _cut_points(work: _Cut, inside: NDArray[np.bool_], intruder: IntArray) -> FloatArray:
    """Where to cut each segment: the intruder's foot, or its distance from a corner that both lines lead to.

    In the middle where the segment is far longer than the intruder is away: along another wall feet would come one
    by one, halves take as many rounds as the length has doublings.
    """
    points, original = work.points, work.original
    p, q = (points[work.segments[inside, k]] for k in (0, 1))
    v, d = points[intruder], q - p
    square = (d * d).sum(axis=1)
    part = np.clip(((v - p) * d).sum(axis=1) / square, 1e-6, 1 - 1e-6)
    aside = np.abs((v - p)[:, 0] * d[:, 1] - (v - p)[:, 1] * d[:, 0]) / square  # in lengths of the segment
    part = np.where(aside < _FLAT, 0.5, part)
    mine = original[work.owner[inside]]
    theirs = np.where(work.of_point[intruder, None] >= 0, original[work.of_point[intruder]], -1)
    for end in (0, 1):
        corner, other = mine[:, end], mine[:, 1 - end]
        joined = (theirs == corner[:, None]).any(axis=1)
        joined |= _among(_keys(np.stack([corner, intruder], axis=1), _MANY), work.pairs)
        away = points[other] - points[corner]
        far = np.hypot(*(v - points[corner]).T) / np.hypot(*away.T)
        there = ((points[corner] + away * far[:, None] - p) * d).sum(axis=1) / square
        part = np.where(joined & (there > 1e-6) & (there < 1 - 1e-6), there, part)
    cut: FloatArray = p + d * part[:, None]
    return cut


def _among(keys: IntArray, known: IntArray) -> NDArray[np.bool_]:
    """Which keys are among those known, which are in rising order."""
    place = np.minimum(np.searchsorted(known, keys), len(known) - 1)
    found: NDArray[np.bool_] = known[place] == keys
    return found


def _keys(pairs: IntArray, count: int) -> IntArray:
    """One number a pair, whatever its order."""
    keys: IntArray = pairs.min(axis=1) * count + pairs.max(axis=1)
    return keys
