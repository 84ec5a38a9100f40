"""How far it is from each cell to the next one in which a flight may meet something."""

from __future__ import annotations

from wallkit.kernels.index.cell_chains import MANY, pair_of
from wallkit.kernels.index.cell_entries import LATEST
from wallkit.kernels.index.grid import clearing_at, clearings_of, departures_of
from wallkit.kernels.jit import kernel, rare_kernel
from wallkit.kernels.records import HALF, OCTANTS, WIDEST

STRETCH = 4
"""Cells of a chain that a rectangle takes in, along and across: more make few longer."""


@kernel
def clear(blocks, numbers, endless):
    """Note for each empty cell its Chebyshev distance to the nearest cell with entries, at least 1.

    Two passes over each block, forth and back. What lies around a block is not known and
    counts as listing something, unless the block is ``endless``: there is nothing beyond the whole grid.
    """
    for b in range(len(blocks)):
        block = blocks[b]
        columns, rows, outside = block.columns, block.rows, 1 << 30 if endless else 0
        # Two-pass distance transform in the chessboard metric (Rosenfeld and Pfaltz 1966): forth from the neighbours to
        # the left and below, then back from those to the right and above.
        for row in range(rows):
            for column in range(columns):
                at = 4 * (block.first + row * columns + column)
                moves = 0
                if numbers[at + 4] == numbers[at]:
                    back, below = numbers[at - 4 + LATEST] if column > 0 else outside, outside
                    if row > 0:
                        below = numbers[at - 4 * columns + LATEST]
                        below = min(below, numbers[at - 4 * columns - 4 + LATEST] if column > 0 else outside)
                        below = min(below, numbers[at - 4 * columns + 4 + LATEST] if column < columns - 1 else outside)
                    moves = min(back, below) + 1
                numbers[at + LATEST] = moves
        for row in range(rows - 1, -1, -1):
            for column in range(columns - 1, -1, -1):
                at = 4 * (block.first + row * columns + column)
                moves = numbers[at + LATEST]
                if moves > 1:
                    ahead, above = numbers[at + 4 + LATEST] if column < columns - 1 else outside, outside
                    if row < rows - 1:
                        above = numbers[at + 4 * columns + LATEST]
                        above = min(above, numbers[at + 4 * columns - 4 + LATEST] if column > 0 else outside)
                        above = min(above, numbers[at + 4 * columns + 4 + LATEST] if column < columns - 1 else outside)
                    moves = min(moves, min(ahead, above) + 1)
                numbers[at + LATEST] = moves


@kernel
def clear_ahead(octants, grid, above, clearings):
    """Find a large empty rectangle that begins with each cell, for each octant; see ``Model.clearings``.

    It is the one of the cell beside and this cell, or that of the cell above and this cell, cut to what is free above
    or beside. There is nothing beyond the border, and WIDEST is all that half of a number holds.

    Args:
        octants: of the cells, see ``Table``.
        grid: that they are in.
        above: a number for each column, to work with.
        clearings: written.
    """
    columns, rows = grid.columns, grid.rows
    for octant in range(grid.octants):
        step, rise, first = 1 - 2 * (octant & 1), 1 - (octant & 2), clearings_of(grid, octant)
        for j in range(rows):
            row = rows - 1 - j if rise > 0 else j
            beside, wide, high = WIDEST, WIDEST, WIDEST
            for i in range(columns):
                column = columns - 1 - i if step > 0 else i
                cell = row * columns + column
                at = clearing_at(grid, first, cell)
                if (octants[cell] >> octant) & 1 != 0:
                    beside, wide, high, above[column], clearings[at] = 0, 0, WIDEST, 0, 0
                    continue
                # Two candidates: this row as far as it is free, as high as the lowest of its columns; and the rectangle
                # of the cell above, one row higher, cut to what is free here.
                up, broad, tall = WIDEST, WIDEST, WIDEST
                if j > 0:
                    up = min(int(above[column]) + 1, WIDEST)
                    broad = int(clearings[clearing_at(grid, first, cell + rise * columns)])
                    tall = min((broad >> HALF) + 1, WIDEST)
                    broad = broad & WIDEST if tall > 1 else WIDEST
                above[column] = up
                beside = min(beside + 1, WIDEST)
                wide, high, broad = min(wide + 1, WIDEST), min(high, up), min(broad, beside)
                if is_larger(broad, tall, wide, high):
                    wide, high = broad, tall
                clearings[at] = wide + (high << HALF)


@kernel
def is_larger(wide, high, than_wide, than_high):
    """Compare w h / (w + h) of two rectangles, since a ball leaves one by the shorter side, mostly."""
    # w h / (w + h) > W H / (W + H), multiplied out: whole numbers, no quotient.
    return wide * high * (than_wide + than_high) > than_wide * than_high * (wide + high)


@kernel
def clear_departures(listing, count, chains, grid, clearings):
    """Find a large rectangle, for each octant, in which a ball that leaves a wall in a cell meets nothing.

    Its cells list nothing at all, or edges of one chain alone (see ``cell_chains``), which it
    leaves. It begins with a few cells of the chain, along the row or the column, and goes on as the clearings of empty
    ones do.

    Args:
        listing: the cells that list something.
        count: of them.
        chains: for each pair of opposite octants, by cell: the chain of all that it lists, 0 for nothing, or MANY.
        grid: not packed, with clearings for the quadrants.
        clearings: departures are written, for cells of one chain.
    """
    columns, rows, cells = grid.columns, grid.rows, grid.columns * grid.rows
    for octant in range(OCTANTS):
        step, rise, plane, pair = 1 - 2 * (octant & 1), 1 - (octant & 2), (octant & 3) * cells, pair_of(octant) * cells
        for k in range(count):
            cell = listing[k]
            if chains[pair + cell] != MANY:
                column, row = cell % columns, cell // columns
                wide, high = _grow(chains, pair, clearings, plane, columns, rows, column, row, step, 0, 0, rise)
                tall, broad = _grow(chains, pair, clearings, plane, columns, rows, column, row, 0, rise, step, 0)
                if is_larger(broad, tall, wide, high):
                    wide, high = broad, tall
                clearings[departures_of(grid, octant) + cell] = wide + (high << HALF)


@rare_kernel
def _grow(chains, pair, clearings, plane, columns, rows, column, row, step, rise, step_up, rise_up):
    """Grow a rectangle by lines across, line by line along (step, rise): (how far along, how far across)."""
    chain, limit = chains[pair + row * columns + column], WIDEST
    along, across = 1, 1
    for k in range(STRETCH):
        there = column + k * step, row + k * rise
        size = _across(chains, pair, clearings, plane, columns, rows, *there, step_up, rise_up, chain)
        if size == 0:
            break
        limit = min(limit, size)
        cell = (row + k * rise) * columns + column + k * step
        far, empty = k + 1, chains[pair + cell] == 0
        if empty:
            far = min(k + _side(clearings[plane + cell], step), WIDEST)
        # One line longer, but only as wide as the narrowest so far: the best of all lengths is kept.
        if is_larger(far, limit, along, across):
            along, across = far, limit
        if empty:
            break
    return along, across


@kernel
def _across(chains, pair, clearings, plane, columns, rows, column, row, step, rise, chain):
    """How many cells of a line list nothing but a chain, or at least so many: 0 for none, or outside."""
    for k in range(STRETCH):
        if (column < 0) | (row < 0) | (column >= columns) | (row >= rows):
            return k
        cell = row * columns + column
        if chains[pair + cell] == 0:
            # The rectangle ahead of an empty cell goes on in this line: its length counts whole.
            return min(k + _side(clearings[plane + cell], step), WIDEST)
        if chains[pair + cell] != chain:
            return k
        column, row = column + step, row + rise
    return STRETCH


@kernel
def _side(clearing, step):
    """How far a clearing goes along its columns, where steps go so, or else along its rows."""
    return int(clearing) & WIDEST if step != 0 else int(clearing) >> HALF
