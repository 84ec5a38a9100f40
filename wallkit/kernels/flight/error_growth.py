"""The derivative of a flight and its bounces: how a small error, or a cloud of them, is carried along."""

from __future__ import annotations

import math
from typing import Any

from wallkit.kernels.impact.drag_motion import eased
from wallkit.kernels.jit import kernel

BOUNCES, SLIDES, LEAVES, PASSES, STOPS, SLOWS, TURNS, ENDS, JOINS = 0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0
"""What a contact is to an error. Who passes slides on from another edge. Where one stops or slows, endless bounces end:
they have taken its speed, or left it what it has along the wall, so that rolling friction acts from here on. Who turns
round on a wall is slowed down on it: from there on what slows it down acts the other way. Where a run ends nothing is
turned. Who joins a hollow comes to it along its tangent, to rounding, and goes on along it."""

BOUNCES_IN_SERIES = 4096
LEFT_IN_SERIES = 2.0**-40
"""Of the first of endless bounces: what is left then adds no digit that an error needs."""


@kernel
def derivative(
    vx: float, vy: float, ux: float, uy: float, nx: float, ny: float, keep: Any, bend: float, g: Any, h: Any
) -> Any:
    """Give the derivative of one bounce, as rows of 2 x 2 blocks; see ``wallkit.simulation.horizon`` for the equations.

    Args:
        vx: velocity before, with vy; u is the velocity after, n the normal, v.n < 0.
        vy: see vx.
        ux: see vx.
        uy: see vx.
        nx: see vx.
        ny: see vx.
        keep: (T, R), tangential and normal restitution.
        bend: curvature k.
        g: (gx, gy), the acceleration before.
        h: the same after: another one where the ball slides from here on.

    Returns:
        S = d(place along the wall)/dx, A = dx'/dx, B = dv'/dx, M = dv'/dv.
    """
    across = vx * nx + vy * ny
    tx, ty = -nx / across, -ny / across  # dt/dx
    # A neighbour dx ahead touches earlier by (n.dx) / (v.n): S = 1 + v dt/dx takes its place to the wall.
    s11, s12, s21, s22 = 1 + vx * tx, vx * ty, vy * tx, 1 + vy * ty
    wx, wy = vx - ux, vy - uy
    # v' = M v, M = T - (T + R) n n^T; along the wall n turns by the curvature k, and v' with it.
    both = keep[0] + keep[1]
    m11, m12, m22 = keep[0] - both * nx * nx, -both * nx * ny, keep[0] - both * ny * ny
    # For the time by which it touches later, gravity acts before the bounce instead of after it: M g - h.
    jx, jy = m11 * g[0] + m12 * g[1] - h[0], m12 * g[0] + m22 * g[1] - h[1]
    rx, ry = vx * s11 + vy * s21, vx * s12 + vy * s22
    k = both * bend
    return (
        (s11, s12, s21, s22),
        (1 + wx * tx, wx * ty, wy * tx, 1 + wy * ty),
        (
            jx * tx - k * (nx * rx + across * s11),
            jx * ty - k * (nx * ry + across * s12),
            jy * tx - k * (ny * rx + across * s21),
            jy * ty - k * (ny * ry + across * s22),
        ),
        (m11, m12, m12, m22),
    )


@kernel
def contact(
    vx: float, vy: float, ax: float, ay: float, path: Any, bend: Any, keep: Any, pull: Any, drag: float, i: int
) -> Any:
    """Give the derivative at contact i, before which v and its change in time are known: S, A, B and M.

    They are those of :func:`derivative` at a bounce. A ball that begins to slide keeps what its error has along the
    wall; where endless bounces stop it (see ``wallkit.simulation.horizon``), it goes on later by dT, so with -a dT.
    Where they leave it its speed along the wall, what pulled it along before is taken from a. One that runs off an edge
    by dt = -(dx.v) / v^2 later falls so much later: its velocity differs by the jump of the acceleration times dt. One
    that turns round under a does so by dt = -dv.a / a^2 later, and goes off under h: dv' = -h dt.
    """
    nx, ny, ux, uy = path[i, 3], path[i, 4], path[i, 1], path[i, 2]
    hx, hy = pull[i + 1, 0] - drag * ux, pull[i + 1, 1] - drag * uy
    if path[i, 5] == BOUNCES:
        return derivative(vx, vy, ux, uy, nx, ny, (keep[i, 0], keep[i, 1]), bend[i], (ax, ay), (hx, hy))
    one, none = (1.0, 0.0, 0.0, 1.0), (0.0, 0.0, 0.0, 0.0)
    if path[i, 5] == ENDS:
        return one, one, none, one
    if path[i, 5] == LEAVES:
        square = vx * vx + vy * vy
        jx, jy = (0.0, 0.0) if square == 0.0 else ((hx - ax) / square, (hy - ay) / square)
        return one, one, (jx * vx, jx * vy, jy * vx, jy * vy), one
    along = _along(nx, ny)
    if path[i, 5] == JOINS:
        k = bend[i]
        return one, along, (k * ux * nx, k * ux * ny, k * uy * nx, k * uy * ny), along
    if path[i, 5] == PASSES:  # from edge to edge: that place is where it is
        return none, along, none, along
    if path[i, 5] == TURNS:  # who stays there goes off with nothing
        square = ax * ax + ay * ay
        keeps = max(hx * ax + hy * ay, 0.0) / square if square > 0.0 else 1.0
        return along, along, none, _scaled(along, keeps)
    if path[i, 5] == STOPS or path[i, 5] == SLOWS:
        return _after_last_bounces(along, path, bend, keep, pull, hx, hy, ax, ay, i)
    return along, along, none, along


@kernel
def _along(nx: float, ny: float) -> Any:
    """What of a vector is along the wall: 1 - n n^T."""
    return ny * ny, -nx * ny, -nx * ny, nx * nx


@kernel
def _after_last_bounces(
    along: Any, path: Any, bend: Any, keep: Any, pull: Any, hx: float, hy: float, ax: float, ay: float, i: int
) -> Any:
    """Give S, A, B and M where endless bounces end that stop a ball, or after which friction slows it down.

    The last bounce that is told leaves at w, dt = -dx.n / w late and faster by dw = dv.n - p dt + k u dx.t, for along a
    curve n turns; its series takes a time T in proportion to w, so dT = dt + T dw / w. Where restitution f along the
    wall stops it, after the way c u, it stops farther by u dt and by that way times dw / w: for the first two parts of
    dw by u (1 - c p / w) dt, at the time of ``_lasts``.
    """
    T, k = path[i, 0] - path[i - 1, 0], bend[i - 1]
    nx, ny = path[i - 1, 3], path[i - 1, 4]  # of that bounce: on an arc it turns from there by more than w / v
    w, c, p = _series(path, bend, keep, pull, i)
    part = 1.0 - T * p / w
    # Here, `since` later, dx.n has `since` dv.n more.
    since = _lasts(path, bend, keep, pull, T, i)
    d, m = -part / w, (T + part * since) / w
    keeps = 1.0 if path[i, 5] == SLOWS else 0.0  # of what it had until then
    jx, jy = hx - keeps * ax, hy - keeps * ay
    px, py = along[0] * jx + along[1] * jy, along[2] * jx + along[3] * jy
    late = (-px * m * nx, -px * m * ny, -py * m * nx, -py * m * ny)
    # u as a vector along the wall, there.
    across = path[i - 1, 1] * nx + path[i - 1, 2] * ny
    ux, uy = path[i - 1, 1] - across * nx, path[i - 1, 2] - across * ny
    lx, ly = d * nx + T * k / w * ux, d * ny + T * k / w * uy
    place = along
    if path[i, 5] == STOPS:
        far = (c * p / w - 1.0) / w
        fx, fy = far * nx + c * k / w * ux, far * ny + c * k / w * uy
        place = _plus(along, (ux * fx, ux * fy, uy * fx, uy * fy))
    return (
        place,
        place,
        (-px * lx, -px * ly, -py * lx, -py * ly),
        _plus(_scaled(along, keeps), late),
    )


@kernel
def _series(path: Any, bend: Any, keep: Any, pull: Any, i: int) -> Any:
    """Endless bounces that end at i: (w at first, their way over the speed u along the wall at first, p at first).

    Each takes 2 w / p, and leaves the parts e of w and f of u; what presses the ball, p = -g.n - k u^2, changes with u.
    """
    nx, ny, vx, vy = path[i - 1, 3], path[i - 1, 4], path[i - 1, 1], path[i - 1, 2]
    w, u = vx * nx + vy * ny, vy * nx - vx * ny
    flat, square = -(pull[i, 0] * nx + pull[i, 1] * ny), -bend[i - 1] * u * u
    first = flat + square
    time, left, total = 2.0 * w, 1.0, 0.0
    for _bounce in range(BOUNCES_IN_SERIES):
        total += left * time / (flat + left * left * square)
        time, left = keep[i, 1] * time, keep[i, 0] * left
        if time * left < LEFT_IN_SERIES * w:
            break
    return w, total, first


@kernel
def _lasts(path: Any, bend: Any, keep: Any, pull: Any, t: float, i: int) -> float:
    """Time for which an error is carried from contact to contact: t, but where endless bounces stop a ball.

    dw / w = (dv.n - p dt) / w adds c u dv.n / w to what is above for dx.n: both are one for dx.n + dv.n c / (c p / w -
    1) there, which is dx.n at that time.
    """
    if path[i, 5] != STOPS:
        return t
    w, c, p = _series(path, bend, keep, pull, i)
    lasting: float = c / (c * p / w - 1.0)
    return lasting


@kernel
def _times(m: Any, n: Any) -> Any:
    """Multiply two 2 x 2 matrices, given by rows."""
    return (
        m[0] * n[0] + m[1] * n[2],
        m[0] * n[1] + m[1] * n[3],
        m[2] * n[0] + m[3] * n[2],
        m[2] * n[1] + m[3] * n[3],
    )


@kernel
def _times_turned(m: Any, n: Any) -> Any:
    """Multiply a 2 x 2 matrix with another's transpose, m n^T."""
    return _times(m, (n[0], n[2], n[1], n[3]))


@kernel
def _plus(m: Any, n: Any) -> Any:
    return m[0] + n[0], m[1] + n[1], m[2] + n[2], m[3] + n[3]


@kernel
def _scaled(m: Any, part: float) -> Any:
    return part * m[0], part * m[1], part * m[2], part * m[3]


@kernel
def _eased(drag: float, t: float) -> Any:
    """Part of a velocity that drag leaves in a time, and the free time, see ``drag_motion``."""
    if drag == 0.0:
        return 1.0, t
    left, free, _second = eased(drag, t)
    return left, free


@kernel
def _flown(xx, xv, vv, t, left, drag):
    """Carry the covariances of place, of place with velocity, and of velocity through a free flight.

    It takes dx to dx + t dv: Var x + t (C + C^T) + t^2 Var v, and C + t Var v. With drag t is the free time, and dv has
    lost as much as v has.
    """
    both = _plus(xv, (xv[0], xv[2], xv[1], xv[3]))
    more = (t * (both[0] + t * vv[0]), t * (both[1] + t * vv[1]), t * (both[2] + t * vv[2]), t * (both[3] + t * vv[3]))
    xx = _plus(xx, more)
    xv = _plus(xv, (t * vv[0], t * vv[1], t * vv[2], t * vv[3]))
    if drag > 0.0:
        xv, vv = _scaled(xv, left), _scaled(vv, left * left)
    return xx, xv, vv


@kernel
def _glided(xx: Any, xv: Any, vv: Any, g: Any) -> Any:
    """Carry the covariances along a circle, as those of (xi, eta): see ``wallkit.simulation.glide_errors``."""
    px, py, tx, ty, k = g[4], g[5], g[6], g[7], g[12]
    # Var(xi, eta) from the components along p; then M Var M^T.
    c11 = px * (xx[0] * px + xx[1] * py) + py * (xx[2] * px + xx[3] * py)
    c12 = px * (xv[0] * px + xv[1] * py) + py * (xv[2] * px + xv[3] * py)
    c22 = px * (vv[0] * px + vv[1] * py) + py * (vv[2] * px + vv[3] * py)
    m = (g[8], g[9], g[10], g[11])
    d11, d12, _d21, d22 = _times_turned(_times(m, (c11, c12, c12, c22)), m)
    # dx = xi t and dv = eta t + k xi e, e = (ty, -tx).
    tt, te, ee = (
        (tx * tx, tx * ty, tx * ty, ty * ty),
        (tx * ty, -tx * tx, ty * ty, -tx * ty),
        (ty * ty, -tx * ty, -tx * ty, tx * tx),
    )
    both = _plus(te, (te[0], te[2], te[1], te[3]))
    xv = _plus(_scaled(tt, d12), _scaled(te, k * d11))
    return _scaled(tt, d11), xv, _plus(_plus(_scaled(tt, d22), _scaled(both, k * d12)), _scaled(ee, k * k * d11))


@kernel
def _met(xx: Any, xv: Any, vv: Any, A: Any, B: Any, M: Any) -> tuple[Any, Any, Any]:
    """Carry covariances through a contact: dx' = A dx and dv' = B dx + M dv."""
    back = (xv[0], xv[2], xv[1], xv[3])
    turned = _plus(_times(B, xx), _times(M, back))
    new_vv = _plus(_times_turned(turned, B), _times_turned(_plus(_times(B, xv), _times(M, vv)), M))
    new_xv = _plus(_times_turned(_times(A, xx), B), _times_turned(_times(A, xv), M))
    return _times_turned(_times(A, xx), A), new_xv, new_vv


@kernel
def _outer(x: float, y: float) -> Any:
    return x * x, x * y, x * y, y * y


@kernel
def _wall_moved(d: float, wx: float, wy: float, across: float, nx: float, ny: float, B: Any) -> tuple[Any, Any, Any]:
    """Covariances that a wall adds which is elsewhere by d along its normal n: as a ball that is off by -d n meets it.

    dx' = d (n - A n) and dv' = -d B n; with A = 1 - w n^T / (v.n) and w = v - v', n - A n is w / (v.n). A hollow met at
    a small angle is met far along it, where its normal is another one: that is in B.
    """
    px, py = d * wx / across, d * wy / across
    qx, qy = -d * (B[0] * nx + B[1] * ny), -d * (B[2] * nx + B[3] * ny)
    return _outer(px, py), (px * qx, px * qy, py * qx, py * qy), _outer(qx, qy)


@kernel
def _one_flown(error: Any, t: float, left: float, g: Any) -> Any:
    """Carry one error (dx, dv) to the next contact: as ``_flown``, or along a circle as ``_glided``."""
    x, y, p, q = error
    if g[0] != g[0]:
        return x + p * t, y + q * t, p * left, q * left
    px, py, tx, ty = g[4], g[5], g[6], g[7]
    xi, eta = x * px + y * py, p * px + q * py
    xi, eta = g[8] * xi + g[9] * eta, g[10] * xi + g[11] * eta
    k = g[12] * xi
    return xi * tx, xi * ty, eta * tx + k * ty, eta * ty - k * tx


@kernel
def _one_met(error: Any, A: Any, B: Any, M: Any) -> Any:
    """Carry one error through a contact, as ``_met``."""
    x, y, p, q = error
    return (
        A[0] * x + A[1] * y,
        A[2] * x + A[3] * y,
        B[0] * x + B[1] * y + M[0] * p + M[1] * q,
        B[2] * x + B[3] * y + M[2] * p + M[3] * q,
    )


@kernel
def _with_made(made: Any, sums: Any, error: Any, S: Any, A: Any, B: Any, M: Any, i: int) -> Any:
    """Carry the known error through a contact and add what is made there; note its sizes, place and velocity."""
    x, y, _p, _q = error
    wx, wy = S[0] * x + S[1] * y + made[i, 0], S[2] * x + S[3] * y + made[i, 1]
    x, y, p, q = _one_met(error, A, B, M)
    x, y, p, q = x + made[i, 2], y + made[i, 3], p + made[i, 4], q + made[i, 5]
    sums[i, 0], sums[i, 1] = math.sqrt(wx * wx + wy * wy), math.sqrt(p * p + q * q)
    return x, y, p, q


@kernel
def carry(
    start: Any,
    path: Any,
    bend: Any,
    keep: Any,
    pull: Any,
    drag: float,
    glides: Any,
    fresh: Any,
    made: Any,
    variance: Any,
    sums: Any,
) -> None:
    """Fill ``variance`` with that of the place of each contact, and of the velocity after it before it is rounded.

    Args:
        start: (2,) velocity at time 0.
        path: (n, 6) time, velocity after, normal of each contact, and what it is: ``BOUNCES`` and so on.
        bend: (n,) curvature.
        keep: (n, 2) tangential and normal restitution.
        pull: (n + 1, 2) acceleration before each contact and after the last, drag aside.
        drag: rate under gravity, or 0.
        glides: (n, 13) of ``wallkit.simulation.glide_errors``, of not-a-number where the ball came no circle along.
        fresh: (n, 4) new at each contact: displacement of the wall, turn of its normal, rounding of the place,
            and of the velocity relative to the speed; 0 where it is known.
        made: (n, 6) known errors of each contact, see ``wallkit.simulation.made_errors``, or None.
        variance: (n, 2), filled; left as it is after the first place of more than 1e300.
        sums: (n, 2) filled likewise with what known errors add up to, of the same two.
    """
    ux, uy = start[0], start[1]
    error = (0.0, 0.0, 0.0, 0.0)
    # covariances of position, of position with velocity, of velocity; the start is exact: it is what was asked for
    xx = xv = vv = (0.0, 0.0, 0.0, 0.0)
    now = 0.0
    for i in range(len(path)):
        t = path[i, 0] - now
        now = path[i, 0]
        left, t = _eased(drag, _lasts(path, bend, keep, pull, t, i))
        vx, vy = ux * left + pull[i, 0] * t, uy * left + pull[i, 1] * t
        ax, ay = pull[i, 0] - drag * vx, pull[i, 1] - drag * vy
        if made is not None:
            error = _one_flown(error, t, left, glides[i])
        if glides[i, 0] == glides[i, 0]:
            xx, xv, vv = _glided(xx, xv, vv, glides[i])
            vx, vy, ax, ay = glides[i, 0], glides[i, 1], glides[i, 2], glides[i, 3]
        else:
            xx, xv, vv = _flown(xx, xv, vv, t, left, drag)
        ux, uy, nx, ny = path[i, 1], path[i, 2], path[i, 3], path[i, 4]
        across = vx * nx + vy * ny
        if path[i, 5] == BOUNCES and not across < 0:
            break  # not a bounce that a neighbour shares: it began in contact
        S, A, B, M = contact(vx, vy, ax, ay, path, bend, keep, pull, drag, i)
        place = _times_turned(_times(S, xx), S)
        # the trace of S Var(x) S^T, and rounding
        variance[i, 0] = place[0] + place[3] + 2 * fresh[i, 2] * fresh[i, 2]
        if path[i, 5] == BOUNCES:  # the wall elsewhere by d is met at d (n - v / (v.n)) along it, and d along n
            variance[i, 0] += fresh[i, 0] * fresh[i, 0] * (vx * vx + vy * vy) / (across * across)
        if not variance[i, 0] < 1e300:
            break
        if made is not None:
            error = _with_made(made, sums, error, S, A, B, M, i)
            if not sums[i, 0] < 1e150:
                break
        xx, xv, vv = _met(xx, xv, vv, A, B, M)
        variance[i, 1] = vv[0] + vv[3]
        rounded = fresh[i, 2] * fresh[i, 2]
        if path[i, 5] != BOUNCES:  # nothing is turned
            xx = _plus(xx, _scaled(_along(nx, ny), rounded))
            vv = _plus(vv, _scaled(_outer(ux, uy), fresh[i, 3] * fresh[i, 3]))
            continue
        moved = _wall_moved(fresh[i, 0], vx - ux, vy - uy, across, nx, ny, B)
        xx, xv, vv = _plus(xx, moved[0]), _plus(xv, moved[1]), _plus(vv, moved[2])
        # Its normal turned by `turn` turns v', with dn = (ny, -nx) turn; and the state is rounded.
        turn, slip = fresh[i, 1] * (keep[i, 0] + keep[i, 1]), vx * ny - vy * nx
        turned = _outer(turn * (nx * slip + across * ny), turn * (ny * slip - across * nx))
        joins = i + 1 < len(path) and (path[i + 1, 5] == STOPS or path[i + 1, 5] == SLOWS)
        # Who joins the wall is put on it: of the rounding of its place what is along the wall is left.
        xx = _plus(xx, _scaled(_along(nx, ny), rounded) if joins else (rounded, 0.0, 0.0, rounded))
        rounded = fresh[i, 3] * fresh[i, 3] * (ux * ux + uy * uy)
        vv = _plus(_plus(vv, turned), (rounded, 0.0, 0.0, rounded))


@kernel
def stretch(
    start: Any, path: Any, bend: Any, keep: Any, pull: Any, drag: float, glides: Any, error: Any, logs: Any
) -> None:
    """Carry one small error (dx, dv) along and fill ``logs`` with the logarithm of its growth at each bounce."""
    ux, uy = start[0], start[1]
    carried = (error[0], error[1], error[2], error[3])
    now = 0.0
    for i in range(len(path)):
        t = path[i, 0] - now
        now = path[i, 0]
        left, t = _eased(drag, _lasts(path, bend, keep, pull, t, i))
        vx, vy = ux * left + pull[i, 0] * t, uy * left + pull[i, 1] * t
        ax, ay = pull[i, 0] - drag * vx, pull[i, 1] - drag * vy
        carried = _one_flown(carried, t, left, glides[i])
        if glides[i, 0] == glides[i, 0]:
            vx, vy, ax, ay = glides[i, 0], glides[i, 1], glides[i, 2], glides[i, 3]
        ux, uy = path[i, 1], path[i, 2]
        _, A, B, M = contact(vx, vy, ax, ay, path, bend, keep, pull, drag, i)
        x, y, p, q = _one_met(carried, A, B, M)
        # Scaled back to 1 at each bounce, as Benettin et al. (1980) do for Lyapunov exponents.
        size = math.sqrt(x * x + y * y + p * p + q * q)
        logs[i] = math.log(size)
        carried = (x / size, y / size, p / size, q / size)
