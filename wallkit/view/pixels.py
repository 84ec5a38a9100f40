"""Pixels: a picture as one array, coloured through masks, and written as PNG."""

from __future__ import annotations

import functools
import struct
import zlib
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from PIL.Image import Image

    from wallkit.view.masks import Mask

_SMALL = 4096  # pixels of a mask: up to that all are mixed, covered or not
_LEVEL = 2  # of deflate: three times as fast as 6, and files a few per cent larger


class Pixels:
    """Rows of pixels from the top, each red + 2^8 green + 2^16 blue."""

    def __init__(self, width: int, height: int, paper: str) -> None:
        self.values: NDArray[np.uint32] = np.full((height, width), number_of(paper), dtype="<u4")

    @property
    def size(self) -> tuple[int, int]:
        """Width and height."""
        return self.values.shape[1], self.values.shape[0]

    def copied(self) -> Pixels:
        """Give the same pixels in an array of their own."""
        other = Pixels.__new__(Pixels)
        other.values = self.values.copy()
        return other

    def paint(self, mask: Mask | None, colour: str, opacity: float = 1.0) -> None:
        """Lay a colour over what is there, as far as a mask covers it; None covers nothing."""
        if mask is None:
            return
        cover, (rows, columns), hue = mask.cover, mask.cover.shape, number_of(colour)
        under = self.values[mask.top : mask.top + rows, mask.left : mask.left + columns]
        strength = _strengths(opacity)
        if cover.size <= _SMALL:
            under[...] = _mixed(under, hue, strength[cover])
            return
        if opacity >= 1.0:
            np.copyto(under, np.uint32(hue), where=cover == 255)
            found = np.flatnonzero((cover - np.uint8(1)) < 254)  # 0 becomes 255: neither nothing nor all
        else:
            found = np.flatnonzero(cover.view(np.bool_))
        width = self.values.shape[1]
        place = found + (mask.top * width + mask.left)
        if columns != width:
            place += found // columns * (width - columns)
        flat = self.values.reshape(-1)
        flat[place] = _mixed(flat[place], hue, strength[cover.reshape(-1)[found]])

    def rgb(self) -> NDArray[np.uint8]:
        """Give the pixels as (height, width, 3)."""
        channels = np.empty((*self.values.shape, 3), dtype=np.uint8)
        for channel in range(3):  # one by one, which is five times as fast as all in one step
            channels[:, :, channel] = self.values.view(np.uint8)[:, channel::4]
        return channels

    def image(self) -> Image:
        """Give the pixels as an image of Pillow's."""
        from PIL import Image

        return Image.fromarray(self.rgb())

    def png(self) -> bytes:
        """Give the pixels as a PNG file.

        Rows are not filtered: most of a drawing is of one colour, or repeats, which deflate finds sooner as it is.
        """
        width, height = self.size
        rows = np.zeros((height, 3 * width + 1), dtype=np.uint8)
        rows[:, 1:] = self.rgb().reshape(height, -1)
        head = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)  # eight bits of red, green and blue
        parts = ((b"IHDR", head), (b"IDAT", zlib.compress(rows.data, _LEVEL)), (b"IEND", b""))
        return b"\x89PNG\r\n\x1a\n" + b"".join(
            struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))
            for name, data in parts
        )


def number_of(colour: str) -> int:
    """Turn ``#rrggbb`` into the number of a pixel."""
    return int.from_bytes(bytes.fromhex(colour[1:]), "little")


@functools.lru_cache(maxsize=256)
def _strengths(opacity: float) -> NDArray[np.uint32]:
    """What each value of a mask is worth."""
    return np.asarray(np.rint(np.arange(256) * min(max(opacity, 0.0), 1.0)), dtype=np.uint32)


def _mixed(under: NDArray[np.uint32], hue: int, strength: NDArray[np.uint32]) -> NDArray[np.uint32]:
    """Mix pixels with a colour: (under (255 - s) + hue s) / 255, rounded, in each channel.

    Red and blue are 16 bits apart, so one product does for both: 255 * 255 + 128 is less than 2^16. x / 255 is
    (x + 128 + ((x + 128) >> 8)) >> 8 for such x.
    """
    apart, one = np.uint32(0x00FF00FF), np.uint32(0x000000FF)
    rest = np.uint32(255) - strength
    twice = (under & apart) * rest + np.uint32(hue & 0x00FF00FF) * strength + np.uint32(0x00800080)
    twice = (twice + ((twice >> 8) & apart)) >> 8 & apart
    once = ((under >> 8) & one) * rest + np.uint32(hue >> 8 & 0xFF) * strength + np.uint32(0x80)
    once = (once + (once >> 8)) & np.uint32(0xFF00)
    return np.asarray(twice | once, dtype=np.uint32)
