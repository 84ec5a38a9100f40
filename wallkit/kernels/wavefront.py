"""Many balls on their way through the grid: a wave of them, each stage for all of them together.

A ball alone waits: for memory, for roots and quotients, and for the processor to find out which way a branch goes.
Here every ball of a wave is one step further with every turn of the loop: all fetch what they look at next, all ask it
for the time of impact, all find out when they leave their cell, all cross into clearings. The arithmetic has no
branches and runs over flat arrays, LANES for each number of a ball, so that vector instructions do it; what is fetched
for one ball does not wait for another. Balls that enter a cell which lists something, or turn at a wall, are listed and
handled one by one; one that has ended makes room for another. Among so many edges that memory is slow to give them, two
waves fly in turn: what one needs is on its way while the other flies.

The formulas are those of ``impact``, ``arcs`` and ``motion``, term by term: the same bits come out.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from wallkit.kernels.corner import settle
from wallkit.kernels.flight import absorbs, ending_without, has_left, normal_of, passes, still_limit, tolerance_of
from wallkit.kernels.grid import clearing_at, in_units, leaf, per_speed, place, way_of
from wallkit.kernels.jit import kernel, prefetch, rare_kernel
from wallkit.kernels.model import (
    ABSORBED,
    AMBIGUOUS,
    AT_REST,
    BOUNCE_LIMIT,
    COLLAPSE,
    COLLAPSES,
    LEFT_SCENE,
    NO_HIT,
    RUNNING,
    TIME_REACHED,
)
from wallkit.kernels.motion import advance, reflect
from wallkit.kernels.queue import NO_BALL, next_ball
from wallkit.kernels.wave_impact import (
    ARC_LIST,
    ARCS,
    AT,
    BEST,
    BORDER_X,
    BORDER_Y,
    COLUMN,
    CORNER_LIST,
    CORNERS,
    COUNTS,
    CROSSES,
    E0,
    E1,
    E2,
    E3,
    E4,
    E5,
    E6,
    E7,
    E8,
    E9,
    END,
    ENERGY,
    ENTERED,
    ENTERING,
    FEATURE,
    FLIES,
    FLOATS,
    FROM_VX,
    FROM_VY,
    FROM_X,
    FROM_Y,
    ID,
    LANES,
    LAST,
    LINE_LIST,
    LOST,
    NEXT,
    NEXT_CORNER,
    NONE,
    PER_ENERGY,
    PER_U,
    PER_W,
    PX,
    PY,
    ROW,
    SIDE,
    SIZE,
    SPEED,
    TIME,
    TOLERANCE,
    TOUCHED,
    TURNING,
    TURNS,
    VX,
    VY,
    WAY,
    U,
    W,
    X,
    Y,
    meet_arcs_disc,
    meet_arcs_point,
    meet_corners,
    meet_lines_disc,
    meet_lines_point,
)  # fmt: skip

BALL, BOUNCES, STILL = (LANES * number for number in range(3))
INTEGERS = 3 * LANES
MET = 2 * LANES
"""Features met that wait to be counted: one turn adds LANES at most."""
WAVES = 2
"""Flown in turn where there are many edges: while one flies, what the other needs comes from memory."""
NEAR_EDGES = 1 << 15
"""So many stay near the processor with the cells that list them: one wave, and nothing asked for ahead, is faster."""


class WaveScratch(NamedTuple):
    """Memory to work in: contents do not matter."""

    floats: Any
    """(WAVES, FLOATS) floats, see ``wave_impact``."""
    integers: Any
    """(WAVES, INTEGERS) signed integers."""
    counts: Any
    """(WAVES, COUNTS) unsigned integers, see ``wave_impact``, which need no look whether they count from the end."""
    met: Any
    """MET integers."""


@kernel
def _list_looking(arcs, radius, q):
    """List the balls that look at something, by its kind, of those there are: (at lines, at arcs, at corners)."""
    at_line, at_arc, at_corner = 0, 0, 0
    for i in range(LANES):
        k = q[NEXT + i]
        q[LINE_LIST + at_line] = i
        at_line += int(k < q[ARCS + i])
        if arcs is not None:
            q[ARC_LIST + at_arc] = i
            at_arc += int((k >= q[ARCS + i]) & (k < q[CORNERS + i]))
        if radius is not None:
            q[CORNER_LIST + at_corner] = i
            at_corner += int(q[NEXT_CORNER + i] < q[END + i])
    return at_line, at_arc, at_corner


@kernel
def _fetch_lines(model, radius, s, q, count):
    for k in range(count):
        i = q[LINE_LIST + k]
        edge = model.ids[q[NEXT + i]]
        line = model.lines[edge]
        s[ID + i] = float(edge)
        s[E0 + i], s[E1 + i] = line.ax, line.ay
        if radius is None:
            s[E2 + i], s[E3 + i] = line.bx, line.by
        s[E4 + i], s[E5 + i], s[E6 + i] = line.nx, line.ny, line.length


@kernel
def _fetch_corners(model, s, q, count):
    for k in range(count):
        i = q[CORNER_LIST + k]
        vertex = model.ids[q[NEXT_CORNER + i]]
        corner = model.corners[vertex]
        s[ID + i], s[E0 + i], s[E1 + i] = float(vertex), corner.x, corner.y


@kernel
def _fetch_arcs(model, arcs, radius, s, q, count):
    if arcs is None:
        return
    for k in range(count):
        i = q[ARC_LIST + k]
        edge = model.ids[q[NEXT + i]]
        arc = arcs[model.arc_of_edge[edge]]
        s[ID + i] = float(edge)
        s[E0 + i], s[E1 + i] = arc.ax, arc.ay
        if radius is None:
            s[E2 + i], s[E3 + i] = arc.bx, arc.by
        s[E4 + i], s[E5 + i], s[E6 + i], s[E7 + i] = arc.sx, arc.sy, arc.fx, arc.fy
        s[E8 + i], s[E9 + i] = arc.radius, arc.wide


@kernel
def _decide(s, q, grid, radius):
    """Find when every ball leaves its cell, and what it does next: look on, cross into the next cell, or turn.

    As ``grid.ahead`` does, with the borders of the cell (or clearing) as they are. Also where the next cell is in
    ``Model.clearings``: some place within for balls that do not cross, too, for all of them look there.
    """
    columns, rows = float(grid.columns << grid.shift), float(grid.rows << grid.shift)
    for i in range(LANES):
        px, py, u, w, per_u, per_w = s[PX + i], s[PY + i], s[U + i], s[W + i], s[PER_U + i], s[PER_W + i]
        border_x, border_y = s[BORDER_X + i], s[BORDER_Y + i]
        exit_x, exit_y = (border_x - px) * per_u, (border_y - py) * per_w
        sideways = exit_x < exit_y
        time = exit_x if sideways else exit_y
        there_x, there_y = px + time * u, py + time * w
        there_x = there_x if there_x > 0.0 else 0.0
        there_y = there_y if there_y > 0.0 else 0.0
        there_x = there_x if there_x < columns - 1.0 else columns - 1.0
        there_y = there_y if there_y < rows - 1.0 else rows - 1.0
        back_x, back_y = s[COLUMN + i], s[ROW + i]  # where the ball is, or, asked again, what came out before
        there_x = back_x if (there_x < back_x) == (per_u > 0.0) else there_x
        there_y = back_y if (there_y < back_y) == (per_w > 0.0) else there_y
        x = (border_x if per_u > 0.0 else border_x - 1.0) if sideways else there_x
        y = there_y if sideways else (border_y if per_w > 0.0 else border_y - 1.0)
        outside = (x < 0.0) | (x >= columns) | (y < 0.0) | (y >= rows)
        turns = outside | (s[BEST + i] <= time)
        following = q[NEXT + i] + int(q[NEXT + i] < q[CORNERS + i])
        q[NEXT + i] = following
        goes = (s[FLIES + i] == 1.0) & (following >= q[CORNERS + i])
        if radius is not None:
            following = q[NEXT_CORNER + i] + int(q[NEXT_CORNER + i] < q[END + i])
            q[NEXT_CORNER + i] = following
            goes = goes & (following >= q[END + i])
        column, row = int(0.0 if outside else x), int(0.0 if outside else y)
        s[COLUMN + i], s[ROW + i] = float(column), float(row)
        q[AT + i] = clearing_at(grid, q[WAY + i], column, row)
        q[CROSSES + i] = int(goes & (not turns))
        q[TURNS + i] = int(goes & turns)


@kernel
def _list_turning(q):
    """List the balls that turn: how many."""
    turning = 0
    for i in range(LANES):
        q[TURNING + turning] = i
        turning += q[TURNS + i]
    return turning


@kernel
def _list_entering(model, q):
    """Find the clearings that balls cross into, and list those that cross into a cell instead: how many."""
    entering, size = 0, 1 << model.grid.shift
    for i in range(LANES):
        side = model.clearings[q[AT + i]]
        q[SIDE + i], q[SIZE + i] = side, size
        q[ENTERING + entering] = i
        entering += int(q[CROSSES + i] > side)
    return entering


@kernel
def _enter(model, s, q, i):
    """Enter the cell at the column and row of a ball."""
    grid, cells = model.grid, model.cells
    top = q[AT + i] >> 2
    if cells[top].link > 0:
        _open(cells, q, i, top, grid.shift)
    else:
        cell, shift = leaf(cells, grid, int(s[COLUMN + i]), int(s[ROW + i]))
        _open(cells, q, i, cell, shift)


@kernel
def _open(cells, q, i, cell, shift):
    """Look at what a cell of the side 2^shift lists."""
    q[NEXT + i], q[ARCS + i], q[CORNERS + i] = cells[cell].first, cells[cell].arcs, cells[cell].corners
    q[NEXT_CORNER + i], q[END + i] = cells[cell].corners, cells[cell + 1].first
    q[SIDE + i], q[SIZE + i] = cells[cell].link, 1 << shift


@kernel
def _border(s, q):
    """Find the borders ahead of the balls that have crossed into a cell or clearing, as ``grid.ahead`` does."""
    for i in range(LANES):
        crosses, size, side = q[CROSSES + i] > 0, q[SIZE + i], q[SIDE + i]
        column, row = int(s[COLUMN + i]) & -int(size), int(s[ROW + i]) & -int(size)
        far, near = float(size * side), float(size) - float(size * side)
        x, y = float(column) + (far if s[PER_U + i] > 0.0 else near), float(row) + (far if s[PER_W + i] > 0.0 else near)
        s[BORDER_X + i] = x if crosses else s[BORDER_X + i]
        s[BORDER_Y + i] = y if crosses else s[BORDER_Y + i]


@kernel
def _set_out(model, s, q, i, until):
    """Begin a flight: nothing met so far, in the cell where the ball is."""
    grid = model.grid
    s[BEST + i] = (until - s[TIME + i]) - s[LOST + i]
    s[FEATURE + i] = NONE
    s[TOUCHED + i] = 0.0
    px, py, u, w = in_units(grid, s[X + i], s[Y + i], s[VX + i], s[VY + i])
    per_u, per_w = per_speed(u), per_speed(w)
    s[PX + i], s[PY + i], s[U + i], s[W + i], s[PER_U + i], s[PER_W + i] = px, py, u, w, per_u, per_w
    way = way_of(per_u, per_w)
    column, row = place(grid, s[X + i], s[Y + i])
    s[COLUMN + i], s[ROW + i] = float(column), float(row)
    q[WAY + i] = way
    q[AT + i] = clearing_at(grid, way, column, row)
    q[CROSSES + i] = 1


@kernel
def _turn(model, radius, s, n, i, until, limit):
    """Take a ball to what it meets and turn it there, as ``flight.fly`` does: an ending, or RUNNING."""
    x, y, vx, vy, time, lost = s[X + i], s[Y + i], s[VX + i], s[VY + i], s[TIME + i], s[LOST + i]
    t, feature = s[BEST + i], int(s[FEATURE + i])
    if radius is None:
        if s[TOUCHED + i] > 0.0 and s[LAST + i] >= 0.0:
            met = _settle(model, s, n, i)
            if met != NO_HIT:
                t, feature = 0.0, met
    if feature in (NO_HIT, AMBIGUOUS, COLLAPSES):
        return ending_without(None, feature, until)
    n[STILL + i] = 0 if passes(time, t, t, vx, vy, s[TOLERANCE + i]) else n[STILL + i] + 1
    if n[STILL + i] > still_limit(model.restitution):
        return COLLAPSE
    if t > 0.0:
        s[FROM_X + i], s[FROM_Y + i], s[FROM_VX + i], s[FROM_VY + i] = x, y, vx, vy
        x, y = x + t * vx, y + t * vy
        time, lost = advance(time, lost, t)
    nx, ny, twice, wall = normal_of(model, feature, x, y)
    vx, vy, energy = reflect(model.restitution, wall, nx, ny, twice, vx, vy, s[ENERGY + i])
    s[X + i], s[Y + i], s[VX + i], s[VY + i], s[TIME + i], s[LOST + i] = x, y, vx, vy, time, lost
    if model.restitution is not None:
        _set_energy(s, i, energy)
    s[LAST + i] = float(feature)
    n[BOUNCES + i] += 1
    if absorbs(model.restitution, wall):
        return ABSORBED
    if energy <= 0.0:
        return AT_REST
    return BOUNCE_LIMIT if n[BOUNCES + i] >= limit else RUNNING


@kernel
def _set_energy(s, i, energy):
    """Keep a squared speed, and what every look at an arc or a corner would make of it again."""
    s[ENERGY + i], s[SPEED + i], s[PER_ENERGY + i] = energy, math.sqrt(energy), 1.0 / energy


@rare_kernel
def _settle(model, s, n, i):
    """Settle a point in a corner, as ``flight.fly`` does."""
    return settle(
        model, int(s[LAST + i]), s[X + i], s[Y + i], s[VX + i], s[VY + i],
        s[FROM_X + i], s[FROM_Y + i], s[FROM_VX + i], s[FROM_VY + i], s[TOLERANCE + i], n[STILL + i],
    )  # fmt: skip


@kernel
def fly_wave(model, radius, start, order, queue, stop, until, limit, hits, outcome, scratch):
    """Fly balls of one radius until none is left; as ``flight.fly`` does.

    Args:
        model: the scene; with a grid, without gravity, damping or one-sided walls.
        radius: of all balls; None for points.
        start: the balls, see ``Start``.
        order: of the balls, best neighbours one after the other.
        queue: which places in the order are to fly, see ``Queue``.
        stop: the place after the last.
        until: time at which to stop, or inf.
        limit: number of bounces at which to stop.
        hits: bounces by wall, added to.
        outcome: written for these balls, see ``Outcome``.
        scratch: see ``WaveScratch``.
    """
    far = len(model.lines) > NEAR_EDGES
    flying, waves = 0, WAVES if far else 1
    for wave in range(waves):
        s, n, q = scratch.floats[wave], scratch.integers[wave], scratch.counts[wave]
        _clear(s, q)
        for i in range(LANES):
            flying += _board(model, radius, s, n, q, i, start, order, queue, stop, until, limit, outcome)
        _cross(model, s, q, far)
    wave, met = 0, 0
    while flying > 0:
        s, n, q = scratch.floats[wave], scratch.integers[wave], scratch.counts[wave]
        wave = wave + 1 if wave + 1 < waves else 0
        _meet(model, radius, s, q)
        _decide(s, q, model.grid, radius)
        if far:
            _prefetch_cells(model, q)
            _prefetch_listed(model, radius, scratch.counts[wave])
        for k in range(_list_turning(q)):
            i = q[TURNING + k]
            before = n[BOUNCES + i]
            ending = _turn(model, radius, s, n, i, until, limit)
            scratch.met[met] = int(s[LAST + i])
            met += n[BOUNCES + i] - before
            if ending == RUNNING:
                _set_out(model, s, q, i, until)
                continue
            _store(radius, s, n, i, start, until, ending, outcome)
            flying += _board(model, radius, s, n, q, i, start, order, queue, stop, until, limit, outcome) - 1
        if met >= LANES:
            met = _count(model, scratch.met, met, hits)
        _cross(model, s, q, far)
    _count(model, scratch.met, met, hits)


@kernel
def _clear(s, q):
    """Empty a wave; without a ball a lane has a speed that nothing divides by 0 for."""
    for k in range(FLOATS):
        s[k] = 0.0
    for k in range(COUNTS):
        q[k] = 0
    for i in range(LANES):
        _set_energy(s, i, 1.0)


@kernel
def _count(model, met, count, hits):
    """Count bounces off features, many together, so that one does not wait for another's memory: 0 are left."""
    for k in range(count):
        feature = met[k]
        met[k] = model.edge_wall[feature] if feature >= 0 else model.corner_wall[-2 - feature]
    for k in range(count):
        hits[met[k]] += 1
    return 0


@kernel
def _prefetch_cells(model, q):
    """Ask memory for what balls need when they cross: it comes while others turn."""
    for i in range(LANES):
        prefetch(model.clearings, q[AT + i])
        prefetch(model.cells, q[AT + i] >> 2)


@kernel
def _prefetch_listed(model, radius, q):
    """Ask memory for all that the cells list which balls of another wave have entered."""
    for k in range(q[ENTERED]):
        i = q[ENTERING + k]
        for at in range(q[NEXT + i], q[ARCS + i]):
            prefetch(model.lines, model.ids[at])
        if radius is not None:
            for at in range(q[NEXT_CORNER + i], q[END + i]):
                prefetch(model.corners, model.ids[at])


@kernel
def _cross(model, s, q, far):
    """Let balls cross into clearings and cells."""
    entering = _list_entering(model, q)
    for k in range(entering):
        _enter(model, s, q, q[ENTERING + k])
    if far:
        q[ENTERED] = entering
        for k in range(entering):
            prefetch(model.ids, q[NEXT + q[ENTERING + k]])
    _border(s, q)


@kernel
def _meet(model, radius, s, q):
    """Let every ball look at the next line, arc or corner of its cell."""
    at_line, at_arc, at_corner = _list_looking(model.arcs, radius, q)
    if at_line > 0:
        _fetch_lines(model, radius, s, q, at_line)
        if radius is None:
            meet_lines_point(s, q)
        else:
            meet_lines_disc(s, q, radius)
    if at_arc > 0:
        _fetch_arcs(model, model.arcs, radius, s, q, at_arc)
        if radius is None:
            meet_arcs_point(s, q)
        else:
            meet_arcs_disc(s, q, radius)
    if at_corner > 0:
        if radius is not None:
            _fetch_corners(model, s, q, at_corner)
            meet_corners(s, q, radius)


@kernel
def _board(model, radius, s, n, q, i, start, order, queue, stop, until, limit, outcome):
    """Give a lane the next ball that flies at all, if there is one: 1 or 0."""
    while True:
        upcoming = next_ball(queue, stop)
        if upcoming == NO_BALL:
            break
        ball = order[upcoming]
        x, y = start.position[ball, 0] - start.origin[0], start.position[ball, 1] - start.origin[1]
        vx, vy = start.velocity[ball, 0], start.velocity[ball, 1]
        energy = vx * vx + vy * vy
        s[X + i], s[Y + i], s[VX + i], s[VY + i], s[TIME + i], s[LOST + i] = x, y, vx, vy, 0.0, 0.0
        s[FROM_X + i], s[FROM_Y + i], s[FROM_VX + i], s[FROM_VY + i] = x, y, vx, vy
        s[TOLERANCE + i] = tolerance_of(x, y, start.extent)
        s[LAST + i], n[BOUNCES + i], n[STILL + i], n[BALL + i] = NONE, 0, 0, ball
        if energy > 0.0 and limit > 0:
            s[FLIES + i] = 1.0
            _set_energy(s, i, energy)
            _set_out(model, s, q, i, until)
            return 1
        _store(radius, s, n, i, start, until, AT_REST if energy <= 0.0 else BOUNCE_LIMIT, outcome)
    s[FLIES + i], q[CROSSES + i] = 0.0, 0
    q[NEXT + i], q[NEXT_CORNER + i], q[ARCS + i], q[CORNERS + i], q[END + i] = 0, 0, 0, 0, 0
    return 0


@kernel
def _store(radius, s, n, i, start, until, ending, outcome):
    """Write where a ball has ended, flown on to the end time if that is why."""
    ball = n[BALL + i]
    x, y, vx, vy, time = s[X + i], s[Y + i], s[VX + i], s[VY + i], s[TIME + i] + s[LOST + i]
    if ending == TIME_REACHED and s[BEST + i] > 0.0:
        x, y, time = x + s[BEST + i] * vx, y + s[BEST + i] * vy, until
    x, y = x + start.origin[0], y + start.origin[1]
    outcome.position[ball, 0], outcome.position[ball, 1] = x, y
    outcome.velocity[ball, 0], outcome.velocity[ball, 1] = vx, vy
    outcome.time[ball] = time
    outcome.bounces[ball] = n[BOUNCES + i]
    gone = ending == TIME_REACHED and has_left(start.box, 0.0 if radius is None else radius, x, y, vx, vy)
    outcome.ending[ball] = LEFT_SCENE if gone else ending
