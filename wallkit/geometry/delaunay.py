"""The Delaunay triangulation of points in a box, in whole arrays: n log n steps, whatever their order."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from wallkit.geometry.arrays import FloatArray, IntArray
from wallkit.geometry.half_edges import HalfEdges
from wallkit.geometry.orientation import side


def delaunay(points: FloatArray) -> HalfEdges:
    """Triangulate (P, 2) different points, the last four the corners of a box around all, as in :class:`HalfEdges`.

    In rounds: each triangle takes one of the points in it, by chance, and edges are turned until it is Delaunay's
    again. So points come in an order by chance, for which the turns are n log n (L. J. Guibas, D. E. Knuth and
    M. Sharir, Randomized incremental construction of Delaunay and Voronoi diagrams, 1992). Points on one circle, to
    rounding, are taken as they come.
    """
    mesh = HalfEdges(points)
    while len(mesh.waiting):
        rows = np.flatnonzero(mesh.alone(mesh.home))
        h, on_edge = _entered(mesh, mesh.home[rows], points[mesh.waiting[rows]])
        beyond = np.where(on_edge, mesh.across[h], h) // 3
        free = mesh.alone(h // 3, beyond)
        h, rows, on_edge = h[free], rows[free], on_edge[free]
        point = mesh.waiting[rows]
        left = np.ones(len(mesh.waiting), dtype=np.bool_)
        left[rows] = False
        mesh.waiting, mesh.home = mesh.waiting[left], mesh.home[left]
        border = mesh.split(h, point).ravel()
        turned = mesh.flip(h[on_edge]).ravel()
        mesh.legalise(np.concatenate([border, turned]))
    return mesh


def _entered(mesh: HalfEdges, triangle: IntArray, place: FloatArray) -> tuple[IntArray, NDArray[np.bool_]]:
    """Half-edges of triangles that places are in, the one that a place is on if it is on one; and whether it is."""
    h = 3 * triangle
    on_edge = np.zeros(len(h), dtype=np.bool_)
    for i in range(3):
        here = 3 * triangle + i
        p, q = (mesh.points[mesh.corner[corner[here]]] for corner in (mesh.after, mesh.before))
        on = side(p, q, place) == 0
        h[on], on_edge[on] = here[on], True
    return h, on_edge
