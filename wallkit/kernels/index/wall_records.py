"""The records of edges and vertices, written from walls: what flights and the index read of them."""

from __future__ import annotations

import math

from wallkit.kernels.jit import kernel
from wallkit.kernels.records import Corner, Fan, Line

LINE_AT, LINE_SIZE = Line(*range(8)), 8
CORNER_AT, CORNER_SIZE = Corner(*range(4)), 4
FAN_AT, FAN_SIZE = Fan(*range(6)), 6
"""The columns of records that are written, which are flat: ``lines[LINE_SIZE * edge + LINE_AT.nx]``."""
SMOOTH = 2.0**-44
"""Edges that meet at less than this angle (radians) have no corner: see ``scan_disc`` for how they overlap."""
NEARLY_STRAIGHT = 2.0**-41
"""Rounding of an edge in parts of its size, some 500 times: see ``write_corners``."""


@kernel
def write_lines(vertices, origin, offsets, closed, lines, edge_wall):
    """Write a ``Line`` of each edge; without a length it has no normal.

    Args:
        vertices: (2 V,) x and y in turn.
        origin: (x0, y0) of the local coordinates.
        offsets: (W + 1,) see ``Walls``.
        closed: (W,) likewise.
        lines: (8 E,) written.
        edge_wall: (E,) written: the wall of each edge.

    Returns:
        How long the edges of closed walls are together, and those of open ones.
    """
    x0, y0 = origin
    around, along, edge = 0.0, 0.0, 0
    for wall in range(len(closed)):
        first, end = offsets[wall], offsets[wall + 1]
        bx, by = vertices[2 * first] - x0, vertices[2 * first + 1] - y0
        for k in range(end - first if closed[wall] else end - first - 1):
            ax, ay = bx, by
            following = first + k + 1 if first + k + 1 < end else first
            bx, by = vertices[2 * following] - x0, vertices[2 * following + 1] - y0
            dx, dy = bx - ax, by - ay
            length = math.sqrt(dx * dx + dy * dy)
            nx, ny, twice = 0.0, 0.0, 0.0
            if length > 0.0:
                nx, ny = dy / length, -dx / length
                twice = 2.0 / (nx * nx + ny * ny)
            if closed[wall]:
                around += length
            else:
                along += length
            at = LINE_SIZE * edge
            lines[at + LINE_AT.ax], lines[at + LINE_AT.ay] = ax, ay
            lines[at + LINE_AT.bx], lines[at + LINE_AT.by] = bx, by
            lines[at + LINE_AT.nx], lines[at + LINE_AT.ny] = nx, ny
            lines[at + LINE_AT.length], lines[at + LINE_AT.twice] = length, twice
            edge_wall[edge] = wall
            edge += 1
    return around, along


@kernel
def write_corners(vertices, origin, offsets, closed, lines, normals, arcs, size, radius, across, corners, fans, opened):
    """Tell for each vertex where a disc can touch it: from one normal of its edges to the other.

    Where the wall turns left the fan opens to its right, and the other way round; a free end has half a circle, a
    vertex at an edge without length all of it.

    On the other side a disc meets both edges before it meets the vertex, by radius * angle^2 / 2 farther away than
    where the edges alone would hold it. Where that is not far above the rounding of the edges (of an arc as large as
    its radius) a disc that rolls along one may pass the other unseen: there the vertex stands in for it, on ``both``
    sides.

    Args:
        vertices: (2 V,) x and y in turn.
        origin: (x0, y0) of the local coordinates.
        offsets: (W + 1,) see ``Walls``.
        closed: (W,) likewise.
        lines: ``Line`` by edge.
        normals: (4 E,) outward normals at the end and at the start of each edge; None for those of the lines.
        arcs: ``Arc`` by edge; None where all are lines.
        size: largest absolute local coordinate.
        radius: of the smallest disc.
        across: 1 where discs may stand across walls, which one-sided ones let in from behind; else 0. Those touch a
            free end from all around.
        corners: (4 V,) written, see ``Corner``.
        fans: (6 V,) written, see ``Fan``.
        opened: (V,) written: 1 where a disc can touch the vertex at all, but for rounding; else 0.
    """
    x0, y0 = origin
    edge = 0
    for wall in range(len(closed)):
        first, count = offsets[wall], offsets[wall + 1] - offsets[wall]
        edges = count if closed[wall] else count - 1
        for k in range(count):
            before, after = edge + (k - 1 if k > 0 else edges - 1), edge + k
            arrives, leaves = closed[wall] or k > 0, k < edges
            # u is the normal of the edge that arrives, w of the one that leaves.
            ux, uy, wx, wy, bare, rounded = 0.0, 0.0, 0.0, 0.0, False, size
            if arrives:
                ux, uy = _normal_at(lines, normals, before, 0)
                bare = lines[before].length == 0.0
                if arcs is not None:
                    rounded += arcs[before].radius
            if leaves:
                wx, wy = _normal_at(lines, normals, after, 2)
                bare = bare or lines[after].length == 0.0
                if arcs is not None:
                    rounded += arcs[after].radius
            at = CORNER_SIZE * (first + k)
            corners[at + CORNER_AT.x] = vertices[2 * (first + k)] - x0
            corners[at + CORNER_AT.y] = vertices[2 * (first + k) + 1] - y0
            corners[at + CORNER_AT.sx], corners[at + CORNER_AT.sy] = ux + wx, uy + wy
            # At a free end the normal turns by half a circle, from one side of the edge to the other.
            if not arrives:
                ux, uy = -wx, -wy
            elif not leaves:
                wx, wy = -ux, -uy
            cross = ux * wy - uy * wx
            known = across == 0 and not (arrives and leaves)
            opened[first + k] = int(bare or abs(cross) > SMOOTH or ux * wx + uy * wy <= 0.0)
            if cross < 0.0:
                ux, uy, wx, wy = -wx, -wy, -ux, -uy
            if bare:
                ux, uy, wx, wy = 1.0, 0.0, 1.0, 0.0
            at = FAN_SIZE * (first + k)
            fans[at + FAN_AT.ux], fans[at + FAN_AT.uy], fans[at + FAN_AT.wx], fans[at + FAN_AT.wy] = ux, uy, wx, wy
            fans[at + FAN_AT.wide] = 1.0 if bare else 0.0
            fans[at + FAN_AT.both] = 1.0 if radius * cross * cross < NEARLY_STRAIGHT * rounded and not known else 0.0
        edge += edges


@kernel
def _normal_at(lines, normals, edge, place):
    """Outward normal of an edge where it ends (place 0), or where it starts (2)."""
    if normals is None:
        return lines[edge].nx, lines[edge].ny
    return normals[4 * edge + place], normals[4 * edge + place + 1]
