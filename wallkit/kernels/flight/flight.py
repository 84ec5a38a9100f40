"""The loop: search the first contact, move there, turn the velocity, note it; until something ends the flight."""

from __future__ import annotations

import math

from wallkit.kernels.flight.damping import free_time, last_flight, slowed
from wallkit.kernels.flight.gravity import bounce, facing, first_contact, kept_energy, lifted, move
from wallkit.kernels.flight.guide import guide
from wallkit.kernels.flight.motion import advance
from wallkit.kernels.flight.point_in_corner import normal_at, settle
from wallkit.kernels.flight.resting import held_after, keep, stopped_between
from wallkit.kernels.jit import kernel
from wallkit.kernels.records import (
    ABSORBED,
    AMBIGUOUS,
    AMBIGUOUS_CORNER,
    AT_REST,
    BOUNCE_LIMIT,
    COLLAPSE,
    COLLAPSES,
    EDGE,
    JOINING,
    LEAVING,
    LEFT_SCENE,
    NO_HIT,
    NO_ROW,
    PASSING,
    RUNNING,
    SLIDING,
    STARTING,
    TIME_REACHED,
    VERTEX,
    WEDGED,
)

TOLERANCE = 2.0**-47
"""Positions are off by less than this part of the extent: p + t v by some 8 roundings (2^-53), (p - a).n by as many;
64 of them are on the safe side and still far below what a drawing can mean."""
FALLING_TOLERANCE = 2.0**-41
"""The same under gravity: |v| t and g t^2 / 2 come to eight times the extent each before they cancel (up and down
again in a room), and times are roots of polynomials: eight times eight as much."""
HELD = (JOINING, PASSING, SLIDING, LEAVING, STARTING)
"""How a ball is held that a wall, not a flight, moves on: see ``hold.keep``."""


@kernel
def fly(model, gravity, radius, state, counts, until, limit, hits, log, capacity):
    """Fly one ball until its time, its bounce limit, an ending, or a full log.

    Args:
        model: the scene, see ``Model``.
        gravity: ``model.gravity``, given by itself so that what it is not needed for is dropped.
        radius: of the ball; 0 for a point.
        state: floats of the ball (``STATE_SIZE``), read and written, so that a flight can go on later.
        counts: integers of the ball, see ``Counts``.
        until: time at which to stop, or inf.
        limit: number of bounces at which to stop.
        hits: counts of bounces, see ``Model.edge_tally``, added to.
        log: flat floats, ``LOG_STRIDE`` a contact; empty to keep no contacts.
        capacity: contacts that fit in ``log``.

    Returns:
        Number of contacts in the log. The flight goes on from here if ``counts`` says RUNNING.
    """
    x, y, vx, vy, time, lost, energy = state[0], state[1], state[2], state[3], state[4], state[5], state[6]
    from_x, from_y, from_vx, from_vy = state[7], state[8], state[9], state[10]
    tolerance = state[11]
    last, bounces, still, held, hold, side = counts[0], counts[1], counts[3], counts[4], counts[5], float(counts[6])
    turns, changes, before = counts[7], counts[8], counts[9]
    ending = RUNNING
    noted = 0
    while ending == RUNNING and noted < capacity:
        ending = ending_at_once(gravity, energy, bounces, limit)
        if ending != RUNNING:
            break
        remaining = (until - time) - lost
        if gravity is not None and hold in HELD:
            keeps = hold in (SLIDING, LEAVING)
            x, y, vx, vy, t, energy, last, held, hold, side, turns, changes, kind, feature, ending = keep(
                model, gravity, radius, x, y, vx, vy, energy, last, held, hold, side, turns, changes,
                (from_x, from_y, from_vx, from_vy), tolerance, remaining,
            )  # fmt: skip
            time, lost = (until, 0.0) if ending == TIME_REACHED else advance(time, lost, t)
            if kind != NO_ROW:
                nx, ny = normal_from(model, gravity, radius, held, side, x, y)
                noted = note(log, noted, time + lost, x, y, vx, vy, nx, ny, radius, held, kind)
            if keeps:
                from_x, from_y = x, y  # it came back along the wall, on its side of that
                from_vx, from_vy = lifted(model, gravity, radius, held, hold, side, x, y, -vx, -vy)
            if feature == NO_HIT:
                continue
            passed = t
        else:
            best = free_time(model.damping, energy, remaining)  # in which t is: as if nothing slowed the ball down
            t, feature, touched = first_contact(
                model, gravity, radius, x, y, vx, vy, energy, last, held, hold, side, tolerance, best
            )
            if touched > 0 and last >= 0:
                met = settle(model, last, x, y, vx, vy, from_x, from_y, from_vx, from_vy, tolerance, still)
                if met != NO_HIT:
                    t, feature = 0.0, met
            if feature in (NO_HIT, AMBIGUOUS) or (feature == COLLAPSES and (gravity is None or before == NO_HIT)):
                ending = ending_without(model.damping, feature, until)
                break
            passed, kept = slowed(model.damping, energy, t, remaining)
            if gravity is None:  # a collapse is where the last bounce was
                still = 0 if passes(time, passed, t, vx, vy, tolerance) else still + 1
                if still > still_limit(model.restitution):
                    ending = COLLAPSE
                    break
            if t > 0.0:
                from_x, from_y = x, y
                from_vx, from_vy = lifted(model, gravity, radius, held, hold, side, x, y, vx, vy)
                x, y, vx, vy = move(gravity, x, y, vx, vy, t)
                vx, vy, energy = kept * vx, kept * vy, kept * kept * energy
                time, lost = advance(time, lost, passed)
        if gravity is not None:
            still = 0 if passes(time, passed, t, vx, vy, tolerance) else still + 1
            if feature == COLLAPSES:
                still += still_limit(model.restitution)
            if still > still_limit(model.restitution):
                ending = COLLAPSE
                if model.restitution is not None:
                    vx, vy, still = 0.0, 0.0, 0
                    held, hold, side, ending = stopped_between(
                        model, gravity, radius, last, side, before, x, y, (from_x, from_y, from_vx, from_vy), tolerance
                    )
                    energy = kept_energy(gravity, x, y, 0.0, 0.0)
                continue
        nx, ny, twice, wall = normal_of(model, feature, x, y)
        nx, ny = facing(model, gravity, radius, feature, x, y, vx, vy, nx, ny)
        vx, vy, energy = bounce(model, gravity, wall, nx, ny, twice, x, y, vx, vy, energy)
        before, last = (before if feature == last else last), feature
        bounces += 1
        turns, changes = 0, 0
        hits[tally_of(model, feature)] += 1
        noted = note(log, noted, time + lost, x, y, vx, vy, nx, ny, radius, feature, EDGE if feature >= 0 else VERTEX)
        if absorbs(model.restitution, wall):
            ending = ABSORBED
        if gravity is not None:
            held, hold, side = held_after(
                model, gravity, radius, feature, held, hold, side, x, y, vx, vy, nx, ny, tolerance
            )
            if hold == WEDGED:
                ending, vx, vy = AT_REST, 0.0, 0.0
    if ending == TIME_REACHED and (until - time) - lost > 0.0:
        from_x, from_y, from_vx, from_vy = x, y, vx, vy
        t, kept, time, lost = last_flight(model.damping, energy, time, lost, until)
        x, y, vx, vy = move(gravity, x, y, vx, vy, t)
        vx, vy, energy = kept * vx, kept * vy, kept * kept * energy
        if kept == 0.0:
            ending, vx, vy = AT_REST, 0.0, 0.0
    state[0], state[1], state[2], state[3], state[4], state[5], state[6] = x, y, vx, vy, time, lost, energy
    state[7], state[8], state[9], state[10] = from_x, from_y, from_vx, from_vy
    counts[0], counts[1], counts[2], counts[3], counts[4], counts[5] = last, bounces, ending, still, held, hold
    counts[6], counts[7], counts[8], counts[9] = int(side), turns, changes, before
    return noted


@kernel
def normal_from(model, gravity, radius, held, side, x, y):
    """Unit normal, towards the ball, of what holds it."""
    _rho, _away, nx, ny = guide(model, model.arcs, held, side, radius, x, y)
    return nx, ny


@kernel
def ending_at_once(gravity, energy, bounces, limit):
    """What ends the run of a ball that is about to fly: an ending, or RUNNING."""
    if gravity is None:
        if energy <= 0.0:
            return AT_REST
    return BOUNCE_LIMIT if bounces >= limit else RUNNING


@kernel
def ending_without(damping, feature, until):
    """What ends the run of a ball for which no contact was found that it gets out of."""
    if feature == AMBIGUOUS:
        return AMBIGUOUS_CORNER
    if feature == COLLAPSES:
        return COLLAPSE
    if damping is None:
        if until == math.inf:
            return LEFT_SCENE
    return TIME_REACHED


@kernel
def passes(time, passed, t, vx, vy, tolerance):
    """Tell whether a flight passes time and space by more than their rounding; t is its free time."""
    return time + passed > time and t * (abs(vx) + abs(vy)) > tolerance * 2.0**-6


@kernel
def normal_of(model, feature, x, y):
    """Normal at a contact, any length and way, 2 / (n.n), and the wall."""
    if feature >= 0:
        nx, ny, twice = normal_at(model, model.arcs, feature, x, y)
        return nx, ny, twice, wall_of(model, feature)
    corner = model.corners[-2 - feature]
    nx, ny = x - corner.x, y - corner.y
    return nx, ny, 2.0 / (nx * nx + ny * ny), wall_of(model, feature)


@kernel
def wall_of(model, feature):
    """Wall of an edge or a corner."""
    return model.edge_wall[feature] if feature >= 0 else model.corner_wall[-2 - feature]


@kernel
def tally_of(model, feature):
    """Which count of bounces one off an edge or a corner is added to."""
    return model.edge_tally[feature] if feature >= 0 else model.corner_tally[-2 - feature]


@kernel
def absorbs(restitution, wall):
    """Tell whether a wall leaves a ball no speed at all."""
    if restitution is None:
        return False
    return restitution[2 * wall] == 0.0 and restitution[2 * wall + 1] == 0.0


@kernel
def still_limit(restitution):
    """Contacts in a row that rounding does not tell apart, in time or place, after which a ball is caught.

    Caught between walls, or rolling into a hollow; with restitution, losing its speed in a wedge.
    """
    return 1000 if restitution is None else 100


@kernel
def tolerance_of(x, y, extent):
    """How far positions of a flight that begins at (x, y) may be off by rounding, without gravity."""
    return TOLERANCE * max(max(abs(x), abs(y)), extent)


@kernel
def has_left(box, r, x, y, vx, vy):
    """Tell whether a ball is outside the box of the walls, by more than rounding, and flies away: ``is_gone``."""
    r += 2.0**-40 * max(max(abs(box[0]), abs(box[1])), max(abs(box[2]), abs(box[3])))
    out_x = (x > box[2] + r and vx >= 0.0) or (x < box[0] - r and vx <= 0.0)
    out_y = (y > box[3] + r and vy >= 0.0) or (y < box[1] - r and vy <= 0.0)
    return out_x or out_y


@kernel
def begin_all(position, velocity, balls, x0, y0, extent, states, counts, start):
    """Write the states of some balls at time 0, without gravity, and their counts; see ``initial_states``."""
    for i in range(len(balls)):
        ball, state = balls[i], states[i]
        x, y, vx, vy = position[ball, 0] - x0, position[ball, 1] - y0, velocity[ball, 0], velocity[ball, 1]
        state[0], state[1], state[2], state[3], state[4], state[5] = x, y, vx, vy, 0.0, 0.0
        state[6] = vx * vx + vy * vy
        state[7], state[8], state[9], state[10] = x, y, vx, vy
        state[11] = tolerance_of(x, y, extent)
        for k in range(len(start)):
            counts[i, k] = start[k]


@kernel
def end_all(states, counts, radii, x0, y0, box, balls, outcome):
    """Read from states and counts where some balls ended, in the scene's coordinates; see ``Outcome``."""
    for i in range(len(balls)):
        ball, state = balls[i], states[i]
        x, y, vx, vy = state[0] + x0, state[1] + y0, state[2], state[3]
        outcome.position[ball, 0], outcome.position[ball, 1] = x, y
        outcome.velocity[ball, 0], outcome.velocity[ball, 1] = vx, vy
        outcome.time[ball] = state[4] + state[5]
        outcome.bounces[ball] = counts[i, 1]
        gone = counts[i, 2] == TIME_REACHED and has_left(box, radii[i], x, y, vx, vy)
        outcome.ending[ball] = LEFT_SCENE if gone else counts[i, 2]


@kernel
def fly_all(model, gravity, radii, states, counts, until, limit, hits, log, capacity):
    """Fly balls one after the other, with an empty log, or one ball with a log; see ``fly``."""
    noted = 0
    for ball in range(len(radii)):
        noted = fly(model, gravity, radii[ball], states[ball], counts[ball], until, limit, hits, log, capacity)
    return noted


@kernel
def note(log, row, time, x, y, vx, vy, nx, ny, radius, feature, kind):
    """Write one contact to the log, the normal made a unit and pointing to the ball: the row for the next one."""
    if len(log) == 0:
        return row
    length = math.sqrt(nx * nx + ny * ny)
    nx, ny = nx / length, ny / length
    o = 11 * row
    log[o], log[o + 1], log[o + 2], log[o + 3], log[o + 4] = time, x, y, vx, vy
    log[o + 5], log[o + 6] = x - radius * nx, y - radius * ny
    log[o + 7], log[o + 8], log[o + 9] = nx, ny, float(feature)
    log[o + 10] = float(kind)
    return row + 1
