"""Well-known text: a collection of the material as a MULTIPOLYGON and the open walls as a MULTILINESTRING.

Written here and not by shapely, whose writers give 16 digits at most: some numbers then read back as others.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import shapely

from wallkit.export.level import Level
from wallkit.export.material_shapes import areas_of, is_ring
from wallkit.export.number_text import rows
from wallkit.geometry.arrays import FloatArray


def write(level: Level) -> str:
    """Write a level as one GEOMETRYCOLLECTION, with all digits."""
    level.findings.note(
        "export-names", level.walls, "well-known text has shapes only: names, layers and materials are left out"
    )
    polygons = [f"({', '.join(map(_points, _rings(area.polygon)))})" for area in areas_of(level)]
    lines = [
        _points(np.concatenate([wall.vertices, wall.vertices[:1]]) if wall.closed else wall.vertices)
        for wall in level
        if not is_ring(wall)
    ]
    return f"GEOMETRYCOLLECTION ({_many('MULTIPOLYGON', polygons)}, {_many('MULTILINESTRING', lines)})\n"


def _rings(polygon: Any) -> list[FloatArray]:
    return [shapely.get_coordinates(ring) for ring in (polygon.exterior, *polygon.interiors)]


def _points(points: FloatArray) -> str:
    return f"({rows('%r %r', points)})"


def _many(word: str, parts: list[str]) -> str:
    return f"{word} ({', '.join(parts)})" if parts else f"{word} EMPTY"
