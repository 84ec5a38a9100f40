"""Pages of an SVG: the sheet that it lies on, and those that Inkscape keeps of several."""

from __future__ import annotations

from typing import Any

from importers.boxes import Box
from importers.drawing import Artboard
from importers.limits import good_coordinate
from importers.svg.matrix import Matrix, transform
from importers.svg.names import INKSCAPE, SODIPODI


def pages_of(root: Any, matrix: Matrix) -> list[Artboard]:
    """List the pages that Inkscape (1.2 and later) keeps in a drawing; none where it keeps a single one.

    Args:
        root: the svg element.
        matrix: from its user units, in which pages are written, to px.
    """
    found = [
        page for view in root.iterchildren(SODIPODI + "namedview") for page in view.iterchildren(INKSCAPE + "page")
    ]
    named = [(page.get(INKSCAPE + "label") or f"page {index + 1}", page) for index, page in enumerate(found)]
    pages = [_page(name, page, matrix) for name, page in named]
    return [page for page in pages if page is not None] if len(found) > 1 else []


def sheet_of(root: Any, viewport: Box | None) -> Artboard | None:
    """Give the sheet in px: the box of the outermost viewport; None where the file says no size, or none above 0."""
    said = any(root.get(name) is not None for name in ("viewBox", "width", "height"))
    return Artboard("page", *viewport) if said and viewport is not None else None


def _page(name: str, element: Any, matrix: Matrix) -> Artboard | None:
    try:
        x, y, width, height = (float(element.get(key)) for key in ("x", "y", "width", "height"))
    except (TypeError, ValueError):
        return None
    return _rectangle(name, x, y, width, height, matrix)


def _rectangle(name: str, x: float, y: float, width: float, height: float, matrix: Matrix) -> Artboard | None:
    corners = [("M", x, y), ("L", x + width, y), ("L", x + width, y + height), ("L", x, y + height)]
    _, xs, ys = zip(*transform(list(corners), matrix), strict=True)
    return Artboard(name, min(xs), min(ys), max(xs), max(ys)) if all(map(good_coordinate, (*xs, *ys))) else None
