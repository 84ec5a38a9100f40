"""Waves with friction, drag, one-sided and soft walls, and few balls one by one: the same bits."""

import math

import numpy as np
import pytest
from alone import assert_as_alone
from hypothesis import given, settings
from hypothesis import strategies as st

from wallkit import Balls, Ending, Material, Scene, Walls
from wallkit.simulation.prepared import prepare
from wallkit.simulation.survey_backends import WORTH_A_WAVE, suits_wave

COUNT = 3 * WORTH_A_WAVE + 7
SLOWING = [{"rolling_friction": 3.0}, {"drag": 0.2}]


def level(random, *, arcs, one_sided, soft=False, size=1.0):
    """A room of 200 by 150 with sixty corners of two edges in it, of which some are arcs, one-sided or soft."""
    count = 60
    middle, turn = random.uniform([10, 10], [190, 140], (count, 2)), random.uniform(0, math.tau, (count, 2))
    arms = random.uniform(1, 9, (count, 2))[:, :, None] * np.stack([np.cos(turn), np.sin(turn)], axis=2)
    bent = random.uniform(-1.5, 1.5, (count, 2)) * (random.random((count, 2)) < 0.5 * arcs)
    room = np.array([[0.0, 0.0], [200.0, 0.0], [200.0, 150.0], [0.0, 150.0]])
    paths = [room, *np.stack([middle + arms[:, 0], middle, middle + arms[:, 1]], axis=1)]
    materials = [Material(1.0, 1.0), Material(0.8, 0.9), Material(0.5, 1.0), Material(0.0, 0.0)]
    return Walls.from_polylines(
        [size * path for path in paths],
        closed=[True] + [False] * count,
        bulges=[np.zeros(4), *(np.array([*pair, 0.0]) for pair in bent)],
        sides=["both"] + ["outward" if one_sided and k % 3 else "both" for k in range(count)],
        material=[materials[k] for k in random.integers(0, 4, count + 1)] if soft else Material(),
    )


def thrown(random, radius, speed=50.0, size=1.0):
    """Balls anywhere in the room: discs may overlap walls, and stand across one-sided ones."""
    turn = random.uniform(0, math.tau, COUNT)
    velocity = size * speed * np.stack([np.cos(turn), np.sin(turn)], axis=1)
    return Balls(size * random.uniform([5, 5], [195, 145], (COUNT, 2)), velocity, size * radius)


def assert_same(scene, **limits):
    assert suits_wave(prepare(scene, check=False).modelled.model, np.asarray(scene.balls.radius))
    return assert_as_alone(scene, WORTH_A_WAVE - 1, **limits)


@pytest.mark.parametrize("slowing", SLOWING, ids=["friction", "drag"])
@pytest.mark.parametrize("limits", [{"until": 12.0}, {"until": 60.0}, {"bounces": 9}, {"until": 12.0, "bounces": 9}])
@pytest.mark.parametrize("radius", [0.0, 0.7])
@pytest.mark.parametrize("arcs", [False, True])
def test_balls_that_something_slows_down(arcs, radius, limits, slowing):
    random = np.random.default_rng(1)
    scene = Scene(level(random, arcs=arcs, one_sided=False), thrown(random, radius), **slowing)
    totals = assert_same(scene, **limits)
    assert totals.bounces.sum() > 300
    # 50 units/s at 3 units/s^2 last for 17 s
    assert limits.get("until") != 60.0 or "drag" in slowing or np.all(totals.ending == Ending.AT_REST)


@pytest.mark.parametrize("radius", [0.0, 0.7, 4.0])
@pytest.mark.parametrize("arcs", [False, True])
def test_one_sided_walls(arcs, radius):
    random = np.random.default_rng(2)
    assert (
        assert_same(Scene(level(random, arcs=arcs, one_sided=True), thrown(random, radius)), until=20.0).hits[1:].sum()
    )


@pytest.mark.parametrize("radius", [0.0, 0.7])
def test_points_and_discs_aimed_at_vertices_of_one_sided_walls(radius):
    random = np.random.default_rng(3)
    walls = level(random, arcs=True, one_sided=True)
    position = random.integers([1, 1], [200, 150], (COUNT, 2)) + 0.5
    velocity = walls.vertices[random.integers(0, len(walls.vertices), COUNT)] - position
    assert_same(Scene(walls, Balls(position, velocity, radius), rolling_friction=0.5), until=20.0)


@settings(max_examples=12)
@given(
    st.integers(0, 2**32 - 1),
    st.sampled_from([1e-6, 1.0, 1e9]),
    st.sampled_from([0.0, 0.01, 0.7, 6.0]),
    st.tuples(st.booleans(), st.booleans(), st.booleans()),
    st.sampled_from([{}, {"rolling_friction": 2.0}, {"drag": 0.1}]),
)
def test_any_level_with_anything_that_acts(seed, size, radius, kinds, slowing):
    arcs, one_sided, soft = kinds
    random = np.random.default_rng(seed)
    walls = level(random, arcs=arcs, one_sided=one_sided, soft=soft, size=size)
    if "rolling_friction" in slowing:
        slowing = {"rolling_friction": size * slowing["rolling_friction"]}
    assert_same(Scene(walls, thrown(random, radius, size=size), **slowing), until=15.0)
