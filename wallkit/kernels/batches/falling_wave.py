"""Many balls falling through the grid: a wave of them, each stage for all of them together, as in ``wave``.

Every ball of a wave is one rectangle of its way further with every turn of the loop. What walks and asks runs over flat
arrays, so that vector instructions do it; a ball that has found its first contact bounces by the kernels of single
balls, and so does one that a wall holds. The same bits come out.
"""

from __future__ import annotations

from wallkit.kernels.batches.ball_queue import NO_BALL, next_ball
from wallkit.kernels.batches.falling_columns import (
    BEST,
    COUNTS,
    FEATURE,
    FLIES,
    FLOATS,
    TOUCHED,
)
from wallkit.kernels.batches.falling_impact import meet_falling
from wallkit.kernels.batches.falling_walk import find_ways_out, look_around, set_out, walk_on
from wallkit.kernels.batches.lockstep_lanes import note_end
from wallkit.kernels.batches.wave_columns import LANES, NONE
from wallkit.kernels.flight.ball_state import FALLING_OVER, read_state, tolerance_of, write_state
from wallkit.kernels.flight.flight import (
    HOLDS,
    arrived,
    back_before,
    back_on_wall,
    ending_at_once,
    ending_without,
    flown_on,
    kept_to_wall,
    met,
    settled,
)
from wallkit.kernels.flight.gravity import kept_energy
from wallkit.kernels.intrinsics import lowest
from wallkit.kernels.jit import kernel
from wallkit.kernels.records import (
    AMBIGUOUS,
    COLLAPSES,
    COUNT,
    FALLS_BACK,
    LEFT,
    NO_HIT,
    RUNNING,
    STARTING,
    STATE,
)

BOARDS = -1.0
"""In place of the time of a contact: a ball has still to begin."""


@kernel
def fly_falling_wave(model, gravity, radius, start, order, queue, stop, until, limit, hits, outcome, scratch):
    """Fly balls of one radius until none is left; as ``flight.fly`` does.

    Args:
        model: the scene; with a grid and gravity, without drag.
        gravity: ``model.gravity``.
        radius: of all balls; None for points.
        start: the balls, see ``Start``.
        order: of the balls, best neighbours one after the other.
        queue: which places in the order are to fly, see ``Queue``.
        stop: the place after the last.
        until: time at which to stop, or inf.
        limit: number of bounces at which to stop.
        hits: counts of bounces, see ``Model.edge_tally``, added to.
        outcome: written for these balls, see ``Outcome``.
        scratch: see ``FallScratch``.
    """
    s, q, grid = scratch.floats, scratch.counts, model.grid
    for k in range(FLOATS):
        s[k] = 0.0
    for k in range(COUNTS):
        q[k] = 0
    flying = 0
    for i in range(LANES):
        flying += _board(gravity, i, start, order, queue, stop, scratch)
    # A turn: rectangles ahead, when they are left, what they list, and bounces of those that have found theirs.
    while flying > 0:
        listed = look_around(model, grid, s, q)
        find_ways_out(grid, gravity, s)
        meet_falling(model, gravity, radius, scratch, listed)
        found = walk_on(grid, gravity, s, q)
        while found > 0:
            i = lowest(found)
            found &= found - 1
            t, feature, touched = s[BEST + i], int(s[FEATURE + i]), int(s[TOUCHED + i])
            ending = _bounce(model, gravity, radius, t, feature, touched, until, limit, hits, scratch, i)
            if ending == RUNNING:
                _set_out(model, gravity, radius, scratch, i, until)
            else:
                _store(scratch.states[i], scratch.tallies[i], scratch.balls[i], radius, start, outcome)
                flying += _board(gravity, i, start, order, queue, stop, scratch) - 1


@kernel
def _bounce(model, gravity, radius, t, feature, touched, until, limit, hits, scratch, i):
    """Let a ball meet what its flight has found, and go on until it flies again: RUNNING, or how it has ended."""
    state, counts, log = scratch.states[i], scratch.tallies[i], scratch.log
    ball, clock, start, grip, last, bounces, still, before = read_state(state, counts)
    tolerance, size, ending, flown = state[STATE.tolerance], 0.0 if radius is None else radius, RUNNING, t != BOARDS
    while True:
        face, fate = 0.0, RUNNING
        if flown:
            back = scratch.fallers[i].back
            t, feature = settled(model, ball, start, grip, last, still, tolerance, t, feature, touched, back)
            if feature in (NO_HIT, AMBIGUOUS) or (feature == COLLAPSES and before == NO_HIT):
                ending = ending_without(None, feature, until)
                break
            if feature == FALLS_BACK:
                ball, clock, start, grip, last = back_on_wall(model, gravity, ball, clock, grip, t)
                feature = NO_HIT
            else:
                ball, clock, start, grip, last, still, feature, face, fate = arrived(
                    model, gravity, size, ball, clock, start, grip, last, still, feature, t, t, 1.0, tolerance
                )
        if feature != NO_HIT:
            ball, grip, last, bounces, still, before, ending, _noted = met(
                model, gravity, size, ball, clock, start, grip, last, bounces, still, before, feature, face, fate, t, t,
                tolerance, hits, log, 0,
            )  # fmt: skip
        if ending == RUNNING:
            ending = ending_at_once(gravity, ball[4], bounces, limit)
        if ending != RUNNING or grip[1] not in HOLDS:
            break
        remaining, flown = (until - clock[0]) - clock[1], False
        ball, clock, start, grip, last, t, feature, ending, _noted = kept_to_wall(
            model, gravity, size, ball, clock, start, grip, last, tolerance, remaining, until, log, 0
        )
    ball, clock, start, ending = flown_on(model, gravity, ball, clock, start, ending, until)
    write_state(state, counts, ball, clock, start, grip, last, bounces, ending, still, before)
    return ending


@kernel
def _set_out(model, gravity, radius, scratch, i, until):
    """Begin a flight: nothing met so far, in the cell where the ball is."""
    state, counts, f, s = scratch.states[i], scratch.tallies[i], scratch.fallers, scratch.floats
    ball, clock, _start, grip, last, _bounces, _still, _before = read_state(state, counts)
    x, y, vx, vy, _energy = ball
    f[i].x, f[i].y, f[i].vx, f[i].vy, f[i].tolerance, f[i].last = x, y, vx, vy, state[STATE.tolerance], float(last)
    f[i].skipped = float(grip[0]) if grip[1] == LEFT else NONE
    s[FEATURE + i], s[TOUCHED + i] = NONE, 0.0
    remaining = (until - clock[0]) - clock[1]
    size = 0.0 if radius is None else radius
    f[i].back, best = back_before(model, gravity, size, ball, grip, state[STATE.tolerance], remaining)
    set_out(model.grid, gravity, s, scratch.counts, i, x, y, vx, vy, best)


@kernel
def _board(gravity, i, start, order, queue, stop, scratch):
    """Give a lane the next ball, if there is one: 1 or 0."""
    s, upcoming = scratch.floats, next_ball(queue, stop)
    if upcoming == NO_BALL:
        s[FLIES + i] = 0.0
        return 0
    ball, state, counts, f = order[upcoming], scratch.states[i], scratch.tallies[i], scratch.fallers
    x, y = start.position[ball, 0] - start.origin[0], start.position[ball, 1] - start.origin[1]
    vx, vy = start.velocity[ball, 0], start.velocity[ball, 1]
    energy, tolerance = kept_energy(gravity, x, y, vx, vy), FALLING_OVER * tolerance_of(x, y, start.extent)
    state[STATE.tolerance] = tolerance
    write_state(
        state, counts, (x, y, vx, vy, energy), (0.0, 0.0), (x, y, vx, vy), (NO_HIT, STARTING, 1.0, 0, 0), NO_HIT, 0,
        RUNNING, 0, NO_HIT,
    )  # fmt: skip
    scratch.balls[i] = ball
    f[i].x, f[i].y, f[i].vx, f[i].vy, f[i].tolerance, f[i].last, f[i].skipped = x, y, vx, vy, tolerance, NONE, NONE
    s[BEST + i], s[FEATURE + i], s[TOUCHED + i], s[FLIES + i] = BOARDS, NONE, 0.0, 1.0
    return 1


@kernel
def _store(state, counts, ball, radius, start, outcome):
    """Write where a ball has ended."""
    place, velocity = (state[STATE.x], state[STATE.y]), (state[STATE.vx], state[STATE.vy])
    time, bounces, ending = state[STATE.time] + state[STATE.lost], counts[COUNT.bounces], counts[COUNT.ending]
    note_end(outcome, start, ball, radius, place, velocity, time, bounces, ending)
