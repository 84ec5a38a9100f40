"""Places: a drawing on the page, in the units and with the origin that are asked for, before anything is made of it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from importers.boxes import Box, box_of
from importers.drawing import Artboard, Drawing, DrawnPath, Segment, Subpath
from importers.limits import MAX_COORDINATE
from importers.page_choice import keep_artboard
from importers.problems import Problem
from wallkit.walls.import_options import INCH, ImportOptions, point_of, scale_of
from wallkit.walls.importing.segments import default_tolerance, gather
from wallkit.walls.walls import WallsError

Point = Callable[[float, float], tuple[float, float]]


def placed(drawing: Drawing, options: ImportOptions) -> Drawing:
    """Give the part of a drawing that is asked for, in its units, with its origin.

    A length l of the file is l * a / b in the units asked for, see :func:`_ratio`. Then the origin is taken away; scale
    and flip, which come later, leave it where it is.

    Args:
        drawing: as read; it stays as it is.
        options: ``page``, ``units``, ``origin``, ``flip_y``, ``apply_clips`` and ``tolerance`` are asked.

    Raises:
        DrawingError: there is no such page.
        LimitError: the clips are too large to cut with.
        WallsError: the origin is to be a page or box that the drawing has not, its units are no lengths, or what comes
            out is larger than 1e9.
    """
    if isinstance(options.page, int) and drawing.page != options.page:
        drawing = replace(drawing, problems=list(drawing.problems))
        keep_artboard(drawing, options.page)
    elif options.page is None and len(drawing.artboards) > 1:
        drawing = replace(drawing, problems=[*drawing.problems, _several(drawing)])
    units, a, b = _ratio(drawing, options)
    if options.apply_clips:
        from wallkit.walls.importing.clips import clipped

        drawing = clipped(drawing, _nearness(drawing, options, a / b))
    if units == drawing.units and a == b and not options.origin:
        return _reachable(drawing, options)
    x0, y0 = point_of(options.origin) or _corner(drawing, options, a, b)
    factor = a / b

    def moved(x: float, y: float) -> tuple[float, float]:
        return x * a / b - x0, y * a / b - y0

    found = replace(
        drawing,
        units=units,
        paths=[_path(path, moved, factor) for path in drawing.paths],
        problems=[_problem(problem, moved) for problem in drawing.problems],
        artboards=[_artboard(board, moved) for board in drawing.artboards],
        sheet=None if drawing.sheet is None else _artboard(drawing.sheet, moved),
    )
    return _reachable(found, options)


def _reachable(drawing: Drawing, options: ImportOptions) -> Drawing:
    """Give the drawing back if it stays within the largest coordinates, once it is scaled; readers see to the rest."""
    moves = [f"--{name}" for name in ("units", "origin") if getattr(options, name)]
    moves += ["--scale"] if options.scale > 1.0 else []
    most = MAX_COORDINATE / max(1.0, options.scale)
    if moves and not all(sub.within(most) for path in drawing.paths for sub in path.subpaths):
        message = f"the drawing reaches beyond {MAX_COORDINATE:g} with {' and '.join(moves)}"
        fix = "ask for larger units, a smaller scale or a nearer origin"
        raise WallsError(message, code="bad-option", fix=fix, file=drawing.file)
    return drawing


def _ratio(drawing: Drawing, options: ImportOptions) -> tuple[str, float, float]:
    """Give the units asked for, and a and b, of which the one of these is as long as the other of the drawing's.

    With the scale ``A u = B w`` of units u and w, and i(w) of w and i(d) of the drawing's to the inch, a length l of
    the drawing is l i(w) / i(d) w on its paper, and is to be A / B of that: a / b = A i(w) / (B i(d)).
    """
    scale = scale_of(options.units or drawing.units)
    if scale is None and not options.origin:
        return drawing.units, 1.0, 1.0
    if scale is None or drawing.units not in INCH:
        raise WallsError(f"units {drawing.units!r} have no size", code="bad-option", fix=f"one of: {', '.join(INCH)}")
    if scale.of == drawing.units:
        return scale.name, scale.shown, scale.drawn
    return scale.name, scale.shown * INCH[scale.of], scale.drawn * INCH[drawing.units]


def _nearness(drawing: Drawing, options: ImportOptions, own: float) -> float:
    """Give half the tolerance in the drawing's own units, of which one is ``own`` of those asked for.

    The other half is for what becomes of the lines.
    """
    usual = default_tolerance(gather(sub for path in drawing.paths for sub in path.subpaths), 0.1 / own)
    return (usual if options.tolerance is None else options.tolerance / own) / 2


def _several(drawing: Drawing) -> Problem:
    names = ", ".join(f"{index + 1} {board.name!r}" for index, board in enumerate(drawing.artboards[:8]))
    count = len(drawing.artboards)
    more = "" if count <= 8 else f" and {count - 8} more"
    message = f"{count} pages are one level: {names}{more}"
    return Problem(
        "several-artboards", "info", message, "choose one with --page N; or say that all are meant, --page all"
    )


def _corner(drawing: Drawing, options: ImportOptions, a: float, b: float) -> tuple[float, float]:
    """Give the corner of page or box that becomes (0, 0), of smallest coordinates in the result and in its units."""
    if not options.origin:
        return 0.0, 0.0
    box = _page_box(drawing) if options.origin == "page" else _art_box(drawing)
    if box is None:
        other = "box" if options.origin == "page" else "X,Y"
        what = "says no page" if options.origin == "page" else "is empty"
        raise WallsError(f"the drawing {what}", code="no-origin", fix=f"give --origin {other}", file=drawing.file)
    return box[0] * a / b, (box[3] if options.flip_y else box[1]) * a / b


def _page_box(drawing: Drawing) -> Box | None:
    sheets = [drawing.sheet] if drawing.sheet is not None else drawing.artboards
    if not sheets:
        return None
    low_x, low_y = min(sheet.x_min for sheet in sheets), min(sheet.y_min for sheet in sheets)
    return low_x, low_y, max(sheet.x_max for sheet in sheets), max(sheet.y_max for sheet in sheets)


def _art_box(drawing: Drawing) -> Box | None:
    return box_of(path for path in drawing.paths if path.visible and not path.guide and not path.clip)


def _path(path: DrawnPath, moved: Point, factor: float) -> DrawnPath:
    width = None if path.stroke_width is None else path.stroke_width * factor
    subpaths = [Subpath([_segment(part, moved, factor) for part in sub.segments], sub.closed) for sub in path.subpaths]
    return replace(path, subpaths=subpaths, stroke_width=width, error=path.error * factor)


def _segment(segment: Segment, moved: Point, factor: float) -> Segment:
    if segment[0] == "A":
        _, rx, ry, rotation, large, sweep, x, y = segment
        return ("A", rx * factor, ry * factor, rotation, large, sweep, *moved(x, y))
    numbers = segment[1:]
    return (segment[0], *(part for x, y in zip(numbers[::2], numbers[1::2], strict=True) for part in moved(x, y)))


def _artboard(board: Artboard, moved: Point) -> Artboard:
    return Artboard(board.name, *moved(board.x_min, board.y_min), *moved(board.x_max, board.y_max))


def _problem(problem: Problem, moved: Point) -> Problem:
    if problem.x is None or problem.y is None:
        return problem
    x, y = moved(problem.x, problem.y)
    return replace(problem, x=x, y=y)
