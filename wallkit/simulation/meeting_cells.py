"""Cells for discs that meet: how large, which of them walls are near to, and an order in which neighbours are close."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from wallkit.geometry.arrays import FloatArray, IntArray
from wallkit.geometry.ragged import numbered
from wallkit.kernels.meeting.records import Cells
from wallkit.simulation.modelled import Modelled
from wallkit.simulation.prepared import spaced
from wallkit.walls import Walls

OVER = 1.0 + 2.0**-20
"""Cells are wider than the largest disc by this, far above the rounding of when a disc enters one."""
MOST = 1 << 14
"""Columns, or rows, at most."""


def cells_for(box: FloatArray, radii: FloatArray, per_disc: float) -> Cells:
    """Choose square cells over a box (x0, y0, x1, y1): ``per_disc`` a disc, or those of the largest disc."""
    most = float(radii.max(initial=0.0))
    x0, y0 = float(box[0]) - most, float(box[1]) - most
    width, height = float(box[2]) + most - x0, float(box[3]) + most - y0
    side = math.sqrt(width * height / max(len(radii), 1) / per_disc)
    side = max(side, 2.0 * most * OVER, max(width, height) / MOST) or 1.0
    columns, rows = max(1, math.ceil(width / side)), max(1, math.ceil(height / side))
    return Cells(x0, y0, side, columns, rows, ((columns - 1) // 4).bit_length())


def box_of(modelled: Modelled, position: FloatArray) -> FloatArray:
    """(4,) box around the walls and (n, 2) places, in local coordinates."""
    box = np.array(modelled.box, dtype=np.float64) - np.tile(modelled.origin, 2)
    if not np.isfinite(box).all():  # there are no walls
        box = np.array([np.inf, np.inf, -np.inf, -np.inf])
    if len(position):
        box = np.concatenate([np.minimum(box[0:2], position.min(axis=0)), np.maximum(box[2:4], position.max(axis=0))])
    return box if np.isfinite(box).all() else np.zeros(4)


def cell_of(cells: Cells, position: FloatArray) -> IntArray:
    """(n, 2) column and row of places."""
    place = np.floor((position - (cells.x0, cells.y0)) / cells.side)
    found: IntArray = np.clip(place, 0, (cells.columns - 1, cells.rows - 1)).astype(np.int64)
    return found


def along_a_curve(place: IntArray) -> IntArray:
    """Order (n, 2) columns and rows along Morton's curve."""
    low, high = spaced(place & 1023), spaced(place >> 10)
    return np.argsort((high[:, 0] | high[:, 1] << 1) << 20 | low[:, 0] | low[:, 1] << 1, kind="stable")


def near_walls(walls: Walls, origin: FloatArray, cells: Cells, radius: float) -> NDArray[Any]:
    """By cell: 1 where a disc of at most that radius whose centre is in it may touch a wall.

    Each edge is cut into pieces as long as a cell, or of a turn of pi / 8 on an arc; the boxes of these, widened by
    the radius, and by what an arc bows beyond its chord, cover all such places.
    """
    near = np.zeros((-(-cells.rows // 4) * 4, 4 << cells.shift), dtype=np.uint8)
    start = walls.edge_starts
    a, b, bulge = walls.vertices[start] - origin, walls.vertices[walls.edge_ends] - origin, walls.bulges[start]
    turn = 4.0 * np.arctan(np.abs(bulge))
    length = np.hypot(*(b - a).T) * np.maximum(1.0, np.abs(bulge)) * (math.pi / 2)
    pieces = np.maximum(np.ceil(length / cells.side), np.ceil(turn * (8.0 / math.pi)))
    edge, rank = numbered(np.maximum(pieces, 1.0).astype(np.int64))
    count = np.maximum(pieces, 1.0)[edge]
    one, two = (_along(a[edge], b[edge], bulge[edge], part / count) for part in (rank, rank + 1))
    bow = np.hypot(*(two - one).T) * np.abs(np.tan(turn[edge] / count / 4.0)) / 2.0
    wide = (radius + bow)[:, None] * OVER + 2.0**-30 * cells.side
    first = cell_of(cells, np.minimum(one, two) - wide)
    last = cell_of(cells, np.maximum(one, two) + wide)
    rows = last[:, 1] - first[:, 1] + 1
    box, down = numbered(rows)
    line, across = numbered((last[:, 0] - first[:, 0] + 1)[box])
    near[(first[box, 1] + down)[line], first[box, 0][line] + across] = 1
    return near.reshape(len(near) // 4, 4, -1, 4).transpose(0, 2, 1, 3).reshape(-1)  # tile by tile


def _along(a: FloatArray, b: FloatArray, bulge: FloatArray, part: FloatArray) -> FloatArray:
    """Places at a part of edges from a to b: on a chord, or as far round an arc.

    The point of an arc of the turn 4 t = 4 atan(bulge) at the part u: a + (b - a) sin(2 t u) / sin(2 t), turned by
    2 t (u - 1) from the chord.
    """
    half = 2.0 * np.arctan(bulge)
    sine = np.sin(half)
    round_ = np.abs(sine) > 0.0
    ratio = np.divide(np.sin(half * part), sine, out=part.astype(np.float64), where=round_)
    angle = np.where(round_, half * (part - 1.0), 0.0)
    d = b - a
    turned = np.stack(
        [d[:, 0] * np.cos(angle) - d[:, 1] * np.sin(angle), d[:, 0] * np.sin(angle) + d[:, 1] * np.cos(angle)], 1
    )
    place: FloatArray = a + ratio[:, None] * turned
    return place
