"""Rings: signed area, reversal, and their shape as shapely polygons."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from wallkit.geometry.arrays import FloatArray, IntArray
from wallkit.geometry.ragged import numbered, portions


def signed_areas(vertices: FloatArray, bulges: FloatArray | None, offsets: IntArray) -> FloatArray:
    """Signed area of each ring, arcs included: (W,), positive when counter-clockwise with y up.

    The shoelace sum taken from each ring's first vertex, so that a far origin costs no digits, and for an arc
    of angle 4 atan(bulge) the circular segment R^2 (angle - sin angle) / 2 between chord and arc.

    Args:
        vertices: (V, 2).
        bulges: (V,), or None for lines alone.
        offsets: (W + 1,) ring k has the vertices ``offsets[k]`` to ``offsets[k + 1]``, which may be none.
    """
    bent = bulges if bulges is not None and bulges.any() else None
    sums = np.zeros(len(offsets) - 1)
    for row, stop in portions(offsets):
        full = row + np.flatnonzero(np.diff(offsets[row : stop + 1]))
        if len(full):
            some = slice(offsets[row], offsets[stop])
            first = offsets[full] - offsets[row]
            parts = _parts(vertices[some], None if bent is None else bent[some], first)
            sums[full] = np.add.reduceat(parts, first)
    return sums


def _parts(vertices: FloatArray, bulges: FloatArray | None, first: IntArray) -> FloatArray:
    """What each edge of rings, none empty, adds to the signed area: (V,), ``first`` the rings' first vertices."""
    last = np.append(first[1:], len(vertices)) - 1
    a = vertices - np.repeat(vertices[first], last + 1 - first, axis=0)
    b = np.empty_like(a)
    b[:-1], b[last] = a[1:], 0.0
    parts: FloatArray = (a[:, 0] * b[:, 1] - b[:, 0] * a[:, 1]) / 2
    if bulges is not None:
        parts += _segment_areas(b - a, bulges)
    return parts


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
    points, bends = vertices.copy(), bulges.copy()
    for row, stop in portions(offsets):
        if not turn[row:stop].any():
            continue
        which = row + np.flatnonzero(turn[row:stop])
        size = offsets[which + 1] - offsets[which]
        wall, rank = numbered(size)
        first = offsets[which][wall]
        to, far = first + rank, size[wall] - rank
        points[to] = vertices[first + far % size[wall]]
        bends[to] = 0.0 - bulges[first + far - 1]  # 0 - 0 is 0, -0 is not
    return points, bends
