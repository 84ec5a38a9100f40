"""Many balls falling through the grid as a wave and few one by one: the same bits."""

import math
from dataclasses import replace

import numpy as np
import pytest
from alone import assert_as_alone
from hypothesis import given, settings
from hypothesis import strategies as st
from test_survey_wave_acting import level, thrown

from wallkit import Balls, Ending, Material, Scene, Walls, simulate
from wallkit.kernels.batches.wave_columns import PER_TURN
from wallkit.kernels.records import OCTANTS
from wallkit.simulation.prepared import prepare
from wallkit.simulation.survey_backends import WORTH_A_WAVE, suits_wave

COUNT = 3 * WORTH_A_WAVE + 7
DOWN = {"gravity": (0.0, -20.0)}


def assert_same(scene, **limits):
    model = prepare(scene, check=False).modelled.model
    assert suits_wave(model, np.asarray(scene.balls.radius))
    return assert_as_alone(scene, WORTH_A_WAVE - 1, **limits), model


@pytest.mark.parametrize("limits", [{"until": 12.0}, {"bounces": 25}, {"until": 9.0, "bounces": 12}, {"until": 0.0}])
@pytest.mark.parametrize("radius", [0.0, 0.7, 3.0])
@pytest.mark.parametrize("arcs", [False, True])
def test_a_falling_wave_gives_the_bits_of_one_by_one(arcs, radius, limits):
    random = np.random.default_rng(2)
    scene = Scene(level(random, arcs=arcs, one_sided=False), thrown(random, radius), **DOWN)
    totals, _model = assert_same(scene, **limits)
    assert limits.get("until") == 0.0 or totals.bounces.sum() > 1000


@pytest.mark.parametrize("gravity", [(0.0, -20.0), (20.0, 0.0), (-3.0, 5.0), (1e-300, 2.0), (14.0, -14.0)])
def test_any_way_down_also_for_balls_at_rest_and_from_outside(gravity):
    random = np.random.default_rng(3)
    position = random.uniform([-30.0, -30.0], [230.0, 180.0], (COUNT, 2))
    velocity = random.integers(-2, 3, (COUNT, 2)) * 10.0
    for radius in (0.0, 0.4):
        scene = Scene(level(random, arcs=True, one_sided=False), Balls(position, velocity, radius), gravity=gravity)
        totals, _model = assert_same(scene, until=10.0)
        assert Ending.LEFT_SCENE in totals.ending
        assert_same(scene, bounces=8)


@pytest.mark.parametrize("acts", [{}, {"rolling_friction": 0.1}, {"static_friction": 0.3}], ids=["", "rolls", "sticks"])
@pytest.mark.parametrize("radius", [0.0, 0.7])
@pytest.mark.parametrize("arcs", [False, True])
def test_walls_that_take_speed_hold_balls_and_absorb_them(arcs, radius, acts):
    random = np.random.default_rng(4)
    walls = level(random, arcs=arcs, one_sided=False, soft=True)
    if "static_friction" in acts:
        walls, acts = replace(walls, materials=(Material(0.5, 1.0, **acts),) * len(walls)), {}
        totals, _model = assert_same(Scene(walls, thrown(random, radius), **DOWN), until=60.0)
        assert Ending.AT_REST in totals.ending
        return
    totals, _model = assert_same(Scene(walls, thrown(random, radius), **DOWN, **acts), until=60.0)
    assert Ending.ABSORBED in totals.ending


@pytest.mark.parametrize("ball", [8, 121, 131])
def test_a_glide_within_a_rounding_of_the_lowest_place_of_an_arc_goes_on(ball):
    # A way below the rounding of the place left it where it was: each stretch ended where it had begun, for ever.
    random = np.random.default_rng(4)
    walls = level(random, arcs=True, one_sided=False, soft=True)
    walls = replace(walls, materials=(Material(0.5, 1.0, static_friction=1.5),) * len(walls))
    balls = thrown(random, 0.0)
    one = Balls(balls.position[ball : ball + 1], balls.velocity[ball : ball + 1], 0.0)
    run = simulate(Scene(walls, one, **DOWN), until=60.0, mode="interpreted")
    assert run.ending[0] in (Ending.TIME_REACHED, Ending.AT_REST)


@pytest.mark.parametrize("radius", [0.0, 0.7, 4.0])
@pytest.mark.parametrize("arcs", [False, True])
def test_one_sided_walls(arcs, radius):
    random = np.random.default_rng(5)
    scene = Scene(level(random, arcs=arcs, one_sided=True), thrown(random, radius), **DOWN)
    totals, _model = assert_same(scene, until=12.0)
    assert totals.hits[1:].sum()


@pytest.mark.parametrize("radius", [0.0, 0.4])
@pytest.mark.parametrize("bulge", [0.0, 0.02, -0.02])
def test_balls_aimed_at_vertices_and_points_that_start_on_walls(bulge, radius):
    random = np.random.default_rng(6)
    angle = np.arange(40) * math.tau / 40
    ring = 100.0 * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    for e in (1.0, 0.5, 0.0):
        walls = Walls.from_polylines([ring], bulges=[np.full(40, bulge)], material=Material(e, 1.0))
        position = random.integers(-60, 60, (COUNT, 2)) + 0.5
        velocity = ring[random.integers(0, 40, COUNT)] - position
        if radius == 0.0:
            along, edge = random.integers(0, 9, COUNT)[:, None] / 8.0, random.integers(0, 40, COUNT)
            on = ring[edge] * (1 - along) + ring[(edge + 1) % 40] * along
            position = np.where(np.arange(COUNT)[:, None] % 2 == 0, on, position)
        assert_same(Scene(walls, Balls(position, velocity, radius), **DOWN), until=30.0)


@pytest.mark.parametrize("radius", [0.0, 0.01])
def test_cells_in_cells_and_cells_that_list_many_lines(radius):
    random = np.random.default_rng(7)
    room = np.array([[0.0, 0.0], [200.0, 0.0], [200.0, 150.0], [0.0, 150.0]])
    middle, turn = random.normal([100.0, 20.0], 0.3, (2000, 2)), random.uniform(0, math.tau, 2000)
    arm = 0.02 * np.stack([np.cos(turn), np.sin(turn)], axis=1)
    # A star of walls through one place: its cell lists them all, however small it is.
    spokes = np.stack([np.cos(np.arange(30) * math.pi / 30), np.sin(np.arange(30) * math.pi / 30)], axis=1)
    star = np.stack([[60.0, 40.0] - 5.0 * spokes, [60.0, 40.0] + 5.0 * spokes], axis=1)
    paths = [room, *np.stack([middle - arm, middle + arm], axis=1), *star]
    walls = Walls.from_polylines(paths, closed=[True] + [False] * (len(paths) - 1))
    target = np.where(np.arange(COUNT)[:, None] % 2 == 0, [60.0, 40.0], [100.0, 20.0])
    position = random.uniform([5.0, 60.0], [195.0, 145.0], (COUNT, 2))
    _totals, model = assert_same(Scene(walls, Balls(position, target - position, radius), **DOWN), until=15.0)
    cells = model.cells
    assert np.any(cells["end"] < cells["first"])
    assert np.any((cells["end"] >= cells["first"]) & (cells["arcs"].astype(int) - cells["first"] > PER_TURN))


def test_clearings_by_octant():
    angle = np.arange(600) * math.tau / 600
    size = 100.0 * (1.0 + 0.15 * np.cos(3.0 * angle) + 0.07 * np.sin(5.0 * angle))
    walls = Walls.from_polylines([np.stack([size * np.cos(angle), size * np.sin(angle)], axis=1)])
    balls = thrown(np.random.default_rng(8), 2.0)
    balls = Balls(0.5 * (np.asarray(balls.position) - [100.0, 75.0]), balls.velocity, 2.0)
    _totals, model = assert_same(Scene(walls, balls, **DOWN), until=12.0)
    assert model.grid.octants == OCTANTS


def test_so_many_cells_that_clearings_are_packed_with_them():
    random, count = np.random.default_rng(9), 120_000
    middle, turn = random.uniform(2.0, 2300.0, (count, 2)), random.uniform(0, math.tau, count)
    arm = np.stack([np.cos(turn), np.sin(turn)], axis=1)
    walls = Walls.from_polylines(list(np.stack([middle - arm, middle + arm], axis=1)), closed=False)
    position = random.uniform(0.0, 2300.0, (COUNT, 2))
    balls = Balls(position, thrown(random, 0.6).velocity, 0.6)
    totals, model = assert_same(Scene(walls, balls, **DOWN), until=4.0)
    assert model.grid.packed
    assert totals.bounces.sum() > 1000


@settings(max_examples=25)
@given(
    st.integers(0, 2**32 - 1),
    st.sampled_from([1e-6, 1.0, 1e9]),
    st.sampled_from([0.0, 0.01, 0.7, 6.0]),
    st.tuples(st.booleans(), st.booleans(), st.booleans()),
    st.sampled_from([{}, {"rolling_friction": 0.05}]),
)
def test_any_level_with_anything_that_acts(seed, size, radius, kinds, acts):
    arcs, one_sided, soft = kinds
    random = np.random.default_rng(seed)
    walls = level(random, arcs=arcs, one_sided=one_sided, soft=soft, size=size)
    turn = random.uniform(0, math.tau)
    gravity = (20.0 * size * math.cos(turn), 20.0 * size * math.sin(turn))
    assert_same(Scene(walls, thrown(random, radius, size=size), gravity=gravity, **acts), until=8.0)


@pytest.mark.parametrize("restitution", [0.4, 1.0])
def test_points_fall_back_on_the_ends_of_upright_sides_of_half_pipes(restitution):
    random = np.random.default_rng(6)
    middles, radius, height = 10.0 * np.arange(8), 3.0, 2.0
    pipe = np.array([(-radius, height), (-radius, 0.0), (radius, 0.0), (radius, height)])
    walls = Walls.from_polylines(
        [pipe + np.array([middle, 0.0]) for middle in middles],
        closed=[False] * len(middles),
        bulges=[[0.0, 1.0, 0.0, 0.0]] * len(middles),
        material=[Material(restitution)] * len(middles),
    )
    middle, side = random.choice(middles, COUNT), random.choice([-1.0, 1.0], COUNT)
    position = np.stack([middle + side * radius, random.uniform(0.1, 1.9, COUNT)], axis=1)
    velocity = np.stack([np.zeros(COUNT), random.uniform(5.0, 14.0, COUNT)], axis=1)
    totals, _model = assert_same(Scene(walls, Balls(position, velocity, 0.0), **DOWN), until=4.0)
    rose = position[:, 1] + velocity[:, 1] ** 2 / 40.0 > height
    assert 0.3 * COUNT < np.count_nonzero(rose) < COUNT
    # Those that ran up over the end are in their half pipe, as the discs are whose limit they are.
    assert (np.abs(totals.position[:, 0] - middle) <= radius + 1e-9).all()
