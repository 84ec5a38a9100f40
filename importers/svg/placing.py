"""Where an element's content goes: viewports of svg and symbol, and the transform of any element."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from importers.svg.matrix import IDENTITY, Matrix, multiply, translation
from importers.svg.shapes import Lengths, Shape
from importers.svg.style import Declared, Style
from importers.svg.transforms import resolve
from importers.svg.units import Font, Viewport, parse_length, to_px
from importers.svg.viewbox import fit, parse_view_box

if TYPE_CHECKING:
    from importers.svg.reader import Reader

# What an svg without any size is given by browsers.
DEFAULT_SIZE = (300.0, 150.0)


def root_viewport(root: Any, declared: Declared, font: Font) -> tuple[Matrix, Viewport] | None:
    """Give the outermost viewport: the matrix into its px and the size that percentages refer to.

    A size that is missing or a percentage is that of the viewBox, so that one user unit is one px. None when
    nothing is shown.
    """
    box = parse_view_box(root.get("viewBox"))
    size = []
    for index, name in enumerate(("width", "height")):
        given = declared.get(name)
        if given is None:
            given = parse_length(root.get(name) or "")
        natural = box[2 + index] if box else DEFAULT_SIZE[index]
        if not isinstance(given, tuple) or (box and any(unit == "%" for _, unit in given)):
            size.append(natural)
        else:
            size.append(to_px(given, natural, font))
    width, height = size
    if width <= 0 or height <= 0 or (box and (box[2] <= 0 or box[3] <= 0)):
        return None
    matrix = fit(box, root.get("preserveAspectRatio"), width, height)
    viewport = Viewport(box[2], box[3]) if box else Viewport(width, height)
    if "transform" in declared:
        matrix = multiply(_root_transform(declared, width, height, font), matrix)
    return matrix, viewport


def _root_transform(declared: Declared, width: float, height: float, font: Font) -> Matrix:
    """Give the transform of the outermost svg, moved so that the transformed viewport begins at (0, 0)."""
    value = declared["transform"]
    matrix = _functions(value, width, height, font)
    a, b, c, d, _, _ = matrix
    left = min(0.0, a * width) + min(0.0, c * height)
    top = min(0.0, b * width) + min(0.0, d * height)
    return (a, b, c, d, -left, -top)


def nested_viewport(
    element: Any, lengths: Lengths, size: tuple[float | None, float | None]
) -> tuple[Matrix, Viewport] | None:
    """Give the viewport of an inner svg or of a symbol in use; None when it shows nothing.

    Args:
        element: svg or symbol.
        lengths: of it.
        size: what the ``use`` says, None where it says nothing.
    """
    x, y = lengths.get("x") or 0.0, lengths.get("y") or 0.0
    width = size[0] if size[0] is not None else lengths.get("width")
    height = size[1] if size[1] is not None else lengths.get("height")
    width = lengths.viewport.width if width is None else width
    height = lengths.viewport.height if height is None else height
    box = parse_view_box(element.get("viewBox"))
    if width <= 0 or height <= 0 or (box and (box[2] <= 0 or box[3] <= 0)):
        return None
    matrix = multiply(translation(x, y), fit(box, element.get("preserveAspectRatio"), width, height))
    return matrix, Viewport(box[2], box[3]) if box else Viewport(width, height)


def use_size(tag: str, use: Any, lengths: Lengths) -> tuple[float | None, float | None]:
    """Give the size that a ``use`` asks for its symbol or svg."""
    return lengths.get("width"), lengths.get("height")


def element_matrix(
    reader: Reader, element: Any, declared: Declared, style: Style, viewport: Viewport, shape: Shape | None = None
) -> Matrix:
    """Give the matrix of an element's ``transform`` about its ``transform-origin``."""
    value = declared["transform"]
    box = (0.0, 0.0, viewport.width, viewport.height)
    matrix = _functions(value, box[2], box[3], style.font)
    origin = declared.get("transform-origin")
    if isinstance(origin, tuple):
        x = box[0] + to_px(origin[0], box[2], style.font)
        y = box[1] + to_px(origin[1], box[3], style.font)
        matrix = multiply(multiply(translation(x, y), matrix), translation(-x, -y))
    return matrix


def _functions(value: Any, width: float, height: float, font: Font) -> Matrix:
    if not isinstance(value, tuple) or not value:
        return IDENTITY
    if isinstance(value[0], float):
        return (value[0], value[1], value[2], value[3], value[4], value[5])
    return resolve(value, width, height, font)
