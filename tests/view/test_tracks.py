import numpy as np
import pytest

import wallkit
from wallkit import ContactKind
from wallkit.view.tracks import tracks


def flown(count, **limit):
    walls = wallkit.Walls.from_polylines([[(0, 0), (10, 0), (10, 7), (0, 7)]])
    angle = np.linspace(0.1, 6, count)
    balls = wallkit.Balls(np.full((count, 2), 3.0), 2 * np.stack([np.cos(angle), np.sin(angle)], 1), 0.25)
    return wallkit.simulate(wallkit.Scene(walls, balls), **limit)


def test_stretches_join_and_say_where_the_run_says_a_ball_is():
    run = flown(4, until=30.0)
    flight = tracks(run)
    assert flight.whole == len(run.contacts) + 4 == len(flight.time)
    same = flight.ball[1:] == flight.ball[:-1]
    assert np.array_equal(flight.until[:-1][same], flight.time[1:][same])
    assert np.array_equal(flight.target[:-1][same], flight.position[1:][same])
    for t in np.linspace(0, 30, 41):
        for ball, place in enumerate(run.position(t)):
            at = np.flatnonzero((flight.ball == ball) & (flight.time <= t))[-1]
            # one product and one sum, each rounded, of numbers below 16: a few units of 2^-49
            assert np.allclose(
                flight.position[at] + flight.velocity[at] * (t - flight.time[at]), place, rtol=0, atol=1e-14
            )


def test_thinning_keeps_each_balls_first_stretches_evenly():
    flight = tracks(flown(7, bounces=50), limit=100)
    assert flight.thinned
    assert flight.whole == 7 * 51
    assert np.diff(flight.offsets).tolist() == [14] * 7
    assert (flight.contact[flight.offsets[:-1]] == -1).all()


def test_more_balls_than_the_limit_leaves_the_last_ones_out():
    flight = tracks(flown(7, bounces=3), limit=5)
    assert np.diff(flight.offsets).tolist() == [1, 1, 1, 1, 1, 0, 0]


def test_a_ball_that_leaves_is_followed_out_of_sight():
    walls = wallkit.Walls.from_polylines([[(0, 0), (10, 0)]], closed=False)
    run = wallkit.simulate(wallkit.Scene(walls, wallkit.Balls([[5, 5]], [[0.0, -1]], 1)), bounces=10)
    flight = tracks(run)
    assert len(flight.time) == 2
    assert flight.target[-1] == pytest.approx([5, flight.position[-1][1] + 15], abs=1.5)  # 1.5 times the diagonal


def test_a_run_without_balls_or_contacts_has_empty_tracks():
    walls = wallkit.Walls.from_polylines([[(0, 0), (10, 0)]], closed=False)
    assert len(tracks(wallkit.simulate(wallkit.Scene(walls), until=1.0)).time) == 0


def test_under_gravity_a_track_falls_slides_and_rests_as_the_run_says():
    walls = wallkit.Walls.from_polylines(
        [[(0, 0), (30, -6), (60, 0), (60, 40), (0, 40)]], material=wallkit.Material(0.5, 0.9)
    )
    balls = wallkit.Balls([[10, 20], [30, 30]], [[3.0, 1], [-4, 0]], [1, 0])
    run = wallkit.simulate(wallkit.Scene(walls, balls, gravity=(0, -9.81)), until=60.0)
    assert ContactKind.SLIDE in run.contacts["kind"]
    flight = tracks(run)
    for t in np.linspace(0, 30, 97):
        for ball, place in enumerate(run.position(t)):
            at = np.flatnonzero((flight.ball == ball) & (flight.time <= t))[-1]
            s = min(t, flight.until[at]) - flight.time[at]
            mine = flight.position[at] + flight.velocity[at] * s + flight.pull[at] * s * s / 2
            assert np.allclose(mine, place, rtol=0, atol=1e-12)  # the same formula, summed in another order
    # A stretch of some length ends where the next one begins, by the same motion: the pull is right for slides, too.
    s = flight.until - flight.time
    reached = flight.position + flight.velocity * s[:, None] + flight.pull * (s * s / 2)[:, None]
    assert np.allclose(reached, flight.target, rtol=0, atol=1e-6)


@pytest.mark.parametrize("acts", [{"rolling_friction": 0.4}, {"drag": 0.3}], ids=str)
def test_slowed_balls_are_where_the_run_says_and_their_paths_are_straight(acts):
    walls = wallkit.Walls.from_polylines([[(0, 0), (10, 0), (10, 7), (0, 7)]])
    scene = wallkit.Scene(walls, wallkit.Balls([[3, 3]], [[3.0, 1]], 0.25), **acts)
    run = wallkit.simulate(scene, until=20.0)
    flight = tracks(run)
    for t in np.linspace(0, 20, 61):
        at = np.flatnonzero(flight.time <= t)[-1]
        s = min(t, flight.until[at]) - flight.time[at]
        felt = -np.expm1(-flight.drag * s) / flight.drag if flight.drag else s
        mine = flight.position[at] + flight.velocity[at] * felt + flight.pull[at] * s * s / 2
        assert np.allclose(mine, run.position(t)[0], rtol=0, atol=1e-9)


@pytest.mark.parametrize(
    "acts", [{"rolling_friction": 0.4}, {"drag": 0.3}, {"rolling_friction": 0.4, "drag": 0.3}], ids=str
)
def test_balls_that_fall_slowed_are_near_where_the_run_says(acts):
    walls = wallkit.Walls.from_polylines(
        [[(0, 0), (10, 0), (10, 7), (0, 7)]], bulges=[[0.3, 0, 0, 0]], material=wallkit.Material(0.5, 1.0)
    )
    scene = wallkit.Scene(walls, wallkit.Balls([[3, 3]], [[3.0, 1]], 0.25), gravity=(0, -9.81), **acts)
    run = wallkit.simulate(scene, until=8.0)
    flight = tracks(run)
    for t in np.linspace(0, 8, 81):
        at = np.flatnonzero(flight.time <= t)[-1]
        s = min(t, flight.until[at]) - flight.time[at]
        mine = flight.position[at] + flight.velocity[at] * s + flight.pull[at] * s * s / 2
        assert np.allclose(mine, run.position(t)[0], rtol=0, atol=1e-3)
    s = flight.until - flight.time
    reached = flight.position + flight.velocity * s[:, None] + flight.pull * (s * s / 2)[:, None]
    assert np.allclose(reached, flight.target, rtol=0, atol=1e-6)


def test_a_sensor_parts_no_stretch():
    walls = wallkit.Walls.from_polylines([[(0, 0), (10, 0), (10, 7), (0, 7)]])
    goal = wallkit.Walls.from_polylines([[(0, 3), (10, 3)]], closed=False)
    balls = wallkit.Balls([[5, 5]], [[0.3, -2.0]], 0.25)
    plain = tracks(wallkit.simulate(wallkit.Scene(walls, balls), until=20.0))
    sensed = wallkit.simulate(wallkit.Scene(walls, balls, sensors=goal), until=20.0)
    assert ContactKind.ENTER in sensed.contacts["kind"]
    assert np.array_equal(tracks(sensed).time, plain.time)
