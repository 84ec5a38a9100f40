"""From a drawing to walls: choose paths, make edges of curves, clean, nest, orient, report."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import IO, Any, Literal, Unpack, cast

import numpy as np

from importers.drawing import Drawing, DrawnPath
from importers.problems import Problem
from wallkit.geometry.arrays import FloatArray
from wallkit.walls.checking.self_check import straight_edges, validate
from wallkit.walls.import_options import ImportOptions, ImportWishes
from wallkit.walls.importing.arc_fitting.curves_to_arcs import fit_arcs
from wallkit.walls.importing.choose_paths import choose
from wallkit.walls.importing.clean import clean
from wallkit.walls.importing.curves_to_lines import Pieces, flatten
from wallkit.walls.importing.drawn_balls import drawn_balls
from wallkit.walls.importing.drawn_sensors import drawn_places, drawn_sensors
from wallkit.walls.importing.fill_rule import material_rings
from wallkit.walls.importing.outlines import Outlines, assemble, keep_sides, on_grid
from wallkit.walls.importing.placing import placed
from wallkit.walls.importing.segments import Segments, default_tolerance, gather
from wallkit.walls.met_lines import MetLines
from wallkit.walls.nesting import depths
from wallkit.walls.orient import turned_to
from wallkit.walls.solid import Nested, decide
from wallkit.walls.walls import Walls, WallsError

Source = str | Path | IO[bytes] | IO[str] | Drawing | Sequence[Any]


def import_walls(source: Source, options: ImportOptions | None = None, /, **wishes: Unpack[ImportWishes]) -> Walls:
    """Turn a drawing into walls.

    Args:
        source: a path, a file object, a Drawing, or paths of the library svgpathtools (px, y down).
        options: all options in one value; or else
        **wishes: the same as keywords, such as ``tolerance=0.05, curves="arcs", snap=0.5``; see
            :class:`wallkit.walls.import_options.ImportOptions` for all of them. ``repairs`` takes a ``Repairs``.

    Returns:
        Walls with everything noticed in ``problems``; nothing is left out without one. ``solid`` says which side of
        the outermost walls is material, and why: paint and the balls that are drawn decide, unless an option does.

    Raises:
        DrawingError: the source is not a drawing.
        WallsError: an option is out of range, or a glob fits nothing.
        LimitError: more than 2,000,000 vertices.
    """
    if options is not None and wishes:
        raise WallsError("options come in one value or as keywords", code="bad-option", fix="give one of the two")
    chosen = ImportOptions.of(**wishes) if options is None else options
    drawing = source if isinstance(source, Drawing) else _read(source, chosen)
    return build_walls(placed(drawing, chosen), chosen)


def build_walls(drawing: Drawing, options: ImportOptions, balls: FloatArray | None = None) -> Walls:
    """Turn a drawing into walls, with balls that are not drawn, see :func:`walls_and_lines`."""
    return walls_and_lines(drawing, options, balls)[0]


def walls_and_lines(
    drawing: Drawing, options: ImportOptions, balls: FloatArray | None = None
) -> tuple[Walls, MetLines | None]:
    """Turn a drawing into walls, and say where they meet: that was looked for, but where walls were repaired.

    Args:
        drawing: in its place, see :func:`wallkit.walls.importing.placing.placed`.
        options: how.
        balls: (n, 2) centres in the units of the result; where none are drawn they help to decide what is solid.
    """
    scale, flip_y = options.scale, options.flip_y
    drawn, _ = drawn_balls(drawing)
    if drawn or balls is None:
        balls = np.array([(ball.x, ball.y) for ball in drawn]).reshape(-1, 2) * (scale, -scale if flip_y else scale)
    choice = choose(drawing, options, drawn)
    chosen, pointless = _with_segments(choice.walls)
    if options.outline_strokes:
        chosen, outlined = _outlined(chosen, options.tolerance)
        pointless += outlined
    segments = gather((sub for path in chosen for sub in path.subpaths), scale, flip_y)
    within = default_tolerance(segments) if options.tolerance is None else options.tolerance * scale
    pieces = _pieces(segments, within, options)
    markers = drawn_places(choice.places, scale, flip_y)
    if not len(balls):
        balls = np.array([(marker.x, marker.y) for marker in markers if marker.kind == "spawn"]).reshape(-1, 2)
    outlines, moved = _outlines(segments, pieces, chosen, options)
    cut = scale * max((path.error for path in chosen), default=0.0)
    walls, met = nested(keep_sides(outlines) if flip_y else outlines, options, within, balls)
    sensors, doubtful = _sensors(choice.sensors, options, within)
    found = [_moved(problem, scale, flip_y) for problem in (*drawing.problems, *choice.problems, *pointless)]
    walls = replace(
        walls,
        units=drawing.units if scale == 1 else "",
        y_axis=_flipped(drawing.y_axis) if flip_y else drawing.y_axis,
        tolerance=within,
        measured_error=walls.measured_error + pieces.error + moved + cut,
        measured_normal_error=pieces.normal_error,
        source_file=drawing.file,
        source_sha256=drawing.sha256,
        problems=found + walls.problems + doubtful,
        markers=markers,
    )
    if sensors is not None:
        from wallkit.walls.walls_json import sensors_like

        walls = replace(walls, sensors=sensors_like(walls, sensors))
    return walls, met


def _pieces(segments: Segments, within: float, options: ImportOptions) -> Pieces:
    return fit_arcs(segments, within) if options.curves == "arcs" else flatten(segments, within)


def _outlines(
    segments: Segments, pieces: Pieces, paths: list[DrawnPath], options: ImportOptions
) -> tuple[Outlines, float]:
    """Make clean polylines, on the grid that is asked for: them, and how far that moved anything at most."""
    outlines = assemble(segments, pieces, paths)
    if not options.grid:
        return clean(outlines), 0.0
    outlines, moved = on_grid(outlines, options.grid)
    return clean(outlines), moved


def _sensors(paths: list[DrawnPath], options: ImportOptions, within: float) -> tuple[Walls | None, list[Problem]]:
    """Make sensors as exact as the walls; what is cleaned of them is told as for walls."""
    paths, pointless = _with_segments(paths)
    if not paths:
        return None, pointless
    segments = gather((sub for path in paths for sub in path.subpaths), options.scale, options.flip_y)
    outlines, _ = _outlines(segments, _pieces(segments, within, options), paths, options)
    sensors, problems = drawn_sensors(outlines)
    return sensors, [_moved(problem, options.scale, options.flip_y) for problem in pointless] + problems


def _read(source: str | Path | IO[bytes] | IO[str] | Sequence[Any], options: ImportOptions) -> Drawing:
    if type(source).__module__.startswith("svgpathtools."):  # a Path is a list of segments
        source = [source]
    if isinstance(source, list | tuple):
        from importers.svg.svgpathtools_paths import drawing_from_svgpathtools

        return drawing_from_svgpathtools(source)
    from importers.read import read_drawing  # late: it brings the readers of all formats

    drawing: Drawing = read_drawing(cast(Any, source), page=options.page, via=options.via)
    return drawing


def _outlined(paths: list[DrawnPath], tolerance: float | None) -> tuple[list[DrawnPath], list[Problem]]:
    from wallkit.walls.importing.stroke_areas import outline_strokes

    within = (
        default_tolerance(gather(sub for path in paths for sub in path.subpaths)) if tolerance is None else tolerance
    )
    return outline_strokes(paths, within)


def _with_segments(paths: list[DrawnPath]) -> tuple[list[DrawnPath], list[Problem]]:
    """Take away subpaths that only move the pen; each is a path of one point and reported as such."""
    kept: list[DrawnPath] = []
    problems: list[Problem] = []
    for path in paths:
        drawn = [sub for sub in path.subpaths if len(sub) > 1]
        if len(drawn) < len(path.subpaths):
            problems.extend(_one_point(path, *sub.start) for sub in path.subpaths if len(sub) == 1)
        if drawn:
            kept.append(path if len(drawn) == len(path.subpaths) else replace(path, subpaths=drawn))
    return kept, problems


def _one_point(path: DrawnPath, x: float, y: float) -> Problem:
    return Problem(
        code="one-point-path",
        severity="warning",
        message="a path of a single point has no wall",
        fix="delete the stray point, or draw a small circle if a ball should hit it",
        layer=path.layer,
        name=path.name,
        line=path.line,
        x=x,
        y=y,
    )


def nested(
    outlines: Outlines, options: ImportOptions, tolerance: float, balls: FloatArray
) -> tuple[Walls, MetLines | None]:
    """Find out which rings are edges of paint, nest them, decide what is solid, repair if asked to, turn, and check."""
    plain = replace(outlines.to_walls(options.sides), tolerance=tolerance)
    met = MetLines.of(plain, straight_edges(plain))
    keep, dropped = material_rings(outlines, met.edges, met.touches.crossing_walls)
    problems = outlines.problems + dropped
    if not keep.all():
        outlines = outlines.keep(keep)
        plain = replace(outlines.to_walls(options.sides), tolerance=tolerance)
        met = MetLines.of(plain, straight_edges(plain))
    owners = [outlines.paths[owner] for owner in outlines.owner.tolist()]
    lines = [path.line for path in owners]
    depth, parent = depths(met.edges, met.touches.crossing_walls)
    solid = decide(Nested(met.edges, depth, parent, owners), options, balls)
    repairs = options.repairs
    if repairs is not None:
        from wallkit.walls.repairing.passes import repair

        even_odd = [path.fill is not None and path.fill_rule == "evenodd" for path in owners]
        done = repair(plain, repairs, arena=solid.room, even_odd=even_odd, file_lines=lines)
        problems = problems + [change.to_problem() for change in done.changes] + done.violations
        return replace(done.walls, solid=solid, problems=_still_true(problems, done.walls)), None
    walls = turned_to(plain, depth, solid.room)
    found = validate(plain, lines=lines, edges=met.edges, touches=met.touches)
    return replace(walls, solid=solid, problems=problems + found), met


def _still_true(problems: list[Problem], walls: Walls) -> list[Problem]:
    """Leave out open paths that repair has closed: their reported end is no open end any more."""
    first, last = walls.offsets[:-1][~walls.closed], walls.offsets[1:][~walls.closed] - 1
    ends = {tuple(point) for point in walls.vertices[np.concatenate([first, last])].tolist()}
    return [problem for problem in problems if problem.code != "open-path" or (problem.x, problem.y) in ends]


def _flipped(axis: Literal["up", "down"]) -> Literal["up", "down"]:
    return "down" if axis == "up" else "up"


def _moved(problem: Problem, scale: float, flip_y: bool) -> Problem:
    if problem.x is None or problem.y is None or (scale == 1 and not flip_y):
        return problem
    return replace(problem, x=problem.x * scale, y=problem.y * scale * (-1 if flip_y else 1))
