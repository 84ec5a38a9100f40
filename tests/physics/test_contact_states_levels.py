"""Balls under gravity in drawn levels and in corners: every run goes on, or ends for a reason, and loses no ball."""

import math

import numpy as np
import pytest
import shapely

from wallkit import Balls, Ending, Material, Scene, Walls, import_walls, simulate
from wallkit.scene.samples import samples
from wallkit.scene.starting_places import roomiest
from wallkit.simulation.run import ContactKind

DRAWINGS = [sample.path for sample in samples() if sample.path.suffix in (".svg", ".ai")]


@pytest.mark.parametrize("path", DRAWINGS, ids=lambda path: path.stem)
@pytest.mark.parametrize("restitution", [0.8, 0.5, 0.0])
def test_no_ball_collapses_in_a_drawn_level(path, restitution):
    drawn = import_walls(path, curves="arcs")
    pieces = [slice(a, b) for a, b in zip(drawn.offsets[:-1], drawn.offsets[1:], strict=True)]
    level = Walls.from_polylines(
        [drawn.vertices[piece] for piece in pieces],
        closed=[bool(closed) for closed in drawn.closed],
        bulges=[drawn.bulges[piece] for piece in pieces],
        material=Material(restitution, 1.0),
    )
    spot, rng, count = roomiest(drawn), np.random.default_rng(3), 3
    x0, y0, x1, y1 = level.box()
    size = max(x1 - x0, y1 - y0)
    angle, speed = rng.uniform(0, 2 * np.pi, count), size * rng.uniform(0, 1, count)
    velocity = np.stack([speed * np.cos(angle), speed * np.sin(angle)], axis=1)
    place = np.tile((spot.x, spot.y), (count, 1))
    balls = Balls(place, velocity, min(0.01 * size, 0.5 * spot.room))
    run = simulate(Scene(level, balls, gravity=(0.0, -size)), until=6.0, bounces=5000, mode="interpreted")
    assert Ending.COLLAPSE not in run.ending
    before = 0.5 * speed**2 + size * place[:, 1]
    after = 0.5 * (run.final["vx"] ** 2 + run.final["vy"] ** 2) + size * run.final["y"]
    assert (after - before <= 1e-11 * size * size).all()


ROOMS = {
    # overhangs, from which a ball falls whose speed towards them a wall has taken
    "tent": [[0, 0], [40, 100], [60, 100], [100, 0]],
    "diamond": [[50, 0], [100, 50], [50, 100], [0, 50]],
    "leaning box": [[0, 0], [60, 100], [160, 100], [100, 0]],
}


@pytest.mark.parametrize("room", ROOMS)
@pytest.mark.parametrize("restitution", [0.0, 0.5])
@pytest.mark.parametrize("radius", [0.0, 3.0])
def test_nothing_leaves_a_room_by_its_overhangs(room, restitution, radius):
    walls = Walls.from_polylines([ROOMS[room]], material=Material(restitution, 1.0))
    angle = np.random.default_rng(1).uniform(0, 2 * np.pi, 25)
    centre = np.mean(ROOMS[room], axis=0)
    balls = Balls(np.tile(centre, (25, 1)), 80 * np.stack([np.cos(angle), np.sin(angle)], axis=1), radius)
    run = simulate(Scene(walls, balls, gravity=(0.0, -100.0)), until=20.0, bounces=400, mode="interpreted")
    inside = shapely.Polygon(ROOMS[room]).buffer(1e-7 - radius)
    assert shapely.contains_xy(inside, run.final["x"], run.final["y"]).all()
    assert Ending.COLLAPSE not in run.ending


@pytest.mark.parametrize(
    ("left", "right", "bulge"), [(-100, 60, 0.3), (-50, 60, 0.1), (-50, 30, -0.1), (-50, 60, 0.02)]
)
@pytest.mark.parametrize("restitution", [0.5, 0.0])
def test_nothing_falls_through_the_tip_of_a_line_and_an_arc(left, right, bulge, restitution):
    corner = [[0, 0], [left, 100], [right, 100]]
    walls = Walls.from_polylines([corner], bulges=[[0, 0, bulge]], material=Material(restitution, 1.0))
    x = np.linspace(0.45, 0.55, 12) * (left + right)
    balls = Balls(np.stack([x, np.full(12, 95.0)], axis=1), np.zeros((12, 2)), 0.0)
    run = simulate(Scene(walls, balls, gravity=(0.0, -100.0)), until=30.0, bounces=2000, mode="interpreted")
    room = shapely.Polygon(corner).buffer(0.5 * abs(bulge) * math.hypot(right, 100) + 1e-6)  # as far as the arc bows
    assert shapely.contains_xy(room, run.final["x"], run.final["y"]).all()
    assert (run.final["y"] > -1e-6).all()


def test_a_point_that_corners_of_two_dead_walls_stop_rests_there_and_not_outside():
    # sharper than a right angle: dead hits on either wall in turn leave it no speed, and gravity presses it on both
    run = simulate(
        Scene(
            Walls.from_polylines([[[-60, 40], [0, 0], [-10, 60]]], closed=False, material=Material(0.0, 1.0)),
            Balls([-30.0, 35.0], [0.0, 0.0]),
            gravity=(3.0, -100.0),
        ),
        until=20.0,
    )
    assert run.ending == (Ending.AT_REST,)
    assert np.hypot(run.final["x"][0], run.final["y"][0]) < 1e-8
    assert np.count_nonzero(run.contacts["kind"] == ContactKind.EDGE) < 200


@pytest.mark.parametrize("radius", [0.0, 4.0])
def test_compiled_contact_states_have_the_bits_of_interpreted_ones(radius):
    # a valley of lines and a hollow of arcs, a dome, a joint that falls away, a free end
    level = Walls.from_polylines(
        [[[-100, 80], [-60, 0], [0, 0], [60, 0], [100, 80]], [[-30, 40], [30, 40]], [[70, 90], [110, 85], [130, 40]]],
        closed=False,
        bulges=[[0, 0.3, 0.4, 0, 0], [-0.3, 0], [0, 0, 0]],
        material=Material(0.4, 1.0),
    )
    x = np.array([-80.0, -20.0, 5.0, 20.0, 90.0, 100.0])
    scene = Scene(level, Balls(np.stack([x, np.full(6, 110.0)], 1), np.zeros((6, 2)), radius), gravity=(0.0, -100.0))
    one, other = (simulate(scene, until=20.0, bounces=500, mode=mode) for mode in ("interpreted", "compiled"))
    assert {ContactKind.SLIDE, ContactKind.LEAVE} <= set(one.contacts["kind"].tolist())
    assert one.contacts.tobytes() == other.contacts.tobytes()
    assert one.final.tobytes() == other.final.tobytes()
