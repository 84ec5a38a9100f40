"""Surveys: totals that add up, balls drawn by number, memory that does not grow."""

from dataclasses import replace

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

import wallkit
from wallkit.scene.start_overlaps import clearances
from wallkit.simulation.prepared import prepare_again
from wallkit.simulation.run import ContactKind
from wallkit.simulation.streams import RandomBalls, survey_stream

ROOM = wallkit.Walls.from_polylines(
    [[[0.0, 0.0], [40.0, 0.0], [40.0, 30.0], [0.0, 30.0]], [[18.0, 13.0], [22.0, 13.0], [22.0, 17.0], [18.0, 17.0]]]
)


def test_totals_add_up():
    draw = RandomBalls((2.0, 2.0, 12.0, 28.0), speed=9.0, radius=0.5, seed=4)
    scene = wallkit.Scene(ROOM, draw(0, 500))
    totals = wallkit.survey(scene, until=20.0)
    assert totals.hits.sum() == totals.bounces.sum() > 0
    assert (totals.time == 20.0).all()
    np.testing.assert_allclose(np.hypot(*totals.velocity.T), 9.0, rtol=1e-15)


def test_a_ball_is_drawn_from_its_number_alone():
    draw = RandomBalls((2.0, 2.0, 12.0, 28.0), seed=4)
    all_at_once, later = draw(0, 100), draw(60, 40)
    np.testing.assert_array_equal(all_at_once.position[60:], later.position)
    np.testing.assert_array_equal(all_at_once.velocity[60:], later.velocity)
    assert not np.array_equal(draw(0, 5).position, RandomBalls((2.0, 2.0, 12.0, 28.0), seed=5)(0, 5).position)


def test_chunks_of_a_stream_change_no_bit():
    draw = RandomBalls((2.0, 2.0, 12.0, 28.0), speed=9.0, seed=1)
    scene = wallkit.Scene(ROOM)
    (whole,) = survey_stream(scene, draw, 3000, until=5.0, chunk=3000)
    parts = list(survey_stream(scene, draw, 3000, until=5.0, chunk=700))
    assert [len(part.bounces) for part in parts] == [700, 700, 700, 700, 200]
    np.testing.assert_array_equal(np.concatenate([part.position for part in parts]), whole.position)
    np.testing.assert_array_equal(sum(part.hits for part in parts), whole.hits)


def test_what_was_made_of_the_walls_serves_other_balls_of_the_same_size():
    first, second = _pillars(1.5), _pillars(1.5, 200)
    ready = wallkit.prepare(first)
    again = prepare_again(ready, second.balls)
    assert again.modelled.model is ready.modelled.model
    np.testing.assert_array_equal(wallkit.survey(again, 9.0).position, wallkit.survey(second, 9.0).position)
    np.testing.assert_array_equal(wallkit.survey(ready, 9.0).position, wallkit.survey(first, 9.0).position)
    for other in (wallkit.Balls([[5.0, 5.0]], [[1.0, 0.0]], 1.0), wallkit.Balls([[-900.0, 5.0]], [[1.0, 0.0]], 1.5)):
        assert prepare_again(ready, other).modelled.model is not ready.modelled.model


def _pillars(radius, count=300):
    """A room of short walls in all directions, with balls that touch none of them."""
    rng = np.random.default_rng(8)
    middle, angle = rng.uniform(10.0, 190.0, (200, 2)), rng.uniform(0.0, np.pi, 200)
    arm = 3.0 * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    room = np.array([[0.0, 0.0], [200.0, 0.0], [200.0, 200.0], [0.0, 200.0]])
    lines = [room, *np.stack([middle - arm, middle + arm], axis=1)]
    walls = wallkit.Walls.from_polylines(lines, closed=[True] + [False] * 200)
    tries, way = rng.uniform(3.0, 197.0, (4 * count, 2)), rng.uniform(0.0, 2 * np.pi, count)
    far = shapely.distance(shapely.MultiLineString([*lines[1:]]), shapely.points(tries)) > radius + 0.1
    velocity = 9.0 * np.stack([np.cos(way), np.sin(way)], axis=1)
    return wallkit.Scene(walls, wallkit.Balls(tries[far][:count], velocity, radius))


@pytest.mark.parametrize("radius", [0.0, 1.5])
def test_the_order_in_which_balls_fly_is_not_seen(radius):
    scene = _pillars(radius)
    ready = wallkit.prepare(scene)
    shuffled = replace(ready, order=np.random.default_rng(4).permutation(len(scene.balls)))
    run = wallkit.simulate(scene, until=12.0)
    for totals in (wallkit.survey(scene, until=12.0), wallkit.survey(ready, 12.0), wallkit.survey(shuffled, 12.0)):
        np.testing.assert_array_equal(totals.position, np.stack([run.final["x"], run.final["y"]], axis=1))
        np.testing.assert_array_equal(totals.bounces, np.bincount(run.contacts["ball"], minlength=len(scene.balls)))
        assert totals.hits.sum() == totals.bounces.sum() > 300


def test_balls_of_many_radii_keep_their_own():
    scene = _pillars(1.5)
    balls = wallkit.Balls(scene.balls.position, scene.balls.velocity, np.linspace(0.1, 1.5, len(scene.balls)))
    scene = wallkit.Scene(scene.walls, balls)
    run = wallkit.simulate(scene, until=12.0)
    totals = wallkit.survey(scene, until=12.0)
    np.testing.assert_array_equal(totals.position, np.stack([run.final["x"], run.final["y"]], axis=1))


@settings(max_examples=60)
@given(st.integers(0, 2**32), st.integers(1, 60), st.floats(0.01, 300.0), st.sampled_from([0.0, 1.0, 1e6]))
def test_room_at_the_start_is_what_shapely_measures(seed, count, reach, offset):
    rng = np.random.default_rng(seed)
    ends = rng.uniform(0.0, 200.0, (30, 2, 2)) + offset
    places = rng.uniform(-20.0, 220.0, (count, 2)) * rng.choice([[1.0, 1.0], [1.0, 0.0], [0.0, 1.0], [0.0, 0.0]])
    places += offset
    walls = wallkit.Walls.from_polylines(list(ends), closed=[False] * 30)
    found, edge = clearances(walls, places, np.full(count, reach))
    expected = shapely.distance(shapely.points(places)[:, None], shapely.linestrings(ends)[None]).min(axis=1)
    inside = expected < reach * (1.0 - 1e-9)
    np.testing.assert_allclose(found[inside], expected[inside], atol=1e-9, rtol=0)  # coordinates up to 1e6
    assert np.isinf(found[expected > reach * (1.0 + 1e-9)]).all()
    assert ((edge >= 0) == np.isfinite(found)).all()


@pytest.mark.parametrize(
    "acts",
    [{}, {"gravity": (1.0, -9.81)}, {"rolling_friction": 0.3}, {"drag": 0.1}],
    ids=lambda acts: next(iter(acts), ""),
)
@pytest.mark.parametrize(("radius", "bulge"), [(0.0, 0.3), (0.5, 0.0)])
def test_a_survey_counts_the_crossings_of_a_run(acts, radius, bulge):
    sensors = wallkit.Walls.from_polylines(
        [[[10.0, 0.0], [10.0, 30.0]], [[23.0, 8.0], [33.0, 8.0], [33.0, 18.0], [23.0, 18.0]]],
        closed=[False, True],
        bulges=[[0.0, 0.0], [bulge] * 4],
    )
    steel = wallkit.Material(0.95, 1.0)
    walls = wallkit.Walls.from_polylines([[[0.0, 0.0], [40.0, 0.0], [40.0, 30.0], [0.0, 30.0]]], material=steel)
    balls = RandomBalls((2.0, 2.0, 38.0, 28.0), speed=9.0, radius=radius, seed=4)(0, 150)
    scene = wallkit.Scene(walls, balls, sensors=sensors, **acts)
    contacts = wallkit.simulate(scene, until=20.0, mode="compiled").contacts
    expected = [
        [
            np.count_nonzero((contacts["kind"] == kind) & (contacts["wall"] == wall))
            for kind in (ContactKind.ENTER, ContactKind.EXIT)
        ]
        for wall in (0, 1)
    ]
    totals = wallkit.survey(scene, until=20.0, threads=2)
    assert totals.crossings.tolist() == expected
    assert totals.crossings.min() > 20
    plain = wallkit.survey(wallkit.Scene(walls, balls, **acts), until=20.0)
    assert plain.crossings.shape == (0, 2)
    for name in ("position", "velocity", "time", "bounces", "hits", "ending"):
        np.testing.assert_array_equal(getattr(totals, name), getattr(plain, name))


def test_a_long_run_loses_no_crossing():
    corridor = wallkit.Walls.from_polylines([[[0.0, -9.0], [0.0, 9.0]], [[10.0, -9.0], [10.0, 9.0]]], closed=False)
    line = wallkit.Walls.from_polylines([[[5.0, -9.0], [5.0, 9.0]]], closed=False)
    scene = wallkit.Scene(corridor, wallkit.Balls([2.0, 0.0], [4.0, 0.0]), sensors=line)
    totals = wallkit.survey(scene, bounces=1000)
    assert totals.crossings.sum() == 1000  # one on the way to each bounce
    assert np.ptp(totals.crossings) == 0
