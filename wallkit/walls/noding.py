"""Noding: walls as pieces that meet at their ends only, cut where they cross, touch and lie on one another."""

from __future__ import annotations

import numpy as np

from wallkit.geometry.arrays import FloatArray, IntArray
from wallkit.geometry.same_points import merged
from wallkit.walls.crossings import Touches
from wallkit.walls.edge_tree import Edges

MOST_CROSSINGS = 20_000
"""Walls that cross more often are a tangle: the faces between them are not looked at."""


def noded(edges: Edges, touches: Touches) -> tuple[FloatArray, FloatArray]:
    """Cut edges where they meet: the ends of the pieces, (n, 2) each, every piece once.

    What meets nothing keeps its bits and its order. A new point is off both lines by rounding alone, and points as
    near as 1e-11 of the whole are one of them, so that no piece crosses another by rounding. n log n for n edges
    and meetings.

    Args:
        edges: of the walls.
        touches: all of these edges (``complete``).
    """
    own = touches.copy_of[edges.wall] == edges.wall
    if own.all() and not len(touches.cut_edge):
        return edges.a, edges.b
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
    once: IntArray = np.sort(np.unique(keys, return_index=True)[1])
    return points[pieces[once, 0]], points[pieces[once, 1]]
