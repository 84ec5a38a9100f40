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
from wallkit.kernels.rooms import widest_ways as kernels
from wallkit.walls.checking.rooms_by_kernels import one_by_one


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

    used: IntArray
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
    roomy = np.concatenate([frame, circle])
    parent = np.arange(len(roomy))
    parent[outer] = outer[0]
    order = np.argsort(-ways.width, kind="stable")
    given = ways.one[order], ways.two[order], ways.width[order], roomy, float(narrow), float(least)
    used, joined = np.zeros(len(roomy), dtype=np.int64), np.zeros(3 * len(roomy), dtype=np.int64)
    count, rooms = one_by_one(kernels.unite, mesh, given, (parent, used, joined))
    while (parent[parent] != parent).any():
        parent = parent[parent]
    roots = distinct(parent[: len(circle)])
    closed: list[int] = roots[(roomy[roots] > least) & (roomy[roots] < math.inf)].tolist()
    parted = joined[: 3 * rooms].reshape(-1, 3)
    into_outside = np.isinf(roomy[parted[:, 2]])
    found = zip(order[parted[:, 0]].tolist(), parted[:, 1].tolist(), into_outside.tolist(), strict=True)
    return Joined(order[used[:count]], [Room(*one) for one in found], closed)


def _outer(mesh: Triangulation) -> IntArray:
    """The triangles at the frame."""
    return np.flatnonzero(mesh.outer[mesh.edge].sum(axis=1))


class WaysOut(NamedTuple):
    """From each node to the outside, along the tree.

    Attributes:
        before: the next node on the way; -1 at the outside, and where there is no way.
        step: the way that leads there, -1 likewise.
        narrowest: width of the narrowest of all ways to the outside; infinite there, 0 where there is none.
    """

    before: IntArray
    step: IntArray
    narrowest: FloatArray


def ways_out(mesh: Triangulation, ways: Ways, used: IntArray) -> WaysOut:
    """Walk the tree from the outside."""
    nodes = 2 * len(mesh.corners)
    one, two = np.concatenate([ways.one[used], ways.two[used]]), np.concatenate([ways.two[used], ways.one[used]])
    order = np.argsort(one, kind="stable")
    first = np.searchsorted(one[order], np.arange(nodes + 1))
    outer = _outer(mesh)
    out = WaysOut(np.full(nodes, -1), np.full(nodes, -1), np.zeros(nodes))
    out.narrowest[outer] = np.inf
    reached = np.zeros(nodes, dtype=np.int64)
    reached[: len(outer)] = outer
    given = first, two[order], np.tile(used, 2)[order], ways.width, len(outer)
    one_by_one(kernels.walk_out, mesh, given, (*out, reached))
    return out
