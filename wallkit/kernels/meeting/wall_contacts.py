"""Contacts of discs that meet with walls: found and made by the kernel that flies a ball alone, one at a time."""

from __future__ import annotations

from wallkit.kernels.flight.flight import fly
from wallkit.kernels.flight.gravity import kept_energy
from wallkit.kernels.jit import kernel, rare_kernel
from wallkit.kernels.meeting.cell_list import quit_cell
from wallkit.kernels.meeting.collapse import count_still
from wallkit.kernels.meeting.records import (
    BEING,
    BOUNCES,
    DUE,
    FIXED,
    FLYING,
    FRESH,
    LOST,
    MET,
    NEVER,
    NOBODY,
    NUMBER,
    OUT,
    RADIUS,
    ROW,
    TIME,
    VX,
    VY,
    X,
    Y,
)
from wallkit.kernels.records import (
    ABSORBED,
    AMBIGUOUS_CORNER,
    AT_REST,
    COLLAPSE,
    COUNT,
    JOINING,
    LEAVING,
    LOG,
    PASSING,
    RUNNING,
    SLIDING,
    STATE,
)

MOST = 2**62
"""Bounces that no ball reaches."""


@rare_kernel
def fly_on(model, gravity, radius, state, counts, until, hits, log):
    """Fly a ball to its next contact with a wall: see ``fly``."""
    return fly(model, gravity, radius, state, counts, until, MOST, hits, log, 1)


@kernel
def widened(time, begun):
    """A time a little later than ``time``, by more than rounding: a contact at that very time is found."""
    return time + 2.0**-40 * (time - begun) + 2.0**-50 * abs(time) + 2.0**-1000


@rare_kernel
def wall_ahead(model, gravity, discs, ball, until):
    """When a disc meets a wall, or ends by itself, up to a time; or NEVER."""
    state, counts, hits, log = discs.tries
    row = discs.ball[ball]
    cold(gravity, discs, ball)
    for k in range(len(state)):
        state[k] = discs.states[ball][k]
    for k in range(len(counts)):
        counts[k] = discs.counts[ball][k]
    if counts[COUNT.ending] != RUNNING:
        return NEVER
    noted = fly_on(model, gravity, row[RADIUS], state, counts, widened(until, row[TIME]), hits, log)
    if noted > 0:
        return log[LOG.time]
    if counts[COUNT.ending] in (COLLAPSE, AMBIGUOUS_CORNER) or (
        gravity is not None and counts[COUNT.ending] == AT_REST
    ):
        return state[STATE.time] + state[STATE.lost]
    return NEVER


@kernel
def cold(gravity, discs, ball):
    """Bring the cold state of a disc up to its last contact: after a meeting it begins anew."""
    own = discs.link[ball]
    if own[BEING] != FRESH:
        return
    row, state, counts = discs.ball[ball], discs.states[ball], discs.counts[ball]
    x, y, vx, vy = row[X], row[Y], row[VX], row[VY]
    state[STATE.x], state[STATE.y], state[STATE.vx], state[STATE.vy] = x, y, vx, vy
    state[STATE.time], state[STATE.lost] = row[TIME], row[LOST]
    state[STATE.energy] = vx * vx + vy * vy if gravity is None else kept_energy(gravity, x, y, vx, vy)
    state[STATE.from_x], state[STATE.from_y], state[STATE.from_vx], state[STATE.from_vy] = x, y, vx, vy
    for k in range(len(counts)):
        counts[k] = discs.start[k]
    counts[COUNT.bounces] = int(own[BOUNCES])
    own[BEING] = FLYING


@kernel
def give_up_if_held(discs, ball):
    """End a disc that a wall comes to hold under gravity, by an approach with no speed: others cannot meet it."""
    counts = discs.counts[ball]
    holds = counts[COUNT.hold] in (JOINING, SLIDING, LEAVING, PASSING)
    if counts[COUNT.ending] == AT_REST or (counts[COUNT.ending] == RUNNING and holds):
        counts[COUNT.ending] = COLLAPSE


@rare_kernel
def take_wall_contact(model, gravity, discs, ball, hits, log, noted):
    """Make the contact of a disc with a wall that is due, and note it: the next row of the log."""
    row, own = discs.ball[ball], discs.link[ball]
    cold(gravity, discs, ball)
    count_still(discs, ball, row[DUE] - (row[TIME] + row[LOST]))
    state, counts, tried = discs.states[ball], discs.counts[ball], discs.tries[3]
    found = fly_on(model, gravity, row[RADIUS], state, counts, widened(row[DUE], row[TIME]), hits, tried)
    row[X], row[Y], row[VX], row[VY] = state[STATE.x], state[STATE.y], state[STATE.vx], state[STATE.vy]
    row[TIME], row[LOST] = state[STATE.time], state[STATE.lost]
    own[BOUNCES], own[MET] = counts[COUNT.bounces], NOBODY
    if gravity is not None:
        give_up_if_held(discs, ball)
    ending = counts[COUNT.ending]
    if ending == ABSORBED or (gravity is not None and ending != RUNNING):
        quit_cell(discs, ball)
        own[BEING] = OUT
    elif ending in (COLLAPSE, AMBIGUOUS_CORNER):
        own[BEING], row[VX], row[VY] = FIXED, 0.0, 0.0
    if found == 0:
        return noted
    if len(log) > 0:
        o = ROW * noted
        for k in range(len(tried)):
            log[o + k] = tried[k]
        log[o + 11], log[o + 12] = float(own[NUMBER]), -1.0
        log[o + 13], log[o + 14], log[o + 15], log[o + 16] = 0.0, 0.0, 0.0, 0.0
    return noted + 1


@kernel
def states_at(model, gravity, discs, time, states, endings):
    """Write the states of all discs at a time before which nothing more is due, and how each has ended or would."""
    state, counts, hits, log = discs.tries
    for ball in range(len(discs.ball)):
        cold(gravity, discs, ball)
        for k in range(len(state)):
            state[k] = discs.states[ball][k]
        for k in range(len(counts)):
            counts[k] = discs.counts[ball][k]
        if counts[COUNT.ending] == RUNNING and time < NEVER:
            fly_on(model, gravity, discs.ball[ball][RADIUS], state, counts, time, hits, log)
        for k in range(len(state)):
            states[ball][k] = state[k]
        endings[ball] = counts[COUNT.ending]
