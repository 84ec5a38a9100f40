"""Rings: signed area, reversal, and their shape as shapely polygons."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from wallkit.geometry.arrays import FloatArray, IntArray

_AT_ONCE = 1 << 14  # vertices: what they need stays in the cache


def signed_areas(vertices: FloatArray, bulges: FloatArray, offsets: IntArray) -> FloatArray:
    """Signed area of each ring, arcs included: (W,), positive when counter-clockwise with y up.

    The shoelace sum taken from each ring's first vertex, so that a far origin costs no digits, and for an arc
    of angle 4 atan(bulge) the circular segment R^2 (angle - sin angle) / 2 between chord and arc.
    """
    counts = np.diff(offsets)
    following = np.arange(1, len(vertices) + 1)
    full = counts > 0
    following[offsets[1:][full] - 1] = offsets[:-1][full]
    first, parts, has_arcs = np.repeat(offsets[:-1], counts), np.empty(len(vertices)), bool(np.any(bulges))
    for begin in range(0, len(vertices), _AT_ONCE):
        some = slice(begin, begin + _AT_ONCE)
        origin = vertices[first[some]]
        a, b = vertices[some] - origin, vertices[following[some]] - origin
        parts[some] = (a[:, 0] * b[:, 1] - b[:, 0] * a[:, 1]) / 2
        if has_arcs:
            parts[some] += _segment_areas(b - a, bulges[some])
    sums = np.zeros(len(counts))
    if len(parts):
        sums[full] = np.add.reduceat(parts, offsets[:-1][full])
    return sums


def _segment_areas(chord: FloatArray, bulges: FloatArray) -> FloatArray:
    """Area between chord and arc; positive where the arc bows to the right (it adds to a left-hand solid)."""
    angle = 4 * np.arctan(bulges)
    square = chord[:, 0] ** 2 + chord[:, 1] ** 2
    with np.errstate(divide="ignore", invalid="ignore"):
        radius_square = square / (4 * np.sin(angle / 2) ** 2)
        area = radius_square * (angle - np.sin(angle)) / 2
    # a flat arc is a parabola: 2/3 of chord times height, the height |chord| bulge / 2
    return np.where(np.abs(bulges) > 1e-4, area, square * bulges / 3)


def rings_of(vertices: FloatArray, offsets: IntArray) -> NDArray[np.object_]:
    """Make a shapely polygon of each ring of at least three vertices; None for the others."""
    import shapely

    counts = np.diff(offsets)
    full = np.flatnonzero(counts >= 3)
    polygons = np.full(len(counts), None, dtype=object)
    if not len(full):
        return polygons
    points = vertices if len(full) == len(counts) else vertices[np.repeat(counts >= 3, counts)]
    sizes = counts[full]
    starts = np.cumsum(sizes) - sizes
    index = np.repeat(np.arange(len(full)), sizes + 1)
    take = np.insert(np.arange(len(points)), starts + sizes, starts) if len(points) else np.empty(0, dtype=np.int64)
    rings = shapely.linearrings(points[take], indices=index)
    del points, take, index  # before each ring is copied
    polygons[full] = shapely.polygons(rings)
    return polygons


def turned(
    vertices: FloatArray, bulges: FloatArray, offsets: IntArray, turn: NDArray[np.bool_]
) -> tuple[FloatArray, FloatArray]:
    """Reverse the closed walls marked in ``turn``: the first vertex stays first, bulges go to the new edges."""
    counts = np.diff(offsets)
    position = np.arange(len(vertices))
    first, size, turned = np.repeat(offsets[:-1], counts), np.repeat(counts, counts), np.repeat(turn, counts)
    rank = position - first
    vertex_from = np.where(turned, first + (size - rank) % np.maximum(size, 1), position)
    bulge_from = np.where(turned, first + size - 1 - rank, position)
    return vertices[vertex_from], np.where(turned, 0.0 - bulges[bulge_from], bulges)  # 0 - 0 is 0, -0 is not
