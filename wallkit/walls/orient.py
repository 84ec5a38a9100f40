"""Orientation: nest walls and turn them so that material is on their left."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from wallkit.walls.contacts import Contacts
from wallkit.walls.edges import Edges
from wallkit.walls.nesting import depths
from wallkit.walls.rings import signed_areas, turned
from wallkit.walls.walls import Walls


def oriented(walls: Walls, arena: bool, edges: Edges, contacts: Contacts) -> Walls:
    """Set depths, and turn closed walls: even depth a solid, odd depth a hole; with ``arena`` all one deeper.

    Args:
        walls: turned any way.
        arena: the outermost closed walls are rooms.
        edges: their straight edges.
        contacts: the contacts of those.
    """
    depth = depths(edges, contacts.crossing_walls)[0] + (1 if arena else 0)
    area = signed_areas(walls.vertices, walls.bulges, walls.offsets)
    turn = walls.closed & ((area > 0) != (depth % 2 == 0)) & (area != 0)
    vertices, bulges = turned(walls.vertices, walls.bulges, walls.offsets, turn)
    return replace(walls, vertices=np.ascontiguousarray(vertices), bulges=bulges, depth=depth.astype(np.int64))


def is_arena(walls: Walls) -> bool:
    """The outermost closed walls are rooms."""
    return bool(walls.closed.any() and walls.depth[walls.closed].min() % 2)
