"""Many balls among few lines, in step: one pass a line over all balls of a chunk, free of branches.

A chunk is one flat array of floats, LANES for each number of a ball, so that the compiler sees that nothing aliases and
uses vector instructions. A round takes every ball to its next bounce; a ball that has ended makes room for another.
The formulas are those of ``line_impact`` and ``motion``, term by term: the same bits come out. What few balls need in a
round (corners, places where rounding hides a side) the passes only notice; ``line_impact`` then answers for those.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from wallkit.kernels.batches.ball_queue import NO_BALL, next_ball
from wallkit.kernels.flight.flight import has_left, still_limit, tolerance_of
from wallkit.kernels.flight.motion import reflect
from wallkit.kernels.flight.point_in_corner import settle
from wallkit.kernels.impact.line_impact import scan_corners, scan_point, slack_of
from wallkit.kernels.jit import kernel, rare_kernel
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

LANES = 128
MOST_EDGES = 20
"""Beyond this the grid, or a scan that stops early, is faster."""
(
    X, Y, VX, VY, TIME, LOST, ENERGY, TOLERANCE, LAST, BOUNCES, STILL, BEST, ROW, ASK, ENDING, NX, NY, TWICE,
    FROM_X, FROM_Y, FROM_VX, FROM_VY,
) = (LANES * number for number in range(22))  # fmt: skip
ROOM, REACH = FROM_X, FROM_Y
"""Of discs; points alone need to know where they came from."""
SCRATCH = 22 * LANES
ROW_SIZE = 4
"""Normal of a line or place of a corner, 2 / (n.n), count of bounces (``Model.edge_tally``): a row for each of
``model.ids``. Lanes name features so."""
NONE = float(NO_HIT)
STILL_LIMIT = float(still_limit(None))
MANY = 2.0**20
"""Added to ASK by each corner that may be met, with its row: ASK is below twice this if it is only one."""
WIDER = 1.0 + 2.0**-20
"""Far beyond all rounding in the look for corners that may be met: that look may only save work, never decide."""


class Start(NamedTuple):
    """The balls of a survey at time 0, in the scene's coordinates.

    Position and velocity (n, 2); the origin (x0, y0) of the local coordinates, and their extent (see ``Model``); the
    box (x_min, y_min, x_max, y_max) of the walls.
    """

    position: Any
    velocity: Any
    origin: Any
    extent: float
    box: Any


class Outcome(NamedTuple):
    """Where each ball ended, in the scene's coordinates: see ``wallkit.simulation.survey.SurveyTotals``."""

    position: Any
    velocity: Any
    time: Any
    bounces: Any
    ending: Any


class Scratch(NamedTuple):
    """Memory to work in: contents do not matter. Integers are unsigned: no look whether they count from the end."""

    lanes: Any
    """SCRATCH floats."""
    balls: Any
    """LANES integers: the ball of each lane."""
    ended: Any
    """LANES + 1 integers."""
    met: Any
    """LANES integers: the row of what the ball of each lane meets."""
    rows: Any
    """(1 + lines + corners, ROW_SIZE) floats; numbers, whatever they are."""


@kernel
def fly_in_step(model, radius, start, queue, stop, until, limit, hits, outcome, scratch):
    """Fly balls of one radius until none is left; as ``flight.fly`` does, where few lines and nothing else act.

    Args:
        model: the scene; no grid, arcs, gravity, restitution or one-sided walls.
        radius: of all balls; None for points.
        start: the balls, see ``Start``.
        queue: which are to fly, see ``Queue``.
        stop: number of the ball after the last.
        until: time at which to stop, or inf.
        limit: number of bounces at which to stop.
        hits: counts of bounces, see ``Model.edge_tally``, added to.
        outcome: written for these balls.
        scratch: see ``Scratch``.
    """
    s, balls, ended, met, rows = scratch.lanes, scratch.balls, scratch.ended, scratch.met, scratch.rows
    # A round: all ask what they meet, fetch its normal, bounce; a lane whose ball has ended takes another one.
    _list_rows(model, rows)
    _clear(s)
    flying = 0
    while flying < LANES and _board(s, flying, balls, radius, start, queue, stop, until, limit, hits, outcome):
        flying += 1
    while flying > 0:
        _ask(model, radius, s, until, flying)
        _look_up(s, met, rows)
        _bounce(s, radius, float(model.cells[0].corners), until, float(limit))
        _count(s, hits, met, rows, flying)
        for j in range(_list_ended(s, ended, flying) - 1, -1, -1):
            i = ended[j]
            _store(s, i, balls[i], radius, start, hits, outcome)
            if not _board(s, i, balls, radius, start, queue, stop, until, limit, hits, outcome):
                # Lanes stay packed: passes go over all LANES, but what is done ball by ball only over those that fly.
                flying -= 1  # no ball is left for this lane: the last one moves here
                for k in range(0, SCRATCH, LANES):
                    s[k + i] = s[k + flying]
                balls[i] = balls[flying]


@kernel
def _clear(s):
    """Let lanes without a ball hold numbers that do no harm."""
    for i in range(SCRATCH):
        s[i] = 0.0
    # Energy and row 1 and NONE, so that passes over empty lanes divide by no 0 and meet nothing.
    for i in range(LANES):
        s[ENERGY + i], s[ROW + i], s[LAST + i] = 1.0, NONE, NONE


@kernel
def _ask(model, radius, s, until, flying):
    """Find what each ball meets first."""
    lines, rows = model.cells[0].corners, model.cells[0].end
    for k in range(lines):
        if radius is None:
            _pass_point(s, float(k), model.lines[model.ids[k]])
        else:
            _pass_disc(s, float(k), model.lines[model.ids[k]], radius)
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


@kernel
def _list_rows(model, rows):
    """Gather what a bounce needs to know of each line and corner."""
    lines, count = model.cells[0].corners, model.cells[0].end
    for k in range(lines):
        line = model.lines[model.ids[k]]
        rows[k, 0], rows[k, 1], rows[k, 2], rows[k, 3] = line.nx, line.ny, line.twice, model.edge_tally[model.ids[k]]
    for k in range(lines, count):
        corner = model.corners[model.ids[k]]
        rows[k, 0], rows[k, 1], rows[k, 2], rows[k, 3] = corner.x, corner.y, 0.0, model.corner_tally[model.ids[k]]


@kernel
def _pass_point(s, row, line):
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
        crosses = other & (not near) & (rises != (cross_b < 0.0)) & (rises == above)
        met = crosses & (closing > 0.0) & (t < best)
        s[BEST + i] = t if met else best
        s[ROW + i] = row if met else s[ROW + i]
        s[ASK + i] = 1.0 if (near & other) | (crosses & (closing <= 0.0)) else s[ASK + i]


@kernel
def _pass_disc(s, row, line, radius):
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
        t = (d - radius) / closing
        t = 0.0 if t < 0.0 else t
        u = ey * nx - ex * ny + t * (vy * nx - vx * ny)
        met = (closing > 0.0) & (u >= -slack) & (u <= length + slack) & (s[LAST + i] != row) & (t < best)
        s[BEST + i] = t if met else best
        s[ROW + i] = row if met else s[ROW + i]


@kernel
def _reach(s):
    """Set how far against its velocity a corner may lie that a disc meets in time: see ``_pass_corner``."""
    for i in range(LANES):
        s[REACH + i] = -(s[BEST + i] * s[ENERGY + i] + s[ROOM + i]) * WIDER


@kernel
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
    last, feature = _feature_of(model, s[LAST + i]), _feature_of(model, s[ROW + i])
    s[BEST + i], feature = scan_corners(
        model.corners, model.ids, first, stop, None, model.corner_wall, None, radius,
        s[X + i], s[Y + i], s[VX + i], s[VY + i], s[ENERGY + i], last, s[TOLERANCE + i], s[BEST + i], feature,
    )  # fmt: skip
    s[ROW + i] = _row_of(model, feature)


@rare_kernel
def _answer_point(model, s, i, until):
    """Ask all lines of a point that is within rounding of one; in a corner, settle it, as ``flight.fly`` does."""
    x, y, vx, vy, tolerance = s[X + i], s[Y + i], s[VX + i], s[VY + i], s[TOLERANCE + i]
    last = _feature_of(model, s[LAST + i])
    t, feature, touched = scan_point(
        model.lines, model.ids, 0, model.cells[0].arcs, None, model.edge_wall,
        x, y, vx, vy, last, tolerance, (until - s[TIME + i]) - s[LOST + i], NO_HIT,
    )  # fmt: skip
    if touched > 0 and last >= 0:
        came = s[FROM_X + i], s[FROM_Y + i], s[FROM_VX + i], s[FROM_VY + i]
        met = settle(model, last, x, y, vx, vy, came[0], came[1], came[2], came[3], tolerance, int(s[STILL + i]))
        if met != NO_HIT:
            t, feature = 0.0, met
    s[BEST + i], s[ROW + i] = t, _row_of(model, feature)


@kernel
def _feature_of(model, row):
    """Feature that a row stands for, see ``NO_HIT``."""
    k = int(row)
    if k < 0:
        return NO_HIT
    return int(model.ids[k]) if k < model.cells[0].corners else -2 - int(model.ids[k])


@kernel
def _row_of(model, feature):
    """Row of a feature, or the number in place of one."""
    lines = model.cells[0].corners
    for k in range(model.cells[0].end):
        if (model.ids[k] if k < lines else -2 - model.ids[k]) == feature:
            return float(k)
    return float(feature)


@kernel
def _look_up(s, met, rows):
    """Fetch the rows of what the balls meet; any for those that meet nothing."""
    # A gather. What is no row is below 0 and takes row 0, whose normal nobody uses.
    for i in range(LANES):
        met[i] = s[ROW + i] if s[ROW + i] > 0.0 else 0.0
    for i in range(LANES):
        s[NX + i], s[NY + i], s[TWICE + i] = rows[met[i], 0], rows[met[i], 1], rows[met[i], 2]


@kernel
def _bounce(s, radius, lines, until, limit):
    """Move every ball, turn its velocity where it meets something, and tell which have ended; as ``flight.fly``."""
    for i in range(LANES):
        x, y, vx, vy, t, row = s[X + i], s[Y + i], s[VX + i], s[VY + i], s[BEST + i], s[ROW + i]
        time, lost, energy = s[TIME + i], s[LOST + i], s[ENERGY + i]
        # Selects in place of branches, term by term as in ``flight.fly``: `hit` bounces, `late` flies until time is up.
        total = time + t
        passed = (total > time) & (t * (abs(vx) + abs(vy)) > s[TOLERANCE + i] * 2.0**-6)
        still = 0.0 if passed else s[STILL + i] + 1.0
        hit = (row >= 0.0) & (still <= STILL_LIMIT)
        late = (row == NONE) & (until < math.inf)
        moved = (hit | late) & (t > 0.0)
        if radius is None:
            s[FROM_X + i] = x if moved else s[FROM_X + i]
            s[FROM_Y + i] = y if moved else s[FROM_Y + i]
            s[FROM_VX + i] = vx if moved else s[FROM_VX + i]
            s[FROM_VY + i] = vy if moved else s[FROM_VY + i]
        x, y = x + t * vx if moved else x, y + t * vy if moved else y
        # Neumaier's sum, see ``motion.advance``.
        rest = (time - total) + t if time >= t else (t - total) + time
        time, lost = total if moved else time, lost + rest if moved else lost
        time, lost = until if late & moved else time, 0.0 if late & moved else lost
        nx, ny, twice = s[NX + i], s[NY + i], s[TWICE + i]
        if radius is not None:
            # The row of a corner holds its place: the normal goes from there to the centre.
            at_corner = row >= lines
            nx, ny = x - nx if at_corner else nx, y - ny if at_corner else ny
            twice = 2.0 / (nx * nx + ny * ny) if at_corner else twice
        wx, wy, _energy = reflect(None, 0, nx, ny, twice, vx, vy, energy)
        bounces = s[BOUNCES + i] + 1.0 if hit else s[BOUNCES + i]
        ending = float(BOUNCE_LIMIT) if bounces >= limit else float(RUNNING)
        ending = ending if hit else float(COLLAPSE)
        ending = float(AMBIGUOUS_CORNER) if row == float(AMBIGUOUS) else ending
        open_end = float(LEFT_SCENE) if until == math.inf else float(TIME_REACHED)
        s[ENDING + i] = open_end if row == NONE else ending
        s[X + i], s[Y + i], s[TIME + i], s[LOST + i] = x, y, time, lost
        s[VX + i] = wx if hit else vx
        s[VY + i] = wy if hit else vy
        s[LAST + i] = row if hit else s[LAST + i]
        s[BOUNCES + i], s[STILL + i] = bounces, still
        s[BEST + i] = (until - time) - lost
        s[ROW + i] = NONE
        s[ASK + i] = 0.0


@kernel
def _count(s, hits, met, rows, flying):
    """Count bounces; if there is but one count, those of a ball count when it has ended."""
    if len(hits) == 1:
        return
    for i in range(flying):
        if s[ENDING + i] == RUNNING or s[ENDING + i] == BOUNCE_LIMIT:
            hits[int(rows[met[i], 3])] += 1


@kernel
def _list_ended(s, ended, flying):
    """List the lanes whose balls have ended: how many."""
    count = 0
    for i in range(flying):
        ended[count] = i  # written for each, kept where the count moves on: nothing to mispredict
        count += 1 if s[ENDING + i] != RUNNING else 0
    return count


@kernel
def _board(s, i, balls, radius, start, queue, stop, until, limit, hits, outcome):
    """Give a lane the next ball that flies at all: False if there is none."""
    ball = next_ball(queue, stop)
    while ball != NO_BALL:
        balls[i] = ball
        _load(s, i, radius, start, ball)
        if s[ENERGY + i] > 0.0 and limit > 0:
            s[BEST + i] = until
            return True
        s[ENDING + i] = float(AT_REST) if s[ENERGY + i] <= 0.0 else float(BOUNCE_LIMIT)
        _store(s, i, ball, radius, start, hits, outcome)
        ball = next_ball(queue, stop)
    return False


@kernel
def _load(s, i, radius, start, ball):
    """Put a ball, at time 0, into a lane."""
    x, y = start.position[ball, 0] - start.origin[0], start.position[ball, 1] - start.origin[1]
    vx, vy = start.velocity[ball, 0], start.velocity[ball, 1]
    # Positions are local to the scene's middle, where floats lie densest.
    energy = vx * vx + vy * vy
    s[X + i], s[Y + i], s[VX + i], s[VY + i] = x, y, vx, vy
    s[TIME + i], s[LOST + i], s[BOUNCES + i], s[STILL + i], s[ASK + i] = 0.0, 0.0, 0.0, 0.0, 0.0
    s[ENERGY + i], s[TOLERANCE + i] = energy, tolerance_of(x, y, start.extent)
    s[LAST + i], s[ROW + i] = NONE, NONE
    if radius is None:
        s[FROM_X + i], s[FROM_Y + i], s[FROM_VX + i], s[FROM_VY + i] = x, y, vx, vy
    else:
        s[ROOM + i] = radius * math.sqrt(energy) * WIDER


@kernel
def _store(s, i, ball, radius, start, hits, outcome):
    """Write where a ball has ended."""
    x, y, vx, vy = s[X + i] + start.origin[0], s[Y + i] + start.origin[1], s[VX + i], s[VY + i]
    outcome.position[ball, 0], outcome.position[ball, 1] = x, y
    outcome.velocity[ball, 0], outcome.velocity[ball, 1] = vx, vy
    outcome.time[ball] = s[TIME + i] + s[LOST + i]
    outcome.bounces[ball] = s[BOUNCES + i]
    # One wall: all bounces are its own, counted once a ball.
    if len(hits) == 1:
        hits[0] += outcome.bounces[ball]
    ending = int(s[ENDING + i])
    gone = ending == TIME_REACHED and has_left(start.box, 0.0 if radius is None else radius, x, y, vx, vy)
    outcome.ending[ball] = LEFT_SCENE if gone else ending
