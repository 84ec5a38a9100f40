"""Numbers as large as doubles go, given to what builds and flies scenes: an error that says what may be."""

import io
import math

import pytest

import wallkit
from wallkit import Balls, RandomBalls, Scene, Walls, World, aim, count, simulate
from wallkit.simulation import world

DRAWING = b'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 100 100"><path d="M5 5H95V95H5Z"/></svg>'
LARGE = (1e308, -1e308, 2.0**1023)


def room(**changed):
    walls = wallkit.import_walls(io.BytesIO(DRAWING), arena=True)
    return Scene(walls, changed.pop("balls", Balls([[25.0, 25.0]], [[30.0, 10.0]], 2.0)), **changed)


def bowed(bulge):
    return Walls.from_polylines([[[0.0, 0.0], [100.0, 0.0], [50.0, 90.0]]], bulges=[[bulge, 0.0, 0.0]])


LARGE_THINGS = {
    "a place": lambda large: simulate(room(balls=Balls([[large, 2.0]], [[1.0, 2.0]]), gravity=(0.0, -9.0)), bounces=9),
    "a speed": lambda large: simulate(room(balls=Balls([[25.0, 25.0]], [[large, 2.0]])), bounces=9),
    "a radius": lambda large: simulate(room(balls=Balls([[25.0, 25.0]], [[1.0, 2.0]], abs(large))), bounces=9),
    "gravity": lambda large: simulate(room(gravity=(0.0, large)), bounces=9),
    "rolling friction": lambda large: simulate(room(rolling_friction=abs(large)), bounces=9),
    "drag": lambda large: simulate(room(drag=abs(large), gravity=(0.0, -9.0)), bounces=9),
    "a bulge": lambda large: simulate(Scene(bowed(large), Balls([[50.0, 40.0]], [[1.0, 3.0]])), bounces=9),
    "a box of balls": lambda large: count(
        room(gravity=(0.0, -9.0)), RandomBalls((0.0, 0.0, abs(large), 10.0)), 10, bounces=3
    ),
    "a kick": lambda large: World(room()).place(0, velocity=(large, 25.0)),
    "a new place": lambda large: World(room(gravity=(0.0, -9.0))).place(0, (large, 25.0)),
    "a start": lambda large: aim(room(), (large, 25.0), (75.0, 75.0, 5.0), 1),
    "a target": lambda large: aim(room(), (25.0, 25.0), (large, 75.0, 5.0), 1),
    "a target's radius": lambda large: aim(room(), (25.0, 25.0), (75.0, 75.0, abs(large)), 1),
    "a level's scale": lambda large: room().walls.export("planck", scale=abs(large)),
    "a level's grid": lambda large: room().walls.export("planck", grid=abs(large)),
}


@pytest.mark.parametrize("thing", LARGE_THINGS)
def test_what_is_too_large_is_refused_in_words(thing):
    for large in LARGE:
        with pytest.raises(wallkit.WallkitError):  # a warning of numpy would fail the test
            LARGE_THINGS[thing](large)


@pytest.mark.parametrize("far", LARGE)
def test_without_gravity_a_ball_may_be_as_far_away_as_numbers_go(far):
    run = simulate(room(balls=Balls([[far, 25.0]], [[-math.copysign(1e150, far), 0.0]])), bounces=9)
    assert run.trusted_until()[0].bounces == 0
    world = World(room())
    world.place(0, (far, 25.0))
    assert len(world.step(1.0)) == 0


def test_a_frame_without_end_ends(monkeypatch):
    monkeypatch.setattr(world, "MOST_CONTACTS", 1_000)
    for seconds in LARGE[0], 1e9:
        with pytest.raises(wallkit.LimitError, match="contacts of a ball in one frame, at most 1,000"):
            World(room()).step(seconds)
    resting = World(room(balls=Balls([[25.0, 25.0]], [[0.0, 0.0]], 2.0)))
    assert len(resting.step(1e9)) == 0
