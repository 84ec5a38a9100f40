"""Paths of the svgpathtools library as a Drawing, for people who make or change their paths with it."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from importers.drawing import Drawing, DrawnPath, Segment, Subpath
from importers.errors import DrawingError
from importers.limits import MAX_COORDINATE, good_coordinate


def drawing_from_svgpathtools(paths: Iterable[Any]) -> Drawing:
    """Take ``svgpathtools.Path`` objects as a drawing: one drawn path each, a subpath for each continuous part.

    Coordinates are taken as they are, complex numbers x + i y, in px with y down, as svgpathtools reads SVG. A part
    that ends where it began is closed. svgpathtools itself is not imported: its segments are told by their names.

    Args:
        paths: svgpathtools paths, or anything that iterates over its segments.

    Raises:
        DrawingError: it is no list of paths, a segment is none of Line, QuadraticBezier, CubicBezier and Arc, or a
            number is not finite or beyond 1e9.
    """
    drawn = []
    for index, path in enumerate(_items(paths, "a list of paths")):
        try:
            drawn.append(_path(_items(path, "a path, which is a list of segments")))
        except (AttributeError, TypeError, ValueError, OverflowError) as error:
            raise _refused(f"path {index} cannot be read: {error}") from None
    return Drawing(units="px", y_axis="down", kind="svgpathtools", paths=drawn)


def _items(whole: Any, what: str) -> Iterable[Any]:
    if isinstance(whole, str | bytes | dict) or not isinstance(whole, Iterable):
        raise _refused(f"a {type(whole).__name__} is not {what}")
    return whole


def _refused(message: str) -> DrawingError:
    fix = "give a list of svgpathtools.Path, each of Line, QuadraticBezier, CubicBezier and Arc"
    return DrawingError(message, code="not-a-drawing", fix=fix)


def _path(path: Iterable[Any]) -> DrawnPath:
    """Take one path.

    Raises:
        DrawingError: a segment is not known, or a number of it is not good.
        AttributeError: a segment has not the points that its kind has; a TypeError or ValueError: they are none.
    """
    subpaths: list[Subpath] = []
    end: complex | None = None
    for segment in path:
        if segment.start != end:
            subpaths.append(Subpath([("M", *_numbers(segment.start))], closed=False))
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
        rx, ry = map(abs, _numbers(segment.radius))
        rotation, _ = _numbers(complex(segment.rotation))
        if rx == 0 or ry == 0:
            return ("L", *_numbers(segment.end))
        return ("A", rx, ry, rotation, int(segment.large_arc), int(segment.sweep), *_numbers(segment.end))
    hint = ", not a segment; svg2paths gives (paths, attributes), of which this takes the first"
    raise _refused(f"a segment is a {kind}{hint if kind in ('Path', 'dict') else ''}")


def _numbers(*points: complex) -> list[float]:
    numbers = [float(number) for point in points for number in (point.real, point.imag)]
    if not all(map(good_coordinate, numbers)):
        raise _refused(f"a segment has the numbers {numbers}, which are not all finite and at most {MAX_COORDINATE:g}")
    return numbers
