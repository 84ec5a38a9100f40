"""Balls that keep to straight walls under gravity: they slide, pass joints, pivot about ends, fly off: closed forms."""

import math

import numpy as np
import pytest

from wallkit import Balls, Ending, Material, Scene, Walls, World, simulate
from wallkit.simulation.run import ContactKind

G = 100.0
DOWN = (0.0, -G)


def walls(*lines, closed=False, restitution=0.5, tangential=1.0, **how):
    return Walls.from_polylines(lines, closed=closed, material=Material(restitution, tangential), **how)


def ramp(pieces):
    """A slope of 3 in 4 from (0, 300) to (400, 0), in as many pieces, of unequal length."""
    parts = np.concatenate([[0.0], np.sort(np.random.default_rng(pieces).uniform(0.02, 0.98, pieces - 1)), [1.0]])
    return np.stack([400.0 * parts, 300.0 * (1.0 - parts)], axis=1)


@pytest.mark.parametrize("pieces", [1, 2, 3, 50])
@pytest.mark.parametrize("radius", [0.0, 5.0])
@pytest.mark.parametrize("restitution", [0.0, 0.5])
def test_a_ramp_ends_in_the_same_state_in_however_many_pieces_it_is_drawn(pieces, radius, restitution):
    # let go in touch with it: nothing is lost, v^2 = 2 g h at the end, along the slope
    start = np.array([40.0, 270.0]) + radius * np.array([0.6, 0.8])
    scene = Scene(walls(ramp(pieces), restitution=restitution), Balls(start, [0.0, 0.0], radius), gravity=DOWN)
    run = simulate(scene, until=6.0)
    leaves = run.contacts[run.contacts["kind"] == ContactKind.LEAVE]
    assert len(leaves) == 1
    speed = math.sqrt(2.0 * G * 270.0)
    # a joint of 50 is off its place by 1e-13, and what it turns the ball by is that of its length
    np.testing.assert_allclose([leaves["vx"][0], leaves["vy"][0]], [0.8 * speed, -0.6 * speed], rtol=1e-12)
    assert leaves["time"][0] == pytest.approx(speed / (0.6 * G), rel=1e-12)
    end = np.array([400.0, 0.0]) + radius * np.array([0.6, 0.8])
    np.testing.assert_allclose([leaves["x"][0], leaves["y"][0]], end, atol=1e-10)
    assert np.count_nonzero(run.contacts["kind"] == ContactKind.SLIDE) == np.count_nonzero(ramp(pieces)[1:, 0] > 40.0)


@pytest.mark.parametrize("slope", [0.5, 2.0, 8.0])
@pytest.mark.parametrize("restitution", [0.8, 0.5, 0.0])
def test_every_marble_on_a_run_of_straight_shelves_reaches_the_floor(slope, restitution):
    width, height, gap = 400.0, 600.0, 60.0
    drop = math.tan(math.radians(slope)) * (width - gap)
    lines = [[[0, 0], [0, height], [width, height], [width, 0]]]
    for k in range(6):
        y = height - 100 - k * 80
        lines.append([[0, y], [width - gap, y - drop]] if k % 2 == 0 else [[width, y], [gap, y - drop]])
    level = walls(*lines, closed=[True] + [False] * 6, restitution=restitution)
    x = np.linspace(30, 200, 20)
    balls = Balls(np.stack([x, np.full(20, height - 60)], axis=1), np.zeros((20, 2)), 8.0)
    run = simulate(Scene(level, balls, gravity=(0.0, -300.0)), until=600.0, mode="interpreted")
    assert run.final["y"] == pytest.approx(np.full(20, 8.0), abs=1e-9)
    assert set(run.ending) <= {Ending.TIME_REACHED, Ending.AT_REST}


def table(speed, radius, gravity=300.0):
    """A disc that runs along a level platform, over its end."""
    top = walls([[100, 100], [-100, 100]])
    return simulate(Scene(top, Balls([0.0, 100 + radius], [speed, 0.0], radius), gravity=(0.0, -gravity)), until=300.0)


@pytest.mark.parametrize("speed", [0.5, 5.0, 20.0, 35.0, 45.0, 48.9])
def test_a_slow_disc_pivots_about_the_end_of_a_table_and_leaves_it_where_nothing_presses_it(speed):
    g, r = 300.0, 8.0
    leave = table(speed, r).contacts[-1]
    assert (leave["kind"], leave["edge"]) == (ContactKind.LEAVE, -1)
    cosine = 2.0 / 3.0 + speed * speed / (3.0 * g * r)  # of the angle from the top: v^2 = g r cos
    assert leave["ny"] == pytest.approx(cosine, abs=1e-13)
    assert math.hypot(leave["vx"], leave["vy"]) == pytest.approx(math.sqrt(g * r * cosine), rel=1e-13)


@pytest.mark.parametrize("speed", [49.0, 60.0, 300.0])
def test_a_fast_disc_leaves_the_end_of_a_table_at_once(speed):
    contacts = table(speed, 8.0).contacts  # v^2 >= g r = 2400; laid on the table, it slides from the start: no bounce
    assert contacts["kind"].tolist() == [ContactKind.SLIDE, ContactKind.LEAVE]
    assert contacts["x"][-1] == pytest.approx(100.0, abs=1e-12)


def test_no_disc_freezes_at_the_end_of_a_table_whatever_its_speed():
    for speed in np.linspace(0.3, 60.0, 100):
        run = table(float(speed), 5.0)
        assert run.ending == (Ending.TIME_REACHED,) or run.ending == (Ending.LEFT_SCENE,)
        assert len(run.contacts) <= 5


@pytest.mark.parametrize("radius", [0.0, 4.0])
@pytest.mark.parametrize("restitution", [0.0, 0.3])
def test_a_valley_takes_the_normal_part_of_the_speed_by_the_restitution_of_its_other_side(radius, restitution):
    # down 3 in 4 on to a level floor: v along the slope; after the bounce the part along the floor is whole
    line = [[-400, 300], [0, 0], [4000, 0]]
    level = walls(line, restitution=restitution)
    start = np.array([-200.0, 150.0]) + radius * np.array([0.6, 0.8])
    run = simulate(Scene(level, Balls(start, [0.0, 0.0], radius), gravity=DOWN), until=20.0)
    bounce = run.contacts[run.contacts["kind"] == ContactKind.EDGE][0]
    speed = math.sqrt(2.0 * G * (start[1] - bounce["y"]))
    assert bounce["vx"] == pytest.approx(0.8 * speed, rel=1e-12)
    assert bounce["vy"] == pytest.approx(restitution * 0.6 * speed, abs=1e-9)
    slides = run.contacts[run.contacts["kind"] == ContactKind.SLIDE]
    assert slides["vx"][-1] == pytest.approx(0.8 * speed, rel=1e-12)
    assert slides["ny"][-1] == 1.0


@pytest.mark.parametrize("radius", [0.0, 4.0])
def test_a_wall_across_a_slope_sends_a_ball_back_up_until_it_rests_between_the_two(radius):
    # each time with half the speed: it is at rest after t (1 + 2 e / (1 - e)), t the time down
    level = walls([[-400, 300], [0, 0], [150, 200]], restitution=0.5)
    start = np.array([-400.0, 300.0]) / 2 + radius * np.array([0.6, 0.8])
    run = simulate(Scene(level, Balls(start, [0.0, 0.0], radius), gravity=DOWN), until=20.0)
    way = 250.0 - radius
    assert run.ending == (Ending.AT_REST,)
    assert run.final["time"][0] == pytest.approx(math.sqrt(2.0 * way / (0.6 * G)) * 3.0, abs=1e-4)
    rest = radius * np.array([0.6 - 0.8, 0.8 + 0.6])
    np.testing.assert_allclose([run.final["x"][0], run.final["y"][0]], rest, atol=1e-8)


def test_a_ball_with_loss_along_the_wall_rests_on_no_slope():
    level = walls([[-400, 300], [400, -300]], restitution=0.5, tangential=0.9)
    run = simulate(Scene(level, Balls([-200.0, 160.0], [0.0, 0.0], 5.0), gravity=DOWN), until=3.0)
    assert run.ending == (Ending.TIME_REACHED,)
    begun = run.contacts[run.contacts["kind"] == ContactKind.SLIDE][-1]
    assert (begun["vx"], begun["vy"]) == (0.0, 0.0)  # the bounces have taken all, and it starts anew
    fallen = 0.5 * 0.6 * G * (3.0 - begun["time"]) ** 2
    moved = math.hypot(run.final["x"][0] - begun["x"], run.final["y"][0] - begun["y"])
    assert moved == pytest.approx(fallen, rel=1e-12)


@pytest.mark.parametrize(("friction", "ending"), [(0.76, Ending.AT_REST), (0.74, Ending.TIME_REACHED)])
@pytest.mark.parametrize("radius", [0.0, 5.0])
def test_static_friction_holds_a_ball_on_a_slope_of_no_more_than_its_coefficient(friction, ending, radius):
    slope = Walls.from_polylines([[[-400, 300], [400, -300]]], closed=False, material=Material(0.5, 0.9, friction))
    run = simulate(Scene(slope, Balls([-200.0, 160.0], [0.0, 0.0], radius), gravity=DOWN), until=4.0)
    assert run.ending == (ending,)


def test_static_friction_holds_a_ball_that_turns_on_a_slope_and_lets_one_pass_that_moves():
    valley = Walls.from_polylines(
        [[[-400, 300], [0, 0], [400, 0], [1200, 80]]], closed=False, material=Material(0.0, 1.0, 0.2)
    )
    run = simulate(Scene(valley, Balls([-40.0, 30.0], [-1e-3, 0.0], 0.0), gravity=DOWN), until=60.0)
    # down 3 in 4, steeper than it holds; on over the floor; up 1 in 10 to where v^2 = 2 g h, and held there
    assert run.ending == (Ending.AT_REST,)
    assert run.final["x"][0] > 400.0
    bounce = run.contacts[run.contacts["kind"] == ContactKind.SLIDE][1]
    speed = math.hypot(bounce["vx"], bounce["vy"]) * (10.0 / math.sqrt(101.0))  # less the normal part at the next joint
    assert run.final["y"][0] == pytest.approx(speed * speed / (2.0 * G), rel=1e-9)


@pytest.mark.parametrize(("radius", "height"), [(0.0, 87.5), (5.0, 82.5)])
@pytest.mark.parametrize("tangential", [1.0, 0.9])
def test_a_ball_that_a_dead_ceiling_has_stopped_falls_from_it(radius, height, tangential):
    room = walls([[0, 0], [0, 100], [100, 100], [100, 0]], closed=True, restitution=0.0, tangential=tangential)
    run = simulate(Scene(room, Balls([50.0, 50.0], [3.0, 200.0], radius), gravity=DOWN), until=10.0)
    hit = (200.0 - math.sqrt(200.0**2 - 2.0 * G * (50.0 - radius))) / G
    assert run.contacts["time"][0] == pytest.approx(hit, rel=1e-13)
    assert run.position(hit + 0.5)[0, 1] == pytest.approx(height, abs=1e-10)


def test_what_is_left_of_a_speed_that_a_dead_wall_has_taken_straight_on_is_nothing():
    for angle in np.linspace(0.1, 6.2, 40):
        n = np.array([math.cos(angle), math.sin(angle)])
        t = np.array([-n[1], n[0]])
        wall = walls([30 * n + 100 * t, 30 * n - 100 * t], restitution=0.0)
        run = simulate(Scene(wall, Balls([0.0, 0.0], 7.3 * n)), bounces=5)
        assert run.ending == (Ending.AT_REST,)
        assert len(run.contacts) == 1


@pytest.mark.parametrize("radius", [0.0, 0.5])
def test_a_kick_moves_a_ball_that_rests_on_the_floor(radius):
    world = World(Scene(walls([[-100, 0], [100, 0]]), Balls([0.0, 1.0 + radius], [0.0, 0.0], radius), gravity=(0, -10)))
    for _frame in range(300):
        world.step(1 / 60)
    np.testing.assert_array_equal(world.velocity, [[0.0, 0.0]])
    world.place(0, velocity=(30.0, -1.0))  # into the floor: turned at once
    world.step(0.125)
    np.testing.assert_allclose(world.position, [[3.75, radius + 0.125 - 5 * 0.125**2]], atol=1e-13)
    for _frame in range(120):
        world.step(1 / 60)
    world.place(0, velocity=(-8.0, 0.0))  # along it: it slides
    before = world.position[0]
    world.step(0.5)
    np.testing.assert_allclose(world.position[0], before - np.array([4.0, 0.0]), atol=1e-12)
    np.testing.assert_array_equal(world.velocity, [[-8.0, 0.0]])


def test_a_point_that_starts_on_a_floor_with_a_velocity_into_it_bounces_as_a_disc_does():
    for radius in (0.0, 0.5):
        scene = Scene(walls([[-100, 0], [100, 0]]), Balls([0.0, radius], [3.0, -4.0], radius), gravity=(0.0, -10.0))
        contact = simulate(scene, until=0.3).contacts[0]
        assert (contact["time"], contact["vx"], contact["vy"]) == (0.0, 3.0, 2.0)
