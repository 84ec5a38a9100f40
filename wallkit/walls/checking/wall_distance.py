"""How far places in triangles are from the nearest wall: looked for from triangle to triangle, away from the place."""

from __future__ import annotations

import numpy as np

from wallkit.geometry.arrays import FloatArray, IntArray
from wallkit.geometry.triangulation import Triangulation

_AT_ONCE = 1 << 15  # places: bounds the memory


def wall_distance(mesh: Triangulation, triangle: IntArray, place: FloatArray) -> FloatArray:
    """Give the distance of each of (n, 2) places, in triangles (n,) apart from the frame, from the nearest wall: (n,).

    The nearest point of all walls is seen from the place. So it is a corner or on a wall among the triangles that are
    entered, from where the place is, over edges that are no walls and nearer than what was found.
    """
    result = np.empty(len(place))
    for begin in range(0, len(place), _AT_ONCE):
        some = slice(begin, begin + _AT_ONCE)
        result[some] = _of_some(mesh, triangle[some], place[some])
    return result


def _of_some(mesh: Triangulation, triangle: IntArray, place: FloatArray) -> FloatArray:
    best: FloatArray = np.min([np.hypot(*(mesh.points[mesh.corners[triangle, k]] - place).T) for k in range(3)], axis=0)
    row, at, side = np.repeat(np.arange(len(place)), 3), np.repeat(triangle, 3), np.tile(np.arange(3), len(place))
    while len(row):
        edge, x = mesh.edge[at, side], place[row]
        p, q = (mesh.points[mesh.corners[at, (side + ahead) % 3]] for ahead in (1, 2))
        d, off = q - p, x - p
        part = np.clip((off * d).sum(axis=1) / np.maximum((d * d).sum(axis=1), 1e-300), 0.0, 1.0)
        distance = np.hypot(*(off - d * part[:, None]).T)
        wall = mesh.wall[edge]
        np.minimum.at(best, row[wall], distance[wall])
        own = at == triangle[row]  # on whose edge a place may be
        from_inside = own | (d[:, 0] * off[:, 1] - d[:, 1] * off[:, 0] > 0)
        seen = ~wall & (distance < best[row]) & from_inside
        row, edge, at = row[seen], edge[seen], mesh.neighbours[at[seen], side[seen]]
        entry = (mesh.edge[at] == edge[:, None]).argmax(axis=1)
        np.minimum.at(best, row, np.hypot(*(mesh.points[mesh.corners[at, entry]] - place[row]).T))
        row, at, side = np.tile(row, 2), np.tile(at, 2), np.concatenate([(entry + 1) % 3, (entry + 2) % 3])
    return best
