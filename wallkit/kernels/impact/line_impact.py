"""Time of impact, one function a pair: point and line, disc and line, disc and corner.

Each pass looks at a run of entries and keeps the earliest contact so far. Equal times go to the lower feature,
so that neither the order of the entries nor the index decides anything. ``reach`` is the best time so far
widened by more than the rounding of one division: it may only save work, never decide.
"""

from __future__ import annotations

import math

from wallkit.kernels.jit import kernel
from wallkit.kernels.records import NO_HIT

WIDER = 1.0 + 2.0**-50


@kernel
def precedes(feature: int, other: int) -> bool:
    """Order of features at equal times: edges before corners, then by number."""
    if other == NO_HIT:
        return False
    if feature >= 0:
        return other < 0 or feature < other
    return other < 0 and feature > other


@kernel
def slack_of(tolerance, radius):
    """How far past the end of an edge a disc may touch it, see ``scan_disc``."""
    return tolerance + radius * 2.0**-42


@kernel
def scan_point(lines, ids, start, stop, one_sided, edge_wall, x, y, vx, vy, last, tolerance, best, feature):
    """Earliest contact of a point with the lines of entries start to stop.

    The ray p + t v passes between a and b when the crosses of (a - p) and (b - p) with v differ in sign, 0
    counting as positive. A vertex has one such sign, shared by both of its edges, so no ray slips between
    neighbours or meets both. Which way the ray crosses follows from the same two signs, and it is an approach
    if the point lies on that side: d = (p - a).n > 0 when the crosses rise. Then t = |d| / |v.n|; where v.n rounds
    to 0 or beyond, the difference of the crosses over the length stands in, which is not 0: their signs differ.

    A point within ``tolerance`` (the rounding of positions) of another edge has no side of its own there: that
    edge is left out and counted, and the caller settles it from where the point came from.

    Returns:
        (time, feature, number of edges touched).
    """
    touched = 0
    reach = best * WIDER
    for k in range(start, stop):
        line = lines[ids[k]]
        ex = line.ax - x
        ey = line.ay - y
        nx = line.nx
        ny = line.ny
        d = -(ex * nx + ey * ny)
        if -tolerance <= d <= tolerance:
            u = ex * ny - ey * nx
            if -tolerance <= u <= line.length + tolerance:
                if ids[k] != last:
                    touched += 1
                continue
        cross_a = ex * vy - ey * vx
        cross_b = (line.bx - x) * vy - (line.by - y) * vx
        if (cross_a < 0.0) == (cross_b < 0.0):
            continue
        if (cross_a < 0.0) != (d > 0.0):
            continue
        gap = abs(d)
        closing = vx * nx + vy * ny
        if d > 0.0:
            closing = -closing
        if closing <= 0.0:  # all but parallel: rounding hides that the vertices lie on either side
            closing = abs(cross_b - cross_a) / line.length
        if gap > reach * closing:
            continue
        if one_sided is not None:
            if d < 0.0 and one_sided[edge_wall[ids[k]]] != 0:
                continue
        t = gap / closing
        if (t < best or (t == best and precedes(ids[k], feature))) and ids[k] != last:
            best = t
            reach = best * WIDER
            feature = ids[k]
    return best, feature, touched


@kernel
def scan_disc(lines, ids, start, stop, one_sided, edge_wall, radius, x, y, vx, vy, last, tolerance, best, feature):
    """Earliest contact of a disc with the flat of the lines of entries start to stop.

    With d = (p - a).n on the side where d > 0, contact is at d + t v.n = r, t = (d - r) / -(v.n), if v.n < 0 and
    the foot u = (p - a).tau + t v.tau lies on the edge. An overlap counts as t = 0; receding is never an event.

    The foot may lie past the end by the rounding of positions and r 2^-42: neighbours overlap there, so that nothing
    slips between an edge and the circle of its corner, and edges that meet smoothly need no corner. Against that
    circle the contact is off by r 2^-85 in place and by 2^-42 in direction.

    Returns:
        (time, feature).
    """
    reach = best * WIDER
    slack = slack_of(tolerance, radius)
    for k in range(start, stop):
        line = lines[ids[k]]
        ex = x - line.ax
        ey = y - line.ay
        nx = line.nx
        ny = line.ny
        d = ex * nx + ey * ny
        closing = -(vx * nx + vy * ny)
        if d < 0.0:
            if one_sided is not None:
                if one_sided[edge_wall[ids[k]]] != 0:
                    continue
            d = -d
            closing = -closing
        if closing <= 0.0:
            continue
        gap = d - radius
        if gap > reach * closing:
            continue
        t = gap / closing
        if t < 0.0:
            t = 0.0
        u = ey * nx - ex * ny + t * (vy * nx - vx * ny)
        if u < -slack or u > line.length + slack:
            continue
        if (t < best or (t == best and precedes(ids[k], feature))) and ids[k] != last:
            best = t
            reach = best * WIDER
            feature = ids[k]
    return best, feature


@kernel
def scan_corners(corners, ids, start, stop, one_sided, corner_wall, radius, x, y, vx, vy, energy, last, best, feature):
    """Earliest contact of a disc with the corners of entries start to stop.

    With e = p - corner, |e + t v| = r has the discriminant D = r^2 - (e x v)^2 / v^2, taken from the distance at
    which the path passes the corner, and the smaller root t = c / q, c = e.e - r^2, q = -e.v + sqrt(v^2 D);
    nothing cancels in q because only e.v < 0 approaches. An overlap (c < 0) counts as t = 0.

    Returns:
        (time, feature).
    """
    per_energy = 1.0 / energy
    square = radius * radius
    for k in range(start, stop):
        corner = corners[ids[k]]
        ex = x - corner.x
        ey = y - corner.y
        along = ex * vx + ey * vy
        if along >= 0.0:
            continue
        cross = ex * vy - ey * vx
        discriminant = square - cross * cross * per_energy
        if discriminant < 0.0:
            continue
        c = ex * ex + ey * ey - square
        t = c / (math.sqrt(energy * discriminant) - along)
        if t < 0.0:
            t = 0.0
        if t < best or (t == best and precedes(-2 - ids[k], feature)):
            if -2 - ids[k] == last:
                continue
            if one_sided is not None:
                if one_sided[corner_wall[ids[k]]] != 0 and behind(corner, ex + t * vx, ey + t * vy):
                    continue
            best = t
            feature = -2 - ids[k]
    return best, feature


@kernel
def behind(corner, ex, ey):
    """A centre at e from a corner is behind it when it is against the sum of the normals there."""
    return ex * corner.sx + ey * corner.sy < 0.0
