"""Regions: where anything of an element can be seen, as boxes.

A box holds at least all that is seen, so what is said to be outside of one is.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

from importers.boxes import Box, box_of
from importers.drawing import Clip, DrawnPath
from importers.svg.matrix import Matrix, multiply

EVERYWHERE: Box = (-math.inf, -math.inf, math.inf, math.inf)
NOWHERE: Box = (math.inf, math.inf, -math.inf, -math.inf)


@dataclass(frozen=True, slots=True)
class Region:
    """Where something can be seen.

    Attributes:
        box: nothing is seen outside of it.
        exact: all of it is seen; a clip that is a rectangle, and no mask.
        clip: the clips, as they are drawn.
        known: the clips are all that cuts; there is no mask, and no clip that is not understood.
    """

    box: Box = EVERYWHERE
    exact: bool = True
    clip: Clip | None = None
    known: bool = True

    def within(self, other: Region) -> Region:
        """Give the region of what is seen in both."""
        a, b = self.box, other.box
        box = (max(a[0], b[0]), max(a[1], b[1]), min(a[2], b[2]), min(a[3], b[3]))
        clip = other.clip
        for own in _inwards(self.clip):
            clip = replace(own, outer=clip)
        return Region(box, self.exact and other.exact, clip, self.known and other.known)

    def through(self, matrix: Matrix) -> Region:
        """Give the region on the page of one in coordinates that a matrix puts there."""
        clip: Clip | None = None
        for own in _inwards(self.clip):
            clip = replace(own, matrix=multiply(matrix, own.matrix), outer=clip)
        if not all(map(math.isfinite, self.box)):
            return replace(self, clip=clip)
        left, top, right, bottom = self.box
        a, b, c, d, e, f = matrix
        corners = [(a * x + c * y + e, b * x + d * y + f) for x in (left, right) for y in (top, bottom)]
        xs, ys = zip(*corners, strict=True)
        straight = (b == 0 and c == 0) or (a == 0 and d == 0)
        return Region((min(xs), min(ys), max(xs), max(ys)), self.exact and straight, clip, self.known)

    def misses(self, box: Box) -> bool:
        """Tell whether nothing of a box is seen."""
        mine = self.box
        return box[2] < mine[0] or box[0] > mine[2] or box[3] < mine[1] or box[1] > mine[3]

    def cuts(self, box: Box) -> bool:
        """Tell whether perhaps not all of a box is seen."""
        mine = self.box
        inside = mine[0] <= box[0] and mine[1] <= box[1] and box[2] <= mine[2] and box[3] <= mine[3]
        return not (self.exact and inside)


def _inwards(clip: Clip | None) -> list[Clip]:
    """List clips around each other, the outermost first."""
    found = []
    while clip is not None:
        found.append(clip)
        clip = clip.outer
    return found[::-1]


ALL = Region()
UNKNOWN = Region(exact=False, known=False)


def region_of(paths: Sequence[DrawnPath]) -> Region:
    """Give the region of a clip that is made of paths; exact where they are one upright rectangle."""
    seen = [path for path in paths if path.visible]
    box = box_of(seen)
    clip = Clip(tuple((path.subpaths, path.fill_rule) for path in seen))
    if box is None:
        return Region(NOWHERE, clip=clip)
    return Region(box, len(seen) == 1 and is_upright_rectangle(seen[0]), clip)


def reach_of(path: DrawnPath) -> Box | None:
    """Give the box of a path with what its stroke may paint: half the width, and the corners that jut out of that."""
    box = box_of([path])
    if box is None:
        return None
    reach = 2.0 * (path.stroke_width or 0.0)
    return box[0] - reach, box[1] - reach, box[2] + reach, box[3] + reach


def is_upright_rectangle(path: DrawnPath) -> bool:
    """Tell whether a path is one rectangle whose edges run along the axes."""
    if len(path.subpaths) != 1:
        return False
    segments = path.subpaths[0].segments
    points = [segment[1:] for segment in segments]
    if any(segment[0] not in "ML" for segment in segments):
        return False
    if len(points) == 5 and points[4] == points[0]:
        points.pop()
    if len(points) != 4:
        return False
    (ax, ay), (bx, by), (cx, cy), (dx, dy) = points
    first_along_y = ax == bx and by == cy and cx == dx and dy == ay
    first_along_x = ay == by and bx == cx and cy == dy and dx == ax
    return bool(first_along_x or first_along_y)
