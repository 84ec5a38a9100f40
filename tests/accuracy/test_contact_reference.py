"""The reference of contact states against closed forms, and the simulator against it: the state at the end of a run."""

import math

import mpmath
import numpy as np
import pytest
from agreement import assert_ends_as_the_reference

from wallkit import Balls, Material, Scene, Walls, simulate
from wallkit.accuracy.contact_scenes import contact_scene, one_sided_scene, rolling_scene, touching_scene
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


@pytest.mark.parametrize("inside", [True, False])
def test_rolling_friction_on_an_arc_is_what_its_equation_says(inside):
    # rho w' = g.t - mu N by Runge and Kutta's rule with 4,000 steps, off by less than 1e-12, from where it is held
    friction, radius, rho = 2.0, 0.5, 5.5 - inside
    bulge, y = (1.0, 10.0) if inside else (-1.0, 0.0)
    walls = level([[0, y], [10, y]], [[bulge, 0.0]])
    start = (5 - rho * math.cos(0.4), 10 - rho * math.sin(0.4) + 1e-9) if inside else (5 + 1.0, rho + 0.1)
    scene = Scene(walls, Balls([start], [(0.0, 0.0)], radius), gravity=(0.0, -PULL), rolling_friction=friction)
    begin = next(change for change in ContactReference(scene).run(1.0) if change.kind == "slide")
    end = ContactReference(scene).run(float(begin.time) + 0.6)[-1]
    side = -1 if inside else 1  # of the centre of the circle, up from it: the angle a is from the top, or the bottom

    def change(state):
        a, w = state
        pressed = PULL * math.cos(a) - side * rho * w * w
        return np.array([w, (side * PULL * math.sin(a) - math.copysign(friction / PULL * pressed, w)) / rho])

    x, up, vx, _vy = begin.row()[1:]
    state = np.array([math.atan2(x - 5, side * (up - y)), 0.0])
    state[1] = vx / rho / math.cos(state[0])
    step = 0.6 / 4000
    for _ in range(4000):
        one = change(state)
        two = change(state + step / 2 * one)
        three = change(state + step / 2 * two)
        four = change(state + step * three)
        state += step / 6 * (one + 2 * two + 2 * three + four)
    assert float(end.position[0]) == pytest.approx(5 + rho * math.sin(state[0]), abs=1e-11)
    assert float(end.velocity[0]) == pytest.approx(rho * state[1] * math.cos(state[0]), abs=1e-11)


def test_rolling_friction_stops_a_ball_on_the_way_of_its_energy():
    # v^2 = 2 a s on a level wall, and there it stands
    scene = Scene(level([[0, 0], [30, 0]]), Balls([(1.0, 0.5)], [(3.0, -1.0)], 0.5), (0.0, -PULL), rolling_friction=1.5)
    last = ContactReference(scene).run(10.0)[-1]
    assert last.kind == "rest"
    assert float(last.position[0]) == pytest.approx(1.0 + 9.0 / 3.0, abs=1e-15)


@pytest.mark.parametrize("first", range(0, 36, 6))
def test_runs_with_rolling_friction_end_where_the_reference_ends_them(first):
    # Friction acts when the endless bounces are over. Their last one that is told, of some 1e-5 / s, is late by a
    # rounding of 1e-15 over that, and the end of them by a few times as much.
    for seed in range(first, first + 6):
        _kind, scene, until = rolling_scene(seed)
        assert_ends_as_the_reference(scene, until)


def test_the_last_bounces_of_a_disc_in_a_corner_do_not_take_it_into_the_other_wall():
    # with rolling friction it goes on along the wall in them, by some 1e-10, and the other wall is nearer
    _kind, scene, until = rolling_scene(587)
    end, walls = ContactReference(scene).run(until)[-1], scene.walls.vertices
    place = np.array([float(value) for value in end.position])
    for a, b in zip(walls, np.roll(walls, -1, axis=0), strict=True):
        along = (b - a) / np.hypot(*(b - a))
        beside = a + np.clip((place - a) @ along, 0.0, np.hypot(*(b - a))) * along
        assert np.hypot(*(place - beside)) >= 0.2 - 1e-9
    assert simulate(scene, until=until).final[0].tolist()[1:3] == pytest.approx(place, abs=1e-9)


@pytest.mark.parametrize("bulge", [0.0, 0.25])
def test_the_reference_lets_rolling_friction_wait_for_the_end_of_endless_bounces(bulge):
    # on a level wall they take sqrt(2 h / g) (1 + e) / (1 - e), and nothing slows the ball down along it; at the bottom
    # of a hollow of radius rho what presses it is g + u^2 / rho, to the second order in the way that it comes in them
    e, u, high = 0.5, 3.0, 1e-12
    walls = level([[-5, 0], [5, 0]], [[bulge, 0.0]], restitution=e)
    rho = 5 * (1 + bulge * bulge) / (2 * bulge) if bulge else math.inf
    start = (0.0, -5 * bulge + high)
    scene = Scene(walls, Balls([start], [(u, 0.0)], 0.0), (0.0, -PULL), rolling_friction=1.5)
    changes = ContactReference(scene).run(1.0)
    slide = next(change for change in changes if change.kind == "slide")
    high = start[1] + 5 * bulge  # as drawn, exact
    expected = math.sqrt(2 * high / (PULL + u * u / rho)) * (1 + e) / (1 - e)
    assert float(slide.time) == pytest.approx(expected, rel=1e-6 if bulge else 1e-15)
    assert float(slide.velocity[0]) == pytest.approx(u, abs=1e-10)


@pytest.mark.parametrize("scene_of", [one_sided_scene, touching_scene])
def test_runs_through_one_sided_walls_and_from_starts_in_touch_end_where_the_reference_ends_them(scene_of):
    for seed in range(24):
        _kind, scene, until = scene_of(seed)
        assert_ends_as_the_reference(scene, until)


def test_a_disc_comes_through_a_one_sided_shelf_and_lies_down_on_it():
    # thrown up at 8 it passes the shelf, whose outward side is above, and comes down on it: the work of 9.81 * 2
    shelf = Walls.from_polylines([[(5, 2), (-5, 2)]], closed=False, sides="outward", material=Material(0.0, 1.0))
    scene = Scene(shelf, Balls([(0.0, 0.5)], [(0.0, 8.0)], 0.5), gravity=(0.0, -PULL))
    changes = ContactReference(scene).run(5.0)
    assert [change.kind for change in changes] == ["bounce", "slide", "rest"]
    falls = (8 + math.sqrt(64 - 2 * PULL * 2.0)) / PULL
    assert float(changes[0].time) == pytest.approx(falls, rel=1e-14)


def test_a_ball_that_is_placed_on_a_slope_slides_from_there():
    # 30 degrees: along it g sin(30) t^2 / 2 from the speed 1, whatever tangential restitution would take in bounces
    slope = level([[0, 0], [10 * math.sqrt(3), -10]], restitution=0.5, tangential=0.5)
    down = np.array([math.sqrt(0.75), -0.5])
    place = 2.0 * down + 0.5 * np.array([0.5, math.sqrt(0.75)])
    changes = ended(slope, place, down, 0.5, 1.0)
    assert [change.kind for change in changes] == ["slide", "end"]
    assert changes[-1].row()[1:3] == pytest.approx(place + (1.0 + PULL / 4) * down, abs=1e-14)


def test_rolling_friction_waits_for_the_end_of_endless_bounces():
    # on a level wall they take 2 w / g (1 - e), w after the first, along at the speed u; then it rolls on by u^2 / 2 a
    e, u, high, friction = 0.5, 3.0, 0.2, 1.5
    walls = level([[-5, 0], [30, 0]], restitution=e)
    scene = Scene(walls, Balls([(0.0, 0.5 + high)], [(u, 0.0)], 0.5), (0.0, -PULL), rolling_friction=friction)
    run = simulate(scene, until=20.0)
    bounces = math.sqrt(2 * high / PULL) * (1 + e) / (1 - e)
    assert run.final["x"][0] == pytest.approx(u * bounces + u * u / (2 * friction), abs=1e-9)
    assert run.final["vx"][0] == 0.0


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
        assert_ends_as_the_reference(scene, until)


def test_a_disc_that_runs_up_and_out_of_a_half_pipe_keeps_its_speed():
    # its side is upright and gravity leans away from it: at the joint nothing presses the disc, and it flies off along
    # both, meeting neither
    _kind, scene, until = contact_scene(1209)
    run, changes = simulate(scene, until=until), ContactReference(scene).run(until)
    assert len(run.contacts) < 12
    assert np.abs(np.array(run.final[0].tolist()) - np.array(changes[-1].row())).max() < 1e-11


@pytest.mark.parametrize("seed", [10695, 17145])
def test_at_a_smooth_joint_from_which_a_ball_flies_off_there_is_nothing_to_hit(seed):
    # such pipes, of a disc and of a point: line and arc meet at 1e-16 radians, and tangential restitution below 1, or
    # the far side of the line, would tell of any bounce
    _kind, scene, until = contact_scene(seed)
    run, changes = simulate(scene, until=until), ContactReference(scene).run(until)
    left = next(k for k, change in enumerate(changes) if change.kind == "leave")
    energy = [
        (vx * vx + vy * vy) / 2 - scene.gravity[0] * x - scene.gravity[1] * y
        for _time, x, y, vx, vy in (change.row() for change in changes[left - 1 : left + 1])
    ]
    assert energy[1] == pytest.approx(energy[0], rel=1e-13)  # frictionless up to there, and it leaves with all of it
    assert np.abs(np.array(run.final[0].tolist()) - np.array(changes[-1].row())).max() < 1e-11
