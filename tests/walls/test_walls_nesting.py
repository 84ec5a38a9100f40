"""Nesting, fill rules and contacts against shapely, on whole numbers where every kind of touching happens."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest
import shapely
from drawn import codes, drawing, path, polygon, square
from hypothesis import given, settings
from hypothesis import strategies as st
from shapely.geometry import Polygon

from wallkit.geometry.orientation import side, side_of
from wallkit.walls.crossings import find_touches
from wallkit.walls.edge_tree import Edges
from wallkit.walls.importing.pipeline import import_walls
from wallkit.walls.nesting import depths
from wallkit.walls.solid import walls_around


def edges_of(*rings, closed=True):
    vertices = np.concatenate([np.asarray(ring, dtype=float) for ring in rings])
    offsets = np.concatenate([[0], np.cumsum([len(ring) for ring in rings])])
    return Edges(vertices, offsets, np.full(len(rings), closed))


def rectangle(x, y, w, h):
    return [(x, y), (x + w, y), (x + w, y + h), (x, y + h)]


whole = st.integers(0, 6)
exact = st.floats(-1e6, 1e6).map(lambda x: round(x, 9))  # products of coordinates below 1e-150 would underflow
ring = st.lists(st.tuples(whole, whole), min_size=3, max_size=7, unique=True)


@settings(max_examples=150)
@given(ring, ring)
def test_two_rings_cross_exactly_when_neither_holds_the_other(p, q):
    one, two = Polygon(p), Polygon(q)
    if not (one.is_valid and two.is_valid):
        return
    shared = one.intersection(two).area
    partly = shared > 1e-9 and shared < min(one.area, two.area) - 1e-9  # areas of whole numbers are halves
    crossing = find_touches(edges_of(p, q)).crossing_walls
    assert (crossing[:, 0] != crossing[:, 1]).any() == partly


@settings(max_examples=100)
@given(ring)
def test_a_ring_without_any_contact_is_valid_and_no_valid_ring_crosses_itself(p):
    found = find_touches(edges_of(p))
    clean = not (len(found.crossing_walls) or len(found.overlap_edges) or len(found.touch_walls))
    if Polygon(p).area > 0:
        assert clean == Polygon(p).is_valid


@pytest.mark.parametrize(
    ("walls", "crossing"),
    [
        ([rectangle(0, 0, 4, 2), rectangle(2, 0, 4, 2)], True),  # through two shared edges
        ([rectangle(0, 0, 4, 4), rectangle(0, 1, 1, 1)], False),  # inside, along an edge
        ([rectangle(0, 0, 1, 1), rectangle(1, 0, 1, 1)], False),  # tiles
        ([rectangle(0, 0, 4, 4), [(2, 0), (4, 2), (2, 4), (0, 2)]], False),  # all four corners on edges
        ([[(0, 0), (2, 0), (4, 0), (2, 3)], [(2, 0), (3, -2), (2, 1)]], True),  # through a vertex
        ([[(0, 0), (1, 1), (2, 2), (2, 0), (1, 1), (0, 2)]], True),  # an eight through its own vertices
    ],
)
def test_crossing_or_only_touching(walls, crossing):
    assert bool(len(find_touches(edges_of(*walls)).crossing_walls)) == crossing


@settings(max_examples=100)
@given(st.lists(st.tuples(exact, exact), min_size=3, max_size=3), st.floats(0, 1))
def test_side_is_exact(points, part):
    a, b, c = points
    on = (a[0] + part * (b[0] - a[0]), a[1] + part * (b[1] - a[1]))  # nearly collinear: the hard case
    for p, q, r in ((a, b, c), (a, b, on), (on, a, b)):
        exact = [[Fraction(value) for value in point] for point in (p, q, r)]
        (ax, ay), (bx, by), (cx, cy) = exact
        det = (ax - cx) * (by - cy) - (ay - cy) * (bx - cx)
        sign = (det > 0) - (det < 0)
        assert side(*(np.array([point]) for point in (p, q, r)))[0] == sign == side_of(p, q, r)


boxes = st.tuples(st.integers(0, 8), st.integers(0, 8), st.integers(1, 9), st.integers(1, 9))


@settings(max_examples=60)
@given(st.lists(st.tuples(boxes, st.integers(0, 3), st.booleans(), st.booleans()), min_size=1, max_size=14))
def test_depth_counts_the_rings_around_touching_or_not_copies_once(choice):
    rings, shapes = [], []
    for box, roll, reverse, cut in choice:
        corners = rectangle(*box)[:3] if cut else rectangle(*box)
        shape = Polygon(corners)
        common = [(shape.intersection(other).area, min(shape.area, other.area)) for other in shapes]
        if all(area < 1e-9 or abs(area - least) < 1e-9 for area, least in common):
            turned = np.roll(corners, roll, axis=0)
            rings.append(turned[::-1] if reverse else turned)
            shapes.append(shape)
    different = [s for i, s in enumerate(shapes) if not any(s.equals(other) for other in shapes[:i])]
    expected = [sum(o.area > s.area + 1e-9 and o.buffer(1e-6).contains(s) for o in different) for s in shapes]
    assert depths(edges_of(*rings))[0].tolist() == expected


def test_rings_that_cross_are_not_around_one_another_but_around_what_both_hold():
    e = edges_of(rectangle(0, 0, 6, 6), rectangle(3, 3, 6, 6), rectangle(4, 4, 1, 1), rectangle(7, 7, 1, 1))
    depth, _ = depths(e, find_touches(e).crossing_walls)
    assert depth.tolist() == [0, 0, 2, 1]


def test_ten_thousand_rings_in_one_another():
    sizes = np.arange(1, 10_001)[:, None]
    corners = [np.concatenate([sx * sizes, sy * sizes], axis=1) for sx, sy in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
    e = edges_of(*np.stack(corners, axis=1) * 0.1)
    assert depths(e)[0].tolist() == list(range(9_999, -1, -1))


OUTER, INNER, INNERMOST = square(0, 0, 30), square(5, 5, 20), square(10, 10, 5)


def reverse(subpath):
    segments, closed = subpath
    points = [segment[1:] for segment in segments]
    return polygon(*reversed(points))[0], closed


@pytest.mark.parametrize(
    ("inner", "innermost", "rule", "area", "count"),
    [
        (reverse(INNER), INNERMOST, "nonzero", 900 - 400 + 25, 3),
        (INNER, INNERMOST, "nonzero", 900, 1),
        (INNER, reverse(INNERMOST), "nonzero", 900, 1),
        (reverse(INNER), reverse(INNERMOST), "nonzero", 900 - 400 + 25, 3),
        (INNER, INNERMOST, "evenodd", 900 - 400 + 25, 3),
        (reverse(INNER), reverse(INNERMOST), "evenodd", 900 - 400 + 25, 3),
    ],
)
def test_the_fill_rule_decides_inside_one_path(inner, innermost, rule, area, count):
    walls = import_walls(drawing(path(OUTER, inner, innermost, fill="#000000", fill_rule=rule)))
    assert len(walls) == count
    assert walls.to_shapely().geoms[0].area == area
    assert codes(walls) == ["inside-fill"] * (3 - count)


def test_stroked_outlines_count_as_the_ring_of_what_they_enclose():
    walls = import_walls(drawing(path(OUTER, stroke="#000000"), path(INNER, stroke="#000000")))
    assert walls.depth.tolist() == [0, 1]


@pytest.mark.parametrize(
    ("rings", "code"),
    [
        ([polygon((0, 0), (2, 2), (2, 0), (0, 2))], "self-crossing"),
        ([square(0, 0, 4), square(2, 2, 4)], "crossing"),
        ([square(0, 0, 4), reverse(square(0, 0, 4))], "duplicate-wall"),
        ([square(0, 0, 4), square(4, 1, 2)], "shared-edge"),
        ([polygon((0, 0), (4, 0), (4, 4), (4, 2), (0, 4))], "doubled-edge"),
        ([square(0, 0, 100), polygon((0, 200), (90, 200), (90, 200.01), (0, 200.01))], "sliver"),
        ([([("M", 0, 0), ("L", 50, 0), ("L", 50, 50), ("L", 0, 50), ("L", 0, 0.5)], False)], "gap"),
        ([([("M", 0, 0), ("L", 5, 0)], False), ([("M", 5, 0), ("L", 5, 5)], False)], "ends-meet"),
    ],
)
def test_every_violation_is_reported_with_its_place(rings, code):
    walls = import_walls(drawing(*(path(ring, line=7, layer="L") for ring in rings)))
    problem = next(problem for problem in walls.problems if problem.code == code)
    assert (problem.line, problem.layer) == (7, "L")
    assert problem.x is not None
    assert problem.fix


def test_the_figure_that_closes_a_gap_is_named():
    """Lines that cross at (0, 0): the last edge is drawn on by 0.5 of its length, 5."""
    ring = [("M", 0, 0), ("L", 50, 0), ("L", 50, 50), ("L", 3, 4), ("L", 0.3, 0.4)], False
    gap = next(p for p in import_walls(drawing(path(ring))).problems if p.code == "gap")
    assert float(gap.fix.split()[-1]) == pytest.approx(0.5, rel=2e-3)
    assert float(gap.fix.split()[-1]) >= 0.5


def test_a_thousand_places_are_listed_and_the_rest_is_counted():
    across = [path(([("M", 0, y), ("L", 50, y)], False)) for y in range(6, 45)]
    down = [path(([("M", x + 5.5, 0), ("L", x + 5.5, 50)], False)) for x in range(40)]
    crossings = [p for p in import_walls(drawing(*across, *down)).problems if p.code == "crossing"]
    assert len(crossings) == 1001
    assert crossings[-1].message.startswith("560 more")  # 39 * 40 - 1000


def test_which_walls_are_around_a_point_is_what_shapely_says():
    """Stars in stars, whose rays cross edges at all angles; points of the whole plane around them."""
    rng = np.random.default_rng(7)
    turn = np.linspace(0, 2 * np.pi, 40)[:-1]
    stars = [
        size * np.stack([np.cos(turn), np.sin(turn)], 1) * rng.uniform(0.3, 1, (39, 1)) for size in (1.0, 0.6, 2.0)
    ]
    points = rng.uniform(-2, 2, (500, 2))
    found = np.zeros((500, 3), dtype=bool)
    found[walls_around(edges_of(*stars), points)] = True
    expected = [shapely.contains_xy(shapely.Polygon(star), points[:, 0], points[:, 1]) for star in stars]
    assert found.T.tolist() == [one.tolist() for one in expected]
