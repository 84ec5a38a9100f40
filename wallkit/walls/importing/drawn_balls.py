"""Balls drawn in a drawing: circles, and lines from their centres as velocities."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from importers.drawing import Drawing, DrawnPath, Segment
from importers.problems import Problem
from wallkit.geometry.arrays import FloatArray
from wallkit.geometry.path_segments import chords
from wallkit.walls.roles import role_of

# A circle of four cubics, as drawing programs write it, is off by 2.7e-4 of its radius; hand-made ones by more.
_ROUND = 0.02
_MARKER = 2.0  # radii of the ball: a ball that has less than its own radius of play goes nowhere
_CENTRED = 0.25  # radii of the ball


class DrawnBall(NamedTuple):
    """A circle whose role is a ball; ``velocity`` is None where no line starts in it."""

    x: float
    y: float
    radius: float
    velocity: tuple[float, float] | None


def drawn_balls(drawing: Drawing, scale: float = 1.0, flip_y: bool = False) -> tuple[list[DrawnBall], list[Problem]]:
    """Read what is drawn as balls (roles.py): a circle is one, a line that starts in it is its velocity per second.

    Args:
        drawing: as read; hidden paths and guides do not count.
        scale: as for the walls: places, radii and velocities are multiplied by it.
        flip_y: as for the walls: y changes its sign.

    Returns:
        The balls in the file's order, and a problem for each path there that is neither.
    """
    fx, fy = scale, -scale if flip_y else scale
    circles: list[tuple[float, float, float]] = []
    lines: list[tuple[DrawnPath, tuple[float, float], tuple[float, float]]] = []
    problems: list[Problem] = []
    for path in drawing.paths:
        if role_of(path) != "ball" or not path.visible or path.guide or path.clip:
            continue
        for sub in path.subpaths:
            points = points_along(sub.segments) * (fx, fy)
            circle = circle_of(points)
            if circle:
                circles.append(circle)
            elif not sub.closed and len(sub) > 1:
                lines.append((path, tuple(points[0]), tuple(points[-1])))
            else:
                problems.append(_stray(path, points[0]))
    velocities: dict[int, tuple[float, float]] = {}
    for path, start, end in lines:
        owner = _owner(circles, start)
        if owner is None:
            problems.append(_stray(path, np.array(start)))
        else:
            velocities[owner] = end[0] - circles[owner][0], end[1] - circles[owner][1]
    return [DrawnBall(*circle, velocities.get(index)) for index, circle in enumerate(circles)], problems


def _stray(path: DrawnPath, place: FloatArray) -> Problem:
    return Problem(
        code="not-a-ball",
        severity="warning",
        message="a path among the balls is neither a circle nor a line that starts in one; left out",
        fix="draw circles for balls and a line from a circle's centre for its velocity per second",
        layer=path.layer,
        name=path.name,
        line=path.line,
        x=float(place[0]),
        y=float(place[1]),
    )


def _owner(circles: list[tuple[float, float, float]], start: tuple[float, float]) -> int | None:
    """Give the circle that a point is in, the one with the nearest centre where there are several."""
    distances = [math.hypot(start[0] - x, start[1] - y) for x, y, _ in circles]
    inside = [index for index, (_, _, radius) in enumerate(circles) if distances[index] <= radius]
    return min(inside, key=distances.__getitem__, default=None)


def circle_of(points: FloatArray) -> tuple[float, float, float] | None:
    """Give centre and radius where the points of a path lie around one centre, all sides of it."""
    if len(points) < 9:  # a curve has more; a square would pass otherwise
        return None
    low, high = points.min(axis=0), points.max(axis=0)
    centre, radius = (low + high) / 2, float((high - low).mean()) / 2
    away = np.hypot(*(points - centre).T)
    if radius == 0 or np.abs(away - radius).max() > _ROUND * radius:
        return None
    return float(centre[0]), float(centre[1]), radius


def points_along(segments: list[Segment]) -> FloatArray:
    """Give points along a subpath."""
    parts = [np.array([segments[0][1:3]], dtype=np.float64)]
    for segment in segments[1:]:
        parts.append(chords(parts[-1][-1], segment[0], segment[1:]))
    return np.concatenate(parts)


def marks_a_ball(path: DrawnPath, balls: list[DrawnBall]) -> bool:
    """Tell whether a path only marks where a ball is: a circle around its centre, at most twice as large.

    Args:
        path: a drawn path.
        balls: as :func:`drawn_balls` gives them, unscaled.
    """
    if len(path.subpaths) != 1 or not path.subpaths[0].closed or len(path.subpaths[0]) < 3:
        return False
    x, y = path.subpaths[0].start
    near = [ball for ball in balls if math.hypot(x - ball.x, y - ball.y) <= (_MARKER + 2 * _CENTRED) * ball.radius]
    circle = circle_of(points_along(path.subpaths[0].segments)) if near else None
    return circle is not None and any(
        math.hypot(circle[0] - ball.x, circle[1] - ball.y) <= _CENTRED * ball.radius
        and circle[2] <= _MARKER * ball.radius
        for ball in near
    )
