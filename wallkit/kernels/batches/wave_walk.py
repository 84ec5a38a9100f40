"""The way of a wave through the grid: which balls leave their cell, and what they look at in the next one."""

from __future__ import annotations

import numpy as np

from wallkit.kernels.batches.wave_columns import (
    ARC_IDS,
    ARCS,
    ASKING,
    AT,
    BEST,
    BORDER_X,
    BORDER_Y,
    CLEARING,
    COLUMN,
    CORNER_IDS,
    CORNERS,
    CROSSES,
    END,
    FEATURE,
    FLIES,
    LANES,
    LINE_IDS,
    NEXT,
    NEXT_ARC,
    NEXT_CORNER,
    NONE,
    OCTANT,
    PAIRED,
    PER_TURN,
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
from wallkit.kernels.batches.wave_pairs import LONG, SHORT, fill_up, list_cell, list_short, pair_all
from wallkit.kernels.index.grid import clearing_at, is_divided, leaf, moves_to_next, top_number
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
        column, row = np.floor(0.0 if outside else x), np.floor(0.0 if outside else y)
        s[COLUMN + i], s[ROW + i] = column, row
        q[TOP + i] = top_number(grid, column, row) * float(1 << grid.packed)
        q[AT + i] = clearing_at(grid, q[OCTANT + i], q[TOP + i] >> grid.packed)
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
    """Enter the cell at the column and row of a ball: its number."""
    if is_divided(model.cells[q[TOP + i]]):
        _enter_part(model, s, q, i)
    return q[TOP + i]


@rare_kernel
def _enter_part(model, s, q, i):
    """Enter a part of a divided cell, which takes the place of that, with the borders ahead as in ``grid.ahead``."""
    column, row = int(s[COLUMN + i]), int(s[ROW + i])
    cell, shift = leaf(model.cells, model.grid, column, row)
    far = moves_to_next(model.cells[cell]) << shift
    # The empty square is as wide to the left: from the cell's right border, or its upper one, back by `far`.
    near = (1 << shift) - far
    column, row = (column >> shift) << shift, (row >> shift) << shift
    s[BORDER_X + i] = float(column + (far if s[PER_U + i] > 0.0 else near))
    s[BORDER_Y + i] = float(row + (far if s[PER_W + i] > 0.0 else near))
    q[TOP + i] = cell


@kernel
def _open(cells, q, i, cell):
    """Note what a cell lists, to be paired later."""
    first, arcs, corners = cells[cell].first, cells[cell].arcs, cells[cell].corners
    q[NEXT + i], q[ARCS + i], q[NEXT_ARC + i], q[CORNERS + i] = first, arcs, arcs, corners
    q[NEXT_CORNER + i], q[END + i] = corners, cells[cell].end


@rare_kernel
def cross(model, lists, radius, s, q, pairs, far):
    """Let balls cross into clearings and cells, and pair them with what these list; from ``far`` that is done later."""
    entering = _cross_clearings(model, s, q)
    short = model.arcs is None and len(lists) > 0
    if not short:
        _prefetch_ids(model, q, entering, far)
    asking, listed = int(q[ASKING]), (0, 0, 0)
    while entering > 0:
        i = lowest(entering)
        entering &= entering - 1
        if short:
            if lists[SHORT * q[TOP + i]] != LONG:
                listed = list_short(radius, lists, q[TOP + i], i, pairs, listed)
                continue
        cell = _enter(model, s, q, i)
        record = model.cells[cell]
        if far or record.first + PER_TURN < record.end:
            _open(model.cells, q, i, cell)
            asking |= 1 << i
        else:
            listed = list_cell(model, radius, record, i, pairs, listed)
    q[ASKING] = asking
    if not far:
        pair_rest(model, radius, q, pairs, listed)


@kernel
def _prefetch_ids(model, q, entering, far):
    """Prefetch the ids that cells list, of all balls that enter one, before the first is paired with them."""
    while entering > 0:
        i = lowest(entering)
        entering &= entering - 1
        first = model.cells[q[TOP + i]].first
        _prefetch_one(model.ids, first, far)
        _prefetch_one(model.ids, first + (AT_ONCE - 1), far)  # so many are read at once, often from two lines


@kernel
def pair_rest(model, radius, q, pairs, listed):
    """Pair balls with what they have still to ask, behind the pairs that are listed, and note how many there are."""
    if q[ASKING] > 0:
        listed = pair_all(model, radius, q, pairs, listed)
    fill_up(model.ids, pairs, listed)
    q[PAIRED], q[PAIRED + 1], q[PAIRED + 2] = listed


@kernel
def prefetch_cells(model, lists, q, far):
    """Prefetch what balls need when they cross, while others turn."""
    for i in range(LANES):
        _prefetch_one(model.clearings, q[AT + i], far)
    if len(lists) > 0:
        for i in range(LANES):
            prefetch(lists, SHORT * q[TOP + i])
    elif model.grid.packed == 0:
        for i in range(LANES):
            _prefetch_one(model.cells, q[TOP + i], far)


@kernel
def _prefetch_one(records, place, far):
    if far:
        prefetch_far(records, place)
    else:
        prefetch(records, place)


@kernel
def prefetch_listed(model, q, pairs):
    """Prefetch the records that the balls of another wave are paired with."""
    _prefetch_records(model.lines, pairs, LINE_IDS, q[PAIRED])
    _prefetch_records(model.arcs, pairs, ARC_IDS, q[PAIRED + 1])
    _prefetch_records(model.corners, pairs, CORNER_IDS, q[PAIRED + 2])


@kernel
def _prefetch_records(records, pairs, first, count):
    if records is not None:
        for k in range(count):
            prefetch_far(records, pairs[first + k])
