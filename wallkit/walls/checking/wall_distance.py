"""How far places in triangles are from the nearest wall: looked for from triangle to triangle, away from the place."""

from __future__ import annotations

import numpy as np

from wallkit.geometry.arrays import FloatArray, IntArray
from wallkit.geometry.ragged import slices
from wallkit.geometry.triangulation import Triangulation
from wallkit.walls.checking.rooms_by_kernels import kernels_pay, wall_distances

_AT_ONCE = 1 << 15  # places: bounds the memory


def wall_distance(mesh: Triangulation, triangle: IntArray, place: FloatArray) -> FloatArray:
    """Give the distance of each of (n, 2) places, in triangles (n,) apart from the frame, from the nearest wall: (n,).

    The nearest point of all walls is seen from the place. So it is a corner or on a wall among the triangles that are
    entered, from where the place is, over edges that are no walls and nearer than what was found. Squares of distances
    are compared: a root, and above all ``hypot``, takes longer than all the rest.
    """
    if kernels_pay(mesh):
        return wall_distances(mesh, triangle, place)
    result = np.empty(len(place))
    for some in slices(len(place), _AT_ONCE):
        result[some] = _of_some(mesh, triangle[some], place[some])
    return result


def _of_some(mesh: Triangulation, triangle: IntArray, place: FloatArray) -> FloatArray:
    across, up = mesh.points.T.copy()  # columns: sums and gathers of pairs take NumPy several times as long
    x, y = place.T.copy()
    best = np.full(len(place), np.inf)
    for corner in mesh.corners[triangle].T:
        np.minimum(best, _squared(across[corner] - x, up[corner] - y), out=best)
    row, at, side = np.repeat(np.arange(len(place)), 3), np.repeat(triangle, 3), np.tile(np.arange(3), len(place))
    while len(row):
        edge = mesh.edge[at, side]
        p, q = (mesh.corners[at, (side + ahead) % 3] for ahead in (1, 2))
        dx, dy, off_x, off_y = across[q] - across[p], up[q] - up[p], x[row] - across[p], y[row] - up[p]
        part = np.clip((off_x * dx + off_y * dy) / np.maximum(dx * dx + dy * dy, 1e-300), 0.0, 1.0)
        square = _squared(off_x - dx * part, off_y - dy * part)
        wall = mesh.wall[edge]
        np.minimum.at(best, row[wall], square[wall])
        own = at == triangle[row]  # on whose edge a place may be
        from_inside = own | (dx * off_y - dy * off_x > 0)
        seen = ~wall & (square < best[row]) & from_inside
        row, edge, at = row[seen], edge[seen], mesh.neighbours[at[seen], side[seen]]
        entry = (mesh.edge[at] == edge[:, None]).argmax(axis=1)
        tip = mesh.corners[at, entry]
        np.minimum.at(best, row, _squared(across[tip] - x[row], up[tip] - y[row]))
        row, at, side = np.tile(row, 2), np.tile(at, 2), np.concatenate([(entry + 1) % 3, (entry + 2) % 3])
    root: FloatArray = np.sqrt(best)
    return root


def _squared(x: FloatArray, y: FloatArray) -> FloatArray:
    return x * x + y * y
