"""The way of a falling wave through the grid: the rectangles that its balls are in, when they leave them, and whereto.

The formulas are those of ``parabola_walk``, term by term, with selects in place of branches.
"""

from __future__ import annotations

import math

import numpy as np

from wallkit.kernels.batches.falling_columns import (
    ARCS,
    AT,
    AT_VX,
    AT_VY,
    AT_X,
    AT_Y,
    BACK_X,
    BACK_Y,
    BEST,
    CLEARING,
    COLUMN,
    CORNERS,
    END,
    FLIES,
    HIGH,
    LEFT,
    LEVEL,
    LOW,
    NEXT,
    NOW,
    OCTANT,
    RIGHT,
    ROW,
    SIDEWAYS,
    STEEP,
    STILL_X,
    STILL_Y,
    THEN,
    TURN,
    VX,
    VY,
    X,
    Y,
)
from wallkit.kernels.batches.wave_columns import LANES
from wallkit.kernels.impact.polynomial_roots import NEVER
from wallkit.kernels.index.grid import clearing_at, clearings_of, is_divided, leaf, moves_to_next, top_at
from wallkit.kernels.intrinsics import AT_ONCE, look_up, lowest
from wallkit.kernels.jit import kernel, rare_kernel
from wallkit.kernels.records import HALF, OCTANTS, WIDEST

ONE_BY_ONE = 1 + (1 << HALF)
"""The cell itself, in place of a clearing."""


@kernel
def look_around(model, grid, s, q):
    """Find the rectangle ahead of each ball: the bits of those whose rectangle is a cell that lists something."""
    for i in range(0, LANES, AT_ONCE):
        look_up(model.clearings, q, AT + i, q, CLEARING + i)
    listed, size, per_size = 0, float(1 << grid.shift), 1.0 / (1 << grid.shift)
    for i in range(LANES):
        clear = q[CLEARING + i]
        listed |= int((clear == 0) & (s[FLIES + i] > 0.0)) << i
        clear = clear if clear > 0 else ONE_BY_ONE
        wide, high = size * float(clear & WIDEST), size * float(clear >> HALF)
        column, row = np.floor(s[COLUMN + i] * per_size) * size, np.floor(s[ROW + i] * per_size) * size
        # Backwards the rectangle ends with the right border of the cell.
        left = column if s[BACK_X + i] == 0.0 else column + size - wide
        low = row if s[BACK_Y + i] == 0.0 else row + size - high
        s[LEFT + i], s[RIGHT + i], s[LOW + i], s[HIGH + i] = left, left + wide, low, low + high
    entering = listed
    while entering > 0:
        i = lowest(entering)
        entering &= entering - 1
        _enter(model, grid, s, q, i)
    return listed


@kernel
def _enter(model, grid, s, q, i):
    """Look at what the cell of a ball lists."""
    column, row = int(s[COLUMN + i]), int(s[ROW + i])
    cell = top_at(grid, column, row) << grid.packed
    if is_divided(model.cells[cell]):
        cell = _enter_part(model, grid, s, i, column, row)
    cells = model.cells
    q[NEXT + i], q[ARCS + i], q[CORNERS + i], q[END + i] = (
        cells[cell].first, cells[cell].arcs, cells[cell].corners, cells[cell].end,
    )  # fmt: skip


@rare_kernel
def _enter_part(model, grid, s, i, column, row):
    """Find the rectangle of a ball in a part of a divided cell: its number."""
    cell, shift = leaf(model.cells, grid, column, row)
    far = moves_to_next(model.cells[cell]) << shift
    near = (1 << shift) - far
    left, low = (column >> shift) << shift, (row >> shift) << shift
    left = left if s[BACK_X + i] == 0.0 else left + near
    low = low if s[BACK_Y + i] == 0.0 else low + near
    s[LEFT + i], s[RIGHT + i], s[LOW + i], s[HIGH + i] = float(left), float(left + far), float(low), float(low + far)
    return cell


@kernel
def find_ways_out(grid, gravity, s):
    """Find when each ball leaves its rectangle, or turns in it before, and through which border."""
    columns, rows = float(grid.columns << grid.shift), float(grid.rows << grid.shift)
    for i in range(LANES):
        across = _until_left(
            grid.x0, grid.unit, s[LEFT + i], s[RIGHT + i], columns, s[AT_X + i], s[AT_VX + i], gravity[0], s[BACK_X + i]
        )
        up = _until_left(
            grid.y0, grid.unit, s[LOW + i], s[HIGH + i], rows, s[AT_Y + i], s[AT_VY + i], gravity[1], s[BACK_Y + i]
        )
        sideways = across < up
        then = s[NOW + i] + (across if sideways else up)
        s[SIDEWAYS + i] = 1.0 if sideways else 0.0
        s[THEN + i] = then if then < s[TURN + i] else s[TURN + i]


@kernel
def _until_left(origin, unit, first, end, count, p, u, a, back):
    """How long a coordinate takes to leave what lies from first to end, as in ``parabola_walk``."""
    border = origin + (end if back == 0.0 else first) * unit
    d, u, a = border - p if back == 0.0 else p - border, u if back == 0.0 else -u, a if back == 0.0 else -a
    u = u if u > 0.0 else 0.0
    # Without a pull it is d / u in the same bits: the root of a square is exact.
    square = u * u + 2.0 * a * d
    faster = u + math.sqrt(square if square > 0.0 else 0.0)
    leaves = (square >= 0.0) & (faster > 0.0)
    t = 2.0 * d / (faster if leaves else 1.0)
    t = t if leaves else NEVER
    t = t if d > 0.0 else 0.0
    open_end = end >= count if back == 0.0 else first <= 0.0
    return NEVER if open_end else t


@kernel
def walk_on(grid, gravity, s, q):
    """Let balls go on whose first contact may lie beyond their rectangle: the bits of those that have found theirs."""
    gx, gy = gravity[0], gravity[1]
    columns, rows = float(grid.columns << grid.shift), float(grid.rows << grid.shift)
    found = 0
    for i in range(LANES):
        then, turn = s[THEN + i], s[TURN + i]
        ends = (s[BEST + i] <= then) | (then == NEVER)
        found |= int(ends & (s[FLIES + i] > 0.0)) << i
        now = 0.0 if ends else then
        x, y, vx, vy = s[X + i], s[Y + i], s[VX + i], s[VY + i]
        at_x, at_y = x + now * (vx + 0.5 * now * gx), y + now * (vy + 0.5 * now * gy)
        s[NOW + i], s[AT_X + i], s[AT_Y + i] = now, at_x, at_y
        s[AT_VX + i], s[AT_VY + i] = vx + now * gx, vy + now * gy
        there_x = _within((at_x - grid.x0) * grid.per_unit, columns - 1.0, s[LEFT + i], s[RIGHT + i] - 1.0)
        there_y = _within((at_y - grid.y0) * grid.per_unit, rows - 1.0, s[LOW + i], s[HIGH + i] - 1.0)
        ahead_x, ahead_y = s[BACK_X + i] == 0.0, s[BACK_Y + i] == 0.0
        # Beyond the border that is passed the number is a whole one; at a turn the ball stays in its cell.
        passes, sideways = now < turn, s[SIDEWAYS + i] > 0.0
        beyond_x, beyond_y = (
            (s[RIGHT + i] if ahead_x else s[LEFT + i] - 1.0),
            s[HIGH + i] if ahead_y else s[LOW + i] - 1.0,
        )
        there_x = beyond_x if passes & sideways else there_x
        there_y = beyond_y if passes & (not sideways) else there_y
        column, row = s[COLUMN + i], s[ROW + i]
        column = there_x if (there_x > column) == ahead_x else column
        row = there_y if (there_y > row) == ahead_y else row
        s[COLUMN + i], s[ROW + i] = (0.0 if ends else column), 0.0 if ends else row
    for i in range(LANES):
        _turn(grid, gravity, s, q, i)
    return found


@kernel
def _within(offset, last, least, most):
    """The number of a unit, kept in the grid and in the rectangle."""
    offset = offset if offset > 0.0 else 0.0
    number = np.floor(offset if offset < last else last)
    number = number if number > least else least
    return number if number < most else most


@kernel
def _turn(grid, gravity, s, q, i):
    """Find the octant of a ball at a turn of its velocity and when it turns next, and where it looks for a clearing."""
    now, turn = s[NOW + i], s[TURN + i]
    turns, following = now == turn, _next_turn(grid, s, i, now)
    turn = following if turns else turn
    # Signs do not change between two turns: any time between them tells.
    t = 0.5 * (now + turn) if turn < NEVER else 2.0 * now + 1.0
    ux, uy = s[VX + i] + t * gravity[0], s[VY + i] + t * gravity[1]
    back_x, back_y = ux <= 0.0, uy <= 0.0
    s[TURN + i] = turn
    s[BACK_X + i] = (1.0 if back_x else 0.0) if turns else s[BACK_X + i]
    s[BACK_Y + i] = (1.0 if back_y else 0.0) if turns else s[BACK_Y + i]
    octant = clearings_of(grid, int(back_x) + 2 * int(back_y) + 4 * int(abs(ux) < abs(uy)))
    q[OCTANT + i] = octant if turns else q[OCTANT + i]
    q[AT + i] = clearing_at(grid, q[OCTANT + i], top_at(grid, int(s[COLUMN + i]), int(s[ROW + i])))


@kernel
def _next_turn(grid, s, i, now):
    """The first time after now at which the octant of a flight changes."""
    turn = _after(s[STILL_X + i], now, NEVER)
    turn = _after(s[STILL_Y + i], now, turn)
    if grid.octants == OCTANTS:
        turn = _after(s[STEEP + i], now, _after(s[LEVEL + i], now, turn))
    return turn


@kernel
def _after(time, now, other):
    return time if (time > now) & (time < other) else other


@kernel
def set_out(grid, gravity, s, q, i, x, y, vx, vy, remaining):
    """Begin the way of a ball: nothing met before its time is up, in the cell where it is."""
    gx, gy = gravity[0], gravity[1]
    s[X + i], s[Y + i], s[VX + i], s[VY + i] = x, y, vx, vy
    s[AT_X + i], s[AT_Y + i], s[AT_VX + i], s[AT_VY + i] = x, y, vx, vy
    s[BEST + i], s[NOW + i], s[TURN + i], s[FLIES + i] = remaining, 0.0, 0.0, 1.0
    s[STILL_X + i], s[STILL_Y + i] = _standstill(vx, gx), _standstill(vy, gy)
    if grid.octants == OCTANTS:
        s[LEVEL + i], s[STEEP + i] = _standstill(vx - vy, gx - gy), _standstill(vx + vy, gx + gy)
    _column_of(grid, s, i, x, y)
    _turn(grid, gravity, s, q, i)


@kernel
def _column_of(grid, s, i, x, y):
    columns, rows = float(grid.columns << grid.shift), float(grid.rows << grid.shift)
    s[COLUMN + i] = _within((x - grid.x0) * grid.per_unit, columns - 1.0, 0.0, columns)
    s[ROW + i] = _within((y - grid.y0) * grid.per_unit, rows - 1.0, 0.0, rows)


@kernel
def _standstill(v, g):
    return -v / g if g != 0.0 else NEVER
