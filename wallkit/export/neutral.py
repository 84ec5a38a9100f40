"""wallkit-level: the plain JSON that the loaders for matter.js, Rapier and Unity read (schema in wallkit/schemas).

A program of one's own can read it as well: everything is placed, every number has all its digits, and points are
objects of x and y, as JsonUtility of Unity wants them.
"""

from __future__ import annotations

from typing import Any, TextIO

from wallkit.export.convex import solids_of
from wallkit.export.json_text import PointLists, points, write_json
from wallkit.export.level import Level, LevelWall
from wallkit.export.number_text import Rows

FORMAT, VERSION = "wallkit-level", 1


def write_level(level: Level, stream: TextIO, solids: bool = False) -> None:
    """Write a level as ``wallkit-level``, version 1; with ``solids`` the convex pieces too."""
    whole: dict[str, Any] = {
        "format": FORMAT,
        "version": VERSION,
        "y_axis": level.y_axis,
        "scale": level.scale,
        "walls": [_wall(wall) for wall in level],
    }
    if solids:
        whole["solids"] = [
            {
                **_marks(solid.wall),
                "pieces": PointLists(solid.pieces, '{"points": ', "}"),
            }
            for solid in solids_of(level)
        ]
    write_json(whole, 2, stream)


def _wall(wall: LevelWall) -> dict[str, Any]:
    result = {
        **_marks(wall),
        "closed": wall.closed,
        "depth": wall.depth,
        "oneWay": wall.one_way,
        "points": points(wall.vertices),
    }
    if wall.curve is not None:
        template = '{"x": %r, "y": %r, "bulge": %r}'
        result["arcs"] = Rows(template, wall.curve, before="[", after="]")
    return result


def _marks(wall: LevelWall) -> dict[str, Any]:
    return {
        "name": wall.name,
        "layer": wall.layer,
        "wall": wall.number,
        "restitution": float(wall.material.restitution),
        "tangentialRestitution": float(wall.material.tangential_restitution),
    }
