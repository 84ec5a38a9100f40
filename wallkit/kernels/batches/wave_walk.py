"""The way of a wave through the grid: which balls leave their cell, and what they look at in the next one."""

from __future__ import annotations

import numpy as np

from wallkit.kernels.batches.wave_columns import (
    ARCS,
    ASKING,
    AT,
    BEST,
    BORDER_X,
    BORDER_Y,
    CLEARING,
    COLUMN,
    CORNERS,
    CROSSES,
    END,
    FEATURE,
    FLIES,
    LANES,
    NEXT,
    NEXT_ARC,
    NEXT_CORNER,
    NONE,
    OCTANT,
    PER_U,
    PER_W,
    PX,
    PY,
    ROW,
    TOP,
    TOUCHED,
    U,
    W,
)
from wallkit.kernels.index.grid import clearing_at, is_divided, leaf, moves_to_next, top_at
from wallkit.kernels.intrinsics import AT_ONCE, look_up, lowest, prefetch, prefetch_far
from wallkit.kernels.jit import kernel, rare_kernel
from wallkit.kernels.records import HALF, WIDEST

ONE_BY_ONE = 1 + (1 << HALF)
"""The cell itself, in place of a clearing."""


@kernel
def decide(s, q, grid):
    """Find when every ball leaves its cell, and what it does next: look on, cross into the next cell, turn, or end.

    As ``grid.ahead`` does, with the borders of the cell (or clearing) as they are. Also where the next cell is in
    ``Model.clearings``: some place within for balls that do not cross, too, for all of them look there.

    Returns:
        The bits of the balls that turn, and of those that end their flight free.
    """
    columns, rows = float(grid.columns << grid.shift), float(grid.rows << grid.shift)
    turning, ending, asking = 0, 0, int(q[ASKING])
    for i in range(LANES):
        px, py, u, w, per_u, per_w = s[PX + i], s[PY + i], s[U + i], s[W + i], s[PER_U + i], s[PER_W + i]
        border_x, border_y = s[BORDER_X + i], s[BORDER_Y + i]
        # Times to both borders; it leaves by the first, and the other coordinate is that of p + t v, kept in the grid.
        exit_x, exit_y = (border_x - px) * per_u, (border_y - py) * per_w
        sideways = exit_x < exit_y
        time = exit_x if sideways else exit_y
        there_x, there_y = px + time * u, py + time * w
        there_x = there_x if there_x > 0.0 else 0.0
        there_y = there_y if there_y > 0.0 else 0.0
        there_x = there_x if there_x < columns - 1.0 else columns - 1.0
        there_y = there_y if there_y < rows - 1.0 else rows - 1.0
        back_x, back_y = s[COLUMN + i], s[ROW + i]  # where the ball is, or, asked again, what came out before
        there_x = back_x if (there_x < back_x) == (per_u > 0.0) else there_x
        there_y = back_y if (there_y < back_y) == (per_w > 0.0) else there_y
        x = (border_x if per_u > 0.0 else border_x - 1.0) if sideways else there_x
        y = there_y if sideways else (border_y if per_w > 0.0 else border_y - 1.0)
        outside = (x < 0.0) | (x >= columns) | (y < 0.0) | (y >= rows)
        # A contact before the border is final, and beyond the grid there is nothing more to find.
        turns = outside | (s[BEST + i] <= time)
        goes = (s[FLIES + i] == 1.0) & ((asking >> i) & 1 == 0)
        column, row = int(0.0 if outside else x), int(0.0 if outside else y)
        s[COLUMN + i], s[ROW + i] = float(column), float(row)
        top = top_at(grid, column, row)
        q[TOP + i] = top << grid.packed
        q[AT + i] = clearing_at(grid, q[OCTANT + i], top)
        q[CROSSES + i] = int(goes & (not turns))
        # Nothing met and nothing touched: its flight ends free.
        free = (s[FEATURE + i] == NONE) & (s[TOUCHED + i] == 0.0)
        turning |= int(goes & turns & (not free)) << i
        ending |= int(goes & turns & free) << i
    return turning, ending


@kernel
def _cross_clearings(model, s, q):
    """Let balls cross into clearings, with the borders ahead as in ``grid.ahead``: the bits of those that enter a cell.

    Such a cell is taken for one that is not divided, as most are.
    """
    for i in range(0, LANES, AT_ONCE):
        look_up(model.clearings, q, AT + i, q, CLEARING + i)
    entering, size, per_size = 0, float(1 << model.grid.shift), 1.0 / (1 << model.grid.shift)
    for i in range(LANES):
        clear, crosses = q[CLEARING + i], q[CROSSES + i]
        # 0 in place of a clearing is a cell that lists something: who crosses (1 > 0) enters it.
        entering |= int(crosses > clear) << i
        clear = clear if clear > 0 else ONE_BY_ONE
        wide, high = size * float(clear & WIDEST), size * float(clear >> HALF)
        column, row = np.floor(s[COLUMN + i] * per_size) * size, np.floor(s[ROW + i] * per_size) * size
        x = column + (wide if s[PER_U + i] > 0.0 else size - wide)
        y = row + (high if s[PER_W + i] > 0.0 else size - high)
        s[BORDER_X + i] = x if crosses > 0 else s[BORDER_X + i]
        s[BORDER_Y + i] = y if crosses > 0 else s[BORDER_Y + i]
    return entering


@kernel
def _enter(model, s, q, i):
    """Enter the cell at the column and row of a ball."""
    if is_divided(model.cells[q[TOP + i]]):
        _enter_part(model, s, q, i)
    else:
        _open(model.cells, q, i, q[TOP + i])


@rare_kernel
def _enter_part(model, s, q, i):
    """Enter a part of a divided cell, with the borders ahead as in ``grid.ahead``."""
    column, row = int(s[COLUMN + i]), int(s[ROW + i])
    cell, shift = leaf(model.cells, model.grid, column, row)
    _open(model.cells, q, i, cell)
    far = moves_to_next(model.cells[cell]) << shift
    # The empty square is as wide to the left: from the cell's right border, or its upper one, back by `far`.
    near = (1 << shift) - far
    column, row = (column >> shift) << shift, (row >> shift) << shift
    s[BORDER_X + i] = float(column + (far if s[PER_U + i] > 0.0 else near))
    s[BORDER_Y + i] = float(row + (far if s[PER_W + i] > 0.0 else near))


@kernel
def _open(cells, q, i, cell):
    """Look at what a cell lists."""
    first, arcs, corners = cells[cell].first, cells[cell].arcs, cells[cell].corners
    q[NEXT + i], q[ARCS + i], q[NEXT_ARC + i], q[CORNERS + i] = first, arcs, arcs, corners
    q[NEXT_CORNER + i], q[END + i] = corners, cells[cell].end


@kernel
def cross(model, s, q, far):
    """Let balls cross into clearings and cells."""
    entering = _cross_clearings(model, s, q)
    q[ASKING] |= entering
    while entering > 0:
        i = lowest(entering)
        entering &= entering - 1
        _enter(model, s, q, i)
        if far:
            # The ids that the next turn pairs up.
            prefetch_far(model.ids, q[NEXT + i])
            prefetch_far(model.ids, q[NEXT + i] + (AT_ONCE - 1))  # so many are read at once, often from two lines


@kernel
def prefetch_cells(model, q, far):
    """Prefetch what balls need when they cross, while others turn."""
    for i in range(LANES):
        _prefetch_one(model.clearings, q[AT + i], far)
    if model.grid.packed == 0:
        for i in range(LANES):
            _prefetch_one(model.cells, q[TOP + i], far)


@kernel
def _prefetch_one(records, place, far):
    if far:
        prefetch_far(records, place)
    else:
        prefetch(records, place)


@kernel
def prefetch_listed(model, radius, q):
    """Prefetch the records that are listed in the cells which the balls of another wave have entered."""
    asking = int(q[ASKING])
    while asking > 0:
        i = lowest(asking)
        asking &= asking - 1
        _prefetch_records(model.lines, model.ids, q[NEXT + i], q[ARCS + i])
        _prefetch_records(model.arcs, model.ids, q[NEXT_ARC + i], q[CORNERS + i])
        if radius is not None:
            _prefetch_records(model.corners, model.ids, q[NEXT_CORNER + i], q[END + i])


@kernel
def _prefetch_records(records, ids, first, end):
    if records is not None:
        for at in range(first, end):
            prefetch_far(records, ids[at])
