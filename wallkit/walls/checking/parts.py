"""Parts of the plane that walls part from one another: in which one a ball or a goal is, and how large it is."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from wallkit.geometry.arrays import FloatArray, IntArray
from wallkit.geometry.triangulation import Triangulation
from wallkit.walls.checking.room_circles import joined, triangles_at


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Parts:
    """The parts that triangles make where no wall is between them.

    Attributes:
        mesh: the triangles.
        part: (T,) the part of each triangle.
        outside: the part around everything.
        area: (P,) of each part.
        box: (P, 4) least x, y and largest x, y of each part.
        place: (P, 2) a place in each part, the middle of its largest triangle.
    """

    mesh: Triangulation
    part: IntArray
    outside: int
    area: FloatArray
    box: FloatArray
    place: FloatArray

    @classmethod
    def of(cls, mesh: Triangulation, least: float) -> Parts:
        """Find the parts; openings up to ``least`` wide count as closed."""
        part = joined(mesh, ~mesh.wall & (mesh.length > least))
        corners = mesh.points[mesh.corners]
        u, v = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
        size = np.abs(u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]) / 2
        count = int(part.max()) + 1
        box = np.concatenate([np.full((count, 2), np.inf), np.full((count, 2), -np.inf)], axis=1)
        np.minimum.at(box[:, :2], part, corners.min(axis=1))
        np.maximum.at(box[:, 2:], part, corners.max(axis=1))
        place = np.empty((count, 2))
        order = np.argsort(size, kind="stable")
        place[part[order]] = corners[order].mean(axis=1)  # the last written is the largest
        outside = int(part[np.flatnonzero(mesh.outer[mesh.edge].any(axis=1))[0]])
        area = np.bincount(part, size, count).astype(np.float64)
        return cls(mesh, part, outside, area, box, place)

    def at(self, points: FloatArray) -> IntArray:
        """The part that each of (n, 2) points is in; the outside also for points far away."""
        triangle = triangles_at(self.mesh, points)
        where: IntArray = np.where(triangle >= 0, self.part[triangle], self.outside)
        return where

    def around(self, part: int) -> IntArray:
        """Larger bounded parts whose box holds the box of ``part``, the largest first."""
        low, high = self.box[:, :2] <= self.box[part, :2], self.box[:, 2:] >= self.box[part, 2:]
        larger = low.all(axis=1) & high.all(axis=1) & (self.area > self.area[part])
        larger[self.outside] = False
        rows = np.flatnonzero(larger)
        ordered: IntArray = rows[np.argsort(-self.area[rows], kind="stable")]
        return ordered
