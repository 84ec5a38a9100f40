"""DXF R2010 by ezdxf: an LWPOLYLINE for each wall, arcs as bulges, exact.

A bulge above 1 (more than a half circle) is cut in two: GDAL and others take such an arc for its complement.
"""

from __future__ import annotations

from typing import TextIO

import numpy as np

from wallkit.export.level import Level, LevelWall
from wallkit.export.names import unique, without
from wallkit.export.options import ExportError
from wallkit.geometry.arrays import FloatArray
from wallkit.geometry.bulge_arcs import edge_points

APP = "WALLKIT"
_FORBIDDEN = '<>/\\":;?*|=`,'
_CHUNK = 60  # characters: a string of extended data has at most 255 bytes, a character up to four
_UNITS = {"in": 1, "mm": 4, "cm": 5, "m": 6}  # $INSUNITS; points and pixels are none of them


def write(level: Level, stream: TextIO) -> None:
    """Write a level as DXF.

    Raises:
        ExportError: ezdxf is not installed.
    """
    try:
        from ezdxf.filemanagement import new

        from wallkit.export.dxf_points import Points
    except ImportError as error:
        raise ExportError(
            "DXF needs the package ezdxf", code="missing-package", fix="pip install 'wallkit[dxf]'"
        ) from error
    document = new("R2010")
    document.header["$INSUNITS"] = _UNITS.get(level.units, 0)
    document.appids.add(APP)
    layers = _layers(level)
    for name in layers.values():
        if name not in document.layers:
            document.layers.add(name)
    space = document.modelspace()
    for wall in level:
        marks = {"layer": layers[wall.layer]}
        line = space.add_lwpolyline([], close=wall.closed, dxfattribs=marks)
        line.lwpoints = Points(np.insert(halved(wall), [2, 2], 0.0, axis=1))  # widths of 0 at both ends of an edge
        line.set_xdata(APP, _notes(wall))
    document.write(stream)


def _layers(level: Level) -> dict[str, str]:
    """Give each layer a name that DXF allows."""
    drawn = list(level.layers())
    layers = dict(zip(drawn, unique((name or "walls" for name in drawn), _FORBIDDEN, fold=True), strict=True))
    level.findings.note_where(
        "export-renamed",
        level.walls,
        lambda wall: bool(wall.layer) and layers[wall.layer] != wall.layer,
        "the name of its layer had to change; as drawn it is in the extended data",
    )
    return layers


def _notes(wall: LevelWall) -> list[tuple[int, str | float]]:
    """Give a wall's words and numbers as extended data: ``key=value``, long values go on in ``key+value``."""
    notes: list[tuple[int, str | float]] = []
    for key, value in (("name", wall.name), ("layer", wall.layer), ("sides", wall.sides)):
        text = without(value, "")
        pieces = [text[k : k + _CHUNK] for k in range(0, len(text), _CHUNK)] or [""]
        notes += [(1000, f"{key}{'+' if k else '='}{piece}") for k, piece in enumerate(pieces)]
    for key in ("restitution", "tangential_restitution"):
        notes += [(1000, key), (1040, float(getattr(wall.material, key)))]
    return notes


def halved(wall: LevelWall) -> FloatArray:
    """Give the corners of a wall as x, y, bulge, with arcs of more than a half circle cut in two.

    The bulge is tan(angle / 4), so that of half the angle is tan(atan(bulge) / 2).
    """
    corners = np.column_stack([wall.vertices, wall.bulges])
    large = np.flatnonzero(np.abs(wall.bulges) > 1)
    if not len(large):
        return corners
    following = np.roll(wall.vertices, -1, axis=0)
    middle = edge_points(wall.vertices[large], following[large], wall.bulges[large], np.full(len(large), 0.5))
    corners[large, 2] = np.tan(np.arctan(corners[large, 2]) / 2)
    added = np.column_stack([middle, corners[large, 2]])
    result: FloatArray = np.insert(corners, large + 1, added, axis=0)
    return result
