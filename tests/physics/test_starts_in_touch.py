"""Balls that are laid on a wall, or come down along one, where it goes over smoothly into an arc."""

from __future__ import annotations

import math

import numpy as np
import pytest

from wallkit import Balls, ContactKind, Material, Scene, Walls, World, simulate, survey
from wallkit.accuracy.contact_scenes import touching_scene
from wallkit.accuracy.reference_contact import ContactReference

G = 9.81


def half_pipe(radius, height, material, *, pieces=1, turned=False, shift=(0.0, 0.0)):
    """An upright half pipe about ``shift``, its arc in one or two pieces, drawn either way round."""
    middle = [(0.0, -radius)] if pieces == 2 else []
    points = np.array([(-radius, height), (-radius, 0.0), *middle, (radius, 0.0), (radius, height)]) + shift
    bulges = [0.0, *[math.tan(math.pi / (4 * pieces))] * pieces, 0.0, 0.0]
    if turned:
        points, bulges = points[::-1], [*(-np.array(bulges[-2::-1])), 0.0]
    return Walls.from_polylines([points], closed=[False], bulges=[bulges], material=[material])


def beyond(run, pipe, disc, height, shift):
    """How far a disc's centre came out of what it has of a half pipe, at its contacts and at the end."""
    contacts, final = run.contacts, run.final
    x = np.append(contacts["x"], final["x"]) - shift[0]
    y = np.append(contacts["y"], final["y"]) - shift[1]
    off = np.where(y < 0.0, np.hypot(x, y), np.where(y <= height, abs(x), 0.0))
    return float(off.max()) - (pipe - disc)


@pytest.mark.parametrize("seed", range(60))
def test_a_disc_that_starts_along_a_side_of_a_half_pipe_stays_in_it(seed):
    random = np.random.default_rng(seed)
    pipe, disc, height = random.uniform(1.0, 5.0), random.choice([0.1, 0.3, 0.5]), random.uniform(0.5, 4.0)
    shift = random.uniform(-3.0, 3.0, 2)
    material = Material(random.choice([0.0, 0.4, 1.0, random.random()]), random.choice([1.0, 0.9, 0.3]))
    walls = half_pipe(pipe, height, material, pieces=int(random.integers(1, 3)), turned=seed % 2 == 1, shift=shift)
    side, speed = random.choice([-1.0, 1.0]), random.choice([0.0, -1.0, 1.0]) * random.uniform(0.1, 5.0)
    drop = random.uniform(0.01, 0.99) * height
    balls = Balls([(shift[0] + side * (pipe - disc), shift[1] + drop)], [(0.0, speed)], disc)
    run = simulate(Scene(walls, balls, gravity=(0.0, -G)), until=3.0, mode="interpreted")
    # Places are some 10 across: 64 roundings of that are 7e-14 (see TOLERANCE), under gravity 64 times as much.
    assert beyond(run, pipe, disc, height, shift) < 5e-12


@pytest.mark.parametrize("tangential", [1.0, 0.9, 0.3])
@pytest.mark.parametrize("restitution", [0.0, 0.5, 1.0])
@pytest.mark.parametrize("pieces", [1, 2])
@pytest.mark.parametrize("speed", [0.0, -2.0, 1.0])
def test_a_disc_comes_to_the_bottom_of_a_half_pipe_with_all_its_energy(speed, pieces, restitution, tangential):
    pipe, disc, drop = 4.80526374, 0.2, 1.9
    walls = half_pipe(pipe, 2.9, Material(restitution, tangential), pieces=pieces)
    balls = Balls([(pipe - disc, drop)], [(0.0, speed)], disc)
    run = simulate(Scene(walls, balls, gravity=(0.0, -G)), until=3.0, mode="interpreted")
    assert set(run.contacts["kind"]) == {ContactKind.SLIDE}  # no bounce, so nothing takes its speed
    final = run.final[0]
    energy = speed * speed + 2.0 * G * (drop - final["y"])
    assert math.hypot(final["vx"], final["vy"]) == pytest.approx(math.sqrt(energy), rel=1e-12)


@pytest.mark.parametrize("off", [0.0, 1e-16, -1e-16, 4e-16, -4e-16, 1e-15, -1e-15])
@pytest.mark.parametrize("tangential", [1.0, 0.9, 0.3])
def test_a_disc_that_falls_onto_an_arc_along_its_tangent_goes_on_along_it(off, tangential):
    """The arc begins where the disc comes down; rounding puts it inside or outside the tangent."""
    pipe, disc, height = 3.0, 0.5, 2.0
    walls = Walls.from_polylines(
        [[(-pipe, 0.0), (pipe, 0.0)]], closed=[False], bulges=[[1.0, 0.0]], material=[Material(0.5, tangential)]
    )
    balls = Balls([(pipe - disc + off, height)], [(0.0, 0.0)], disc)
    run = simulate(Scene(walls, balls, gravity=(0.0, -G)), until=1.0, mode="interpreted")
    final = run.final[0]
    assert math.hypot(final["x"], final["y"]) == pytest.approx(pipe - disc, abs=1e-12)
    assert run.contacts["time"][0] == pytest.approx(math.sqrt(2.0 * height / G), abs=1e-7)
    if tangential == 1.0:  # else it depends on rounding whether it strikes the end of the arc as it passes that
        assert math.hypot(final["vx"], final["vy"]) == pytest.approx(math.sqrt(2.0 * G * (height - final["y"])))


@pytest.mark.parametrize("pieces", [1, 2])
@pytest.mark.parametrize("speed", [6.0, 9.0])
@pytest.mark.parametrize("restitution", [0.5, 1.0])
def test_a_disc_that_leaves_a_half_pipe_upwards_falls_back_into_it(restitution, speed, pieces):
    pipe, disc, height = 4.3, 0.2, 1.5
    walls = half_pipe(pipe, height, Material(restitution), pieces=pieces, shift=(0.1, 0.0))
    balls = Balls([(0.1 + pipe - disc, 0.5)], [(0.0, speed)], disc)
    run = simulate(Scene(walls, balls, gravity=(0.0, -G)), until=3.0, mode="interpreted")
    assert ContactKind.LEAVE in run.contacts["kind"]
    assert beyond(run, pipe, disc, height, (0.1, 0.0)) < 5e-12
    energy = run.contacts["vx"] ** 2 + run.contacts["vy"] ** 2 + 2.0 * G * run.contacts["y"]
    # It grazes the end of the side as it comes back, at the root of rounding: with restitution 1 that takes nothing.
    lost = 1e-12 if restitution == 1.0 else 1e-5
    assert energy == pytest.approx(np.full(len(energy), speed**2 + G), rel=lost)


def test_a_disc_in_touch_with_an_upright_side_does_not_go_through_the_hollow_below():
    _kind, scene, until = touching_scene(183)
    run = simulate(scene, until=until, mode="interpreted")
    pipe = float(scene.walls.vertices[2, 0])
    assert math.hypot(run.final["x"][0], run.final["y"][0] - pipe) <= pipe - 0.2 + 1e-11


@pytest.mark.parametrize("seed", [0, 3, 7, 183])
def test_interpreted_and_compiled_kernels_agree_on_starts_in_touch(seed):
    _kind, scene, until = touching_scene(seed)
    one, other = (simulate(scene, until=until, mode=mode) for mode in ("interpreted", "compiled"))
    assert one.contacts.tobytes() == other.contacts.tobytes()
    assert one.final.tobytes() == other.final.tobytes()


@pytest.mark.parametrize("tangential", [0.3, 0.9])
def test_a_ball_laid_on_a_wall_keeps_its_speed_whatever_the_wall_takes_from_bounces(tangential):
    for disc, angle in [(0.2, 0.3), (0.2, 0.7), (0.0, 0.3), (0.5, -0.4)]:
        along, normal = np.array([math.cos(angle), math.sin(angle)]), np.array([-math.sin(angle), math.cos(angle)])
        walls = Walls.from_polylines([[-40.0 * along, 40.0 * along]], material=[Material(0.5, tangential)])
        ball = Balls([along + disc * normal], [1.24 * along], disc)
        final = simulate(Scene(walls, ball, gravity=(0.0, -G)), until=1.0, mode="interpreted").final[0]
        # v = v0 - g sin(angle) t along the slope
        speed = np.dot((final["vx"], final["vy"]), along)
        assert speed == pytest.approx(1.24 - G * math.sin(angle), abs=1e-12)


def test_surveys_in_lockstep_count_what_balls_laid_on_a_wall_meet():
    walls = half_pipe(4.0, 2.0, Material(0.5, 0.9))
    discs = Balls([(3.8, 1.0), (-3.8, 0.5), (3.8, 1.9)], [(0.0, -1.0), (0.0, 0.0), (0.0, 9.0)], 0.2)
    scene = Scene(walls, discs, gravity=(0.0, -G))
    run = simulate(scene, until=1.5, mode="interpreted")
    totals = survey(scene, until=1.5)
    assert np.array_equal(totals.position, np.stack([run.final["x"], run.final["y"]], axis=1))


@pytest.mark.parametrize("seed", range(40))
def test_a_point_laid_on_an_upright_side_of_a_half_pipe_stays_in_it(seed):
    # whichever way round the pipe is drawn: it is on the side to which the wall turns below
    random = np.random.default_rng(seed)
    pipe, height, shift = random.uniform(1.0, 5.0), random.uniform(0.5, 4.0), random.uniform(-3.0, 3.0, 2)
    material = Material(random.choice([0.0, 0.4, 1.0, random.random()]), random.choice([1.0, 0.9, 0.3]))
    walls = half_pipe(pipe, height, material, pieces=int(random.integers(1, 3)), turned=seed % 2 == 1, shift=shift)
    start, drop = walls.vertices[random.choice([0, -1])], random.uniform(0.01, 0.99) * height
    speed = random.choice([0.0, -1.0, 1.0]) * math.sqrt(2.0 * G * (height - drop)) * random.random()  # not over its end
    scene = Scene(walls, Balls([(start[0], shift[1] + drop)], [(0.0, speed)], 0.0), gravity=(0.0, -G))
    run = simulate(scene, until=3.0, mode="interpreted")
    assert beyond(run, pipe, 0.0, height, shift) < 5e-12  # as for discs
    if material.restitution == 1.0:  # it comes to the arc along it, and keeps all its energy
        final = run.final[0]
        energy = speed * speed + 2.0 * G * (shift[1] + drop - final["y"])
        assert final["vx"] ** 2 + final["vy"] ** 2 == pytest.approx(energy, rel=1e-10)


def over_the_end(seed, drag=None):
    """A half pipe along gravity, and a point on one of its sides that runs up over the end of that."""
    random = np.random.default_rng(seed)
    pipe, height, shift = random.uniform(1.0, 5.0), random.uniform(0.5, 4.0), random.uniform(-3.0, 3.0, 2)
    material = Material(random.choice([0.0, 0.4, 1.0, random.random()]), random.choice([1.0, 0.9, 0.3]))
    walls = half_pipe(pipe, height, material, pieces=int(random.integers(1, 3)), turned=seed % 2 == 1, shift=shift)
    start, drop = walls.vertices[random.choice([0, -1])], random.uniform(0.01, 0.99) * height
    speed = math.sqrt(2.0 * G * (height - drop)) * random.uniform(1.3, 2.0)
    balls = Balls([(start[0], shift[1] + drop)], [(0.0, speed)], 0.0)
    return Scene(walls, balls, gravity=(0.0, -G), drag=drag), pipe, height, shift


@pytest.mark.parametrize("drag", [None, 0.1])
@pytest.mark.parametrize("seed", range(30))
def test_a_point_that_runs_up_over_the_end_of_a_half_pipe_falls_back_into_it(seed, drag):
    # As discs do, however small they are; whether the wall lies beside its way by rounding decides nothing.
    scene, pipe, height, shift = over_the_end(seed, drag)
    run = simulate(scene, until=3.0, mode="interpreted")
    assert beyond(run, pipe, 0.0, height, shift) < 5e-12
    leaves = np.flatnonzero(run.contacts["kind"] == ContactKind.LEAVE)
    assert len(leaves)
    for row in leaves:
        if row + 1 < len(run.contacts):
            up, back = run.contacts[row], run.contacts[row + 1]
            assert (back["kind"], back["x"], back["y"]) == (
                ContactKind.SLIDE,
                up["x"],
                pytest.approx(up["y"], abs=1e-14),
            )
            if drag is None:
                assert (back["vx"], back["vy"]) == (-up["vx"], pytest.approx(-up["vy"], rel=1e-13))
                assert back["time"] - up["time"] == pytest.approx(2.0 * up["vy"] / G, rel=1e-12)
    true, final = ContactReference(scene).run(3.0)[-1].row(), run.final[0]
    assert math.hypot(final["x"] - true[1], final["y"] - true[2]) < 1e-10
    assert run.trusted_until(1e-9)[0].whole
    world = World(scene)
    for _ in range(180):
        world.step(1 / 60)
    assert world.position[0] == pytest.approx((final["x"], final["y"]), abs=1e-10)


@pytest.mark.parametrize("turned", [False, True])
@pytest.mark.parametrize("side", [0, 1])
def test_a_point_laid_on_an_upright_side_of_a_closed_wall_is_where_balls_are_free(side, turned):
    # A room runs clockwise and a pillar counter-clockwise, so that material is on the left; both have floors below.
    square = [(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0)]
    ring = square[::-1] if turned else square
    ground = [(-9.0, -3.0), (9.0, -3.0)]
    walls = Walls.from_polylines([ring, ground], closed=[True, False], material=Material(0.0, 1.0))
    scene = Scene(walls, Balls([(4.0 * side, 2.0)], [(0.0, 0.0)], 0.0), gravity=(0.0, -G))
    final = simulate(scene, until=3.0, mode="interpreted").final[0]
    assert final["y"] == pytest.approx(0.0 if turned else -3.0, abs=1e-11)  # the room's floor, or the ground outside
    assert final["x"] == pytest.approx(4.0 * side, abs=1e-11)
    world = World(scene)
    for _ in range(180):
        world.step(1 / 60)
    assert world.position[0] == pytest.approx((final["x"], final["y"]), abs=1e-11)


@pytest.mark.parametrize("turned", [False, True])
def test_interpreted_and_compiled_kernels_agree_on_points_laid_on_upright_sides(turned):
    walls = half_pipe(4.0, 2.0, Material(0.5, 0.9), pieces=2, turned=turned)
    points = Balls([(4.0, 1.0), (-4.0, 0.5), (4.0, 1.9)], [(0.0, -1.0), (0.0, 0.0), (0.0, 5.0)], 0.0)
    for drag in (None, 0.2):
        scene = Scene(walls, points, gravity=(0.0, -G), drag=drag)
        one, other = (simulate(scene, until=2.0, mode=m) for m in ("interpreted", "compiled"))
        assert one.contacts.tobytes() == other.contacts.tobytes()
        assert one.final.tobytes() == other.final.tobytes()
