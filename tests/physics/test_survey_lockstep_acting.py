"""Gravity, friction, drag, soft walls and one-sided ones in lockstep: the bits of balls that are flown alone."""

import math

import numpy as np
import pytest
from alone import assert_as_alone

from wallkit import Balls, Material, Scene, Walls
from wallkit.kernels.batches.lockstep_lanes import LANES
from wallkit.simulation.prepared import prepare
from wallkit.simulation.survey_backends import WORTH_LOCKSTEP, suits_lockstep

LINES = [
    [[0.0, 0.0], [40.0, 0.0], [44.0, 30.0], [-3.0, 30.0]],
    [[18.0, 13.0], [22.0, 13.0], [20.0, 17.0]],
    [[8.0, 5.0], [8.0, 25.0]],
    [[30.0, 4.0], [33.0, 9.0], [30.0, 9.0]],
]
"""Level and leaning walls, overhangs, corners inside and outside, free ends."""
DOWN = {"gravity": (0.0, -40.0)}
SOFT = [Material(0.8, 0.9), Material(0.0, 1.0), Material(1.0, 0.6), Material(0.0, 0.0)]
"""By wall: loses some speed, kills the bounce, brakes, absorbs."""
CLOSED = [True, True, False, False]
HARD = Walls.from_polylines(LINES, closed=CLOSED)


def _walls(material, sides="both"):
    return Walls.from_polylines(LINES, closed=CLOSED, sides=sides, material=material)


def _assert_same(scene, **limits):
    assert suits_lockstep(prepare(scene, check=False).modelled.model, np.asarray(scene.balls.radius))
    return assert_as_alone(scene, WORTH_LOCKSTEP - 1, **limits)


def _ways(random, count):
    turns = random.uniform(0, math.tau, count)
    return random.uniform(0, 60, count)[:, None] * np.stack([np.cos(turns), np.sin(turns)], axis=1)


@pytest.mark.parametrize("radius", [0.0, 0.7])
@pytest.mark.parametrize(
    ("walls", "acts"),
    [
        (HARD, DOWN),
        (_walls(SOFT, ["both", "outward", "both", "outward"]), {"gravity": (13.0, -9.0), "rolling_friction": 0.1}),
        (_walls(SOFT, ["both", "outward", "outward", "both"]), {"rolling_friction": 0.5}),
        (HARD, {"drag": 0.3}),
    ],
)
def test_all_that_acts(walls, acts, radius):
    random = np.random.default_rng(3)
    position = random.uniform([-10.0, -10.0], [50.0, 40.0], (4 * LANES + 9, 2))  # some outside, some over walls
    velocity = _ways(random, len(position))
    velocity[:20] = 0.0
    assert _assert_same(Scene(walls, Balls(position, velocity, radius), **acts), until=9.0).bounces.sum() > 500


@pytest.mark.parametrize("radius", [0.0, 0.7])
@pytest.mark.parametrize("limits", [{"until": 20.0}, {"bounces": 25}, {"until": 0.0}, {"until": 1e300, "bounces": 9}])
def test_limits_under_gravity(radius, limits):
    random = np.random.default_rng(4)
    position = random.uniform([1.0, 1.0], [39.0, 29.0], (3 * LANES + 1, 2))
    scene = Scene(HARD, Balls(position, _ways(random, len(position)), radius), **DOWN)
    _assert_same(scene, **limits)


@pytest.mark.parametrize("radius", [0.0, 1.0])
@pytest.mark.parametrize("e", [1.0, 0.7, 0.0])
def test_flights_into_vertices_and_from_walls(radius, e):
    random = np.random.default_rng(5)
    walls = _walls(Material(e, 1.0))  # soft walls, too
    vertices = walls.vertices[random.integers(0, len(walls.vertices), 400)]
    position = random.integers([1, 1], [40, 30], (400, 2)) + 0.5
    position[:100, 1] = radius  # in touch with the floor
    # After the time t a ball thrown with (q - p) / t - g t / 2 is at q.
    t = random.integers(1, 4, 400)[:, None] / 2.0
    velocity = (vertices - position) / t - 0.5 * t * np.array(DOWN["gravity"])
    assert _assert_same(Scene(walls, Balls(position, velocity, radius), **DOWN), until=9.0).bounces.sum() > 1000


@pytest.mark.parametrize("radius", [0.0, 2.0])
@pytest.mark.parametrize("pull", [(0.0, -10.0), (10.0, 0.0), (-7.0, -7.0)])
def test_balls_in_wedges_and_between_walls(radius, pull):
    lines = [[[0.0, 0.0], [90.0, 4.1]], [[0.0, 0.0], [90.0, -4.1]], [[90.0, -4.1], [90.0, 4.1]]]
    random = np.random.default_rng(6)
    position = np.stack([random.uniform(50, 85, 200), random.uniform(-0.01, 0.01, 200)], axis=1)
    scene = Scene(Walls.from_polylines(lines, closed=False), Balls(position, _ways(random, 200), radius), gravity=pull)
    _assert_same(scene, until=15.0, bounces=3000)


@pytest.mark.parametrize("speed", [0.0, 1e-60, 1e60])
def test_speeds_far_from_that_of_the_fall(speed):
    random = np.random.default_rng(7)
    position = random.uniform([1.0, 1.0], [39.0, 29.0], (200, 2))
    scene = Scene(HARD, Balls(position, speed * _ways(random, 200), 0.5), **DOWN)
    _assert_same(scene, bounces=20)
