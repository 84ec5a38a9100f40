"""What is due first: a tournament of all discs.

Each node of a binary tree names the disc that comes first among those below it. A new time asks the nodes above its
disc again, up to the first one whose winner is another disc, and was: above it nothing has changed.
"""

from __future__ import annotations

from wallkit.kernels.intrinsics import prefetch_far
from wallkit.kernels.jit import kernel, rare_kernel
from wallkit.kernels.meeting.records import CELL, DISCS, DUE, NEVER, NOBODY, NUMBER, PARTNER, WALL

FAR = 1 << 14
"""Nodes of the tournament from which on the discs do not fit into the nearer caches."""


@kernel
def precedes(time, low, high, then, other_low, other_high):
    """Order of contacts: by time; at one time by the lower number of a disc, walls first, then by the higher one."""
    if time != then:
        return time < then
    return low < other_low or (low == other_low and high < other_high)


@kernel
def names(link, ball):
    """What orders the contact of a disc among those at the same time: (lower number, higher one; -1 for a wall)."""
    own, partner = int(link[ball][NUMBER]), link[ball][PARTNER]
    if partner < DISCS:
        other = int(link[partner][NUMBER])
        return min(own, other), max(own, other)
    if partner == WALL:
        return own, -1
    return -1, -1


@kernel
def is_search(partner):
    """Tell whether what is due is no contact."""
    return partner >= DISCS and partner != WALL


@rare_kernel
def _goes_first(discs, a, b):
    """Tell whether a disc comes before another one whose key is the same: searches first, so none is overlooked."""
    link = discs.link
    due_a, due_b = discs.ball[a][DUE] < discs.leave[a], discs.ball[b][DUE] < discs.leave[b]
    if not due_a or is_search(link[a][PARTNER]):
        return True
    if not due_b or is_search(link[b][PARTNER]):
        return False
    low_a, high_a = names(link, a)
    low_b, high_b = names(link, b)
    return not precedes(0.0, low_b, high_b, 0.0, low_a, high_a)


@kernel
def requeue(discs, ball):
    """Set the key of a disc to what is due, or when it leaves its cell, and play its matches again."""
    key, tree = discs.key, discs.tree
    due, leave = discs.ball[ball][DUE], discs.leave[ball]
    winner, best = int(ball), leave if leave <= due else due
    node = (len(key) >> 1) + winner
    key[node] = best
    far = len(key) > FAR
    while node > 1:
        rival, its = int(tree[node ^ 1]), key[node ^ 1]
        first = its < best  # who wins is not foreseen: it is chosen without a branch
        if its == best:
            first = loses_a_tie(discs, winner, rival, best)
        winner = rival if first else winner
        best = its if first else best
        node >>= 1
        if tree[node] == winner and winner != ball:
            break  # it was the winner, and its key is as it was: nothing changes above
        tree[node], key[node] = winner, best
        if far and node < 128:
            ask_ahead(discs, winner, node)


@kernel
def ask_ahead(discs, ball, node):
    """Prefetch what the contact of a disc will read, as it comes nearer to the first place in the tournament.

    What wins among the discs below one of 2^k nodes is due after some 2^k other events: first its own rows are asked
    for, then its partner's and the cells around it, which those name, then the discs in these.
    """
    link, head, shift = discs.link, discs.head, discs.cells.shift
    if node >= 64:
        prefetch_far(discs.ball, 8 * ball)
        prefetch_far(link, 8 * ball)
        prefetch_far(discs.leave, ball)
        prefetch_far(discs.step, ball)
        leaf = (len(discs.key) >> 1) + ball
        for _level in range(8):
            prefetch_far(discs.key, leaf)
            prefetch_far(discs.tree, leaf)
            leaf >>= 1
    elif 16 <= node < 32:
        partner, cell = int(link[ball][PARTNER]), int(link[ball][CELL])
        for line in range(-1, 2):
            prefetch_far(head, cell + (line << shift))
        prefetch_far(discs.near, cell)
        if partner < DISCS:
            prefetch_far(discs.ball, 8 * partner)
            prefetch_far(link, 8 * partner)
    elif 4 <= node < 8:
        cell = int(link[ball][CELL])
        for line in range(-1, 2):
            for c in range(cell + (line << shift) - 1, cell + (line << shift) + 2):
                if 0 <= c < len(head) and head[c] != NOBODY:
                    prefetch_far(discs.ball, 8 * int(head[c]))
                    prefetch_far(discs.after, int(head[c]))


@kernel
def loses_a_tie(discs, winner, rival, time):
    """Tell whether of two discs with the same key the other one comes first; two that meet are one event."""
    if time == NEVER or discs.link[winner][PARTNER] == rival:
        return False
    return not _goes_first(discs, winner, rival)


@kernel
def play_all(discs):
    """Play all matches, for discs whose keys are set."""
    tree, key = discs.tree, discs.key
    for node in range((len(key) >> 1) - 1, 0, -1):
        a, b = int(tree[2 * node]), int(tree[2 * node + 1])
        best, its = key[2 * node], key[2 * node + 1]
        if its < best or (its == best and loses_a_tie(discs, a, b, best)):
            a, best = b, its
        tree[node], key[node] = a, best
