"""Gaps and rooms: widths known from the drawing, connectedness against shapely's erosion."""

from __future__ import annotations

import math

import numpy as np
import pytest
import shapely
from drawn import circle, drawing, line, path, polygon, square
from hypothesis import example, given, settings
from hypothesis import strategies as st

from wallkit.walls import Walls
from wallkit.walls.checking.free_space import eroded, free_space
from wallkit.walls.checking.leaks import leak_problems, reach_of
from wallkit.walls.importing.pipeline import import_walls

ROOM_WITH_GAP = [(0, 30), (0, 0), (100, 0), (100, 60), (0, 60), (0, 30.5)]
CUP = [
    (0, 0), (100, 0), (100, 49), (90, 49), (90, 10), (10, 10),
    (10, 90), (90, 90), (90, 51), (100, 51), (100, 100), (0, 100),
]  # fmt: skip
TWO_ROOMS = [
    (0, 0), (0, 40), (40, 40), (40, 22), (60, 22), (60, 40), (100, 40),
    (100, 0), (60, 0), (60, 18), (40, 18), (40, 0),
]  # fmt: skip


def reach(space, walls, radius, *starts):
    return reach_of(space, walls, radius, np.array(starts, dtype=float).reshape(-1, 2))


def test_a_hidden_gap_of_a_half_leaks_just_below_a_quarter_and_not_just_above():
    walls = Walls.from_polylines([ROOM_WITH_GAP], closed=False)
    space = free_space(walls)
    (gap,) = space.gaps
    assert gap.width == 0.5
    assert {gap.a, gap.b} == {(0, 30), (0, 30.5)}
    assert [len(space.leaks(radius)) for radius in (0, 0.1, 0.2499, 0.2501, 1)] == [1, 1, 1, 0, 0]
    assert [problem.code for problem in leak_problems(space, reach(space, walls, 0.2499))] == ["leak"]
    assert leak_problems(space, reach(space, walls, 0.2501)) == []


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


def random_sticks(seed):
    rng = np.random.default_rng(seed)
    sticks = [np.array([p, p + rng.normal(0, 8, 2)]) for p in rng.uniform(0, 20, (12, 2))]
    return Walls.from_polylines(sticks, closed=False)


def eroded_outside(walls, radius):
    return max(eroded(walls, radius), key=lambda part: shapely.box(*part.bounds).area)


@settings(max_examples=40)
@given(st.integers(0, 10_000), st.floats(0.05, 3))
@example(3537, 2.375).via("a tip faces a wall behind the edge between two others, and is nearer to it than to both")
def test_what_is_connected_agrees_with_shapelys_erosion(seed, radius):
    """Random sticks: rooms that a disc can leave are in the eroded part that is outside, and only those."""
    walls = random_sticks(seed)
    outside = eroded_outside(walls, radius)
    for gap in free_space(walls, narrow=1e9).gaps:
        # the erosion's corners are off by 1e-4 radii; leave alone what hangs on that
        if gap.room_radius < radius * 1.01 or abs(gap.escape - 2 * radius) < 0.01 * radius:
            continue
        assert outside.contains(shapely.Point(gap.room)) == (gap.escape > 2 * radius)


@settings(max_examples=10)
@given(st.integers(0, 10_000))
@example(174).via("a foot where the triangulation itself had cut the wall")
@example(206).via("feet nearly on one line, of which GEOS makes triangles that are none of Delaunay's")
def test_a_disc_just_narrower_than_the_escape_gets_out_and_one_just_wider_does_not(seed):
    walls = random_sticks(seed)
    for gap in free_space(walls, narrow=1e9).gaps:
        for radius in (0.4985 * gap.escape, 0.5015 * gap.escape):
            if 0.05 < radius < gap.room_radius / 1.003:
                assert eroded_outside(walls, radius).contains(shapely.Point(gap.room)) == (2 * radius < gap.escape)


def as_walls(*lines, closed=False):
    return Walls.from_polylines([np.array(points, dtype=float) for points in lines], closed)


@settings(max_examples=40)
@given(st.floats(0.001, 20), st.floats(0, 2 * math.pi), st.floats(-1000, 1000), st.floats(0.1, 0.9))
def test_a_gap_has_its_width_wherever_it_is(width, angle, shift, place):
    low = place * (260 - width) + 30
    room = np.array([(390, low + width), (390, 290), (30, 290), (30, 30), (390, 30), (390, low)])
    turn = np.array([[math.cos(angle), math.sin(angle)], [-math.sin(angle), math.cos(angle)]])
    (gap,) = free_space(as_walls(room @ turn + shift)).gaps
    # coordinates up to 1500 are rounded to 2e-13
    assert gap.width == pytest.approx(width, abs=1e-12, rel=1e-12)


@pytest.mark.parametrize("curves", ["lines", "arcs"])
def test_a_gap_between_two_round_pillars_is_between_the_arcs_themselves(curves):
    """A corridor into a chamber, whose mouth two pillars narrow to 0.37."""
    chamber = [(0, 20), (0, 100), (-100, 100), (-100, -100), (0, -100), (0, -20)]
    pillars = [circle(0, y, 20 - 0.185) for y in (20, -20)]
    outline = path(line(*chamber[:1], *chamber[1:]))
    found = free_space(import_walls(drawing(outline, *(path(p) for p in pillars)), curves=curves, tolerance=0.05))
    gap = next(gap for gap in found.gaps if gap.outside)
    # lines are within the tolerance on either side; arcs are exact
    assert gap.width == pytest.approx(0.37, abs=0.1 if curves == "lines" else 1e-9)


def test_a_room_of_a_single_outline_is_its_inside():
    found = free_space(import_walls(drawing(path(square(0, 0, 10)))))
    assert found.closed_rooms == pytest.approx(np.array([[5, 5, 5]]))


def test_inside_material_is_no_room_unless_the_outline_is_one():
    squares = drawing(path(square(0, 0, 100)), path(square(30, 30, 40)))
    (hole,) = free_space(import_walls(squares)).closed_rooms
    assert hole == pytest.approx([50, 50, 20])
    (ring,) = free_space(import_walls(squares, arena=True)).closed_rooms
    # a square ring 30 wide: a disc in its corner touches two sides and the inner corner, r (1 + sqrt 2) = 30 sqrt 2
    assert ring[2] == pytest.approx(30 * math.sqrt(2) / (1 + math.sqrt(2)), rel=1e-6)


def test_free_space_of_given_polylines_follows_their_winding():
    """A clockwise room with a counter-clockwise island: free is what is between."""
    room, island = [(0, 0), (0, 20), (30, 20), (30, 0)], [(12, 8), (18, 8), (18, 12), (12, 12)]
    (around,) = free_space(as_walls(room, island, closed=True)).closed_rooms
    # in a corner a disc touches two sides and the island's corner: (12 - r)^2 + (8 - r)^2 = r^2
    assert around[2] == pytest.approx(20 - math.sqrt(192), rel=1e-6)
    (inner,) = free_space(as_walls(room[::-1], island[::-1], closed=True)).closed_rooms
    assert inner == pytest.approx([15, 10, 2], rel=1e-6)


@settings(max_examples=30)
@given(st.integers(0, 10_000))
@example(3717).via("the summit is above a triangle that is no roomy one itself")
def test_the_largest_circle_of_a_closed_room_is_shapelys(seed):
    """Random pillars in a room; both searches end within 1e-6 of the room's size."""
    rng = np.random.default_rng(seed)
    pillars = [shapely.Point(*rng.uniform(10, 90, 2)).buffer(rng.uniform(2, 9), quad_segs=3) for _ in range(6)]
    area = shapely.box(0, 0, 100, 100).difference(shapely.union_all(pillars))
    if area.geom_type != "Polygon":
        return
    rings = [area.exterior, *area.interiors]
    outlines = [np.array(ring.coords)[:-1] for ring in rings]
    ways = [ring.is_ccw for ring in rings]
    outlines = [o[::-1] if ccw == (i == 0) else o for i, (o, ccw) in enumerate(zip(outlines, ways, strict=True))]
    space = free_space(as_walls(*outlines, closed=True))
    largest = max([*space.closed_rooms[:, 2], *(gap.room_radius for gap in space.gaps)])
    assert largest == pytest.approx(shapely.maximum_inscribed_circle(area, tolerance=1e-5).length, abs=2e-4)


def test_the_largest_circle_may_bulge_through_the_door():
    """Beside a door of 10 between posts: x - 10 = r, (195 - x)^2 + 5^2 = r^2."""
    room = [(0, 0), (0, 300), (400, 300), (400, 0)]
    posts = [[(195, -1), (205, -1), (205, 140), (195, 140)], [(195, 150), (205, 150), (205, 301), (195, 301)]]
    space = free_space(
        import_walls(drawing(path(polygon(*room)), *(path(polygon(*post)) for post in posts)), arena=True)
    )
    (gap,) = space.gaps
    assert gap.width == 10
    assert gap.room_radius == pytest.approx((195**2 + 25) / (2 * 195), rel=1e-6)
    assert len(space.unreachable(20)) == 1


def test_an_eroded_square_is_the_smaller_square():
    walls = as_walls(square_points := [(0, 0), (10, 0), (10, 10), (0, 10)], closed=True)
    inside = [part for part in eroded(walls, 1) if part.within(shapely.Polygon(square_points))]
    # straight sides are exact up to the factor 1 / cos(pi / 256) that keeps round corners on the safe side
    assert [part.area for part in inside] == pytest.approx([64], rel=1e-4)


def test_no_walls_a_point_and_a_single_line_have_no_rooms():
    for walls in (as_walls(), as_walls([(3, 4), (3, 4)], closed=True), as_walls([(0, 0), (1, 1)])):
        found = free_space(walls)
        assert found.gaps == []
        assert not len(found.closed_rooms)
        assert found.complete


def test_a_polygon_of_many_edges_in_another_is_one_room():
    t = np.linspace(0, 2 * math.pi, 2000, endpoint=False)
    r = 100 + 5 * np.sin(9 * t)
    outline = np.stack([r * np.cos(t), r * np.sin(t)], axis=1)
    found = free_space(as_walls(outline[::-1], outline / 2, closed=True))
    assert len(found.closed_rooms) == 1
    assert found.complete
    assert not found.gaps


def test_islands_whose_edges_touch_do_not_hang_the_search():
    walls = import_walls(drawing(*(path(polygon((k, 0), (k + 1, 0), (k, 1))) for k in range(30))))
    assert free_space(walls).complete


def test_a_ball_in_the_smaller_room_is_shut_in_and_one_in_the_larger_is_shut_out():
    """A door of 4 between rooms of 40 and 30 by 40."""
    house = [
        (0, 0),
        (0, 40),
        (40, 40),
        (40, 22),
        (45, 22),
        (45, 40),
        (75, 40),
        (75, 0),
        (45, 0),
        (45, 18),
        (40, 18),
        (40, 0),
    ]
    walls = import_walls(drawing(path(polygon(*house))), arena=True)
    space = free_space(walls)
    codes = [
        [problem.code for problem in leak_problems(space, reach(space, walls, radius, start))]
        for radius, start in ((2.1, (20, 20)), (2.1, (60, 20)), (1.9, (20, 20)))
    ]
    assert codes == [["unreachable"], ["shut-in"], []]


def test_a_room_whose_outline_closes_with_an_edge_as_short_as_rounding_is_a_room():
    """Relative coordinates with few digits miss the first point by a little, and `z` closes that with a short edge."""
    corners = [(300 * math.cos(k * math.tau / 40), 200 * math.sin(k * math.tau / 40)) for k in range(40)]
    corners.append((300.0 - 1.6e-4, 0.0))
    space = free_space(import_walls(drawing(path(polygon(*corners)), path(square(-100, -20, 60))), arena=True))
    free = shapely.difference(shapely.Polygon(corners), shapely.box(-100, -20, -40, 40))
    largest = shapely.length(shapely.maximum_inscribed_circle(free, tolerance=0.01))
    assert space.gaps == []
    # Without the room the block's own inside would be all that there is, of radius 30.
    assert max(r for _, _, r in space.closed_rooms.tolist()) == pytest.approx(largest, rel=2e-3)


@pytest.mark.parametrize("seed", range(40))
def test_a_wall_that_ends_on_a_slanted_one_parts_the_room(seed):
    """Its end is on the line to rounding alone, on this side or on that: no ball gets through between them.

    Both rooms are as high as the whole: their largest circles have half its height, or half their width.
    """
    random = np.random.default_rng(seed)
    turn, place = random.random() * 2 * np.pi, random.random(2) * 50
    around = np.array([[np.cos(turn), np.sin(turn)], [-np.sin(turn), np.cos(turn)]])
    ring = np.array([(0, 0), (20, 0), (20, 10), (0, 10)]) @ around + place
    part = random.uniform(0.2, 0.8)
    stem = np.array([ring[0] + (ring[1] - ring[0]) * part, ring[3] + (ring[2] - ring[3]) * part])
    space = free_space(Walls.from_polylines([ring, stem], closed=[True, False]))
    expected = sorted(min(5.0, 10 * part) for part in (part, 1 - part))
    assert (space.complete, space.gaps) == (True, [])
    assert sorted(space.closed_rooms[:, 2].tolist()) == pytest.approx(expected, rel=1e-8)


@pytest.mark.parametrize("seed", range(5))
def test_closed_rooms_come_the_roomiest_first_then_from_left_to_right_and_up(seed):
    """In whatever order walls are drawn and whichever way round: slanted squares that share edges, two of them cut."""
    random = np.random.default_rng(seed)
    turned = np.array([[math.cos(0.3), math.sin(0.3)], [-math.sin(0.3), math.cos(0.3)]])
    square = np.array([(0, 0), (1, 0), (1, 1), (0, 1), (0, 0)])
    cells = [30.0 * (square + np.array([i, j])) @ turned for i in (0, 1, 2) for j in (0, 1)]
    whole = [cell[:4].mean(axis=0).tolist() for cell in cells[1:-1]]
    walls = [*cells, cells[0][[0, 2]], cells[-1][[0, 2]]]
    drawn = [walls[k][:: random.choice([-1, 1])] for k in random.permutation(len(walls))]
    rooms = free_space(Walls.from_polylines(drawn, closed=False)).closed_rooms
    assert rooms[:, 2] == pytest.approx([15.0] * 4 + [30 - 15 * math.sqrt(2)] * 4, rel=1e-7)
    assert rooms[:4, :2] == pytest.approx(np.array(sorted(whole)), abs=1e-4)
    assert rooms[4:, 0].tolist() == sorted(rooms[4:, 0].tolist())
