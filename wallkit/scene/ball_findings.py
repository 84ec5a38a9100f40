"""Findings about where balls stand: in material, or in a box of their own inside another room."""

from __future__ import annotations

import numpy as np

from importers.problems import Problem
from wallkit.geometry.arrays import IntArray
from wallkit.scene.scene import Balls
from wallkit.walls import Walls
from wallkit.walls.checking.self_check import straight_edges
from wallkit.walls.edge_tree import Edges
from wallkit.walls.nesting import depths
from wallkit.walls.orient import is_arena
from wallkit.walls.solid import innermost, walls_around

_FIX = "move it into free space, or say what is solid (--solid, --arena, --room NAME)"


def ball_findings(walls: Walls, balls: Balls) -> list[Problem]:
    """Find balls whose centre is in material, and those shut in a room inside another one.

    Material is what ``walls.solid`` says. Walls given as numbers have no such word: their winding says it where one
    is solid from outside alone, and else the place of most balls, since two-sided walls keep a ball in as well as out.
    """
    places = np.asarray(balls.position, dtype=np.float64).reshape(-1, 2)
    if not len(places) or not walls.closed.any():
        return []
    edges = straight_edges(walls)
    depth = _depth(walls, edges)
    home = innermost(*walls_around(edges, places), depth, len(places))
    around = np.append(depth + 1, 0)[home]  # the -1 of no wall finds the 0 at the end
    level = around + _is_room(walls, around)
    found = []
    for ball in np.flatnonzero((level % 2 == 1) | (level >= 4)).tolist():
        x, y = places[ball].tolist()
        if level[ball] % 2:
            code, what, fix = "ball-in-material", "stands in material", _FIX
        else:
            code, what, fix = "shut-in", "is shut in a room inside another one", "open that room, or move the ball"
        wall = int(home[ball])
        layer, name = (walls.layers[wall], walls.names[wall]) if wall >= 0 else ("", "")
        found.append(Problem(code, "warning", f"ball {ball} {what}", fix, layer=layer, name=name, x=x, y=y))
    return found


def _depth(walls: Walls, edges: Edges) -> IntArray:
    """Closed walls around each wall: as counted by the import, less the step down that a room is; else counted now."""
    return walls.depth - walls.solid.room if walls.solid is not None else depths(edges)[0]


def _is_room(walls: Walls, around: IntArray) -> bool:
    inside = int((around % 2).sum())
    if walls.solid is not None:
        return walls.solid.room
    if 2 * inside == len(around) or "outward" in walls.sides:
        return is_arena(walls)
    return 2 * inside > len(around)
