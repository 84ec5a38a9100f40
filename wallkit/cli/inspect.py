"""``wallkit inspect``: what a drawing holds, and what of it would be left out and why."""

from __future__ import annotations

import json
import sys
from collections import Counter
from typing import TYPE_CHECKING, Annotated

import typer

from wallkit.cli.messages import count_by_severity, paint, plain, show_problems, use_colour

if TYPE_CHECKING:
    from importers.drawing import Artboard, Drawing, DrawnPath

_WORDS = {"M": "subpath", "L": "line", "Q": "quadratic curve", "C": "cubic curve", "A": "arc"}
_MOST_LAYERS = 16  # shown; a screen has about forty lines


def register(app: typer.Typer) -> None:
    """Attach the command."""
    app.command("inspect", rich_help_panel="Drawings and walls")(inspect)


def inspect(
    file: Annotated[str, typer.Argument(help="A drawing (Illustrator, EPS, PDF, SVG, pasted text); - is stdin.")],
    as_json: Annotated[bool, typer.Option("--json", help="Write the whole drawing as JSON to stdout.")] = False,
    page: Annotated[str, typer.Option("--page", help="Page or artboard to read, from 1, or all.")] = "",
    via: Annotated[str, typer.Option("--via", help="ghostscript: let it run a PostScript program.")] = "",
) -> None:
    """Show what FILE holds: layers, paths, boxes, units, and what is left out and why."""
    from importers.page_choice import page_choice
    from importers.read import read_drawing

    drawing = read_drawing(file, page=page_choice(page, file), via=via)
    if as_json:
        json.dump(drawing.to_json(), sys.stdout, ensure_ascii=False, allow_nan=False)
        sys.stdout.write("\n")
    else:
        sys.stdout.write(describe(drawing, use_colour(sys.stdout)))
        sys.stdout.flush()
    show_problems(drawing.problems, file)


def describe(drawing: Drawing, colour: bool = False) -> str:
    """Give the one-screen description of a drawing."""
    lines = [paint(plain(drawing.file) or "drawing", "bold", colour) + f": {drawing.kind or 'drawing'}"]
    lines.append(f"  units    {drawing.units}, y axis {drawing.y_axis}")
    lines += _sheet_lines(drawing)
    lines.append(f"  paths    {_path_counts(drawing.paths)}")
    lines.append(f"  segments {_segment_counts(drawing.paths)}")
    art = [path for path in drawing.paths if not path.guide]  # guides go far beyond what is drawn
    lines.append(f"  box      {_box_text(art)}")
    lines += _layer_lines(drawing, colour)
    lines.append(f"  problems {count_by_severity(drawing.problems)}")
    return "\n".join(lines) + "\n"


def _sheet_lines(drawing: Drawing) -> list[str]:
    """Tell the size of the page, as drawn and on paper, and its artboards."""
    lines = [f"  page     {_size(drawing.sheet, drawing.units)}"] if drawing.sheet is not None else []
    if len(drawing.artboards) > 1:
        lines.append(f"  pages    {len(drawing.artboards)} (--page N takes one of them)")
        shown = drawing.artboards[:_MOST_LAYERS]
        lines += [f'    {n + 1} "{plain(b.name)}": {_size(b, drawing.units)}' for n, b in enumerate(shown)]
    return lines


def _size(board: Artboard, units: str) -> str:
    width, height = board.x_max - board.x_min, board.y_max - board.y_min
    millimetre = {"px": 25.4 / 96, "pt": 25.4 / 72}[units]
    return f"{width:.6g} by {height:.6g} {units}, {width * millimetre:.5g} by {height * millimetre:.5g} mm"


def _path_counts(paths: list[DrawnPath]) -> str:
    closed = sum(sub.closed for path in paths for sub in path.subpaths)
    subpaths = sum(len(path.subpaths) for path in paths)
    marks = [
        (sum(not path.visible for path in paths), "hidden"),
        (sum(path.locked for path in paths), "locked"),
        (sum(path.guide for path in paths), "guides"),
        (sum(path.clip for path in paths), "clipping"),
    ]
    extra = "".join(f", {number} {word}" for number, word in marks if number)
    return f"{len(paths)} ({subpaths} subpaths: {closed} closed, {subpaths - closed} open){extra}"


def _segment_counts(paths: list[DrawnPath]) -> str:
    counts = Counter(segment[0] for path in paths for sub in path.subpaths for segment in sub.segments)
    parts = [
        f"{counts[kind]} {word}{'' if counts[kind] == 1 else 's'}" for kind, word in _WORDS.items() if kind in counts
    ]
    return ", ".join(part for part in parts if "subpath" not in part) or "none"


def _box_text(paths: list[DrawnPath]) -> str:
    from importers.boxes import box_of

    box = box_of(paths)
    if box is None:
        return "none"
    x0, y0, x1, y1 = box
    return f"x {x0:.6g} to {x1:.6g}, y {y0:.6g} to {y1:.6g} ({x1 - x0:.6g} by {y1 - y0:.6g})"


def _layer_lines(drawing: Drawing, colour: bool) -> list[str]:
    by_layer: dict[str, list[DrawnPath]] = {layer.name: [] for layer in drawing.layers}
    for path in drawing.paths:
        by_layer.setdefault(path.layer, []).append(path)
    marks = {
        layer.name: [
            word
            for word, there in (
                ("hidden", not layer.visible),
                ("locked", layer.locked),
                ("not printing", not layer.printing),
            )
            if there
        ]
        for layer in drawing.layers
    }
    lines = [f"  layers   {len(drawing.layers)}"]
    for name in list(by_layer)[:_MOST_LAYERS]:
        title = f'"{plain(name)}"' if name or name in marks else "(no layer)"
        words = "".join(f", {word}" for word in marks.get(name, []))
        count = len(by_layer[name])
        lines.append(
            f"    {paint(title, 'bold', colour)}: {count} path{'' if count == 1 else 's'}{words}; "
            f"box {_box_text([path for path in by_layer[name] if not path.guide])}"
        )
    if len(by_layer) > _MOST_LAYERS:
        lines.append(f"    and {len(by_layer) - _MOST_LAYERS} more layers")
    return lines
