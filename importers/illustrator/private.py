"""Illustrator's own data in an EPS file since version 9, where the page itself is a PostScript program."""

from __future__ import annotations

from typing import NamedTuple

from importers.filters import ascii85
from importers.illustrator.scanner import find_note
from importers.limits import Packing, Unpacker

_BEGIN = b"%AI9_PrivateDataBegin"
_END = b"%AI9_PrivateDataEnd"
_STREAMS = (b"%AI9_DataStream", b"%AI24_DataStream")


class PrivatePart(NamedTuple):
    """Where Illustrator's own data are.

    Attributes:
        data: the bytes that hold them: the file itself, or what a part of it was decoded to.
        start: where they begin in there.
        stop: where they end.
        decoded: they are not the file itself.
        damage: what is wrong with them, or ``""``.
    """

    data: bytes
    start: int
    stop: int
    decoded: bool
    damage: str


def find_private(data: bytes, start: int, stop: int, file: str = "") -> PrivatePart | None:
    """Find Illustrator's own data in an EPS file; None when it has none.

    They stand behind the page, as they are, or packed (zlib, since 2020 zstd) and in ASCII85 as comments.

    Raises:
        LimitError: they stand for more than the limits allow.
    """
    begin = find_note(data, _BEGIN, start, stop)
    if begin < 0:
        return None
    begin += len(_BEGIN)
    end = find_note(data, _END, begin, stop)
    last = end if end >= 0 else stop
    streams = [(find_note(data, mark, begin, last), mark) for mark in _STREAMS]
    found = [(position, mark) for position, mark in streams if position >= 0]
    if not found:
        return PrivatePart(data, begin, last, False, "")
    position, mark = min(found)
    text = data[position + len(mark) : last]
    for line_start in (b"\r\n%", b"\r%", b"\n%"):
        text = text.replace(line_start, b"")
    packed = ascii85(text, file)
    packing: Packing = "zstd" if packed.startswith(b"\x28\xb5\x2f\xfd") else "zlib"
    unpacked = Unpacker(file).unpack(packed, packing)
    return PrivatePart(unpacked.data, 0, len(unpacked.data), True, unpacked.damage)
