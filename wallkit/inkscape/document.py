"""The document that is open in Inkscape: what wallkit reads of it, and layers of wallkit's own in it."""

from __future__ import annotations

from copy import deepcopy
from typing import Any

from lxml import etree

from importers.svg import read_tree
from importers.svg.matrix import Matrix, multiply
from wallkit.view.canvas import Bitmap, Canvas, Disc, Item, Label, Shape, path_data, printable
from wallkit.view.frame import Frame
from wallkit.view.theme import STYLES, colour, ramp

_ID = "wallkit-layer-"
_SVG = "{http://www.w3.org/2000/svg}"
_INKSCAPE = "{http://www.inkscape.org/namespaces/inkscape}"
_SODIPODI = "{http://sodipodi.sourceforge.net/DTD/sodipodi-0.dtd}"


class Document:
    """An SVG document.

    Attributes:
        data: its bytes without wallkit's layers: what wallkit reads.
    """

    def __init__(self, data: bytes) -> None:
        """Parse it.

        Raises:
            DrawingError, LimitError: it is no SVG, or larger than wallkit reads.
        """
        self.root, self.matrix = read_tree(data)
        bare = deepcopy(self.root.getroottree())
        for layer in bare.xpath(f"//*[starts-with(@id, '{_ID}')]"):
            layer.getparent().remove(layer)
        self.data: bytes = etree.tostring(bare, xml_declaration=True, encoding="UTF-8")

    def to_bytes(self) -> bytes:
        """Write the document."""
        data: bytes = etree.tostring(self.root.getroottree(), xml_declaration=True, encoding="UTF-8")
        return data

    def put_layer(self, name: str, canvas: Canvas, frame: Frame) -> None:
        """Put a canvas, drawn in a frame over the drawing's px, on a layer of its own, in front of all.

        One of the same name goes. The layer is locked, so that nobody moves a mark by accident, and says
        ``data-ignore``: it makes no walls.
        """
        for old in self.root.xpath(f"//*[@id='{_ID}{name}']"):
            old.getparent().remove(old)
        words = {"id": f"{_ID}{name}", "data-ignore": ""}
        spaces = {"inkscape": _INKSCAPE[1:-1], "sodipodi": _SODIPODI[1:-1]}
        layer = etree.SubElement(self.root, f"{_SVG}g", words, spaces)
        layer.set(f"{_INKSCAPE}groupmode", "layer")
        layer.set(f"{_INKSCAPE}label", f"wallkit {name}")
        layer.set(f"{_SODIPODI}insensitive", "true")
        layer.set("transform", f"matrix({','.join(map(repr, _to_user_units(self.matrix, frame)))})")
        for item in canvas.items:
            if not isinstance(item, Bitmap):
                layer.append(_element(item))


def _to_user_units(matrix: Matrix, frame: Frame) -> Matrix:
    """From pixels of the frame to user units of the document: the frame's way back, then that of the root.

    The frame is x' = left + s (x - x0), y' = top + s (y - y0), so x = x0 + (x' - left) / s and y alike.
    """
    s = 1.0 / frame.scale
    back = (s, 0.0, 0.0, s, frame.box[0] - s * frame.left, frame.box[1] - s * frame.top)
    a, b, c, d, e, f = matrix
    area = a * d - b * c or 1.0  # a matrix without an inverse shows nothing, wherever the layer is
    inverse = (d / area, -b / area, -c / area, a / area, (c * f - d * e) / area, (b * e - a * f) / area)
    return multiply(inverse, back)


def _element(item: Item) -> Any:
    """Give an item as an element with its style, as Inkscape keeps it: in style attributes, not in a sheet."""
    if isinstance(item, Label):
        words = {"x": f"{item.x:.2f}", "y": f"{item.y:.2f}", "style": _text_style(item)}
        element = etree.Element(f"{_SVG}text", words)
        element.text = printable(item.text)
        return element
    if isinstance(item, Disc):
        place = {"cx": f"{item.x:.2f}", "cy": f"{item.y:.2f}", "r": f"{item.radius:.2f}"}
        element = etree.Element(f"{_SVG}circle", place | {"style": _style(item.style, item.step, item.filled, item)})
    else:
        assert isinstance(item, Shape)
        data = {"d": path_data(item.commands), "style": _style(item.style, item.step, False, item)}
        element = etree.Element(f"{_SVG}path", data)
    if item.title:
        etree.SubElement(element, f"{_SVG}title").text = printable(item.title)
    return element


def _style(name: str, step: int | None, filled: bool, item: Shape | Disc) -> str:
    style = STYLES[name]
    hue = None if step is None else ramp(step, "light")
    stroke = hue or (colour(style.stroke, "light") if style.stroke else "none")
    fill = hue if filled and hue else colour(style.fill, "light") if style.fill else "none"
    dash = f";stroke-dasharray:{style.dash[0]:g},{style.dash[1]:g}" if style.dash else ""
    round_ = ";stroke-linecap:round;stroke-linejoin:round"
    return f"fill:{fill};stroke:{stroke};stroke-width:{style.width:g}{round_}{dash};opacity:{item.opacity:g}"


def _text_style(label: Label) -> str:
    fill = colour(STYLES[label.style].fill or "ink", "light")
    weight = "bold" if label.bold else "normal"
    return (
        f"font-family:sans-serif;font-size:{label.size:g}px;font-weight:{weight};text-anchor:{label.anchor};fill:{fill}"
    )
