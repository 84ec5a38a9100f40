"""Drawings made by hand for the tests of walls."""

from __future__ import annotations

import math

from importers.drawing import Drawing, DrawnPath, Subpath


def path(*subpaths, **marks):
    """A drawn path of subpaths given as (segments, closed)."""
    return DrawnPath([Subpath(list(segments), closed) for segments, closed in subpaths], **marks)


def drawing(*paths, **kwargs):
    return Drawing(kwargs.pop("units", "pt"), kwargs.pop("y_axis", "up"), paths=list(paths), **kwargs)


def polygon(*points):
    """A closed subpath through points."""
    return [("M", *points[0]), *(("L", *point) for point in points[1:])], True


def line(*points):
    return polygon(*points)[0], False


def square(x, y, size, clockwise=False):
    corners = [(x, y), (x + size, y), (x + size, y + size), (x, y + size)]
    return polygon(*(reversed(corners) if clockwise else corners))


def circle(x, y, r):
    """As the SVG reader gives it: two half turns."""
    return [("M", x + r, y), ("A", r, r, 0, 0, 1, x - r, y), ("A", r, r, 0, 0, 1, x + r, y)], True


def four_cubics(x, y, r):
    k = 4 / 3 * (math.sqrt(2) - 1) * r
    return [
        ("M", x + r, y),
        ("C", x + r, y + k, x + k, y + r, x, y + r),
        ("C", x - k, y + r, x - r, y + k, x - r, y),
        ("C", x - r, y - k, x - k, y - r, x, y - r),
        ("C", x + k, y - r, x + r, y - k, x + r, y),
    ], True


def codes(walls):
    return [problem.code for problem in walls.problems]
