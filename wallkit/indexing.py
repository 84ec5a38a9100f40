"""The index: a uniform grid whose cells list what a ball in them can meet.

At a contact the centre is at the distance r from what it touches: on one of two lines beside an edge, or on the
arc around a corner that lies between the normals of its edges. An entry is in every cell which that locus crosses
or passes within a margin of (for radii from r to R: within the band between the two). The margin, a part of the
cell, is far above the rounding of a position and of a cell's border, so a contact is always listed in the cell in
which the centre is at that time: the walk through the cells may stop at the first cell that contains its best
contact.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from wallkit.kernels.model import Grid
from wallkit.scene import FloatArray

IntArray = NDArray[np.int64]
MARGIN = 2.0**-16
CELL = 0.8
"""Cell size in units of sqrt(area / edges); measured, flat between 0.5 and 1.2."""
PIECE = math.pi / 4
"""The arc around a corner is entered in chords of at most this angle, with the bow between chord and arc."""


def build_grid(
    lines: FloatArray,
    edge_ids: IntArray,
    corners: FloatArray,
    fans: FloatArray,
    corner_ids: IntArray,
    radii: tuple[float, float],
) -> tuple[Grid, IntArray, IntArray]:
    """Sort edges and corners into cells.

    Args:
        lines: (E, 8) columns of ``Line``.
        edge_ids: which of them to enter.
        corners: (V, 4) columns of ``Corner``.
        fans: (V, 2) angle at which the arc of each corner begins, and how far it goes, radians.
        corner_ids: which of them to enter.
        radii: smallest and largest distance of a centre at a contact.

    Returns:
        The grid, and the ids of edges and corners cell by cell.
    """
    middle, spread = (radii[0] + radii[1]) / 2, (radii[1] - radii[0]) / 2
    ends = np.concatenate([lines[edge_ids, 0:2], lines[edge_ids, 2:4]])
    low, high = ends.min(axis=0) - radii[1], ends.max(axis=0) + radii[1]
    size = _cell_size(high - low, len(edge_ids))
    low, high = low - size * MARGIN * 4, high + size * MARGIN * 4
    columns, rows = (int(n) + 1 for n in np.floor((high - low) / size))
    box = (low, size, columns, rows)
    reach = spread + size * MARGIN
    beside, owners = _beside(lines[edge_ids], edge_ids, middle)
    line_start, sorted_edges = _enter(box, beside, owners, np.full(len(owners), reach))
    chords, bow, owners = _chords(corners[corner_ids, 0:2], fans[corner_ids], corner_ids, middle)
    corner_start, sorted_corners = _enter(box, chords, owners, reach + bow)
    grid = Grid(line_start, corner_start, float(low[0]), float(low[1]), size, columns, rows)
    return grid, sorted_edges, sorted_corners


def _cell_size(extent: FloatArray, count: int) -> float:
    width, height = float(extent[0]), float(extent[1])
    longest = max(width, height)
    return max(CELL * math.sqrt(width * height / count), longest / (4.0 * count + 64.0), longest * 2.0**-20)


def _beside(lines: FloatArray, ids: IntArray, distance: float) -> tuple[FloatArray, IntArray]:
    """Give the two lines at a distance beside each edge (the edge itself at 0), and whose they are."""
    if distance == 0.0:
        return lines[:, 0:4], ids
    shift = distance * np.tile(lines[:, 4:6], 2)
    return np.concatenate([lines[:, 0:4] + shift, lines[:, 0:4] - shift]), np.concatenate([ids, ids])


def _chords(
    centres: FloatArray, fans: FloatArray, ids: IntArray, radius: float
) -> tuple[FloatArray, FloatArray, IntArray]:
    """Cut the arc around each corner into chords: (chords, how far each arc bows out, whose they are)."""
    pieces = np.maximum(np.ceil(fans[:, 1] / PIECE), 1).astype(np.int64)
    which, number = _spread(np.zeros_like(pieces), pieces - 1)
    angle = fans[which, 1] / pieces[which]
    start = fans[which, 0] + number * angle
    centre = centres[which]
    a = centre + radius * np.stack([np.cos(start), np.sin(start)], axis=1)
    b = centre + radius * np.stack([np.cos(start + angle), np.sin(start + angle)], axis=1)
    return np.hstack([a, b]), radius * (1.0 - np.cos(angle / 2)), ids[which]


def _enter(
    box: tuple[FloatArray, float, int, int], lines: FloatArray, owners: IntArray, reach: FloatArray
) -> tuple[NDArray[np.uint64], IntArray]:
    """Enter lines into cells: (start of each cell, owners by cell, each once)."""
    count = box[2] * box[3]
    cells, which = _cells_of_lines(box, lines, reach)
    many = int(owners.max(initial=0)) + 1
    keys = np.unique(cells * many + owners[which])
    start = np.zeros(count + 1, dtype=np.uint64)
    np.cumsum(np.bincount(keys // many, minlength=count), out=start[1:])
    return start, keys % many


def _cells_of_lines(
    box: tuple[FloatArray, float, int, int], lines: FloatArray, reach: FloatArray
) -> tuple[IntArray, IntArray]:
    """List (cell, line) pairs: column by column, the rows that the line and what is within reach of it cover."""
    low, size, columns, rows = box
    ax, ay, bx, by = lines[:, 0], lines[:, 1], lines[:, 2], lines[:, 3]
    first = _place(np.minimum(ax, bx) - reach - low[0], size, columns)
    last = _place(np.maximum(ax, bx) + reach - low[0], size, columns)
    line, column = _spread(first, last)
    ax, ay, bx, by, reach = ax[line], ay[line], bx[line], by[line], reach[line]
    cell_left = low[0] + column * size - reach
    cell_right = low[0] + (column + 1) * size + reach
    flat = bx != ax
    slope = np.divide(by - ay, bx - ax, out=np.zeros_like(ax), where=flat)
    at_left, at_right = ay + (cell_left - ax) * slope, ay + (cell_right - ax) * slope
    low_y, high_y = np.minimum(ay, by), np.maximum(ay, by)
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
