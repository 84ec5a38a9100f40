"""Many balls in lockstep and few one by one: the same bits."""

import math

import numpy as np
import pytest

from wallkit import Balls, Scene, survey
from wallkit.accuracy import scenes


@pytest.mark.parametrize("radius", [0.0, 5.0])
def test_lockstep_gives_the_bits_of_one_by_one(radius):
    random = np.random.default_rng(2)
    turns = random.uniform(0, math.tau, 300)
    position = random.uniform(-30, 30, (300, 2))
    velocity = random.uniform(1, 60, 300)[:, None] * np.stack([np.cos(turns), np.sin(turns)], axis=1)
    walls = scenes.star()
    together = survey(Scene(walls, Balls(position, velocity, radius)), until=50.0)
    for first in range(0, 300, 60):  # so few are flown one by one
        part = slice(first, first + 60)
        alone = survey(Scene(walls, Balls(position[part], velocity[part], radius)), until=50.0)
        assert np.array_equal(alone.bounces, together.bounces[part])
        assert np.array_equal(alone.position, together.position[part])
        assert np.array_equal(alone.velocity, together.velocity[part])
