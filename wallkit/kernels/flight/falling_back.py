"""A point that has run off the upper end of a wall along gravity, and falls back along it.

Its way is the wall's own line, on which no gap has a sign. But it has a side of the wall: that on which it kept to it.
A disc on that side goes up beside the line and comes down beside it, however small it is; so does the point, their
limit. So it falls back to the wall's end, and keeps to the wall from there on, on that side.
"""

from __future__ import annotations

import math

from wallkit.kernels.flight.gravity import LEVEL, fall, kept_energy
from wallkit.kernels.flight.guide import STRAIGHT, guide
from wallkit.kernels.flight.joints import AT_VERTEX
from wallkit.kernels.impact.drag_motion import along, speed_after
from wallkit.kernels.impact.leaving import LEVEL_SPEED
from wallkit.kernels.impact.polynomial_roots import NEVER
from wallkit.kernels.jit import rare_kernel

CLOSE = 2.0**-40
"""Of a time, Newton's step that is so small is the last."""
STEPS = 100


@rare_kernel
def falls_back(model, gravity, held, side, x, y, vx, vy, tolerance):
    """Time until a point that has left a wall, on a side of it, falls back on its upper end along it; or NEVER."""
    rho, _away, nx, ny = guide(model, model.arcs, held, side, 0.0, x, y)
    gx, gy = gravity[0], gravity[1]
    pull = math.sqrt(gx * gx + gy * gy)
    line = model.lines[held]
    px, py = x - line.ax, y - line.ay
    if rho != STRAIGHT or abs(gx * nx + gy * ny) > LEVEL * (abs(gx) + abs(gy)) or abs(px * nx + py * ny) > tolerance:
        return NEVER
    if abs(vx * nx + vy * ny) > LEVEL_SPEED * (abs(vx) + abs(vy)):
        return NEVER
    # Up from the higher of its ends, against gravity.
    height = -max(px * gx + py * gy, (x - line.bx) * gx + (y - line.by) * gy) / pull
    speed = -(vx * gx + vy * gy) / pull
    if height < -tolerance or (speed <= 0.0 and height <= AT_VERTEX * tolerance):
        return NEVER
    height = max(height, 0.0)
    # h + v t - g t^2 / 2 = 0; drag has it be there before or after that.
    time = (speed + math.sqrt(speed * speed + 2.0 * pull * height)) / pull
    if model.drag is None:
        return time
    # The height has a second derivative below 0, so from beyond its root Newton's steps come down to it.
    while along(model.drag, height, speed, -pull, time) > 0.0:
        time *= 2.0
    for _step in range(STEPS):
        step = along(model.drag, height, speed, -pull, time) / speed_after(model.drag, speed, -pull, time)
        time -= step
        if abs(step) <= CLOSE * time:
            break
    return time


@rare_kernel
def fallen_back(model, gravity, held, ball, time):
    """Put a point that has fallen back to the upper end of a wall there, and its velocity along the wall."""
    x, y, vx, vy, energy = ball
    gx, gy = gravity[0], gravity[1]
    pull = math.sqrt(gx * gx + gy * gy)
    line = model.lines[held]
    upper = line.ax * gx + line.ay * gy < line.bx * gx + line.by * gy
    _x, _y, vx, vy = fall(gravity, model.drag, x, y, vx, vy, time)
    x, y = (line.ax, line.ay) if upper else (line.bx, line.by)
    speed = (vx * gx + vy * gy) / pull
    if model.drag is None:  # of the energy, whose digits a flight keeps: v^2 = energy + 2 g.p
        speed = math.sqrt(max(energy + 2.0 * (gx * x + gy * y), 0.0))
    vx, vy = speed * gx / pull, speed * gy / pull
    return x, y, vx, vy, kept_energy(gravity, x, y, vx, vy)
