"""Arcs against the exact curve, measured by code of the tests' own: centre and radius from the bulge."""

from __future__ import annotations

import math

import numpy as np
import pytest
from drawn import circle, drawing, four_cubics, path, polygon
from hypothesis import given, settings
from hypothesis import strategies as st
from shapely.geometry import Point

from importers.drawing import Subpath
from wallkit.walls.arcs import fit_arcs
from wallkit.walls.build import import_walls
from wallkit.walls.flatten import evaluate
from wallkit.walls.strokes import gather


def cubic(points):
    (x0, y0), *rest = points
    return gather([Subpath([("M", x0, y0), ("C", *np.ravel(rest).tolist())], False)])


def distance_to_edge(points, a, b, bulge):
    """Complex plane; the centre is the chord's middle plus i (1 - bulge^2) / (4 bulge) times the chord."""
    if bulge == 0:
        t = np.clip(((points - a) * (b - a).conjugate()).real / max(abs(b - a) ** 2, 1e-300), 0, 1)
        return abs(points - a - t * (b - a))
    centre = (a + b) / 2 + 1j * (b - a) * (1 - bulge**2) / (4 * bulge)
    radius = abs(b - a) * (1 + bulge**2) / (4 * abs(bulge))
    angle = 4 * math.atan(bulge)
    swept = np.mod(np.angle((points - centre) / (a - centre)) * np.sign(bulge), 2 * math.pi)
    # the sharp end of a huge circle loses digits of the angle: within 1e-9 of it both answers agree to rounding
    within = swept <= abs(angle) + 1e-9
    ends = np.minimum(abs(points - a), abs(points - b))
    return np.where(within, abs(abs(points - centre) - radius), ends)


def distance_to_walls(points, vertices, bulges):
    flat = points[:, 0] + 1j * points[:, 1]
    corner = vertices[:, 0] + 1j * vertices[:, 1]
    edges = zip(corner[:-1], corner[1:], bulges, strict=True)
    return np.min([distance_to_edge(flat, a, b, bulge) for a, b, bulge in edges], axis=0)


coordinate = st.floats(-100, 100).map(lambda x: round(x, 2))
point = st.tuples(coordinate, coordinate)


@settings(max_examples=60, deadline=None)
@given(st.tuples(point, point, point, point), st.sampled_from([1.0, 0.1, 0.01, 1e-4]))
def test_every_point_of_a_cubic_is_within_tolerance(points, tolerance):
    strokes = cubic(points)
    pieces = fit_arcs(strokes, tolerance)
    vertices = np.concatenate([strokes.starts, pieces.ends])
    t = np.linspace(0, 1, 2001)
    curve = evaluate(np.repeat(strokes.cubics, len(t), axis=0), t)
    # the test's own circles lose digits where they are flat: radius up to 1e9 at 1e-16
    assert distance_to_walls(curve, vertices, pieces.bulges).max() <= tolerance * 1.001 + 1e-6
    assert pieces.error <= tolerance
    assert (np.abs(pieces.bulges) <= 1).all()
    assert pieces.ends[-1].tolist() == list(points[3])


@pytest.mark.parametrize("shift", [0, 1e-9, 1e-6, 1e-3, 1.0, -1.0])
@pytest.mark.parametrize("tolerance", [0.1, 1e-3])
def test_cusps_near_cusps_and_small_loops(shift, tolerance):
    strokes = cubic([(0, 0), (100, 100 + shift), (0, 100), (100, 0)])
    pieces = fit_arcs(strokes, tolerance)
    t = np.linspace(0, 1, 20001)
    curve = evaluate(np.repeat(strokes.cubics, len(t), axis=0), t)
    vertices = np.concatenate([strokes.starts, pieces.ends])
    assert distance_to_walls(curve, vertices, pieces.bulges).max() <= tolerance * 1.001


@pytest.mark.parametrize("tolerance", [1e-1, 1e-2, 1e-3, 1e-4])
def test_arcs_join_without_a_corner(tolerance):
    strokes = cubic([(0, 0), (30, 80), (70, -60), (100, 20)])
    pieces = fit_arcs(strokes, tolerance)
    corner = np.concatenate([strokes.starts, pieces.ends]) @ [1, 1j]
    chord = np.angle(np.diff(corner))
    half = 2 * np.arctan(pieces.bulges)
    corners = np.angle(np.exp(1j * ((chord + half)[:-1] - (chord - half)[1:])))
    assert np.abs(corners).max() < 1e-7  # rounding of tangents over arcs of 1e-2


def test_order_of_convergence_is_three():
    rng = np.random.default_rng(5)
    cubics = rng.uniform(0, 100, (60, 4, 2))
    strokes = gather([Subpath([("M", *c[0].tolist()), ("C", *c[1:].ravel().tolist())], False) for c in cubics])
    few, many = (fit_arcs(strokes, tolerance).counts.sum() for tolerance in (1e-2, 1e-5))
    # a thousandth of the tolerance costs 1000^(1/3) = 10 times the edges; published for biarcs: order 3.07 to 3.36
    assert 2.8 < math.log(1000) / math.log(many / few) < 3.6


def test_normal_error_is_what_it_says():
    strokes = cubic([(0, 0), (30, 80), (70, -60), (100, 20)])
    pieces = fit_arcs(strokes, 1e-3)
    t = np.linspace(0, 1, 4001)
    curve = evaluate(np.repeat(strokes.cubics, len(t), axis=0), t) @ [1, 1j]
    corner = np.concatenate([strokes.starts, pieces.ends]) @ [1, 1j]
    distances = np.array(
        [distance_to_edge(curve, a, b, k) for a, b, k in zip(corner[:-1], corner[1:], pieces.bulges, strict=True)]
    )
    edge = distances.argmin(axis=0)
    a, b, k = corner[edge], corner[edge + 1], pieces.bulges[edge]
    centre = (a + b) / 2 + 1j * (b - a) * (1 - k**2) / (4 * k)
    arc_tangent = 1j * (curve - centre) * np.sign(k)
    angle = np.abs(np.angle(np.gradient(curve) / arc_tangent))[2:-2]
    assert angle.max() == pytest.approx(pieces.normal_error, rel=0.05)


def test_true_circles_become_exact_arcs():
    walls = import_walls(drawing(path(circle(3, 4, 5))), curves="arcs")
    assert len(walls) == 1
    assert walls.vertices.tolist() == [[8, 4], [-2, 4]]
    assert walls.bulges.tolist() == [1, 1]
    assert walls.measured_error == 0
    assert walls.measured_normal_error == 0


def test_circles_inside_out_and_nested():
    rings = [circle(0, 0, r) for r in (5, 10, 15)]
    walls = import_walls(drawing(*(path(ring) for ring in rings)), curves="arcs")
    assert walls.depth.tolist() == [2, 1, 0]
    assert walls.bulges.tolist() == [1, 1, -1, -1, 1, 1]
    assert walls.to_shapely(1e-4).geoms[0].area == pytest.approx(math.pi * (225 - 100 + 25), rel=1e-4)


def test_a_circle_of_four_cubics_is_four_arcs():
    walls = import_walls(drawing(path(four_cubics(0, 0, 100))), curves="arcs")
    assert len(walls.edge_starts) == 4
    assert walls.measured_error == pytest.approx(
        0.027253, rel=1e-3
    )  # 2.7253e-4 r: how far the cubics themselves are off


def test_straight_cubics_are_lines_and_corners_stay():
    side = [("M", 0, 0), ("C", 1, 0, 2, 0, 3, 0), ("L", 3, 3), ("C", 2, 3, 1, 3, 0, 3)], True
    walls = import_walls(drawing(path(side)), curves="arcs")
    assert not walls.has_arcs
    assert sorted(map(tuple, walls.vertices.tolist())) == [(0, 0), (0, 3), (3, 0), (3, 3)]


def test_a_straight_cubic_that_turns_back_keeps_its_reach():
    pieces = fit_arcs(cubic([(0, 0), (9, 0), (9, 0), (0, 0)]), 0.1)
    assert pieces.ends.tolist() == [[6.75, 0], [0, 0]]


@pytest.mark.parametrize("ratio", [1.5, 3, 20, 500])
def test_ellipses_are_biarcs_within_tolerance(ratio):
    ring = [("M", ratio, 0), ("A", ratio, 1, 0, 0, 1, -ratio, 0), ("A", ratio, 1, 0, 0, 1, ratio, 0)], True
    pieces = fit_arcs(gather([Subpath(*ring)]), 1e-3)
    angle = np.linspace(0, 2 * np.pi, 20001)
    curve = np.stack([ratio * np.cos(angle), np.sin(angle)], axis=1)
    vertices = np.concatenate([[[ratio, 0]], pieces.ends])
    assert distance_to_walls(curve, vertices, pieces.bulges).max() <= 1.001e-3


def test_arcs_bow_to_the_right_of_the_chord_when_positive():
    walls = import_walls(drawing(path(circle(0, 0, 1)), path(polygon((5, 5), (6, 5), (5, 6)))), curves="arcs")
    shape = walls.to_shapely(1e-3).geoms[0]
    assert shape.contains(Point(0, -0.99))
    assert shape.contains(Point(0, 0.99))
