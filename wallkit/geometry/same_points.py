"""Points that are as near as rounding count as one."""

from __future__ import annotations

import numpy as np

from wallkit.geometry.arrays import FloatArray, IntArray

SAME = 1e-11
"""Of the diagonal of everything: points as near are one."""


def merged(points: FloatArray) -> IntArray:
    """For each of (n, 2) points the first of those that are as near as rounding; of a chain of such, the first: (n,).

    A triangulation would leave the others out, and lines that meet in one point would meet in many.
    """
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import connected_components
    from scipy.spatial import cKDTree

    if not len(points):
        return np.empty(0, dtype=np.int64)
    size = float(np.hypot(*(points.max(axis=0) - points.min(axis=0)))) or 1.0
    alike, number = np.unique(points, axis=0, return_inverse=True)
    one, two = cKDTree(alike).query_pairs(SAME * size, output_type="ndarray").T
    links = coo_matrix((np.ones(len(one)), (one, two)), shape=(len(alike), len(alike)))
    group = connected_components(links, directed=False)[1][number.reshape(-1)]
    _, first = np.unique(group, return_index=True)
    chosen: IntArray = first[group].astype(np.int64)
    return chosen
