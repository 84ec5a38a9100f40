"""What an export is told: sizes, the place of the origin, and how to say what a format cannot."""

from __future__ import annotations

import math
from dataclasses import dataclass, fields
from typing import Any

from importers.errors import WallkitError
from importers.limits import MAX_COORDINATE

Box = tuple[float, float, float, float]
Point = tuple[float, float]


class ExportError(WallkitError):
    """Walls cannot be exported as asked: an unknown format, a wrong option, a package that is missing."""


@dataclass(frozen=True, slots=True)
class ExportOptions:
    """Options of every export; a format ignores what means nothing to it.

    Attributes:
        scale: target units (px, m) per unit of the drawing; None is 1, and for engines that count in metres what
            makes the larger side of the level 20 m.
        origin: what becomes (0, 0): ``"page"`` (the corner of the page, or the drawing's own origin where no page
            is known), ``"box"`` (the corner of the box of all walls), or a point of the drawing as ``"X,Y"`` or a
            pair. The corner is the upper left one where y points down in the target, else the lower left one.
            Where the y axes differ, y is mirrored about that point; without a page about the end of the box.
        page: (x_min, y_min, x_max, y_max) of the page in the drawing, or None.
        grid: coordinates are rounded to multiples of it, in target units; 0 leaves them.
        tolerance: largest distance of lines from the arcs that they stand for, in the drawing's units; None is
            the walls' own.
        max_vertices: of a convex piece, at least 3.
        min_spacing: vertices nearer to the one before are left out, in target units; None is 0, and 0.0051 m for
            the Box2D family, which merges or refuses nearer ones.
        arena_frame: width of the material around a room, in target units, for formats of convex pieces; None is a
            tenth of the larger side.
        thickness: of open walls, in target units, for formats that know solids only; None is 0.5 % of the larger side.
    """

    scale: float | None = None
    origin: str | Point = "page"
    page: Box | None = None
    grid: float = 0.0
    tolerance: float | None = None
    max_vertices: int = 8
    min_spacing: float | None = None
    arena_frame: float | None = None
    thickness: float | None = None

    def __post_init__(self) -> None:
        for name in ("scale", "tolerance", "arena_frame", "thickness"):
            value = getattr(self, name)
            if value is not None and not (math.isfinite(value) and value > 0):
                raise _bad(name, value, "give a number above 0")
        for name in ("grid", "min_spacing"):
            value = getattr(self, name)
            if value is not None and not 0 <= value <= MAX_COORDINATE:
                raise _bad(name, value, f"give a number from 0 to {MAX_COORDINATE:g}")
        if self.max_vertices < 3:
            raise _bad("max_vertices", self.max_vertices, "give 3 or more")
        object.__setattr__(self, "origin", _origin(self.origin))

    @classmethod
    def of(cls, given: dict[str, Any]) -> ExportOptions:
        """Make options of keywords.

        Raises:
            ExportError: one is not known, or out of range.
        """
        known = [field.name for field in fields(cls)]
        unknown = [name for name in given if name not in known]
        if unknown:
            fix = f"the options are {', '.join(known)}"
            raise ExportError(f"{unknown[0]!r} is no option of an export", code="bad-option", fix=fix)
        return cls(**given)


def _origin(origin: str | Point) -> str | Point:
    if origin in ("page", "box"):
        return origin
    try:
        x, y = (float(part) for part in (origin.split(",") if isinstance(origin, str) else origin))
    except ValueError:
        x = y = math.nan
    if not (math.isfinite(x) and math.isfinite(y)):
        raise _bad("origin", origin, 'give "page", "box" or two numbers with a comma, such as 10,20')
    return x, y


def _bad(name: str, value: object, fix: str) -> ExportError:
    return ExportError(f"{name.replace('_', '-')} is {value!r}", code="bad-option", fix=fix)
