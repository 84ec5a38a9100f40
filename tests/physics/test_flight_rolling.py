"""Discs that roll along a wall, touching it all the way, into a hollow: they stay inside, however it is joined on.

Such a disc comes to an arc on its tangent and to a line at next to no angle. Rounding decides whether the path touches
them at all, or where; many of these discs once left a stadium through its round ends.
"""

import math

import numpy as np
import pytest
import shapely
from alone import assert_same_bits, flown

from wallkit import Balls, Scene, Walls
from wallkit.simulation.modelled import Modelled

EIGHTH = math.tan(math.pi / 8)
OFFS = [0.0, 1e-15, -1e-15, 1e-14, -1e-14, 1e-13, 1e-12, 1e-9]
"""From the wall, beyond the radius; a start may be off by rounding."""
TILTS = [0.0, 1e-16, -1e-16, 1e-12, -1e-12, 1e-9, -1e-9]


def placed(rng):
    """A way to put a drawing anywhere, of any size: exact, or by rounded numbers."""
    turn, size = rng.choice([0.0, math.pi / 2, rng.uniform(0, math.tau)]), rng.choice([1.0, rng.uniform(0.1, 10.0)])
    c, s = size * math.cos(turn), size * math.sin(turn)
    shift = rng.choice([0.0, 1.0]) * rng.uniform(-100, 100, 2)
    return lambda p, shift=shift: p @ np.array([[c, s], [-s, c]]) + shift, size


def rolling(rng, place, size, radius, span, count=60):
    """Discs that touch the floor from x = 0 on, and roll along it."""
    start = np.stack([rng.uniform(*span, count), radius + rng.choice(OFFS, count)], axis=1)
    tilt = rng.choice(TILTS, count)
    velocity = rng.choice([1.0, 33.3, 128.0]) * np.stack([np.cos(tilt), np.sin(tilt)], axis=1)
    return Balls(place(start), place(velocity) - place(np.zeros(2)), size * radius)


def assert_all_inside(scene, region, until, bounces=2000):
    """With and without an index: (the totals of both)."""
    both = [flown(scene, index, until=until, bounces=bounces)[0] for index in ("grid", "none")]
    for totals in both:
        away = shapely.distance(region, shapely.points(totals.position))
        assert away.max() < 1e-4 * scene.balls.radius.max()
    return both


@pytest.mark.parametrize("ends", ["halves", "quarters", "quarters with a rounded bulge"])
def test_along_a_cushion_into_a_round_end(ends):
    rng = np.random.default_rng(1)
    if ends == "halves":
        outline, bulges = [[0, 0], [100, 0], [100, 100], [0, 100]], [0, 1, 0, 1]
    else:
        bulge = EIGHTH if ends == "quarters" else 0.41421356
        outline = [[0, 0], [100, 0], [150, 50], [100, 100], [0, 100], [-50, 50]]
        bulges = [0, bulge, bulge, 0, bulge, bulge]
    for _scene in range(40):
        place, size = placed(rng)
        radius = rng.choice([1.0, 5.0, 16.0, rng.uniform(0.1, 20.0)])
        walls = Walls.from_polylines([place(np.array(outline, dtype=float))], bulges=[np.array(bulges, dtype=float)])
        scene = Scene(walls, rolling(rng, place, size, radius, (5.0, 95.0)))
        axis = shapely.LineString(place(np.array([[0.0, 50.0], [100.0, 50.0]])))
        region = axis.buffer(size * (50.0 - radius), quad_segs=4000)
        speed = float(np.hypot(*scene.balls.velocity[0]))
        assert_same_bits(*assert_all_inside(scene, region, until=1e4 * size / speed))


@pytest.mark.parametrize("obstacles", [0, 200])
def test_along_a_floor_that_turns_up_a_little(obstacles):
    """Each joint turns by 1e-13 to 1e-2, some of the edges bow next to nothing; obstacles make the cells small."""
    rng = np.random.default_rng(2)
    for _scene in range(60):
        place, size = placed(rng)
        radius, joints = rng.choice([1.0, 5.0, 16.0]), int(rng.integers(1, 6))
        turns = np.cumsum(np.full(joints, 10.0 ** rng.uniform(-13, -2)))
        steps = rng.choice([2.0, 20.0, 60.0]) * np.stack([np.cos(turns), np.sin(turns)], axis=1)
        floor = np.concatenate(
            [[[0.0, 0.0]], np.array([100.0, 0.0]) + np.cumsum(np.vstack([[0.0, 0.0], steps]), axis=0)]
        )
        right = floor[-1, 0]
        outline = np.concatenate([floor, [[right, 100.0], [0.0, 100.0]]])
        bulges = np.zeros(len(outline))
        bulges[1 : 1 + joints] = rng.choice([0.0, 0.0, 1e-12, 1e-9, -1e-9])
        teeth = [[[x, 88.0], [x + 0.3, 88.0], [x + 0.1, 88.5]] for x in np.linspace(2.0, 98.0, obstacles)]
        walls = Walls.from_polylines(
            [place(np.array(ring)) for ring in (outline, *teeth)], bulges=[bulges] + [np.zeros(3)] * obstacles
        )
        scene = Scene(walls, rolling(rng, place, size, radius, (25.0, 60.0)))
        region = shapely.Polygon(place(outline)).buffer(-size * radius)
        speed = float(np.hypot(*scene.balls.velocity[0]))
        assert_same_bits(*assert_all_inside(scene, region, until=1e4 * size / speed))


@pytest.mark.parametrize("radius", [0.5, 5.0, 20.0])
def test_around_a_wavy_room_of_arcs(radius):
    """Started in contact, along the wall, most of them where two arcs are joined.

    Without an index a vertex there counts too for those whose start is too near by rounding: bits may differ.
    """
    rng = np.random.default_rng(3)
    angle = np.arange(400) * math.tau / 400
    size = 200 * (1 + 0.15 * np.cos(3 * angle) + 0.07 * np.sin(5 * angle))
    points = np.stack([size * np.cos(angle), size * np.sin(angle)], axis=1)
    walls = Walls.from_polylines([points[::2]], bulges=[bulges_through(points)])
    model = Modelled(Scene(walls, Balls(np.zeros(2), [1.0, 0.0], radius)), index="none")
    arc = model.model.arcs[rng.integers(0, 200, 300)]
    turn = np.arctan2(arc["sy"], arc["sx"]) + rng.choice([0.0, 1.0, 0.3], 300) * np.abs(arc["sweep"])
    out = np.stack([np.cos(turn), np.sin(turn)], axis=1)
    centre = np.stack([arc["ax"] - arc["sx"], arc["ay"] - arc["sy"]], axis=1) + model.origin
    foot = centre + arc["radius"][:, None] * out
    inwards = out * np.where((foot * out).sum(axis=1) > 0.0, -1.0, 1.0)[:, None]
    tilt = rng.choice(TILTS, 300)[:, None]
    along = np.stack([-out[:, 1], out[:, 0]], axis=1) * rng.choice([-1.0, 1.0], 300)[:, None]
    position = foot + (radius + rng.choice(OFFS, 300))[:, None] * inwards
    scene = Scene(walls, Balls(position, 50.0 * (along + tilt * inwards), radius))
    assert_all_inside(scene, shapely.Polygon(points).buffer(-radius + 0.2), until=100.0)


def bulges_through(points):
    """Of arcs from every second point to the next but one, through the one between."""
    a, m, b = points[::2], points[1::2], np.roll(points[::2], -1, axis=0)
    chord, rise = b - a, m - (a + b) / 2
    cross = chord[:, 0] * rise[:, 1] - chord[:, 1] * rise[:, 0]
    return -2.0 * cross / (chord**2).sum(axis=1)
