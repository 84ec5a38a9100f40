"""How free space hangs together: triangles and the circles in them, united from the widest way down.

A disc of diameter d gets from a triangle to the next over an edge longer than d, and no other: the ends of an edge are
on walls, so that it passes no shorter one; and where walls with a narrow place between them part two rooms, some edges
as short as that part them, since all narrow places are edges (narrow_places.py). A circle of radius r in a triangle is
joined to it by a way 2 r wide.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from wallkit.geometry.arrays import FloatArray, IntArray, distinct
from wallkit.geometry.triangulation import Triangulation


class Room(NamedTuple):
    """A room that was joined to a larger one, or to the outside.

    Attributes:
        way: the number of the way that joined it.
        node: the node with its roomiest circle.
        outside: it was joined to the outside.
    """

    way: int
    node: int
    outside: bool


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Ways:
    """Ways between nodes: triangles by number, and (number of triangles + triangle) the circles in them.

    Attributes:
        one: (n,) the triangle that each leads from.
        two: (n,) the triangle that it leads to, or the circle in it.
        width: (n,) of each.
        edge: (n,) the edge that it leads over; -1 for that to a circle.
    """

    one: IntArray
    two: IntArray
    width: FloatArray
    edge: IntArray

    @classmethod
    def of(cls, mesh: Triangulation, circle: FloatArray, where: NDArray[np.bool_]) -> Ways:
        """Take all edges but walls from the triangles ``where`` (T,), and circles of (T,) radii, if above 0."""
        count = len(mesh.corners)
        triangle, beyond, edge = np.repeat(np.arange(count), 3), mesh.neighbours.ravel(), mesh.edge.ravel()
        free = (beyond > triangle) & ~mesh.wall[edge] & where[triangle]
        triangle, beyond, edge = triangle[free], beyond[free], edge[free]
        own = np.flatnonzero((circle > 0) & where)
        return cls(
            np.concatenate([triangle, own]),
            np.concatenate([beyond, count + own]),
            np.concatenate([mesh.length[edge], 2 * circle[own]]),
            np.concatenate([edge, np.full(len(own), -1)]),
        )


@dataclass(frozen=True, slots=True)
class Joined:
    """What came of uniting everything.

    Attributes:
        used: the ways that joined what was not joined before: a tree, as wide as can be.
        rooms: those joined to larger ones, the widest way first.
        closed: the nodes with the roomiest circles of the parts that no way leads out of.
    """

    used: list[int]
    rooms: list[Room]
    closed: list[int]


def unite(mesh: Triangulation, ways: Ways, circle: FloatArray, narrow: float, least: float) -> Joined:
    """Unite nodes from the widest way down.

    Args:
        mesh: the triangles.
        ways: between them and the circles.
        circle: (T,) radii.
        narrow: of what is joined over a way up to this part as wide as its roomiest circle a room is noted.
        least: smaller circles are no rooms.
    """
    outer = _outer(mesh)
    frame = np.zeros(len(circle))
    frame[outer] = np.inf
    roomy = np.concatenate([frame, circle]).tolist()  # of a root: the radius of the roomiest circle
    parent = list(range(len(roomy)))
    for triangle in outer:
        parent[triangle] = outer[0]
    best = list(range(len(roomy)))
    used: list[int] = []
    rooms: list[Room] = []
    order = np.argsort(-ways.width, kind="stable")
    columns = (order, ways.one[order], ways.two[order], ways.width[order])
    for way, one, two, width in zip(*(column.tolist() for column in columns), strict=True):
        while parent[one] != one:  # to its root, with the path halved on the way
            parent[one] = one = parent[parent[one]]
        while parent[two] != two:
            parent[two] = two = parent[parent[two]]
        if one == two:
            continue
        used.append(way)
        if roomy[one] < roomy[two]:
            one, two = two, one
        if 2 * narrow * roomy[two] >= width > 0 and roomy[two] > least:
            rooms.append(Room(way, best[two], math.isinf(roomy[one])))
        parent[two] = one
    root = np.array(parent)
    while (root[root] != root).any():
        root = root[root]
    roots: list[int] = distinct(root[: len(circle)]).tolist()
    return Joined(used, rooms, [best[node] for node in roots if least < roomy[node] < math.inf])


def _outer(mesh: Triangulation) -> list[int]:
    """The triangles at the frame."""
    triangles: list[int] = np.flatnonzero(mesh.outer[mesh.edge].sum(axis=1)).tolist()
    return triangles


class WaysOut(NamedTuple):
    """From each node to the outside, along the tree.

    Attributes:
        before: the next node on the way; -1 at the outside, and where there is no way.
        step: the way that leads there, -1 likewise.
        narrowest: width of the narrowest of all ways to the outside; infinite there, 0 where there is none.
    """

    before: list[int]
    step: list[int]
    narrowest: list[float]


def ways_out(mesh: Triangulation, ways: Ways, used: list[int]) -> WaysOut:
    """Walk the tree from the outside."""
    nodes, tree = 2 * len(mesh.corners), np.array(used, dtype=np.int64)
    one, two = np.concatenate([ways.one[tree], ways.two[tree]]), np.concatenate([ways.two[tree], ways.one[tree]])
    order = np.argsort(one, kind="stable")
    first = np.searchsorted(one[order], np.arange(nodes + 1)).tolist()
    other, number, width = two[order].tolist(), np.tile(tree, 2)[order].tolist(), ways.width.tolist()
    before, step, narrowest = [-1] * nodes, [-1] * nodes, [0.0] * nodes
    reached = _outer(mesh)
    for node in reached:
        narrowest[node] = math.inf
    for node in reached:  # which grows on the way
        for k in range(first[node], first[node + 1]):
            if narrowest[other[k]] == 0:
                before[other[k]], step[other[k]] = node, number[k]
                narrowest[other[k]] = min(narrowest[node], width[number[k]])
                reached.append(other[k])
    return WaysOut(before, step, narrowest)
