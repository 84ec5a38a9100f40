"""The reference of contact states with drag against closed forms and Runge and Kutta's rule; simulator against it."""

import math

import numpy as np
import pytest
from agreement import assert_ends_as_the_reference

from wallkit import Balls, Material, Scene, Walls
from wallkit.accuracy.contact_scenes import drag_scene
from wallkit.accuracy.reference_contact import ContactReference

PULL = 9.81


def stepped(change, state, time, steps=4000):
    """Runge and Kutta's rule: off by less than 1e-12 in these."""
    step = time / steps
    path = [np.array(state)]
    for _ in range(steps):
        state = path[-1]
        one = change(state)
        two = change(state + step / 2 * one)
        three = change(state + step / 2 * two)
        four = change(state + step * three)
        path.append(state + step / 6 * (one + 2 * two + 2 * three + four))
    return np.array(path)


@pytest.mark.parametrize("friction", [0.0, 1.5])
def test_a_slide_with_drag_is_its_closed_form(friction):
    # 30 degrees down: a = g sin - mu g cos, v = (a / k) (1 - e^(-k t)), s = a (t - (1 - e^(-k t)) / k) / k
    drag, time = 0.8, 2.0
    slope = Walls.from_polylines([[(0.0, 0.0), (40 * math.sqrt(3), -40.0)]], closed=False, material=Material(0.5, 0.5))
    down, normal = np.array([math.sqrt(0.75), -0.5]), np.array([0.5, math.sqrt(0.75)])
    ball = Balls([2.0 * down + 0.5 * normal], [(0.0, 0.0)], 0.5)
    scene = Scene(slope, ball, gravity=(0.0, -PULL), drag=drag, rolling_friction=friction or None)
    end = ContactReference(scene).run(time)[-1]
    pull, left = PULL / 2 - friction * math.sqrt(0.75), math.exp(-drag * time)
    way = 2.0 + pull * (time - (1 - left) / drag) / drag
    assert end.row()[1:3] == pytest.approx(way * down + 0.5 * normal, abs=1e-13)
    assert end.row()[3:] == pytest.approx(pull / drag * (1 - left) * down, abs=1e-13)


@pytest.mark.parametrize("friction", [0.0, 2.0])
@pytest.mark.parametrize("inside", [True, False])
def test_a_glide_with_drag_is_what_its_equation_says(inside, friction):
    # rho w' = g.t - mu N - k rho w, from where it is held
    drag, radius, rho = 0.7, 0.5, 5.5 - inside
    bulge, y = (1.0, 10.0) if inside else (-1.0, 0.0)
    walls = Walls.from_polylines([[(0, y), (10, y)]], closed=False, bulges=[[bulge, 0.0]], material=Material(0.0, 1.0))
    start = (5 - rho * math.cos(0.4), 10 - rho * math.sin(0.4) + 1e-9) if inside else (5 + 1.0, rho + 0.1)
    ball = Balls([start], [(0.0, 0.0)], radius)
    scene = Scene(walls, ball, gravity=(0.0, -PULL), drag=drag, rolling_friction=friction or None)
    begin = next(change for change in ContactReference(scene).run(1.0) if change.kind == "slide")
    end = ContactReference(scene).run(float(begin.time) + 0.6)[-1]
    side = -1 if inside else 1  # the angle is from the top, or the bottom

    def change(state):
        a, w = state
        pressed = PULL * math.cos(a) - side * rho * w * w
        slower = math.copysign(friction / PULL * pressed, w) + drag * rho * w
        return np.array([w, (side * PULL * math.sin(a) - slower) / rho])

    x, up, vx, _vy = begin.row()[1:]
    angle = math.atan2(x - 5, side * (up - y))
    angle, speed = stepped(change, [angle, vx / rho / math.cos(angle)], 0.6)[-1]
    assert float(end.position[0]) == pytest.approx(5 + rho * math.sin(angle), abs=1e-11)
    assert float(end.velocity[0]) == pytest.approx(rho * speed * math.cos(angle), abs=1e-11)


@pytest.mark.parametrize("radius", [0.0, 0.5])
@pytest.mark.parametrize("velocity", [(6.0, 9.0), (9.0, 3.0), (4.0, 11.0)])
def test_a_flight_with_drag_meets_a_pillar_where_it_first_touches_it(velocity, radius):
    drag = 0.9
    pillar = np.array([(7.0, 1.0), (6.0, 2.0), (5.0, 1.0), (6.0, 0.0)])
    walls = Walls.from_polylines([pillar], bulges=[[math.tan(math.pi / 8)] * 4], material=Material(1.0, 1.0))
    scene = Scene(walls, Balls([(0.0, 0.0)], [velocity], radius), gravity=(0.0, -PULL), drag=drag)
    first = ContactReference(scene).run(3.0)[0]

    def change(state):
        return np.array([*state[2:], -drag * state[2], -PULL - drag * state[3]])

    time = float(first.time) if first.kind == "bounce" else 3.0
    path = stepped(change, [0.0, 0.0, *velocity], time)
    gaps = np.hypot(path[:, 0] - 6.0, path[:, 1] - 1.0) - (1.0 + radius)
    assert gaps[:-1].min() > 0.0
    if first.kind == "bounce":
        assert gaps[-1] == pytest.approx(0.0, abs=1e-11)
        assert first.row()[1:3] == pytest.approx(path[-1, :2], abs=1e-11)


@pytest.mark.parametrize("first", range(0, 36, 6))
def test_runs_with_drag_end_where_the_reference_ends_them(first):
    # 1e-9 as without drag: what bounces at the end of their series lose of the time, see docs/accuracy.md
    for seed in range(first, first + 6):
        _kind, scene, until = drag_scene(seed)
        assert_ends_as_the_reference(scene, until)
