"""Gaps and rooms: widths known from the drawing, connectedness against shapely's erosion."""

from __future__ import annotations

import math

import numpy as np
import pytest
import shapely
from drawn import circle, drawing, path, polygon
from hypothesis import given, settings
from hypothesis import strategies as st

from wallkit.walls import Walls
from wallkit.walls.build import import_walls
from wallkit.walls.free_space import eroded, free_space
from wallkit.walls.leaks import leak_problems

ROOM_WITH_GAP = [(0, 30), (0, 0), (100, 0), (100, 60), (0, 60), (0, 30.5)]
CUP = [
    (0, 0), (100, 0), (100, 49), (90, 49), (90, 10), (10, 10),
    (10, 90), (90, 90), (90, 51), (100, 51), (100, 100), (0, 100),
]  # fmt: skip
TWO_ROOMS = [
    (0, 0), (0, 40), (40, 40), (40, 22), (60, 22), (60, 40), (100, 40),
    (100, 0), (60, 0), (60, 18), (40, 18), (40, 0),
]  # fmt: skip


def test_a_hidden_gap_of_a_half_leaks_just_below_a_quarter_and_not_just_above():
    space = free_space(Walls.from_polylines([ROOM_WITH_GAP], closed=False))
    (gap,) = space.gaps
    assert gap.width == 0.5
    assert {gap.a, gap.b} == {(0, 30), (0, 30.5)}
    assert [len(space.leaks(radius)) for radius in (0, 0.1, 0.2499, 0.2501, 1)] == [1, 1, 1, 0, 0]
    assert [problem.code for problem in leak_problems(space, 0.2499)] == ["leak"]
    assert leak_problems(space, 0.2501) == []


def test_the_way_through_the_leak_goes_from_the_room_to_the_outside():
    walls = Walls.from_polylines([ROOM_WITH_GAP], closed=False)
    (gap,) = free_space(walls).gaps
    room = shapely.box(0, 0, 100, 60)
    assert room.contains(shapely.Point(gap.path[0]))
    assert not room.contains(shapely.Point(gap.path[-1])) or gap.path[-1][0] == 0
    way, lines = shapely.LineString(gap.path), shapely.LineString(ROOM_WITH_GAP)
    assert way.disjoint(lines)


def test_a_closed_room_has_no_gap():
    walls = import_walls(drawing(path(polygon((0, 0), (100, 0), (100, 60), (0, 60)))), arena=True)
    space = free_space(walls)
    assert space.gaps == []
    assert space.closed_rooms[:, 2] == pytest.approx(30)


def test_a_solid_with_a_slit_leaks_and_its_material_is_no_room():
    space = free_space(import_walls(drawing(path(polygon(*CUP)))))
    assert [gap.width for gap in space.gaps] == [2]
    assert space.gaps[0].outside


def test_two_rooms_and_the_door_between():
    space = free_space(import_walls(drawing(path(polygon(*TWO_ROOMS))), arena=True))
    assert [gap.width for gap in space.gaps] == [4]
    assert not space.gaps[0].outside
    assert space.leaks(0.1) == []
    assert [len(space.unreachable(radius)) for radius in (1.99, 2.01)] == [0, 1]


def test_a_tip_against_the_middle_of_a_long_wall():
    """Width from a vertex to the inside of an edge, exact: 60 - 59.25 across a door of 0.75."""
    walls = Walls.from_polylines([[(0, 0), (100, 0), (100, 60), (0, 60), (0, 0)], [(50, 0), (50, 59.25)]], closed=False)
    widths = [gap.width for gap in free_space(walls).gaps]
    assert widths == [0.75]


@pytest.mark.parametrize("curves", ["lines", "arcs"])
def test_a_gap_between_circles_to_a_thousandth(curves):
    """Eight pillars in a ring: neighbours are 2 R sin(pi / 8) - 2 r apart."""
    far, r = 40.0, 15.0
    ring = [circle(far * math.cos(k * math.pi / 4), far * math.sin(k * math.pi / 4), r) for k in range(8)]
    walls = import_walls(drawing(*(path(pillar) for pillar in ring)), curves=curves, tolerance=1e-4)
    leak = free_space(walls).gaps[0]
    assert leak.width == pytest.approx(2 * far * math.sin(math.pi / 8) - 2 * r, rel=1e-3)


@settings(max_examples=40, deadline=None)
@given(st.integers(0, 10_000), st.floats(0.05, 3))
def test_what_is_connected_agrees_with_shapelys_erosion(seed, radius):
    """Random sticks: rooms that a disc can leave are in the eroded part that is outside, and only those."""
    rng = np.random.default_rng(seed)
    sticks = [np.array([p, p + rng.normal(0, 8, 2)]) for p in rng.uniform(0, 20, (12, 2))]
    walls = Walls.from_polylines(sticks, closed=False)
    space = free_space(walls, narrow=1e9)
    parts = eroded(walls, radius)
    outside = max(parts, key=lambda part: shapely.box(*part.bounds).area)
    for gap in space.gaps:
        spot = shapely.Point(gap.room)
        # the erosion's corners are off by 1e-4 radii; leave alone what hangs on that
        if gap.room_radius < radius * 1.01 or abs(gap.escape - 2 * radius) < 0.01 * radius:
            continue
        assert outside.contains(spot) == (gap.escape > 2 * radius)
