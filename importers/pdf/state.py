"""What a PDF page has said so far: where its units lie, with which paint it draws."""

from __future__ import annotations

import math
from dataclasses import dataclass

from importers.limits import MAX_COORDINATE
from importers.regions import ALL, Region
from importers.subpaths import Matrix as Matrix

IDENTITY: Matrix = (1.0, 0.0, 0.0, 1.0, 0.0, 0.0)


def multiply(first: Matrix, then: Matrix) -> Matrix:
    """Give the matrix that applies `first`, then `then` (x' = a x + c y + e, y' = b x + d y + f)."""
    a, b, c, d, e, f = first
    a2, b2, c2, d2, e2, f2 = then
    return (
        a * a2 + b * c2,
        a * b2 + b * d2,
        c * a2 + d * c2,
        c * b2 + d * d2,
        e * a2 + f * c2 + e2,
        e * b2 + f * d2 + f2,
    )


@dataclass(frozen=True, slots=True)
class Graphics:
    """The part of the state that ``q`` keeps and ``Q`` brings back; replaced, never changed.

    Attributes:
        matrix: from the units of the content to those of the page.
        fill: colour of fills.
        stroke: colour of strokes.
        width: line width in the units of the content.
        fill_space: kind of the fill's colour space when it is none of the plain ones.
        stroke_space: the same for the stroke.
        fill_alpha: opacity of fills; 0 paints nothing.
        stroke_alpha: the same for strokes.
        unseen: a group around it is drawn with opacity 0.
        fill_tiled: fills are made of tiles.
        stroke_tiled: the same for strokes.
        region: what clips leave.
        masked: a soft mask is in force, or there are too many clips in each other to follow.
        clips: so many clips are in each other.
    """

    matrix: Matrix = IDENTITY
    fill: str = "#000000"
    stroke: str = "#000000"
    width: float = 1.0
    fill_space: str = ""
    stroke_space: str = ""
    fill_alpha: float = 1.0
    stroke_alpha: float = 1.0
    unseen: bool = False
    fill_tiled: bool = False
    stroke_tiled: bool = False
    region: Region = ALL
    masked: bool = False
    clips: int = 0

    @property
    def fill_seen(self) -> bool:
        """Tell whether a fill leaves anything on the page."""
        return self.fill_alpha > 0.0 and not self.unseen

    @property
    def stroke_seen(self) -> bool:
        """Tell whether a stroke leaves anything on the page."""
        return self.stroke_alpha > 0.0 and not self.unseen

    def width_on_page(self) -> float:
        """Give the line width in the page's units: times the geometric mean of the matrix's two scales, in bounds."""
        a, b, c, d, _, _ = self.matrix
        width = self.width * math.sqrt(abs(a * d - b * c))
        return width if width <= MAX_COORDINATE else MAX_COORDINATE
