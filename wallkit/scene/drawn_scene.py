"""A drawing as walls and balls: what a drawing and a scene file that names it have in common."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from importers.drawing import Drawing
from importers.problems import Problem
from wallkit.scene.scene import Balls
from wallkit.walls import Walls
from wallkit.walls.import_options import ImportOptions
from wallkit.walls.importing.drawn_balls import drawn_balls
from wallkit.walls.importing.pipeline import build_walls

SPEED, ANGLE = 50.0, 30.0
"""Of a ball whose velocity nobody said: units per second, and degrees from the x axis towards the y axis."""


@dataclass(slots=True)
class Drawn:
    """What a drawing holds.

    Attributes:
        walls: imported; their own ``problems`` are with them.
        balls: that are drawn; one without a velocity has the usual one.
        still: some ball was drawn without a velocity.
        used: the balls of the scene are these.
        problems: of the balls' drawing.
    """

    walls: Walls
    balls: Balls
    still: bool
    problems: list[Problem]
    used: bool = True


def drawn_scene(drawing: Drawing, options: ImportOptions, balls: NDArray[np.float64] | None = None) -> Drawn:
    """Read walls and balls from a drawing.

    Args:
        drawing: as read.
        options: how it becomes walls; scale and flip act on the balls, too.
        balls: (n, 2) places of balls that are not drawn, see :func:`wallkit.walls.importing.pipeline.build_walls`.
    """
    walls = build_walls(drawing, options, balls)
    found, problems = drawn_balls(drawing, options.scale, options.flip_y)
    usual = SPEED * math.cos(math.radians(ANGLE)), SPEED * math.sin(math.radians(ANGLE))
    velocity = [usual if ball.velocity is None else ball.velocity for ball in found]
    return Drawn(
        walls,
        Balls(
            np.array([(ball.x, ball.y) for ball in found]).reshape(-1, 2),
            np.array(velocity).reshape(-1, 2),
            np.array([ball.radius for ball in found]),
        ),
        any(ball.velocity is None for ball in found),
        problems,
    )
