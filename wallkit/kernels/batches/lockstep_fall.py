"""Lockstep under gravity: parabolas against lines, hulls of flights against corners, and the pass of the bounces.

The formulas are those of ``gravity_impact``, ``gravity`` and ``motion``, term by term. A pass goes on with balls whose
contact is as plain as nearly all are: it approaches, and throws the ball off by far more than rounding, with most of
its speed. All others, and those that a wall holds, are left to ``flight.fly``, bounce by bounce.
"""

from __future__ import annotations

import math

from wallkit.kernels.batches.lockstep_lanes import (
    ALONE,
    ASK,
    AX,
    AY,
    BEFORE,
    BEST,
    BOUNCES,
    ENDING,
    ENERGY,
    FAR,
    FROM_VX,
    FROM_VY,
    FROM_X,
    FROM_Y,
    HELD,
    HIGH_Y,
    HOLD,
    LANES,
    LAST,
    LEFT_X,
    LENGTH,
    LOST,
    LOW_Y,
    MANY,
    MOST,
    NONE,
    NX,
    NY,
    QX,
    QY,
    RIGHT_X,
    ROW,
    RX,
    RY,
    SIDE,
    STILL,
    TIME,
    TOLERANCE,
    TWICE,
    VX,
    VY,
    X,
    Y,
    feature_of,
    is_one_way,
)
from wallkit.kernels.batches.lockstep_straight import WIDER, turned
from wallkit.kernels.flight.flight import still_limit
from wallkit.kernels.flight.joints import AT_VERTEX
from wallkit.kernels.impact.gravity_impact import fall_corners, hull_of, strays
from wallkit.kernels.impact.leaving import LEVEL_SPEED
from wallkit.kernels.impact.line_impact import slack_of
from wallkit.kernels.impact.polynomial_roots import NEVER, fall_after_rise, first_fall_quadratic
from wallkit.kernels.intrinsics import lowest
from wallkit.kernels.jit import kernel, pass_kernel
from wallkit.kernels.records import BOUNCE_LIMIT, FREE, LEFT_SCENE, RUNNING, TIME_REACHED

SMALL = 2.0**-20
"""Far beyond all rounding in the look for what may be met: that look may only save work, never decide."""


@kernel
def ask_falling(model, gravity, radius, s, flying):
    """Find what each ball meets first; as ``parabola_walk.fall_search`` without a grid."""
    lines, rows = model.cells[0].corners, model.cells[0].end
    for k in range(lines):
        line = model.lines[model.ids[k]]
        one_way = is_one_way(model.one_sided, model.edge_wall[model.ids[k]])
        left = _pass_line(s, float(k), line, one_way, gravity, radius)
        while left != 0:
            i = lowest(left)
            left &= left - 1
            _ask_far_side(s, i, float(k), line, gravity, radius)
    # Lines first: corners are asked only where they may be met before what is found by then.
    if radius is not None:
        _outline(s, gravity, radius)
        for k in range(lines, rows):
            _pass_corner(s, float(k), model.corners[model.ids[k]])
        for i in range(flying):
            if s[ASK + i] > 0.0:
                _answer_disc(model, gravity, radius, s, i)
                s[ASK + i] = 0.0


@pass_kernel
def _pass_line(s, row, line, one_way, gravity, radius):
    """Let the near side of a line ask all balls, as ``fall_line`` does: bits of those that may meet the far side."""
    ax, ay, nx, ny, length = line.ax, line.ay, line.nx, line.ny, line.length
    gx, gy = gravity[0], gravity[1]
    gn, gu = gx * nx + gy * ny, gy * nx - gx * ny
    r = 0.0 if radius is None else radius
    beside = 0
    for i in range(LANES):
        vx, vy, best = s[VX + i], s[VY + i], s[BEST + i]
        ex, ey, slack = s[X + i] - ax, s[Y + i] - ay, slack_of(s[TOLERANCE + i], r)
        # Across the edge the centre is at d + vn t + gn t^2 / 2, along it at u + vu t + gu t^2 / 2.
        d, vn = ex * nx + ey * ny, vx * nx + vy * ny
        u, vu = ey * nx - ex * ny, vy * nx - vx * ny
        above = d > 0.0
        if radius is None:
            tolerance = s[TOLERANCE + i]
            near = (abs(d) <= tolerance) & (u >= -tolerance) & (u <= length + tolerance)
            s[ASK + i] = 1.0 if near & (s[LAST + i] != row) else s[ASK + i]
            leaves = vn > 0.0 if abs(vn) > LEVEL_SPEED * (abs(vx) + abs(vy)) else gn < 0.0
            above = leaves if near else above
        side = 1.0 if above else -1.0
        t = first_fall_quadratic(0.5 * (side * gn), side * vn, side * d - r, math.inf)
        solid = above | (not one_way)
        if one_way:
            t = fall_after_rise(0.5 * gn, vn, d - r) if side * d - r < -slack else t
        foot = u + t * (vu + 0.5 * t * gu)
        there = (foot >= -slack) & (foot <= length + slack)
        in_time = solid & (t <= best)
        met = in_time & there & (t < best)
        s[BEST + i] = t if met else best
        s[ROW + i] = row if met else s[ROW + i]
        far = (in_time & (not there) & (not one_way)) | (not solid)
        far = far & _may_come_back(-0.5 * side * gn, -side * vn, -side * d - r, s[BEST + i])
        s[FAR + i] = side
        beside |= int(far) << i
    return beside


@kernel
def _may_come_back(a, b, c, best):
    """Tell whether a t^2 + b t + c may rise above 0 and fall through it before ``best``: give or take much rounding.

    It turns down (a < 0 < b), above 0 (b^2 > 4 a c) and in time (at b / -2 a), and is below 0 by then.
    """
    by_then, size = (a * best + b) * best + c, (abs(a) * best + abs(b)) * best + abs(c)
    above = b * b - 4.0 * a * c > 0.0
    return (a < 0.0) & (b > 0.0) & above & (b <= -2.0 * WIDER * a * best) & (by_then <= SMALL * size)


@kernel
def _ask_far_side(s, i, row, line, gravity, radius):
    """Let the far side of a line ask a ball, as ``fall_line`` does."""
    gx, gy, nx, ny, side = gravity[0], gravity[1], line.nx, line.ny, s[FAR + i]
    r = 0.0 if radius is None else radius
    vx, vy, slack = s[VX + i], s[VY + i], slack_of(s[TOLERANCE + i], r)
    ex, ey = s[X + i] - line.ax, s[Y + i] - line.ay
    d, vn, gn = ex * nx + ey * ny, vx * nx + vy * ny, gx * nx + gy * ny
    u, vu, gu = ey * nx - ex * ny, vy * nx - vx * ny, gy * nx - gx * ny
    t = fall_after_rise(-0.5 * side * gn, -side * vn, -side * d - r)
    foot = u + t * (vu + 0.5 * t * gu)
    if t < s[BEST + i] and -slack <= foot <= line.length + slack:
        s[BEST + i], s[ROW + i] = t, row


@pass_kernel
def _outline(s, gravity, radius):
    """Find the hull of each disc's flight until the contact that it has found, and the box of that."""
    for i in range(LANES):
        px, py, tolerance = s[X + i], s[Y + i], s[TOLERANCE + i]
        _px, _py, qx, qy, rx, ry, margin, size = hull_of(
            None, px, py, s[VX + i], s[VY + i], gravity[0], gravity[1], 0.0, s[BEST + i], tolerance
        )
        left, right = px if px < qx else qx, px if px > qx else qx
        low, high = py if py < qy else qy, py if py > qy else qy
        s[LEFT_X + i], s[RIGHT_X + i] = left if left < rx else rx, right if right > rx else rx
        s[LOW_Y + i], s[HIGH_Y + i] = low if low < ry else ry, high if high > ry else ry
        s[QX + i], s[QY + i], s[RX + i], s[RY + i] = qx, qy, rx, ry
        s[MOST + i] = radius * radius + margin * (4.0 * radius + size)
        s[ASK + i] = 0.0 if size < math.inf else 2.0 * MANY  # a flight without end may meet all


@pass_kernel
def _pass_corner(s, row, corner):
    """Note which discs may meet a corner before what they have found, by the hull of their flights: ``fall_corners``.

    That is the box of a hull, and the strip of ``strays``.
    """
    cx, cy = corner.x, corner.y
    for i in range(LANES):
        left, right, low, high = s[LEFT_X + i] - cx, cx - s[RIGHT_X + i], s[LOW_Y + i] - cy, cy - s[HIGH_Y + i]
        off_x, off_y = left if left > right else right, low if low > high else high
        off_x, off_y = off_x if off_x > 0.0 else 0.0, off_y if off_y > 0.0 else 0.0
        most = s[MOST + i]
        may = off_x * off_x + off_y * off_y <= most
        may = may & (not strays(s[X + i], s[Y + i], s[QX + i], s[QY + i], s[RX + i], s[RY + i], cx, cy, most))
        s[ASK + i] = s[ASK + i] + (MANY + row) if may else s[ASK + i]


@kernel
def _answer_disc(model, gravity, radius, s, i):
    """Ask the corner that a disc may meet, or all if there are more."""
    first, stop = int(model.cells[0].corners), int(model.cells[0].end)
    # One corner alone adds MANY and its row; two or more come to 2 MANY, and all are asked.
    if s[ASK + i] < 2.0 * MANY:
        first = int(s[ASK + i] - MANY)
        stop = first + 1
    px, py, qx, qy, rx, ry, most = s[X + i], s[Y + i], s[QX + i], s[QY + i], s[RX + i], s[RY + i], s[MOST + i]
    # Both halves of the flight have hulls of their own, a quarter as wide.
    ax, ay, bx, by = 0.5 * (px + qx), 0.5 * (py + qy), 0.5 * (qx + rx), 0.5 * (qy + ry)
    mx, my = 0.5 * (ax + bx), 0.5 * (ay + by)
    for k in range(first, stop):
        corner = model.corners[model.ids[k]]
        cx, cy = corner.x, corner.y
        if _keeps_off(px, py, ax, ay, mx, my, cx, cy, most) and _keeps_off(mx, my, bx, by, rx, ry, cx, cy, most):
            continue
        last, feature = feature_of(model, s[LAST + i]), feature_of(model, s[ROW + i])
        s[BEST + i], feature = fall_corners(
            model.corners, model.ids, k, k + 1, model.one_sided, model.corner_wall, model.fans, radius,
            s[X + i], s[Y + i], s[VX + i], s[VY + i], gravity[0], gravity[1], None, NEVER, last, s[TOLERANCE + i],
            0.0, NEVER, s[BEST + i], feature,
        )  # fmt: skip
        if feature == -2 - int(model.ids[k]):
            s[ROW + i] = float(k)


@kernel
def _keeps_off(px, py, qx, qy, rx, ry, cx, cy, most):
    """Tell whether a part of a flight with this hull keeps farther than the root of ``most`` from a corner."""
    if strays(px, py, qx, qy, rx, ry, cx, cy, most):
        return True
    return least_of(px - cx, py - cy, qx - cx, qy - cy, rx - cx, ry - cy) > most


@kernel
def least_of(ax, ay, bx, by, cx, cy):
    """Lower bound of w.w on the Bezier curve of w through a, b and c: the least coefficient of its quartic."""
    # a.a, a.b, (a.c + 2 b.b) / 3, b.c, c.c, see ``gravity_impact``.
    first, second, last = ax * ax + ay * ay, ax * bx + ay * by, cx * cx + cy * cy
    third, fourth = (ax * cx + ay * cy + 2.0 * (bx * bx + by * by)) / 3.0, bx * cx + by * cy
    first, last = first if first < second else second, fourth if fourth < last else last
    first = first if first < third else third
    return first if first < last else last


@pass_kernel
def bounce_falling(model, gravity, s, radius, until, limit):
    """Move every ball, turn its velocity where it meets something, and tell which have ended; as ``flight.fly``."""
    lines, most_still = float(model.cells[0].corners), float(still_limit(model.restitution))
    gx, gy = gravity[0], gravity[1]
    pull = abs(gx) + abs(gy)
    for i in range(LANES):
        x, y, vx, vy, t, row = s[X + i], s[Y + i], s[VX + i], s[VY + i], s[BEST + i], s[ROW + i]
        time, lost, energy, tolerance = s[TIME + i], s[LOST + i], s[ENERGY + i], s[TOLERANCE + i]
        # Selects in place of branches, term by term as in ``flight.fly``.
        moves, total = t > 0.0, s[TIME + i] + t
        rest = (time - total) + t if time >= t else (t - total) + time
        new_time, new_lost = total if moves else time, lost + rest if moves else lost
        new_x = x + t * (vx + 0.5 * t * gx) if moves else x
        new_y = y + t * (vy + 0.5 * t * gy) if moves else y
        new_vx, new_vy = vx + t * gx if moves else vx, vy + t * gy if moves else vy
        passes = (new_time + t > new_time) & (t * (abs(new_vx) + abs(new_vy)) > tolerance * 2.0**-6)
        still = 0.0 if passes else s[STILL + i] + 1.0
        nx, ny, twice, above = s[NX + i], s[NY + i], s[TWICE + i], True
        inner = True
        if radius is None:
            above = new_vx * nx + new_vy * ny <= 0.0
            # Near an end of the line ``fly`` asks the vertex: here somewhat farther from it than there.
            along = (new_y - s[AY + i]) * nx - (new_x - s[AX + i]) * ny
            near = 2.0 * AT_VERTEX * tolerance
            inner = (along > near) & (along < s[LENGTH + i] - near)
        else:
            # The row of a corner holds its place: the normal goes from there to the centre.
            at_corner = row >= lines
            above = at_corner | ((new_x - s[AX + i]) * nx + (new_y - s[AY + i]) * ny >= 0.0)
            nx, ny = new_x - nx if at_corner else nx, new_y - ny if at_corner else ny
            twice = 2.0 / (nx * nx + ny * ny) if at_corner else twice
        nx, ny = nx if above else -nx, ny if above else -ny
        into, height = new_vx * nx + new_vy * ny, 2.0 * (gx * new_x + gy * new_y)
        wx, wy, square, dead = turned(model.restitution, s, i, nx, ny, twice, new_vx, new_vy, energy + height)
        away, length = wx * nx + wy * ny, nx * nx + ny * ny
        rounding, speed = LEVEL_SPEED * (abs(wx) + abs(wy)), LEVEL_SPEED * (abs(new_vx) + abs(new_vy))
        # Four times what ``held_after`` and ``facing`` go by, and without their roots: those decide about what is less.
        throws = (away > 0.0) & (away * away > 4.0 * pull * tolerance * length)
        throws = throws & (away * away > 4.0 * rounding * rounding * length)
        comes = (into < 0.0) & (into * into > 4.0 * speed * speed * length)
        free = (s[HOLD + i] == float(FREE)) & (s[ASK + i] == 0.0)
        plain = throws & comes & (energy + height > 0.0) & (not dead) & (still <= most_still)
        hit, late = free & plain & inner & (row >= 0.0), free & (row == NONE)
        flies = moves & (hit | (late & (until < math.inf)))
        if radius is None:
            s[FROM_X + i], s[FROM_Y + i] = x if flies else s[FROM_X + i], y if flies else s[FROM_Y + i]
            s[FROM_VX + i], s[FROM_VY + i] = vx if flies else s[FROM_VX + i], vy if flies else s[FROM_VY + i]
        time, lost = new_time if flies else time, new_lost if flies else lost
        time, lost = until if late & flies else time, 0.0 if late & flies else lost
        s[X + i], s[Y + i], s[TIME + i], s[LOST + i] = new_x if flies else x, new_y if flies else y, time, lost
        vx, vy = new_vx if flies else vx, new_vy if flies else vy
        s[VX + i], s[VY + i], s[ENERGY + i] = wx if hit else vx, wy if hit else vy, square - height if hit else energy
        bounces, last = s[BOUNCES + i] + 1.0 if hit else s[BOUNCES + i], s[LAST + i]
        s[BEFORE + i] = last if hit & (last != row) else s[BEFORE + i]
        s[LAST + i], s[HELD + i] = row if hit else last, row if hit else s[HELD + i]
        s[SIDE + i] = (1.0 if above else -1.0) if hit else s[SIDE + i]
        s[BOUNCES + i], s[STILL + i] = bounces, still if hit else s[STILL + i]
        ending = float(BOUNCE_LIMIT) if bounces >= limit else float(RUNNING)
        open_end = float(LEFT_SCENE) if until == math.inf else float(TIME_REACHED)
        s[ENDING + i] = open_end if late else (ending if hit else ALONE)
        s[BEST + i], s[ROW + i], s[ASK + i] = (until - time) - lost, NONE, 0.0
