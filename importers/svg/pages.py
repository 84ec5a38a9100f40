"""Pages of an SVG: what Inkscape keeps of several, and the sheet that a drawing lies on."""

from __future__ import annotations

from typing import Any

from importers.drawing import Artboard, Box
from importers.limits import good_coordinate
from importers.svg.matrix import Matrix, transform
from importers.svg.names import INKSCAPE, SODIPODI

_PAGE = f"{{*}}namedview/{INKSCAPE}page"


def inkscape_pages(root: Any, matrix: Matrix) -> list[Artboard]:
    """List the pages of a drawing by Inkscape 1.2 or later, where it has more than one.

    Args:
        root: the svg element.
        matrix: from its user units, in which pages are written, to px.
    """
    found = [_page(element, number + 1, matrix) for number, element in enumerate(root.iterfind(_NAMED_VIEW + _PAGE))]
    return [page for page in found if page is not None] if len(found) > 1 else []


_NAMED_VIEW = ""


def _page(element: Any, number: int, matrix: Matrix) -> Artboard | None:
    try:
        x, y, width, height = (float(element.get(name)) for name in ("x", "y", "width", "height"))
    except (TypeError, ValueError):
        return None
    corners = transform([("M", x, y), ("L", x + width, y), ("L", x + width, y + height), ("L", x, y + height)], matrix)
    xs, ys = [corner[1] for corner in corners], [corner[2] for corner in corners]
    if not all(map(good_coordinate, (*xs, *ys))):
        return None
    name = element.get(INKSCAPE + "label") or f"page {number}"
    return Artboard(name, min(xs), min(ys), max(xs), max(ys))
