"""Two discs: when they touch, and what that makes of their velocities."""

from __future__ import annotations

import math

from wallkit.kernels.flight.gravity import move
from wallkit.kernels.flight.motion import advance
from wallkit.kernels.jit import kernel
from wallkit.kernels.meeting.records import LOST, NEVER, RADIUS, TIME, VX, VY, X, Y


@kernel
def begins(one, other):
    """How long two flights must be carried on to the later of their beginnings: (that of one, that of the other).

    Exact but for the rounding of the difference, however late it is: what the clocks lost counts.
    """
    span = (one[TIME] - other[TIME]) + (one[LOST] - other[LOST])
    return (-span if span < 0.0 else 0.0), (span if span > 0.0 else 0.0)


@kernel
def meeting_time(gravity, one, other):
    """When two discs in flight touch: (time of the clock, time from the later of their beginnings); or NEVER.

    Both fall alike, so that their relative motion d + w t is a straight line, under gravity too. |d + w t| = s has
    the discriminant D = s^2 w^2 - (d x w)^2, taken from the distance at which they pass, and the smaller root
    t = c / q, c = d.d - s^2, q = -d.w + sqrt(D); nothing cancels in q, because only d.w < 0 approaches. An overlap that
    approaches is a contact now. Asked of (other, one) the answer has the same bits.
    """
    first, second = begins(one, other)
    ax, ay, avx, avy = move(gravity, one[X], one[Y], one[VX], one[VY], first)
    bx, by, bvx, bvy = move(gravity, other[X], other[Y], other[VX], other[VY], second)
    dx, dy, wx, wy = ax - bx, ay - by, avx - bvx, avy - bvy
    towards = -(dx * wx + dy * wy)
    reach = one[RADIUS] + other[RADIUS]
    cross = dx * wy - dy * wx
    square = reach * reach
    discriminant = square * (wx * wx + wy * wy) - cross * cross
    if (towards <= 0.0) | (discriminant < 0.0):  # one branch, for it is not foreseen which of the two it is
        return NEVER, 0.0
    c = dx * dx + dy * dy - square
    t = c / (towards + math.sqrt(discriminant)) if c > 0.0 else 0.0
    if first > 0.0 or (first == second and one[TIME] < other[TIME]):
        return other[TIME] + (other[LOST] + t), t
    return one[TIME] + (one[LOST] + t), t


@kernel
def carry(gravity, row, time, lost, first, t):
    """Carry a flight on to the later of two beginnings, then to the contact, as ``meeting_time`` saw it."""
    x, y, vx, vy = move(gravity, row[X], row[Y], row[VX], row[VY], first)
    row[X], row[Y], row[VX], row[VY] = move(gravity, x, y, vx, vy, t)
    row[TIME], row[LOST] = advance(time, lost, t)


@kernel
def meet_at(gravity, one, other):
    """Carry two discs to their contact."""
    first, second = begins(one, other)
    _due, t = meeting_time(gravity, one, other)
    time, lost = one[TIME], one[LOST]
    if first > 0.0 or (first == second and one[TIME] < other[TIME]):
        time, lost = other[TIME], other[LOST]
    carry(gravity, one, time, lost, first, t)
    carry(gravity, other, time, lost, second, t)


@kernel
def collide(restitution, gravity, hop, one, other, part_one, part_other):
    """Turn the velocities of two discs that touch; d from other to one, w of one relative to other, n = d / |d|.

    With e and f the restitution along n and across, w' = f (w - (w.n) n) - e (w.n) n, so that w changes by
    -(1 + e) (w.n) n - (1 - f) (w - (w.n) n). Of this one takes its part m2 / (m1 + m2), other the rest: momentum
    stays. Neither has spin. Under gravity they part at no less than ``hop``, where restitution takes speed.
    """
    dx, dy = one[X] - other[X], one[Y] - other[Y]
    wx, wy = one[VX] - other[VX], one[VY] - other[VY]
    normal = (wx * dx + wy * dy) / (dx * dx + dy * dy)
    if restitution is None:
        ux, uy = -2.0 * normal * dx, -2.0 * normal * dy
    else:
        e, f = restitution[0], restitution[1]
        whole = (1.0 + e) - (1.0 - f)
        ux, uy = -whole * normal * dx - (1.0 - f) * wx, -whole * normal * dy - (1.0 - f) * wy
        if gravity is not None:
            length = math.sqrt(dx * dx + dy * dy)
            lacks = hop + e * normal * length  # they part at -e (w.n)
            if e < 1.0 and lacks > 0.0:
                ux, uy = ux + lacks * dx / length, uy + lacks * dy / length
    one[VX] += part_one * ux
    one[VY] += part_one * uy
    other[VX] -= part_other * ux
    other[VY] -= part_other * uy
