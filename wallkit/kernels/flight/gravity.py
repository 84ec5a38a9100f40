"""What gravity does to a flight: parabolas, and energy kept.

Each kernel takes gravity as an argument of its own; where it is None only the straight flight is left of it.
"""

from __future__ import annotations

import math

from wallkit.kernels.flight.guide import guide
from wallkit.kernels.flight.motion import reflect
from wallkit.kernels.impact.drag_motion import carried
from wallkit.kernels.impact.leaving import LEVEL_SPEED
from wallkit.kernels.index.grid import search
from wallkit.kernels.index.parabola_walk import fall_search
from wallkit.kernels.jit import kernel
from wallkit.kernels.records import FREE, LEFT, NO_HIT, STARTING

LEVEL = 2.0**-48
"""A wall that turns gravity by less than this is level."""


@kernel
def first_contact(model, gravity, radius, x, y, vx, vy, energy, last, held, hold, side, tolerance, best):
    """Find what ends the flight before ``best``: (time, feature, edges touched by a point where it starts)."""
    if gravity is None:
        return search(model, model.grid, radius, x, y, vx, vy, energy, last, tolerance, best, NO_HIT)
    skipped = held if hold == LEFT else NO_HIT
    reference = (0.0, 0.0)
    if skipped >= 0:
        _rho, _away, nx, ny = guide(model, model.arcs, held, side, radius, x, y)
        reference = (nx, ny)
    return fall_search(
        model,
        model.grid,
        model.drag,
        radius,
        x,
        y,
        vx,
        vy,
        gravity[0],
        gravity[1],
        last,
        skipped,
        tolerance,
        reference,
        best,
        NO_HIT,
    )


@kernel
def move(gravity, x, y, vx, vy, t):
    """Where a ball is after a time of flight, and its velocity: p + v t + g t^2 / 2, v + g t."""
    if gravity is None:
        return x + t * vx, y + t * vy, vx, vy
    gx, gy = gravity[0], gravity[1]
    # t (v + t g / 2): one rounding fewer than v t + g t^2 / 2.
    return x + t * (vx + 0.5 * t * gx), y + t * (vy + 0.5 * t * gy), vx + t * gx, vy + t * gy


@kernel
def fall(gravity, drag, x, y, vx, vy, t):
    """Where a ball is after a time of flight, and its velocity, as ``move`` says, or with drag."""
    if drag is None:
        return move(gravity, x, y, vx, vy, t)
    return carried(drag, x, y, vx, vy, gravity[0], gravity[1], t)


@kernel
def bounce(model, gravity, wall, nx, ny, twice, x, y, vx, vy, energy):
    """Turn the velocity at a contact: (vx, vy, energy kept by the next flight).

    Under gravity a flight keeps v^2 - 2 g.p; the speed before the bounce is taken from it.
    """
    if gravity is None:
        return reflect(model.restitution, wall, nx, ny, twice, vx, vy, energy)
    # It comes along the wall, to rounding, and begins to be pressed on it: nothing to turn yet. twice is 2 / (n.n).
    into, speed = vx * nx + vy * ny, LEVEL_SPEED * (abs(vx) + abs(vy))
    if into >= 0.0 or into * into * twice <= 2.0 * speed * speed:
        return vx, vy, energy
    energy = energy_now(gravity, model.drag, x, y, vx, vy, energy)
    # energy = v^2 - 2 g.p, so v^2 = energy + 2 g.p at the wall.
    height = 2.0 * (gravity[0] * x + gravity[1] * y)
    vx, vy, square = reflect(model.restitution, wall, nx, ny, twice, vx, vy, max(energy + height, 0.0))
    return vx, vy, square - height


@kernel
def energy_now(gravity, slows, x, y, vx, vy, energy):
    """What a flight keeps, or, where something (None if nothing) slows the ball down, has left of it."""
    if slows is None:
        return energy
    return kept_energy(gravity, x, y, vx, vy)


@kernel
def kept_energy(gravity, x, y, vx, vy):
    """What a flight keeps: v^2 - 2 g.p."""
    return vx * vx + vy * vy - 2.0 * (gravity[0] * x + gravity[1] * y)


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
            bend = curvature(model, model.arcs, feature, radius, x, y, nx, ny)
            # The wall pushes with -g.n, and with what it takes to keep the centre on its curve.
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
        arc = arcs[feature]
        if arc.radius > 0.0:
            return nx * nx + ny * ny - arc.radius * arc.radius
    # (p - a).n, the distance from the line.
    line = model.lines[feature]
    return (x - line.ax) * nx + (y - line.ay) * ny


@kernel
def curvature(model, arcs, feature, radius, x, y, nx, ny):
    """How the way of the centre along a feature bends towards the normal, per unit of the normal's length.

    1 / (R - r) in the hollow of an arc, -1 / (R + r) on its back, -1 / r on a corner, 0 on a line.
    """
    length = math.sqrt(nx * nx + ny * ny)
    if feature < 0:
        return -length / radius
    if arcs is not None:
        arc = arcs[feature]
        if arc.radius > 0.0:
            # On the back (e along n) the centre goes round a circle of R + r, in the hollow round one of R - r.
            ex, ey = x - arc.ax + arc.sx, y - arc.ay + arc.sy
            return (
                -length / math.sqrt(ex * ex + ey * ey)
                if ex * nx + ey * ny > 0.0
                else length / max(arc.radius - radius, arc.radius * LEVEL)
            )
    return 0.0


@kernel
def lifted(model, gravity, radius, held, hold, side, x, y, vx, vy):
    """Velocity at a flight's start as corners remember it: a ball that leaves a wall along it is on its side of that.

    The lift off the wall, 2^-40 of the speed, is far above rounding and far below what corners tell apart.
    """
    if gravity is None:
        return vx, vy
    if hold in (FREE, STARTING):
        return vx, vy
    _rho, _away, nx, ny = guide(model, model.arcs, held, side, radius, x, y)
    # At rest any lift does: it only says on which side of the wall the ball is.
    speed = abs(vx) + abs(vy)
    lift = 2.0**-40 * speed if speed > 0.0 else 1.0
    return vx + lift * nx, vy + lift * ny
