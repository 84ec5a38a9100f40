"""How edges meet at a vertex, under gravity: which one is next to another, and which face of it looks at the ball.

The edges at a vertex go off from it in an order, see ``Joint``, and divide what is round it into sectors. A face is the
side of a wall, 1 its outward one and -1 the other. Ends of edges are numbered as in ``Model.joints``.
"""

from __future__ import annotations

import math

from wallkit.kernels.jit import kernel, rare_kernel

AT_VERTEX = 64.0
"""A point is at a vertex within so many tolerances of it. What goes along a face of a tip, behind it by rounding,
passes the plane of the other face behind the tip, by that over the tip's angle: this covers angles down to 1/64 of the
part that rounding is of the tolerance. One that truly meets an edge so near to its end comes out of the same sector."""
NO_END = -1


@kernel
def end_at(model, edge, x, y, tolerance):
    """End of an edge at which a place is, or NO_END."""
    line, near = model.lines[edge], AT_VERTEX * tolerance  # an arc's chord has its ends
    starts = abs(x - line.ax) <= near and abs(y - line.ay) <= near
    ends = abs(x - line.bx) <= near and abs(y - line.by) <= near
    if starts and ends:
        starts = abs(x - line.ax) + abs(y - line.ay) <= abs(x - line.bx) + abs(y - line.by)
    if starts:
        return 2 * edge
    return 2 * edge + 1 if ends else NO_END


@kernel
def leading_along(model, first, wx, wy):
    """The end, of all at the vertex of ``first``, whose edge goes off most along w, counted from that on."""
    found, best, end = first, -math.inf, first
    while True:
        joint = model.joints[end]
        along = wx * joint.tx + wy * joint.ty
        if along > best:
            found, best = end, along
        end = int(joint.counter)
        if end == first:
            return found


@kernel
def following(joint, end, side):
    """End of an edge that is next to a joint on a side of its wall: a ball comes from one edge to the other there."""
    return joint.clockwise if (side > 0.0) == (end == 0) else joint.counter


@kernel
def side_after(next_end, end, side):
    """Side of the next edge's wall on which a ball is that comes from an end of another one, on a side of that."""
    return -side if (next_end & 1) == end else side


@kernel
def one_sided(sides, wall):
    """Tell whether a wall is solid from its outward side alone."""
    if sides is None:
        return False
    return sides[wall] != 0


@kernel
def left_face(end):
    """Face of an edge to the left of the way out from the vertex at its end."""
    return -1.0 if end & 1 == 0 else 1.0


@rare_kernel
def other_bound(model, own, side):
    """The other bound of the sector on a side of the edge at an end: (end, its face), face 0 if there is none.

    Faces of one-sided walls that let a ball pass bound no sector.
    """
    end, face = own, side
    while True:
        next_end = int(following(model.joints[end], end & 1, face))
        next_face = side_after(next_end, end & 1, face)
        if next_face > 0.0 or not one_sided(model.one_sided, model.edge_wall[next_end >> 1]):
            return next_end, next_face
        if next_end == own:
            return own, 0.0
        end, face = next_end, -next_face  # through it, and on in the same direction


@rare_kernel
def next_face(model, last, side, edge, x, y, tolerance):
    """Face of an edge that looks at a point which is at a vertex on a side of the edge hit last: (joined, face).

    Only the one on the other side of the point's sector does; the face of all others is 0. Edges that do not meet here
    are not ``joined``.
    """
    own, end = end_at(model, last, x, y, tolerance), end_at(model, edge, x, y, tolerance)
    if own == NO_END or end == NO_END or model.joints[own].place != model.joints[end].place:
        return False, 0.0
    other, face = other_bound(model, own, side)
    return True, face if other >> 1 == edge else 0.0
