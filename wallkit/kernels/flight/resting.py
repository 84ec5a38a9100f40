"""How a wall holds a ball under gravity: its bounces end, it rests or slides, and leaves again.

With restitution e < 1 a ball that leaves a wall at the normal speed w, pressed back by p = -g.n, bounces without
end in the time 2 w / (p (1 - e)). When the height it reaches, w^2 / (2 p), is below the rounding of positions, these
bounces are taken at once. After that it keeps to the wall: at rest where tangential restitution f < 1 has stopped it
(or nothing pulls), else sliding with the part of gravity along the wall, until the wall ends or something is met.

On a curve (an arc, or the circle of a corner) p = -g.n + v^2 k, with k the curvature of the way of the centre,
positive in a hollow. There the bounces end the same way, but what comes after, a pendulum's swing, is not flown: the
ball is caught, and its run ends there, by name.
"""

from __future__ import annotations

import math

from wallkit.kernels.flight.gravity import LEVEL, curvature, end_of_edge, kept_energy, pull_on, towards
from wallkit.kernels.flight.point_in_corner import rises_ahead
from wallkit.kernels.impact.gravity_impact import fall_search
from wallkit.kernels.jit import kernel, rare_kernel
from wallkit.kernels.records import (
    AT_REST,
    CAUGHT,
    COLLAPSE,
    COMING_TO_REST,
    FREE,
    LEAVE,
    LEAVING,
    LEFT,
    NO_HIT,
    SLIDE,
    SLIDING,
    WEDGED,
)


@kernel
def change_hold(model, gravity, radius, x, y, vx, vy, energy, last, held, hold, tolerance):
    """Let a ball that comes to rest on an edge keep to it, or one whose slide has ended leave it.

    Returns:
        (x, y, vx, vy after it, the time it takes, energy, last, hold, kind of the contact).
    """
    if hold == LEAVING:
        return x, y, vx, vy, 0.0, energy, last, LEFT, LEAVE
    x, y, vx, vy, t, hold = _keep_to(model, model.restitution, held, radius, x, y, vx, vy, gravity, last, tolerance)
    return x, y, vx, vy, t, kept_energy(gravity, x, y, vx, vy), held, hold, SLIDE


@rare_kernel
def _keep_to(model, restitution, held, radius, x, y, vx, vy, gravity, last, tolerance):
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
        gx, gy = pull_on(model, gravity, held, SLIDING)
        moves = e >= 1.0 or along != 0.0 or gx != 0.0 or gy != 0.0
        return x, y, ax, ay, 0.0 if moves else first / (1.0 - e), SLIDING
    time, span = first / (1.0 - e), first / (1.0 - e * f)
    t, feature, touched = fall_search(
        model, model.grid, radius, x, y, ax, ay, 0.0, 0.0, last, held, tolerance,
        towards(model, held, gravity), span, NO_HIT,
    )  # fmt: skip
    if touched > 0:
        return x, y, 0.0, 0.0, time, SLIDING
    end = end_of_edge(model, held, x, y, ax, ay, 0.0, 0.0)
    if end < span and (feature == NO_HIT or end < t):
        left = 1.0 - end / span
        return x + end * ax, y + end * ay, left * ax, left * ay, time * (1.0 - left), LEAVING
    if feature != NO_HIT:
        span = t
    return x + span * ax, y + span * ay, 0.0, 0.0, time, SLIDING


@kernel
def rests(model, held, vx, vy, gravity):
    """A ball that keeps to an edge stays where it is."""
    gx, gy = pull_on(model, gravity, held, SLIDING)
    if vx != 0.0 or vy != 0.0:
        return False
    return (gx == 0.0 and gy == 0.0) or _is_rough(model.restitution, model.edge_wall[held])


@kernel
def _is_rough(restitution, wall):
    if restitution is None:
        return False
    return restitution[2 * wall + 1] < 1.0


@kernel
def held_after(model, gravity, radius, feature, held, hold, x, y, vx, vy, nx, ny, tolerance):
    """What holds a ball after a bounce off a feature (normal n towards it), and how: (edge, hold)."""
    if feature != held and _is_on(model, held, hold, radius, x, y, tolerance):
        hx, hy = towards(model, held, gravity)
        if _clings(gravity, hx, hy, 0.0, vx, vy, tolerance):
            gx, gy = pull_on(model, gravity, held, SLIDING)
            press, away = -(gx * nx + gy * ny), vx * nx + vy * ny
            if press > 0.0 and away * away <= 2.0 * press * tolerance * math.sqrt(nx * nx + ny * ny):
                return held, WEDGED
            return held, COMING_TO_REST
    length = math.sqrt(nx * nx + ny * ny)
    bend = curvature(model, model.arcs, feature, radius, x, y, nx, ny) / length
    if _clings(gravity, nx / length, ny / length, bend, vx, vy, tolerance):
        if feature >= 0 and _is_line(model.arcs, feature):
            return feature, COMING_TO_REST
        return feature, CAUGHT
    return NO_HIT, FREE


@kernel
def stops_slide(model, gravity, radius, held, x, y, vx, vy, tolerance):
    """Edge that stops a point at the end of the edge on which it slides, or NO_HIT; a disc is stopped before."""
    if radius > 0.0:
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
def _is_line(arcs, edge):
    if arcs is None:
        return True
    return arcs[edge].radius == 0.0


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


@kernel
def _sticks(restitution, wall):
    if restitution is None:
        return False
    return restitution[2 * wall] < 1.0 and restitution[2 * wall + 1] < 1.0
