"""What the balls of a wave ask in a turn: pairs of a ball and a line, an arc or a corner that its cell lists."""

from __future__ import annotations

from typing import Any

import numpy as np

from wallkit.kernels.batches.wave_columns import (
    ARC_IDS,
    ARC_MOVERS,
    ARCS,
    ASKING,
    CORNER_IDS,
    CORNER_MOVERS,
    CORNERS,
    END,
    LINE_IDS,
    LINE_MOVERS,
    NEXT,
    NEXT_ARC,
    NEXT_CORNER,
    PAIRS,
    PER_TURN,
)
from wallkit.kernels.intrinsics import AT_ONCE, lowest, pair_up
from wallkit.kernels.jit import kernel, rare_kernel

SHORT, LONGEST, LONG = 8, 7, (1 << 32) - 1
"""Numbers of a cell in the short lists: how many lines it lists and, from the bit SHORT on, how many corners, or LONG
for more than LONGEST in all; then their ids."""


@kernel
def note_short_lists(cells, ids, lists):
    """Note what cells list where that is short, lines and corners: all that a wave asks of one is on one cache line.

    Args:
        cells: with the divided ones, which count as LONG, but not their parts.
        ids: see ``Model``; no arcs.
        lists: written, SHORT numbers a cell; AT_ONCE more at the end.
    """
    end_of_all = len(lists) - AT_ONCE
    for c in range(end_of_all // SHORT):
        first: Any = np.int64(cells[c].first)
        corners, end = np.int64(cells[c].corners), np.int64(cells[c].end)
        if (end < first) | (end - first > LONGEST):
            lists[SHORT * c] = LONG
        else:
            lists[SHORT * c] = (corners - first) + ((end - corners) << SHORT)
            # As many as fit, at once; what is too much is written over by the next cell.
            pair_up(ids, first, 0, lists, SHORT * c + 1, end_of_all)


@kernel
def list_short(radius, lists, cell, i, pairs, listed):
    """Pair a ball with the short list of a cell, as ``list_cell`` does."""
    lines, arcs, corners = listed
    count, first = lists[SHORT * cell], SHORT * cell + 1
    pair_up(lists, first, i, pairs, LINE_IDS + lines, LINE_MOVERS + lines)
    lines += int(count & LONGEST)
    if radius is not None:
        pair_up(lists, first + (count & LONGEST), i, pairs, CORNER_IDS + corners, CORNER_MOVERS + corners)
        corners += int(count >> SHORT)
    return lines, arcs, corners


@kernel
def list_cell(model, radius, cell, i, pairs, listed):
    """Pair a ball with all that a cell lists, PER_TURN ids at most.

    Args:
        model: the scene.
        radius: of all balls; None for points.
        cell: a ``Cell``.
        i: the ball's lane.
        pairs: written behind those that are there.
        listed: how many lines, arcs and corners are paired so far.

    Returns:
        How many are paired then.
    """
    lines, arcs, corners = listed
    # A cell's ids follow one another, lines, arcs, corners: each kind has its own list of pairs.
    mixed, ids = model.arcs is not None, model.ids
    lines += _list(ids, model.lines, mixed, cell.first, cell.arcs, i, pairs, LINE_IDS + lines, LINE_MOVERS + lines)
    arcs += _list(ids, model.arcs, False, cell.arcs, cell.corners, i, pairs, ARC_IDS + arcs, ARC_MOVERS + arcs)
    if radius is not None:
        to_ids, to_movers = CORNER_IDS + corners, CORNER_MOVERS + corners
        corners += _list(ids, model.corners, mixed, cell.corners, cell.end, i, pairs, to_ids, to_movers)
    return lines, arcs, corners


@kernel
def _list(ids, records, seldom, first, stop, i, pairs, to_ids, to_movers):
    """Pair a ball with PER_TURN ids at most: how many there are.

    PER_TURN are written each time, and those that are there count, for that is quicker than to find out first; not so
    where there is ``seldom`` one.
    """
    if records is None:
        return 0
    count: Any = np.int64(stop) - np.int64(first)  # signed, for an unsigned one goes with no signed one
    if seldom and count == 0:
        return 0
    # Eight at once, written behind those that are there; the next ball writes over what is too much.
    pair_up(ids, first, i, pairs, to_ids, to_movers)
    return count


@rare_kernel
def pair_all(model, radius, q, pairs, listed):
    """Pair balls with what their cells list and they have not asked, at most PER_TURN lines, arcs and corners each.

    Args and returns: as for ``list_cell``, for all balls that are ASKING.
    """
    lines, arcs, corners = listed
    asking, more, mixed = int(q[ASKING]), 0, model.arcs is not None
    while asking > 0:
        i = lowest(asking)
        asking &= asking - 1
        to = LINE_IDS + lines, LINE_MOVERS + lines
        taken, left = _take(model.ids, model.lines, mixed, q, NEXT + i, ARCS + i, i, pairs, to)
        lines += taken
        to = ARC_IDS + arcs, ARC_MOVERS + arcs
        taken, left_arcs = _take(model.ids, model.arcs, False, q, NEXT_ARC + i, CORNERS + i, i, pairs, to)
        arcs += taken
        left += left_arcs
        if radius is not None:
            to = CORNER_IDS + corners, CORNER_MOVERS + corners
            taken, left_corners = _take(model.ids, model.corners, mixed, q, NEXT_CORNER + i, END + i, i, pairs, to)
            corners += taken
            left += left_corners
        more |= int(left > 0) << i
    q[ASKING] = more
    return lines, arcs, corners


@kernel
def _take(ids, records, seldom, q, at, end, i, pairs, to):
    """Pair a ball with the next PER_TURN ids of a list at most: how many, and how many are left."""
    if records is None:
        return 0, 0
    first: Any = np.int64(q[at])
    left: Any = np.int64(q[end]) - first
    taken = min(left, PER_TURN)
    q[at] = first + taken
    return _list(ids, records, seldom, first, first + taken, i, pairs, to[0], to[1]), left - taken


@kernel
def fill_up(ids, pairs, listed):
    """Write as many pairs as a vector takes behind the last one of each kind: the first ball and the first id."""
    lines, arcs, corners = listed
    nothing = len(ids) - AT_ONCE
    pair_up(ids, nothing, 0, pairs, LINE_IDS + lines, LINE_MOVERS + lines)
    pair_up(ids, nothing, 0, pairs, ARC_IDS + arcs, ARC_MOVERS + arcs)
    pair_up(ids, nothing, 0, pairs, CORNER_IDS + corners, CORNER_MOVERS + corners)


@kernel
def part(left):
    """How many pairs to work on next, with those that make them up to whole vectors; the bits of those there are."""
    count = min(left, PAIRS)
    return (count + AT_ONCE - 1) // AT_ONCE * AT_ONCE, (1 << count) - 1


@kernel
def one_way(model, one_sided, pairs, first, asked):
    """Of the bits of lines or arcs, those that belong to one-sided walls."""
    if one_sided is None:
        return 0
    found, left = 0, asked
    while left > 0:
        j = lowest(left)
        left &= left - 1
        if one_sided[model.edge_wall[pairs[first + j]]] != 0:
            found |= 1 << j
    return found
