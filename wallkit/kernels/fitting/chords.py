"""Chords of cubics: where a cubic is cut so that lines are near enough, and how far they are off.

``walls.importing.curves_to_lines`` says why cuts lie where they do; the same is written there for NumPy, operation by
operation, and gives the same bits. Lengths are ``np.hypot`` in both: ``math.hypot`` of Python rounds otherwise.
"""

from __future__ import annotations

import math

import numpy as np

from wallkit.kernels.jit import kernel
from wallkit.kernels.ordering import put_in_order

DEEPEST = 40
"""Halvings: t is then below 1e-12, and rounding, not the curve, is what is left."""


@kernel
def height_at(t, d1, d2):
    """Absolute value of 3 t (1 - t) ((1 - t) d1 + t d2) where t is inside of 0 to 1; else 0."""
    return abs(3 * t * (1 - t) * ((1 - t) * d1 + t * d2)) if (t > 0) & (t < 1) else 0.0


@kernel
def extremes(d1, d2):
    """Where 3 t (1 - t) ((1 - t) d1 + t d2) is extreme, see ``geometry.cubics``; 0 for what is no number."""
    a, b, c = 3 * (d1 - d2), d2 - 2 * d1, d1
    under = b * b - a * c
    q = -(b + math.copysign(math.sqrt(under if under > 0.0 else 0.0), b))
    return q / a if a != 0.0 else 0.0, c / q if q != 0.0 else 0.0


@kernel
def past(along, length):
    """How far beyond an end of the chord an arm reaches."""
    return max(max(-along, along - length), 0.0)


@kernel
def chord_bound(xs, ys):
    """Bound the distance between a cubic and its chord, see ``geometry.cubics``: from its coordinates."""
    x, y = xs[3] - xs[0], ys[3] - ys[0]
    u1, v1, u2, v2 = xs[1] - xs[0], ys[1] - ys[0], xs[2] - xs[0], ys[2] - ys[0]
    length = np.hypot(x, y)
    if not length > 0.0:
        return 0.75 * max(np.hypot(u1, v1), np.hypot(u2, v2))
    d1, d2 = (x * v1 - y * u1) / length, (x * v2 - y * u2) / length
    beyond1, beyond2 = past((x * u1 + y * v1) / length, length), past((x * u2 + y * v2) / length, length)
    if (beyond1 != 0.0) | (beyond2 != 0.0):
        return 0.75 * max(np.hypot(d1, beyond1), np.hypot(d2, beyond2))
    one, two = extremes(d1, d2)
    return max(height_at(one, d1, d2), height_at(two, d1, d2))


@kernel
def coordinates(cubics, n, axis):
    """Give one coordinate of the four control points."""
    return cubics[n, 0, axis], cubics[n, 1, axis], cubics[n, 2, axis], cubics[n, 3, axis]


@kernel
def halves(p):
    """Cut at the middle by de Casteljau, in one coordinate: the two halves."""
    a, b, c = p[0] + (p[1] - p[0]) * 0.5, p[1] + (p[2] - p[1]) * 0.5, p[2] + (p[3] - p[2]) * 0.5
    d, e = a + (b - a) * 0.5, b + (c - b) * 0.5
    middle = d + (e - d) * 0.5
    return (p[0], a, d, middle), (middle, e, c, p[3])


@kernel
def halved(cubics, n, tolerance, most, waiting, out, at):
    """Halve a cubic until the bound holds for each piece, or DEEPEST times.

    Halves that wait are on a stack, the first one along the curve on top. Each is a right half, so it begins at a cut,
    and they are taken from there in the order of the cuts.

    Args:
        cubics: (n, 4, 2).
        n: which.
        tolerance: the bound.
        most: it stops at more cuts than that.
        waiting: (DEEPEST, 11) for the stack.
        out: where the cuts are written, rising; None to count them.
        at: the first one's place there.

    Returns:
        How many cuts there are.
    """
    xs, ys, low, width, depth = coordinates(cubics, n, 0), coordinates(cubics, n, 1), 0.0, 1.0, 0.0
    height = count = 0
    while count <= most:
        if (depth < DEEPEST) & (chord_bound(xs, ys) > tolerance):
            xs, right_xs = halves(xs)
            ys, right_ys = halves(ys)
            depth, width, count = depth + 1.0, width / 2, count + 1
            row = waiting[height]
            row[0], row[1], row[2], row[3] = right_xs
            row[4], row[5], row[6], row[7] = right_ys
            row[8], row[9], row[10] = low + width, width, depth
            height += 1
            continue
        if height == 0:
            break
        height -= 1
        row = waiting[height]
        xs, ys = (row[0], row[1], row[2], row[3]), (row[4], row[5], row[6], row[7])
        low, width, depth = row[8], row[9], row[10]
        if out is not None:
            out[at] = low
            at += 1
    return count


@kernel
def count_halvings(cubics, tolerance, most, waiting, counts):
    """Write how many cuts halving takes for each cubic, and return all of them; it stops where they are above most."""
    total = 0
    for n in range(len(cubics)):
        counts[n] = halved(cubics, n, tolerance, most - total, waiting, None, 0)
        total += counts[n]
        if total > most:
            break
    return total


@kernel
def share_out(cubics, n, t, share):
    """Write the running integral of the density of cuts over a cubic at parameters ``t``: see ``curves_to_lines``."""
    xs, ys = coordinates(cubics, n, 0), coordinates(cubics, n, 1)
    dx0, dx1, dx2 = 3 * (xs[1] - xs[0]), 3 * (xs[2] - xs[1]), 3 * (xs[3] - xs[2])
    dy0, dy1, dy2 = 3 * (ys[1] - ys[0]), 3 * (ys[2] - ys[1]), 3 * (ys[3] - ys[2])
    ddx0, ddx1, ddy0, ddy1 = 2 * (dx1 - dx0), 2 * (dx2 - dx1), 2 * (dy1 - dy0), 2 * (dy2 - dy1)
    last, densest = len(t) - 1, 0.0
    for k in range(last):
        m = (t[k + 1] + t[k]) / 2
        s = 1 - m
        fx, fy = dx0 * (s * s) + 2 * dx1 * s * m + dx2 * (m * m), dy0 * (s * s) + 2 * dy1 * s * m + dy2 * (m * m)
        sx, sy = ddx0 * s + ddx1 * m, ddy0 * s + ddy1 * m
        speed = np.hypot(fx, fy)
        density = math.sqrt(abs(fx * sy - fy * sx) / speed) if speed > 0.0 else 0.0
        share[k + 1] = density
        densest = max(densest, density)
    running, least = 0.0, 1e-3 * densest  # so that the integral rises everywhere
    share[0] = 0.0
    for k in range(last):
        running += share[k + 1] + least
        share[k + 1] = running / last


@kernel
def part_at(t, share, wanted, moved):
    """Parameter at which the integral is ``wanted``; it is looked up after ``moved`` was added, as NumPy's rows are."""
    low, high = 0, len(t) - 1
    if share[high] + moved <= wanted + moved:
        low = high
    while high - low > 1:
        middle = (low + high) // 2
        if share[middle] + moved <= wanted + moved:
            low = middle
        else:
            high = middle
    low = min(low, len(t) - 2)
    part = (wanted - share[low]) / max(share[low + 1] - share[low], 1e-300)
    return t[low] + min(max(part, 0.0), 1.0) * (t[1] - t[0])


@kernel
def blossom(q0, q1, q2, b, c):
    """Two more steps of the blossom of a cubic."""
    r0, r1 = q0 + (q1 - q0) * b, q1 + (q2 - q1) * b
    return r0 + (r1 - r0) * c


@kernel
def between(p, low, high):
    """The piece of a cubic from t = low to t = high, in one coordinate."""
    a0, a1, a2 = p[0] + (p[1] - p[0]) * low, p[1] + (p[2] - p[1]) * low, p[2] + (p[3] - p[2]) * low
    b0, b1, b2 = p[0] + (p[1] - p[0]) * high, p[1] + (p[2] - p[1]) * high, p[2] + (p[3] - p[2]) * high
    return (
        blossom(a0, a1, a2, low, low),
        blossom(a0, a1, a2, low, high),
        blossom(a0, a1, a2, high, high),
        blossom(b0, b1, b2, high, high),
    )


@kernel
def passes(cubics, n, cuts, first, count, tolerance):
    """Tell whether the bound holds for each of ``count`` pieces between cuts."""
    xs, ys = coordinates(cubics, n, 0), coordinates(cubics, n, 1)
    low = 0.0
    for k in range(count):
        high = cuts[first + k] if k < count - 1 else 1.0
        if chord_bound(between(xs, low, high), between(ys, low, high)) > tolerance:
            return False
        low = high
    return True


@kernel
def cut_evenly(cubics, rows, t, tolerance, halvings, room, cuts, counts, shares):
    """Try equal shares of the density, the predicted number of pieces and a few more, see ``curves_to_lines``.

    Args:
        cubics: (n, 4, 2).
        rows: those that are tried.
        t: (k,) where the density is sampled.
        tolerance: for the bound.
        halvings: (n,) cuts by halving.
        room: (n,) where the cuts of each cubic are written, as many at most.
        cuts: written for those that are taken.
        counts: (n,) how many they are, written for those that are taken; -1 before.
        shares: (rows, k) for the work.
    """
    for row in range(len(rows)):
        share_out(cubics, rows[row], t, shares[row])
    last, step = len(t) - 1, math.sqrt(8 * tolerance)
    for extra in range(5):
        widest = 0.0
        for row in range(len(rows)):
            pieces = piece_count(shares[row, last] / step, extra)
            if (counts[rows[row]] < 0) & (pieces <= halvings[rows[row]]):
                widest = max(widest, shares[row, last])
        span, place = widest * 2 + 1, 0
        for row in range(len(rows)):
            n = rows[row]
            pieces = piece_count(shares[row, last] / step, extra)
            if (counts[n] >= 0) | (pieces > halvings[n]):
                continue
            for k in range(1, pieces):
                wanted = shares[row, last] * k / pieces
                cuts[room[n] + k - 1] = part_at(t, shares[row], wanted, span * place)
            if passes(cubics, n, cuts, room[n], pieces, tolerance):
                counts[n] = pieces - 1
            place += 1


@kernel
def piece_count(ideal, extra):
    """Pieces that are tried: the predicted number, and ``extra`` times some more."""
    wanted = math.ceil(ideal)
    return max(wanted + extra * max(wanted // 64, 1), 1)


@kernel
def cut_the_rest(cubics, tolerance, halvings, room, waiting, cuts, counts):
    """Cut by Wang's bound where that takes fewest, by halving where nothing else was taken; all cuts rising.

    Args:
        cubics: (n, 4, 2).
        tolerance: for the bound.
        halvings: (n,) cuts by halving.
        room: (n,) where the cuts of each cubic are.
        waiting: for :func:`halved`.
        cuts: of those taken so far, and written.
        counts: (n,) how many; -1 where nothing was taken; written.
    """
    for n in range(len(cubics)):
        xs, ys = coordinates(cubics, n, 0), coordinates(cubics, n, 1)
        largest = 0.0
        for k in range(2):
            x, y = (xs[k + 2] - xs[k + 1]) - (xs[k + 1] - xs[k]), (ys[k + 2] - ys[k + 1]) - (ys[k + 1] - ys[k])
            largest = max(largest, np.hypot(x, y))
        steps = max(math.sqrt(0.75 * largest / tolerance), 1.0)
        best = counts[n] if counts[n] >= 0 else halvings[n]
        if steps <= best:
            steps = float(math.ceil(steps))
            counts[n] = int(steps) - 1
            for k in range(counts[n]):
                cuts[room[n] + k] = (k + 1) / steps
        elif counts[n] < 0:
            counts[n] = halved(cubics, n, tolerance, halvings[n], waiting, cuts, room[n])
        else:
            put_in_order(cuts, room[n], room[n] + counts[n])  # they are, but for rounding


@kernel
def value_at(p, t):
    """One coordinate of the point of a cubic at t."""
    s = 1 - t
    return s * s * s * p[0] + 3 * s * s * t * p[1] + 3 * s * t * t * p[2] + t * t * t * p[3]


@kernel
def off_chord(xs, ys, t):
    """How far the point at t is from the chord."""
    dx, dy = xs[3] - xs[0], ys[3] - ys[0]
    wx, wy = value_at(xs, t) - xs[0], value_at(ys, t) - ys[0]
    square = dx * dx + dy * dy
    part = min(max((wx * dx + wy * dy) / (square if square > 0.0 else 1.0), 0.0), 1.0)
    return np.hypot(wx - part * dx, wy - part * dy)


@kernel
def farthest(xs, ys, looks):
    """The largest distance of a piece from its chord, of the places that are looked at: see ``curves_to_lines``."""
    x, y = xs[3] - xs[0], ys[3] - ys[0]
    u1, v1, u2, v2 = xs[1] - xs[0], ys[1] - ys[0], xs[2] - xs[0], ys[2] - ys[0]
    one, two = extremes(x * v1 - y * u1, x * v2 - y * u2)
    far = off_chord(xs, ys, one if (one > 0) & (one < 1) else 0.5)
    far = max(far, off_chord(xs, ys, two if (two > 0) & (two < 1) else 0.5))
    along1, along2 = x * u1 + y * v1, x * u2 + y * v2
    if (min(along1, along2) < 0) | (max(along1, along2) > x * x + y * y):
        for t in looks:
            far = max(far, off_chord(xs, ys, t))
    return far


@kernel
def chords(cubics, counts, cuts, looks, points, far):
    """Write the point at each cut, and how far each piece is from its chord.

    Args:
        cubics: (n, 4, 2).
        counts: (n,) cuts of each.
        cuts: (m,) of the first cubic, of the second, and so on, rising.
        looks: parts of a piece at which it is looked at where it goes beyond the ends of its chord.
        points: (m, 2) written.
        far: (m + n,) written.
    """
    cut = piece = 0
    for n in range(len(cubics)):
        xs, ys = coordinates(cubics, n, 0), coordinates(cubics, n, 1)
        low = 0.0
        for k in range(counts[n] + 1):
            high = 1.0
            if k < counts[n]:
                high = cuts[cut]
                points[cut, 0], points[cut, 1] = value_at(xs, high), value_at(ys, high)
                cut += 1
            far[piece] = farthest(between(xs, low, high), between(ys, low, high), looks)
            piece, low = piece + 1, high
