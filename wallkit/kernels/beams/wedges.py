"""Wedges of directions in a triangulated room, the stack on which they wait, and how a wall mirrors them.

A wedge is seen from the source, (0, 0), with y up: (lx, ly) and (rx, ry) are points on its left and right border, less
than 180 degrees apart. At a wall the room, not the wedge, is mirrored: every path is a straight line from the source
for ever, and borders keep their bits. After k bounces the room is seen as (x, y) -> M (x, y) + t.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from wallkit.kernels.jit import kernel

OPEN, EXIT = -1, -2
"""In place of a wall: nothing stands there; the room ends."""
FRAME, NUMBERS = 10, 3
"""Floats and integers of a wedge that waits."""
WINDOW, SEARCH = 0, 1
"""What a row of ``Found.words`` is: all directions reach the target; or they come to what is not to be unfolded."""
EVENTS = 8
"""Borders that the target draws in one wedge, at most, and what one wedge may become: windows, and wedges."""


class Mirror(NamedTuple):
    """An edge as a mirror: x -> x - twice n (n.x - offset), n of length one; twice 0: it is not to be unfolded.

    A wall that leaves the part e of the normal speed and f of the speed along it turns (t, -n) to (f t, e n). To unfold
    is to put that direction where the old one goes on: n -> -(f / e) n, which keeps the wall where it is. So twice is
    1 + f / e, and 2 for a mirror.
    """

    nx: float
    ny: float
    offset: float
    twice: float


class Room(NamedTuple):
    """The triangulated room; half-edge 3 t + i is opposite corner i of triangle t, corners counter-clockwise."""

    x: Any
    """By corner, 3 a triangle, relative to the source."""
    y: Any
    across: Any
    """By half-edge: that of the neighbour."""
    wall: Any
    """By half-edge: the edge that stops what leaves the triangle through it, OPEN or EXIT."""
    mirrors: Any
    """By edge: the four numbers of a ``Mirror``."""


class Target(NamedTuple):
    """A disc, relative to the source."""

    x: float
    y: float
    radius: float


class Found(NamedTuple):
    """What is read and written."""

    counts: Any
    """(3 + K,) integers: rows written, wedges that wait, and beams by depth from 0 to K."""
    lost: Any
    """(1,) radians that were too narrow to follow."""
    borders: Any
    """(rows, 4) right and left border of what was found."""
    words: Any
    """(rows, 2 + K) integers: WINDOW or SEARCH, bounces, and the edges bounced off."""
    floats: Any
    """(rows, FRAME) of wedges that wait: M by rows, t, left border, right border."""
    numbers: Any
    """(rows, NUMBERS): half-edge to leave through, or -1 - h to enter the triangle of h; bounces; 1 if the target may
    be within, else 0."""
    word: Any
    """(K + 1,) edges that the wedge at hand bounced off."""
    events: Any
    """(EVENTS + 2, 2) scratch."""


@kernel
def put(found, h, m, lx, ly, rx, ry, k, near):
    """Let a wedge wait."""
    row, floats, numbers = found.counts[1], found.floats, found.numbers
    for i in range(6):
        floats[row, i] = m[i]
    floats[row, 6], floats[row, 7], floats[row, 8], floats[row, 9] = lx, ly, rx, ry
    numbers[row, 0], numbers[row, 1], numbers[row, 2] = h, k, near
    found.counts[1] = row + 1


@kernel
def note(found, kind, lx, ly, rx, ry, k):
    """Write what was found, with the word of the wedge at hand."""
    row, borders, words = found.counts[0], found.borders, found.words
    borders[row, 0], borders[row, 1], borders[row, 2], borders[row, 3] = rx, ry, lx, ly
    words[row, 0], words[row, 1] = kind, k
    for i in range(k):
        words[row, 2 + i] = found.word[i]
    found.counts[0] = row + 1


@kernel
def go_on(room, target, most, found, m, lx, ly, rx, ry, h, edge, k, near):
    """Mirror a wedge at the edge to which it came through half-edge h: how many beams that makes.

    With B x = x - twice n (n.x - offset) the room is seen as M B + t from there on. What cannot bounce again is
    followed only where the target may be within.
    """
    if edge == EXIT:
        return 0
    mirrors = room.mirrors
    nx, ny, offset, twice = mirrors[edge, 0], mirrors[edge, 1], mirrors[edge, 2], mirrors[edge, 3]
    if twice == 0.0:
        if k < most or near == 1:
            note(found, SEARCH, lx, ly, rx, ry, k)
        return 0
    if k == most:
        return 0
    mnx, mny = twice * (m[0] * nx + m[1] * ny), twice * (m[2] * nx + m[3] * ny)
    turned = (
        m[0] - mnx * nx, m[1] - mnx * ny, m[2] - mny * nx, m[3] - mny * ny, m[4] + mnx * offset, m[5] + mny * offset,
    )  # fmt: skip
    found.word[k] = edge
    found.counts[3 + k] += 1
    near = may_reach(target, turned, lx, ly, rx, ry)
    if near == 1 or k + 1 < most:
        put(found, -1 - h, turned, lx, ly, rx, ry, k + 1, near)
    return 1


@kernel
def may_reach(target, m, lx, ly, rx, ry):
    """Tell whether the target, as it is seen, may be in a wedge: 1, or 0 where it surely is not.

    It lies beside the wedge where its centre q is farther left of the left border than it is large, q x l > R |l|, or
    right of the other. M makes no disc larger than R = r sqrt(sum of squares of M), 1.4 r for a mirror.
    """
    qx = m[0] * target.x + m[1] * target.y + m[4]
    qy = m[2] * target.x + m[3] * target.y + m[5]
    square = target.radius * target.radius * (m[0] * m[0] + m[1] * m[1] + m[2] * m[2] + m[3] * m[3])
    left, right = lx * qy - ly * qx, qx * ry - qy * rx
    if left > 0.0 and left * left > square * (lx * lx + ly * ly):
        return 0
    if right > 0.0 and right * right > square * (rx * rx + ry * ry):
        return 0
    behind = qx * lx + qy * ly < 0.0 and qx * rx + qy * ry < 0.0 and qx * qx + qy * qy > square
    return 0 if behind else 1
