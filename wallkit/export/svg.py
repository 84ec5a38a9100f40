"""SVG: a path for each wall, arcs as arcs. wallkit reads it back to the same walls."""

from __future__ import annotations

from importers.drawing import DrawnPath, Subpath
from importers.svg.svgpathtools_paths import svgpathtools_paths
from wallkit.export.level import Level, LevelWall
from wallkit.export.names import say_renamed
from wallkit.export.xml_text import clean, quoted
from wallkit.walls.as_paths import subpath_of

INKSCAPE = "http://www.inkscape.org/namespaces/inkscape"


def write(level: Level) -> str:
    """Write a level as SVG without groups."""
    return write_svg(level, layers=False)


def write_svg(level: Level, layers: bool) -> str:
    """Write a level as SVG; with ``layers`` each layer is a group that Inkscape shows as one."""
    say_renamed(level.walls, [clean(wall.name) for wall in level], "nothing: XML cannot hold it", level.findings)
    width, height = level.page or (max(level.box[2], 1.0), max(level.box[3], 1.0))
    thin = repr(float(f"{level.side / 500:.1g}"))
    spaces = f' xmlns:inkscape="{INKSCAPE}"' if layers else ""
    lines = [
        f'<svg xmlns="http://www.w3.org/2000/svg"{spaces} width="{width!r}" height="{height!r}"'
        f' viewBox="0 0 {width!r} {height!r}" fill="none" stroke="black" stroke-width="{thin}">'
    ]
    if layers:
        for name, walls in level.layers().items():
            lines.append(f' <g inkscape:groupmode="layer" inkscape:label={quoted(name or "walls")}>')
            lines += [f"  {_path(wall)}" for wall in walls]
            lines.append(" </g>")
    else:
        lines += [f" {_path(wall)}" for wall in level]
    return "\n".join([*lines, "</svg>", ""])


def _path(wall: LevelWall) -> str:
    marks = {
        "data-name": wall.name,
        "data-layer": wall.layer,
        "data-sides": wall.sides if wall.one_way else "",
        "data-restitution": repr(float(wall.material.restitution)),
        "data-tangential_restitution": repr(float(wall.material.tangential_restitution)),
    }
    words = "".join(f" {key}={quoted(value)}" for key, value in marks.items() if value)
    return f'<path d="{path_data(wall)}"{words}/>'


def path_data(wall: LevelWall) -> str:
    """Give a wall as path data, as svgpathtools writes it: an M, L for lines, A for arcs; Z closes it."""
    subpath = subpath_of(wall.vertices, wall.bulges, wall.closed)
    (path,) = svgpathtools_paths([DrawnPath([Subpath(subpath.segments, closed=False)])])
    return f"{path.d()} Z" if wall.closed else str(path.d())
