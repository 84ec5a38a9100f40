"""Time of impact of falling balls with arcs; lines, corners and what arcs share with them are in ``gravity_impact``."""

from __future__ import annotations

from wallkit.kernels.impact.arc_impact import FALLING_MOULD, is_wide, to_end
from wallkit.kernels.impact.drag_motion import along, pulled, speed_after
from wallkit.kernels.impact.gravity_impact import (
    HULL_ROUNDING,
    LATER,
    circle_fall,
    fall_from_behind,
    hull_of,
    line_fall,
    range_of,
)
from wallkit.kernels.impact.leaving import LEVEL_SPEED, left_along
from wallkit.kernels.impact.line_impact import precedes, slack_of
from wallkit.kernels.impact.polynomial_roots import NEVER
from wallkit.kernels.jit import kernel, rare_kernel

SMOOTH_ON = 1.0 - 2.0**-20
"""Cosine between the normals of a wall that a point has left and of an arc that goes on from it: some 2^-10 apart."""


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
        least, most = range_of(ax, ay, bx, by, cx, cy, arc.sx, arc.sy)
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
    ax, ay = pulled(drag, vx, gx), pulled(drag, vy, gy)
    c4, c3 = 0.25 * (ax * ax + ay * ay), vx * ax + vy * ay
    c2, bent = vx * vx + vy * vy + ex * ax + ey * ay, abs(ex * ax) + abs(ey * ay)
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
        if again and not from_behind and _only_rises(drag, side * c4, side * c3, b2, b1, c0, bent, best):
            other = is_mould
            continue
        t = circle_fall(
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
            t = circle_fall(
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
        t = line_fall(drag, far, a, b, c) if c > 0.0 else fall_from_behind(drag, far, 0.5 * a, b, c)
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
def _only_rises(drag, c4, c3, c2, c1, c0, bent, span):
    """Tell whether a gap that begins at 0, to rounding, surely comes to no fall through 0 in a span of time.

    It is c0 + q t, q a cubic that lies between the four coefficients of its Bezier curve. Where these are a quarter of
    q(0) = c1 and more, the gap is at most 0 up to t = 4 |c0| / c1, and until then its slope keeps most of c1. With drag
    ``bent`` is what the acceleration has in c2.
    """
    t = 4.0 * abs(c0) / (c1 if c1 > 0.0 else 1.0)
    # q = c1 + c2 t + c3 t^2 + c4 t^3 on [0, span] has the Bezier coefficients c1, c1 + a/3, c1 + (2 a + b)/3 and
    # c1 + a + b + c.
    a, b, c = c2 * span, c3 * span * span, c4 * span * span * span
    least = 0.25 * c1 + HULL_ROUNDING * (abs(a) + abs(b) + abs(c))
    bend = abs(c2)
    if drag is not None:
        # s is less than t^2 / 2 by k t / 3 of that at most, and so are the terms in which it stands once; s^2 twice.
        least += drag * span * (bent * span + abs(b) + abs(c))
        bend += drag * bent * t
    keeps = c1 > 4.0 * t * (bend + t * (abs(c3) + t * abs(c4)))
    return keeps and c1 + a / 3.0 > least and c1 + (2.0 * a + b) / 3.0 > least and c1 + a + b + c > least
