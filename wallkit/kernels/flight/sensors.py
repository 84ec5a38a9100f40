"""Sensors: walls that a ball's centre crosses without a bounce. They change no flight, so they are asked after it."""

from __future__ import annotations

import math

from wallkit.kernels.flight.damping import free_time, slowed
from wallkit.kernels.flight.flight import fly, normal_of
from wallkit.kernels.flight.gravity import first_contact, move, pull_on
from wallkit.kernels.flight.motion import advance
from wallkit.kernels.jit import kernel
from wallkit.kernels.records import EDGE, FREE, LOG_STRIDE, NO_HIT, RUNNING, SLIDE, SLIDING


@kernel
def next_crossing(sensors, pull, x, y, vx, vy, time, lost, until, last, tolerance):
    """Move a centre on to the next sensor that it crosses in a flight.

    Args:
        sensors: their model; its damping is that of the flight.
        pull: acceleration on this flight, or None.
        x: of the centre, local to the sensors.
        y: of the centre.
        vx: its velocity.
        vy: its velocity.
        time: now.
        lost: by the time to rounding.
        until: when the flight ends, or inf.
        last: the edge that it crosses here, or NO_HIT.
        tolerance: of places.

    Returns:
        (x, y, vx, vy, time, lost, edge); the edge is NO_HIT, and the rest as it was, where none is crossed.
    """
    remaining = (until - time) - lost
    energy = vx * vx + vy * vy
    best = free_time(sensors.damping, energy, remaining)
    t, edge, _touched = first_contact(sensors, pull, 0.0, x, y, vx, vy, energy, last, NO_HIT, FREE, tolerance, best)
    if edge == NO_HIT:
        return x, y, vx, vy, time, lost, edge
    passed, kept = slowed(sensors.damping, energy, t, remaining)
    x, y, vx, vy = move(sensors, pull, NO_HIT, FREE, x, y, vx, vy, t)
    time, lost = advance(time, lost, passed)
    return x, y, kept * vx, kept * vy, time, lost, edge


@kernel
def outward(sensors, edge, x, y):
    """Outward unit normal of a sensor's edge at a place on it."""
    nx, ny, twice, _wall = normal_of(sensors, edge, x, y)
    unit = (0.5 * twice) ** 0.5 * _turn(sensors.arcs, edge)
    return nx * unit, ny * unit


@kernel
def _turn(arcs, edge):
    """1 where the normal that an edge is stored with is its outward one, else -1."""
    if arcs is not None:
        if arcs[edge].radius > 0.0:
            return math.copysign(1.0, arcs[edge].sweep)
    return 1.0


@kernel
def count_crossings(sensors, pull, x, y, vx, vy, since, until, found, first):
    """Count what one flight crosses: into found[first + 2 s] where it enters sensor s, into the next where it exits."""
    time, lost, last = since, 0.0, NO_HIT
    tolerance = 2.0**-47 * max(max(abs(x), abs(y)), sensors.extent)
    while vx != 0.0 or vy != 0.0 or pull is not None:
        x, y, vx, vy, time, lost, last = next_crossing(sensors, pull, x, y, vx, vy, time, lost, until, last, tolerance)
        if last == NO_HIT:
            break
        nx, ny = outward(sensors, last, x, y)
        found[first + 2 * sensors.edge_wall[last] + (0 if vx * nx + vy * ny < 0.0 else 1)] += 1


@kernel
def set_pull(model, gravity, pull, kind, feature):
    """Write what accelerates a ball after a contact: gravity, or the part of it along the wall on which it slides."""
    if pull is not None:
        pull[0], pull[1] = pull_on(model, gravity, feature, SLIDING if kind == SLIDE else FREE)


@kernel
def fly_sensed(model, gravity, pull, sensors, walls, radii, states, counts, until, limit, found, log, capacity):
    """Fly balls one after the other, as ``flight.fly_all`` does, and count what they cross.

    Args:
        model: the scene.
        gravity: ``model.gravity``.
        pull: scratch of 2 floats, None without gravity.
        sensors: their model, with the same local origin.
        walls: their number, W.
        radii: (n,) of the balls.
        states: (n, STATE_SIZE), read and written.
        counts: (n, 6), read and written.
        until: time at which to stop, or inf.
        limit: number of bounces at which to stop.
        found: (W + 2 S,) added to: bounces by wall, then for each sensor how often it is entered, and left.
        log: scratch of capacity LOG_STRIDE floats.
        capacity: 1 or more.
    """
    for ball in range(len(radii)):
        x, y, vx, vy, since = states[ball, 0], states[ball, 1], states[ball, 2], states[ball, 3], states[ball, 4]
        set_pull(model, gravity, pull, EDGE, NO_HIT)
        while counts[ball, 2] == RUNNING:
            noted = fly(model, gravity, radii[ball], states[ball], counts[ball], until, limit, found, log, capacity)
            for row in range(noted):
                o = LOG_STRIDE * row
                count_crossings(sensors, pull, x, y, vx, vy, since, log[o], found, walls)
                since, x, y, vx, vy = log[o], log[o + 1], log[o + 2], log[o + 3], log[o + 4]
                set_pull(model, gravity, pull, int(log[o + 10]), int(log[o + 9]))
        count_crossings(sensors, pull, x, y, vx, vy, since, states[ball, 4] + states[ball, 5], found, walls)
