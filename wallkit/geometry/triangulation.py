"""A constrained Delaunay triangulation of walls, in a frame around everything; walls can be cut further."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from wallkit.geometry.arrays import FloatArray, IntArray
from wallkit.geometry.box_tree import BoxTree
from wallkit.geometry.constrained_delaunay import constrained
from wallkit.geometry.delaunay import edge_keys
from wallkit.geometry.same_points import SAME, merged

MOST_TURNS, MORE_TURNS = 100_000, 4
"""Edges of the Delaunay triangulation that walls take the place of, and so many more for each piece of a wall."""
_FRAME = 4.0  # in diagonals: the frame is far enough to count as outside


@dataclass(eq=False)
class Triangulation:
    """Triangles of points, the walls among their edges.

    Attributes:
        points: (P, 2); the last four are the frame.
        corners: (T, 3) points of each triangle, counter-clockwise with y up.
        neighbours: (T, 3) the triangle opposite each corner, or -1.
        edge: (T, 3) number of the edge opposite each corner.
        ends: (N, 2) points of each edge, the smaller number first.
        wall: (N,) the edge is a piece of a wall.
        outer: (N,) the edge is on the frame.
        length: (N,) of each edge.
        given: how many points, the first, are ends of given segments.
        size: the diagonal of everything in the frame.
    """

    points: FloatArray
    corners: IntArray
    neighbours: IntArray
    edge: IntArray
    ends: IntArray
    wall: NDArray[np.bool_]
    outer: NDArray[np.bool_]
    length: FloatArray
    given: int
    size: float

    @cached_property
    def boxes(self) -> BoxTree:
        """The boxes around the triangles."""
        corners = self.points[self.corners]
        return BoxTree(corners.min(axis=1).T, corners.max(axis=1).T)


def triangulate(a: FloatArray, b: FloatArray) -> Triangulation | None:
    """Triangulate segments from ``a`` to ``b``, (n, 2) each, that meet at their ends only; None for a tangle.

    Every segment is an edge then; points as near as 1e-11 of the whole are one. A tangle is where walls would take
    the place of more than 100,000 edges between points that they part, and four more for each wall.
    """
    points, which = np.unique(np.concatenate([a, b]), axis=0, return_inverse=True)
    kept, which = np.unique(merged(points)[which.reshape(-1)], return_inverse=True)
    points, pieces = points[kept], which.reshape(2, -1).T
    return _triangulated(points, pieces, len(points))


def cut_further(mesh: Triangulation, edge: IntArray, at: FloatArray) -> Triangulation | None:
    """Triangulate once more, with (n, 2) places ``at`` on edges (n,) that are pieces of walls among the points.

    What is as near as 1e-11 of the whole to an end of the piece, or to the place before, is left out.
    """
    same = SAME * mesh.size
    p, q = (mesh.points[mesh.ends[edge, k]] for k in (0, 1))
    along = ((at - p) * (q - p)).sum(axis=1) / mesh.length[edge]
    order = np.lexsort((along, edge))
    edge, at, along = edge[order], at[order], along[order]
    again = np.append(False, (edge[1:] == edge[:-1]) & (np.diff(along) <= same))[: len(edge)]
    new = ~again & (along > same) & (along < mesh.length[edge] - same)
    edge, at, along = edge[new], at[new], along[new]
    return _triangulated(*_cut(mesh, edge, at, along), mesh.given)


def _cut(mesh: Triangulation, edge: IntArray, at: FloatArray, along: FloatArray) -> tuple[FloatArray, IntArray]:
    """Points and pieces of walls, cut at places that are in order along each edge."""
    walls = np.flatnonzero(mesh.wall)
    known = mesh.points[:-4]
    row = np.concatenate([walls, edge, walls])
    whole = mesh.length[walls]
    order = np.lexsort((np.concatenate([np.full(len(walls), -1.0), along, whole + 1]), row))
    row = row[order]
    vertex = np.concatenate([mesh.ends[walls, 0], len(known) + np.arange(len(at)), mesh.ends[walls, 1]])[order]
    joined = row[1:] == row[:-1]
    return np.concatenate([known, at]), np.stack([vertex[:-1][joined], vertex[1:][joined]], axis=1)


def _triangulated(points: FloatArray, pieces: IntArray, given: int) -> Triangulation | None:
    """Triangulate pieces of walls between points, (n, 2) numbers of their ends."""
    low, high = points.min(axis=0), points.max(axis=0)
    middle, size = (low + high) / 2, float(np.hypot(*(high - low))) or 1.0
    moved = points - middle  # for the sake of their digits
    _, first, alike = np.unique(moved[:, 0] + 1j * moved[:, 1], return_index=True, return_inverse=True)
    kept, pieces = np.unique(first[alike[pieces]], return_inverse=True)
    points, pieces = points[kept], pieces.reshape(-1, 2)
    pieces = pieces[pieces[:, 0] != pieces[:, 1]]
    frame = _FRAME * size * np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]])
    found = constrained(np.concatenate([moved[kept], frame]), pieces, MOST_TURNS + MORE_TURNS * len(pieces))
    if found is None:
        return None
    corners, walls = found
    everything = np.concatenate([points, frame + middle])
    sides = np.stack([corners[:, [1, 2]], corners[:, [2, 0]], corners[:, [0, 1]]], axis=1)
    keys, edge = np.unique(edge_keys(sides.reshape(-1, 2), len(everything)), return_inverse=True)
    edge = edge.reshape(-1, 3)
    neighbours = _neighbours(edge)
    outer = np.zeros(len(keys), dtype=np.bool_)
    outer[edge[neighbours < 0]] = True
    ends = np.stack(np.divmod(keys, len(everything)), axis=1)
    length = np.hypot(*(everything[ends[:, 1]] - everything[ends[:, 0]]).T)
    wall = np.isin(keys, edge_keys(walls, len(everything)))
    return Triangulation(everything, corners, neighbours, edge, ends, wall, outer, length, given, size)


def _neighbours(edge: IntArray) -> IntArray:
    """The triangle on the other side of each edge of each triangle, -1 without one: (T, 3)."""
    order = np.argsort(edge.ravel(), kind="stable")
    same = edge.ravel()[order][1:] == edge.ravel()[order][:-1]
    one, two = order[:-1][same], order[1:][same]
    beyond = np.full(edge.size, -1, dtype=np.int64)
    beyond[one], beyond[two] = two // 3, one // 3
    return beyond.reshape(-1, 3)
