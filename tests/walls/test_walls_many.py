"""Many edges and curves: near pairs as by comparing all with all, and blocks that make no difference."""

from itertools import pairwise

import numpy as np
import pytest
import shapely

import wallkit
from wallkit.geometry import rings as rings_of_walls
from wallkit.geometry.box_tree import BoxTree
from wallkit.geometry.ragged import portions
from wallkit.walls import as_shapely, edge_tree
from wallkit.walls.edge_tree import Edges, EdgeTree
from wallkit.walls.importing import curves_to_lines
from wallkit.walls.importing.arc_fitting import curves_to_arcs


def polylines(seed):
    """Walks, some of which stand still, run straight, or come back over themselves, with long monotone parts."""
    rng = np.random.default_rng(seed)
    lines = []
    for _ in range(12):
        steps = rng.integers(-3, 4, (rng.integers(2, 60), 2)).astype(np.float64)
        steps[: len(steps) // 2] = np.abs(steps[: len(steps) // 2])
        lines.append(rng.integers(0, 40, 2) + np.cumsum(steps, axis=0))
    counts = [len(line) for line in lines]
    return Edges(np.concatenate(lines), np.concatenate([[0], np.cumsum(counts)]), rng.random(12) < 0.5)


def boxes(edges):
    return np.minimum(edges.a, edges.b), np.maximum(edges.a, edges.b)


def all_with_all(edges, rows):
    low, high = boxes(edges)
    meets = ((low[rows, None] <= high[None, rows]) & (high[rows, None] >= low[None, rows])).all(axis=2)
    found = set()
    for i, j in np.argwhere(meets).tolist():
        first, second = rows[i], rows[j]
        neighbours = edges.stop[first] == edges.start[second] or edges.stop[second] == edges.start[first]
        if first < second and not neighbours:
            found.add((int(first), int(second)))
    return found


@pytest.mark.parametrize("seed", range(20))
def test_near_pairs_are_those_of_all_with_all_each_once(seed):
    edges = polylines(seed)
    rows = np.arange(len(edges))
    for some in (None, rows[edges.wall % 3 != 0]):
        pairs = [pair for part in edges.near_pairs(some) for pair in zip(*(x.tolist() for x in part), strict=True)]
        assert len(pairs) == len(set(pairs))
        assert set(pairs) == all_with_all(edges, rows if some is None else some)


def test_edges_on_one_line_and_rings_in_rings_have_the_same_pairs():
    there_and_back = np.array([[float(k), 0.0] for k in [*range(30), *range(29, 0, -1)]])
    turn = 2 * np.pi * np.arange(64) / 64
    rings = [k * np.stack([np.cos(turn), np.sin(turn)], axis=1) for k in range(1, 9)]
    for lines in ([there_and_back, there_and_back + np.array([0.5, 0.0])], rings):
        counts = [len(line) for line in lines]
        offsets = np.concatenate([[0], np.cumsum(counts)])
        edges = Edges(np.concatenate(lines), offsets, np.full(len(lines), lines is rings))
        pairs = {pair for part in edges.near_pairs() for pair in zip(*(x.tolist() for x in part), strict=True)}
        assert pairs == all_with_all(edges, np.arange(len(edges)))


def test_boxes_find_the_edges_that_they_meet():
    edges = polylines(3)
    low, high = boxes(edges)
    rng = np.random.default_rng(4)
    corner = rng.uniform(-10, 60, (50, 2))
    size = rng.uniform(0, 9, (50, 2))
    source, edge = EdgeTree(edges, np.arange(len(edges))).query(shapely.box(*corner.T, *(corner + size).T))
    meets = ((low[None] <= (corner + size)[:, None]) & (high[None] >= corner[:, None])).all(axis=2)
    assert set(zip(source.tolist(), edge.tolist(), strict=True)) == {(i, j) for i, j in np.argwhere(meets).tolist()}
    assert (np.diff(source) >= 0).all()


def many_curves():
    """Rings of smooth cubics, a wavy line of 60, and loops."""
    rng = np.random.default_rng(5)
    data = []
    for x in range(0, 600, 60):
        points = rng.uniform(0, 50, (8, 3, 2)) + np.array([x, 0])
        data.append(f"M{x},0" + "".join("C" + " ".join(f"{u:.3f},{v:.3f}" for u, v in p) for p in points) + "Z")
    waves = "".join(f"S{10 * k + 7},{100 + 20 * (k % 2)} {10 * k + 10},110" for k in range(60))
    data.append("M0,110" + waves)
    paths = "".join(f'<path fill="none" stroke="#000" d="{d}"/>' for d in data)
    return wallkit.read_drawing_text(f'<svg xmlns="http://www.w3.org/2000/svg">{paths}</svg>')


def test_lines_are_the_same_in_any_blocks(monkeypatch):
    drawing = many_curves()
    whole = wallkit.import_walls(drawing, curves="lines", tolerance=0.01)
    monkeypatch.setattr(curves_to_lines, "_BLOCK", 7)
    parts = wallkit.import_walls(drawing, curves="lines", tolerance=0.01)
    np.testing.assert_array_equal(whole.vertices, parts.vertices)
    assert whole.measured_error == parts.measured_error


def test_arcs_are_the_same_in_any_blocks(monkeypatch):
    drawing = many_curves()
    whole = wallkit.import_walls(drawing, curves="arcs", tolerance=0.01)
    monkeypatch.setattr(curves_to_arcs, "_BLOCK", 3)
    parts = wallkit.import_walls(drawing, curves="arcs", tolerance=0.01)
    np.testing.assert_array_equal(whole.offsets, parts.offsets)
    np.testing.assert_array_equal(whole.vertices, parts.vertices)
    np.testing.assert_array_equal(whole.bulges, parts.bulges)
    assert whole.measured_error == parts.measured_error
    assert whole.measured_normal_error == parts.measured_normal_error


def test_walls_and_what_is_found_of_them_are_the_same_in_any_portions(monkeypatch):
    drawing = many_curves()
    whole = wallkit.import_walls(drawing, curves="arcs", tolerance=0.01, flip_y=True)
    assert {problem.code for problem in whole.problems} >= {"self-crossing", "open-path"}
    for module in (edge_tree, rings_of_walls):
        monkeypatch.setattr(module, "portions", lambda of: portions(of, 5))
    for module in (edge_tree, as_shapely):
        monkeypatch.setattr(module, "AT_ONCE", 3)
    parts = wallkit.import_walls(drawing, curves="arcs", tolerance=0.01, flip_y=True)
    for name in ("offsets", "vertices", "bulges", "depth"):
        np.testing.assert_array_equal(getattr(whole, name), getattr(parts, name))
    assert whole.problems == parts.problems


@pytest.mark.parametrize("about", [1, 3, 10, 1000])
def test_portions_have_all_rows_in_order_each_once(about):
    counts = np.array([0, 0, 3, 0, 7, 1, 1, 1, 30, 2, 0, 0])
    offsets = np.concatenate([[0], np.cumsum(counts)])
    ranges = list(portions(offsets, about))
    assert [row for first, stop in ranges for row in range(first, stop)] == list(range(len(counts)))
    # what begins in one of the stretches of ``about`` entries, and the last of these with all that it has
    assert all(offsets[stop - 1] - offsets[first] < about for first, stop in ranges)
    assert list(portions(np.zeros(1, dtype=np.int64))) == []


def test_areas_and_turned_rings_are_those_of_shapely_in_any_portions(monkeypatch):
    rng = np.random.default_rng(6)
    counts = rng.integers(3, 9, 40)
    offsets = np.concatenate([[0], np.cumsum(counts)])
    vertices, lines = rng.uniform(-5, 5, (offsets[-1], 2)), np.zeros(offsets[-1])
    rings = [shapely.LinearRing(vertices[a:b]) for a, b in pairwise(offsets.tolist())]
    areas = [shapely.Polygon(ring).area * (1 if ring.is_ccw else -1) for ring in rings if ring.is_simple]
    simple = np.array([ring.is_simple for ring in rings])
    for about in (1, 7, 1 << 14):
        monkeypatch.setattr(rings_of_walls, "portions", lambda of, about=about: portions(of, about))
        for bulges in (None, lines):
            got = rings_of_walls.signed_areas(vertices, bulges, offsets)
            np.testing.assert_allclose(got[simple], areas, rtol=0, atol=1e-13)  # some eps of 100, the largest product
        points, _ = rings_of_walls.turned(vertices, lines, offsets, np.arange(40) % 2 == 0)
        for k, (a, b) in enumerate(pairwise(offsets.tolist())):
            expected = vertices[a:b] if k % 2 else np.roll(vertices[a:b][::-1], 1, axis=0)
            np.testing.assert_array_equal(points[a:b], expected)


@pytest.mark.parametrize("count", [0, 1, 15, 16, 17, 300, 5000])
@pytest.mark.parametrize("shape", ["scattered", "one place", "long", "on a line"])
def test_a_tree_of_boxes_finds_what_shapely_finds(count, shape):
    rng = np.random.default_rng(count)
    low = np.zeros((2, count)) if shape == "one place" else rng.uniform(-1e3, 1e3, (2, count))
    if shape == "on a line":
        low[1] = 7.0
    size = rng.uniform(0, 2e3 / np.sqrt(count + 1), (2, count))
    if shape == "long":
        size[0, ::2] *= 1e3
    high = low + np.where(shape == "one place", 0.0, size)
    tree = BoxTree(low, high)
    own, own_found = tree.query(low[:, :200], high[:, :200])
    for one, other in zip(tree.among(0, 200), (own, own_found), strict=True):
        np.testing.assert_array_equal(one, other)
    corner = rng.uniform(-1.5e3, 1.5e3, (2, 5000))
    for lowest, highest in ((low[:, :200], high[:, :200]), (corner, corner + rng.uniform(0, 300, (2, 5000)))):
        found = np.stack(tree.query(lowest, highest), axis=1)
        expected = shapely.STRtree(shapely.box(*tree.low, *tree.high)).query(shapely.box(*lowest, *highest)).T
        np.testing.assert_array_equal(found, expected.reshape(-1, 2)[np.lexsort(expected.T[::-1])])
