"""Which walls a flight may meet first: all of them, or those along its way through the cells of a grid."""

from __future__ import annotations

import math

import numpy as np

from wallkit.kernels.impact.arc_impact import scan_arcs_disc, scan_arcs_point
from wallkit.kernels.impact.line_impact import scan_corners, scan_disc, scan_point
from wallkit.kernels.jit import kernel
from wallkit.kernels.records import FIRST_CLEARING, HALF, PACKED, WIDEST

SLOWEST = 2.0**-900
"""Units per second; a flight that went on at it would not pass a unit."""


@kernel
def scan(model, c, radius, x, y, vx, vy, energy, last, tolerance, best, feature):
    """Earliest contact with what one cell lists: (time, feature, edges touched by a point where it starts)."""
    cell = model.cells[c]
    touched = 0
    if radius == 0.0:
        best, feature, touched = scan_point(
            model.lines, model.ids, cell.first, cell.arcs, model.one_sided, model.edge_wall,
            x, y, vx, vy, last, tolerance, best, feature,
        )  # fmt: skip
        best, feature, more = scan_arcs_point(
            model.arcs, model.ids, cell.arcs, cell.corners, model.one_sided, model.edge_wall,
            x, y, vx, vy, energy, last, tolerance, best, feature,
        )  # fmt: skip
        return best, feature, touched + more
    best, feature = scan_disc(
        model.lines, model.ids, cell.first, cell.arcs, model.one_sided, model.edge_wall,
        radius, x, y, vx, vy, last, tolerance, best, feature,
    )  # fmt: skip
    best, feature = scan_arcs_disc(
        model.arcs, model.ids, cell.arcs, cell.corners, model.one_sided, model.edge_wall,
        radius, x, y, vx, vy, energy, last, tolerance, best, feature,
    )  # fmt: skip
    best, feature = scan_corners(
        model.corners, model.ids, cell.corners, cell.end, model.one_sided, model.corner_wall, model.fans,
        radius, x, y, vx, vy, energy, last, tolerance, best, feature,
    )  # fmt: skip
    return best, feature, touched


@kernel
def search(model, grid, radius, x, y, vx, vy, energy, last, tolerance, best, feature):
    """Find the earliest contact before ``best``: (time, feature, edges touched by a point where it starts)."""
    # Few edges: one cell lists them all.
    if grid is None:
        return scan(model, 0, radius, x, y, vx, vy, energy, last, tolerance, best, feature)
    return _march(model, grid, radius, x, y, vx, vy, energy, last, tolerance, best, feature)


@kernel
def home(model, grid, x, y):
    """Number of the cell that lists what a point at (x, y) touches."""
    if grid is None:
        return 0
    column, row = place(grid, x, y)
    return leaf(model.cells, grid, column, row)[0]


@kernel
def place(grid, x, y):
    """Column and row of a place, in units; those at the border for places beyond."""
    # Whole units: borders of cells are whole numbers too, and the walk compares them exactly.
    return (
        _unit((x - grid.x0) * grid.per_unit, grid.columns << grid.shift),
        _unit((y - grid.y0) * grid.per_unit, grid.rows << grid.shift),
    )


@kernel
def _unit(offset, count):
    """Keep an offset in units within the grid, nothing at all (0 times inf) too; without branches."""
    offset = offset if offset > 0.0 else 0.0
    # A comparison with nan is false: 0 is taken for it.
    last = count - 1.0
    return int(offset if offset < last else last)


@kernel
def inside(grid, column, row):
    """Tell whether a place in units is within the grid."""
    return (column >= 0) & (column < grid.columns << grid.shift) & (row >= 0) & (row < grid.rows << grid.shift)


@kernel
def leaf(cells, grid, column, row):
    """Find the undivided cell at a place in units: (its number, its side in units as a power of two)."""
    shift = grid.shift
    c = top_at(grid, column, row) << grid.packed
    while is_divided(cells[c]):
        # 2^bits by 2^bits parts, row by row: the next bits of row and column number the part.
        bits = int(cells[c].arcs)
        last = (1 << bits) - 1
        shift -= bits
        part = (((row >> shift) & last) << bits) | ((column >> shift) & last)
        c = int(cells[c].first) + (part << grid.packed)
    return c, shift


@kernel
def is_divided(cell):
    """Tell whether smaller cells stand for a cell."""
    return cell.end < cell.first


@kernel
def moves_to_next(cell):
    """Chebyshev distance from an undivided cell to the nearest one with entries; 1 if this one has some."""
    return int(cell.first) if cell.first == cell.end else 1


@kernel
def octant_of(per_u, per_w):
    """The octant of a direction: 1 to the left, 2 down, 4 more up or down than sideways, added up."""
    # Three bits: the two signs, and which component is the larger. 1 / u compares as u does, the other way round.
    return int(per_u <= 0.0) + 2 * int(per_w <= 0.0) + 4 * int(abs(per_w) < abs(per_u))


@kernel
def clearing(clearings, grid, octant, column, row):
    """Width and height of the clearing ahead of a place in units, in cells that are not part of another; 0 for none."""
    size = int(clearings[clearing_at(grid, clearings_of(grid, octant), top_at(grid, column, row))])
    return size & WIDEST, size >> HALF


@kernel
def top_at(grid, column, row):
    """Number of the cell, not part of another one, at a place in units."""
    return (row >> grid.shift) * grid.columns + (column >> grid.shift)


@kernel
def top_number(grid, column, row):
    """As ``top_at`` for whole units that are floats: a float, exactly; vectors of integers of 64 bits are slow."""
    # A side is a power of two, and there are less than 2^32 cells.
    per_size = 1.0 / (1 << grid.shift)
    return np.floor(row * per_size) * float(grid.columns) + np.floor(column * per_size)


@kernel
def clearings_of(grid, octant):
    """Where in ``Model.clearings`` those of an octant begin."""
    octant &= grid.octants - 1
    return FIRST_CLEARING + octant if grid.packed > 0 else octant * grid.columns * grid.rows


@kernel
def clearing_at(grid, first, top):
    """Where in ``Model.clearings`` that of a cell is, with those of its octant from the first on."""
    # Packed, a cell and its rectangles are 2^PACKED numbers in a row; else each octant has a plane of its own.
    return first + (top << (PACKED * grid.packed))


@kernel
def departures_of(grid, octant):
    """Where in ``Model.clearings`` the departures of an octant begin, one for each cell."""
    return (grid.octants + octant) * grid.columns * grid.rows


@kernel
def around(moves, shift, number, count):
    """Where the empty square around a cell, or the cell itself, begins and ends along one axis, in units.

    The nearest cell that may list something is so many ``moves`` away; ``number`` is a column or row in the cell,
    ``count`` how many units there are.
    """
    first = ((number >> shift) - moves + 1) << shift
    end = ((number >> shift) + moves) << shift
    return max(first, 0), min(end, count)


@kernel
def per_speed(u):
    """1 / u; almost no speed is taken for almost none to the left, so that it stays finite."""
    return 1.0 / u if abs(u) > SLOWEST else -1.0 / SLOWEST


@kernel
def ahead(grid, wide, high, shift, column, row, px, py, u, w, per_u, per_w):
    """When a ball leaves a rectangle, and where to: (time, column, row).

    All in units: the ball is at p and flies with (u, w), of which the inverses are ``per_speed``; the rectangle begins
    with the cell of side 2^shift at (column, row) and is ``wide`` times ``high`` of them large, in the flight's octant.

    Beyond the border that it passes the column (or row) is a whole number, not a rounded one, and the other never goes
    back: so every step goes on, also where a path runs through the common corner of four cells. The rounding
    of that other one may choose the wrong one of two neighbours only where the path passes their border within
    rounding, and entries reach into their neighbours by far more (see ``wallkit.simulation.build_grid``).
    """
    right, up = int(per_u > 0.0), int(per_w > 0.0)  # in sums instead of branches, which no processor could foresee
    # To the right the border is `wide` cells on from the left edge of this one, to the left wide - 1 back from it.
    border_x = ((column >> shift) + 1 - right + (2 * right - 1) * wide) << shift
    border_y = ((row >> shift) + 1 - up + (2 * up - 1) * high) << shift
    exit_x, exit_y = (border_x - px) * per_u, (border_y - py) * per_w
    # It leaves by the border that it comes to first: exact there, and the other coordinate is that of p + t v.
    sideways = int(exit_x < exit_y)
    time = exit_x if exit_x < exit_y else exit_y
    there_x = _unit(px + time * u, grid.columns << grid.shift)
    there_y = _unit(py + time * w, grid.rows << grid.shift)
    there_x = max(there_x, column) if per_u > 0.0 else min(there_x, column)
    there_y = max(there_y, row) if per_w > 0.0 else min(there_y, row)
    beyond_x = border_x - 1 + right
    beyond_y = border_y - 1 + up
    return time, there_x + sideways * (beyond_x - there_x), beyond_y + sideways * (there_y - beyond_y)


@kernel
def _march(model, grid, radius, x, y, vx, vy, energy, last, tolerance, best, feature):
    """Walk the cells along the flight, in order, until the best contact lies within what was walked.

    The cells at the border reach on without end, for balls that come from outside.
    """
    touched = 0
    px, py, u, w = in_units(grid, x, y, vx, vy)
    per_u, per_w = per_speed(u), per_speed(w)
    octant = octant_of(per_u, per_w)
    column, row = place(grid, x, y)
    time = -math.inf
    # What is met before the border of the cells walked so far is final: later cells hold only later contacts.
    while best > time and inside(grid, column, row):
        shift = grid.shift
        wide, high = clearing(model.clearings, grid, octant, column, row)
        if wide == 0:
            c, shift = leaf(model.cells, grid, column, row)
            wide = high = moves_to_next(model.cells[c])
            best, feature, more = scan(
                model, c, radius, x, y, vx, vy, energy, last, tolerance, best, feature,
            )  # fmt: skip
            touched += more
        time, column, row = ahead(grid, wide, high, shift, column, row, px, py, u, w, per_u, per_w)
    return best, feature, touched


@kernel
def in_units(grid, x, y, vx, vy):
    """Place and velocity in units from the grid's corner."""
    per_unit = grid.per_unit
    return (x - grid.x0) * per_unit, (y - grid.y0) * per_unit, vx * per_unit, vy * per_unit
