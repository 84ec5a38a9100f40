"""Points in a corner: several lines within rounding of where the ball is.

Which side of them the ball is on cannot be read from its position. It follows from where the ball came from: the
last flight did not cross them, so its start tells the side; and if that start was as close, the flight left there
receding from them.
"""

from __future__ import annotations

from wallkit.kernels.jit import kernel
from wallkit.kernels.model import AMBIGUOUS, NO_HIT
from wallkit.kernels.motion import reflect

SAME = 1e-9
"""Two outgoing velocities closer than this part of the speed are one: an angle of pi / n as drawn has a limit."""
TURNS = 200_000


@kernel
def settle(model, last, x, y, vx, vy, from_x, from_y, from_vx, from_vy, tolerance, still):
    """Find the edge that a point in a corner meets next, at once; or NO_HIT if it is free to go.

    Returns AMBIGUOUS if starting with the other wall would send the point elsewhere: an exact corner hit that
    has no limit.
    """
    second = _blocking(model, last, last, x, y, vx, vy, from_x, from_y, from_vx, from_vy, tolerance)
    if second == NO_HIT:
        return NO_HIT
    if still == 0 and not _order_is_free(model, last, second, from_vx, from_vy):
        return AMBIGUOUS
    return second


@kernel
def _blocking(model, first, last, x, y, vx, vy, from_x, from_y, from_vx, from_vy, tolerance):
    """The touched edge that the velocity runs against soonest, seen from the last one."""
    lines = model.lines
    tx, ty = -lines[last].ny, lines[last].nx
    if tx * vx + ty * vy < 0.0:
        tx, ty = -tx, -ty
    found = NO_HIT
    widest = -2.0
    for edge in range(len(model.edge_wall)):
        if edge == last:
            continue
        line = lines[edge]
        nx, ny, length = line.nx, line.ny, line.length
        ex, ey = x - line.ax, y - line.ay
        d = ex * nx + ey * ny
        u = ey * nx - ex * ny
        if not (-tolerance <= d <= tolerance and -tolerance <= u <= length + tolerance):
            continue
        came = (from_x - line.ax) * nx + (from_y - line.ay) * ny
        if -tolerance <= came <= tolerance:
            came = from_vx * nx + from_vy * ny
        toward = vx * nx + vy * ny
        if (came > 0.0) == (toward > 0.0) or toward == 0.0:
            continue
        if came < 0.0 and model_is_one_sided(model.one_sided, model.edge_wall[edge]):
            continue
        lean = _lean(lines[last], line, u, tolerance, from_x, from_y, from_vx, from_vy, tx, ty)
        if lean > widest:
            widest = lean
            found = edge
    return found


@kernel
def model_is_one_sided(one_sided, wall):
    """Tell whether a wall is solid from its outward side alone."""
    if one_sided is None:
        return False
    return one_sided[wall] != 0


@kernel
def _lean(last, line, u, tolerance, from_x, from_y, from_vx, from_vy, tx, ty):
    """How closely an edge leans over the way along the last wall, -1 to 1; -2 if it does not rise on the ball's side.

    An edge that ends here and goes off behind the last wall, or along it, cannot be met when leaving that wall.
    """
    mx, my = last.nx, last.ny
    side = (from_x - last.ax) * mx + (from_y - last.ay) * my
    if -tolerance <= side <= tolerance:
        side = from_vx * mx + from_vy * my
    if side < 0.0:
        mx, my = -mx, -my
    dx, dy = -line.ny, line.nx
    rise = dx * mx + dy * my
    starts_here = u <= tolerance
    ends_here = u >= line.length - tolerance
    if ends_here and not starts_here:
        dx, dy, rise = -dx, -dy, -rise
    if (starts_here or ends_here) and rise <= 0.0:
        return -2.0
    if rise < 0.0:
        dx, dy = -dx, -dy
    return dx * tx + dy * ty


@kernel
def _order_is_free(model, first, second, vx, vy):
    """Bouncing off the two walls in turn gives the same outgoing velocity whichever comes first."""
    ax, ay = _leave(model, first, second, vx, vy)
    bx, by = _leave(model, second, first, vx, vy)
    return (ax - bx) * (ax - bx) + (ay - by) * (ay - by) <= SAME * SAME * (vx * vx + vy * vy)


@kernel
def _leave(model, first, second, vx, vy):
    """Velocity after bouncing off two lines in turn until it recedes from both."""
    lines = model.lines
    sign_a = _against(lines, first, vx, vy)
    sign_b = _against(lines, second, vx, vy)
    edge, other, sign, other_sign = first, second, sign_a, sign_b
    receded = 0
    for _turn in range(TURNS):
        nx, ny = sign * lines[edge].nx, sign * lines[edge].ny
        if vx * nx + vy * ny < 0.0:
            receded = 0
            vx, vy, _energy = reflect(
                model.restitution, model.edge_wall[edge], nx, ny, lines[edge].twice, vx, vy, vx * vx + vy * vy
            )
        else:
            receded += 1
            if receded == 2:
                break
        edge, other = other, edge
        sign, other_sign = other_sign, sign
    return vx, vy


@kernel
def _against(lines, edge, vx, vy):
    """Sign that turns the normal of a line against a velocity."""
    return -1.0 if vx * lines[edge].nx + vy * lines[edge].ny > 0.0 else 1.0
