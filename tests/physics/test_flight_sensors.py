"""Sensors met in their corners and at borders that they share: what is closed is left as often as it is entered."""

from dataclasses import replace

import numpy as np
import pytest

from wallkit import Balls, ContactKind, Run, Scene, Walls, simulate, survey
from wallkit.simulation import sensors as sensors_module
from wallkit.simulation.run import in_order
from wallkit.simulation.sensors import _flights, sensors_of

DIAMOND = [[10, 0], [20, 10], [10, 20], [0, 10]]
FIELD = Walls.from_polylines([[[-100, -100], [-100, 100], [100, 100], [100, -100]]])


def crossings(outlines, start, velocity, *, bulges=None, gravity=None, until=3.0):
    sensors = Walls.from_polylines(outlines, bulges=bulges)
    scene = Scene(FIELD, Balls([start] * 2, [velocity] * 2, 0.5), sensors=sensors, gravity=gravity)
    run, totals = simulate(scene, until=until), survey(scene, until=until)
    seen = run.contacts[(run.contacts["ball"] == 0) & (run.contacts["kind"] >= ContactKind.ENTER)]
    counts = [
        [int(((seen["wall"] == w) & (seen["kind"] == kind)).sum()) for kind in (ContactKind.ENTER, ContactKind.EXIT)]
        for w in range(len(outlines))
    ]
    assert (totals.crossings == 2 * np.array(counts)).all()
    return counts


@pytest.mark.parametrize("bulge", [0.0, 0.2])
@pytest.mark.parametrize(("start", "velocity"), [((-20, 20), (30, 0)), ((50, 0), (-30, 0)), ((20, -20), (0, 30))])
def test_a_tip_touched_from_outside_is_entered_as_often_as_it_is_left(start, velocity, bulge):
    ((enters, exits),) = crossings([DIAMOND], start, velocity, bulges=[[bulge] * 4])
    assert enters == exits
    if bulge == 0.0:
        assert enters <= 1


@pytest.mark.parametrize("bulge", [0.0, 0.2, 1.0])
@pytest.mark.parametrize(
    ("start", "velocity"), [((-20, 10), (30, 0)), ((50, 10), (-30, 0)), ((10, -20), (0, 30)), ((10, 50), (0, -30))]
)
def test_a_path_through_two_corners_enters_once_and_leaves_once(start, velocity, bulge):
    assert crossings([DIAMOND], start, velocity, bulges=[[bulge] * 4]) == [[1, 1]]


def test_a_parabola_that_touches_a_tip_enters_as_often_as_it_leaves():
    # up to its top in the tip (10, 0) from below, and down again: x = -10 + 20 t, y = -50 + 100 t - 50 t^2
    for heights in (1.0, -1.0):
        outline = [[x, heights * y] for x, y in DIAMOND]
        ((enters, exits),) = crossings([outline], (-10, -50), (20, 100), gravity=(0, -100), until=2.0)
        assert enters == exits


@pytest.mark.parametrize("gravity", [None, (0.0, -1.0)])
@pytest.mark.parametrize(("start", "velocity"), [((-5, 12), (20, 0)), ((25, 15), (-20, 1)), ((-5, 5), (20, 8))])
def test_a_border_that_two_sensors_share_is_left_and_entered_at_once(start, velocity, gravity):
    left, right = [[0, 0], [10, 0], [10, 20], [0, 20]], [[10, 0], [20, 0], [20, 20], [10, 20]]
    assert crossings([left, right], start, velocity, gravity=gravity) == [[1, 1], [1, 1]]


@pytest.mark.parametrize("mode", ["interpreted", "compiled"])
def test_a_hundred_sensors_that_one_flight_crosses_are_told_in_order(mode, monkeypatch):
    # more than there is room for at first
    monkeypatch.setattr(sensors_module, "AT_ONCE", 16)
    place = np.linspace(-49.5, 49.5, 100)
    sensors = Walls.from_polylines([[[x, -90], [x, 90]] for x in place], closed=False)
    scene = Scene(FIELD, Balls([[-90, 0], [90, 0]], [[20, 0], [-30, 0]], 0.5), sensors=sensors)
    for gravity in (None, (0.0, -1.0)):
        seen = simulate(replace(scene, gravity=gravity), bounces=1, mode=mode).contacts
        one, other = (seen[(seen["ball"] == ball) & (seen["kind"] >= ContactKind.ENTER)] for ball in (0, 1))
        np.testing.assert_array_equal(one["wall"], np.arange(100))
        np.testing.assert_array_equal(other["wall"], np.arange(100)[::-1])
        np.testing.assert_allclose(one["time"], (place + 90) / 20, rtol=1e-14)
        np.testing.assert_allclose(other["time"], (90 - place[::-1]) / 30, rtol=1e-14)
        # normals point to the right of a line that goes up
        assert set(one["kind"]) == {ContactKind.EXIT}
        assert set(other["kind"]) == {ContactKind.ENTER}
        fallen = 0.0 if gravity is None else 1.0
        np.testing.assert_allclose(one["y"], -0.5 * fallen * one["time"] ** 2, rtol=1e-12, atol=1e-12)


@pytest.mark.parametrize(
    "acts", [{}, {"gravity": (3.0, -40.0)}, {"drag": 0.02}, {"gravity": (0.0, -40.0), "drag": 0.02}]
)
def test_crossings_are_the_same_however_they_are_asked_for(acts):
    sensors = Walls.from_polylines([DIAMOND, [[-50, -50], [50, -50]]], [True, False], bulges=[[0.3] * 4, [0.0] * 2])
    turn = np.linspace(0.1, 6.1, 5)
    balls = Balls(
        np.full((5, 2), -20.0), 60.0 * np.stack([np.cos(turn), np.sin(turn)], axis=1), [3.0, 3.0, 3.0, 0.0, 0.0]
    )
    scene = Scene(FIELD, balls, sensors=sensors, **acts)
    one, other = (simulate(scene, until=30.0, bounces=60, mode=mode).contacts for mode in ("interpreted", "compiled"))
    assert one.tobytes() == other.tobytes()
    lazily = sensors_of(scene)
    whole = simulate(scene, until=30.0, bounces=60)
    run = Run(scene, one[one["kind"] < ContactKind.ENTER], whole.final, whole.ending, whole.start)
    motions, ball, spans = _flights(run)
    told = []
    for flight, of in enumerate(ball.tolist()):
        row = flight - int(np.searchsorted(ball, of))
        told += list(lazily.crossings_on(of, motions[of], row, *spans[flight].tolist()))
    crossed = one[one["kind"] >= ContactKind.ENTER]
    assert len(told) == len(crossed) > 10
    told = np.array(told, dtype=one.dtype)
    assert in_order(told).tobytes() == crossed.tobytes()
