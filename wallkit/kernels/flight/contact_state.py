"""A ball that keeps to a wall: it slides on a line, glides along an arc, or pivots about a vertex.

Its centre stays on a guide, so its motion is exact: constant acceleration on a straight one, a pendulum's on a circle;
with rolling friction and drag see ``slowed_contact``. One stretch of it goes on in one direction until, first of all,

* nothing presses the ball on the wall any longer: v^2 / rho + g.n, less or more, is linear in the place on a circle;
* it stands still: so is v^2;
* it comes to the end of the edge, or of the fan of a vertex, or meets something else: see ``obstacles``;
* its quarter of the circle ends, or what its cell of the index lists, or its time.

All of them are falls through zero of polynomials of the second degree, in one variable, and the first of them counts.
"""

from __future__ import annotations

import math

from wallkit.kernels.flight.guide import STRAIGHT, ahead_of, guide
from wallkit.kernels.flight.obstacles import falls, meet_arcs, meet_corners, meet_lines, place_at
from wallkit.kernels.flight.pendulum import speed_at, swing_time, swing_within, to_quarter, turned, turning
from wallkit.kernels.flight.slowed_contact import pull_ahead, slide_with_drag, slows, swing_on, way_to_turn
from wallkit.kernels.impact.polynomial_roots import NEVER
from wallkit.kernels.index.grid import around, home, leaf, moves_to_next, place
from wallkit.kernels.jit import kernel, rare_kernel
from wallkit.kernels.records import END_OF_EDGE, GOES_ON, LIFTS, NO_HIT, TIME_IS_UP, TURNS

OVER = 2.0**-18
"""A stretch ends beyond the border of a cell by this part of its side: well within what the cell lists (2^-16)."""


@rare_kernel
def stretch(model, gravity, radius, held, side, last, x, y, vx, vy, start_of, tolerance, span):
    """Move a ball along its guide until something happens.

    Returns:
        (x, y, vx, vy, the time it took, what ended it: a feature, or END_OF_EDGE, LIFTS, TURNS, GOES_ON, TIME_IS_UP).
    """
    rho, away, nx, ny = guide(model, model.arcs, held, side, radius, x, y)
    gx, gy = gravity[0], gravity[1]
    tx, ty, speed = ahead_of(rho, away, nx, ny, vx, vy, gx, gy)
    # e goes from the middle of the guide's circle to the centre, on whichever side of the wall the ball is.
    ex, ey = away * nx, away * ny
    rolling, drag = model.rolling, model.drag
    way, event = _own_events(model, rolling, drag, held, radius, rho, away, ex, ey, tx, ty, gx, gy, x, y, speed)
    way, event = _met(
        model, model.grid, radius, held, side, last, rho, ex, ey, tx, ty, x, y, start_of, tolerance, way, event
    )
    if rho == STRAIGHT:
        pull = pull_ahead(rolling, drag, tx, ty, gx, gy)
        return _straight(drag, tx, ty, pull, x, y, speed, way, event, span)
    return _round(rolling, drag, rho, away, ex, ey, tx, ty, gx, gy, x, y, speed, way, event, span)


@rare_kernel
def reach(model, gravity, radius, held, side, last, x, y, way, start_of, tolerance):
    """Move a centre along its guide by a length (to the left of the normal above 0), or to what is met, or the end.

    Returns:
        (x, y, part of the way that is done).
    """
    rho, away, nx, ny = guide(model, model.arcs, held, side, radius, x, y)
    turn = 1.0 if way > 0.0 else -1.0
    tx, ty, ex, ey = -turn * ny, turn * nx, away * nx, away * ny
    whole = abs(way) if rho == STRAIGHT else abs(way) / (2.0 * rho)  # tan of so small an angle is that angle
    done, event = _to_end(model, model.arcs, held, radius, rho, away, ex, ey, tx, ty, x, y, whole, GOES_ON)
    done, event = _met(
        model, None, radius, held, side, last, rho, ex, ey, tx, ty, x, y, start_of, tolerance, done, event
    )
    x, y = place_at(rho, ex, ey, tx, ty, x, y, done)
    return x, y, done / whole if whole > 0.0 else 1.0


@kernel
def _straight(drag, tx, ty, pull, x, y, speed, way, event, span):
    """Go ``way`` in the direction t at v + a t, or as far as in the time ``span``: see ``stretch``."""
    if drag is not None:
        return slide_with_drag(drag, tx, ty, pull, x, y, speed, way, event, span)
    # v'^2 = v^2 + 2 a s, and the time is 2 s / (v + v'): no difference, whatever the pull.
    square = max(speed * speed + 2.0 * pull * way, 0.0)
    then = 0.0 if event == TURNS else math.sqrt(square) if way < NEVER else speed
    time = NEVER if way == NEVER or speed + then == 0.0 else 2.0 * way / (speed + then)
    if way == 0.0:
        time = 0.0
    if time > span or (time == NEVER and span == NEVER):
        if span == NEVER:
            return x, y, speed * tx, speed * ty, 0.0, TIME_IS_UP
        way, then, time, event = span * (speed + 0.5 * span * pull), speed + span * pull, span, TIME_IS_UP
    return x + way * tx, y + way * ty, then * tx, then * ty, time, event


@kernel
def _round(rolling, drag, rho, away, ex, ey, tx, ty, gx, gy, x, y, speed, way, event, span):
    """Turn by ``way`` = tan(phi / 2) about the centre of a circle, or as far as in the time ``span``."""
    if drag is None:
        if rolling is None:
            return _swung(rho, ex, ey, tx, ty, gx, gy, x, y, speed, way, event, span)
    done, then, time, ended = swing_on(rolling, drag, rho, away, ex, ey, tx, ty, gx, gy, speed, way, span)
    _fx, _fy, ux, uy = turned(ex, ey, tx, ty, done)
    x, y = place_at(rho, ex, ey, tx, ty, x, y, done)
    return x, y, then * ux, then * uy, time, event if ended == GOES_ON and done >= way else ended


@kernel
def _swung(rho, ex, ey, tx, ty, gx, gy, x, y, speed, way, event, span):
    """``_round`` without friction or drag: a pendulum."""
    square = speed * speed
    fx, fy, ux, uy = turned(ex, ey, tx, ty, way)
    # Energy gives the speed; where the ball turns it is 0, exactly.
    then = 0.0 if event == TURNS else speed_at(rho, gx, gy, ex, ey, tx, ty, square, way)
    time = swing_time(rho, gx, gy, ex, ey, fx, fy, way, speed, then)
    if time > span:
        way, time, event = swing_within(rho, gx, gy, ex, ey, tx, ty, square, way, span), span, TIME_IS_UP
        fx, fy, ux, uy = turned(ex, ey, tx, ty, way)
        then = speed_at(rho, gx, gy, ex, ey, tx, ty, square, way)
    x, y = place_at(rho, ex, ey, tx, ty, x, y, way)
    return x, y, then * ux, then * uy, time, event


@kernel
def _own_events(model, rolling, drag, held, radius, rho, away, ex, ey, tx, ty, gx, gy, x, y, speed):
    """First event on the way ahead that asks for nothing but the guide and what holds the ball: (way, event)."""
    square = speed * speed
    if rho == STRAIGHT:
        way = way_to_turn(drag, speed, pull_ahead(rolling, drag, tx, ty, gx, gy))
        event = TURNS if way < NEVER else GOES_ON
        return _to_end(model, model.arcs, held, radius, rho, away, ex, ey, tx, ty, x, y, way, event)
    if slows(rolling, drag):  # where it turns and where it lifts is found on the way, at most a right angle
        return _to_end(model, model.arcs, held, radius, rho, away, ex, ey, tx, ty, x, y, 1.0, GOES_ON)
    # A way below the rounding of the place would leave it where it is, and without end.
    way, event = to_quarter(ex, ey, tx, ty, gx, gy, 2.0**-52 * (abs(x) + abs(y)) / rho), GOES_ON
    turn = turning(rho, gx, gy, ex, ey, tx, ty, square)
    if turn < way:
        way, event = turn, TURNS
    # rho times what presses it is -away (v^2 + rho g.e); with v^2 it changes by -away 3 rho g.(f - e)
    pressed = -away * (square + rho * (gx * ex + gy * ey))
    lift = falls(rho, ex, ey, tx, ty, pressed, -3.0 * away * gx, -3.0 * away * gy, 0.0, False)
    if lift < way:
        way, event = lift, LIFTS
    return _to_end(model, model.arcs, held, radius, rho, away, ex, ey, tx, ty, x, y, way, event)


@kernel
def _to_end(model, arcs, held, radius, rho, away, ex, ey, tx, ty, x, y, way, event):
    """Look whether the edge, or the fan of the vertex, ends before: (way, event)."""
    if held < 0:
        first = model.spokes[-2 - held]
        end = first
        while end != NO_HIT:
            joint = model.joints[end]
            # beside the vertex e.d < 0 for the direction d of each of its edges
            c = -rho * (ex * joint.tx + ey * joint.ty)
            meets = falls(rho, ex, ey, tx, ty, c, -joint.tx, -joint.ty, 0.0, False)
            if meets < way:
                way, event = meets, END_OF_EDGE
            end = joint.counter
            if end == first:
                break
        return way, event
    line = model.lines[held]
    left = -1.0
    if rho != STRAIGHT:
        left = _left_on_arc(arcs, held, x - away * radius * ex, y - away * radius * ey, ex, ey, tx, ty)
    else:
        # Place along the edge, tau = (-ny, nx); onwards where t.tau > 0.
        u = (y - line.ay) * line.nx - (x - line.ax) * line.ny
        onwards = ty * line.nx - tx * line.ny > 0.0
        left = max(line.length - u if onwards else u, 0.0)
    if left < way:
        way, event = left, END_OF_EDGE
    return way, event


@kernel
def _left_on_arc(arcs, held, x, y, ex, ey, tx, ty):
    """How far ahead an arc ends of its place (x, y), in the direction e: tan(phi / 2); NEVER beyond a right angle.

    With h the chord to the end R sin(phi) = h.t and R cos(phi) = R + h.e: no digit depends on how far the centre is.
    """
    if arcs is None:
        return NEVER
    arc = arcs[held]
    hx, hy = arc.ax - x, arc.ay - y
    if ex * ty - ey * tx > 0.0:  # counter-clockwise, to b
        hx, hy = arc.bx - x, arc.by - y
    across, along = hx * tx + hy * ty, hx * ex + hy * ey
    if arc.radius + along <= 0.0:
        return NEVER
    return max(across, 0.0) / (2.0 * arc.radius + along)


@kernel
def _met(model, grid, radius, held, side, last, rho, ex, ey, tx, ty, x, y, start_of, tolerance, way, event):
    """Look what is met before ``way``, and how far the cell of the index reaches: (way, event)."""
    cell = model.cells[home(model, model.grid, x, y)]
    if grid is not None:
        border = _border(model, grid, rho, ex, ey, tx, ty, x, y)
        if border < way:
            way, event = border, GOES_ON
    best, feature = way, NO_HIT
    best, feature = meet_lines(
        model, cell.first, cell.arcs, radius, held, side, last, rho, ex, ey, tx, ty, x, y, start_of, tolerance,
        best, feature,
    )  # fmt: skip
    best, feature = meet_arcs(
        model, model.arcs, cell.arcs, cell.corners, radius, held, side, last, rho, ex, ey, tx, ty, x, y, start_of,
        tolerance, best, feature,
    )  # fmt: skip
    if radius > 0.0:  # corners are listed for the discs of a scene; a point meets none
        best, feature = meet_corners(
            model, cell.corners, cell.end, radius, held, rho, ex, ey, tx, ty, x, y, tolerance, best, feature
        )
    return (best, feature) if feature != NO_HIT else (way, event)


@kernel
def _border(model, grid, rho, ex, ey, tx, ty, x, y):
    """How far ahead a ball is just beyond the cell of the index, or the empty square, in which it is."""
    column, row = place(grid, x, y)
    columns, rows = grid.columns << grid.shift, grid.rows << grid.shift
    c, shift = leaf(model.cells, grid, column, row)
    moves = moves_to_next(model.cells[c])
    left, right = around(moves, shift, column, columns)
    low, high = around(moves, shift, row, rows)
    # A hair beyond the border, so that the next stretch begins in the next cell and not on the border again.
    over = OVER * grid.unit * (1 << shift)
    way = NEVER
    if left > 0:
        way = min(way, falls(rho, ex, ey, tx, ty, x - (grid.x0 + left * grid.unit - over), 1.0, 0.0, 0.0, False))
    if right < columns:
        way = min(way, falls(rho, ex, ey, tx, ty, grid.x0 + right * grid.unit + over - x, -1.0, 0.0, 0.0, False))
    if low > 0:
        way = min(way, falls(rho, ex, ey, tx, ty, y - (grid.y0 + low * grid.unit - over), 0.0, 1.0, 0.0, False))
    if high < rows:
        way = min(way, falls(rho, ex, ey, tx, ty, grid.y0 + high * grid.unit + over - y, 0.0, -1.0, 0.0, False))
    return way
