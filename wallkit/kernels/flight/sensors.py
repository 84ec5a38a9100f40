"""Sensors: walls that a ball's centre crosses without a bounce. They change no flight, so they are asked after it.

Where several edges are touched at once (in a vertex, or where sensors share a border) the search finds one of them. For
the others the way decides as for any vertex: a path passes between the ends of an edge if they lie on either side of
it, and a vertex on the path has one side for all edges that meet there. So what is closed is left as often as entered.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from wallkit.kernels.flight.damping import free_time, slowed
from wallkit.kernels.flight.flight import fly, normal_of
from wallkit.kernels.flight.gravity import fall, first_contact
from wallkit.kernels.flight.guide import STRAIGHT, guide
from wallkit.kernels.flight.motion import advance
from wallkit.kernels.flight.point_in_corner import touching
from wallkit.kernels.flight.resting import side_of
from wallkit.kernels.flight.sensors_on_circles import next_crossing_round
from wallkit.kernels.flight.slowed_contact import pull_ahead, slows
from wallkit.kernels.impact.contact_normal import normal_at
from wallkit.kernels.index.grid import home
from wallkit.kernels.jit import kernel, rare_kernel
from wallkit.kernels.records import COUNT, EDGE, FREE, LOG, LOG_STRIDE, NO_HIT, RUNNING, SLIDE, STATE


class Crossing(NamedTuple):
    """The columns of a crossing that is noted: ``rows[row * CROSSING_STRIDE + CROSSING.time]``."""

    flight: Any
    time: Any
    x: Any
    y: Any
    vx: Any
    vy: Any
    nx: Any
    ny: Any
    """Outward unit normal of the sensor there."""
    edge: Any


CROSSING, CROSSING_STRIDE, FLIGHT_STRIDE = Crossing(*range(9)), 9, 6


@kernel
def next_crossing(sensors, pull, x, y, vx, vy, time, lost, until, last, tolerance):
    """Move a centre on to the next sensor that it crosses in a flight.

    Args:
        sensors: their model; its damping and drag are those of the flight.
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
    # The centre is a point that nothing turns: the same search as for a wall, with radius 0.
    t, edge, _touched = first_contact(
        sensors, pull, 0.0, x, y, vx, vy, energy, last, NO_HIT, FREE, 1.0, tolerance, best
    )
    if edge == NO_HIT:
        return x, y, vx, vy, time, lost, edge
    passed, kept = slowed(sensors.damping, energy, t, remaining)
    x, y, vx, vy = fall(pull, sensors.drag, x, y, vx, vy, t)
    time, lost = advance(time, lost, passed)
    return x, y, kept * vx, kept * vy, time, lost, edge


@kernel
def outward(sensors, edge, x, y):
    """Outward unit normal of a sensor's edge at a place on it."""
    nx, ny, twice, _wall = normal_of(sensors, edge, x, y)
    # twice = 2 / (n.n), so 1 / |n| = sqrt(twice / 2).
    unit = (0.5 * twice) ** 0.5 * _turn(sensors.arcs, edge)
    return nx * unit, ny * unit


@rare_kernel
def crosses_too(sensors, edge, last, x, y, vx, vy, tolerance):
    """Tell whether a centre that crosses the edge ``last`` at (x, y) crosses another edge there too.

    Edges of one wall that meet there share the side on which the path passes their vertex: that across from the other
    end of ``last``. Those of other walls take a vertex on the path for one to its left.
    """
    if edge == last:
        return False
    touches, starts, ends = touching(sensors, sensors.arcs, edge, x, y, tolerance)
    if not touches:
        return False
    if not (starts or ends):
        return True
    vertex = 1.0
    if sensors.edge_wall[edge] == sensors.edge_wall[last]:
        _touches, from_here, to_here = touching(sensors, sensors.arcs, last, x, y, tolerance)
        if from_here or to_here:
            vertex = -_side_of_way(sensors, last, from_here, x, y, vx, vy)
    # The path passes between the ends of an edge if they lie on either side of it; the vertex has one side for all.
    return _side_of_way(sensors, edge, starts, x, y, vx, vy) != vertex


@rare_kernel
def _side_of_way(sensors, edge, starts, x, y, vx, vy):
    """On which side of its way a centre has an edge that starts at (x, y), or ends there: 1 on the left, or -1."""
    nx, ny, _twice = normal_at(sensors, sensors.arcs, edge, x, y)
    # The edge goes a quarter turn to the left of n from its start: to the left of v where v.n > 0.
    along = 1.0 if starts else -1.0
    return 1.0 if along * (vx * nx + vy * ny) >= 0.0 else -1.0


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
    _cross(sensors, pull, x, y, vx, vy, since, until, found, first, None, 0, 0)


@kernel
def note_crossings(sensors, pull, flights, pulls, first, rows):
    """Note what flights cross, one after the other, each in order.

    Args:
        sensors: their model.
        pull: scratch of 2 floats; None where nothing pulls.
        flights: (6 m,) of each x, y, vx, vy, since and until, local to the sensors.
        pulls: (2 m,) accelerations.
        first: the flight to begin with.
        rows: flat, written: see ``Crossing``.

    Returns:
        The flight to go on with, m at the end, and how many rows are written; one whose rows find no room is begun
        again.
    """
    count = 0
    for flight in range(first, len(flights) // FLIGHT_STRIDE):
        at, before = FLIGHT_STRIDE * flight, count
        if pull is not None:
            pull[0], pull[1] = pulls[2 * flight], pulls[2 * flight + 1]
        count = _cross(
            sensors, pull, flights[at], flights[at + 1], flights[at + 2], flights[at + 3], flights[at + 4],
            flights[at + 5], None, 0, rows, flight, count,
        )  # fmt: skip
        if CROSSING_STRIDE * count > len(rows):
            return flight, before
    return len(flights) // FLIGHT_STRIDE, count


@kernel
def _cross(sensors, pull, x, y, vx, vy, since, until, found, first, rows, flight, count):
    """Find what one flight crosses; it is counted or, with ``rows``, noted behind ``count`` of them: how many then."""
    time, lost, last = since, 0.0, NO_HIT
    tolerance = 2.0**-47 * max(max(abs(x), abs(y)), sensors.extent)
    while vx != 0.0 or vy != 0.0 or pull is not None:
        x, y, vx, vy, time, lost, last = next_crossing(sensors, pull, x, y, vx, vy, time, lost, until, last, tolerance)
        if last == NO_HIT:
            break
        count = _tell(sensors, last, time + lost, x, y, vx, vy, found, first, rows, flight, count)
        # Where edges meet the search names one of them; the others that are crossed there are asked for.
        cell = sensors.cells[home(sensors, sensors.grid, x, y)]
        for k in range(cell.first, cell.corners):
            if crosses_too(sensors, sensors.ids[k], last, x, y, vx, vy, tolerance):
                count = _tell(sensors, sensors.ids[k], time + lost, x, y, vx, vy, found, first, rows, flight, count)
    return count


@kernel
def _tell(sensors, edge, time, x, y, vx, vy, found, first, rows, flight, count):
    """Count a crossing, or note it; rows for which there is no room are only counted."""
    if rows is None:
        _count(sensors, edge, x, y, vx, vy, found, first)
        return count
    at = CROSSING_STRIDE * count
    if at + CROSSING_STRIDE <= len(rows):
        nx, ny = outward(sensors, edge, x, y)
        rows[at + CROSSING.flight], rows[at + CROSSING.time] = float(flight), time
        rows[at + CROSSING.x], rows[at + CROSSING.y] = x, y
        rows[at + CROSSING.vx], rows[at + CROSSING.vy] = vx, vy
        rows[at + CROSSING.nx], rows[at + CROSSING.ny], rows[at + CROSSING.edge] = nx, ny, float(edge)
    return count + 1


@kernel
def _count(sensors, edge, x, y, vx, vy, found, first):
    """Count a crossing of an edge: inwards or outwards."""
    nx, ny = outward(sensors, edge, x, y)
    # Against the outward normal it goes in.
    found[first + 2 * sensors.edge_wall[edge] + (0 if vx * nx + vy * ny < 0.0 else 1)] += 1


@kernel
def count_round(sensors, gravity, rho, away, nx, ny, x, y, vx, vy, since, until, found, first):
    """Count what a ball crosses that glides along an arc, or pivots about a vertex: see ``count_crossings``."""
    # e from the middle of the circle to the centre, and the speed counter-clockwise, e x v.
    ex, ey = away * nx, away * ny
    v, last = vy * ex - vx * ey, NO_HIT
    while True:
        x, y, ex, ey, v, since, last = next_crossing_round(
            sensors, gravity[0], gravity[1], rho, away, x, y, ex, ey, v, since, until, last
        )
        if last == NO_HIT:
            break
        _count(sensors, last, x, y, -v * ey, v * ex, found, first)


@kernel
def count_kept(model, gravity, sensors, radius, feature, kind, nx, ny, x, y, vx, vy, since, until, found, first):
    """Count what a ball crosses after a contact if a curve holds it from there on: whether one does."""
    if gravity is None:
        return False
    if kind != SLIDE:
        return False
    side = side_of(model, model.arcs, feature, x, y, nx, ny)
    rho, away, nx, ny = guide(model, model.arcs, feature, side, radius, x, y)
    if rho == STRAIGHT:
        return False
    count_round(sensors, gravity, rho, away, nx, ny, x, y, vx, vy, since, until, found, first)
    return True


@kernel
def set_pull(model, gravity, pull, kind, feature, vx, vy):
    """Write what accelerates a ball after a contact: gravity, or its part along the wall on which the ball slides.

    Rolling friction is part of it there, against the velocity; drag is not.
    """
    if pull is not None:
        pull[0], pull[1] = gravity[0], gravity[1]
        if kind == SLIDE and feature >= 0:
            line = model.lines[feature]
            # (g.t) t, with t = (-ny, nx) along the line.
            along = gravity[1] * line.nx - gravity[0] * line.ny
            pull[0], pull[1] = -along * line.ny, along * line.nx
            if slows(model.rolling, model.drag):
                moves = vy * line.nx - vx * line.ny
                turn = 1.0 if moves > 0.0 or (moves == 0.0 and along > 0.0) else -1.0
                tx, ty = -turn * line.ny, turn * line.nx
                ahead = pull_ahead(model.rolling, model.drag, tx, ty, gravity[0], gravity[1])
                pull[0], pull[1] = ahead * tx, ahead * ty


@kernel
def fly_sensed(model, gravity, pull, sensors, walls, radii, states, counts, until, limit, found, log, capacity):
    """Fly balls one after the other, as ``flight.fly_all`` does, and count what they cross.

    Args:
        model: the scene.
        gravity: ``model.gravity``.
        pull: scratch of 2 floats, None without gravity.
        sensors: their model, with the same local origin.
        walls: how many counts of bounces there are, W.
        radii: (n,) of the balls.
        states: (n, STATE_SIZE), read and written.
        counts: (n, 10), see ``Counts``, read and written.
        until: time at which to stop, or inf.
        limit: number of bounces at which to stop.
        found: (W + 2 S,) added to: counts of bounces, then for each sensor how often it is entered, and left.
        log: scratch of capacity LOG_STRIDE floats.
        capacity: 1 or more.
    """
    for ball in range(len(radii)):
        state = states[ball]
        x, y, vx, vy, since = state[STATE.x], state[STATE.y], state[STATE.vx], state[STATE.vy], state[STATE.time]
        set_pull(model, gravity, pull, EDGE, NO_HIT, vx, vy)
        feature, kind, nx, ny, radius = NO_HIT, EDGE, 0.0, 0.0, radii[ball]
        while counts[ball, COUNT.ending] == RUNNING:
            noted = fly(model, gravity, radii[ball], state, counts[ball], until, limit, found, log, capacity)
            for row in range(noted):
                o = LOG_STRIDE * row
                end = log[o + LOG.time]
                # From contact to contact the ball flies or slides, or a curve holds it: it crosses sensors on that way.
                if not count_kept(
                    model, gravity, sensors, radius, feature, kind, nx, ny, x, y, vx, vy, since, end, found, walls
                ):
                    count_crossings(sensors, pull, x, y, vx, vy, since, end, found, walls)
                since, x, y, vx, vy = end, log[o + LOG.x], log[o + LOG.y], log[o + LOG.vx], log[o + LOG.vy]
                nx, ny = log[o + LOG.nx], log[o + LOG.ny]
                feature, kind = int(log[o + LOG.feature]), int(log[o + LOG.kind])
                set_pull(model, gravity, pull, kind, feature, vx, vy)
        end = state[STATE.time] + state[STATE.lost]
        if not count_kept(
            model, gravity, sensors, radius, feature, kind, nx, ny, x, y, vx, vy, since, end, found, walls
        ):
            count_crossings(sensors, pull, x, y, vx, vy, since, end, found, walls)
