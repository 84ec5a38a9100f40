"""The ways to be wrong: each does what its sentence says, parts where it must, and tells what it flew through."""

import math
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from wallkit import Balls, ContactKind, Material, Scene, SceneError, Walls, World, simulate
from wallkit.accuracy import scenes
from wallkit.simulation.ways import MOST_FRAMES, flown_through, last_moment, partings, step_through

WRONG_WAYS = ("stop", "full-step", "reflect-in-place", "overlap")


def corridor(**about):
    """Two mirrors 10 apart in a box 10 by 100: what happens along x is arithmetic."""
    return Walls.from_polylines([[(0.0, -50.0), (0.0, 50.0)], [(10.0, -50.0), (10.0, 50.0)]], closed=False, **about)


def along_x(speed, radius=1.0, walls=None, **acts):
    return Scene(corridor() if walls is None else walls, Balls([(5.0, 0.0)], [(speed, 0.0)], radius), **acts)


def test_what_overlaps_at_the_end_of_a_frame_turns_the_ball_where_it_then_is():
    stepped = step_through(along_x(4.0), "overlap", 1.125, 3.375)
    # 5, then 9.5: half a unit into the wall at 10, so it turns there; then 5 and 0.5, into the wall at 0
    assert stepped.state[:, 0, 0].tolist() == [5.0, 9.5, 5.0, 0.5]
    assert stepped.state[:, 0, 2].tolist() == [4.0, -4.0, -4.0, 4.0]
    assert stepped.contacts["time"].tolist() == [1.125, 3.375]
    assert stepped.contacts["px"].tolist() == [10.0, 0.0]
    assert stepped.contacts["wall"].tolist() == [1, 0]


def test_a_disc_that_only_touches_overlaps_nothing():
    world = World(along_x(4.0), "overlap")
    assert len(world.step(1.0)) == 0  # at 9: its rim is on the wall
    assert world.velocity[0].tolist() == [4.0, 0.0]


@pytest.mark.parametrize(("end", "through"), [(9.5, False), (10.5, True)])
def test_a_ball_whose_centre_a_frame_puts_beyond_the_wall_flies_on(end, through):
    scene = along_x((end - 5.0) / 0.5)
    stepped = step_through(scene, "overlap", 0.5, 0.5)
    assert stepped.state[-1, 0, 0] == end
    assert (stepped.state[-1, 0, 2] > 0.0) == through  # beyond, the wall's normal towards the ball points onwards
    assert bool(flown_through(stepped)) == through


def test_a_point_flies_through_everything_under_the_overlap_test():
    stepped = step_through(along_x(1.0, radius=0.0), "overlap", 1.0, 8.0)
    assert stepped.state[-1, 0].tolist() == [13.0, 0.0, 1.0, 0.0]
    (through,) = flown_through(stepped)  # though it stood on the line at the end of a frame
    assert (through.time, through.place, through.wall, through.lost) == (5.0, (10.0, 0.0), 1, True)


def test_gravity_and_restitution_act_on_what_overlaps():
    floor = Walls.from_polylines([[(-9.0, 0.0), (9.0, 0.0)]], closed=False, material=Material(0.5, 0.25))
    scene = Scene(floor, Balls([(0.0, 2.0)], [(4.0, 0.0)], 1.0), gravity=(0.0, -8.0))
    world = World(scene, "overlap")
    world.step(0.625)
    # y = 2 - 4 dt^2 = 0.4375 < 1, v = (4, -5): along the floor a quarter is left, across it a half
    assert world.position[0].tolist() == [2.5, 0.4375]
    assert world.velocity[0].tolist() == [1.0, 2.5]


@pytest.mark.parametrize("sides", ["both", "outward"])
def test_round_walls_turn_a_ball_along_their_radius(sides):
    ring = Walls.from_polylines([[(-3.0, 0.0), (3.0, 0.0)]], bulges=[[1.0, 1.0]], sides=sides)
    world = World(Scene(ring, Balls([(6.0, 8.0)], [(-3.0, -4.0)], 1.0)), "overlap")
    (contact,) = world.step(1.25)  # at 3.75 from the middle, 0.75 from the ring, along (3, 4)
    assert (contact["kind"], contact["wall"]) == (ContactKind.EDGE, 0)
    assert (contact["nx"], contact["ny"]) == pytest.approx((0.6, 0.8))
    assert world.velocity[0].tolist() == pytest.approx([3.0, 4.0])


def test_a_wall_that_is_solid_from_outside_alone_may_be_left():
    pad = Walls.from_polylines([[(-3.0, -3.0), (3.0, -3.0), (3.0, 3.0), (-3.0, 3.0)]], sides="outward")
    world = World(Scene(pad, Balls([(0.0, 0.0)], [(5.0, 0.0)], 1.0)), "overlap")
    assert len(world.step(0.5)) == 0  # within the wall, on its way out
    assert len(step_through(Scene(pad, Balls([(0.0, 0.0)], [(5.0, 0.0)], 1.0)), "overlap", 0.5, 5.0).contacts) == 0
    assert flown_through(step_through(Scene(pad, Balls([(0.0, 0.0)], [(5.0, 0.0)], 1.0)), "overlap", 2.0, 4.0)) == []


@example(vx=37, vy=0, dt=1 / 64)
@settings(max_examples=20, deadline=None)
@given(vx=st.integers(-40, 40), vy=st.integers(-40, 40), dt=st.sampled_from([1 / 64, 1 / 8, 1 / 4]))
def test_in_a_box_the_overlap_test_is_the_four_comparisons_of_a_first_game(vx, vy, dt):
    walls = Walls.from_polylines([[(0.0, 0.0), (64.0, 0.0), (64.0, 32.0), (0.0, 32.0)]])
    stepped = step_through(Scene(walls, Balls([(30.0, 11.0)], [(float(vx), float(vy))], 2.0)), "overlap", dt, 16.0)
    x, y, u, v = Fraction(30), Fraction(11), Fraction(vx), Fraction(vy)
    for frame in range(1, len(stepped.time)):
        x, y = x + u * Fraction(dt), y + v * Fraction(dt)
        if not (0 <= x <= 64 and 0 <= y <= 32):  # beyond a wall; up to there the four comparisons are all
            break
        u = abs(u) if x < 2 else -abs(u) if x > 62 else u
        v = abs(v) if y < 2 else -abs(v) if y > 30 else v
        assert stepped.state[frame, 0].tolist() == [float(x), float(y), float(u), float(v)]


def test_sensors_are_told_in_frames_of_the_overlap_test_too():
    line = Walls.from_polylines([[(7.0, -50.0), (7.0, 50.0)]], closed=False)
    world = World(along_x(4.0, sensors=line), "overlap")
    (crossing,) = world.step(0.75)
    assert (crossing["time"], crossing["x"], crossing["kind"]) == (0.5, 7.0, ContactKind.EXIT)


def test_a_kicked_ball_goes_on_from_there():
    world = World(along_x(4.0), "overlap")
    world.step(0.25)
    world.place(0, position=(3.0, 1.0), velocity=(0.0, 2.0))
    world.step(0.5)
    assert world.position[0].tolist() == [3.0, 2.0]


@pytest.mark.parametrize("dt", [0.01, 1 / 60, 0.3])
@pytest.mark.parametrize("radius", [0.0, 4.0])
def test_frames_of_the_exact_way_never_part(dt, radius):
    scene = Scene(scenes.star(), Balls([(3.0, -7.0), (10.0, 20.0)], [(43.0, 24.0), (-30.0, 12.0)], radius))
    stepped = step_through(scene, "exact", dt, 12.0)
    run = simulate(scene, until=12.0)
    assert partings(run, stepped) == []
    assert np.array_equal(stepped.state[:, :, 0:2], run.position(stepped.time))


def test_stopping_at_a_wall_parts_by_the_rest_of_the_frame():
    scene = along_x(4.0)
    stepped = step_through(scene, "stop", 0.75, 6.0)
    (parting,) = partings(simulate(scene, until=6.0), stepped)
    # met at 9 after 1 s; the frame ends at 1.5 with the exact ball at 7: 2 off, and 1 % of the scene's 100 is 1
    assert (parting.ball, parting.time, parting.place, parting.exact) == (0, 1.5, (9.0, 0.0), (7.0, 0.0))
    assert parting.distance == 2.0
    assert flown_through(stepped) == []


def test_a_full_step_goes_through_what_is_behind_the_contact():
    stepped = step_through(along_x(100.0), "full-step", 0.2, 0.3)
    (through,) = flown_through(stepped)  # from 9 a whole step of 20 back, through the wall at 0
    assert (through.ball, through.time, through.wall, through.lost) == (0, 0.2, 0, True)
    assert through.place == pytest.approx((0.0, 0.0), abs=1e-12)


def test_turning_in_place_goes_through_what_is_behind_the_start():
    (through,) = flown_through(step_through(along_x(100.0), "reflect-in-place", 0.2, 0.3))
    assert (through.wall, through.lost) == (0, True)


@pytest.mark.parametrize("way", ["stop", "exact"])
@pytest.mark.parametrize("radius", [0.0, 5.0])
def test_these_two_go_through_nothing(way, radius):
    scene = Scene(scenes.star(), Balls([(3.0, -7.0)], [(5000.0, 2345.0)], radius))
    stepped = step_through(scene, way, 0.05, 10.0)
    assert flown_through(stepped) == []
    assert np.hypot(*stepped.state[:, 0, 0:2].T).max() < 200.0


@pytest.mark.parametrize("way", WRONG_WAYS)
def test_shorter_frames_part_later_or_never(way):
    scene = Scene(scenes.stadium(), Balls([(3.0, -7.0)], [(43.0, 24.0)], 4.0))
    run = simulate(scene, until=30.0)
    times = []
    for dt in (0.4, 0.02, 0.002):
        found = partings(run, step_through(scene, way, dt, 30.0))
        times.append(found[0].time if found else math.inf)
    assert times == sorted(times)
    assert times[0] < times[-1]


def test_a_run_that_ended_at_its_bounces_is_not_compared_beyond():
    scene = along_x(4.0)
    run = simulate(scene, bounces=0)
    assert partings(run, step_through(scene, "stop", 0.75, 6.0)) == []


@pytest.mark.parametrize("gravity", [None, (0.0, -8.0)])
def test_a_ball_that_leaves_is_compared_beyond_its_last_contact(gravity):
    floor = Walls.from_polylines([[(-100.0, 0.0), (100.0, 0.0)]], closed=False)
    scene = Scene(floor, Balls([(0.0, 60.0)], [(50.0, -40.0)], 10.0), gravity=gravity)
    run = simulate(scene, bounces=9)
    until = last_moment(run)
    assert partings(run, step_through(scene, "exact", 0.25, until)) == []
    if gravity is None:  # met at 1.25 s, left for good; stopped for the rest of a frame that ends at 2 s
        assert until == pytest.approx(1.25 + 200.0 / math.hypot(50.0, 40.0))
        (parting,) = partings(run, step_through(scene, "stop", 2.0, until))
        assert (parting.time, parting.place, parting.exact) == (2.0, (62.5, 10.0), (100.0, 40.0))


def test_a_frame_is_shown_until_the_next_one():
    stepped = step_through(along_x(4.0), "stop", 0.5, 2.0)
    assert stepped.shown([0.0, 0.49, 0.5, 0.99, 9.0])[:, 0, 0].tolist() == [5.0, 5.0, 7.0, 7.0, 5.0]


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("magic", 0.1, 1.0), "way is"),
        (("stop", 0.0, 1.0), "dt is"),
        (("stop", math.nan, 1.0), "dt is"),
        (("stop", 0.1, -1.0), "until is"),
        (("stop", 1e-300, 1e300), "frames"),
        (("stop", 1.0, float(MOST_FRAMES)), "frames"),
    ],
)
def test_what_cannot_be_stepped_is_refused(arguments, words):
    with pytest.raises(SceneError, match=words):
        step_through(along_x(4.0), *arguments)


@pytest.mark.parametrize("way", WRONG_WAYS)
def test_balls_that_meet_are_known_to_the_exact_way_alone(way):
    scene = along_x(4.0, meeting=True)
    with pytest.raises(SceneError, match="balls meet"):
        step_through(scene, way, 0.1, 1.0)
