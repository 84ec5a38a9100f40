"""SVG: a path for each wall, arcs as arcs. wallkit reads it back to the same walls."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TextIO

import numpy as np

from importers.drawing import DrawnPath
from importers.svg.svgpathtools_paths import svgpathtools_paths
from wallkit.export.level import Level, LevelWall
from wallkit.export.names import say_renamed
from wallkit.export.xml_text import clean, quoted
from wallkit.walls.as_paths import subpath_of

AT_ONCE = 2048  # edges
INKSCAPE = "http://www.inkscape.org/namespaces/inkscape"


def write(level: Level, stream: TextIO) -> None:
    """Write a level as SVG without groups."""
    write_svg(level, stream, layers=False)


def write_svg(level: Level, stream: TextIO, layers: bool) -> None:
    """Write a level as SVG; with ``layers`` each layer is a group that Inkscape shows as one."""
    say_renamed(level.walls, [clean(wall.name) for wall in level], "nothing: XML cannot hold it", level.findings)
    width, height = level.page or (max(level.box[2], 1.0), max(level.box[3], 1.0))
    thin = repr(float(f"{level.side / 500:.1g}"))
    spaces = f' xmlns:inkscape="{INKSCAPE}"' if layers else ""
    stream.write(
        f'<svg xmlns="http://www.w3.org/2000/svg"{spaces} width="{width!r}" height="{height!r}"'
        f' viewBox="0 0 {width!r} {height!r}" fill="none" stroke="black" stroke-width="{thin}">\n'
    )
    if layers:
        for name, walls in level.layers().items():
            stream.write(f' <g inkscape:groupmode="layer" inkscape:label={quoted(name or "walls")}>\n')
            for wall in walls:
                _write_path(wall, "  ", stream)
            stream.write(" </g>\n")
    else:
        for wall in level:
            _write_path(wall, " ", stream)
    stream.write("</svg>\n")


def _write_path(wall: LevelWall, indent: str, stream: TextIO) -> None:
    marks = {
        "data-name": wall.name,
        "data-layer": wall.layer,
        "data-sides": wall.sides if wall.one_way else "",
        "data-restitution": repr(float(wall.material.restitution)),
        "data-tangential_restitution": repr(float(wall.material.tangential_restitution)),
    }
    words = "".join(f" {key}={quoted(value)}" for key, value in marks.items() if value)
    stream.write(f'{indent}<path d="')
    for part in path_data(wall):
        stream.write(part)
    stream.write(f'"{words}/>\n')


def path_data(wall: LevelWall) -> Iterator[str]:
    """Give a wall as path data, as svgpathtools writes it: an M, L for lines, A for arcs; Z closes it.

    Its segments are objects of some 500 bytes for an edge, so a long wall is given to it in parts. Each begins with
    an M where the one before ended, which is left out.
    """
    count = len(wall.vertices)
    for start in range(0, max(count - 1, 1), AT_ONCE):
        end = min(start + AT_ONCE, count - 1)
        around = np.arange(start, end + 1)
        if wall.closed and end == count - 1 and wall.bulges[-1]:  # Z draws a closing line, but no arc
            around = np.append(around, 0)
        subpath = subpath_of(wall.vertices[around], wall.bulges[around], closed=False)
        (path,) = svgpathtools_paths([DrawnPath([subpath])])
        data = str(path.d())
        yield data if start == 0 else " " + data.split(" ", 2)[2]
    if wall.closed:
        yield " Z"
