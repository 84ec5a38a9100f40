"""Time of impact with circular arcs: points and discs, from outside and from inside.

All arcs are kept counter-clockwise from a to b about their centre c, whatever way the wall runs. With e = p - c the
power of the point e.e - R^2 is taken as w.(w + 2 (a - c)) with w = p - a: near the arc nothing of the size R^2 cancels.
Half a chord, times v, is the root of (R v)^2 - (e x v)^2, from the distance at which the path passes the centre: a
grazing hit needs that. It is also the root of (e.v)^2 - v^2 power, which rounds as the place does, however far away the
centre is: that is taken where at most half of it cancels (inside nothing does).
"""

from __future__ import annotations

import math

from wallkit.kernels.impact.line_impact import precedes, slack_of, stands_across
from wallkit.kernels.jit import kernel, rare_kernel

WELL_KNOWN = 2.0**-20
"""The rounded power of a point on the arc is used while it changes the next chord by less than this part."""
MOULD = 2.0**-26
"""A disc fits into an arc as into a mould if their radii differ by less than this part: then it touches all of the arc
at once, when its centre is where the arc's is, and no place tells where the normal lies. Its centre may go this part of
the radius beyond, which is less than any drawing means; the rounding of its place (2^-52) then turns the normal by as
little. The ends of the arc do not stop it: where the arc is half a circle it passes them at a right angle.
"""
FALLING_MOULD = 2.0**-20
"""The same under gravity, where the distance of a centre from another is known to half the digits only."""


@kernel
def scan_arcs_point(arcs, ids, start, stop, one_sided, edge_wall, x, y, vx, vy, energy, last, tolerance, best, feature):
    """Earliest contact of a point with the arcs of entries start to stop.

    A line cuts a circle twice: into it, then out of it. If a and b lie on different sides of the line, one of
    the two cuts is on the arc: going counter-clockwise from the right of the path to its left passes the way out,
    else the way in. If they lie on one side, both cuts are on the arc or none: both if the arc holds the
    middle of the cap on the other side. The sides are the signs of the vertices, shared with the neighbours, so seams
    are as tight as those of lines.

    The way in is hit from outside and the way out from inside; which of them lies ahead follows from the side the
    point is on. On the arc itself (it was hit last, or is within rounding) the side is the one the point leaves to:
    inwards it meets the way out at t = -2 e.v / v^2.

    Returns:
        (time, feature, number of other arcs touched).
    """
    touched = 0
    if arcs is None:
        return best, feature, touched
    speed = math.sqrt(energy)
    for k in range(start, stop):
        arc = arcs[ids[k]]
        wx = x - arc.ax
        wy = y - arc.ay
        ex = wx + arc.sx
        ey = wy + arc.sy
        power = wx * (wx + 2.0 * arc.sx) + wy * (wy + 2.0 * arc.sy)
        along = ex * vx + ey * vy
        on = ids[k] == last
        if not on and abs(power) <= (2.0 * arc.radius + tolerance) * tolerance and holds(arc, ex, ey, tolerance):
            touched += 1
            on = True
        inside = along < 0.0 if on else power < 0.0
        if not inside and (on or along >= 0.0):
            continue
        enters, leaves = _cuts(arc, wx, wy, x, y, vx, vy)
        if one_sided is not None and one_sided[edge_wall[ids[k]]] != 0:
            enters = enters and arc.sweep > 0.0
            leaves = leaves and arc.sweep < 0.0
        if not leaves and (inside or not enters):
            continue
        # |e + t v|^2 = R^2 has the roots (-e.v -+ h) / v^2, h^2 = (e.v)^2 - v^2 power = (R |v|)^2 - (e x v)^2.
        cross = abs(ex * vy - ey * vx)
        square = (arc.radius * speed - cross) * (arc.radius * speed + cross)
        part = energy * power
        square = along * along - part if along * along - part > part else square
        root = math.sqrt(max(square, 0.0))
        # In at power / (h - e.v); from the arc itself the whole chord; out at (h - e.v) / v^2 or -power / (e.v + h).
        if not inside and enters:
            t = power / (root - along)
        elif on and energy * abs(power) > WELL_KNOWN * along * along:
            t = -2.0 * along / energy
        elif along <= 0.0:
            t = (root - along) / energy
        else:
            t = -power / (along + root)
        if t < best or (t == best and precedes(ids[k], feature)):
            best = t
            feature = ids[k]
    return best, feature, touched


@kernel
def _cuts(arc, wx, wy, x, y, vx, vy):
    """Tell whether the line along v enters, and whether it leaves, the circle through the arc: (enters, leaves)."""
    a_right = wy * vx - wx * vy >= 0.0
    b_right = (arc.bx - x) * vy - (arc.by - y) * vx >= 0.0
    # The line parts a from b: counter-clockwise from its right to its left passes the way out of the circle.
    if a_right != b_right:
        return b_right, a_right
    ex = wx + arc.sx
    ey = wy + arc.sy
    cross = ex * vy - ey * vx
    # a and b are on one side. Farther than R from the centre the line cuts nothing; else the arc holds both cuts if
    # it holds the middle of the cap beyond the line, a quarter turn from v on the other side.
    if cross * cross >= arc.radius * arc.radius * (vx * vx + vy * vy):
        return False, False
    both = holds(arc, -vy, vx, 0.0) if a_right else holds(arc, vy, -vx, 0.0)
    return both, both


@kernel
def holds(arc, ex, ey, slack):
    """Tell whether the arc lies in the direction e from its centre, give or take a length at its ends."""
    fx, fy = to_end(arc)
    return spans(arc.sx, arc.sy, fx, fy, arc.radius, is_wide(arc.sweep), ex, ey, slack)


@kernel
def to_end(arc):
    """Give the way from the centre of an arc to its end b."""
    return (arc.bx - arc.ax) + arc.sx, (arc.by - arc.ay) + arc.sy


@kernel
def is_wide(sweep):
    """Tell whether an arc is more than half a circle."""
    return abs(sweep) > math.pi


@kernel
def spans(sx, sy, fx, fy, radius, wide, ex, ey, slack):
    """``holds`` of an arc from s to f about its centre, which may be wide; without branches."""
    # s x e >= 0: e lies within half a turn past s; e x f >= 0: before f. Crosses are lengths at the arc, times R, so
    # slack R widens both ends by slack. A wide arc holds what meets either, a narrow one what meets both.
    least = -slack * radius
    past_a = sx * ey - sy * ex >= least
    before_b = ex * fy - ey * fx >= least
    # With slack the two overlap on the far side of the centre as well: there e.(s + f) < 0.
    ahead = (slack == 0.0) | (ex * (sx + fx) + ey * (sy + fy) >= least)
    return ((past_a | before_b) & wide) | (past_a & before_b & ahead & (not wide))


@kernel
def scan_arcs_disc(
    arcs, ids, start, stop, one_sided, edge_wall, radius, x, y, vx, vy, energy, last, tolerance, best, feature
):
    """Earliest contact of a disc with the arcs of entries start to stop.

    From outside the centre meets the circle of R + r where it comes nearer, from inside that of R - r where it goes
    away; a larger disc than the arc meets its ends only, one as large all of it at once (see MOULD). The contact counts
    if the arc lies in its direction (with the overlap of ``scan_disc`` at the ends); an overlap on the way in counts
    as t = 0, but for a one-sided wall only one by rounding, as there.

    A disc that rolls along a wall comes to a hollow arc on its tangent. Rounding may have it miss the circle of R - r,
    or touch it just before the arc begins, and then it is on the way out where it comes beside the arc: that counts
    as a contact too, if it is out there by no more than rounding.

    Returns:
        (time, feature).
    """
    if arcs is None:
        return best, feature
    slack = slack_of(tolerance, radius)
    speed = math.sqrt(energy)
    for k in range(start, stop):
        arc = arcs[ids[k]]
        wx = x - arc.ax
        wy = y - arc.ay
        ex = wx + arc.sx
        ey = wy + arc.sy
        power = wx * (wx + 2.0 * arc.sx) + wy * (wy + 2.0 * arc.sy)
        along = ex * vx + ey * vy
        cross = abs(ex * vy - ey * vx)
        from_outside = True
        from_inside = True
        if one_sided is not None and one_sided[edge_wall[ids[k]]] != 0:
            # A power changes by 2 |e| for each length: the slack of a gap of powers is 2 (R + r) times that of a gap.
            deep = 2.0 * (arc.radius + radius) * slack
            out_gap, in_gap = (
                power - radius * (2.0 * arc.radius + radius),
                -power - radius * (2.0 * arc.radius - radius),
            )
            from_outside = arc.sweep > 0.0 and not stands_across(one_sided, edge_wall, ids[k], out_gap, deep)
            from_inside = arc.sweep < 0.0 and not stands_across(one_sided, edge_wall, ids[k], in_gap, deep)
        t = -1.0
        # From outside the back of the arc comes first; beside the arc the disc may fly in, and meet the hollow.
        if power >= 0.0:
            if along >= 0.0:
                continue
            if from_outside:
                t = _time_to_outside(arc, radius, power, along, cross, speed, energy)
                if t >= 0.0 and not holds(arc, ex + t * vx, ey + t * vy, slack):
                    t = -1.0
        if t < 0.0 and from_inside:
            off = hidden_by_rounding(slack, arc.radius)
            t = _time_to_inside(arc, radius, ex, ey, power, along, cross, speed, energy, off, ids[k] == last)
            if t >= 0.0 and not holds(arc, ex + t * vx, ey + t * vy, slack):
                near = holds(arc, ex + t * vx, ey + t * vy, aside_of(slack, arc.radius))
                t = _time_beside(arc, radius, t, ex, ey, vx, vy, off) if near else -1.0
        if t >= 0.0 and (t < best or (t == best and precedes(ids[k], feature))):
            best = t
            feature = ids[k]
    return best, feature


@kernel
def _time_to_outside(arc, radius, power, along, cross, speed, energy):
    """Time at which the centre, outside and coming nearer, is at R + r from the arc's centre; -1 if never."""
    # e.e - (R + r)^2 = power - r (2 R + r) = c, and the smaller root is c / (h - e.v), e.v < 0.
    reach = arc.radius + radius
    c = power - radius * (2.0 * arc.radius + radius)
    part = energy * c
    if c > 0.0 and along * along - part > part:
        return c / (math.sqrt(along * along - part) - along)
    if reach * speed < cross:
        return -1.0
    root = math.sqrt((reach * speed - cross) * (reach * speed + cross))
    return c / (root - along) if c > 0.0 else 0.0


@kernel
def hidden_by_rounding(slack, radius):
    """How far from the centre of an arc a disc may be off that touches it."""
    return slack + radius * 2.0**-48


@kernel
def aside_of(slack, radius):
    """How far from the end of an arc a disc may go out through R - r to come beside it no farther out than that.

    Such a way out rises by w^2 / 2 R on a way w at least: w^2 <= 2 R off, and off <= slack + R 2^-48.
    """
    return slack * 2.0**19 + radius * 2.0**-17


@kernel
def is_mould(arc_radius, radius):
    """Tell whether a disc is as large as an arc, see MOULD."""
    return abs(arc_radius - radius) < MOULD * arc_radius


@kernel
def _time_to_inside(arc, radius, ex, ey, power, along, cross, speed, energy, off, again):
    """Time at which the centre goes away through R - r from the arc's centre, or by it; -1 if never."""
    # e.e - (R - r)^2 = power + r (2 R - r) = c. The centre leaves that circle at the larger root, (h - e.v) / v^2,
    # or -c / (e.v + h) where it moves outwards already.
    reach = arc.radius - radius
    c = power + radius * (2.0 * arc.radius - radius)
    if is_mould(arc.radius, radius):
        reach = MOULD * arc.radius
        c = ex * ex + ey * ey - reach * reach
    if reach <= 0.0:
        return -1.0
    if c >= 0.0 and along > 0.0:
        return 0.0 if power < 0.0 else -1.0
    # It left the hollow itself: c is rounding, and the chord from there on is -2 e.v / v^2.
    if again and energy * abs(c) > WELL_KNOWN * along * along:
        return -2.0 * along / energy if along < 0.0 else 0.0
    if (reach + off) * speed < cross:
        return -1.0
    square = (reach * speed - cross) * (reach * speed + cross)
    part = energy * c
    square = along * along - part if along * along - part > part else square
    if square <= 0.0:  # it passes by, the nearest place may lie behind
        return -along / energy if along < 0.0 else 0.0
    root = math.sqrt(square)
    if along <= 0.0:
        return (root - along) / energy
    return -c / (along + root)


@rare_kernel
def _time_beside(arc, radius, t, ex, ey, vx, vy, off):
    """Time after t at which the centre comes beside the end of the arc, if it is at R - r there; else -1."""
    fx, fy = to_end(arc)
    # g goes from the centre to the end on the side to which the disc goes round. Its centre is on that ray where
    # (e + t v) x g = 0, and R - r along it if it touches there.
    gx, gy = (arc.sx, arc.sy) if ex * vy - ey * vx > 0.0 else (fx, fy)
    later = (ex * gy - ey * gx) / (gx * vy - gy * vx) if gx * vy != gy * vx else -1.0
    out = (gx * (ex + later * vx) + gy * (ey + later * vy)) / arc.radius - (arc.radius - radius)
    return later if later > t and abs(out) <= off else -1.0
