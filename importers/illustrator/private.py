"""Illustrator's own data in an EPS file since version 9, where the page itself is a PostScript program."""

from __future__ import annotations

import re
from typing import NamedTuple

from importers.filters import ascii85
from importers.limits import Packing, Unpacker

_BEGIN = re.compile(rb"(?<=[\r\n])%AI9_PrivateDataBegin")
_END = re.compile(rb"(?<=[\r\n])%AI9_PrivateDataEnd")
_STREAM = re.compile(rb"(?<=[\r\n])%AI(9|24)_DataStream[^\r\n]*")
_LINE_START = re.compile(rb"(?:\A|[\r\n]+)%?")


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
    begin = _BEGIN.search(data, start, stop)
    if begin is None:
        return None
    end = _END.search(data, begin.end(), stop)
    last = end.start() if end else stop
    stream = _STREAM.search(data, begin.end(), last)
    if stream is None:
        return PrivatePart(data, begin.end(), last, False, "")
    packed = ascii85(_LINE_START.sub(b"", data[stream.end() : last]))
    packing: Packing = "zstd" if packed.startswith(b"\x28\xb5\x2f\xfd") else "zlib"
    unpacked = Unpacker(file).unpack(packed, packing)
    return PrivatePart(unpacked.data, 0, len(unpacked.data), True, unpacked.damage)
