"""Where vertices come close to the middle of walls: feet, to be vertices of the triangulation too.

The narrowest spot between two walls leads from a vertex to a vertex or to the foot on an edge, and the circle over it
is empty. With all such feet among its points a Delaunay triangulation has every such spot among its edges, and what a
disc gets through is told by lengths of edges alone (H. Edelsbrunner, The union of balls and its dual shape, 1995).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from wallkit.geometry.arrays import FloatArray, IntArray
from wallkit.geometry.ragged import slices
from wallkit.geometry.triangulation import Triangulation, cut_further

_NEARLY = 1e-9  # of the square of the distance: rounding
_AT_ONCE = 1 << 15  # corners that are looked from: bounds the memory
_DEEPEST = 40  # edges looked over: with more between two walls, their vertices are as dense as feet would be


def narrow_feet(mesh: Triangulation) -> tuple[IntArray, FloatArray]:
    """Find feet of given vertices on the inside of pieces of walls: all that have nothing in the circle between them.

    A segment to such a foot crosses only edges which have a foot of the vertex inside, since their ends are out of the
    circle; so feet are looked for over such edges alone. The middle of the segment is nearest to the vertex, hence
    in its Voronoi cell, and no farther from it than the circles around its triangles are large. That the circle is
    empty is asked of the first and the last triangle on the way alone: a foot more does no harm.

    Args:
        mesh: triangles with the walls among their edges.

    Returns:
        (n,) the edges that the feet are on, and (n, 2) the feet; both empty where there are none.
    """
    row = np.flatnonzero(mesh.corners.ravel() < mesh.given)
    reach = _reach(mesh)
    x, y = mesh.points.T.copy()  # columns: sums and gathers of pairs take NumPy several times as long
    parts = [_feet_of(mesh, x, y, row[some], reach) for some in slices(len(row), _AT_ONCE)]
    return np.concatenate([edge for edge, _ in parts]), np.concatenate([foot for _, foot in parts])


def _feet_of(
    mesh: Triangulation, x: FloatArray, y: FloatArray, row: IntArray, reach: FloatArray
) -> tuple[IntArray, FloatArray]:
    """The same of some corners of triangles, by their numbers; x and y are those of the points."""
    corner = mesh.corners.ravel()
    edge, through = mesh.edge.ravel()[row], row // 3
    edges, feet = [np.empty(0, dtype=np.int64)], [np.empty((0, 2))]
    for _ in range(_DEEPEST):
        vertex, (p, q) = corner[row], mesh.ends[edge].T
        at_x, at_y = _foot(x[vertex], y[vertex], x[p], y[p], x[q], y[q])
        inner = ((at_x != x[p]) | (at_y != y[p])) & ((at_x != x[q]) | (at_y != y[q]))
        inner &= np.hypot(x[vertex] - at_x, y[vertex] - at_y) <= reach[vertex]
        met = np.flatnonzero(inner & mesh.wall[edge])
        around = np.concatenate([mesh.corners[row[met] // 3], mesh.corners[through[met]]], axis=1)
        met = met[_empty(x, y, vertex[met], at_x[met], at_y[met], around)]
        edges.append(edge[met])
        feet.append(np.stack([at_x[met], at_y[met]], axis=1))
        going = np.flatnonzero(inner & ~mesh.wall[edge] & ~mesh.outer[edge])
        if not len(going):
            break
        row, edge, through = _across(mesh, row, edge, through, going)
    return np.concatenate(edges), np.concatenate(feet)


def with_feet(mesh: Triangulation) -> Triangulation:
    """Triangulate walls once more, with :func:`narrow_feet` among the points."""
    edge, feet = narrow_feet(mesh)
    return cut_further(mesh, edge, feet) if len(edge) else mesh


def _reach(mesh: Triangulation) -> FloatArray:
    """How far from each vertex feet may be: the diameter of the largest circle around one of its triangles."""
    p, q, r = (mesh.points[mesh.corners[:, k]] for k in range(3))
    sides = np.hypot(*np.stack([q - r, r - p, p - q]).transpose(2, 0, 1))
    (ux, uy), (vx, vy) = (q - p).T, (r - p).T
    diameter = sides.prod(axis=0) / np.maximum(np.abs(ux * vy - uy * vx), 1e-300)
    reach = np.zeros(len(mesh.points))
    np.maximum.at(reach, mesh.corners.ravel(), np.repeat(diameter * (1 + 1e-9), 3))  # rounded up, to look too far
    return reach


def _empty(
    x: FloatArray, y: FloatArray, vertex: IntArray, at_x: FloatArray, at_y: FloatArray, around: IntArray
) -> NDArray[np.bool_]:
    """Whether none of some points ``around``, (n, 6), is in the circle from a vertex to its foot.

    In the circle over v f is what sees it under more than a right angle: (w - v) . (w - f) < 0. Of a vertex on a wall,
    to rounding, it is a point.
    """
    v_x, v_y = x[vertex], y[vertex]
    off_x, off_y = at_x - v_x, at_y - v_y
    least = -_NEARLY * (off_x * off_x + off_y * off_y)
    empty = np.ones(len(vertex), dtype=np.bool_)
    for point in around.T:
        w_x, w_y = x[point], y[point]
        empty &= (w_x - v_x) * (w_x - at_x) + (w_y - v_y) * (w_y - at_y) >= least
    return empty


def _across(
    mesh: Triangulation, row: IntArray, edge: IntArray, through: IntArray, going: IntArray
) -> tuple[IntArray, IntArray, IntArray]:
    """Step over edges into the next triangles: their two other edges."""
    row, edge, through = row[going], edge[going], through[going]
    side = (mesh.edge[through] == edge[:, None]).argmax(axis=1)
    beyond = mesh.neighbours[through, side]
    entry = (mesh.edge[beyond] == edge[:, None]).argmax(axis=1)
    following = np.concatenate([mesh.edge[beyond, (entry + 1) % 3], mesh.edge[beyond, (entry + 2) % 3]])
    return np.tile(row, 2), following, np.tile(beyond, 2)


def _foot(
    x: FloatArray, y: FloatArray, p_x: FloatArray, p_y: FloatArray, q_x: FloatArray, q_y: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """The point of each segment from p to q that is nearest to (x, y)."""
    d_x, d_y = q_x - p_x, q_y - p_y
    part = ((x - p_x) * d_x + (y - p_y) * d_y) / np.maximum(d_x * d_x + d_y * d_y, 1e-300)
    part = np.clip(part, 0.0, 1.0)
    return p_x + d_x * part, p_y + d_y * part
