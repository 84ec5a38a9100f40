"""Balls and goals where no game can use them: in material, or in a sealed room of their own."""

from __future__ import annotations

import numpy as np

from importers.problems import Problem
from wallkit.geometry.arrays import FloatArray, IntArray, distinct
from wallkit.walls.checking.free_space import FreeSpace
from wallkit.walls.checking.material import Solids
from wallkit.walls.checking.parts import Parts
from wallkit.walls.walls import Walls


def ball_problems(space: FreeSpace, walls: Walls, places: FloatArray, radii: FloatArray) -> list[Problem]:
    """Tell every ball whose centre is in material, and every ball that no way leads out of a room of its own.

    The room of the level is the outside, if a ball is there; else the largest part that holds a ball, or a larger
    one around it. A ball in another part cannot get there, however small it is.

    Args:
        space: rooms and gaps of the walls.
        walls: the walls.
        places: (n, 2) centres of the balls.
        radii: (n,) their radii.
    """
    parts, solids = space.parts, space.solids
    if parts is None or solids is None or not len(places):
        return []
    buried = solids.contain(places)
    if space.inside and buried.all():
        buried[:] = False  # a plain outline with all balls in it is a room
    innermost = solids.innermost(places)
    problems = [
        _in_material(walls, ball, int(innermost[ball]), places[ball], float(radii[ball]))
        for ball in np.flatnonzero(buried).tolist()
    ]
    free = np.flatnonzero(~buried)
    where = parts.at(places[free])
    level = _level(parts, solids, where)
    return problems + [
        _shut_in(ball, places[ball], float(radii[ball]), parts, level)
        for ball, part in zip(free.tolist(), where.tolist(), strict=True)
        if part != level
    ]


def goal_problems(space: FreeSpace, goals: Walls, places: FloatArray) -> list[Problem]:
    """Tell every goal (a sensor) that no ball can get to, however small: walls part it from all balls.

    Args:
        space: rooms and gaps of the walls.
        goals: the sensors; a ball crosses them, or is inside.
        places: (n, 2) centres of the balls; without any nothing is told.
    """
    parts, solids = space.parts, space.solids
    if parts is None or solids is None or not len(places) or not len(goals):
        return []
    held = parts.at(places)
    starts, ends = goals.vertices[goals.edge_starts], goals.vertices[goals.edge_ends]
    middle = (starts + ends) / 2
    wall = np.repeat(np.arange(len(goals)), np.diff(goals.offsets))[goals.edge_starts]
    reached = np.bincount(wall[np.isin(parts.at(middle), held)], minlength=len(goals)) > 0
    return [_goal(goals, index) for index in np.flatnonzero(~reached).tolist()]


def _level(parts: Parts, solids: Solids, where: IntArray) -> int:
    """The part that is the level, among those that hold balls and those around them; -1 without any."""
    held = distinct(where)
    if not len(held) or parts.outside in held:
        return parts.outside
    candidates = held[np.argsort(-parts.area[held], kind="stable")]
    around = parts.around(int(candidates[0]))
    around = around[~solids.contain(parts.place[around])]
    return int(around[0] if len(around) else candidates[0])


def _in_material(walls: Walls, ball: int, wall: int, at: FloatArray, radius: float) -> Problem:
    where = "outside all rooms" if wall < 0 else f"in the material of {_called(walls, wall)}"
    return Problem(
        code="ball-in-material",
        severity="warning",
        message=f"ball {ball} of radius {radius:.6g} stands {where}",
        fix="move the ball into free space; if the outline around it is meant as a room, say so (--arena)",
        layer=walls.layers[wall] if wall >= 0 else "",
        name=walls.names[wall] if wall >= 0 else "",
        x=float(at[0]),
        y=float(at[1]),
    )


def _shut_in(ball: int, at: FloatArray, radius: float, parts: Parts, level: int) -> Problem:
    rest = "the outside" if level == parts.outside else "the larger room"
    return Problem(
        code="shut-in",
        severity="warning",
        message=f"ball {ball} of radius {radius:.6g} stands in a sealed room: no way leads from it to {rest}",
        fix="open the walls around it, or move the ball; nothing to do if it is meant to stay",
        x=float(at[0]),
        y=float(at[1]),
    )


def _goal(goals: Walls, index: int) -> Problem:
    at = goals.vertices[goals.offsets[index]]
    called = f"sensor {index} ({goals.names[index]!r})" if goals.names[index] else f"sensor {index}"
    return Problem(
        code="unreachable",
        severity="warning",
        message=f"no ball gets to {called}: walls part it from every ball",
        fix="open the walls around it, or move it",
        layer=goals.layers[index],
        name=goals.names[index],
        x=float(at[0]),
        y=float(at[1]),
    )


def _called(walls: Walls, wall: int) -> str:
    name = walls.names[wall]
    return f"wall {wall} ({name!r})" if name else f"wall {wall}"
