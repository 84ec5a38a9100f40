"""How a ball moves between contacts, and how a contact turns its velocity."""

from __future__ import annotations

from wallkit.kernels.jit import kernel


@kernel
def advance(time, lost, step):
    """Add a step to the time and keep what rounding loses (Neumaier's sum): (time, lost)."""
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
        return _with_energy(vx - factor * nx, vy - factor * ny, energy)
    e = restitution[2 * wall]
    f = restitution[2 * wall + 1]
    energy = f * f * energy + (e * e - f * f) * (0.5 * factor * normal)
    part = 0.5 * (f + e) * factor
    return _with_energy(f * vx - part * nx, f * vy - part * ny, energy)


@kernel
def _with_energy(vx, vy, energy):
    """Scale v to the squared speed ``energy``, which it has but for rounding: one Newton step of 1 / sqrt."""
    if energy <= 0.0:
        return 0.0, 0.0, 0.0
    scale = 1.5 - 0.5 * ((vx * vx + vy * vy) / energy)
    return vx * scale, vy * scale, energy
