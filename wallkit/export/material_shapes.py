"""The material of a level as shapely polygons, each with the wall that is its outline."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import shapely

from wallkit.export.level import Level, LevelWall
from wallkit.geometry.rings import rings_of
from wallkit.walls.as_shapely import even_odd


@dataclass(frozen=True, slots=True)
class Area:
    """A polygon and the walls that are its rings.

    Attributes:
        polygon: exterior counter-clockwise, holes clockwise in the target's numbers.
        outline: the wall of its exterior; None where that is the frame around a room.
        holes: the walls of its holes.
    """

    polygon: Any
    outline: LevelWall | None
    holes: list[LevelWall]

    @property
    def walls(self) -> list[LevelWall]:
        """All walls of it, the outline first."""
        return [*([] if self.outline is None else [self.outline]), *self.holes]


def areas_of(level: Level, frame: float | None = None) -> list[Area]:
    """Give what an odd number of closed walls is around: the material, or the free space of rooms.

    Args:
        level: any level.
        frame: None, or the width of a frame around rooms: then the material is given, the frame's too.
    """
    rings = [wall for wall in level if is_ring(wall)]
    if not rings:
        return []
    offsets = np.concatenate([[0], np.cumsum([len(wall.vertices) for wall in rings])])
    polygons = rings_of(np.concatenate([wall.vertices for wall in rings]), offsets)
    around = None
    if frame is not None and level.is_room:
        x_min, y_min, x_max, y_max = level.box
        around = shapely.box(x_min - frame, y_min - frame, x_max + frame, y_max + frame)
    outer = 0 if around is not None or not level.is_room else 1
    areas = _by_nesting(rings, polygons, outer, around)
    return _by_parity(rings, polygons, around) if areas is None else areas


def is_ring(wall: LevelWall) -> bool:
    """It encloses something: it is closed, and no line of two vertices."""
    return wall.closed and len(wall.vertices) > 2


def _by_nesting(rings: list[LevelWall], polygons: Any, outer: int, around: Any) -> list[Area] | None:
    """Put each hole into the smallest ring around it; None where rings cross or touch along an edge."""
    depth = np.array([ring.depth for ring in rings])
    shells, holes = np.flatnonzero(depth % 2 == outer), np.flatnonzero(depth % 2 != outer)
    parents = _parents(polygons, depth, shells, holes)
    if around is None and (parents < 0).any():
        return None
    inside: dict[int, list[int]] = {}
    for hole, parent in zip(holes.tolist(), parents.tolist(), strict=True):
        inside.setdefault(parent, []).append(hole)
    made = polygons[shells]
    for place, shell in enumerate(shells.tolist()):
        if shell in inside:
            cut = [polygons[hole].exterior for hole in inside[shell]]
            made[place] = shapely.Polygon(polygons[shell].exterior, cut)
    outlines: list[LevelWall | None] = [rings[shell] for shell in shells.tolist()]
    if around is not None:
        cut = [polygons[hole].exterior for hole in inside.get(-1, [])]
        made = np.append(made, shapely.Polygon(around.exterior, cut))
        outlines.append(None)
    if not shapely.is_valid(shapely.MultiPolygon(made.tolist())):
        return None
    owners = [*shells.tolist(), -1]
    turned = shapely.orient_polygons(made)
    return [
        Area(polygon, outline, [rings[hole] for hole in inside.get(owner, [])])
        for polygon, outline, owner in zip(turned, outlines, owners, strict=False)
    ]


def _parents(polygons: Any, depth: Any, shells: Any, holes: Any) -> Any:
    """Find for each hole the smallest shell around it that is one level up; -1 where there is none."""
    parents = np.full(len(holes), -1, dtype=np.int64)
    if not len(holes) or not len(shells):
        return parents
    tree = shapely.STRtree(polygons[shells])
    hole, shell = tree.query(shapely.point_on_surface(polygons[holes]), predicate="within")
    fits = depth[shells[shell]] == depth[holes[hole]] - 1
    hole, shell = hole[fits], shells[shell[fits]]
    order = np.argsort(-shapely.area(polygons[shell]), kind="stable")
    parents[hole[order]] = shell[order]  # the smallest comes last and stays
    return parents


def _by_parity(rings: list[LevelWall], polygons: Any, around: Any) -> list[Area]:
    """Even-odd over all rings, whatever they cross; the first wall that a ring has a vertex of is its own."""
    whole = even_odd(polygons)
    if around is not None:
        whole = shapely.difference(around, whole)
    parts = [part for part in shapely.get_parts(whole) if part.geom_type == "Polygon" and not part.is_empty]
    owners = {tuple(point): ring for ring in reversed(rings) for point in ring.vertices.tolist()}
    result = []
    for part in shapely.orient_polygons(np.array(parts, dtype=object)):
        found = [
            next((owners[p] for p in ring.coords if p in owners), None) for ring in (part.exterior, *part.interiors)
        ]
        walls = [wall for wall in found if wall is not None]
        result.append(Area(part, walls[0] if found[0] is not None else None, walls[0 if found[0] is None else 1 :]))
    return result
