"""What the formats of the Box2D family share: chains that are ready for it."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from wallkit.export.level import Level, LevelWall
from wallkit.export.losses import say_friction
from wallkit.geometry.arrays import FloatArray


def is_loop(wall: LevelWall) -> bool:
    """It is a chain that closes; a ring of two vertices is a line."""
    return wall.closed and len(wall.vertices) > 2


def for_four(vertices: FloatArray) -> FloatArray:
    """Give a triangle a fourth vertex, in the middle of its longest edge: chains of Box2D v3 have four at least."""
    if len(vertices) != 3:
        return vertices
    following = np.roll(vertices, -1, axis=0)
    longest = int(np.hypot(*(following - vertices).T).argmax())
    return np.insert(vertices, longest + 1, (vertices[longest] + following[longest]) / 2, axis=0)


def say_box2d(level: Level, kept: str, keeps: Callable[[LevelWall], bool]) -> None:
    """Say what no Box2D keeps: friction, and one-way walls but those that ``keeps`` holds for."""
    say_friction(level, kept)
    level.findings.note_where(
        "export-one-way",
        level.walls,
        lambda wall: wall.one_way and not keeps(wall),
        f"the wall stops from both sides, not from outside alone; it is kept as {kept}",
        "let the game decide by the outward normal",
    )
