"""A drawing as walls and balls: what a drawing and a scene file that names it have in common."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from importers.drawing import Drawing
from importers.problems import Problem
from wallkit.scene.scene import Balls
from wallkit.walls import Walls
from wallkit.walls.import_options import ImportOptions
from wallkit.walls.importing.drawn_balls import drawn_balls
from wallkit.walls.importing.pipeline import walls_and_lines
from wallkit.walls.importing.placing import placed
from wallkit.walls.met_lines import MetLines
from wallkit.walls.walls import ARRAYS

SPEED, ANGLE = 50.0, 30.0
"""Of a ball whose velocity nobody said: units per second, and degrees from the x axis towards the y axis."""


@dataclass(slots=True, eq=False)
class Drawn:
    """What a drawing holds.

    Attributes:
        walls: imported; their own ``problems`` are with them, their sensors are not.
        balls: that are drawn; one without a velocity has the usual one.
        still: some ball was drawn without a velocity.
        used: the balls of the scene are these.
        problems: of the balls' drawing.
        sensors: that are drawn, or None.
        met: where the walls meet, if that was looked for.
    """

    walls: Walls
    balls: Balls
    still: bool
    problems: list[Problem]
    used: bool = True
    sensors: Walls | None = None
    met: MetLines | None = None


def drawn_scene(drawing: Drawing, options: ImportOptions, balls: NDArray[np.float64] | None = None) -> Drawn:
    """Read walls and balls from a drawing.

    Args:
        drawing: as read.
        options: how it becomes walls; scale and flip act on the balls, too.
        balls: (n, 2) places of balls that are not drawn, see :func:`wallkit.walls.importing.pipeline.walls_and_lines`.
    """
    drawing = placed(drawing, options)
    built, met = walls_and_lines(drawing, options, balls)
    walls, sensors = apart(built)
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
        sensors=sensors,
        met=met,
    )


def apart(walls: Walls) -> tuple[Walls, Walls | None]:
    """Part walls from the sensors that came with them: a scene has each in its own place."""
    return (walls, None) if walls.sensors is None else (replace(walls, sensors=None), walls.sensors)


def together(first: Walls | None, second: Walls | None) -> Walls | None:
    """Put walls behind others, in the units and axes of the first."""
    if first is None or second is None:
        return second if first is None else first
    parts = [*first, *second]
    made = Walls.from_polylines(
        [wall.vertices for wall in parts],
        [wall.closed for wall in parts],
        bulges=[wall.bulges for wall in parts],
        sides=[wall.sides for wall in parts],
        material=[wall.material for wall in parts],
        names=[wall.name for wall in parts],
        layers=[wall.layer for wall in parts],
        origins=[wall.origin for wall in parts],
    )
    made.depth = np.concatenate([first.depth, second.depth])
    return replace(first, **{name: getattr(made, name) for name in ARRAYS})
