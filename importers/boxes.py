"""Boxes of segments: the smallest rectangle around curves and arcs themselves, not around control points."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterable, Sequence

from importers.drawing import DrawnPath, Segment

Box = tuple[float, float, float, float]  # x_min, y_min, x_max, y_max


def box_of(paths: Iterable[DrawnPath]) -> Box | None:
    """Give the box of all paths; None when they have no point."""
    return box_of_segments(segment for path in paths for sub in path.subpaths for segment in sub.segments)


def box_of_segments(segments: Iterable[Segment]) -> Box | None:
    """Give the box of segments in drawing order; None without any.

    A curve reaches beyond its ends where its derivative is 0 in x or y; those parameters are the roots of a
    line (quadratic) or of a parabola (cubic), and closed for an arc.
    """
    xs: list[float] = []
    ys: list[float] = []
    x0 = y0 = 0.0
    for segment in segments:
        x, y = segment[-2], segment[-1]
        xs.append(x)
        ys.append(y)
        kind = segment[0]
        if kind in ("C", "Q"):
            xs += _extrema((x0, *segment[1::2]))
            ys += _extrema((y0, *segment[2::2]))
        elif kind == "A":
            extra = _arc_extrema(x0, y0, segment)
            xs += [point[0] for point in extra]
            ys += [point[1] for point in extra]
        x0, y0 = x, y
    return (min(xs), min(ys), max(xs), max(ys)) if xs else None


def _extrema(p: Sequence[float]) -> list[float]:
    """Give the values of a Bezier curve in one coordinate where its derivative is 0 inside."""
    if len(p) == 3:
        slope = p[0] - 2 * p[1] + p[2]
        roots = [(p[0] - p[1]) / slope] if slope else []
    else:
        a = -p[0] + 3 * p[1] - 3 * p[2] + p[3]
        b = 2 * (p[0] - 2 * p[1] + p[2])
        c = p[1] - p[0]
        under = b * b - 4 * a * c
        # q keeps its digits where b is far larger than a, which is where the parabola is nearly a line
        q = -(b + math.copysign(math.sqrt(under), b)) / 2 if under >= 0 else 0.0
        roots = ([q / a] if a else []) + ([c / q] if q else [])
    return [_bezier(p, t) for t in roots if 0 < t < 1]


def _bezier(p: Sequence[float], t: float) -> float:
    points = list(p)
    while len(points) > 1:
        points = [a + (b - a) * t for a, b in itertools.pairwise(points)]
    return points[0]


def _arc_extrema(x0: float, y0: float, segment: Segment) -> list[tuple[float, float]]:
    """Give the points of an arc where it runs along an axis, as far as they are within it.

    With the ellipse as centre + u cos t + v sin t, x is extreme at tan t = v_x / u_x and half a turn on.
    """
    _, rx, ry, degrees, large, sweep, x, y = segment
    cosine, sine = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    dx, dy = (x0 - x) / 2, (y0 - y) / 2
    px, py = (cosine * dx + sine * dy) / rx, (cosine * dy - sine * dx) / ry
    half = math.hypot(px, py)
    if half == 0.0:
        return []
    depth = math.sqrt(max(0.0, 1.0 - half * half)) / half * (-1.0 if large == sweep else 1.0)
    qx, qy = depth * py, -depth * px  # the centre, in the unit circle, from the middle of the chord
    first = math.atan2(py - qy, px - qx)
    turn = math.atan2(-py - qy, -px - qx) - first
    turn = turn % math.tau if sweep else -(-turn % math.tau)
    ux, uy, vx, vy = rx * cosine, rx * sine, -ry * sine, ry * cosine
    centre_x = (x0 + x) / 2 + ux * qx + vx * qy
    centre_y = (y0 + y) / 2 + uy * qx + vy * qy
    points = []
    for t in (math.atan2(vx, ux), math.atan2(vx, ux) + math.pi, math.atan2(vy, uy), math.atan2(vy, uy) + math.pi):
        along = (t - first) % math.tau if sweep else (first - t) % math.tau
        if along < abs(turn):
            points.append(
                (centre_x + ux * math.cos(t) + vx * math.sin(t), centre_y + uy * math.cos(t) + vy * math.sin(t))
            )
    return points
