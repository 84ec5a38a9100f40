"""Time of impact for a whole wave of balls: each asks what it looks at, a line, an arc or a corner.

There are no branches, so that vector instructions do the work. The formulas are those of ``impact`` and ``arcs``, term
by term: the same bits come out. A lane that looks at something of another kind, or at nothing, goes through the motions
with some record of this kind, and its result is dropped; so these passes divide by zero and are for compiled kernels
alone.
"""

from __future__ import annotations

import math

from wallkit.kernels.arcs import (
    WELL_KNOWN,
    aside_of,
    hidden_by_rounding,
    is_wide,
    scan_arcs_disc,
    scan_arcs_point,
    spans,
)
from wallkit.kernels.impact import slack_of
from wallkit.kernels.instructions import fetch, lowest
from wallkit.kernels.jit import kernel, rare_kernel
from wallkit.kernels.model import Arc, Corner, Line
from wallkit.kernels.wave_lanes import (
    ALONG,
    ARCS,
    BEST,
    CHORD,
    CORNERS,
    DOUBT,
    E0,
    E1,
    E2,
    E3,
    E4,
    E5,
    E6,
    E7,
    EITHER,
    END,
    ENERGY,
    FEATURE,
    FROM,
    ID,
    INSIDE,
    LANES,
    LAST,
    NEITHER,
    NEXT,
    NEXT_CORNER,
    NONE,
    OUTSIDE,
    PER_ENERGY,
    POWER,
    SPEED,
    SQUARE,
    TOLERANCE,
    TOUCHED,
    VX,
    VY,
    T,
    X,
    Y,
)

LINE_FLOATS, ARC_FLOATS, CORNER_FLOATS = (len(kind._fields) for kind in (Line, Arc, Corner))


@kernel
def meet(model, radius, s, q):
    """Let every ball look at the next line, arc or corner of its cell."""
    at_line, at_arc, at_corner = _looking(q)
    if at_line > 0:
        for i in range(0, LANES, LINE_FLOATS):
            fetch(model.lines, model.ids, q, NEXT + i, s, ID + i, LANES)
        if radius is None:
            _meet_lines_point(s, q)
        else:
            _meet_lines_disc(s, q, radius)
    if at_arc > 0:
        _meet_arcs(model, model.arcs, radius, s, q)
    if radius is not None:
        if at_corner > 0:
            for i in range(0, LANES, CORNER_FLOATS):
                fetch(model.corners, model.ids, q, NEXT_CORNER + i, s, ID + i, LANES)
            _meet_corners(s, q, radius)


@kernel
def _meet_arcs(model, arcs, radius, s, q):
    if arcs is None:
        return
    for i in range(0, LANES, ARC_FLOATS):
        fetch(arcs, model.ids, q, NEXT + i, s, ID + i, LANES)
    again = _meet_arcs_point(s, q) if radius is None else _meet_arcs_disc(s, q, radius)
    while again > 0:
        i = lowest(again)
        again &= again - 1
        _ask_again(model, arcs, radius, s, q, i)


@rare_kernel
def _ask_again(model, arcs, radius, s, q, i):
    """Let a ball ask its arc alone, with all that its pass leaves out as it is seldom so."""
    k, last, feature = q[NEXT + i], int(s[LAST + i]), int(s[FEATURE + i])
    if radius is None:
        s[BEST + i], feature, touched = scan_arcs_point(
            arcs, model.ids, k, k + 1, None, model.edge_wall, s[X + i], s[Y + i], s[VX + i], s[VY + i], s[ENERGY + i],
            last, s[TOLERANCE + i], s[BEST + i], feature,
        )  # fmt: skip
        s[TOUCHED + i] += float(touched)
    else:
        s[BEST + i], feature = scan_arcs_disc(
            arcs, model.ids, k, k + 1, None, model.edge_wall, radius, s[X + i], s[Y + i], s[VX + i], s[VY + i],
            s[ENERGY + i], last, s[TOLERANCE + i], s[BEST + i], feature,
        )  # fmt: skip
    s[FEATURE + i] = float(feature)


@kernel
def _looking(q):
    """Tell how many balls look at lines, at arcs and at corners."""
    at_line, at_arc, at_corner = 0, 0, 0
    for i in range(LANES):
        k = q[NEXT + i]
        at_line += int(k < q[ARCS + i])
        at_arc += int((k >= q[ARCS + i]) & (k < q[CORNERS + i]))
        at_corner += int(q[NEXT_CORNER + i] < q[END + i])
    return at_line, at_arc, at_corner


@kernel
def _edge_is_sooner(t, edge, best, feature):
    """Whether a contact with an edge comes first: at equal times as ``impact.precedes`` says."""
    return (t < best) | ((t == best) & (feature != NONE) & ((feature < 0.0) | (edge < feature)))


@kernel
def _meet_lines_point(s, q):
    """Let every point ask its line, as ``impact.scan_point`` does."""
    for i in range(LANES):
        x, y, vx, vy = s[X + i], s[Y + i], s[VX + i], s[VY + i]
        tolerance, best, feature, number = s[TOLERANCE + i], s[BEST + i], s[FEATURE + i], s[ID + i]
        nx, ny, length = s[E4 + i], s[E5 + i], s[E6 + i]
        ex, ey = s[E0 + i] - x, s[E1 + i] - y
        d = -(ex * nx + ey * ny)
        u = ex * ny - ey * nx
        asked = (q[NEXT + i] < q[ARCS + i]) & (s[LAST + i] != number)
        near = (abs(d) <= tolerance) & (u >= -tolerance) & (u <= length + tolerance)
        cross_a = ex * vy - ey * vx
        cross_b = (s[E2 + i] - x) * vy - (s[E3 + i] - y) * vx
        above = d > 0.0
        closing = vx * nx + vy * ny
        closing = -closing if above else closing
        closing = closing if closing > 0.0 else abs(cross_b - cross_a) / length
        t = abs(d) / closing
        rises = cross_a < 0.0
        sooner = _edge_is_sooner(t, number, best, feature)
        met = asked & (not near) & (rises != (cross_b < 0.0)) & (rises == above) & sooner
        s[BEST + i] = t if met else best
        s[FEATURE + i] = number if met else feature
        s[TOUCHED + i] = 1.0 if near & asked else s[TOUCHED + i]


@kernel
def _meet_lines_disc(s, q, radius):
    """Let every disc ask its line, as ``impact.scan_disc`` does."""
    for i in range(LANES):
        vx, vy, best, feature, number = s[VX + i], s[VY + i], s[BEST + i], s[FEATURE + i], s[ID + i]
        nx, ny = s[E4 + i], s[E5 + i]
        slack = slack_of(s[TOLERANCE + i], radius)
        ex, ey = s[X + i] - s[E0 + i], s[Y + i] - s[E1 + i]
        d = ex * nx + ey * ny
        closing = -(vx * nx + vy * ny)
        below = d < 0.0
        d = -d if below else d
        closing = -closing if below else closing
        t = (d - radius) / closing
        t = 0.0 if t < 0.0 else t
        u = ey * nx - ex * ny + t * (vy * nx - vx * ny)
        asked = (q[NEXT + i] < q[ARCS + i]) & (s[LAST + i] != number) & (closing > 0.0)
        sooner = _edge_is_sooner(t, number, best, feature)
        met = asked & (u >= -slack) & (u <= s[E6 + i] + slack) & sooner
        s[BEST + i] = t if met else best
        s[FEATURE + i] = number if met else feature


@kernel
def _meet_corners(s, q, radius):
    """Let every disc ask its corner, as ``impact.scan_corners`` does."""
    square = radius * radius
    for i in range(LANES):
        vx, vy, best, feature, energy = s[VX + i], s[VY + i], s[BEST + i], s[FEATURE + i], s[ENERGY + i]
        number = -2.0 - s[ID + i]
        ex, ey = s[X + i] - s[E0 + i], s[Y + i] - s[E1 + i]
        along = ex * vx + ey * vy
        cross = ex * vy - ey * vx
        discriminant = square - cross * cross * s[PER_ENERGY + i]
        c = ex * ex + ey * ey - square
        t = c / (math.sqrt(energy * (discriminant if discriminant > 0.0 else 0.0)) - along)
        t = 0.0 if t < 0.0 else t
        looks = q[NEXT_CORNER + i] < q[END + i]
        asked = looks & (s[LAST + i] != number) & (along < 0.0) & (discriminant >= 0.0)
        sooner = (t < best) | ((t == best) & (feature < NONE) & (number > feature))  # as ``precedes`` says
        met = asked & sooner
        s[BEST + i] = t if met else best
        s[FEATURE + i] = number if met else feature


@kernel
def _meet_arcs_point(s, q):
    """Let every point ask its arc, as ``arcs.scan_arcs_point`` does.

    In two passes, so that the processor works on several vectors at once while roots and quotients take long.

    Returns:
        The bits of the points that are to ask again: within rounding of an arc that they have not just left.
    """
    again = _find_cuts(s, q)
    for i in range(LANES):
        energy, along, power, square, cut = s[ENERGY + i], s[ALONG + i], s[POWER + i], s[SQUARE + i], s[FROM + i]
        best, feature, number = s[BEST + i], s[FEATURE + i], s[ID + i]
        root = math.sqrt(square if square > 0.0 else 0.0)
        above, below = (root - along, energy) if along <= 0.0 else (-power, along + root)
        above, below = (-2.0 * along, energy) if cut == CHORD else (above, below)
        above, below = (power, root - along) if cut == OUTSIDE else (above, below)
        t = above / below
        met = (cut != NEITHER) & _edge_is_sooner(t, number, best, feature)
        s[BEST + i] = t if met else best
        s[FEATURE + i] = number if met else feature
    return again


@kernel
def _find_cuts(s, q):
    """Find which cut of its line with the circle of its arc each point meets, see OUTSIDE; and who is to ask again."""
    near = 0
    for i in range(LANES):
        x, y, vx, vy, tolerance = s[X + i], s[Y + i], s[VX + i], s[VY + i], s[TOLERANCE + i]
        ax, ay, sx, sy, radius, wide = s[E0 + i], s[E1 + i], s[E4 + i], s[E5 + i], s[E6 + i], is_wide(s[E7 + i])
        fx, fy = (s[E2 + i] - ax) + sx, (s[E3 + i] - ay) + sy
        wx, wy = x - ax, y - ay
        ex, ey = wx + sx, wy + sy
        power = wx * (wx + 2.0 * sx) + wy * (wy + 2.0 * sy)
        along = ex * vx + ey * vy
        on = s[LAST + i] == s[ID + i]
        asked = (q[NEXT + i] >= q[ARCS + i]) & (q[NEXT + i] < q[CORNERS + i])
        unclear = (not on) & (abs(power) <= (2.0 * radius + tolerance) * tolerance)
        near |= int(asked & unclear) << i
        inside = (along if on else power) < 0.0
        a_right = wy * vx - wx * vy >= 0.0
        b_right = (s[E2 + i] - x) * vy - (s[E3 + i] - y) * vx >= 0.0
        cross = abs(ex * vy - ey * vx)
        far_x, far_y = -vy if a_right else vy, vx if a_right else -vx
        both = (cross * cross < radius * radius * (vx * vx + vy * vy)) & spans(
            sx, sy, fx, fy, radius, wide, far_x, far_y, 0.0
        )
        enters = (b_right & (not a_right)) | ((a_right == b_right) & both)
        leaves = (a_right & (not b_right)) | ((a_right == b_right) & both)
        meets = asked & (not unclear) & (inside | ((not on) & (along < 0.0))) & (leaves | (enters & (not inside)))
        speed = s[SPEED + i]
        chord = on & (s[ENERGY + i] * abs(power) > WELL_KNOWN * along * along)
        cut = OUTSIDE if enters & (not inside) else (CHORD if chord else INSIDE)
        s[FROM + i] = cut if meets else NEITHER
        s[ALONG + i], s[POWER + i], s[SQUARE + i] = along, power, (radius * speed - cross) * (radius * speed + cross)
    return near


@kernel
def _meet_arcs_disc(s, q, disc):
    """Let every disc ask its arc, as ``arcs.scan_arcs_disc`` does, but from one side only.

    In three short passes, so that the processor works on several vectors at once while roots and quotients take long.

    Returns:
        The bits of the balls that are to ask again, alone: from both sides, or as they are near the end of an arc.
    """
    _take_sides(s, q, disc)
    _find_times(s, disc)
    return _find_places(s, disc)


@kernel
def _take_sides(s, q, disc):
    """Find the side that each disc may meet its arc from: see OUTSIDE.

    A disc outside the circle of an arc may meet the arc from outside, with e.v < 0 where it does, or fly by it into
    the circle and meet it from inside, with e.v > 0. All directions in which a narrow arc lies are between those of s
    and f: where s.v and f.v have one sign, and are larger than what rounding and slack come to, it tells the side.
    """
    for i in range(LANES):
        vx, vy, speed = s[VX + i], s[VY + i], s[SPEED + i]
        ax, ay, sx, sy, radius, wide = s[E0 + i], s[E1 + i], s[E4 + i], s[E5 + i], s[E6 + i], is_wide(s[E7 + i])
        fx, fy = (s[E2 + i] - ax) + sx, (s[E3 + i] - ay) + sy
        wx, wy = s[X + i] - ax, s[Y + i] - ay
        ex, ey = wx + sx, wy + sy
        power = wx * (wx + 2.0 * sx) + wy * (wy + 2.0 * sy)
        along = ex * vx + ey * vy
        cross = abs(ex * vy - ey * vx)
        inner = radius - disc
        off = hidden_by_rounding(slack_of(s[TOLERANCE + i], disc), radius)
        s_along, f_along = sx * vx + sy * vy, fx * vx + fy * vy
        doubt = s[DOUBT + i]
        narrow = (2.0 * disc < radius) & (not wide)
        ahead = narrow & (s_along > doubt) & (f_along > doubt)
        behind = narrow & (s_along < -doubt) & (f_along < -doubt)
        outside = (power >= 0.0) & (not ahead)
        farthest = inner + off
        enters = (inner > 0.0) & ((farthest * speed >= cross) | (s[LAST + i] == s[ID + i])) & (not behind)
        reach = radius + disc if outside else inner
        farthest = reach if outside else farthest
        square = (reach * speed - cross) * (reach * speed + cross)
        asked = (q[NEXT + i] >= q[ARCS + i]) & (q[NEXT + i] < q[CORNERS + i]) & ((power < 0.0) | (along < 0.0))
        side = (EITHER if enters else OUTSIDE) if outside else (INSIDE if inner > 0.0 else NEITHER)
        s[FROM + i] = side if asked else NEITHER
        s[E0 + i], s[E1 + i], s[E2 + i], s[E3 + i] = ex, ey, fx, fy
        square = square if square > 0.0 else 0.0
        s[ALONG + i], s[POWER + i], s[SQUARE + i] = along, power, square if farthest * speed >= cross else -1.0


@kernel
def _find_times(s, disc):
    """Find when each disc is at its distance from the circle of its arc, -1 for never."""
    for i in range(LANES):
        energy, along, power, square, radius = s[ENERGY + i], s[ALONG + i], s[POWER + i], s[SQUARE + i], s[E6 + i]
        outside = s[FROM + i] > NEITHER
        root = math.sqrt(square if square > 0.0 else 0.0)
        off = disc if outside else -disc
        c = power - off * (2.0 * radius + off)
        overlaps = (c <= 0.0) if outside else (c >= 0.0) & (along > 0.0)
        is_last = s[LAST + i] == s[ID + i]
        chord = (not outside) & is_last & (energy * abs(c) > WELL_KNOWN * along * along)
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
def _find_places(s, disc):
    """Find which arcs lie where the discs are then: the bits of those that are to ask again."""
    again = 0
    for i in range(LANES):
        best, feature, number, t = s[BEST + i], s[FEATURE + i], s[ID + i], s[T + i]
        slack = slack_of(s[TOLERANCE + i], disc)
        x, y = s[E0 + i] + t * s[VX + i], s[E1 + i] + t * s[VY + i]
        wide = is_wide(s[E7 + i])
        lies_there = spans(s[E4 + i], s[E5 + i], s[E2 + i], s[E3 + i], s[E6 + i], wide, x, y, slack)
        meets = (t >= 0.0) & lies_there & (s[FROM + i] != NEITHER)
        aside = aside_of(slack, s[E6 + i])
        beside = min(abs(s[E4 + i] * y - s[E5 + i] * x), abs(x * s[E3 + i] - y * s[E2 + i])) <= aside * s[E6 + i]
        unclear = (s[FROM + i] == EITHER) | ((t >= 0.0) & beside)
        again |= int((s[FROM + i] != NEITHER) & unclear & (not meets)) << i
        sooner = _edge_is_sooner(t, number, best, feature)
        s[BEST + i] = t if meets & sooner else best
        s[FEATURE + i] = number if meets & sooner else feature
    return again
