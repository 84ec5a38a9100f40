"""Rolling friction and drag under gravity: closed forms and integrals in 30 digits, and the same bits everywhere."""

import itertools
import math

import mpmath
import numpy as np
import pytest

from wallkit import Balls, Ending, Material, Scene, Walls, World, simulate, survey
from wallkit.kernels.flight.slowed_contact import swing_on
from wallkit.kernels.impact.drag_motion import eased, time_of_way, time_to_border
from wallkit.kernels.records import GOES_ON, LIFTS, TIME_IS_UP, TURNS
from wallkit.simulation.modelled import Modelled
from wallkit.simulation.run import ContactKind
from wallkit.simulation.simulate import Flights, flown

G = 9.81
DOWN = (0.0, -G)
SOFT, RUBBER = Material(0.5, 1.0), Material(0.7, 0.95)
ACTS = [{"rolling_friction": 0.8}, {"drag": 0.3}, {"rolling_friction": 0.4, "drag": 0.5}]


def line(a, b, material=SOFT):
    return Walls.from_polylines([[a, b]], closed=False, material=material)


def bowl(restitution=0.8):
    """A half circle of radius 3 about (0, 0), open above."""
    return Walls.from_polylines([[[-3, 0], [3, 0]]], bulges=[[1, 0]], closed=False, material=Material(restitution, 1.0))


def room(material=RUBBER, bulge=0.06):
    """Nineteen sides, a bar and a peg: more than brute force, so with a grid."""
    angle = 2 * np.pi * np.arange(19) / 19
    ring = 20 * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    return Walls.from_polylines(
        [ring, [(-4.0, -9.0), (3.0, -7.0)], [(5.0, 2.0), (6.0, 2.0)]],
        closed=[True, False, True],
        material=material,
        bulges=[np.full(19, bulge), np.zeros(2), np.ones(2)],
    )


def many(count, radius, seed=3):
    rng = np.random.default_rng(seed)
    turn, way = rng.uniform(0, math.tau, (2, count))
    out, speed = rng.uniform(10.0, 14.0, count)[:, None], rng.uniform(0.1, 30.0, count)[:, None]
    places = out * np.stack([np.cos(turn), np.sin(turn)], axis=1)
    return Balls(places, speed * np.stack([np.cos(way), np.sin(way)], axis=1), radius)


@pytest.mark.parametrize("x", [1e-300, 1e-9, 1e-3, 0.1, 0.4999, 0.5, 0.7, 3.0, 40.0, 900.0])
@pytest.mark.parametrize("k", [1e-6, 0.3, 70.0])
def test_the_times_of_drag_have_all_digits(k, x):
    t = x / k
    with mpmath.workdps(60):
        left = mpmath.exp(-mpmath.mpf(k) * t)
        free = (1 - left) / k
        expected = [float(value) for value in (left, free, (t - free) / k)]
    assert eased(k, t) == pytest.approx(expected, rel=4e-16 * (1 + x))


@pytest.mark.parametrize("when", [time_of_way, time_to_border])
@pytest.mark.parametrize("seed", range(40))
def test_a_way_takes_its_time(seed, when):
    rng = np.random.default_rng(seed)
    k, v, a = 10 ** rng.uniform(-5, 2), 10 ** rng.uniform(-3, 3), rng.choice([-1, 0, 1]) * 10 ** rng.uniform(-2, 2)
    t = rng.uniform(0, 1) * (math.log1p(-k * v / a) / k if a < 0 else 10 / k)
    _left, free, second = eased(k, t)
    # a way rounded by 2^-52 of its parts moves the time by that over the speed
    speed = v * math.exp(-k * t) + a * free
    bound = 4e-16 * (v * free + abs(a) * second) / speed + 4e-15 * t
    assert when(k, v, a, v * free + a * second) == pytest.approx(t, abs=bound)


def test_friction_stops_a_ball_on_a_level_wall_as_it_does_without_gravity():
    balls = Balls([0.0, 0.5], [10.0, 0.0], 0.5)
    run = simulate(Scene(line([-50, 0], [50, 0]), balls, gravity=(0.0, -10.0), rolling_friction=2.0), until=100.0)
    assert run.ending == (Ending.AT_REST,)
    assert run.final[0].tolist() == (5.0, 25.0, 0.5, 0.0, 0.0)  # u / a, u^2 / 2 a
    flat = simulate(Scene(line([-50, 9], [50, 9]), balls, rolling_friction=2.0), until=100.0)
    for time in (0.0, 1.0, 4.9, 5.0, math.inf):
        np.testing.assert_allclose(run.position(time), flat.position(time), atol=1e-12)


@pytest.mark.parametrize(("friction", "moves"), [(0.59, True), (0.61, False)])
def test_a_slope_holds_a_ball_where_friction_is_more_than_its_pull(friction, moves):
    slope = line([-400, 300], [400, -300])  # 3 in 4: it pulls by 0.6 g and is pressed by 0.8 g
    gravity, radius = 10.0, 5.0
    place = [-100.0 + 0.6 * radius, 75.0 + 0.8 * radius]
    level = friction * gravity / 0.8  # what friction takes on the level, so that it takes `friction` g on the slope
    balls = Balls(place, [0.0, 0.0], radius)
    run = simulate(Scene(slope, balls, gravity=(0.0, -gravity), rolling_friction=level), until=4.0)
    assert run.ending == (Ending.TIME_REACHED if moves else Ending.AT_REST,)
    way = np.hypot(*(run.position(4.0)[0] - place))
    assert way == pytest.approx((0.6 - friction) * gravity * 8.0 if moves else 0.0, abs=1e-9)


def test_a_ball_goes_up_a_slope_against_friction_and_down_with_less():
    slope, gravity = line([-400, -300], [400, 300]), 10.0
    up = Scene(slope, Balls([0.0, 0.0], [8.0, 6.0], 0.0), gravity=(0.0, -gravity), rolling_friction=2.5)
    run = simulate(up, until=4.0)
    top = 10.0 / (6.0 + 2.0)  # 0.6 g against it and 0.8 of the friction
    assert run.contacts["kind"].tolist()[-1] == ContactKind.SLIDE
    assert run.contacts["time"][-1] == pytest.approx(top, rel=1e-12)
    highest = 0.5 * 10.0 * top
    np.testing.assert_allclose(run.position(top), [[0.8 * highest, 0.6 * highest]], rtol=1e-12)
    back = highest - 0.5 * (6.0 - 2.0) * (4.0 - top) ** 2
    np.testing.assert_allclose(run.position(4.0), [[0.8 * back, 0.6 * back]], rtol=1e-12)


@pytest.mark.parametrize("radius", [0.0, 0.3])
def test_drag_on_a_slope_has_its_closed_form(radius):
    slope, k = line([-400, 300], [400, -300]), 0.4
    start = np.array([-40.0 + 0.6 * radius, 30.0 + 0.8 * radius])
    run = simulate(Scene(slope, Balls(start, [-4.0, 3.0], radius), gravity=(0.0, -10.0), drag=k), until=9.0)
    assert run.ending == (Ending.TIME_REACHED,)
    for time in (0.3, 0.9, 2.0, 9.0):
        free = -math.expm1(-k * time) / k
        way = -5.0 * free + 6.0 * (time - free) / k
        np.testing.assert_allclose(run.position(time)[0], start + way * np.array([0.8, -0.6]), atol=1e-11)


def speed_closed(rho, away, mu, square, start, angle):
    """V^2 with rolling friction alone: linear in V^2, so exponentials of the angle from the bottom.

    d(V^2)/da = -2 g rho sin a - 2 mu (-away)(g rho cos a + V^2), for a rising from ``start``.
    """
    m = 2 * mpmath.mpf(mu) * away
    a0, a1 = mpmath.mpf(start), mpmath.mpf(angle)

    def part(a):  # a particular solution P cos a + Q sin a of y' = m y + m g rho cos a - 2 g rho sin a
        f = G * mpmath.mpf(rho)
        # y = P cos a + Q sin a: -P sin + Q cos = m P cos + m Q sin + m f cos - 2 f sin
        p = (2 * f - m * m * f) / (1 + m * m)
        q = m * p + m * f
        return p * mpmath.cos(a) + q * mpmath.sin(a)

    return (square - part(a0)) * mpmath.exp(m * (a1 - a0)) + part(a1)


@pytest.mark.parametrize("seed", range(30))
def test_a_glide_with_friction_has_the_speed_of_its_closed_form(seed):
    rng = np.random.default_rng(seed)
    rho, mu = 10 ** rng.uniform(-1, 2), 10 ** rng.uniform(-3, 0)
    start = rng.uniform(-1.2, 0.4)
    square = rng.uniform(0.2, 4.0) * G * rho
    e, t = (math.sin(start), -math.cos(start)), (math.cos(start), math.sin(start))
    way = math.tan(rng.uniform(0.05, 0.7) / 2)
    u, speed, _time, event = swing_on(mu, None, rho, -1.0, *e, *t, *DOWN, math.sqrt(square), way, math.inf)
    there = start + 2 * math.atan(u)
    with mpmath.workdps(30):
        expected = speed_closed(rho, -1, mu, square, start, there)
    if event == TURNS:
        assert abs(float(expected)) < 1e-12 * G * rho
    else:
        assert (event, u) == (GOES_ON, way)
        assert speed**2 == pytest.approx(float(expected), rel=2e-13, abs=2e-13 * G * rho)


@pytest.mark.parametrize("seed", range(12))
def test_a_swing_with_drag_and_friction_is_where_a_taylor_series_puts_it(seed):
    rng = np.random.default_rng(seed)
    rho, mu, k = 10 ** rng.uniform(-1, 2), rng.choice([0.0, 0.1]), 10 ** rng.uniform(-2, 1)
    angle, speed = rng.uniform(-1.4, 0.2), rng.uniform(0.3, 1.5) * math.sqrt(G * rho)
    e, t = (math.sin(angle), -math.cos(angle)), (math.cos(angle), math.sin(angle))
    span = rng.uniform(0.1, 0.5) * math.sqrt(rho / G)
    u, then, time, event = swing_on(mu or None, k, rho, -1.0, *e, *t, *DOWN, speed, 1.0, span)
    with mpmath.workdps(25):

        def law(_time, state):
            a, w = state
            pressed = G * mpmath.cos(a) + rho * w * w
            return [w, (-G * mpmath.sin(a) - mu * pressed) / rho - k * w]

        solved = mpmath.odefun(law, 0, [mpmath.mpf(angle), mpmath.mpf(speed) / rho])
        a, w = solved(mpmath.mpf(time))
    if event == TIME_IS_UP:
        assert time == span
    assert angle + 2 * math.atan(u) == pytest.approx(float(a), abs=2e-14)
    assert then == pytest.approx(float(w) * rho, abs=4e-14 * math.sqrt(G * rho))


def test_a_ball_slowed_in_a_loop_lifts_where_nothing_presses_it():
    rho, mu, start = 2.0, 0.05, 0.0
    square = 5.0 * G * rho  # enough for the loop without friction, not with it
    u, speed, time, event, angle = 0.0, math.sqrt(square), 0.0, GOES_ON, start
    while event == GOES_ON:
        e, t = (math.sin(angle), -math.cos(angle)), (math.cos(angle), math.sin(angle))
        u, speed, took, event = swing_on(mu, None, rho, -1.0, *e, *t, *DOWN, speed, 1.0, math.inf)
        angle, time = angle + 2 * math.atan(u), time + took
    assert event == LIFTS
    with mpmath.workdps(30):

        def pressed(a):
            return speed_closed(rho, -1, mu, square, start, a) / rho + G * mpmath.cos(a)

        expected = mpmath.findroot(pressed, (1.8, 3.0), solver="anderson")
    assert angle == pytest.approx(float(expected), rel=1e-13)


@pytest.mark.parametrize("acts", ACTS, ids=str)
def test_a_bowl_brings_a_ball_to_rest_at_its_bottom(acts):
    run = simulate(Scene(bowl(), Balls([-1.0, 1.0], [0.0, 0.0], 0.1), gravity=DOWN, **acts), until=1e4)
    assert run.ending == (Ending.AT_REST,)
    x, y = run.final["x"][0], run.final["y"][0]
    assert math.hypot(x, y) == pytest.approx(2.9, rel=1e-14)
    mu = acts.get("rolling_friction", 0.0) / G
    assert abs(x) <= (mu + 1e-12) * -y  # where friction holds it: tan a <= mu
    times = np.linspace(0.0, run.final["time"][0], 2000)
    energy = 0.5 * np.square(run.velocity(times)).sum(axis=2)[:, 0] + G * run.position(times)[:, 0, 1]
    assert np.all(np.diff(energy) <= 1e-12 * G * 4.0)


def test_a_drop_with_drag_is_where_the_closed_form_puts_it_and_bounces_there():
    k, height = 0.5, 7.0
    floor = line([-9, 0], [9, 0], Material(1.0, 1.0))
    run = simulate(Scene(floor, Balls([0.0, height], [1.0, 0.0]), gravity=DOWN, drag=k), until=3.0)
    first = run.contacts[0]
    with mpmath.workdps(30):

        def above(t):
            return height - G * (t - (1 - mpmath.exp(-k * t)) / k) / k

        down = mpmath.findroot(above, 1.5)
        speed = G * (1 - mpmath.exp(-k * down)) / k
    assert first["time"] == pytest.approx(float(down), rel=1e-15)
    assert first["vy"] == pytest.approx(float(speed), rel=1e-14)
    assert first["vx"] == pytest.approx(math.exp(-k * float(down)), rel=1e-15)


def first_touch(place, velocity, k, gap, counts, until):
    """When a flight first has a gap of 0 where that counts, in 30 digits: sampled densely, then refined."""
    with mpmath.workdps(30):

        def there(t):
            f = (1 - mpmath.exp(-k * t)) / k
            s = (t - f) / k
            return [place[i] + velocity[i] * f + DOWN[i] * s for i in range(2)]

        steps = [mpmath.mpf(until) * i / 400 for i in range(1, 401)]
        for before, after in itertools.pairwise(steps):
            if gap(there(before)) > 0 >= gap(there(after)):
                time = mpmath.findroot(lambda t: gap(there(t)), (before, after), solver="anderson")
                if counts(there(time)):
                    return float(time)
    return None


@pytest.mark.parametrize("seed", range(12))
def test_flights_with_drag_meet_lines_corners_and_arcs_when_they_do(seed):
    rng = np.random.default_rng(seed)
    radius, k = rng.choice([0.0, 0.2]), 10 ** rng.uniform(-2, 0.7)
    velocity = rng.uniform(2.0, 14.0) * np.array([1.0, rng.uniform(-0.3, 1.5)])
    peg = Walls.from_polylines(
        [[(4.0, 0.0), (5.0, 0.0)], [(7.0, -30.0), (7.0, 1.0)], [(-20.0, -9.0), (20.0, -8.0)]],
        bulges=[[1.0, 1.0], [0.0, 0.0], [0.0, 0.0]],
        closed=[True, False, False],
    )
    until = 4.0
    contacts = simulate(Scene(peg, Balls([0.0, 0.3], velocity, radius), gravity=DOWN, drag=k), until=until).contacts
    n = np.array([-1.0, 40.0]) / math.hypot(1.0, 40.0)
    gaps = [
        (lambda p: mpmath.sqrt((p[0] - 4.5) ** 2 + p[1] ** 2) - 0.5 - radius, lambda p: True),
        (lambda p: mpmath.sqrt((p[0] - 7) ** 2 + (p[1] - 1) ** 2) - radius, lambda p: radius > 0.0),
        (lambda p: 7 - p[0] - radius, lambda p: p[1] <= 1),
        (lambda p: p[0] * n[0] + (p[1] + 8.5) * n[1] - radius, lambda p: p[0] <= 20),
    ]
    touched = [first_touch((0.0, 0.3), velocity, k, *gap, until) for gap in gaps]
    times = [time for time in touched if time is not None]
    if not times:
        assert not len(contacts)
        return
    assert contacts["time"][0] == pytest.approx(min(times), rel=1e-12)


@pytest.mark.parametrize("radius", [0.0, 0.4])
def test_the_index_changes_no_bit_of_a_flight(radius):
    scene = Scene(room(Material(1.0, 1.0)), many(6, radius), gravity=(1.0, -G), drag=0.3)
    runs = [flown(Flights(scene, mode="interpreted", index=index), 4.0, 10**6) for index in ("none", "grid")]
    assert Modelled(scene, index="grid").model.grid is not None
    assert runs[0].contacts.tobytes() == runs[1].contacts.tobytes()
    assert runs[0].final.tobytes() == runs[1].final.tobytes()


@pytest.mark.parametrize("acts", ACTS, ids=str)
@pytest.mark.parametrize("radius", [0.0, 0.4])
def test_energy_never_grows_and_nobody_leaves_the_room(acts, radius):
    run = simulate(Scene(room(), many(4, radius), gravity=DOWN, **acts), until=12.0, mode="interpreted")
    times = np.linspace(0.0, 12.0, 401)
    place, velocity = run.position(times), run.velocity(times)
    assert np.hypot(place[..., 0], place[..., 1]).max() < 20.5
    energy = 0.5 * np.square(velocity).sum(axis=2) + G * place[..., 1]
    assert np.all(np.diff(energy, axis=0) <= 1e-9)


@pytest.mark.parametrize("acts", ACTS, ids=str)
def test_world_is_where_the_run_is_and_reports_the_same(acts):
    scene = Scene(room(), many(3, 0.4), gravity=DOWN, sensors=line([-15, -12], [15, -12]), **acts)
    run, world = simulate(scene, until=4.0, mode="interpreted"), World(scene)
    seen = []
    for frame in range(1, 241):
        seen.append(world.step(1 / 60))
        if frame % 40 == 0:
            np.testing.assert_allclose(world.position, run.position(world.time), atol=1e-9)
            np.testing.assert_allclose(world.velocity, run.velocity(world.time), atol=1e-9)
    told = np.concatenate(seen)
    until = run.contacts["time"] <= world.time
    for ball in range(3):
        mine, theirs = told[told["ball"] == ball], run.contacts[until & (run.contacts["ball"] == ball)]
        assert mine["kind"].tolist() == theirs["kind"].tolist()
        np.testing.assert_allclose(mine["time"], theirs["time"], atol=1e-11)


@pytest.mark.parametrize("acts", ACTS, ids=str)
def test_sensors_are_crossed_where_the_run_passes_them(acts):
    gates = Walls.from_polylines([[(-15, -12), (15, -12)], [(0, -25), (0, 25)]], closed=False)
    scene = Scene(room(), many(4, 0.4, seed=8), gravity=DOWN, sensors=gates, **acts)
    run = simulate(scene, until=15.0, mode="interpreted")
    crossed = run.contacts[run.contacts["kind"] >= ContactKind.ENTER]
    assert len(crossed) >= 8
    for row in crossed:
        x, y = run.position(float(row["time"]))[row["ball"]]
        assert (x if row["wall"] else y + 12.0) == pytest.approx(0.0, abs=1e-9)
    places = run.position(np.linspace(0.0, 15.0, 3001))
    for ball in range(4):  # as often as the side changes from sample to sample: what comes back sooner comes in pairs
        sides = np.sign(places[:, ball, 0])
        own = crossed[(crossed["ball"] == ball) & (crossed["wall"] == 1)]
        changes = int(np.count_nonzero(np.diff(sides[sides != 0])))
        assert len(own) >= changes
        assert (len(own) - changes) % 2 == 0


@pytest.mark.parametrize("nothing", [{"rolling_friction": 0.0}, {"drag": 0.0}, {"drag": 1e-300}], ids=str)
def test_nothing_that_slows_is_nothing(nothing):
    scene = {"walls": room(), "balls": many(3, 0.4), "gravity": DOWN}
    run, plain = simulate(Scene(**scene, **nothing), until=8.0), simulate(Scene(**scene), until=8.0)
    assert run.contacts.tobytes() == plain.contacts.tobytes()
    assert run.final.tobytes() == plain.final.tobytes()


@pytest.mark.parametrize("acts", [{"drag": 1e-13}, {"rolling_friction": 1e-13}], ids=str)
def test_next_to_nothing_is_next_to_nothing(acts):
    scene = {"walls": room(Material(0.6, 1.0)), "balls": many(6, 0.4), "gravity": DOWN}
    run, plain = simulate(Scene(**scene, **acts), until=6.0), simulate(Scene(**scene), until=6.0)
    for time in (0.5, 1.0, 2.0):
        np.testing.assert_allclose(run.position(time), plain.position(time), atol=1e-9)


def test_compiled_kernels_give_the_bits_of_interpreted_ones():
    scene = Scene(room(), many(6, 0.4), gravity=DOWN, drag=0.3, rolling_friction=0.5)
    run = simulate(scene, until=6.0, mode="interpreted")
    machine = simulate(scene, until=6.0, mode="compiled")
    assert ContactKind.SLIDE in run.contacts["kind"]
    assert run.contacts.tobytes() == machine.contacts.tobytes()
    assert run.final.tobytes() == machine.final.tobytes()
    totals = survey(scene, until=6.0)
    np.testing.assert_array_equal(totals.position, run.position(math.inf))


def test_a_survey_counts_the_crossings_that_a_run_tells():
    gate = line([-15, -12], [15, -12])
    scene = Scene(room(), many(6, 0.4), gravity=DOWN, drag=0.3, rolling_friction=0.5, sensors=gate)
    run, totals = simulate(scene, until=6.0, mode="interpreted"), survey(scene, until=6.0)
    kinds = run.contacts["kind"] == ContactKind.ENTER, run.contacts["kind"] == ContactKind.EXIT
    assert totals.crossings.tolist() == [[int(kind.sum()) for kind in kinds]]
    assert kinds[0].any() or kinds[1].any()
