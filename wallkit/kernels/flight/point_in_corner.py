"""Points in a corner: several lines within rounding of where the ball is.

Which side of them the ball is on cannot be read from its position. It follows from where the ball came from: the
last flight did not cross them, so its start tells the side; and if that start was as close, the flight left there
receding from them.
"""

from __future__ import annotations

import math

from wallkit.kernels.flight.joints import next_face
from wallkit.kernels.flight.motion import reflect
from wallkit.kernels.impact.arc_impact import holds
from wallkit.kernels.impact.contact_normal import normal_at, outward
from wallkit.kernels.index.grid import home
from wallkit.kernels.jit import kernel, rare_kernel
from wallkit.kernels.records import AMBIGUOUS, COLLAPSES, NO_HIT

SAME = 1e-9
"""Two outgoing velocities closer than this part of the speed are one: an angle of pi / n as drawn has a limit."""
TURNS = 200_000


@rare_kernel
def settle(model, last, side, x, y, vx, vy, from_x, from_y, from_vx, from_vy, tolerance, still):
    """Find the edge that a point in a corner meets next, at once; or NO_HIT if it is free to go.

    ``side`` is that of the edge hit last on which the point is, where it is known, or 0: from it follows which face of
    another edge at the same vertex the point can meet (see ``joints``), under gravity.

    Returns AMBIGUOUS if starting with the other wall would send the point elsewhere: an exact corner hit that
    has no limit; COLLAPSES if restitution takes all speed before the point gets out.
    """
    cell = model.cells[home(model, model.grid, x, y)]
    found, found_side, found_joined, last_side = NO_HIT, 0.0, False, side * outward(model.arcs, last)
    if side == 0.0:
        last_side = _left(model, last, x, y, vx, vy, from_x, from_y, from_vx, from_vy, tolerance)
    closest = -2.0
    for k in range(cell.first, cell.corners):
        edge = int(model.ids[k])
        if edge == last or not touching(model, model.arcs, edge, x, y, tolerance)[0]:
            continue
        joined, came = _face_at_joint(model, model.joints, last, side, edge, x, y, tolerance)
        if not joined:
            came = came_from(model, edge, x, y, from_x, from_y, from_vx, from_vy, tolerance)
        if came == 0.0:
            continue
        # Of the edges that it runs against, the one that leans most over its way is the next one in the wedge.
        lean = _lean(model, last, last_side, edge, came, x, y, vx, vy, tolerance)
        if lean > closest:
            closest, found, found_side, found_joined = lean, edge, came, joined
    if found == NO_HIT:
        return NO_HIT
    if still > 0:
        return found
    # Under gravity both orders are compared at the hit itself, see ``vertex.order_shows``; here where it has not flown.
    if found_joined and (x != from_x or y != from_y):
        ax, ay = _leave(model, found, found_side, last, last_side, x, y, vx, vy)
        return COLLAPSES if _is_nothing(model.restitution, ax, ay, vx, vy) else found
    return _outcome(model, last, last_side, found, found_side, x, y, from_vx, from_vy)


@kernel
def _face_at_joint(model, joints, last, side, edge, x, y, tolerance):
    """Side, as of ``came_from``, of an edge that shares the vertex with the one hit last: (shares it, side or 0)."""
    if joints is None:
        return False, 0.0
    if side == 0.0:
        return False, 0.0
    joined, face = next_face(model, last, side, edge, x, y, tolerance)
    return joined, face * outward(model.arcs, edge)


@rare_kernel
def came_from(model, edge, x, y, from_x, from_y, from_vx, from_vy, tolerance):
    """Side of an edge (1 that of ``normal_at``, or -1) from which the point came: that of where its flight began.

    If it began on the edge too, the point left there on the side to which it flew. If it began beside an end of the
    edge, within rounding of its line, the place of the start is still the best that is known.
    """
    side = _side(model, model.arcs, edge, from_x, from_y, tolerance)
    if side == 0.0 and not touching(model, model.arcs, edge, from_x, from_y, tolerance)[0]:
        side = _side(model, model.arcs, edge, from_x, from_y, 0.0)
    if side == 0.0:
        # It began on the edge, too: it flew off to the side to which its velocity points there. (Here an arc has turned
        # by the angle of the way between, far more than what lifts a ball off it that leaves along it.)
        nx, ny, _twice = normal_at(model, model.arcs, edge, from_x, from_y)
        side = from_vx * nx + from_vy * ny
    return 1.0 if side > 0.0 else -1.0


@rare_kernel
def _left(model, last, x, y, vx, vy, from_x, from_y, from_vx, from_vy, tolerance):
    """Side of the edge hit last on which the point is: it recedes from it. Along it, the side from which it came."""
    nx, ny, _twice = normal_at(model, model.arcs, last, x, y)
    away = vx * nx + vy * ny
    # What bounces recedes by more than the rounding of v.n, some 2^-51 |v| |n|; less is a flight along the wall.
    if abs(away) > 2.0**-40 * (abs(vx) + abs(vy)) * (abs(nx) + abs(ny)):
        return 1.0 if away > 0.0 else -1.0
    return came_from(model, last, x, y, from_x, from_y, from_vx, from_vy, tolerance)


@rare_kernel
def _lean(model, last, side, edge, came, x, y, vx, vy, tolerance):
    """How closely an edge leans over the way along the last wall, -1 to 1; -2 if the point does not run against it.

    ``side`` and ``came`` are the sides of the two on which the point is. An edge that ends here and goes off behind the
    last wall, or along it, cannot be met when leaving that wall.
    """
    _touched, starts, ends = touching(model, model.arcs, edge, x, y, tolerance)
    nx, ny, _twice = normal_at(model, model.arcs, edge, x, y)
    toward = vx * nx + vy * ny
    if (came > 0.0) == (toward > 0.0) or toward == 0.0:
        return -2.0
    if _passes(model.one_sided, model, model.arcs, edge, came):
        return -2.0
    mx, my, _twice = normal_at(model, model.arcs, last, x, y)
    mx, my = side * mx, side * my
    # d along the edge, away from the corner: against its own direction where it ends here.
    dx, dy = -ny, nx
    rise = dx * mx + dy * my
    if ends and not starts:
        dx, dy, rise = -dx, -dy, -rise
    if (starts or ends) and rise <= 0.0:
        return -2.0
    if rise < 0.0:
        dx, dy = -dx, -dy
    # t along the last wall, the way that the point goes. The cosine between d and t is how closely the edge leans.
    tx, ty = -my, mx
    if tx * vx + ty * vy < 0.0:
        tx, ty = -tx, -ty
    scale = math.sqrt((dx * dx + dy * dy) * (tx * tx + ty * ty))
    return (dx * tx + dy * ty) / scale


@rare_kernel
def touching(model, arcs, edge, x, y, tolerance):
    """Tell whether a point is on an edge, and at its start or its end: (touches, starts here, ends here)."""
    if arcs is not None:
        arc = arcs[edge]
        if arc.radius > 0.0:
            touched = _side(model, arcs, edge, x, y, tolerance) == 0.0 and holds(
                arc, x - arc.ax + arc.sx, y - arc.ay + arc.sy, tolerance
            )
            return touched, _near(x - arc.ax, y - arc.ay, tolerance), _near(x - arc.bx, y - arc.by, tolerance)
    line = model.lines[edge]
    ex, ey = x - line.ax, y - line.ay
    u = ey * line.nx - ex * line.ny
    touched = _side(model, arcs, edge, x, y, tolerance) == 0.0 and -tolerance <= u <= line.length + tolerance
    return touched, u <= tolerance, u >= line.length - tolerance


@rare_kernel
def _near(dx, dy, tolerance):
    return abs(dx) <= 2.0 * tolerance and abs(dy) <= 2.0 * tolerance


@rare_kernel
def _side(model, arcs, edge, x, y, tolerance):
    """Which side of an edge's line or circle a point is on: that of ``normal_at`` above 0; 0 within rounding."""
    if arcs is not None:
        arc = arcs[edge]
        if arc.radius > 0.0:
            wx, wy = x - arc.ax, y - arc.ay
            power = wx * (wx + 2.0 * arc.sx) + wy * (wy + 2.0 * arc.sy)
            return 0.0 if abs(power) <= (2.0 * arc.radius + tolerance) * tolerance else power
    line = model.lines[edge]
    d = (x - line.ax) * line.nx + (y - line.ay) * line.ny
    return 0.0 if abs(d) <= tolerance else d


@rare_kernel
def _passes(one_sided, model, arcs, edge, came):
    """Tell whether a ball on the side ``came`` (see ``_side``) passes an edge of a one-sided wall."""
    if one_sided is None:
        return False
    if one_sided[model.edge_wall[edge]] == 0:
        return False
    # One-sided: solid from its outward side alone.
    return came * outward(arcs, edge) < 0.0


@rare_kernel
def _outcome(model, first, first_side, second, second_side, x, y, vx, vy):
    """Tell what bouncing off two edges in turn comes to, whichever is first: the second edge if that is the same."""
    ax, ay = _leave(model, first, first_side, second, second_side, x, y, vx, vy)
    if _is_nothing(model.restitution, ax, ay, vx, vy):
        return COLLAPSES
    return AMBIGUOUS if order_matters(model, first, first_side, second, second_side, x, y, vx, vy) else second


@rare_kernel
def order_matters(model, first, first_side, second, second_side, x, y, vx, vy):
    """Tell whether bouncing off two edges in turn comes to something else where the second one is the first."""
    ax, ay = _leave(model, first, first_side, second, second_side, x, y, vx, vy)
    bx, by = _leave(model, second, second_side, first, first_side, x, y, vx, vy)
    # Reflections at two walls commute, bounce for bounce, where their angle is pi / n; else the order shows.
    return (ax - bx) * (ax - bx) + (ay - by) * (ay - by) > SAME * SAME * (vx * vx + vy * vy)


@kernel
def _is_nothing(restitution, ax, ay, vx, vy):
    """Tell whether restitution has taken all speed of a ball: a is what is left of v."""
    if restitution is None:
        return False
    return ax * ax + ay * ay <= SAME * SAME * (vx * vx + vy * vy)


@rare_kernel
def _leave(model, first, first_side, second, second_side, x, y, vx, vy):
    """Velocity after bouncing off two edges in turn until it recedes from both, or restitution has taken all of it.

    In a wedge of the angle a with e <= (1 - sin a) / (1 + sin a) it never recedes: what is left then of its speed only
    falls, and 2^-10 of what ``_is_nothing`` asks changes neither that answer nor that of two orders.
    """
    ax, ay, a_twice = normal_at(model, model.arcs, first, x, y)
    bx, by, b_twice = normal_at(model, model.arcs, second, x, y)
    ax, ay, bx, by = first_side * ax, first_side * ay, second_side * bx, second_side * by
    a_wall, b_wall = model.edge_wall[first], model.edge_wall[second]
    from_vx, from_vy = 2.0**-10 * vx, 2.0**-10 * vy
    # In a wedge of the angle a there are at most ceil(pi / a) bounces: unfolded, the way is one straight line.
    for _turn in range(TURNS):
        receding = True
        if vx * ax + vy * ay < 0.0:
            vx, vy, _energy = reflect(model.restitution, a_wall, ax, ay, a_twice, vx, vy, vx * vx + vy * vy)
            receding = False
        if vx * bx + vy * by < 0.0:
            vx, vy, _energy = reflect(model.restitution, b_wall, bx, by, b_twice, vx, vy, vx * vx + vy * vy)
            receding = False
        if receding or _is_nothing(model.restitution, vx, vy, from_vx, from_vy):
            break
    return vx, vy
