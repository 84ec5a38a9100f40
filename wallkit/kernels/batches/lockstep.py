"""Many balls among few lines, in step: one pass a line over all balls of a chunk, free of branches.

A chunk is one flat array of floats, see ``lockstep_lanes``, worked on by vector instructions. A round takes every ball
to its next bounce; a ball that has ended makes room for another. The formulas are those of single balls, term by term:
the same bits come out. What few balls need in a round (corners, places where rounding hides a side) the passes only
notice; the kernels of single balls then answer for those, and ``flight.fly`` for bounces that nearly stop a ball.
"""

from __future__ import annotations

import math

from wallkit.kernels.batches.ball_queue import NO_BALL, next_ball
from wallkit.kernels.batches.lockstep_fall import ask_falling, bounce_falling
from wallkit.kernels.batches.lockstep_lanes import (
    ALONE,
    ASK,
    AX,
    AY,
    BEFORE,
    BEST,
    BOUNCES,
    ENDING,
    ENERGY,
    FROM_VX,
    FROM_VY,
    FROM_X,
    FROM_Y,
    HELD,
    HOLD,
    LANES,
    LAST,
    LENGTH,
    LOST,
    NONE,
    NX,
    NY,
    PLAIN,
    ROOM,
    ROW,
    SCRATCH,
    SIDE,
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
    note_end,
    row_of,
)  # fmt: skip
from wallkit.kernels.batches.lockstep_straight import WIDER, ask_straight, bounce_straight, look_ahead
from wallkit.kernels.flight.ball_state import FALLING_OVER, tolerance_of
from wallkit.kernels.flight.flight import flown_on, fly
from wallkit.kernels.flight.gravity import kept_energy
from wallkit.kernels.jit import kernel, pass_kernel, rare_kernel
from wallkit.kernels.records import (
    AT_REST,
    BOUNCE_LIMIT,
    COUNT,
    FREE,
    NO_HIT,
    RUNNING,
    STARTING,
    STATE,
    TIME_REACHED,
)  # fmt: skip

MOST_EDGES = 20
"""Beyond this the grid, or a scan that stops early, is faster."""
FEW = LANES // 4
"""A pass over all lanes takes as long as so many bounces one by one."""


@kernel
def fly_in_step(model, gravity, radius, start, queue, stop, until, limit, hits, outcome, scratch):
    """Fly balls of one radius until none is left; as ``flight.fly`` does, where few lines are.

    Args:
        model: the scene; no grid and no arcs.
        gravity: ``model.gravity``, given by itself so that what it is not needed for is dropped.
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
    _list_rows(model, model.restitution, rows)
    _clear(s)
    flying = 0
    while flying < LANES and _board(
        model, gravity, s, flying, balls, radius, start, queue, stop, until, limit, hits, outcome
    ):
        flying += 1
    few = _few(gravity, model.restitution)
    while flying > few:
        if gravity is None:
            look_ahead(model.damping, s)
            ask_straight(model, radius, s, until, flying)
        else:
            ask_falling(model, gravity, radius, s, flying)
        _look_up(gravity, model.restitution, s, met, rows)
        if gravity is None:
            bounce_straight(model, model.damping, model.restitution, s, radius, until, float(limit))
        else:
            bounce_falling(model, gravity, s, radius, until, float(limit))
        _count(s, hits, met, rows, flying)
        _fly_those_alone(model, gravity, model.restitution, radius, s, flying, until, limit, hits, scratch)
        for j in range(_list_ended(s, ended, flying) - 1, -1, -1):
            i = ended[j]
            _finish(model, model.damping, s, i, until)
            _store(s, i, balls[i], radius, start, hits, outcome)
            if not _board(model, gravity, s, i, balls, radius, start, queue, stop, until, limit, hits, outcome):
                # Lanes stay packed: passes go over all LANES, but what is done ball by ball only over those that fly.
                flying -= 1  # no ball is left for this lane: the last one moves here
                for k in range(0, _numbers(gravity, model.restitution, model.damping), LANES):
                    s[k + i] = s[k + flying]
                balls[i] = balls[flying]
    _fly_the_last(model, gravity, model.restitution, radius, s, flying, until, limit, hits, scratch, start, outcome)


@kernel
def _few(gravity, restitution):
    """So many balls or fewer fly on one by one, where ``flight.fly`` is at hand; else they keep their lanes."""
    if gravity is None and restitution is None:
        return 0
    return FEW


@kernel
def _fly_the_last(model, gravity, restitution, radius, s, flying, until, limit, hits, scratch, start, outcome):
    """Let the balls that are left when no other waits fly to their ends: for so few a pass takes longer."""
    if gravity is None and restitution is None:
        return
    for i in range(flying):
        _fly_alone(model, gravity, radius, s, i, until, limit, limit, hits, scratch)
        _finish(model, model.damping, s, i, until)
        _store(s, i, scratch.balls[i], radius, start, hits, outcome)


@kernel
def _numbers(gravity, restitution, damping):
    """Where the numbers of lanes that a scene needs end."""
    if gravity is None and restitution is None and damping is None:
        return PLAIN
    return SCRATCH


@kernel
def _clear(s):
    """Let lanes without a ball hold numbers that do no harm."""
    for i in range(SCRATCH):
        s[i] = 0.0
    # Energy and row 1 and NONE, so that passes over empty lanes divide by no 0 and meet nothing.
    for i in range(LANES):
        s[ENERGY + i], s[STOP + i], s[ROW + i], s[LAST + i] = 1.0, 1.0, NONE, NONE


@kernel
def _list_rows(model, restitution, rows):
    """Gather what a bounce needs to know of each line and corner."""
    lines, count = model.cells[0].corners, model.cells[0].end
    for k in range(count):
        if k < lines:
            line, wall = model.lines[model.ids[k]], model.edge_wall[model.ids[k]]
            rows[k, 0], rows[k, 1], rows[k, 2], rows[k, 3] = (
                line.nx,
                line.ny,
                line.twice,
                model.edge_tally[model.ids[k]],
            )
            rows[k, 6], rows[k, 7], rows[k, 8] = line.ax, line.ay, line.length
        else:
            corner, wall = model.corners[model.ids[k]], model.corner_wall[model.ids[k]]
            rows[k, 0], rows[k, 1], rows[k, 2], rows[k, 3] = corner.x, corner.y, 0.0, model.corner_tally[model.ids[k]]
        if restitution is not None:
            rows[k, 4], rows[k, 5] = restitution[2 * wall], restitution[2 * wall + 1]


@pass_kernel
def _look_up(gravity, restitution, s, met, rows):
    """Fetch the rows of what the balls meet; any for those that meet nothing."""
    # A gather. What is no row is below 0 and takes row 0, whose normal nobody uses.
    for i in range(LANES):
        met[i] = s[ROW + i] if s[ROW + i] > 0.0 else 0.0
    for i in range(LANES):
        s[NX + i], s[NY + i], s[TWICE + i] = rows[met[i], 0], rows[met[i], 1], rows[met[i], 2]
    if restitution is not None:
        for i in range(LANES):
            s[E + i], s[F + i] = rows[met[i], 4], rows[met[i], 5]
    if gravity is not None:
        for i in range(LANES):
            s[AX + i], s[AY + i], s[LENGTH + i] = rows[met[i], 6], rows[met[i], 7], rows[met[i], 8]


@kernel
def _count(s, hits, met, rows, flying):
    """Count bounces; if there is but one count, those of a ball count when it has ended."""
    if len(hits) == 1:
        return
    for i in range(flying):
        if s[ENDING + i] in (RUNNING, BOUNCE_LIMIT, AT_REST):
            hits[int(rows[met[i], 3])] += 1


@kernel
def _fly_those_alone(model, gravity, restitution, radius, s, flying, until, limit, hits, scratch):
    """Take the balls that the pass has left out to their next bounce, or to their end."""
    if gravity is None and restitution is None:
        return
    for i in range(flying):
        if s[ENDING + i] == ALONE:
            _fly_alone(model, gravity, radius, s, i, until, limit, int(s[BOUNCES + i]) + 1, hits, scratch)


@rare_kernel
def _fly_alone(model, gravity, radius, s, i, until, limit, stop, hits, scratch):
    """Take one ball to its end, or, before that, to the bounce number ``stop``."""
    state, counts, known = scratch.state, scratch.counts, len(hits) == 1
    bounces = int(s[BOUNCES + i])
    state[STATE.x], state[STATE.y], state[STATE.vx], state[STATE.vy] = s[X + i], s[Y + i], s[VX + i], s[VY + i]
    state[STATE.time], state[STATE.lost], state[STATE.energy] = s[TIME + i], s[LOST + i], s[ENERGY + i]
    state[STATE.tolerance] = s[TOLERANCE + i]
    state[STATE.from_x], state[STATE.from_y] = s[FROM_X + i], s[FROM_Y + i]
    state[STATE.from_vx], state[STATE.from_vy] = s[FROM_VX + i], s[FROM_VY + i]
    counts[COUNT.last], counts[COUNT.before] = feature_of(model, s[LAST + i]), feature_of(model, s[BEFORE + i])
    counts[COUNT.bounces], counts[COUNT.ending], counts[COUNT.still] = bounces, RUNNING, int(s[STILL + i])
    counts[COUNT.held], counts[COUNT.side] = feature_of(model, s[HELD + i]), int(s[SIDE + i])
    counts[COUNT.hold] = STARTING if counts[COUNT.last] == NO_HIT else int(s[HOLD + i])
    counts[COUNT.turns], counts[COUNT.changes] = 0, 0
    size = 0.0 if radius is None else radius
    fly(model, gravity, size, state, counts, until, min(limit, stop), hits, scratch.log, 1)
    s[X + i], s[Y + i], s[VX + i], s[VY + i] = state[STATE.x], state[STATE.y], state[STATE.vx], state[STATE.vy]
    s[TIME + i], s[LOST + i], s[ENERGY + i] = state[STATE.time], state[STATE.lost], state[STATE.energy]
    if radius is None:
        s[FROM_X + i], s[FROM_Y + i] = state[STATE.from_x], state[STATE.from_y]
        s[FROM_VX + i], s[FROM_VY + i] = state[STATE.from_vx], state[STATE.from_vy]
    s[LAST + i], s[BEFORE + i] = row_of(model, counts[COUNT.last]), row_of(model, counts[COUNT.before])
    s[STILL + i], s[HELD + i] = float(counts[COUNT.still]), row_of(model, counts[COUNT.held])
    s[HOLD + i], s[SIDE + i] = float(counts[COUNT.hold]), float(counts[COUNT.side])
    s[BOUNCES + i] = float(counts[COUNT.bounces])
    if known:  # bounces off the one wall are counted when the ball has ended
        hits[0] -= counts[COUNT.bounces] - bounces
    ending = counts[COUNT.ending]
    # A ball that meets nothing more has been flown on by now: ``_finish`` then finds no time left.
    s[ENDING + i] = float(RUNNING if ending == BOUNCE_LIMIT and counts[COUNT.bounces] < limit else ending)
    s[BEST + i] = (until - s[TIME + i]) - s[LOST + i]


@kernel
def _finish(model, damping, s, i, until):
    """Let a ball that something slows down fly until time is up, or until it stops."""
    if damping is None:
        return
    if s[ENDING + i] != float(TIME_REACHED):
        return
    if s[ENERGY + i] == 0.0:  # the pass has let it fly until it stopped
        s[ENDING + i] = float(AT_REST)
        return
    ball, clock = (s[X + i], s[Y + i], s[VX + i], s[VY + i], s[ENERGY + i]), (s[TIME + i], s[LOST + i])
    ball, clock, _start, ending = flown_on(model, None, ball, clock, ball[:4], TIME_REACHED, until)
    s[X + i], s[Y + i], s[VX + i], s[VY + i], s[ENERGY + i] = ball
    s[TIME + i], s[LOST + i] = clock
    s[ENDING + i] = float(ending)


@pass_kernel
def _list_ended(s, ended, flying):
    """List the lanes whose balls have ended: how many."""
    count = 0
    for i in range(flying):
        ended[count] = i  # written for each, kept where the count moves on: nothing to mispredict
        count += 1 if s[ENDING + i] != RUNNING else 0
    return count


@kernel
def _board(model, gravity, s, i, balls, radius, start, queue, stop, until, limit, hits, outcome):
    """Give a lane the next ball that flies at all: False if there is none."""
    ball = next_ball(queue, stop)
    while ball != NO_BALL:
        balls[i] = ball
        _load(gravity, model.restitution, s, i, radius, start, ball)
        rests = gravity is None and s[ENERGY + i] <= 0.0
        if limit > 0 and not rests:
            s[BEST + i] = until
            return True
        s[ENDING + i] = float(AT_REST) if rests else float(BOUNCE_LIMIT)
        _store(s, i, ball, radius, start, hits, outcome)
        ball = next_ball(queue, stop)
    return False


@kernel
def _load(gravity, restitution, s, i, radius, start, ball):
    """Put a ball, at time 0, into a lane."""
    x, y = start.position[ball, 0] - start.origin[0], start.position[ball, 1] - start.origin[1]
    vx, vy = start.velocity[ball, 0], start.velocity[ball, 1]
    # Positions are local to the scene's middle, where floats lie densest.
    energy, tolerance = vx * vx + vy * vy, tolerance_of(x, y, start.extent)
    if gravity is not None:
        energy, tolerance = kept_energy(gravity, x, y, vx, vy), FALLING_OVER * tolerance
    s[X + i], s[Y + i], s[VX + i], s[VY + i] = x, y, vx, vy
    s[TIME + i], s[LOST + i], s[BOUNCES + i], s[STILL + i], s[ASK + i] = 0.0, 0.0, 0.0, 0.0, 0.0
    s[ENERGY + i], s[TOLERANCE + i] = energy, tolerance
    s[LAST + i], s[ROW + i] = NONE, NONE
    if gravity is not None or restitution is not None:
        s[BEFORE + i], s[HELD + i], s[HOLD + i], s[SIDE + i] = NONE, NONE, float(FREE), 1.0
    if radius is None:
        s[FROM_X + i], s[FROM_Y + i], s[FROM_VX + i], s[FROM_VY + i] = x, y, vx, vy
    elif gravity is None:
        s[ROOM + i] = radius * math.sqrt(energy) * WIDER


@kernel
def _store(s, i, ball, radius, start, hits, outcome):
    """Write where a ball has ended."""
    place, velocity, bounces = (s[X + i], s[Y + i]), (s[VX + i], s[VY + i]), int(s[BOUNCES + i])
    note_end(outcome, start, ball, radius, place, velocity, s[TIME + i] + s[LOST + i], bounces, int(s[ENDING + i]))
    # One wall: all bounces are its own, counted once a ball.
    if len(hits) == 1:
        hits[0] += bounces
