"""A point that hops in the tip of a valley whose walls take speed along themselves only: where that leads to.

Both walls rise from the tip, give back all speed across them (e = 1) and keep the part f < 1 of that along them. A
bounce takes (1 - f^2) u^2 / 2 of the energy, u the speed along the wall, and nothing brings any: so the energy has a
limit, and what it tends to loses nothing: it meets each wall square to it. From where it leaves a wall square to it,
gravity, which pulls along that wall, brings it back to it at another angle. So what loses nothing hops from one wall
to the other and back on one parabola, square to both.

Across gravity its speed stays: with unit normals n into the valley and h across gravity

    w1 n1.h = -w2 n2.h,    T = -(w1 n1 + w2 n2).g / g^2,    w1 n1 T + g T^2 / 2 = b t2 - a t1,

so there is one in each size, at the ways a and b up the walls, or none, if a or b is below 0. Where there is none, the
energy tends to 0: the point comes to rest in the tip. So it does where that hop is not stable; else it may end in it.

With the energy kept, a neighbour's change of way s and of speed u along the wall become, one flight later,

    s2 = t2.x,    u2 = f2 (t2.v + (g.t2) (n2.x) / w2),    x = s t1 + T v,    v = u t1 + (g.t1 / w1) s n1:

v.n1 from the energy, and the last term from n2.x / w2, the time by which it meets the wall later. There and back that
is a matrix with the determinant f1 f2, and it is stable where its trace is less than 1 + f1 f2. The whole has no size:
what is said of a tip holds for hops as small as one likes.
"""

from __future__ import annotations

from wallkit.kernels.jit import kernel, rare_kernel

MARGIN = 2.0**-10
"""Of ways and traces; walls bow by less along hops in the first 2^-20 of them."""


@rare_kernel
def may_hop_on(gravity, one, other, keeps, other_keeps):
    """Tell whether a point may hop for ever between two edges that rise from a tip, and give back what is across them.

    Args:
        gravity: (gx, gy).
        one: ``Joint`` of an edge at the tip; t is its direction out from there.
        other: that of the other edge, less than half a turn away.
        keeps: part below 1 of the speed along the first edge that it leaves.
        other_keeps: the same of the other edge.
    """
    gx, gy = gravity[0], gravity[1]
    cross = one.tx * other.ty - one.ty * other.tx
    turn = 1.0 if cross > 0.0 else -1.0
    t, n = (one.tx, one.ty), (-turn * one.ty, turn * one.tx)
    s, m = (other.tx, other.ty), (turn * other.ty, -turn * other.tx)
    w, z = m[0] * gy - m[1] * gx, n[1] * gx - n[0] * gy
    if w * z <= 0.0:
        return False
    w, z = abs(w), abs(z)
    time = -((w * n[0] + z * m[0]) * gx + (w * n[1] + z * m[1]) * gy) / (gx * gx + gy * gy)
    if time <= 0.0:
        return False
    dx, dy = (w * n[0] + 0.5 * gx * time) * time, (w * n[1] + 0.5 * gy * time) * time
    a, b = (dy * s[0] - dx * s[1]) / cross, (dy * t[0] - dx * t[1]) / cross
    if min(a, b) < -MARGIN * (abs(dx) + abs(dy)):
        return False
    p = _flight(gx, gy, t, n, w, s, m, z, time, other_keeps)
    q = _flight(gx, gy, s, m, z, t, n, w, time, keeps)
    trace = q[0] * p[0] + q[1] * p[2] + q[2] * p[1] + q[3] * p[3]
    return abs(trace) < 1.0 + keeps * other_keeps + MARGIN


@kernel
def _flight(gx, gy, t, n, w, s, m, z, time, keeps):
    """Derivative of (way, speed) along an edge with direction s by those along one with t, by rows; normals m, n."""
    pull, along = (gx * t[0] + gy * t[1]) / w, (gx * s[0] + gy * s[1]) / z
    st, sn = s[0] * t[0] + s[1] * t[1], s[0] * n[0] + s[1] * n[1]
    mt, mn = m[0] * t[0] + m[1] * t[1], m[0] * n[0] + m[1] * n[1]
    return (
        st + time * pull * sn,
        time * st,
        keeps * (pull * sn + along * (mt + time * pull * mn)),
        keeps * (st + along * time * mt),
    )
