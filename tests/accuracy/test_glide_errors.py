"""The derivative of a glide against the variational equation; trust after a corner that was left."""

import math

import mpmath
import numpy as np
import pytest

from wallkit import Balls, Material, Scene, Walls, simulate
from wallkit.accuracy.contact_scenes import contact_scene
from wallkit.simulation import horizon
from wallkit.simulation.glide_errors import glides_of

PULL = 9.81


def test_a_glide_carries_an_error_as_the_variational_equation_does():
    # xi'' = -(g.e / rho) xi beside rho a'' = -g sin(a), by Taylor series in 30 digits, over a turn and a half swing
    walls = Walls.from_polylines([[[0, 10], [10, 10]]], closed=False, bulges=[[1.0, 0.0]], material=Material(0.0, 1.0))
    run = simulate(Scene(walls, Balls([(1.5, 8.0)], [(0.0, 0.0)], 0.5), gravity=(0.0, -PULL)), until=3.0)
    own = np.concatenate([run.contacts, run.contacts[-1:]])
    own[-1]["time"] = 3.0
    found = glides_of(run.scene, own, np.array([0.0, -PULL]))[-1]
    rho, start = 4.5, own[-2]
    angle = math.atan2(start["x"] - 5.0, 10.0 - start["y"])
    speed = math.copysign(math.hypot(start["vx"], start["vy"]), start["vx"])
    with mpmath.workdps(30):

        def motion(_time, state):
            a, w, xi, eta, other, more = state
            stiff = PULL / rho * mpmath.cos(a)
            return [w, -PULL / rho * mpmath.sin(a), eta, -stiff * xi, more, -stiff * other]

        ends = mpmath.odefun(motion, 0, [angle, speed / rho, 1, 0, 0, 1])(3.0 - start["time"])
    assert found[8:12] == pytest.approx([float(ends[k]) for k in (2, 4, 3, 5)], rel=1e-7)
    assert found[0:2] @ found[6:8] == pytest.approx(float(ends[1]) * rho, rel=1e-12)


def test_a_corner_that_a_disc_has_just_left_does_not_end_trust():
    # off the end of a shelf, about its corner, and on to the floor: nothing decides there
    walls = Walls.from_polylines([[[0, 5], [6, 4.8]], [[-10, 0], [30, 0]]], closed=False, material=Material(0.0, 1.0))
    run = simulate(Scene(walls, Balls([(2.0, 6.0)], [(0.4, 0.0)], 0.5), gravity=(0.0, -PULL)), until=6.0)
    assert horizon.trusted_until(run.scene, run.contacts, 0, 1e-9).whole


def test_the_last_bounces_in_a_corner_have_speeds_whose_squares_have_no_digits():
    # a point in the corner of two arcs, restitution 0: each bounce leaves it a part of its speed, down to 1e-163
    _kind, scene, until = contact_scene(17309)
    run = simulate(scene, until=until)
    speed = np.hypot(run.contacts["vx"], run.contacts["vy"])
    assert (speed**2 < 2.0**-1022).any()
    assert horizon.trusted_until(scene, run.contacts, 0, 1e-6).bounces > 0
