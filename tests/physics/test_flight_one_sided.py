"""One-sided walls and discs: one that stands across passes until it has left the wall, with an index or without."""

import math

import numpy as np
import pytest

from wallkit import Balls, Scene, Walls, simulate
from wallkit.simulation.simulate import Flights

SHAFT = [[0, -200], [0, 200], [100, 200], [100, -200]]


def platform(velocity, gravity, *, start=(50.0, -20.0), radius=5.0):
    # the platform is solid from above: its outward side is to the right of its way
    walls = Walls.from_polylines([SHAFT, [[100, 0], [0, 0]]], closed=[True, False], sides=["both", "outward"])
    return Scene(walls, Balls([start], [velocity], radius), gravity=gravity)


@pytest.mark.parametrize("top", [0.3, 2.0, 4.9])
def test_a_disc_half_way_through_a_platform_falls_back_through_it_though_it_touches_a_side_wall(top):
    # it turns round at y = top, below its radius, and meets the right wall on the way up or down; vertical walls leave
    # y as it is: y = -20 + v t - g t^2 / 2 for as long as the floor is far
    rise = math.sqrt(2 * 100 * (20 + top))
    for across in (150.0, 170.0, 200.0):
        run = simulate(platform((across, rise), (0.0, -100.0)), until=1.6)
        assert set(run.contacts["wall"].tolist()) == {0}
        assert run.final["y"][0] == pytest.approx(-20 + rise * 1.6 - 50 * 1.6**2, abs=1e-9)


def test_a_disc_that_has_left_a_platform_upwards_lands_on_it():
    rise = math.sqrt(2 * 100 * 40)  # to y = 20
    run = simulate(platform((0.0, rise), (0.0, -100.0)), bounces=1)
    # up to 20 in rise / g, and down from there to 5
    assert run.contacts["wall"].tolist() == [1]
    assert run.contacts["time"][0] == pytest.approx(rise / 100 + math.sqrt(2 * 15 / 100), rel=1e-14)


def test_without_gravity_a_disc_that_turns_round_half_way_through_goes_back():
    # a lid at y = 7 stops the disc of radius 5 at y = 2, where it stands across the platform
    lines = [SHAFT, [[100, 0], [0, 0]], [[0, 7], [100, 7]]]
    walls = Walls.from_polylines(lines, closed=[True, False, False], sides=["both", "outward", "both"])
    run = simulate(Scene(walls, Balls([[50.0, -20.0]], [[0.0, 10.0]], 5.0)), until=5.0)
    assert run.contacts["wall"].tolist() == [2]
    assert run.final["y"][0] == pytest.approx(2 - 10 * (5.0 - 2.2), rel=1e-14)


@pytest.mark.parametrize("gravity", [None, (0.0, -40.0)])
@pytest.mark.parametrize("seed", range(6))
def test_discs_among_one_sided_walls_have_the_same_bits_with_an_index_and_without(seed, gravity):
    rng = np.random.default_rng(seed)
    count = 30
    a = rng.uniform(10, 190, (count, 2))
    angle, length = rng.uniform(0, 2 * np.pi, count), rng.uniform(5, 50, count)
    b = a + length[:, None] * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    c = b + rng.uniform(-25, 25, (count, 2))
    bulges = [[float(k), 0.0, 0.0] for k in np.where(rng.random(count) < 0.5, 0.0, rng.uniform(-1, 1, count))]
    lines = [[[0, 0], [0, 200], [200, 200], [200, 0]], *np.stack([a, b, c], axis=1).tolist()]
    walls = Walls.from_polylines(
        lines, bulges=[[0.0] * 4, *bulges], closed=[True] + [False] * count, sides=["both"] + ["outward"] * count
    )
    heading = rng.uniform(0, 2 * np.pi, 12)
    velocity = 50 * np.stack([np.cos(heading), np.sin(heading)], axis=1)
    scene = Scene(walls, Balls(rng.uniform(10, 190, (12, 2)), velocity, 4.0), gravity=gravity)
    outcomes = []
    for index in ("none", "grid"):
        flights = Flights(scene, mode="interpreted", index=index)
        outcomes.append(
            [np.concatenate(list(flights.fly(ball, 12.0, 1000)) or [np.empty((0, 11))]) for ball in range(12)]
        )
    for plain, indexed in zip(*outcomes, strict=True):
        np.testing.assert_array_equal(plain, indexed)
