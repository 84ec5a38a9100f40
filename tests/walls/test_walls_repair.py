"""Repair: damaged drawings give the material of the sound ones, with normals away from it; twice is as once."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest
import shapely
from drawn import circle, codes, drawing, line, path, polygon, square
from hypothesis import given, settings
from hypothesis import strategies as st

from wallkit.walls import Walls
from wallkit.walls.checking.widths import is_thin
from wallkit.walls.importing.pipeline import import_walls
from wallkit.walls.repairing.passes import repair
from wallkit.walls.repairing.repairs import Repairs
from wallkit.walls.walls import WallsError

EVERYTHING = Repairs(
    snap=0.05, join=True, drop_duplicates=True, resolve=True, union=True, min_width=0.01, simplify=1e-6
)


def star(rng, x, y, size):
    """A ring without crossings: rising angles, radii between half and all of the size."""
    count = int(rng.integers(5, 12))
    angle = (np.arange(count) + rng.uniform(0.3, 0.7, count)) * 2 * math.pi / count
    radius = size * rng.uniform(0.6, 1, count)
    return np.stack([x + radius * np.cos(angle), y + radius * np.sin(angle)], axis=1)


def nested_rings(rng):
    """Stars in stars, and stars beside stars: (ring, depth)."""
    rings = []
    for column in range(int(rng.integers(1, 4))):
        size = 10.0
        for depth in range(int(rng.integers(1, 5))):
            rings.append((star(rng, 30 * column, 0, size), depth))
            size *= 0.25  # corners are at most 101 degrees apart: the ring before stays 0.6 cos 50.4 = 0.38 away
    return rings


def damaged(rng, ring):
    """The same ring as drawings have it: turned, started elsewhere, cut open by a hair, drawn twice."""
    ring = np.roll(ring, int(rng.integers(len(ring))), axis=0)
    if rng.random() < 0.5:
        ring = ring[::-1]
    kind = rng.choice(["closed", "back", "gap", "pieces", "twice"])
    if kind == "closed":
        return [polygon(*ring.tolist())]
    if kind == "twice":
        return [polygon(*ring.tolist()), polygon(*np.roll(ring, 1, axis=0)[::-1].tolist())]
    whole = np.concatenate([ring, ring[:1]])
    if kind == "back":
        return [line(*whole.tolist())]
    if kind == "gap":
        whole[-1] += rng.uniform(-0.02, 0.02, 2)
        return [line(*whole.tolist())]
    half = len(whole) // 2
    first, second = whole[: half + 1].copy(), whole[half:].copy()
    second[0] += rng.uniform(-0.02, 0.02, 2)
    return [line(*first.tolist()), line(*second[::-1].tolist())]


def material(walls):
    return walls.to_shapely().geoms[0]


def assert_normals_leave_the_material(walls, shape, step):
    start, stop = walls.vertices[walls.edge_starts], walls.vertices[walls.edge_ends]
    middle = (start + stop) / 2
    long_enough = np.hypot(*(stop - start).T) > 20 * step
    outside = shapely.points(middle + step * walls.normals)[long_enough]
    inside = shapely.points(middle - step * walls.normals)[long_enough]
    assert not shapely.contains(shape, outside).any()
    assert shapely.contains(shape, inside).all()


@settings(max_examples=60)
@given(st.integers(0, 100_000))
def test_damaged_drawings_give_the_same_material(seed):
    rng = np.random.default_rng(seed)
    rings = nested_rings(rng)
    sound = shapely.MultiPolygon()
    for ring, depth in sorted(rings, key=lambda pair: pair[1]):
        sound = sound.union(shapely.Polygon(ring)) if depth % 2 == 0 else sound.difference(shapely.Polygon(ring))
    subpaths = [subpath for ring, _ in rings for subpath in damaged(rng, ring)]
    order = rng.permutation(len(subpaths))
    walls = import_walls(drawing(*(path(subpaths[i]) for i in order)), tolerance=1e-3, repairs=EVERYTHING)
    assert walls.closed.all()
    assert [problem for problem in walls.problems if problem.severity != "info"] == []
    shape = material(walls)
    # ends move by at most the snap of 0.05 along lines that were drawn, and were off by at most 0.02 sqrt 2
    assert shape.symmetric_difference(sound).area <= 0.05 * sound.length
    assert shape.boundary.hausdorff_distance(sound.boundary) <= 0.05 + 0.02 * math.sqrt(2)
    assert_normals_leave_the_material(walls, shape, 1e-5)
    again = repair(walls, EVERYTHING)
    assert again.changes == []
    assert again.violations == []
    assert again.walls == walls


@settings(max_examples=60)
@given(st.integers(0, 100_000))
def test_overlapping_solids_are_united_as_shapely_unites_them(seed):
    rng = np.random.default_rng(seed)
    rings = [star(rng, *rng.uniform(0, 12, 2), 5.0) for _ in range(int(rng.integers(2, 7)))]
    apart = [shapely.Polygon(ring) for ring in rings]
    if any(a.contains(b) for a in apart for b in apart if a is not b):
        return  # then one is a hole of the other, not a solid
    walls = import_walls(drawing(*(path(polygon(*ring.tolist())) for ring in rings)), repairs=Repairs(union=True))
    whole = shapely.union_all(apart)
    assert material(walls).symmetric_difference(whole).area < 1e-9
    assert_normals_leave_the_material(walls, whole, 1e-7)
    assert repair(walls, Repairs(union=True)).changes == []


def test_snapping_says_how_far_it_moved():
    ring = [(0, 30), (0, 0), (100, 0), (100, 60), (0, 60), (0, 30.5)]
    done = repair(Walls.from_polylines([ring], closed=False), Repairs(snap=0.5))
    assert done.walls.closed.all()
    assert [(change.step, change.moved) for change in done.changes] == [("snap", 0.25), ("join", 0)]
    assert repair(Walls.from_polylines([ring], closed=False), Repairs(snap=0.4999)).changes == []


def test_an_end_snaps_onto_the_middle_of_a_wall():
    walls = Walls.from_polylines([[(0, 0), (10, 0)], [(5, 0.2), (5, 8)]], closed=False)
    done = repair(walls, Repairs(snap=0.3))
    assert done.walls.vertices.tolist() == [[0, 0], [10, 0], [5, 0], [5, 8]]
    assert repair(done.walls, Repairs(snap=0.3)).changes == []


def test_an_end_that_was_snapped_onto_a_slanted_wall_is_no_gap_any_more():
    walls = Walls.from_polylines([[(0, 0), (10, 3.3)], [(5.1, 1.8), (4, 8)]], closed=False)
    done = repair(walls, Repairs(snap=0.3))
    assert [change.step for change in done.changes] == ["snap"]
    assert "gap" not in [problem.code for problem in done.violations]
    assert repair(done.walls, Repairs(snap=0.3)).changes == []


def test_four_lines_that_meet_become_a_room():
    sides = [line((0, 0), (9, 0)), line((9, 5), (9, 0)), line((9, 5), (0, 5)), line((0, 0), (0, 5))]
    walls = import_walls(drawing(*(path(side) for side in sides)), repairs=Repairs(join=True), arena=True)
    assert walls.closed.tolist() == [True]
    assert len(walls.vertices) == 4
    assert "open-path" not in codes(walls)


def test_arcs_stay_arcs_when_joined_and_turned():
    half = [("M", 1, 0), ("A", 1, 1, 0, 0, 1, -1, 0)], False
    other = [("M", 1, 0), ("A", 1, 1, 0, 0, 0, -1, 0)], False
    walls = import_walls(drawing(path(half), path(other)), curves="arcs", repairs=Repairs(join=True))
    assert walls.bulges.tolist() == [1, 1]
    assert walls.to_shapely(1e-4).geoms[0].area == pytest.approx(math.pi, rel=1e-3)


@pytest.mark.parametrize("rule", ["nonzero", "evenodd"])
def test_a_five_pointed_star_by_its_fill_rule(rule):
    """Areas of the pentagram of circumradius 1: with and without its pentagon."""
    corners = [(math.cos(0.8 * math.pi * k), math.sin(0.8 * math.pi * k)) for k in range(5)]
    star_path = path(polygon(*corners), fill="#000000", fill_rule=rule)
    walls = import_walls(drawing(star_path), repairs=Repairs(resolve=True))
    pentagon = 5 / 2 * math.sin(math.radians(72)) * ((3 - math.sqrt(5)) / 2) ** 2
    # ten triangles from the centre: tip radius 1, notch radius (3 - sqrt 5) / 2, 36 degrees between
    whole = 10 * math.sin(math.radians(36)) * (3 - math.sqrt(5)) / 2 / 2
    assert material(walls).area == pytest.approx(whole if rule == "nonzero" else whole - pentagon, rel=1e-9)
    assert "self-crossing" not in codes(walls)


def test_duplicates_go_and_near_ones_stay():
    walls = import_walls(
        drawing(path(square(0, 0, 5)), path(square(0, 0, 5)), path(square(0, 0, 5.001)), path(line((0, 0), (5, 0)))),
        repairs=Repairs(drop_duplicates=True),
    )
    assert len(walls) == 2


def test_circles_over_the_same_chord_are_no_duplicates():
    thin = [("M", 0, 0), ("A", 5, 5, 0, 0, 1, 8, 0), ("A", 5, 5, 0, 0, 1, 0, 0)], True
    thick = [("M", 0, 0), ("A", 4, 4, 0, 0, 1, 8, 0), ("A", 4, 4, 0, 0, 1, 0, 0)], True
    d = drawing(path(thin), path(thick), path(thick))
    walls = import_walls(d, curves="arcs", repairs=Repairs(drop_duplicates=True))
    assert len(walls) == 2


@pytest.mark.parametrize(("width", "left"), [(0.099, 2), (0.101, 1)])
def test_slivers_go_by_the_disc_that_fits(width, left):
    strip = polygon((0, 0), (50, 0), (50, 0.1), (0, 0.1))
    d = drawing(path(strip), path(circle(0, 30, 3)))
    assert len(import_walls(d, tolerance=1e-3, repairs=Repairs(min_width=width))) == left


BOW_TIE = [(0, 0), (60, 60), (60, 0), (0, 60)]  # two triangles of 900, turned opposite ways: signed area 0
SPIKE = [(0, 0), (3, 0), (3, 3), (1.51, 3), (1.5, 40_000), (1.49, 3), (0, 3)]  # 3 wide, but 2 A / P = 0.005


@pytest.mark.parametrize("ring", [BOW_TIE, SPIKE])
def test_a_wide_ring_is_no_sliver_whatever_its_signed_area_and_perimeter(ring):
    walls = import_walls(drawing(path(polygon(*ring))), tolerance=0.1)
    assert "sliver" not in codes(walls)
    assert len(import_walls(drawing(path(polygon(*ring))), tolerance=0.1, repairs=Repairs(min_width=0.1))) == 1


@pytest.mark.parametrize(
    "ring",
    [
        [(0, 0), (50, 0), (50, 0.01), (0, 0.01)],
        [(0, 0), (50, 0), (20, 0)],
        [(0, 0), (50, 0.01), (50, 0), (0, 0.01)],
    ],
)
def test_the_fix_that_a_sliver_proposes_removes_it(ring):
    d = drawing(path(polygon(*ring)), path(square(0, 10, 30)))
    (problem,) = (p for p in import_walls(d, tolerance=0.1).problems if p.code == "sliver")
    option, width = problem.fix.rstrip(")").split()[-2:]
    assert option == "(--min-width"
    assert float(width) > Repairs().min_width
    walls = import_walls(d, tolerance=0.1, repairs=Repairs(min_width=float(width)))
    assert len(walls) == 1
    assert "sliver" not in codes(walls)


@settings(max_examples=60)
@given(st.integers(0, 10_000), st.floats(0.01, 8))
def test_a_ring_is_thin_where_shapely_leaves_nothing_of_it(seed, diameter):
    """Against the union of the faces with winding other than 0, built by shapely's buffer of one piece at a time."""
    rng = np.random.default_rng(seed)
    ring = rng.uniform(0, 10, (int(rng.integers(3, 9)), 2))
    fan = [shapely.Polygon([ring[0], p, q]) for p, q in itertools.pairwise(ring[1:])]
    # the winding number is the sum over the triangles of a fan, each with its sign
    closed = shapely.LineString([*ring, ring[0]])
    faces = shapely.get_parts(shapely.polygonize([shapely.node(closed)]))
    inside = [
        face
        for face in faces
        if sum((1 if t.exterior.is_ccw else -1) * t.contains(face.representative_point()) for t in fan)
    ]
    left = shapely.union_all(inside).buffer(-diameter / 2)
    assert is_thin(ring, diameter) == left.is_empty


def test_simplify_stays_within_its_distance_and_keeps_the_corners():
    angle = np.linspace(0, 2 * math.pi, 1000, endpoint=False)
    ring = np.stack([np.cos(angle), np.sin(angle)], axis=1) * 10
    done = repair(Walls.from_polylines([ring]), Repairs(simplify=0.01))
    assert len(done.walls.vertices) < 200
    assert done.changes[0].moved <= 0.01
    assert done.walls.measured_error == done.changes[0].moved
    assert repair(done.walls, Repairs(simplify=0.01)).changes == []


def test_a_stroke_becomes_what_it_paints():
    stroked = path(line((0, 0), (10, 0), (10, 10)), stroke="#000000", stroke_width=2.0)
    walls = import_walls(drawing(stroked), outline_strokes=True)
    # two bars of 10 x 2, mitred: they overlap in 1 x 1 and the corner adds 1 x 1
    assert material(walls).area == pytest.approx(2 * 20)
    assert codes(walls) == ["outlined-stroke"]


def test_a_stroked_ring_becomes_a_ring_with_a_hole():
    walls = import_walls(drawing(path(square(0, 0, 10), stroke="#000000", stroke_width=2.0)), outline_strokes=True)
    assert walls.depth.tolist() == [0, 1]
    assert material(walls).area == pytest.approx(12 * 12 - 8 * 8)


@pytest.mark.parametrize("option", [{"snap": -1}, {"min_width": float("nan")}, {"simplify": float("inf")}])
def test_lengths_must_be_lengths(option):
    with pytest.raises(WallsError):
        Repairs(**option)


def test_nothing_asked_changes_nothing_and_keeps_every_bit():
    walls = import_walls(drawing(path(circle(0, 0, 5)), path(square(20, 0, 5))), curves="arcs")
    done = repair(walls, Repairs())
    assert done.walls == walls
    assert done.changes == []
