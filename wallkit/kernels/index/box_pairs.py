"""Which boxes of a packed tree meet boxes in question, see ``geometry.box_tree``."""

from __future__ import annotations

from wallkit.kernels.intrinsics import lowest
from wallkit.kernels.jit import kernel
from wallkit.kernels.ordering import put_in_order

WIDTH = 16
"""Boxes of a row."""
DEEPEST = 16
"""Levels of a tree; one of so many would have 2^64 boxes."""


MOST_SORTED = 64
"""Boxes of one question that are put in order one by one."""


@kernel
def boxes_met(corners, firsts, order, low, high, state, waiting, question, box):
    """Find boxes that meet those in question, each question going down the tree by itself.

    Args:
        corners: (rows, 4, WIDTH) lowest x and y, highest x and y of the boxes of all levels, the leaves first.
        firsts: (levels,) the first row of each level; the last has one row. Row k of a level holds the children of
            the k-th box of the level above.
        order: the number of the box of each leaf.
        low: (2, m) lowest corners of the boxes in question.
        high: (2, m) their highest.
        state: the question to begin with, how many pairs are written, and how many questions have more boxes than are
            put in order; all are written. It ends before a question whose pairs may not have room.
        waiting: (2, WIDTH DEEPEST) for rows that wait: their level, and their number in it.
        question: written, the question of each pair, rising.
        box: written, the box of each pair, rising for each question but for those.
    """
    asked, count, unsorted = state[0], state[1], state[2]
    while asked < low.shape[1]:
        before, whole = count, True
        x0, y0, x1, y1 = low[0, asked], low[1, asked], high[0, asked], high[1, asked]
        waiting[0, 0], waiting[1, 0], height = len(firsts) - 1, 0, 1
        while height > 0:
            height -= 1
            level, row = waiting[0, height], waiting[1, height]
            own = firsts[level] + row
            if (level == 0) & (count + WIDTH > len(box)):
                whole = False
                break
            at = corners[own]
            met = 0  # a bit each, by vector instructions
            for k in range(WIDTH):
                meets = (at[0, k] <= x1) & (at[1, k] <= y1) & (at[2, k] >= x0) & (at[3, k] >= y0)
                met |= int(meets) << k
            while met != 0:
                child = WIDTH * row + lowest(met)
                met &= met - 1
                if level == 0:
                    question[count], box[count] = asked, order[child]
                    count += 1
                else:
                    waiting[0, height], waiting[1, height] = level - 1, child
                    height += 1
        if not whole:
            count = before
            break
        if count - before > MOST_SORTED:
            unsorted += 1
        else:
            put_in_order(box, before, count)
        asked += 1
    state[0], state[1], state[2] = asked, count, unsorted
