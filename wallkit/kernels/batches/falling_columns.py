"""What a falling wave knows of its balls, and of what they ask: flat arrays, LANES or PAIRS for each number.

So the compiler sees that nothing aliases, and vector instructions do the work. Each name is where its numbers begin.
LANES, PAIRS and PER_TURN are those of ``wave_columns``.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from wallkit.kernels.batches.wave_columns import LANES, PAIRS, PER_TURN
from wallkit.kernels.intrinsics import AT_ONCE, numbers_of
from wallkit.kernels.records import Line


class Faller(NamedTuple):
    """What a ball asks with, one cache line, fetched for each pair that it is in: as its flight began."""

    x: float
    y: float
    vx: float
    vy: float
    tolerance: float
    """How far its position may be off by rounding."""
    last: float
    """The feature that it met last, or NONE."""
    skipped: float
    """The line that it has just left along it, or NONE."""
    back: float
    """When it falls back on the end of a wall that it left, or NEVER."""


FALLER = np.dtype([(name, np.float64) for name in Faller._fields])
(
    X, Y, VX, VY, BEST, FEATURE, TOUCHED, FLIES, NOW, THEN, TURN, STILL_X, STILL_Y, LEVEL, STEEP,
    AT_X, AT_Y, AT_VX, AT_VY, BACK_X, BACK_Y, COLUMN, ROW, LEFT, RIGHT, LOW, HIGH, SIDEWAYS,
) = (LANES * number for number in range(28))  # fmt: skip
"""By ball: its flight's start, its contact so far (time, feature, how many edges it touched where it began), whether it
flies. Times since the start: NOW until when it has walked, THEN when it leaves the rectangle in which it is, TURN when
its octant changes next; that is when a velocity is 0 (STILL) or both are equal (LEVEL) or opposite (STEEP). Its place
and velocity now, whether they go back, its column and row; the rectangle, in units, and whether it leaves it by a
side."""
FLOATS = 28 * LANES
(
    FROM_X, FROM_Y, FROM_VX, FROM_VY, TOLERANCE, LAST, SKIPPED, ID, AX, AY, NX, NY, LENGTH, T, LATER_T,
) = (FLOATS + PAIRS * number for number in range(15))  # fmt: skip
"""By pair: what the ball's ``Faller`` and the line that it asks have, and its ID; when it meets the near side, and
when, after that, the far one."""
FLOATS += 15 * PAIRS
ASKS_LINE = numbers_of(
    Faller, x=FROM_X, y=FROM_Y, vx=FROM_VX, vy=FROM_VY, tolerance=TOLERANCE, last=LAST, skipped=SKIPPED
)
LINE_NUMBERS = ((0, ID), *numbers_of(Line, ax=AX, ay=AY, nx=NX, ny=NY, length=LENGTH))
"""What is fetched for a pair."""
NEXT, ARCS, CORNERS, END, OCTANT, AT, CLEARING = (LANES * number for number in range(7))
COUNTS = 7 * LANES
"""By ball, unsigned: what its cell lists, NEXT the first of it (see ``Cell``); where the clearings of its octant begin,
where in ``Model.clearings`` it looks, and what stands there."""
ROOM = PER_TURN * LANES + AT_ONCE
IDS, FALLERS = 0, ROOM
LISTED = 2 * ROOM
"""Pairs of a turn: the ids, and which balls ask them."""


class FallScratch(NamedTuple):
    """Memory to work in: contents do not matter."""

    fallers: Any
    """(LANES,) ``Faller``."""
    floats: Any
    """FLOATS floats."""
    counts: Any
    """COUNTS unsigned integers, which need no look whether they count from the end."""
    pairs: Any
    """LISTED unsigned integers."""
    balls: Any
    """(LANES,) signed integers: the ball of each lane."""
    states: Any
    """(LANES, STATE_SIZE) floats, see ``State``."""
    tallies: Any
    """(LANES, 10) signed integers, see ``Counts``."""
    log: Any
    """No floats."""
