"""Time of impact for a whole wave of balls: each asks what it looks at, a line, an arc or a corner.

A wave is one flat array of floats, LANES for each number of a ball and of what it looks at, so that the compiler sees
that nothing aliases and uses vector instructions; there are no branches. The formulas are those of ``impact`` and
``arcs``, term by term: the same bits come out. A lane that looks at something of another kind goes through the motions,
and its result is dropped; so these passes divide by zero and are for compiled kernels alone.
"""

from __future__ import annotations

import math

from wallkit.kernels.arcs import WELL_KNOWN, spans
from wallkit.kernels.jit import kernel
from wallkit.kernels.model import NO_HIT

LANES = 32
"""So few that a wave stays in the nearest cache, beside what it looks at."""
(
    X, Y, VX, VY, TIME, LOST, ENERGY, SPEED, PER_ENERGY, FROM_X, FROM_Y, FROM_VX, FROM_VY, TOLERANCE,
    LAST, BEST, FEATURE, TOUCHED, ID, FLIES,
    PX, PY, U, W, PER_U, PER_W, BORDER_X, BORDER_Y, COLUMN, ROW,
    E0, E1, E2, E3, E4, E5, E6, E7, E8, E9,
) = (LANES * number for number in range(40))  # fmt: skip
FLOATS = 40 * LANES
NONE = float(NO_HIT)
(
    NEXT, NEXT_CORNER, ARCS, CORNERS, END, WAY, AT, SIDE, SIZE, CROSSES, TURNS,
    LINE_LIST, ARC_LIST, CORNER_LIST, ENTERING, TURNING, ENTERED,
) = (LANES * number for number in range(17))  # fmt: skip
COUNTS = 17 * LANES
"""NEXT: place in ``Model.ids`` of what a ball looks at: a line before that in ARCS, an arc before that in CORNERS,
else nothing; discs look at a corner in the same turn, at NEXT_CORNER before END. Whether a ball CROSSES or TURNS is 1
or 0; the lists are of lanes, and at ENTERED stands how many are in ENTERING."""


@kernel
def _edge_is_sooner(t, edge, best, feature):
    """Whether a contact with an edge comes first: at equal times as ``impact.precedes`` says."""
    return (t < best) | ((t == best) & (feature != NONE) & ((feature < 0.0) | (edge < feature)))


@kernel
def meet_lines_point(s, q):
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
def meet_lines_disc(s, q, radius):
    """Let every disc ask its line, as ``impact.scan_disc`` does."""
    for i in range(LANES):
        vx, vy, best, feature, number = s[VX + i], s[VY + i], s[BEST + i], s[FEATURE + i], s[ID + i]
        nx, ny = s[E4 + i], s[E5 + i]
        slack = s[TOLERANCE + i] + radius * 2.0**-42
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
def meet_corners(s, q, radius):
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
def meet_arcs_point(s, q):
    """Let every point ask its arc, as ``arcs.scan_arcs_point`` does."""
    for i in range(LANES):
        x, y, vx, vy, energy, tolerance = s[X + i], s[Y + i], s[VX + i], s[VY + i], s[ENERGY + i], s[TOLERANCE + i]
        best, feature, number = s[BEST + i], s[FEATURE + i], s[ID + i]
        sx, sy, fx, fy, radius, wide = s[E4 + i], s[E5 + i], s[E6 + i], s[E7 + i], s[E8 + i], s[E9 + i]
        wx, wy = x - s[E0 + i], y - s[E1 + i]
        ex, ey = wx + sx, wy + sy
        power = wx * (wx + 2.0 * sx) + wy * (wy + 2.0 * sy)
        along = ex * vx + ey * vy
        again = s[LAST + i] == number
        near = (abs(power) <= (2.0 * radius + tolerance) * tolerance) & spans(
            sx, sy, fx, fy, radius, wide, ex, ey, tolerance
        )
        on = again | near
        inside = (on & (along < 0.0)) | ((not on) & (power < 0.0))
        a_right = wy * vx - wx * vy >= 0.0
        b_right = (s[E2 + i] - x) * vy - (s[E3 + i] - y) * vx >= 0.0
        cross = abs(ex * vy - ey * vx)
        far_x, far_y = -vy if a_right else vy, vx if a_right else -vx
        both = (cross * cross < radius * radius * (vx * vx + vy * vy)) & spans(
            sx, sy, fx, fy, radius, wide, far_x, far_y, 0.0
        )
        enters = (b_right & (not a_right)) | ((a_right == b_right) & both)
        leaves = (a_right & (not b_right)) | ((a_right == b_right) & both)
        asked = (q[NEXT + i] >= q[ARCS + i]) & (q[NEXT + i] < q[CORNERS + i])
        s[TOUCHED + i] = 1.0 if asked & near & (not again) else s[TOUCHED + i]
        meets = asked & (inside | ((not on) & (along < 0.0))) & (leaves | (enters & (not inside)))
        speed = s[SPEED + i]
        square = (radius * speed - cross) * (radius * speed + cross)
        root = math.sqrt(square if square > 0.0 else 0.0)
        above, below = -power, along + root
        above, below = (root - along, energy) if along <= 0.0 else (above, below)
        chord = on & (energy * abs(power) > WELL_KNOWN * along * along)
        above, below = (-2.0 * along, energy) if chord else (above, below)
        above, below = (power, root - along) if enters & (not inside) else (above, below)
        t = above / below
        sooner = _edge_is_sooner(t, number, best, feature)
        s[BEST + i] = t if meets & sooner else best
        s[FEATURE + i] = number if meets & sooner else feature


@kernel
def meet_arcs_disc(s, q, disc):
    """Let every disc ask its arc, as ``arcs.scan_arcs_disc`` does."""
    for i in range(LANES):
        vx, vy, energy = s[VX + i], s[VY + i], s[ENERGY + i]
        best, feature, number = s[BEST + i], s[FEATURE + i], s[ID + i]
        sx, sy, fx, fy, radius, wide = s[E4 + i], s[E5 + i], s[E6 + i], s[E7 + i], s[E8 + i], s[E9 + i]
        slack = s[TOLERANCE + i] + disc * 2.0**-42
        wx, wy = s[X + i] - s[E0 + i], s[Y + i] - s[E1 + i]
        ex, ey = wx + sx, wy + sy
        power = wx * (wx + 2.0 * sx) + wy * (wy + 2.0 * sy)
        along = ex * vx + ey * vy
        cross = abs(ex * vy - ey * vx)
        speed = s[SPEED + i]
        asked = (q[NEXT + i] >= q[ARCS + i]) & (q[NEXT + i] < q[CORNERS + i]) & ((power < 0.0) | (along < 0.0))
        reach = radius + disc
        square = (reach * speed - cross) * (reach * speed + cross)
        c = power - disc * (2.0 * radius + disc)
        t_out = c / (math.sqrt(square if square > 0.0 else 0.0) - along)
        t_out = t_out if c > 0.0 else 0.0
        from_outside = (
            (power >= 0.0)
            & (reach * speed >= cross)
            & spans(sx, sy, fx, fy, radius, wide, ex + t_out * vx, ey + t_out * vy, slack)
        )
        reach = radius - disc
        square = (reach * speed - cross) * (reach * speed + cross)
        root = math.sqrt(square if square > 0.0 else 0.0)
        c = power + disc * (2.0 * radius - disc)
        overlaps = (c >= 0.0) & (along > 0.0)
        again = (s[LAST + i] == number) & (energy * abs(c) > WELL_KNOWN * along * along)
        above, below = (root - along, energy) if along <= 0.0 else (-c, along + root)
        above, below = (-2.0 * along, energy) if again else (above, below)
        t_in = above / below
        t_in = 0.0 if overlaps else t_in
        from_inside = (
            (reach > 0.0)
            & ((overlaps & (power < 0.0)) | ((not overlaps) & (again | (reach * speed >= cross))))
            & (t_in >= 0.0)
            & spans(sx, sy, fx, fy, radius, wide, ex + t_in * vx, ey + t_in * vy, slack)
        )
        t = t_out if from_outside else t_in
        sooner = _edge_is_sooner(t, number, best, feature)
        met = asked & (from_outside | from_inside) & sooner
        s[BEST + i] = t if met else best
        s[FEATURE + i] = number if met else feature
