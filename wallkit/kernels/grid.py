"""Which walls a flight may meet first: all of them, or those along its way through a uniform grid."""

from __future__ import annotations

import math

from wallkit.kernels.arcs import scan_arcs_disc, scan_arcs_point
from wallkit.kernels.impact import scan_corners, scan_disc, scan_point
from wallkit.kernels.jit import kernel


@kernel
def scan(model, cells, c, radius, x, y, vx, vy, energy, last, tolerance, best, feature):
    """Earliest contact with the entries of one cell: (time, feature, edges touched by a point where it starts)."""
    first, end = cells.line_start[c], cells.line_start[c + 1]
    first_arc, end_arc = cells.arc_start[c], cells.arc_start[c + 1]
    touched = 0
    if radius == 0.0:
        best, feature, touched = scan_point(
            model.line_entries, model.line_ids, first, end, model.one_sided, model.edge_wall,
            x, y, vx, vy, last, tolerance, best, feature,
        )  # fmt: skip
        best, feature, more = scan_arcs_point(
            model.arc_entries, model.arc_ids, first_arc, end_arc, model.one_sided, model.edge_wall,
            x, y, vx, vy, energy, last, tolerance, best, feature,
        )  # fmt: skip
        return best, feature, touched + more
    best, feature = scan_disc(
        model.line_entries, model.line_ids, first, end, model.one_sided, model.edge_wall,
        radius, x, y, vx, vy, last, tolerance, best, feature,
    )  # fmt: skip
    best, feature = scan_arcs_disc(
        model.arc_entries, model.arc_ids, first_arc, end_arc, model.one_sided, model.edge_wall,
        radius, x, y, vx, vy, energy, last, tolerance, best, feature,
    )  # fmt: skip
    best, feature = scan_corners(
        model.corner_entries, model.corner_ids, cells.corner_start[c], cells.corner_start[c + 1],
        model.one_sided, model.corner_wall, radius, x, y, vx, vy, energy, last, best, feature,
    )  # fmt: skip
    return best, feature, touched


@kernel
def search(model, grid, radius, x, y, vx, vy, energy, last, tolerance, best, feature):
    """Find the earliest contact before ``best``: (time, feature, edges touched by a point where it starts)."""
    if grid is None:
        return scan(model, model.whole, 0, radius, x, y, vx, vy, energy, last, tolerance, best, feature)
    return _march(model, grid, radius, x, y, vx, vy, energy, last, tolerance, best, feature)


@kernel
def home(model, grid, x, y):
    """Cells and the number of the one that lists what a point at (x, y) touches."""
    if grid is None:
        return model.whole, 0
    column, row = cell_of(grid, x, y)
    return grid.cells, row * grid.columns + column


@kernel
def cell_of(grid, x, y):
    """Column and row of a place, those at the border for places beyond."""
    return _cell(x - grid.x0, grid.size, grid.columns), _cell(y - grid.y0, grid.size, grid.rows)


@kernel
def _march(model, grid, radius, x, y, vx, vy, energy, last, tolerance, best, feature):
    """Walk the cells along the flight, in order, until the best contact lies within what was walked.

    The time at which a cell is left is computed from the cell's number, never summed up, so a long flight does
    not drift off its cells; entries reach into their neighbours by far more than that rounding (see
    ``wallkit.indexing``).
    """
    touched = 0
    enter, leave = _clip(grid, x, y, vx, vy)
    if enter > leave or enter > best:
        return best, feature, touched
    column, row = cell_of(grid, x + enter * vx, y + enter * vy)
    step_x = 1 if vx > 0.0 else -1
    step_y = 1 if vy > 0.0 else -1
    per_vx = 1.0 / vx if vx != 0.0 else math.inf
    per_vy = 1.0 / vy if vy != 0.0 else math.inf
    while True:
        c = row * grid.columns + column
        best, feature, more = scan(
            model, grid.cells, c, radius, x, y, vx, vy, energy, last, tolerance, best, feature,
        )  # fmt: skip
        touched += more
        exit_x = _leaving(grid.x0, grid.size, column, step_x, x, per_vx)
        exit_y = _leaving(grid.y0, grid.size, row, step_y, y, per_vy)
        if exit_x < exit_y:
            if best <= exit_x:
                return best, feature, touched
            column += step_x
            if column < 0 or column >= grid.columns:
                return best, feature, touched
        else:
            if best <= exit_y:
                return best, feature, touched
            row += step_y
            if row < 0 or row >= grid.rows:
                return best, feature, touched


@kernel
def _leaving(low, size, number, step, p, per_v):
    """Time at which a coordinate leaves its column or row of cells."""
    if per_v == math.inf:
        return math.inf
    edge = number + 1 if step > 0 else number
    return (low + edge * size - p) * per_v


@kernel
def _cell(offset, size, count):
    """Column or row of an offset from the grid's corner, kept within the grid."""
    if offset <= 0.0:
        return 0
    if offset >= size * count:
        return count - 1
    return min(int(offset / size), count - 1)


@kernel
def _clip(grid, x, y, vx, vy):
    """Times at which the flight enters and leaves the grid's box; enter > leave if it misses it."""
    enter_x, leave_x = _slab(grid.x0, grid.x0 + grid.size * grid.columns, x, vx)
    enter_y, leave_y = _slab(grid.y0, grid.y0 + grid.size * grid.rows, y, vy)
    return max(enter_x, enter_y, 0.0), min(leave_x, leave_y)


@kernel
def _slab(low, high, p, v):
    """Times at which one coordinate enters and leaves an interval."""
    if v == 0.0:
        return (-math.inf, math.inf) if low <= p <= high else (math.inf, -math.inf)
    first = (low - p) / v
    second = (high - p) / v
    return (first, second) if first < second else (second, first)
