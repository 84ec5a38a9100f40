"""A canvas as pixels, by Pillow: drawn at twice the size and averaged, which smooths every edge."""

from __future__ import annotations

import io
import math

import numpy as np
from PIL import Image, ImageDraw, ImageFont

from wallkit.geometry.arrays import FloatArray
from wallkit.geometry.path_segments import chords
from wallkit.view.canvas import Bitmap, Canvas, Command, Disc, Item, Label, Shape
from wallkit.view.theme import STYLES, Theme, colour, ramp

_FINE = 2  # each pixel is the mean of 2 by 2
_ANCHORS = {"start": "ls", "middle": "ms", "end": "rs"}


def png(canvas: Canvas, theme: Theme = "light", scale: float = 2.0) -> bytes:
    """Give the picture as a PNG file of ``scale`` pixels a pixel of the canvas."""
    data = io.BytesIO()
    Raster(canvas.width, canvas.height, theme, scale).drawn(canvas.items).reduced().save(data, "PNG")
    return data.getvalue()


class Raster:
    """Pixels to draw items on.

    Attributes:
        image: the fine pixels; :meth:`reduced` gives what is to be shown.
        zoom: fine pixels a pixel of the canvas.
        theme: light or dark.
    """

    def __init__(self, width: float, height: float, theme: Theme, scale: float) -> None:
        self.zoom = scale * _FINE
        self.theme: Theme = theme
        size = max(1, math.ceil(width * scale)) * _FINE, max(1, math.ceil(height * scale)) * _FINE
        self.image = Image.new("RGB", size, colour("paper", theme))
        self._draw = ImageDraw.Draw(self.image)

    def copied(self) -> Raster:
        """Give pixels of their own with the same content, so that one background serves many frames."""
        other = Raster.__new__(Raster)
        other.zoom, other.theme, other.image = self.zoom, self.theme, self.image.copy()
        other._draw = ImageDraw.Draw(other.image)
        return other

    def reduced(self) -> Image.Image:
        """Give the picture in its own size."""
        return self.image.reduce(_FINE)

    def drawn(self, items: list[Item]) -> Raster:
        """Draw items in order."""
        for item in items:
            if isinstance(item, Shape):
                self._shape(item)
            elif isinstance(item, Disc):
                self._disc(item)
            elif isinstance(item, Label):
                self._label(item)
            else:
                self._bitmap(item)
        return self

    def _shape(self, shape: Shape) -> None:
        lines = [points * self.zoom for points in polylines(shape.commands)]
        style = STYLES[shape.style]
        if style.fill:
            hue = ramp(shape.step, self.theme) if shape.step is not None else colour(style.fill, self.theme)
            self._fill(lines, hue, shape.opacity)
        stroke = (
            ramp(shape.step, self.theme)
            if shape.step is not None
            else style.stroke and colour(style.stroke, self.theme)
        )
        if not stroke:
            return
        width = max(1, round(style.width * self.zoom))
        if style.dash:
            lines = [
                dash for line in lines for dash in _dashes(line, style.dash[0] * self.zoom, style.dash[1] * self.zoom)
            ]
        if shape.opacity >= 1:
            for line in lines:
                self._draw.line([tuple(p) for p in line.tolist()], stroke, width, joint="curve")
        elif lines:
            self._faint(lines, stroke, width, shape.opacity)

    def _faint(self, lines: list[FloatArray], stroke: str, width: int, opacity: float) -> None:
        every = np.concatenate(lines)
        corner = np.maximum(np.floor(every.min(axis=0)) - width, 0).astype(int)
        far = np.minimum(np.ceil(every.max(axis=0)) + width + 1, self.image.size).astype(int)
        if (far <= corner).any():
            return
        mask = Image.new("L", tuple((far - corner).tolist()), 0)
        pen = ImageDraw.Draw(mask)
        for line in lines:
            pen.line([tuple(p) for p in (line - corner).tolist()], round(255 * opacity), width, joint="curve")
        self.image.paste(stroke, tuple(corner.tolist()), mask)

    def _fill(self, lines: list[FloatArray], fill: str, opacity: float) -> None:
        """Fill even-odd: along each row of pixels the inside begins and ends where an edge crosses its middle."""
        if not lines:
            return
        a = np.concatenate(lines)
        b = np.concatenate([np.roll(line, -1, axis=0) for line in lines])
        left, top = np.clip(np.floor(a.min(axis=0)), 0, self.image.size).astype(int).tolist()
        right, bottom = np.clip(np.ceil(a.max(axis=0)), 0, self.image.size).astype(int).tolist()
        width, height = right - left, bottom - top
        if width <= 0 or height <= 0:
            return
        a, b = a - (left, top), b - (left, top)
        down = (a[:, 1] < b[:, 1])[:, None]
        low, high = np.where(down, a, b), np.where(down, b, a)
        first = np.clip(np.ceil(low[:, 1] - 0.5), 0, height).astype(np.int64)
        count = np.maximum(0, np.clip(np.ceil(high[:, 1] - 0.5), 0, height).astype(np.int64) - first)
        edge = np.repeat(np.arange(len(a)), count)
        row = first[edge] + np.arange(len(edge)) - np.repeat(np.cumsum(count) - count, count)
        part = (row + 0.5 - low[edge, 1]) / (high - low)[edge, 1]
        x = low[edge, 0] + part * (high - low)[edge, 0]
        flips = np.zeros((height, width + 1), dtype=np.uint8)
        np.bitwise_xor.at(flips, (row, np.clip(np.ceil(x - 0.5), 0, width).astype(np.int64)), 1)
        inside = np.bitwise_xor.accumulate(flips[:, :width], axis=1)
        self.image.paste(fill, (left, top), Image.fromarray(inside * np.uint8(round(255 * opacity))))

    def _disc(self, disc: Disc) -> None:
        style = STYLES[disc.style]
        hue = ramp(disc.step, self.theme) if disc.step is not None else None
        fill = hue if disc.filled else style.fill and colour(style.fill, self.theme)
        stroke = hue or (style.stroke and colour(style.stroke, self.theme))
        x, y, radius = disc.x * self.zoom, disc.y * self.zoom, disc.radius * self.zoom
        width = max(1, round(style.width * self.zoom))
        if disc.opacity >= 1:
            self._draw.circle((x, y), radius + width / 2, fill or None, stroke or None, width)
            return
        left, top = math.floor(x - radius - width), math.floor(y - radius - width)
        size = math.ceil(2 * (radius + width)) + 2
        mask = Image.new("L", (size, size), 0)
        ink = round(255 * disc.opacity)
        ImageDraw.Draw(mask).circle((x - left, y - top), radius + width / 2, ink if fill else None, ink, width)
        self.image.paste(stroke or fill or "#808080", (left, top), mask)

    def _label(self, label: Label) -> None:
        font = ImageFont.load_default(label.size * self.zoom)
        fill = colour(STYLES[label.style].fill or "ink", self.theme)
        text = "".join(c if c.isprintable() else "\ufffd" for c in label.text)
        place = (label.x * self.zoom, label.y * self.zoom)
        weight = label.size * self.zoom / 40 if label.bold else 0
        self._draw.text(place, text, fill, font, _ANCHORS[label.anchor], stroke_width=weight, stroke_fill=fill)

    def _bitmap(self, cells: Bitmap) -> None:
        def edges(start: float, count: int) -> list[int]:  # shared by neighbours, or seams would show
            return [round((start + index * cells.size) * self.zoom) for index in range(count + 1)]

        xs, ys = edges(cells.x, len(cells.rows[0]) if cells.rows else 0), edges(cells.y, len(cells.rows))
        for row, steps in enumerate(cells.rows):
            for column, step in enumerate(steps):
                if step >= 0:
                    box = xs[column], ys[row], xs[column + 1] - 1, ys[row + 1] - 1
                    self._draw.rectangle(box, ramp(step, self.theme))


def polylines(commands: list[Command]) -> list[FloatArray]:
    """Give each subpath as (n, 2) points, curves and arcs cut into chords; a closed one ends where it began."""
    lines: list[list[FloatArray]] = []
    for command in commands:
        kind, numbers = command[0], command[1:]
        if kind == "M":
            lines.append([np.array([numbers])])
        elif kind == "Z":
            lines[-1].append(lines[-1][0][:1])
        else:
            lines[-1].append(chords(lines[-1][-1][-1], kind, numbers))
    return [np.concatenate(parts) for parts in lines]


def _dashes(line: FloatArray, dash: float, gap: float) -> list[FloatArray]:
    """Cut a polyline into dashes."""
    length = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(line, axis=0).T))])
    cuts = np.arange(0.0, length[-1], dash + gap)[:20_000]

    def at(places: FloatArray) -> FloatArray:
        return np.stack([np.interp(places, length, line[:, 0]), np.interp(places, length, line[:, 1])], axis=1)

    return [
        at(np.unique([cut, *length[(length > cut) & (length < cut + dash)], min(cut + dash, length[-1])]))
        for cut in cuts
    ]
