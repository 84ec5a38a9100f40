"""Many balls among few lines, in step: one pass an edge over all balls of a chunk, free of branches.

A chunk is one flat array of floats, LANES for each number of a ball, so that the compiler sees that nothing aliases and
uses vector instructions. A pass over all edges takes every ball to its next bounce; a ball that has ended makes room
for another. The formulas are those of ``impact`` and ``motion``, term by term: the same bits come out.
"""

from __future__ import annotations

import math

from wallkit.kernels.corner import settle
from wallkit.kernels.flight import still_limit
from wallkit.kernels.jit import kernel, rare_kernel
from wallkit.kernels.model import (
    AMBIGUOUS,
    AMBIGUOUS_CORNER,
    AT_REST,
    BOUNCE_LIMIT,
    COLLAPSE,
    COLLAPSES,
    LEFT_SCENE,
    NO_HIT,
    RUNNING,
    STATE_SIZE,
    TIME_REACHED,
)

LANES = 256
MOST_EDGES = 20
"""Beyond this the grid, or a scan that stops early, is faster."""
(
    X, Y, VX, VY, TIME, LOST, ENERGY, FROM_X, FROM_Y, FROM_VX, FROM_VY, TOLERANCE,
    LAST, BOUNCES, STILL, BEST, FEATURE, TOUCHED, NX, NY, TWICE,
) = (LANES * number for number in range(21))  # fmt: skip
SCRATCH = 21 * LANES
NONE = float(NO_HIT)
STILL_LIMIT = float(still_limit(None))
SETTLED_AMBIGUOUS, SETTLED_COLLAPSES = 2.0, 3.0
"""What TOUCHED says of a point in a corner that it does not leave."""


@kernel
def _pass_point(s, number, line):
    """Let one line ask all points, as ``impact.scan_point`` does."""
    ax, ay, bx, by, nx, ny = line.ax, line.ay, line.bx, line.by, line.nx, line.ny
    length, twice = line.length, line.twice
    for i in range(LANES):
        x, y, vx, vy = s[X + i], s[Y + i], s[VX + i], s[VY + i]
        tolerance, best = s[TOLERANCE + i], s[BEST + i]
        ex, ey = ax - x, ay - y
        d = -(ex * nx + ey * ny)
        u = ex * ny - ey * nx
        other = s[LAST + i] != number
        near = (abs(d) <= tolerance) & (u >= -tolerance) & (u <= length + tolerance)
        cross_a = ex * vy - ey * vx
        cross_b = (bx - x) * vy - (by - y) * vx
        above = d > 0.0
        closing = vx * nx + vy * ny
        closing = -closing if above else closing
        closing = closing if closing > 0.0 else abs(cross_b - cross_a) / length
        t = abs(d) / closing
        rises = cross_a < 0.0
        met = other & (not near) & (rises != (cross_b < 0.0)) & (rises == above) & (t < best)
        s[BEST + i] = t if met else best
        s[FEATURE + i] = number if met else s[FEATURE + i]
        s[NX + i] = nx if met else s[NX + i]
        s[NY + i] = ny if met else s[NY + i]
        s[TWICE + i] = twice if met else s[TWICE + i]
        s[TOUCHED + i] = 1.0 if near & other else s[TOUCHED + i]


@kernel
def _pass_disc(s, number, line, radius):
    """Let one line ask all discs, as ``impact.scan_disc`` does."""
    ax, ay, nx, ny, length, twice = line.ax, line.ay, line.nx, line.ny, line.length, line.twice
    for i in range(LANES):
        vx, vy, best = s[VX + i], s[VY + i], s[BEST + i]
        slack = s[TOLERANCE + i] + radius * 2.0**-42
        ex, ey = s[X + i] - ax, s[Y + i] - ay
        d = ex * nx + ey * ny
        closing = -(vx * nx + vy * ny)
        below = d < 0.0
        d = -d if below else d
        closing = -closing if below else closing
        t = (d - radius) / closing
        t = 0.0 if t < 0.0 else t
        u = ey * nx - ex * ny + t * (vy * nx - vx * ny)
        met = (closing > 0.0) & (u >= -slack) & (u <= length + slack) & (s[LAST + i] != number) & (t < best)
        s[BEST + i] = t if met else best
        s[FEATURE + i] = number if met else s[FEATURE + i]
        s[NX + i] = nx if met else s[NX + i]
        s[NY + i] = ny if met else s[NY + i]
        s[TWICE + i] = twice if met else s[TWICE + i]


@kernel
def _pass_corner(s, number, corner, radius):
    """Let one corner ask all discs, as ``impact.scan_corners`` does; its normal is taken at the contact."""
    cx, cy = corner.x, corner.y
    square = radius * radius
    for i in range(LANES):
        vx, vy, best, energy = s[VX + i], s[VY + i], s[BEST + i], s[ENERGY + i]
        ex, ey = s[X + i] - cx, s[Y + i] - cy
        along = ex * vx + ey * vy
        cross = ex * vy - ey * vx
        discriminant = square - cross * cross * (1.0 / energy)
        c = ex * ex + ey * ey - square
        t = c / (math.sqrt(energy * (discriminant if discriminant > 0.0 else 0.0)) - along)
        t = 0.0 if t < 0.0 else t
        met = (along < 0.0) & (discriminant >= 0.0) & (t < best) & (s[LAST + i] != number)
        mx, my = (s[X + i] + t * vx) - cx, (s[Y + i] + t * vy) - cy
        s[BEST + i] = t if met else best
        s[FEATURE + i] = number if met else s[FEATURE + i]
        s[NX + i] = mx if met else s[NX + i]
        s[NY + i] = my if met else s[NY + i]
        s[TWICE + i] = 2.0 / (mx * mx + my * my) if met else s[TWICE + i]


@kernel
def _begin(s, until):
    for i in range(LANES):
        s[BEST + i] = (until - s[TIME + i]) - s[LOST + i]
        s[FEATURE + i] = NONE
        s[TOUCHED + i] = 0.0


@kernel
def _bounce(s):
    """Move every ball that meets something and turn its velocity, as ``flight.fly`` does."""
    for i in range(LANES):
        x, y, vx, vy, t = s[X + i], s[Y + i], s[VX + i], s[VY + i], s[BEST + i]
        time, lost, energy = s[TIME + i], s[LOST + i], s[ENERGY + i]
        hit = s[FEATURE + i] != NONE
        total = time + t
        passed = (total > time) & (t * (abs(vx) + abs(vy)) > s[TOLERANCE + i] * 2.0**-6)
        rest = (time - total) + t if time >= t else (t - total) + time
        count = 0.0 if passed else s[STILL + i] + 1.0
        s[STILL + i] = count if hit else s[STILL + i]
        hit = hit & (count <= STILL_LIMIT)
        moved = hit & (t > 0.0)
        s[FROM_X + i] = x if moved else s[FROM_X + i]
        s[FROM_Y + i] = y if moved else s[FROM_Y + i]
        s[FROM_VX + i] = vx if moved else s[FROM_VX + i]
        s[FROM_VY + i] = vy if moved else s[FROM_VY + i]
        s[X + i] = x + t * vx if moved else x
        s[Y + i] = y + t * vy if moved else y
        s[TIME + i] = total if moved else time
        s[LOST + i] = lost + rest if moved else lost
        nx, ny = s[NX + i], s[NY + i]
        normal = vx * nx + vy * ny
        factor = normal * s[TWICE + i]
        wx, wy = vx - factor * nx, vy - factor * ny
        scale = 1.5 - 0.5 * ((wx * wx + wy * wy) / energy)
        s[VX + i] = wx * scale if hit else vx
        s[VY + i] = wy * scale if hit else vy
        s[LAST + i] = s[FEATURE + i] if hit else s[LAST + i]
        s[BOUNCES + i] = s[BOUNCES + i] + 1.0 if hit else s[BOUNCES + i]


@kernel
def fly_in_step(model, radius, states, counts, until, limit, hits, s, balls):
    """Fly all balls of one radius; what ``flight.fly_all`` does, for scenes of few lines where nothing else acts.

    Args:
        model: the scene; no grid, arcs, gravity, restitution or one-sided walls.
        radius: of all balls.
        states: (n, STATE_SIZE) read and written.
        counts: (n, 6) read and written.
        until: time at which to stop, or inf.
        limit: number of bounces at which to stop.
        hits: bounces by wall, added to.
        s: scratch of SCRATCH floats.
        balls: scratch of LANES integers.
    """
    upcoming = 0
    flying = 0
    for i in range(LANES):
        balls[i] = NO_HIT
        for k in range(SCRATCH // LANES):
            s[k * LANES + i] = 0.0
        s[ENERGY + i] = 1.0
        s[FEATURE + i] = NONE
        s[LAST + i] = NONE
        upcoming, more = _load(s, i, balls, states, counts, limit, upcoming)
        flying += more
    while flying > 0:
        _begin(s, until)
        for k in range(model.cells[0].arcs):
            if radius == 0.0:
                _pass_point(s, float(model.ids[k]), model.lines[model.ids[k]])
            else:
                _pass_disc(s, float(model.ids[k]), model.lines[model.ids[k]], radius)
        if radius > 0.0:
            for k in range(model.cells[0].corners, model.cells[1].first):
                _pass_corner(s, -2.0 - float(model.ids[k]), model.corners[model.ids[k]], radius)
        else:
            for i in range(LANES):
                if s[TOUCHED + i] > 0.0 and s[LAST + i] >= 0.0:
                    _settle(model, s, i)
        _bounce(s)
        for i in range(LANES):
            if balls[i] == NO_HIT:
                continue
            ending = _ending(s, i, until, limit)
            if ending in (RUNNING, BOUNCE_LIMIT):
                feature = int(s[LAST + i])
                wall = model.edge_wall[feature] if feature >= 0 else model.corner_wall[-2 - feature]
                hits[wall] += 1
            if ending != RUNNING:
                _store(s, i, balls[i], states, counts, until, ending)
                balls[i] = NO_HIT
                upcoming, more = _load(s, i, balls, states, counts, limit, upcoming)
                flying += more - 1


@kernel
def _ending(s, i, until, limit):
    """What the pass just done is for a ball: an ending, or RUNNING."""
    if s[TOUCHED + i] == SETTLED_AMBIGUOUS:
        return AMBIGUOUS_CORNER
    if s[TOUCHED + i] == SETTLED_COLLAPSES or s[STILL + i] > STILL_LIMIT:
        return COLLAPSE
    if s[FEATURE + i] == NONE:
        return LEFT_SCENE if until == math.inf else TIME_REACHED
    return BOUNCE_LIMIT if s[BOUNCES + i] >= limit else RUNNING


@rare_kernel
def _settle(model, s, i):
    """Settle a point in a corner, as ``flight.fly`` does."""
    met = settle(
        model, int(s[LAST + i]), s[X + i], s[Y + i], s[VX + i], s[VY + i],
        s[FROM_X + i], s[FROM_Y + i], s[FROM_VX + i], s[FROM_VY + i], s[TOLERANCE + i], int(s[STILL + i]),
    )  # fmt: skip
    if met in (AMBIGUOUS, COLLAPSES):
        s[FEATURE + i] = NONE
        s[TOUCHED + i] = SETTLED_AMBIGUOUS if met == AMBIGUOUS else SETTLED_COLLAPSES
    elif met != NO_HIT:
        line = model.lines[met]
        s[BEST + i], s[FEATURE + i] = 0.0, float(met)
        s[NX + i], s[NY + i], s[TWICE + i] = line.nx, line.ny, line.twice


@kernel
def _load(s, i, balls, states, counts, limit, upcoming):
    """Give a lane its next ball: (number of the one after it, 1 if there was one)."""
    while upcoming < len(states):
        ball = upcoming
        upcoming += 1
        if states[ball, 6] <= 0.0 or counts[ball, 1] >= limit:
            counts[ball, 2] = AT_REST if states[ball, 6] <= 0.0 else BOUNCE_LIMIT
            continue
        for k in range(STATE_SIZE):
            s[k * LANES + i] = states[ball, k]
        s[LAST + i], s[BOUNCES + i], s[STILL + i] = float(counts[ball, 0]), float(counts[ball, 1]), 0.0
        balls[i] = ball
        return upcoming, 1
    s[VX + i], s[VY + i], s[LAST + i], s[FEATURE + i] = 0.0, 0.0, NONE, NONE
    return upcoming, 0


@kernel
def _store(s, i, ball, states, counts, until, ending):
    """Put a ball that has ended back, flown on to the end time if that is why."""
    if ending == TIME_REACHED and s[BEST + i] > 0.0:
        s[FROM_X + i], s[FROM_Y + i], s[FROM_VX + i], s[FROM_VY + i] = s[X + i], s[Y + i], s[VX + i], s[VY + i]
        s[X + i] += s[BEST + i] * s[VX + i]
        s[Y + i] += s[BEST + i] * s[VY + i]
        s[TIME + i], s[LOST + i] = until, 0.0
    for k in range(STATE_SIZE):
        states[ball, k] = s[k * LANES + i]
    counts[ball, 0], counts[ball, 1] = int(s[LAST + i]), int(s[BOUNCES + i])
    counts[ball, 2], counts[ball, 3] = ending, int(s[STILL + i])
