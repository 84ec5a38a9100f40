"""Balls that keep to curved walls under gravity: pendulums, loops, domes; against elliptic integrals in 30 digits."""

import math

import mpmath
import numpy as np
import pytest

from wallkit import Balls, Ending, Material, Scene, Walls, World, simulate, survey
from wallkit.kernels.flight.pendulum import carlson_rf, swing
from wallkit.simulation.run import ContactKind

G = 9.81
DOWN = (0.0, -G)
QUARTER = math.tan(math.pi / 8)


def half_pipe(restitution=0.5):
    """A half circle of radius 3 about (0, 0), with plumb walls above its ends."""
    return Walls.from_polylines(
        [[[-3, 3], [-3, 0], [3, 0], [3, 3]]], bulges=[[0, 1, 0, 0]], closed=False, material=Material(restitution, 1.0)
    )


def at_rest_in_the_pipe(angle, radius):
    rho = 3.0 - radius
    return Balls([rho * math.sin(angle), -rho * math.cos(angle)], [0.0, 0.0], radius)


def period_of(rho, angle):
    with mpmath.workdps(30):
        return float(4 * mpmath.sqrt(mpmath.mpf(rho) / G) * mpmath.ellipk(mpmath.sin(mpmath.mpf(angle) / 2) ** 2))


@pytest.mark.parametrize("xyz", [(0.0, 1.0, 2.0), (1e-12, 1.0, 2.0), (3.0, 3.0, 3.0), (1e-20, 1e-3, 1e20)])
def test_the_integral_of_the_first_kind_has_all_digits(xyz):
    assert carlson_rf(*xyz) == pytest.approx(float(mpmath.elliprf(*xyz)), rel=4e-16)


def test_it_is_infinite_where_the_pendulum_takes_for_ever():
    assert carlson_rf(0.0, 0.0, 1.0) == math.inf


@pytest.mark.parametrize("seed", range(60))
def test_a_pendulum_is_where_jacobi_puts_it(seed):
    rng = np.random.default_rng(seed)
    rho, g, angle = 10 ** rng.uniform(-2, 3), 10 ** rng.uniform(-1, 3), rng.uniform(-3.1, 3.1)
    speed = rng.choice([0.0, 1e-6, 0.3, 1.9, 2.1, 5.0]) * math.sqrt(g * rho) * rng.choice([-1, 1])
    span = rng.choice([0.1, 1.0, 7.0, 100.0]) * math.sqrt(rho / g)
    with mpmath.workdps(30):
        w, s = mpmath.sqrt(mpmath.mpf(g) / rho), mpmath.sin(mpmath.mpf(angle) / 2)
        m = mpmath.mpf(speed) ** 2 / (4 * mpmath.mpf(g) * rho) + s * s
        back = -1 if speed < 0 else 1
        if m > 1:  # it goes round
            u = mpmath.ellipf(mpmath.mpf(angle) / 2, 1 / m) + back * mpmath.sqrt(m) * w * span
            there = 2 * mpmath.atan2(mpmath.ellipfun("sn", u, 1 / m), mpmath.ellipfun("cn", u, 1 / m))
            then = back * 2 * mpmath.sqrt(m) * w * rho * mpmath.ellipfun("dn", u, 1 / m)
        else:
            start = mpmath.ellipf(mpmath.asin(min(max(s / mpmath.sqrt(m), -1), 1)), m)
            u = (2 * mpmath.ellipk(m) - start if speed < 0 else start) + w * span
            there = 2 * mpmath.asin(mpmath.sqrt(m) * mpmath.ellipfun("sn", u, m))
            then = 2 * mpmath.sqrt(m) * w * rho * mpmath.ellipfun("cn", u, m)
        there, then = float(there), float(then)
    ex, ey, v, dx, dy = swing(rho, 0.0, -g, math.sin(angle), -math.cos(angle), speed, span)
    # a rounding of the energy changes the period: its error grows with time, and with log 1 / |1 - m| near the top
    bound = 3e-14 * (1.0 + span * math.sqrt(g / rho))
    assert abs(math.remainder(math.atan2(ex, -ey) - there, 2 * math.pi)) < bound
    np.testing.assert_allclose([math.sin(angle) + dx, -math.cos(angle) + dy], [ex, ey], atol=1e-13)
    assert abs(v - then) < bound * math.sqrt(g * rho) * (1.0 + abs(speed) / math.sqrt(g * rho))


@pytest.mark.parametrize("radius", [0.0, 0.1, 2.0])
@pytest.mark.parametrize("angle", [0.01, 0.3, 1.0, 1.5])
def test_a_ball_in_a_half_pipe_has_the_period_of_a_pendulum(radius, angle):
    balls = at_rest_in_the_pipe(angle, radius)
    period = period_of(3.0 - radius, angle)
    run = simulate(Scene(half_pipe(), balls, gravity=DOWN), until=20.25 * period)
    begun = run.contacts["time"][-1]  # it may fall on to the wall over the rounding of where it was put
    assert begun < 1e-6
    np.testing.assert_allclose(run.position(10 * period), balls.position, atol=1e-11)
    np.testing.assert_allclose(run.position(10.5 * period), balls.position * [-1, 1], atol=1e-11)
    np.testing.assert_allclose(run.position(10.25 * period), [[0.0, radius - 3.0]], atol=1e-6)
    energy = 0.5 * np.square(run.velocity(20.2 * period)).sum() + G * run.position(20.2 * period)[0, 1]
    assert energy == pytest.approx(G * balls.position[0, 1], rel=1e-12)
    assert run.ending == (Ending.TIME_REACHED,)


def test_a_ball_that_swings_for_ever_says_so_where_no_time_ends_it():
    run = simulate(Scene(half_pipe(), at_rest_in_the_pipe(1.0, 0.1), gravity=DOWN), bounces=100)
    assert run.ending == (Ending.SWINGING,)
    assert run.ending[0].label == "swings for ever"


def test_a_bowl_without_friction_keeps_a_ball_gliding_with_its_energy():
    bowl = Walls.from_polylines([[[-3, 0], [3, 0]]], bulges=[[1, 0]], closed=False, material=Material(0.8, 1.0))
    run = simulate(Scene(bowl, Balls([-1.0, 1.0], [0.0, 0.0], 0.1), gravity=DOWN), until=1e4)
    slide = run.contacts[-1]
    assert slide["kind"] == ContactKind.SLIDE
    energy = 0.5 * (slide["vx"] ** 2 + slide["vy"] ** 2) + G * slide["y"]
    for time in (100.0, 5000.0, 1e4):
        (vx, vy), (x, y) = run.velocity(time)[0], run.position(time)[0]
        assert 0.5 * (vx**2 + vy**2) + G * y == pytest.approx(energy, rel=1e-12)
        assert math.hypot(x, y) == pytest.approx(2.9, rel=1e-14)


def loop(square, radius):
    """A floor that runs into three quarters of a circle of radius 2, and the squared speed at its bottom."""
    way = [[-5, 0], [0, 0], [2, 2], [0, 4], [-2, 2]]
    level = Walls.from_polylines(
        [way], bulges=[[0, QUARTER, QUARTER, QUARTER, 0]], closed=False, material=Material(0.5, 1.0)
    )
    balls = Balls([-4.0, radius], [math.sqrt(square), 0.0], radius)
    return simulate(Scene(level, balls, gravity=DOWN), until=4.0).contacts


@pytest.mark.parametrize("radius", [0.0, 0.3])
@pytest.mark.parametrize("part", [2.1, 2.5, 3.0, 4.0, 4.9, 4.99])
def test_a_ball_too_slow_for_a_loop_leaves_it_where_nothing_presses_it(radius, part):
    rho = 2.0 - radius
    leave = next(contact for contact in loop(part * G * rho, radius) if contact["kind"] == ContactKind.LEAVE)
    assert (leave["y"] - 2.0) / rho == pytest.approx((part - 2.0) / 3.0, abs=1e-13)
    assert leave["x"] > 0.0


@pytest.mark.parametrize("radius", [0.0, 0.3])
def test_a_loop_holds_a_ball_from_five_g_rho_on(radius):
    rho = 2.0 - radius
    for part in (5.0 * (1 + 1e-12), 5.1, 9.0):
        leave = next(contact for contact in loop(part * G * rho, radius) if contact["kind"] == ContactKind.LEAVE)
        np.testing.assert_allclose([leave["x"], leave["y"]], [-rho, 2.0], atol=1e-12)
    leave = next(
        contact for contact in loop(5.0 * (1 - 1e-9) * G * rho, radius) if contact["kind"] == ContactKind.LEAVE
    )
    assert leave["x"] > 0.0


@pytest.mark.parametrize("radius", [0.0, 0.5])
@pytest.mark.parametrize("speed", [0.01, 0.5, 2.0])
def test_a_ball_slides_off_a_dome_as_off_a_sphere(radius, speed):
    dome = Walls.from_polylines([[[3, 0], [-3, 0]]], bulges=[[1, 0]], closed=False, material=Material(0.5, 1.0))
    rho = 3.0 + radius
    run = simulate(Scene(dome, Balls([0.0, rho], [speed, 0.0], radius), gravity=DOWN), until=10.0)
    leave = run.contacts[run.contacts["kind"] == ContactKind.LEAVE][0]
    assert leave["y"] / rho == pytest.approx(2.0 / 3.0 + speed * speed / (3.0 * G * rho), abs=1e-13)


def test_a_run_and_a_world_put_a_gliding_ball_at_the_same_place():
    scene = Scene(half_pipe(), at_rest_in_the_pipe(1.2, 0.1), gravity=DOWN)
    run, world = simulate(scene, until=10.0), World(scene)
    for _frame in range(200):
        world.step(1 / 30)
        np.testing.assert_allclose(world.position, run.position(world.time), atol=1e-12)
        np.testing.assert_allclose(world.velocity, run.velocity(world.time), atol=1e-11)


@pytest.mark.parametrize("bulge", [1e-3, 1e-6, 1e-9])
def test_a_nearly_straight_arc_is_slid_down_as_the_line_that_it_nearly_is(bulge):
    leaves = []
    for bend in (0.0, bulge, -bulge):
        slope = Walls.from_polylines(
            [[[0, 300], [400, 0]]], bulges=[[bend, 0]], closed=False, material=Material(0.0, 1.0)
        )
        run = simulate(Scene(slope, Balls([40.0, 276.0], [0.0, 0.0], 0.0), gravity=(0.0, -100.0)), until=5.0)
        leaves.append(run.contacts[run.contacts["kind"] == ContactKind.LEAVE][0])
    for leave in leaves[1:]:
        # its sagitta is 250 bulge; energy alone decides the speed, and the place is the end
        assert leave["time"] == pytest.approx(leaves[0]["time"], rel=20 * bulge)
        assert math.hypot(leave["vx"], leave["vy"]) == pytest.approx(
            math.hypot(leaves[0]["vx"], leaves[0]["vy"]), rel=20 * bulge
        )
        assert (leave["x"], leave["y"]) == (pytest.approx(400.0, abs=1e-9), pytest.approx(0.0, abs=1e-9))


@pytest.mark.parametrize("bulge", [-0.2, 0.0, 0.3])
@pytest.mark.parametrize("restitution", [0.3, 0.6, 0.85])
def test_a_point_that_settles_in_the_tip_of_a_valley_rests_there(restitution, bulge):
    # Each bounce takes energy and both sides rise from the tip: there is no other place to stay, whichever of the two a
    # point meets first where it hits the tip to rounding. Of 300 some do so, before they are slow enough to be caught.
    corners = [(0.0, 0.0), (55.0, 100.0), (-70.0, 100.0)]
    valley = Walls.from_polylines([corners], bulges=[[bulge, 0.0, 0.0]], material=Material(restitution))
    rng = np.random.default_rng(8)
    starts = np.column_stack([rng.uniform(-20.0, 15.0, 300), rng.uniform(60.0, 90.0, 300)])
    scene = Scene(valley, Balls(starts, rng.normal(0.0, 10.0, (300, 2))), gravity=(0.0, -30.0))
    totals = survey(scene, until=1e4)
    assert set(totals.ending) == {Ending.AT_REST}
    # Hops along an edge of about 100 are left out in 2^-20 of it before the last hit, which is at the tip to rounding.
    assert np.abs(totals.position).max() < 1e-9
    assert not totals.velocity.any()
    assert totals.time.max() < 1e3


@pytest.mark.parametrize(("right", "left", "along"), [(0.697, 0.512, 0.6), (0.618, 0.322, 0.3), (0.205, 0.202, 0.3)])
def test_a_point_that_loses_speed_along_the_walls_of_a_valley_alone_rests_in_its_tip(right, left, along):
    # No hop between these walls that meets both square is stable; a hundred of 200 hit the tip before they are caught.
    valley = _valley(right, left, Material(1.0, along))
    scene = Scene(valley, Balls(*_thrown_into(valley, 200)), gravity=(0.0, -30.0))
    totals = survey(scene, until=1e3)
    assert set(totals.ending) == {Ending.AT_REST}
    assert np.abs(totals.position).max() < 1e-9


@pytest.mark.parametrize(("right", "left", "along"), [(0.92, 1.106, 0.3), (1.036, 1.281, 0.6)])
def test_a_point_hops_on_for_ever_between_walls_that_it_meets_square(right, left, along):
    # Square to both walls it loses nothing, e = 1; across gravity its speed stays, and the flight's middle is its top.
    valley = _valley(right, left, Material(1.0, along))
    scene = Scene(valley, Balls(*_thrown_into(valley, 50)), gravity=(0.0, -30.0))
    run = simulate(scene, until=300.0)
    for ball in range(50):
        last, end = run.contacts[run.contacts["ball"] == ball][-2:]
        for contact in (last, end):
            across = contact["vx"] * contact["nx"] + contact["vy"] * contact["ny"]
            assert across == pytest.approx(math.hypot(contact["vx"], contact["vy"]), rel=1e-12)
        assert {last["edge"], end["edge"]} == {0, 2}
        time = end["time"] - last["time"]
        # -w2 n2 = w1 n1 + g T, and b t2 = a t1 + w1 n1 T + g T^2 / 2
        assert -end["vx"] == pytest.approx(last["vx"], rel=1e-9)
        assert -end["vy"] == pytest.approx(last["vy"] - 30.0 * time, rel=1e-9)
        assert end["x"] == pytest.approx(last["x"] + last["vx"] * time, rel=1e-9)


def test_the_order_of_bounces_in_a_tip_decides_whether_speed_is_lost_or_a_hop_is_for_ever():
    # Two points that meet one or the other wall first, 1e-7 from a tip, with the same velocity: no continuation of
    # a hit of the tip itself is the limit of both.
    valley, speed, angle, time = _valley(1.437, 0.297, Material(1.0, 0.6)), 5.0, 2.046, 2e-3
    there = -speed * np.array([math.cos(angle), math.sin(angle)])
    pull = np.array([0.0, -30.0])
    aside = 1e-7 * np.array([math.sin(angle), -math.cos(angle)])
    places = [side * aside - there * time + pull * time**2 / 2 for side in (1.0, -1.0)]
    run = simulate(Scene(valley, Balls(places, [there - pull * time] * 2), gravity=tuple(pull)), until=60.0)
    assert [run.contacts[run.contacts["ball"] == ball]["edge"][0] for ball in (0, 1)] == [0, 2]
    speed = np.hypot(run.final["vx"], run.final["vy"])
    assert run.ending[0] == Ending.TIME_REACHED
    assert speed[0] > 0.1
    assert speed[1] < 1e-3  # the other has next to nothing left where it hits the tip itself
    assert math.hypot(run.final["x"][1], run.final["y"][1]) < 1e-9


def _valley(right, left, material):
    """Walls of length 100 that rise from (0, 0) at two angles, closed above."""
    ends = [(100 * math.cos(right), 100 * math.sin(right)), (-100 * math.cos(left), 100 * math.sin(left))]
    return Walls.from_polylines([[(0.0, 0.0), *ends]], material=material)


def _thrown_into(valley, count):
    rng = np.random.default_rng(3)
    inside = rng.dirichlet((1, 1, 1), count) @ valley.vertices
    return 0.8 * inside + 0.2 * valley.vertices.mean(axis=0), rng.normal(0.0, 10.0, (count, 2))
