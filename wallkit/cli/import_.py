"""`wallkit import`: a drawing becomes walls; data on standard output, a summary on standard error."""

from __future__ import annotations

import io
import sys
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, TextIO

import typer

from wallkit.cli import import_options as options
from wallkit.cli.watching import watchable

if TYPE_CHECKING:
    from wallkit.walls import Walls
    from wallkit.walls.import_options import ImportOptions


def register(app: typer.Typer) -> None:
    """Attach the command."""
    app.command("import", rich_help_panel="Drawings and walls")(import_drawing)


@options.with_import_options("lines")
@watchable
def import_drawing(
    file: options.File,
    out: Annotated[
        str,
        typer.Option(
            "-o",
            "--out",
            metavar="OUT",
            help="Where to write: .json, or as export does; - is stdout. --page all: one each.",
        ),
    ] = "-",
    preview: Annotated[str, typer.Option(metavar="PICTURE", help="Draw the walls and all findings (.svg, .png).")] = "",
    importing: dict[str, Any] | None = None,
) -> None:
    """Turn a drawing into walls: closed and open polylines with outward normals."""
    _check_ending(out)
    asked = options.options_of(importing or {})
    if asked.page == "all" and out != "-":
        pages = _pages(file, asked.via)
        if pages > 1:
            for page in range(1, pages + 1):
                at = _numbered(preview, page) if preview else ""
                _import(file, replace(asked, page=page), _numbered(out, page), at)
            return
    _import(file, asked, out, preview)


def _import(file: str, asked: ImportOptions, out: str, preview: str) -> None:
    from importers.read import read_drawing
    from wallkit.cli.export import page_of, write_level
    from wallkit.cli.messages import show_problems
    from wallkit.export.formats import known_ending
    from wallkit.walls.importing.pipeline import import_walls

    drawing = read_drawing(source(file), page=asked.page, via=asked.via)
    walls = import_walls(drawing, asked)
    if preview:
        draw(walls, preview)
    problems = walls.problems
    if out == "-" or not known_ending(out):
        walls.save(out)
    else:
        problems = problems + write_level(walls, out, None, page=page_of(drawing, asked.scale, asked.flip_y))
    show_problems(problems, walls.source_file)
    summarise(walls)
    if walls.solid is not None and walls.solid.how != "asked":
        print(f"assumed: {walls.solid.sentence()}", file=sys.stderr)


def _pages(file: str, via: str) -> int:
    """Count the pages or artboards of a drawing."""
    from importers.read import read_drawing

    return len(read_drawing(source(file), page="all", via=via).artboards)


def _numbered(name: str, page: int) -> str:
    """Name the file of one page: ``level.json`` becomes ``level-2.json``."""
    path = Path(name)
    return str(path.with_name(f"{path.stem}-{page}{path.suffix}"))


def source(file: str) -> Any:
    """Give what the reader takes: the path, or standard input for ``-``, called so in messages."""
    if file != "-":
        return file
    from wallkit.cli.scene_input import read_input  # late: it brings numpy

    stream = io.BytesIO(read_input(file))
    stream.name = file
    return stream


def _check_ending(out: str) -> None:
    from wallkit.export.formats import formats, known_ending
    from wallkit.walls.walls import WallsError

    if out != "-" and Path(out).suffix.lower() != ".json" and not known_ending(out):
        endings = ", ".join(each.endings[0] for each in formats().values())
        raise WallsError(
            f"walls cannot be written as {Path(out).suffix or 'a file without an ending'}",
            code="unknown-ending",
            fix=f"use .json, or for a level an ending of these: {endings}",
            file=out,
        )


def draw(walls: Walls, picture: str) -> None:
    """Write the picture of walls and their problems."""
    from wallkit.view.picture import walls_canvas
    from wallkit.view.write import write_picture

    write_picture(picture, walls_canvas(walls, walls.problems))


def summarise(walls: Walls, stream: TextIO | None = None) -> None:
    """Write what came of it: one line for the walls, one for how exact they are."""
    stream = stream or sys.stderr
    closed, edges = int(walls.closed.sum()), len(walls.edge_starts)
    still_open = len(walls) - closed
    parts = [f"{closed} closed", f"{still_open} open"] if still_open else [f"{closed} closed"]
    print(
        f"{len(walls)} {_plural('wall', len(walls))} ({', '.join(parts)}), {edges} {_edge_words(walls, edges)}",
        file=stream,
    )
    exact = f"largest distance to the drawn curves {walls.measured_error:.3g} (tolerance {walls.tolerance:.3g})"
    if walls.measured_normal_error is not None:
        exact += f", largest error of a normal {walls.measured_normal_error:.3g} rad"
    print(exact, file=stream)


def _edge_words(walls: Walls, edges: int) -> str:
    import numpy as np

    arcs = int(np.count_nonzero(walls.bulges))
    return _plural("edge", edges) + (f" ({arcs} {_plural('arc', arcs)})" if arcs else "")


def _plural(word: str, count: int) -> str:
    return word if count == 1 else word + "s"
