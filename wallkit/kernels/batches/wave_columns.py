"""What a wave knows of its balls, and of what they ask: flat arrays, LANES or PAIRS for each number.

So the compiler sees that nothing aliases, and vector instructions do the work. Each name is where its numbers begin.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from wallkit.kernels.intrinsics import AT_ONCE, numbers_of
from wallkit.kernels.records import NO_HIT, Corner, Line

LANES = 32
"""Balls of a wave: so few that it stays in the L1 cache, beside what it looks at, and a bit for each in 32."""
PER_TURN = AT_ONCE
"""So many lines, arcs and corners of its cell a ball asks in a turn at most; most cells list fewer."""
PAIRS = 56
"""Pairs of a ball and what it asks that are worked on together: mostly all of a turn, and a bit for each in 64."""


class Mover(NamedTuple):
    """What a ball asks with, one cache line: fetched for each pair that it is in."""

    x: float
    y: float
    vx: float
    vy: float
    energy: float
    """Squared speed."""
    speed: float
    tolerance: float
    """How far its position may be off by rounding."""
    last: float
    """The feature that it met last, or NONE."""


MOVER = np.dtype([(name, np.float64) for name in Mover._fields])

(
    TIME, LOST, FROM_X, FROM_Y, FROM_VX, FROM_VY, BEST, FEATURE, TOUCHED, FLIES,
    PX, PY, U, W, PER_U, PER_W, BORDER_X, BORDER_Y, COLUMN, ROW, NX, NY, TWICE,
) = (LANES * number for number in range(23))  # fmt: skip
"""By ball: its time, what that lost to rounding, where a point's flight began, its contact so far (time, feature, and
whether it touched an edge where it began), whether it flies; in units of the grid, its place and velocity, their
inverses, the borders ahead, and where it goes; the normal where it turns, and 2 / (n.n)."""
(
    X, Y, VX, VY, ENERGY, SPEED, TOLERANCE, LAST, ID, E0, E1, E2, E3, E4, E5, E6, E7,
    FROM, ALONG, POWER, SQUARE, T,
) = (23 * LANES + PAIRS * number for number in range(22))  # fmt: skip
"""By pair: the ball's ``Mover``; the feature that it asks, its ID and the numbers of its record; what is
found of an arc on the way to the time of impact, and that."""
FLOATS = 23 * LANES + 22 * PAIRS
_MOVES = {"x": X, "y": Y, "vx": VX, "vy": VY, "tolerance": TOLERANCE, "last": LAST}
ASKS_LINE, ASKS_CORNER = numbers_of(Mover, **_MOVES), numbers_of(Mover, energy=ENERGY, **_MOVES)
ASKS_ARC = numbers_of(Mover, energy=ENERGY, speed=SPEED, **_MOVES)
LINE_FOR_DISC = ((0, ID), *numbers_of(Line, ax=E0, ay=E1, nx=E4, ny=E5, length=E6))
LINE_FOR_POINT = (*LINE_FOR_DISC, *numbers_of(Line, bx=E2, by=E3))
CORNER_PLACE = ((0, ID), *numbers_of(Corner, x=E0, y=E1))
WHOLE_ARC = ((0, ID), *enumerate((E0, E1, E2, E3, E4, E5, E6, E7), 1))
"""What is fetched for a pair of what a ball brings with it, and of a record."""
INSIDE, NEITHER, OUTSIDE, EITHER, CHORD = -1.0, 0.0, 1.0, 2.0, 3.0
"""FROM where a disc may meet its arc: EITHER side stands for outside, else inside. E0 to E3, read when that is found,
then hold e and f (see ``arc_impact``)."""
NONE = float(NO_HIT)
(
    NEXT, ARCS, NEXT_ARC, CORNERS, NEXT_CORNER, END, OCTANT, TOP, AT, CLEARING, CROSSES, ASKING, PAIRED,
) = (LANES * number for number in range(13))  # fmt: skip
COUNTS = 13 * LANES
"""By ball: NEXT is the place in ``Model.ids`` of the next line that it asks, before that in ARCS; so for arcs, from
NEXT_ARC to CORNERS, and for corners, from NEXT_CORNER to END. OCTANT is where the clearings of its octant begin, TOP
its cell, AT where in ``Model.clearings`` it looks; what stands there is the CLEARING. Whether a ball CROSSES is 1 or 0;
ASKING holds the bits of those that have more to ask in their cell than what is paired; three numbers from PAIRED on,
how many lines, arcs and corners are."""
ROOM = PER_TURN * LANES + AT_ONCE
LINE_IDS, LINE_MOVERS, ARC_IDS, ARC_MOVERS, CORNER_IDS, CORNER_MOVERS = (ROOM * number for number in range(6))
LISTED = 6 * ROOM
"""Pairs of a turn, by kind: the ids, and which balls ask them."""

BALL, BOUNCES, STILL, ENDING = (LANES * number for number in range(4))
INTEGERS = 4 * LANES
"""Signed: the ball, its bounces, its contacts in a row without time, and how it ends."""
