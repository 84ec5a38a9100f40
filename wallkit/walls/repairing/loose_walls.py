"""Lines: walls one by one, for passes that join, split and drop them."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from wallkit.geometry.arrays import FloatArray
from wallkit.walls.as_shapely import check_tolerance, straightened
from wallkit.walls.edge_tree import Edges
from wallkit.walls.origins import NOWHERE, Origin
from wallkit.walls.walls import ARRAYS, Material, Sides, Walls


@dataclass(slots=True, eq=False, repr=False)
class LooseWall:
    """One wall on its own; arrays as in Walls.

    Attributes:
        vertices: (n, 2).
        bulges: (n,).
        closed: it is a ring.
        name: of the wall.
        layer: of the wall.
        sides: of the wall.
        material: of the wall.
        origin: of the wall.
        even_odd: how its self-crossings part material from none.
        file_line: line in the file, or None.
    """

    vertices: FloatArray
    bulges: FloatArray
    closed: bool
    name: str
    layer: str
    sides: Sides
    material: Material
    origin: Origin = NOWHERE
    even_odd: bool = False
    file_line: int | None = None


def to_lines(walls: Walls, even_odd: Sequence[bool] = (), file_lines: Sequence[int | None] = ()) -> list[LooseWall]:
    """Take walls apart."""
    return [
        LooseWall(
            wall.vertices,
            wall.bulges,
            wall.closed,
            wall.name,
            wall.layer,
            wall.sides,
            wall.material,
            wall.origin,
            even_odd[index] if even_odd else False,
            file_lines[index] if file_lines else None,
        )
        for index, wall in enumerate(walls)
    ]


def from_lines(walls: Walls, lines: Sequence[LooseWall]) -> Walls:
    """Put lines together as walls that have the units, tolerance and source of ``walls``."""
    made = Walls.from_polylines(
        [line.vertices for line in lines],
        [line.closed for line in lines],
        bulges=[line.bulges for line in lines],
        sides=[line.sides for line in lines],
        material=[line.material for line in lines],
        names=[line.name for line in lines],
        layers=[line.layer for line in lines],
        origins=[line.origin for line in lines],
    )
    return replace(walls, **{name: getattr(made, name) for name in ARRAYS})


def edges_of(lines: Sequence[LooseWall], tolerance: float = 0.0) -> Edges:
    """The straight edges of lines; with a tolerance arcs become lines as checks see them, else their chords count."""
    walls = from_lines(Walls.from_polylines([]), lines)
    if tolerance:
        vertices, offsets = straightened(walls, check_tolerance(walls, tolerance))
        return Edges(vertices, offsets, walls.closed)
    return Edges(walls.vertices, walls.offsets, walls.closed)


def like(line: LooseWall, rings: Iterable[FloatArray]) -> list[LooseWall]:
    """Closed lines of straight edges with the marks of ``line``; rings as shapely gives them, first = last."""
    return [
        replace(line, vertices=np.ascontiguousarray(ring[:-1]), bulges=np.zeros(len(ring) - 1), closed=True)
        for ring in rings
    ]
