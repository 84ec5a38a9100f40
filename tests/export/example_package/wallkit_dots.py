"""A format of one wall a line: "dots", then "closed" or "open" and the points. Written and read in forty lines."""

from __future__ import annotations

from typing import TextIO

from importers.drawing import Drawing, DrawnPath, Subpath
from importers.problems import Problem
from wallkit.export import ExportOptions, build_level
from wallkit.walls import Walls


def write(walls: Walls, stream: TextIO, options: ExportOptions) -> list[Problem]:
    """Write walls as dots: what `wallkit export level.dots` calls."""
    level = build_level(walls, options, y_axis="up")  # placed, y up, arcs as lines
    for wall in level:
        points = " ".join(f"{x!r},{y!r}" for x, y in wall.vertices.tolist())
        stream.write(f"dots {'closed' if wall.closed else 'open'} {points}\n")
    level.findings.note_where("export-names", level.walls, lambda wall: bool(wall.name), "dots have no names")
    return level.findings.problems


def read(data: bytes) -> Drawing | None:
    """Read dots; None for any other file, so that the next reader is asked."""
    if not data.startswith(b"dots "):
        return None
    paths = []
    for line in data.decode("ascii").splitlines():
        _, kind, *points = line.split()
        (x, y), *rest = (tuple(float(number) for number in point.split(",")) for point in points)
        segments = [("M", x, y), *(("L", *point) for point in rest)]
        paths.append(DrawnPath([Subpath(segments, kind == "closed")], stroke="#000000"))
    return Drawing("px", "up", paths=paths, kind="dots")
