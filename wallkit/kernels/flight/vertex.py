"""A point at a vertex, under gravity: which faces of the edges that meet there it can touch.

The edges go off from a vertex in an order, ``Joint``, and divide what is round it into sectors. A point that comes to
the vertex comes out of one of them, and just one face of each of the two edges beside that looks into it: it can
touch these two and no other, whatever rounding says about lines and circles so near to their ends.

For sectors, faces and ends see ``joints``, and docs/where-is-inside.md for why no point leaves its sector.
"""

from __future__ import annotations

import math

from wallkit.kernels.flight.joints import AT_VERTEX, NO_END, end_at, leading_along, left_face, one_sided, other_bound
from wallkit.kernels.flight.motion import reflect
from wallkit.kernels.flight.obstacles import SMOOTH_JOINT
from wallkit.kernels.flight.point_in_corner import order_matters, touching
from wallkit.kernels.flight.tip import may_hop_on
from wallkit.kernels.impact.contact_normal import normal_at, outward
from wallkit.kernels.impact.drag_motion import pulled
from wallkit.kernels.impact.leaving import LEVEL_SPEED
from wallkit.kernels.jit import kernel, rare_kernel
from wallkit.kernels.records import NO_HIT

LEFT_OUT = 2.0**-20
"""Part of an edge in which bounces are left out before a rest that is sure, see ``rests_anyhow``."""
TOGETHER = 2.0**-20
"""Edges may go off from a vertex at a smaller angle (radians), and cosines not tell them apart: that of 2^-26 is 1."""


@rare_kernel
def first_face(model, gravity, feature, end, last, ball, start, tolerance):
    """Which face a point meets that has come to a vertex at an end of an edge which it seems to meet.

    Returns:
        (edge or NO_HIT, face, edge along which a point that meets none flies past the vertex or NO_HIT, face of that).
    """
    _x, _y, vx, vy, _energy = ball
    first, second = _sector(model, gravity, end, last, ball, start, tolerance)
    if first == NO_END:
        return feature, 0.0, NO_HIT, 0.0
    one, other = model.joints[first], model.joints[second]
    # Normals into the sector: the first edge's to its left, going out, the second one's to its right.
    into_first, into_second = vy * one.tx - vx * one.ty, vx * other.ty - vy * other.tx
    level = LEVEL_SPEED * (abs(vx) + abs(vy))
    first_face, second_face = left_face(first), -left_face(second)
    if into_first < -level and (feature == first >> 1 or into_second >= -level):
        return first >> 1, first_face, NO_HIT, 0.0
    if into_second < -level and (feature == second >> 1 or into_first >= -level):
        return second >> 1, second_face, NO_HIT, 0.0
    if into_first < -level:  # what it seemed to meet looks into another sector: the one more in its way
        if into_first <= into_second:
            return first >> 1, first_face, NO_HIT, 0.0
        return second >> 1, second_face, NO_HIT, 0.0
    # It goes on in its sector, along an edge: the one on which it goes out, or else the one along which it came.
    out_first, out_second = vx * one.tx + vy * one.ty, vx * other.tx + vy * other.ty
    on_first, on_second = abs(into_first) <= level, abs(into_second) <= level
    if on_first and (out_first > 0.0 or not (on_second and out_second > 0.0)):
        beside, face, bends = first, first_face, _bend(model, gravity, first, vx, vy)
    else:
        beside, face, bends = second, second_face, -_bend(model, gravity, second, vx, vy)
    if not (on_first or on_second):
        return NO_HIT, 0.0, NO_HIT, 0.0
    if bends < 0.0 and (out_first if beside == first else out_second) > 0.0:
        return beside >> 1, face, NO_HIT, 0.0  # it is pressed on it
    return NO_HIT, 0.0, beside >> 1, face


@rare_kernel
def order_shows(model, feature, face, ball, tolerance):
    """Tell whether a point that comes to a vertex, and meets a face there, bounces on elsewhere than from the other.

    It is asked of the velocity at the hit. A point that recedes from the other face after the first bounce is free.
    """
    x, y, vx, vy, _energy = ball
    own = end_at(model, feature, x, y, tolerance)
    if own == NO_END or not touching(model, model.arcs, feature, x, y, tolerance)[0]:
        return False
    end, other_face = other_bound(model, own, face)
    other = end >> 1
    if other_face == 0.0 or other == feature or not touching(model, model.arcs, other, x, y, tolerance)[0]:
        return False
    # Of a sector of half a turn or more the other bound is not met after a bounce.
    one, two = model.joints[own], model.joints[end]
    if face * left_face(own) * (one.tx * two.ty - one.ty * two.tx) <= TOGETHER:
        return False
    side, other_side = face * outward(model.arcs, feature), other_face * outward(model.arcs, other)
    nx, ny, twice = normal_at(model, model.arcs, feature, x, y)
    bounced_x, bounced_y, _square = reflect(
        model.restitution, model.edge_wall[feature], nx, ny, twice, vx, vy, vx * vx + vy * vy
    )
    mx, my, _twice = normal_at(model, model.arcs, other, x, y)
    if other_side * (bounced_x * mx + bounced_y * my) >= 0.0:
        return False
    return order_matters(model, feature, side, other, other_side, x, y, vx, vy)


@rare_kernel
def rests_anyhow(model, gravity, feature, face, ball, tolerance):
    """Tell whether a point that comes to a vertex, and meets a face there, ends at rest there from the other one, too.

    Where both edges rise from the vertex, by a = -g.t for each unit of way, a point of the energy v^2 / 2 gets no
    farther along either than v^2 / 2 a. Walls with restitution e < 1 take speed from it at every bounce, and there is
    no end of these before it rests. So do walls with e = 1 that take speed along them, where no hop between them is
    stable (see ``tip``). So only the bounces are not known that are left out, all of them within 2^-20
    of the edges, a millionth: no picture shows them. A longer way is not left out.
    """
    x, y, vx, vy, _energy = ball
    own = end_at(model, feature, x, y, tolerance)
    end, _face = other_bound(model, own, face)
    if model.restitution is None or not (_rises(model, gravity, own, vx, vy) and _rises(model, gravity, end, vx, vy)):
        return False
    one, other = 2 * model.edge_wall[feature], 2 * model.edge_wall[end >> 1]
    e, f = model.restitution[one], model.restitution[one + 1]
    other_e, other_f = model.restitution[other], model.restitution[other + 1]
    if e < 1.0 and other_e < 1.0:
        return True
    if not (e == 1.0 and other_e == 1.0 and f < 1.0 and other_f < 1.0):
        return False
    return not may_hop_on(gravity, model.joints[own], model.joints[end], f, other_f)


@kernel
def _rises(model, gravity, end, vx, vy):
    """Tell whether an edge rises from its end so much that a point of speed v keeps to the first 2^-20 of it."""
    joint, line = model.joints[end], model.lines[end >> 1]
    rise = -(gravity[0] * joint.tx + gravity[1] * joint.ty)
    length = math.sqrt((line.bx - line.ax) * (line.bx - line.ax) + (line.by - line.ay) * (line.by - line.ay))
    return vx * vx + vy * vy <= LEFT_OUT * 2.0 * rise * length


@kernel
def _sector(model, gravity, end, last, ball, start, tolerance):
    """The sector of a vertex out of which a point has come to it: the ends to its right and to its left."""
    x, y, _vx, _vy, _energy = ball
    # A flight too short to have left its first wall by more than rounding came along that, on its side of it.
    side = 0.0
    own = end_at(model, last, x, y, tolerance) if last >= 0 else NO_END
    if own != NO_END and model.joints[own].place == model.joints[end].place:
        side = _kept_side(model, last, own, ball, start, tolerance)
    if side != 0.0:
        other, face = other_bound(model, own, side)
        if face == 0.0:
            return NO_END, NO_END
        return (own, other) if side == left_face(own) else (other, own)
    return _sector_of_way(model, gravity, end, ball, tolerance)


@kernel
def _kept_side(model, last, own, ball, start, tolerance):
    """Side of the edge hit last on which a flight went along it, within rounding, to its end; else 0."""
    x, y, vx, vy, _energy = ball
    from_x, from_y, from_vx, from_vy = start
    if not touching(model, model.arcs, last, from_x, from_y, tolerance)[0]:
        return 0.0
    joint = model.joints[own]
    # |v.n| |p - p0| / |v|: how far it parts from the edge, going straight
    across = abs(vy * joint.tx - vx * joint.ty) * (abs(x - from_x) + abs(y - from_y))
    if across > 2.0 * AT_VERTEX * tolerance * (abs(vx) + abs(vy)):
        return 0.0
    nx, ny, _twice = normal_at(model, model.arcs, last, from_x, from_y)
    out = outward(model.arcs, last)
    return out if from_vx * nx + from_vy * ny > 0.0 else -out


@kernel
def _sector_of_way(model, gravity, end, ball, tolerance):
    """``_sector`` by the way that a point came: the ends to its right and to its left, whose faces are solid."""
    place = int(model.joints[end].place)
    _x, _y, vx, vy, _energy = ball
    wx, wy = -vx, -vy
    pull = abs(gravity[0]) + abs(gravity[1])
    if vx * vx + vy * vy <= 2.0 * pull * tolerance:
        wx, wy = gravity[0], gravity[1]  # at the top of its way: p - v t + g t^2 / 2
    # Nearest to the way lies an edge beside it; of edges that go off together the bend tells.
    end = nearest = leading_along(model, place, wx, wy)
    lies_left = _is_left(model, gravity, end, wx, wy, ball, tolerance)
    while True:
        joint = model.joints[end]
        other = int(joint.counter) if lies_left else int(joint.clockwise)
        first, second = (end, other) if lies_left else (other, end)
        if other == nearest or not _together(model, first, second):
            break
        if _is_left(model, gravity, other, wx, wy, ball, tolerance) != lies_left:
            break
        end = other
    first, second = (end, other) if lies_left else (other, end)
    first, first_face = _solid(model, first, left_face(first))
    second, second_face = _solid(model, second, -left_face(second))
    return (first, second) if first_face != 0.0 and second_face != 0.0 else (NO_END, NO_END)


@kernel
def _together(model, first, second):
    """Tell whether edges go off from a vertex in one direction, to rounding, the second to the left of the first."""
    one, other = model.joints[first], model.joints[second]
    across = one.tx * other.ty - one.ty * other.tx
    if one.tx * other.tx + one.ty * other.ty < 0.0 or not 0.0 <= across <= TOGETHER:
        return False
    return across > 0.0 or curvature_out(model.arcs, second) >= curvature_out(model.arcs, first)


@kernel
def _solid(model, end, face):
    """The end if its face stops a ball, or else the next one beyond it with its face; face 0 if there is none."""
    if face > 0.0 or not one_sided(model.one_sided, model.edge_wall[end >> 1]):
        return end, face
    return other_bound(model, end, -face)


@kernel
def _is_left(model, gravity, end, wx, wy, ball, tolerance):
    """Tell whether the way w, out from a vertex, along which a point came lies to the left of an edge."""
    joint, line = model.joints[end], model.lines[end >> 1]
    x, y, vx, vy, _energy = ball
    along, across = wx * joint.tx + wy * joint.ty, wy * joint.tx - wx * joint.ty
    if along <= 0.0:
        return across > 0.0
    # It came beside the edge, and has not crossed it: how far to the left it was where it passed the edge's end tells.
    ex, ey = (x - line.ax, y - line.ay) if end & 1 == 0 else (x - line.bx, y - line.by)
    beyond, off = -(ex * joint.tx + ey * joint.ty), ey * joint.tx - ex * joint.ty
    off += across * max(beyond, 0.0) / along
    if abs(off) > tolerance:
        return off > 0.0
    # At the time t before it was at w t + a t^2 / 2, and the edge bends too: across t + h t^2 / 2. Where it has
    # been on that side by no more than rounding, across^2 / 2 |h|, the bend tells.
    bend = _bend(model, gravity, end, vx, vy)
    return bend > 0.0 if across * across <= 2.0 * abs(bend) * tolerance else across > 0.0


@kernel
def _bend(model, gravity, end, vx, vy):
    """How a flight along an edge bends away from it, to the left of the way out from its end: a.n - k v^2."""
    joint = model.joints[end]
    ax, ay = pulled(model.drag, vx, gravity[0]), pulled(model.drag, vy, gravity[1])
    return ay * joint.tx - ax * joint.ty - curvature_out(model.arcs, end) * (vx * vx + vy * vy)


@kernel
def curvature_out(arcs, end):
    """Curvature of an edge, above 0 where it bends to the left on its way out from an end."""
    if arcs is not None:
        arc = arcs[end >> 1]
        if arc.radius > 0.0:
            return 1.0 / arc.radius if (arc.sweep > 0.0) == (end & 1 == 0) else -1.0 / arc.radius
    return 0.0


@rare_kernel
def free_side(model, gravity, edge):
    """On which side of a line along gravity a point lies that is laid on it: 1 the outward one, or -1.

    Nothing presses it there. Of a closed wall it is the outward side, where balls are free; of an open one that to
    which the wall turns below the line, for what comes down along it comes to that hollow. Else it is the outward one.
    """
    first = last = edge
    while first > 0 and model.edge_wall[first - 1] == model.edge_wall[edge]:
        first -= 1
    while last + 1 < len(model.edge_wall) and model.edge_wall[last + 1] == model.edge_wall[edge]:
        last += 1
    if first < last and model.joints[2 * first].place == model.joints[2 * last + 1].place:
        return 1.0
    line = model.lines[edge]
    below = edge
    for _edge in range(last - first + 1):
        end = 2 * below
        if model.joints[end].tx * gravity[0] + model.joints[end].ty * gravity[1] > 0.0:
            end += 1
        joint = model.joints[end]
        following_end = int(joint.counter)
        if following_end == end or int(joint.clockwise) != following_end:
            return 1.0  # it ends here, or walls go off to both sides
        there = model.joints[following_end]
        # Down is against the way out from the lower end.
        turn = there.tx * joint.ty - there.ty * joint.tx
        if abs(turn) <= SMOOTH_JOINT and there.tx * joint.tx + there.ty * joint.ty < 0.0:
            turn = curvature_out(model.arcs, following_end)
        if turn != 0.0:
            # Outward is n, and to the left of the way down lies (-gy, gx).
            out_left = line.ny * gravity[0] - line.nx * gravity[1] > 0.0
            return 1.0 if (turn > 0.0) == out_left else -1.0
        below = following_end >> 1
    return 1.0
