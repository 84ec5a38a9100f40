"""Many edges and curves: near pairs as by comparing all with all, and blocks that make no difference."""

import numpy as np
import pytest
import shapely

import wallkit
from wallkit.geometry.box_tree import BoxTree
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
