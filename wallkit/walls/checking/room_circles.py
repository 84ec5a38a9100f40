"""The largest circle of a room: shapely's ``maximum_inscribed_circle`` of what a disc gets to through its triangles.

A room behind a gap of width w is what is reached over edges of triangles longer than w, and where it ends at such an
edge there is no wall: a larger circle may bulge through. A circle of radius R >= w / 2 between the ends of a chord of
length w bulges by less than its half disc, so the half disc is added to the room where no wall is in it.
"""

from __future__ import annotations

import numpy as np
import shapely
from numpy.typing import NDArray

from wallkit.geometry.arrays import FloatArray, IntArray
from wallkit.geometry.conforming_delaunay import Triangulation

MOST_ROOMS = 16  # the roomiest; the others keep the circle that was found
MOST_WORK = 4_000_000  # triangles looked at for all rooms together
_FINE = 1e-7  # of the radius: the tolerance that shapely is asked for (it bounds its own steps)
_HAIR = 1e-9  # of the size of everything: half the width of an open wall inside a room
_HALF_DISC = np.linspace(0, np.pi, 9)[1:-1]


def larger_circles(mesh: Triangulation, places: FloatArray, radius: FloatArray, width: FloatArray) -> FloatArray:
    """Find the largest circle of each room.

    Args:
        mesh: triangles with the walls among their edges.
        places: (n, 2) a place in each room.
        radius: (n,) of the circle that is known there.
        width: (n,) of the widest gap that leads out of the room; 0 where it is closed.

    Returns:
        (n, 3) x, y, radius; what was given where nothing larger is found.
    """
    result = np.column_stack([places, radius])
    start = triangles_at(mesh, places)
    length = np.hypot(*(mesh.points[mesh.ends[:, 1]] - mesh.points[mesh.ends[:, 0]]).T)
    most = min(max(MOST_WORK // max(len(mesh.corners), 1), 1), MOST_ROOMS)
    for row in np.argsort(-radius, kind="stable")[:most].tolist():
        if start[row] < 0:
            continue
        inside = _reached(mesh, int(start[row]), ~mesh.wall & (length > width[row]))
        area = _area(mesh, inside, places[row])
        if area is None:
            continue
        found = shapely.maximum_inscribed_circle(area, tolerance=_FINE * radius[row])
        if shapely.length(found) > radius[row]:
            result[row] = *shapely.get_coordinates(found)[0], shapely.length(found)
    return result


def triangles_at(mesh: Triangulation, points: FloatArray) -> IntArray:
    """The triangle that each of (n, 2) points is in; -1 where there is none."""
    result = np.full(len(points), -1, dtype=np.int64)
    if len(points) and len(mesh.corners):
        ring = mesh.points[mesh.corners[:, [0, 1, 2, 0]]]
        tree = shapely.STRtree(shapely.polygons(ring))
        source, triangle = tree.query(shapely.points(points), predicate="intersects")
        result[source] = triangle
    return result


def joined(mesh: Triangulation, passable: NDArray[np.bool_]) -> IntArray:
    """Number the parts that triangles make which hang together over passable edges: (T,) the part of each."""
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import connected_components

    count = len(mesh.corners)
    one = np.repeat(np.arange(count), 3)
    two, over = mesh.neighbours.ravel(), passable[mesh.edge.ravel()]
    over = over & (two >= 0)
    links = coo_matrix((np.ones(int(over.sum())), (one[over], two[over])), shape=(count, count))
    _, part = connected_components(links, directed=False)
    return np.asarray(part, dtype=np.int64)


def _reached(mesh: Triangulation, start: int, passable: NDArray[np.bool_]) -> NDArray[np.bool_]:
    part = joined(mesh, passable)
    same: NDArray[np.bool_] = part == part[start]
    return same


def _area(mesh: Triangulation, inside: NDArray[np.bool_], place: FloatArray) -> shapely.Geometry | None:
    """The area of triangles, with half discs over its open sides, without the open walls that stand in it."""
    sides = np.bincount(mesh.edge[inside].ravel(), minlength=len(mesh.ends))
    rim, within = sides == 1, (sides == 2) & mesh.wall
    if (rim & mesh.outer).any():
        return None
    faces = shapely.get_parts(shapely.polygonize(_segments(mesh, rim)))
    here = faces[shapely.intersects_xy(faces, *place)]
    if not len(here):
        return None
    area = here[0]
    caps = _half_discs(mesh, np.flatnonzero(rim & ~mesh.wall), inside)
    if len(caps):
        tree = shapely.STRtree(_segments(mesh, mesh.wall))
        closed = np.unique(tree.query(shapely.buffer(caps, -_HAIR * mesh.cut.size), predicate="intersects")[0])
        area = shapely.union_all([area, *np.delete(caps, closed)])
    if within.any():
        area = shapely.difference(
            area, shapely.buffer(shapely.multilinestrings(_segments(mesh, within)), _HAIR * mesh.cut.size)
        )
        parts = shapely.get_parts(area)
        area = parts[shapely.distance(parts, shapely.points(place)).argmin()]
    return area


def _segments(mesh: Triangulation, chosen: NDArray[np.bool_]) -> NDArray[np.object_]:
    lines: NDArray[np.object_] = shapely.linestrings(mesh.points[mesh.ends[chosen]])
    return lines


def _half_discs(mesh: Triangulation, edge: IntArray, inside: NDArray[np.bool_]) -> NDArray[np.object_]:
    """Half discs over edges on the rim, away from the triangle inside."""
    if not len(edge):
        return np.empty(0, dtype=object)
    where = np.flatnonzero(inside)
    corner = np.zeros(len(mesh.ends), dtype=np.int64)
    corner[mesh.edge[where].ravel()] = mesh.corners[where].ravel()
    a, b, c = mesh.points[mesh.ends[edge, 0]], mesh.points[mesh.ends[edge, 1]], mesh.points[corner[edge]]
    left = (b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0] > 0
    away = np.stack([(b - a)[:, 1], -(b - a)[:, 0]], axis=1) * np.where(left, 0.5, -0.5)[:, None]
    middle, along = (a + b) / 2, (b - a) / 2
    arc = middle[:, None] - along[:, None] * np.cos(_HALF_DISC)[:, None] + away[:, None] * np.sin(_HALF_DISC)[:, None]
    ring = np.concatenate([a[:, None], arc, b[:, None], a[:, None]], axis=1)
    caps: NDArray[np.object_] = shapely.polygons(ring)
    return caps
