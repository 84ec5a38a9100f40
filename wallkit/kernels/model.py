"""What the kernels see of a scene: flat arrays of floats, and None for what the scene lacks.

The same tuples hold NumPy arrays for the compiled kernels and lists of Python floats for the interpreted ones;
both are read as ``a[i]``, so that one source serves and gives the same bits. Coordinates are local (see
``Scene.arrays``).
"""

from __future__ import annotations

from typing import Any, NamedTuple

EDGE_STRIDE = 8
"""An edge entry: ax, ay, bx, by, nx, ny, length, unused; n is the outward unit normal as rounded."""
CORNER_STRIDE = 4
"""A corner entry: x, y, and the sum of the outward normals of its edges (which side of a one-sided wall it is)."""
STATE_SIZE = 12
"""x, y, vx, vy, time, what the time lost to rounding, speed squared; for points where the last flight began (x, y)
and its velocity, and the tolerance: how far positions may be off by rounding."""
LOG_STRIDE = 11
"""time, x, y, vx, vy, px, py, nx, ny, feature, kind."""

NO_HIT = -1
"""No feature. Edge e is the feature e, corner j is the feature -2 - j."""
AMBIGUOUS = -(2**62)
"""In place of a feature: an exact corner hit whose outcome depends on which wall comes first."""

RUNNING = -1
EDGE, VERTEX = 0, 1
TIME_REACHED, BOUNCE_LIMIT, LEFT_SCENE, AT_REST, COLLAPSE, AMBIGUOUS_CORNER = 0, 1, 2, 3, 4, 5


class Grid(NamedTuple):
    """Uniform cells; the entries of cell c are start[c] to start[c + 1]."""

    edge_start: Any
    corner_start: Any
    x0: float
    y0: float
    size: float
    columns: int
    rows: int


class Model(NamedTuple):
    """All that a flight needs to know of its scene."""

    edges: Any
    edge_ids: Any
    corners: Any
    corner_ids: Any
    grid: Any
    lines: Any
    """By edge: ax, ay, bx, by, nx, ny, length, 2 / (n.n)."""
    vertices: Any
    """By corner: x, y, sum of normals."""
    edge_wall: Any
    corner_wall: Any
    restitution: Any
    """By wall: normal, tangential; None when all are 1."""
    one_sided: Any
    """By wall: 1 when solid from its outward side alone; None when all are two-sided."""
    extent: float
    """Largest absolute local coordinate."""


class Counts(NamedTuple):
    """Places in the integer state of a ball."""

    last: int = 0
    bounces: int = 1
    ending: int = 2
    still: int = 3
