"""Points and discs among circular arcs: closed forms, either side, tangential joints."""

import math

import mpmath
import numpy as np
import pytest

import wallkit
from wallkit.simulation.simulate import Flights


def circle(radius=100.0, centre=(0.0, 0.0), pieces=2, turn=1):
    angle = turn * 2 * np.pi * np.arange(pieces) / pieces + 0.3
    points = np.asarray(centre) + radius * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    return points, np.full(pieces, turn * math.tan(2 * np.pi / pieces / 4))


def scene_of(*rings, position, velocity, radius=0.0, **how):
    walls = wallkit.Walls.from_polylines([r[0] for r in rings], bulges=[r[1] for r in rings], **how)
    return wallkit.Scene(walls, wallkit.Balls(position, velocity, radius))


def stadium(radius=1.0, straight=2.0):
    half = straight / 2
    points = np.array([[-half, -radius], [half, -radius], [half, radius], [-half, radius]])
    return points, np.array([0.0, 1.0, 0.0, 1.0])


@pytest.mark.parametrize("pieces", [2, 3, 7])
@pytest.mark.parametrize("turn", [1, -1])
@pytest.mark.parametrize("radius", [0.0, 7.0])
def test_circle_from_inside_keeps_its_angle(pieces, turn, radius):
    run = wallkit.simulate(
        scene_of(circle(pieces=pieces, turn=turn), position=[20.0, -35.0], velocity=[31.0, 17.0], radius=radius),
        bounces=2000,
    )
    c = run.contacts
    momentum = c["x"] * c["vy"] - c["y"] * c["vx"]
    # one rounding of a product of size 1e4 a bounce, summed at random
    assert np.abs(momentum / (20 * 17 + 35 * 31) - 1).max() < 1e-12
    gaps = np.diff(c["time"])
    assert np.abs(gaps / gaps[0] - 1).max() < 1e-10
    assert np.abs(np.hypot(c["x"], c["y"]) - (100 - radius)).max() < 1e-11
    assert len(c) == 2000


@pytest.mark.parametrize("radius", [0.0, 7.0, 150.0])
def test_circle_from_outside(radius):
    run = wallkit.simulate(
        scene_of(circle(), position=[-500.0, 40.0], velocity=[10.0, 0.0], radius=radius), until=1000.0
    )
    reach = 100.0 + radius
    assert len(run.contacts) == 1
    contact = run.contacts[0]
    angle = math.asin(40.0 / reach)
    assert contact["x"] == pytest.approx(-reach * math.cos(angle), rel=1e-14)
    assert contact["vx"] == pytest.approx(-10 * math.cos(2 * angle), abs=1e-13)
    assert contact["vy"] == pytest.approx(10 * math.sin(2 * angle), abs=1e-13)
    assert run.ending == (wallkit.Ending.LEFT_SCENE,)


@pytest.mark.parametrize("radius", [0.0, 0.05])
def test_stadium_keeps_its_ball_and_its_bits(radius):
    rng = np.random.default_rng(5)
    angle = rng.uniform(0, 2 * np.pi, 20)
    position = rng.uniform(-0.4, 0.4, (20, 2))
    shot = scene_of(
        stadium(), position=position, velocity=np.stack([np.cos(angle), np.sin(angle)], axis=1), radius=radius
    )
    one = wallkit.simulate(shot, bounces=100, mode="interpreted")
    other = wallkit.simulate(shot, bounces=100, mode="compiled")
    assert one.contacts.tobytes() == other.contacts.tobytes()
    for mode in ("brute", "grid"):
        flights = Flights(shot, mode="compiled", index=mode)
        pieces = [np.concatenate(list(flights.fly(ball, math.inf, 100))) for ball in range(20)]
        np.testing.assert_array_equal(
            np.concatenate(pieces)[:, 1], np.concatenate([one.contacts_of(b)["x"] for b in range(20)])
        )
    late = wallkit.survey(shot, bounces=20_000)
    x, y = np.maximum(np.abs(late.position[:, 0]) - 1.0, 0.0), late.position[:, 1]
    assert np.hypot(x, y).max() <= 1.0 - radius + 1e-13
    assert (late.bounces == 20_000).all()


def test_tangential_joints_give_no_ghost_hits():
    # a disc rolls exactly along the straight part of a stadium; in the cap it would touch without end
    run = wallkit.simulate(
        scene_of(stadium(1.0, 4.0), position=[0.0, -0.75], velocity=[1.0, 0.0], radius=0.25), until=2.2
    )
    assert run.contacts["time"].min() == 2.0
    assert run.ending == (wallkit.Ending.COLLAPSE,)
    moved = wallkit.simulate(
        scene_of(stadium(1.0, 4.0), position=[-1.0, 0.0], velocity=[1.0, 1.0], radius=0.25), bounces=500
    )
    assert (moved.contacts["kind"] == wallkit.ContactKind.EDGE).all()


def test_many_arcs_index_changes_no_bit():
    rng = np.random.default_rng(11)
    rings = [
        circle(8.0, (25.0 * i, 25.0 * j), pieces=int(rng.integers(2, 6)), turn=int(rng.choice([-1, 1])))
        for i in range(8)
        for j in range(8)
    ]
    room = np.array([[-30.0, -30.0], [205.0, -30.0], [205.0, 205.0], [-30.0, 205.0]]), np.array([0.1, -0.1, 0.3, 0.0])
    for radius in (0.0, 2.0):
        shot = scene_of(*rings, room, position=[12.0, 12.0], velocity=[7.0, 3.3], radius=radius)
        logs = []
        for mode in ("brute", "grid"):
            flights = Flights(shot, mode="compiled", index=mode)
            logs.append(np.concatenate(list(flights.fly(0, math.inf, 5000))))
        assert len(logs[0]) == 5000
        assert logs[0].tobytes() == logs[1].tobytes()


def test_a_ball_within_the_bow_of_an_arc_has_not_left():
    run = wallkit.simulate(scene_of(stadium(), position=[0.0, 0.0], velocity=[1.0, 0.0]), until=1.9)
    assert run.ending == (wallkit.Ending.TIME_REACHED,)


@pytest.mark.parametrize("radius", [0.0, 2.0])
@pytest.mark.parametrize("bulge", [0.3, 1e-5, -1e-5, 1e-8, -1e-8, 1e-11])
def test_an_arc_is_met_on_its_circle_however_far_its_centre_is(radius, bulge):
    # the arc through (-100, 0), (0, -100 bulge) and (100, 0) in 50 digits; a ball comes at 0.6 to 45 degrees.
    # Its place is rounded by some 2^-53 of its size, and its time by 2^-53 of itself: 8 of these are allowed
    walls = wallkit.Walls.from_polylines([[[-100.0, 0.0], [100.0, 0.0]]], bulges=[[bulge, 0.0]], closed=False)
    rng = np.random.default_rng(2)
    with mpmath.workdps(50):
        b = mpmath.mpf(bulge)
        arc, middle = 50 * (1 + b * b) / abs(b), 50 * (1 - b * b) / b
        for _ in range(40):
            aim = float(rng.uniform(-60, 60))
            way = np.array([1.0, -float(rng.choice([1.0, 0.1, 0.01]))])
            start = [aim, radius] - way * rng.uniform(80, 120)
            run = wallkit.simulate(wallkit.Scene(walls, wallkit.Balls(start, 30 * way, radius)), bounces=1)
            if len(run.contacts) == 0 or run.contacts["edge"][0] < 0:
                continue
            x, y = (mpmath.mpf(float(run.contacts[name][0])) for name in ("x", "y"))
            reach = arc - radius if bulge > 0 else arc + radius
            assert abs(mpmath.hypot(x, y - middle) - reach) <= 8 * 2.0**-53 * 200
