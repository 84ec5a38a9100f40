"""What part of a wedge reaches a disc between two walls."""

from __future__ import annotations

import math

from wallkit.kernels.beams.wedges import EXIT, WINDOW, go_on, note
from wallkit.kernels.jit import kernel, rare_kernel


@rare_kernel
def split_at_target(room, target, most, found, m, lx, ly, rx, ry, h, edge, k):
    """Part a wedge that comes to an edge by what reaches the target before it; the beams that go on from the edge.

    Whether a ray does changes only at the tangents to the disc, and where the disc's rim crosses the edge, or the edge
    that the wedge comes from. Between those borders the middle speaks for all.
    """
    det = m[0] * m[3] - m[1] * m[2]
    back = m[3] / det, -m[1] / det, -m[2] / det, m[0] / det  # from what is seen to the room itself
    px, py = -(back[0] * m[4] + back[1] * m[5]), -(back[2] * m[4] + back[3] * m[5])
    events = found.events
    events[0, 0], events[0, 1] = rx, ry
    count = _tangents(target, m, px, py, lx, ly, rx, ry, events)
    if k > 0:
        count = _rim(room, target, found.word[k - 1], m, lx, ly, rx, ry, events, count)
    if edge != EXIT:
        count = _rim(room, target, edge, m, lx, ly, rx, ry, events, count)
    events[count, 0], events[count, 1] = lx, ly
    beams = 0
    last = found.word[k - 1] if k > 0 else EXIT
    for i in range(count):
        ax, ay, bx, by = events[i, 0], events[i, 1], events[i + 1, 0], events[i + 1, 1]
        if ax * by - ay * bx <= 0.0:
            continue
        a, b = math.sqrt(ax * ax + ay * ay), math.sqrt(bx * bx + by * by)
        ux, uy = ax / a + bx / b, ay / a + by / b
        dx, dy = back[0] * ux + back[1] * uy, back[2] * ux + back[3] * uy
        if _is_hit(room, target, last, edge, px, py, dx, dy):
            note(found, WINDOW, bx, by, ax, ay, k)
        else:
            beams += go_on(room, target, most, found, m, bx, by, ax, ay, h, edge, k, 1)
    return beams


@kernel
def _is_hit(room, target, last, edge, px, py, dx, dy):
    """Tell whether the ray p + s d meets the disc after the line of the edge ``last`` and before that of ``edge``.

    |p + s d - c| = r at s = (v.d -+ sqrt(r^2 d.d - (v x d)^2)) / d.d with v = c - p.
    """
    vx, vy = target.x - px, target.y - py
    square, cross = dx * dx + dy * dy, vx * dy - vy * dx
    inside = target.radius * target.radius * square - cross * cross
    if inside <= 0.0:
        return False
    middle, half = (vx * dx + vy * dy) / square, math.sqrt(inside) / square
    since = 0.0 if last == EXIT else _reach(room, last, px, py, dx, dy)
    until = math.inf if edge == EXIT else _reach(room, edge, px, py, dx, dy)
    return middle + half > since and middle - half < until


@kernel
def _reach(room, edge, px, py, dx, dy):
    """Where the ray p + s d meets the line n.x = offset of an edge."""
    nx, ny, offset = room.mirrors[edge, 0], room.mirrors[edge, 1], room.mirrors[edge, 2]
    return (offset - (nx * px + ny * py)) / (nx * dx + ny * dy)


@kernel
def _tangents(target, m, px, py, lx, ly, rx, ry, events):
    """Enter the tangents from p to the disc, L v +- r (v turned left), L^2 = v.v - r^2: how many borders there are."""
    vx, vy, r = target.x - px, target.y - py, target.radius
    free = vx * vx + vy * vy - r * r
    count = 1
    if free > 0.0:
        length = math.sqrt(free)
        for sign in (-1.0, 1.0):
            tx, ty = length * vx - sign * r * vy, length * vy + sign * r * vx
            count = _enter(m[0] * tx + m[1] * ty, m[2] * tx + m[3] * ty, lx, ly, rx, ry, events, count)
    return count


@kernel
def _rim(room, target, edge, m, lx, ly, rx, ry, events, count):
    """Enter where the rim of the disc crosses the line of an edge: c + h n +- sqrt(r^2 - h^2) (-ny, nx)."""
    nx, ny = room.mirrors[edge, 0], room.mirrors[edge, 1]
    off = room.mirrors[edge, 2] - (nx * target.x + ny * target.y)
    square = target.radius * target.radius - off * off
    if square > 0.0:
        half = math.sqrt(square)
        for sign in (-1.0, 1.0):
            x, y = target.x + off * nx - sign * half * ny, target.y + off * ny + sign * half * nx
            ux, uy = m[0] * x + m[1] * y + m[4], m[2] * x + m[3] * y + m[5]
            count = _enter(ux, uy, lx, ly, rx, ry, events, count)
    return count


@kernel
def _enter(ux, uy, lx, ly, rx, ry, events, count):
    """Sort a border into those of a wedge, from right to left, if it is within: how many there are."""
    if rx * uy - ry * ux <= 0.0 or ux * ly - uy * lx <= 0.0:
        return count
    place = count
    while place > 1 and ux * events[place - 1, 1] - uy * events[place - 1, 0] > 0.0:
        events[place, 0], events[place, 1] = events[place - 1, 0], events[place - 1, 1]
        place -= 1
    events[place, 0], events[place, 1] = ux, uy
    return count + 1
