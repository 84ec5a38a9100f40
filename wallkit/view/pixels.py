"""Pixels: a picture as one array, coloured where something covers them, and written as PNG."""

from __future__ import annotations

import functools
import struct
import zlib
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from wallkit.geometry.arrays import IntArray
from wallkit.geometry.ragged import numbered, slices
from wallkit.view.cover import Cover, Mask, Runs

if TYPE_CHECKING:
    from PIL.Image import Image


_SMALL = 4096  # pixels of a mask: up to that all are mixed, covered or not
_LONG = 32  # pixels of a run: beyond, it costs less to lay it down by itself
_BAND = 128  # rows that are packed at once, in memory that stays in the cache
_LEVEL = 2  # of deflate: three times as fast as 6, and files a few per cent larger


class Pixels:
    """Rows of pixels from the top, each red + 2^8 green + 2^16 blue."""

    def __init__(self, width: int, height: int, paper: str) -> None:
        self.values: NDArray[np.uint32] = np.full((height, width), number_of(paper), dtype="<u4")
        self._most = np.zeros(height * width, dtype=np.uint8)  # for the work: of each pixel the largest cover

    @property
    def size(self) -> tuple[int, int]:
        """Width and height."""
        return self.values.shape[1], self.values.shape[0]

    def copied(self) -> Pixels:
        """Give the same pixels in an array of their own."""
        other = Pixels.__new__(Pixels)
        other.values, other._most = self.values.copy(), self._most
        return other

    def paint(self, cover: Cover | None, colour: str, opacity: float = 1.0) -> None:
        """Lay a colour over what is there, as far as it is covered; None covers nothing."""
        if cover is None:
            return
        hue, strength = number_of(colour), _strengths(opacity)
        if isinstance(cover, Mask):
            self._paint_mask(cover, hue, strength)
        elif isinstance(cover, Runs):
            self._paint_runs(cover, hue, strength)
        else:
            most = self._most
            np.maximum.at(most, cover.place, cover.cover)
            self._mix(cover.place, hue, strength[most[cover.place]])
            most[cover.place] = 0

    def paint_each(
        self, left: int, top: int, hues: NDArray[np.uint32], shown: NDArray[np.bool_], opacity: float
    ) -> None:
        """Lay a colour of its own over each pixel of a rectangle from (left, top) on, where it is shown."""
        under = self.values[top : top + hues.shape[0], left : left + hues.shape[1]]
        under[shown] = _mixed(under[shown], hues[shown], _strengths(opacity)[-1:])

    def _mix(self, place: IntArray, hue: int, strength: NDArray[np.uint32]) -> None:
        flat = self.values.reshape(-1)
        flat[place] = _mixed(flat[place], hue, strength)

    def _paint_mask(self, mask: Mask, hue: int, strength: NDArray[np.uint32]) -> None:
        cover, (rows, columns) = mask.cover, mask.cover.shape
        under = self.values[mask.top : mask.top + rows, mask.left : mask.left + columns]
        if cover.size <= _SMALL:
            under[...] = _mixed(under, hue, strength[cover])
            return
        if strength[255] == 255:
            np.copyto(under, np.uint32(hue), where=cover == 255)
            found = np.flatnonzero((cover - np.uint8(1)) < 254)  # 0 becomes 255: neither nothing nor all
        else:
            found = np.flatnonzero(cover.view(np.bool_))
        width = self.values.shape[1]
        place = found + (mask.top * width + mask.left)
        if columns != width:
            place += found // columns * (width - columns)
        self._mix(place, hue, strength[cover.reshape(-1)[found]])

    def _paint_runs(self, runs: Runs, hue: int, strength: NDArray[np.uint32]) -> None:
        """Lay down long runs that hide what was there each at once, and all others pixel by pixel."""
        begin, end, cover = runs
        whole = (strength[cover] == 255) & (end - begin > _LONG)
        flat, value = self.values.reshape(-1), np.uint32(hue)
        for first, stop in zip(begin[whole].tolist(), end[whole].tolist(), strict=True):
            flat[first:stop] = value
        rest = ~whole
        which, rank = numbered((end - begin)[rest])
        self._mix(begin[rest][which] + rank, hue, strength[cover[rest]][which])

    def rgb(self) -> NDArray[np.uint8]:
        """Give the pixels as (height, width, 3)."""
        height, width = self.values.shape
        channels = np.empty((height, 3 * width), dtype=np.uint8)
        _spread_channels(self.values, channels)
        return channels.reshape(height, width, 3)

    def image(self) -> Image:
        """Give the pixels as an image of Pillow's."""
        from PIL import Image

        return Image.fromarray(self.rgb())

    def png(self) -> bytes:
        """Give the pixels as a PNG file.

        Rows are not filtered: most of a drawing is of one colour, or repeats, which deflate finds sooner as it is.
        """
        width, height = self.size
        pack, packed = zlib.compressobj(_LEVEL), list[bytes]()
        rows = np.zeros((_BAND, 3 * width + 1), dtype=np.uint8)  # each begins with its filter: none
        for band in slices(height, _BAND):
            pixels = self.values[band]
            _spread_channels(pixels, rows[: len(pixels), 1:])
            packed.append(pack.compress(rows[: len(pixels)].data))
        head = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)  # eight bits of red, green and blue
        parts = ((b"IHDR", head), (b"IDAT", b"".join([*packed, pack.flush()])), (b"IEND", b""))
        return b"\x89PNG\r\n\x1a\n" + b"".join(
            struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))
            for name, data in parts
        )


def _spread_channels(pixels: NDArray[np.uint32], into: NDArray[np.uint8]) -> None:
    """Write the three channels of pixels (h, w) side by side (h, 3 w)."""
    for channel in range(3):  # one by one, which is five times as fast as all in one step
        into[:, channel::3] = pixels.view(np.uint8)[:, channel::4]


def number_of(colour: str) -> int:
    """Turn ``#rrggbb`` into the number of a pixel."""
    return int.from_bytes(bytes.fromhex(colour[1:]), "little")


@functools.lru_cache(maxsize=256)
def _strengths(opacity: float) -> NDArray[np.uint32]:
    """What each value of a mask is worth."""
    return np.asarray(np.rint(np.arange(256) * min(max(opacity, 0.0), 1.0)), dtype=np.uint32)


def _mixed(
    under: NDArray[np.uint32], hue: int | NDArray[np.uint32], strength: NDArray[np.uint32]
) -> NDArray[np.uint32]:
    """Mix pixels with a colour, or with one each: (under (255 - s) + hue s) / 255, rounded, in each channel.

    Red and blue are 16 bits apart, so one product does for both: 255 * 255 + 128 is less than 2^16. x / 255 is
    (x + 128 + ((x + 128) >> 8)) >> 8 for such x.
    """
    apart, one, over = np.uint32(0x00FF00FF), np.uint32(0x000000FF), np.asarray(hue, dtype=np.uint32)
    rest = np.uint32(255) - strength
    twice = (under & apart) * rest + (over & apart) * strength + np.uint32(0x00800080)
    twice = (twice + ((twice >> 8) & apart)) >> 8 & apart
    once = ((under >> 8) & one) * rest + (over >> 8 & one) * strength + np.uint32(0x80)
    once = (once + (once >> 8)) & np.uint32(0xFF00)
    return np.asarray(twice | once, dtype=np.uint32)
