"""Where an element's content goes: viewports of svg and symbol, and the transform of any element."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

from importers.boxes import Box
from importers.regions import Region
from importers.svg.inheritance import Style
from importers.svg.matrix import IDENTITY, Matrix, multiply, translation
from importers.svg.shapes import Lengths
from importers.svg.style import Declared
from importers.svg.transforms import resolve
from importers.svg.units import Font, Viewport, parse_length, to_px
from importers.svg.viewbox import fit, parse_view_box

# In the order in which they apply, outermost first.
_PROPERTIES = ("translate", "rotate", "scale", "transform")
# What an svg without any size is given by browsers.
DEFAULT_SIZE = (300.0, 150.0)


class Outermost(NamedTuple):
    """The outermost viewport.

    Attributes:
        matrix: from user units to its px.
        viewport: what percentages refer to.
        page: the box of the picture in px; None where browsers show nothing, for want of a size.
    """

    matrix: Matrix
    viewport: Viewport
    page: Box | None


def root_viewport(root: Any, declared: Declared, font: Font) -> Outermost:
    """Give the outermost viewport.

    A size that is missing or a percentage is that of the viewBox: one user unit is one px. Without any size the
    matrix is that of the user units.

    Raises:
        NumberError: a size is too large.
    """
    box = parse_view_box(root.get("viewBox"))
    width, height = root_size(root, declared, font)
    shown = width > 0 and height > 0 and not (box and (box[2] <= 0 or box[3] <= 0))
    matrix = fit(box, root.get("preserveAspectRatio"), width, height) if shown else IDENTITY
    viewport = Viewport(box[2], box[3]) if box and shown else Viewport(width, height)
    page = Region((0.0, 0.0, width, height))
    if has_transform(declared):
        turned = _root_transform(declared, width, height, font)
        matrix, page = multiply(turned, matrix), page.through(turned)
    return Outermost(matrix, viewport, page.box if shown else None)


def root_size(root: Any, declared: Declared, font: Font) -> tuple[float, float]:
    """Give width and height of the outermost viewport in px."""
    box = parse_view_box(root.get("viewBox"))
    natural = (box[2], box[3]) if box else DEFAULT_SIZE
    width, height = (
        _root_length(root.get(name), declared.get(name), natural[index], box is not None, font)
        for index, name in enumerate(("width", "height"))
    )
    return width, height


def _root_length(text: str | None, declared: Any, natural: float, boxed: bool, font: Font) -> float:
    if isinstance(declared, tuple):
        return to_px(declared, natural, font)
    terms = parse_length(text) if text is not None else None
    if terms is None or (boxed and any(unit == "%" for _, unit in terms)):
        return natural
    return max(0.0, to_px(terms, natural, font))


def _root_transform(declared: Declared, width: float, height: float, font: Font) -> Matrix:
    """Give the transform of the outermost svg, moved so that the transformed viewport begins at (0, 0)."""
    a, b, c, d, _, _ = _whole_transform(declared, width, height, font)
    left = min(0.0, a * width) + min(0.0, c * height)
    top = min(0.0, b * width) + min(0.0, d * height)
    return (a, b, c, d, -left, -top)


def nested_viewport(
    element: Any, lengths: Lengths, size: tuple[float | None, float | None]
) -> tuple[Matrix, Viewport, Box] | None:
    """Give the viewport of an inner svg or of a symbol in use, and its box around it; None when it shows nothing.

    Args:
        element: svg or symbol.
        lengths: of it.
        size: what the ``use`` says, None where it says nothing.
    """
    x, y = lengths.get("x") or 0.0, lengths.get("y") or 0.0
    width = size[0] if size[0] is not None else lengths.size("width")
    height = size[1] if size[1] is not None else lengths.size("height")
    width = lengths.viewport.width if width is None else width
    height = lengths.viewport.height if height is None else height
    box = parse_view_box(element.get("viewBox"))
    if width <= 0 or height <= 0 or (box and (box[2] <= 0 or box[3] <= 0)):
        return None
    matrix = multiply(translation(x, y), fit(box, element.get("preserveAspectRatio"), width, height))
    return matrix, Viewport(box[2], box[3]) if box else Viewport(width, height), (x, y, x + width, y + height)


def use_size(tag: str, lengths: Lengths) -> tuple[float | None, float | None]:
    """Give the size that a ``use`` asks for its symbol or svg; a symbol without one fills the viewport."""
    width, height = (_asked(lengths, name) for name in ("width", "height"))
    if tag == "symbol":
        width = lengths.viewport.width if width is None else width
        height = lengths.viewport.height if height is None else height
    return width, height


def _asked(lengths: Lengths, name: str) -> float | None:
    """Give a size of a ``use``: what is there but no length counts as 0."""
    size = lengths.size(name)
    written = lengths.attributes.get(name, "auto").strip() != "auto"
    return 0.0 if size is None and written else size


def has_transform(declared: Declared) -> bool:
    """Tell whether any of the four properties that transform is declared."""
    return any(name in declared for name in _PROPERTIES)


def element_matrix(declared: Declared, style: Style, viewport: Viewport, own_box: Callable[[], Box | None]) -> Matrix:
    """Give the matrix of an element's transform properties about its ``transform-origin``.

    Args:
        declared: of the element, one of the transform properties among them.
        style: of the element.
        viewport: the nearest, for percentages.
        own_box: gives the box of what the element draws, in its own coordinates; called where it is needed.
    """
    which = declared.get("transform-box", "view-box")
    box: Box | None = None
    if which in ("fill-box", "stroke-box", "content-box", "border-box"):
        box = own_box() or (0.0, 0.0, 0.0, 0.0)
        if which in ("stroke-box", "border-box") and style.stroke is not None:
            half = to_px(style.stroke_width, viewport.diagonal, style.font) / 2
            box = (box[0] - half, box[1] - half, box[2] + half, box[3] + half)
    left, top, right, bottom = box if box is not None else (0.0, 0.0, viewport.width, viewport.height)
    width, height = right - left, bottom - top
    matrix = _whole_transform(declared, width, height, style.font)
    origin = declared.get("transform-origin")
    if isinstance(origin, tuple):
        left += to_px(origin[0], width, style.font)
        top += to_px(origin[1], height, style.font)
    if left == 0.0 and top == 0.0:
        return matrix
    return multiply(multiply(translation(left, top), matrix), translation(-left, -top))


def _whole_transform(declared: Declared, width: float, height: float, font: Font) -> Matrix:
    matrix = IDENTITY
    for name in _PROPERTIES:
        value = declared.get(name)
        if not isinstance(value, tuple) or not value:
            continue
        written = isinstance(value[0], float)  # by the attribute, which is a matrix already
        matrix = multiply(matrix, value if written else resolve(value, width, height, font))
    return matrix
