"""Points in a corner: several lines within rounding of where the ball is.

Which side of them the ball is on cannot be read from its position. It follows from where the ball came from: the
last flight did not cross them, so its start tells the side; and if that start was as close, the flight left there
receding from them.
"""

from __future__ import annotations

import math

from wallkit.kernels.flight.motion import reflect
from wallkit.kernels.impact.arc_impact import holds
from wallkit.kernels.index.grid import home
from wallkit.kernels.jit import kernel, rare_kernel
from wallkit.kernels.records import AMBIGUOUS, COLLAPSES, NO_HIT

SAME = 1e-9
"""Two outgoing velocities closer than this part of the speed are one: an angle of pi / n as drawn has a limit."""
TURNS = 200_000
RISE = 2.0**-30
"""An edge that rises by less is straight on: what it turns a sliding point by is lost in the rounding of its normal."""


@rare_kernel
def settle(model, last, x, y, vx, vy, from_x, from_y, from_vx, from_vy, tolerance, still):
    """Find the edge that a point in a corner meets next, at once; or NO_HIT if it is free to go.

    Returns AMBIGUOUS if starting with the other wall would send the point elsewhere: an exact corner hit that
    has no limit; COLLAPSES if restitution takes all speed before the point gets out.
    """
    cell = model.cells[home(model, model.grid, x, y)]
    found = NO_HIT
    closest = -2.0
    for k in range(cell.first, cell.corners):
        edge = int(model.ids[k])
        lean = _lean(model, last, edge, x, y, vx, vy, from_x, from_y, from_vx, from_vy, tolerance)
        if lean > closest:
            closest, found = lean, edge
    if found == NO_HIT:
        return NO_HIT
    if still > 0:
        return found
    last_side = _left(model, last, x, y, vx, vy, from_x, from_y, from_vx, from_vy, tolerance)
    found_side = _came(model, found, x, y, from_x, from_y, from_vx, from_vy, tolerance)
    return _outcome(model, last, last_side, found, found_side, x, y, from_vx, from_vy)


@rare_kernel
def _came(model, edge, x, y, from_x, from_y, from_vx, from_vy, tolerance):
    """Side of an edge (1 that of ``normal_at``, or -1) from which the point came: that of where its flight began.

    If it began on the edge too, the point left there on the side to which it flew. If it began beside an end of the
    edge, within rounding of its line, the place of the start is still the best that is known.
    """
    side = _side(model, model.arcs, edge, from_x, from_y, tolerance)
    if side == 0.0 and not _touch(model, model.arcs, edge, from_x, from_y, tolerance)[0]:
        side = _side(model, model.arcs, edge, from_x, from_y, 0.0)
    if side == 0.0:
        nx, ny, _twice = normal_at(model, model.arcs, edge, x, y)
        side = from_vx * nx + from_vy * ny
    return 1.0 if side > 0.0 else -1.0


@rare_kernel
def _left(model, last, x, y, vx, vy, from_x, from_y, from_vx, from_vy, tolerance):
    """Side of the edge hit last on which the point is: it recedes from it. Along it, the side from which it came."""
    nx, ny, _twice = normal_at(model, model.arcs, last, x, y)
    away = vx * nx + vy * ny
    if abs(away) > 2.0**-40 * (abs(vx) + abs(vy)) * (abs(nx) + abs(ny)):
        return 1.0 if away > 0.0 else -1.0
    return _came(model, last, x, y, from_x, from_y, from_vx, from_vy, tolerance)


@rare_kernel
def _lean(model, last, edge, x, y, vx, vy, from_x, from_y, from_vx, from_vy, tolerance):
    """How closely an edge leans over the way along the last wall, -1 to 1; -2 if the point does not run against it.

    An edge that ends here and goes off behind the last wall, or along it, cannot be met when leaving that wall.
    """
    if edge == last:
        return -2.0
    touches, starts, ends = _touch(model, model.arcs, edge, x, y, tolerance)
    if not touches:
        return -2.0
    nx, ny, _twice = normal_at(model, model.arcs, edge, x, y)
    came = _came(model, edge, x, y, from_x, from_y, from_vx, from_vy, tolerance)
    toward = vx * nx + vy * ny
    if (came > 0.0) == (toward > 0.0) or toward == 0.0:
        return -2.0
    if _passes(model.one_sided, model, model.arcs, edge, came):
        return -2.0
    mx, my, _twice = normal_at(model, model.arcs, last, x, y)
    side = _left(model, last, x, y, vx, vy, from_x, from_y, from_vx, from_vy, tolerance)
    mx, my = side * mx, side * my
    dx, dy = -ny, nx
    rise = dx * mx + dy * my
    if ends and not starts:
        dx, dy, rise = -dx, -dy, -rise
    if (starts or ends) and rise <= 0.0:
        return -2.0
    if rise < 0.0:
        dx, dy = -dx, -dy
    tx, ty = -my, mx
    if tx * vx + ty * vy < 0.0:
        tx, ty = -tx, -ty
    scale = math.sqrt((dx * dx + dy * dy) * (tx * tx + ty * ty))
    return (dx * tx + dy * ty) / scale


@kernel
def normal_at(model, arcs, edge, x, y):
    """A normal of an edge at a point on it, any length, and 2 / (n.n): outward of a line, out of an arc's circle.

    The normal of an arc, turned a quarter to the left, points from its a to its b, as that of a line does.
    """
    if arcs is not None:
        arc = arcs[edge]
        if arc.radius > 0.0:
            nx, ny = x - arc.ax + arc.sx, y - arc.ay + arc.sy
            return nx, ny, 2.0 / (nx * nx + ny * ny)
    line = model.lines[edge]
    return line.nx, line.ny, line.twice


@rare_kernel
def _touch(model, arcs, edge, x, y, tolerance):
    """Tell whether a point is on an edge, and at its start or its end: (touches, starts here, ends here)."""
    if arcs is not None:
        arc = arcs[edge]
        if arc.radius > 0.0:
            touches = _side(model, arcs, edge, x, y, tolerance) == 0.0 and holds(
                arc, x - arc.ax + arc.sx, y - arc.ay + arc.sy, tolerance
            )
            return touches, _near(x - arc.ax, y - arc.ay, tolerance), _near(x - arc.bx, y - arc.by, tolerance)
    line = model.lines[edge]
    ex, ey = x - line.ax, y - line.ay
    u = ey * line.nx - ex * line.ny
    touches = _side(model, arcs, edge, x, y, tolerance) == 0.0 and -tolerance <= u <= line.length + tolerance
    return touches, u <= tolerance, u >= line.length - tolerance


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
    outward = 1.0
    if arcs is not None:
        if arcs[edge].radius > 0.0:
            outward = arcs[edge].sweep
    return came * outward < 0.0


@rare_kernel
def _outcome(model, first, first_side, second, second_side, x, y, vx, vy):
    """Tell what bouncing off two edges in turn comes to, whichever is first: the second edge if that is the same."""
    ax, ay = _leave(model, first, first_side, second, second_side, x, y, vx, vy)
    bx, by = _leave(model, second, second_side, first, first_side, x, y, vx, vy)
    small = SAME * SAME * (vx * vx + vy * vy)
    if model.restitution is not None and ax * ax + ay * ay <= small:
        return COLLAPSES
    return second if (ax - bx) * (ax - bx) + (ay - by) * (ay - by) <= small else AMBIGUOUS


@rare_kernel
def _leave(model, first, first_side, second, second_side, x, y, vx, vy):
    """Velocity after bouncing off two edges in turn until it recedes from both."""
    ax, ay, a_twice = normal_at(model, model.arcs, first, x, y)
    bx, by, b_twice = normal_at(model, model.arcs, second, x, y)
    ax, ay, bx, by = first_side * ax, first_side * ay, second_side * bx, second_side * by
    a_wall, b_wall = model.edge_wall[first], model.edge_wall[second]
    for _turn in range(TURNS):
        receding = True
        if vx * ax + vy * ay < 0.0:
            vx, vy, _energy = reflect(model.restitution, a_wall, ax, ay, a_twice, vx, vy, vx * vx + vy * vy)
            receding = False
        if vx * bx + vy * by < 0.0:
            vx, vy, _energy = reflect(model.restitution, b_wall, bx, by, b_twice, vx, vy, vx * vx + vy * vy)
            receding = False
        if receding:
            break
    return vx, vy


@rare_kernel
def rises_ahead(model, held, x, y, vx, vy, nx, ny, tolerance):
    """Edge that rises from the end of the one on which a point slides, or NO_HIT: n is the side of the point.

    Such an edge goes up on that side from where the point is, across its way; one that falls away or goes straight on
    does not stop it.
    """
    cell = model.cells[home(model, model.grid, x, y)]
    found = NO_HIT
    steepest = RISE * (abs(nx) + abs(ny))
    for k in range(cell.first, cell.corners):
        edge = int(model.ids[k])
        rise = _rise(model, edge, held, x, y, vx, vy, nx, ny, tolerance)
        if rise > steepest:
            steepest, found = rise, edge
    return found


@rare_kernel
def _rise(model, edge, held, x, y, vx, vy, nx, ny, tolerance):
    """How steeply an edge at (x, y) goes up along n, as a part of n; 0 if it is not there, or beside the way."""
    if edge == held:
        return 0.0
    touches, starts, ends = _touch(model, model.arcs, edge, x, y, tolerance)
    if not touches:
        return 0.0
    mx, my, _twice = normal_at(model, model.arcs, edge, x, y)
    length = math.sqrt(mx * mx + my * my)
    dx, dy = -my / length, mx / length
    rise = dx * nx + dy * ny
    if not (starts or ends):
        return abs(rise)
    return rise if starts else -rise
