"""Lockstep without gravity: the passes of lines and corners over all balls, and the one in which all bounce.

The formulas are those of ``line_impact``, ``damping`` and ``motion``, term by term.
"""

from __future__ import annotations

import math

from wallkit.kernels.batches.lockstep_lanes import (
    ALONE,
    ASK,
    BEST,
    BOUNCES,
    ENDING,
    ENERGY,
    FROM_VX,
    FROM_VY,
    FROM_X,
    FROM_Y,
    KEPT,
    LANES,
    LAST,
    LOST,
    MANY,
    NONE,
    NX,
    NY,
    PASSED,
    REACH,
    ROOM,
    ROW,
    STILL,
    STOP,
    TIME,
    TOLERANCE,
    TWICE,
    VX,
    VY,
    E,
    F,
    X,
    Y,
    feature_of,
    is_one_way,
    row_of,
)
from wallkit.kernels.flight.damping import free_time, free_time_rolling, rolling_stop, slowed, slowed_rolling
from wallkit.kernels.flight.flight import still_limit
from wallkit.kernels.flight.motion import NEARLY_ALL, bounced, reflect, squared_after
from wallkit.kernels.flight.point_in_corner import settle
from wallkit.kernels.impact.line_impact import scan_corners, scan_point, slack_of
from wallkit.kernels.jit import kernel, pass_kernel, rare_kernel
from wallkit.kernels.records import (
    AMBIGUOUS,
    AMBIGUOUS_CORNER,
    AT_REST,
    BOUNCE_LIMIT,
    COLLAPSE,
    LEFT_SCENE,
    NO_HIT,
    RUNNING,
    TIME_REACHED,
)

WIDER = 1.0 + 2.0**-20
"""Far beyond all rounding in the look for corners that may be met: that look may only save work, never decide."""


@kernel
def ask_straight(model, radius, s, until, flying):
    """Find what each ball meets first."""
    lines, rows = model.cells[0].corners, model.cells[0].end
    for k in range(lines):
        one_way = is_one_way(model.one_sided, model.edge_wall[model.ids[k]])
        if radius is None:
            _pass_point(s, float(k), model.lines[model.ids[k]], one_way)
        else:
            _pass_disc(s, float(k), model.lines[model.ids[k]], one_way, radius)
    # Lines first: corners are asked only where they may be met before what is found by then.
    if radius is not None:
        _reach(s)
        for k in range(lines, rows):
            _pass_corner(s, float(k), model.corners[model.ids[k]])
    for i in range(flying):
        if s[ASK + i] > 0.0:
            if radius is None:
                _answer_point(model, s, i, until)
            else:
                _answer_disc(model, radius, s, i)


@pass_kernel
def _pass_point(s, row, line, one_way):
    """Let one line ask all points, as ``line_impact.scan_point`` does."""
    ax, ay, bx, by, nx, ny, length = line.ax, line.ay, line.bx, line.by, line.nx, line.ny, line.length
    for i in range(LANES):
        x, y, vx, vy = s[X + i], s[Y + i], s[VX + i], s[VY + i]
        tolerance, best = s[TOLERANCE + i], s[BEST + i]
        ex, ey = ax - x, ay - y
        d = -(ex * nx + ey * ny)
        u = ex * ny - ey * nx
        other = s[LAST + i] != row
        near = (abs(d) <= tolerance) & (u >= -tolerance) & (u <= length + tolerance)
        cross_a = ex * vy - ey * vx
        cross_b = (bx - x) * vy - (by - y) * vx
        above = d > 0.0
        closing = vx * nx + vy * ny
        closing = -closing if above else closing
        # Divided for every lane: one that does not cross drops what comes out, inf and nan as well.
        t = abs(d) / closing
        rises = cross_a < 0.0
        crosses = other & (not near) & (rises != (cross_b < 0.0)) & (rises == above) & (above | (not one_way))
        met = crosses & (closing > 0.0) & (t < best)
        s[BEST + i] = t if met else best
        s[ROW + i] = row if met else s[ROW + i]
        s[ASK + i] = 1.0 if (near & other) | (crosses & (closing <= 0.0)) else s[ASK + i]


@pass_kernel
def _pass_disc(s, row, line, one_way, radius):
    """Let one line ask all discs, as ``line_impact.scan_disc`` does."""
    ax, ay, nx, ny, length = line.ax, line.ay, line.nx, line.ny, line.length
    for i in range(LANES):
        vx, vy, best = s[VX + i], s[VY + i], s[BEST + i]
        slack = slack_of(s[TOLERANCE + i], radius)
        ex, ey = s[X + i] - ax, s[Y + i] - ay
        d = ex * nx + ey * ny
        closing = -(vx * nx + vy * ny)
        below = d < 0.0
        d = -d if below else d
        closing = -closing if below else closing
        # d + t v.n = r on the side of the ball, an overlap at once, and the foot at that time: see ``scan_disc``.
        gap = d - radius
        t = gap / closing
        # A one-sided wall is met from its outward side, and not by a disc that stands across it: ``stands_across``.
        passes = one_way & (below | ((t < 0.0) & (gap < -slack)))
        t = 0.0 if t < 0.0 else t
        u = ey * nx - ex * ny + t * (vy * nx - vx * ny)
        met = (not passes) & (closing > 0.0) & (u >= -slack) & (u <= length + slack) & (s[LAST + i] != row) & (t < best)
        s[BEST + i] = t if met else best
        s[ROW + i] = row if met else s[ROW + i]


@pass_kernel
def _reach(s):
    """Set how far against its velocity a corner may lie that a disc meets in time: see ``_pass_corner``."""
    for i in range(LANES):
        s[REACH + i] = -(s[BEST + i] * s[ENERGY + i] + s[ROOM + i]) * WIDER


@pass_kernel
def _pass_corner(s, row, corner):
    """Note which discs may meet a corner before what they have found.

    The way passes it within r, |e x v| <= r |v|, and the contact is at (-e.v - r |v|) / v^2 or later: -e.v is at most
    t v^2 + r |v| for a contact before t.
    """
    cx, cy = corner.x, corner.y
    for i in range(LANES):
        vx, vy, room = s[VX + i], s[VY + i], s[ROOM + i]
        ex, ey = s[X + i] - cx, s[Y + i] - cy
        along = ex * vx + ey * vy
        cross = ex * vy - ey * vx
        # |e x v| <= r |v| and -e.v <= t v^2 + r |v|; ROOM is r |v|, and REACH the negative of the latter, both widened.
        may = (along < 0.0) & (along >= s[REACH + i]) & (abs(cross) <= room) & (s[LAST + i] != row)
        s[ASK + i] = s[ASK + i] + (MANY + row) if may else s[ASK + i]


@kernel
def _answer_disc(model, radius, s, i):
    """Ask the corner that a disc may meet, or all if there are more."""
    first, stop = int(model.cells[0].corners), int(model.cells[0].end)
    # One corner alone adds MANY and its row; two or more come to 2 MANY, and all are asked.
    if s[ASK + i] < 2.0 * MANY:
        first = int(s[ASK + i] - MANY)
        stop = first + 1
    last, feature = feature_of(model, s[LAST + i]), feature_of(model, s[ROW + i])
    s[BEST + i], feature = scan_corners(
        model.corners, model.ids, first, stop, model.one_sided, model.corner_wall, model.fans, radius,
        s[X + i], s[Y + i], s[VX + i], s[VY + i], s[ENERGY + i], last, s[TOLERANCE + i], s[BEST + i], feature,
    )  # fmt: skip
    s[ROW + i] = row_of(model, feature)


@rare_kernel
def _answer_point(model, s, i, until):
    """Ask all lines of a point that is within rounding of one; in a corner, settle it, as ``flight.fly`` does."""
    x, y, vx, vy, tolerance = s[X + i], s[Y + i], s[VX + i], s[VY + i], s[TOLERANCE + i]
    last, best = (
        feature_of(model, s[LAST + i]),
        free_time(model.damping, s[ENERGY + i], (until - s[TIME + i]) - s[LOST + i]),
    )
    t, feature, touched = scan_point(
        model.lines, model.ids, 0, model.cells[0].arcs, model.one_sided, model.edge_wall,
        x, y, vx, vy, last, tolerance, best, NO_HIT,
    )  # fmt: skip
    if touched > 0 and last >= 0:
        came = s[FROM_X + i], s[FROM_Y + i], s[FROM_VX + i], s[FROM_VY + i]
        met = settle(model, last, 0.0, x, y, vx, vy, came[0], came[1], came[2], came[3], tolerance, int(s[STILL + i]))
        if met != NO_HIT:
            t, feature = 0.0, met
    s[BEST + i], s[ROW + i] = t, row_of(model, feature)


@pass_kernel
def _slow(damping, s, until):
    """Tell what each ball's flight takes, and what part of its speed that leaves, where something slows it down."""
    if damping is None:
        return
    # Two loops: vector instructions serve the one alone, which asks for no logarithm.
    if damping[1] > 0.0:
        for i in range(LANES):
            most = (until - s[TIME + i]) - s[LOST + i]
            s[PASSED + i], s[KEPT + i] = slowed(damping, s[ENERGY + i], s[BEST + i], most)
    else:
        for i in range(LANES):
            most, stop = (until - s[TIME + i]) - s[LOST + i], s[STOP + i]
            passed, kept = slowed_rolling(stop, s[BEST + i], most)
            # A ball that meets nothing stops, or its time is up before: as in ``damping.last_flight``.
            stops, free = most >= stop, s[ROW + i] == NONE
            last = 0.0 if stops else 1.0 - most / stop
            s[PASSED + i], s[KEPT + i] = stop if free & stops else passed, last if free else kept


@pass_kernel
def look_ahead(damping, s):
    """Begin the next flights: contacts count until time is up, or something has stopped the ball."""
    if damping is None:
        return
    if damping[1] > 0.0:
        for i in range(LANES):
            s[BEST + i] = free_time(damping, s[ENERGY + i], s[BEST + i])
    else:
        for i in range(LANES):
            s[STOP + i] = rolling_stop(damping, s[ENERGY + i])
            s[BEST + i] = free_time_rolling(s[STOP + i], s[BEST + i])


@pass_kernel
def bounce_straight(model, damping, restitution, s, radius, until, limit):
    """Move every ball, turn its velocity where it meets something, and tell which have ended; as ``flight.fly``."""
    lines, most_still = float(model.cells[0].corners), float(still_limit(restitution))
    _slow(damping, s, until)
    for i in range(LANES):
        x, y, vx, vy, t, row = s[X + i], s[Y + i], s[VX + i], s[VY + i], s[BEST + i], s[ROW + i]
        time, lost, energy = s[TIME + i], s[LOST + i], s[ENERGY + i]
        passed = t if damping is None else s[PASSED + i]
        # Selects in place of branches, term by term as in ``flight.fly``: `hit` bounces, `late` flies until time is up.
        total = time + passed
        passes = (total > time) & (t * (abs(vx) + abs(vy)) > s[TOLERANCE + i] * 2.0**-6)
        still = 0.0 if passes else s[STILL + i] + 1.0
        hit = (row >= 0.0) & (still <= most_still)
        # With drag the last flight, which takes an exponential, is that of ``flight.flown_on``.
        late = (row == NONE) & (until < math.inf) if damping is None else (row == NONE) & (damping[1] <= 0.0)
        moved = (hit | late) & (t > 0.0)
        new_x, new_y = x + t * vx if moved else x, y + t * vy if moved else y
        new_vx, new_vy = vx, vy
        if damping is not None:
            kept = s[KEPT + i] if moved else 1.0
            new_vx, new_vy, energy = kept * vx, kept * vy, kept * kept * energy
        # Neumaier's sum, see ``motion.advance``.
        rest = (time - total) + passed if time >= passed else (passed - total) + time
        time, lost = total if moved else time, lost + rest if moved else lost
        stops = False if damping is None else late & moved & (s[KEPT + i] == 0.0)
        if damping is not None:
            new_vx, new_vy = 0.0 if stops else new_vx, 0.0 if stops else new_vy
        ended = late & moved & (not stops)
        time, lost = until if ended else time, 0.0 if ended else lost
        nx, ny, twice = s[NX + i], s[NY + i], s[TWICE + i]
        if radius is not None:
            # The row of a corner holds its place: the normal goes from there to the centre.
            at_corner = row >= lines
            nx, ny = new_x - nx if at_corner else nx, new_y - ny if at_corner else ny
            twice = 2.0 / (nx * nx + ny * ny) if at_corner else twice
        wx, wy, energy, alone = turned(restitution, s, i, nx, ny, twice, new_vx, new_vy, energy)
        bounces = s[BOUNCES + i] + 1.0 if hit else s[BOUNCES + i]
        ending = _ending_of(damping, row, hit, bounces, energy, until, limit)
        if restitution is not None:  # what ``flight.fly`` is asked for stays where it is
            alone = alone & hit
            ending, hit, moved = ALONE if alone else ending, hit & (not alone), moved & (not alone)
            bounces, still = s[BOUNCES + i] if alone else bounces, s[STILL + i] if alone else still
            new_x, new_y = x if alone else new_x, y if alone else new_y
            new_vx, new_vy = vx if alone else new_vx, vy if alone else new_vy
            time, lost = s[TIME + i] if alone else time, s[LOST + i] if alone else lost
        if radius is None:
            s[FROM_X + i] = x if moved else s[FROM_X + i]
            s[FROM_Y + i] = y if moved else s[FROM_Y + i]
            s[FROM_VX + i] = vx if moved else s[FROM_VX + i]
            s[FROM_VY + i] = vy if moved else s[FROM_VY + i]
        s[ENDING + i] = ending
        s[X + i], s[Y + i], s[TIME + i], s[LOST + i] = new_x, new_y, time, lost
        s[VX + i] = wx if hit else new_vx
        s[VY + i] = wy if hit else new_vy
        if damping is not None or restitution is not None:
            s[ENERGY + i] = energy if hit else 0.0 if stops else s[ENERGY + i]
        s[LAST + i] = row if hit else s[LAST + i]
        s[BOUNCES + i], s[STILL + i] = bounces, still
        s[BEST + i] = (until - time) - lost
        s[ROW + i] = NONE
        s[ASK + i] = 0.0


@kernel
def _ending_of(damping, row, hit, bounces, energy, until, limit):
    """How a ball's run ends that hits a row, or not: an ending, or RUNNING."""
    ending = float(BOUNCE_LIMIT) if bounces >= limit else float(RUNNING)
    open_end = float(LEFT_SCENE) if until == math.inf else float(TIME_REACHED)
    if damping is not None:
        ending, open_end = float(AT_REST) if energy <= 0.0 else ending, float(TIME_REACHED)
    ending = ending if hit else float(COLLAPSE)
    ending = float(AMBIGUOUS_CORNER) if row == float(AMBIGUOUS) else ending
    return open_end if row == NONE else ending


@kernel
def turned(restitution, s, i, nx, ny, twice, vx, vy, energy):
    """Turn a velocity as ``motion.reflect`` does: (vx, vy, energy, whether a wall takes so much that it must)."""
    if restitution is None:
        vx, vy, energy = reflect(None, 0, nx, ny, twice, vx, vy, energy)
        return vx, vy, energy, False
    e, f = s[E + i], s[F + i]
    normal = vx * nx + vy * ny
    factor = normal * twice
    left = squared_after(e, f, energy, 0.5 * factor * normal)
    vx, vy, square = bounced(e, f, nx, ny, factor, vx, vy, left)
    return vx, vy, square, not left > NEARLY_ALL * energy
