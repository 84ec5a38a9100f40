"""Many balls in lockstep and few one by one: the same bits."""

import math

import numpy as np
import pytest
from alone import assert_as_alone

from wallkit import Balls, Ending, Scene, Walls
from wallkit.accuracy import scenes
from wallkit.kernels.batches.lockstep_lanes import LANES
from wallkit.simulation.prepared import prepare
from wallkit.simulation.survey_backends import WORTH_LOCKSTEP, suits_lockstep

BOX = [[0.0, 0.0], [40.0, 0.0], [40.0, 30.0], [0.0, 30.0]]
ROOM = Walls.from_polylines(
    [
        BOX,
        [[18.0, 13.0], [22.0, 13.0], [20.0, 17.0]],
        [[8.0, 5.0], [8.0, 25.0]],
        [[30.0, 4.0], [33.0, 9.0], [30.0, 9.0]],
    ],
    closed=[True, True, False, False],
)
"""Four walls, corners inside and outside, free ends."""


def _assert_same(scene, **limits):
    """Compare a survey in lockstep with one of parts so small that each ball is flown alone; give the totals."""
    assert suits_lockstep(prepare(scene, check=False).modelled.model, np.asarray(scene.balls.radius))
    return assert_as_alone(scene, WORTH_LOCKSTEP - 1, **limits)


def _ways(random, count, slowest=1.0):
    turns = random.uniform(0, math.tau, count)
    return random.uniform(slowest, 60, count)[:, None] * np.stack([np.cos(turns), np.sin(turns)], axis=1)


@pytest.mark.parametrize("limits", [{"until": 50.0}, {"bounces": 40}, {"until": 9.0, "bounces": 12}, {"until": 0.0}])
@pytest.mark.parametrize("radius", [0.0, 5.0])
def test_lockstep_gives_the_bits_of_one_by_one(radius, limits):
    random = np.random.default_rng(2)
    balls = Balls(random.uniform(-30, 30, (3 * LANES + 7, 2)), _ways(random, 3 * LANES + 7), radius)
    _assert_same(Scene(scenes.star(), balls), **limits)


@pytest.mark.parametrize("radius", [0.0, 0.7, 3.0])
def test_walls_corners_and_free_ends(radius):
    random = np.random.default_rng(3)
    position = random.uniform([-20.0, -20.0], [60.0, 50.0], (500, 2))  # some outside, some over walls
    totals = _assert_same(Scene(ROOM, Balls(position, _ways(random, 500), radius)), until=30.0)
    assert (totals.hits > 50).all()
    assert set(totals.ending) >= {Ending.TIME_REACHED, Ending.LEFT_SCENE}


@pytest.mark.parametrize("radius", [0.0, 0.7])
def test_balls_aimed_at_vertices(radius):
    random = np.random.default_rng(4)
    vertices = ROOM.vertices[random.integers(0, len(ROOM.vertices), 400)]
    position = random.integers([1, 1], [40, 30], (400, 2)) + 0.5
    totals = _assert_same(Scene(ROOM, Balls(position, vertices - position, radius)), until=20.0)
    assert totals.bounces.sum() > 1000
    assert radius > 0.0 or Ending.AMBIGUOUS_CORNER in totals.ending


def test_points_that_start_on_walls_and_corners():
    random = np.random.default_rng(5)
    along = random.integers(0, 9, 300)[:, None] / 8.0  # 0 and 1 are corners
    edge = random.integers(0, 4, 300)
    box = np.array(BOX)
    position = box[edge] * (1 - along) + box[(edge + 1) % 4] * along
    velocity = random.integers(-2, 3, (300, 2)).astype(float)  # some at rest, some along the wall
    totals = _assert_same(Scene(Walls.from_polylines([BOX]), Balls(position, velocity, 0.0)), until=60.0)
    assert Ending.AT_REST in totals.ending


@pytest.mark.parametrize("limits", [{"until": 7.0}, {"until": 1e300, "bounces": 3000}])
@pytest.mark.parametrize("radius", [0.0, 2.0])
def test_balls_caught_between_walls(radius, limits):
    walls = Walls.from_polylines([[[0.0, -2.0], [90.0, -2.0]], [[0.0, 2.0], [90.0, 2.0]]], closed=False)
    random = np.random.default_rng(6)
    position = np.stack([random.uniform(5, 85, 200), random.uniform(-1e-14, 1e-14, 200)], axis=1)
    velocity = np.stack([np.zeros(200), random.uniform(1, 30, 200)], axis=1)
    totals = _assert_same(Scene(walls, Balls(position, velocity, radius)), **limits)
    assert radius == 0.0 or Ending.COLLAPSE in totals.ending


def test_points_that_fly_along_the_line_of_a_wall_towards_it():
    random = np.random.default_rng(8)
    angle = random.uniform(0.0, math.pi, 8)
    way = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    middle = np.stack([np.arange(8) * 100.0, random.uniform(0.0, 50.0, 8)], axis=1)
    walls = Walls.from_polylines(list(np.stack([middle - 9.0 * way, middle + 9.0 * way], axis=1)), closed=False)
    of = np.arange(2000) % 8
    position = middle[of] + random.uniform(10.0, 30.0, 2000)[:, None] * way[of]
    _assert_same(Scene(walls, Balls(position, -way[of], 0.0)), until=50.0)


@pytest.mark.parametrize("late", [1e-9, 0.05, 0.5])
def test_discs_that_run_head_on_into_an_end_just_in_time(late):
    random = np.random.default_rng(9)
    turn = random.uniform(-1.5, 1.5, 300)  # the wall lies the other way
    way = np.stack([np.cos(turn), np.sin(turn)], axis=1)
    walls = Walls.from_polylines([[[0.0, 0.0], [-50.0, 0.0]]], closed=False)
    totals = _assert_same(Scene(walls, Balls(10.0 * way, -way, 1.0)), until=9.0 + late)
    assert (totals.bounces == 1).all()


@pytest.mark.parametrize("speed", [1e-150, 1e-100, 1e100, 1e150])
def test_speeds_whose_squares_are_at_the_ends_of_what_floats_hold(speed):
    random = np.random.default_rng(7)
    turns = random.uniform(0, math.tau, 200)
    velocity = speed * np.stack([np.cos(turns), np.sin(turns)], axis=1)
    _assert_same(Scene(scenes.star(), Balls(random.uniform(-30, 30, (200, 2)), velocity, 5.0)), bounces=30)
