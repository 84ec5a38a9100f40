"""What balls can touch by geometry alone: the space that their centres can be in, and the edges beside it."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from wallkit.geometry.bulge_arcs import arc_points
from wallkit.levels.check_work import Squares
from wallkit.scene.room_balls import RoomBalls
from wallkit.simulation.streams import RandomBalls
from wallkit.walls import Walls

_STEP = math.pi / 256
"""Chords of arcs are then off by 2e-5 of the radius."""
_MARGIN = 1e-3
"""Of the size of the walls: chords and buffers are off by less; no edge nearer than this is called out of reach."""


@dataclass(frozen=True, slots=True, eq=False)
class Reachable:
    """Where balls can be.

    Attributes:
        edges: (E,) False for those that no ball can touch, certainly.
        squares: (rows, columns) True for those whose middle a centre can be at.
    """

    edges: NDArray[np.bool_]
    squares: NDArray[np.bool_]


def reachable(walls: Walls, radius: float, draw: object, squares: Squares) -> Reachable:
    """Find the space that centres can be in, from where they start: faces of the walls, moved in by the radius.

    No ball leaves a face. Walls that are solid from one side only bound none here where they are open, or where balls
    start inside. So what is called out of reach is; what is not may still never be touched. Where nobody knows where a
    draw starts balls, all is in reach.
    """
    import shapely

    everything = np.ones((squares.rows, squares.columns), dtype=np.bool_)
    starts, edges = (
        _starts(draw),
        [edge_points(walls, int(a), int(b)) for a, b in zip(walls.edge_starts, walls.edge_ends, strict=True)],
    )
    if starts is None or not edges:
        return Reachable(np.ones(len(edges), dtype=np.bool_), everything)
    x0, y0, x1, y1 = walls.box()
    size = max(x1 - x0, y1 - y0) or 1.0
    margin, lines = _MARGIN * size, shapely.multilinestrings([shapely.linestrings(edge) for edge in edges])
    frame = shapely.box(x0, y0, x1, y1).buffer(size + 4 * radius).exterior
    barriers = [shapely.get_parts(lines)[_barriers(walls, edges, starts)], [frame]]
    faces = shapely.get_parts(shapely.polygonize(shapely.get_parts(shapely.node(shapely.multilinestrings(
        np.concatenate(barriers)
    )))))  # fmt: skip
    mine = shapely.union_all([face for face in faces if shapely.dwithin(face, starts, 1e-9 * size)])
    parts = shapely.get_parts(shapely.buffer(mine, -0.998 * radius, quad_segs=32) if radius > 0.0 else mine)
    free = shapely.union_all([part for part in parts if shapely.dwithin(part, starts, 1e-9 * size)])
    shapely.prepare(free)
    touched = shapely.dwithin(shapely.get_parts(lines), free, radius + margin)
    x, y = np.meshgrid(
        squares.x0 + squares.side * (np.arange(squares.columns) + 0.5),
        squares.y0 + squares.side * (np.arange(squares.rows) + 0.5),
    )
    return Reachable(np.asarray(touched, dtype=np.bool_), np.asarray(shapely.contains_xy(free, x, y), dtype=np.bool_))


def _starts(draw: object) -> Any:
    """Give where a draw starts balls, as a geometry; None where that is not known."""
    import shapely

    if isinstance(draw, RoomBalls):
        return shapely.union_all(shapely.polygons(draw.triangles))
    if isinstance(draw, RandomBalls):
        x0, y0, x1, y1 = draw.box
        return shapely.box(x0, y0, x1, y1) if x1 > x0 and y1 > y0 else shapely.linestrings([(x0, y0), (x1, y1)])
    return None


def edge_points(walls: Walls, a: int, b: int) -> Any:
    """Give the points of the edge between two vertices: two of a line, more of an arc."""
    start, end, bulge = walls.vertices[a], walls.vertices[b], float(walls.bulges[a])
    if bulge == 0.0:
        return np.stack([start, end])
    return np.concatenate([arc_points(start, end, bulge, _STEP), end[None]])


def _barriers(walls: Walls, edges: list[Any], starts: Any) -> NDArray[np.bool_]:
    """(E,) which edges no ball passes."""
    import shapely

    stops = np.ones(len(edges), dtype=np.bool_)
    for index, sides in enumerate(walls.sides):
        if sides == "both":
            continue
        own = slice(walls.edge_offsets[index], walls.edge_offsets[index + 1])
        ring = np.concatenate(edges[own]) if len(edges[own]) else np.empty((0, 2))
        if not walls.closed[index] or len(ring) < 4 or shapely.intersects(shapely.polygons(ring).buffer(0), starts):
            stops[own] = False
    return stops
