"""Surveys of balls that fly together, held against the same balls flown alone."""

import numpy as np

from wallkit import Balls, Scene, survey


def assert_as_alone(scene, few, **limits):
    """Compare a survey with ones of parts of so few balls that each is flown alone; give its totals."""
    together = survey(scene, check=False, **limits)
    position, velocity, radius = scene.balls.position, scene.balls.velocity, scene.balls.radius
    hits = 0
    for first in range(0, len(position), few):
        part = slice(first, first + few)
        balls = Balls(position[part], velocity[part], radius[part])
        alone = survey(Scene(scene.walls, balls), check=False, **limits)
        hits = hits + alone.hits
        for name in ("bounces", "position", "velocity", "time", "ending"):
            np.testing.assert_array_equal(getattr(together, name)[part], getattr(alone, name), err_msg=name)
    np.testing.assert_array_equal(together.hits, hits)
    assert together.hits.sum() == together.bounces.sum()
    return together
