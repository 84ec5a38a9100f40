"""Paths of the svgpathtools library as a Drawing, for people who make or change their paths with it."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from importers.drawing import Drawing, DrawnPath, Segment, Subpath
from importers.errors import DrawingError


def drawing_from_svgpathtools(paths: Iterable[Any]) -> Drawing:
    """Take ``svgpathtools.Path`` objects as a drawing: one drawn path each, a subpath for each continuous part.

    Coordinates are taken as they are, complex numbers x + i y, in px with y down, as svgpathtools reads SVG. A part
    that ends where it began is closed. svgpathtools itself is not imported: its segments are told by their names.

    Args:
        paths: svgpathtools paths, or anything that iterates over its segments.

    Raises:
        DrawingError: these are no paths, or a segment is none of Line, QuadraticBezier, CubicBezier and Arc.
    """
    try:
        return Drawing(units="px", y_axis="down", kind="svgpathtools", paths=[_path(path) for path in paths])
    except (AttributeError, TypeError) as error:  # something to go through, or a segment, is another thing
        message, fix = f"these are no paths of svgpathtools: {error}", "give a list of svgpathtools.Path"
        raise DrawingError(message, code="not-a-drawing", fix=fix) from error


def _path(path: Iterable[Any]) -> DrawnPath:
    subpaths: list[Subpath] = []
    end: complex | None = None
    for segment in path:
        if segment.start != end:
            subpaths.append(Subpath([("M", segment.start.real, segment.start.imag)], closed=False))
        subpaths[-1].segments.append(_segment(segment))
        end = segment.end
    for subpath in subpaths:
        subpath.closed = subpath.segments[0][1:] == subpath.segments[-1][-2:]
    return DrawnPath(subpaths)


def _segment(segment: Any) -> Segment:
    kind = type(segment).__name__
    if kind == "Line":
        return ("L", *_numbers(segment.end))
    if kind == "QuadraticBezier":
        return ("Q", *_numbers(segment.control, segment.end))
    if kind == "CubicBezier":
        return ("C", *_numbers(segment.control1, segment.control2, segment.end))
    if kind == "Arc":
        marks = (float(segment.rotation), int(segment.large_arc), int(segment.sweep))
        return ("A", *_numbers(segment.radius), *marks, *_numbers(segment.end))
    raise DrawingError(
        f"a segment is a {kind}", code="not-a-drawing", fix="give paths of Line, QuadraticBezier, CubicBezier and Arc"
    )


def _numbers(*points: complex) -> list[float]:
    return [number for point in points for number in (point.real, point.imag)]
