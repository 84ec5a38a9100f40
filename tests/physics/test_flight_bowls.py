"""Gravity in rooms with round walls: whatever a ball does there, it stays, and its run ends by name."""

import numpy as np
import pytest
import shapely

from wallkit import Balls, Ending, Material, Scene, Walls, simulate, survey
from wallkit.simulation.run import ContactKind

QUARTER = np.tan(np.pi / 8)  # the bulge of a quarter circle; negative in a room, which runs clockwise

ROOMS = {
    # straight sides that run smoothly into half circles: a ball slides from the one onto the other
    "stadium": ([[[220, 20], [20, 220], [220, 420], [620, 420], [820, 220], [620, 20]]], [[-1, -1, 0, -1, -1, 0]]),
    "bowl": ([[[0, 100], [100, 0], [0, -100], [-100, 0]]], [[-1, -1, -1, -1]]),
    # a round pillar in a box: a ball comes to lie on top of it and beside it
    "pillar": (
        [[[0, 0], [0, 300], [300, 300], [300, 0]], [[150, 100], [200, 150], [150, 200], [100, 150]]],
        [[0, 0, 0, 0], [1, 1, 1, 1]],
    ),
}
INSIDE = {
    "stadium": lambda x, y: np.hypot(np.maximum(np.abs(x - 420) - 200, 0), y - 220) <= 200 + 1e-9,
    "bowl": lambda x, y: np.hypot(x, y) <= 100 + 1e-9,
    "pillar": lambda x, y: (
        (np.maximum(np.abs(x - 150), np.abs(y - 150)) <= 150 + 1e-9) & (np.hypot(x - 150, y - 150) >= 50 - 1e-9)
    ),
}
STARTS = {"stadium": (330, 250), "bowl": (10, 5), "pillar": (50, 150)}


def walls_of(room, restitution, tangential):
    outlines, turns = ROOMS[room]
    bulges = [np.array(turn) * QUARTER for turn in turns]
    return Walls.from_polylines(outlines, bulges=bulges, material=Material(restitution, tangential))


def shots(room, count, radius):
    rng = np.random.default_rng(5)
    angle, speed = rng.uniform(0, 2 * np.pi, count), rng.uniform(0, 300, count)
    velocity = np.stack([speed * np.cos(angle), speed * np.sin(angle)], axis=1)
    return Balls(np.tile(STARTS[room], (count, 1)), velocity, radius)


@pytest.mark.parametrize("room", ROOMS)
@pytest.mark.parametrize("radius", [0.0, 8.0])
@pytest.mark.parametrize(("restitution", "tangential"), [(0.3, 1.0), (0.8, 0.9), (0.97, 1.0)])
def test_nothing_leaves_a_room_under_gravity(room, radius, restitution, tangential):
    walls = walls_of(room, restitution, tangential)
    for gravity in ((0.0, -300.0), (170.0, 90.0)):
        scene = Scene(walls, shots(room, 60, radius), gravity=gravity)
        totals = survey(scene, until=200.0, bounces=20_000)
        assert not np.any(totals.ending == Ending.LEFT_SCENE)
        assert INSIDE[room](totals.position[:, 0], totals.position[:, 1]).all()


def test_a_ball_dropped_into_the_middle_of_a_bowl_comes_to_rest_at_its_bottom():
    walls = walls_of("bowl", 0.5, 1.0)
    run = simulate(Scene(walls, Balls([[0, 50]], [[0, 0]], 8.0), gravity=(0, -9.81)), bounces=1000)
    # sqrt(2 h / g) (1 + e) / (1 - e), h from 50 down to where the ball touches: -(100 - 8)
    expected = np.sqrt(2 * (50 + 92) / 9.81) * 3
    assert run.ending == (Ending.AT_REST,)
    assert run.final["time"][0] == pytest.approx(expected, rel=1e-6)  # bounces below rounding are not waited for
    assert run.final["y"][0] == pytest.approx(-92, abs=1e-9)


def test_a_ball_that_slides_smoothly_into_a_hollow_swings_on_in_it_for_ever():
    walls = walls_of("stadium", 0.3, 1.0)
    run = simulate(Scene(walls, Balls([[330, 250]], [[163, 81]], 8.0), gravity=(0, 300)), bounces=3000)
    assert run.ending == (Ending.SWINGING,)
    slides = run.contacts[run.contacts["kind"] == ContactKind.SLIDE]
    energy = 0.5 * (slides["vx"] ** 2 + slides["vy"] ** 2) - 300 * slides["y"]
    np.testing.assert_allclose(energy, energy[0], rtol=1e-12)
    assert {(float(x), float(y)) for x, y in zip(slides["x"][1:], slides["y"][1:], strict=True)} == {
        (620.0, 412.0),
        (220.0, 412.0),
    }


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("radius", [0.0, 1.0])
@pytest.mark.parametrize(("restitution", "tangential"), [(0.3, 1.0), (0.9, 1.0), (0.5, 0.9)])
def test_nothing_leaves_a_jagged_room_by_its_valleys(seed, radius, restitution, tangential):
    # balls slide into valleys and under overhangs, where two walls and rounding meet in one point
    rng = np.random.default_rng(seed)
    count = 0
    while count < 4:
        corners = int(rng.integers(5, 16))
        angle, far = np.sort(rng.uniform(0, 2 * np.pi, corners)), rng.uniform(40, 100, corners)
        outline = np.stack([far * np.cos(angle), far * np.sin(angle)], axis=1)
        room = shapely.Polygon(outline)
        if not room.is_valid or room.boundary.distance(room.representative_point()) < 2:
            continue
        count += 1
        start = np.array(room.representative_point().coords[0])
        direction, speed = rng.uniform(0, 2 * np.pi, 40), rng.uniform(0, 100, 40)
        velocity = np.stack([speed * np.cos(direction), speed * np.sin(direction)], axis=1)
        walls = Walls.from_polylines([outline], material=Material(restitution, tangential))
        scene = Scene(walls, Balls(np.tile(start, (40, 1)), velocity, radius), gravity=(20.0, -90.0))
        totals = survey(scene, until=100.0, bounces=20_000)
        # 1e-7 is far above the rounding of a hundred units and far below any way out
        assert shapely.contains_xy(room.buffer(1e-7), totals.position).all()


@pytest.mark.parametrize("mode", ["interpreted", "compiled"])
@pytest.mark.parametrize("radius", [0.0, 1.0, 9.0])
def test_a_ball_falls_from_the_middle_of_a_round_room(radius, mode):
    # no direction is normal to the wall there: it falls by R - r, in sqrt(2 (R - r) / g)
    room = Walls.from_polylines([[[-10.0, 0.0], [10.0, 0.0]]], bulges=[[-1.0, -1.0]])
    scene = Scene(room, Balls([[0.0, 0.0]], [[0.0, 0.0]], radius), gravity=(0.0, -8.0))
    contact = simulate(scene, bounces=1, mode=mode).contacts[0]
    assert contact["time"] == pytest.approx(np.sqrt((10.0 - radius) / 4.0), rel=1e-14)
    assert contact["y"] == pytest.approx(radius - 10.0, rel=1e-14)
