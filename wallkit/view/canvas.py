"""Canvas: what a picture consists of, in pixels, written as SVG here and as pixels in ``raster``."""

from __future__ import annotations

from dataclasses import dataclass, field
from html import escape
from typing import Any, Literal

from wallkit.view.theme import STYLES, css

# Path commands in pixels, absolute: ("M", x, y), ("L", x, y), ("Q", x1, y1, x, y), ("C", x1, y1, x2, y2, x, y),
# ("A", rx, ry, rotation, large, sweep, x, y) and ("Z",).
Command = tuple[Any, ...]
Anchor = Literal["start", "middle", "end"]


@dataclass(frozen=True, slots=True)
class Shape:
    """A path, filled even-odd and stroked as its style says.

    Attributes:
        style: a name in ``theme.STYLES``.
        commands: the path.
        step: the ramp's step that colours the stroke, and the fill where the style has one; None for its own colours.
        opacity: 0 to 1.
        title: what a pointer over it shows.
    """

    style: str
    commands: list[Command]
    step: int | None = None
    opacity: float = 1.0
    title: str = ""


@dataclass(frozen=True, slots=True)
class Disc:
    """A circle; ``step`` colours its stroke, and its fill too where ``filled``."""

    style: str
    x: float
    y: float
    radius: float
    step: int | None = None
    filled: bool = False
    opacity: float = 1.0
    title: str = ""


@dataclass(frozen=True, slots=True)
class Label:
    """A line of text; y is its base line, size in pixels."""

    style: str
    x: float
    y: float
    text: str
    size: float = 12.0
    anchor: Anchor = "start"
    bold: bool = False


@dataclass(frozen=True, slots=True)
class Bitmap:
    """Cells of a colour ramp: rows of steps from the top, -1 for none; drawn as squares of ``size`` pixels."""

    x: float
    y: float
    size: float
    rows: list[list[int]]
    opacity: float = 1.0


Item = Shape | Disc | Label | Bitmap


@dataclass(slots=True)
class Canvas:
    """A picture as a list of items, drawn in order.

    Attributes:
        width: in pixels.
        height: in pixels.
        title: what it shows, for people who cannot see it.
        items: from the bottom up.
    """

    width: float
    height: float
    title: str = ""
    items: list[Item] = field(default_factory=list)

    def add(self, *items: Item) -> None:
        """Draw items over what is there."""
        self.items.extend(items)

    def to_svg(self) -> str:
        """Write the picture as one SVG document that follows the reader's light or dark setting."""
        width, height = _number(self.width), _number(self.height)
        body = "\n".join(_written(item) for item in self.items)
        return (
            f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" '
            f'viewBox="0 0 {width} {height}" role="img" font-family="system-ui, sans-serif">\n'
            f"<title>{escape(printable(self.title))}</title>\n<style>{css()}</style>\n"
            f'<rect class="wk-paper" width="{width}" height="{height}"/>\n'
            '<g fill-rule="evenodd" stroke-linejoin="round" stroke-linecap="round">\n'
            f"{body}\n</g>\n</svg>\n"
        )


def _written(item: Item) -> str:
    if isinstance(item, Shape):
        return _tag(
            "path",
            f'd="{path_data(item.commands)}"',
            _classes(item.style, item.step, item.step if STYLES[item.style].fill else None),
            item.opacity,
            item.title,
        )
    if isinstance(item, Disc):
        place = f'cx="{_number(item.x)}" cy="{_number(item.y)}" r="{_number(item.radius)}"'
        return _tag("circle", place, _classes(item.style, item.step, item.step if item.filled else None), item.opacity,
                    item.title)  # fmt: skip
    if isinstance(item, Label):
        weight = ' font-weight="600"' if item.bold else ""
        return (
            f'<text class="wk-{item.style}" x="{_number(item.x)}" y="{_number(item.y)}" '
            f'font-size="{_number(item.size)}" text-anchor="{item.anchor}"{weight}>'
            f"{escape(printable(item.text))}</text>"
        )
    return _cells(item)


def _tag(name: str, place: str, classes: str, opacity: float, title: str) -> str:
    faint = f' opacity="{_number(opacity)}"' if opacity < 1 else ""
    told = f"<title>{escape(printable(title))}</title></{name}>" if title else ""
    return f'<{name} class="{classes}" {place}{faint}{">" + told if told else "/>"}'


def _classes(style: str, stroke: int | None, fill: int | None) -> str:
    words = [f"wk-{style}"]
    if stroke is not None:
        words.append(f"wk-s{stroke}")
    if fill is not None:
        words.append(f"wk-f{fill}")
    return " ".join(words)


def _cells(item: Bitmap) -> str:
    """One path a step: as many elements as colours, however many cells."""
    by_step: dict[int, list[str]] = {}
    size = _number(item.size)
    for row, steps in enumerate(item.rows):
        for column, step in enumerate(steps):
            if step >= 0:
                x, y = _number(item.x + column * item.size), _number(item.y + row * item.size)
                by_step.setdefault(step, []).append(f"M{x} {y}h{size}v{size}h-{size}z")
    paths = (f'<path class="wk-f{step}" d="{"".join(cells)}"/>' for step, cells in sorted(by_step.items()))
    return f'<g opacity="{_number(item.opacity)}" shape-rendering="crispEdges">{"".join(paths)}</g>'


def path_data(commands: list[Command]) -> str:
    """Write commands as SVG path data, to a hundredth of a pixel."""
    return "".join(command[0] + " ".join(map(_number, command[1:])) for command in commands)


def _number(value: float) -> str:
    text = f"{value:.2f}"
    return text.rstrip("0").rstrip(".") if "." in text else text


def printable(text: str) -> str:
    """Replace what XML 1.0 cannot hold: control characters and lone surrogates of somebody's layer names."""
    return "".join(
        c if c >= " " and not "\ud800" <= c <= "\udfff" and c not in "\ufffe\uffff" else "\ufffd" for c in text
    )
