"""Flights that are watched: until a target is reached, with the places they pass, and what those do that miss it."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from wallkit.kernels.flight.flight import fly, tally_of
from wallkit.kernels.flight.guide import STRAIGHT, guide
from wallkit.kernels.flight.regular import period_of, tangent_norm, word_of
from wallkit.kernels.flight.resting import side_of
from wallkit.kernels.flight.sensors import next_crossing, set_pull
from wallkit.kernels.flight.sensors_on_circles import next_crossing_round
from wallkit.kernels.impact.drag_motion import along
from wallkit.kernels.jit import kernel
from wallkit.kernels.records import (
    BOUNCE_LIMIT,
    COUNT,
    EDGE,
    LOG,
    LOG_STRIDE,
    NO_HIT,
    RUNNING,
    SLIDE,
    STATE,
    TIME_REACHED,
    VERTEX,
)

ROWS = 640
"""Contacts of a ball that are remembered: ten words of 64 edges."""
PIECE = 64
"""Contacts that are flown before anybody looks, at most."""
LAST = 300
"""Contacts over which the tangent map is taken."""
GROWS = 20.0
"""Regular motion stretches by less than this a contact: island orbits of a mushroom by 8 at most, chaotic ones by
millions over all."""
CURVED = 10
"""One in so many contacts must be on a curve: among straight walls every motion grows linearly, whatever it does."""
OTHER, REGULAR, REPEATS, SLOW = 0, 1, 2, 3


class Watch(NamedTuple):
    """What is watched, and where it is written."""

    sensors: Any
    """Model of the sensors that are the target, or None."""
    pull: Any
    """Scratch of 2 floats; None without gravity."""
    target: Any
    """(E + V,) 1 for the edges that are the target."""
    aims: Any
    """1 if there are such edges, else 0."""
    cells: Any
    """(x0, y0, cells per unit, columns, rows) of the squares in which places are counted."""
    visits: Any
    """(rows * columns,) balls that were in each, added to."""
    stamps: Any
    """(rows * columns,) the last ball that was; scratch, with numbers below that of the first ball."""
    marks: Any
    """(2 (E + V),) scratch, likewise."""
    log: Any
    """(ROWS * LOG_STRIDE,) scratch: the last contacts of a ball, one after the other and round again."""
    covering: Any
    """Number of the ball from which on places are not counted any more."""
    time: Any
    """(n,) when each ball reached the target: inf before; a ball with 0 is there already and does not fly."""
    met: Any
    """(n,) after how many bounces it did."""
    kind: Any
    """(n,) of motion, of those that did not and came to a limit: REGULAR, REPEATS or SLOW."""
    norm: Any
    """(n,) norm of the tangent map over their last contacts, for each of these contacts."""
    period: Any
    """(n,) edges of the word that they repeat, or 0."""
    word: Any
    """(n,) number of the set of features of their last contacts."""


@kernel
def fly_watched(model, gravity, lasting, watch, radii, states, counts, first, until, limit, hits):
    """Fly balls one after the other until they reach the target or end.

    Args:
        model: the scene, which counts bounces by edge.
        gravity: ``model.gravity``.
        lasting: 1 to judge motions at the limit; 0 where none lasts, as with friction or drag, or nobody asks.
        watch: see ``Watch``.
        radii: (n,) of the balls.
        states: (n, STATE_SIZE), read and written.
        counts: of the balls, read and written.
        first: number of the first ball, above 0.
        until: time at which to stop, or inf.
        limit: number of bounces at which to stop.
        hits: (E + V,) bounces by edge and vertex until the target, added to.
    """
    for ball in range(len(radii)):
        if watch.time[ball] > 0.0:
            filled = fly_to_target(
                model, gravity, watch, radii[ball], states[ball], counts[ball], ball, first + ball, until, limit, hits
            )
            if watch.time[ball] == math.inf:
                judge(model, gravity, lasting, watch, radii[ball], counts[ball], ball, first + ball, filled)


@kernel
def fly_to_target(model, gravity, watch, radius, state, counts, ball, number, until, limit, hits):
    """Fly one ball until it reaches the target or ends: how many contacts it had.

    Contacts are flown ahead by the piece and looked at after it: their flights only where somebody wants to know.
    """
    x, y, vx, vy, since = state[STATE.x], state[STATE.y], state[STATE.vx], state[STATE.vy], state[STATE.time]
    set_pull(model, gravity, watch.pull, EDGE, NO_HIT, vx, vy)
    feature, kind, nx, ny = NO_HIT, EDGE, 0.0, 0.0
    covers = number < watch.covering
    asks = covers or watch.sensors is not None
    filled, bounces, crossed = 0, 0, math.inf
    while counts[COUNT.ending] == RUNNING:
        room = min(min(PIECE, 4 + counts[COUNT.bounces] // 4), ROWS - filled % ROWS)
        ring = watch.log[LOG_STRIDE * (filled % ROWS) :]
        noted = fly(model, gravity, radius, state, counts, until, limit, hits, ring, room)
        row = 0
        while row < noted and (asks or watch.aims == 1):
            o = LOG_STRIDE * row
            if asks:
                crossed = crosses_at(
                    model, gravity, watch.sensors, watch.pull, radius, feature, kind, nx, ny, x, y, vx, vy, since,
                    ring[o + LOG.time],
                )  # fmt: skip
                if covers:
                    cover(
                        watch, watch.pull, model.drag, number, x, y, vx, vy, ring[o + LOG.time] - since,
                        ring[o + LOG.x], ring[o + LOG.y],
                    )  # fmt: skip
            feature, kind = int(ring[o + LOG.feature]), int(ring[o + LOG.kind])
            hit = kind <= VERTEX and watch.target[tally_of(model, feature)] == 1
            if hit or crossed < math.inf:
                crossed_first = crossed < math.inf
                watch.time[ball] = crossed if crossed_first else ring[o + LOG.time]
                watch.met[ball] = bounces + (0 if crossed_first else 1)
                forget(model, ring, row if crossed_first else row + 1, noted, hits)
                return filled + row
            bounces += 1 if kind <= VERTEX else 0
            if asks:
                since, x, y = ring[o + LOG.time], ring[o + LOG.x], ring[o + LOG.y]
                vx, vy = ring[o + LOG.vx], ring[o + LOG.vy]
                nx, ny = ring[o + LOG.nx], ring[o + LOG.ny]
                set_pull(model, gravity, watch.pull, kind, feature, vx, vy)
            row += 1
        filled += noted
    if asks:
        end = state[STATE.time] + state[STATE.lost]
        crossed = crosses_at(
            model, gravity, watch.sensors, watch.pull, radius, feature, kind, nx, ny, x, y, vx, vy, since, end
        )
        if covers:
            cover(watch, watch.pull, model.drag, number, x, y, vx, vy, end - since, state[STATE.x], state[STATE.y])
        if crossed < math.inf:
            watch.time[ball], watch.met[ball] = crossed, bounces
    return filled


@kernel
def forget(model, log, row, noted, hits):
    """Take back the bounces from a row on: they were flown ahead, and the ball was at its target."""
    for k in range(row, noted):
        if log[LOG_STRIDE * k + LOG.kind] <= VERTEX:
            hits[tally_of(model, int(log[LOG_STRIDE * k + LOG.feature]))] -= 1


@kernel
def crosses_at(model, gravity, sensors, pull, radius, feature, kind, nx, ny, x, y, vx, vy, since, until):
    """When a flight after a contact first crosses a sensor of the target: inf if it does not."""
    if sensors is None:
        return math.inf
    if gravity is not None:
        if kind == SLIDE:
            side = side_of(model, model.arcs, feature, x, y, nx, ny)
            rho, away, nx, ny = guide(model, model.arcs, feature, side, radius, x, y)
            if rho != STRAIGHT:
                ex, ey = away * nx, away * ny
                _x, _y, _ex, _ey, _v, time, edge = next_crossing_round(
                    sensors, gravity[0], gravity[1], rho, away, x, y, ex, ey, vy * ex - vx * ey, since, until, NO_HIT
                )
                return math.inf if edge == NO_HIT else time
    if vx == 0.0 and vy == 0.0 and pull is None:
        return math.inf
    tolerance = 2.0**-47 * max(max(abs(x), abs(y)), sensors.extent)
    _x, _y, _vx, _vy, time, lost, edge = next_crossing(
        sensors, pull, x, y, vx, vy, since, 0.0, until, NO_HIT, tolerance
    )
    return math.inf if edge == NO_HIT else time + lost


@kernel
def cover(watch, pull, drag, number, x, y, vx, vy, passed, to_x, to_y):
    """Count a ball in the squares that a flight passes: at steps of a square, a parabola's by its equation."""
    x0, y0, per_unit, columns, rows = watch.cells
    dx, dy = to_x - x, to_y - y
    steps = int(per_unit * max(abs(dx), abs(dy))) + 1
    gx, gy = 0.0, 0.0
    if pull is not None:  # p(s) = x + s (dx - g t^2 / 2) + s^2 g t^2 / 2 for s from 0 to 1
        gx, gy = 0.5 * passed * passed * pull[0], 0.5 * passed * passed * pull[1]
        if not abs(gx) + abs(gy) < math.inf:
            gx, gy = 0.0, 0.0
        steps += int(min(per_unit * (abs(gx) + abs(gy)), 1000.0))
    each = 1.0 / steps
    for k in range(steps + 1):
        s = k * each
        px, py = x + s * (dx - (1.0 - s) * gx), y + s * (dy - (1.0 - s) * gy)
        px, py = _with_drag(drag, pull, x, y, vx, vy, s, passed, to_x, to_y, px, py)
        column, row = (px - x0) * per_unit, (py - y0) * per_unit
        if 0.0 <= column < columns and 0.0 <= row < rows:
            cell = int(row) * columns + int(column)
            if watch.stamps[cell] != number:
                watch.stamps[cell] = number
                watch.visits[cell] += 1


@kernel
def _with_drag(drag, pull, x, y, vx, vy, s, passed, to_x, to_y, px, py):
    """Where a ball is under gravity and drag after the part s of its time; (px, py) without drag."""
    if drag is None:
        return px, py
    if not passed < math.inf:
        return px, py
    # A curve that holds it has it elsewhere: what that takes it off its end is taken back evenly.
    off_x = to_x - along(drag, x, vx, pull[0], passed)
    off_y = to_y - along(drag, y, vy, pull[1], passed)
    t = s * passed
    return along(drag, x, vx, pull[0], t) + s * off_x, along(drag, y, vy, pull[1], t) + s * off_y


@kernel
def judge(model, gravity, lasting, watch, radius, counts, ball, number, filled):
    """Tell how a ball moves that came to a limit before it came to the target."""
    watch.word[ball] = word_of(watch.log, ROWS, filled, LAST, watch.marks, number)
    if counts[COUNT.ending] != TIME_REACHED and counts[COUNT.ending] != BOUNCE_LIMIT:
        return
    watch.kind[ball] = SLOW
    if lasting == 0:
        return
    watch.period[ball] = period_of(model, watch.log, ROWS, filled)
    if watch.period[ball] > 0:
        watch.kind[ball] = REPEATS
    if filled > LAST:
        norm, curved = tangent_norm(model, gravity, radius, watch.log, ROWS, filled, LAST)
        watch.norm[ball] = norm / LAST
        if norm < GROWS * LAST and CURVED * curved >= LAST:
            watch.kind[ball] = REGULAR
