"""Artboards of a drawing by Illustrator CS4 or later, from its document data."""

from __future__ import annotations

import re

from importers.drawing import Artboard
from importers.illustrator.text import decode, string_end, unescape
from importers.limits import good_coordinate

_ARRAY = b"(ArtboardArray)"
_ENTRY = b"/Dictionary :"
_WINDOW = 1 << 18  # bytes before the array's name that may describe its artboards, some hundred bytes each
_POINT = re.compile(rb"([-+.\deE]{1,40}) ([-+.\deE]{1,40}) /RealPointRelToROrigin[\s%_]{1,20}\(PositionPoint([12])\)")
_NAME = re.compile(rb"\) /UnicodeString \(Name\)")


def find_artboards(data: bytes, stop: int) -> list[Artboard]:
    """List the artboards in the document data before `stop`; they stand in the coordinates of the art."""
    end = data.find(_ARRAY, 0, stop)
    if end < 0:
        return []
    entries = data[max(end - _WINDOW, 0) : end].split(_ENTRY)
    found = [_read_artboard(entry) for entry in entries[1:]]
    return [artboard for artboard in found if artboard is not None]


def _read_artboard(entry: bytes) -> Artboard | None:
    """Read one entry: two opposite corners and a name; None when it is something else."""
    corners: dict[bytes, tuple[float, float]] = {}
    for x, y, which in _POINT.findall(entry):
        try:
            corners[which] = float(x), float(y)
        except ValueError:
            return None
    if len(corners) != 2 or not all(good_coordinate(number) for corner in corners.values() for number in corner):
        return None
    (x1, y1), (x2, y2) = corners.values()
    return Artboard(_name_of(entry), min(x1, x2), min(y1, y2), max(x1, x2), max(y1, y2))


def _name_of(entry: bytes) -> str:
    """Read an entry's name, ``""`` without one."""
    match = _NAME.search(entry)
    line = max(entry.rfind(b"\n", 0, match.start()), entry.rfind(b"\r", 0, match.start())) if match else -1
    start = entry.find(b"(", line + 1) if match else -1
    end = string_end(entry, start, len(entry)) if start >= 0 else -1
    return decode(unescape(entry[start + 1 : end - 1]), "") if end > 0 else ""
