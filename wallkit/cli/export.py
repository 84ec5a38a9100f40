"""`wallkit export`: walls as the level that an engine, an editor or another program reads."""

from __future__ import annotations

import sys
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from wallkit.cli import import_options as options
from wallkit.cli.watching import watchable

if TYPE_CHECKING:
    from importers.drawing import Drawing
    from importers.problems import Problem
    from wallkit.export.options import Box
    from wallkit.walls import Walls


def register(app: typer.Typer) -> None:
    """Attach the command."""
    app.command("export", rich_help_panel="Drawings and walls")(export_level)


def _list_formats(wanted: bool) -> None:
    if wanted:
        from wallkit.export.formats import formats

        for each in formats().values():
            typer.echo(f"{each.name:<11} {each.endings[0]:<14} {each.title}")
        raise typer.Exit


def _complete_formats(begun: str) -> list[tuple[str, str]]:
    """List the formats whose names begin so, each with what it is, for the shell."""
    from wallkit.export.formats import formats

    return [(each.name, each.title) for each in formats().values() if each.name.startswith(begun)]


@options.with_import_options("arcs")
@watchable
def export_level(
    file: Annotated[str, typer.Argument(metavar="FILE", help="Drawing, walls or scene; - is standard input.")],
    out: Annotated[str, typer.Option("-o", "--out", metavar="OUT", help="Where to write; - is standard output.")] = "-",
    format: Annotated[
        str | None,
        typer.Option(
            "--format",
            metavar="NAME",
            help="Of the level; without it the ending of OUT decides.",
            autocompletion=_complete_formats,
        ),
    ] = None,
    list_formats: Annotated[
        bool, typer.Option("--list", callback=_list_formats, is_eager=True, help="List the formats and end.")
    ] = False,
    target_scale: Annotated[
        float | None,
        typer.Option("--target-scale", "--meters-per-unit", help="Target units (px, m) per unit of the walls."),
    ] = None,
    max_vertices: Annotated[int, typer.Option(help="Of a convex piece.")] = 8,
    min_spacing: Annotated[float | None, typer.Option(metavar="D", help="Leave out vertices nearer than it.")] = None,
    arena_frame: Annotated[float | None, typer.Option(metavar="W", help="Width of the material around a room.")] = None,
    thickness: Annotated[float | None, typer.Option(metavar="W", help="Of open walls, where all is solid.")] = None,
    importing: dict[str, Any] | None = None,
) -> None:
    """Write walls where the level is made: Tiled, Godot, Box2D and planck, pymunk, Phaser, DXF, SVG, GeoJSON..."""
    from wallkit.cli.messages import show_problems
    from wallkit.cli.scene_input import opened, read_input
    from wallkit.export.formats import find_format
    from wallkit.scene.file_kinds import kind_of
    from wallkit.scene.wishes import Wishes
    from wallkit.walls.importing.placing import placed

    chosen = find_format(out, format)
    given = options.options_of(importing or {})
    asked = replace(given, origin="", grid=0.0)  # what the level begins with and rounds to, not the drawing
    data = read_input(file)
    if not chosen.arcs and kind_of(data) == "drawing":  # lines near the curves themselves, not near arcs near them
        asked = replace(asked, curves="lines")
    found = opened(file, Wishes(importing=asked, put_ball=False), data)
    walls = found.scene.walls
    page = None if found.drawing is None else page_of(placed(found.drawing, asked), asked.scale, asked.flip_y)
    wanted: dict[str, Any] = {"scale": target_scale, "origin": given.origin or "page", "page": page, "grid": given.grid}
    wanted |= {"tolerance": asked.tolerance, "max_vertices": max_vertices, "min_spacing": min_spacing}
    wanted |= {"arena_frame": arena_frame, "thickness": thickness}
    problems = write_level(walls, out, chosen.name, **wanted)
    show_problems([*walls.problems, *problems], walls.source_file or file)


def page_of(drawing: Drawing, scale: float = 1.0, flip_y: bool = False) -> Box | None:
    """Give the box of the first artboard, or of the sheet, where import options move it to; None without any."""
    page = drawing.artboards[0] if drawing.artboards else drawing.sheet
    if page is None:
        return None
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
