"""Which walls a flight may meet first: all of them, or those along its way through the cells of a grid."""

from __future__ import annotations

import math

from wallkit.kernels.arcs import scan_arcs_disc, scan_arcs_point
from wallkit.kernels.impact import scan_corners, scan_disc, scan_point
from wallkit.kernels.jit import kernel


@kernel
def scan(model, c, radius, x, y, vx, vy, energy, last, tolerance, best, feature):
    """Earliest contact with what one cell lists: (time, feature, edges touched by a point where it starts)."""
    cell = model.cells[c]
    end = model.cells[c + 1].first
    touched = 0
    if radius == 0.0:
        best, feature, touched = scan_point(
            model.lines, model.ids, cell.first, cell.arcs, model.one_sided, model.edge_wall,
            x, y, vx, vy, last, tolerance, best, feature,
        )  # fmt: skip
        best, feature, more = scan_arcs_point(
            model.arcs, model.arc_of_edge, model.ids, cell.arcs, cell.corners, model.one_sided, model.edge_wall,
            x, y, vx, vy, energy, last, tolerance, best, feature,
        )  # fmt: skip
        return best, feature, touched + more
    best, feature = scan_disc(
        model.lines, model.ids, cell.first, cell.arcs, model.one_sided, model.edge_wall,
        radius, x, y, vx, vy, last, tolerance, best, feature,
    )  # fmt: skip
    best, feature = scan_arcs_disc(
        model.arcs, model.arc_of_edge, model.ids, cell.arcs, cell.corners, model.one_sided, model.edge_wall,
        radius, x, y, vx, vy, energy, last, tolerance, best, feature,
    )  # fmt: skip
    best, feature = scan_corners(
        model.corners, model.ids, cell.corners, end,
        model.one_sided, model.corner_wall, radius, x, y, vx, vy, energy, last, best, feature,
    )  # fmt: skip
    return best, feature, touched


@kernel
def search(model, grid, radius, x, y, vx, vy, energy, last, tolerance, best, feature):
    """Find the earliest contact before ``best``: (time, feature, edges touched by a point where it starts)."""
    if grid is None:
        return scan(model, 0, radius, x, y, vx, vy, energy, last, tolerance, best, feature)
    return _march(model, grid, radius, x, y, vx, vy, energy, last, tolerance, best, feature)


@kernel
def home(model, grid, x, y):
    """Give the number of the cell that lists what a point at (x, y) touches."""
    if grid is None:
        return 0
    return leaf(model.cells, grid, *place(grid, x, y))[0]


@kernel
def place(grid, x, y):
    """Column and row of a place, in units; those at the border for places beyond."""
    return (
        _unit((x - grid.x0) * grid.per_unit, grid.columns << grid.shift),
        _unit((y - grid.y0) * grid.per_unit, grid.rows << grid.shift),
    )


@kernel
def _unit(offset, count):
    if offset <= 0.0:
        return 0
    if offset >= count:
        return count - 1
    return int(offset)


@kernel
def leaf(cells, grid, column, row):
    """Find the undivided cell at a place in units: (its number, its side in units as a power of two)."""
    shift = grid.shift
    c = (row >> shift) * grid.columns + (column >> shift)
    while cells[c].link <= 0:
        bits = int(cells[c].arcs)
        last = (1 << bits) - 1
        shift -= bits
        c = -int(cells[c].link) + ((((row >> shift) & last) << bits) | ((column >> shift) & last))
    return c, shift


@kernel
def clearing(grid, link, shift, number, count):
    """Where the empty square around a cell, or the cell itself, begins and ends along one axis, in units.

    ``number`` is a column or row in the cell, ``count`` how many units there are.
    """
    first = ((number >> shift) - link + 1) << shift
    end = ((number >> shift) + link) << shift
    return max(first, 0), min(end, count)


@kernel
def _march(model, grid, radius, x, y, vx, vy, energy, last, tolerance, best, feature):
    """Walk the cells along the flight, in order, until the best contact lies within what was walked.

    Where a cell is left it is left for good: the column (or row) beyond its border is a whole number, not a rounded
    one, and the other coordinate is kept within the cell. Its rounding may choose the wrong one of two neighbours only
    where the path passes their common border within rounding, and entries reach into their neighbours by far
    more (see ``wallkit.indexing``).
    """
    touched = 0
    enter, leave = _clip(grid, x, y, vx, vy)
    if enter > leave or enter > best:
        return best, feature, touched
    column, row = place(grid, x + enter * vx, y + enter * vy)
    columns, rows = grid.columns << grid.shift, grid.rows << grid.shift
    per_vx = 1.0 / vx if vx != 0.0 else math.inf
    per_vy = 1.0 / vy if vy != 0.0 else math.inf
    while 0 <= column < columns and 0 <= row < rows:
        c, shift = leaf(model.cells, grid, column, row)
        best, feature, more = scan(
            model, c, radius, x, y, vx, vy, energy, last, tolerance, best, feature,
        )  # fmt: skip
        touched += more
        link = int(model.cells[c].link)
        left, right = clearing(grid, link, shift, column, columns)
        low, high = clearing(grid, link, shift, row, rows)
        exit_x = _leaving(grid.x0, grid.unit, right if vx > 0.0 else left, x, per_vx)
        exit_y = _leaving(grid.y0, grid.unit, high if vy > 0.0 else low, y, per_vy)
        if best <= min(exit_x, exit_y):
            break
        if exit_x < exit_y:
            column = right if vx > 0.0 else left - 1
            row = min(max(_unit((y + exit_x * vy - grid.y0) * grid.per_unit, rows), low), high - 1)
        else:
            row = high if vy > 0.0 else low - 1
            column = min(max(_unit((x + exit_y * vx - grid.x0) * grid.per_unit, columns), left), right - 1)
    return best, feature, touched


@kernel
def _leaving(origin, unit, border, p, per_v):
    """Time at which a coordinate comes to a border, given in units."""
    if abs(per_v) == math.inf:
        return math.inf
    return (origin + border * unit - p) * per_v


@kernel
def _clip(grid, x, y, vx, vy):
    """Times at which the flight enters and leaves the grid's box; enter > leave if it misses it."""
    enter_x, leave_x = _slab(grid.x0, grid.x0 + grid.unit * (grid.columns << grid.shift), x, vx)
    enter_y, leave_y = _slab(grid.y0, grid.y0 + grid.unit * (grid.rows << grid.shift), y, vy)
    return max(enter_x, enter_y, 0.0), min(leave_x, leave_y)


@kernel
def _slab(low, high, p, v):
    """Times at which one coordinate enters and leaves an interval."""
    if v == 0.0:
        return (-math.inf, math.inf) if low <= p <= high else (math.inf, -math.inf)
    first = (low - p) / v
    second = (high - p) / v
    return (first, second) if first < second else (second, first)
