"""Many balls on their way through the grid: a wave of them, each stage for all of them together.

A ball alone waits: for memory, for roots and quotients, and for branches that the processor predicts wrongly.
Here every ball of a wave is one step further with every turn of the loop: those that have entered a cell are paired
with what it lists, all pairs are asked for the time of impact, all balls find out when they leave their cell, all cross
into clearings. The arithmetic has no branches and runs over flat arrays, LANES for each number of a ball and PAIRS for
each of a pair, so that vector instructions do it; what is fetched for one does not wait for another. Balls that enter a
cell which lists something, or turn at a wall, are handled one by one; one that has ended makes room for another. Among
so many edges that they do not stay in the cache, two waves fly in turn: the records of one are prefetched while the
other flies.

The formulas are those of ``line_impact``, ``arc_impact`` and ``motion``, term by term: the same bits come out.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from wallkit.kernels.batches.ball_queue import NO_BALL, next_ball
from wallkit.kernels.batches.lockstep_lanes import note_end
from wallkit.kernels.batches.wave_columns import (
    AT,
    BALL,
    BEST,
    BOUNCES,
    COLUMN,
    COUNTS,
    CROSSES,
    ENDING,
    FEATURE,
    FLIES,
    FLOATS,
    FROM_VX,
    FROM_VY,
    FROM_X,
    FROM_Y,
    LANES,
    LOST,
    NONE,
    NX,
    NY,
    OCTANT,
    PER_U,
    PER_W,
    PX,
    PY,
    ROW,
    STILL,
    TIME,
    TOP,
    TOUCHED,
    TWICE,
    U,
    W,
)
from wallkit.kernels.batches.wave_impact import meet
from wallkit.kernels.batches.wave_walk import cross, decide, pair_rest, prefetch_cells, prefetch_listed
from wallkit.kernels.flight.ball_state import tolerance_of
from wallkit.kernels.flight.damping import free_time, slowed
from wallkit.kernels.flight.flight import (
    absorbs,
    ending_without,
    flown_on,
    normal_of,
    passes,
    still_limit,
    tally_of,
    wall_of,
)
from wallkit.kernels.flight.motion import advance, reflect
from wallkit.kernels.flight.point_in_corner import settle
from wallkit.kernels.index.grid import (
    clearing_at,
    clearings_of,
    departures_of,
    in_units,
    octant_of,
    per_speed,
    place,
    top_at,
)
from wallkit.kernels.intrinsics import lowest
from wallkit.kernels.jit import kernel, rare_kernel
from wallkit.kernels.records import (
    ABSORBED,
    AMBIGUOUS,
    AT_REST,
    BOUNCE_LIMIT,
    COLLAPSE,
    COLLAPSES,
    NO_HIT,
    RUNNING,
    TIME_REACHED,
)

MET = 2 * LANES
"""Features met that wait to be counted: one turn adds LANES at most."""
WAVES = 2
"""Flown in turn where there are many edges: while one flies, what the other needs comes from memory."""
APART = 2.0**12
"""Edges of a monotone chain part from where they are joined by more than a rounding in so many of it, see ``ASIDE``."""
NEAR_EDGES = 1 << 15
"""So many stay near the processor with the cells that list them: one wave is faster."""
NEAR_CELLS = 1 << 15
"""So many cells stay in the cache with their clearings: a prefetch would take longer than it saves."""


class WaveScratch(NamedTuple):
    """Memory to work in: contents do not matter."""

    movers: Any
    """(WAVES, LANES) ``Mover``."""
    floats: Any
    """(WAVES, FLOATS) floats, see ``wave_columns``."""
    integers: Any
    """(WAVES, INTEGERS) signed integers."""
    counts: Any
    """(WAVES, COUNTS) unsigned integers, see ``wave_columns``, which need no look whether they count from the end."""
    pairs: Any
    """(WAVES, LISTED) unsigned integers."""
    met: Any
    """MET integers."""


@kernel
def fly_wave(model, lists, radius, start, order, queue, stop, until, limit, hits, outcome, scratch):
    """Fly balls of one radius until none is left; as ``flight.fly`` does.

    Args:
        model: the scene; with a grid, without gravity.
        lists: what cells list, see ``note_short_lists``; of length 0 where that does not pay.
        radius: of all balls; None for points.
        start: the balls, see ``Start``.
        order: of the balls, best neighbours one after the other.
        queue: which places in the order are to fly, see ``Queue``.
        stop: the place after the last.
        until: time at which to stop, or inf.
        limit: number of bounces at which to stop.
        hits: counts of bounces, see ``Model.edge_tally``, added to.
        outcome: written for these balls, see ``Outcome``.
        scratch: see ``WaveScratch``.
    """
    # Where the records do not stay in the near caches two waves take turns: one flies while the other's are fetched.
    far = len(model.lines) > NEAR_EDGES
    flying, waves = 0, WAVES if far else 1
    for wave in range(waves):
        b, s = scratch.movers[wave], scratch.floats[wave]
        n, q = scratch.integers[wave], scratch.counts[wave]
        _clear(b, s, q)
        for i in range(LANES):
            flying += _board(model, radius, b, s, n, q, i, start, order, queue, stop, until, limit, outcome)
        cross(model, lists, radius, s, q, scratch.pairs[wave], far)
    if far:
        pair_rest(model, radius, scratch.counts[0], scratch.pairs[0], (0, 0, 0))
    # A turn: times of impact of pairs, way through the cells, bounces, lanes that end their ball, and the next pairs.
    wave, met = 0, 0
    while flying > 0:
        b, s = scratch.movers[wave], scratch.floats[wave]
        n, q, pairs = scratch.integers[wave], scratch.counts[wave], scratch.pairs[wave]
        wave = wave + 1 if wave + 1 < waves else 0
        meet(model, radius, b, s, q, pairs)
        turning, ending = decide(s, q, model.grid)
        if len(model.cells) > NEAR_CELLS:
            prefetch_cells(model, lists, q, far)
        if far:
            pair_rest(model, radius, scratch.counts[wave], scratch.pairs[wave], (0, 0, 0))
            prefetch_listed(model, scratch.counts[wave], scratch.pairs[wave])
        ended, met = _turn_all(model, radius, b, s, n, q, turning, until, limit, scratch.met, met)
        ending |= ended
        while ending > 0:
            i = lowest(ending)
            ending &= ending - 1
            how = n[ENDING + i] if (turning >> i) & 1 != 0 else ending_without(model.damping, NO_HIT, until)
            _store(model, model.damping, radius, b[i], s, n, i, start, until, how, outcome)
            flying += _board(model, radius, b, s, n, q, i, start, order, queue, stop, until, limit, outcome) - 1
        if met >= LANES:
            met = _count(model, scratch.met, met, hits)
        cross(model, lists, radius, s, q, pairs, far)
    _count(model, scratch.met, met, hits)


@kernel
def _turn_all(model, radius, b, s, n, q, turning, until, limit, met, count):
    """Take balls to what they meet, turn them there, and let them set out again.

    Args:
        model: the scene.
        radius: of all balls; None for points.
        b: movers of the wave.
        s: its floats.
        n: its signed integers.
        q: its unsigned integers.
        turning: a bit for each lane whose ball meets something.
        until: time at which to stop.
        limit: number of bounces at which to stop.
        met: the features met are added behind the first ``count``.
        count: of them.

    Returns:
        (a bit for each lane whose ball has ended, number of features met).
    """
    # Three passes: a ball's quotients and roots wait some twenty cycles for one another, but not for those of the
    # next ball, so that the processor works on several balls at a time.
    left = turning
    while left > 0:
        i = lowest(left)
        left &= left - 1  # takes the lowest bit away
        n[ENDING + i] = _reach(model, radius, b[i], s, n, i, until)
    left = turning
    while left > 0:
        i = lowest(left)
        left &= left - 1
        if n[ENDING + i] == RUNNING:
            n[ENDING + i] = _reflect(model, b[i], s, n, i, limit)
            met[count] = int(b[i].last)
            count += 1
    left, ended = turning, turning & 0
    while left > 0:
        i = lowest(left)
        left &= left - 1
        if n[ENDING + i] == RUNNING:
            _set_out(model, radius, b[i], s, q, i, until)
        else:
            ended |= 1 << i
    return ended, count


@kernel
def _set_out(model, radius, ball, s, q, i, until):
    """Begin a flight: nothing met so far, in the cell where the ball is."""
    grid = model.grid
    # The end of time is the first contact so far: later ones do not count.
    s[BEST + i] = free_time(model.damping, ball.energy, (until - s[TIME + i]) - s[LOST + i])
    s[FEATURE + i] = NONE
    s[TOUCHED + i] = 0.0
    # In units of the grid, with the inverses of the speeds: the walk multiplies and never divides.
    px, py, u, w = in_units(grid, ball.x, ball.y, ball.vx, ball.vy)
    per_u, per_w = per_speed(u), per_speed(w)
    s[PX + i], s[PY + i], s[U + i], s[W + i], s[PER_U + i], s[PER_W + i] = px, py, u, w, per_u, per_w
    octant = octant_of(per_u, per_w)
    column, row = place(grid, ball.x, ball.y)
    s[COLUMN + i], s[ROW + i] = float(column), float(row)
    q[OCTANT + i] = clearings_of(grid, octant)
    top = top_at(grid, column, row)
    q[TOP + i] = top << grid.packed
    q[AT + i] = clearing_at(grid, q[OCTANT + i], top)
    # A point well off the ends of the edge that it leaves may fly through cells that list its chain alone.
    if radius is None:
        if (grid.departs > 0) & (ball.last >= 0.0):
            if _is_off_ends(model, int(ball.last), ball.x, ball.y, APART * ball.tolerance):
                q[AT + i] = departures_of(grid, octant) + top
    q[CROSSES + i] = 1


@kernel
def _is_off_ends(model, edge, x, y, off):
    """Tell whether a place on an edge is farther than that from both its ends."""
    line = model.lines[edge]
    ax, ay, bx, by = line.ax, line.ay, line.bx, line.by
    # The sum of both coordinates is at least the distance, and needs no root.
    return (abs(x - ax) + abs(y - ay) > off) & (abs(x - bx) + abs(y - by) > off)


@kernel
def _reach(model, radius, ball, s, n, i, until):
    """Take a ball to what it meets, as ``flight.fly`` does, and note the normal there: an ending, or RUNNING."""
    x, y, vx, vy, time, lost = ball.x, ball.y, ball.vx, ball.vy, s[TIME + i], s[LOST + i]
    # What ``meet`` has found is final: the ball has come to the border of its cell after it.
    t, feature = s[BEST + i], int(s[FEATURE + i])
    if radius is None:
        if s[TOUCHED + i] > 0.0 and ball.last >= 0.0:
            met = _settle(model, ball, s, n, i)
            if met != NO_HIT:
                t, feature = 0.0, met
    if feature in (NO_HIT, AMBIGUOUS, COLLAPSES):
        return ending_without(model.damping, feature, until)
    passed, slower = slowed(model.damping, ball.energy, t, (until - time) - lost)
    n[STILL + i] = 0 if passes(time, passed, t, vx, vy, ball.tolerance) else n[STILL + i] + 1
    if n[STILL + i] > still_limit(model.restitution):
        return COLLAPSE
    if t > 0.0:
        if radius is None:
            s[FROM_X + i], s[FROM_Y + i], s[FROM_VX + i], s[FROM_VY + i] = x, y, vx, vy
        x, y = x + t * vx, y + t * vy
        ball.vx, ball.vy, ball.energy = slower * vx, slower * vy, slower * slower * ball.energy
        time, lost = advance(time, lost, passed)
    ball.x, ball.y, ball.last, s[TIME + i], s[LOST + i] = x, y, float(feature), time, lost
    s[NX + i], s[NY + i], s[TWICE + i], _wall = normal_of(model, feature, x, y)
    return RUNNING


@kernel
def _reflect(model, ball, s, n, i, limit):
    """Turn a ball at the wall that it has reached, as ``flight.fly`` does: an ending, or RUNNING."""
    wall = wall_of(model, int(ball.last))
    ball.vx, ball.vy, energy = reflect(
        model.restitution, wall, s[NX + i], s[NY + i], s[TWICE + i], ball.vx, ball.vy, ball.energy
    )
    # Where nothing takes speed it is that of the start: its root need not be taken again.
    if model.restitution is not None or model.damping is not None:
        ball.energy, ball.speed = energy, math.sqrt(energy)
    n[BOUNCES + i] += 1
    if absorbs(model.restitution, wall):
        return ABSORBED
    if energy <= 0.0:
        return AT_REST
    return BOUNCE_LIMIT if n[BOUNCES + i] >= limit else RUNNING


@rare_kernel
def _settle(model, ball, s, n, i):
    """Settle a point in a corner, as ``flight.fly`` does."""
    return settle(
        model, int(ball.last), 0.0, ball.x, ball.y, ball.vx, ball.vy,
        s[FROM_X + i], s[FROM_Y + i], s[FROM_VX + i], s[FROM_VY + i], ball.tolerance, n[STILL + i],
    )  # fmt: skip


@kernel
def _clear(b, s, q):
    """Empty a wave; without a ball a lane has a speed that nothing divides by 0 for."""
    for k in range(FLOATS):
        s[k] = 0.0
    for k in range(COUNTS):
        q[k] = 0
    for i in range(LANES):
        b[i].x, b[i].y, b[i].vx, b[i].vy, b[i].energy, b[i].speed = 0.0, 0.0, 0.0, 0.0, 1.0, 1.0
        b[i].tolerance, b[i].last = 0.0, NONE


@kernel
def _count(model, met, count, hits):
    """Count bounces off features, many together, so that one does not wait for another's memory: 0 are left."""
    # Two loops: the walls of all features are fetched before the first is counted.
    for k in range(count):
        met[k] = tally_of(model, met[k])
    for k in range(count):
        hits[met[k]] += 1
    return 0


@kernel
def _board(model, radius, b, s, n, q, i, start, order, queue, stop, until, limit, outcome):
    """Give a lane the next ball that flies at all, if there is one: 1 or 0."""
    while True:
        upcoming = next_ball(queue, stop)
        if upcoming == NO_BALL:
            break
        ball = order[upcoming]
        x, y = start.position[ball, 0] - start.origin[0], start.position[ball, 1] - start.origin[1]
        vx, vy = start.velocity[ball, 0], start.velocity[ball, 1]
        # A ball that rests, or may not bounce, is stored at once and takes no lane.
        energy = vx * vx + vy * vy
        b[i].x, b[i].y, b[i].vx, b[i].vy, b[i].energy, b[i].speed = x, y, vx, vy, energy, math.sqrt(energy)
        b[i].tolerance, b[i].last, s[TIME + i], s[LOST + i] = tolerance_of(x, y, start.extent), NONE, 0.0, 0.0
        s[FROM_X + i], s[FROM_Y + i], s[FROM_VX + i], s[FROM_VY + i] = x, y, vx, vy
        n[BOUNCES + i], n[STILL + i], n[BALL + i] = 0, 0, ball
        if energy > 0.0 and limit > 0:
            s[FLIES + i] = 1.0
            _set_out(model, radius, b[i], s, q, i, until)
            return 1
        _store(model, None, radius, b[i], s, n, i, start, until, AT_REST if energy <= 0.0 else BOUNCE_LIMIT, outcome)
    s[FLIES + i], q[CROSSES + i] = 0.0, 0
    return 0


@kernel
def _store(model, damping, radius, ball, s, n, i, start, until, ending, outcome):
    """Write where a ball has ended, flown on to the end time if that is why."""
    number = n[BALL + i]
    x, y, vx, vy, time = ball.x, ball.y, ball.vx, ball.vy, s[TIME + i] + s[LOST + i]
    if damping is not None:
        flown, clock = (x, y, vx, vy, ball.energy), (s[TIME + i], s[LOST + i])
        flown, clock, _start, ending = flown_on(model, None, flown, clock, flown[:4], ending, until)
        x, y, vx, vy, _energy = flown
        time = clock[0] + clock[1]
    elif ending == TIME_REACHED and s[BEST + i] > 0.0:  # BEST is the time that is left; a free flight uses it up
        x, y, time = x + s[BEST + i] * vx, y + s[BEST + i] * vy, until
    note_end(outcome, start, number, radius, (x, y), (vx, vy), time, n[BOUNCES + i], ending)
