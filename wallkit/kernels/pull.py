"""What gravity does to a flight: parabolas, energy kept, and balls that have come to rest against a straight wall.

With restitution e < 1 a ball that leaves a wall at the normal speed w, pressed back by p = -g.n, bounces without
end in the time 2 w / (p (1 - e)). When the height it reaches, w^2 / (2 p), is below the rounding of positions, these
bounces are taken at once. After that it keeps to the wall: at rest where tangential restitution f < 1 has stopped it
(or nothing pulls), else sliding with the part of gravity along the wall, until the wall ends or something is met.

On a curve (an arc, or the circle of a corner) p = -g.n + v^2 k, with k the curvature of the way of the centre,
positive in a hollow. There the bounces end the same way, but what comes after, a pendulum's swing, is not flown: the
ball is caught, and its run ends there, by name.

Each kernel takes gravity as an argument of its own; where it is None only the straight flight is left of it.
"""

from __future__ import annotations

import math

from wallkit.kernels.corner import rises_ahead
from wallkit.kernels.falling import LEVEL_SPEED, fall_search
from wallkit.kernels.grid import search
from wallkit.kernels.jit import kernel, rare_kernel
from wallkit.kernels.model import (
    AT_REST,
    CAUGHT,
    COLLAPSE,
    COMING_TO_REST,
    END_OF_EDGE,
    FREE,
    LEAVING,
    LEFT,
    NO_HIT,
    SLIDING,
    WEDGED,
)
from wallkit.kernels.motion import reflect
from wallkit.kernels.roots import first_fall_quadratic

LEVEL = 2.0**-48
"""A wall that turns gravity by less than this is level."""


@kernel
def first_contact(model, gravity, radius, x, y, vx, vy, energy, last, held, hold, tolerance, best):
    """Find what ends the flight before ``best``: (time, feature, edges touched by a point where it starts)."""
    if gravity is None:
        return search(model, model.grid, radius, x, y, vx, vy, energy, last, tolerance, best, NO_HIT)
    gx, gy = _pull(model, gravity, held, hold)
    skipped = held if hold in (SLIDING, LEFT) else NO_HIT
    reference = towards(model, held, gravity) if skipped != NO_HIT else (0.0, 0.0)
    t, feature, touched = fall_search(
        model, model.grid, radius, x, y, vx, vy, gx, gy, last, skipped, tolerance, reference, best, NO_HIT
    )
    if hold == SLIDING:
        end = _end_of_edge(model, held, x, y, vx, vy, gx, gy)
        if end < t:
            return end, END_OF_EDGE, 0
    return t, feature, touched


@kernel
def move(model, gravity, held, hold, x, y, vx, vy, t):
    """Where a ball is after a time, and its velocity: p + v t + g t^2 / 2, v + g t."""
    if gravity is None:
        return x + t * vx, y + t * vy, vx, vy
    gx, gy = _pull(model, gravity, held, hold)
    return x + t * (vx + 0.5 * t * gx), y + t * (vy + 0.5 * t * gy), vx + t * gx, vy + t * gy


@kernel
def bounce(model, gravity, wall, nx, ny, twice, x, y, vx, vy, energy):
    """Turn the velocity at a contact: (vx, vy, energy kept by the next flight).

    Under gravity a flight keeps v^2 - 2 g.p; the speed before the bounce is taken from it.
    """
    if gravity is None:
        return reflect(model.restitution, wall, nx, ny, twice, vx, vy, energy)
    if vx * nx + vy * ny >= 0.0:  # it begins to be pressed on the wall: nothing to turn yet
        return vx, vy, energy
    height = 2.0 * (gravity[0] * x + gravity[1] * y)
    vx, vy, square = reflect(model.restitution, wall, nx, ny, twice, vx, vy, max(energy + height, 0.0))
    return vx, vy, square - height


@kernel
def kept_energy(gravity, x, y, vx, vy):
    """What a flight keeps: v^2 - 2 g.p."""
    return vx * vx + vy * vy - 2.0 * (gravity[0] * x + gravity[1] * y)


@kernel
def towards(model, held, gravity):
    """Unit normal of the edge that holds a ball, towards the ball: against gravity."""
    line = model.lines[held]
    side = -1.0 if gravity[0] * line.nx + gravity[1] * line.ny > 0.0 else 1.0
    return side * line.nx, side * line.ny


@kernel
def facing(model, gravity, radius, feature, x, y, vx, vy, nx, ny):
    """Turn the normal of a contact to the ball.

    Without gravity a contact approaches by far more than rounding, and the velocity tells the side. Under gravity it
    may begin with no speed towards the wall at all. The centre of a disc is its radius off the wall then, and
    tells the side; a point is on the side from which it is pressed.
    """
    towards_ball = -(vx * nx + vy * ny)
    if gravity is not None:
        if radius > 0.0:
            towards_ball = _offset(model, model.arcs, feature, x, y, nx, ny)
        else:
            bend = _curvature(model, model.arcs, feature, radius, x, y, nx, ny)
            press = -(gravity[0] * nx + gravity[1] * ny) + bend * (vx * vx + vy * vy)
            if abs(towards_ball) <= LEVEL_SPEED * (abs(vx) + abs(vy)) * math.sqrt(nx * nx + ny * ny):
                towards_ball = press
    if towards_ball < 0.0:
        return -nx, -ny
    return nx, ny


@kernel
def _offset(model, arcs, feature, x, y, nx, ny):
    """On which side of a feature a centre is: that of the normal above 0. All round a corner is outside."""
    if feature < 0:
        return 1.0
    if arcs is not None:
        if model.arc_of_edge[feature] >= 0:
            arc = arcs[model.arc_of_edge[feature]]
            return nx * nx + ny * ny - arc.radius * arc.radius
    line = model.lines[feature]
    return (x - line.ax) * nx + (y - line.ay) * ny


@kernel
def _curvature(model, arcs, feature, radius, x, y, nx, ny):
    """How the way of the centre along a feature bends towards the normal, per unit of the normal's length.

    1 / (R - r) in the hollow of an arc, -1 / (R + r) on its back, -1 / r on a corner, 0 on a line.
    """
    length = math.sqrt(nx * nx + ny * ny)
    if feature < 0:
        return -length / radius
    if arcs is not None:
        if model.arc_of_edge[feature] >= 0:
            arc = arcs[model.arc_of_edge[feature]]
            ex, ey = x - arc.ax + arc.sx, y - arc.ay + arc.sy
            return (
                -length / math.sqrt(ex * ex + ey * ey)
                if ex * nx + ey * ny > 0.0
                else length / max(arc.radius - radius, arc.radius * LEVEL)
            )
    return 0.0


@kernel
def side_kept(model, gravity, held, hold, vx, vy):
    """Velocity at a flight's start as corners remember it: a ball that slides has the side from which it is pressed.

    The lift off the wall, 2^-40 of the speed, is far above rounding and far below what corners tell apart.
    """
    if gravity is None:
        return vx, vy
    if hold != SLIDING:
        return vx, vy
    nx, ny = towards(model, held, gravity)
    lift = 2.0**-40 * (abs(vx) + abs(vy))
    return vx + lift * nx, vy + lift * ny


@kernel
def held_after(model, gravity, radius, feature, held, hold, x, y, vx, vy, nx, ny, tolerance):
    """What holds a ball after a bounce off a feature (normal n towards it), and how: (edge, hold)."""
    if feature != held and _is_on(model, held, hold, radius, x, y, tolerance):
        hx, hy = towards(model, held, gravity)
        if _clings(gravity, hx, hy, 0.0, vx, vy, tolerance):
            gx, gy = _pull(model, gravity, held, SLIDING)
            press, away = -(gx * nx + gy * ny), vx * nx + vy * ny
            if press > 0.0 and away * away <= 2.0 * press * tolerance * math.sqrt(nx * nx + ny * ny):
                return held, WEDGED
            return held, COMING_TO_REST
    length = math.sqrt(nx * nx + ny * ny)
    bend = _curvature(model, model.arcs, feature, radius, x, y, nx, ny) / length
    if _clings(gravity, nx / length, ny / length, bend, vx, vy, tolerance):
        if feature >= 0 and _is_line(model, model.arcs, feature):
            return feature, COMING_TO_REST
        return feature, CAUGHT
    return NO_HIT, FREE


@kernel
def stops_slide(model, gravity, radius, held, x, y, vx, vy, tolerance):
    """Edge that stops a point at the end of the edge on which it slides, or NO_HIT; a disc is stopped before."""
    if gravity is None or radius > 0.0:
        return NO_HIT
    nx, ny = towards(model, held, gravity)
    return rises_ahead(model, held, x, y, vx, vy, nx, ny, tolerance)


@kernel
def _is_on(model, held, hold, radius, x, y, tolerance):
    """Tell whether a ball is on the edge that holds it, or held it until just now, ends included."""
    if hold not in (SLIDING, LEFT):
        return False
    line = model.lines[held]
    ex, ey = x - line.ax, y - line.ay
    u = ey * line.nx - ex * line.ny
    near = abs(abs(ex * line.nx + ey * line.ny) - radius) <= 2.0 * tolerance
    return near and -tolerance <= u <= line.length + tolerance


@kernel
def _clings(gravity, nx, ny, bend, vx, vy, tolerance):
    """Pressed against a wall with unit normal n and curvature ``bend``, a ball rises less than the tolerance."""
    pull = abs(gravity[0]) + abs(gravity[1])
    press = bend * (vx * vx + vy * vy) - (gravity[0] * nx + gravity[1] * ny)
    away = vx * nx + vy * ny
    return press > LEVEL * pull and away * away <= 2.0 * press * tolerance


@kernel
def _is_line(model, arcs, edge):
    if arcs is None:
        return True
    return model.arc_of_edge[edge] < 0


@kernel
def end_of_hold(model, gravity, hold, wall, nx, ny, vx, vy):
    """How the run of a ball ends that is wedged, or that a curve has caught: (ending, vx, vy).

    Wedged between what it slides on and what it slides against, it is at rest. On a curve it is at rest where the
    wall is rough, or at the very bottom of a hollow without speed; else it would swing on along the curve, and all
    that is known is that its bounces have collapsed.
    """
    if hold == WEDGED or _sticks(model.restitution, wall):
        return AT_REST, 0.0, 0.0
    across = gravity[0] * ny - gravity[1] * nx
    if abs(across) <= LEVEL * abs(gravity[0] * nx + gravity[1] * ny) and vx * ny - vy * nx == 0.0:
        return AT_REST, 0.0, 0.0
    return COLLAPSE, vx, vy


@rare_kernel
def keep_to(model, restitution, held, radius, x, y, vx, vy, gravity, last, tolerance):
    """Take the last, endless bounces on an edge at once: (x, y, vx, vy after them, the time they take, hold).

    With f = 1 the way along the wall is that of sliding, so the ball slides at once; only where nothing moves it are
    the bounces waited for. With f < 1 they stop it after the way v w' / (1 - e f), w' = 2 w / p the time of the first,
    unless something stands in that way, or the edge ends before.
    """
    line = model.lines[held]
    along = vy * line.nx - vx * line.ny
    ax, ay = -along * line.ny, along * line.nx
    e, f = 1.0, 1.0
    if restitution is not None:
        e, f = restitution[2 * model.edge_wall[held]], restitution[2 * model.edge_wall[held] + 1]
    away = abs(vx * line.nx + vy * line.ny)
    first = 2.0 * away / abs(gravity[0] * line.nx + gravity[1] * line.ny)
    if e >= 1.0 or f >= 1.0:
        gx, gy = _pull(model, gravity, held, SLIDING)
        moves = e >= 1.0 or along != 0.0 or gx != 0.0 or gy != 0.0
        return x, y, ax, ay, 0.0 if moves else first / (1.0 - e), SLIDING
    time, span = first / (1.0 - e), first / (1.0 - e * f)
    t, feature, touched = fall_search(
        model, model.grid, radius, x, y, ax, ay, 0.0, 0.0, last, held, tolerance,
        towards(model, held, gravity), span, NO_HIT,
    )  # fmt: skip
    if touched > 0:
        return x, y, 0.0, 0.0, time, SLIDING
    end = _end_of_edge(model, held, x, y, ax, ay, 0.0, 0.0)
    if end < span and (feature == NO_HIT or end < t):
        left = 1.0 - end / span
        return x + end * ax, y + end * ay, left * ax, left * ay, time * (1.0 - left), LEAVING
    if feature != NO_HIT:
        span = t
    return x + span * ax, y + span * ay, 0.0, 0.0, time, SLIDING


@kernel
def rests(model, held, vx, vy, gravity):
    """A ball that keeps to an edge stays where it is."""
    gx, gy = _pull(model, gravity, held, SLIDING)
    if vx != 0.0 or vy != 0.0:
        return False
    return (gx == 0.0 and gy == 0.0) or _is_rough(model.restitution, model.edge_wall[held])


@kernel
def _is_rough(restitution, wall):
    if restitution is None:
        return False
    return restitution[2 * wall + 1] < 1.0


@kernel
def _sticks(restitution, wall):
    if restitution is None:
        return False
    return restitution[2 * wall] < 1.0 and restitution[2 * wall + 1] < 1.0


@kernel
def _pull(model, gravity, held, hold):
    """Gravity as a ball feels it: all of it, or the part along the edge that holds it; none on a level one."""
    if hold != SLIDING:
        return gravity[0], gravity[1]
    line = model.lines[held]
    pull = gravity[1] * line.nx - gravity[0] * line.ny
    if abs(pull) <= LEVEL * (abs(gravity[0]) + abs(gravity[1])):
        return 0.0, 0.0
    return -pull * line.ny, pull * line.nx


@kernel
def _end_of_edge(model, held, x, y, vx, vy, gx, gy):
    """Time at which a ball that slides on an edge comes to its end; g is the pull along the edge."""
    line = model.lines[held]
    u = (y - line.ay) * line.nx - (x - line.ax) * line.ny
    v = vy * line.nx - vx * line.ny
    g = gy * line.nx - gx * line.ny
    return min(
        first_fall_quadratic(0.5 * g, v, u, math.inf), first_fall_quadratic(-0.5 * g, -v, line.length - u, math.inf)
    )
