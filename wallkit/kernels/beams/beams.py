"""All directions from one point that reach a disc, by unfolding: the loop over beams.

A beam is what met the same walls so far. It goes from triangle to triangle; the corner that comes next lies beside it,
or splits it in two. So its cost is that of the triangles on its way, however many walls there are elsewhere.
"""

from __future__ import annotations

from wallkit.kernels.beams.targets import split_at_target
from wallkit.kernels.beams.wedges import EVENTS, EXIT, OPEN, go_on, put
from wallkit.kernels.jit import kernel

DONE, FULL = 0, 1
"""What ``split_beams`` came to: no wedge is left; or there is no more room, or so many beams as were allowed."""
NARROW = 2.0**-43
"""Radians, 1.1e-13: a narrower wedge that comes to a wall is given up, and its width is added to ``lost``."""


@kernel
def split_beams(room, target, most, found, most_beams):
    """Follow the wedges that wait until none is left.

    Args:
        room: see ``Room``.
        target: see ``Target``.
        most: K, bounces at most.
        found: read and written, see ``Found``.
        most_beams: beams after which to stop.

    Returns:
        DONE or FULL; after FULL another call goes on, if there is more room.
    """
    counts, beams = found.counts, 0
    while counts[1] > 0:
        if is_full(found) or beams >= most_beams:
            return FULL
        row = counts[1] - 1
        counts[1] = row
        floats, numbers = found.floats, found.numbers
        m = floats[row, 0], floats[row, 1], floats[row, 2], floats[row, 3], floats[row, 4], floats[row, 5]
        lx, ly, rx, ry = floats[row, 6], floats[row, 7], floats[row, 8], floats[row, 9]
        h, k, near = numbers[row, 0], numbers[row, 1], numbers[row, 2]
        while True:
            if h < 0:
                h, lx, ly = enter(room, -1 - h, m, lx, ly, rx, ry, k, near, found)
            edge = room.wall[h]
            if is_full(found):
                put(found, h, m, lx, ly, rx, ry, k, near)
                return FULL
            if edge != OPEN:
                break
            h = -1 - room.across[h]
        beams += at_wall(room, target, most, found, m, lx, ly, rx, ry, h, edge, k, near)
    return DONE


@kernel
def is_full(found):
    """Tell whether what one wedge may become might not find room."""
    return found.counts[0] + EVENTS > len(found.borders) or found.counts[1] + EVENTS > len(found.floats)


@kernel
def enter(room, g, m, lx, ly, rx, ry, k, near, found):
    """Go through the triangle that a wedge enters by half-edge g: (half-edge to leave through, left border).

    The corner opposite is seen at u. Where l x u >= 0 it lies on the left of the wedge, which leaves between u and the
    right end of g; where r x u <= 0 it is the other way round. Else the left part waits, and the right one goes on.
    An odd number of mirrors makes left of right.
    """
    x, y = room.x[g], room.y[g]
    ux, uy = m[0] * x + m[1] * y + m[4], m[2] * x + m[3] * y + m[5]
    i = g % 3
    after, before = (g - 2 if i == 2 else g + 1), (g + 2 if i == 0 else g - 1)
    odd = k & 1
    left, right = (after if odd else before), (before if odd else after)
    if lx * uy - ly * ux >= 0.0:
        return right, lx, ly
    if rx * uy - ry * ux <= 0.0:
        return left, lx, ly
    put(found, left, m, lx, ly, ux, uy, k, near)
    return right, ux, uy


@kernel
def at_wall(room, target, most, found, m, lx, ly, rx, ry, h, edge, k, near):
    """Note what of a wedge reaches the target before the edge it came to, and mirror the rest: beams made."""
    across, along = rx * ly - ry * lx, rx * lx + ry * ly  # |r| |l| sin and cos of the width
    if along > 0.0 and across <= NARROW * along:
        if edge != EXIT and k < most:
            found.lost[0] += across / along
        return 0
    if near == 0:
        return go_on(room, target, most, found, m, lx, ly, rx, ry, h, edge, k, near)
    return split_at_target(room, target, most, found, m, lx, ly, rx, ry, h, edge, k)
