"""A million edges through contacts, nesting, checks and the grid; run with `pytest benchmarks/test_walls_speed.py`.

Measured figures are in docs/walls.md. Memory is the highest of the whole process.
"""

from __future__ import annotations

import resource

import numpy as np
import pytest

from wallkit.walls.checking.self_check import straight_edges, validate
from wallkit.walls.crossings import find_touches
from wallkit.walls.edge_tree import Edges
from wallkit.walls.nesting import depths
from wallkit.walls.orient import oriented
from wallkit.walls.walls import Walls


def wobbly_rings():
    """10,000 rings of 100 edges side by side."""
    rng = np.random.default_rng(0)
    angle = np.linspace(0, 2 * np.pi, 100, endpoint=False)
    radius = 3 * (1 + 0.1 * rng.normal(size=(10_000, 100)))
    centre = np.stack(np.meshgrid(np.arange(100), np.arange(100)), -1).reshape(-1, 1, 2) * 10.0
    return centre + np.stack([radius * np.cos(angle), radius * np.sin(angle)], -1)


def rings_in_rings():
    """1,000 rings of 1,000 edges, each in the next."""
    angle = np.linspace(0, 2 * np.pi, 1000, endpoint=False)
    return np.arange(1, 1001)[:, None, None] * np.stack([np.cos(angle), np.sin(angle)], -1)


def squares_in_squares():
    """250,000 squares, each in the next: as deep as a million edges go."""
    size = np.arange(1, 250_001)[:, None] * 0.1
    corners = [np.concatenate([x * size, y * size], 1) for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
    return np.stack(corners, axis=1)


@pytest.mark.parametrize("rings", [wobbly_rings, rings_in_rings, squares_in_squares])
def test_a_million_edges(benchmark, rings):
    points = rings()
    count = len(points)
    walls = Walls.from_polylines(list(points))
    assert len(walls.vertices) == 1_000_000

    def whole():
        edges = straight_edges(walls)
        touches = find_touches(edges)
        turned = oriented(walls, False, edges, touches)
        return turned, validate(turned, edges=edges, touches=touches)

    turned, problems = benchmark.pedantic(whole, rounds=1)
    assert problems == []
    assert turned.depth.max() in (0, count - 1)
    benchmark.extra_info["peak_GB"] = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e6


def test_depth_of_a_million_edges_alone(benchmark):
    points = squares_in_squares()
    edges = Edges(points.reshape(-1, 2), np.arange(250_001) * 4, np.ones(250_000, dtype=bool))
    depth, _ = benchmark.pedantic(lambda: depths(edges), rounds=1)
    assert depth.max() == 249_999
