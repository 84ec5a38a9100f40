"""Which cells an edge or a corner goes into: those crossed by the places of a centre at a contact, widened.

The places are two lines beside an edge, two arcs beside an arc, and the arc around a corner. Arcs are cut into chords.
Entries are written into flat numbers, four a cell as in ``Cell``, twice: first they are only counted, then, when
``lay_out`` has made places of the counts, the ids are written too. So nothing is sorted, and ids come cell by cell in
the order in which they are given.
"""

from __future__ import annotations

import math

from wallkit.kernels.arcs import is_wide, to_end
from wallkit.kernels.jit import kernel, rare_kernel
from wallkit.kernels.model import HALF, WIDEST

BOW = 1.0 / 8.0
"""Chords miss their arc by at most this part of a cell, and what they miss it by widens them."""
SMALL = 1.0 / 4.0
"""An arc of at most this radius, in cells, crosses most of the cells that its box does."""
MOST_CHORDS = 1024
"""Of a part of an arc; in cells so small that they bow more, they are the wider."""
OF_LINES, OF_ARCS, OF_CORNERS = 1, 2, 4
"""Where in a cell's numbers the entries of a kind are counted. When all are written each of them has come to the end of
its kind, which is where the next one begins: ``arcs``, ``corners``, and ``first`` of the next cell."""
LATEST = 3
"""Where in a cell's numbers the latest entry stands, so that none is entered twice; later its ``link``."""


@kernel
def enter(blocks, source, lines, arcs, corners, fans, distance, numbers, ids, entered):
    """Enter edges and corners into the cells of blocks; with no ``ids`` they are only counted.

    Blocks speak of ids of ``source``; lines, arcs, their numbers and corners are those of ``Model``, and ``fans`` has
    a ``Fan`` for each vertex. ``distance`` is that of a centre at a contact. Written are ``numbers``, four a cell and
    four more at the end, ``ids``, and how many are ``entered`` by block: more than ``most`` where it was given up.
    """
    for b in range(len(blocks)):
        block = blocks[b]
        count = 0
        for k in range(block.start, block.end):
            if count > block.most:
                break
            if k < block.arcs:
                count += _enter_line(block, lines[source[k]], distance, k, source[k], numbers, ids)
            elif k >= block.corners:
                corner, fan = corners[source[k]], fans[source[k]]
                count += _arc(block, corner.x, corner.y, distance, fan.ux, fan.uy, fan.wx, fan.wy, fan.wide,
                              OF_CORNERS, k, source[k], numbers, ids)  # fmt: skip
            elif arcs is not None:
                count += _enter_arc(block, arcs[source[k]], distance, k, source[k], numbers, ids)
        entered[b] = count


@kernel
def _enter_line(block, line, distance, item, entry, numbers, ids):
    """Enter the lines at a distance beside an edge; the functions below give how many cells were new to it."""
    sx, sy = distance * line.nx, distance * line.ny
    count = _line(block, line.ax + sx, line.ay + sy, line.bx + sx, line.by + sy, block.reach,
                  OF_LINES, item, entry, numbers, ids)  # fmt: skip
    if distance > 0.0:
        count += _line(block, line.ax - sx, line.ay - sy, line.bx - sx, line.by - sy, block.reach,
                       OF_LINES, item, entry, numbers, ids)  # fmt: skip
    return count


@kernel
def _enter_arc(block, arc, distance, item, entry, numbers, ids):
    """Enter the arcs at a distance outside and inside an arc."""
    x, y, per = arc.ax - arc.sx, arc.ay - arc.sy, 1.0 / arc.radius
    fx, fy = to_end(arc)
    ux, uy, wx, wy = arc.sx * per, arc.sy * per, fx * per, fy * per
    wide = 1.0 if is_wide(arc.sweep) else 0.0
    count = _arc(block, x, y, arc.radius + distance, ux, uy, wx, wy, wide, OF_ARCS, item, entry, numbers, ids)
    if distance > 0.0:
        count += _arc(block, x, y, arc.radius - distance, ux, uy, wx, wy, wide, OF_ARCS, item, entry, numbers, ids)
    return count


@rare_kernel
def _arc(block, x, y, radius, ux, uy, wx, wy, wide, kind, item, entry, numbers, ids):
    """Enter an arc about (x, y), from the direction u counter-clockwise to w: its box, or parts below 120 degrees."""
    small = abs(radius) <= SMALL * block.side
    if wide == 0.0 and not small and ux * wx + uy * wy > -0.5:
        return _chords(block, x, y, radius, ux, uy, wx, wy, kind, item, entry, numbers, ids)
    mx, my = _half_way(ux, uy, wx, wy, wide)
    if small:
        edge = mx * ux + my * uy  # directions as near to the middle are in the arc
        left, right = -1.0 if -mx >= edge else min(ux, wx), 1.0 if mx >= edge else max(ux, wx)
        low, high = -1.0 if -my >= edge else min(uy, wy), 1.0 if my >= edge else max(uy, wy)
        if radius < 0.0:
            left, right, low, high = right, left, high, low
        return _box(block, x + radius * left, x + radius * right, y + radius * low, y + radius * high,
                    kind, item, entry, numbers, ids)  # fmt: skip
    if wide == 0.0:
        count = _chords(block, x, y, radius, ux, uy, mx, my, kind, item, entry, numbers, ids)
        return count + _chords(block, x, y, radius, mx, my, wx, wy, kind, item, entry, numbers, ids)
    hx, hy = _half_way(ux, uy, mx, my, 0.0)
    count = _chords(block, x, y, radius, ux, uy, hx, hy, kind, item, entry, numbers, ids)
    count += _chords(block, x, y, radius, hx, hy, mx, my, kind, item, entry, numbers, ids)
    hx, hy = _half_way(mx, my, wx, wy, 0.0)
    count += _chords(block, x, y, radius, mx, my, hx, hy, kind, item, entry, numbers, ids)
    return count + _chords(block, x, y, radius, hx, hy, wx, wy, kind, item, entry, numbers, ids)


@kernel
def _half_way(ux, uy, wx, wy, wide):
    """Direction half way from u counter-clockwise to w: along their sum, or beside their difference."""
    if ux * wx + uy * wy <= 0.0:
        mx, my = wy - uy, ux - wx
    else:
        mx, my = ux + wx, uy + wy
        if wide != 0.0:
            mx, my = -mx, -my
    length = math.sqrt(mx * mx + my * my)
    return mx / length, my / length


@rare_kernel
def _chords(block, x, y, radius, ux, uy, wx, wy, kind, item, entry, numbers, ids):
    """Enter an arc of less than 120 degrees in chords: halved until they bow little enough, then turned on and on.

    Cosines and sines of halves need square roots alone, which are the same everywhere. Turning on gathers up to two
    roundings a chord, and the centre of a flat arc is far away: both are parts of the radius, and widen the chords.
    """
    cosine, sine = min(ux * wx + uy * wy, 1.0), ux * wy - uy * wx
    half = math.sqrt(0.5 + 0.5 * cosine)
    size = abs(radius)
    bow = size * (0.5 - 0.5 * cosine) / (1.0 + half)
    count = 1
    while bow > BOW * block.side and count < MOST_CHORDS:
        cosine, sine, count = half, sine / (2.0 * half), 2 * count
        half = math.sqrt(0.5 + 0.5 * cosine)
        bow = size * (0.5 - 0.5 * cosine) / (1.0 + half)
    reach = block.reach + bow + size * (count + 1) * 2.0**-51
    ax, ay, entries = x + radius * ux, y + radius * uy, 0
    for _chord in range(count):
        ux, uy = ux * cosine - uy * sine, ux * sine + uy * cosine
        bx, by = x + radius * ux, y + radius * uy
        entries += _line(block, ax, ay, bx, by, reach, kind, item, entry, numbers, ids)
        ax, ay = bx, by
    return entries


@rare_kernel
def _box(block, left, right, low, high, kind, item, entry, numbers, ids):
    """Enter a box, and what is within reach of it."""
    per_side, reach = block.per_side, block.reach
    left, right = (left - reach - block.x0) * per_side, (right + reach - block.x0) * per_side
    low, high = (low - reach - block.y0) * per_side, (high + reach - block.y0) * per_side
    if right < 0.0 or left >= block.columns or high < 0.0 or low >= block.rows:
        return 0
    count = 0
    for column in range(int(max(left, 0.0)), int(min(right, block.columns - 0.5)) + 1):
        count += _rows(block, column, low, high, kind, item, entry, numbers, ids)
    return count


@rare_kernel
def _line(block, ax, ay, bx, by, reach, kind, item, entry, numbers, ids):
    """Enter a line, and all within reach of it along x and y: column by column, the rows that it covers there."""
    per_side = block.per_side
    ax, ay, bx, by, reach = (
        (ax - block.x0) * per_side, (ay - block.y0) * per_side,
        (bx - block.x0) * per_side, (by - block.y0) * per_side, reach * per_side,
    )  # fmt: skip
    left, right, low, high = min(ax, bx) - reach, max(ax, bx) + reach, min(ay, by), max(ay, by)
    if right < 0.0 or left >= block.columns or high + reach < 0.0 or low - reach >= block.rows:
        return 0
    first, last = int(max(left, 0.0)), int(min(right, block.columns - 0.5))
    if first == last or ax == bx:
        bottom, top, count = low - reach, high + reach, 0
        for column in range(first, last + 1):
            count += _rows(block, column, bottom, top, kind, item, entry, numbers, ids)
        return count
    slope, count = (by - ay) / (bx - ax), 0
    for column in range(first, last + 1):
        here, there = ay + (column - reach - ax) * slope, ay + (column + 1 + reach - ax) * slope
        bottom, top = max(low, min(here, there, high)) - reach, min(high, max(here, there, low)) + reach
        if top >= 0.0 and bottom < block.rows:
            count += _rows(block, column, bottom, top, kind, item, entry, numbers, ids)
    return count


@kernel
def _rows(block, column, bottom, top, kind, item, entry, numbers, ids):
    """Enter what a column holds between two heights, given in cells; one of them at least is in the block."""
    lowest, count = int(max(bottom, 0.0)), 0
    at = 4 * (block.first + column + block.columns * lowest)
    for _row in range(lowest, int(min(top, block.rows - 0.5)) + 1):
        if numbers[at + LATEST] != item + 1:
            numbers[at + LATEST] = item + 1
            if len(ids) > 0:
                ids[numbers[at + kind]] = entry
            numbers[at + kind] += 1
            count += 1
        at += 4 * block.columns
    return count


@kernel
def lay_out(numbers):
    """Make of the counts of each cell where its entries of each kind begin; give how many there are in all."""
    total = 0
    for at in range(0, len(numbers) - 4, 4):
        lines, arcs, corners = numbers[at + OF_LINES], numbers[at + OF_ARCS], numbers[at + OF_CORNERS]
        numbers[at + OF_LINES] = total
        numbers[at + OF_ARCS] = total + lines
        numbers[at + OF_CORNERS] = total + lines + arcs
        numbers[at + LATEST] = 0
        total += int(lines) + int(arcs) + int(corners)
    return total


@kernel
def clear(blocks, numbers, endless):
    """Link each cell that lists nothing to the nearest one that does: how many king's moves it is away, at least 1.

    Two passes over each block, forth and back, as for any distance of moves. What lies around a block is not known and
    counts as listing something, unless the block is ``endless``: there is nothing beyond the whole grid.
    """
    for b in range(len(blocks)):
        block = blocks[b]
        columns, rows, outside = block.columns, block.rows, 1 << 30 if endless else 0
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
def clear_ahead(numbers, columns, rows, above, clearings):
    """Find a large empty rectangle that begins with each cell, each way; see ``Model.clearings``.

    It is the one of the cell beside and this cell, or that of the cell above and this cell, cut to what is free above
    or beside: the one with the larger w h / (w + h), since a ball leaves it by the shorter side, mostly. There is
    nothing beyond the border, and WIDEST is all that half of a number holds.

    Args:
        numbers: of the cells, see above.
        columns: of the grid.
        rows: of the grid.
        above: a number for each column, to work with.
        clearings: written.
    """
    for way in range(4):
        step, rise = 1 - 2 * (way & 1), 1 - (way & 2)
        for j in range(rows):
            row = rows - 1 - j if rise > 0 else j
            beside, wide, high = WIDEST, WIDEST, WIDEST
            for i in range(columns):
                column = columns - 1 - i if step > 0 else i
                cell = row * columns + column
                at = 4 * cell + way
                if numbers[4 * cell + 4] != numbers[4 * cell]:
                    beside, wide, high, above[column], clearings[at] = 0, 0, WIDEST, 0, 0
                    continue
                up, broad, tall = WIDEST, WIDEST, WIDEST
                if j > 0:
                    up, broad = min(int(above[column]) + 1, WIDEST), int(clearings[at + 4 * rise * columns])
                    tall = min((broad >> HALF) + 1, WIDEST)
                    broad = broad & WIDEST if tall > 1 else WIDEST
                above[column] = up
                beside = min(beside + 1, WIDEST)
                wide, high, broad = min(wide + 1, WIDEST), min(high, up), min(broad, beside)
                if wide * high * (broad + tall) < broad * tall * (wide + high):
                    wide, high = broad, tall
                clearings[at] = wide + (high << HALF)
