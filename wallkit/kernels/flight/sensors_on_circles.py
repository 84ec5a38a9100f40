"""Sensors that a ball crosses whose centre goes round a circle: it glides along an arc or pivots about a vertex."""

from __future__ import annotations

import math

from wallkit.kernels.flight.obstacles import falls, place_at
from wallkit.kernels.flight.pendulum import speed_at, swing_time, to_quarter, turned, turning
from wallkit.kernels.flight.slowed_contact import swing_on
from wallkit.kernels.impact.arc_impact import holds
from wallkit.kernels.jit import kernel, rare_kernel
from wallkit.kernels.records import GOES_ON, NO_HIT

MORE = 2.0**-45
"""Rounding of a place on the circle, in parts of its radius."""
PIECES = 14
"""More than a full swing, or a full turn, has: quarters, divided at right angles and where the ball turns."""


@rare_kernel
def next_crossing_round(sensors, gx, gy, rho, away, x, y, ex, ey, v, time, until, last):
    """Move a centre on along its circle to the next sensor that it crosses.

    Args:
        sensors: their model; what slows the ball down is in it, too.
        gx: gravity, with gy.
        gy: see gx.
        rho: radius of the circle.
        away: 1 where it bends away from the ball's side of the wall, else -1.
        x: of the centre, local to the sensors, with y.
        y: see x.
        ex: unit direction from the circle's middle to it, with ey.
        ey: see ex.
        v: speed, counter-clockwise.
        time: now.
        until: when the ball leaves the circle, or inf.
        last: the edge that it crosses here, or NO_HIT.

    Returns:
        (x, y, ex, ey, v, time, edge); the edge is NO_HIT where none is crossed until then, or in a full swing ever.
    """
    return _next_crossing(sensors, sensors.rolling, sensors.drag, gx, gy, rho, away, x, y, ex, ey, v, time, until, last)


@kernel
def _next_crossing(sensors, rolling, drag, gx, gy, rho, away, x, y, ex, ey, v, time, until, last):
    """``next_crossing_round``, with what slows the ball down as arguments, so that what is not needed is dropped."""
    if drag is None:
        if rolling is None:
            return _next_crossing_swung(sensors, gx, gy, rho, x, y, ex, ey, v, time, until, last)
    return _next_crossing_slowed(sensors, rolling, drag, gx, gy, rho, away, x, y, ex, ey, v, time, until, last)


@rare_kernel
def _next_crossing_swung(sensors, gx, gy, rho, x, y, ex, ey, v, time, until, last):
    """``next_crossing_round`` without friction or drag: a pendulum."""
    idle = 0
    while idle < PIECES:
        pull = gy * ex - gx * ey
        if v == 0.0 and pull == 0.0:
            break
        # At rest it sets out to where gravity pulls it.
        turn = 1.0 if v > 0.0 or (v == 0.0 and pull > 0.0) else -1.0
        tx, ty, square = -turn * ey, turn * ex, v * v
        t, t_turn = to_quarter(ex, ey, tx, ty, gx, gy, 0.0), turning(rho, gx, gy, ex, ey, tx, ty, square)
        turns = t_turn < t
        t = min(t, t_turn)
        # a sensor at the very end of a quarter, as below the circle's middle, is crossed on this side of the end
        way, edge = _first_sensor(sensors, sensors.arcs, rho, ex, ey, tx, ty, x, y, last, t if turns else t + MORE)
        t, turns = way if edge != NO_HIT else t, turns and edge == NO_HIT
        fx, fy, _ux, _uy = turned(ex, ey, tx, ty, t)
        then = 0.0 if turns else speed_at(rho, gx, gy, ex, ey, tx, ty, square, t)
        time += swing_time(rho, gx, gy, ex, ey, fx, fy, t, abs(v), then)
        if time >= until:
            break
        x, y = place_at(rho, ex, ey, tx, ty, x, y, t)
        ex, ey, v = fx, fy, turn * then
        if edge != NO_HIT:
            return x, y, ex, ey, v, time, edge
        idle, last = idle + (1 if until == math.inf else 0), NO_HIT
    return x, y, ex, ey, v, time, NO_HIT


@rare_kernel
def _next_crossing_slowed(sensors, rolling, drag, gx, gy, rho, away, x, y, ex, ey, v, time, until, last):
    """``next_crossing_round`` for a ball that friction or drag slows down: where it turns there is a contact."""
    pull = gy * ex - gx * ey
    turn = 1.0 if v > 0.0 or (v == 0.0 and pull > 0.0) else -1.0
    speed, idle = abs(v), 0
    while time < until and idle < PIECES:
        tx, ty = -turn * ey, turn * ex
        way, edge = _first_sensor(sensors, sensors.arcs, rho, ex, ey, tx, ty, x, y, last, 1.0)
        u, speed, took, event = swing_on(rolling, drag, rho, away, ex, ey, tx, ty, gx, gy, speed, way, until - time)
        time += took
        if event != GOES_ON or time >= until:
            break
        x, y = place_at(rho, ex, ey, tx, ty, x, y, u)
        ex, ey, _ux, _uy = turned(ex, ey, tx, ty, u)
        if edge != NO_HIT and u >= way:
            return x, y, ex, ey, turn * speed, time, edge
        idle, last = idle + (1 if until == math.inf else 0), NO_HIT
    return x, y, ex, ey, turn * speed, time, NO_HIT


@kernel
def _first_sensor(sensors, arcs, rho, ex, ey, tx, ty, x, y, last, best):
    """First edge of a sensor on the way, up to ``best`` = tan(phi / 2): (way, edge)."""
    found = NO_HIT
    for edge in range(len(sensors.lines)):
        line = sensors.lines[edge]
        if line.length == 0.0:
            continue
        if arcs is not None:
            if arcs[edge].radius > 0.0:
                best, found = _cross_arc(arcs[edge], edge, rho, ex, ey, tx, ty, x, y, last, best, found)
                continue
        px, py = x - line.ax, y - line.ay
        d = 0.0 if edge == last else px * line.nx + py * line.ny
        rising = tx * line.nx + ty * line.ny
        above = d > 0.0 or (d == 0.0 and rising > 0.0)
        side = 1.0 if above else -1.0
        # From the side on which the centre is, or, on the sensor, to which it moves: the gap is above 0 and falls.
        way = falls(rho, ex, ey, tx, ty, side * d, side * line.nx, side * line.ny, 0.0, False)
        if way < best:
            fx, fy = place_at(rho, ex, ey, tx, ty, x, y, way)
            if 0.0 <= (fy - line.ay) * line.nx - (fx - line.ax) * line.ny < line.length:
                best, found = way, edge
    return best, found


@kernel
def _cross_arc(arc, edge, rho, ex, ey, tx, ty, x, y, last, best, found):
    """``_first_sensor`` for one arc."""
    wx, wy = x - arc.ax, y - arc.ay
    px, py = wx + arc.sx, wy + arc.sy
    power = 0.0 if edge == last else wx * (wx + 2.0 * arc.sx) + wy * (wy + 2.0 * arc.sy)
    beyond = power > 0.0 or (power == 0.0 and tx * px + ty * py > 0.0)
    side = 1.0 if beyond else -1.0
    # |p|^2 - R^2, or the negative from inside: of gradient 2 p, and q = 1.
    way = falls(rho, ex, ey, tx, ty, side * power, 2.0 * side * px, 2.0 * side * py, side, False)
    if way < best:
        fx, fy = place_at(rho, ex, ey, tx, ty, x, y, way)
        if holds(arc, fx - arc.ax + arc.sx, fy - arc.ay + arc.sy, 0.0):
            return way, edge
    return best, found
