"""The triangulation for beams: every segment an edge, no new points; and segments cut where they meet."""

import numpy as np
import pytest
import shapely

from wallkit.geometry.constrained_delaunay import triangulate
from wallkit.geometry.noded_segments import node
from wallkit.geometry.orientation import side


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
