"""How a ball joins a wall: its last, endless bounces are taken at once, and its centre is put on the guide."""

from __future__ import annotations

from wallkit.kernels.flight.contact_state import reach
from wallkit.kernels.flight.gravity import LEVEL
from wallkit.kernels.flight.guide import STRAIGHT, guide, off_guide, press
from wallkit.kernels.flight.pendulum import turned
from wallkit.kernels.flight.slowed_contact import or_none
from wallkit.kernels.jit import kernel, rare_kernel
from wallkit.kernels.records import PASSING, SLIDING


@kernel
def join(model, gravity, radius, held, hold, side, last, x, y, vx, vy, start_of, tolerance):
    """Put a ball on its guide, and its velocity along it; take its last, endless bounces at once.

    With f = 1 its way along the wall in them is that of sliding, so it slides at once, but where it stands, and comes
    to rest when they are over, or where rolling friction waits for it, which takes nothing from a ball that bounces:
    so it slides when they are over. With f < 1 they stop it. Where a is the pull along, u its speed along after the
    bounce and t = 2 w / p the time to the next, the times to come are t e^k and u_(k+1) = f (u_k + a t e^k), so that
    after t / (1 - e) it has come by

        S = t (u + e f a t / (1 - e^2)) / (1 - e f) + a t^2 / (2 (1 - e^2)).

    Where something stands in that way, it comes there with what is left of u.
    """
    rho, away, nx, ny = guide(model, model.arcs, held, side, radius, x, y)
    off = off_guide(model, model.arcs, held, side, radius, x, y)
    x, y = x - off * nx, y - off * ny
    # Apart into w, off the wall, and u along it, to the left of the normal.
    w, u = vx * nx + vy * ny, vy * nx - vx * ny
    vx, vy = -u * ny, u * nx
    e, f = _kept(model, model.restitution, held)
    pull = gravity[1] * nx - gravity[0] * ny
    stands = u == 0.0 and abs(pull) <= LEVEL * (abs(gravity[0]) + abs(gravity[1]))
    if hold == PASSING or e >= 1.0 or (f >= 1.0 and not stands and not _given(model.rolling)):
        return x, y, vx, vy, 0.0, SLIDING
    if f >= 1.0 and not stands:
        time, pull = _unslowed(model.drag, gravity, rho, away, nx, ny, u, abs(w), e)
        way = time * (u + 0.5 * pull * time)
        x, y, done = reach(model, gravity, radius, held, side, last, x, y, way, start_of, tolerance)
        _rho, _away, nx, ny = guide(model, model.arcs, held, side, radius, x, y)
        u += pull * done * time
        return x, y, -u * ny, u * nx, done * time, SLIDING
    if stands or rho == STRAIGHT:
        # Up and down again under p takes 2 w / p, and each bounce e times as long as the one before:
        # t (1 + e + e^2 + ...) = t / (1 - e).
        t = 2.0 * abs(w) / press(gravity, rho, away, nx, ny, u * u)
        time = t / (1.0 - e)
        if stands:
            return x, y, vx, vy, time, SLIDING
        way = t * (u + e * f * pull * t / (1.0 - e * e)) / (1.0 - e * f) + 0.5 * pull * t * t / (1.0 - e * e)
    else:
        time, way = _last_bounces(gravity, rho, away, nx, ny, u, abs(w), e, f)
    x, y, done = reach(model, gravity, radius, held, side, last, x, y, way, start_of, tolerance)
    _rho, _away, nx, ny = guide(model, model.arcs, held, side, radius, x, y)
    left = (1.0 - done) * u
    return x, y, -left * ny, left * nx, done * time, SLIDING


@kernel
def _given(rolling):
    """Tell whether there is any rolling friction."""
    return rolling is not None


@rare_kernel
def _unslowed(drag, gravity, rho, away, nx, ny, u, w, e):
    """Time of the endless bounces of a ball that they do not slow down, and what accelerates it along the wall then.

    That is the pull half-way, where the wall has turned, less drag there: over so short a time t the place along the
    wall is off by t^3 of its change.
    """
    time = 2.0 * w / (press(gravity, rho, away, nx, ny, u * u) * (1.0 - e))
    if rho != STRAIGHT:  # a way to the left turns n as in ``_last_bounces``
        nx, ny, _tx, _ty = turned(nx, ny, -away * ny, away * nx, 0.25 * u * time / rho)
    pull = gravity[1] * nx - gravity[0] * ny
    return time, pull - or_none(drag) * (u + 0.5 * pull * time)


@rare_kernel
def _last_bounces(gravity, rho, away, nx, ny, u, w, e, f):
    """Time and way of the endless bounces on a circle that a wall with f < 1 ends, one after the other.

    As u dies, so does the part v^2 / rho of what presses the ball on the wall, and on its way the wall turns. A bounce
    goes x = u t + a t^2 / 2 along the wall and y = w t - b t^2 / 2 off it, and ends where y = k x^2 / 2 (k = 1 / rho in
    a hollow, else -1 / rho):

        t = 2 w / (b + k u^2 + k u a t),    and off the wall it comes down there at w + k u a t^2 / 2.

    What is left out is of the square of the angle by which the wall turns under one bounce.
    """
    time, way, least = 0.0, 0.0, 2.0**-34 * w
    while w > least:
        # A way to the left turns n to the left on the back of an arc, and to the right in a hollow: by way / rho.
        mx, my, _tx, _ty = turned(nx, ny, -away * ny, away * nx, 0.5 * way / rho)
        pressed, pull = press(gravity, rho, away, mx, my, u * u), gravity[1] * mx - gravity[0] * my
        if pressed <= 0.0:
            break
        t = 2.0 * w / pressed
        later = -away / rho * u * pull * t
        t = 2.0 * w / (pressed + later)
        w = e * (w + 0.5 * later * t)
        time, way, u = time + t, way + t * (u + 0.5 * pull * t), f * (u + pull * t)
    return time, way


@kernel
def _kept(model, restitution, feature):
    """Restitution along the normal, and along the wall, of a feature."""
    if restitution is None:
        return 1.0, 1.0
    wall = model.edge_wall[feature] if feature >= 0 else model.corner_wall[-2 - feature]
    return restitution[2 * wall], restitution[2 * wall + 1]
