"""Time of impact, one function a pair: point and line, disc and line, disc and corner.

Each pass looks at a run of entries and keeps the earliest contact so far. Equal times go to the lower feature,
so that neither the order of the entries nor the index decides anything. ``reach`` is the best time so far
widened by more than the rounding of one division: it may only save work, never decide.
"""

from __future__ import annotations

import math

from wallkit.kernels.jit import kernel, rare_kernel
from wallkit.kernels.records import NO_HIT

WIDER = 1.0 + 2.0**-50


@kernel
def precedes(feature: int, other: int) -> bool:
    """Order of features at equal times: edges before corners, then by number."""
    if other == NO_HIT:
        return False
    # Edges are 0 and more, corners -2 - j: the lower corner is the larger number.
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
        # e goes from the point to a. So d = (p - a).n = -e.n, and the foot of the point along the edge,
        # tau = (-ny, nx), is u = (p - a).tau = e x n.
        d = -(ex * nx + ey * ny)
        if -tolerance <= d <= tolerance:
            u = ex * ny - ey * nx
            if -tolerance <= u <= line.length + tolerance:
                if ids[k] != last:
                    touched += 1
                continue
        # e x v < 0 puts a vertex to the left of the ray. Both on one side: the ray passes the edge by.
        cross_a = ex * vy - ey * vx
        cross_b = (line.bx - x) * vy - (line.by - y) * vx
        if (cross_a < 0.0) == (cross_b < 0.0):
            continue
        # a on the left and b on the right: the ray crosses against n, an approach where d > 0; else along n.
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
        # d + t v.n = 0, and v.n is -closing on the side where d > 0. The look at `reach` saved most quotients.
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
    the foot u = (p - a).tau + t v.tau lies on the edge. An overlap counts as t = 0; receding is never an event. A disc
    that overlaps a one-sided wall by more than rounding has come through it, and passes until it has left it.

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
        # d = (p - a).n; on the other side of the wall -n takes the place of n, so that d > 0 in what follows.
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
        # Contact where d + t v.n = r: t = (d - r) / -(v.n).
        gap = d - radius
        if gap > reach * closing:
            continue
        t = gap / closing
        if t < 0.0:
            if stands_across(one_sided, edge_wall, ids[k], gap, slack):
                continue
            t = 0.0
        # The foot at that time, along tau = (-ny, nx): (p - a).tau + t v.tau.
        u = ey * nx - ex * ny + t * (vy * nx - vx * ny)
        if u < -slack or u > line.length + slack:
            continue
        if (t < best or (t == best and precedes(ids[k], feature))) and ids[k] != last:
            best = t
            reach = best * WIDER
            feature = ids[k]
    return best, feature


@kernel
def scan_corners(
    corners, ids, start, stop, one_sided, corner_wall, fans, radius, x, y, vx, vy, energy, last, tolerance, best,
    feature,
):  # fmt: skip
    """Earliest contact of a disc with the corners of entries start to stop.

    With e = p - corner, |e + t v| = r has the discriminant D = r^2 - (e x v)^2 / v^2, taken from the distance at
    which the path passes the corner, and the smaller root t = c / q, c = e.e - r^2, q = -e.v + sqrt(v^2 D);
    nothing cancels in q because only e.v < 0 approaches. An overlap (c < 0) counts as t = 0. For one-sided walls see
    ``stands_across``.

    Returns:
        (time, feature).
    """
    per_energy = 1.0 / energy
    square = radius * radius
    for k in range(start, stop):
        corner = corners[ids[k]]
        ex = x - corner.x
        ey = y - corner.y
        # |e + t v|^2 = r^2 is v^2 t^2 + 2 (e.v) t + e.e - r^2 = 0; with e.v >= 0 the distance only grows.
        along = ex * vx + ey * vy
        if along >= 0.0:
            continue
        cross = ex * vy - ey * vx
        # A quarter of the discriminant, (e.v)^2 - v^2 (e.e - r^2), is v^2 r^2 - (e x v)^2 by Lagrange's identity.
        # Over v^2 it is r^2 less the squared distance at which the path passes: a grazing hit keeps its digits.
        discriminant = square - cross * cross * per_energy
        if discriminant < 0.0:
            continue
        c = ex * ex + ey * ey - square
        # The smaller root, (-e.v - root) / v^2 = c / (root - e.v): the terms below add up, since e.v < 0.
        t = c / (math.sqrt(energy * discriminant) - along)
        if t < 0.0:
            t = 0.0
        if t < best or (t == best and precedes(-2 - ids[k], feature)):
            if -2 - ids[k] == last:
                continue
            slack = slack_of(tolerance, radius)
            if stands_across(one_sided, corner_wall, ids[k], c, 2.0 * radius * slack):
                continue
            if from_across(one_sided, corner_wall, fans, corners, ids[k], radius, slack, ex + t * vx, ey + t * vy):
                continue
            best = t
            feature = -2 - ids[k]
    return best, feature


@kernel
def stands_across(one_sided, wall_of, index, gap, slack):
    """Tell whether a disc overlaps what belongs to a one-sided wall, by more than rounding.

    It has come from behind and is on its way through: it meets the wall only after it has left it.
    """
    if one_sided is None:
        return False
    return gap < -slack and one_sided[wall_of[index]] != 0


@rare_kernel
def from_across(one_sided, corner_wall, fans, corners, index, radius, slack, ex, ey):
    """Tell whether a disc that touches a corner of a one-sided wall, at e from it, has come through the wall.

    It is behind, against the sum of the normals there, or beside an edge and not between the normals at the corner:
    then it stands across that edge, by w^2 / 2 r at w along it, which is more than the rounding of positions.
    """
    if one_sided is None:
        return False
    if one_sided[corner_wall[index]] == 0:
        return False
    corner, fan = corners[index], fans[index]
    if ex * corner.sx + ey * corner.sy < 0.0:
        return True
    turned = -1.0 if fan.both > 0.0 and ex * (fan.ux + fan.wx) + ey * (fan.uy + fan.wy) < 0.0 else 1.0
    ux, uy, wx, wy = turned * fan.ux, turned * fan.uy, turned * fan.wx, turned * fan.wy
    # A disc that overlaps an edge by s covers w to each side of the foot, w^2 = r^2 - (r - s)^2, about 2 r s.
    aside = -math.sqrt(2.0 * radius * slack)
    between = ux * ey - uy * ex >= aside and ex * wy - ey * wx >= aside and ex * (ux + wx) + ey * (uy + wy) >= aside
    return not (between or fan.wide > 0.0)
