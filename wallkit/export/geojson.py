"""GeoJSON: the material as polygons with holes, each closed wall as a ring of its own, open walls as lines.

Coordinates are those of the level: planar, not longitude and latitude. GeoJSON has no place to say so, and programs
for maps take them for degrees.
"""

from __future__ import annotations

from typing import Any, TextIO

import numpy as np
import shapely

from wallkit.export.json_text import numbers, write_json
from wallkit.export.level import Level, LevelWall, signed_areas_of
from wallkit.export.material_shapes import areas_of, is_ring


def write(level: Level, stream: TextIO) -> None:
    """Write a level as a FeatureCollection; the property ``kind`` is material (or room), ring or line."""
    if level.walls:
        level.findings.say("export-planar", "coordinates are plane; programs for maps take GeoJSON for degrees")
    kind = "room" if level.is_room else "material"
    areas = [
        _feature({"type": "Polygon", "coordinates": _rings(area.polygon)}, {"kind": kind}) for area in areas_of(level)
    ]
    features = areas + [_wall(wall, area) for wall, area in zip(level, signed_areas_of(level.walls), strict=True)]
    write_json({"type": "FeatureCollection", "features": features}, 2, stream)


def _wall(wall: LevelWall, area: float) -> dict[str, Any]:
    ring = is_ring(wall)
    properties: dict[str, Any] = {
        "kind": "ring" if ring else "line",
        "name": wall.name,
        "layer": wall.layer,
        "wall": wall.number,
        "depth": wall.depth,
        "sides": wall.sides,
        "restitution": float(wall.material.restitution),
        "tangential_restitution": float(wall.material.tangential_restitution),
    }
    if not ring:
        return _feature({"type": "LineString", "coordinates": numbers(wall.vertices)}, properties)
    vertices = wall.vertices if area >= 0 else wall.vertices[::-1]  # exteriors are counter-clockwise
    closed = numbers(np.concatenate([vertices, vertices[:1]]))
    if wall.curve is not None:
        properties["arcs"] = numbers(wall.curve)
    return _feature({"type": "Polygon", "coordinates": [closed]}, properties)


def _feature(geometry: dict[str, Any], properties: dict[str, Any]) -> dict[str, Any]:
    return {"type": "Feature", "properties": properties, "geometry": geometry}


def _rings(polygon: Any) -> list[Any]:
    return [numbers(shapely.get_coordinates(ring)) for ring in (polygon.exterior, *polygon.interiors)]
