"""Clips: paths that a clip cuts end there, where that is asked for.

A filled path becomes what of its area is seen, an outline what of its line is seen: a ring that is cut becomes open
lines. Curves of what is cut become lines first; what lies wholly inside its clips stays as it is, curves and all.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import shapely

from importers.drawing import Clip, Drawing, DrawnPath, FillRule, Segment, Shape, Subpath
from importers.limits import MAX_ELEMENTS, limit_error
from importers.problems import Problem
from importers.svg.matrix import transform
from wallkit.geometry.arrays import FloatArray
from wallkit.walls.as_shapely import even_odd
from wallkit.walls.importing.curves_to_lines import flatten
from wallkit.walls.importing.outlines import assemble
from wallkit.walls.importing.segments import gather
from wallkit.walls.repairing.areas import rings_around

_APPLIED = ("clip-not-applied", "outside-clip")
"""What readers say of clips that are not applied."""
_MOST_PAIRS = 10_000_000  # of a face and an edge, of one path: a winding number takes some ns and bytes for each


def clipped(drawing: Drawing, tolerance: float) -> Drawing:
    """Cut the paths of a drawing by their clips.

    Args:
        drawing: as read; it stays as it is.
        tolerance: how near lines are to the curves that they stand for, in the drawing's units.

    Returns:
        The drawing with the paths that are seen; what was cut, and what is left out, is one info problem.

    Raises:
        LimitError: the clips have more segments than a drawing may have, or a path crosses itself too often.
    """
    cutter = _Cutter(tolerance)
    paths: list[DrawnPath] = []
    cut: list[DrawnPath] = []
    gone = 0
    for path in drawing.paths:
        if path.clipped is None:
            paths.append(path)
            continue
        subpaths = cutter.seen(path)
        if subpaths is None:
            paths.append(replace(path, clipped=None))
            continue
        cut.append(path)
        gone += not subpaths
        if subpaths:
            error = cutter.error
            paths.append(replace(path, subpaths=subpaths, fill_rule="evenodd", clipped=None, error=error))
    problems = [problem for problem in drawing.problems if problem.code not in _APPLIED]
    if cut:
        problems.append(_told(cut, gone, tolerance))
    return replace(drawing, paths=paths, problems=problems)


def _told(cut: list[DrawnPath], gone: int, tolerance: float) -> Problem:
    many = "1 path was" if len(cut) == 1 else f"{len(cut)} paths were"
    left = f"; {gone} of them {'is' if gone == 1 else 'are'} left out: nothing is seen" if gone else ""
    message = f"{many} cut by clips, curves there as lines within {tolerance:g}{left}"
    first = cut[0]
    x, y = first.subpaths[0].segments[0][1:3]
    fix = "leave --apply-clips out to have them whole"
    return Problem("clip-applied", "info", message, fix, first.layer, first.name, first.line, None, x, y)


class _Cutter:
    """Areas of clips, each made once.

    Attributes:
        error: how far lines are at most from the curves of the path that was cut last, and of its clips.
    """

    def __init__(self, tolerance: float) -> None:
        self._tolerance = tolerance
        self._areas: dict[int, tuple[Any, float]] = {}
        self.error = 0.0
        self._segments = 0

    def seen(self, path: DrawnPath) -> list[Subpath] | None:
        """Give what of a path is seen; None where that is all of it."""
        assert path.clipped is not None
        area, of_clips = self._area(path.clipped)
        lines, closed, own = _flat(path.subpaths, self._tolerance)
        self.error = max(own, of_clips)
        filled = [line for line, ring in zip(lines, closed, strict=True) if ring and path.fill is not None]
        others = [line for line, ring in zip(lines, closed, strict=True) if not (ring and path.fill is not None)]
        ways = [shapely.LineString(line) for line in others if len(line) > 1]
        solid = _painted(filled, path.fill_rule) if filled else shapely.Polygon()
        if area.covers(solid) and all(area.covers(way) for way in ways):
            return None
        subpaths = [_closed(ring) for ring in rings_around(shapely.intersection(solid, area))]
        for way in ways:
            subpaths += [_open(way)] if area.covers(way) else [_open(part) for part in _parts(way, area)]
        return subpaths

    def _area(self, clip: Clip) -> tuple[Any, float]:
        """Give what clips leave, from the outermost in, and how near that is."""
        waiting: list[Clip] = []
        inner: Clip | None = clip
        while inner is not None and id(inner) not in self._areas:
            waiting.append(inner)
            inner = inner.outer
        area, error = (None, 0.0) if inner is None else self._areas[id(inner)]
        for one in reversed(waiting):
            covered = [self._covered(shape, one) for shape in one.shapes]
            own = shapely.union_all([shape for shape, _ in covered])
            area = own if area is None else shapely.intersection(area, own)
            error = max([error, *(near for _, near in covered)])
            shapely.prepare(area)
            self._areas[id(one)] = area, error
        return area, error

    def _covered(self, shape: Shape, clip: Clip) -> tuple[Any, float]:
        """Give the area of a shape; its open subpaths count as closed."""
        subpaths, rule = shape
        self._segments += sum(len(sub.segments) for sub in subpaths)
        if self._segments > MAX_ELEMENTS:
            raise limit_error("segments of clips, as often as they are used", f"{MAX_ELEMENTS:,}")
        placed = [Subpath(transform(sub.segments, clip.matrix), True) for sub in subpaths]
        lines, _, error = _flat(placed, self._tolerance)
        return _painted(lines, rule), error


def _flat(subpaths: Sequence[Subpath], tolerance: float) -> tuple[list[FloatArray], list[bool], float]:
    """Give each subpath as points, a closed one's with the first again at the end, and how far they are off at most."""
    drawn = [sub for sub in subpaths if len(sub.segments) > 1]
    segments = gather(drawn)
    pieces = flatten(segments, tolerance)
    outlines = assemble(segments, pieces, [DrawnPath(drawn)])
    lines = []
    for index, ring in enumerate(outlines.closed.tolist()):
        line = outlines.vertices[outlines.offsets[index] : outlines.offsets[index + 1]]
        lines.append(np.concatenate([line, line[:1]]) if ring else line)
    return lines, outlines.closed.tolist(), pieces.error


def _painted(rings: list[FloatArray], rule: FillRule) -> Any:
    """Give the area that closed rings paint by a fill rule."""
    polygons = np.array([shapely.Polygon(ring) for ring in rings if len(ring) > 3], dtype=object)
    if (len(polygons) < 2 or rule == "evenodd") and shapely.is_valid(polygons).all():
        return even_odd(polygons)
    edges = shapely.union_all(shapely.boundary(polygons))
    faces = shapely.get_parts(shapely.polygonize(shapely.get_parts(edges)))
    inside = shapely.get_coordinates(shapely.point_on_surface(faces))
    turns = _windings(rings, inside)
    return shapely.union_all(faces[turns % 2 != 0 if rule == "evenodd" else turns != 0])


def _windings(rings: list[FloatArray], points: FloatArray) -> np.ndarray:
    """How often rings turn around each point: a ray to the right meets so many more edges going up than down."""
    edges = sum(len(ring) for ring in rings)
    if edges * len(points) > _MOST_PAIRS:
        fix = "leave --apply-clips out, or simplify the path that crosses itself"
        raise limit_error("crossings of a clip or a path under one", f"{_MOST_PAIRS:,} pairs", fix=fix)
    turns = np.zeros(len(points), dtype=np.int64)
    x, y = points[:, 0, None], points[:, 1, None]
    for ring in rings:
        a, b = ring[:-1], ring[1:]
        left = (b[:, 0] - a[:, 0]) * (y - a[:, 1]) - (x - a[:, 0]) * (b[:, 1] - a[:, 1])
        turns += ((a[:, 1] <= y) & (b[:, 1] > y) & (left > 0)).sum(axis=1)
        turns -= ((a[:, 1] > y) & (b[:, 1] <= y) & (left < 0)).sum(axis=1)
    return turns


def _parts(way: Any, area: Any) -> list[Any]:
    """Give what of a line is seen; pieces that go on over the start of a ring are one."""
    seen = shapely.intersection(way, area)
    lines = [part for part in shapely.get_parts(seen) if part.geom_type == "LineString" and part.length > 0]
    return list(shapely.get_parts(shapely.line_merge(shapely.MultiLineString(lines)))) if lines else []


def _closed(ring: FloatArray) -> Subpath:
    return Subpath(_segments(ring[:-1]), True)


def _open(line: Any) -> Subpath:
    points = shapely.get_coordinates(line)
    ring = len(points) > 3 and bool((points[0] == points[-1]).all())
    return Subpath(_segments(points[:-1] if ring else points), ring)


def _segments(points: FloatArray) -> list[Segment]:
    first, *rest = points.tolist()
    return [("M", *first), *(("L", *point) for point in rest)]
