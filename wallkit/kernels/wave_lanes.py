"""What a wave of balls knows of each: flat arrays, LANES for each number.

So the compiler sees that nothing aliases, and vector instructions do the work. Each name is where its LANES begin.
"""

from __future__ import annotations

from wallkit.kernels.model import NO_HIT

LANES = 32
"""So few that a wave stays in the nearest cache, beside what it looks at."""
(
    X, Y, VX, VY, TIME, LOST, ENERGY, SPEED, PER_ENERGY, DOUBT, FROM_X, FROM_Y, FROM_VX, FROM_VY, TOLERANCE,
    LAST, BEST, FEATURE, TOUCHED, FLIES,
    PX, PY, U, W, PER_U, PER_W, BORDER_X, BORDER_Y, COLUMN, ROW,
    ID, E0, E1, E2, E3, E4, E5, E6, E7, FROM, ALONG, POWER, SQUARE, T, NX, NY, TWICE,
) = (LANES * number for number in range(47))  # fmt: skip
FLOATS = 47 * LANES
"""The ball as in ``flight.fly``, with its speed and by how much e.v may be off at a contact; its contact so far; in
units of the grid, its place and velocity, their inverses, the borders ahead, and where it goes; the edge or corner that
it looks at, its ID and the numbers of its record; what is found of an arc on the way to the time of impact; the normal
where it turns, and 2 / (n.n)."""
INSIDE, NEITHER, OUTSIDE, EITHER, CHORD = -1.0, 0.0, 1.0, 2.0, 3.0
"""FROM where a disc may meet its arc: EITHER side stands for outside, else inside. E0 to E3, read when that is found,
then hold e and f (see ``arcs``)."""
NONE = float(NO_HIT)
(
    NEXT, NEXT_CORNER, ARCS, CORNERS, END, WAY, TOP, AT, CLEARING, CROSSES, ENTERED,
) = (LANES * number for number in range(11))  # fmt: skip
COUNTS = 11 * LANES
"""NEXT: place in ``Model.ids`` of what a ball looks at: a line before that in ARCS, an arc before that in CORNERS,
else nothing; discs look at a corner in the same turn, at NEXT_CORNER before END. WAY is where the clearings of its way
begin, TOP its cell, AT where in ``Model.clearings`` it looks; what stands there is the CLEARING. Whether a ball CROSSES
is 1 or 0; ENTERED holds the bits of those that have entered a cell."""

BALL, BOUNCES, STILL, ENDING = (LANES * number for number in range(4))
INTEGERS = 4 * LANES
"""Signed: the ball, its bounces, its contacts in a row without time, and how it ends."""
