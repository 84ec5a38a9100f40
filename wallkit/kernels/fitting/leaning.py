"""Directions that lean, stretch by stretch; ``walls.importing.arc_fitting.joint_directions`` says why and how."""

from __future__ import annotations

import math

from wallkit.kernels.fitting.biarc_formulas import dot, larger, offset, turned_back
from wallkit.kernels.fitting.cubic_chains import curve_at, moved, place_in
from wallkit.kernels.jit import kernel

LOOKS = 9
"""Places of a span that are looked at."""


@kernel
def response(x):
    """How far a biarc of length 1 moves at x when it starts in a direction turned by 1."""
    return x - 1.5 * x * x if x < 0.5 else (1.0 - x) * (1.0 - x) / 2.0


@kernel
def deviate(chains, chain, low, high, p0, p1, arc, fractions, off, start, end):
    """Write how far a span is off, and how much farther by directions at start and end turned by 1: (LOOKS,) each."""
    control, offsets, shifts, starts, stops, _, _ = chains
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
        off[k] = offset(x, y, bend0 if x < 0.0 else bend1)
        part = ((x - begin.real) * way.real + (y - begin.imag) * way.imag) / divisor
        start[k], end[k] = -response(part) * size, response(1.0 - part) * size


@kernel
def sum_of(terms):
    """Sum 2 LOOKS terms as NumPy sums a row of 18: in eight columns, these in pairs, and the last two."""
    a = (terms[0] + terms[8]) + (terms[1] + terms[9])
    b = (terms[2] + terms[10]) + (terms[3] + terms[11])
    c = (terms[4] + terms[12]) + (terms[5] + terms[13])
    d = (terms[6] + terms[14]) + (terms[7] + terms[15])
    return (a + b) + (c + d) + terms[16] + terms[17]


@kernel
def evening(off, end, after, start, norm, stride, bows, slopes):
    """The angle at a cut that makes the larger deviation ``off + angle * response`` of two spans smaller."""
    largest = 0.0
    for k in range(LOOKS):
        largest = larger(largest, abs(off[k]))
    for k in range(LOOKS):
        largest = larger(largest, abs(after[k]))
    scale = largest if largest > 0.0 else 1.0
    for k in range(2 * LOOKS):
        value, moves = (off[k], end[k]) if k < LOOKS else (after[k - LOOKS], start[k - LOOKS])
        weighted = value / scale
        weighted = weighted * weighted
        fourth = weighted * weighted
        weighted = weighted * (fourth * fourth) * moves
        bows[k], slopes[k] = weighted * moves, weighted * value
    bow, slope = sum_of(bows), sum_of(slopes)
    step = -stride * slope / ((norm - 1.0) * bow) if bow > 0.0 else 0.0
    worst = 0.0
    for k in range(LOOKS):
        worst = larger(worst, abs(step * end[k] + off[k]))
    for k in range(LOOKS):
        worst = larger(worst, abs(step * start[k] + after[k]))
    return step / 5.0 if worst > largest else step


@kernel
def lean_all(chains, spans, arcs, fractions, sweeps, norm, stride, off, start, end, sums, angle):
    """Find the angles that directions at the ends of spans are turned by.

    Args:
        chains: of cubics.
        spans: chain, stretch, low, high, first and last point of each.
        arcs: of the spans.
        fractions: (LOOKS,) of a span, where to look.
        sweeps: how often each angle is made better.
        norm: see ``joint_directions``.
        stride: see ``joint_directions``.
        off: (n, LOOKS) for the work.
        start: (n, LOOKS) for the work.
        end: (n, LOOKS) for the work.
        sums: (2, 2 LOOKS) for the work.
        angle: (n,) 0 at first, written.
    """
    ids, stretch, low, high, p0, p1 = spans
    joint, along, bend0, bend1 = arcs
    for n in range(len(ids)):
        arc = (joint[n], along[n], bend0[n], bend1[n])
        deviate(chains, ids[n], low[n], high[n], p0[n], p1[n], arc, fractions, off[n], start[n], end[n])
    first = 0
    while first < len(ids):
        stop = first + 1
        while stop < len(ids) and stretch[stop] == stretch[first]:
            stop += 1
        for turn in range(2 * sweeps):
            for cut in range(first + turn % 2, stop - 1, 2):
                step = evening(off[cut], end[cut], off[cut + 1], start[cut + 1], norm, stride, sums[0], sums[1])
                for k in range(LOOKS):
                    off[cut, k] += end[cut, k] * step
                    off[cut + 1, k] += start[cut + 1, k] * step
                angle[cut] += step
        first = stop
