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
from wallkit.kernels.jit import kernel


@kernel
def pair_all(model, radius, q, pairs):
    """Pair balls with what their cells list and they have not asked, at most PER_TURN lines, arcs and corners each.

    Returns:
        How many lines, arcs and corners are paired.
    """
    lines, arcs, corners = 0, 0, 0
    asking, more, mixed = int(q[ASKING]), 0, model.arcs is not None
    while asking > 0:
        i = lowest(asking)
        asking &= asking - 1
        # A cell's ids follow one another, lines, arcs, corners: each kind has its own list of pairs.
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
    _fill_up(model.ids, pairs, LINE_IDS, LINE_MOVERS, lines)
    _fill_up(model.ids, pairs, ARC_IDS, ARC_MOVERS, arcs)
    _fill_up(model.ids, pairs, CORNER_IDS, CORNER_MOVERS, corners)
    return lines, arcs, corners


@kernel
def _take(ids, records, seldom, q, at, end, i, pairs, to):
    """Pair a ball with the next ids of a list: how many, and how many are left.

    PER_TURN are written each time, and those that are there count, for that is quicker than to find out first; not so
    where there is ``seldom`` one.
    """
    if records is None:
        return 0, 0
    first: Any = np.int64(q[at])  # signed, for what two unsigned ones differ by goes with no signed one
    left: Any = np.int64(q[end]) - first
    if seldom and left == 0:
        return 0, 0
    # Eight at once, written behind those that are there; the next ball writes over what is too much.
    pair_up(ids, first, i, pairs, to[0], to[1])
    taken = min(left, PER_TURN)
    q[at] = first + taken
    return taken, left - taken


@kernel
def _fill_up(ids, pairs, to_ids, to_movers, count):
    """Write as many pairs as a vector takes behind the last one: the first ball and the first of its kind."""
    pair_up(ids, len(ids) - AT_ONCE, 0, pairs, to_ids + count, to_movers + count)


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
