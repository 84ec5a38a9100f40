"""The simulator itself against the multi-precision reference, scored by the scene's own growth of a rounding."""

import math

import numpy as np
import pytest

from wallkit import Balls, Scene
from wallkit.accuracy import scenes
from wallkit.accuracy.departure import departure, true_error

BOUNCES = {"box": 1000, "star": 1000, "wedge": 1000, "maze": 300, "curve": 40, "stadium": 40, "sinai": 50}
CASES = [(scene, radius) for scene in scenes.built_in() for radius in (0.0, scene.radius)]
NAMES = [f"{scene.name}-{radius:g}" for scene, radius in CASES]


@pytest.mark.parametrize(("built_in", "radius"), CASES, ids=NAMES)
def test_errors_grow_no_faster_than_the_scene_makes_them(built_in, radius):
    error, rms, promised = true_error(built_in.scene(radius=radius), BOUNCES[built_in.name])
    # rms is what one rounding of place, velocity and wall a bounce grows to; ten times that for several of them
    # in a bounce, and up to where the error is small enough for its growth to be linear.
    linear = rms < 1e-4
    assert np.all(error[linear] <= 10 * rms[linear])
    assert not np.any(error[:promised] > 1e-6)


@pytest.mark.parametrize(("built_in", "radius"), CASES, ids=NAMES)
def test_the_promise_is_kept_and_not_shy(built_in, radius):
    found = departure(built_in, radius, min(BOUNCES[built_in.name], 200))
    if found.real is None:
        assert found.promised == found.bounces
    else:
        assert found.promised <= found.real <= 1.3 * found.promised


@pytest.mark.parametrize("seed", range(6))
def test_promises_are_kept_from_random_starts(seed):
    random = np.random.default_rng(seed)
    built = scenes.built_in()[1 if seed % 2 else 3]
    turn = random.uniform(0, math.tau)
    aim = 50 * np.array([math.cos(turn), math.sin(turn)])
    scene = Scene(built.lines(0.0), Balls([built.position], [aim], built.radius))
    error, _, promised = true_error(scene, 150)
    assert not np.any(error[:promised] > 1e-6)
