"""Chains of cubics: where their points are, and how far spans of them are from their arcs; see ``arc_fitting``.

Chains are tuples ``(control, offsets, shifts, starts, stops, headings, leavings)`` as in ``smooth_chains.Chains``, with
the control points (n, 4) of ``curves.Cubics``. Arcs are tuples (joints, directions there, curvatures, curvatures).
"""

from __future__ import annotations

from wallkit.kernels.fitting.biarc_formulas import biarc, half_tangent, larger, offset, turned_back, unit
from wallkit.kernels.jit import kernel

PLACES = 19
"""Where a close look looks: at k / 18."""


@kernel
def curve_at(offsets, starts, chain, u):
    """The last curve of a chain that starts at u or before, by bisection."""
    low, high = offsets[chain], offsets[chain + 1] - 1
    while low < high:
        middle = (low + high + 1) // 2
        if starts[middle] <= u:
            low = middle
        else:
            high = middle - 1
    return low


@kernel
def point_at(chains, chain, u):
    """Give the point of a chain at ``u`` and the direction there, as ``Chains.at`` does."""
    control, offsets, shifts, starts, stops, headings, _ = chains
    curve = curve_at(offsets, starts, chain, u)
    t = (u - starts[curve]) / (stops[curve] - starts[curve])
    p0, p1, p2, p3 = control[curve, 0], control[curve, 1], control[curve, 2], control[curve, 3]
    c = 3 * p1
    b = 3 * (p2 - 2 * p1)
    a = p3 - c - b
    place = shifts[curve] + complex(((a.real * t + b.real) * t + c.real) * t, ((a.imag * t + b.imag) * t + c.imag) * t)
    if t == 0.0:
        return place, headings[curve]
    first, second, third = 3 * (p1 - p0), 3 * (p2 - p1), 3 * (p3 - p2)
    s, double, square = 1.0 - t, 2.0 * t, t * t
    direction = unit(
        complex(
            (first.real * s + second.real * double) * s + third.real * square,
            (first.imag * s + second.imag * double) * s + third.imag * square,
        )
    )
    return place, direction


@kernel
def points_at(chains, ids, u, places, directions):
    """Points and directions of chains ``ids`` at ``u``; both are written."""
    for n in range(len(ids)):
        places[n], directions[n] = point_at(chains, ids[n], u[n])


@kernel
def columns(start, p1, p2, p3):
    """Coefficients of 1, t, t^2 and t^3, and the three control points of the derivative, in one coordinate."""
    c, b = 3.0 * p1, 3.0 * (p2 - 2.0 * p1)
    return start, c, b, p3 - c - b, c, 3.0 * (p2 - p1), 3.0 * (p3 - p2)


@kernel
def moved(control, curve, origin, along):
    """Columns of a cubic in axes at ``origin``, the x axis ``along``: those of x and those of y."""
    p1, p2 = turned_back(control[curve, 1], along), turned_back(control[curve, 2], along)
    p3, start = turned_back(control[curve, 3], along), -turned_back(origin, along)
    return columns(start.real, p1.real, p2.real, p3.real), columns(start.imag, p1.imag, p2.imag, p3.imag)


@kernel
def place_in(column, t):
    """One coordinate of a point."""
    return ((column[3] * t + column[2]) * t + column[1]) * t + column[0]


@kernel
def velocity_in(column, t):
    """One coordinate of the derivative."""
    s = 1.0 - t
    return (column[4] * s + column[5] * (2.0 * t)) * s + column[6] * (t * t)


@kernel
def off_and_turn(x_column, y_column, bend0, bend1, t):
    """Signed distance at t, and the tangent of half the angle between directions; see ``biarcs.Ruler``."""
    x, y = place_in(x_column, t), place_in(y_column, t)
    vx, vy = velocity_in(x_column, t), velocity_in(y_column, t)
    bend = bend0 if x < 0.0 else bend1
    fx, fy = 1.0 - y * bend, bend * x
    return offset(x, y, bend), half_tangent(fx * vy - fy * vx, vx * fx + vy * fy)


@kernel
def last_curve(offsets, starts, chain, low, high):
    """The last curve that a span from ``low`` to ``high`` has a part of."""
    curve = curve_at(offsets, starts, chain, high)
    return curve - 1 if (starts[curve] == high) & (curve > curve_at(offsets, starts, chain, low)) else curve


@kernel
def part_of(starts, stops, curve, low, high):
    """Parameters of a curve where a span of its chain begins and ends in it."""
    start, stop = starts[curve], stops[curve]
    return (max(low, start) - start) / (stop - start), (min(high, stop) - start) / (stop - start)


@kernel
def joined(chains, spans, n, limits, straight):
    """Join a span by arcs, see :func:`look`: (its first and last curve, joint, direction there, curvatures, sound)."""
    _, offsets, _, starts, stops, _, _ = chains
    ids, lows, highs, p0, p1, t0, t1 = spans
    chain, low, high = ids[n], lows[n], highs[n]
    first, last = curve_at(offsets, starts, chain, low), last_curve(offsets, starts, chain, low, high)
    alone = (offsets[chain + 1] - offsets[chain] == 1) & (low == 0.0) & (high == stops[first])
    limit = limits[1] if alone else limits[0]
    joint, along, bend0, bend1, _, _, _, sound = biarc(p0[n], p1[n], t0[n], t1[n], limit, straight)
    return first, last, joint, along, bend0, bend1, sound


@kernel
def measure_between(x_column, y_column, bend0, bend1, low, high, fractions, work):
    """Write distance and turn of a curve from arcs, at fractions of what is between two of its parameters."""
    for k in range(len(fractions)):
        t = low + (high - low) * fractions[k]
        off, work[1, k] = off_and_turn(x_column, y_column, bend0, bend1, t)
        work[0, k] = abs(off)


@kernel
def look(chains, spans, limits, straight, fractions, work, distance, turn, sound):
    """Join spans by arcs and measure these: at fixed fractions of the part of a span that is in one curve.

    Args:
        chains: of cubics.
        spans: chain, low, high, first and last point, and the directions there of each.
        limits: directions equal within the first make two arcs one; within the second where a curve is all of its
            chain and of the span.
        straight: see ``biarc_formulas.biarc``.
        fractions: where.
        work: (2, as many) for the work.
        distance: (n,) the largest, written.
        turn: (n,) the largest, see ``biarcs.measure``; written.
        sound: (n,) whether the arcs are; written.
    """
    control, _, shifts, starts, stops, _, _ = chains
    _, lows, highs, _, _, _, _ = spans
    for n in range(len(lows)):
        low, high = lows[n], highs[n]
        first, last, joint, along, bend0, bend1, fine = joined(chains, spans, n, limits, straight)
        most, widest = 0.0, 0.0
        for curve in range(first, last + 1):
            begin, end = part_of(starts, stops, curve, low, high)
            x_column, y_column = moved(control, curve, joint - shifts[curve], along)
            measure_between(x_column, y_column, bend0, bend1, begin, end, fractions, work)
            for k in range(len(fractions)):
                most, widest = larger(most, work[0, k]), larger(widest, work[1, k])
        distance[n], turn[n], sound[n] = most, widest, fine


@kernel
def peak_of(values):
    """Give where the largest of PLACES values is, at most one from an end, and the value."""
    most, at = values[0], 0
    for k in range(1, PLACES):
        if values[k] > most:
            most, at = values[k], k
        elif values[k] != values[k]:
            most, at = values[k], 0
            break
    return most, min(max(at, 1), PLACES - 2)


@kernel
def count_sections(chains, ids, lows, highs, counts):
    """Write in how many curves each span has a part."""
    _, offsets, _, starts, _, _, _ = chains
    for n in range(len(ids)):
        first = curve_at(offsets, starts, ids[n], lows[n])
        counts[n] = last_curve(offsets, starts, ids[n], lows[n], highs[n]) - first + 1


@kernel
def look_closely(chains, spans, limits, straight, fractions, margin, work, arcs, sections, seen):
    """Join spans by arcs and measure their sections at PLACES places.

    Args:
        chains: of cubics.
        spans: as :func:`look` takes them.
        limits: see there.
        straight: see there.
        fractions: where, PLACES of them, from ``margin`` of a section away from the ends of its span.
        margin: so much.
        work: (2, PLACES) for the work.
        arcs: joint, direction there and both curvatures of each span, written, and whether they are sound.
        sections: span, curve, low and high of each section, and low and high of where to look, written.
        seen: (2, m) of largest distances and turns; (2, m) where these are, one of the fractions but the first and the
            last; (2, 3, m) the values before, there and after; written.
    """
    control, _, shifts, starts, stops, _, _ = chains
    _, lows, highs, _, _, _, _ = spans
    joints, alongs, bends0, bends1, sounds = arcs
    rows, curves, begins, ends, first_looks, last_looks = sections
    largest, at, around = seen
    section = 0
    for n in range(len(lows)):
        low, high = lows[n], highs[n]
        first, last, joint, along, bend0, bend1, fine = joined(chains, spans, n, limits, straight)
        joints[n], alongs[n], bends0[n], bends1[n], sounds[n] = joint, along, bend0, bend1, fine
        for curve in range(first, last + 1):
            begin, end = part_of(starts, stops, curve, low, high)
            away = (end - begin) * margin
            low_look, high_look = begin + (away if curve == first else 0.0), end - (away if curve == last else 0.0)
            x_column, y_column = moved(control, curve, joint - shifts[curve], along)
            measure_between(x_column, y_column, bend0, bend1, low_look, high_look, fractions, work)
            for which in range(2):
                largest[which, section], at[which, section] = peak_of(work[which])
                for step in range(3):
                    around[which, step, section] = work[which, at[which, section] - 1 + step]
            rows[section], curves[section], begins[section], ends[section] = n, curve, begin, end
            first_looks[section], last_looks[section] = low_look, high_look
            section += 1


@kernel
def look_again(control, shifts, sections, arcs, places, worst):
    """Raise the largest distance and turn of sections by those at one more place each.

    Args:
        control: of the curves.
        shifts: of the curves.
        sections: the span of each, its curve, low and high.
        arcs: of the spans.
        places: (2, n) parameters, for the distance and for the turn.
        worst: (2, n) raised.
    """
    rows, curves, _, _ = sections
    joint, along, bend0, bend1 = arcs
    for n in range(len(rows)):
        span, curve = rows[n], curves[n]
        x_column, y_column = moved(control, curve, joint[span] - shifts[curve], along[span])
        off, _ = off_and_turn(x_column, y_column, bend0[span], bend1[span], places[0, n])
        _, angle = off_and_turn(x_column, y_column, bend0[span], bend1[span], places[1, n])
        worst[0, n], worst[1, n] = larger(worst[0, n], abs(off)), larger(worst[1, n], angle)
