"""How many flights are to come: so much work on an index pays."""

from __future__ import annotations

import numpy as np

from wallkit.scene.scene import Scene
from wallkit.simulation.edge_records import columns

ASKED = 256
"""Balls whose speed is asked, at equal steps among all: the estimate need not be better than by half."""


def expected_flights(
    scene: Scene, box: tuple[float, float, float, float], length: float, until: float, bounces: float
) -> float:
    """Estimate how many flights balls will make: a length of flight over the mean free path pi A / P, each.

    A is the area of the walls' box, P the length of their chords, twice that of open ones, which have two sides, and
    2 pi r more for the ends of an open one, around which centres of discs turn. That path is exact for points in a room
    that balls mix well in; here it decides on speed alone. Under gravity balls are as quick as they will be in the
    middle of the time.

    Args:
        scene: walls, balls, and what acts.
        box: around the vertices.
        length: of all chords, those of open walls twice.
        until: seconds, or inf.
        bounces: most of a ball.
    """
    walls, balls = scene.walls, scene.balls
    low_x, low_y, high_x, high_y = box
    turns = 2 * np.pi * float(np.mean(balls.radius)) * np.count_nonzero(~walls.closed) if len(balls) else 0.0
    with np.errstate(invalid="ignore", divide="ignore", over="ignore"):
        path = np.pi * (high_x - low_x) * (high_y - low_y) / max(length + turns, 1e-300)
        vx, vy = columns(np.asarray(balls.velocity, dtype=np.float64)[:: max(1, len(balls) // ASKED)])
        speed = np.sqrt(vx * vx + vy * vy)
        if scene.gravity is not None:
            speed = speed + np.hypot(*scene.gravity) * until / 2
        return float(np.fmin(speed * until / path, bounces).sum()) * (len(balls) / max(len(speed), 1))
