"""Which cells an edge or a corner goes into: those crossed by the places of a centre at a contact, widened.

The places are two lines beside an edge, two arcs beside an arc, and the arc around a corner. Arcs are cut into chords.
Entries are counted in flat numbers, four a cell as in ``Cell``, and noted one after the other. ``sort`` makes places of
the counts and takes each id to its own, so that they come cell by cell in the order in which they are given.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from wallkit.kernels.impact.arc_impact import FALLING_MOULD, MOULD, is_mould, is_wide, to_end
from wallkit.kernels.intrinsics import prefetch_far
from wallkit.kernels.jit import kernel, rare_kernel
from wallkit.kernels.records import OCTANTS

BOW = 1.0 / 8.0
"""Chords miss their arc by at most this part of a cell, and what they miss it by widens them."""
SMALL = 1.0 / 2.0
"""An arc of at most this radius, in cells, crosses most of the cells that its box does."""
MOST_CHORDS = 1024
"""Of a part of an arc; in cells so small that they bow more, they are the wider."""
OF_LINES, OF_ARCS, OF_CORNERS = 1, 2, 4
"""Where in a cell's numbers the entries of a kind are counted. When all are sorted each of them has come to the end of
its kind, which is where the next one begins: ``arcs``, ``corners``, and ``first`` of the next cell."""
ALL_OCTANTS = (1 << OCTANTS) - 1
ASIDE = 2.0**-10
"""Cosine by which a flight must go away from what it is not to meet: far above what rounding may turn."""
NEAR_CELLS = 1 << 16
"""So many stay in the L2 cache: a prefetch would gain nothing."""
AHEAD = 8
"""Prefetch distance, in entries: by then the cell has come, and it is still in the cache."""
LATEST = 3
"""Where in a cell's numbers the latest entry stands, so that none is entered twice; later the ``moves_to_next``."""


class Table(NamedTuple):
    """What is written of cells."""

    numbers: Any
    """Four a cell, and four more at the end."""
    octants: Any
    """The bits of the octants in which a flight may meet something that a cell lists; empty where nobody asks."""
    counted: Any
    """By entry: which of the numbers counts it."""
    ids: Any
    """By entry: the id. Entries for which there is no room are only counted."""


@kernel
def enter(blocks, source, lines, arcs, corners, fans, distance, table, entered):
    """Enter edges and corners into the cells of blocks; with no ``ids`` they are only counted.

    Blocks speak of ids of ``source``; lines, arcs, their numbers and corners are those of ``Model``, and ``fans`` has
    a ``Fan`` for each vertex; both are None for points, which meet no corner. ``distance`` is that of a centre at a
    contact. Written are the ``table``, and how many are ``entered`` by block: more than ``most`` where it was given up.

    The functions below take how many entries there are so far, and return how many there are then.
    """
    count = 0
    for b in range(len(blocks)):
        block = blocks[b]
        before, far = count, block.columns * block.rows > NEAR_CELLS
        for k in range(block.start, block.end):
            if count - before > block.most:
                break
            if far and k + AHEAD < block.end:
                _prefetch_cells(block, source[k + AHEAD], k + AHEAD >= block.corners, lines, corners, table.numbers)
            if k < block.arcs:
                count = _enter_line(block, lines[source[k]], distance, k, source[k], count, table)
            elif corners is not None and k >= block.corners:
                corner, fan = corners[source[k]], fans[source[k]]
                # Which way such a fan opens is rounding: both ways are entered.
                if fan.both > 0.0:
                    count = _arc(block, corner.x, corner.y, distance, -fan.ux, -fan.uy, -fan.wx, -fan.wy, fan.wide,
                                 1.0, OF_CORNERS, k, source[k], count, table)  # fmt: skip
                count = _arc(block, corner.x, corner.y, distance, fan.ux, fan.uy, fan.wx, fan.wy, fan.wide, 1.0,
                             OF_CORNERS, k, source[k], count, table)  # fmt: skip
            elif arcs is not None:
                count = _enter_arc(block, arcs[source[k]], distance, k, source[k], count, table)
        entered[b] = count - before


@kernel
def _prefetch_cells(block, entry, is_corner, lines, corners, numbers):
    """Prefetch the cell in the middle of what is entered soon, and those above and below it."""
    if corners is not None and is_corner:
        x, y = corners[entry].x, corners[entry].y
    else:
        line = lines[entry]
        x, y = 0.5 * (line.ax + line.bx), 0.5 * (line.ay + line.by)
    column, row = int((x - block.x0) * block.per_side), int((y - block.y0) * block.per_side)
    at = 4 * (block.first + column + block.columns * row)
    for neighbour in range(-1, 2):
        prefetch_far(numbers, at + 4 * block.columns * neighbour)


@kernel
def _enter_line(block, line, distance, item, entry, count, table):
    """Enter the lines at a distance beside an edge."""
    nx, ny, octants = line.nx, line.ny, ALL_OCTANTS
    # At a contact the centre is on the edge moved out by r, along n or against it; for a point both are one.
    for _side in range(2 if distance > 0.0 else 1):
        sx, sy = distance * nx, distance * ny
        if len(table.octants) > 0:
            octants = octants_against(nx, ny, nx, ny)
        count = _line(block, line.ax + sx, line.ay + sy, line.bx + sx, line.by + sy, block.reach,
                      OF_LINES, item, entry, octants, count, table)  # fmt: skip
        nx, ny = -nx, -ny
    return count


@kernel
def _enter_arc(block, arc, distance, item, entry, count, table):
    """Enter the arcs at a distance outside and inside an arc."""
    # The arc's centre is a - s. A centre at a contact is R + r or |R - r| from it, in a direction of the arc.
    x, y, per = arc.ax - arc.sx, arc.ay - arc.sy, 1.0 / arc.radius
    fx, fy = to_end(arc)
    ux, uy, wx, wy = arc.sx * per, arc.sy * per, fx * per, fy * per
    wide = 1.0 if is_wide(arc.sweep) else 0.0
    count = _arc(block, x, y, arc.radius + distance, ux, uy, wx, wy, wide, 1.0, OF_ARCS, item, entry, count, table)
    if distance > 0.0:
        inside = MOULD * arc.radius if is_mould(arc.radius, distance) else arc.radius - distance
        count = _arc(block, x, y, inside, ux, uy, wx, wy, wide, -1.0, OF_ARCS, item, entry, count, table)
        inside = FALLING_MOULD * arc.radius
        if abs(arc.radius - distance) < inside:
            count = _arc(block, x, y, inside, ux, uy, wx, wy, wide, -1.0, OF_ARCS, item, entry, count, table)
    return count


@rare_kernel
def _arc(block, x, y, radius, ux, uy, wx, wy, wide, facing, kind, item, entry, count, table):
    """Enter an arc about (x, y), from the direction u counter-clockwise to w: its box, or parts below 120 degrees."""
    small = abs(radius) <= SMALL * block.side
    facing = facing if radius > SMALL * block.side + block.reach else 0.0
    if wide == 0.0 and not small and ux * wx + uy * wy > -0.5:
        return _chords(block, x, y, radius, ux, uy, wx, wy, facing, kind, item, entry, count, table)
    if small:
        # The box holds the ends, and each extreme of the circle that is in the arc: as near to its middle m as u is.
        mx, my = _towards(ux, uy, wx, wy, wide)
        edge = mx * ux + my * uy  # directions as near to the middle are in the arc
        left, right = -1.0 if -mx >= edge else min(ux, wx), 1.0 if mx >= edge else max(ux, wx)
        low, high = -1.0 if -my >= edge else min(uy, wy), 1.0 if my >= edge else max(uy, wy)
        if radius < 0.0:
            left, right, low, high = right, left, high, low
        return _box(block, x + radius * left, x + radius * right, y + radius * low, y + radius * high,
                    kind, item, entry, ALL_OCTANTS, count, table)  # fmt: skip
    mx, my = _half_way(ux, uy, wx, wy, wide)
    if wide == 0.0:
        count = _chords(block, x, y, radius, ux, uy, mx, my, facing, kind, item, entry, count, table)
        return _chords(block, x, y, radius, mx, my, wx, wy, facing, kind, item, entry, count, table)
    hx, hy = _half_way(ux, uy, mx, my, 0.0)
    count = _chords(block, x, y, radius, ux, uy, hx, hy, facing, kind, item, entry, count, table)
    count = _chords(block, x, y, radius, hx, hy, mx, my, facing, kind, item, entry, count, table)
    hx, hy = _half_way(mx, my, wx, wy, 0.0)
    count = _chords(block, x, y, radius, mx, my, hx, hy, facing, kind, item, entry, count, table)
    return _chords(block, x, y, radius, hx, hy, wx, wy, facing, kind, item, entry, count, table)


@kernel
def octants_against(ux, uy, wx, wy):
    """The bits of the octants in which a flight may go against a direction between u and w; see ``grid.octant_of``.

    It may not where both u and w lie along both ends of the octant, by more than rounding: so do all between them.
    """
    # An octant lies between two directions, such as (1, 0) and (1, 1). A normal with n.(1, 0) > 0 and n.(1, 1) > 0
    # goes along with every flight between them, and none of these meets the wall. n.(1, 1) is a sum, n.(1, -1) a rest.
    low_x, high_x, low_y, high_y = min(ux, wx), max(ux, wx), min(uy, wy), max(uy, wy)
    low_sum, high_sum = min(ux + uy, wx + wy), max(ux + uy, wx + wy)
    low_rest, high_rest = min(ux - uy, wx - wy), max(ux - uy, wx - wy)
    right, left, up, down = low_x >= ASIDE, high_x <= -ASIDE, low_y >= ASIDE, high_y <= -ASIDE
    right_up, left_down = low_sum >= ASIDE, high_sum <= -ASIDE
    right_down, left_up = low_rest >= ASIDE, high_rest <= -ASIDE
    along = (
        int(right & right_up) + (int(left & left_up) << 1)
        + (int(right & right_down) << 2) + (int(left & left_down) << 3)
        + (int(up & right_up) << 4) + (int(up & left_up) << 5)
        + (int(down & right_down) << 6) + (int(down & left_down) << 7)
    )  # fmt: skip
    return ALL_OCTANTS - along


@kernel
def _towards(ux, uy, wx, wy, wide):
    """A vector half way from u counter-clockwise to w, of any length: their sum, or their difference turned."""
    # u + w, or, beyond a right angle, where that cancels, w - u turned by a quarter to the right.
    if ux * wx + uy * wy <= 0.0:
        return wy - uy, ux - wx
    return (ux + wx, uy + wy) if wide == 0.0 else (-ux - wx, -uy - wy)


@kernel
def _half_way(ux, uy, wx, wy, wide):
    """Direction half way from u counter-clockwise to w."""
    mx, my = _towards(ux, uy, wx, wy, wide)
    length = math.sqrt(mx * mx + my * my)
    return mx / length, my / length


@rare_kernel
def _chords(block, x, y, radius, ux, uy, wx, wy, facing, kind, item, entry, count, table):
    """Enter an arc of less than 120 degrees in chords: halved until they bow little enough, then turned on and on.

    Cosines and sines of halves need square roots alone, which are the same everywhere. Turning on gathers up to two
    roundings a chord, and the centre of a flat arc is far away: both are parts of the radius, and widen the chords.
    """
    cosine, sine = min(ux * wx + uy * wy, 1.0), ux * wy - uy * wx
    # cos(A/2) = sqrt((1 + cos A) / 2), and the bow R (1 - cos(A/2)) = R (1 - cos A) / 2 / (1 + cos(A/2)).
    half = math.sqrt(0.5 + 0.5 * cosine)
    size = abs(radius)
    bow = size * (0.5 - 0.5 * cosine) / (1.0 + half)
    chords = 1
    while bow > BOW * block.side and chords < MOST_CHORDS:
        # sin(A/2) = sin A / (2 cos(A/2)).
        cosine, sine, chords = half, sine / (2.0 * half), 2 * chords
        half = math.sqrt(0.5 + 0.5 * cosine)
        bow = size * (0.5 - 0.5 * cosine) / (1.0 + half)
    reach = block.reach + bow + size * (chords + 1) * 2.0**-51
    ax, ay, octants = x + radius * ux, y + radius * uy, ALL_OCTANTS
    for _chord in range(chords):
        wx, wy = ux * cosine - uy * sine, ux * sine + uy * cosine
        bx, by = x + radius * wx, y + radius * wy
        if len(table.octants) > 0 and facing != 0.0:
            octants = octants_against(facing * ux, facing * uy, facing * wx, facing * wy)
        count = _line(block, ax, ay, bx, by, reach, kind, item, entry, octants, count, table)
        ax, ay, ux, uy = bx, by, wx, wy
    return count


@rare_kernel
def _box(block, left, right, low, high, kind, item, entry, octants, count, table):
    """Enter a box, and what is within reach of it."""
    per_side, reach = block.per_side, block.reach
    left, right = (left - reach - block.x0) * per_side, (right + reach - block.x0) * per_side
    low, high = (low - reach - block.y0) * per_side, (high + reach - block.y0) * per_side
    if right < 0.0 or left >= block.columns or high < 0.0 or low >= block.rows:
        return count
    column, row = int(max(left, 0.0)), int(max(low, 0.0))
    columns = int(min(right, block.columns - 0.5)) + 1 - column
    rows = int(min(high, block.rows - 0.5)) + 1 - row
    # One loop over all its cells, not a loop of loops: their ends are what the processor predicts wrongly.
    at, k = 4 * (block.first + column + block.columns * row), 0
    for _cell in range(columns * rows):
        count = _enter_cell(at, kind, item, entry, octants, count, table)
        k += 1
        at += 4 if k < columns else 4 * (block.columns + 1 - columns)
        k = k if k < columns else 0
    return count


@rare_kernel
def _line(block, ax, ay, bx, by, reach, kind, item, entry, octants, count, table):
    """Enter a line, and all within reach of it along x and y: column by column, the rows that it covers there."""
    per_side = block.per_side
    ax, ay, bx, by, reach = (
        (ax - block.x0) * per_side, (ay - block.y0) * per_side,
        (bx - block.x0) * per_side, (by - block.y0) * per_side, reach * per_side,
    )  # fmt: skip
    left, right, low, high = min(ax, bx) - reach, max(ax, bx) + reach, min(ay, by), max(ay, by)
    if right < 0.0 or left >= block.columns or high + reach < 0.0 or low - reach >= block.rows:
        return count
    first, last = int(max(left, 0.0)), int(min(right, block.columns - 0.5))
    whole = first == last or ax == bx
    slope = 0.0 if whole else (by - ay) / (bx - ax)
    for column in range(first, last + 1):
        # The rows that the line covers over a column, itself widened by `reach`, cut to the line's own height.
        here, there = ay + (column - reach - ax) * slope, ay + (column + 1 + reach - ax) * slope
        here, there = (low, high) if whole else (here, there)
        bottom, top = max(low, min(here, there, high)) - reach, min(high, max(here, there, low)) + reach
        if top >= 0.0 and bottom < block.rows:
            count = _rows(block, column, bottom, top, kind, item, entry, octants, count, table)
    return count


@kernel
def _rows(block, column, bottom, top, kind, item, entry, octants, count, table):
    """Enter what a column holds between two heights, given in cells; one of them at least is in the block."""
    lowest = int(max(bottom, 0.0))
    at = 4 * (block.first + column + block.columns * lowest)
    for _row in range(lowest, int(min(top, block.rows - 0.5)) + 1):
        count = _enter_cell(at, kind, item, entry, octants, count, table)
        at += 4 * block.columns
    return count


@kernel
def _enter_cell(at, kind, item, entry, octants, count, table):
    """Enter into the cell whose numbers begin ``at`` a place."""
    # The latest entry stands in the cell, so that chords and sides that overlap are entered once.
    numbers = table.numbers
    if numbers[at + LATEST] != item + 1:
        numbers[at + LATEST] = item + 1
        numbers[at + kind] += 1
        if count < len(table.ids):
            table.counted[count], table.ids[count] = at + kind, entry
        count += 1
    if len(table.octants) > 0:
        table.octants[at >> 2] |= octants
    return count


@kernel
def sort(table, ids):
    """Write the ids of a table cell by cell, of each lines, arcs, corners; there are as many as are entered."""
    numbers, total = table.numbers, 0
    for at in range(0, len(numbers) - 4, 4):
        lines, arcs, corners = numbers[at + OF_LINES], numbers[at + OF_ARCS], numbers[at + OF_CORNERS]
        # Where each kind begins. Writing an id moves this on, in the end to where the next kind begins.
        numbers[at + OF_LINES] = total
        numbers[at + OF_ARCS] = total + lines
        numbers[at + OF_CORNERS] = total + lines + arcs
        numbers[at + LATEST] = 0
        total += int(lines) + int(arcs) + int(corners)
    for k in range(len(ids)):
        at = table.counted[k]
        ids[numbers[at]] = table.ids[k]
        numbers[at] += 1


@kernel
def describe(numbers, before, farthest, cells, first, step):
    """Write the fields of ``Cell``, flat, of cells that come one after the other.

    Args:
        numbers: of the cells, see ``Table``, sorted.
        before: so many ids come before theirs.
        farthest: bound of distances.
        cells: written.
        first: where they begin.
        step: how far apart they are.
    """
    to = first
    for at in range(0, len(numbers) - 4, 4):
        start, arcs, corners, end = numbers[at], numbers[at + OF_LINES], numbers[at + OF_ARCS], numbers[at + OF_CORNERS]
        if start == end:
            # An empty cell: all four fields hold how far it is from entries, see ``Cell``.
            moves = min(max(numbers[at + LATEST], 1), farthest)
            cells[to], cells[to + 1], cells[to + 2], cells[to + 3] = moves, moves, moves, moves
        else:
            cells[to], cells[to + 1] = start + before, arcs + before
            cells[to + 2], cells[to + 3] = corners + before, end + before
        to += step
