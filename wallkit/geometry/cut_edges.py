"""Points put on edges of a triangulation that segments lie on: all in rounds, Delaunay's again after each."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from wallkit.geometry.arrays import FloatArray, IntArray
from wallkit.geometry.half_edges import HalfEdges
from wallkit.geometry.orientation import side

_ON = 1e-9
"""Of the size of everything: a corner so near a segment that a place on it has none to stand on is on it."""


def cut(mesh: HalfEdges, h: IntArray, at: FloatArray, size: float) -> HalfEdges:
    """Cut labelled edges at places, and turn edges without label until the triangulation is Delaunay's.

    A place is off its edge by rounding. Where that is beyond the triangle beside the edge, the place is left out: it is
    next to an end of the edge, or the triangle has no height, and then its two other sides are labelled as well.

    Args:
        mesh: triangles.
        h: (n,) a half-edge of the edge that each place is on; places on one edge one after the other.
        at: (n, 2) the places, in order along the half-edge or against it.
        size: of everything.

    Returns:
        The triangulation with all places among its points, before the last four; one that is left out has no triangle.
        Labels are 0, or more.
    """
    finer = mesh.grow(at)
    finer.label = np.where(finer.label < 0, -1, 0)
    if len(at):
        cuts = _Cuts.of(finer, h, at, len(mesh.points) - 4)
        while (cuts.low < cuts.high).any():
            cuts.go_on(finer, _ON * size)
    return finer


@dataclass(slots=True, eq=False, repr=False)
class _Cuts:
    """Edges that are still to be cut, by their label, from 1.

    Attributes:
        start: (m,) the point that each begins at.
        low: (m,) the row of the first place that is still to be put on it.
        high: (m,) the row after the last.
        point: (n,) the points that are still to be put in.
    """

    start: IntArray
    low: IntArray
    high: IntArray
    point: IntArray

    @classmethod
    def of(cls, mesh: HalfEdges, h: IntArray, at: FloatArray, first: int) -> _Cuts:
        """Label the edges with their places."""
        low = np.flatnonzero(np.diff(h, prepend=-1))
        high = np.append(low[1:], len(h))
        h = h[low]
        p, q = (mesh.points[mesh.corner[corner[h]]] for corner in (mesh.after, mesh.before))
        backwards = (at[low] * (q - p)).sum(axis=1) > (at[high - 1] * (q - p)).sum(axis=1)
        h = np.where(backwards, mesh.across[h], h)
        mesh.label[h] = mesh.label[mesh.across[h]] = np.arange(1, len(h) + 1)
        return cls(mesh.corner[mesh.after[h]], low, high, first + np.arange(len(at)))

    def go_on(self, mesh: HalfEdges, on: float) -> None:
        """Put the middle one of the places of each edge in, where no two of them are in one triangle."""
        h = np.flatnonzero(mesh.label > 0)
        number = mesh.label[h] - 1
        wanted = (mesh.corner[mesh.after[h]] == self.start[number]) & (self.low[number] < self.high[number])
        h, number = h[wanted], number[wanted]
        free = mesh.alone(h // 3, mesh.across[h] // 3)
        h, number = h[free], number[free]
        middle = (self.low[number] + self.high[number]) // 2
        stands = self._stands(mesh, h, self.point[middle], on)
        self._put(mesh, h[stands], number[stands], middle[stands])
        left = np.ones(len(self.point), dtype=np.bool_)
        left[middle] = False
        row = np.append(0, np.cumsum(left))
        self.low, self.high, self.point = row[self.low], row[self.high], self.point[left]

    def _stands(self, mesh: HalfEdges, h: IntArray, point: IntArray, on: float) -> NDArray[np.bool_]:
        """Which places make four triangles; the others are on the edge, or as good as at its ends."""
        place, stands = mesh.points[point], np.ones(len(h), dtype=np.bool_)
        for here in (h, mesh.across[h]):
            p, q, a = (mesh.points[mesh.corner[part]] for part in (mesh.after[here], mesh.before[here], here))
            whole = (side(p, place, a) > 0) & (side(place, q, a) > 0)
            stands &= whole
            (x, y), (u, v) = (q - p).T, (a - p).T
            flat = here[~whole & (np.abs(x * v - y * u) < on * np.hypot(x, y))]
            for beside in (mesh.after[flat], mesh.before[flat]):
                new = beside[mesh.label[beside] < 0]
                mesh.label[new] = mesh.label[mesh.across[new]] = 0
        return stands

    def _put(self, mesh: HalfEdges, h: IntArray, number: IntArray, middle: IntArray) -> None:
        """Put places in: each edge keeps its label up to the place, and has a new one from there on."""
        point = self.point[middle]
        border = mesh.split(h, point)
        to_end, to_start = border[1] - 1, border[2] - 2  # half-edges from the place and to it, on the one side
        border = np.concatenate([border, mesh.flip(h)])
        new = len(self.start) + np.arange(len(h))
        for half, label in ((to_start, number), (to_end, new)):
            mesh.label[half] = mesh.label[mesh.across[half]] = label + 1
        self.start = np.concatenate([self.start, point])
        self.low, self.high = np.concatenate([self.low, middle]), np.concatenate([self.high, self.high[number]])
        self.high[number] = middle
        mesh.legalise(border.ravel())
