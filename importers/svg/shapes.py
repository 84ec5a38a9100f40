"""Basic shapes to segments in their own coordinates, with the quirks that browsers share."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

from importers.boxes import Box, box_of_segments
from importers.drawing import Segment, Subpath
from importers.limits import LETTERS_OF_A_STEP, Work
from importers.numbers import NumberError
from importers.svg.arcs import full_ellipse
from importers.svg.path_data import COMMA, NUMBER, Fault, check_length, parse_path_data
from importers.svg.plain_paths import PlainPaths
from importers.svg.style import INITIAL, Declared, Pending, TooLarge, parse_declaration
from importers.svg.units import Font, Terms, Viewport, needs_metrics, needs_window, parse_length, to_px

_STEPS_OF_A_SHAPE = 25  # of work, see limits.Work
# What percentages of it refer to.
_AXES = {
    "x": "width",
    "cx": "width",
    "x1": "width",
    "x2": "width",
    "width": "width",
    "rx": "width",
    "y": "height",
    "cy": "height",
    "y1": "height",
    "y2": "height",
    "height": "height",
    "ry": "height",
    "r": "diagonal",
}
_STYLED = frozenset(("x", "y", "cx", "cy", "r", "rx", "ry", "width", "height"))


@dataclass(slots=True, eq=False)
class Lengths:
    """The lengths of one element, resolved: a style sheet's before the attribute's.

    Attributes:
        attributes: of the element.
        declared: its declarations from style sheets and the ``style`` attribute.
        viewport: for percentages.
        font: for font units.
        invalid: attributes whose text is no length, for a report.
        assumed: units in use that depend on a window or a font.
    """

    attributes: Any
    declared: Declared
    viewport: Viewport
    font: Font
    invalid: list[str] = field(default_factory=list)
    assumed: list[str] = field(default_factory=list)

    def get(self, name: str) -> float | None:
        """Give a length in user units; None where it is missing, ``auto`` or invalid."""
        terms = self._terms(name)
        if terms is None:
            return None
        if needs_window(terms) or needs_metrics(terms):
            self.assumed.append(name)
        return self._px(name, terms)

    def size(self, name: str) -> float | None:
        """Give a width or height in user units; None where it is missing, ``auto`` or no length, 0 below 0."""
        text = self.attributes.get(name)
        terms = parse_length(text) if text is not None else None
        if terms is None:
            if text is not None and text.strip() != "auto":
                self.invalid.append(name)
            return None
        return max(0.0, self._px(name, terms))

    def _px(self, name: str, terms: Terms) -> float:
        try:
            return to_px(terms, getattr(self.viewport, _AXES[name]), self.font)
        except NumberError:
            raise NumberError("" if name in self.declared else name) from None

    def _terms(self, name: str) -> Terms | None:
        if name in self.declared:
            value = self.declared[name]
            return value if isinstance(value, tuple) else None
        text = self.attributes.get(name)
        if text is None:
            return None
        try:
            value = parse_declaration(name, text, "attribute") if name in _STYLED else parse_length(text)
        except NumberError:
            raise NumberError(name) from None
        if isinstance(value, TooLarge):
            raise NumberError(name)
        if value is None or isinstance(value, Pending):
            self.invalid.append(name)
        return value if isinstance(value, tuple) else None


@dataclass(slots=True, eq=False)
class Shape:
    """What a shape element draws.

    Attributes:
        subpaths: in its own coordinates; none when it draws nothing.
        fault: where its data are wrong, and in which attribute.
        attribute: of the fault.
        nothing: why it draws nothing, ``""`` when it draws or is empty by itself.
    """

    subpaths: list[Subpath]
    fault: Fault | None = None
    attribute: str = ""
    nothing: str = ""
    _boxes: list[Box | None] = field(default_factory=list, repr=False, compare=False)

    def box(self) -> Box | None:
        """Give the box of what it draws, worked out once; None where that is nothing."""
        if not self._boxes:
            self._boxes.append(box_of_segments(segment for sub in self.subpaths for segment in sub.segments))
        return self._boxes[0]


class Shapes:
    """Reads the shapes of a document; lists of points and path data that are copied are read once."""

    def __init__(self, work: Work, plain: PlainPaths) -> None:
        self._work, self._plain = work, plain
        self._read: dict[Any, Shape] = {}

    def of(self, tag: str, element: Any, attributes: Any, lengths: Lengths, copied: bool) -> Shape:
        """Give what an element draws.

        Args:
            tag: one of SHAPES.
            element: of the document.
            attributes: its own.
            lengths: the same, resolved.
            copied: it is drawn by reference, and maybe again.
        """
        data = "d" if tag == "path" else "points"
        own = copied and data in attributes and data not in lengths.declared
        shape = self._read.get(element) if own else None
        if shape is None:
            text = lengths.declared.get(data) or attributes.get(data)
            if text:
                self._work.charge("path data", len(text) // LETTERS_OF_A_STEP)
            plain = self._plain.get(text) if text and tag == "path" else None
            shape = make_shape(tag, attributes, lengths) if plain is None else Shape([plain], attribute="d")
            if own:
                self._read[element] = shape
        self._work.charge("shapes", _STEPS_OF_A_SHAPE + sum(map(len, shape.subpaths)))
        return shape


def make_shape(tag: str, attributes: Any, lengths: Lengths) -> Shape:
    """Give what the element draws.

    Args:
        tag: one of SHAPES.
        attributes: of the element.
        lengths: the same, resolved.
    """
    return SHAPES[tag](attributes, lengths)


def _path(attributes: Any, lengths: Lengths) -> Shape:
    text = lengths.declared.get("d", attributes.get("d"))
    if text is None or text == INITIAL:
        return Shape([], nothing="it has no d" if text is None else "its d is none")
    subpaths, fault = parse_path_data(text)
    drawn = [subpath for subpath in subpaths if len(subpath.segments) > 1]
    nothing = "" if drawn else "its path data draw nothing"
    # Where only moves are, the first stays: it is one point, for those who ask what became of the path
    return Shape(drawn or subpaths[:1], fault, "d", nothing if not subpaths else "")


def _rect(attributes: Any, lengths: Lengths) -> Shape:
    x, y = lengths.get("x") or 0.0, lengths.get("y") or 0.0
    width, height = lengths.get("width") or 0.0, lengths.get("height") or 0.0
    if width <= 0 or height <= 0:
        return Shape([], nothing=f"its width is {width:g}, its height {height:g}")
    rx, ry = lengths.get("rx"), lengths.get("ry")
    rx, ry = (rx if rx is not None else ry or 0.0), (ry if ry is not None else rx or 0.0)
    rx, ry = max(0.0, min(rx, width / 2)), max(0.0, min(ry, height / 2))
    right, bottom = x + width, y + height
    if rx == 0 or ry == 0:
        segments: list[Segment] = [("M", x, y), ("L", right, y), ("L", right, bottom), ("L", x, bottom)]
        return Shape([Subpath(segments, closed=True)])
    return Shape([Subpath(_rounded(x, y, right, bottom, rx, ry), closed=True)])


def _rounded(x: float, y: float, right: float, bottom: float, rx: float, ry: float) -> list[Segment]:
    """Give a rectangle with elliptic corners, clockwise on the screen from behind the first corner."""
    corners = [
        ((right - rx, y), (right, y + ry)),
        ((right, bottom - ry), (right - rx, bottom)),
        ((x + rx, bottom), (x, bottom - ry)),
        ((x, y + ry), (x + rx, y)),
    ]
    segments: list[Segment] = [("M", x + rx, y)]
    for (x0, y0), (x1, y1) in corners:
        if segments[-1][-2:] != (x0, y0):
            segments.append(("L", x0, y0))
        segments.append(("A", rx, ry, 0.0, 0, 1, x1, y1))
    return segments


def _circle(attributes: Any, lengths: Lengths) -> Shape:
    r = lengths.get("r") or 0.0
    if r <= 0:
        return Shape([], nothing="its radius is 0 or missing")
    return Shape([Subpath(full_ellipse(lengths.get("cx") or 0.0, lengths.get("cy") or 0.0, r, r), closed=True)])


def _ellipse(attributes: Any, lengths: Lengths) -> Shape:
    rx, ry = lengths.get("rx"), lengths.get("ry")
    rx, ry = (rx if rx is not None else ry or 0.0), (ry if ry is not None else rx or 0.0)
    if rx <= 0 or ry <= 0:
        return Shape([], nothing=f"its radii are {rx:g} and {ry:g}")
    return Shape([Subpath(full_ellipse(lengths.get("cx") or 0.0, lengths.get("cy") or 0.0, rx, ry), closed=True)])


def _line(attributes: Any, lengths: Lengths) -> Shape:
    x1, y1, x2, y2 = (lengths.get(name) or 0.0 for name in ("x1", "y1", "x2", "y2"))
    return Shape([Subpath([("M", x1, y1), ("L", x2, y2)], closed=False)])


def _points(attributes: Any, closed: bool) -> Shape:
    text = attributes.get("points") or ""
    numbers, fault = read_points(text)
    if fault is not None and not fault.message.startswith("a point"):
        return Shape([], fault, "points", "its list of points is wrong, and browsers then draw none of it")
    if not numbers:
        return Shape([], fault, "points", "it has no points")
    segments: list[Segment] = [("M", numbers[0], numbers[1])]
    segments += [("L", x, y) for x, y in zip(numbers[2::2], numbers[3::2], strict=True)]
    return Shape([Subpath(segments, closed=closed)], fault, "points")


def read_points(text: str) -> tuple[list[float], Fault | None]:
    """Read a ``points`` list to x, y, x, y...; an odd number at the end is left out, with a fault."""
    check_length(text)
    numbers: list[float] = []
    position = len(text) - len(text.lstrip(" \t\r\n\f"))
    end = len(text.rstrip(" \t\r\n\f"))
    while position < end:
        match = NUMBER.match(text, position)
        if match is None:
            return numbers, Fault(position, f"{text[position]!r} is not expected in a list of points")
        numbers.append(float(match[0]))
        if numbers[-1] in (float("inf"), float("-inf")):
            return numbers, Fault(position, "the number is too large")
        gap = COMMA.match(text, match.end())
        position = gap.end() if gap else match.end()
    if len(numbers) % 2:
        return numbers[:-1], Fault(max(0, end - 1), "a point has two numbers, the last has one and is left out")
    return numbers, None


SHAPES: dict[str, Callable[[Any, Lengths], Shape]] = {
    "path": _path,
    "rect": _rect,
    "circle": _circle,
    "ellipse": _ellipse,
    "line": _line,
    "polyline": lambda attributes, lengths: _points(attributes, closed=False),
    "polygon": lambda attributes, lengths: _points(attributes, closed=True),
}
