"""How edges join: from the end of an edge to the next one on either side, by the topology of the walls."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from wallkit.geometry.arrays import FloatArray, IntArray
from wallkit.kernels.records import JOINT, NO_HIT
from wallkit.simulation.edge_records import FLAT, end_normals
from wallkit.walls import Walls


def joints_of(walls: Walls, origin: FloatArray, lines: NDArray[Any]) -> tuple[NDArray[Any], IntArray]:
    """Make a ``JOINT`` of each end of each edge, and name for each vertex one end of an edge that is there.

    End 2 e is where edge e begins, 2 e + 1 where it ends. Vertices at the same coordinates are one place, whatever wall
    they belong to. Around a place its ends lie in the order of the directions in which their edges leave it (of two
    that leave together the one that bends to the left comes later): the next one on either side is the neighbour in
    that order. Edges without a length, and copies of an edge, are left out.

    Returns:
        (2 E,) of ``JOINT``, and (V,) the lowest end at the place of each vertex, NO_HIT where there is none.
    """
    starts, ends = walls.edge_starts, walls.edge_ends
    vertices, bulges = walls.vertices - origin, walls.bulges[starts]
    _unique, place = np.unique(vertices, axis=0, return_inverse=True)
    place = place.reshape(-1)
    at_end, at_start = end_normals(lines, bulges)
    count = 2 * len(starts)
    joints = np.zeros(count, dtype=JOINT)
    out = np.empty((count, 2))
    out[0::2] = np.stack([-at_start[1], at_start[0]], axis=1)
    out[1::2] = np.stack([at_end[1], -at_end[0]], axis=1)
    vertex = np.empty(count, dtype=np.int64)
    vertex[0::2], vertex[1::2] = starts, ends
    bend = np.where(np.abs(bulges) > FLAT, bulges, 0.0)
    kept = np.repeat(_once(place[starts], place[ends], bend) & (lines["length"] > 0.0), 2)
    left = np.empty(count)
    left[0::2], left[1::2] = bend, -bend
    joints["tx"], joints["ty"], joints["vertex"] = out[:, 0], out[:, 1], vertex
    joints["clockwise"] = joints["counter"] = joints["place"] = np.arange(count)
    ordered = np.flatnonzero(kept)
    ordered = ordered[np.lexsort((left[ordered], np.arctan2(out[ordered, 1], out[ordered, 0]), place[vertex[ordered]]))]
    spokes = np.full(len(vertices), NO_HIT, dtype=np.int64)
    if not len(ordered):
        return joints, spokes
    group = place[vertex[ordered]]
    begins = np.flatnonzero(np.concatenate([[True], group[1:] != group[:-1]]))
    sizes = np.diff(np.append(begins, len(group)))
    first = np.repeat(begins, sizes)
    rank, size = np.arange(len(group)) - first, np.repeat(sizes, sizes)
    joints["counter"][ordered] = ordered[first + (rank + 1) % size]
    joints["clockwise"][ordered] = ordered[first + (rank - 1) % size]
    lowest = np.full(len(_unique), NO_HIT, dtype=np.int64)
    lowest[group[begins]] = np.minimum.reduceat(ordered, begins)
    spokes[:] = lowest[place]
    joints["place"] = spokes[vertex]
    return joints, spokes


def _once(a: IntArray, b: IntArray, bend: FloatArray) -> NDArray[np.bool_]:
    """Tell which edges, between places, are the first of their kind: the same ends and the same bend either way."""
    turned = a > b
    keys = np.stack([np.where(turned, b, a), np.where(turned, a, b), np.where(turned, -bend, bend)], axis=1)
    _keys, first = np.unique(keys, axis=0, return_index=True)
    once = np.zeros(len(a), dtype=np.bool_)
    once[first] = True
    return once
