"""What the kernels see of a scene: flat arrays of floats, and None for what the scene lacks.

The same tuples hold NumPy arrays (of records) for the compiled kernels and lists (of named tuples) of Python floats
for the interpreted ones; both are read as ``lines[i].ax``, so that one source serves and gives the same bits.
Ids and what counts them are unsigned: they need no look whether they count from the end.
Coordinates are local (see ``wallkit.simulation.modelled``).
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np


class State(NamedTuple):
    """The columns of the state of a ball, floats: ``state[STATE.x]``."""

    x: Any
    y: Any
    vx: Any
    vy: Any
    time: Any
    lost: Any
    """What the time lost to rounding."""
    energy: Any
    """Speed squared; under gravity less 2 g.p, which a flight keeps."""
    from_x: Any
    from_y: Any
    """Where the last flight of a point began."""
    from_vx: Any
    from_vy: Any
    """Its velocity there."""
    tolerance: Any
    """How far positions may be off by rounding."""


class Counts(NamedTuple):
    """The columns of the integer state of a ball: ``counts[COUNT.last]``; and such a state.

    Last feature; bounces; ending or RUNNING; contacts in a row without time; feature that holds it, or NO_HIT; how it
    does, see FREE and the following; on which side of it the ball is, 1 the outward one of its wall, -1 the other; how
    often, in a row, it turned there; changes from feature to feature since the last bounce; what it met before that.
    """

    last: int
    bounces: int
    ending: int
    still: int
    held: int
    hold: int
    side: int
    turns: int
    changes: int
    before: int


class LogRow(NamedTuple):
    """The columns of a contact in the log, which is flat: ``log[row * LOG_STRIDE + LOG.time]``."""

    time: Any
    x: Any
    y: Any
    """The centre."""
    vx: Any
    vy: Any
    """After the contact."""
    px: Any
    py: Any
    """The contact point."""
    nx: Any
    ny: Any
    """Unit normal towards the ball."""
    feature: Any
    kind: Any
    """EDGE, VERTEX, SLIDE or LEAVE."""


STATE, STATE_SIZE = State(*range(12)), 12
COUNT = Counts(*range(10))
LOG, LOG_STRIDE = LogRow(*range(11)), 11

NO_HIT = -1
"""No feature. Edge e is the feature e, corner j is the feature -2 - j."""
END_OF_EDGE = -(2**61)
"""In place of a feature: a ball that keeps to a wall comes to the end of the edge, or of the corner, that holds it."""
LIFTS, TURNS, GOES_ON, TIME_IS_UP = -(2**61) - 1, -(2**61) - 2, -(2**61) - 3, -(2**61) - 4
"""In place of a feature: nothing presses a ball that keeps to a wall on it any longer; it stands still and turns; it
is as far as was looked ahead; its time is up."""
COLLAPSES = -(2**60)
"""In place of a feature: an exact corner hit that the ball does not get out of."""
AMBIGUOUS = -(2**62)
"""In place of a feature: an exact corner hit whose outcome depends on which wall comes first."""
FALLS_BACK = -(2**62) - 1
"""In place of a feature: a point falls back along a wall to its upper end, see ``falling_back``."""

RUNNING = -1
NO_ROW = -1
"""In place of the kind of a contact: there is none to note."""
EDGE, VERTEX, SLIDE, LEAVE, BALL = 0, 1, 2, 3, 6
FREE, JOINING, SLIDING, LEAVING, LEFT, WEDGED, PASSING, STARTING = 0, 1, 2, 3, 4, 5, 6, 7
"""How a feature holds a ball under gravity: not; from the next moment, when its bounces have died; now; until the next
moment; until just now; together with another one; from the next moment, without a bounce; it has still to be looked,
as the ball starts."""
TIME_REACHED, BOUNCE_LIMIT, LEFT_SCENE, AT_REST, COLLAPSE, AMBIGUOUS_CORNER, ABSORBED, SWINGING = 0, 1, 2, 3, 4, 5, 6, 7


class Line(NamedTuple):
    """An edge from a to b; n is the outward unit normal as rounded, twice = 2 / (n.n)."""

    ax: float
    ay: float
    bx: float
    by: float
    nx: float
    ny: float
    length: float
    twice: float


class Arc(NamedTuple):
    """A circular arc, counter-clockwise from a to b, a = c + s.

    sweep is its angle, in radians, below 0 if the wall runs clockwise, from b to a (then its outward side is the inside
    of the circle).
    """

    ax: float
    ay: float
    bx: float
    by: float
    sx: float
    sy: float
    radius: float
    sweep: float


class Corner(NamedTuple):
    """A vertex, and the sum of the outward normals of its edges: which side of a one-sided wall a centre is on."""

    x: float
    y: float
    sx: float
    sy: float


class Joint(NamedTuple):
    """An end of an edge: 2 e where edge e begins, 2 e + 1 where it ends.

    (tx, ty) is the unit direction in which the edge goes from there; then come the ends that are next around the place,
    which may be this one itself, the vertex, and the lowest end at the place, which stands for it.
    """

    tx: float
    ty: float
    clockwise: int
    counter: int
    vertex: int
    place: int


class Cell(NamedTuple):
    """A cell of the index, and what is listed in it: ids from ``first`` to before ``end``.

    Lines come first, then arcs (from ``arcs`` on), then corners (from ``corners`` on). An empty
    cell stores its Chebyshev distance (cells, at least 1) to the nearest cell with entries, in all four fields; without
    gravity it is 1 in a cell that is not part of another, for which flights have clearings. Where
    ``end`` is before ``first`` the cell is divided into 2^arcs by 2^arcs smaller ones, row by row from the cell
    ``first`` on, and lists nothing itself.
    """

    first: int
    arcs: int
    corners: int
    end: int


class Fan(NamedTuple):
    """The directions in which a disc can touch a vertex: from u counter-clockwise to w; ``wide`` is 1 for all.

    ``both`` is 1 where it may touch it in the opposite directions too: by rounding, and at the free end of an edge that
    a disc may stand across.
    """

    ux: float
    uy: float
    wx: float
    wy: float
    wide: float
    both: float


class Block(NamedTuple):
    """Square cells, row by row from the cell ``first`` on, and what is to be entered in them.

    That is ids from ``start`` to ``end``: lines, then arcs (from ``arcs`` on), then corners (from ``corners`` on).
    """

    x0: float
    y0: float
    side: float
    per_side: float
    """1 / side."""
    reach: float
    """So much to each side is entered too."""
    columns: int
    rows: int
    first: int
    start: int
    arcs: int
    corners: int
    end: int
    most: int
    """Entries it may come to; with more it is given up."""


# The same fields as records of arrays: eight floats, a cache line, for a line or an arc.
LINE = np.dtype([(name, np.float64) for name in Line._fields])
ARC = np.dtype([(name, np.float64) for name in Arc._fields])
CORNER = np.dtype([(name, np.float64) for name in Corner._fields])
OCTANTS = 8
"""A flight goes in one of them, see ``grid.octant_of``."""
FIRST_CLEARING, PACKED = 8, 4
"""Where packed clearings begin after their cell, and bits of the room that both take, in numbers of 16 bits."""
QUADRANTS = 4
"""For points, which meet a line from both its sides, octants are no better than these."""
HALF, WIDEST = 7, 127
"""Bits of a clearing's width and of its height, in cells, and what they hold."""
JOINT = np.dtype([(name, np.float64 if place < 2 else np.int64) for place, name in enumerate(Joint._fields)])
# Unsigned 32 bits hold four thousand million entries, and four of them are a quarter of a cache line.
CELL = np.dtype([(name, np.uint32) for name in Cell._fields])
FAN = np.dtype([(name, np.float64) for name in Fan._fields])
BLOCK = np.dtype([(name, np.float64 if place < 5 else np.int64) for place, name in enumerate(Block._fields)])
_RECORDS: dict[Any, Any] = {LINE: Line, ARC: Arc, CORNER: Corner, JOINT: Joint, CELL: Cell, FAN: Fan, BLOCK: Block}


def in_lists(value: Any) -> Any:
    """Give lists of Python floats, and of named tuples, for arrays: several times faster to interpret."""
    if isinstance(value, np.ndarray):
        if value.dtype.names is None:
            return value.tolist()
        return list(map(_RECORDS[value.dtype]._make, value.tolist()))
    if isinstance(value, tuple):
        items = (in_lists(item) for item in value)
        return type(value)(*items) if hasattr(value, "_fields") else tuple(items)
    return value


class Grid(NamedTuple):
    """Square cells, row by row, some of them divided again and again.

    Places in it are counted in units: whole numbers of the side of the smallest cell, so that all cells begin and end
    at whole numbers and the walk through them is exact whatever their sizes.
    """

    x0: float
    y0: float
    unit: float
    per_unit: float
    """1 / unit."""
    shift: int
    """A cell that is not part of another one has the side 2^shift, in units."""
    columns: int
    rows: int
    """Of cells that are not part of another one."""
    octants: int
    """Directions of flight for which such a cell has clearings: OCTANTS or QUADRANTS."""
    departs: int
    """1 if there are departures, else 0."""
    packed: int
    """1 if a record with the clearings of a cell comes after its own, so that one fetch serves both; 0 if
    clearings lie octant by octant, so that more of them stay in the cache."""


class Model(NamedTuple):
    """All that a flight needs to know of its scene."""

    ids: Any
    """Edges and vertices cell by cell, unsigned; with a grid AT_ONCE more at the end, so many are read at once."""
    cells: Any
    """``Cell``; without a grid one lists all."""
    grid: Any
    """``Grid``, or None."""
    clearings: Any
    """At ``grid.clearing_at``: by octant of flight and by cell that is not part of another, a large rectangle of cells
    that begins with it, extends in that octant, and lists nothing that a flight in it may meet. It is width +
    2^HALF * height, in cells; 0 where the cell lists something to be met. At ``grid.departures_of`` the like for points
    that leave a wall: what they leave may be listed too. Packed clearings are in the memory of ``cells``."""
    lines: Any
    """``Line`` by edge; the chord of an arc."""
    arcs: Any
    """``Arc`` by edge, of radius 0 for a line; None when all edges are lines."""
    corners: Any
    """``Corner`` by vertex."""
    edge_wall: Any
    corner_wall: Any
    edge_tally: Any
    """By edge: to which of the counts of bounces one off it is added, its wall's or its own."""
    corner_tally: Any
    """By vertex: the same."""
    restitution: Any
    """By wall: normal, tangential; None when all are 1."""
    static_friction: Any
    """By wall: its coefficient; None when all are 0, or without gravity."""
    one_sided: Any
    """By wall: 1 when solid from its outward side alone; None when all are two-sided."""
    fans: Any
    """``Fan`` by vertex, none for points; None when all walls are two-sided."""
    gravity: Any
    """(gx, gy), or None."""
    damping: Any
    """(rolling friction, drag), one of them 0, or None; without gravity."""
    extent: float
    """Largest absolute local coordinate."""
    joints: Any
    """``Joint`` by end of an edge; None without gravity."""
    spokes: Any
    """By vertex: the lowest end of an edge at its place, or NO_HIT; None without gravity."""
    rolling: Any
    """Under gravity: coefficient of rolling friction, by which what presses a ball on a wall slows it down; or None."""
    drag: Any
    """Under gravity: rate k of dv/dt = g - k v, or None."""
