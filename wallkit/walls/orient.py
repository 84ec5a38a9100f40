"""Orientation: nest walls and turn them so that material is on their left."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from wallkit.geometry.arrays import IntArray
from wallkit.geometry.rings import signed_areas, turned
from wallkit.walls.crossings import Touches
from wallkit.walls.edge_tree import Edges
from wallkit.walls.nesting import depths
from wallkit.walls.walls import Walls


def oriented(walls: Walls, arena: bool, edges: Edges, touches: Touches) -> Walls:
    """Set depths, and turn closed walls: even depth a solid, odd depth a hole; with ``arena`` all one deeper.

    Args:
        walls: turned any way.
        arena: the outermost closed walls are rooms.
        edges: their straight edges.
        touches: the touches of those.
    """
    return turned_to(walls, depths(edges, touches.crossing_walls)[0], arena)


def turned_to(walls: Walls, depth: IntArray, arena: bool) -> Walls:
    """Do the same for walls whose depths, with the outermost at 0, are known."""
    depth = depth + (1 if arena else 0)
    area = signed_areas(walls.vertices, walls.bulges, walls.offsets)
    turn = walls.closed & ((area > 0) != (depth % 2 == 0)) & (area != 0)
    vertices, bulges = turned(walls.vertices, walls.bulges, walls.offsets, turn)
    return replace(walls, vertices=np.ascontiguousarray(vertices), bulges=bulges, depth=depth.astype(np.int64))


def inside_out(walls: Walls) -> Walls:
    """Make rooms of what is solid and solids of what is free: every wall one deeper (or back), closed ones reversed.

    The depths are those of an import. First vertices stay where they are: the result is, bit for bit, what an import
    with the other reading gives.
    """
    arena = bool(walls.closed.any() and walls.depth[walls.closed].min() % 2)
    return turned_to(walls, walls.depth - arena, not arena)


def is_arena(walls: Walls) -> bool:
    """The outermost closed walls are rooms: the largest runs clockwise (y up), so that material is outside of it.

    The winding says it, for imported walls and for those that were given as arrays (whose depths nobody has counted)
    alike; no wall is around the largest.
    """
    if not walls.closed.any():
        return False
    areas = np.where(walls.closed, signed_areas(walls.vertices, walls.bulges, walls.offsets), 0.0)
    return bool(areas[np.abs(areas).argmax()] < 0)
