"""Triangulations: every segment an edge, no new points, Delaunay beside segments; and segments cut where they meet."""

from fractions import Fraction

import numpy as np
import pytest
import shapely

from wallkit.geometry import constrained_delaunay
from wallkit.geometry.constrained_delaunay import constrained, triangulate
from wallkit.geometry.cut_edges import cut
from wallkit.geometry.delaunay import delaunay
from wallkit.geometry.noded_segments import node
from wallkit.geometry.orientation import in_circle, side


def framed(points):
    low, high = points.min(axis=0) - 50, points.max(axis=0) + 50
    return np.concatenate([points, [low, (high[0], low[1]), high, (low[0], high[1])]])


def check(a, b):
    """A triangulation of the frame, in which each piece of a segment is an edge, seen from both sides."""
    noded = node(a, b)
    points = framed(noded.points)
    mesh = triangulate(points, noded.pieces)
    corners = mesh.corners.reshape(-1, 3)
    assert (side(*(points[corners[:, i]] for i in range(3))) > 0).all()
    assert len(corners) == 2 * len(points) - 2 - 4  # Euler, with four points on the border
    area = shapely.area(shapely.polygons(points[corners])).sum()
    assert area == pytest.approx(np.ptp(points, axis=0).prod(), rel=1e-12)
    inner = np.flatnonzero(mesh.across >= 0)
    assert (mesh.across[mesh.across[inner]] == inner).all()
    assert len(inner) == len(mesh.across) - 4
    assert np.bincount(mesh.segment[mesh.segment >= 0], minlength=len(noded.pieces)).tolist() == [2] * len(noded.pieces)
    assert set(mesh.corners.tolist()) == set(range(len(points)))
    return noded


@pytest.mark.parametrize("count", [1, 2, 10, 80])
@pytest.mark.parametrize("seed", range(4))
def test_segments_by_chance(count, seed):
    random = np.random.default_rng(seed)
    a, b = random.random((2, count, 2)) * 100
    noded = check(a, b)
    lines = shapely.linestrings(np.stack([a, b], axis=1))
    crossings = sum(int(shapely.crosses(lines[i], lines[:i]).sum()) for i in range(count))
    assert len(noded.points) == 2 * count + crossings
    assert len(noded.pieces) == count + 2 * crossings
    pieces = np.hypot(*(noded.points[noded.pieces[:, 0]] - noded.points[noded.pieces[:, 1]]).T)
    whole = np.zeros(count)
    np.add.at(whole, noded.owner, pieces[noded.piece])
    assert whole == pytest.approx(np.hypot(*(b - a).T), rel=1e-9)  # each piece has its owner, and no other


@pytest.mark.parametrize("seed", range(6))
def test_segments_of_a_grid_that_touch_and_lie_on_one_another(seed):
    a, b = np.random.default_rng(seed).integers(0, 7, (2, 40, 2)).astype(float)
    real = (a != b).any(axis=1)
    noded = check(a, b)
    assert set(noded.owner.tolist()) == set(np.flatnonzero(real).tolist())
    pieces = np.hypot(*(noded.points[noded.pieces[:, 0]] - noded.points[noded.pieces[:, 1]]).T)
    whole = np.zeros(len(a))
    np.add.at(whole, noded.owner, pieces[noded.piece])
    assert whole == pytest.approx(np.hypot(*(b - a).T), rel=1e-9)


def test_what_meets_nothing_keeps_its_bits():
    points = np.random.default_rng(1).random((6, 2)) / 3
    ends = points + np.array([0.0, 1e-3])
    noded = node(points, ends)
    kept = {tuple(point) for point in np.concatenate([points, ends]).tolist()}
    assert {tuple(point) for point in noded.points.tolist()} == kept


def test_a_segment_through_points_is_led_through_them():
    points = framed(np.array([(0.0, 0.0), (5.0, 0.0), (10.0, 0.0), (3.0, 4.0), (7.0, -4.0)]))
    mesh = triangulate(points, np.array([[0, 2]]))
    h = np.flatnonzero(mesh.segment == 0)
    ends = {
        tuple(sorted((int(mesh.corners[k - k % 3 + (k + 1) % 3]), int(mesh.corners[k - k % 3 + (k + 2) % 3]))))
        for k in h
    }
    assert ends == {(0, 1), (1, 2)}


def test_nothing_to_cut():
    noded = node(np.empty((0, 2)), np.empty((0, 2)))
    assert len(noded.points) == len(noded.pieces) == len(noded.owner) == 0


def test_a_tangle_is_told_soon():
    a, b = np.random.default_rng(0).random((2, 2000, 2))  # some 460,000 crossings
    assert node(a, b) is None


def in_circle_exactly(a, b, c, d):
    """The determinant of the lifted points, in fractions."""
    rows = [[Fraction(float(x)) - Fraction(float(y)) for x, y in zip(point, d, strict=True)] for point in (a, b, c)]
    (p, q), (r, s), (t, u) = rows
    det = (p * p + q * q) * (r * u - s * t) - (r * r + s * s) * (p * u - q * t) + (t * t + u * u) * (p * s - q * r)
    return (det > 0) - (det < 0)


def angle(u, v):
    return abs(np.arctan2(u[0] * v[1] - u[1] * v[0], u @ v))


def wrong_by(mesh, h):
    """How far beyond a half turn the two angles at each half-edge are, where the circle holds the point opposite."""
    worst = 0.0
    for k in h.tolist():
        a, p, q = (mesh.points[mesh.corner[part]] for part in (k, mesh.after[k], mesh.before[k]))
        d = mesh.points[mesh.corner[mesh.across[k]]]
        if in_circle_exactly(a, p, q, d) > 0:
            worst = max(worst, angle(p - a, q - a) + angle(p - d, q - d) - np.pi)
    return worst


def sound(mesh):
    """Triangles cover the box once, and both sides of each edge agree."""
    corners = mesh.corner[: 3 * mesh.count].reshape(-1, 3)
    places = mesh.points[corners]
    assert (side(*places.transpose(1, 0, 2)) > 0).all()
    assert shapely.area(shapely.polygons(places)).sum() == pytest.approx(np.ptp(mesh.points, axis=0).prod(), rel=1e-12)
    h = np.flatnonzero(mesh.across[: 3 * mesh.count] >= 0)
    back = mesh.across[h]
    assert len(h) == 3 * mesh.count - 4
    assert (mesh.across[back] == h).all()
    assert (mesh.corner[mesh.after[h]] == mesh.corner[mesh.before[back]]).all()
    assert (mesh.label[h] == mesh.label[back]).all()
    return h


SQUARE = np.array([(-300.0, -300.0), (300.0, -300.0), (300.0, 300.0), (-300.0, 300.0)])
TURN = np.arange(300) * 2 * np.pi / 300
POINTS = {
    "by chance": np.random.default_rng(0).random((400, 2)),
    "lattice": np.stack(np.meshgrid(np.arange(18.0), np.arange(18.0)), axis=-1).reshape(-1, 2),
    "one line": np.stack([np.arange(200.0), np.zeros(200)], axis=1),
    "slanted line": np.arange(200.0)[:, None] * (0.1, 0.3) / 7,
    "circle": np.stack([np.cos(TURN), np.sin(TURN)], axis=1),
    "squares about one centre": np.concatenate([SQUARE * k / 70 for k in range(1, 71)]),
    "turned squares": np.concatenate([SQUARE @ [[0.6, -0.8], [0.8, 0.6]] * k / 70 for k in range(1, 71)]),
    "one point": np.zeros((1, 2)),
    "none": np.empty((0, 2)),
}


@pytest.mark.parametrize("name", POINTS)
def test_delaunay_beside_fractions(name):
    """No circle holds the point across an edge, but by the rounding that makes angles uncertain: some 2^-46."""
    points = POINTS[name]
    mesh = delaunay(framed(points) if len(points) else np.array([(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]))
    h = sound(mesh)
    assert mesh.count == 2 * len(mesh.points) - 6
    assert set(mesh.corner.tolist()) == set(range(len(mesh.points)))
    assert wrong_by(mesh, h[h < mesh.across[h]]) <= 2.0**-44


def test_delaunay_of_points_by_chance_is_that_of_geos():
    points = framed(np.random.default_rng(5).random((2000, 2)) * 1000)
    mesh = delaunay(points)
    ours = {frozenset(map(tuple, points[row].tolist())) for row in mesh.corner.reshape(-1, 3)}
    rings = shapely.get_parts(shapely.delaunay_triangles(shapely.multipoints(points)))
    assert ours == {frozenset(map(tuple, shapely.get_coordinates(ring).tolist())) for ring in rings}


def test_a_point_in_a_circle_is_told_as_by_fractions():
    random = np.random.default_rng(3)
    turn = random.random((200, 4)) * 2 * np.pi
    for round_, row in zip([*range(12)] * 17, turn, strict=False):
        a, b, c, d = np.round(np.stack([np.cos(row), np.sin(row)], axis=1), round_ + 1).tolist()
        if side(*(np.array([point]) for point in (a, b, c)))[0] > 0:
            assert in_circle(a, b, c, d) == in_circle_exactly(a, b, c, d)
    assert in_circle((0, 0), (1, 0), (1, 1), (0, 1)) == 0


def segments_of(seed):
    """Segments by chance, of a lattice, short ones, or long ones near one another."""
    random = np.random.default_rng(seed)
    count, kind = int(random.integers(5, 40)), seed % 4
    if kind == 0:
        return random.random((2, count, 2)) * 100
    if kind == 1:
        return random.integers(0, 9, (2, count, 2)).astype(float)
    a = random.random((count, 2)) * 100
    if kind == 2:
        return a, a + random.normal(0, 3, (count, 2))
    height = np.sort(random.random(count))
    return np.stack([random.random(count), height], axis=1), np.stack([1000 + random.random(count), height], axis=1)


@pytest.mark.parametrize("seed", range(16))
def test_beside_segments_it_is_delaunays_and_stays_so_when_they_are_cut(seed):
    noded = node(*segments_of(seed))
    points, pieces = framed(noded.points), noded.pieces
    mesh = constrained(points, pieces)
    h = sound(mesh)
    free = h[(mesh.label[h] < 0) & (h < mesh.across[h])]
    assert wrong_by(mesh, free) <= 2.0**-44
    on = h[(mesh.label[h] >= 0) & (h < mesh.across[h])]
    assert len(on) == len(pieces)
    ends = points[mesh.corner[np.stack([mesh.after[on], mesh.before[on]])]]
    part = np.arange(1, 8)[None, :, None] / 8
    at = (ends[0][:, None] + (ends[1] - ends[0])[:, None] * part)[:, :: 1 - 2 * (seed % 2)].reshape(-1, 2)
    finer = cut(mesh, np.repeat(on, 7), at, 1000.0)
    h = sound(finer)
    assert wrong_by(finer, h[(finer.label[h] < 0) & (h < finer.across[h])]) <= 2.0**-44
    length = np.hypot(*(finer.points[finer.corner[finer.after]] - finer.points[finer.corner[finer.before]]).T)
    whole = np.hypot(*(ends[0] - ends[1]).T).sum()
    assert length[h[finer.label[h] >= 0]].sum() / 2 == pytest.approx(whole, rel=1e-9)  # no piece is lost
    assert finer.count == 2 * len(finer.points) - 6


def test_a_corner_on_a_segment_to_rounding_closes_it():
    """A place that would stand on the corner is left out, and the two ways past the corner are on the segment."""
    points = np.array([(0.0, 0.0), (10.0, 1.0), (5.0, 0.5 + 5e-16), (5.0, 4.0)])
    mesh = constrained(framed(points), np.array([[0, 1], [2, 3]]))
    assert (mesh.label == 0).sum() == 2  # it is not on it
    h = int(np.flatnonzero(mesh.label == 0)[0])
    finer = cut(mesh, np.array([h]), points[2:3], 10.0)
    h = np.flatnonzero(finer.label >= 0)
    on = np.stack([finer.corner[finer.after[h]], finer.corner[finer.before[h]]], axis=1).tolist()
    assert [0, 2] in on
    assert [2, 1] in on


def work(monkeypatch, count):
    """How many points are looked at where segments take the place of edges."""
    looked = []
    inner = constrained_delaunay.filled
    monkeypatch.setattr(
        constrained_delaunay, "filled", lambda at, a, b, chain: looked.append(len(chain)) or inner(at, a, b, chain)
    )
    height = np.arange(count) / count
    a, b = np.stack([0 * height, height], axis=1), np.stack([0 * height + 1000, height], axis=1)
    random = np.random.default_rng(0)
    a, b = a + random.random((count, 2)) / count / 4, b + random.random((count, 2)) / count / 4
    segments = np.arange(2 * count).reshape(2, -1).T
    constrained(framed(np.concatenate([a, b])), segments)
    monkeypatch.setattr(constrained_delaunay, "filled", inner)
    return sum(looked)


def test_long_segments_near_one_another_are_n_log_n(monkeypatch):
    """Each crosses what is between the ends of all others, unless some of these are in already."""
    few, many = work(monkeypatch, 400), work(monkeypatch, 800)
    assert few > 0
    assert many <= 2.5 * few


def test_turns_grow_as_the_points_do():
    squares = [delaunay(framed(np.concatenate([SQUARE * k / n for k in range(1, n + 1)]))).turned for n in (250, 500)]
    assert squares[1] <= 2.3 * squares[0]
