"""`wallkit export`: walls as the level that an engine, an editor or another program reads."""

from __future__ import annotations

import io
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from wallkit.cli import import_options as importing

if TYPE_CHECKING:
    from importers.drawing import Drawing
    from importers.problems import Problem
    from wallkit.export.options import Box
    from wallkit.walls import Walls


def register(app: typer.Typer) -> None:
    """Attach the command."""
    app.command("export")(export_level)


def _list_formats(wanted: bool) -> None:
    if wanted:
        from wallkit.export.formats import formats

        for each in formats().values():
            typer.echo(f"{each.name:<11} {each.endings[0]:<14} {each.title}")
        raise typer.Exit


def export_level(
    file: Annotated[str, typer.Argument(metavar="FILE", help="Drawing, walls or scene; - is standard input.")],
    out: Annotated[str, typer.Option("-o", "--out", metavar="OUT", help="Where to write; - is standard output.")] = "-",
    format: Annotated[
        str | None, typer.Option("--format", metavar="NAME", help="Of the level; without it the ending of OUT decides.")
    ] = None,
    list_formats: Annotated[
        bool, typer.Option("--list", callback=_list_formats, is_eager=True, help="List the formats and end.")
    ] = False,
    scale: Annotated[
        float | None,
        typer.Option("--scale", "--meters-per-unit", help="Target units (px, m) per unit of the drawing."),
    ] = None,
    origin: Annotated[
        str, typer.Option(metavar="page|box|X,Y", help="What becomes (0, 0); y is mirrored about it where need be.")
    ] = "page",
    grid: Annotated[float, typer.Option(metavar="G", help="Round coordinates to multiples of it.")] = 0.0,
    tolerance: importing.Tolerance = None,
    curves: Annotated[
        str | None, typer.Option(help="lines or arcs; without it arcs for the formats that keep them.")
    ] = None,
    max_vertices: Annotated[int, typer.Option(help="Of a convex piece.")] = 8,
    min_spacing: Annotated[float | None, typer.Option(metavar="D", help="Leave out vertices nearer than it.")] = None,
    arena_frame: Annotated[float | None, typer.Option(metavar="W", help="Width of the material around a room.")] = None,
    thickness: Annotated[float | None, typer.Option(metavar="W", help="Of open walls, where all is solid.")] = None,
    layer: importing.Layer = None,
    hidden: importing.Hidden = False,
    arena: importing.Arena = False,
    sides: importing.Sides = "both",
) -> None:
    """Write walls where the level is made: Tiled, Godot, Box2D and planck, pymunk, Phaser, DXF, SVG, GeoJSON..."""
    from wallkit.cli.messages import show_problems
    from wallkit.export.formats import find_format

    chosen = find_format(out, format)
    wanted: dict[str, Any] = {"tolerance": tolerance, "curves": curves or ("arcs" if chosen.arcs else "lines")}
    wanted |= {"layers": layer or None, "hidden": hidden, "arena": arena, "sides": sides}
    walls, page = walls_of(file, wanted)
    options: dict[str, Any] = {"scale": scale, "origin": origin, "page": page, "grid": grid, "tolerance": tolerance}
    options |= {"max_vertices": max_vertices, "min_spacing": min_spacing}
    options |= {"arena_frame": arena_frame, "thickness": thickness}
    problems = write_level(walls, out, chosen.name, **options)
    show_problems([*walls.problems, *problems], walls.source_file or file)


def walls_of(file: str, importing: dict[str, Any]) -> tuple[Walls, Box | None]:
    """Read FILE, whatever it is, as walls; with the page of a drawing that has one."""
    from wallkit.cli.scene_input import read_input
    from wallkit.scene_files import kind_of, read_scene

    data = read_input(file)
    kind = kind_of(data)
    if kind == "walls":
        from wallkit.walls.files import loads

        return loads(data, file), None
    if kind == "scene":
        return read_scene(data, file=file, folder=Path() if file == "-" else Path(file).parent).scene.walls, None
    from importers.read import read_drawing
    from wallkit.walls.build import import_walls

    stream = io.BytesIO(data)
    stream.name = file
    drawing = read_drawing(stream)
    return import_walls(drawing, **importing), page_of(drawing)


def page_of(drawing: Drawing, scale: float = 1.0, flip_y: bool = False) -> Box | None:
    """Give the first artboard's box where import options move it to, or None without any."""
    if not drawing.artboards:
        return None
    page = drawing.artboards[0]
    low, high = (-page.y_max, -page.y_min) if flip_y else (page.y_min, page.y_max)
    return page.x_min * scale, low * scale, page.x_max * scale, high * scale


def write_level(walls: Walls, out: str, format: str | None, **options: Any) -> list[Problem]:
    """Export, and say on standard error what was written."""
    from wallkit.export import export, find_format

    problems = export(walls, out, format, **options)
    chosen = find_format(out, format)
    where = "standard output" if out == "-" else out
    if chosen.loader and out != "-":
        where += f", and {Path(out).parent / chosen.loader} that loads it"
    print(f"{len(walls)} {'wall' if len(walls) == 1 else 'walls'} as {chosen.title} to {where}", file=sys.stderr)
    return problems
