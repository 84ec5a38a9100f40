"""Time of impact under gravity: parabolas against lines, corners and arcs, and their way through the grid.

A gap that falls through zero is a contact; ``polynomial_roots`` finds when. A ball may meet both sides of one wall in
one flight (up past its end, and down on it), so each side is asked; from behind, the gap must rise above zero before it
falls. Where a contact counts only on part of a line or circle, the parts overlap by the rounding of positions.

Most of what a cell lists is not met, and mostly the *hull* of the flight shows that: a part of a parabola is a Bezier
curve, and a linear form of the place lies between those of its three points, a quadratic one between five made of them.
That look may only save work, never decide: it keeps off all that is within rounding.
"""

from __future__ import annotations

import math

from wallkit.kernels.impact.arc_impact import FALLING_MOULD, is_wide, to_end
from wallkit.kernels.impact.drag_motion import along, pulled, speed_after
from wallkit.kernels.impact.drag_roots import Gap, first_fall, first_fall_after
from wallkit.kernels.impact.leaving import LEVEL_SPEED, left_along
from wallkit.kernels.impact.line_impact import from_across, precedes, slack_of, stands_across
from wallkit.kernels.impact.polynomial_roots import NEVER, first_fall_quadratic, first_fall_quartic
from wallkit.kernels.jit import kernel, rare_kernel

SMOOTH_ON = 1.0 - 2.0**-20
"""Cosine between the normals of a wall that a point has left and of an arc that goes on from it: some 2^-10 apart."""
HULL_ROUNDING = 2.0**-45
"""Of the size of a hull, beyond the rounding of its points and of what is made of them."""
GRAZING_ROUNDING = 2.0**-46
"""Of the squared way to a corner, above the rounding of the quartic's coefficients."""
LATER = 1.0 + 2.0**-18
"""Roots are looked for up to so much after the time that matters: ``_polished`` moves them by less."""


@kernel
def hull_of(drag, x, y, vx, vy, gx, gy, start, stop, tolerance):
    """Give the hull of a flight between two times: (px, py, qx, qy, rx, ry, margin, size).

    It begins at p and ends at r, and its tangents there meet in q. What is within ``margin`` may be met: with drag,
    where the way is no parabola, everything.
    """
    if drag is not None:
        return x, y, x, y, x, y, NEVER, 0.0
    ux, uy = vx + start * gx, vy + start * gy
    half = 0.5 * (stop - start)
    # A part of a parabola is a quadratic Bezier curve. Its middle point is where the tangents at both ends meet:
    # half the part's time along either of them.
    px, py = x + start * (vx + 0.5 * start * gx), y + start * (vy + 0.5 * start * gy)
    qx, qy = px + half * ux, py + half * uy
    rx, ry = qx + half * (ux + 2.0 * half * gx), qy + half * (uy + 2.0 * half * gy)
    size = abs(px) + abs(py) + abs(qx) + abs(qy) + abs(rx) + abs(ry)
    return px, py, qx, qy, rx, ry, tolerance + HULL_ROUNDING * size, size


@rare_kernel
def fall_line(
    lines, ids, start, stop, one_sided, edge_wall, radius, x, y, vx, vy, gx, gy, drag, far, last, skipped, tolerance,
    best, feature,
):  # fmt: skip
    """Earliest contact with the lines of entries start to stop: +-(d + vn t + gn t^2 / 2) - r falls through 0.

    ``skipped`` is the line that the ball has just left along it. A disc that overlaps a one-sided wall by more
    than rounding has come through it, and meets it once it has left it. The far side can be met only by a ball that
    comes through the gap to the near one, beside the edge: it is asked only if that is before ``best``.

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
        # Across the edge the centre is at d + vn t + gn t^2 / 2, along it at u + vu t + gu t^2 / 2.
        d, vn, gn = ex * nx + ey * ny, vx * nx + vy * ny, gx * nx + gy * ny
        u, vu, gu = ey * nx - ex * ny, vy * nx - vx * ny, gy * nx - gx * ny
        above = d > 0.0
        if radius == 0.0 and abs(d) <= tolerance and -tolerance <= u <= line.length + tolerance:
            touched += 1 if ids[k] != last else 0
            above = vn > 0.0 if abs(vn) > noise else gn < 0.0  # pressed on it, it lies on it
        side = 1.0 if above else -1.0
        if one_sided is None or side > 0.0 or one_sided[edge_wall[ids[k]]] == 0:
            t = _line_fall(drag, far, side * gn, side * vn, side * d - radius)
            if stands_across(one_sided, edge_wall, ids[k], side * d - radius, slack):
                t = _fall_from_behind(drag, far, 0.5 * gn, vn, d - radius)
            # Where this side is not met in time, nor beside the edge, the ball has not come through to the other.
            if not t <= best:
                continue
            if -slack <= along(drag, u, vu, gu, t) <= line.length + slack:
                if t < best or precedes(ids[k], feature):
                    best, feature = t, ids[k]
                continue
        if one_sided is not None:
            if side > 0.0 and one_sided[edge_wall[ids[k]]] != 0:
                continue
        # The gap to the far side is the negative one, below 0 now: it rises as the ball comes through.
        t = _fall_from_behind(drag, far, -0.5 * side * gn, -side * vn, -side * d - radius)
        if t < best or (t == best and precedes(ids[k], feature)):
            if -slack <= along(drag, u, vu, gu, t) <= line.length + slack:
                best, feature = t, ids[k]
    return best, feature, touched


@kernel
def _line_fall(drag, far, a, b, c):
    """First fall through 0 of the gap c to a line that changes at b and is pulled by a, before ``far``."""
    if drag is None:
        return first_fall_quadratic(0.5 * a, b, c, math.inf)
    # One coordinate, the gap, as a flight along x past the line x = 0.
    return first_fall(Gap(0.0, 0.5, 0.0, 0.0, 0.0, 0.0, c, 0.0, b, 0.0, a, 0.0, drag), far, NEVER, False)


@kernel
def _fall_from_behind(drag, far, a, b, c):
    """First fall of a t^2 + b t + c through 0, below which it is now, after it has risen above."""
    if drag is not None:
        return first_fall(Gap(0.0, 0.5, 0.0, 0.0, 0.0, 0.0, c, 0.0, b, 0.0, 2.0 * a, 0.0, drag), far, NEVER, True)
    discriminant = b * b - 4.0 * a * c
    if a >= 0.0 or b <= 0.0 or discriminant <= 0.0:
        return NEVER
    # a < 0 < b: the larger root, (-b - root) / 2 a, whose terms are of one sign.
    return -0.5 * (b + math.sqrt(discriminant)) / a


@rare_kernel
def _range_of(ax, ay, bx, by, cx, cy, sx, sy):
    """Bounds of w.w + 2 s.w on the Bezier curve of w through a, b and c: of the five coefficients of its quartic."""
    # w = (1-t)^2 a + 2 t (1-t) b + t^2 c. As a quartic w.w has the coefficients a.a, a.b, (a.c + 2 b.b) / 3, b.c, c.c,
    # and 2 s.w, raised by two degrees, 2 s.a, s.(a + b), s.(a + 4 b + c) / 3, s.(b + c), 2 s.c. The curve lies between
    # the least and the largest of them.
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
    corners, ids, start, stop, one_sided, corner_wall, fans, radius, x, y, vx, vy, gx, gy, drag, far, last, tolerance,
    now, until, best, feature,
):  # fmt: skip
    """Earliest contact of a disc with the corners of entries start to stop: |e + v t + g t^2 / 2|^2 - r^2 falls.

    A corner of a one-sided wall may be passed from behind and met later on the same flight. A disc that has pivoted
    about ``last``, or has come off its edge, leaves it along it.
    """
    px, py, qx, qy, rx, ry, margin, size = hull_of(drag, x, y, vx, vy, gx, gy, now, min(best, until), tolerance)
    left, right = min(min(px, qx), rx), max(max(px, qx), rx)
    low, high = min(min(py, qy), ry), max(max(py, qy), ry)
    most = radius * radius + margin * (4.0 * radius + size)
    slack = slack_of(tolerance, radius)
    # |e + v t + g t^2/2|^2 = g.g/4 t^4 + v.g t^3 + (v.v + e.g) t^2 + 2 e.v t + e.e.
    c4, c3 = 0.25 * (gx * gx + gy * gy), vx * gx + vy * gy
    ax, ay = pulled(drag, vx, gx), pulled(drag, vy, gy)
    for k in range(start, stop):
        corner = corners[ids[k]]
        cx, cy = corner.x, corner.y
        # First the box of the hull, which most corners are far from, then the quartic's own bounds, then its roots.
        off_x, off_y = max(max(left - cx, cx - right), 0.0), max(max(low - cy, cy - high), 0.0)
        if off_x * off_x + off_y * off_y > most:
            continue
        least, _largest = _range_of(px - cx, py - cy, qx - cx, qy - cy, rx - cx, ry - cy, 0.0, 0.0)
        if least > most:
            continue
        ex, ey = x - cx, y - cy
        c2, c1 = vx * vx + vy * vy + ex * ax + ey * ay, 2.0 * (ex * vx + ey * vy)
        c0 = ex * ex + ey * ey - radius * radius
        from_behind = stands_across(one_sided, corner_wall, ids[k], c0, 2.0 * radius * slack)
        if -2 - ids[k] == last:
            c2, c1, c0, from_behind = left_along(c2, c1, c0, radius, slack, vx, vy, gx, gy, from_behind)
        t = _circle_fall(
            drag, far, 1.0, -radius * radius, ex, ey, 0.0, 0.0, vx, vy, gx, gy, c4, c3, c2, c1, c0, 0.0,
            LATER * min(best, until), from_behind,
        )  # fmt: skip
        if drag is None:
            if t == NEVER and c0 > 0.0 and not from_behind and -2 - ids[k] != last:
                t = _grazing(radius, ex, ey, vx, vy, gx, gy, c4, c3, c2, c1, c0, LATER * min(best, until))
        if one_sided is not None:
            if t <= best and t < NEVER:
                there_x, there_y = along(drag, ex, vx, gx, t), along(drag, ey, vy, gy, t)
                if from_across(one_sided, corner_wall, fans, corners, ids[k], radius, slack, there_x, there_y):
                    t = _circle_fall(
                        drag, far, 1.0, -radius * radius, ex, ey, 0.0, 0.0, vx, vy, gx, gy, c4, c3, c2, c1, c0, t,
                        LATER * min(best, until), True,
                    )  # fmt: skip
        if t < best or (t == best and precedes(-2 - ids[k], feature)):
            best, feature = t, -2 - ids[k]
    return best, feature


@rare_kernel
def _grazing(radius, ex, ey, vx, vy, gx, gy, c4, c3, c2, c1, c0, t_max):
    """First fall of a disc on to a corner that the rounding of the quartic's coefficients hides, or NEVER.

    They are off by the rounding of the squared way, which is 1 / r of that in the distance: where a disc comes over a
    corner on to its edge, along that, neither the edge nor the corner would stop it. So it is asked again from near by.
    """
    # At the corner e + v t + g t^2 / 2 = 0: g t^2 / 2 <= |e| + |v| t, so t <= (|v| + sqrt(v^2 + 2 g |e|)) / g.
    pull, speed, off = math.sqrt(gx * gx + gy * gy), abs(vx) + abs(vy), abs(ex) + abs(ey)
    if pull == 0.0:
        return NEVER
    latest = (speed + math.sqrt(speed * speed + 2.0 * pull * off)) / pull
    size = 2.0 * (off + speed * latest)
    near = first_fall_quartic(c4, c3, c2, c1, c0 - GRAZING_ROUNDING * size * size, t_max, False)
    if not near < NEVER:
        return NEVER
    px, py = ex + near * (vx + 0.5 * near * gx), ey + near * (vy + 0.5 * near * gy)
    ux, uy = vx + near * gx, vy + near * gy
    # The quartic of the flight from there: its c0 is of the size of r^2, not of the way to the corner.
    f3, f2 = ux * gx + uy * gy, ux * ux + uy * uy + px * gx + py * gy
    # Within the rounding of places it touches the corner: else it might be just past that, and just below the line.
    way = abs(ex) + abs(ey) + near * (abs(vx) + abs(vy) + near * (abs(gx) + abs(gy)))
    reach = radius + 2.0**-50 * way
    f1, f0 = 2.0 * (px * ux + py * uy), px * px + py * py - reach * reach
    return near + first_fall_quartic(c4, f3, f2, f1, f0, t_max - near, False)


@rare_kernel
def _circle_fall(
    drag, far, side, off, wx, wy, sx, sy, vx, vy, gx, gy, c4, c3, c2, c1, c0, after, t_max, from_behind
):  # fmt: skip
    """First fall through 0 of the gap side (w.(w + 2 s) + off) up to t_max, or the next one after a time.

    Its first coefficients are c0, c1, c2, where what the ball has just left may have been taken out of them: see
    ``left_along``.
    """
    if drag is None:
        if after > 0.0:
            t = _fall_after(c4, c3, c2, c1, c0, after, t_max)
        else:
            t = first_fall_quartic(c4, c3, c2, c1, c0, t_max, from_behind)
        return _polished(t, off, wx, wy, sx, sy, vx, vy, gx, gy)
    ex, ey = wx + sx, wy + sy
    bend = vx * vx + vy * vy + ex * pulled(drag, vx, gx) + ey * pulled(drag, vy, gy)
    off_now = c0 - side * (wx * (wx + 2.0 * sx) + wy * (wy + 2.0 * sy))
    lin, twice = c1 - side * 2.0 * (ex * vx + ey * vy), 2.0 * (c2 - side * bend)
    gap = Gap(side, side * sx, side * sy, off_now, lin, twice, wx, wy, vx, vy, gx, gy, drag)
    return first_fall_after(gap, far, after, t_max, from_behind)


@rare_kernel
def _polished(t, off, wx, wy, sx, sy, vx, vy, gx, gy):
    """One Newton step for w.(w + 2 s) + off = 0 with w(t) = w + v t + g t^2 / 2, from places instead of coefficients.

    The coefficients of the quartic carry the rounding of (|v| t + g t^2 / 2)^2, the places that of |v| t + g t^2 / 2.
    Grazing, where the step is no longer small, the root has no better digits to give.
    """
    if not 0.0 < t < NEVER:
        return t
    px, py = wx + t * (vx + 0.5 * t * gx), wy + t * (vy + 0.5 * t * gy)
    # d/dt of w.(w + 2 s) is 2 (w + s).(v + g t).
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
    arcs, ids, start, stop, one_sided, edge_wall, radius, x, y, vx, vy, gx, gy, drag, far, last, skipped, tolerance,
    reference, now, until, best, feature,
):  # fmt: skip
    """Earliest contact with the arcs of entries start to stop: |e(t)|^2 - (R + r)^2 or (R - r)^2 - |e(t)|^2 falls.

    Contacts before ``now`` or after ``until`` are found in other cells. ``skipped`` is what the ball has just left
    along it, ``reference`` the normal of that, towards the ball, or zero: a point that comes smoothly onto an arc is on
    that side of it.

    Returns:
        (time, feature, number of other arcs that a point touches where it starts).
    """
    touched = 0
    if arcs is None:
        return best, feature, touched
    px, py, qx, qy, rx, ry, margin, size = hull_of(drag, x, y, vx, vy, gx, gy, now, min(best, until), tolerance)
    slack = slack_of(tolerance, radius)
    for k in range(start, stop):
        arc = arcs[ids[k]]
        wx, wy = x - arc.ax, y - arc.ay
        solid_in, solid_out, one_way = True, True, False
        if one_sided is not None:
            one_way = one_sided[edge_wall[ids[k]]] != 0
            solid_out, solid_in = not one_way or arc.sweep > 0.0, not one_way or arc.sweep < 0.0
        ax, ay, bx, by, cx, cy = px - arc.ax, py - arc.ay, qx - arc.ax, qy - arc.ay, rx - arc.ax, ry - arc.ay
        if _goes_by(arc, ax, ay, bx, by, cx, cy, slack + margin):
            continue
        # Bounds of the power on this part of the flight: where it reaches neither level no root is looked for.
        least, most = _range_of(ax, ay, bx, by, cx, cy, arc.sx, arc.sy)
        near = margin * (4.0 * (arc.radius + radius) + size)
        outer, inner = levels_of(arc.radius, radius)
        if least > outer + near or most < inner - near:
            continue
        again = ids[k] == last
        outside, on = _side_of(arc, radius, wx, wy, vx, vy, gx, gy, tolerance, reference)
        touched += 1 if on and not again else 0
        t = _time_to_arc(
            arc, radius, outside, solid_out, solid_in, one_way, wx, wy, vx, vy, gx, gy, drag, far, again,
            ids[k] == skipped, slack, min(best, LATER * until), least - near, most + near,
        )  # fmt: skip
        if t < best or (t == best and precedes(ids[k], feature)):
            best, feature = t, ids[k]
            px, py, qx, qy, rx, ry, margin, size = hull_of(drag, x, y, vx, vy, gx, gy, now, min(best, until), tolerance)
    return best, feature, touched


@kernel
def levels_of(arc_radius, radius):
    """Power |e|^2 - R^2 of a centre that touches an arc from outside, and of one that does so from inside.

    With w from a, the start of the arc, and s from its centre to a, it is w.(w + 2 s): a nearly straight arc is
    judged as the line is that it comes to. For a disc as large as the arc see ``FALLING_MOULD``.
    """
    mould = FALLING_MOULD * arc_radius
    inner = -radius * (2.0 * arc_radius - radius)
    if arc_radius - radius < mould:
        inner = -(arc_radius - mould) * (arc_radius + mould)
    return radius * (2.0 * arc_radius + radius), inner


@rare_kernel
def _goes_by(arc, ax, ay, bx, by, cx, cy, slack):
    """Tell whether a hull, given from the start of the arc, lies all beyond one of its ends; see ``_beside``."""
    if is_wide(arc.sweep):
        return False
    least = -slack * arc.radius
    sx, sy = arc.sx, arc.sy
    # As in ``_beside``: s x w for the end a, (w - d) x f for the end b. Linear in w, so the hull's points decide.
    if sx * ay - sy * ax < least and sx * by - sy * bx < least and sx * cy - sy * cx < least:
        return True
    fx, fy = to_end(arc)
    dx, dy = arc.bx - arc.ax, arc.by - arc.ay
    a, b, c = (ax - dx) * fy - (ay - dy) * fx, (bx - dx) * fy - (by - dy) * fx, (cx - dx) * fy - (cy - dy) * fx
    return a < least and b < least and c < least


@rare_kernel
def _side_of(arc, radius, wx, wy, vx, vy, gx, gy, tolerance, reference):
    """Tell whether a ball is outside the circle of an arc, and whether it is a point within rounding of the arc.

    Such a point is on the side to which it flies, or, level, from which it is pressed; or see ``fall_arcs``.
    """
    ex, ey = wx + arc.sx, wy + arc.sy
    power = wx * (wx + 2.0 * arc.sx) + wy * (wy + 2.0 * arc.sy)
    if radius > 0.0 or abs(power) > (2.0 * arc.radius + tolerance) * tolerance or not _beside(arc, wx, wy, tolerance):
        return power >= 0.0, False
    along = ex * reference[0] + ey * reference[1]
    if abs(along) > SMOOTH_ON * arc.radius:
        return along > 0.0, True
    rises = ex * vx + ey * vy
    if abs(rises) > LEVEL_SPEED * (abs(vx) + abs(vy)) * arc.radius:
        return rises > 0.0, True
    # Level on the arc |e|^2 / 2 changes with v.v + e.g: below 0 gravity presses the point on the back, from outside.
    return vx * vx + vy * vy + ex * gx + ey * gy < 0.0, True


@rare_kernel
def _time_to_arc(
    arc, radius, outside, solid_out, solid_in, one_way, wx, wy, vx, vy, gx, gy, drag, far, again, left, slack, best,
    least, most,
):  # fmt: skip
    """Time up to ``best`` at which a ball, at w from the start of an arc, meets it; NEVER if it does not.

    Its power stays between ``least`` and ``most`` while contacts count. The other side is met only through the gap to
    this one, beside the arc; a disc as large as the arc may be on neither. The ball has met the arc last (``again``) or
    has ``left`` it along it: then it may be going on behind its circle, past its end, see ``left_along``.
    """
    ex, ey = wx + arc.sx, wy + arc.sy
    power = wx * (wx + 2.0 * arc.sx) + wy * (wy + 2.0 * arc.sy)
    c4, c3 = 0.25 * (gx * gx + gy * gy), vx * gx + vy * gy
    c2 = vx * vx + vy * vy + ex * pulled(drag, vx, gx) + ey * pulled(drag, vy, gy)
    c1 = 2.0 * (ex * vx + ey * vy)
    outer, inner = levels_of(arc.radius, radius)
    mould = FALLING_MOULD * arc.radius
    found, other = NEVER, True
    for turn in range(2):
        from_outside = outside == (turn == 0)
        fits = from_outside or arc.radius - radius > -mould
        if not (other and fits and (solid_out if from_outside else solid_in)):
            continue
        # The gap is the power less its level; in the hollow the negative of that.
        side, level = (1.0, outer) if from_outside else (-1.0, inner)
        is_mould = not from_outside and arc.radius - radius < mould
        overlaps = one_way and side * (power - level) < -2.0 * (arc.radius + radius) * slack
        from_behind = power > level if is_mould else turn == 1 or overlaps
        b2, b1, c0 = side * c2, side * c1, side * (power - level)
        if is_mould and from_behind:  # it may come in along a wall that joins the hollow, out by rounding
            c0 += 2.0 * mould * slack
        if again or left:
            reach = arc.radius + side * radius
            b2, b1, c0, from_behind = left_along(b2, b1, c0, reach, slack, vx, vy, gx, gy, from_behind)
        if (least > level) if from_outside else (most < level):
            continue
        if from_behind and ((most < level) if from_outside else (least > level)):
            continue
        if again and not from_behind and _only_rises(drag, side * c4, side * c3, b2, b1, c0, best):
            other = is_mould
            continue
        t = _circle_fall(
            drag, far, side, -level, wx, wy, arc.sx, arc.sy, vx, vy, gx, gy, side * c4, side * c3, b2, b1, c0, 0.0,
            LATER * best, from_behind,
        )  # fmt: skip
        other = is_mould or from_behind or t <= best
        # A circle may be met twice, and the arc may lie at the second place alone.
        for _again in range(2):
            if not t <= best or t >= found:
                break
            there_x, there_y = along(drag, wx, vx, gx, t), along(drag, wy, vy, gy, t)
            if (t > 0.0 or not again) and _beside(arc, there_x, there_y, slack):
                found, other = t, other and _again == 1
                break
            t = _circle_fall(
                drag, far, side, -level, wx, wy, arc.sx, arc.sy, vx, vy, gx, gy, side * c4, side * c3, b2, b1, c0, t,
                LATER * best, True,
            )  # fmt: skip
        if not from_outside and not is_mould and (from_behind or c0 <= 0.0 or (found == NEVER and t < NEVER)):
            found = _time_onto(arc, radius, wx, wy, vx, vy, gx, gy, drag, far, slack, best, found)
    return found


@rare_kernel
def _time_onto(arc, radius, wx, wy, vx, vy, gx, gy, drag, far, slack, best, found):
    """Time up to ``best`` at which a ball comes beside an end of an arc's hollow and goes on along that, or ``found``.

    A flight down a wall that goes over into the arc has the gap 0 there, and falling, but on the way to it none above
    0 from which to fall: rounding alone says whether there is one, and puts its fall later, by the root of rounding.
    So a gap of rounding counts as 0 there.
    """
    fx, fy = to_end(arc)
    ux, uy = wx - (arc.bx - arc.ax), wy - (arc.by - arc.ay)
    meets = found
    for end in range(2):
        # In front of its end the arc has s x e < 0 or e x f < 0, see ``_beside``: the negative of that falls through 0.
        if end == 0:
            a, b, c = arc.sy * gx - arc.sx * gy, arc.sy * vx - arc.sx * vy, arc.sy * wx - arc.sx * wy
        else:
            a, b, c = fx * gy - fy * gx, fx * vy - fy * vx, fx * uy - fy * ux
        t = _line_fall(drag, far, a, b, c) if c > 0.0 else _fall_from_behind(drag, far, 0.5 * a, b, c)
        if not 0.0 < t <= min(best, meets):
            continue
        px, py = along(drag, wx, vx, gx, t), along(drag, wy, vy, gy, t)
        if not _beside(arc, px, py, slack):
            continue
        gap = px * (px + 2.0 * arc.sx) + py * (py + 2.0 * arc.sy) + radius * (2.0 * arc.radius - radius)
        if abs(gap) > 2.0 * arc.radius * slack:
            continue
        qx, qy = speed_after(drag, vx, gx, t), speed_after(drag, vy, gy, t)
        ex, ey = px + arc.sx, py + arc.sy
        # Off it at w = -e.v / R, pressed back by p = (v.v + e.g) / R, it would rise by w^2 / 2 p: by rounding, no more.
        outwards, pressed = ex * qx + ey * qy, qx * qx + qy * qy + ex * gx + ey * gy
        grazes = outwards * outwards <= 2.0 * pressed * arc.radius * slack
        if pressed > 0.0 and (grazes or (outwards > 0.0 and found == NEVER)):
            meets = t
    return meets


@rare_kernel
def _only_rises(drag, c4, c3, c2, c1, c0, span):
    """Tell whether a gap that begins at 0, to rounding, surely comes to no fall through 0 in a span of time.

    It is c0 + q t, q a cubic that lies between the four coefficients of its Bezier curve. Where these are a quarter of
    q(0) = c1 and more, the gap is at most 0 up to t = 4 |c0| / c1, and until then its slope keeps most of c1.
    """
    if drag is not None:
        return False
    # q = c1 + c2 t + c3 t^2 + c4 t^3 on [0, span] has the Bezier coefficients c1, c1 + a/3, c1 + (2 a + b)/3 and
    # c1 + a + b + c.
    a, b, c = c2 * span, c3 * span * span, c4 * span * span * span
    least = 0.25 * c1 + HULL_ROUNDING * (abs(a) + abs(b) + abs(c))
    t = 4.0 * abs(c0) / (c1 if c1 > 0.0 else 1.0)
    keeps = c1 > 4.0 * t * (abs(c2) + t * (abs(c3) + t * abs(c4)))
    return keeps and c1 + a / 3.0 > least and c1 + (2.0 * a + b) / 3.0 > least and c1 + a + b + c > least


@rare_kernel
def _fall_after(c4, c3, c2, c1, c0, time, t_max):
    """The next fall of a quartic through 0 after one at a time, before which it rises above 0."""
    # Taylor's coefficients about that fall: the same quartic in the time since.
    f0 = (((c4 * time + c3) * time + c2) * time + c1) * time + c0
    f1 = ((4.0 * c4 * time + 3.0 * c3) * time + 2.0 * c2) * time + c1
    f2 = (6.0 * c4 * time + 3.0 * c3) * time + c2
    f3 = 4.0 * c4 * time + c3
    return time + first_fall_quartic(c4, f3, f2, f1, f0, t_max, True)
