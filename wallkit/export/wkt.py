"""Well-known text: a collection of the material as a MULTIPOLYGON and the open walls as a MULTILINESTRING."""

from __future__ import annotations

from typing import Any

import numpy as np
import shapely

from wallkit.export.level import Level
from wallkit.export.material_shapes import areas_of, is_ring


def write(level: Level) -> str:
    """Write a level as one GEOMETRYCOLLECTION, with all digits."""
    level.findings.note(
        "export-names", level.walls, "well-known text has shapes only: names, layers and materials are left out"
    )
    lines = [shapely.LineString(_line(wall)) for wall in level if not is_ring(wall)]
    whole = shapely.GeometryCollection(
        [shapely.MultiPolygon([area.polygon for area in areas_of(level)]), shapely.MultiLineString(lines)]
    )
    return str(shapely.to_wkt(whole, rounding_precision=-1)) + "\n"


def _line(wall: Any) -> Any:
    return np.concatenate([wall.vertices, wall.vertices[:1]]) if wall.closed else wall.vertices
