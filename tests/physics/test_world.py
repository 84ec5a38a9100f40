"""World: the exact way is ``simulate`` cut into frames; the classic ways do what their names say."""

import math
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from wallkit import Balls, ContactKind, Material, Scene, SceneError, Walls, World, simulate
from wallkit.accuracy import scenes

FORWARD = (50 * math.cos(0.5), 50 * math.sin(0.5))


def corridor():
    """Two mirrors 10 apart: what happens along x is arithmetic."""
    return Walls.from_polylines([[(0.0, -50.0), (0.0, 50.0)], [(10.0, -50.0), (10.0, 50.0)]], closed=False)


def one_ball(way, velocity=(4.0, 0.0), position=(5.0, 0.0), radius=1.0):
    return World(Scene(corridor(), Balls([position], [velocity], radius)), way)


@pytest.mark.parametrize("radius", [0.0, 5.0])
@pytest.mark.parametrize("dt", [1 / 60, 0.37, 11.0])
def test_the_exact_way_is_simulate_cut_into_frames(radius, dt):
    start = np.array([[3.0, -7.0], [10.0, 20.0], [-30.0, 5.0]])
    velocity = np.array([FORWARD, (-30.0, 12.0), (0.0, 41.0)])
    scene = Scene(scenes.star(), Balls(start, velocity, np.full(3, radius)))
    world = World(scene)
    frames = [world.step(dt) for _ in range(math.ceil(20 / dt))]
    run = simulate(scene, until=world.time)
    found = np.concatenate(frames)
    for name in run.contacts.dtype.names:
        assert np.array_equal(found[name], run.contacts[name]), name
    assert np.array_equal(world.position, run.position(world.time))
    assert np.array_equal(world.velocity, run.velocity(world.time))


@settings(max_examples=25)
@given(steps=st.lists(st.floats(0.0, 3.0), max_size=12))
def test_how_time_is_cut_changes_no_contact(steps):
    scene = Scene(scenes.star(), Balls([(3.0, -7.0)], [FORWARD], 5.0))
    world = World(scene)
    found = [world.step(dt) for dt in steps]
    run = simulate(scene, until=world.time)
    assert sum(len(part) for part in found) == len(run.contacts)
    if len(run.contacts):
        assert np.array_equal(np.concatenate(found)["x"], run.contacts["x"])


@pytest.mark.parametrize(
    ("way", "x"),
    [
        # radius 1: from 5 the wall is met at 9 after 1 s; the frame lasts 1.5 s, velocity 4 and then -4
        ("exact", 9.0 - 4 * 0.5),
        ("stop", 9.0),
        ("full-step", 9.0 - 4 * 1.5),
        ("reflect-in-place", 5.0 - 4 * 1.5),
    ],
)
def test_the_four_ways_in_one_frame(way, x):
    world = one_ball(way)
    contacts = world.step(1.5)
    assert world.position[0].tolist() == [x, 0.0]
    assert world.velocity[0].tolist() == [-4.0, 0.0]
    assert contacts["time"].tolist() == [1.0]
    assert contacts["px"].tolist() == [10.0]


@pytest.mark.parametrize("way", ["exact", "stop"])
def test_these_two_never_leave_the_room(way):
    balls = scenes.star(), Balls([(3.0, -7.0)], [(5000.0, 2345.0)], 5.0)
    world = World(Scene(*balls), way)
    for _ in range(300):
        world.step(0.05)
    assert np.hypot(*world.position[0]) < 200.0


def test_a_full_step_jumps_through_what_is_behind():
    world = one_ball("full-step", velocity=(100.0, 0.0))
    world.step(0.2)  # met at 9 after 0.04 s, then a whole step of 20 to the left, through the wall at 0
    assert world.position[0, 0] == -11.0


def test_stopping_at_contacts_makes_balls_late():
    # Frames of 0.75 s in a corridor 8 wide at 4/s: each crossing takes 2 s, and is cut to whole frames: 2.25 s.
    world = one_ball("stop")
    for _ in range(40):
        world.step(0.75)
    # the first in frame 2, then one in every third: 13 by frame 38, then two frames of 3 back from the wall at 9
    assert world.position[0].tolist() == [3.0, 0.0]
    exact = one_ball("exact")
    contacts = [exact.step(0.75) for _ in range(40)]
    assert sum(map(len, contacts)) == 15  # at 1, 3, 5, ... 29 s


def test_a_kick_counts_from_now_on():
    world = one_ball("exact")
    world.step(0.5)
    assert world.position[0].tolist() == [7.0, 0.0]
    world.place(0, velocity=(-2.0, 1.0))
    world.step(1.0)
    assert world.position[0].tolist() == [5.0, 1.0]
    world.place(0, position=(2.0, 0.0))
    assert len(world.step(1.0)) == 1  # at 1 after half a second
    assert world.position[0].tolist() == [2.0, 1.0]


@pytest.mark.parametrize("radius", [0.0, 1.0])
def test_a_kick_into_the_wall_it_touches_is_turned(radius):
    world = one_ball("stop", radius=radius)
    world.step(1.5)
    assert world.position[0, 0] == 10.0 - radius
    world.place(0, velocity=(4.0, 1.0))
    assert world.velocity[0].tolist() == [-4.0, 1.0]
    world.step(1.0)
    assert world.position[0].tolist() == [6.0 - radius, 1.0]


def test_compiled_frames_give_the_same_bits():
    scene = Scene(scenes.star(), Balls([(3.0, -7.0)], [FORWARD], 5.0))
    plain, fast = World(scene), World(scene, compile=True)
    for _ in range(100):
        assert np.array_equal(plain.step(0.1), fast.step(0.1))
    assert np.array_equal(plain.position, fast.position)


def test_a_ball_without_walls_flies_on():
    world = World(
        Scene(Walls.from_polylines([[(0.0, 0.0), (1.0, 0.0)]], closed=False), Balls([(0.0, 1.0)], [(1.0, 1.0)]))
    )
    assert len(world.step(1e6)) == 0
    assert world.position[0].tolist() == [1e6, 1e6 + 1]


@pytest.mark.parametrize("dt", [-1.0, math.nan, math.inf])
def test_a_step_that_is_no_time_is_refused(dt):
    with pytest.raises(SceneError, match="dt is"):
        one_ball("exact").step(dt)


def test_ways_are_named_in_the_error():
    with pytest.raises(SceneError, match="reflect-in-place"):
        one_ball("magic")


def test_a_ball_cannot_be_put_nowhere():
    with pytest.raises(SceneError, match="is "):
        one_ball("exact").place(0, position=(math.nan, 0.0))


def test_many_frames_lose_no_time():
    world = one_ball("exact", velocity=(0.0, 0.0))
    for _ in range(10_000):
        world.step(1 / 60)
    assert world.time == float(10_000 * Fraction(1 / 60))


def test_gravity_rest_and_sliding_are_those_of_simulate():
    room = Walls.from_polylines([[(0.0, 0.0), (0.0, 8.0), (12.0, 8.0), (12.0, 0.0)]], material=Material(0.6, 0.9))
    ramp = Walls.from_polylines([[(1.0, 3.0), (6.0, 1.0)]], closed=False, material=Material(0.3, 1.0))
    walls = Walls.from_polylines(
        [room.vertices, ramp.vertices], closed=[True, False], material=[room.materials[0], ramp.materials[0]]
    )
    balls = Balls([(2.0, 5.0), (9.0, 3.0)], [(0.0, 0.0), (3.0, 2.0)], [0.2, 0.0])
    scene = Scene(walls, balls, gravity=(0.0, -9.81))
    world = World(scene)
    found = np.concatenate([world.step(0.1) for _ in range(300)])
    run = simulate(scene, until=world.time)
    assert {kind.label for kind in map(ContactKind, found["kind"])} >= {"edge", "slide"}
    for name in found.dtype.names:
        assert np.array_equal(found[name], run.contacts[name]), name
    assert np.array_equal(world.position, run.position(world.time))
    assert np.allclose(world.velocity, run.velocity(world.time), atol=1e-12)


def test_between_contacts_a_ball_falls_on_a_parabola():
    floor = Walls.from_polylines([[(-5.0, 0.0), (5.0, 0.0)]], closed=False)
    world = World(Scene(floor, Balls([(0.0, 5.0)], [(1.0, 0.0)]), gravity=(0.0, -2.0)))
    world.step(1.5)
    assert world.position[0].tolist() == [1.5, 5.0 - 1.5**2]
    assert world.velocity[0].tolist() == [1.0, -3.0]
    world.place(0, velocity=(0.0, 0.0))
    world.step(1.0)
    assert world.position[0].tolist() == [1.5, 5.0 - 1.5**2 - 1.0]


@pytest.mark.parametrize(
    "acts",
    [{}, {"gravity": (0.0, -9.81)}, {"rolling_friction": 0.7}, {"drag": 0.2}],
    ids=lambda acts: next(iter(acts), ""),
)
@pytest.mark.parametrize("dt", [0.1, 3.0])
def test_frames_report_what_crosses_a_sensor_as_a_run_does(acts, dt):
    room = Walls.from_polylines([[(0.0, 0.0), (0.0, 8.0), (12.0, 8.0), (12.0, 0.0)]], material=Material(0.9, 1.0))
    sensors = Walls.from_polylines(
        [[(3.0, 0.0), (3.0, 8.0)], [(5.0, 2.0), (8.0, 2.0), (8.0, 5.0)]], closed=[False, True]
    )
    scene = Scene(room, Balls([(2.0, 5.0), (9.0, 3.0)], [(7.0, 1.0), (-6.0, 2.0)], [0.2, 0.0]), sensors=sensors, **acts)
    world = World(scene)
    found = np.concatenate([world.step(dt) for _ in range(round(15.0 / dt))])
    run = simulate(scene, until=world.time)
    assert {ContactKind.EDGE, ContactKind.ENTER, ContactKind.EXIT} <= set(found["kind"])
    assert set(found["wall"][found["kind"] >= ContactKind.ENTER]) == {0, 1}
    for name in found.dtype.names:
        assert np.array_equal(found[name], run.contacts[name]), name


def test_a_kicked_ball_crosses_sensors_on_its_new_way():
    sensors = Walls.from_polylines([[(7.0, -50.0), (7.0, 50.0)]], closed=False)
    world = World(Scene(corridor(), Balls([(5.0, 0.0)], [(4.0, 0.0)], 1.0), sensors=sensors))
    assert len(world.step(0.25)) == 0
    world.place(0, velocity=(0.0, 1.0))
    assert len(world.step(1.0)) == 0
    world.place(0, velocity=(2.0, 0.0))
    (crossing,) = world.step(1.0)
    assert (crossing["time"], crossing["x"], crossing["kind"]) == (1.75, 7.0, ContactKind.EXIT)
