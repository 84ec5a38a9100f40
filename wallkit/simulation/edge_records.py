"""Edges and vertices of walls as the kernels see them: lines, arcs, corners."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from wallkit.geometry.arrays import FloatArray, IntArray
from wallkit.geometry.bulge_arcs import offset_of, radius_of
from wallkit.kernels.index.wall_records import LINE_SIZE, write_corners, write_lines
from wallkit.kernels.records import ARC, CORNER, FAN, LINE, Arc, Line
from wallkit.simulation.aligned_arrays import on_cache_lines
from wallkit.simulation.by_kernels import Kernels

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


class Lines(NamedTuple):
    """Edges, arcs among them by their chords.

    Attributes:
        records: (E,) ``LINE``.
        wall: (E,) the wall of each.
        around: how long those of closed walls are together.
        along: how long those of open walls are.
    """

    records: NDArray[Any]
    wall: IntArray
    around: float
    along: float


def columns(table: FloatArray) -> FloatArray:
    """(2, n) of (n, 2): passes over a column are many times as quick as over rows of two."""
    return np.ascontiguousarray(table.T)


def lines_of(
    vertices: FloatArray,
    offsets: IntArray,
    closed: NDArray[np.bool_],
    origin: FloatArray,
    *,
    machine_code: bool = False,
) -> Lines:
    """Make a ``LINE`` of each edge of walls, in coordinates local to an origin; see ``Walls`` for the arrays."""
    kernels, count = Kernels(machine_code), len(vertices) - int(np.count_nonzero(~closed))
    records, wall = on_cache_lines(count, LINE), np.empty(count, dtype=np.int64)
    written = (
        (records.view(np.float64), wall) if machine_code else (kernels.room(LINE_SIZE * count, float), [0] * count)
    )
    given = kernels.given((np.ravel(vertices), tuple(origin.tolist()), offsets, closed))
    around, along = kernels.run(write_lines, *given, *written)
    if not machine_code:
        records.view(np.float64)[:], wall[:] = written
    return Lines(records, wall, around, along)


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
    offsets: IntArray,
    closed: NDArray[np.bool_],
    origin: FloatArray,
    lines: NDArray[Any],
    arcs: NDArray[Any] | None,
    bulges: FloatArray,
    size: float,
    radius: float,
    *,
    across: bool = False,
    machine_code: bool = False,
) -> Corners:
    """Tell for each vertex where a disc can touch it, see ``write_corners``; ``bulges`` are those of the edges."""
    kernels, count = Kernels(machine_code), len(vertices)
    corners, fans = on_cache_lines(count, CORNER), np.empty(count, dtype=FAN)
    opened: Any = np.empty(count, dtype=np.uint8)
    flat = corners.view(np.float64), fans.view(np.float64)
    written: Any = (*flat, opened) if machine_code else (*([0.0] * len(one) for one in flat), [0] * count)
    normals = None if arcs is None else np.concatenate(end_normals(lines, bulges)).T.reshape(-1)
    given = kernels.given((np.ravel(vertices), tuple(origin.tolist()), offsets, closed, lines, normals, arcs))
    kernels.run(write_corners, *given, size, radius, int(across), *written)
    if not machine_code:
        flat[0][:], flat[1][:], opened[:] = written
    return Corners(corners, fans, opened.view(np.bool_))


def end_normals(lines: NDArray[Any], bulges: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Give (2, E) outward normals at the end and at the start of each edge: an arc's are its chord's, turned."""
    normals = np.stack([lines["nx"], lines["ny"]])
    if not bulges.any():
        return normals, normals
    b = np.where(np.abs(bulges) > FLAT, bulges, 0.0)  # tan of half the angle between arc and chord
    along, across = (1.0 - b * b) / (1.0 + b * b) * normals, 2.0 * b / (1.0 + b * b) * normals
    turned = np.stack([-across[1], across[0]])
    return along + turned, along - turned
