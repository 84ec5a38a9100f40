"""What the kernels see of discs that meet: a row a disc, cells, and the queue of what is due.

A disc's state is that of its last contact and stands until the next one: neither a border of a cell nor another disc's
contact changes a bit of it. So the contacts are the same, bit for bit, for any size of the cells.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

X, Y, VX, VY, TIME, LOST, DUE, RADIUS, LEAVE, MASS = range(10)
"""Row of floats of a disc: in its first line of the cache, which other discs ask for, its state after its last contact;
the time of that and what the time lost to rounding; when its next contact is due; its radius. In the second one: when
it leaves its cell; its mass."""
CELL, PARTNER, NUMBER, BOUNCES, MET, BEING, PLACE, STEP, AFTER = range(20, 29)
"""Row of whole numbers of a disc, in the same two lines, behind MASS: its cell; with what its next contact is; its
number in the scene; contacts so far; the disc that it met last and has not parted from by another contact; how it is,
see FLYING and the following; its place in the heap, or UNHEAPED; to which side it leaves its cell; the next disc of its
cell, or NOBODY."""
FLOATS, NUMBERS = 16, 32
"""Columns of such a row as floats, and as whole numbers."""

NOBODY, WALL, LOOK, NOTHING = 2**32 - 1, 2**32 - 2, 2**32 - 3, 2**32 - 4
"""In place of a disc: none; and what is due otherwise: a contact with a wall, a search for what is due, nothing."""
DISCS = 2**32 - 4
"""All below are discs."""
UNHEAPED = 2**32 - 1
"""In place of a place in the heap."""
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
    """Square cells, see ``cell_list``; those at the border reach out to infinity."""

    x0: float
    y0: float
    side: float
    columns: int
    rows: int
    shift: int
    """A row of tiles has 1 << shift of them."""


SIZE, PRESENT, PASSED, LEFT = range(4)
"""Whole numbers of the queue: discs in the heap; the present stretch of time; stretches passed, and events left, since
it was planned, and until it is planned anew."""
ROOM = 16
"""Whole numbers of a list of the queue."""
BEGIN, RATE = range(2)
"""Floats of the queue: time at which stretch 0 begins, stretches a unit of time."""


class Queue(NamedTuple):
    """What is due first, see ``event_queue``."""

    lists: Any
    """Lists of at most ROOM discs, a line of the cache each, by stretch of time modulo their number, a power of two."""
    filled: Any
    """How many discs are in each; apart from them, so that a disc is written to its list without waiting for it."""
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
    """(n, FLOATS) floats: see X and the following."""
    link: Any
    """(n, NUMBERS) unsigned: see CELL and the following; the same memory as ``ball``, in other columns."""
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
