"""What a ball that keeps to a wall meets on its guide: other walls, in closed form.

The gap to a line, d - r, is linear in the place of the centre, and that to a circle, |p - c|^2 - L^2 or the negative of
it, differs from a linear one by q |p - p0|^2. Along a straight guide, p = p0 + s t, it is the polynomial

    q s^2 + (G.t) s + c,    G the gradient of the gap at p0, c its value there,

and along a circle of radius rho from the direction e towards t, with p = p0 + rho sin(phi) (t - tan(phi / 2) e), it is
one in u = tan(phi / 2), up to the factor 1 + u^2:

    (c - 2 P) u^2 + 2 rho (G.t) u + c,    P = rho (G.e) - 2 q rho^2.

A contact is where it falls through zero. As p0 is where the ball is now, c has the digits of that place, however large
the circle.
"""

from __future__ import annotations

import math

from wallkit.kernels.flight.guide import STRAIGHT
from wallkit.kernels.flight.joints import AT_VERTEX, following, one_sided, side_after
from wallkit.kernels.flight.point_in_corner import came_from
from wallkit.kernels.impact.arc_impact import FALLING_MOULD, holds
from wallkit.kernels.impact.line_impact import from_across, precedes, slack_of, stands_across
from wallkit.kernels.impact.polynomial_roots import NEVER, first_fall_quadratic
from wallkit.kernels.jit import kernel, rare_kernel
from wallkit.kernels.records import NO_HIT

LATER = 1.0 + 2.0**-20
"""Far beyond all rounding in a look that may only save work, never decide."""
SMOOTH_JOINT = 2.0**-20
"""Edges that meet at a smaller angle (radians) are met where they join, not before: that is off by r 2^-41 at most."""


@kernel
def falls(rho, ex, ey, tx, ty, c, gx, gy, q, from_behind):
    """Where on a guide a gap falls through 0 (s, or u up to 1): see above; from behind only after it has risen."""
    # q s^2 + (G.t) s + c on a line, (c - 2 P) u^2 + 2 rho (G.t) u + c on a circle.
    if rho == STRAIGHT:
        a, b = q, gx * tx + gy * ty
    else:
        a, b = c - 2.0 * rho * ((gx * ex + gy * ey) - 2.0 * q * rho), 2.0 * rho * (gx * tx + gy * ty)
    if not from_behind:
        return first_fall_quadratic(a, b, c, math.inf)
    # From behind it must rise (b > 0) and turn (a < 0): the fall is the larger root.
    discriminant = b * b - 4.0 * a * c
    if a >= 0.0 or b <= 0.0 or discriminant <= 0.0:
        return NEVER
    return -0.5 * (b + math.sqrt(discriminant)) / a


@kernel
def _keeps_off(rho, tx, ty, c, gx, gy, best):
    """Tell whether on a straight guide a gap c of the gradient G stays above 0 up to ``best``, whatever q >= 0 adds."""
    # It is at least c + (G.t) s: no root and no quotient for what lies behind, or too far ahead.
    along = gx * tx + gy * ty
    return rho == STRAIGHT and c > 0.0 and (along >= 0.0 or c > -along * best * LATER)


@kernel
def place_at(rho, ex, ey, tx, ty, x, y, u):
    """Centre after the way u on a guide."""
    if rho == STRAIGHT:
        return x + u * tx, y + u * ty
    # sin(phi) = 2 u / (1 + u^2) and p - p0 = rho sin(phi) (t - u e), with u = tan(phi / 2).
    way = rho * (2.0 * u / (1.0 + u * u))
    return x + way * (tx - u * ex), y + way * (ty - u * ey)


@kernel
def joined(model, held, edge, x, y, tolerance):
    """Tell whether a place is where an edge joins what holds the ball: what follows there is asked of the joint."""
    for end in range(2):
        joint = model.joints[2 * edge + end]
        if held < 0:
            if model.spokes[-2 - held] == joint.place:
                return True
            continue
        for other in range(2):
            if model.joints[2 * held + other].place == joint.place:
                # They share a joint. A contact there is no obstacle: topology says what follows, not distances.
                line = model.lines[edge]
                px, py = (line.ax, line.ay) if end == 0 else (line.bx, line.by)
                if abs(x - px) <= tolerance and abs(y - py) <= tolerance:
                    return True
    return False


@kernel
def follows(model, held, side, edge, to_right):
    """Tell whether an edge goes on smoothly from the one that holds the ball, on the ball's side.

    ``to_right`` tells the side of the edge that is asked: that to the right of its wall's direction, or the left one.
    """
    if held < 0:
        return False
    for end in range(2):
        joint = model.joints[2 * held + end]
        next_end = following(joint, end, side)
        if next_end >> 1 != edge or next_end == 2 * held + end:
            continue
        other = model.joints[next_end]
        # Directions go out from the joint: edges run on into each other where these are opposite, to rounding.
        across, ahead = joint.tx * other.ty - joint.ty * other.tx, joint.tx * other.tx + joint.ty * other.ty
        if ahead < 0.0 and abs(across) < SMOOTH_JOINT and (side_after(next_end, end, side) > 0.0) == to_right:
            return True
    return False


@kernel
def _by_joint(radius, slack):
    """How far from a joint a contact, found within the rounding of places, may be one with the joint itself."""
    # With a point that is over the angle between the edges, see ``AT_VERTEX``.
    return (AT_VERTEX if radius == 0.0 else 8.0) * slack


@rare_kernel
def meet_lines(
    model, start, stop, radius, held, side, last, rho, ex, ey, tx, ty, x, y, start_of, tolerance, best, feature
):
    """First contact with the lines of entries start to stop on the way ahead: (way, feature).

    ``start_of`` is where the flight or the slide that came here began, and its velocity: a point that touches a line is
    on the side of it from which it came.
    """
    slack = slack_of(tolerance, radius)
    # Two straight lines that share a vertex meet nowhere else.
    near = math.inf if radius == 0.0 and rho == STRAIGHT else _by_joint(radius, slack)
    from_x, from_y, from_vx, from_vy = start_of
    for k in range(start, stop):
        edge = int(model.ids[k])
        if edge == held:
            continue
        line = model.lines[edge]
        px, py = x - line.ax, y - line.ay
        d, u = px * line.nx + py * line.ny, py * line.nx - px * line.ny
        above = d > 0.0
        if radius == 0.0 and abs(d) <= tolerance and -tolerance <= u <= line.length + tolerance:
            if edge == last:
                above = tx * line.nx + ty * line.ny > 0.0
            else:
                above = came_from(model, edge, x, y, from_x, from_y, from_vx, from_vy, tolerance) > 0.0
            d = 0.0
        for turn in range(2):
            out = 1.0 if turn == 0 else -1.0
            if out < 0.0 and one_sided(model.one_sided, model.edge_wall[edge]):
                continue
            # The gap +-d - r has the gradient +-n and does not bend: q = 0.
            c = out * d - radius
            if rho == STRAIGHT and c <= 0.0 and out * (line.nx * tx + line.ny * ty) >= 0.0:
                continue  # the ball is behind, and this gap changes one way alone
            if _keeps_off(rho, tx, ty, c, out * line.nx, out * line.ny, best):
                continue
            from_behind = above != (out > 0.0) or stands_across(model.one_sided, model.edge_wall, edge, c, slack)
            way = falls(rho, ex, ey, tx, ty, c, out * line.nx, out * line.ny, 0.0, from_behind)
            if not (way < best or (way == best and precedes(edge, feature))):
                continue
            fx, fy = place_at(rho, ex, ey, tx, ty, x, y, way)
            # The foot on the edge, tau = (-ny, nx), as far beyond its ends as rounding may put it.
            foot = (fy - line.ay) * line.nx - (fx - line.ax) * line.ny
            if not -slack <= foot <= line.length + slack or follows(model, held, side, edge, out > 0.0):
                continue
            if joined(model, held, edge, fx - out * radius * line.nx, fy - out * radius * line.ny, near):
                continue
            best, feature = way, edge
    return best, feature


@rare_kernel
def meet_arcs(
    model, arcs, start, stop, radius, held, side, last, rho, ex, ey, tx, ty, x, y, start_of, tolerance, best, feature
):
    """First contact with the arcs of entries start to stop on the way ahead: (way, feature); see ``meet_lines``."""
    if arcs is None:
        return best, feature
    slack = slack_of(tolerance, radius)
    near = _by_joint(radius, slack)
    from_x, from_y, from_vx, from_vy = start_of
    for k in range(start, stop):
        edge = int(model.ids[k])
        if edge == held:
            continue
        arc = arcs[edge]
        wx, wy = x - arc.ax, y - arc.ay
        px, py = wx + arc.sx, wy + arc.sy
        power = wx * (wx + 2.0 * arc.sx) + wy * (wy + 2.0 * arc.sy)
        beyond = power >= 0.0
        if radius == 0.0 and abs(power) <= (2.0 * arc.radius + tolerance) * tolerance and holds(arc, px, py, tolerance):
            if edge == last:
                beyond = tx * px + ty * py > 0.0
            else:
                beyond = came_from(model, edge, x, y, from_x, from_y, from_vx, from_vy, tolerance) > 0.0
            power = 0.0
        for turn in range(2):
            out = 1.0 if turn == 0 else -1.0
            reach = arc.radius + out * radius
            if reach <= FALLING_MOULD * arc.radius:
                continue
            if out * arc.sweep < 0.0 and one_sided(model.one_sided, model.edge_wall[edge]):
                continue
            # The gap +-(|p|^2 - (R +- r)^2) = +-power - r (2 R +- r) has the gradient +-2 p, and q = +-1.
            c = out * power - radius * (2.0 * arc.radius + out * radius)
            if out > 0.0 and _keeps_off(rho, tx, ty, c, 2.0 * px, 2.0 * py, best):
                continue
            from_behind = beyond != (out > 0.0)
            from_behind = from_behind or stands_across(
                model.one_sided, model.edge_wall, edge, c, 2.0 * (arc.radius + radius) * slack
            )
            way = falls(rho, ex, ey, tx, ty, c, 2.0 * out * px, 2.0 * out * py, out, from_behind)
            if not (way < best or (way == best and precedes(edge, feature))):
                continue
            fx, fy = place_at(rho, ex, ey, tx, ty, x, y, way)
            qx, qy = fx - arc.ax + arc.sx, fy - arc.ay + arc.sy
            if not holds(arc, qx, qy, slack) or follows(model, held, side, edge, out * arc.sweep > 0.0):
                continue
            # The contact point is r from the centre towards the arc, or away from its middle in the hollow.
            inwards = out * radius / math.sqrt(qx * qx + qy * qy)
            if joined(model, held, edge, fx - inwards * qx, fy - inwards * qy, near):
                continue
            best, feature = way, edge
    return best, feature


@rare_kernel
def meet_corners(model, start, stop, radius, held, rho, ex, ey, tx, ty, x, y, tolerance, best, feature):
    """First contact with the corners of entries start to stop on the way ahead: (way, feature)."""
    slack = slack_of(tolerance, radius)
    for k in range(start, stop):
        vertex = int(model.ids[k])
        corner = model.corners[vertex]
        px, py = x - corner.x, y - corner.y
        # The gap |p|^2 - r^2 has the gradient 2 p, and q = 1.
        c = px * px + py * py - radius * radius
        if _keeps_off(rho, tx, ty, c, 2.0 * px, 2.0 * py, best):
            continue
        if _is_own(model, held, model.spokes[vertex]) or held == -2 - vertex:
            continue
        from_behind = stands_across(model.one_sided, model.corner_wall, vertex, c, 2.0 * radius * slack)
        way = falls(rho, ex, ey, tx, ty, c, 2.0 * px, 2.0 * py, 1.0, from_behind)
        if not (way < best or (way == best and precedes(-2 - vertex, feature))):
            continue
        fx, fy = place_at(rho, ex, ey, tx, ty, x, y, way)
        if from_across(
            model.one_sided, model.corner_wall, model.fans, model.corners, vertex, radius, slack,
            fx - corner.x, fy - corner.y,
        ):  # fmt: skip
            continue
        best, feature = way, -2 - vertex
    return best, feature


@kernel
def _is_own(model, held, place):
    """Tell whether a place is an end of the edge, or the corner, that holds the ball."""
    if place == NO_HIT:
        return False
    if held < 0:
        return model.spokes[-2 - held] == place
    return model.joints[2 * held].place == place or model.joints[2 * held + 1].place == place
