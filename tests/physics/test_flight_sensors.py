"""Sensors met in their corners and at borders that they share: what is closed is left as often as it is entered."""

import numpy as np
import pytest

from wallkit import Balls, ContactKind, Scene, Walls, simulate, survey

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
