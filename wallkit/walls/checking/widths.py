"""How wide a ring is: whether a disc of some diameter fits into what it encloses (where its winding is not 0)."""

from __future__ import annotations

import numpy as np
import shapely
from numpy.typing import NDArray

from wallkit.geometry.arrays import FloatArray, IntArray
from wallkit.geometry.segments import segment_distance

_LEVELS = np.arange(1, 32, 2) / 32  # of the height: where a disc is looked for first
_MOST_CROSSINGS = 5_000  # of a ring with itself; one with more is a tangle, and not called thin


def is_thin(ring: FloatArray, diameter: float) -> bool:
    """Tell whether no disc of this diameter fits into a ring, (n, 2) points, the first not repeated.

    A disc around the middle of the widest stretch that a level line has inside is tried first; what that does not
    prove wide is shrunk by half the diameter, face by face where the ring crosses itself.
    """
    if len(ring) < 3:
        return True
    a, b = ring, np.roll(ring, -1, axis=0)
    place = _inner_points(a, b)
    for point in place:
        if segment_distance(np.broadcast_to(point, a.shape), a, b).min() >= diameter / 2:
            return False
    polygon = shapely.polygons(ring)
    if not shapely.is_valid(polygon):
        found = enclosed(ring)
        if found is None:
            return False
        polygon = found
    return bool(shapely.is_empty(shapely.buffer(polygon, -diameter / 2)))


def enclosed(ring: FloatArray) -> shapely.Geometry | None:
    """The area where a ring's winding number is not 0; None for a ring with too many crossings."""
    closed = np.concatenate([ring, ring[:1]])
    pieces = shapely.get_parts(shapely.node(shapely.linestrings(closed)))
    if len(pieces) > 2 * _MOST_CROSSINGS + len(ring):
        return None
    faces = shapely.get_parts(shapely.polygonize(pieces))
    places = shapely.get_coordinates(shapely.point_on_surface(faces))
    return shapely.union_all(faces[winding(closed, places) != 0])


def winding(closed: FloatArray, points: FloatArray) -> IntArray:
    """How often a closed line, its first point repeated, goes around each of (n, 2) points.

    Crossings of the ray to the right, up minus down.
    """
    result = np.empty(len(points), dtype=np.int64)
    a, b = closed[:-1], closed[1:]
    portion = max(1_000_000 // max(len(a), 1), 1)
    for begin in range(0, len(points), portion):
        x, y = points[begin : begin + portion].T[:, :, None]
        up = (a[:, 1] <= y) & (b[:, 1] > y)
        down = (b[:, 1] <= y) & (a[:, 1] > y)
        left = (b[:, 0] - a[:, 0]) * (y - a[:, 1]) - (x - a[:, 0]) * (b[:, 1] - a[:, 1])
        result[begin : begin + portion] = (up & (left > 0)).sum(axis=1) - (down & (left < 0)).sum(axis=1)
    return result


def _inner_points(a: FloatArray, b: FloatArray) -> FloatArray:
    """On each of some level lines the middle of the longest stretch where the winding is not 0: (at most 16, 2)."""
    low, high = a[:, 1].min(), a[:, 1].max()
    places = []
    for y in (low + _LEVELS * (high - low)).tolist():
        crosses: NDArray[np.bool_] = (a[:, 1] <= y) != (b[:, 1] <= y)
        p, q = a[crosses], b[crosses]
        x = p[:, 0] + (y - p[:, 1]) / (q[:, 1] - p[:, 1]) * (q[:, 0] - p[:, 0])
        order = np.argsort(x, kind="stable")
        x, turns = x[order], np.cumsum(np.where(q[order, 1] > p[order, 1], 1, -1))
        length = np.where(turns[:-1] != 0, np.diff(x), 0.0)
        if len(length) and length.max() > 0:
            widest = int(length.argmax())
            places.append(((x[widest] + x[widest + 1]) / 2, y))
    return np.array(places).reshape(-1, 2)
