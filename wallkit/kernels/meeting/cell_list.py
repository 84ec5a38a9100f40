"""Cells as large as the largest disc: which discs are near, and when a disc goes on to the next cell.

Cells are numbered tile by tile, each of 4 by 4 cells, which is a line of the cache where their first discs are listed:
a cell and those around it are in two lines or so.
"""

from __future__ import annotations

import math

from wallkit.kernels.flight.gravity import move
from wallkit.kernels.jit import kernel
from wallkit.kernels.meeting.records import AFTER, CELL, LOST, NEVER, TIME, VX, VY, X, Y

STAYS, RIGHT, LEFT, UPWARDS, DOWNWARDS = range(5)
"""To which side of its cell a disc goes."""


@kernel
def cell_number(cells, up, along):
    """Number of the cell in a row and a column."""
    tile = ((up >> 2) << cells.shift) + (along >> 2)
    return (tile << 4) + ((up & 3) << 2) + (along & 3)


@kernel
def row_and_column(cells, cell):
    """Row and column of a cell."""
    tile = cell >> 4
    up, along = tile >> cells.shift, tile & ((1 << cells.shift) - 1)
    return (up << 2) + (cell >> 2 & 3), (along << 2) + (cell & 3)


@kernel
def cell_at(cells, x, y):
    """Number of the cell of a place; that at the border for a place beyond."""
    column = min(max((x - cells.x0) / cells.side, 0.0), cells.columns - 1.0)
    row = min(max((y - cells.y0) / cells.side, 0.0), cells.rows - 1.0)
    return cell_number(cells, int(row), int(column))


@kernel
def enter(discs, ball, cell):
    """Put a disc into a cell."""
    own = discs.link[ball]
    own[CELL], own[AFTER] = cell, discs.head[cell]
    discs.head[cell] = ball


@kernel
def quit_cell(discs, ball):
    """Take a disc out of its cell."""
    link, cell = discs.link, discs.link[ball][CELL]
    other = discs.head[cell]
    if other == ball:
        discs.head[cell] = link[ball][AFTER]
        return
    while link[other][AFTER] != ball:
        other = link[other][AFTER]
    link[other][AFTER] = link[ball][AFTER]


@kernel
def next_border(gravity, cells, row, up, along, now):
    """When a flight leaves its cell: (time of the clock, to which side, or STAYS).

    From where it is now; it need not be exact, for cells overlap by more than rounding.
    """
    span = now - (row[TIME] + row[LOST])
    x, y, vx, vy = move(gravity, row[X], row[Y], row[VX], row[VY], span)
    left, low = cells.x0 + along * cells.side, cells.y0 + up * cells.side
    time, step = NEVER, STAYS
    if along + 1 < cells.columns:
        time, step = _sooner(_passes(gravity, 0, 1.0, left + cells.side - x, vx), RIGHT, time, step)
    if along > 0:
        time, step = _sooner(_passes(gravity, 0, -1.0, x - left, -vx), LEFT, time, step)
    if up + 1 < cells.rows:
        time, step = _sooner(_passes(gravity, 1, 1.0, low + cells.side - y, vy), UPWARDS, time, step)
    if up > 0:
        time, step = _sooner(_passes(gravity, 1, -1.0, y - low, -vy), DOWNWARDS, time, step)
    return now + time, step


@kernel
def _sooner(time, step, then, other):
    """The sooner one of two ways out of a cell."""
    return (time, step) if time < then else (then, other)


@kernel
def _passes(gravity, axis, sign, short, speed):
    """How long it takes until a way that is ``short`` of a border passes it outwards; ``sign`` 1 where that is upwards.

    h = v t + g t^2 / 2 with h >= 0. It passes outwards at the root with the velocity +s, s^2 = v^2 + 2 g h, which is
    t = 2 h / (v + s), or (s - v) / g where v < 0 < g. With g <= 0 and v <= 0 it never does.
    """
    h = short if short > 0.0 else 0.0
    if gravity is None:
        return h / speed if speed > 0.0 else NEVER
    pull = sign * gravity[axis]
    square = speed * speed + 2.0 * pull * h
    if square <= 0.0 or (speed <= 0.0 and pull <= 0.0):
        return NEVER
    s = math.sqrt(square)
    return 2.0 * h / (speed + s) if speed >= 0.0 else (s - speed) / pull
