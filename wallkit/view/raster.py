"""A canvas as pixels: each item is a mask with a colour; letters come from Pillow."""

from __future__ import annotations

import functools
import math
from typing import NamedTuple

import numpy as np
from PIL import Image, ImageDraw, ImageFont

from wallkit.geometry.arrays import FloatArray, IntArray
from wallkit.geometry.path_segments import polylines
from wallkit.simulation.aligned_arrays import keep_freed_memory
from wallkit.view.areas import fill, ring
from wallkit.view.canvas import Bitmap, Canvas, Disc, Item, Label, Shape
from wallkit.view.cover import Mask
from wallkit.view.pixels import Pixels, number_of
from wallkit.view.strokes import strokes
from wallkit.view.theme import RAMP_STEPS, STYLES, Theme, colour, ramp

_TOGETHER = 100
"""Points of strokes that are looked for at once, about: those of many points take their time alone as well."""
_DASHES = 20_000
"""Dashes of a line, at most."""
_ANCHORS = {"start": "ls", "middle": "ms", "end": "rs"}


def png(canvas: Canvas, theme: Theme = "light", scale: float = 2.0) -> bytes:
    """Give the picture as a PNG file of ``scale`` pixels a pixel of the canvas."""
    return Raster(canvas.width, canvas.height, theme, scale).drawn(canvas.items).pixels.png()


class _Stroke(NamedTuple):
    """Polylines in pixels, and the pen that draws them."""

    lines: list[FloatArray]
    width: float
    pen: str
    opacity: float

    @property
    def round_ends(self) -> bool:
        """Faint lines that follow each other would show the disc behind their ends twice."""
        return self.opacity >= 1.0


class Raster:
    """Pixels to draw items on.

    Attributes:
        pixels: what is drawn.
        zoom: pixels a pixel of the canvas.
        theme: light or dark.
    """

    def __init__(self, width: float, height: float, theme: Theme, scale: float) -> None:
        keep_freed_memory()
        self.zoom = scale
        self.theme: Theme = theme
        size = max(1, math.ceil(width * scale)), max(1, math.ceil(height * scale))
        self.pixels = Pixels(*size, colour("paper", theme))
        self._waiting: list[_Stroke] = []

    def copied(self) -> Raster:
        """Give pixels of their own with the same content, so that one background serves many frames."""
        other = Raster.__new__(Raster)
        other.zoom, other.theme, other.pixels, other._waiting = self.zoom, self.theme, self.pixels.copied(), []
        return other

    def drawn(self, items: list[Item]) -> Raster:
        """Draw items in order."""
        for item in items:
            if isinstance(item, Shape):
                self._shape(item)
                continue
            self._draw_waiting()
            if isinstance(item, Disc):
                self._disc(item)
            elif isinstance(item, Label):
                self._label(item)
            else:
                self._bitmap(item)
        self._draw_waiting()
        return self

    def _shape(self, shape: Shape) -> None:
        lines = [points * self.zoom for points in polylines(shape.commands)]
        style = STYLES[shape.style]
        hue = None if shape.step is None else ramp(shape.step, self.theme)
        if style.fill:
            self._draw_waiting()
            self.pixels.paint(fill(lines, self.pixels.size), hue or colour(style.fill, self.theme), shape.opacity)
        pen = hue or (style.stroke and colour(style.stroke, self.theme))
        if not pen:
            return
        if style.dash:
            dash, gap = style.dash[0] * self.zoom, style.dash[1] * self.zoom
            lines = [piece for line in lines for piece in _dashes(line, dash, gap)]
        if lines:
            self._wait(_Stroke(lines, style.width * self.zoom, pen, shape.opacity))

    def _wait(self, stroke: _Stroke) -> None:
        """Let a stroke wait for others of the same pen: to look for the pixels of all at once costs less."""
        if self._waiting and (
            stroke.width != self._waiting[0].width
            or stroke.round_ends != self._waiting[0].round_ends
            or sum(len(line) for each in self._waiting for line in each.lines) > _TOGETHER
        ):
            self._draw_waiting()
        self._waiting.append(stroke)

    def _draw_waiting(self) -> None:
        """Draw the strokes that wait, in order."""
        waiting, self._waiting = self._waiting, []
        if waiting:
            width, round_ends = waiting[0].width, waiting[0].round_ends
            spots = strokes([each.lines for each in waiting], width, self.pixels.size, round_ends=round_ends)
            for each, cover in zip(waiting, spots, strict=True):
                self.pixels.paint(cover, each.pen, each.opacity)

    def _disc(self, disc: Disc) -> None:
        style = STYLES[disc.style]
        hue = ramp(disc.step, self.theme) if disc.step is not None else None
        inside = hue if disc.filled else style.fill and colour(style.fill, self.theme)
        pen = hue or (style.stroke and colour(style.stroke, self.theme))
        x, y, radius, half = (value * self.zoom for value in (disc.x, disc.y, disc.radius, style.width / 2))
        if inside:
            self.pixels.paint(ring(x, y, radius + half, 0.0, self.pixels.size), inside, disc.opacity)
        if pen and pen != inside:
            self.pixels.paint(ring(x, y, radius + half, radius - half, self.pixels.size), pen, disc.opacity)

    def _label(self, label: Label) -> None:
        font = _font(label.size * self.zoom)
        hue = colour(STYLES[label.style].fill or "ink", self.theme)
        text = "".join(c if c.isprintable() else "\ufffd" for c in label.text)
        x, y, weight = label.x * self.zoom, label.y * self.zoom, label.size * self.zoom / 40 if label.bold else 0
        box = font.getbbox(text, anchor=_ANCHORS[label.anchor], stroke_width=weight)
        left, top = max(math.floor(x + box[0]) - 1, 0), max(math.floor(y + box[1]) - 1, 0)
        right, bottom = (min(math.ceil(at) + 1, most) for at, most in
                         zip((x + box[2], y + box[3]), self.pixels.size, strict=True))  # fmt: skip
        if left >= right or top >= bottom:
            return
        letters = Image.new("L", (right - left, bottom - top), 0)
        pen = ImageDraw.Draw(letters)
        pen.text((x - left, y - top), text, 255, font, _ANCHORS[label.anchor], stroke_width=weight, stroke_fill=255)
        self.pixels.paint(Mask(np.asarray(letters), left, top), hue)

    def _bitmap(self, cells: Bitmap) -> None:
        """Give each pixel the colour of the cell that its middle is in."""
        steps = np.array(cells.rows, dtype=np.int64, ndmin=2)
        (top, rows), (left, columns) = (
            _cells(start * self.zoom, cells.size * self.zoom, count, pixels)
            for start, count, pixels in zip((cells.y, cells.x), steps.shape, self.pixels.size[::-1], strict=True)
        )
        hues = np.array([number_of(ramp(step, self.theme)) for step in range(RAMP_STEPS)], dtype=np.uint32)
        shown = steps[np.ix_(rows, columns)]
        self.pixels.paint_each(left, top, hues[shown], shown >= 0, cells.opacity)


def _cells(start: float, side: float, count: int, pixels: int) -> tuple[int, IntArray]:
    """Give the first of a row's pixels whose middle is in one of ``count`` cells, and the cell of each from it on."""
    cell = np.floor((np.arange(pixels) + 0.5 - start) / side)
    first, stop = np.searchsorted(cell, (0, count)).tolist()
    return first, cell[first:stop].astype(np.int64)


@functools.lru_cache(maxsize=16)
def _font(size: float) -> ImageFont.FreeTypeFont:
    font = ImageFont.load_default(size)
    assert isinstance(font, ImageFont.FreeTypeFont)
    return font


def _dashes(line: FloatArray, dash: float, gap: float) -> list[FloatArray]:
    """Cut a polyline into dashes."""
    length = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(line, axis=0).T))])
    cuts = np.arange(math.ceil(min(length[-1] / (dash + gap), _DASHES))) * (dash + gap)

    def at(places: FloatArray) -> FloatArray:
        return np.stack([np.interp(places, length, line[:, 0]), np.interp(places, length, line[:, 1])], axis=1)

    return [
        at(np.unique([cut, *length[(length > cut) & (length < cut + dash)], min(cut + dash, length[-1])]))
        for cut in cuts
    ]
