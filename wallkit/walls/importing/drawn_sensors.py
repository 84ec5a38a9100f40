"""Sensors and places drawn in a drawing: what words make of a path that is no wall (roles.py)."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from importers.drawing import DrawnPath
from importers.problems import Problem
from wallkit.geometry.arrays import IntArray
from wallkit.walls.edge_tree import Edges
from wallkit.walls.importing.drawn_balls import circle_of, points_along
from wallkit.walls.importing.outlines import Outlines
from wallkit.walls.nesting import depths
from wallkit.walls.orient import turned_to
from wallkit.walls.origins import Marker
from wallkit.walls.roles import said_of
from wallkit.walls.walls import Walls

NO_FAULT = ("open-path", "closed-as-filled")
"""What a wall is warned about and a sensor is not: a line to be crossed is a good one."""


def drawn_sensors(outlines: Outlines) -> tuple[Walls, list[Problem]]:
    """Make sensors of outlines: closed ones turned so that a ball that goes into them goes against their normals.

    Args:
        outlines: of paths whose role is ``sensor`` or ``target``, cleaned.

    Returns:
        The sensors, and what was found on the way.
    """
    walls = turned_to(outlines.to_walls("both"), _depths(outlines), False)
    return walls, [problem for problem in outlines.problems if problem.code not in NO_FAULT]


def _depths(outlines: Outlines) -> IntArray:
    """Give the depth of each ring within its own path: one sensor may lie in another, and is none of its holes."""
    depth = np.zeros(len(outlines), dtype=np.int64)
    no_crossings = np.empty((0, 2), dtype=np.int64)
    for owner in np.unique(outlines.owner).tolist():
        mine = outlines.owner == owner
        if mine.sum() > 1:
            part = outlines.keep(mine)
            depth[mine] = depths(Edges(part.vertices, part.offsets, part.closed), no_crossings)[0]
    return depth


def drawn_places(paths: Sequence[DrawnPath], scale: float, flip_y: bool) -> tuple[Marker, ...]:
    """Give the places of spawns and targets: the centre of a circle, or the middle of the box of anything else.

    Args:
        paths: whose role is ``spawn`` or ``target``.
        scale: as for the walls.
        flip_y: as for the walls.
    """
    markers = []
    for path in paths:
        said = said_of(path)
        points = np.concatenate([points_along(sub.segments) for sub in path.subpaths]) * scale
        points = points * (1.0, -1.0) if flip_y else points
        circle = circle_of(points)
        x, y = (points.min(axis=0) + points.max(axis=0)) / 2
        place = circle if circle is not None else (float(x), float(y), 0.0)
        markers.append(Marker("target" if said.role == "target" else "spawn", said.name, *place))
    return tuple(markers)
