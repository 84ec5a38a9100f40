"""The exact nearest points of lines and arcs, for what was found on the lines put in their place."""

from __future__ import annotations

import numpy as np

from wallkit.geometry.exact_edges import ComplexArray, ExactEdges
from wallkit.walls.walls import Walls


def exact_edges(walls: Walls) -> ExactEdges:
    """Take all edges of walls."""
    starts = walls.edge_starts
    return ExactEdges.of(walls.vertices[starts], walls.vertices[walls.edge_ends], walls.bulges[starts])


def nearest_pair(edges: ExactEdges, a: complex, b: complex, reach: float) -> tuple[complex, complex]:
    """Sharpen two points of two walls to the two that are nearest to each other thereabouts.

    Nearest points are ends of edges with their feet on the other edge, or the points of two circles (of a circle
    and a line) on the line through both centres (through the centre, square to the line): all are tried.

    Args:
        edges: all edges.
        a: a point within ``reach`` of one of them.
        b: a point within ``reach`` of another.
        reach: how far the points may move.
    """
    every = np.ones(len(edges.a), dtype=np.complex128)
    near_a = np.flatnonzero(np.abs(edges.nearest(a * every) - a) <= reach)
    near_b = np.flatnonzero(np.abs(edges.nearest(b * every) - b) <= reach)
    one, two = (grid.ravel() for grid in np.meshgrid(near_a, near_b, indexing="ij"))
    one, two = one[one != two], two[one != two]
    e, f = edges.take(one), edges.take(two)
    best, width = (a, b), np.inf
    for seed in _seeds(e, f):
        q = f.nearest(seed)
        p = e.nearest(q)
        here = (np.abs(p - a) <= reach) & (np.abs(q - b) <= reach) & (np.abs(p - q) >= abs(a - b) / 2)
        distance = np.where(here, np.abs(p - q), np.inf)
        if len(distance) and distance.min() < width:
            k = int(distance.argmin())
            best, width = (complex(p[k]), complex(q[k])), float(distance[k])
    return best


def _seeds(e: ExactEdges, f: ExactEdges) -> list[ComplexArray]:
    """Points on or near ``e`` that its nearest point to ``f`` is among, once it is projected to and fro."""
    seeds = [e.a, e.b, e.nearest(f.a), e.nearest(f.b)]
    to_line = 1j * (f.b - f.a)
    towards = np.where(f.radius > 0, f.centre - e.centre, to_line)
    with np.errstate(divide="ignore", invalid="ignore"):
        towards = np.where(towards != 0, towards / np.abs(towards), 1)
    around = (e.centre + side * e.radius * towards for side in (1, -1))
    return seeds + [np.where(e.radius > 0, place, e.nearest(f.centre)) for place in around]
