"""Contacts of discs that meet with walls: found and made by the kernel that flies a ball alone, one at a time.

Under gravity a disc that a wall would come to hold, or that loses its speed on it, hops: it leaves the wall at no less
than the speed ``hop``. So does one disc another. Then all discs fall, and see one another move in straight lines, in a
pile too, and the number of contacts in a given time has an end (compare the least time of a contact of S. Luding and
S. McNamara 1998, Granular Matter 1:113).
"""

from __future__ import annotations

from wallkit.kernels.flight.flight import fly, wall_of
from wallkit.kernels.flight.gravity import kept_energy
from wallkit.kernels.jit import kernel, rare_kernel
from wallkit.kernels.meeting.cell_list import quit_cell
from wallkit.kernels.meeting.collapse import count_still
from wallkit.kernels.meeting.records import (
    BEING,
    BOUNCES,
    DUE,
    ENERGY,
    FIXED,
    FLYING,
    FRESH,
    FROM_VX,
    FROM_VY,
    FROM_X,
    FROM_Y,
    LOST,
    MET,
    NEVER,
    NOBODY,
    NUMBER,
    OUT,
    RADIUS,
    ROW,
    TIME,
    TOLERANCE,
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
    recall(gravity, discs, ball)
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
def recall(gravity, discs, ball):
    """Write what ``fly`` knows of a disc into ``discs.tries``; after a meeting it begins anew."""
    state, counts, row, own = discs.tries[0], discs.tries[1], discs.ball[ball], discs.link[ball]
    x, y, vx, vy, cold = row[X], row[Y], row[VX], row[VY], discs.cold[ball]
    if own[BEING] == FRESH:
        cold[ENERGY] = vx * vx + vy * vy if gravity is None else kept_energy(gravity, x, y, vx, vy)
        cold[FROM_X], cold[FROM_Y], cold[FROM_VX], cold[FROM_VY] = x, y, vx, vy
        for k in range(len(counts)):
            discs.counts[ball][k] = discs.start[k]
        own[BEING] = FLYING
    state[STATE.x], state[STATE.y], state[STATE.vx], state[STATE.vy] = x, y, vx, vy
    state[STATE.time], state[STATE.lost], state[STATE.energy] = row[TIME], row[LOST], cold[ENERGY]
    state[STATE.from_x], state[STATE.from_y] = cold[FROM_X], cold[FROM_Y]
    state[STATE.from_vx], state[STATE.from_vy], state[STATE.tolerance] = cold[FROM_VX], cold[FROM_VY], cold[TOLERANCE]
    for k in range(len(counts)):
        counts[k] = discs.counts[ball][k]
    counts[COUNT.bounces] = int(own[BOUNCES])


@kernel
def remember(discs, ball):
    """Note what ``fly`` has made of a disc in ``discs.tries``."""
    state, counts, row, cold = discs.tries[0], discs.tries[1], discs.ball[ball], discs.cold[ball]
    row[X], row[Y], row[VX], row[VY] = state[STATE.x], state[STATE.y], state[STATE.vx], state[STATE.vy]
    row[TIME], row[LOST], cold[ENERGY] = state[STATE.time], state[STATE.lost], state[STATE.energy]
    cold[FROM_X], cold[FROM_Y] = state[STATE.from_x], state[STATE.from_y]
    cold[FROM_VX], cold[FROM_VY] = state[STATE.from_vx], state[STATE.from_vy]
    discs.link[ball][BOUNCES] = counts[COUNT.bounces]
    counts[COUNT.bounces] = 0  # as many as there are need not fit
    for k in range(len(counts)):
        discs.counts[ball][k] = counts[k]


@kernel
def hop_off(model, discs, ball):
    """Let a disc hop off the wall that it has just met, where that would hold it, or takes its speed; tell whether."""
    state, counts, _hits, log = discs.tries
    ending, hold = counts[COUNT.ending], counts[COUNT.hold]
    if ending not in (RUNNING, AT_REST):
        return False
    held = ending == AT_REST or hold in (JOINING, SLIDING, LEAVING, PASSING)
    nx, ny = log[LOG.nx], log[LOG.ny]
    lacks = discs.hop - (state[STATE.vx] * nx + state[STATE.vy] * ny)
    if lacks <= 0.0 or not (held or takes_speed(model, model.restitution, int(log[LOG.feature]))):
        return False
    state[STATE.vx] += lacks * nx
    state[STATE.vy] += lacks * ny
    log[LOG.vx], log[LOG.vy] = state[STATE.vx], state[STATE.vy]
    return True


@kernel
def takes_speed(model, restitution, feature):
    """Tell whether a wall gives back less than the whole speed towards it."""
    if restitution is None:
        return False
    return restitution[2 * wall_of(model, feature)] < 1.0


@rare_kernel
def take_wall_contact(model, gravity, discs, ball, hits, log, noted):
    """Make the contact of a disc with a wall that is due, and note it: the next row of the log."""
    row, own = discs.ball[ball], discs.link[ball]
    recall(gravity, discs, ball)
    count_still(discs, ball, row[DUE] - (row[TIME] + row[LOST]))
    state, counts, _hits, tried = discs.tries
    found = fly_on(model, gravity, row[RADIUS], state, counts, widened(row[DUE], row[TIME]), hits, tried)
    own[MET] = NOBODY
    hops = False
    if gravity is not None and found > 0:
        hops = hop_off(model, discs, ball)
    remember(discs, ball)
    ending = counts[COUNT.ending]
    if hops:
        own[BEING] = FRESH
    elif ending == ABSORBED or (gravity is not None and ending != RUNNING):
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
        recall(gravity, discs, ball)
        if counts[COUNT.ending] == RUNNING and time < NEVER:
            fly_on(model, gravity, discs.ball[ball][RADIUS], state, counts, time, hits, log)
        for k in range(len(state)):
            states[ball][k] = state[k]
        endings[ball] = counts[COUNT.ending]
