"""The swing of a ball that gravity moves along a circle without friction: a pendulum, in closed form.

With a the angle from the lowest place, h = a / 2, and rho the radius of the way of the centre, energy gives the speed

    V^2 = A cos^2 h + B sin^2 h,    A = V^2 at the bottom, B = A - 4 g rho that at the top (below 0: it turns before)

and the time from h0 to h1, within a quarter 0 <= h <= pi/2 (from the bottom up to the top, or down again), is

    T = 2 rho |integral dh / V| = 2 rho |z1 - z0| R_F(U^2, W^2, X^2),    z = sin^2 h,
    U = s1 c1 V0 + s0 c0 V1,    W = s1 c0 V1 + s0 c1 V0,    X = s1 c0 V0 + s0 c1 V1,    s = sin h, c = cos h

(Carlson's symmetric form, DLMF 19.29.4: the factors below the root are z, 1 - z, A + (B - A) z and 1). All terms are
sums of what is not negative, so no digit is lost: neither from one end of the quarter to the other, nor on a short way,
nor on a circle so large that it is nearly straight (T = 2 way / (V0 + V1)), nor where V or s or c is 0. On the
separatrix (B = 0) the way to the top takes for ever, and R_F says so.

An angle phi from a place on is given as t = tan(phi / 2), 0 <= t <= 1, which needs + - * / and sqrt alone.
"""

from __future__ import annotations

import math
from typing import Any

from wallkit.kernels.jit import kernel, rare_kernel

NEAR = 380.0
"""(3 * 2^-53)^(-1/6), rounded up: R_F's series in the differences, cut after the sixth order, is then good to 2^-53."""
STEPS = 60
"""Of Newton's method in a bracket: a bisection of t in [0, 1] takes 53 at most."""


@rare_kernel
def carlson_rf(x: float, y: float, z: float) -> float:
    """Give R_F(x, y, z) = 1/2 integral over t > 0 of dt / sqrt((t + x)(t + y)(t + z)); inf where two of them are 0.

    Duplication (DLMF 19.36.1 and 19.26.18): x -> (x + l) / 4 with l = sqrt(xy) + sqrt(yz) + sqrt(zx) leaves R_F as it
    is and brings the three together by a factor of four, until a series of their differences is exact.
    """
    if int(x <= 0.0) + int(y <= 0.0) + int(z <= 0.0) > 1:
        return math.inf
    mean = (x + y + z) / 3.0
    # A duplication brings all three four times nearer to their mean; within mean / NEAR the series is exact.
    apart = max(abs(mean - x), abs(mean - y), abs(mean - z)) * NEAR
    dx, dy = mean - x, mean - y
    while apart > mean:
        rx, ry, rz = math.sqrt(x), math.sqrt(y), math.sqrt(z)
        more = rx * ry + ry * rz + rz * rx
        x, y, z = 0.25 * (x + more), 0.25 * (y + more), 0.25 * (z + more)
        mean = 0.25 * (mean + more)
        dx, dy, apart = 0.25 * dx, 0.25 * dy, 0.25 * apart
    p, q = dx / mean, dy / mean
    r = -(p + q)
    # Symmetric functions of the relative differences p, q and r = -(p + q), whose sum is 0 (DLMF 19.36.1).
    e2, e3 = p * q - r * r, p * q * r
    return (1.0 - e2 / 10.0 + e3 / 14.0 + e2 * e2 / 24.0 - 3.0 * e2 * e3 / 44.0) / math.sqrt(mean)


@kernel
def half_angle(ex, ey, gx, gy):
    """Sine and cosine of half the angle between two directions, one of them a unit: each >= 0, none by cancellation."""
    pull = math.sqrt(gx * gx + gy * gy)
    cosine, sine = (ex * gx + ey * gy) / pull, abs(ex * gy - ey * gx) / pull
    # cos(a/2) = sqrt((1 + cos a) / 2) where that adds up, and sin(a/2) = sin a / (2 cos(a/2)); else the sine first.
    if cosine >= 0.0:
        c = math.sqrt(0.5 * (1.0 + cosine))
        return 0.5 * sine / c, c
    s = math.sqrt(0.5 * (1.0 - cosine))
    return s, 0.5 * sine / s


@kernel
def turned(ex: float, ey: float, tx: float, ty: float, t: float) -> Any:
    """Turn the unit e towards the unit t by phi, t = tan(phi / 2): (direction, its own direction ahead)."""
    per = 1.0 / (1.0 + t * t)
    # cos(phi) = (1 - t^2) / (1 + t^2), sin(phi) = 2 t / (1 + t^2).
    c, s = (1.0 - t) * (1.0 + t) * per, 2.0 * t * per
    return c * ex + s * tx, c * ey + s * ty, c * tx - s * ex, c * ty - s * ey


@kernel
def swing_time(rho, gx, gy, ex, ey, fx, fy, t, v0, v1):
    """Time from the direction e, at the speed v0, to f, at v1, t = tan(phi / 2) farther within one quarter."""
    if t <= 0.0:
        return 0.0
    s0, c0 = half_angle(ex, ey, gx, gy)
    s1, c1 = half_angle(fx, fy, gx, gy)
    u, w, x = s1 * c1 * v0 + s0 * c0 * v1, s1 * c0 * v1 + s0 * c1 * v0, s1 * c0 * v0 + s0 * c1 * v1
    # z1 - z0 = sin^2 h1 - sin^2 h0 = sin(h1 - h0) sin(h1 + h0), and h1 - h0 = phi / 2 has the sine t / sqrt(1 + t^2).
    rise = t / math.sqrt(1.0 + t * t) * (s0 * c1 + c0 * s1)
    return 2.0 * rho * rise * carlson_rf(u * u, w * w, x * x)


@kernel
def speed_at(rho, gx, gy, ex, ey, tx, ty, square, t):
    """Speed after a turn by t = tan(phi / 2) from where its square is ``square``: v^2 + 2 rho g.(f - e)."""
    # f - e = 2 t (t_0 - t e) / (1 + t^2), see ``turned``.
    along, across = gx * tx + gy * ty, gx * ex + gy * ey
    return math.sqrt(max(square + 4.0 * rho * t / (1.0 + t * t) * (along - t * across), 0.0))


@rare_kernel
def swing_within(rho, gx, gy, ex, ey, tx, ty, square, t_end, span):
    """Give t = tan(phi / 2), before t_end, that is reached after the time ``span``.

    Newton's method for T(t) = span, with dT/dt = 2 rho / (V (1 + t^2)), in a bracket that it halves where a step leaves
    it. T rises, but is vertical where the ball stands still: bisection is what ends there.
    """
    low, high = 0.0, t_end
    v0 = math.sqrt(square)
    # At first where constant acceleration has it: s = (v + a T / 2) T, and tan(phi / 2) about s / 2 rho.
    t = min(0.5 * (v0 + 0.5 * span * (gx * tx + gy * ty)) * span / rho, t_end)
    if not 0.0 < t < t_end:
        t = 0.5 * t_end
    for _step in range(STEPS):
        fx, fy, _ux, _uy = turned(ex, ey, tx, ty, t)
        v = speed_at(rho, gx, gy, ex, ey, tx, ty, square, t)
        late = swing_time(rho, gx, gy, ex, ey, fx, fy, t, v0, v) - span
        if late == 0.0:
            break
        if late > 0.0:
            high = t
        else:
            low = t
        # dT/dt = 2 rho / (V (1 + t^2)).
        following = t - 0.5 * late * v * (1.0 + t * t) / rho
        if abs(following - t) <= 2.0**-53 * t:
            break
        if not low < following < high:
            following = 0.5 * (low + high)
            if following in (low, high):
                break
        t = following
    return t


@kernel
def to_quarter(ex, ey, tx, ty, gx, gy, off):
    """How far ahead of e the quarter ends, at the bottom or the top: t = tan(phi / 2), at most 1 (a right angle).

    ``off`` is the angle by which rounding may have e off, beside that of its numbers.
    """
    along, across = gx * tx + gy * ty, gx * ex + gy * ey
    ahead = across if along > 0.0 else -across  # on the way down the bottom is next, else the top
    if abs(along) <= (2.0**-50 + off) * abs(across) or ahead <= 0.0:  # it is there, and begins the next one
        return 1.0
    # The angle to the direction of g, or from it, has the sine |g.t| and the cosine `ahead`, times |g|:
    # tan(phi / 2) = sin / (1 + cos).
    return abs(along) / (math.sqrt(along * along + across * across) + ahead)


@rare_kernel
def swing(
    rho: float, gx: float, gy: float, ex: float, ey: float, v: float, span: float
) -> tuple[float, float, float, float, float]:
    """Give where a pendulum is after any time.

    Args:
        rho: radius of the way of the centre.
        gx: gravity, with gy.
        gy: see gx.
        ex: unit direction from the circle's centre to the ball's, with ey.
        ey: see ex.
        v: speed, counter-clockwise; at 0 the ball begins to move where gravity pulls it.
        span: seconds, 0 or more.

    Returns:
        (direction then, speed then, change of the direction, which a large circle has to more digits than the former).

    Quarter by quarter, whole periods taken at once. At rest at the bottom or the top it stays there.
    """
    since, dx, dy, first = 0.0, 0.0, 0.0, True
    if v * v < 2.0**-1000:
        v = 0.0  # as the last speeds in a corner: below all that are modelled, whose squares have all digits
    for _quarter in range(40):
        pull = gy * ex - gx * ey
        if v == 0.0 and pull == 0.0:
            break
        turn = 1.0 if v > 0.0 or (v == 0.0 and pull > 0.0) else -1.0
        # A stretch ends with its quarter of the circle, where the ball turns, or when time is up.
        tx, ty, square = -turn * ey, turn * ex, v * v
        t, t_turn = to_quarter(ex, ey, tx, ty, gx, gy, 0.0), turning(rho, gx, gy, ex, ey, tx, ty, square)
        turns = t_turn < t
        t = min(t, t_turn)
        fx, fy, _ux, _uy = turned(ex, ey, tx, ty, t)
        then = 0.0 if turns else speed_at(rho, gx, gy, ex, ey, tx, ty, square, t)
        time = swing_time(rho, gx, gy, ex, ey, fx, fy, t, abs(v), then)
        ends = since + time > span
        if ends:
            t = swing_within(rho, gx, gy, ex, ey, tx, ty, square, t, span - since)
            fx, fy, _ux, _uy = turned(ex, ey, tx, ty, t)
            then = speed_at(rho, gx, gy, ex, ey, tx, ty, square, t)
        sine = 2.0 * t / (1.0 + t * t)
        dx, dy = dx + sine * (tx - t * ex), dy + sine * (ty - t * ey)
        ex, ey, v = fx, fy, turn * then
        if ends:
            break
        since += time
        if first and passes_bottom(ex, ey, gx, gy) and not turns:
            first = False
            whole = period(rho, math.sqrt(gx * gx + gy * gy), v * v)
            if math.isfinite(whole):
                since += math.floor((span - since) / whole) * whole
    return ex, ey, v, dx, dy


@kernel
def turning(rho, gx, gy, ex, ey, tx, ty, square):
    """How far ahead of e the ball turns, t = tan(phi / 2); inf where not before pi.

    v^2 + 2 rho g.(f - e) = 0 with f - e = 2 t (t_0 - t e) / (1 + t^2): (v^2 - 4 rho g.e) t^2 + 4 rho g.t_0 t + v^2 = 0.
    """
    a = square - 4.0 * rho * (gx * ex + gy * ey)
    half = 2.0 * rho * (gx * tx + gy * ty)
    discriminant = half * half - a * square
    if discriminant < 0.0:
        return math.inf
    root = math.sqrt(discriminant)
    if half >= 0.0:
        return -(half + root) / a if a < 0.0 else math.inf
    # The smaller positive root, by the form that does not cancel where half < 0.
    return square / (root - half)


@kernel
def passes_bottom(ex, ey, gx, gy):
    """Tell whether e is the lowest direction, to rounding."""
    return ex * gx + ey * gy > 0.0 and abs(ex * gy - ey * gx) <= 2.0**-50 * (abs(gx) + abs(gy))


@rare_kernel
def period(rho, pull, square):
    """Time of a full swing, there and back, or of a full turn, of a ball with v^2 = ``square`` at the bottom.

    A swing that turns takes 8 rho K, where its quarter is the integral from the bottom to sin h = sqrt(A / (4 g rho));
    with R_F that is 4 sqrt(rho / g) R_F(0, 1 - m, 1), m = A / (4 g rho). A full turn: 4 rho R_F(0, A - 4 g rho, A).
    """
    whole = 4.0 * pull * rho
    # v^2 / (4 g rho) = sin^2 h where it turns: below 1 it swings, above it goes round.
    if square < whole:
        return 4.0 * math.sqrt(rho / pull) * carlson_rf(0.0, 1.0 - square / whole, 1.0)
    return 4.0 * rho * carlson_rf(0.0, square - whole, square)
