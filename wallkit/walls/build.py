"""From a drawing to walls: choose paths, make edges of curves, clean, nest, orient, report."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import IO, Literal

import numpy as np

from importers.drawing import Drawing, DrawnPath
from importers.problems import Problem
from wallkit.walls.arcs import fit_arcs
from wallkit.walls.clean import clean
from wallkit.walls.contacts import find_contacts
from wallkit.walls.filling import material_rings
from wallkit.walls.flatten import Pieces, flatten
from wallkit.walls.orient import oriented
from wallkit.walls.outlines import Outlines, assemble
from wallkit.walls.repair import Repairs, repair
from wallkit.walls.select import choose
from wallkit.walls.strokes import Strokes, gather
from wallkit.walls.validate import straight_edges, validate
from wallkit.walls.walls import Sides, Walls, WallsError

Curves = Literal["lines", "arcs"]
Source = str | Path | IO[bytes] | IO[str] | Drawing


def import_walls(
    source: Source,
    *,
    tolerance: float | None = None,
    curves: Curves = "lines",
    layers: Sequence[str] | None = None,
    hidden: bool = False,
    snap: float = 0.0,
    arena: bool = False,
    sides: Sides = "both",
    scale: float = 1.0,
    flip_y: bool = False,
    repairs: Repairs | None = None,
    outline_strokes: bool = False,
) -> Walls:
    """Turn a drawing into walls.

    Args:
        source: a path, a file object, or a Drawing.
        tolerance: the largest distance between a curve and its edges, in the drawing's units; by default
            0.1 % of the diagonal of what is taken, at most 0.1.
        curves: ``"lines"`` or ``"arcs"``.
        layers: globs on layer and group names; only these are taken.
        hidden: take hidden paths too.
        snap: open ends within this distance of each other or of a wall are moved together, and joined; the
            same as ``repairs`` with that ``snap``.
        arena: the outermost closed walls are rooms: what is inside is free, material is outside.
        sides: ``"both"`` or ``"outward"``, for closed walls; open ones are always two-sided.
        scale: factor on all coordinates; the places of problems are scaled too.
        flip_y: mirror the y axis (SVG's points down).
        repairs: passes of :func:`wallkit.walls.repair.repair`, their lengths in the drawing's units; what they
            changed is in ``problems``.
        outline_strokes: a stroke with a width becomes the solid that it paints.

    Returns:
        Walls with everything noticed in ``problems``; nothing is left out without one.

    Raises:
        DrawingError: the source is not a drawing.
        WallsError: an option is out of range, or a layer glob fits nothing.
        LimitError: more than 2,000,000 vertices.
    """
    _check(tolerance, curves, sides, scale)
    drawing = source if isinstance(source, Drawing) else _read(source)
    chosen, problems = choose(drawing, layers, hidden)
    chosen, pointless = _with_segments(chosen)
    if outline_strokes:
        chosen, outlined = _outlined(chosen, tolerance)
        pointless += outlined
    strokes = gather((sub for path in chosen for sub in path.subpaths), scale, flip_y)
    within = default_tolerance(strokes) if tolerance is None else tolerance * scale
    pieces = _edges(strokes, within, curves)
    outlines = clean(assemble(strokes, pieces, chosen))
    walls = nested(outlines, sides, arena, within, _scaled(repairs, snap, scale))
    found = [_moved(problem, scale, flip_y) for problem in (*drawing.problems, *problems, *pointless)]
    return replace(
        walls,
        units=drawing.units if scale == 1 else "",
        y_axis=_flipped(drawing.y_axis) if flip_y else drawing.y_axis,
        tolerance=within,
        measured_error=walls.measured_error + pieces.error,
        measured_normal_error=pieces.normal_error,
        source_file=drawing.file,
        source_sha256=drawing.sha256,
        problems=found + walls.problems,
    )


def _read(source: str | Path | IO[bytes] | IO[str]) -> Drawing:
    from importers.read import read_drawing  # late: it brings the readers of all formats

    drawing: Drawing = read_drawing(source)
    return drawing


def _scaled(repairs: Repairs | None, snap: float, scale: float) -> Repairs | None:
    """The passes to run, lengths in the units of the result; None for none."""
    if snap:
        repairs = replace(repairs or Repairs(), snap=snap)
    if repairs is None:
        return None
    return replace(
        repairs, snap=repairs.snap * scale, min_width=repairs.min_width * scale, simplify=repairs.simplify * scale
    )


def _outlined(paths: list[DrawnPath], tolerance: float | None) -> tuple[list[DrawnPath], list[Problem]]:
    from wallkit.walls.stroking import outline_strokes

    within = (
        default_tolerance(gather(sub for path in paths for sub in path.subpaths)) if tolerance is None else tolerance
    )
    return outline_strokes(paths, within)


def _check(tolerance: float | None, curves: str, sides: str, scale: float) -> None:
    if tolerance is not None and not (math.isfinite(tolerance) and tolerance > 0):
        raise WallsError(f"tolerance is {tolerance!r}", code="bad-option", fix="give a number above 0")
    if curves not in ("lines", "arcs"):
        raise WallsError(f"curves is {curves!r}", code="bad-option", fix='give "lines" or "arcs"')
    if sides not in ("both", "outward"):
        raise WallsError(f"sides is {sides!r}", code="bad-option", fix='give "both" or "outward"')
    if not (math.isfinite(scale) and scale > 0):
        raise WallsError(f"scale is {scale!r}", code="bad-option", fix="give a number above 0")


def default_tolerance(strokes: Strokes) -> float:
    """0.1 % of the diagonal of the box of all end and control points, at most 0.1."""
    points = np.concatenate([strokes.starts, strokes.ends, strokes.cubics.reshape(-1, 2)])
    if not len(points):
        return 0.1
    diagonal = float(np.hypot(*(points.max(axis=0) - points.min(axis=0))))
    return min(0.1, diagonal / 1000) or 0.1


def _with_segments(paths: list[DrawnPath]) -> tuple[list[DrawnPath], list[Problem]]:
    """Take away subpaths that only move the pen; each is a path of one point and reported as such."""
    kept: list[DrawnPath] = []
    problems: list[Problem] = []
    for path in paths:
        drawn = [sub for sub in path.subpaths if len(sub.segments) > 1]
        points = (sub.segments[0] for sub in path.subpaths if len(sub.segments) == 1)
        problems.extend(_one_point(path, x, y) for _, x, y in points)
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


def _edges(strokes: Strokes, tolerance: float, curves: Curves) -> Pieces:
    return fit_arcs(strokes, tolerance) if curves == "arcs" else flatten(strokes, tolerance)


def nested(outlines: Outlines, sides: Sides, arena: bool, tolerance: float, repairs: Repairs | None) -> Walls:
    """Find out what is material, repair if asked to, nest, turn, and check."""
    plain = replace(outlines.to_walls(sides), tolerance=tolerance)
    edges = straight_edges(plain)
    contacts = find_contacts(edges)
    keep, dropped = material_rings(outlines, edges, contacts.crossing_walls)
    problems = outlines.problems + dropped
    if not keep.all():
        outlines = outlines.keep(keep)
        plain = replace(outlines.to_walls(sides), tolerance=tolerance)
        edges = straight_edges(plain)
        contacts = find_contacts(edges)
    owners = [outlines.paths[owner] for owner in outlines.owner.tolist()]
    lines = [path.line for path in owners]
    if repairs is not None:
        even_odd = [path.fill is not None and path.fill_rule == "evenodd" for path in owners]
        done = repair(plain, repairs, arena=arena, even_odd=even_odd, file_lines=lines)
        problems = problems + [change.to_problem() for change in done.changes] + done.violations
        return replace(done.walls, problems=_still_true(problems, done.walls))
    walls = oriented(plain, arena, edges, contacts)
    return replace(walls, problems=problems + validate(plain, lines=lines, edges=edges, contacts=contacts))


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
