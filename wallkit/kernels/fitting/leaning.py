"""Directions that lean, stretch by stretch; ``walls.importing.arc_fitting.joint_directions`` says why and how."""

from __future__ import annotations

import math

from wallkit.kernels.fitting.biarc_formulas import biarc, dot, larger, length, offset, turned_back
from wallkit.kernels.fitting.cubic_chains import curve_at, moved, place_in, point_at
from wallkit.kernels.jit import kernel, pass_kernel

LOOKS = 9
"""Places of a span that are looked at."""


@kernel
def response(x):
    """How far a biarc of length 1 moves at x when it starts in a direction turned by 1."""
    return x - 1.5 * x * x if x < 0.5 else (1.0 - x) * (1.0 - x) / 2.0


@kernel
def deviate(chains, span, arc, fractions, off, start, end, at):
    """Write how far a span is off, and how much farther by directions at start and end turned by 1: a column each.

    Args:
        chains: of cubics.
        span: chain, low, high, first and last point.
        arc: its arcs.
        fractions: (LOOKS,) where to look.
        off: (LOOKS, m) written.
        start: (LOOKS, m) written.
        end: (LOOKS, m) written.
        at: the column.
    """
    control, offsets, shifts, starts, stops, _, _ = chains
    chain, low, high, p0, p1 = span
    joint, along, bend0, bend1 = arc
    chord = p1 - p0
    square = dot(chord, chord)
    divisor, size = square if square > 0.0 else 1.0, math.sqrt(square)
    begin, way = turned_back(p0 - joint, along), turned_back(chord, along)
    curve = curve_at(offsets, starts, chain, low + (high - low) * fractions[0])
    x_column, y_column = moved(control, curve, joint - shifts[curve], along)
    last = offsets[chain + 1] - 1
    for k in range(LOOKS):
        u = low + (high - low) * fractions[k]
        before = curve
        while curve < last and starts[curve + 1] <= u:
            curve += 1
        if curve != before:
            x_column, y_column = moved(control, curve, joint - shifts[curve], along)
        t = (u - starts[curve]) / (stops[curve] - starts[curve])
        x, y = place_in(x_column, t), place_in(y_column, t)
        off[k, at] = offset(x, y, bend0 if x < 0.0 else bend1)
        part = ((x - begin.real) * way.real + (y - begin.imag) * way.imag) / divisor
        start[k, at], end[k, at] = -response(part) * size, response(1.0 - part) * size


@pass_kernel
def raise_to_sizes(values, largest, count):
    """Raise numbers to the sizes of values."""
    for n in range(count):
        largest[n] = larger(largest[n], abs(values[n]))


@pass_kernel
def raise_to_moved(values, moves, step, largest, count):
    """Raise numbers to the sizes of ``values + step * moves``."""
    for n in range(count):
        largest[n] = larger(largest[n], abs(step[n] * moves[n] + values[n]))


@pass_kernel
def weigh(values, moves, largest, bows, slopes, count):
    """Write what values weigh in the sums for the bow of the norm and for its slope."""
    for n in range(count):
        weighted = values[n] / (largest[n] if largest[n] > 0.0 else 1.0)
        weighted = weighted * weighted
        fourth = weighted * weighted
        weighted = weighted * (fourth * fourth) * moves[n]
        bows[n], slopes[n] = weighted * moves[n], weighted * values[n]


@pass_kernel
def add_four(sums, a, b, c, d, count):
    """Write sums of four, in pairs."""
    for n in range(count):
        sums[n] = (a[n] + b[n]) + (c[n] + d[n])


@pass_kernel
def add_last(sums, a, b, c, d, e, f, count):
    """Write sums of six, as NumPy sums a row of 18 of which four are sums of four."""
    for n in range(count):
        sums[n] = (a[n] + b[n]) + (c[n] + d[n]) + e[n] + f[n]


@kernel
def sum_up(terms, four, total, count):
    """Sum 2 LOOKS rows as NumPy sums a row of 18: in eight columns, these in pairs, and the last two."""
    for k in range(4):
        add_four(four[k], terms[2 * k], terms[2 * k + 8], terms[2 * k + 1], terms[2 * k + 9], count)
    add_last(total, four[0], four[1], four[2], four[3], terms[16], terms[17], count)


@pass_kernel
def step_by(bow, slope, norm, stride, step, count):
    """Write the angles at which the norm is about smallest."""
    for n in range(count):
        some = bow[n] > 0.0
        step[n] = -stride * slope[n] / ((norm - 1.0) * (bow[n] if some else 1.0)) if some else 0.0


@pass_kernel
def shorten(after, largest, step, angle, count):
    """Shorten steps that make the largest deviation larger, and add them to the angles."""
    for n in range(count):
        step[n] = step[n] / 5.0 if after[n] > largest[n] else step[n]
        angle[n] += step[n]


@pass_kernel
def follow(values, moves, step, count):
    """Add what steps move."""
    for n in range(count):
        values[n] += moves[n] * step[n]


@kernel
def even(before, after, shift, norm, stride, angle, room, count):
    """Turn the directions at cuts so that the largest deviation of the two spans at each gets smaller.

    Args:
        before: (LOOKS, m) how far the spans before the cuts are off, and how much farther by a turn.
        after: the same of the spans after them.
        shift: the column of the first of these.
        norm: see ``joint_directions``.
        stride: see ``joint_directions``.
        angle: (m,) of the cuts, written.
        room: for the work: (2, 2 LOOKS, m), (4, m) and (5, m).
        count: of the cuts.
    """
    off, ends = before
    next_off, starts = after
    terms, four, rows = room
    largest, bow, slope, step, size = rows[0], rows[1], rows[2], rows[3], rows[4]
    for n in range(count):
        largest[n], size[n] = 0.0, 0.0
    for k in range(LOOKS):
        raise_to_sizes(off[k], largest, count)
        raise_to_sizes(next_off[k][shift:], largest, count)
    for k in range(LOOKS):
        weigh(off[k], ends[k], largest, terms[0, k], terms[1, k], count)
        weigh(next_off[k][shift:], starts[k][shift:], largest, terms[0, LOOKS + k], terms[1, LOOKS + k], count)
    sum_up(terms[0], four, bow, count)
    sum_up(terms[1], four, slope, count)
    step_by(bow, slope, norm, stride, step, count)
    for k in range(LOOKS):
        raise_to_moved(off[k], ends[k], step, size, count)
        raise_to_moved(next_off[k][shift:], starts[k][shift:], step, size, count)
    shorten(size, largest, step, angle, count)
    for k in range(LOOKS):
        follow(off[k], ends[k], step, count)
        follow(next_off[k][shift:], starts[k][shift:], step, count)


@kernel
def turned(direction, angle, most):
    """Turn a direction by an angle, by ``most`` at most: Taylor's series, to 1e-20 for angles as small as these."""
    x = -most if angle < -most else (most if angle > most else angle)
    square = x * x
    cos = 1 - square / 2 * (1 - square / 12 * (1 - square / 30 * (1 - square / 56)))
    sin = x * (1 - square / 6 * (1 - square / 20 * (1 - square / 42 * (1 - square / 72))))
    return cos * direction + sin * (1j * direction)


@kernel
def rate_of(spans, n, limit, straight):
    """Give -k' h^2 / 48 of a span by the curvatures of its arcs, which differ by 2 k' h / 3."""
    _, _, _, _, p0, p1, t0, t1 = spans
    _, _, bend0, bend1, _, _, single, sound = biarc(p0[n], p1[n], t0[n], t1[n], limit, straight)
    return (bend0 - bend1) * length(p1[n] - p0[n]) / 32.0 if sound and not single else 0.0


@kernel
def end_of(stretch, first):
    """Where the stretch of a span ends."""
    stop = first + 1
    while stop < len(stretch) and stretch[stop] == stretch[first]:
        stop += 1
    return stop


@kernel
def begin_leaning(chains, spans, first, stop, arc_limits, rates):
    """Turn the directions at the cuts of a stretch by the rates of the curvature."""
    ids, _, _, high, _, _, t0, t1 = spans
    limit, straight, most = arc_limits
    for cut in range(first, stop - 1):
        _, direction = point_at(chains, ids[cut], high[cut])
        t0[cut + 1] = direction
        t1[cut] = direction
    for n in range(first, stop):
        rates[n - first] = rate_of(spans, n, limit, straight)
    for cut in range(first, stop - 1):
        direction = turned(t1[cut], (rates[cut - first] + rates[cut + 1 - first]) / 2.0, most)
        t0[cut + 1] = direction
        t1[cut] = direction


@kernel
def measure_all(chains, spans, first, stop, arc_limits, fractions, halves, column):
    """Write how far the spans of a stretch are off, in columns from an even one on; the two ends do not turn."""
    ids, _, low, high, p0, p1, t0, t1 = spans
    limit, straight, _ = arc_limits
    for n in range(first, stop):
        joint, along, bend0, bend1, _, _, _, _ = biarc(p0[n], p1[n], t0[n], t1[n], limit, straight)
        place, at = halves[(column + n - first) % 2], (column + n - first) // 2
        span, arc = (ids[n], low[n], high[n], p0[n], p1[n]), (joint, along, bend0, bend1)
        deviate(chains, span, arc, fractions, place[0], place[1], place[2], at)
    for k in range(LOOKS):
        halves[0, 1, k, column // 2] = 0.0
        halves[(column + stop - first - 1) % 2, 2, k, (column + stop - first - 1) // 2] = 0.0


@kernel
def lean_some(chains, spans, first, room, arc_limits, fractions, search, work):
    """Turn the directions at the cuts of stretches from span ``first`` on, as many as fit; return the next span."""
    halves, angle, rates, even_room = work
    sweeps, norm, stride = search
    stretch, t0, t1 = spans[1], spans[6], spans[7]
    n, column = first, 0
    while n < len(stretch):
        stop = end_of(stretch, n)
        if stop - n > 1:
            if (column > 0) & (column + stop - n > room):
                break
            begin_leaning(chains, spans, n, stop, arc_limits, rates)
            measure_all(chains, spans, n, stop, arc_limits, fractions, halves, column)
            column += stop - n
            if column % 2 == 1:  # a place that nothing moves
                for k in range(LOOKS):
                    for which in range(3):
                        halves[1, which, k, column // 2] = 0.0
                column += 1
        n = stop
    count = column // 2
    for cut in range(count):
        angle[0, cut], angle[1, cut] = 0.0, 0.0
    even_halves, odd_halves = (halves[0, 0], halves[0, 1], halves[0, 2]), (halves[1, 0], halves[1, 1], halves[1, 2])
    for _ in range(sweeps):
        off, start, end = even_halves
        odd_off, odd_start, odd_end = odd_halves
        even((off, end), (odd_off, odd_start), 0, norm, stride, angle[0], even_room, count)
        even((odd_off, odd_end), (off, start), 1, norm, stride, angle[1], even_room, count - 1)
    column = 0
    for cut in range(first, n - 1):
        if stretch[cut] == stretch[cut + 1]:
            direction = turned(t1[cut], angle[column % 2, column // 2], arc_limits[2])
            t0[cut + 1] = direction
            t1[cut] = direction
            column += 1
        elif cut > first and stretch[cut - 1] == stretch[cut]:
            column += 1 + (column + 1) % 2
    return n


@kernel
def lean_all(chains, spans, arc_limits, fractions, search, work):
    """Turn the directions at the cuts inside of stretches.

    Args:
        chains: of cubics.
        spans: chain, stretch, low, high, first and last point of each, and the directions there, which are written.
        arc_limits: limit and straight of ``biarc_formulas.biarc``, and the largest angle of a turn.
        fractions: (LOOKS,) of a span, where to look.
        search: how often each angle is made better, norm and stride, see ``joint_directions``.
        work: for spans with even and odd numbers, (2, 3, LOOKS, m), how far they are off and what turns at their starts
            and ends add, twice m no less than the longest stretch and one; (2, m); one number for each span of the
            longest stretch; what :func:`even` works in.
    """
    first = 0
    while first < len(spans[0]):
        first = lean_some(chains, spans, first, 2 * work[0].shape[3], arc_limits, fractions, search, work)
