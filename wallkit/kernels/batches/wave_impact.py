"""Time of impact for a whole wave of balls: all pairs of a ball and a line, an arc or a corner that it asks.

There are no branches, so that vector instructions do the work. The formulas are those of ``line_impact`` and
``arc_impact``, term by term: the same bits come out. Pairs are worked on many at a time; the last ones are made up to
as many with pairs whose result is dropped, which may divide by zero: so these passes are for compiled kernels alone.
"""

from __future__ import annotations

import math

from wallkit.kernels.batches.wave_columns import (
    ALONG,
    ARC_IDS,
    ARC_MOVERS,
    ASKS_ARC,
    ASKS_CORNER,
    ASKS_LINE,
    BEST,
    CHORD,
    CORNER_IDS,
    CORNER_MOVERS,
    CORNER_PLACE,
    E0,
    E1,
    E2,
    E3,
    E4,
    E5,
    E6,
    E7,
    EITHER,
    ENERGY,
    FEATURE,
    FROM,
    ID,
    INSIDE,
    LAST,
    LINE_FOR_DISC,
    LINE_FOR_POINT,
    LINE_IDS,
    LINE_MOVERS,
    NEITHER,
    NONE,
    OUTSIDE,
    PAIRED,
    PAIRS,
    POWER,
    SPEED,
    SQUARE,
    TOLERANCE,
    TOUCHED,
    VX,
    VY,
    WHOLE_ARC,
    T,
    X,
    Y,
)
from wallkit.kernels.batches.wave_pairs import one_way, part
from wallkit.kernels.impact.arc_impact import (
    WELL_KNOWN,
    aside_of,
    hidden_by_rounding,
    is_mould,
    is_wide,
    scan_arcs_disc,
    scan_arcs_point,
    spans,
)
from wallkit.kernels.impact.line_impact import from_across, slack_of, stands_across
from wallkit.kernels.intrinsics import AT_ONCE, fetch, lowest
from wallkit.kernels.jit import kernel, rare_kernel
from wallkit.kernels.records import Corner

CORNER_FLOATS = len(Corner._fields)
DULL = 2.0**-800
"""Of slower balls, and of ones as much faster, not all squares are numbers that rounding leaves as they are."""


@kernel
def meet(model, radius, movers, s, q, pairs):
    """Let every ball ask what it is paired with."""
    lines, arcs, corners = int(q[PAIRED]), int(q[PAIRED + 1]), int(q[PAIRED + 2])
    for first in range(0, lines, PAIRS):
        # Whole vectors: the last one is made up with other pairs, whose bits are not among the `real` ones.
        padded, real = part(lines - first)
        for i in range(0, padded, AT_ONCE):
            fetch(movers, pairs, LINE_MOVERS + first + i, s, i, ASKS_LINE)
            if radius is None:
                fetch(model.lines, pairs, LINE_IDS + first + i, s, i, LINE_FOR_POINT)
            else:
                fetch(model.lines, pairs, LINE_IDS + first + i, s, i, LINE_FOR_DISC)
        if radius is None:
            met, near, behind = _meet_lines_point(s, padded)
            _touch(s, pairs, LINE_MOVERS + first, near & real)
        else:
            met, behind = _meet_lines_disc(s, radius, padded)
        met &= real
        through = one_way(model, model.one_sided, pairs, LINE_IDS + first, met & behind)
        _keep(s, pairs, LINE_MOVERS + first, met & ~through, False)
    _meet_arcs(model, model.arcs, radius, movers, s, pairs, arcs)
    if radius is not None:
        for first in range(0, corners, PAIRS):
            padded, real = part(corners - first)
            for i in range(0, padded, AT_ONCE):
                fetch(movers, pairs, CORNER_MOVERS + first + i, s, i, ASKS_CORNER)
                for j in range(i, i + AT_ONCE, CORNER_FLOATS):
                    fetch(model.corners, pairs, CORNER_IDS + first + j, s, j, CORNER_PLACE)
            met = _meet_corners(s, radius, padded) & real
            met = _solid_corners(model, model.one_sided, radius, s, pairs, CORNER_IDS + first, met)
            _keep(s, pairs, CORNER_MOVERS + first, met, True)


@kernel
def _solid_corners(model, one_sided, radius, s, pairs, first, met):
    """Of the bits of contacts with corners, keep those that ``line_impact.scan_corners`` finds at one-sided walls."""
    if one_sided is None:
        return met
    left = met
    while left > 0:
        j = lowest(left)
        left &= left - 1
        index = pairs[first + j]
        slack, t = slack_of(s[TOLERANCE + j], radius), s[T + j]
        ex, ey = s[X + j] - s[E0 + j], s[Y + j] - s[E1 + j]
        there_x, there_y = ex + t * s[VX + j], ey + t * s[VY + j]
        gap = ex * ex + ey * ey - radius * radius
        across = stands_across(one_sided, model.corner_wall, index, gap, 2.0 * radius * slack) or from_across(
            one_sided, model.corner_wall, model.fans, model.corners, index, radius, slack, there_x, there_y
        )
        if across:
            met -= 1 << j
    return met


@kernel
def _keep(s, pairs, first, met, corners):
    """Let balls keep the soonest of contacts, all with edges or all with corners; see ``line_impact.precedes``."""
    while met > 0:
        j = lowest(met)
        met &= met - 1
        i = pairs[first + j]
        t, number, best, feature = s[T + j], s[ID + j], s[BEST + i], s[FEATURE + i]
        # At equal times, without branches: edges by number, then corners, which are -2 - j; nothing precedes NONE, -1.
        after_edges = feature < NONE
        precedes = (after_edges & (number > feature)) if corners else (after_edges | (number < feature))
        sooner = (t < best) | ((t == best) & precedes)
        s[BEST + i] = t if sooner else best
        s[FEATURE + i] = number if sooner else feature


@kernel
def _touch(s, pairs, first, near):
    """Note which points are within rounding of a line."""
    # Seldom: a loop over the bits that are set costs less than a pass.
    while near > 0:
        s[TOUCHED + pairs[first + lowest(near)]] = 1.0
        near &= near - 1


@kernel
def _meet_arcs(model, arcs, radius, movers, s, pairs, listed):
    if arcs is None:
        return
    for first in range(0, listed, PAIRS):
        padded, real = part(listed - first)
        for i in range(0, padded, AT_ONCE):
            fetch(movers, pairs, ARC_MOVERS + first + i, s, i, ASKS_ARC)
            fetch(arcs, pairs, ARC_IDS + first + i, s, i, WHOLE_ARC)
        met, again = _meet_arcs_point(s, padded) if radius is None else _meet_arcs_disc(s, radius, padded)
        # Which of its sides stops a ball, and whether it has to leave it first, the scalar kernel knows.
        alone = one_way(model, model.one_sided, pairs, ARC_IDS + first, met & real)
        _keep(s, pairs, ARC_MOVERS + first, met & real & ~alone, False)
        again = (again & real) | alone
        while again > 0:
            j = lowest(again)
            again &= again - 1
            _ask_again(model, arcs, radius, movers, s, pairs, first + j)


@rare_kernel
def _ask_again(model, arcs, radius, movers, s, pairs, k):
    """Let a ball ask its arc alone, with all that its pass leaves out as it is seldom so."""
    # The scalar kernel, for one pair: it does what the pass has no room for, with the same bits.
    i = pairs[ARC_MOVERS + k]
    mover, at = movers[i], ARC_IDS + k
    last, feature = int(mover.last), int(s[FEATURE + i])
    if radius is None:
        s[BEST + i], feature, touched = scan_arcs_point(
            arcs, pairs, at, at + 1, model.one_sided, model.edge_wall, mover.x, mover.y, mover.vx, mover.vy,
            mover.energy, last, mover.tolerance, s[BEST + i], feature,
        )  # fmt: skip
        s[TOUCHED + i] += float(touched)
    else:
        s[BEST + i], feature = scan_arcs_disc(
            arcs, pairs, at, at + 1, model.one_sided, model.edge_wall, radius, mover.x, mover.y, mover.vx, mover.vy,
            mover.energy, last, mover.tolerance, s[BEST + i], feature,
        )  # fmt: skip
    s[FEATURE + i] = float(feature)


@kernel
def _meet_lines_point(s, padded):
    """Let every point ask its line, as ``line_impact.scan_point`` does: who meets it, touches it, and is behind it."""
    meeting, touching, behind = 0, 0, 0
    for i in range(padded):
        x, y, vx, vy = s[X + i], s[Y + i], s[VX + i], s[VY + i]
        tolerance, number = s[TOLERANCE + i], s[ID + i]
        nx, ny, length = s[E4 + i], s[E5 + i], s[E6 + i]
        ex, ey = s[E0 + i] - x, s[E1 + i] - y
        # e from the point to a: d = (p - a).n = -e.n, and the foot u = e x n, as in ``scan_point``.
        d = -(ex * nx + ey * ny)
        u = ex * ny - ey * nx
        asked = s[LAST + i] != number
        near = (abs(d) <= tolerance) & (u >= -tolerance) & (u <= length + tolerance)
        cross_a = ex * vy - ey * vx
        cross_b = (s[E2 + i] - x) * vy - (s[E3 + i] - y) * vx
        above = d > 0.0
        closing = vx * nx + vy * ny
        closing = -closing if above else closing
        # All but parallel: the difference of the crosses over the length stands in for v.n.
        closing = closing if closing > 0.0 else abs(cross_b - cross_a) / length
        rises = cross_a < 0.0
        met = asked & (not near) & (rises != (cross_b < 0.0)) & (rises == above)
        s[T + i] = abs(d) / closing
        meeting |= int(met) << i
        touching |= int(near & asked) << i
        behind |= int(d < 0.0) << i
    return meeting, touching, behind


@kernel
def _meet_lines_disc(s, radius, padded):
    """Let every disc ask its line, as ``line_impact.scan_disc`` does: who meets it, and who is behind or across it."""
    meeting, behind = 0, 0
    for i in range(padded):
        vx, vy, nx, ny = s[VX + i], s[VY + i], s[E4 + i], s[E5 + i]
        slack = slack_of(s[TOLERANCE + i], radius)
        ex, ey = s[X + i] - s[E0 + i], s[Y + i] - s[E1 + i]
        d = ex * nx + ey * ny
        closing = -(vx * nx + vy * ny)
        below = d < 0.0
        d = -d if below else d
        closing = -closing if below else closing
        # d + t v.n = r on the side of the ball, an overlap at once, and the foot at that time.
        gap = d - radius
        t = gap / closing
        t = 0.0 if t < 0.0 else t
        u = ey * nx - ex * ny + t * (vy * nx - vx * ny)
        asked = (s[LAST + i] != s[ID + i]) & (closing > 0.0)
        meeting |= int(asked & (u >= -slack) & (u <= s[E6 + i] + slack)) << i
        behind |= int(below | (gap < -slack)) << i
        s[T + i] = t
    return meeting, behind


@kernel
def _meet_corners(s, radius, padded):
    """Let every disc ask its corner, as ``line_impact.scan_corners`` does: the bits of those that meet it."""
    square, meeting = radius * radius, 0
    for i in range(padded):
        vx, vy, energy, number = s[VX + i], s[VY + i], s[ENERGY + i], -2.0 - s[ID + i]
        ex, ey = s[X + i] - s[E0 + i], s[Y + i] - s[E1 + i]
        along = ex * vx + ey * vy
        cross = ex * vy - ey * vx
        # r^2 less the squared distance at which the path passes; t = c / (root - e.v), as in ``scan_corners``.
        discriminant = square - cross * cross * (1.0 / energy)
        c = ex * ex + ey * ey - square
        t = c / (math.sqrt(energy * (discriminant if discriminant > 0.0 else 0.0)) - along)
        t = 0.0 if t < 0.0 else t
        meeting |= int((s[LAST + i] != number) & (along < 0.0) & (discriminant >= 0.0)) << i
        s[ID + i], s[T + i] = number, t
    return meeting


@kernel
def _meet_arcs_point(s, padded):
    """Let every point ask its arc, as ``arc_impact.scan_arcs_point`` does.

    In two passes, so that the processor works on several vectors at once while roots and quotients take long.

    Returns:
        The bits of the points that meet it, and of those that are to ask again: within rounding of an arc that they
        have not just left.
    """
    again, meeting = _find_cuts(s, padded), 0
    for i in range(padded):
        energy, along, power, square, cut = s[ENERGY + i], s[ALONG + i], s[POWER + i], s[SQUARE + i], s[FROM + i]
        root = math.sqrt(square if square > 0.0 else 0.0)
        # Numerator and denominator are selected, so that one quotient serves every form of the root.
        above, below = (root - along, energy) if along <= 0.0 else (-power, along + root)
        above, below = (-2.0 * along, energy) if cut == CHORD else (above, below)
        above, below = (power, root - along) if cut == OUTSIDE else (above, below)
        s[T + i] = above / below
        meeting |= int(cut != NEITHER) << i
    return meeting, again


@kernel
def _find_cuts(s, padded):
    """Find which cut of its line with the circle of its arc each point meets, see OUTSIDE; and who is to ask again."""
    near = 0
    for i in range(padded):
        x, y, vx, vy, tolerance = s[X + i], s[Y + i], s[VX + i], s[VY + i], s[TOLERANCE + i]
        ax, ay, sx, sy, radius, wide = s[E0 + i], s[E1 + i], s[E4 + i], s[E5 + i], s[E6 + i], is_wide(s[E7 + i])
        fx, fy = (s[E2 + i] - ax) + sx, (s[E3 + i] - ay) + sy
        wx, wy = x - ax, y - ay
        ex, ey = wx + sx, wy + sy
        power = wx * (wx + 2.0 * sx) + wy * (wy + 2.0 * sy)
        along = ex * vx + ey * vy
        on = s[LAST + i] == s[ID + i]
        unclear = (not on) & (abs(power) <= (2.0 * radius + tolerance) * tolerance)
        near |= int(unclear) << i
        inside = (along if on else power) < 0.0
        a_right = wy * vx - wx * vy >= 0.0
        b_right = (s[E2 + i] - x) * vy - (s[E3 + i] - y) * vx >= 0.0
        cross = abs(ex * vy - ey * vx)
        # The middle of the cap beyond the line: a quarter turn from v, on the side where a and b are not.
        far_x, far_y = -vy if a_right else vy, vx if a_right else -vx
        both = (cross * cross < radius * radius * (vx * vx + vy * vy)) & spans(
            sx, sy, fx, fy, radius, wide, far_x, far_y, 0.0
        )
        enters = (b_right & (not a_right)) | ((a_right == b_right) & both)
        leaves = (a_right & (not b_right)) | ((a_right == b_right) & both)
        meets = (not unclear) & (inside | ((not on) & (along < 0.0))) & (leaves | (enters & (not inside)))
        speed = s[SPEED + i]
        chord = on & (s[ENERGY + i] * abs(power) > WELL_KNOWN * along * along)
        cut = OUTSIDE if enters & (not inside) else (CHORD if chord else INSIDE)
        s[FROM + i] = cut if meets else NEITHER
        # Half the chord times |v|, squared: (R |v|)^2 - (e x v)^2, or (e.v)^2 - v^2 power where that does not cancel.
        square = (radius * speed - cross) * (radius * speed + cross)
        part = s[ENERGY + i] * power
        square = along * along - part if along * along - part > part else square
        s[ALONG + i], s[POWER + i], s[SQUARE + i] = along, power, square
    return near


@kernel
def _meet_arcs_disc(s, disc, padded):
    """Let every disc ask its arc, as ``arc_impact.scan_arcs_disc`` does, but from one side only.

    In three short passes, so that the processor works on several vectors at once while roots and quotients take long.

    Returns:
        The bits of the balls that meet it, and of those that are to ask again, alone: from both sides, or as they are
        near the end of an arc, or as large as it.
    """
    _take_sides(s, disc, padded)
    _find_times(s, disc, padded)
    return _find_places(s, disc, padded)


@kernel
def _take_sides(s, disc, padded):
    """Find the side that each disc may meet its arc from: see OUTSIDE.

    A disc outside the circle of an arc may meet the arc from outside, with e.v < 0 where it does, or fly by it into
    the circle and meet it from inside, with e.v > 0. All directions in which a narrow arc lies are between those of s
    and f: where s.v and f.v have one sign, and are larger than what rounding and slack come to, it tells the side.
    """
    for i in range(padded):
        vx, vy, speed = s[VX + i], s[VY + i], s[SPEED + i]
        ax, ay, sx, sy, radius, wide = s[E0 + i], s[E1 + i], s[E4 + i], s[E5 + i], s[E6 + i], is_wide(s[E7 + i])
        fx, fy = (s[E2 + i] - ax) + sx, (s[E3 + i] - ay) + sy
        wx, wy = s[X + i] - ax, s[Y + i] - ay
        ex, ey = wx + sx, wy + sy
        power = wx * (wx + 2.0 * sx) + wy * (wy + 2.0 * sy)
        along = ex * vx + ey * vy
        cross = abs(ex * vy - ey * vx)
        # From inside the centre meets the circle of R - r.
        inner = radius - disc
        slack = slack_of(s[TOLERANCE + i], disc)
        off = hidden_by_rounding(slack, radius)
        s_along, f_along = sx * vx + sy * vy, fx * vx + fy * vy
        doubt = 8.0 * slack * speed
        energy = s[ENERGY + i]
        narrow = (2.0 * disc < radius) & (not wide) & (energy > DULL) & (energy < 1.0 / DULL)
        ahead = narrow & (s_along > doubt) & (f_along > doubt)
        behind = narrow & (s_along < -doubt) & (f_along < -doubt)
        outside = (power >= 0.0) & (not ahead)
        farthest = inner + off
        enters = (inner > 0.0) & ((farthest * speed >= cross) | (s[LAST + i] == s[ID + i])) & (not behind)
        # (R +- r)^2 = R^2 +- r (2 R +- r): c is e.e less that, from the power.
        reach = radius + disc if outside else inner
        farthest = reach if outside else farthest
        square = (reach * speed - cross) * (reach * speed + cross)
        side_of = disc if outside else -disc
        c = power - side_of * (2.0 * radius + side_of)
        part = energy * c
        clear = along * along - part > part
        square = along * along - part if clear & ((c > 0.0) | (not outside)) else square
        misses = (farthest * speed < cross) & (not (outside & (c > 0.0) & clear))
        asked = (power < 0.0) | (along < 0.0)
        side = (EITHER if enters else OUTSIDE) if outside else (INSIDE if inner > 0.0 else NEITHER)
        side = INSIDE if is_mould(radius, disc) else side
        s[FROM + i] = side if asked else NEITHER
        s[E0 + i], s[E1 + i], s[E2 + i], s[E3 + i] = ex, ey, fx, fy
        square = square if square > 0.0 else 0.0
        s[ALONG + i], s[POWER + i], s[SQUARE + i] = along, power, -1.0 if misses else square


@kernel
def _find_times(s, disc, padded):
    """Find when each disc is at its distance from the circle of its arc, -1 for never."""
    for i in range(padded):
        energy, along, power, square, radius = s[ENERGY + i], s[ALONG + i], s[POWER + i], s[SQUARE + i], s[E6 + i]
        outside = s[FROM + i] > NEITHER
        root = math.sqrt(square if square > 0.0 else 0.0)
        off = disc if outside else -disc
        c = power - off * (2.0 * radius + off)
        overlaps = (c <= 0.0) if outside else (c >= 0.0) & (along > 0.0)
        is_last = s[LAST + i] == s[ID + i]
        chord = (not outside) & is_last & (energy * abs(c) > WELL_KNOWN * along * along)
        # Inside the larger root, outside the smaller one, and from the arc itself the whole chord, in one quotient.
        above, below = (root - along, energy) if along <= 0.0 else (-c if square > 0.0 else 0.0, along + root)
        above, below = (-2.0 * along, energy) if chord else (above, below)
        above, below = (c, root - along) if outside else (above, below)
        t = above / below
        t = t if t > 0.0 else 0.0
        known = (square >= 0.0) | (chord & (not overlaps)) | (overlaps & (not outside))
        known = known & (outside | (not overlaps) | (power < 0.0))
        t = 0.0 if overlaps else t
        s[T + i] = t if known else -1.0


@kernel
def _find_places(s, disc, padded):
    """Find which arcs lie where the discs are then: the bits of those, and of those that are to ask again."""
    meeting, again = 0, 0
    for i in range(padded):
        t, slack = s[T + i], slack_of(s[TOLERANCE + i], disc)
        x, y = s[E0 + i] + t * s[VX + i], s[E1 + i] + t * s[VY + i]
        wide = is_wide(s[E7 + i])
        lies_there = spans(s[E4 + i], s[E5 + i], s[E2 + i], s[E3 + i], s[E6 + i], wide, x, y, slack)
        mould = is_mould(s[E6 + i], disc)
        meets = (t >= 0.0) & lies_there & (s[FROM + i] != NEITHER) & (not mould)
        aside = aside_of(slack, s[E6 + i])
        # |s x e| and |e x f| are R times how far the place is from the rays through both ends.
        beside = min(abs(s[E4 + i] * y - s[E5 + i] * x), abs(x * s[E3 + i] - y * s[E2 + i])) <= aside * s[E6 + i]
        unclear = (s[FROM + i] == EITHER) | ((t >= 0.0) & beside) | mould
        again |= int((s[FROM + i] != NEITHER) & unclear & (not meets)) << i
        meeting |= int(meets) << i
    return meeting, again
