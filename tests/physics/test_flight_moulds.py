"""Discs that come into a hollow as large as they are: all of it touches them at once, and they come out again.

A disc that flew along the axis of a half circle of its own radius once went through: it passes the ends at a right
angle, and the circle on which its centre should stay had no size.
"""

import numpy as np
import pytest
import shapely
from alone import assert_as_alone, flown
from test_flight_rolling import placed

from wallkit import Balls, Scene, Walls, simulate

SIZES = [0.0, 1e-16, -1e-16, 1e-14, -1e-14, 1e-11, -1e-11, 1e-8, -1e-8, 1.6e-8, -1.6e-8, 3e-8, -3e-8, 1e-6, -1e-6, 1e-3]
"""By how much the hollow is larger than the disc, in parts of it."""
ASIDE = [0.0, 1e-16, -1e-16, 1e-14, 1e-12, -1e-12, 1e-9, 1e-8, -1e-8, 2e-8, 1e-7, -1e-6, 1e-4, 1e-2]
"""How far off the axis discs come, in radii."""
CUP = np.array([[-40.0, -30.0], [0.0, -30.0], [0.0, -5.0], [0.0, 5.0], [0.0, 30.0], [-40.0, 30.0]])


def cup(place, bulge):
    """A room with a hollow in its wall, whose arc has the radius 5 for a half circle, and its region, finely."""
    walls = Walls.from_polylines([place(CUP)], bulges=[np.array([0.0, 0.0, bulge, 0.0, 0.0, 0.0])])
    half = 2 * np.arctan(bulge)
    radius = 5.0 / np.sin(half)
    turn = np.linspace(-half, half, 4001)
    arc = np.stack([radius * (np.cos(turn) - np.cos(half)), radius * np.sin(turn)], axis=1)
    return walls, shapely.Polygon(place(np.concatenate([CUP[:3], arc[1:-1], CUP[3:]]))), radius


def shot_along_the_axis(walls, place, start, radius, gravity=None):
    """Discs that fly into the hollow, from places in the drawing as it was before it was placed."""
    axis = place(np.array([1.0, 0.0])) - place(np.zeros(2))
    pull = None if gravity is None else tuple(gravity * axis)
    return Scene(walls, Balls(place(start), np.tile(3.0 * axis, (len(start), 1)), radius), gravity=pull)


def assert_outside_walls(region, totals, radius):
    """No disc is in a wall by more than what moulds give way, and what the region's chords leave out."""
    places = shapely.points(totals.position)
    assert shapely.contains(region, places).all()
    assert (shapely.distance(region.exterior, places) > (1.0 - 3e-6) * radius).all()


@pytest.mark.parametrize("bulge", [1.0, 0.6, 0.2])
@pytest.mark.parametrize("gravity", [None, 1.0])
def test_no_disc_leaves_through_a_hollow_of_its_size(bulge, gravity):
    rng = np.random.default_rng(int(10 * bulge))
    for larger in SIZES:
        place, size = placed(rng)
        walls, region, hollow = cup(place, bulge)
        start = np.stack([np.full(len(ASIDE), -20.0), hollow * np.array(ASIDE)], axis=1)
        radius = size * hollow * (1.0 - larger)
        scene = shot_along_the_axis(walls, place, start, radius, gravity)
        for index in ("grid", "none"):
            totals, _ = flown(scene, index, until=14.3, bounces=400)
            assert_outside_walls(region, totals, radius)


def test_along_the_axis_it_comes_straight_back():
    walls, _, _ = cup(lambda p: p, 1.0)
    run = simulate(Scene(walls, Balls([-20.0, 0.0], [4.0, 0.0], 5.0)), until=9.0)
    contacts = run.contacts  # those with the ends of the arc turn nothing
    assert contacts["time"] == pytest.approx(5.0, abs=1e-6)
    assert contacts[-1][["x", "y", "vx", "vy"]].tolist() == pytest.approx([0.0, 0.0, -4.0, 0.0], abs=1e-6)
    assert run.position(9.0) == pytest.approx(np.array([[-16.0, 0.0]]), abs=1e-5)


def test_waves_fly_it_as_alone():
    rng = np.random.default_rng(3)
    for larger in SIZES:
        place, size = placed(rng)
        walls, region, hollow = cup(place, 1.0)
        aside = np.concatenate([hollow * np.repeat(ASIDE, 4), rng.uniform(-20, 20, 100)])
        start = np.stack([rng.uniform(-30.0, -8.0, len(aside)), aside], axis=1)
        radius = size * hollow * (1.0 - larger)
        scene = shot_along_the_axis(walls, place, start, radius)
        assert_outside_walls(region, assert_as_alone(scene, 30, until=30.0, bounces=400), radius)
