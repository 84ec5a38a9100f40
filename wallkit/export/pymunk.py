"""pymunk: a Python module that adds the walls to a space, as segments that know their neighbours.

Without ``set_neighbors`` a ball that meets the seam of two segments is pushed by both and gains speed.
"""

from __future__ import annotations

from typing import TextIO

from wallkit.export.level import Level, LevelWall
from wallkit.export.losses import say_friction
from wallkit.export.number_text import Rows

_HEAD = '''"""Walls for pymunk 7, written by wallkit export.

    import pymunk, level
    space = pymunk.Space()
    level.add_walls(space)

The y axis points down, as in pygame. pymunk multiplies the restitutions of a pair: give a ball elasticity 1 for the
wall's to count. Choose the step so that a ball moves by less than its radius in it.
"""

import pymunk

ONE_WAY = 0x57A11  # collision type of walls that stop only what comes against their outward normal
WALLS = [
'''
_TAIL = '''

def add_walls(space, radius=0.0):
    """Add all walls to the space's static body and return their segments, each with its entry of WALLS as `.wall`.

    `radius` makes the walls thicker, for fast balls.
    """
    segments = []
    for wall in WALLS:
        points = wall["points"]
        last = len(points) if wall["closed"] else len(points) - 1
        for i in range(last):
            a, b = points[i], points[(i + 1) % len(points)]
            segment = pymunk.Segment(space.static_body, a, b, radius)
            before = points[i - 1] if i or wall["closed"] else a
            behind = points[(i + 2) % len(points)] if i + 1 < last or wall["closed"] else b
            segment.set_neighbors(before, behind)
            segment.elasticity = wall["restitution"]
            segment.friction = 0.0
            segment.wall = wall
            if wall["one_way"]:
                segment.collision_type = ONE_WAY
            segments.append(segment)
    space.add(*segments)
    if any(wall["one_way"] for wall in WALLS):
        space.on_collision(ONE_WAY, None, pre_solve=_only_from_outside)
    return segments


def _only_from_outside(arbiter, space, data):
    segment, ball = arbiter.shapes
    normal = arbiter.normal  # from the first shape to the second
    if not hasattr(segment, "wall"):
        segment, ball, normal = ball, segment, -normal
    edge = segment.b - segment.a
    outward = pymunk.Vec2d(edge.y, -edge.x)
    if normal.dot(outward) <= 0 or ball.body.velocity.dot(outward) > 0:
        arbiter.process_collision = False
'''


def write(level: Level, stream: TextIO) -> None:
    """Write a level as a Python module."""
    say_friction(level, "tangential_restitution")
    stream.write(_HEAD)
    for wall in level:
        _wall(wall).write(stream)
    stream.write(f"]\n{_TAIL}")


def _wall(wall: LevelWall) -> Rows:
    marks = repr(
        {
            "name": wall.name,
            "layer": wall.layer,
            "closed": wall.closed and len(wall.vertices) > 2,
            "one_way": wall.one_way,
            "restitution": float(wall.material.restitution),
            "tangential_restitution": float(wall.material.tangential_restitution),
        }
    )
    return Rows("(%r, %r)", wall.vertices, before=f"    {marks[:-1]}, 'points': [", after="]},\n")
