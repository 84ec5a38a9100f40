"""What the kernels see of discs that meet: two short rows a disc, cells, and the queue of what is due.

A disc's state is that of its last contact and stands until the next one: neither a border of a cell nor another disc's
contact changes a bit of it. So the contacts are the same, bit for bit, for any size of the cells.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

X, Y, VX, VY, TIME, LOST, DUE, RADIUS = range(8)
"""Row of floats of a disc, a line of the cache: its state after its last contact; the time of that and what the time
lost to rounding; when its next contact is due; its radius."""
CELL, PARTNER, NUMBER, BOUNCES, MET, BEING, NEXT, PREVIOUS = range(8)
"""Row of whole numbers of a disc: its cell; with what its next contact is; its number in the scene; contacts so far;
the disc that it met last and has not parted from by another contact; how it is, see FLYING and the following; and where
it stands in the queue: the disc after it in its list, HEAPED or UNLISTED; the disc before it, or STRETCH and the number
of the list that it leads, or its place in the heap."""

NOBODY, WALL, LOOK, NOTHING = 2**32 - 1, 2**32 - 2, 2**32 - 3, 2**32 - 4
"""In place of a disc: none; and what is due otherwise: a contact with a wall, a search for what is due, nothing."""
DISCS = 2**32 - 4
"""All below are discs."""
HEAPED, UNLISTED, STRETCH = 2**32 - 2, 2**32 - 3, 2**31
"""Marks of NEXT and PREVIOUS; discs are fewer than STRETCH."""
FLYING, FRESH, FIXED, OUT = 0, 1, 2, 3
"""How a disc is: flying since a contact with a wall; flying since a contact with a disc (its cold state is to be made
anew); ended where it stands, and met as if it had no end of mass; ended and taken out: no disc meets it."""
ENERGY, FROM_X, FROM_Y, FROM_VX, FROM_VY, TOLERANCE, STILL = range(7)
"""Row of what else a flight alone knows of a disc, see ``State``, since its last contact with a wall; and how many
contacts in a row rounding does not tell apart."""
ROW = 17
"""Floats of a contact in the log: those of a contact with a wall (``LOG_STRIDE``), then ball, other (-1 for none), and
the other's centre and velocity."""
NEVER = math.inf


class Cells(NamedTuple):
    """Square cells, row by row; those at the border reach out to infinity."""

    x0: float
    y0: float
    side: float
    columns: int
    rows: int
    shift: int
    """Row r begins at the cell r << shift."""


SIZE, PRESENT, PASSED, LEFT = range(4)
"""Whole numbers of the queue: discs in the heap; the present stretch of time; stretches passed, and events left, since
it was planned, and until it is planned anew."""
BEGIN, RATE = range(2)
"""Floats of the queue: time at which stretch 0 begins, stretches a unit of time."""


class Queue(NamedTuple):
    """What is due first, see ``event_queue``."""

    first: Any
    """By stretch of time, modulo their number, a power of two: the first disc of its list, or NOBODY."""
    heap: Any
    """(n,) discs of the present stretch and before: that at k comes before those at 2 k + 1 and 2 k + 2."""
    times: Any
    """(n,) what is due for them when."""
    state: Any
    """See SIZE and the following."""
    scale: Any
    """See BEGIN and RATE."""


class Discs(NamedTuple):
    """All that meeting needs to know of the discs of a scene; coordinates are local, as in ``Model``."""

    ball: Any
    """(n, 8) floats: see X and the following."""
    link: Any
    """(n, 8) unsigned: see CELL and the following."""
    after: Any
    """(n,) the next disc of its cell, or NOBODY."""
    mass: Any
    """(n,)."""
    leave: Any
    """(n,) when it leaves its cell."""
    step: Any
    """(n,) by how much the number of its cell changes then."""
    queue: Queue
    head: Any
    """By cell: its first disc, or NOBODY."""
    near: Any
    """By cell: 1 where a disc whose centre is in it may touch a wall."""
    cells: Cells
    restitution: Any
    """(normal, tangential) between discs; None where both are 1."""
    cold: Any
    """(n, 7) floats: see ENERGY and the following."""
    counts: Any
    """(n, len(Counts)) whole numbers of 32 bits, as ``fly`` knows them; bounces are counted in ``link`` alone."""
    hop: float
    """Speed at which a disc leaves what it would come to lie on under gravity, see ``wall_contacts``."""
    tries: Any
    """((STATE_SIZE,), (len(Counts),), (W,), (LOG_STRIDE,)): a state, counts, hits and log to try a flight with."""
    start: Any
    """(len(Counts),) counts of a ball at its start."""
