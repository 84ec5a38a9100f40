"""Paths of the svgpathtools library, both ways, for people who make, measure or change their paths with it.

A ``svgpathtools.Path`` is a list of segments. It has no word for a pen that is lifted between two parts that touch,
for a part that ends where it began and is open all the same, and for names and paint. A path that is written here
carries these along in one attribute; :func:`drawing_from_svgpathtools` heeds it as long as it fits the segments.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace
from itertools import pairwise
from typing import Any, NamedTuple

from importers.drawing import Drawing, DrawnPath, Segment, Subpath, YAxis
from importers.errors import DrawingError
from importers.limits import MAX_COORDINATE, good_coordinate

CARRIED = "drawn_by_wallkit"
"""The attribute of a ``svgpathtools.Path`` that holds ``_Carried``."""
UNITS = ("px", "pt")


class _Part(NamedTuple):
    """A subpath among the segments of a path."""

    start: complex
    segments: int
    """So many; 0 where the pen only moved."""
    closed: bool
    closing: bool
    """The last one is the closing edge, which a Subpath does not repeat."""


class _Carried(NamedTuple):
    """What the segments of a path do not say."""

    path: DrawnPath
    """Its name, layer and paint; without its subpaths."""
    parts: tuple[_Part, ...]


def drawing_from_svgpathtools(paths: Iterable[Any], *, units: str = "px", y_axis: YAxis = "down") -> Drawing:
    """Take ``svgpathtools.Path`` objects as a drawing: one drawn path each, a subpath for each continuous part.

    Coordinates are taken as they are, complex numbers x + i y. A part that ends where it began is closed. Paths that
    ``Drawing.to_svgpathtools`` made come back as they were, bit for bit, names and paint included, unless their
    segments were changed so much that these are other parts. svgpathtools itself is not imported: its segments are
    told by their names.

    Args:
        paths: svgpathtools paths, or anything that iterates over its segments.
        units: of the coordinates, ``"px"``, as svgpathtools reads SVG, or ``"pt"``.
        y_axis: where theirs points.

    Raises:
        DrawingError: it is no list of paths, a segment is none of Line, QuadraticBezier, CubicBezier and Arc, a
            number is not finite or beyond 1e9, or a word is none of these.
    """
    for name, word, words in (("units", units, UNITS), ("y_axis", y_axis, ("down", "up"))):
        if word not in words:
            fix = f"one of: {', '.join(words)}"
            raise DrawingError(f"{name} is {word!r}", code="bad-option", fix=fix)
    drawn = []
    for index, path in enumerate(_items(paths, "a list of paths")):
        try:
            drawn.append(_path(_items(path, "a path, which is a list of segments")))
        except (AttributeError, TypeError, ValueError, OverflowError) as error:
            raise _refused(f"path {index} cannot be read: {error}") from None
    return Drawing(units=units, y_axis=y_axis, kind="svgpathtools", paths=drawn)


def svgpathtools_paths(paths: Sequence[DrawnPath]) -> list[Any]:
    """Make a ``svgpathtools.Path`` of each drawn path, every number as it is; see :class:`importers.drawing.Drawing`.

    A closed subpath gets its closing edge, where it has a length. An arc whose ends are equal draws nothing and is a
    Line, for svgpathtools cannot hold it.
    """
    import svgpathtools  # late: it brings scipy

    result = []
    for path in paths:
        segments: list[Any] = []
        parts = []
        for subpath in path.subpaths:
            count = len(segments)
            start = end = complex(*subpath.segments[0][1:])
            for segment in subpath.segments[1:]:
                segments.append(_made(svgpathtools, end, segment))
                end = segments[-1].end
            closing = subpath.closed and end != start
            if closing:
                segments.append(svgpathtools.Line(end, start))
            parts.append(_Part(start, len(segments) - count, subpath.closed, closing))
        made = svgpathtools.Path(*segments)
        setattr(made, CARRIED, _Carried(replace(path, subpaths=[]), tuple(parts)))
        result.append(made)
    return result


def _made(svgpathtools: Any, start: complex, segment: Segment) -> Any:
    kind, numbers = segment[0], segment[1:]
    end = complex(*numbers[-2:])
    if kind == "Q":
        return svgpathtools.QuadraticBezier(start, complex(*numbers[:2]), end)
    if kind == "C":
        return svgpathtools.CubicBezier(start, complex(*numbers[:2]), complex(*numbers[2:4]), end)
    if kind == "A" and start != end:
        rx, ry, rotation, large, sweep = numbers[:5]
        arc = svgpathtools.Arc(start, complex(rx, ry), rotation, bool(large), bool(sweep), end)
        arc.radius = complex(rx, ry)  # it makes radii larger that rounding left too short to reach
        return arc
    return svgpathtools.Line(start, end)


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
    segments = list(path)
    carried: _Carried | None = getattr(path, CARRIED, None)
    if carried is not None and _fits(carried.parts, segments):
        return replace(carried.path, subpaths=_parted(carried.parts, segments))
    subpaths: list[Subpath] = []
    end: complex | None = None
    for segment in segments:
        if segment.start != end:
            subpaths.append(Subpath([("M", *_numbers(segment.start))], closed=False))
        subpaths[-1].segments.append(_segment(segment))
        end = segment.end
    for subpath in subpaths:
        subpath.closed = subpath.segments[0][1:] == subpath.segments[-1][-2:]
    return DrawnPath(subpaths)


def _fits(parts: Sequence[_Part], segments: Sequence[Any]) -> bool:
    """Tell whether segments still are the parts that they were: each without a jump, and closed where it was."""
    if sum(part.segments for part in parts) != len(segments):
        return False
    first = 0
    for part in parts:
        own = segments[first : first + part.segments]
        first += part.segments
        if any(before.end != after.start for before, after in pairwise(own)):
            return False
        if part.closing and not (type(own[-1]).__name__ == "Line" and own[-1].end == own[0].start):
            return False
    return True


def _parted(parts: Sequence[_Part], segments: Sequence[Any]) -> list[Subpath]:
    subpaths, first = [], 0
    for part in parts:
        drawn = segments[first : first + part.segments - part.closing]
        start: Segment = ("M", *_numbers(segments[first].start if part.segments else part.start))
        subpaths.append(Subpath([start, *map(_segment, drawn)], closed=part.closed))
        first += part.segments
    return subpaths


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
