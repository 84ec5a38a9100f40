"""The index: a uniform grid whose cells list what a ball in them can meet.

An entry is in every cell that its wall comes within the radius and a margin of. The margin, a part of the cell, is
far above the rounding of a position and of a cell's border, so a contact is always listed in the cell in which
the centre is at that time: the walk through the cells may stop at the first cell that contains its best contact.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from wallkit.kernels.model import Grid
from wallkit.scene import FloatArray

IntArray = NDArray[np.int64]
MARGIN = 2.0**-16
CELL = 0.7
"""Cell size in units of sqrt(area / edges); measured, flat between 0.5 and 1.2."""


def build_grid(
    lines: FloatArray, edge_ids: IntArray, corners: FloatArray, corner_ids: IntArray, radius: float
) -> tuple[Grid, IntArray, IntArray]:
    """Sort edges and corners into cells.

    Returns:
        The grid, and the ids of edges and corners cell by cell.
    """
    ends = np.concatenate([lines[edge_ids, 0:2], lines[edge_ids, 2:4]])
    low, high = ends.min(axis=0) - radius, ends.max(axis=0) + radius
    size = _cell_size(high - low, len(edge_ids))
    low, high = low - size * MARGIN * 4, high + size * MARGIN * 4
    columns, rows = (int(n) + 1 for n in np.floor((high - low) / size))
    reach = radius + size * MARGIN
    cells, owners = _cells_of_lines(lines[edge_ids], low, size, columns, rows, reach)
    edge_start, sorted_edges = _by_cell(cells, edge_ids[owners], columns * rows)
    points = corners[corner_ids, 0:2]
    cells, owners = _cells_of_lines(np.hstack([points, points]), low, size, columns, rows, reach)
    corner_start, sorted_corners = _by_cell(cells, corner_ids[owners], columns * rows)
    grid = Grid(edge_start, corner_start, float(low[0]), float(low[1]), size, columns, rows)
    return grid, sorted_edges, sorted_corners


def _cell_size(extent: FloatArray, count: int) -> float:
    width, height = float(extent[0]), float(extent[1])
    longest = max(width, height)
    return max(CELL * math.sqrt(width * height / count), longest / (4.0 * count + 64.0), longest * 2.0**-20)


def _cells_of_lines(
    lines: FloatArray, low: FloatArray, size: float, columns: int, rows: int, reach: float
) -> tuple[IntArray, IntArray]:
    """List (cell, line) pairs: column by column, the rows that the line and what is within reach of it cover."""
    ax, ay, bx, by = lines[:, 0], lines[:, 1], lines[:, 2], lines[:, 3]
    left, right = np.minimum(ax, bx) - reach, np.maximum(ax, bx) + reach
    first, last = (_place(x - low[0], size, columns) for x in (left, right))
    line, column = _spread(first, last)
    cell_left = low[0] + column * size - reach
    cell_right = cell_left + size + 2.0 * reach
    steep = np.where(bx != ax, (by - ay) / np.where(bx != ax, bx - ax, 1.0), 0.0)[line]
    flat = (bx != ax)[line]
    low_y, high_y = np.minimum(ay, by)[line], np.maximum(ay, by)[line]
    at_left = ay[line] + (cell_left - ax[line]) * steep
    at_right = ay[line] + (cell_right - ax[line]) * steep
    bottom = np.where(flat, np.clip(np.minimum(at_left, at_right), low_y, high_y), low_y)
    top = np.where(flat, np.clip(np.maximum(at_left, at_right), low_y, high_y), high_y)
    first, last = _place(bottom - reach - low[1], size, rows), _place(top + reach - low[1], size, rows)
    pair, row = _spread(first, last)
    return row * columns + column[pair], line[pair]


def _place(offset: FloatArray, size: float, count: int) -> IntArray:
    return np.clip(np.floor(offset / size), 0, count - 1).astype(np.int64)


def _spread(first: IntArray, last: IntArray) -> tuple[IntArray, IntArray]:
    """Give for each range all its numbers: (which range, number)."""
    counts = last - first + 1
    which = np.repeat(np.arange(len(first)), counts)
    start = np.cumsum(counts) - counts
    return which, np.arange(len(which)) - start[which] + first[which]


def _by_cell(cells: IntArray, ids: IntArray, count: int) -> tuple[IntArray, IntArray]:
    order = np.argsort(cells, kind="stable")
    start = np.zeros(count + 1, dtype=np.int64)
    np.cumsum(np.bincount(cells, minlength=count), out=start[1:])
    return start, ids[order]
