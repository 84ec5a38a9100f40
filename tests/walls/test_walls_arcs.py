"""Arcs against the exact curve: evaluated here on its own, by Bernstein sums and by shapely on dense points."""

import math

import numpy as np
import pytest
import shapely
from arcs_judged import (
    DENSE,
    arc_points,
    bezier,
    check_smooth,
    cusps,
    directions,
    hausdorff,
    sampling_error,
    to_line,
)
from drawn import circle, drawing, four_cubics, path, polygon
from hypothesis import example, given, settings
from hypothesis import strategies as st

from importers.drawing import Subpath
from wallkit.walls.importing.arc_fitting.curves_to_arcs import fit_arcs
from wallkit.walls.importing.pipeline import import_walls
from wallkit.walls.importing.segments import gather

coordinate = st.floats(-100, 100, allow_nan=False).map(lambda x: round(x, 6))
point = st.tuples(coordinate, coordinate)
tolerance = st.sampled_from([1.0, 0.1, 1e-2, 1e-3, 1e-4])


def fit(segments, tol):
    """Vertices (n + 1, 2), bulges (n,), and the result for the segments of one open subpath."""
    pieces = fit_arcs(gather([Subpath(segments, False)]), tol)
    return np.vstack([segments[0][1:3], pieces.ends]), pieces.bulges, pieces


@settings(max_examples=60)
@given(point, point, point, point, tolerance)
@example((0.0, 0.0), (100.0, 100.0), (0.0, 100.0), (100.0, 0.0), 1e-3)  # a true cusp
@example((0.0, 0.0), (100.0, 100.000001), (0.0, 100.0), (100.0, 0.0), 1e-3)  # nearly one
@example((0.0, 0.0), (100.0, 101.0), (0.0, 101.0), (100.0, 0.0), 1.0)  # a small loop, below the tolerance
@example((0.0, 0.0), (90.0, 60.0), (-60.0, 60.0), (30.0, 0.0), 1e-4)  # a loop
@example((5.0, 5.0), (60.0, 60.0), (-60.0, 60.0), (5.0, 5.0), 1e-2)  # back to its start
@example((1.0, 1.0), (1.0, 1.0), (1.0, 1.0), (1.0, 1.0), 1e-2)  # a point
@example((0.0, 0.0), (0.0, 0.0), (50.0, 70.0), (100.0, 0.0), 1e-3)  # no first arm
@example((0.0, 0.0), (0.0, 0.0), (100.0, 50.0), (100.0, 50.0), 1e-3)  # neither: a straight line
@example((0.0, 0.0), (200.0, 0.0), (-100.0, 0.0), (100.0, 0.0), 1e-3)  # on a line, to and fro
@example((0.0, 0.0), (50.0, 1e-9), (70.0, 0.0), (100.0, 0.0), 1e-3)  # all but straight
@example((0.0, 0.0), (0.0, 50.0), (0.0, 50.0), (0.0, 0.0), 1e-3)  # out and back on itself
@example((1e-5, 0.0), (0.0, 0.0), (5.0, 0.0), (0.0, 0.0), 1.0)  # with a cusp at its start, to rounding
@example(  # on a line to rounding; it stops in the middle and goes on
    (4.120505, 25.775478), (25.775478, -4.432374), (4.120505, 25.775478), (25.775478, -4.432374), 1.0
)
@example((0.0, -6.1e-5), (0.0, -6.1e-5), (0.0, 0.0), (1.0, -1.0), 1.0)  # turns slowly, by 135 degrees within 1e-12
def test_every_cubic_stays_within_the_tolerance(p0, p1, p2, p3, tol):
    check_cubic([p0, p1, p2, p3], tol)


def check_cubic(control, tol):
    """Distance both ways, ends, half circles at most, no kinks but at cusps."""
    control = [tuple(map(float, p)) for p in control]
    vertices, bulges, pieces = fit([("M", *control[0]), ("C", *control[1], *control[2], *control[3])], tol)
    exact = bezier(control, np.linspace(0, 1, DENSE))
    slack = sampling_error(exact) + 1e-12
    assert hausdorff(exact, vertices, bulges) <= tol + slack
    assert pieces.error <= tol
    assert np.abs(bulges).max() <= 1
    assert tuple(vertices[0]) == control[0]
    assert tuple(vertices[-1]) == control[3]
    check_smooth(vertices, bulges, cusps(control))


short = st.integers(-120, -10).map(lambda tenths: 10 ** (tenths / 10))  # from 1e-12 to 0.1
angle = st.floats(0, 2 * math.pi)


@settings(max_examples=40)
@given(point, angle, st.floats(-300, 300), st.floats(-0.2, 1.2), st.just(0.0) | short, st.integers(5, 16), tolerance)
@example((-90.103243, 36.287691), 2.76, -50.0, 0.79, 0.0, 11, 1e-2)  # stops and goes on
@example((-77.365168, -6.813352), 0.58, 79.0, 0.66, 6.30957344480193e-06, 15, 1e-3)
@example((30.0, -20.0), 2.0, 200.0, 0.3, 1e-5, 16, 1e-4)  # to and fro by less than rounding
@example((30.0, -20.0), 2.0, 200.0, 0.3, 1e-4, 16, 1e-4)  # by a little more
@example((0.0, 0.0), 1.0, 100.0, 1e-7, 0.5, 16, 1.0)  # a turning point as good as at the start
def test_every_cubic_to_and_fro_on_a_line_stays_within_the_tolerance(start, turn, size, stop, apart, digits, tol):
    """The speed is size (t - r) (t - s) with both places given, up to the rounding of control points to digits."""
    r, s = stop, stop + apart
    speeds = size * np.array([r * s, r * s - (r + s) / 2, (1 - r) * (1 - s)])  # of Bernstein's form
    along = np.concatenate([[0.0], np.cumsum(speeds / 3)])
    control = np.array(start) + along[:, None] * [math.cos(turn), math.sin(turn)]
    check_cubic(np.round(control, digits - 2), tol)


@settings(max_examples=20)
@given(point, angle, short, angle, short, point, tolerance)
@example((-13.75465, 73.464101), 3.97, 7.943282347242821e-12, 2.15, 7.943282347242813e-4, (8.733858, -60.740623), 1e-3)
@example((-84.957778, 92.572916), 3.39, 5e-10, 4.86, 5e-12, (22.315946, -93.22155), 1e-2)
@example((86.462921, 0.0), 0.8961615249426534, 1e-7, 0.4792108358056123, 10**-3.3, (-97.517578, 1.5), 1.0)
def test_every_cubic_with_short_arms_stays_within_the_tolerance(p0, turn0, arm0, turn1, arm1, p3, tol):
    p1 = np.array(p0) + arm0 * np.array([math.cos(turn0), math.sin(turn0)])
    p2 = p1 + arm1 * np.array([math.cos(turn1), math.sin(turn1)])
    check_cubic([p0, p1, p2, p3], tol)
    check_cubic([p3, p2, p1, p0], tol)


@settings(max_examples=20)
@given(point, point, point, tolerance)
def test_every_quadratic_stays_within_the_tolerance(p0, p1, p2, tol):
    vertices, bulges, pieces = fit([("M", *p0), ("Q", *p1, *p2)], tol)
    exact = bezier([p0, p1, p2], np.linspace(0, 1, DENSE))
    assert hausdorff(exact, vertices, bulges) <= tol + sampling_error(exact) + 1e-12
    assert pieces.error <= tol
    assert tuple(vertices[-1]) == p2


def ellipse(start, turn, rx, ry, rotation, count=DENSE):
    a = np.radians(start) + np.radians(turn) * np.linspace(0, 1, count)
    z = (rx * np.cos(a) + 1j * ry * np.sin(a)) * np.exp(1j * math.radians(rotation))
    return np.stack([z.real, z.imag], axis=1)


def as_segment(points, turn, rx, ry, rotation):
    return [
        ("M", *points[0].tolist()),
        ("A", rx, ry, rotation, int(abs(turn) > 180), int(turn > 0), *points[-1].tolist()),
    ]


@settings(max_examples=25)
@given(
    st.floats(0, 360),
    st.floats(5, 350),
    st.booleans(),
    st.floats(1, 100),
    st.floats(1e-3, 1),
    st.floats(0, 180),
    tolerance,
)
@example(0.0, 350.0, True, 100.0, 1e-3, 0.0, 1.0)
def test_every_elliptic_arc_stays_within_the_tolerance(start, turn, left, rx, ratio, rotation, tol):
    turn = turn if left else -turn
    exact = ellipse(start, turn, rx, rx * ratio, rotation)
    vertices, bulges, pieces = fit(as_segment(exact, turn, rx, rx * ratio, rotation), tol)
    # end points are rounded, which a thin ellipse multiplies: its centre is known to about eps (rx / ry)
    rounding = 1e-12 / ratio**2
    assert hausdorff(exact, vertices, bulges) <= tol + sampling_error(exact) + rounding
    assert pieces.error <= tol
    assert np.abs(bulges).max() <= 1
    check_smooth(vertices, bulges)


@pytest.mark.parametrize("turn", [1.0, 90.0, 179.9, 180.0, 181.0, 270.0, 359.0, -90.0, -200.0])
def test_a_circular_arc_stays_one(turn):
    exact = ellipse(30, turn, 25, 25, 17)
    vertices, bulges, _ = fit(as_segment(exact, turn, 25, 25, 17), 1e-9)
    assert len(bulges) == (1 if abs(turn) <= 180 else 2)
    # the sagitta between samples is what the comparison itself is off by
    assert hausdorff(exact, vertices, bulges) <= sampling_error(exact) + 1e-12
    assert 4 * np.degrees(np.arctan(bulges)).sum() == pytest.approx(turn, rel=1e-12)


def as_programs_write(r, digits):
    """The segments of a circle of four cubics, with so many decimals."""
    segments, _ = four_cubics(0.0, 0.0, float(r))
    return [(word, *(round(x, digits) for x in numbers)) for word, *numbers in segments]


@pytest.mark.parametrize("digits", [15, 3])
def test_a_circle_of_four_cubics_becomes_four_arcs_of_that_circle(digits):
    """Such a circle is off by 2.73e-4 r, so with r = 100 it has to be within 0.1."""
    _, bulges, pieces = fit(as_programs_write(100, digits), 0.1)
    assert len(bulges) == 4
    assert bulges == pytest.approx([math.tan(math.pi / 8)] * 4, rel=1e-12 if digits == 15 else 1e-4)
    assert pieces.error == pytest.approx(2.73e-2, rel=0.02)


def test_a_circle_of_four_cubics_is_followed_where_the_tolerance_is_finer_than_it():
    vertices, bulges, pieces = fit(as_programs_write(100, 15), 1e-3)
    assert len(bulges) > 4
    assert pieces.error <= 1e-3
    check_smooth(vertices, bulges)


def test_straight_curves_become_one_line():
    curves = [("C", 1.0, 1.0, 2.0, 2.0, 3.0, 3.0), ("Q", 4.0, 4.0, 7.0, 7.0), ("L", 7.0, 0.0)]
    vertices, bulges, pieces = fit([("M", 0.0, 0.0), *curves], 1e-3)
    assert vertices.tolist() == [[0, 0], [3, 3], [7, 7], [7, 0]]
    assert not bulges.any()
    assert pieces.error < 1e-14


def test_a_curve_to_and_fro_on_a_line_keeps_its_turning_points():
    vertices, bulges, _ = fit([("M", 0.0, 0.0), ("C", 200.0, 0.0, -100.0, 0.0, 100.0, 0.0)], 1e-3)
    x = bezier([(0, 0), (200, 0), (-100, 0), (100, 0)], np.linspace(0, 1, 100001))[:, 0]
    inner = slice(10000, 90000)
    # at a turning point the place depends on the square of t, so that the grid of 1e-5 is good to 1e-7
    assert sorted(vertices[:, 0]) == pytest.approx([0, x[inner].min(), x[inner].max(), 100], abs=1e-6)
    assert not bulges.any()


def test_corners_between_segments_stay():
    segments = [("M", 0.0, 0.0), ("C", 0.0, 30.0, 20.0, 50.0, 50.0, 50.0), ("C", 50.0, 20.0, 30.0, 0.0, 0.0, 0.0)]
    vertices, bulges, _ = fit(segments, 1e-3)
    at = int(np.flatnonzero((vertices == [50.0, 50.0]).all(axis=1))[0])
    start, end = directions(vertices, bulges)
    assert math.degrees(abs(start[at] - end[at - 1])) == pytest.approx(90, abs=1e-6)


@pytest.mark.parametrize("degree", [2, 3])
def test_the_order_of_convergence_is_three(degree):
    """Edges grow as tolerance^(-1/3) on smooth curves, here 40 random ones of gentle turn.

    Where there are few edges a curve they grow more slowly: directions lean at inner joints alone.
    """
    rng = np.random.default_rng(5)
    steps = np.cumsum(rng.uniform([10, -15], [30, 15], (40, degree, 2)), axis=1)
    word = "Q" if degree == 2 else "C"
    segments = gather(Subpath([("M", 0.0, 0.0), (word, *row.ravel().tolist())], False) for row in steps)
    counts = [len(fit_arcs(segments, tol).ends) for tol in (1e-7, 1e-8, 1e-9, 1e-10)]
    orders = np.log(10) / np.log(np.divide(counts[1:], counts[:-1]))
    assert orders == pytest.approx([3, 3, 3], abs=0.25)


def least(rate, length, tolerance):
    """No arcs that join, even with kinks, are fewer: at best one of length d is off by sqrt(3) / 216 k' d^3.

    Args:
        rate: how fast the curvature changes, at even places of a parameter.
        length: the length of the curve from each place to the next, about.
        tolerance: how far the arcs may be off.
    """
    return float((np.cbrt(np.abs(rate) * math.sqrt(3) / (216 * tolerance)) * length).sum())


def test_the_number_of_edges_is_near_the_least_that_arcs_can_do():
    """The parabola y = x^2 / 2, whose curvature changes at the rate -3 x / (1 + x^2)^3."""
    x = np.linspace(0, 1, 20001)
    need = least(3 * x / (1 + x**2) ** 3, np.sqrt(1 + x**2) / 20000, 1e-9)
    _, bulges, _ = fit([("M", 0.0, 0.0), ("Q", 0.5, 0.0, 1.0, 0.5)], 1e-9)
    assert need <= len(bulges) <= 1.05 * need + 2


def flower(angle):
    """Points, derivatives and second derivatives of r = 200 (1 + 0.15 cos 3a + 0.07 sin 5a), as complex numbers."""
    r = 200 * (1 + 0.15 * np.cos(3 * angle) + 0.07 * np.sin(5 * angle))
    first = 200 * (-0.45 * np.sin(3 * angle) + 0.35 * np.cos(5 * angle))
    second = 200 * (-1.35 * np.cos(3 * angle) - 1.75 * np.sin(5 * angle))
    turn = np.exp(1j * angle)
    return r * turn, (first + 1j * r) * turn, (second + 2j * first - r) * turn


def drawn_flower(count):
    """The flower as Hermite cubics: one closed subpath."""
    angle = 2 * np.pi * np.arange(count + 1) / count
    point, velocity, _ = flower(angle)
    point[-1], arm = point[0], velocity * (2 * np.pi / count / 3)
    corners = np.stack([point[:-1] + arm[:-1], point[1:] - arm[1:], point[1:]], axis=1)
    rows = np.stack([corners.real, corners.imag], axis=2).reshape(count, 6).tolist()
    return [("M", float(point[0].real), float(point[0].imag)), *(("C", *row) for row in rows)]


@pytest.mark.parametrize("count", [400, 2000])
def test_arcs_run_over_the_joints_of_a_smooth_line(count):
    angle = np.linspace(0, 2 * np.pi, 200001)
    _, velocity, acceleration = flower(angle)
    bend = (velocity.conj() * acceleration).imag / np.abs(velocity) ** 3
    need = least(np.diff(bend) / np.abs(velocity[1:]) / angle[1], np.abs(velocity[1:]) * angle[1], 1e-4)
    segments = drawn_flower(count)
    vertices, bulges, pieces = fit(segments, 1e-4)
    assert len(bulges) <= 1.2 * need
    assert pieces.error <= 1e-4
    assert pieces.normal_error < 1e-3
    check_smooth(vertices, bulges)
    assert vertices[0].tolist() == vertices[-1].tolist() == list(segments[0][1:])
    exact = flower(angle)[0]
    exact = np.stack([exact.real, exact.imag], axis=1)
    arcs = np.vstack([arc_points(vertices[i], vertices[i + 1], bulges[i], 200) for i in range(len(bulges))])
    # Hermite cubics of the flower are off by (2 pi / count)^4 / 384 of its fourth derivative, 2e4 at most
    drawn = (2 * np.pi / count) ** 4 / 384 * 2e4
    assert max(to_line(exact, arcs), to_line(arcs, exact)) <= 1e-4 + drawn + sampling_error(exact)


@settings(max_examples=40)
@given(st.lists(point, min_size=3, max_size=8, unique=True), st.floats(0.05, 1.5), tolerance)
def test_every_smooth_line_of_cubics_stays_within_the_tolerance(nodes, arm, tol):
    """Through random points, at each along the chord of its neighbours; arms from short to such that make loops."""
    nodes = np.array(nodes)
    along = (np.roll(nodes, -1, 0) - np.roll(nodes, 1, 0)) * arm / 3
    ring = np.stack([nodes, nodes + along, np.roll(nodes - along, -1, 0), np.roll(nodes, -1, 0)], axis=1)
    segments = [("M", *nodes[0].tolist()), *(("C", *row[1:].ravel().tolist()) for row in ring)]
    vertices, bulges, pieces = fit(segments, tol)
    parts = [bezier(control, np.linspace(0, 1, DENSE)) for control in ring]
    slack = max(sampling_error(part) for part in parts) + 1e-12
    assert hausdorff(np.vstack(parts), vertices, bulges) <= tol + slack
    assert pieces.error <= tol
    assert np.abs(bulges).max() <= 1
    assert vertices[0].tolist() == vertices[-1].tolist() == nodes[0].tolist()


def test_a_joint_that_something_else_touches_stays_a_vertex():
    segments = drawn_flower(400)
    joint = segments[100][-2:]
    alone = fit_arcs(gather([Subpath(segments, True)]), 0.1)
    line = Subpath([("M", 0.0, 0.0), ("L", *joint)], False)
    touched = fit_arcs(gather([Subpath(segments, True), line]), 0.1)
    assert not (alone.ends == joint).all(axis=1).any()
    assert (touched.ends[:-1] == joint).all(axis=1).sum() == 1


def test_straight_cubics_and_quarter_circles_are_not_mixed_with_their_neighbours():
    """A slot: two straight sides and two round ends, all cubics that join smoothly."""
    k = 4 / 3 * (math.sqrt(2) - 1)
    segments = [
        ("M", 0.0, 0.0),
        ("C", 1.0, 0.0, 2.0, 0.0, 3.0, 0.0),
        ("C", 3 + k, 0.0, 4.0, 1 - k, 4.0, 1.0),
        ("C", 4.0, 1 + k, 3 + k, 2.0, 3.0, 2.0),
        ("C", 2.0, 2.0, 1.0, 2.0, 0.0, 2.0),
        ("C", -k, 2.0, -1.0, 1 + k, -1.0, 1.0),
        ("C", -1.0, 1 - k, -k, 0.0, 0.0, 0.0),
    ]
    vertices, bulges, _ = fit(segments, 0.01)
    assert vertices[1:].tolist() == [list(segment[-2:]) for segment in segments[1:]]
    quarter = math.tan(math.pi / 8)
    assert bulges == pytest.approx([0, quarter, quarter, 0, quarter, quarter], abs=1e-12)


def test_the_measured_errors_are_those_of_a_dense_measurement():
    segments = [("M", 0.0, 0.0), ("C", 20.0, 90.0, 70.0, -60.0, 100.0, 30.0)]
    vertices, bulges, pieces = fit(segments, 0.05)
    control = [(0, 0), (20, 90), (70, -60), (100, 30)]
    t = np.linspace(0, 1, 20001)
    exact = bezier(control, t)
    arcs = np.vstack([arc_points(vertices[i], vertices[i + 1], bulges[i], 2000) for i in range(len(bulges))])
    chords = shapely.STRtree(shapely.linestrings(np.stack([arcs[:-1], arcs[1:]], axis=1)))
    (rows, nearest), distance = chords.query_nearest(shapely.points(exact), return_distance=True, all_matches=False)
    # 1e-3 is what is promised; the chords between 2000 points an arc are off by less than 1e-5
    assert pieces.error == pytest.approx(distance.max(), rel=1e-3)
    velocity = bezier(3 * np.diff(control, axis=0), t)
    chord = np.diff(arcs, axis=0)[nearest]
    angle = np.abs(np.angle((velocity @ [1, 1j])[rows] / (chord @ [1, 1j])))
    # chords of 1/2000 of an arc differ in direction from it by less than 4e-4
    assert pieces.normal_error == pytest.approx(angle[(t > 0.001) & (t < 0.999)].max(), abs=1e-3)


def test_far_from_the_origin_costs_no_more_than_the_rounding_of_coordinates():
    near = np.array([(0.0, 0.0), (20.0, 90.0), (70.0, -60.0), (100.0, 30.0)])
    far = near + 2.0**23
    counts = []
    for control in (near, far):
        _, bulges, pieces = fit([("M", *control[0]), ("C", *control[1:].ravel().tolist())], 1e-4)
        counts.append(len(bulges))
        assert pieces.error <= 1e-4
    assert counts[0] == counts[1]


def test_many_segments_at_once_are_each_as_alone():
    rng = np.random.default_rng(2)
    subs, alone = [], []
    for index in range(40):
        p = rng.uniform(0, 100, (4, 2)).tolist()
        q = rng.uniform(0, 100, 2).tolist()
        segments = [("M", *p[0]), ("C", *p[1], *p[2], *p[3]), ("L", *q), ("A", 80.0, 60.0, 30.0, 0, index % 2, *p[0])]
        if index % 3 == 0:
            segments.insert(2, ("Q", *q, *p[1]))
        subs.append(Subpath(segments, False))
        alone.append(fit_arcs(gather([subs[-1]]), 0.01))
    together = fit_arcs(gather(subs), 0.01)
    assert together.counts.tolist() == [count for one in alone for count in one.counts.tolist()]
    assert together.ends.tobytes() == np.vstack([one.ends for one in alone]).tobytes()
    assert together.bulges.tobytes() == np.concatenate([one.bulges for one in alone]).tobytes()


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


def test_arcs_bow_to_the_right_of_the_chord_when_positive():
    walls = import_walls(drawing(path(circle(0, 0, 1)), path(polygon((5, 5), (6, 5), (5, 6)))), curves="arcs")
    shape = walls.to_shapely(1e-3).geoms[0]
    assert shape.contains(shapely.Point(0, -0.99))
    assert shape.contains(shapely.Point(0, 0.99))
