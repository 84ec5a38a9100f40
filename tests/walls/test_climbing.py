"""Summits of the distance to the nearest wall, and what hangs together, beside closed forms and shapely."""

import numpy as np
import pytest
import shapely

from wallkit.geometry.components import components
from wallkit.geometry.same_points import SAME, merged
from wallkit.geometry.triangulation import triangulate
from wallkit.walls.checking import climbing
from wallkit.walls.checking.climbing import Segments, climb
from wallkit.walls.checking.narrow_places import with_feet
from wallkit.walls.checking.wall_distance import wall_distance

SQUARE = np.array([(0.0, 0.0), (10.0, 0.0), (10.0, 10.0), (0.0, 10.0)])


def around(count, radius, x=0.0, y=0.0):
    angle = np.arange(count) * 2 * np.pi / count
    return np.stack([x + radius * np.cos(angle), y + radius * np.sin(angle)], axis=1)


def segments(*rings):
    return Segments.of(np.concatenate(rings), np.concatenate([np.roll(ring, -1, axis=0) for ring in rings]))


def test_a_disc_in_the_corner_of_a_square_ring_touches_two_sides_and_the_inner_corner():
    places, radii = climb(segments(SQUARE, 0.8 * SQUARE + 1), np.array([(0.5, 0.5), (9.6, 0.6), (5.0, 6.0)]))
    r = 2**0.5 / (1 + 2**0.5)
    assert radii == pytest.approx([r, r, 4], rel=1e-8)
    assert places == pytest.approx(np.array([(r, r), (10 - r, r), (5, 5)]), rel=1e-7)


def test_every_climb_ends_on_a_summit_and_the_highest_is_shapelys():
    rings = [around(400, 10.0), around(100, 1.0, 3, 2), around(90, 1.5, -3, 2), around(50, 2.0, 0, -5)]
    walls = segments(*rings)
    starts = np.random.default_rng(0).uniform(-6, 6, (200, 2))
    lines = shapely.multilinestrings([shapely.linearrings(ring) for ring in rings])
    free = shapely.Polygon(rings[0], rings[1:])
    starts = starts[shapely.contains_xy(free, starts)]
    before = shapely.distance(shapely.points(starts), lines)
    places, radii = climb(walls, starts)
    assert radii == pytest.approx(shapely.distance(shapely.points(places), lines), rel=1e-12)
    assert (radii >= before).all()
    assert shapely.contains_xy(free, places).all()  # no step leads through a wall
    assert radii.max() == pytest.approx(
        shapely.length(shapely.maximum_inscribed_circle(free, tolerance=1e-8)), rel=1e-8
    )
    beside = places[:, None] + 1e-3 * around(64, 1.0) * radii[:, None, None]
    higher = shapely.distance(shapely.points(beside), lines).max(axis=1)
    assert (higher <= radii * (1 + 1e-6)).all()


def test_climbs_are_the_same_however_many_climb_together(monkeypatch):
    walls = segments(around(40, 10.0), around(10, 1.0, 3, 2), around(9, 1.5, -3, 2))
    starts = np.random.default_rng(1).uniform(-6, 6, (20, 2))
    together = climb(walls, starts)
    monkeypatch.setattr(climbing, "_AT_ONCE", 3)
    for one, other in zip(climb(walls, starts), together, strict=True):
        assert np.array_equal(one, other)
    assert [len(part) for part in climb(walls, np.empty((0, 2)))] == [0, 0]


@pytest.mark.parametrize("seed", range(5))
def test_components_are_those_of_a_walk(seed):
    rng = np.random.default_rng(seed)
    one, two = rng.integers(0, 200, (2, 120))
    least = list(range(200))
    while True:
        again = list(least)
        for a, b in zip(one.tolist(), two.tolist(), strict=True):
            again[a] = again[b] = min(again[a], again[b])
        if again == least:
            break
        least = again
    assert components(one, two, 200).tolist() == least


def test_points_as_near_as_rounding_are_one_and_chains_of_such():
    """Beside all pairs, one by one: a lattice of steps just below and just above what is near."""
    rng = np.random.default_rng(2)
    steps = rng.choice([0.0, 0.6, 0.9, 1.1], (150, 2)).cumsum(axis=0)
    points = np.concatenate([[(0.0, 0.0), (1.0, 1.0)], 0.5 + steps * SAME * 2**0.5])
    points = points[rng.permutation(len(points))]
    near = np.hypot(*(points[:, None] - points[None, :]).transpose(2, 0, 1)) <= SAME * 2**0.5
    one, two = np.nonzero(near)
    assert merged(points).tolist() == components(one, two, len(points)).tolist()


@pytest.mark.parametrize("seed", range(6))
def test_the_distance_from_the_nearest_wall_is_shapelys(seed):
    """Of middles of triangles, of edges and of circles, among rings and sticks."""
    random = np.random.default_rng(seed)
    middle = random.uniform(0, 1000, (80, 2))
    a, b = middle + random.normal(0, 25, (2, 80, 2))
    lines = shapely.linestrings(np.stack([a, b], axis=1))
    apart = [k for k in range(80) if not shapely.intersects(lines[k], lines[:k]).any()]
    ring = around(40, 700.0, 500, 500)
    mesh = triangulate(np.concatenate([a[apart], ring]), np.concatenate([b[apart], np.roll(ring, -1, axis=0)]))
    assert mesh is not None
    mesh = with_feet(mesh)
    inner = np.flatnonzero((mesh.corners < len(mesh.points) - 4).all(axis=1))
    corners = mesh.points[mesh.corners[inner]]
    walls = shapely.multilinestrings(shapely.linestrings(mesh.points[mesh.ends[mesh.wall]]))
    for weights in ((1 / 3, 1 / 3, 1 / 3), (0.5, 0.5, 0.0), (0.0, 0.5, 0.5), (0.1, 0.2, 0.7)):
        places = (corners * np.array(weights)[:, None]).sum(axis=1)
        assert wall_distance(mesh, inner, places) == pytest.approx(
            shapely.distance(shapely.points(places), walls), rel=1e-9, abs=1e-10
        )
