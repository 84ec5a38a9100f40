"""Time of impact under gravity: parabolas against lines and corners; those against arcs are in ``arc_fall``.

A gap that falls through zero is a contact; ``polynomial_roots`` finds when. A ball may meet both sides of one wall in
one flight (up past its end, and down on it), so each side is asked; from behind, the gap must rise above zero before it
falls. Where a contact counts only on part of a line or circle, the parts overlap by the rounding of positions.

Most of what a cell lists is not met, and mostly the *hull* of the flight shows that: a part of a parabola is a Bezier
curve, and a linear form of the place lies between those of its three points, a quadratic one between five made of them.
That look may only save work, never decide: it keeps off all that is within rounding.
"""

from __future__ import annotations

import math

from wallkit.kernels.impact.drag_motion import along, eased, pulled
from wallkit.kernels.impact.drag_roots import Gap, first_fall, first_fall_after
from wallkit.kernels.impact.leaving import LEVEL_SPEED, left_along
from wallkit.kernels.impact.line_impact import from_across, precedes, slack_of, stands_across
from wallkit.kernels.impact.polynomial_roots import NEVER, fall_after_rise, first_fall_quadratic, first_fall_quartic
from wallkit.kernels.jit import kernel, rare_kernel

HULL_ROUNDING = 2.0**-45
"""Of the size of a hull, beyond the rounding of its points and of what is made of them."""
GRAZING_ROUNDING = 2.0**-46
"""Of the squared way to a corner, above the rounding of the quartic's coefficients."""
PLACE_ROUNDING = 2.0**-9
"""Of the tolerance, 2^-41 of the extent: what the place of a flight with drag is rounded by, 2^-50 of that."""
HIDING = 2.0**-23
"""Of the way to a corner: the square of a smaller radius is below that rounding, and a root of it tells nothing."""
LATER = 1.0 + 2.0**-18
"""Roots are looked for up to so much after the time that matters: ``_polished`` moves them by less."""


@kernel
def hull_of(drag, x, y, vx, vy, gx, gy, start, stop, tolerance):
    """Give the hull of a flight between two times: (px, py, qx, qy, rx, ry, margin, size).

    It begins at p and ends at r, and its tangents there meet in q. What is within ``margin`` may be met. With drag it
    is the hull of a parabola that begins and ends as the flight does, and the margin holds what is between the two.
    """
    if drag is not None:
        return _slowed_hull(drag, x, y, vx, vy, gx, gy, start, stop, tolerance)
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
def _slowed_hull(drag, x, y, vx, vy, gx, gy, start, stop, tolerance):
    """``hull_of`` of a flight with drag k."""
    if not stop < NEVER:
        return x, y, x, y, x, y, NEVER, 0.0
    left, free, second = eased(drag, start)
    px, py = x + (vx * free + gx * second), y + (vy * free + gy * second)
    span, pulls = stop - start, left * (abs(gx - drag * vx) + abs(gy - drag * vy))
    half = 0.5 * span
    qx, qy = px + half * (vx * left + gx * free), py + half * (vy * left + gy * free)
    _left, free, second = eased(drag, stop)
    rx, ry = x + (vx * free + gx * second), y + (vy * free + gy * second)
    size = abs(px) + abs(py) + abs(qx) + abs(qy) + abs(rx) + abs(ry)
    way = (abs(vx) + abs(vy)) * free + (abs(gx) + abs(gy)) * second
    # Flight less parabola has a double root where it starts and one where it stops, and a third derivative of -k a,
    # which only falls off: it is at most k a max(t^2 (T - t)) / 6 = 2 k a T^3 / 81.
    margin = tolerance + HULL_ROUNDING * (size + way) + 0.025 * drag * pulls * span * span * span
    return px, py, qx, qy, rx, ry, margin, size


@kernel
def strays(px, py, qx, qy, rx, ry, cx, cy, most):
    """Tell whether a flight with this hull keeps farther than the root of ``most`` from c: by the strip it lies in.

    Across the way from p to r a parabola goes to half of where q is, and back: (1 - t)^2 p + 2 t (1 - t) q + t^2 r.
    """
    ux, uy = rx - px, ry - py
    bow = 0.5 * (ux * (qy - py) - uy * (qx - px))
    at = ux * (cy - py) - uy * (cx - px)
    below, above = -at if bow > 0.0 else bow - at, at - bow if bow > 0.0 else at
    off = below if below > above else above
    return (off > 0.0) & (off * off > most * (ux * ux + uy * uy))


@kernel
def _misses(line, radius, slack, px, py, qx, qy, rx, ry, margin):
    """Tell whether a flight with this hull keeps off a line: beyond it, before it, or past one of its ends."""
    nx, ny, ax, ay, bx, by = line.nx, line.ny, px - line.ax, py - line.ay, qx - line.ax, qy - line.ay
    cx, cy = rx - line.ax, ry - line.ay
    a, b, c = ax * nx + ay * ny, bx * nx + by * ny, cx * nx + cy * ny
    reach = radius + margin
    if min(min(a, b), c) > reach or max(max(a, b), c) < -reach:
        return True
    a, b, c = ay * nx - ax * ny, by * nx - bx * ny, cy * nx - cx * ny
    return min(min(a, b), c) > line.length + slack + margin or max(max(a, b), c) < -slack - margin


@rare_kernel
def fall_line(
    lines, ids, start, stop, one_sided, edge_wall, radius, x, y, vx, vy, gx, gy, drag, far, last, skipped, tolerance,
    now, until, best, feature,
):  # fmt: skip
    """Earliest contact with the lines of entries start to stop: +-(d + vn t + gn t^2 / 2) - r falls through 0.

    ``skipped`` is the line that the ball has just left along it. A disc that overlaps a one-sided wall by more
    than rounding has come through it, and meets it once it has left it. The far side can be met only by a ball that
    comes through the gap to the near one, beside the edge: it is asked only if that is before ``best``. With drag,
    where that takes long, only hulls of the flight from ``now`` to ``until`` that come near are asked.

    Returns:
        (time, feature, number of other lines that a point touches where it starts).
    """
    touched = 0
    slack = slack_of(tolerance, radius)
    if drag is not None:
        px, py, qx, qy, rx, ry, margin, _size = hull_of(drag, x, y, vx, vy, gx, gy, now, min(best, until), tolerance)
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
        if drag is not None:
            if _misses(line, radius, slack, px, py, qx, qy, rx, ry, margin):
                continue
        side = 1.0 if above else -1.0
        if one_sided is None or side > 0.0 or one_sided[edge_wall[ids[k]]] == 0:
            t = line_fall(drag, far, side * gn, side * vn, side * d - radius)
            if stands_across(one_sided, edge_wall, ids[k], side * d - radius, slack):
                t = fall_from_behind(drag, far, 0.5 * gn, vn, d - radius)
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
        t = fall_from_behind(drag, far, -0.5 * side * gn, -side * vn, -side * d - radius)
        if t < best or (t == best and precedes(ids[k], feature)):
            if -slack <= along(drag, u, vu, gu, t) <= line.length + slack:
                best, feature = t, ids[k]
    return best, feature, touched


@kernel
def line_fall(drag, far, a, b, c):
    """First fall through 0 of the gap c to a line that changes at b and is pulled by a, before ``far``."""
    if drag is None:
        return first_fall_quadratic(0.5 * a, b, c, math.inf)
    # One coordinate, the gap, as a flight along x past the line x = 0.
    return first_fall(Gap(0.0, 0.5, 0.0, 0.0, 0.0, 0.0, c, 0.0, b, 0.0, a, 0.0, drag), far, NEVER, False)


@kernel
def fall_from_behind(drag, far, a, b, c):
    """First fall of a t^2 + b t + c through 0, below which it is now, after it has risen above."""
    if drag is not None:
        return first_fall(Gap(0.0, 0.5, 0.0, 0.0, 0.0, 0.0, c, 0.0, b, 0.0, 2.0 * a, 0.0, drag), far, NEVER, True)
    return fall_after_rise(a, b, c)


@rare_kernel
def range_of(ax, ay, bx, by, cx, cy, sx, sy):
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
        if off_x * off_x + off_y * off_y > most or strays(px, py, qx, qy, rx, ry, cx, cy, most):
            continue
        least, _largest = range_of(px - cx, py - cy, qx - cx, qy - cy, rx - cx, ry - cy, 0.0, 0.0)
        if least > most:
            continue
        ex, ey = x - cx, y - cy
        c2, c1 = vx * vx + vy * vy + ex * ax + ey * ay, 2.0 * (ex * vx + ey * vy)
        c0 = ex * ex + ey * ey - radius * radius
        from_behind = stands_across(one_sided, corner_wall, ids[k], c0, 2.0 * radius * slack)
        if -2 - ids[k] == last:
            c2, c1, c0, from_behind = left_along(c2, c1, c0, radius, slack, vx, vy, gx, gy, from_behind)
        near = 0.0
        grazes = c4 > 0.0 and c0 > 0.0 and not from_behind and -2 - ids[k] != last
        if grazes:  # widened by rounding it falls sooner: without a root of that one the exact one has none
            near = _near(drag, far, radius, ex, ey, vx, vy, gx, gy, c4, c3, c2, c1, tolerance, LATER * min(best, until))
            if not near < NEVER:
                continue
        t = circle_fall(
            drag, far, 1.0, -radius * radius, ex, ey, 0.0, 0.0, vx, vy, gx, gy, c4, c3, c2, c1, c0, 0.0,
            LATER * min(best, until), from_behind,
        )  # fmt: skip
        if drag is None:
            if grazes and (t == NEVER or radius < HIDING * way_of(ex, ey, vx, vy, gx, gy, t)):
                t = _grazing(radius, ex, ey, vx, vy, gx, gy, near, LATER * min(best, until))
        elif grazes and t == NEVER:
            t = near
        if one_sided is not None:
            if t <= best and t < NEVER:
                there_x, there_y = along(drag, ex, vx, gx, t), along(drag, ey, vy, gy, t)
                if from_across(one_sided, corner_wall, fans, corners, ids[k], radius, slack, there_x, there_y):
                    t = circle_fall(
                        drag, far, 1.0, -radius * radius, ex, ey, 0.0, 0.0, vx, vy, gx, gy, c4, c3, c2, c1, c0, t,
                        LATER * min(best, until), True,
                    )  # fmt: skip
        if t < best or (t == best and precedes(-2 - ids[k], feature)):
            best, feature = t, -2 - ids[k]
    return best, feature


@rare_kernel
def _near(drag, far, radius, ex, ey, vx, vy, gx, gy, c4, c3, c2, c1, tolerance, t_max):
    """First fall of a disc on to a corner, or to within the rounding of what is asked of it, or NEVER.

    That of the quartic's coefficients; with drag the gap is made of places, and only their rounding may hide a graze.
    """
    if drag is not None:
        reach = radius + PLACE_ROUNDING * tolerance
        c0 = ex * ex + ey * ey - reach * reach
        return circle_fall(
            drag, far, 1.0, -reach * reach, ex, ey, 0.0, 0.0, vx, vy, gx, gy, c4, c3, c2, c1, c0, 0.0, t_max, False
        )
    # At the corner e + v t + g t^2 / 2 = 0: g t^2 / 2 <= |e| + |v| t, so t <= (|v| + sqrt(v^2 + 2 g |e|)) / g.
    pull, speed, off = math.sqrt(gx * gx + gy * gy), abs(vx) + abs(vy), abs(ex) + abs(ey)
    latest = (speed + math.sqrt(speed * speed + 2.0 * pull * off)) / pull
    size = 2.0 * (off + speed * latest)
    c0 = ex * ex + ey * ey - radius * radius
    return first_fall_quartic(c4, c3, c2, c1, c0 - GRAZING_ROUNDING * size * size, t_max, False)


@rare_kernel
def _grazing(radius, ex, ey, vx, vy, gx, gy, near, t_max):
    """First fall of a disc on to a corner that the rounding of the quartic's coefficients hides, or NEVER.

    They are off by the rounding of the squared way, which is 1 / r of that in the distance: where a disc comes over a
    corner on to its edge, along that, neither the edge nor the corner would stop it. So it is asked again from the
    time ``near``, when it is near by, as is where a disc that is smaller than the rounding seems to meet it.
    """
    px, py = ex + near * (vx + 0.5 * near * gx), ey + near * (vy + 0.5 * near * gy)
    ux, uy = vx + near * gx, vy + near * gy
    # The quartic of the flight from there: its c0 is of the size of r^2, not of the way to the corner.
    f3, f2 = ux * gx + uy * gy, ux * ux + uy * uy + px * gx + py * gy
    # Within the rounding of places it touches the corner: else it might be just past that, and just below the line.
    reach = radius + 2.0**-50 * way_of(ex, ey, vx, vy, gx, gy, near)
    f1, f0 = 2.0 * (px * ux + py * uy), px * px + py * py - reach * reach
    return near + first_fall_quartic(0.25 * (gx * gx + gy * gy), f3, f2, f1, f0, t_max - near, False)


@kernel
def way_of(ex, ey, vx, vy, gx, gy, t):
    """How large the parts are that the place after a time of flight is made of."""
    return abs(ex) + abs(ey) + t * (abs(vx) + abs(vy) + t * (abs(gx) + abs(gy)))


@rare_kernel
def circle_fall(
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
    # What was taken out of c0 is 0 but for what the ball has left. c0 less w.(w + 2 s) would be off by its rounding.
    off_now = side * off + (c0 - side * (wx * (wx + 2.0 * sx) + wy * (wy + 2.0 * sy) + off))
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
def _fall_after(c4, c3, c2, c1, c0, time, t_max):
    """The next fall of a quartic through 0 after one at a time, before which it rises above 0."""
    # Taylor's coefficients about that fall: the same quartic in the time since.
    f0 = (((c4 * time + c3) * time + c2) * time + c1) * time + c0
    f1 = ((4.0 * c4 * time + 3.0 * c3) * time + 2.0 * c2) * time + c1
    f2 = (6.0 * c4 * time + 3.0 * c3) * time + c2
    f3 = 4.0 * c4 * time + c3
    return time + first_fall_quartic(c4, f3, f2, f1, f0, t_max, True)
