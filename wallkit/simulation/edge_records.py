"""Edges and vertices of walls as the kernels see them: lines, arcs, corners."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from wallkit.geometry.arrays import FloatArray, IntArray
from wallkit.geometry.bulge_arcs import offset_of, radius_of
from wallkit.kernels.records import ARC, CORNER, FAN, LINE, Arc, Corner, Line
from wallkit.simulation.aligned_arrays import on_cache_lines

SMOOTH = 2.0**-44
"""Edges that meet at less than this angle (radians) have no corner: see ``scan_disc`` for how they overlap."""
NEARLY_STRAIGHT = 2.0**-41
"""Rounding of an edge in parts of its size, some 500 times: see ``corners_of``."""
FLAT = 2.0**-44
"""An arc with a smaller bulge is its chord, to rounding."""


class Corners(NamedTuple):
    """What discs know of vertices, by vertex."""

    records: NDArray[Any]
    """``CORNER``."""
    fans: NDArray[Any]
    """``FAN``: where a disc can touch."""
    open: NDArray[np.bool_]
    """Whether it can touch at all, but for rounding."""


def columns(table: FloatArray) -> FloatArray:
    """(2, n) of (n, 2): passes over a column are many times as quick as over rows of two."""
    return np.ascontiguousarray(table.T)


def lines_of(vertices: FloatArray, starts: IntArray, ends: IntArray) -> NDArray[Any]:
    """Make a ``LINE`` of each edge, given by its vertices; without a length it has no normal."""
    lines = on_cache_lines(len(starts), LINE)
    x, y = columns(vertices)
    ax, ay, bx, by = x[starts], y[starts], x[ends], y[ends]
    dx, dy = bx - ax, by - ay
    length = np.sqrt(dx * dx + dy * dy)
    none = length == 0.0
    with np.errstate(divide="ignore", invalid="ignore"):
        nx, ny = dy / length, -dx / length
        nx[none] = ny[none] = 0.0
        twice = 2.0 / (nx * nx + ny * ny)
    twice[none] = 0.0
    for name, column in zip(Line._fields, (ax, ay, bx, by, nx, ny, length, twice), strict=True):
        lines[name] = column
    return lines


def arcs_of(lines: NDArray[Any], bulges: FloatArray) -> NDArray[Any] | None:
    """Make an ``ARC`` of each edge, of radius 0 where it is a line; None if all are.

    See ``wallkit.geometry.bulge_arcs`` for the circle of a bulge. An arc that bows less than 2^-44 of its chord is the
    chord.
    """
    is_arc = (np.abs(bulges) > FLAT) & (lines["length"] > 0.0)
    if not is_arc.any():
        return None
    chord, b = lines[is_arc].view(np.float64).reshape(-1, len(Line._fields)), bulges[is_arc]
    start, end = chord[:, 0:2], chord[:, 2:4]
    off = offset_of(chord[:, 6], b)[:, None]
    to_centre = (end - start) / 2 - off * chord[:, 4:6]
    left = (b > 0.0)[:, None]
    arcs = on_cache_lines(len(lines), ARC)
    arcs[:] = 0.0
    columns = [
        *np.where(left, start, end).T,
        *np.where(left, end, start).T,
        *np.where(left, -to_centre, (end - start) / 2 + off * chord[:, 4:6]).T,
        radius_of(chord[:, 6], b),
        4.0 * np.arctan(b),
    ]
    for name, column in zip(Arc._fields, columns, strict=True):
        arcs[name][is_arc] = column
    return arcs


def no_corners() -> Corners:
    """Points touch no vertex."""
    return Corners(np.empty(0, dtype=CORNER), np.empty(0, dtype=FAN), np.empty(0, dtype=np.bool_))


def corners_of(
    vertices: FloatArray,
    lines: NDArray[Any],
    arcs: NDArray[Any] | None,
    bulges: FloatArray,
    starts: IntArray,
    ends: IntArray,
    radius: float,
) -> Corners:
    """Tell for each vertex where a disc can touch it: from one normal of its edges to the other.

    Where the wall turns left the fan opens to its right, and the other way round; a free end has half a circle, a
    vertex at an edge without length all of it.

    On the other side a disc meets both edges before it meets the vertex, by radius * angle^2 / 2 farther away than
    where the edges alone would hold it. Where that is not far above the rounding of the edges (of an arc as large as
    its radius) a disc that rolls along one may pass the other unseen: there the vertex stands in for it, on ``both``
    sides.
    """
    ux, uy, wx, wy = np.zeros((4, len(vertices)))  # normals of the edge that arrives, and of the one that leaves
    (ux[ends], uy[ends]), (wx[starts], wy[starts]) = end_normals(lines, bulges)
    corners = on_cache_lines(len(vertices), CORNER)
    for name, column in zip(Corner._fields, (vertices[:, 0], vertices[:, 1], ux + wx, uy + wy), strict=True):
        corners[name] = column
    first, last = np.ones((2, len(vertices)), dtype=np.bool_)
    first[ends], last[starts] = False, False
    # Chosen by ``where``: a mask as an index takes ten times as long.
    (ux, uy), (wx, wy) = (
        (np.where(first, -wx, ux), np.where(first, -wy, uy)),
        (np.where(last, -ux, wx), np.where(last, -uy, wy)),
    )
    cross = ux * wy - uy * wx
    right = cross < 0.0
    fans = np.zeros(len(vertices), dtype=FAN)
    fans["ux"], fans["uy"] = np.where(right, -wx, ux), np.where(right, -wy, uy)
    fans["wx"], fans["wy"] = np.where(right, -ux, wx), np.where(right, -uy, wy)
    none = lines["length"] == 0.0
    bare = np.concatenate([starts[none], ends[none]])
    fans[bare] = 1.0, 0.0, 1.0, 0.0, 1.0, 0.0
    size = np.full(len(vertices), np.abs(vertices).max(initial=0.0))
    if arcs is not None:
        size[ends] += arcs["radius"]
        size[starts] += arcs["radius"]
    fans["both"] = radius * cross * cross < NEARLY_STRAIGHT * size
    opened = (np.abs(cross) > SMOOTH) | (ux * wx + uy * wy <= 0.0)
    opened[bare] = True
    return Corners(corners, fans, opened)


def end_normals(lines: NDArray[Any], bulges: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Give (2, E) outward normals at the end and at the start of each edge: an arc's are its chord's, turned."""
    normals = np.stack([lines["nx"], lines["ny"]])
    if not bulges.any():
        return normals, normals
    b = np.where(np.abs(bulges) > FLAT, bulges, 0.0)  # tan of half the angle between arc and chord
    along, across = (1.0 - b * b) / (1.0 + b * b) * normals, 2.0 * b / (1.0 + b * b) * normals
    turned = np.stack([-across[1], across[0]])
    return along + turned, along - turned
