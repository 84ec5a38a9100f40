"""The loop: search the first contact, move there, turn the velocity, note it; until something ends the flight."""

from __future__ import annotations

import math

from wallkit.kernels.corner import normal_at, settle
from wallkit.kernels.grid import search
from wallkit.kernels.jit import kernel
from wallkit.kernels.model import (
    AMBIGUOUS,
    AMBIGUOUS_CORNER,
    AT_REST,
    BOUNCE_LIMIT,
    COLLAPSE,
    EDGE,
    LEFT_SCENE,
    NO_HIT,
    RUNNING,
    TIME_REACHED,
    VERTEX,
)
from wallkit.kernels.motion import advance, reflect

STILL_LIMIT = 1000
"""Contacts in a row without any time passing: a ball caught between walls, or one that rolls into a hollow."""


@kernel
def fly(model, radius, state, counts, until, limit, hits, log, capacity):
    """Fly one ball until its time, its bounce limit, an ending, or a full log.

    Args:
        model: the scene, see ``Model``.
        radius: of the ball; 0 for a point.
        state: floats of the ball (``STATE_SIZE``), read and written, so that a flight can go on later.
        counts: integers of the ball, see ``Counts``: last feature, bounces, ending, contacts without time.
        until: time at which to stop, or inf.
        limit: number of bounces at which to stop.
        hits: bounces by wall, added to, or None.
        log: flat floats, ``LOG_STRIDE`` a contact, or None.
        capacity: contacts that fit in ``log``.

    Returns:
        Number of contacts in the log. The flight goes on from here if ``counts`` says RUNNING.
    """
    x, y, vx, vy, time, lost, energy = state[0], state[1], state[2], state[3], state[4], state[5], state[6]
    from_x, from_y, from_vx, from_vy = state[7], state[8], state[9], state[10]
    tolerance = state[11]
    last, bounces, still = counts[0], counts[1], counts[3]
    ending = RUNNING
    noted = 0
    while ending == RUNNING and noted < capacity:
        if energy <= 0.0:
            ending = AT_REST
            break
        if bounces >= limit:
            ending = BOUNCE_LIMIT
            break
        remaining = (until - time) - lost
        t, feature, touched = search(
            model, model.grid, radius, x, y, vx, vy, energy, last, tolerance, remaining, NO_HIT
        )
        if touched > 0 and last >= 0:
            met = settle(model, last, x, y, vx, vy, from_x, from_y, from_vx, from_vy, tolerance, still)
            if met == AMBIGUOUS:
                ending = AMBIGUOUS_CORNER
                break
            if met != NO_HIT:
                t, feature = 0.0, met
        if feature == NO_HIT:
            ending = LEFT_SCENE if until == math.inf else TIME_REACHED
            break
        if time + t > time:
            still = 0
        else:
            still += 1
            if still > STILL_LIMIT:
                ending = COLLAPSE
                break
        if t > 0.0:
            from_x, from_y, from_vx, from_vy = x, y, vx, vy
            x += t * vx
            y += t * vy
            time, lost = advance(time, lost, t)
        if feature >= 0:
            nx, ny, twice = normal_at(model, model.arcs, feature, x, y)
            wall = model.edge_wall[feature]
        else:
            corner = model.corners[-2 - feature]
            nx, ny = x - corner.x, y - corner.y
            twice = 2.0 / (nx * nx + ny * ny)
            wall = model.corner_wall[-2 - feature]
        if vx * nx + vy * ny > 0.0:
            nx, ny = -nx, -ny
        vx, vy, energy = reflect(model.restitution, wall, nx, ny, twice, vx, vy, energy)
        last = feature
        bounces += 1
        if hits is not None:
            hits[wall] += 1
        if log is not None:
            note(log, noted, time + lost, x, y, vx, vy, radius, nx, ny, feature)
            noted += 1
    if ending == TIME_REACHED:
        remaining = (until - time) - lost
        if remaining > 0.0:
            from_x, from_y, from_vx, from_vy = x, y, vx, vy
            x += remaining * vx
            y += remaining * vy
            time, lost = until, 0.0
    state[0], state[1], state[2], state[3], state[4], state[5], state[6] = x, y, vx, vy, time, lost, energy
    state[7], state[8], state[9], state[10] = from_x, from_y, from_vx, from_vy
    counts[0], counts[1], counts[2], counts[3] = last, bounces, ending, still
    return noted


@kernel
def fly_all(model, radii, states, counts, until, limit, hits):
    """Fly balls one after the other; only their last states and the bounces by wall are kept."""
    for ball in range(len(radii)):
        fly(model, radii[ball], states[ball], counts[ball], until, limit, hits, None, limit + 1)


@kernel
def note(log, row, time, x, y, vx, vy, radius, nx, ny, feature):
    """Write one contact to the log, the normal made a unit and pointing to the ball."""
    if log is None:
        return
    length = math.sqrt(nx * nx + ny * ny)
    nx, ny = nx / length, ny / length
    o = 11 * row
    log[o], log[o + 1], log[o + 2], log[o + 3], log[o + 4] = time, x, y, vx, vy
    log[o + 5], log[o + 6] = x - radius * nx, y - radius * ny
    log[o + 7], log[o + 8], log[o + 9] = nx, ny, float(feature)
    log[o + 10] = float(EDGE if feature >= 0 else VERTEX)
