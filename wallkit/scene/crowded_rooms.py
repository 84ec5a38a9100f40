"""The roomiest place in a face in which very many lines stand: circles in the triangles between them."""

from __future__ import annotations

from typing import Any

import numpy as np
import shapely

from wallkit.geometry.triangulation import Triangulation
from wallkit.walls.checking.climbing import Segments, climb
from wallkit.walls.checking.room_circles import climbed_from
from wallkit.walls.checking.triangle_circles import TOO_SMALL, triangle_circles

_NOTHING = 1e-6  # of the square root of the face's area: circles below are no room
_STARTS = 4096  # of climbs, of each of two kinds: along a wall very many triangles are nearly as roomy


def roomiest_circle(mesh: Triangulation, face: Any) -> tuple[float, float, float] | None:
    """Give centre (x, y) and radius of a circle as large as any in a face, among all lines; None without room.

    It is climbed from the largest circles in triangles, which may be too small by ``TOO_SMALL``, and from the longest
    triangles in which a larger one may be: no place in a triangle is farther from all corners than 1 / sqrt 3 of the
    longest side. n log n for n lines.

    Args:
        mesh: between all lines.
        face: a polygon whose edges are lines of the mesh.
    """
    shapely.prepare(face)
    where = shapely.contains_xy(face, mesh.points[mesh.corners].mean(axis=1))
    radius, place = triangle_circles(mesh, _NOTHING * float(np.sqrt(shapely.area(face))), where)
    if not radius.any():
        return None
    largest, longest = float(radius.max()), mesh.length[mesh.edge].max(axis=1)
    roomy = np.where(TOO_SMALL * radius >= largest, radius, 0.0)
    starts = climbed_from(roomy, longest, where, largest, (_STARTS, _STARTS))
    walls = Segments.of(*(mesh.points[mesh.ends[mesh.wall, end]] for end in (0, 1)))
    places, distance = climb(walls, place[starts])
    distance[~shapely.contains_xy(face, places)] = 0.0
    best = int(distance.argmax())
    return float(places[best, 0]), float(places[best, 1]), float(distance[best])
