"""Biarcs and distances from them, for one span; ``walls.importing.arc_fitting.biarcs`` derives the formulas.

They are written as NumPy computes them there, operation by operation: a real number times a complex one is the product
of two complex numbers, so that zeros have the same signs.
"""

from __future__ import annotations

import math

from wallkit.kernels.jit import kernel


@kernel
def dot(a, b):
    """Scalar product of plane vectors."""
    return a.real * b.real + a.imag * b.imag


@kernel
def cross(a, b):
    """Positive where b is left of a."""
    return a.real * b.imag - a.imag * b.real


@kernel
def length(z):
    """Absolute value."""
    return math.sqrt(z.real * z.real + z.imag * z.imag)


@kernel
def unit(z):
    """Give the number of length one; 0 stays 0."""
    size = length(z)
    return complex(z.real / size, z.imag / size) if size > 0.0 else complex(0.0, 0.0)


@kernel
def turned_back(a, b):
    """Give a conj(b), which is a in axes along b where b has length one."""
    return complex(dot(b, a), cross(b, a))


@kernel
def larger(a, b):
    """Give the larger of two numbers; what is not a number is larger than all."""
    return b if (b > a) | (b != b) else a


@kernel
def half_tangent(side, ahead):
    """Tan(h / 2) of the angle h between vectors, by cross and dot product."""
    size = math.sqrt(side * side + ahead * ahead)
    side = abs(side)
    back = ahead < 0.0
    over = size - ahead if back else side
    under = side if back else size + ahead
    return over / (under + 1e-300)


@kernel
def offset(x, y, bend):
    """Signed distance of a point in axes at J along the arcs, ``bend`` the curvature of the arc on its side."""
    f = ((x * x + y * y) * bend) / 2.0 - y
    root = 2.0 * bend * f + 1.0
    root = math.sqrt(0.0 if root < 0.0 else root) + 1.0
    return f * -2.0 / root


@kernel
def arc_from(direction, chord):
    """Curvature and bulge of the arc that starts in a direction and has a chord."""
    side, ahead, square = cross(direction, chord), dot(direction, chord), dot(chord, chord)
    if not square > 0.0:
        return 0.0, 0.0
    under = math.sqrt(square) + ahead
    bulge = side / under if under != 0.0 else math.inf
    return 2.0 * side / square, bulge if math.isfinite(bulge) else 0.0


@kernel
def biarc(p0, p1, t0, t1, limit, straight):
    """Join two points with directions by arcs.

    Args:
        p0: start.
        p1: end.
        t0: direction there.
        t1: direction at the end.
        limit: directions that are equal within it make the two arcs one.
        straight: a smaller bulge is none.

    Returns:
        Joint, direction there, both curvatures, both bulges, whether the arcs are one, and whether they are sound.
    """
    v, both, across = p1 - p0, t0 + t1, t0 - t1
    ahead, apart, square = dot(v, both), dot(across, across), dot(v, v)
    sound = ahead > 0.0
    arm = square / (ahead + math.sqrt(ahead * ahead + apart * square)) if sound else 0.0
    if not math.isfinite(arm):
        sound, arm = False, 0.0
    joint = (p0 + p1 + arm * across) / 2
    along = unit(v - arm * both)
    bend0, bulge0 = arc_from(t0, joint - p0)
    bend1, bulge1 = arc_from(along, p1 - joint)
    chord = unit(v)
    start, end = turned_back(chord, t0), turned_back(t1, chord)
    single = (sound and length(start - end) <= limit) or (v.real == 0.0 and v.imag == 0.0)
    if single:
        half, size = unit(start + end), length(v)
        under = 1.0 + half.real
        bulge0, bulge1 = half.imag / under if under != 0.0 else half.imag * math.inf, 0.0
        joint, along = (p0 + p1) / 2 - 0.5j * v * bulge0, chord
        bend0 = 2.0 * half.imag / size if size > 0.0 else 0.0
        bend1 = bend0
    sound = sound and abs(bulge0) <= 1.0 and abs(bulge1) <= 1.0
    bulge0 = 0.0 if abs(bulge0) < straight else bulge0
    bulge1 = 0.0 if abs(bulge1) < straight else bulge1
    return joint, along, bend0, bend1, bulge0, bulge1, single, sound


@kernel
def biarcs_of(p0, p1, t0, t1, limits, straight, ends, bends, bulges, told):
    """Join the ends of spans by arcs: (n,) each.

    Args:
        p0: starts.
        p1: ends.
        t0: directions at the starts.
        t1: directions at the ends.
        limits: see :func:`biarc`.
        straight: see :func:`biarc`.
        ends: (2, n) joints and directions there, written.
        bends: (2, n) curvatures, written.
        bulges: (2, n) written.
        told: (2, n) whether the arcs are one, and whether they are sound, written.
    """
    for n in range(len(p0)):
        joint, along, bend0, bend1, bulge0, bulge1, single, sound = biarc(
            p0[n], p1[n], t0[n], t1[n], limits[n], straight
        )
        ends[0, n], ends[1, n] = joint, along
        bends[0, n], bends[1, n] = bend0, bend1
        bulges[0, n], bulges[1, n] = bulge0, bulge1
        told[0, n], told[1, n] = single, sound
