"""A constrained Delaunay triangulation of walls, in a frame around everything; walls can be cut further."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from wallkit.geometry.arrays import FloatArray, IntArray
from wallkit.geometry.box_tree import BoxTree
from wallkit.geometry.constrained_delaunay import constrained
from wallkit.geometry.cut_edges import cut
from wallkit.geometry.half_edges import HalfEdges
from wallkit.geometry.same_points import SAME, merged

MOST_CROSSED, MORE_CROSSED = 100_000, 4
"""Edges of the Delaunay triangulation that walls take the place of, and so many more for each piece of a wall."""
_FRAME = 4.0  # in diagonals: the frame is far enough to count as outside


@dataclass(eq=False, repr=False)
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
        middle: (2,) of everything.
        half_edges: the same triangles; their points are relative to the middle.
        half: (N,) a half-edge of each edge.
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
    middle: FloatArray
    half_edges: HalfEdges
    half: IntArray

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
    low, high = points.min(axis=0), points.max(axis=0)
    middle, size = (low + high) / 2, float(np.hypot(*(high - low))) or 1.0
    moved = points - middle  # for the sake of their digits
    _, first, alike = np.unique(moved[:, 0] + 1j * moved[:, 1], return_index=True, return_inverse=True)
    kept, pieces = np.unique(first[alike[pieces]], return_inverse=True)
    points, pieces = points[kept], pieces.reshape(-1, 2)
    pieces = pieces[pieces[:, 0] != pieces[:, 1]]
    frame = _FRAME * size * np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]])
    found = constrained(np.concatenate([moved[kept], frame]), pieces, MOST_CROSSED + MORE_CROSSED * len(pieces))
    if found is None:
        return None
    return _of(found, np.concatenate([points, frame + middle]), len(points), size, middle)


def cut_further(mesh: Triangulation, edge: IntArray, at: FloatArray) -> Triangulation:
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
    edge, at = edge[new], at[new]
    finer = cut(mesh.half_edges, mesh.half[edge], at - mesh.middle, mesh.size)
    points = np.concatenate([mesh.points[:-4], at, mesh.points[-4:]])
    return _of(finer, points, mesh.given, mesh.size, mesh.middle)


def _of(net: HalfEdges, points: FloatArray, given: int, size: float, middle: FloatArray) -> Triangulation:
    """Number the edges by their ends."""
    used = 3 * net.count
    corner, across = net.corner[:used], net.across[:used]
    half = np.flatnonzero(across < np.arange(used))
    begin, end = corner[net.after[half]], corner[net.before[half]]
    net.rest()
    ends = np.stack([np.minimum(begin, end), np.maximum(begin, end)], axis=1)
    order = np.argsort(ends[:, 0] * len(points) + ends[:, 1])
    half, ends = half[order], ends[order]
    edge = np.empty(used, dtype=np.int64)
    edge[half] = np.arange(len(half))
    outer = across[half] < 0
    edge[across[half[~outer]]] = np.flatnonzero(~outer)
    return Triangulation(
        points=points,
        corners=corner.reshape(-1, 3),
        neighbours=np.where(across >= 0, across // 3, -1).reshape(-1, 3),
        edge=edge.reshape(-1, 3),
        ends=ends,
        wall=net.label[half] >= 0,
        outer=outer,
        length=np.hypot(*(points[ends[:, 1]] - points[ends[:, 0]]).T),
        given=given,
        size=size,
        middle=middle,
        half_edges=net,
        half=half,
    )
