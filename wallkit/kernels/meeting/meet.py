"""The loop of discs that meet: take what is due first, turn the velocities, look for what is due next; again.

Each disc has one contact that is due: with another disc, or with a wall (Lubachevsky 1991, J. Comput. Phys. 94:255).
When two discs promise themselves to one another, the partners that they had look again at the time at which they would
have met: until then nothing can have happened to them. A disc goes from cell to cell, and looks at the discs of the
cells that come into its reach then; walls are asked only in cells from which a disc may touch one, by the kernel that
flies a ball alone.
"""

from __future__ import annotations

import math

from wallkit.kernels.flight.gravity import move
from wallkit.kernels.jit import kernel
from wallkit.kernels.meeting.cell_list import (
    DOWNWARDS,
    LEFT,
    RIGHT,
    STAYS,
    UPWARDS,
    cell_at,
    cell_number,
    enter,
    next_border,
    quit_cell,
    row_and_column,
)
from wallkit.kernels.meeting.collapse import is_caught
from wallkit.kernels.meeting.event_queue import first_due, names, plan, precedes, requeue, retie, take_out
from wallkit.kernels.meeting.pair_impact import collide, meet_at, meeting_time
from wallkit.kernels.meeting.records import (
    AFTER,
    BEING,
    BOUNCES,
    CELL,
    DISCS,
    DUE,
    FIXED,
    FRESH,
    LEAVE,
    LOOK,
    LOST,
    MASS,
    MET,
    NEVER,
    NOBODY,
    NOTHING,
    NUMBER,
    OUT,
    PARTNER,
    RADIUS,
    ROW,
    STEP,
    TIME,
    VX,
    VY,
    WALL,
    X,
    Y,
)
from wallkit.kernels.meeting.wall_contacts import take_wall_contact, wall_ahead
from wallkit.kernels.records import BALL, NO_HIT


@kernel
def meet(model, gravity, discs, until, limit, hits, log, capacity, budget):
    """Let discs fly and meet until a time, until one of them has made ``limit`` contacts, or the log is full.

    Args:
        model: the scene, see ``Model``.
        gravity: ``model.gravity``, given by itself so that what it is not needed for is dropped.
        discs: see ``Discs``; ready as ``begin`` leaves them, and read and written, so that it can go on later.
        until: time at which to stop.
        limit: contacts of a disc at which to stop.
        hits: contacts by wall, added to.
        log: flat floats, ``ROW`` a contact; empty to keep none.
        capacity: contacts to be made at most.
        budget: events to be taken at most.

    Returns:
        (contacts made, time of the last event, whether the end is reached: 1 the time, 2 the limit; else 0).
    """
    noted, events, now = 0, 0, 0.0
    while noted < capacity and events < budget:
        ball = first_due(discs)
        if ball == NOBODY or discs.queue.times[0] > until:
            return noted, now, 1
        now = discs.queue.times[0]
        take_out(discs, ball)
        events += 1
        row, own = discs.ball[ball], discs.link[ball]
        other, step = NOBODY, STAYS
        if row[LEAVE] <= row[DUE]:
            step = change_cell(discs, ball)
        elif own[PARTNER] == WALL:
            noted = take_wall_contact(model, gravity, discs, ball, hits, log, noted)
        elif own[PARTNER] < DISCS:
            other = int(own[PARTNER])
            noted = take_meeting(gravity, discs, ball, other, log, noted)
        if step == STAYS:
            row[DUE], own[PARTNER] = NEVER, NOTHING
        if other != NOBODY:
            discs.ball[other][DUE], discs.ball[other][LEAVE] = NEVER, NEVER
            discs.link[other][PARTNER] = NOTHING
            take_out(discs, other)
        for turn in range(2):
            looking = ball if turn == 0 else other
            if looking != NOBODY:
                look(model, gravity, discs, looking, now, step)
        if own[BOUNCES] >= limit or (other != NOBODY and discs.link[other][BOUNCES] >= limit):
            return noted, now, 2
    return noted, now, 0


@kernel
def begin(gravity, discs, now):
    """Put all discs into cells, and let each look at the time ``now``, one after the other."""
    for ball in range(len(discs.ball)):
        row, own = discs.ball[ball], discs.link[ball]
        x, y, _vx, _vy = move(gravity, row[X], row[Y], row[VX], row[VY], now - (row[TIME] + row[LOST]))
        own[CELL] = cell_at(discs.cells, x, y)
        row[DUE], own[PARTNER] = NEVER if own[BEING] == OUT else now, LOOK
        row[LEAVE] = NEVER
    lay_out(discs)


@kernel
def lay_out(discs):
    """List all discs in the cells in which they are, and in the queue."""
    head = discs.head
    for cell in range(len(head)):
        head[cell] = NOBODY
    for ball in range(len(discs.ball)):
        if discs.link[ball][BEING] != OUT:
            enter(discs, ball, discs.link[ball][CELL])
    plan(discs)


@kernel
def change_cell(discs, ball):
    """Take a disc to the next cell: to which side."""
    step = int(discs.link[ball][STEP])
    up, along = row_and_column(discs.cells, int(discs.link[ball][CELL]))
    along += (1 if step == RIGHT else 0) - (1 if step == LEFT else 0)
    up += (1 if step == UPWARDS else 0) - (1 if step == DOWNWARDS else 0)
    quit_cell(discs, ball)
    enter(discs, ball, cell_number(discs.cells, up, along))
    return step


@kernel
def look(model, gravity, discs, ball, now, step):
    """Find what is due next for a disc, among all that are near, or, after a step to another cell, those new there."""
    row, own = discs.ball[ball], discs.link[ball]
    if own[BEING] == OUT:
        row[LEAVE] = NEVER
        requeue(discs, ball)
        return
    cell = int(own[CELL])
    up, along = row_and_column(discs.cells, cell)
    due, partner = among_discs(gravity, discs, ball, up, along, step)
    leave, own[STEP] = next_border(gravity, discs.cells, row, up, along, now)
    if discs.near[cell] != 0:
        t = wall_ahead(model, gravity, discs, ball, min(due, leave))
        if t < NEVER and (t < due or (t == due and partner != WALL)):
            due, partner = t, WALL
    row[LEAVE] = leave
    promise(discs, ball, due, partner)
    requeue(discs, ball)


@kernel
def among_discs(gravity, discs, ball, up, along, step):
    """Find the disc with which a contact is due first: (when, which), or what was due before where that is sooner."""
    row, link, head = discs.ball[ball], discs.link, discs.head
    due, partner, met = row[DUE], int(link[ball][PARTNER]), link[ball][MET]
    low, high, left, right = up - 1, up + 2, along - 1, along + 2
    if step == RIGHT:
        left = along + 1
    elif step == LEFT:
        right = along
    elif step == UPWARDS:
        low = up + 1
    elif step == DOWNWARDS:
        high = up
    left, right = max(left, 0), min(right, discs.cells.columns)
    for line in range(max(low, 0), min(high, discs.cells.rows)):
        for column in range(left, right):
            other = head[cell_number(discs.cells, line, column)]
            while other != NOBODY:
                if other != ball and not (other == met and link[other][MET] == ball):
                    t, _span = meeting_time(gravity, row, discs.ball[other])
                    if t < NEVER and t <= due and t <= discs.ball[other][DUE]:
                        if (t < due and t < discs.ball[other][DUE]) or goes_before(discs, ball, other, t, due, partner):
                            due, partner = t, int(other)
                other = link[other][AFTER]
    return due, partner


@kernel
def goes_before(discs, ball, other, t, due, partner):
    """Tell whether a contact of two discs goes before what is due for them, where that is at the same time."""
    link = discs.link
    one, two = int(link[ball][NUMBER]), int(link[other][NUMBER])
    low, high = min(one, two), max(one, two)
    own_low, own_high = low, high + 1
    if due == t:
        own_low, own_high = -1, -1
        if partner == WALL:
            own_low, own_high = one, -1
        elif partner < DISCS:
            third = int(link[partner][NUMBER])
            own_low, own_high = min(one, third), max(one, third)
    its_low, its_high = low, high + 1
    if discs.ball[other][DUE] == t:
        its_low, its_high = names(link, other)
    return precedes(t, low, high, t, own_low, own_high) and precedes(t, low, high, t, its_low, its_high)


@kernel
def promise(discs, ball, due, partner):
    """Note what is due for a disc; the partners that it leaves, or takes another from, look again at their time."""
    link, before = discs.link, discs.link[ball][PARTNER]
    discs.ball[ball][DUE] = due
    if before == partner:
        return
    link[ball][PARTNER] = partner
    if before < DISCS:
        link[before][PARTNER] = LOOK
        retie(discs, before)
    if partner < DISCS:
        third = link[partner][PARTNER]
        link[partner][PARTNER], discs.ball[partner][DUE] = ball, due
        requeue(discs, partner)
        if third < DISCS:
            link[third][PARTNER] = LOOK
            retie(discs, third)


@kernel
def take_meeting(gravity, discs, ball, other, log, noted):
    """Let two discs meet: note it, the one with the lower number first; the next row of the log."""
    one, two = (ball, other) if discs.link[ball][NUMBER] < discs.link[other][NUMBER] else (other, ball)
    row, its = discs.ball[one], discs.ball[two]
    own, link = discs.link[one], discs.link[two]
    caught = is_caught(gravity, discs, discs.restitution, one, two)
    meet_at(gravity, row, its)
    part, its_part = shares(discs, one, two)
    if caught:
        collide(None, gravity, discs.hop, row, its, part, its_part)
    else:
        collide(discs.restitution, gravity, discs.hop, row, its, part, its_part)
    own[BOUNCES] += 1
    link[BOUNCES] += 1
    own[MET], link[MET] = two, one
    if own[BEING] != FIXED:
        own[BEING] = FRESH
    if link[BEING] != FIXED:
        link[BEING] = FRESH
    if len(log) > 0:
        note_meeting(log, noted, row, its, own, link)
    return noted + 1


@kernel
def shares(discs, one, two):
    """Part of the change of their relative velocity that each of two discs takes: the other's part of their mass."""
    if discs.link[one][BEING] == FIXED:
        return 0.0, 1.0
    if discs.link[two][BEING] == FIXED:
        return 1.0, 0.0
    mass, its_mass = discs.ball[one][MASS], discs.ball[two][MASS]
    whole = mass + its_mass
    return its_mass / whole, mass / whole


@kernel
def note_meeting(log, noted, row, its, own, link):
    """Write a contact of two discs to the log; the normal points to the one with the lower number."""
    dx, dy = row[X] - its[X], row[Y] - its[Y]
    length = math.sqrt(dx * dx + dy * dy)
    nx, ny = dx / length, dy / length
    o = ROW * noted
    log[o], log[o + 1], log[o + 2], log[o + 3], log[o + 4] = row[TIME] + row[LOST], row[X], row[Y], row[VX], row[VY]
    log[o + 5], log[o + 6], log[o + 7], log[o + 8] = row[X] - row[RADIUS] * nx, row[Y] - row[RADIUS] * ny, nx, ny
    log[o + 9], log[o + 10], log[o + 11], log[o + 12] = float(NO_HIT), float(BALL), own[NUMBER], link[NUMBER]
    log[o + 13], log[o + 14], log[o + 15], log[o + 16] = its[X], its[Y], its[VX], its[VY]
