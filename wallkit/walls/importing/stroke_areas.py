"""Strokes with a width become the solids that they paint."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import shapely

from importers.drawing import DrawnPath, Subpath
from importers.problems import Problem
from wallkit.geometry.arrays import FloatArray
from wallkit.walls.as_shapely import even_odd
from wallkit.walls.importing.curves_to_lines import flatten
from wallkit.walls.importing.outlines import Outlines, assemble
from wallkit.walls.importing.segments import gather
from wallkit.walls.repairing.areas import rings_around

_MITRE_LIMIT = 4.0  # SVG's own; Illustrator's 10 differs only at corners sharper than 29 degrees


def outline_strokes(paths: list[DrawnPath], tolerance: float) -> tuple[list[DrawnPath], list[Problem]]:
    """Put the area that it paints in the place of every stroked path of some width.

    Corners are mitred and ends cut flat (drawings do not carry caps and joins here); curves become lines within
    half the tolerance first. A path that is filled too becomes fill and stroke together.
    """
    result: list[DrawnPath] = []
    count = 0
    for path in paths:
        if not path.stroke_width or path.stroke is None:
            result.append(path)
            continue
        area = _painted(path, tolerance)
        subpaths = [Subpath(_segments(ring), True) for ring in rings_around(area)]
        if subpaths:
            count += 1
            result.append(
                replace(path, subpaths=subpaths, fill=path.stroke, stroke=None, stroke_width=None, fill_rule="evenodd")
            )
        else:
            result.append(path)
    if not count:
        return result, []
    message = f"{count} {'stroke' if count == 1 else 'strokes'} became the solids that they paint"
    return result, [Problem("outlined-stroke", "info", message, "leave --outline-strokes out for their middle lines")]


def _painted(path: DrawnPath, tolerance: float) -> shapely.Geometry:
    segments = gather(path.subpaths)
    pieces = flatten(segments, tolerance / 2)
    outlines = assemble(segments, pieces, [path])
    lines = [_line(outlines, index) for index in range(len(outlines))]
    half = (path.stroke_width or 0.0) / 2
    area = shapely.union_all(
        [shapely.buffer(line, half, cap_style="flat", join_style="mitre", mitre_limit=_MITRE_LIMIT) for line in lines]
    )
    if path.fill is None:
        return area
    rings = np.array([shapely.Polygon(line) for line in lines if len(line.coords) > 3], dtype=object)
    return shapely.union(area, even_odd(rings)) if len(rings) else area


def _line(outlines: Outlines, index: int) -> shapely.LineString:
    points = outlines.vertices[outlines.offsets[index] : outlines.offsets[index + 1]]
    if outlines.closed[index]:
        return shapely.LinearRing(points) if len(points) > 2 else shapely.LineString(points[[0, 1, 0]])
    return shapely.LineString(points if len(points) > 1 else points[[0, 0]])


def _segments(ring: FloatArray) -> list[tuple[object, ...]]:
    (x, y), *rest = ring[:-1].tolist()
    return [("M", x, y), *(("L", px, py) for px, py in rest)]
