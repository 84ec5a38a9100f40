"""Illustrator's own copy of a drawing inside a PDF: the private stream, in the operators of the old files."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, NamedTuple

from importers.limits import MAX_STREAM_BYTES, Packing, limit_error
from importers.pdf.document import Document, get, is_stream

# What stands before the packed part, and how it is packed. Before the mark there may be a plain header.
_MARKS: tuple[tuple[bytes, Packing], ...] = (
    (b"%AI12_CompressedData", "zlib"),
    (b"%AI24_ZStandard_Data", "zstd"),
)
# More streams than this would hold more than the input may.
_MAX_BLOCKS = 100_000


class PrivateData(NamedTuple):
    """Illustrator's own data.

    Attributes:
        data: the operators, decoded.
        damage: what is wrong with them, or ``""``.
    """

    data: bytes
    damage: str


def read_private(document: Document, page: Any) -> PrivateData | None:
    """Put the private stream of a page together and decode it; None when the page has none.

    Where there is a place for such data, but nothing known in it, they are empty and damaged.

    Raises:
        LimitError: it stands for more than the limits allow.
    """
    private = get(get(get(page, "/PieceInfo"), "/Illustrator"), "/Private")
    if private is None:
        return None
    blocks: list[bytes] = []
    size = 0
    damage = ""
    for block in _blocks(private):
        data, wrong = document.decode(block)
        blocks.append(data)
        size += len(data)
        if size > MAX_STREAM_BYTES:
            limit = f"{MAX_STREAM_BYTES // 1_000_000} MB"
            raise limit_error("Illustrator's own data in a PDF", limit, file=document.file)
        damage = damage or wrong
    if not blocks:
        return PrivateData(b"", "they are kept in a way that is not known")
    data = b"".join(blocks)
    marks = [(data.find(mark), mark, packing) for mark, packing in _MARKS]
    found = [entry for entry in marks if entry[0] >= 0]
    if found:
        position, mark, packing = min(found)
        packed = data[position + len(mark) :].lstrip(b"\r\n")
        data, wrong = document.unpacker.unpack(packed, packing)
        damage = damage or wrong
    return PrivateData(data, damage)


def _blocks(private: Any) -> Iterator[Any]:
    """Go through the streams that hold the data, in order.

    An .ai has them under AIPrivateData1, 2 ..., a .pdf under AIPDFPrivateData1, 2 ...; or there is one stream alone.
    """
    for name in ("/AIPrivateData", "/AIPDFPrivateData"):
        if is_stream(get(private, f"{name}1")):
            for index in range(1, _MAX_BLOCKS):
                block = get(private, f"{name}{index}")
                if not is_stream(block):
                    return
                yield block
            return
    if is_stream(private):
        yield private
