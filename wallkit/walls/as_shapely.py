"""Walls as shapely geometry: the material as polygons, open walls as lines; arcs as lines within a tolerance."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy as np

from importers.limits import MAX_VERTICES, limit_error
from wallkit.geometry.arrays import FloatArray, IntArray
from wallkit.geometry.bulge_arcs import edge_points
from wallkit.geometry.ragged import AT_ONCE, numbered, slices
from wallkit.geometry.rings import rings_of
from wallkit.walls.walls import Walls

CHORDS, CHORDS_OF_AN_ARC = 100_000, 64
"""So many lines are put in the place of arcs for a check, however small the tolerance is; or so many for each arc."""


def to_shapely(walls: Walls, tolerance: float | None = None) -> Any:
    """Give the walls as one shapely geometry.

    Args:
        walls: any walls.
        tolerance: the largest distance between an arc and the lines put in its place; by default the walls'
            own tolerance, or 1e-4 of their size where that is 0.

    Returns:
        A GeometryCollection of two: the material as a MultiPolygon or Polygon (even-odd over all closed walls;
        for a room, whose material is outside, the free space inside is what is given), and the open walls as
        a MultiLineString.
    """
    import shapely

    vertices, offsets = straightened(walls, tolerance)
    rings = rings_of(vertices, offsets)[walls.closed]
    rings = rings[rings != None]  # noqa: E711  (elementwise)
    starts, ends = offsets[:-1][~walls.closed].tolist(), offsets[1:][~walls.closed].tolist()
    lines = [shapely.linestrings(vertices[a:b]) for a, b in zip(starts, ends, strict=True)]
    return shapely.GeometryCollection([even_odd(rings), shapely.MultiLineString(lines)])


def even_odd(rings: Any) -> Any:
    """Area that an odd number of the polygons covers, each made valid first; in pairs, so that no part grows early."""
    import shapely

    if not len(rings):
        return shapely.MultiPolygon()
    layer = np.where(shapely.is_valid(rings), rings, shapely.make_valid(rings, method="structure"))
    while len(layer) > 1:
        paired = shapely.symmetric_difference(layer[: len(layer) // 2 * 2 : 2], layer[1::2])
        layer = np.concatenate([paired, layer[-1:]]) if len(layer) % 2 else paired
    return layer[0]


def straightened(walls: Walls, tolerance: float | None = None) -> tuple[FloatArray, IntArray]:
    """Put lines in the place of arcs: vertices and offsets as in Walls. Line edges stay as they are.

    Raises:
        LimitError: more than 2,000,000 lines.
    """
    if not walls.has_arcs:
        return walls.vertices, walls.offsets
    within = largest_distance(walls) if tolerance is None else tolerance
    offsets = np.zeros(len(walls.vertices) + 1, dtype=np.int64)
    total = 0.0
    for some, a, b, bulge in _edges_of(walls):
        wanted = _lines_wanted(a, b, bulge, within)
        total += float(wanted.sum())
        if not total <= MAX_VERTICES + len(walls.vertices):
            raise limit_error("lines in the place of arcs", f"{MAX_VERTICES:,}", fix="ask for a larger tolerance")
        offsets[1:][some] = wanted
    np.cumsum(offsets, out=offsets)
    points = np.empty((offsets[-1], 2))
    for some, a, b, bulge in _edges_of(walls):
        first = offsets[:-1][some]
        counts = offsets[1:][some] - first
        points[first] = a
        on, rank = numbered(counts - 1)
        points[first[on] + rank + 1] = edge_points(a[on], b[on], bulge[on], (rank + 1) / counts[on])
    return points, offsets[walls.offsets]


def _edges_of(walls: Walls) -> Iterator[tuple[slice, FloatArray, FloatArray, FloatArray]]:
    """Some edges after others: which, where they start and end, and their bulges."""
    following = _following(walls)
    for some in slices(len(following), AT_ONCE):
        yield some, walls.vertices[some], walls.vertices.take(following[some], axis=0), walls.bulges[some]


def largest_distance(walls: Walls) -> float:
    """Choose how far lines may be from the arcs in whose place they are put, where nobody says it."""
    low_x, low_y, high_x, high_y = walls.box()
    return walls.tolerance or 1e-4 * math.hypot(high_x - low_x, high_y - low_y) or 1.0


def check_tolerance(walls: Walls, tolerance: float) -> float:
    """Give the distance from arcs at which checks see them as lines.

    It is a tenth of the tolerance, 1e-4 of the walls' size where that is 0, or what so many lines come to. A chord
    over the angle s is off by r s^2 / 8, so arcs of angles a take sum(a sqrt(r / 8)) / sqrt(tolerance) of them.
    """
    asked = tolerance / 10 or largest_distance(walls)
    if not walls.has_arcs:
        return asked
    taken = np.empty(len(walls.vertices))
    for some, a, b, bulge in _edges_of(walls):
        angle, radius = _arcs(a, b, bulge)
        taken[some] = np.abs(angle) * np.sqrt(radius / 8)
    most = min(max(CHORDS, CHORDS_OF_AN_ARC * np.count_nonzero(walls.bulges)), MAX_VERTICES // 2)
    return max(asked, float(taken.sum() / most) ** 2)


def _following(walls: Walls) -> IntArray:
    """(V,) the vertex after each, around the end of its wall."""
    following = np.arange(1, len(walls.vertices) + 1)
    full = np.diff(walls.offsets) > 0
    following[walls.offsets[1:][full] - 1] = walls.offsets[:-1][full]
    return following


def _arcs(a: FloatArray, b: FloatArray, bulge: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Of each edge from a to b: the angle of the arc (0 for a line) and its radius (0)."""
    angle = 4 * np.arctan(bulge)
    half_chord = np.hypot(*(b - a).T) / 2
    with np.errstate(divide="ignore", invalid="ignore"):
        return angle, np.where(bulge != 0, half_chord / np.abs(np.sin(angle / 2)), 0.0)


def _lines_wanted(a: FloatArray, b: FloatArray, bulge: FloatArray, tolerance: float) -> FloatArray:
    """How many lines are to be put in the place of each edge from a to b: (n,), 1 for a line."""
    angle, radius = _arcs(a, b, bulge)
    with np.errstate(divide="ignore", invalid="ignore"):
        step = 2 * np.arccos(np.clip(1 - tolerance / radius, math.cos(math.pi / 8), 1.0))
        step = np.where(step > 0, step, np.sqrt(8 * tolerance / radius))
        wanted: FloatArray = np.where(bulge != 0, np.maximum(np.ceil(np.abs(angle) / step), 1), 1.0)
    return wanted
