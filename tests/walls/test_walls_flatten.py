"""Flattening against the exact curve: the bound holds, the measure is true, the count beats both known methods."""

from __future__ import annotations

import math

import numpy as np
import pytest
from drawn import four_cubics
from hypothesis import example, given, settings
from hypothesis import strategies as st

from importers.drawing import Subpath
from wallkit.geometry.cubics import evaluate
from wallkit.walls.importing.curves_to_lines import flatten
from wallkit.walls.importing.segments import gather


def cubic(points):
    (x0, y0), *rest = points
    return gather([Subpath([("M", x0, y0), ("C", *np.ravel(rest).tolist())], False)])


def distance_to_polyline(points, vertices):
    a, b = vertices[:-1], vertices[1:]
    d, w = b - a, points[:, None] - a
    square = (d**2).sum(axis=1)
    t = np.clip((w * d).sum(axis=2) / np.where(square > 0, square, 1), 0, 1)
    return np.hypot(*np.moveaxis(w - t[..., None] * d, 2, 0)).min(axis=1)


coordinate = st.floats(-100, 100).map(lambda x: round(x, 3))
point = st.tuples(coordinate, coordinate)


@settings(max_examples=60)
@given(st.tuples(point, point, point, point), st.sampled_from([1.0, 0.1, 0.01]))
@example(((17.5, 12.0), (19.0, 69.0), (18.0, 53.0), (18.5, 18.312)), 1.0)  # a hook that peaks beyond the chord's end
def test_every_point_of_the_curve_is_within_tolerance(points, tolerance):
    segments = cubic(points)
    pieces = flatten(segments, tolerance)
    vertices = np.concatenate([segments.starts, pieces.ends])
    t = np.linspace(0, 1, 1001)
    curve = evaluate(np.repeat(segments.cubics, len(t), axis=0), t)
    # rounding of evaluation: a few ulp of 100
    assert distance_to_polyline(curve, vertices).max() <= tolerance * (1 + 1e-9) + 1e-12
    assert pieces.error <= tolerance * (1 + 1e-9) + 1e-12
    assert distance_to_polyline(curve, vertices).max() <= pieces.error * (1 + 1e-6) + 1e-12
    assert pieces.ends[-1].tolist() == list(points[3])


def known_counts(cubics, tolerance):
    """Segments by Wang's bound and by halving with 3/4 of the control distance, the two published methods."""
    second = np.diff(cubics, n=2, axis=1)
    wang = np.ceil(np.sqrt(6 * np.hypot(second[..., 0], second[..., 1]).max(axis=1) / (8 * tolerance)))
    return np.maximum(wang, 1), np.array([halves(c, tolerance) for c in cubics])


def halves(c, tolerance):
    if 0.75 * distance_to_polyline(c[1:3], c[[0, 3]]).max() <= tolerance:
        return 1
    first = (c[1:] + c[:-1]) / 2
    second = (first[1:] + first[:-1]) / 2
    middle = second.mean(axis=0)
    left = np.array([c[0], first[0], second[0], middle])
    return halves(left, tolerance) + halves(np.array([middle, second[1], first[2], c[3]]), tolerance)


@pytest.mark.parametrize("tolerance", [1, 0.1, 0.01, 0.001])
def test_no_more_edges_than_the_better_known_method(tolerance):
    cubics = np.random.default_rng(20).uniform(0, 100, (40, 4, 2))
    segments = gather([Subpath([("M", *c[0].tolist()), ("C", *c[1:].ravel().tolist())], False) for c in cubics])
    wang, halving = known_counts(cubics, tolerance)
    counts = flatten(segments, tolerance).counts
    assert (counts <= np.minimum(wang, halving)).all()


def test_near_cusps_and_loops_stay_within_tolerance():
    for shift in (0, 1e-9, 1e-6, 1e-3):
        segments = cubic([(0, 0), (100, 100 + shift), (0, 100), (100, 0)])
        pieces = flatten(segments, 0.01)
        t = np.linspace(0, 1, 20001)
        curve = evaluate(np.repeat(segments.cubics, len(t), axis=0), t)
        vertices = np.concatenate([segments.starts, pieces.ends])
        assert distance_to_polyline(curve, vertices).max() <= 0.01


def test_a_straight_cubic_is_one_edge_and_one_that_turns_back_keeps_its_reach():
    assert flatten(cubic([(0, 0), (1, 1), (2, 2), (3, 3)]), 0.1).counts.tolist() == [1]
    back = flatten(cubic([(0, 0), (9, 0), (9, 0), (0, 0)]), 0.001)
    assert back.ends[:, 0].max() == pytest.approx(6.75, abs=0.001)


@pytest.mark.parametrize("r", [1e-3, 1.0, 250.0, 1e6])
def test_circle_has_the_fewest_equal_edges(r):
    segments = gather([Subpath([("M", r, 0), ("A", r, r, 0, 0, 1, -r, 0), ("A", r, r, 0, 0, 1, r, 0)], True)])
    pieces = flatten(segments, r * 1e-3)
    # a half turn needs ceil(pi / (2 acos(1 - tol/r))) = 36
    assert pieces.counts.tolist() == [36, 36] == [math.ceil(math.pi / (2 * math.acos(1 - 1e-3)))] * 2
    assert pieces.error == pytest.approx(r * (1 - math.cos(math.pi / 72)), rel=1e-9)
    assert np.hypot(*pieces.ends.T) == pytest.approx(r, rel=1e-14)


@settings(max_examples=100)
@given(point, point, st.floats(0.1, 300), st.floats(0.1, 300), st.floats(-360, 360), st.booleans(), st.booleans())
def test_elliptic_arcs_lie_on_their_ellipse_and_within_tolerance(a, b, rx, ry, rotation, large, sweep):
    """Against the definition: the points satisfy the ellipse's equation, reached by a turn of the right kind."""
    if math.dist(a, b) < 1e-3:
        return
    turn = np.exp(-1j * math.radians(rotation))
    half = complex(b[0] - a[0], b[1] - a[1]) * turn / 2
    reach = math.hypot(half.real / rx, half.imag / ry)
    if reach > 1:  # as SVG says: grow until it reaches
        rx, ry = rx * reach * (1 + 1e-12), ry * reach * (1 + 1e-12)
    segments = gather([Subpath([("M", *a), ("A", rx, ry, rotation, int(large), int(sweep), *b)], False)])
    arcs = segments.arcs
    assert arcs.points(arcs.start)[0] == pytest.approx(a, abs=1e-6)
    assert arcs.points(arcs.start + arcs.turn)[0] == pytest.approx(b, abs=1e-6)
    assert (arcs.turn[0] > 0) == sweep
    if abs(abs(arcs.turn[0]) - math.pi) > 1e-5:
        assert (abs(arcs.turn[0]) > math.pi) == large
    pieces = flatten(segments, 0.05)
    assert pieces.error <= 0.05 * (1 + 1e-9)


def test_a_circle_of_four_cubics_is_off_by_what_is_known():
    segments = gather([Subpath(*four_cubics(0, 0, 1))])
    pieces = flatten(segments, 1e-6)
    radii = np.hypot(*pieces.ends.T)
    assert radii.max() - 1 == pytest.approx(2.7253e-4, rel=1e-3)  # the published figure
