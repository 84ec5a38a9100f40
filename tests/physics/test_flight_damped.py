"""Rolling friction and drag: closed forms, the path of a ball that is not slowed, and the same bits everywhere."""

import math

import mpmath
import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from wallkit import Balls, Material, Scene, SceneError, Walls, World, simulate, survey
from wallkit.accuracy import scenes
from wallkit.kernels.flight.damping import free_time, last_flight, slowed
from wallkit.kernels.jit import compiled, kernel
from wallkit.simulation.modelled import Modelled
from wallkit.simulation.run import ContactKind, Ending
from wallkit.simulation.streams import RandomBalls, survey_stream

FAR = Walls.from_polylines([[(-1e6, -1e6), (1e6, -1e6), (1e6, 1e6), (-1e6, 1e6)]])
ACTS = [{"rolling_friction": 3.0}, {"drag": 0.2}]
STEEL, RUBBER = Material(), Material(0.8, 0.95)


def room(material=STEEL, bulge=0.0):
    """Nine sides, straight or bowed, and a bar: more than brute force, so with a grid."""
    angle = 2 * np.pi * np.arange(19) / 19
    ring = 20 * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    return Walls.from_polylines(
        [ring, [(-4.0, -9.0), (3.0, -7.0)]],
        closed=[True, False],
        material=material,
        bulges=[np.full(19, bulge), np.zeros(2)],
    )


def many(count, radius=0.0, speed=25.0):
    rng = np.random.default_rng(3)
    angle, way = rng.uniform(0, math.tau, (2, count))
    out = rng.uniform(0.0, 4.0, count)
    way = rng.uniform(0.1, speed, count)[:, None] * np.stack([np.cos(way), np.sin(way)], axis=1)
    return Balls(out[:, None] * np.stack([np.cos(angle), np.sin(angle)], axis=1), way, radius)


def test_friction_stops_a_ball_at_its_place_and_time():
    run = simulate(Scene(FAR, Balls([1.0, 2.0], [3.0, -4.0]), rolling_friction=0.5), until=100.0)
    assert run.ending == (Ending.AT_REST,)
    assert run.final[0].tolist() == (10.0, 1.0 + 0.6 * 25.0, 2.0 - 0.8 * 25.0, 0.0, 0.0)  # u / a, u^2 / 2 a
    assert run.position(4.0)[0].tolist() == pytest.approx(
        [1.0 + 0.6 * 16.0, 2.0 - 0.8 * 16.0], rel=1e-15
    )  # u t - a t^2 / 2
    assert run.velocity(4.0)[0].tolist() == pytest.approx([1.8, -2.4], rel=1e-15)
    for late in (10.0, 11.0, math.inf):
        assert run.position(late).tolist() == [[16.0, -18.0]]
        assert run.velocity(late).tolist() == [[0.0, 0.0]]


def test_without_a_limit_in_time_friction_ends_the_run():
    run = simulate(Scene(FAR, Balls([1.0, 2.0], [3.0, -4.0]), rolling_friction=0.5), bounces=5)
    assert run.ending == (Ending.AT_REST,)
    assert run.final["time"][0] == 10.0


def test_drag_takes_a_ball_u_over_k_in_the_end():
    scene = Scene(FAR, Balls([1.0, 2.0], [3.0, -4.0]), drag=0.5)
    run = simulate(scene, until=6.0)
    assert run.ending == (Ending.TIME_REACHED,)
    kept = math.exp(-3.0)
    where = (1.0 + 6.0 * (1 - kept), 2.0 - 8.0 * (1 - kept), 3 * kept, -4 * kept)
    assert run.final[0].tolist()[1:] == pytest.approx(where, rel=1e-15)
    np.testing.assert_array_equal(run.position(6.0)[0], [run.final["x"][0], run.final["y"][0]])


def test_a_ball_that_drag_has_all_but_stopped_is_at_rest():
    scene = Scene(FAR, Balls([1.0, 2.0], [3.0, -4.0]), drag=0.5)
    run = simulate(scene, bounces=5)
    assert run.ending == (Ending.AT_REST,)
    assert run.final["time"][0] == pytest.approx(100.0 * math.log(2.0), rel=1e-15)  # 50 halvings of the speed
    np.testing.assert_allclose(run.position(math.inf), [[7.0, -6.0]], rtol=1e-14)
    assert run.velocity(math.inf).tolist() == [[0.0, 0.0]]
    assert run.velocity(69.0).all()
    assert simulate(scene, until=69.0).ending == (Ending.TIME_REACHED,)
    assert simulate(scene, until=70.0).final.tobytes() == run.final.tobytes()


@pytest.mark.parametrize(("way", "contacts"), [(8.0, 0), (math.nextafter(8.0, 9.0), 1)])
def test_a_ball_that_stops_at_a_wall_does_not_touch_it(way, contacts):
    wall = Walls.from_polylines([[(8.0, -9.0), (8.0, 9.0)]], closed=False)
    speed = math.sqrt(2.0 * way)
    run = simulate(Scene(wall, Balls([0.0, 0.0], [speed, 0.0]), rolling_friction=speed**2 / (2.0 * way)), until=100.0)
    assert len(run.contacts) == contacts
    assert run.ending == (Ending.AT_REST,)
    assert run.final["x"][0] == pytest.approx(8.0, rel=1e-15)


@pytest.mark.parametrize("acts", ACTS, ids=str)
@pytest.mark.parametrize("material", [STEEL, RUBBER], ids=["steel", "rubber"])
@pytest.mark.parametrize(("radius", "bulge"), [(0.0, 0.0), (1.0, 0.05)])
def test_the_path_is_that_of_a_ball_that_is_not_slowed_on_another_clock(acts, material, radius, bulge):
    ball = Balls([1.0, 2.0], [95.0, 140.0], radius)
    walls = room(material, bulge)
    run = simulate(Scene(walls, ball, **acts), until=60.0)
    plain = simulate(Scene(walls, ball), bounces=40).contacts
    contacts = run.contacts
    count = min(len(contacts), len(plain), 12)  # beyond, chaos tells roundings apart
    assert count > 8
    assert contacts["wall"][:count].tolist() == plain["wall"][:count].tolist()
    for name in ("x", "y", "nx", "ny"):
        np.testing.assert_allclose(contacts[name][:count], plain[name][:count], atol=1e-9, err_msg=name)
    times, speeds = reclocked(np.array([1.0, 2.0]), np.array([95.0, 140.0]), plain[:count], **acts)
    np.testing.assert_allclose(contacts["time"][:count], times, rtol=1e-11)
    np.testing.assert_allclose(np.hypot(contacts["vx"], contacts["vy"])[:count], speeds, rtol=1e-10)


def reclocked(place, velocity, contacts, rolling_friction=0.0, drag=0.0):
    """Times and speeds after the contacts of a slowed ball, by 40 digits, from the places of one that is not."""
    with mpmath.workdps(40):
        a, k = mpmath.mpf(rolling_friction), mpmath.mpf(drag)
        speed = free = mpmath.hypot(*map(float, velocity))
        time, times, speeds = mpmath.mpf(0), [], []
        x, y = map(float, place)
        for contact in contacts:
            length = mpmath.hypot(mpmath.mpf(float(contact["x"])) - x, mpmath.mpf(float(contact["y"])) - y)
            end = mpmath.sqrt(speed**2 - 2 * a * length) if a else speed - k * length
            time += (speed - end) / a if a else mpmath.log(speed / end) / k
            after = mpmath.hypot(float(contact["vx"]), float(contact["vy"]))
            speed, free = end * after / free, after
            x, y = float(contact["x"]), float(contact["y"])
            times.append(float(time))
            speeds.append(float(speed))
    return times, speeds


@pytest.mark.parametrize("acts", ACTS, ids=str)
def test_between_contacts_and_at_the_end_a_run_is_where_it_was_cut(acts):
    scene = Scene(room(RUBBER), many(4, 0.5), **acts)
    whole = simulate(scene, until=8.0)
    for time in (0.3, 1.7, 4.0, 8.0):
        cut = simulate(scene, until=time)
        before = whole.contacts[whole.contacts["time"] <= time]
        assert cut.contacts.tobytes() == before.tobytes()
        np.testing.assert_allclose(cut.position(time), whole.position(time), rtol=0, atol=1e-13)
        np.testing.assert_allclose(cut.velocity(time), whole.velocity(time), rtol=0, atol=1e-13)


@pytest.mark.parametrize("acts", ACTS, ids=str)
@pytest.mark.parametrize("walls", [room(), room(RUBBER, 0.05), scenes.star()], ids=["grid", "arcs", "few"])
@pytest.mark.parametrize("radius", [0.0, 1.0])
def test_surveys_and_both_kinds_of_kernels_give_the_same_bits(acts, walls, radius):
    scene = Scene(walls, many(130, radius, 100.0), **acts)  # without damping so many would fly in step
    run = simulate(scene, until=7.0, mode="interpreted")
    other = simulate(scene, until=7.0, mode="compiled")
    totals = survey(scene, until=7.0)
    assert run.contacts.tobytes() == other.contacts.tobytes()
    assert run.final.tobytes() == other.final.tobytes()
    assert run.ending == other.ending == tuple(map(Ending, totals.ending))
    if "rolling_friction" in acts:
        assert {Ending.AT_REST, Ending.TIME_REACHED} <= set(run.ending)
    np.testing.assert_array_equal(totals.position, np.stack([run.final["x"], run.final["y"]], axis=1))
    np.testing.assert_array_equal(totals.velocity, np.stack([run.final["vx"], run.final["vy"]], axis=1))
    np.testing.assert_array_equal(totals.time, run.final["time"])
    np.testing.assert_array_equal(totals.bounces, run.bounces)
    assert totals.hits.sum() == len(run.contacts) > 65


def test_streams_slow_down_too():
    draw = RandomBalls((-4.0, -4.0, 4.0, 4.0), speed=9.0, seed=4)
    (totals,) = survey_stream(Scene(room(), rolling_friction=1.5), draw, 50, until=60.0)
    assert (totals.ending == Ending.AT_REST).all()
    np.testing.assert_allclose(totals.time, 6.0, rtol=1e-14)


@pytest.mark.parametrize("nothing", [{"rolling_friction": 0.0}, {"drag": 0.0}, {"drag": 1e-300}], ids=str)
def test_what_slows_nothing_down_is_not_there(nothing):
    scene = Scene(room(), many(3), **nothing)
    assert Modelled(scene).model.damping is None
    plain, run = simulate(Scene(room(), many(3)), until=5.0), simulate(scene, until=5.0)
    assert run.contacts.tobytes() == plain.contacts.tobytes()


@pytest.mark.parametrize("name", ["rolling_friction", "drag"])
def test_ever_less_of_it_is_ever_closer_to_none(name):
    plain = simulate(Scene(room(), many(3)), until=5.0)
    for much in (1e-9, 1e-15, 1e-100):
        run = simulate(Scene(room(), many(3), **{name: much}), until=5.0)
        np.testing.assert_allclose(run.final["x"], plain.final["x"], rtol=0, atol=1e4 * much + 1e-10)
        np.testing.assert_allclose(run.contacts["time"][:20], plain.contacts["time"][:20], rtol=1e2 * much + 1e-13)


@pytest.mark.parametrize("acts", ACTS, ids=str)
@pytest.mark.parametrize("compile", [False, True])
def test_frames_of_a_world_are_a_run_cut_up(acts, compile):
    scene = Scene(room(RUBBER), many(5, 0.5), **acts)
    world = World(scene, compile=compile)
    found = []
    for frame in range(90):
        found.append(world.step(0.1))
        if frame in (7, 40, 89):
            run = simulate(scene, until=world.time)
            contacts = np.concatenate(found)
            for name in contacts.dtype.names:
                np.testing.assert_array_equal(contacts[name], run.contacts[name])
            np.testing.assert_array_equal(world.position, run.position(world.time))
            np.testing.assert_array_equal(world.velocity, run.velocity(world.time))
    if "rolling_friction" in acts:
        assert set(run.ending) == {Ending.AT_REST}
        assert not world.velocity.any()
        world.place(0, velocity=(1.0, 0.0))
        world.step(0.1)
        assert world.velocity[0].tolist() == pytest.approx([0.7, 0.0], abs=1e-12)


def test_a_ball_that_is_caught_before_it_stops_stays_where_it_was_caught():
    wedge = Walls.from_polylines([[(0.0, 0.0), (9.0, 0.3), (9.0, -0.3)]], material=Material(0.3, 1.0))
    scene = Scene(wedge, Balls([8.0, 0.0], [-9.0, 1.0]), rolling_friction=0.01)
    run, world = simulate(scene, until=50.0), World(scene)
    assert run.ending == (Ending.COLLAPSE,)
    world.step(50.0)
    np.testing.assert_allclose(world.position, run.position(50.0), rtol=0, atol=1e-12)
    np.testing.assert_allclose(run.position(50.0)[0], [run.final["x"][0], run.final["y"][0]], rtol=0, atol=1e-12)


@pytest.mark.parametrize("acts", ACTS, ids=str)
def test_sensors_see_slowed_balls_when_they_pass(acts):
    lines = [[(10.0 * number, -1.0), (10.0 * number, 1.0)] for number in (1, 2, 3)]
    sensors = Walls.from_polylines(lines, closed=False)
    wall = Walls.from_polylines([[(40.0, -9.0), (40.0, 9.0)]], closed=False)
    plain = Scene(wall, Balls([0.0, 0.0], [16.0, 0.0], 2.0), **acts)
    run = simulate(Scene(wall, plain.balls, sensors=sensors, **acts), until=100.0)
    seen = run.contacts[run.contacts["kind"] >= ContactKind.ENTER]
    there = simulate(plain, until=100.0)
    assert seen["wall"].tolist()[:3] == [0, 1, 2]
    for crossing in seen:
        assert there.position(crossing["time"])[0, 0] == pytest.approx(crossing["x"], rel=1e-13)
        assert there.velocity(crossing["time"])[0, 0] == pytest.approx(crossing["vx"], rel=1e-12)


def test_two_that_slow_down_have_no_joint_closed_form():
    for acts in ({"rolling_friction": 1.0, "drag": 1.0}, {"drag": -1.0}):
        for begin in (lambda scene: simulate(scene, until=1.0), lambda scene: survey(scene, until=1.0), World):
            with pytest.raises(SceneError) as error:
                begin(Scene(FAR, many(1), **acts))
            assert error.value.code == "bad-damping"


@kernel
def _clock(damping, energy, part, span, out):
    t = free_time(damping, energy, span)
    out[0] = t
    out[1], out[2] = slowed(damping, energy, part * t, span)
    out[3], out[4], out[5], out[6] = last_flight(damping, energy, 0.5, 0.0, 0.5 + span)


positive = st.floats(1e-6, 1e6)


@example(drags=True, energy=1.0, much=0.5, part=5e-324, span=1.0)
@given(st.booleans(), positive, positive, st.floats(0.0, math.nextafter(1.0, 0.0)), positive | st.just(math.inf))
def test_the_clock_is_the_same_interpreted_and_compiled_and_right(drags, much, energy, part, span):
    damping = (0.0, much) if drags else (much, 0.0)
    one, other = [0.0] * 7, np.zeros(7)
    _clock(damping, energy, part, span, one)
    compiled(_clock)(np.array(damping), energy, part, span, other)
    assert one == other.tolist()
    free, passed, kept = one[:3]
    assert 0.0 <= passed <= span
    assert 0.0 < kept <= 1.0
    with mpmath.workdps(40):
        t, exact_span = mpmath.mpf(part * free), mpmath.mpf(span)
        if drags:
            exact_free = -mpmath.expm1(-much * exact_span) / much if span < math.inf else 1 / mpmath.mpf(much)
            left = 1 - much * t
            exact_passed, exact_kept = -mpmath.log1p(-much * t) / much, left
        else:
            stop = mpmath.sqrt(energy) / much
            rolls = min(exact_span, stop)
            exact_free = rolls * (1 - rolls / (2 * stop))
            left = 1 - 2 * t / stop
            exact_kept = mpmath.sqrt(left)
            exact_passed = 2 * t / (1 + exact_kept)
        doubt = 4 * 2.0**-53 / left  # what one rounding of t is worth, the closer to the stop the more
        assert abs(free - exact_free) <= 2.0**-49 * exact_free
        assert abs(kept - exact_kept) <= (doubt + 2.0**-51) * exact_kept
        least = 2.0**-1000  # products of subnormal numbers have no digits
        assert abs(passed - exact_passed) <= (doubt + 2.0**-50) * max(exact_passed, t) + least
