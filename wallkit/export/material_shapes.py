"""The material of a level as shapely polygons: even-odd over all closed walls, as nesting decides."""

from __future__ import annotations

from typing import Any

import numpy as np
import shapely

from wallkit.export.level import Level
from wallkit.walls.rings import rings_of
from wallkit.walls.shapes import even_odd


def polygons_of(level: Level) -> list[Any]:
    """Give the polygons of what an odd number of rings is around: the material, or the free space of a room.

    Exteriors run counter-clockwise and holes clockwise in the target's numbers.
    """
    closed = [wall.vertices for wall in level if wall.closed and len(wall.vertices) > 2]
    if not closed:
        return []
    offsets = np.concatenate([[0], np.cumsum([len(vertices) for vertices in closed])])
    whole = even_odd(rings_of(np.concatenate(closed), offsets))
    parts = [part for part in shapely.get_parts(whole) if part.geom_type == "Polygon" and not part.is_empty]
    return list(shapely.orient_polygons(parts)) if parts else []
