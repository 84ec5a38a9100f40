"""Copies: walls that are drawn more than once, to the bit."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from wallkit.geometry.arrays import FloatArray, IntArray
from wallkit.walls.edge_tree import Edges


def copies(edges: Edges, chosen: NDArray[np.bool_], group: IntArray | None = None) -> IntArray:
    """For each wall the first wall with the very same edges (itself, if there is none before): (W,).

    Only walls marked in ``chosen`` are compared, whichever way they run, and closed ones wherever they start. Walls
    of the same box and number of vertices are compared by their bytes: n log n for any number of copies.
    """
    result = np.arange(len(chosen))
    rows = np.flatnonzero(chosen)
    if len(rows) < 2:
        return result
    first = edges.offsets[:-1][rows]
    keep = np.repeat(chosen, np.diff(edges.offsets))
    starts = np.concatenate([[0], np.cumsum(np.diff(edges.offsets)[rows])[:-1]])
    columns = (edges.vertices if keep.all() else edges.vertices[keep]).T
    boxes = [corner.reduceat(column, starts) for corner in (np.minimum, np.maximum) for column in columns]
    groups = group[rows] if group is not None else 0 * first
    table = np.column_stack([*boxes, edges.offsets[rows + 1] - first, edges.closed[rows], groups])
    _, key, repeats = np.unique(table, axis=0, return_inverse=True, return_counts=True)
    key = key.reshape(-1)
    same: dict[bytes, int] = {}
    for row in np.flatnonzero(repeats[key] > 1).tolist():
        wall = int(rows[row])
        vertices = edges.vertices[edges.offsets[wall] : edges.offsets[wall + 1]]
        form = _canonical(vertices, bool(edges.closed[wall])) + int(key[row]).to_bytes(8, "big")
        result[wall] = same.setdefault(form, wall)
    return result


def _canonical(vertices: FloatArray, closed: bool) -> bytes:
    """The same bytes for the same edges: in the direction that comes first, a ring from its smallest vertex."""
    start = np.lexsort((vertices[:, 1], vertices[:, 0]))[0] if closed else 0
    there = np.roll(vertices, -start, axis=0) + 0.0  # -0 is 0
    back = np.roll(there[::-1], 1, axis=0) if closed else there[::-1]
    return min(there.tobytes(), back.tobytes())
