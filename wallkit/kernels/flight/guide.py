"""The guide of a ball that keeps to a wall: the way that its centre takes, a straight line or a circle.

Beside a line it is the line moved out by r, about a vertex the circle of radius r, outside an arc the circle of R + r
and inside it that of R - r. ``side`` is that of the wall, 1 on its outward side, whatever the direction of an arc.
Directions about the centre of a circle are units, and places are moved along it by differences: so a circle a million
times as large as the scene costs no digits.
"""

from __future__ import annotations

import math

from wallkit.kernels.jit import kernel

STRAIGHT = 0.0
"""In place of the radius of a guide."""


@kernel
def outside(arc, side):
    """Tell whether a ball on a side of an arc's wall is outside the arc's circle."""
    return side * arc.sweep > 0.0


@kernel
def guide(model, arcs, held, side, radius, x, y):
    """Give the guide at a centre: (its radius or STRAIGHT, 1 where it bends away from the ball's side else -1, normal).

    The normal is a unit and points to the ball. On a circle it points away from its centre where the ball is outside,
    to its centre in a hollow.
    """
    if held < 0:
        corner = model.corners[-2 - held]
        ex, ey = x - corner.x, y - corner.y
        length = math.sqrt(ex * ex + ey * ey)
        return radius, 1.0, ex / length, ey / length
    if arcs is not None:
        arc = arcs[held]
        if arc.radius > 0.0:
            ex, ey = x - arc.ax + arc.sx, y - arc.ay + arc.sy
            length = math.sqrt(ex * ex + ey * ey)
            if outside(arc, side):
                return arc.radius + radius, 1.0, ex / length, ey / length
            return arc.radius - radius, -1.0, -ex / length, -ey / length
    line = model.lines[held]
    return STRAIGHT, 1.0, side * line.nx, side * line.ny


@kernel
def off_guide(model, arcs, held, side, radius, x, y):
    """How far from its guide a centre is, along the normal there: by rounding, above 0 on the ball's side."""
    if held < 0:
        corner = model.corners[-2 - held]
        ex, ey = x - corner.x, y - corner.y
        # |e| - r = (e.e - r^2) / (|e| + r).
        return (ex * ex + ey * ey - radius * radius) / (math.sqrt(ex * ex + ey * ey) + radius)
    if arcs is not None:
        arc = arcs[held]
        if arc.radius > 0.0:
            wx, wy = x - arc.ax, y - arc.ay
            ex, ey = wx + arc.sx, wy + arc.sy
            power = wx * (wx + 2.0 * arc.sx) + wy * (wy + 2.0 * arc.sy)
            out = 1.0 if outside(arc, side) else -1.0
            reach = arc.radius + out * radius
            # e.e - (R +- r)^2 = power -+ r (2 R +- r), over |e| + (R +- r).
            gap = power - out * radius * (2.0 * arc.radius + out * radius)
            return out * gap / (math.sqrt(ex * ex + ey * ey) + reach)
    line = model.lines[held]
    return side * ((x - line.ax) * line.nx + (y - line.ay) * line.ny) - radius


@kernel
def press(gravity, rho, away, nx, ny, square):
    """What presses a ball of squared speed ``square`` on its guide, per mass: -g.n, less or more v^2 / rho."""
    # On a circle the ball needs v^2 / rho towards the middle: on the back gravity gives it, in a hollow the wall does.
    pressed = -(gravity[0] * nx + gravity[1] * ny)
    return pressed if rho == STRAIGHT else pressed - away * square / rho


@kernel
def ahead_of(rho, away, nx, ny, vx, vy, gx, gy):
    """Unit direction along the guide in which a ball moves, or is pulled if it does not: (direction, speed).

    The direction is (0, 0) where nothing moves it.
    """
    # v.t for t = (-ny, nx), a quarter turn to the left of the normal.
    along = vy * nx - vx * ny
    speed = abs(along)
    if along == 0.0:
        along = gy * nx - gx * ny
    if along == 0.0:
        return 0.0, 0.0, 0.0
    return (-ny, nx, speed) if along > 0.0 else (ny, -nx, speed)
