"""Surveys of balls that fly together, held against the same balls flown alone, or without an index."""

from dataclasses import replace

import numpy as np

from wallkit import Balls, survey
from wallkit.simulation.modelled import Modelled
from wallkit.simulation.prepared import PreparedScene, prepare


def flown(scene, index="grid", **limits):
    """Totals with a fine index, as surveys make it, or with none, and what the kernels see of the scene."""
    modelled = Modelled(scene, index=index, machine_code=True, limits=None)
    return survey(PreparedScene(scene, modelled, None), **limits), modelled


def assert_same_bits(one, other):
    for name in ("bounces", "position", "velocity", "time", "hits", "ending"):
        assert getattr(one, name).tobytes() == getattr(other, name).tobytes(), name


def assert_as_alone(scene, few, **limits):
    """Compare a survey with ones of parts of so few balls that each is flown alone; give its totals.

    All are prepared, so that they have the same index: of discs that overlap walls at the start it says which is met.
    """
    together = survey(prepare(scene, check=False), **limits)
    position, velocity, radius = scene.balls.position, scene.balls.velocity, scene.balls.radius
    hits = 0
    for first in range(0, len(position), few):
        part = slice(first, first + few)
        balls = Balls(position[part], velocity[part], radius[part])
        alone = survey(prepare(replace(scene, balls=balls), check=False), **limits)
        hits = hits + alone.hits
        for name in ("bounces", "position", "velocity", "time", "ending"):
            np.testing.assert_array_equal(getattr(together, name)[part], getattr(alone, name), err_msg=name)
    np.testing.assert_array_equal(together.hits, hits)
    assert together.hits.sum() == together.bounces.sum()
    return together
