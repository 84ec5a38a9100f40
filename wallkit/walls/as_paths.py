"""Walls as the segments of path data: lines, and circular arcs as such."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from importers.drawing import DrawnPath, Segment, Subpath
from wallkit.geometry.arrays import FloatArray
from wallkit.geometry.bulge_arcs import radius_of

if TYPE_CHECKING:
    from wallkit.walls.walls import Walls


def subpath_of(vertices: FloatArray, bulges: FloatArray, closed: bool) -> Subpath:
    """Give a wall as a subpath: (n, 2) vertices, (n,) bulges.

    A bulge of more than 1 is more than a half circle, the large arc; a left turn goes with growing angles, which is
    ``sweep`` in whatever axes. A closing edge that is a line is left out, as a Subpath does.
    """
    points, turns = vertices.tolist(), bulges.tolist()
    segments: list[Segment] = [("M", *points[0])]
    ends = [*points[1:], points[0]] if closed else points[1:]
    for index, end in enumerate(ends):
        start, bulge = points[index], turns[index]
        if bulge and start != end:
            radius = radius_of(math.hypot(end[0] - start[0], end[1] - start[1]), bulge)
            segments.append(("A", radius, radius, 0.0, int(abs(bulge) > 1), int(bulge > 0), *end))
        elif index < len(points) - 1:
            segments.append(("L", *end))
    return Subpath(segments, closed)


def to_svgpathtools(walls: Walls) -> list[Any]:
    """Give a ``svgpathtools.Path`` for each wall, in order; see :meth:`wallkit.Walls.to_svgpathtools`."""
    from importers.svg.svgpathtools_paths import svgpathtools_paths  # late: it brings scipy

    drawn = [
        DrawnPath([subpath_of(wall.vertices, wall.bulges, wall.closed)], name=wall.name, layer=wall.layer)
        for wall in walls
    ]
    return svgpathtools_paths(drawn)
