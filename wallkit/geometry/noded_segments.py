"""Segments cut where they cross, touch or lie on one another, so that pieces meet at their ends only."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
import shapely

from wallkit.geometry.arrays import FloatArray, IntArray

NEAR = 2.0**-36
"""Of the size of everything: a piece is sought among the segments as near as that, of which it is the nearest."""


MOST_MEETINGS, AT_ONCE = 200_000, 1024
"""Pairs of segments that may meet, with four more for each segment; and segments that are asked together."""


class Noded(NamedTuple):
    """Pieces of segments.

    Attributes:
        points: (P, 2), all different.
        pieces: (S, 2) ends of each piece.
        owner: (M,) the given segment that a piece belongs to; more than one where segments lie on one another.
        piece: (M,) that piece.
    """

    points: FloatArray
    pieces: IntArray
    owner: IntArray
    piece: IntArray


def node(a: FloatArray, b: FloatArray) -> Noded | None:
    """Cut the segments from ``a`` to ``b``, (n, 2) each; those without length are left out; None for a tangle.

    GEOS finds where they meet; a new point is off both lines by rounding alone. What meets nothing keeps its bits. A
    tangle has more than 200,000 meetings, and four more for each segment.
    """
    real = np.flatnonzero((a != b).any(axis=1))
    lines = shapely.linestrings(np.stack([a[real], b[real]], axis=1))
    if _is_tangle(lines):
        return None
    cut = shapely.get_parts(shapely.union_all(lines)) if len(real) else np.empty(0, dtype=object)
    coordinates, line = shapely.get_coordinates(cut, return_index=True)
    within = line[1:] == line[:-1]
    starts, ends = coordinates[:-1][within], coordinates[1:][within]
    points, which = np.unique(np.concatenate([starts, ends]), axis=0, return_inverse=True)
    pieces = np.sort(which.reshape(2, -1).T, axis=1)
    owner, piece = _owners(a[real], b[real], points[pieces[:, 0]], points[pieces[:, 1]], lines)
    return Noded(points, pieces.astype(np.int64), real[owner], piece)


def _is_tangle(lines: Any) -> bool:
    """Tell whether too many pairs meet, without finding all of them."""
    tree, left = shapely.STRtree(lines), MOST_MEETINGS + (4 + 2 + 1) * len(lines)  # itself, and two neighbours twice
    for first in range(0, len(lines), AT_ONCE):
        left -= tree.query(lines[first : first + AT_ONCE], predicate="intersects").shape[1]
        if left < 0:
            return True
    return False


def _owners(a: FloatArray, b: FloatArray, p: FloatArray, q: FloatArray, lines: Any) -> tuple[IntArray, IntArray]:
    """Pair each piece from p to q with the segments on which it lies: the indices of both."""
    if not len(p):
        return np.empty(0, dtype=np.int64), np.empty(0, dtype=np.int64)
    size = float(np.abs(np.concatenate([a, b])).max()) or 1.0
    middles = shapely.points((p + q) / 2)
    piece, owner = shapely.STRtree(lines).query(middles, predicate="dwithin", distance=NEAR * size)
    # a piece lies on a segment if its ends do; of a short piece the segments across it are as near as its own
    off = np.maximum(_distance(a[owner], b[owner], p[piece]), _distance(a[owner], b[owner], q[piece]))
    least = np.full(len(p), np.inf)
    np.minimum.at(least, piece, off)
    on = off <= np.maximum(4.0 * least[piece], 2.0**-46 * size)
    length = np.hypot(*(q - p).T)
    on &= off <= np.maximum(0.25 * length[piece], least[piece])
    return owner[on].astype(np.int64), piece[on].astype(np.int64)


def _distance(a: FloatArray, b: FloatArray, point: FloatArray) -> FloatArray:
    """Distance of points from segments, each (n, 2)."""
    d = b - a
    part = np.clip(((point - a) * d).sum(axis=1) / (d * d).sum(axis=1), 0.0, 1.0)
    distance: FloatArray = np.hypot(*(a + part[:, None] * d - point).T)
    return distance
