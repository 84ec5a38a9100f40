"""Well-known text: a collection of the material as a MULTIPOLYGON and the open walls as a MULTILINESTRING.

Written here and not by shapely, whose writers give 16 digits at most: some numbers then read back as others.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, TextIO

import numpy as np
import shapely

from wallkit.export.level import Level
from wallkit.export.material_shapes import areas_of, is_ring
from wallkit.export.number_text import Rows
from wallkit.geometry.arrays import FloatArray


def write(level: Level, stream: TextIO) -> None:
    """Write a level as one GEOMETRYCOLLECTION, with all digits."""
    level.findings.note(
        "export-names", level.walls, "well-known text has shapes only: names, layers and materials are left out"
    )
    stream.write("GEOMETRYCOLLECTION (")
    polygons = (_rings(area.polygon) for area in areas_of(level))
    _write_many("MULTIPOLYGON", polygons, stream)
    stream.write(", ")
    lines = (
        [np.concatenate([wall.vertices, wall.vertices[:1]]) if wall.closed else wall.vertices]
        for wall in level
        if not is_ring(wall)
    )
    _write_many("MULTILINESTRING", lines, stream)
    stream.write(")\n")


def _rings(polygon: Any) -> list[FloatArray]:
    return [shapely.get_coordinates(ring) for ring in (polygon.exterior, *polygon.interiors)]


def _write_many(word: str, parts: Iterable[list[FloatArray]], stream: TextIO) -> None:
    """Write shapes: a polygon is a list of rings in brackets, a line is one list of points without them."""
    start, end = ("((", "))") if word == "MULTIPOLYGON" else ("(", ")")
    empty = True
    for part in parts:
        stream.write(f"{word} (" if empty else ", ")
        empty = False
        for number, points in enumerate(part):
            before = start if number == 0 else ", ("
            Rows("%r %r", points, before=before, after=end if number == len(part) - 1 else ")").write(stream)
    stream.write(f"{word} EMPTY" if empty else ")")
