"""Time of impact under gravity: parabolas against lines, corners and arcs, and their way through the grid.

A gap that falls through zero is a contact; ``roots`` finds when. A ball may meet both sides of one wall in one flight
(up past its end, and down on it), so each side is asked; from behind, the gap must rise above zero before it falls.
Where a contact counts only on part of a line or circle, the parts overlap by the rounding of positions.

Most of what a cell lists is not met, and mostly its *hull* shows that: a part of a parabola is a Bezier curve, and a
linear form of the place lies between those of its three points, a quadratic one between five made of them. That look
may only save work, never decide: it keeps off all that is within rounding.
"""

from __future__ import annotations

import math

from wallkit.kernels.arcs import FALLING_MOULD, is_wide, to_end
from wallkit.kernels.impact import behind, precedes, slack_of
from wallkit.kernels.jit import kernel, rare_kernel
from wallkit.kernels.roots import NEVER, first_fall_quadratic, first_fall_quartic

LEVEL_SPEED = 2.0**-40
"""A smaller part of the speed, towards a wall or from it, may be rounding: that of v + g t and of a product with n."""
SMOOTH_ON = 1.0 - 2.0**-20
"""Cosine between the normals of a line and of an arc on to which a point slides smoothly: they differ by some 2^-10."""
HULL_ROUNDING = 2.0**-45
"""Of the size of a hull, beyond the rounding of its points and of what is made of them."""


@kernel
def hull_of(x, y, vx, vy, gx, gy, start, stop, tolerance):
    """Give the hull of a flight between two times: (px, py, qx, qy, rx, ry, margin, size).

    It begins at p and ends at r, and its tangents there meet in q. What is within ``margin`` may be met.
    """
    ux, uy = vx + start * gx, vy + start * gy
    half = 0.5 * (stop - start)
    px, py = x + start * (vx + 0.5 * start * gx), y + start * (vy + 0.5 * start * gy)
    qx, qy = px + half * ux, py + half * uy
    rx, ry = qx + half * (ux + 2.0 * half * gx), qy + half * (uy + 2.0 * half * gy)
    size = abs(px) + abs(py) + abs(qx) + abs(qy) + abs(rx) + abs(ry)
    return px, py, qx, qy, rx, ry, tolerance + HULL_ROUNDING * size, size


@rare_kernel
def fall_line(
    lines, ids, start, stop, one_sided, edge_wall, radius, x, y, vx, vy, gx, gy, last, skipped, tolerance, now, until,
    best, feature,
):  # fmt: skip
    """Earliest contact with the lines of entries start to stop: +-(d + vn t + gn t^2 / 2) - r falls through 0.

    ``skipped`` is the line on which the ball slides or has just slid. Contacts before ``now`` or after ``until`` are
    found in other cells.

    Returns:
        (time, feature, number of other lines that a point touches where it starts).
    """
    touched = 0
    slack = slack_of(tolerance, radius)
    noise = LEVEL_SPEED * (abs(vx) + abs(vy))
    hull = hull_of(x, y, vx, vy, gx, gy, now, min(best, until), tolerance)
    for k in range(start, stop):
        if ids[k] == skipped:
            continue
        line = lines[ids[k]]
        nx, ny = line.nx, line.ny
        if _keeps_off(line, hull, radius, slack):
            continue
        ex, ey = x - line.ax, y - line.ay
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
                hull = hull_of(x, y, vx, vy, gx, gy, now, min(best, until), tolerance)
    return best, feature, touched


@rare_kernel
def _keeps_off(line, hull, radius, slack):
    """Tell whether all of a hull lies farther from a line than the radius, on one side, or beside it."""
    px, py, qx, qy, rx, ry, margin, _size = hull
    nx, ny, reach = line.nx, line.ny, radius + margin
    ax, ay = px - line.ax, py - line.ay
    bx, by = qx - line.ax, qy - line.ay
    cx, cy = rx - line.ax, ry - line.ay
    p, q, r = ax * nx + ay * ny, bx * nx + by * ny, cx * nx + cy * ny
    if (p > reach and q > reach and r > reach) or (p < -reach and q < -reach and r < -reach):
        return True
    p, q, r = ay * nx - ax * ny, by * nx - bx * ny, cy * nx - cx * ny
    low, high = -slack - margin, line.length + slack + margin
    return (p < low and q < low and r < low) or (p > high and q > high and r > high)


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
def _range_of(ax, ay, bx, by, cx, cy, sx, sy):
    """Bounds of w.w + 2 s.w on the Bezier curve of w through a, b and c: of the five coefficients of its quartic."""
    a, b, c = sx * ax + sy * ay, sx * bx + sy * by, sx * cx + sy * cy
    first, second = ax * ax + ay * ay + 2.0 * a, ax * bx + ay * by + a + b
    third = (ax * cx + ay * cy + a + c + 2.0 * (bx * bx + by * by + 2.0 * b)) / 3.0
    fourth, fifth = bx * cx + by * cy + b + c, cx * cx + cy * cy + 2.0 * c
    return (
        min(min(min(first, second), min(fourth, fifth)), third),
        max(max(max(first, second), max(fourth, fifth)), third),
    )


@rare_kernel
def fall_corners(
    corners, ids, start, stop, one_sided, corner_wall, radius, x, y, vx, vy, gx, gy, tolerance, now, until,
    best, feature,
):  # fmt: skip
    """Earliest contact of a disc with the corners of entries start to stop: |e + v t + g t^2 / 2|^2 - r^2 falls."""
    px, py, qx, qy, rx, ry, margin, size = hull_of(x, y, vx, vy, gx, gy, now, min(best, until), tolerance)
    most = radius * radius + margin * (4.0 * radius + size)
    for k in range(start, stop):
        corner = corners[ids[k]]
        cx, cy = corner.x, corner.y
        least, _largest = _range_of(px - cx, py - cy, qx - cx, qy - cy, rx - cx, ry - cy, 0.0, 0.0)
        if least > most:
            continue
        ex, ey = x - cx, y - cy
        c2, c1 = vx * vx + vy * vy + ex * gx + ey * gy, 2.0 * (ex * vx + ey * vy)
        c0, c3 = ex * ex + ey * ey - radius * radius, vx * gx + vy * gy
        t = first_fall_quartic(0.25 * (gx * gx + gy * gy), c3, c2, c1, c0, best, False)
        t = _polished(t, -radius * radius, ex, ey, 0.0, 0.0, vx, vy, gx, gy)
        if not (t < best or (t == best and precedes(-2 - ids[k], feature))):
            continue
        if one_sided is not None:
            if one_sided[corner_wall[ids[k]]] != 0 and behind(
                corner, ex + t * (vx + 0.5 * t * gx), ey + t * (vy + 0.5 * t * gy)
            ):
                continue
        best, feature = t, -2 - ids[k]
    return best, feature


@rare_kernel
def _polished(t, off, wx, wy, sx, sy, vx, vy, gx, gy):
    """One Newton step for w.(w + 2 s) + off = 0 with w(t) = w + v t + g t^2 / 2, from places instead of coefficients.

    The coefficients of the quartic carry the rounding of (|v| t + g t^2 / 2)^2, the places that of |v| t + g t^2 / 2.
    Grazing, where the step is no longer small, the root has no better digits to give.
    """
    if not 0.0 < t < NEVER:
        return t
    px, py = wx + t * (vx + 0.5 * t * gx), wy + t * (vy + 0.5 * t * gy)
    slope = 2.0 * ((px + sx) * (vx + t * gx) + (py + sy) * (vy + t * gy))
    gap = px * (px + 2.0 * sx) + py * (py + 2.0 * sy) + off
    if abs(gap) > t * 2.0**-20 * abs(slope) or slope == 0.0:
        return t
    return t - gap / slope


@rare_kernel
def _beside(arc, wx, wy, slack):
    """Tell whether a place, at w from the start a of an arc, lies in its direction from the centre; as ``holds``.

    With f from the centre to its end b, and d from a to b: s x e = s x w and e x f = (w - d) x f for e = s + w. So
    nothing of the size R cancels where the centre is far.
    """
    fx, fy = to_end(arc)
    ux, uy = wx - (arc.bx - arc.ax), wy - (arc.by - arc.ay)
    least = -slack * arc.radius
    past_a = arc.sx * wy - arc.sy * wx >= least
    before_b = ux * fy - uy * fx >= least
    if is_wide(arc.sweep):
        return past_a or before_b
    return past_a and before_b and (wx + arc.sx) * (arc.sx + fx) + (wy + arc.sy) * (arc.sy + fy) >= least


@rare_kernel
def fall_arcs(
    arcs, ids, start, stop, one_sided, edge_wall, radius, x, y, vx, vy, gx, gy, last, tolerance, reference, now, until,
    best, feature,
):  # fmt: skip
    """Earliest contact with the arcs of entries start to stop: |e(t)|^2 - (R + r)^2 or (R - r)^2 - |e(t)|^2 falls.

    With w from a, the start of the arc, and s from its centre to a, |e|^2 - R^2 is w.(w + 2 s): a nearly straight arc
    is judged as the line is that it comes to.

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
    px, py, qx, qy, rx, ry, margin, size = hull_of(x, y, vx, vy, gx, gy, now, min(best, until), tolerance)
    for k in range(start, stop):
        arc = arcs[ids[k]]
        mould = FALLING_MOULD * arc.radius
        outer = radius * (2.0 * arc.radius + radius)
        inner = -radius * (2.0 * arc.radius - radius)
        if arc.radius - radius < mould:
            inner = -(arc.radius - mould) * (arc.radius + mould)
        near = margin * (4.0 * (arc.radius + radius) + size)
        ax, ay = arc.ax, arc.ay
        least, most = _range_of(px - ax, py - ay, qx - ax, qy - ay, rx - ax, ry - ay, arc.sx, arc.sy)
        if least > outer + near or most < inner - near:
            continue
        wx, wy = x - ax, y - ay
        ex, ey = wx + arc.sx, wy + arc.sy
        power = wx * (wx + 2.0 * arc.sx) + wy * (wy + 2.0 * arc.sy)
        c2, c1 = vx * vx + vy * vy + ex * gx + ey * gy, 2.0 * (ex * vx + ey * vy)
        outside = power >= 0.0
        if (
            radius == 0.0
            and abs(power) <= (2.0 * arc.radius + tolerance) * tolerance
            and _beside(arc, wx, wy, tolerance)
        ):
            touched += 1 if ids[k] != last else 0
            along = ex * reference[0] + ey * reference[1]
            outside = c1 > 0.0 if abs(c1) > 2.0 * arc.radius * noise else c2 < 0.0
            if abs(along) > SMOOTH_ON * arc.radius:
                outside = along > 0.0
        for turn in range(2):
            side = 1.0 if turn == 0 else -1.0
            level = outer if turn == 0 else inner
            from_behind = outside != (side > 0.0)
            if turn == 1 and arc.radius - radius <= -mould:
                continue
            if one_sided is not None:
                if one_sided[edge_wall[ids[k]]] != 0 and side * arc.sweep < 0.0:
                    continue
            if (least > level + near) if turn == 0 else (most < level - near):
                continue
            if turn == 1 and arc.radius - radius < mould:
                from_behind = power > level
            if from_behind and ((most < level - near) if turn == 0 else (least > level + near)):
                continue
            c0 = side * (power - level)
            t = first_fall_quartic(side * c4, side * c3, side * c2, side * c1, c0, best, from_behind)
            t = _polished(t, -level, wx, wy, arc.sx, arc.sy, vx, vy, gx, gy)
            for _again in range(2):
                if not (t < best or (t == best and precedes(ids[k], feature))):
                    break
                if (t > 0.0 or ids[k] != last) and _beside(
                    arc, wx + t * (vx + 0.5 * t * gx), wy + t * (vy + 0.5 * t * gy), slack
                ):
                    best, feature = t, ids[k]
                    px, py, qx, qy, rx, ry, margin, size = hull_of(
                        x, y, vx, vy, gx, gy, now, min(best, until), tolerance
                    )
                    break
                t = _fall_after(side * c4, side * c3, side * c2, side * c1, c0, t, best)
                t = _polished(t, -level, wx, wy, arc.sx, arc.sy, vx, vy, gx, gy)
    return best, feature, touched


@rare_kernel
def _fall_after(c4, c3, c2, c1, c0, time, t_max):
    """The next fall of a quartic through 0 after one at a time, before which it rises above 0."""
    f0 = (((c4 * time + c3) * time + c2) * time + c1) * time + c0
    f1 = ((4.0 * c4 * time + 3.0 * c3) * time + 2.0 * c2) * time + c1
    f2 = (6.0 * c4 * time + 3.0 * c3) * time + c2
    f3 = 4.0 * c4 * time + c3
    return time + first_fall_quartic(c4, f3, f2, f1, f0, t_max, True)
