"""Where the lines of walls meet, found once for all who ask: how they touch, the pieces between, triangles of these."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from wallkit.geometry.arrays import FloatArray, IntArray
from wallkit.geometry.rings import turned
from wallkit.walls.crossings import Touches, find_touches
from wallkit.walls.edge_tree import Edges

if TYPE_CHECKING:
    from wallkit.geometry.triangulation import Triangulation
    from wallkit.walls.noding import Pieces
    from wallkit.walls.walls import Walls


@dataclass(eq=False, repr=False)
class MetLines:
    """Straight edges, and what follows from where they meet, each looked for when it is first asked for.

    Attributes:
        edges: of all walls, arcs as lines.
        vertices: (V, 2) of the walls that the edges are of.
        bulges: (V,) likewise.
        offsets: (W + 1,) likewise.
    """

    edges: Edges
    vertices: FloatArray = field(repr=False)
    bulges: FloatArray = field(repr=False)
    offsets: IntArray = field(repr=False)

    @classmethod
    def of(cls, walls: Walls, edges: Edges) -> MetLines:
        """Take straight edges of walls."""
        return cls(edges, walls.vertices, walls.bulges, walls.offsets)

    def same_as(self, walls: Walls, turned_too: bool = True) -> bool:
        """Tell whether walls lie where these do, to the bit, and ``turned_too``: whichever way round closed ones run.

        Then they meet where these do, and are cut into the same pieces.
        """
        if not (np.array_equal(self.offsets, walls.offsets) and np.array_equal(self.edges.closed, walls.closed)):
            return False
        back = turned(self.vertices, self.bulges, self.offsets, walls.closed & turned_too)
        wall = np.repeat(np.arange(len(walls)), np.diff(walls.offsets))
        apart = [
            np.bincount(wall, (vertices != walls.vertices).any(axis=1) | (bulges != walls.bulges), len(walls)) > 0
            for vertices, bulges in ((self.vertices, self.bulges), back)
        ]
        return not (apart[0] & apart[1]).any()

    @cached_property
    def touches(self) -> Touches:
        """How the edges touch."""
        return find_touches(self.edges)

    @property
    def too_many(self) -> bool:
        """Walls cross at more places than are cut, or may: a tangle."""
        from wallkit.walls.noding import MOST_CROSSINGS

        found = self.touches
        return len(self.edges) > 0 and (not found.complete or len(found.crossing_at) > MOST_CROSSINGS)

    @cached_property
    def pieces(self) -> Pieces:
        """The edges cut where they meet; for walls that do not cross too often."""
        from wallkit.walls.noding import noded

        return noded(self.edges, self.touches)

    @cached_property
    def mesh(self) -> Triangulation | None:
        """Triangles between the pieces; None for a tangle."""
        from wallkit.geometry.triangulation import triangulate

        return triangulate(self.pieces.a, self.pieces.b)
