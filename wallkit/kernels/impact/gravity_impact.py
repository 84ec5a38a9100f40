"""Time of impact under gravity: parabolas against lines, corners and arcs, and their way through the grid.

A gap that falls through zero is a contact; ``roots`` finds when. A ball may meet both sides of one wall in one flight
(up past its end, and down on it), so each side is asked; from behind, the gap must rise above zero before it falls.
Where a contact counts only on part of a line or circle, the parts overlap by the rounding of positions.
"""

from __future__ import annotations

import math

from wallkit.kernels.impact.arc_impact import FALLING_MOULD, holds
from wallkit.kernels.impact.line_impact import behind, precedes, slack_of
from wallkit.kernels.impact.polynomial_roots import NEVER, first_fall_quadratic, first_fall_quartic
from wallkit.kernels.index.grid import around, leaf, moves_to_next, place
from wallkit.kernels.jit import kernel, rare_kernel

LEVEL_SPEED = 2.0**-40
"""A smaller part of the speed, towards a wall or from it, may be rounding: that of v + g t and of a product with n."""


@rare_kernel
def fall_line(
    lines, ids, start, stop, one_sided, edge_wall, radius, x, y, vx, vy, gx, gy, last, skipped, tolerance, best, feature
):
    """Earliest contact with the lines of entries start to stop: +-(d + vn t + gn t^2 / 2) - r falls through 0.

    ``skipped`` is the line on which the ball slides or has just slid.

    Returns:
        (time, feature, number of other lines that a point touches where it starts).
    """
    touched = 0
    slack = slack_of(tolerance, radius)
    noise = LEVEL_SPEED * (abs(vx) + abs(vy))
    for k in range(start, stop):
        if ids[k] == skipped:
            continue
        line = lines[ids[k]]
        ex, ey = x - line.ax, y - line.ay
        nx, ny = line.nx, line.ny
        d, vn, gn = ex * nx + ey * ny, vx * nx + vy * ny, gx * nx + gy * ny
        u, vu, gu = ey * nx - ex * ny, vy * nx - vx * ny, gy * nx - gx * ny
        above = d > 0.0
        if radius == 0.0 and abs(d) <= tolerance and -tolerance <= u <= line.length + tolerance:
            touched += 1 if ids[k] != last else 0
            above = vn > 0.0 if abs(vn) > noise else gn < 0.0  # pressed on it, it lies on it
        for turn in range(2):
            side = 1.0 if turn == 0 else -1.0
            if side < 0.0 and one_sided is not None:
                if one_sided[edge_wall[ids[k]]] != 0:
                    continue
            t = _fall_of_side(0.5 * side * gn, side * vn, side * d - radius, above != (side > 0.0))
            if not (t < best or (t == best and precedes(ids[k], feature))):
                continue
            foot = u + t * (vu + 0.5 * t * gu)
            if -slack <= foot <= line.length + slack:
                best, feature = t, ids[k]
    return best, feature, touched


@kernel
def _fall_of_side(a, b, c, from_behind):
    """First fall of a t^2 + b t + c through 0; from behind (below 0 now) only after it has risen."""
    if not from_behind:
        return first_fall_quadratic(a, b, c, math.inf)
    if a >= 0.0 or b <= 0.0:
        return NEVER
    discriminant = b * b - 4.0 * a * c
    if discriminant <= 0.0:
        return NEVER
    return -0.5 * (b + math.sqrt(discriminant)) / a


@rare_kernel
def _fall_after(c4, c3, c2, c1, c0, time, from_behind):
    """First fall of a quartic through 0 at or after a time; from behind only after it has risen above 0."""
    for turn in range(2):
        f0 = (((c4 * time + c3) * time + c2) * time + c1) * time + c0
        f1 = ((4.0 * c4 * time + 3.0 * c3) * time + 2.0 * c2) * time + c1
        f2 = (6.0 * c4 * time + 3.0 * c3) * time + c2
        f3 = 4.0 * c4 * time + c3
        if turn == 0 and from_behind:
            t = first_fall_quartic(-c4, -f3, -f2, -f1, -f0, math.inf)
            if t == NEVER:
                return NEVER
            time += t
        elif turn == 1 or not from_behind:
            t = first_fall_quartic(c4, f3, f2, f1, f0, math.inf)
            return time + t if t < NEVER else NEVER
    return NEVER


@rare_kernel
def fall_corners(corners, ids, start, stop, one_sided, corner_wall, radius, x, y, vx, vy, gx, gy, best, feature):
    """Earliest contact of a disc with the corners of entries start to stop: |e + v t + g t^2 / 2|^2 - r^2 falls."""
    for k in range(start, stop):
        corner = corners[ids[k]]
        ex, ey = x - corner.x, y - corner.y
        t = _fall_after(
            0.25 * (gx * gx + gy * gy),
            vx * gx + vy * gy,
            vx * vx + vy * vy + ex * gx + ey * gy,
            2.0 * (ex * vx + ey * vy),
            ex * ex + ey * ey - radius * radius,
            0.0,
            False,
        )
        if not (t < best or (t == best and precedes(-2 - ids[k], feature))):
            continue
        if one_sided is not None:
            if one_sided[corner_wall[ids[k]]] != 0 and behind(
                corner, ex + t * (vx + 0.5 * t * gx), ey + t * (vy + 0.5 * t * gy)
            ):
                continue
        best, feature = t, -2 - ids[k]
    return best, feature


@kernel
def _polished(t, limit, ex, ey, vx, vy, gx, gy):
    """One Newton step for |e(t)|^2 = limit^2, from places instead of coefficients.

    The coefficients of the quartic carry the rounding of (|v| t + g t^2 / 2)^2, the places that of |v| t + g t^2 / 2.
    Grazing, where the step is no longer small, the root has no better digits to give.
    """
    px, py = ex + t * (vx + 0.5 * t * gx), ey + t * (vy + 0.5 * t * gy)
    slope = 2.0 * (px * (vx + t * gx) + py * (vy + t * gy))
    gap = px * px + py * py - limit * limit
    if abs(gap) > t * 2.0**-20 * abs(slope) or slope == 0.0:
        return t
    return t - gap / slope


@rare_kernel
def fall_arcs(
    arcs, ids, start, stop, one_sided, edge_wall, radius, x, y, vx, vy, gx, gy, last, tolerance, reference,
    best, feature,
):  # fmt: skip
    """Earliest contact with the arcs of entries start to stop: |e(t)|^2 - (R + r)^2 or (R - r)^2 - |e(t)|^2 falls.

    ``reference`` is the normal, towards the ball, of the line on which a point slides or has just slid, or zero: a
    point that comes smoothly onto an arc is on that side of it.

    Returns:
        (time, feature, number of other arcs that a point touches where it starts).
    """
    touched = 0
    if arcs is None:
        return best, feature, touched
    slack = slack_of(tolerance, radius)
    c4, c3 = 0.25 * (gx * gx + gy * gy), vx * gx + vy * gy
    noise = LEVEL_SPEED * (abs(vx) + abs(vy))
    for k in range(start, stop):
        arc = arcs[ids[k]]
        wx, wy = x - arc.ax, y - arc.ay
        ex, ey = wx + arc.sx, wy + arc.sy
        power = wx * (wx + 2.0 * arc.sx) + wy * (wy + 2.0 * arc.sy)
        c2, c1 = vx * vx + vy * vy + ex * gx + ey * gy, 2.0 * (ex * vx + ey * vy)
        outside = power >= 0.0
        if radius == 0.0 and abs(power) <= (2.0 * arc.radius + tolerance) * tolerance and holds(arc, ex, ey, tolerance):
            touched += 1 if ids[k] != last else 0
            along = ex * reference[0] + ey * reference[1]
            outside = c1 > 0.0 if abs(c1) > 2.0 * arc.radius * noise else c2 < 0.0
            if along != 0.0:
                outside = along > 0.0
        for turn in range(2):
            side = 1.0 if turn == 0 else -1.0
            reach, mould = arc.radius + side * radius, FALLING_MOULD * arc.radius
            if reach <= -mould:
                continue
            if one_sided is not None:
                if one_sided[edge_wall[ids[k]]] != 0 and side * arc.sweep < 0.0:
                    continue
            c0 = side * power - radius * (2.0 * arc.radius + side * radius)
            from_behind = outside != (side > 0.0)
            if reach < mould:
                reach = mould
                c0 = reach * reach - (ex * ex + ey * ey)
                from_behind = c0 < 0.0
            t = _fall_after(side * c4, side * c3, side * c2, side * c1, c0, 0.0, from_behind)
            if 0.0 < t < NEVER:
                t = _polished(t, reach, ex, ey, vx, vy, gx, gy)
            for _again in range(2):
                if not (t < best or (t == best and precedes(ids[k], feature))):
                    break
                if (t > 0.0 or ids[k] != last) and holds(
                    arc, ex + t * (vx + 0.5 * t * gx), ey + t * (vy + 0.5 * t * gy), slack
                ):
                    best, feature = t, ids[k]
                    break
                t = _fall_after(side * c4, side * c3, side * c2, side * c1, c0, t, True)
    return best, feature, touched


@kernel
def fall_scan(model, c, radius, x, y, vx, vy, gx, gy, last, skipped, tolerance, reference, best, feature):
    """Earliest contact with what one cell lists: (time, feature, edges touched by a point where it starts)."""
    cell = model.cells[c]
    best, feature, touched = fall_line(
        model.lines, model.ids, cell.first, cell.arcs,
        model.one_sided, model.edge_wall, radius, x, y, vx, vy, gx, gy, last, skipped, tolerance, best, feature,
    )  # fmt: skip
    best, feature, more = fall_arcs(
        model.arcs, model.ids, cell.arcs, cell.corners,
        model.one_sided, model.edge_wall, radius, x, y, vx, vy, gx, gy, last, tolerance, reference, best, feature,
    )  # fmt: skip
    best, feature = fall_corners(
        model.corners, model.ids, cell.corners, cell.end,
        model.one_sided, model.corner_wall, radius, x, y, vx, vy, gx, gy, best, feature,
    )  # fmt: skip
    return best, feature, touched + more


@kernel
def fall_search(model, grid, radius, x, y, vx, vy, gx, gy, last, skipped, tolerance, reference, best, feature):
    """Find the earliest contact before ``best``: (time, feature, edges touched by a point where it starts).

    The cells at the grid's border reach on without end, so a ball that leaves the grid is followed back into it. A
    coordinate of a parabola passes each border at most twice.
    """
    if grid is None:
        return fall_scan(model, 0, radius, x, y, vx, vy, gx, gy, last, skipped, tolerance, reference, best, feature)
    column, row = place(grid, x, y)
    columns, rows = grid.columns << grid.shift, grid.rows << grid.shift
    touched = 0
    now = 0.0
    for _step in range(2 * (columns + rows) + 8):
        c, shift = leaf(model.cells, grid, column, row)
        best, feature, more = fall_scan(
            model, c, radius, x, y, vx, vy, gx, gy, last, skipped, tolerance, reference, best, feature,
        )  # fmt: skip
        if now == 0.0:
            touched += more
        moves = moves_to_next(model.cells[c])
        left, right = around(moves, shift, column, columns)
        low, high = around(moves, shift, row, rows)
        next_column, time_x = _leaving(grid.x0, grid.unit, left, right, columns, x, vx, gx, now)
        next_row, time_y = _leaving(grid.y0, grid.unit, low, high, rows, y, vy, gy, now)
        passed = min(time_x, time_y)
        if passed == NEVER or best <= now + passed:
            break
        now += passed
        then_column, then_row = place(grid, x + now * (vx + 0.5 * now * gx), y + now * (vy + 0.5 * now * gy))
        if time_x < time_y:
            column, row = next_column, min(max(then_row, low), high - 1)
        else:
            column, row = min(max(then_column, left), right - 1), next_row
    return best, feature, touched


@kernel
def _leaving(origin, unit, first, end, count, p, v, g, now):
    """How long after ``now`` a coordinate leaves what lies from first to end, and where to: (column or row, time)."""
    p_now, v_now = p + now * (v + 0.5 * now * g), v + now * g
    up, down = NEVER, NEVER
    if end < count:
        up = first_fall_quadratic(-0.5 * g, -v_now, origin + end * unit - p_now, math.inf)
    if first > 0:
        down = first_fall_quadratic(0.5 * g, v_now, p_now - (origin + first * unit), math.inf)
    return (end, up) if up < down else (first - 1, down)
