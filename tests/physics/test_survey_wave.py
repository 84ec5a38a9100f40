"""Many balls as a wave through the grid and few one by one: the same bits."""

import math

import numpy as np
import pytest
from alone import assert_as_alone
from hypothesis import given, settings
from hypothesis import strategies as st

from wallkit import Balls, Ending, Material, Scene, Walls, survey
from wallkit.kernels.batches.wave import NEAR_EDGES
from wallkit.kernels.batches.wave_columns import PER_TURN
from wallkit.kernels.batches.wave_pairs import LONG, LONGEST, SHORT, note_short_lists
from wallkit.kernels.intrinsics import AT_ONCE
from wallkit.kernels.jit import compiled
from wallkit.kernels.records import in_lists
from wallkit.simulation import survey_backends
from wallkit.simulation.prepared import prepare
from wallkit.simulation.survey_backends import WORTH_A_WAVE, suits_wave

COUNT = 3 * WORTH_A_WAVE + 7


def _assert_same(scene, **limits):
    """Compare a survey as a wave with one of parts so small that each ball is flown alone; give the totals."""
    assert suits_wave(prepare(scene, check=False).modelled.model, np.asarray(scene.balls.radius))
    return assert_as_alone(scene, WORTH_A_WAVE - 1, **limits)


def _ways(random, count, speed=50.0):
    turns = random.uniform(0, math.tau, count)
    return speed * np.stack([np.cos(turns), np.sin(turns)], axis=1)


def _maze(random, count=300, arcs=False, materials=None):
    """A room of 200 by 150 with short walls in it, every second one an arc if so asked; the last stands outside."""
    middle, turn = random.uniform([8, 8], [192, 142], (count, 2)), random.uniform(0, np.pi, count)
    arm = random.uniform(0.5, 6, count)[:, None] * np.stack([np.cos(turn), np.sin(turn)], axis=1)
    middle[-1] = 300.0, 60.0
    lines = [np.array([[0.0, 0.0], [200.0, 0.0], [200.0, 150.0], [0.0, 150.0]])]
    lines += list(np.stack([middle - arm, middle + arm], axis=1))
    bulges = None
    if arcs:
        bent = random.uniform(-1.5, 1.5, count) * (np.arange(count) % 2)
        bulges = [np.zeros(4)] + [np.array([b, 0.0]) for b in bent]
    return Walls.from_polylines(lines, closed=[True] + [False] * count, bulges=bulges, material=materials)


@pytest.mark.parametrize("limits", [{"until": 20.0}, {"bounces": 40}, {"until": 9.0, "bounces": 12}, {"until": 0.0}])
@pytest.mark.parametrize("radius", [0.0, 0.5, 3.0])
@pytest.mark.parametrize("arcs", [False, True])
def test_a_wave_gives_the_bits_of_one_by_one(arcs, radius, limits):
    random = np.random.default_rng(2)
    walls = _maze(random, arcs=arcs)
    position = random.uniform([-20.0, -20.0], [230.0, 180.0], (COUNT, 2))  # some outside, some over walls
    totals = _assert_same(Scene(walls, Balls(position, _ways(random, COUNT), radius)), **limits)
    assert limits.get("until") == 0.0 or (totals.bounces.sum() > 1000 and Ending.LEFT_SCENE in totals.ending)


@pytest.mark.parametrize("radius", [0.0, 0.05])
@pytest.mark.parametrize("arcs", [False, True])
def test_so_many_edges_that_two_waves_fly_in_turn(arcs, radius):
    random = np.random.default_rng(12)
    walls = _maze(random, count=33_000, arcs=arcs)
    position = random.uniform([1.0, 1.0], [199.0, 149.0], (COUNT, 2))
    scene = Scene(walls, Balls(position, _ways(random, COUNT), radius))
    ready = prepare(scene, check=False)
    assert len(ready.modelled.model.lines) > NEAR_EDGES
    assert ready.order is not None
    assert sorted(ready.order) == list(range(COUNT))
    assert _assert_same(scene, until=2.0).bounces.sum() > 10_000


@pytest.mark.parametrize("radius", [0.0, 0.5])
def test_walls_that_slow_stop_and_absorb(radius):
    random = np.random.default_rng(3)
    materials = [Material(*pair) for pair in ((1.0, 1.0), (0.8, 0.9), (0.5, 1.0), (0.0, 0.0))]
    walls = _maze(random, arcs=True, materials=[materials[k] for k in random.integers(0, 4, 301)])
    position = random.uniform([1.0, 1.0], [199.0, 149.0], (COUNT, 2))
    totals = _assert_same(Scene(walls, Balls(position, _ways(random, COUNT), radius)), until=60.0)
    assert Ending.ABSORBED in totals.ending


@pytest.mark.parametrize("radius", [0.0, 0.4])
@pytest.mark.parametrize("arcs", [False, True])
def test_balls_aimed_at_vertices(arcs, radius):
    random = np.random.default_rng(4)
    walls = _maze(random, arcs=arcs)
    vertices = walls.vertices[random.integers(0, len(walls.vertices), COUNT)]
    position = random.integers([1, 1], [200, 150], (COUNT, 2)) + 0.5
    _assert_same(Scene(walls, Balls(position, vertices - position, radius)), until=20.0)


@pytest.mark.parametrize("bulge", [0.0, 0.02, -0.02])
def test_points_that_start_on_walls_and_vertices(bulge):
    random = np.random.default_rng(5)
    angle = np.arange(40) * math.tau / 40
    ring = 100.0 * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    walls = Walls.from_polylines([ring], bulges=[np.full(40, bulge)])
    along, edge = random.integers(0, 9, COUNT)[:, None] / 8.0, random.integers(0, 40, COUNT)
    position = ring[edge] * (1 - along) + ring[(edge + 1) % 40] * along
    velocity = random.integers(-2, 3, (COUNT, 2)).astype(float)  # some at rest, some along the wall
    totals = _assert_same(Scene(walls, Balls(position, velocity, 0.0)), until=600.0)
    assert Ending.AT_REST in totals.ending


@pytest.mark.parametrize("radius", [0.0, 5.0, 30.0, 120.0])
def test_a_round_room_from_inside_and_outside(radius):
    random = np.random.default_rng(6)
    angle = np.arange(24) * math.tau / 24
    ring = 100.0 * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    walls = Walls.from_polylines([ring], bulges=[np.full(24, math.tan(math.tau / 96))])
    position = random.uniform(-60, 60, (COUNT, 2)) + np.where(np.arange(COUNT) % 3 == 0, 300.0, 0.0)[:, None]
    velocity = _ways(random, COUNT) - 0.1 * position
    totals = _assert_same(Scene(walls, Balls(position, velocity, radius)), until=80.0)
    assert radius > 100.0 or totals.bounces.sum() > 500


@pytest.mark.parametrize("speed", [1e-150, 1e-100, 1e100, 1e150])
@pytest.mark.parametrize("arcs", [False, True])
def test_speeds_whose_squares_are_at_the_ends_of_what_floats_hold(arcs, speed):
    random = np.random.default_rng(7)
    position = random.uniform([1.0, 1.0], [199.0, 149.0], (COUNT, 2))
    for radius in (0.0, 0.3):
        _assert_same(Scene(_maze(random, arcs=arcs), Balls(position, _ways(random, COUNT, speed), radius)), bounces=30)


@pytest.mark.parametrize("sweep", [0.1, 0.5, 3.0, math.pi, 3.3, 6.2])
@pytest.mark.parametrize("radius", [0.0, 1.0, 2.9, 3.0])
def test_discs_that_fly_by_an_arc_and_meet_it_from_inside(sweep, radius):
    random = np.random.default_rng(9)
    middle, turn = random.uniform(-60, 60, (40, 2)), random.uniform(0, math.tau, (40, 1))
    ends = [3.0 * np.hstack([np.cos(turn + way * sweep / 2), np.sin(turn + way * sweep / 2)]) for way in (-1, 1)]
    walls = Walls.from_polylines(
        list(np.stack([middle + end for end in ends], axis=1)),
        closed=[False] * 40,
        bulges=[np.array([math.tan(sweep / 4), 0.0])] * 40,
    )
    far = 70.0 * _ways(random, COUNT, 1.0)
    aim = middle[random.integers(0, 40, COUNT)] + random.uniform(-4.0, 4.0, (COUNT, 2))
    totals = _assert_same(Scene(walls, Balls(far, aim - far, radius)), until=40.0)
    assert totals.bounces.sum() > 10


@pytest.mark.parametrize("radius", [0.0, 0.2])
@pytest.mark.parametrize("bulge", [0.0, 0.3])
def test_cells_that_list_more_than_a_ball_asks_in_a_turn(bulge, radius):
    random = np.random.default_rng(10)
    middle = np.repeat(random.uniform([8, 8], [192, 142], (12, 2)), 40, axis=0)
    turn = random.uniform(0, math.tau, len(middle))
    ends = middle + 3.0 * np.stack([np.cos(turn), np.sin(turn)], axis=1)
    bulges = [np.array([bulge * (k % 2), 0.0]) for k in range(len(middle))]
    walls = Walls.from_polylines(list(np.stack([middle, ends], axis=1)), closed=[False] * len(middle), bulges=bulges)
    position = random.uniform([1.0, 1.0], [199.0, 149.0], (COUNT, 2))
    velocity = middle[random.integers(0, len(middle), COUNT)] - position + random.uniform(-1, 1, (COUNT, 2))
    scene = Scene(walls, Balls(position, velocity, radius))
    cells = prepare(scene, check=False).modelled.model.cells
    counts = np.where(cells["end"] > cells["first"], cells["end"].astype(int) - cells["first"], 0)
    assert counts.max() > 4 * PER_TURN
    assert _assert_same(scene, until=30.0).bounces.sum() > 1000


@pytest.mark.parametrize("radius", [0.0, 0.5])
def test_short_lists_say_what_cells_list(radius):
    random = np.random.default_rng(11)
    walls = _maze(random, count=2000)  # some cells list nothing, some are divided
    model = prepare(Scene(walls, Balls([[1.0, 1.0]], [[1.0, 0.0]], radius)), check=False).modelled.model
    cells = model.cells[: model.grid.columns * model.grid.rows]
    listed = [model.ids[first:end].tolist() for first, end in zip(cells["first"], cells["end"], strict=True)]
    lists = np.empty(SHORT * len(cells) + AT_ONCE, dtype=np.uint32)
    compiled(note_short_lists)(model.cells, model.ids, lists)
    interpreted = [0] * len(lists)
    note_short_lists(*in_lists((model.cells, model.ids)), interpreted)
    for row in (lists.tolist(), interpreted):
        for c, ids in enumerate(listed):
            count, *found = row[SHORT * c : SHORT * (c + 1)]
            if len(ids) > LONGEST or cells[c]["end"] < cells[c]["first"]:
                assert count == LONG
            else:
                assert (count % 2**SHORT, count >> SHORT) == (
                    cells[c]["arcs"] - cells[c]["first"],
                    len(ids) - count % 2**SHORT,
                )
                assert found[: len(ids)] == ids
    assert {len(ids) for ids in listed} >= {0, 1, LONGEST, LONGEST + 1}


@pytest.mark.parametrize("radius", [0.0, 0.5])
def test_cells_that_are_too_many_for_short_lists(radius, monkeypatch):
    monkeypatch.setattr(survey_backends, "NEAR_LISTS", 0)
    random = np.random.default_rng(12)
    position = random.uniform([1.0, 1.0], [199.0, 149.0], (COUNT, 2))
    scene = Scene(_maze(random), Balls(position, _ways(random, COUNT), radius))
    assert _assert_same(scene, until=20.0).bounces.sum() > 1000


def test_flights_straight_along_the_axes():
    random = np.random.default_rng(8)
    position = random.uniform([1.0, 1.0], [199.0, 149.0], (COUNT, 2))
    velocity = np.array([[50.0, 0.0], [-50.0, 0.0], [0.0, 50.0], [0.0, -50.0], [1e-300, 50.0]])[np.arange(COUNT) % 5]
    for radius in (0.0, 0.4):
        totals = _assert_same(Scene(_maze(random), Balls(position, velocity, radius)), until=20.0)
        assert totals.bounces.sum() > 1000


@settings(max_examples=15)
@given(st.integers(0, 2**32 - 1), st.sampled_from([1e-6, 1.0, 1e9]), st.floats(0.0, 8.0), st.booleans())
def test_any_maze_of_any_size(seed, size, radius, arcs):
    random = np.random.default_rng(seed)
    walls = _maze(random, count=40, arcs=arcs)
    walls = Walls.from_polylines(
        [size * wall.vertices for wall in walls],
        closed=list(walls.closed),
        bulges=[wall.bulges for wall in walls],
    )
    position = random.uniform([-20.0, -20.0], [230.0, 180.0], (COUNT, 2))
    balls = Balls(size * position, size * _ways(random, COUNT), size * radius)
    _assert_same(Scene(walls, balls), until=10.0)


@pytest.mark.parametrize("threads", [1, 2, 5])
def test_threads_do_not_matter(threads):
    random = np.random.default_rng(9)
    position = random.uniform([1.0, 1.0], [199.0, 149.0], (3000, 2))
    ready = prepare(Scene(_maze(random), Balls(position, _ways(random, 3000), 0.0)))
    one, many = survey(ready, until=10.0, threads=1), survey(ready, until=10.0, threads=threads)
    np.testing.assert_array_equal(one.position, many.position)
    np.testing.assert_array_equal(one.hits, many.hits)
