"""The reference of contact states against closed forms, and the simulator against it: the state at the end of a run."""

import math

import mpmath
import numpy as np
import pytest

from wallkit import Balls, Material, Scene, Walls, simulate
from wallkit.accuracy.contact_scenes import contact_scene
from wallkit.accuracy.reference_contact import ContactReference
from wallkit.accuracy.sure_digits import PrecisionError

PULL = 9.81


def level(points, bulges=None, restitution=0.0, tangential=1.0, friction=0.0):
    return Walls.from_polylines(
        [points], closed=False, bulges=bulges, material=Material(restitution, tangential, friction)
    )


def ended(walls, place, velocity, radius, until):
    scene = Scene(walls, Balls([place], [velocity], radius), gravity=(0.0, -PULL))
    return ContactReference(scene).run(until)


@pytest.mark.parametrize("radius", [0.0, 0.5])
def test_a_bowl_is_a_pendulum(radius):
    # a half circle of radius 5 about (5, 10); dropped dead on it at 30 degrees below its edge, it swings
    middle, turn = (5.0, 10.0), math.radians(30)
    place = middle[0] - (5 - radius) * math.cos(turn), middle[1] - (5 - radius) * math.sin(turn) + 1e-9
    changes = ended(level([[0, 10], [10, 10]], [[1.0, 0.0]]), place, (0.0, 0.0), radius, 30.0)
    held = changes[1]
    deep = 2 * PULL * (held.position[1] - (10 - (5 - radius)))
    square = deep + held.velocity[0] ** 2 + held.velocity[1] ** 2  # at the bottom
    period = 4 * mpmath.sqrt((5 - radius) / PULL) * mpmath.ellipk(square / (4 * PULL * (5 - radius)))
    scene = Scene(level([[0, 10], [10, 10]], [[1.0, 0.0]]), Balls([place], [(0.0, 0.0)], radius), gravity=(0.0, -PULL))
    after = ContactReference(scene).run(float(held.time + 3 * period))[-1]
    assert float(abs(after.position[0] - held.position[0])) < 1e-14
    assert float(abs(after.position[1] - held.position[1])) < 1e-14


def test_a_disc_that_tips_over_an_end_leaves_where_gravity_no_longer_turns_it():
    # pivoting from the speed v at the top it leaves at cos a = 2/3 + v^2 / (3 g r)
    radius, speed = 1.0, 1.5
    changes = ended(level([[0, 0], [10, 0]]), (9.0, radius), (speed, -1.0), radius, 3.0)
    pivot = next(change for change in changes if change.kind == "slide" and change.edge < 0)
    left = next(change for change in changes if change.kind == "leave")
    assert float(pivot.position[0]) == pytest.approx(10.0, abs=1e-30)
    assert float(left.position[1] / radius) == pytest.approx(2 / 3 + speed**2 / (3 * PULL * radius), abs=1e-15)


def test_endless_bounces_end_in_the_time_of_their_series():
    # dropped from h: sqrt(2 h / g) (1 + e) / (1 - e), and it stands there
    e, high = 0.5, 2.0
    changes = ended(level([[0, 0], [10, 0]], restitution=e, tangential=0.9), (5.0, high), (0.0, 0.0), 0.0, 10.0)
    slide = next(change for change in changes if change.kind == "slide")
    assert float(slide.time) == pytest.approx(math.sqrt(2 * high / PULL) * (1 + e) / (1 - e), rel=1e-15)
    assert changes[-1].kind == "rest"


def test_a_ramp_in_two_pieces_is_one_ramp():
    one, two = (
        ended(level(points), (1.0, 10.0), (0.3, 0.0), 0.5, 2.0)[-1].row()
        for points in ([[0, 8], [16, 0]], [[0, 8], [8, 4], [16, 0]])
    )
    assert np.abs(np.array(one) - np.array(two)).max() < 1e-14


def test_what_the_reference_does_not_know_is_refused():
    scene = Scene(level([[0, 0], [1, 0]]), Balls([(0.5, 1.0)], [(0.0, 0.0)], 0.0))
    with pytest.raises(PrecisionError, match="gravity"):
        ContactReference(scene)


@pytest.mark.parametrize("first", range(0, 60, 6))
def test_runs_end_where_the_reference_ends_them(first):
    # one scene of each kind: ramps, shelves, bowls, half pipes, domes and rooms. 1e-9 is some 10^6 roundings: what
    # bounces at the end of their series lose of the time, see docs/accuracy.md
    for seed in range(first, first + 6):
        _kind, scene, until = contact_scene(seed)
        run = simulate(scene, until=until)
        true = np.array(ContactReference(scene).run(until)[-1].row())[1:]
        own = np.array(run.final[0].tolist())[1:]
        assert np.abs(own - true).max() <= 1e-9 or not run.trusted_until(1e-9)[0].whole


def test_a_disc_that_runs_up_and_out_of_a_half_pipe_keeps_its_speed():
    # its side is upright and gravity leans away from it: at the joint nothing presses the disc, and it flies off along
    # both, meeting neither
    _kind, scene, until = contact_scene(1209)
    run, changes = simulate(scene, until=until), ContactReference(scene).run(until)
    assert len(run.contacts) < 12
    assert np.abs(np.array(run.final[0].tolist()) - np.array(changes[-1].row())).max() < 1e-11
