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
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from wallkit.kernels.model import CELL, Grid
from wallkit.scene import FloatArray

IntArray = NDArray[np.int64]
MARGIN = 2.0**-16
SPACING = 0.8
"""Cell size in units of sqrt(area / edges); measured, flat between 0.5 and 1.2."""
BOW = 1.0 / 8.0
"""Arcs are entered in chords that miss them by at most this part of a cell, and by what they miss them."""


class Places(NamedTuple):
    """What is to be indexed: edges and corners of the model, with the numbers they go by."""

    lines: FloatArray
    """(n, 8) columns of ``Line``."""
    line_ids: IntArray
    arcs: FloatArray
    """(n, 11) columns of ``Arc``."""
    arc_ids: IntArray
    corners: FloatArray
    """(n, 2)."""
    fans: FloatArray
    """(n, 2) angle at which the arc around a corner begins, and how far it goes, radians."""
    corner_ids: IntArray


def build_grid(places: Places, radii: tuple[float, float]) -> tuple[Grid, NDArray[Any], NDArray[np.uint32]]:
    """Sort edges and corners into cells.

    Args:
        places: what to enter.
        radii: smallest and largest distance of a centre at a contact.

    Returns:
        The grid, its cells (``CELL``), and the ids that they list.
    """
    middle, spread = (radii[0] + radii[1]) / 2, (radii[1] - radii[0]) / 2
    low, high = _box(places)
    low, high = low - radii[1], high + radii[1]
    size = _cell_size(high - low, len(places.lines) + len(places.arcs))
    low, high = low - size * MARGIN * 4, high + size * MARGIN * 4
    columns, rows = (int(n) + 1 for n in np.floor((high - low) / size))
    box = (low, size, columns, rows)
    reach = spread + size * MARGIN
    beside, owners = _beside(places.lines, places.line_ids, middle)
    line_cells, lines = _enter(box, beside, owners, np.full(len(owners), reach))
    chords, bow, owners = _around_arcs(places.arcs, places.arc_ids, middle, size)
    arc_cells, arcs = _enter(box, chords, owners, reach + bow)
    radius = np.full(len(places.corners), middle)
    chords, bow, owners = _chords(places.corners, places.fans, places.corner_ids, radius, size)
    corner_cells, corners = _enter(box, chords, owners, reach + bow)
    counts = np.stack([np.bincount(c, minlength=columns * rows) for c in (line_cells, arc_cells, corner_cells)])
    taken = counts.sum(axis=0)
    cells = np.zeros(columns * rows + 1, dtype=CELL)
    cells["first"][1:] = np.cumsum(taken)
    cells["arcs"][:-1] = cells["first"][:-1] + counts[0]
    cells["corners"][:-1] = cells["arcs"][:-1] + counts[1]
    cells["link"] = 1
    cells["link"][:-1] = _clearings(taken.reshape(rows, columns) > 0).ravel()
    order = np.argsort(np.concatenate([line_cells, arc_cells, corner_cells]), kind="stable")
    ids = np.append(np.concatenate([lines, arcs, corners])[order], 0).astype(np.uint32)
    return Grid(float(low[0]), float(low[1]), size, 1.0 / size, 0, columns, rows), cells, ids


def _clearings(taken: NDArray[np.bool_]) -> NDArray[np.int32]:
    """How many king's moves each cell is from the nearest one that lists something, at least 1."""
    from scipy.ndimage import distance_transform_cdt

    moves: NDArray[np.int32] = np.maximum(distance_transform_cdt(~taken, metric="chessboard"), 1)
    return moves


def _box(places: Places) -> tuple[FloatArray, FloatArray]:
    """Give the lowest and highest coordinates of edges; an arc may bow out as far as its circle."""
    a, b = places.arcs[:, 0:2], places.arcs[:, 2:4]
    chord = np.hypot(*(b - a).T)[:, None]
    radius, wide = places.arcs[:, 8:9], places.arcs[:, 10:11]
    half = np.sqrt(np.maximum(radius * radius - chord * chord / 4, 0.0))
    bow = np.where(wide > 0.0, radius + half, chord * chord / (4.0 * np.maximum(radius + half, 1e-300)))
    ends = np.concatenate([places.lines[:, 0:2], places.lines[:, 2:4], *(p + s * bow for p in (a, b) for s in (1, -1))])
    return ends.min(axis=0), ends.max(axis=0)


def _cell_size(extent: FloatArray, count: int) -> float:
    width, height = float(extent[0]), float(extent[1])
    longest = max(width, height)
    return max(SPACING * math.sqrt(width * height / count), longest / (4.0 * count + 64.0), longest * 2.0**-20)


def _beside(lines: FloatArray, ids: IntArray, distance: float) -> tuple[FloatArray, IntArray]:
    """Give the two lines at a distance beside each edge (the edge itself at 0), and whose they are."""
    if distance == 0.0:
        return lines[:, 0:4], ids
    shift = distance * np.tile(lines[:, 4:6], 2)
    return np.concatenate([lines[:, 0:4] + shift, lines[:, 0:4] - shift]), np.concatenate([ids, ids])


def _around_arcs(
    arcs: FloatArray, ids: IntArray, distance: float, size: float
) -> tuple[FloatArray, FloatArray, IntArray]:
    """Cut the arcs at a distance outside and inside each arc into chords, as ``_chords`` does."""
    centre, radius = arcs[:, 0:2] - arcs[:, 4:6], arcs[:, 8]
    start, end = np.arctan2(arcs[:, 5], arcs[:, 4]), np.arctan2(arcs[:, 7], arcs[:, 6])
    fans = np.stack([start, np.remainder(end - start, 2 * np.pi)], axis=1)
    both = [_chords(centre, fans, ids, np.abs(radius + side), size) for side in (distance, -distance)]
    chords, bow, owners = (np.concatenate(parts) for parts in zip(*both, strict=True))
    return chords, bow, owners


def _chords(
    centres: FloatArray, fans: FloatArray, ids: IntArray, radius: FloatArray, size: float
) -> tuple[FloatArray, FloatArray, IntArray]:
    """Cut arcs into chords: (chords, how far each arc bows out, whose they are)."""
    piece = 2.0 * np.arccos(np.clip(1.0 - BOW * size / np.maximum(radius, 1e-300), 0.0, 1.0))
    pieces = np.maximum(np.ceil(fans[:, 1] / np.maximum(piece, 2.0**-20)), 1).astype(np.int64)
    which, number = spread(np.zeros_like(pieces), pieces - 1)
    angle = fans[which, 1] / pieces[which]
    start = fans[which, 0] + number * angle
    centre, size_of = centres[which], radius[which][:, None]
    a = centre + size_of * np.stack([np.cos(start), np.sin(start)], axis=1)
    b = centre + size_of * np.stack([np.cos(start + angle), np.sin(start + angle)], axis=1)
    return np.hstack([a, b]), radius[which] * (1.0 - np.cos(angle / 2)), ids[which]


def _enter(
    box: tuple[FloatArray, float, int, int], lines: FloatArray, owners: IntArray, reach: FloatArray
) -> tuple[NDArray[np.uint64], IntArray]:
    """Enter lines into cells: (start of each cell, owners by cell, each once)."""
    cells, which = _cells_of_lines(box, lines, reach)
    many = int(owners.max(initial=0)) + 1
    keys = np.sort(cells * many + owners[which])
    keys = keys[np.diff(keys, prepend=-1) > 0]
    return keys // many, keys % many


def _cells_of_lines(
    box: tuple[FloatArray, float, int, int], lines: FloatArray, reach: FloatArray
) -> tuple[IntArray, IntArray]:
    """List (cell, line) pairs: column by column, the rows that the line and what is within reach of it cover."""
    low, size, columns, rows = box
    ax, ay, bx, by = lines[:, 0], lines[:, 1], lines[:, 2], lines[:, 3]
    first = _place(np.minimum(ax, bx) - reach - low[0], size, columns)
    last = _place(np.maximum(ax, bx) + reach - low[0], size, columns)
    line, column = spread(first, last)
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
    pair, row = spread(first, last)
    return row * columns + column[pair], line[pair]


def _place(offset: FloatArray, size: float, count: int) -> IntArray:
    return np.clip(np.floor(offset / size), 0, count - 1).astype(np.int64)


def spread(first: IntArray, last: IntArray) -> tuple[IntArray, IntArray]:
    """Give for each range all its numbers: (which range, number)."""
    counts = last - first + 1
    which = np.repeat(np.arange(len(first)), counts)
    start = np.cumsum(counts) - counts
    return which, np.arange(len(which)) - start[which] + first[which]
