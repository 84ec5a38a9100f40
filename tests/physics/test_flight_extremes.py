"""Scenes of any size: the same bits at another power of two, and an error by name where doubles end."""

import numpy as np
import pytest

from wallkit import Balls, Scene, SceneError, Walls, simulate

ROOM = np.array([[0.0, 0.0], [0.0, 3.0], [4.0, 3.0], [4.0, 0.0]])


def scene(size=1.0, pace=1.0, gravity=(0.0, -1.5), radius=0.25, bulge=-0.25):
    walls = Walls.from_polylines([ROOM * size], bulges=[[bulge, 0.0, 0.0, bulge]])
    balls = Balls([[1.5 * size, 1.0 * size]], [[0.75 * size * pace, 1.25 * size * pace]], radius * size)
    return Scene(walls, balls, gravity=None if gravity is None else tuple(size * pace * pace * g for g in gravity))


@pytest.mark.parametrize("gravity", [None, (0.0, -1.5)])
@pytest.mark.parametrize("radius", [0.0, 0.25])
@pytest.mark.parametrize("size", [2.0**190, 2.0**-190])
def test_a_scene_scaled_by_a_power_of_two_has_the_same_bits(size, radius, gravity):
    plain = simulate(scene(radius=radius, gravity=gravity), bounces=40).contacts
    scaled = simulate(scene(size, radius=radius, gravity=gravity), bounces=40).contacts
    for name in ("x", "y"):
        np.testing.assert_array_equal(scaled[name], size * plain[name])
    np.testing.assert_array_equal(scaled["time"], plain["time"])


@pytest.mark.parametrize("gravity", [None, (0.0, -1.5)])
@pytest.mark.parametrize("radius", [0.0, 0.25])
@pytest.mark.parametrize("pace", [2.0**100, 2.0**-100])
def test_a_run_at_another_pace_goes_the_same_way(pace, radius, gravity):
    # where Newton's steps begin may differ, and with it a last digit: 1e-13 after a few bounces of a small room
    plain = simulate(scene(radius=radius, gravity=gravity), bounces=8).contacts
    scaled = simulate(scene(1.0, pace, radius=radius, gravity=gravity), bounces=8).contacts
    for name in ("x", "y"):
        np.testing.assert_allclose(scaled[name], plain[name], rtol=1e-13)
    np.testing.assert_allclose(pace * scaled["time"], plain["time"], rtol=1e-13)


@pytest.mark.parametrize(
    ("size", "pace", "word"),
    [
        (1e200, 1.0, "coordinate"),
        (1e-200, 1.0, "coordinate"),
        (1.0, 1e155, "speed|gravity"),
        (1.0, 1e-162, "speed"),
        (1e50, 1e55, "times the size|a speed|gravity"),
    ],
)
@pytest.mark.parametrize("gravity", [None, (0.0, -1.5)])
def test_beyond_the_numbers_is_an_error_by_name(size, pace, word, gravity):
    with pytest.raises(SceneError, match=word):
        simulate(scene(size, pace, gravity=gravity), bounces=10)


@pytest.mark.parametrize("gravity", [1e80, 1e-80])
def test_gravity_beyond_the_numbers_is_an_error_by_name(gravity):
    with pytest.raises(SceneError, match="gravity"):
        simulate(scene(gravity=(0.0, -gravity)), bounces=10)
