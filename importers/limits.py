"""What a reader puts up with before it gives up: every limit by name, and the one bounded decompressor.

A hostile file of a few kilobytes can ask for gigabytes or hours. Each limit is far above what people draw and
low enough that the worst file costs less than 5 seconds and 512 MB. All of them raise LimitError, which names
the limit and its figure.
"""

from __future__ import annotations

import math
import zlib
from dataclasses import dataclass, field
from typing import Literal, NamedTuple

from importers.errors import LimitError

MAX_INPUT_BYTES = 64 * 1024 * 1024  # of one file, as it lies on disk
MAX_ELEMENTS = 1_000_000  # XML elements; in operator languages the segments, since those cost the memory
MAX_OPERATORS = 2_000_000  # that an operator language may take to say it, paint and attributes included
MAX_DEPTH = 256  # groups in groups, layers in layers, dictionaries in dictionaries
MAX_REFERENCES = 500_000  # followed `use`s and the like
MAX_VERTICES = 2_000_000  # of all walls together, once curves are lines
MAX_COORDINATE = 1e9  # |x| and |y|; beyond it doubles leave less than 1e-7 of a unit
MAX_NAME_LETTERS = 50_000_000  # that all paths bear together: their own and those of each group and layer around them

MAX_ENTITIES = 64  # internal ones of a document type; external ones are an error whatever their number
MAX_ENTITY_BYTES = 1024  # of one entity's replacement text

MAX_STREAM_BYTES = 75_000_000  # decoded, of one compressed stream
MAX_DECODED_BYTES = 256_000_000  # decoded, of all streams of a file together

# A step of work is about a microsecond of Python. What a file asks for beyond reading each of its parts once
# (copies, style sheets matched to elements, values worked out again) draws on MAX_STEPS; reading each part once is
# paid for by the parts themselves, so a large drawing is not refused for being large.
MAX_STEPS = 3_000_000
STEPS_OF_AN_ELEMENT = 60
LETTERS_OF_A_STEP = 4

Packing = Literal["zlib", "gzip", "zstd"]

_CHUNK = 1 << 18
_GZIP_MAGIC = b"\x1f\x8b"
_ZSTD_MAGIC = b"\x28\xb5\x2f\xfd"
# zlib.decompressobj's wbits: a zlib header, a gzip header
_WINDOW_BITS = {"zlib": 15, "gzip": 31}
# A zstd frame names the window that its decoder must keep; this is the largest that the format's own
# command-line tool accepts without being asked to.
_ZSTD_WINDOW = 1 << 27
# A zstd block of 4 bytes can stand for 128 KiB, and a decoder gives all that its input stands for: pieces of
# this size keep what comes back at once below 32 MiB.
_ZSTD_PIECE = 1 << 10


def limit_error(limit: str, figure: str, *, file: str = "", line: int | None = None, fix: str = "") -> LimitError:
    """Make the error for a limit that was hit.

    Args:
        limit: what is limited, such as ``"groups in groups"``.
        figure: the figure with its unit, such as ``"256"`` or ``"64 MiB"``.
        file: the file's name as the user gave it.
        line: where it was hit, from 1.
        fix: what to do about it.
    """
    return LimitError(
        f"limit hit: {limit}, at most {figure}",
        code="limit",
        fix=fix or "simplify the drawing or split it into several files",
        file=file,
        line=line,
    )


def check_input_size(size: int, file: str = "") -> None:
    """Raise LimitError when a file of `size` bytes is larger than MAX_INPUT_BYTES."""
    if size > MAX_INPUT_BYTES:
        raise limit_error("size of the input", f"{MAX_INPUT_BYTES // (1 << 20)} MiB", file=file)


def good_coordinate(value: float) -> bool:
    """Tell whether a coordinate is finite and within MAX_COORDINATE."""
    return math.isfinite(value) and abs(value) <= MAX_COORDINATE


@dataclass(slots=True, eq=False)
class Work:
    """The budget of work of one file: every loop over what the file holds draws on it, by what it does.

    Example:
        >>> work = Work("a.svg", letters=400, elements=2)
        >>> work.charge("copies", 1_000)
        >>> work.done, work.most
        (1000, 3000220)

    Attributes:
        file: the file's name, for messages.
        letters: of the file; LETTERS_OF_A_STEP of them pay for one step.
        elements: of the file; each pays for STEPS_OF_AN_ELEMENT.
        most: the steps that may be done.
        spent: the steps done so far, by what they were spent on.
        done: all of them together.
    """

    file: str = ""
    letters: int = 0
    elements: int = 0
    most: int = field(init=False)
    spent: dict[str, int] = field(default_factory=dict)
    done: int = 0

    def __post_init__(self) -> None:
        self.most = MAX_STEPS + self.letters // LETTERS_OF_A_STEP + STEPS_OF_AN_ELEMENT * self.elements

    def charge(self, what: str, steps: int) -> None:
        """Count steps that are about to be done.

        Args:
            what: they are spent on, for the error.
            steps: their number.

        Raises:
            LimitError: they are more than are left.
        """
        self.done += steps
        self.spent[what] = self.spent.get(what, 0) + steps
        if self.done > self.most:
            most = max(self.spent, key=self.spent.__getitem__)
            raise limit_error(f"steps of work, most of them on {most}", f"{self.most:,}", file=self.file)


class Unpacked(NamedTuple):
    """What a compressed stream held.

    Attributes:
        data: the decoded bytes, as far as they could be decoded.
        damage: what is wrong with the stream, ``""`` when it is whole.
    """

    data: bytes
    damage: str


@dataclass(slots=True, eq=False)
class Unpacker:
    """Decompresses the streams of one file and never makes more of them than the limits allow.

    Example:
        >>> import gzip
        >>> Unpacker().unpack(gzip.compress(b"<svg/>"), "gzip").data
        b'<svg/>'

    Attributes:
        file: the file's name, for messages.
        decoded: bytes handed out so far, of all streams together.
    """

    file: str = ""
    decoded: int = 0

    def unpack(self, packed: bytes, packing: Packing) -> Unpacked:
        """Decode one stream; what a damaged one gave before the damage is kept.

        Args:
            packed: the stream, possibly of several members or frames one after the other, possibly followed
                by other bytes.
            packing: how it is packed.

        Raises:
            LimitError: more than MAX_STREAM_BYTES in this stream, or MAX_DECODED_BYTES in all of them.
        """
        unpacked = self._unpack_zstd(packed) if packing == "zstd" else self._inflate(packed, packing)
        self.charge(len(unpacked.data))
        return unpacked

    def charge(self, size: int) -> None:
        """Count `size` decoded bytes against both limits (for streams that were decoded elsewhere)."""
        self._check(size)
        self.decoded += size

    def _check(self, size: int) -> None:
        """Raise LimitError when a stream has grown to `size` bytes and that is too many."""
        if size > MAX_STREAM_BYTES:
            raise limit_error(
                "decoded size of one compressed stream", f"{MAX_STREAM_BYTES // 1_000_000} MB", file=self.file
            )
        if self.decoded + size > MAX_DECODED_BYTES:
            raise limit_error(
                "decoded size of all compressed streams", f"{MAX_DECODED_BYTES // 1_000_000} MB", file=self.file
            )

    def _inflate(self, packed: bytes, packing: Packing) -> Unpacked:
        """Decode zlib, or the members of a gzip file."""
        out = bytearray()
        start = 0  # of the member
        while start < len(packed):
            decoder = zlib.decompressobj(_WINDOW_BITS[packing])
            position = start
            try:
                while position < len(packed) and not decoder.eof:
                    piece = packed[position : position + _CHUNK]
                    position += len(piece)
                    while piece and not decoder.eof:
                        out += decoder.decompress(piece, _CHUNK)
                        self._check(len(out))
                        piece = decoder.unconsumed_tail
            except zlib.error as error:
                return Unpacked(bytes(out), str(error))
            if not decoder.eof:
                return Unpacked(bytes(out), "the compressed data end too early")
            start = position - len(decoder.unused_data)
            if packing != "gzip" or packed[start : start + 2] != _GZIP_MAGIC:
                break
        return Unpacked(bytes(out), "" if packed else "there are no compressed data")

    def _unpack_zstd(self, packed: bytes) -> Unpacked:
        """Decode one zstd frame after the other."""
        import zstandard

        out = bytearray()
        rest = packed
        while rest:
            decoder = zstandard.ZstdDecompressor(max_window_size=_ZSTD_WINDOW).decompressobj()
            position = 0
            try:
                while position < len(rest) and not decoder.eof:
                    out += decoder.decompress(rest[position : position + _ZSTD_PIECE])
                    self._check(len(out))
                    position += _ZSTD_PIECE
            except zstandard.ZstdError as error:
                return Unpacked(bytes(out), str(error))
            if not decoder.eof:
                return Unpacked(bytes(out), "the compressed data end too early")
            rest = decoder.unused_data + rest[position:]
            if not rest.startswith(_ZSTD_MAGIC):
                break
        return Unpacked(bytes(out), "" if packed else "there are no compressed data")
