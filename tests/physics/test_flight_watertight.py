"""No ball leaves a closed region, seams are tight, and the bits do not depend on where or how a run is made."""

import math

import numpy as np
import pytest
import shapely

import wallkit


def random_polygon(rng, count, ragged=0.8):
    """A star-shaped polygon with sharp and blunt corners, edges from long to tiny."""
    angle = np.sort(rng.uniform(0, 2 * np.pi, count))
    size = 100.0 * (1 - ragged * rng.random(count))
    return np.stack([size * np.cos(angle), size * np.sin(angle)], axis=1)


def inside_balls(rng, polygon, count, radius):
    free = shapely.Polygon(polygon).buffer(-radius * 1.000001 - 1e-6)
    low, high = polygon.min(axis=0), polygon.max(axis=0)
    found = np.empty((0, 2))
    while len(found) < count and not free.is_empty:
        tries = rng.uniform(low, high, (20 * count, 2))
        found = np.concatenate([found, tries[shapely.contains_xy(free, tries[:, 0], tries[:, 1])]])
    angle = rng.uniform(0, 2 * np.pi, count)
    return found[:count], 50.0 * np.stack([np.cos(angle), np.sin(angle)], axis=1)


@pytest.mark.parametrize("radius", [0.0, 0.7])
def test_ten_million_bounces_leave_no_random_polygon(radius):
    rng = np.random.default_rng(20)
    bounces = 0
    for count in (5, 7, 9, 12, 15, 20, 30, 50, 100, 200, 300, 400):
        polygon = random_polygon(rng, count)
        position, velocity = inside_balls(rng, polygon, 40, radius)
        if not len(position):
            continue
        scene = wallkit.Scene(
            wallkit.Walls.from_polylines([polygon]), wallkit.Balls(position, velocity[: len(position)], radius)
        )
        totals = wallkit.survey(scene, bounces=10_500)
        region = shapely.Polygon(polygon)
        depth = shapely.distance(region, shapely.points(totals.position))
        # a contact point may be off by the rounding of coordinates of size 100
        assert depth.max() < 1e-11
        if radius > 0:
            assert (shapely.distance(region.exterior, shapely.points(totals.position)) > radius - 1e-11).all()
        assert set(totals.ending) <= {wallkit.Ending.BOUNCE_LIMIT, wallkit.Ending.AMBIGUOUS_CORNER}
        assert (totals.ending == wallkit.Ending.BOUNCE_LIMIT).mean() > 0.99
        speed = np.hypot(*totals.velocity.T)
        assert np.abs(speed / 50.0 - 1).max() < 1e-15
        bounces += int(totals.bounces.sum())
    assert bounces >= 5_000_000 if radius == 0.0 else bounces >= 2_000_000


def test_seams_are_hit_once_each():
    count = 1000
    angle = 2 * np.pi * np.arange(count) / count
    polygon = 200.0 * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    rng = np.random.default_rng(3)
    start = rng.uniform(-90, 90, (20_000, 2))
    aim = polygon[rng.integers(0, count, 20_000)] - start
    scene = wallkit.Scene(wallkit.Walls.from_polylines([polygon]), wallkit.Balls(start, aim))  # all arrive at 1 s
    assert wallkit.survey(scene, until=1.0 - 1e-9).bounces.sum() == 0
    assert (wallkit.survey(scene, until=1.0 + 1e-9).bounces == 1).all()


@pytest.mark.parametrize("radius", [0.0, 5.0])
def test_shots_at_corners_never_escape(radius):
    angle = 0.1 + np.arange(10) * np.pi / 5
    star = np.stack([np.cos(angle), np.sin(angle)], axis=1) * np.where(np.arange(10) % 2, 90.0, 200.0)[:, None]
    rng = np.random.default_rng(4)
    start = rng.uniform(-40, 40, (2000, 2))
    aim = star[rng.integers(0, 10, 2000)] - start
    scene = wallkit.Scene(wallkit.Walls.from_polylines([star]), wallkit.Balls(start, aim, radius))
    totals = wallkit.survey(scene, bounces=50)
    assert shapely.distance(shapely.Polygon(star), shapely.points(totals.position)).max() < 1e-10
    assert not np.any(totals.ending == wallkit.Ending.LEFT_SCENE)


@pytest.mark.parametrize("radius", [0.0, 5.0])
@pytest.mark.parametrize(("shift", "scale"), [(2.0**30, 1.0), (-(2.0**30), 1.0), (0.0, 2.0**-20), (0.0, 2.0**12)])
def test_shifted_or_scaled_scenes_give_the_same_bits(radius, shift, scale):
    rng = np.random.default_rng(8)
    grain = 2.0**-20  # coordinates that stay exact when shifted
    star = np.round(random_polygon(rng, 24) / grain) * grain
    ball, velocity = np.array([[1.0, -2.0]]), np.array([[31.0, 17.0]])
    plain = wallkit.Scene(wallkit.Walls.from_polylines([star]), wallkit.Balls(ball, velocity, radius))
    moved = wallkit.Scene(
        wallkit.Walls.from_polylines([star * scale + shift]),
        wallkit.Balls(ball * scale + shift, velocity * scale, radius * scale),
    )
    one, other = (wallkit.simulate(scene, bounces=200, mode="interpreted").contacts for scene in (plain, moved))
    np.testing.assert_array_equal(one["time"], other["time"])
    np.testing.assert_array_equal(one["x"] * scale + shift, other["x"])
    np.testing.assert_array_equal(one["vx"] * scale, other["vx"])


def test_threads_change_no_bit():
    rng = np.random.default_rng(9)
    polygon = random_polygon(rng, 40)
    position, velocity = inside_balls(rng, polygon, 1500, 0.5)
    scene = wallkit.Scene(wallkit.Walls.from_polylines([polygon]), wallkit.Balls(position, velocity, 0.5))
    one, two = (wallkit.survey(scene, bounces=100, threads=threads) for threads in (1, 2))
    for name in ("bounces", "position", "velocity", "time", "hits", "ending"):
        assert getattr(one, name).tobytes() == getattr(two, name).tobytes()


@pytest.mark.parametrize("radius", [0.0, 3.0])
def test_absent_features_give_the_bits_of_neutral_ones(radius):
    rng = np.random.default_rng(12)
    polygon = random_polygon(rng, 12, ragged=0.5)
    far = np.array([[500.0, 500.0], [510.0, 500.0], [510.0, 510.0]])
    balls = wallkit.Balls([[0.0, 0.0]], [[30.0, 11.0]], radius)
    plain = wallkit.Walls.from_polylines([polygon, far])
    neutral = wallkit.Walls.from_polylines(
        [polygon, far],
        material=[wallkit.Material(), wallkit.Material(0.5, 0.5)],
        sides=["both", "outward"],
        bulges=[np.zeros(12), np.full(3, 0.2)],
    )
    one = wallkit.simulate(wallkit.Scene(plain, balls), bounces=500)
    other = wallkit.simulate(wallkit.Scene(neutral, balls, gravity=(0.0, 0.0)), bounces=500)
    assert one.contacts.tobytes() == other.contacts.tobytes()


def test_a_point_in_a_right_corner_comes_straight_back():
    box = wallkit.Walls.from_polylines([[[0.0, 0.0], [8.0, 0.0], [8.0, 8.0], [0.0, 8.0]]])
    run = wallkit.simulate(wallkit.Scene(box, wallkit.Balls([4.0, 4.0], [-1.0, -1.0])), until=5.0)
    assert run.velocity(4.5).tolist() == [[1.0, 1.0]]
    assert run.ending == (wallkit.Ending.TIME_REACHED,)


def test_a_point_in_a_corner_without_a_limit_says_so():
    tip = math.radians(50.0)
    walls = wallkit.Walls.from_polylines(
        [[[8.0, 0.0], [0.0, 0.0], [8.0 * math.cos(tip), 8.0 * math.sin(tip)]]], closed=False
    )
    aim = np.array([4.0, 2.0])
    run = wallkit.simulate(wallkit.Scene(walls, wallkit.Balls(aim, -aim)), until=5.0)
    assert run.ending == (wallkit.Ending.AMBIGUOUS_CORNER,)


def test_a_duplicate_wall_changes_nothing():
    box = np.array([[0.0, 0.0], [40.0, 0.0], [40.0, 30.0], [0.0, 30.0]])
    balls = wallkit.Balls([[11.0, 7.0]], [[3.0, 4.0]])
    once = wallkit.simulate(wallkit.Scene(wallkit.Walls.from_polylines([box]), balls), bounces=300).contacts
    twice = wallkit.simulate(wallkit.Scene(wallkit.Walls.from_polylines([box, box[::-1]]), balls), bounces=300).contacts
    np.testing.assert_array_equal(once["x"], twice["x"])
    np.testing.assert_array_equal(once["vx"], twice["vx"])


@pytest.mark.parametrize("radius", [0.0, 4.0])
@pytest.mark.parametrize("limits", [{"until": 9.0}, {"bounces": 60}, {"until": 30.0, "bounces": 40}])
def test_balls_in_step_have_the_bits_of_balls_alone(radius, limits):
    rng = np.random.default_rng(31)
    polygon = random_polygon(rng, 11, ragged=0.4)
    position, velocity = inside_balls(rng, polygon, 700, radius)
    corner = polygon[rng.integers(0, 11, 300)]
    velocity[:300] = corner - position[:300]  # exact corners too
    scene = wallkit.Scene(wallkit.Walls.from_polylines([polygon]), wallkit.Balls(position, velocity, radius))
    many = wallkit.survey(scene, **limits)
    run = wallkit.simulate(scene, **limits)
    np.testing.assert_array_equal(many.bounces, run.bounces)
    np.testing.assert_array_equal(many.position[:, 0], run.final["x"])
    np.testing.assert_array_equal(many.velocity[:, 1], run.final["vy"])
    np.testing.assert_array_equal(many.time, run.final["time"])
    assert many.ending.tolist() == list(run.ending)
    assert many.hits.sum() == len(run.contacts)
