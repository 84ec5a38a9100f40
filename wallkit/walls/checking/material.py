"""Where material is: which places the closed walls' winding makes solid, whatever balls are drawn."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from wallkit.geometry.arrays import FloatArray, IntArray
from wallkit.walls.edge_tree import Edges
from wallkit.walls.solid import walls_around
from wallkit.walls.walls import Walls

_PAIRS = 4_000_000  # of points and edges, looked at together


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Solids:
    """Closed walls as solids (counter-clockwise) and rooms or holes (clockwise), as the contract of Walls says.

    A place is counted once up for every solid around it and once down for every room or hole (inside by even-odd, so
    that a ring that crosses itself counts once). Above 0 is material, below 0 is free. At 0 it is as it is outside
    the outermost ring around: free outside a solid, material outside a room.

    Attributes:
        edges: the straight edges of the walls.
        sign: (W,) 1 for a solid, -1 for a room or hole, 0 for an open wall.
        size: (W,) area of each ring.
        around: everything outside all walls is material.
    """

    edges: Edges
    sign: IntArray
    size: FloatArray
    around: bool

    @classmethod
    def of(cls, walls: Walls, edges: Edges) -> Solids:
        """Take the winding of walls; a ring without signed area (a bow-tie) goes by its depth."""
        area = edges.areas
        sign = np.where(area == 0, 1 - 2 * (walls.depth % 2), np.sign(area)).astype(np.int64)
        sign[~walls.closed] = 0
        size = np.where(walls.closed, np.abs(area), -1.0)
        return cls(edges, sign, size, bool(len(sign) and sign[size.argmax()] < 0))

    def contain(self, points: FloatArray) -> NDArray[np.bool_]:
        """Tell which of (n, 2) points lie in material."""
        result = np.empty(len(points), dtype=np.bool_)
        portion = max(_PAIRS // max(len(self.edges), 1), 1)
        for begin in range(0, len(points), portion):
            some = points[begin : begin + portion]
            source, wall = walls_around(self.edges, some)
            level = np.bincount(source, self.sign[wall], len(some))
            order = np.lexsort((self.size[wall], source))
            outermost = np.full(len(some), -1)
            outermost[source[order]] = wall[order]  # the last written is the largest
            beyond = np.where(outermost >= 0, self.sign[outermost] < 0, self.around)
            result[begin : begin + portion] = np.where(level == 0, beyond, level > 0)
        return result

    def innermost(self, points: FloatArray) -> IntArray:
        """The smallest closed wall around each of (n, 2) points; -1 where there is none."""
        source, wall = walls_around(self.edges, points)
        order = np.lexsort((-self.size[wall], source))
        result = np.full(len(points), -1, dtype=np.int64)
        result[source[order]] = wall[order]  # the last written is the smallest
        return result
