"""The way of a parabola through the grid, and what it meets there first.

Both coordinates of the velocity keep their signs but for a moment each, and so does the octant in which
the ball goes. Between two such *turns* the walk is that of a straight flight: a rectangle of cells after the other,
each as large as there is nothing to meet in that octant.
"""

from __future__ import annotations

import math

from wallkit.kernels.impact.arc_fall import fall_arcs
from wallkit.kernels.impact.drag_motion import beyond, carried, speed_after, standstill, time_to_border
from wallkit.kernels.impact.gravity_impact import fall_corners, fall_line
from wallkit.kernels.impact.polynomial_roots import NEVER
from wallkit.kernels.index.grid import clearing, leaf, moves_to_next, place
from wallkit.kernels.jit import kernel
from wallkit.kernels.records import OCTANTS


@kernel
def fall_search(model, grid, drag, radius, x, y, vx, vy, gx, gy, last, skipped, tolerance, reference, best, feature):
    """Find the earliest contact before ``best``: (time, feature, edges touched by a point where it starts).

    ``drag`` is ``model.drag``: with it the way is no parabola, but turns as seldom. The cells at the grid's border
    reach on without end, so a ball that leaves the grid is followed back into it.
    """
    far = _far(model, drag, x, y, vx, vy, gx, gy)
    if grid is None:
        return _fall_scan(
            model, 0, radius, x, y, vx, vy, gx, gy, drag, far, last, skipped, tolerance, reference, 0.0, NEVER, best,
            feature,
        )  # fmt: skip
    column, row = place(grid, x, y)
    columns, rows = grid.columns << grid.shift, grid.rows << grid.shift
    touched, octant = 0, 0
    now = turn = 0.0
    at_x, at_y, ux, uy = x, y, vx, vy
    # Four turns at most make five pieces, and on each columns and rows only rise, or only fall.
    for step in range(5 * (columns + rows) + 16):
        if step == 0 or now == turn:
            turn = _next_turn(grid, drag, vx, vy, gx, gy, now)
            octant = _way_between(drag, vx, vy, gx, gy, now, turn)
        c, shift = 0, grid.shift
        wide, high = clearing(model.clearings, grid, octant, column, row)
        listed = wide == 0
        if listed:
            c, shift = leaf(model.cells, grid, column, row)
            wide = high = moves_to_next(model.cells[c])
        left, right = _span(column, shift, wide, octant & 1)
        low, top = _span(row, shift, high, octant & 2)
        after_x = _until_left(drag, grid.x0, grid.unit, left, right, columns, at_x, ux, gx, octant & 1)
        after_y = _until_left(drag, grid.y0, grid.unit, low, top, rows, at_y, uy, gy, octant & 2)
        # The walk goes on to the border, or to where the octant changes, and looks for contacts until then.
        then = min(now + min(after_x, after_y), turn)
        if listed:
            best, feature, more = _fall_scan(
                model, c, radius, x, y, vx, vy, gx, gy, drag, far, last, skipped, tolerance, reference, now, then, best,
                feature,
            )  # fmt: skip
            touched += more if now == 0.0 else 0
        if best <= then or then == NEVER:
            break
        now = then
        at_x, at_y, ux, uy = carried(drag, x, y, vx, vy, gx, gy, now)
        there_x, there_y = place(grid, at_x, at_y)
        there_x = min(max(there_x, left), right - 1)
        there_y = min(max(there_y, low), top - 1)
        # Beyond the border that is passed the number is a whole one; at a turn the ball stays in its cell.
        if now < turn and after_x < after_y:
            there_x = right if octant & 1 == 0 else left - 1
        elif now < turn:
            there_y = top if octant & 2 == 0 else low - 1
        column = max(there_x, column) if octant & 1 == 0 else min(there_x, column)
        row = max(there_y, row) if octant & 2 == 0 else min(there_y, row)
    return best, feature, touched


@kernel
def _fall_scan(
    model, c, radius, x, y, vx, vy, gx, gy, drag, far, last, skipped, tolerance, reference, now, until, best, feature
):  # fmt: skip
    """Earliest contact between two times with what one cell lists: (time, feature, edges touched at the start)."""
    cell = model.cells[c]
    touched, more = 0, 0
    if cell.first < cell.arcs:
        best, feature, touched = fall_line(
            model.lines, model.ids, cell.first, cell.arcs, model.one_sided, model.edge_wall, radius,
            x, y, vx, vy, gx, gy, drag, far, last, skipped, tolerance, now, until, best, feature,
        )  # fmt: skip
    if cell.arcs < cell.corners:
        best, feature, more = fall_arcs(
            model.arcs, model.ids, cell.arcs, cell.corners, model.one_sided, model.edge_wall, radius,
            x, y, vx, vy, gx, gy, drag, far, last, skipped, tolerance, reference, now, until, best, feature,
        )  # fmt: skip
    if cell.corners < cell.end and radius > 0.0:  # listed for the discs of a scene; a point meets no corner
        best, feature = fall_corners(
            model.corners, model.ids, cell.corners, cell.end, model.one_sided, model.corner_wall, model.fans,
            radius, x, y, vx, vy, gx, gy, drag, far, last, tolerance, now, until, best, feature,
        )  # fmt: skip
    return best, feature, touched + more


@kernel
def _far(model, drag, x, y, vx, vy, gx, gy):
    """Time after which a ball meets no wall any more; asked for where there is drag alone."""
    if drag is None:
        return NEVER
    return beyond(drag, vx, vy, gx, gy, 4.0 * (abs(x) + abs(y) + model.extent))


@kernel
def _next_turn(grid, drag, vx, vy, gx, gy, now):
    """The first time after now at which the octant of a flight changes, see ``grid.octant_of``."""
    turn = min(standstill(drag, vx, gx, now), standstill(drag, vy, gy, now))
    # Octants change too where |vx| = |vy|.
    if grid.octants == OCTANTS:
        turn = min(turn, min(standstill(drag, vx - vy, gx - gy, now), standstill(drag, vx + vy, gx + gy, now)))
    return turn


@kernel
def _way_between(drag, vx, vy, gx, gy, now, turn):
    """The octant of a flight between two turns, see ``grid.octant_of``."""
    # Signs do not change between two turns: any time between them tells.
    t = 0.5 * (now + turn) if turn < NEVER else 2.0 * now + 1.0
    ux, uy = speed_after(drag, vx, gx, t), speed_after(drag, vy, gy, t)
    return int(ux <= 0.0) + 2 * int(uy <= 0.0) + 4 * int(abs(ux) < abs(uy))


@kernel
def _span(number, shift, count, back):
    """Where a rectangle ``count`` cells long, which begins with that of a column (or row), begins and ends, in units.

    It goes the way of the flight: to lower numbers if ``back``.
    """
    # Backwards the rectangle ends with this cell's right border.
    cell = number >> shift
    if back != 0:
        return (cell + 1 - count) << shift, (cell + 1) << shift
    return cell << shift, (cell + count) << shift


@kernel
def _until_left(drag, origin, unit, first, end, count, p, u, a, back):
    """How long a coordinate takes to leave what lies from first to end, at the end to which the flight goes.

    Ahead lies d = u t + a t^2 / 2 with speed u >= 0: t = 2 d / (u + sqrt(u^2 + 2 a d)), or never if it turns before.
    """
    if back == 0:
        if end >= count:
            return NEVER
        d = (origin + end * unit) - p
    else:
        if first <= 0:
            return NEVER
        d, u, a = p - (origin + first * unit), -u, -a
    if d <= 0.0:
        return 0.0
    if drag is not None:
        return time_to_border(drag, max(u, 0.0), a, d)
    if a == 0.0:
        return d / u if u > 0.0 else NEVER
    u = max(u, 0.0)
    # u t + a t^2 / 2 = d has the root 2 d / (u + sqrt(u^2 + 2 a d)), which loses no digits as a vanishes.
    square = u * u + 2.0 * a * d
    if square < 0.0:
        return NEVER
    faster = u + math.sqrt(square)
    return 2.0 * d / faster if faster > 0.0 else NEVER
