"""The normal at a contact with an edge, a line or an arc; that at a corner is the way from it to the centre."""

from __future__ import annotations

from wallkit.kernels.jit import kernel


@kernel
def normal_at(model, arcs, edge, x, y):
    """A normal of an edge at a point on it, any length, and 2 / (n.n): outward of a line, out of an arc's circle.

    The normal of an arc, turned a quarter to the left, points from its a to its b, as that of a line does.
    """
    if arcs is not None:
        arc = arcs[edge]
        if arc.radius > 0.0:
            # From the arc's centre a - s to the place: the contact point of a disc is on the same ray.
            nx, ny = x - arc.ax + arc.sx, y - arc.ay + arc.sy
            return nx, ny, 2.0 / (nx * nx + ny * ny)
    line = model.lines[edge]
    return line.nx, line.ny, line.twice


@kernel
def is_middle(arcs, edge, x, y):
    """Tell whether a place is the middle of an arc's circle, from which no direction is normal to it."""
    if arcs is None:
        return False
    arc = arcs[edge]
    return arc.radius > 0.0 and x - arc.ax + arc.sx == 0.0 and y - arc.ay + arc.sy == 0.0


@kernel
def outward(arcs, edge):
    """1 where ``normal_at`` points to the outward side of an edge's wall, else -1."""
    if arcs is not None:
        arc = arcs[edge]
        if arc.radius > 0.0:
            return 1.0 if arc.sweep > 0.0 else -1.0
    return 1.0
