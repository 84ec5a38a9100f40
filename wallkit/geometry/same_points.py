"""Points that are as near as rounding count as one."""

from __future__ import annotations

import numpy as np

from wallkit.geometry.arrays import FloatArray, IntArray
from wallkit.geometry.components import components

SAME = 1e-11
"""Of the diagonal of everything: points as near are one."""


def merged(points: FloatArray) -> IntArray:
    """For each of (n, 2) points the first of those that are as near as rounding; of a chain of such, the first: (n,).

    A triangulation would leave the others out, and lines that meet in one point would meet in many.
    """
    if not len(points):
        return np.empty(0, dtype=np.int64)
    size = float(np.hypot(*(points.max(axis=0) - points.min(axis=0)))) or 1.0
    alike, number = np.unique(points, axis=0, return_inverse=True)
    group = components(*_near_pairs(alike, SAME * size), len(alike))[number.reshape(-1)]
    _, first, group = np.unique(group, return_index=True, return_inverse=True)
    chosen: IntArray = first[group.reshape(-1)].astype(np.int64)
    return chosen


def _near_pairs(points: FloatArray, same: float) -> tuple[IntArray, IntArray]:
    """Pairs of points no farther apart than ``same``: (n,) each.

    Steps of more than that part the x that are taken, and the y, into groups. Points that are near are in one group
    by both, and there among those that follow by x until that is too far off.
    """
    cell = _group(points[:, 0], same) * len(points) + _group(points[:, 1], same)
    order = np.lexsort((points[:, 0], cell))
    cell, x, y = cell[order], *points[order].T
    pairs = []
    rows, ahead = np.arange(len(points)), 1
    while True:
        rows = rows[rows + ahead < len(points)]
        rows = rows[(cell[rows + ahead] == cell[rows]) & (x[rows + ahead] - x[rows] <= same)]
        if not len(rows):
            break
        near = rows[np.hypot(x[rows + ahead] - x[rows], y[rows + ahead] - y[rows]) <= same]
        pairs.append(np.stack([order[near], order[near + ahead]]))
        ahead += 1
    one, two = np.concatenate([np.empty((2, 0), dtype=np.int64), *pairs], axis=1)
    return one, two


def _group(values: FloatArray, same: float) -> IntArray:
    """Number the runs of values that steps of at most ``same`` join: (n,)."""
    order = np.argsort(values)
    group = np.empty(len(values), dtype=np.int64)
    group[order] = np.cumsum(np.diff(values[order], prepend=-np.inf) > same)
    return group
