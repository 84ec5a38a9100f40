"""What is due first: a calendar of short stretches of time, and a heap of what is due in the present one.

Each stretch has a list of discs whose next event was put into it, or into one that comes whole laps of the calendar
later (R. Brown 1988, Commun. ACM 31:1220; G. Paul 2007, J. Comput. Phys. 221:615). A list is one cache line, and is
only written to: who is due at another time by now is found out when the stretch comes. Its discs, a few, then go into a
binary heap, which knows the order of events at the same time, and takes in what a full list does not. As what is due
soon is known ahead, its cache lines are asked for before it is taken.
"""

from __future__ import annotations

from wallkit.kernels.intrinsics import prefetch_far
from wallkit.kernels.jit import kernel, rare_kernel
from wallkit.kernels.meeting.cell_list import cell_number, row_and_column
from wallkit.kernels.meeting.records import (
    BEGIN,
    CELL,
    DISCS,
    DUE,
    FLOATS,
    LEAVE,
    LEFT,
    NEVER,
    NOBODY,
    NUMBER,
    PARTNER,
    PASSED,
    PLACE,
    PRESENT,
    RATE,
    ROOM,
    SIZE,
    UNHEAPED,
    WALL,
)

FAR = 1 << 15
"""Discs from which on they do not fit into the nearer caches."""
LATE = 2.0**62
"""Number of a stretch that is never reached."""
EACH = 3.0
"""Events in a stretch, about."""
AHEAD = 1
"""Stretches."""


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
def next_event(discs, ball):
    """When something is next to be done for a disc: a contact or a search is due, or it leaves its cell."""
    due, leave = discs.ball[ball][DUE], discs.ball[ball][LEAVE]
    return leave if leave <= due else due


@rare_kernel
def _rank(discs, ball):
    """(lower number, higher one) of the contact that is due, as ``names``: searches first, so none is overlooked."""
    if discs.ball[ball][LEAVE] <= discs.ball[ball][DUE]:
        return -1, -1
    return names(discs.link, ball)


@kernel
def _before(discs, time, ball, then, other):
    """Tell whether what is due for a disc comes before what is due for another one."""
    if time != then:
        return time < then
    low, high = _rank(discs, ball)
    other_low, other_high = _rank(discs, other)
    return precedes(time, low, high, then, other_low, other_high)


@kernel
def _settle(discs, ball, time, place):
    """Put a disc into a gap of the heap, up or down from there to where it belongs."""
    heap, times, link, size = discs.queue.heap, discs.queue.times, discs.link, discs.queue.state[SIZE]
    while place > 0:
        above = (place - 1) >> 1
        other = heap[above]
        if not _before(discs, time, ball, times[above], other):
            break
        heap[place], times[place], link[other][PLACE] = other, times[above], place
        place = above
    below = 2 * place + 1
    while below < size:
        if below + 1 < size and _before(discs, times[below + 1], heap[below + 1], times[below], heap[below]):
            below += 1
        other = heap[below]
        if not _before(discs, times[below], other, time, ball):
            break
        heap[place], times[place], link[other][PLACE] = other, times[below], place
        place, below = below, 2 * below + 1
    heap[place], times[place], link[ball][PLACE] = ball, time, place


@rare_kernel
def _settle_again(discs, place):
    """Bring the disc at a place of the heap to where it belongs."""
    _settle(discs, discs.queue.heap[place], discs.queue.times[place], place)


@kernel
def take_out(discs, ball):
    """Take a disc out of the heap, if it is there."""
    queue, own = discs.queue, discs.link[ball]
    place = own[PLACE]
    if place == UNHEAPED:
        return
    last = queue.state[SIZE] - 1
    queue.state[SIZE], own[PLACE] = last, UNHEAPED
    if place < last:
        queue.heap[place], queue.times[place] = queue.heap[last], queue.times[last]
        _settle_again(discs, place)


@kernel
def _stretch(queue, time):
    """Number of the stretch of a time; rounding is monotonic, so that a later time has no lower one."""
    return int(min((time - queue.scale[BEGIN]) * queue.scale[RATE], LATE))


@kernel
def put_in(discs, ball, time):
    """Put a disc that is not in the heap into the calendar, or into the heap; nowhere if nothing is due for it."""
    if time == NEVER:
        return
    queue = discs.queue
    number = _stretch(queue, time)
    if number > queue.state[PRESENT]:
        slot = number & (len(queue.filled) - 1)
        filled = int(queue.filled[slot])
        if filled < ROOM:
            queue.lists[ROOM * slot + filled], queue.filled[slot] = ball, filled + 1
            return
    push(discs, ball, time)


@kernel
def push(discs, ball, time):
    """Put a disc into the heap."""
    queue, size = discs.queue, discs.queue.state[SIZE]
    queue.state[SIZE] = size + 1
    queue.heap[size], queue.times[size], discs.link[ball][PLACE] = ball, time, size
    if size > 0:
        _settle_again(discs, discs.link[ball][PLACE])


@kernel
def requeue(discs, ball):
    """Note when something is next to be done for a disc."""
    take_out(discs, ball)
    put_in(discs, ball, next_event(discs, ball))


@kernel
def retie(discs, ball):
    """Note that a search, instead of a contact, is due for a disc at the same time."""
    if discs.link[ball][PLACE] != UNHEAPED:
        _settle_again(discs, discs.link[ball][PLACE])


@kernel
def first_due(discs):
    """Give the disc for which something is to be done first: the time is ``discs.queue.times[0]``; or NOBODY."""
    queue, state = discs.queue, discs.queue.state
    state[LEFT] -= 1
    if state[LEFT] < 0 and not plan(discs):
        return NOBODY
    # In the heap may be what a full list did not take in, and lists may have something sooner.
    while state[SIZE] == 0 or _stretch(queue, queue.times[0]) > state[PRESENT]:
        if not _go_on(discs):
            return NOBODY
    return int(queue.heap[0])


@kernel
def _go_on(discs):
    """Go on to the next stretch; tell whether anything is due at all."""
    queue, link = discs.queue, discs.link
    state, lists, most = queue.state, queue.lists, len(queue.filled)
    state[PASSED] += 1
    if state[PASSED] > most + 4 * (8 * len(lists) - state[LEFT]):  # stretches are too short for what happens now
        return plan(discs)
    present = state[PRESENT] + 1
    state[PRESENT] = present
    slot, kept = present & (most - 1), 0
    for k in range(queue.filled[slot]):
        ball = lists[ROOM * slot + k]
        if link[ball][PLACE] == UNHEAPED:
            time = next_event(discs, ball)
            if time < NEVER:
                number = _stretch(queue, time)
                if number <= present:
                    push(discs, ball, time)
                elif (number - present) & (most - 1) == 0:
                    lists[ROOM * slot + kept] = ball
                    kept += 1
    queue.filled[slot] = kept
    if len(link) > FAR:
        _ask_ahead(discs, present)
    return True


@rare_kernel
def plan(discs):
    """Choose the length of a stretch anew, and list all discs; tell whether anything is due at all.

    Half of those for which something is due have it within a time T: some 2 T / n lie between two of them.
    """
    queue, link, count = discs.queue, discs.link, len(discs.ball)
    begin, end, finite = NEVER, 0.0, 0
    for ball in range(count):
        time = next_event(discs, ball)
        link[ball][PLACE] = UNHEAPED
        if time < NEVER:
            begin, end, finite = min(begin, time), max(end, time), finite + 1
    for slot in range(len(queue.filled)):
        queue.filled[slot] = 0
    queue.state[SIZE], queue.state[PRESENT], queue.state[PASSED], queue.state[LEFT] = 0, 0, 0, 0
    if finite == 0:
        return False
    queue.scale[BEGIN], queue.scale[RATE] = begin, 0.0
    queue.state[LEFT] = finite
    span = _half_within(discs, begin, end - begin, finite)
    if span > 0.0:  # all that is due is not due at once
        queue.state[LEFT] = 8 * len(queue.lists)
        queue.scale[RATE] = min(finite / (2.0 * EACH * span), 2.0**50 / (abs(begin) + span))
    for ball in range(count):
        put_in(discs, ball, next_event(discs, ball))
    return True


@kernel
def _half_within(discs, begin, span, finite):
    """Halve a time as long as something is due within it for half of all discs for which it is at all."""
    for _halving in range(64):
        within = 0
        for ball in range(len(discs.ball)):
            if next_event(discs, ball) - begin <= 0.5 * span:
                within += 1
        if 2 * within < finite:
            return span
        span *= 0.5
    return span


@kernel
def _ask_ahead(discs, present):
    """Prefetch what will be read in some of the stretches that come.

    First the own rows of a disc, then its partner's and the cells around it, which those name, then the discs in these.
    """
    lists, filled = discs.queue.lists, discs.queue.filled
    link, head, cells, mask = discs.link, discs.head, discs.cells, len(filled) - 1
    slot = (present + 3 * AHEAD) & mask
    for k in range(ROOM * slot, ROOM * slot + int(filled[slot])):
        _ask_for(discs, int(lists[k]))
    slot = (present + 2 * AHEAD) & mask
    for k in range(ROOM * slot, ROOM * slot + int(filled[slot])):
        partner, cell = int(link[lists[k]][PARTNER]), int(link[lists[k]][CELL])
        up, along = row_and_column(cells, cell)
        for corner in range(4):
            prefetch_far(head, cell_number(cells, up - 1 + (corner & 2), along - 1 + 2 * (corner & 1)))
        prefetch_far(discs.near, cell)
        if partner < DISCS:
            _ask_for(discs, partner)
    slot = (present + AHEAD) & mask
    for k in range(ROOM * slot, ROOM * slot + int(filled[slot])):
        up, along = row_and_column(cells, int(link[lists[k]][CELL]))
        for line in range(max(up - 1, 0), min(up + 2, cells.rows)):
            for column in range(max(along - 1, 0), min(along + 2, cells.columns)):
                other = head[cell_number(cells, line, column)]
                if other != NOBODY:
                    _ask_for(discs, int(other))


@kernel
def _ask_for(discs, ball):
    """Prefetch both lines of a disc."""
    prefetch_far(discs.ball, FLOATS * ball)
    prefetch_far(discs.ball, FLOATS * ball + LEAVE)
