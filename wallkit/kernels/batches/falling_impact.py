"""Times of impact for a falling wave: all pairs of a ball and a line that its cell lists; arcs and corners one by one.

The formulas are those of ``gravity_impact.fall_line``, term by term, with selects in place of branches. The last pairs
are made up to whole vectors with others whose result is dropped.
"""

from __future__ import annotations

import math

from wallkit.kernels.batches.falling_columns import (
    ARCS,
    ASKS_LINE,
    AX,
    AY,
    BEST,
    CORNERS,
    END,
    FALLERS,
    FEATURE,
    FROM_VX,
    FROM_VY,
    FROM_X,
    FROM_Y,
    ID,
    IDS,
    LAST,
    LATER_T,
    LENGTH,
    LINE_NUMBERS,
    NEXT,
    NOW,
    NX,
    NY,
    SKIPPED,
    THEN,
    TOLERANCE,
    TOUCHED,
    T,
)
from wallkit.kernels.batches.wave_columns import NONE, PAIRS, PER_TURN
from wallkit.kernels.batches.wave_pairs import one_way, part
from wallkit.kernels.flight.guide import guide
from wallkit.kernels.impact.arc_fall import fall_arcs
from wallkit.kernels.impact.gravity_impact import fall_corners, fall_line
from wallkit.kernels.impact.leaving import LEVEL_SPEED
from wallkit.kernels.impact.line_impact import slack_of
from wallkit.kernels.impact.polynomial_roots import NEVER, fall_after_rise, first_fall_quadratic
from wallkit.kernels.intrinsics import AT_ONCE, fetch, lowest, pair_up
from wallkit.kernels.jit import kernel, rare_kernel
from wallkit.kernels.records import COUNT, LEFT


@kernel
def meet_falling(model, gravity, radius, scratch, listed):
    """Let every ball in a cell that lists something ask that."""
    f, s, q, pairs = scratch.fallers, scratch.floats, scratch.counts, scratch.pairs
    lines, asking = 0, listed
    while asking > 0:
        i = lowest(asking)
        asking &= asking - 1
        pair_up(model.ids, int(q[NEXT + i]), i, pairs, IDS + lines, FALLERS + lines)
        count = int(q[ARCS + i]) - int(q[NEXT + i])
        lines += count if count < PER_TURN else PER_TURN
        if count > PER_TURN:
            _ask_lines(model, gravity, radius, f, s, model.ids, int(q[NEXT + i]) + PER_TURN, int(q[ARCS + i]), i)
    pair_up(model.ids, len(model.ids) - AT_ONCE, 0, pairs, IDS + lines, FALLERS + lines)
    for first in range(0, lines, PAIRS):
        padded, real = part(lines - first)
        for i in range(0, padded, AT_ONCE):
            fetch(f, pairs, FALLERS + first + i, s, i, ASKS_LINE)
            fetch(model.lines, pairs, IDS + first + i, s, i, LINE_NUMBERS)
        met, beside, touched, asked = _meet_lines(gravity, radius, s, padded)
        _touch(s, pairs, FALLERS + first, touched & real)
        alone = one_way(model, model.one_sided, pairs, IDS + first, asked & real)
        _keep(s, pairs, FALLERS + first, met, (met | beside) & real & ~alone)
        while alone > 0:
            j = lowest(alone)
            alone &= alone - 1
            at = IDS + first + j
            _ask_lines(model, gravity, radius, f, s, pairs, at, at + 1, int(pairs[FALLERS + first + j]))
    if model.arcs is not None or radius is not None:
        asking = listed
        while asking > 0:
            i = lowest(asking)
            asking &= asking - 1
            if q[ARCS + i] < q[END + i]:
                _ask_others(model, model.arcs, gravity, radius, scratch, i)


@kernel
def _meet_lines(gravity, radius, s, padded):
    """Let every ball ask its line.

    Returns:
        The bits of those that meet the near side, that may meet the far one, that touch it where they start, and that
        do not skip it.
    """
    gx, gy = gravity[0], gravity[1]
    r = 0.0 if radius is None else radius
    meeting, beside, touching, asking = 0, 0, 0, 0
    for i in range(padded):
        vx, vy, tolerance = s[FROM_VX + i], s[FROM_VY + i], s[TOLERANCE + i]
        nx, ny, length, slack = s[NX + i], s[NY + i], s[LENGTH + i], slack_of(s[TOLERANCE + i], r)
        ex, ey = s[FROM_X + i] - s[AX + i], s[FROM_Y + i] - s[AY + i]
        # Across the edge the centre is at d + vn t + gn t^2 / 2, along it at u + vu t + gu t^2 / 2.
        d, vn, gn = ex * nx + ey * ny, vx * nx + vy * ny, gx * nx + gy * ny
        u, vu, gu = ey * nx - ex * ny, vy * nx - vx * ny, gy * nx - gx * ny
        above, asked = d > 0.0, s[SKIPPED + i] != s[ID + i]
        if radius is None:
            near = (abs(d) <= tolerance) & (u >= -tolerance) & (u <= length + tolerance)
            touching |= int(near & asked & (s[LAST + i] != s[ID + i])) << i
            leaves = vn > 0.0 if abs(vn) > LEVEL_SPEED * (abs(vx) + abs(vy)) else gn < 0.0
            above = leaves if near else above
        side = 1.0 if above else -1.0
        t = first_fall_quadratic(0.5 * (side * gn), side * vn, side * d - r, math.inf)
        foot = u + t * (vu + 0.5 * t * gu)
        s[T + i] = t
        meeting |= int(asked & (foot >= -slack) & (foot <= length + slack)) << i
        # The gap to the far side rises as the ball comes through, and falls later.
        t = fall_after_rise(-0.5 * side * gn, -side * vn, -side * d - r)
        foot = u + t * (vu + 0.5 * t * gu)
        s[LATER_T + i] = t
        beside |= int(asked & (foot >= -slack) & (foot <= length + slack)) << i
        asking |= int(asked) << i
    return meeting, beside, touching, asking


@kernel
def _keep(s, pairs, first, met, left):
    """Let balls keep the soonest of the contacts found: at equal times as ``line_impact.precedes`` says."""
    while left > 0:
        j = lowest(left)
        left &= left - 1
        i = pairs[first + j]
        best, feature, near, number = s[BEST + i], s[FEATURE + i], s[T + j], s[ID + j]
        # Where the near side is not met in time, nor beside the edge, the ball has not come through to the far one.
        t = near if (met >> j) & 1 != 0 else (s[LATER_T + j] if near <= best else NEVER)
        # Edges go by number, and before corners.
        first_of_equals = (feature != NONE) & ((feature < 0.0) | (number < feature))
        sooner = (t < best) | ((t == best) & first_of_equals)
        s[BEST + i] = t if sooner else best
        s[FEATURE + i] = number if sooner else feature


@kernel
def _touch(s, pairs, first, touching):
    """Count the lines that points touch where they start."""
    while touching > 0:
        i = pairs[first + lowest(touching)]
        touching &= touching - 1
        s[TOUCHED + i] += 1.0 if s[NOW + i] == 0.0 else 0.0


@rare_kernel
def _ask_lines(model, gravity, radius, f, s, ids, first, stop, i):
    """Let a ball ask lines alone, by the kernel of single balls, which knows all that a pass leaves out."""
    faller, feature = f[i], int(s[FEATURE + i])
    size = 0.0 if radius is None else radius
    s[BEST + i], feature, touched = fall_line(
        model.lines, ids, first, stop, model.one_sided, model.edge_wall, size, faller.x, faller.y, faller.vx, faller.vy,
        gravity[0], gravity[1], None, NEVER, int(faller.last), int(faller.skipped), faller.tolerance, s[NOW + i],
        s[THEN + i], s[BEST + i], feature,
    )  # fmt: skip
    s[FEATURE + i] = float(feature)
    s[TOUCHED + i] += float(touched) if s[NOW + i] == 0.0 else 0.0


@kernel
def _ask_others(model, arcs, gravity, radius, scratch, i):
    """Let a ball ask the arcs and corners that its cell lists."""
    f, s, q = scratch.fallers, scratch.floats, scratch.counts
    faller, feature, last = f[i], int(s[FEATURE + i]), int(f[i].last)
    size = 0.0 if radius is None else radius
    if arcs is not None:
        if q[ARCS + i] < q[CORNERS + i]:
            counts = scratch.tallies[i]
            reference = _reference(model, arcs, size, faller, counts)
            s[BEST + i], feature, touched = fall_arcs(
                arcs, model.ids, q[ARCS + i], q[CORNERS + i], model.one_sided, model.edge_wall, size,
                faller.x, faller.y, faller.vx, faller.vy, gravity[0], gravity[1], None, NEVER, last,
                int(faller.skipped), faller.tolerance, reference, s[NOW + i], s[THEN + i], s[BEST + i], feature,
            )  # fmt: skip
            s[TOUCHED + i] += float(touched) if s[NOW + i] == 0.0 else 0.0
    if radius is not None:
        if q[CORNERS + i] < q[END + i]:
            s[BEST + i], feature = fall_corners(
                model.corners, model.ids, q[CORNERS + i], q[END + i], model.one_sided, model.corner_wall, model.fans,
                radius, faller.x, faller.y, faller.vx, faller.vy, gravity[0], gravity[1], None, NEVER, last,
                faller.tolerance, s[NOW + i], s[THEN + i], s[BEST + i], feature,
            )  # fmt: skip
    s[FEATURE + i] = float(feature)


@kernel
def _reference(model, arcs, radius, faller, counts):
    """Normal of what a ball has just left along it, towards the ball; else (0, 0)."""
    if counts[COUNT.hold] != LEFT:
        return 0.0, 0.0
    _rho, _away, nx, ny = guide(model, arcs, counts[COUNT.held], float(counts[COUNT.side]), radius, faller.x, faller.y)
    return nx, ny
