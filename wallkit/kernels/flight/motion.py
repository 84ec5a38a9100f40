"""How a ball moves between contacts, and how a contact turns its velocity."""

from __future__ import annotations

from wallkit.kernels.jit import kernel, rare_kernel

NEARLY_ALL = 2.0**-20
"""Where a bounce leaves less than this part of the squared speed, the difference of squares has too few digits left."""


@kernel
def advance(time, lost, step):
    """Add a step to the time and keep what rounding loses (Neumaier's sum): (time, lost)."""
    # What the total leaves of the larger one is exact, and so is what that lacks of the smaller one.
    total = time + step
    more, less = max(time, step), min(time, step)
    rest = (more - total) + less
    return total, lost + rest


@kernel
def reflect(restitution, wall, nx, ny, twice, vx, vy, energy):
    """Turn a velocity at a wall with normal n (any length), twice = 2 / (n.n): (vx, vy, speed squared).

    v' = f v - (f + e) (v.n) n / (n.n), with e and f the restitution along the normal and along the wall. The
    squared speed after that is f^2 v^2 + (e^2 - f^2) (v.n)^2 / (n.n), and the result is scaled to it, so that
    the speed does not drift: with e = f = 1 it stays what it was at the start.
    """
    normal = vx * nx + vy * ny
    factor = normal * twice
    if restitution is None:
        return with_energy(vx - factor * nx, vy - factor * ny, energy)
    e = restitution[2 * wall]
    f = restitution[2 * wall + 1]
    before = energy
    # The normal part of v is (v.n) n / n.n, its square (v.n)^2 / n.n = factor normal / 2.
    energy = squared_after(e, f, energy, 0.5 * factor * normal)
    if energy < NEARLY_ALL * before:
        return _what_is_left(e, f, nx, ny, twice, vx, vy, normal)
    return bounced(e, f, nx, ny, factor, vx, vy, energy)


@kernel
def squared_after(e, f, square, across):
    """Squared speed after a bounce, where ``across`` is the square of the normal part before: see ``reflect``."""
    return f * f * square + (e * e - f * f) * across


@kernel
def bounced(e, f, nx, ny, factor, vx, vy, energy):
    """Turn a velocity as ``reflect`` says, where it keeps the squared speed ``energy``: factor = 2 (v.n) / (n.n)."""
    part = 0.5 * (f + e) * factor
    return with_energy(f * vx - part * nx, f * vy - part * ny, energy)


@rare_kernel
def _what_is_left(e, f, nx, ny, twice, vx, vy, normal):
    """Turn a velocity that a dead wall takes nearly all of: from its parts along n and across, none by cancellation.

    What is left along a wall that is hit straight on is the rounding of v x n (some 2^-52 |v| |n|): nothing.
    """
    along, whole = vy * nx - vx * ny, 0.5 * twice
    if along * along * whole <= 2.0**-98 * (vx * vx + vy * vy):
        along = 0.0
    # f (v x n) / n.n along (-ny, nx), and -e (v.n) / n.n along n: n is of any length, and `whole` is 1 / n.n.
    across, up = f * along * whole, -e * normal * whole
    x, y = up * nx - across * ny, up * ny + across * nx
    return x, y, x * x + y * y


@kernel
def with_energy(vx, vy, energy):
    """Scale v to the squared speed ``energy``, which it has but for rounding: one Newton step of 1 / sqrt."""
    if energy <= 0.0:
        return 0.0, 0.0, 0.0
    # 1 / sqrt(q) is 1.5 - 0.5 q but for 3/8 (1 - q)^2, and q is 1 but for rounding.
    scale = 1.5 - 0.5 * ((vx * vx + vy * vy) / energy)
    return vx * scale, vy * scale, energy
