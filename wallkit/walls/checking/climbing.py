"""Places farthest from all walls: climbing from where one is to the next summit of the distance to the nearest wall."""

from __future__ import annotations

from dataclasses import dataclass
from functools import reduce
from itertools import combinations
from typing import Any

import numpy as np
import shapely

from wallkit.geometry.arrays import FloatArray, IntArray

_KEPT = 6  # walls that are looked at together
_AT_ONCE = 1024  # climbs: bounds the memory, and keeps it in the cache
_ROUNDS = 100  # a dozen are enough for three walls; where many are as near, as in a ring of short ones, more
_FINE = 1e-8  # of the distance: gains below are none
_FLAT = 1e-12  # determinant of differences of unit vectors: below, rounding is most of it
_PAIRS = np.array([*combinations(range(_KEPT), 2)])
_TRIPLES = np.array([*combinations(range(_KEPT), 3)])


@dataclass(slots=True, eq=False, repr=False)
class Segments:
    """Walls with a tree: ``p`` and ``q``, (n, 2) ends of each, and the diagonal of the box around them."""

    p: FloatArray
    q: FloatArray
    tree: Any
    size: float

    @classmethod
    def of(cls, p: FloatArray, q: FloatArray) -> Segments:
        """Make the tree."""
        size = np.maximum(p, q).max(axis=0) - np.minimum(p, q).min(axis=0)
        return cls(p, q, shapely.STRtree(shapely.linestrings(np.stack([p, q], axis=1))), float(np.hypot(*size)))

    def nearest(self, points: FloatArray) -> tuple[FloatArray, IntArray]:
        """Distance and number of the nearest segment to each of (n, 2) points."""
        (_, number), distance = self.tree.query_nearest(shapely.points(points), return_distance=True, all_matches=False)
        return distance, number

    def away(self, number: IntArray, points: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Distances (n, k) of (n, 2) points from segments (n, k), and (n, k, 2) the unit vectors that lead away."""
        p, d = self.p[number], self.q[number] - self.p[number]
        dx, dy = d[..., 0], d[..., 1]
        along = (points[:, None, 0] - p[..., 0]) * dx + (points[:, None, 1] - p[..., 1]) * dy
        part = along / np.maximum(dx * dx + dy * dy, 1e-300)
        off = points[:, None] - (p + d * np.clip(part, 0.0, 1.0)[..., None])
        distance = np.hypot(off[..., 0], off[..., 1])
        return distance, off / np.maximum(distance, 1e-300)[..., None]


def climb(walls: Segments, places: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Climb from (n, 2) places: (n, 2) where the distance to the nearest wall is a local maximum, and (n,) how large.

    Near a place the distance from a wall is d + n . s after a step s, n the unit vector away from the wall; less it is
    never, since distances from segments are convex. The step is taken to where the least of these, of the walls that
    were met so far, is largest: where three are equal, as in Newton's method. No step is longer than half the
    distance to the nearest wall, so that none leads through a wall. A climb ends where that is as far as walls reach.
    """
    parts = [_climb(walls, places[begin : begin + _AT_ONCE]) for begin in range(0, max(len(places), 1), _AT_ONCE)]
    return np.concatenate([part[0] for part in parts]), np.concatenate([part[1] for part in parts])


def _climb(walls: Segments, places: FloatArray) -> tuple[FloatArray, FloatArray]:
    x, (d, first) = places.copy(), walls.nearest(places)
    known = np.repeat(first[:, None], _KEPT, axis=1)
    reach = d / 2
    going, far = np.flatnonzero(d > 0), walls.size
    for _ in range(_ROUNDS):
        if not len(going):
            break
        step, gain = _step(*walls.away(known[going], x[going]), reach[going])
        worth = (gain > _FINE * d[going]) & (d[going] < far)
        going, step = going[worth], step[worth]
        there = x[going] + step
        distance, wall = walls.nearest(there)
        _remember(walls, known, going, wall, there)
        better = distance > d[going]
        reach[going] = np.where(better, distance / 2, np.hypot(*step.T) / 2)
        x[going[better]], d[going[better]] = there[better], distance[better]
    return x, d


def _remember(walls: Segments, known: IntArray, rows: IntArray, wall: IntArray, there: FloatArray) -> None:
    """Put walls in the place of those known that are farthest away, where they are not known."""
    distance, _ = walls.away(known[rows], there)
    twice = np.triu((known[rows][:, :, None] == known[rows][:, None, :]), 1).any(axis=1)
    distance[twice] = np.inf
    worst = distance.argmax(axis=1)
    fresh = ~(known[rows] == wall[:, None]).any(axis=1)
    known[rows[fresh], worst[fresh]] = wall[fresh]


def _step(d: FloatArray, n: FloatArray, reach: FloatArray) -> tuple[FloatArray, FloatArray]:
    """The step (m, 2), no longer than ``reach``, after which the least of d + n . s is largest, and its gain (m,)."""
    steps = np.concatenate([_to_three(d, n), _along_two(d, n, reach), n * reach[:, None, None]], axis=1)
    length = np.hypot(steps[..., 0], steps[..., 1])
    steps *= (reach[:, None] / np.maximum(length, reach[:, None]))[..., None]
    every_wall = d[:, None, :] + steps @ n.transpose(0, 2, 1)
    after: FloatArray = reduce(np.minimum, (every_wall[..., k] for k in range(_KEPT)))  # a short axis takes NumPy long
    best, every = after.argmax(axis=1), np.arange(len(d))
    return steps[every, best], after[every, best] - d.min(axis=1)


def _to_three(d: FloatArray, n: FloatArray) -> FloatArray:
    """Steps to where three of the distances are equal; 0 where the vectors are too alike."""
    i, j, k = _TRIPLES.T
    u, v, a, b = n[:, i] - n[:, j], n[:, i] - n[:, k], d[:, j] - d[:, i], d[:, k] - d[:, i]
    det = u[..., 0] * v[..., 1] - u[..., 1] * v[..., 0]
    with np.errstate(divide="ignore", invalid="ignore"):
        step = np.stack([a * v[..., 1] - b * u[..., 1], b * u[..., 0] - a * v[..., 0]], axis=-1) / det[..., None]
    step[~(np.abs(det) > _FLAT)] = 0.0
    return step


def _along_two(d: FloatArray, n: FloatArray, reach: FloatArray) -> FloatArray:
    """Steps to where two of the distances are equal, and from there as far as may be along the line of such places."""
    i, j = _PAIRS.T
    u = n[:, i] - n[:, j]
    square = np.maximum((u * u).sum(axis=2), 1e-300)
    across = u * ((d[:, j] - d[:, i]) / square)[..., None]
    ahead = n[:, i] + n[:, j]
    length = np.hypot(ahead[..., 0], ahead[..., 1])
    left = np.sqrt(np.maximum(reach[:, None] ** 2 - (across * across).sum(axis=2), 0.0))
    steps: FloatArray = across + ahead * (left / np.maximum(length, 1e-300))[..., None]
    return steps
