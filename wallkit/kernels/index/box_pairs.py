"""Which boxes of a packed tree meet boxes in question, see ``geometry.box_tree``."""

from __future__ import annotations

from wallkit.kernels.jit import kernel

WIDTH = 16
"""Boxes of a row."""
DEEPEST = 16
"""Levels of a tree; one of so many would have 2^64 boxes."""


@kernel
def boxes_met(corners, firsts, low, high, state, waiting, meets, question, place):
    """Find boxes that meet those in question, each question going down the tree by itself.

    Args:
        corners: (rows, 4, WIDTH) lowest x and y, highest x and y of the boxes of all levels, the leaves first.
        firsts: (levels,) the first row of each level; the last has one row. Row k of a level holds the children of
            the k-th box of the level above.
        low: (2, m) lowest corners of the boxes in question.
        high: (2, m) their highest.
        state: the question to begin with, and how many pairs are written; both are written. It ends before a question
            whose pairs may not have room.
        waiting: (2, WIDTH DEEPEST) for rows that wait: their level, and their number in it.
        meets: (WIDTH,) of bool, for the work: a row is compared as a whole, by vector instructions.
        question: written, the question of each pair.
        place: written, the leaf of each pair.
    """
    asked, count = state[0], state[1]
    while asked < low.shape[1]:
        before, whole = count, True
        x0, y0, x1, y1 = low[0, asked], low[1, asked], high[0, asked], high[1, asked]
        waiting[0, 0], waiting[1, 0], height = len(firsts) - 1, 0, 1
        while height > 0:
            height -= 1
            level, row = waiting[0, height], waiting[1, height]
            own = firsts[level] + row
            if (level == 0) & (count + WIDTH > len(place)):
                whole = False
                break
            box = corners[own]
            for k in range(WIDTH):
                meets[k] = (box[0, k] <= x1) & (box[1, k] <= y1) & (box[2, k] >= x0) & (box[3, k] >= y0)
            for k in range(WIDTH):
                if meets[k]:
                    if level == 0:
                        question[count], place[count] = asked, WIDTH * row + k
                        count += 1
                    else:
                        waiting[0, height], waiting[1, height] = level - 1, WIDTH * row + k
                        height += 1
        if not whole:
            count = before
            break
        asked += 1
    state[0], state[1] = asked, count
