"""Noding: walls as pieces that meet at their ends only, cut where they cross, touch and lie on one another."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from wallkit.geometry.arrays import FloatArray, IntArray
from wallkit.geometry.same_points import merged
from wallkit.walls.crossings import Touches
from wallkit.walls.edge_tree import Edges

MOST_CROSSINGS = 20_000
"""Walls that cross more often are a tangle: the faces between them are not looked at."""


class Pieces(NamedTuple):
    """Walls cut into pieces, every piece once.

    Attributes:
        a: (n, 2) the ends of the pieces.
        b: (n, 2) the other ends.
        piece: (m,) a piece, for each edge that lies on it, the edges of copies of other walls left out.
        wall: (m,) the wall of that edge.
    """

    a: FloatArray
    b: FloatArray
    piece: IntArray
    wall: IntArray


def noded(edges: Edges, touches: Touches) -> Pieces:
    """Cut edges where they meet.

    What meets nothing keeps its bits and its order. A new point is off both lines by rounding alone, and points as
    near as 1e-11 of the whole are one of them, so that no piece crosses another by rounding. n log n for n edges
    and meetings.

    Args:
        edges: of the walls.
        touches: all of these edges (``complete``).
    """
    own = touches.copy_of[edges.wall] == edges.wall
    if own.all() and not len(touches.cut_edge) and not len(touches.overlap_edges):
        return Pieces(edges.a, edges.b, np.arange(len(edges)), edges.wall)
    given, count = len(edges.vertices), len(edges)
    points = np.concatenate([edges.vertices, touches.cut_at])
    row = np.concatenate([np.arange(count), touches.cut_edge, np.arange(count)])
    vertex = np.concatenate([edges.start, given + np.arange(len(touches.cut_edge)), edges.stop])
    d = edges.b - edges.a
    along = ((touches.cut_at - edges.a[touches.cut_edge]) * d[touches.cut_edge]).sum(axis=1)
    whole = (d * d).sum(axis=1)
    order = np.lexsort((np.concatenate([np.full(count, -1.0), along, 2 * whole + 1]), row))
    row, vertex = row[order], merged(points)[vertex[order]]
    joined = (row[1:] == row[:-1]) & own[row[1:]] & (vertex[1:] != vertex[:-1])
    pieces = np.stack([vertex[:-1][joined], vertex[1:][joined]], axis=1)
    keys = pieces.min(axis=1) * len(points) + pieces.max(axis=1)
    _, first, alike = np.unique(keys, return_index=True, return_inverse=True)
    once, wall = np.sort(first), edges.wall[row[1:][joined]]
    piece = np.searchsorted(once, first[alike.reshape(-1)])
    return Pieces(points[pieces[once, 0]], points[pieces[once, 1]], piece, wall)
