"""The stream filters of PostScript and PDF besides Flate, each bounded: ASCII85, ASCIIHex, LZW and RunLength.

Old PDF files have LZW, EPS files by Illustrator have their own data in ASCII85; pikepdf decodes these too, but
without a bound on what comes out.
"""

from __future__ import annotations

import re

from importers.limits import MAX_STREAM_BYTES, limit_error

_SPACE = re.compile(rb"[\s\x00]+")
_NOT_HEX = re.compile(rb"[^0-9A-Fa-f]+")
_CLEAR, _END, _FIRST_CODE = 256, 257, 258


def ascii_hex(data: bytes) -> bytes:
    """Decode pairs of hex digits up to ``>``; a missing last digit is 0."""
    digits = _NOT_HEX.sub(b"", data.partition(b">")[0])
    return bytes.fromhex((digits + b"0" * (len(digits) % 2)).decode("ascii"))


def ascii85(data: bytes) -> bytes:
    """Decode groups of five letters to four bytes up to ``~>``; letters that are none are skipped."""
    text = _SPACE.sub(b"", data.partition(b"~")[0])
    text = text.removeprefix(b"<").replace(b"z", b"!!!!!")
    text = bytes(byte for byte in text if 33 <= byte <= 117)
    padding = -len(text) % 5
    text += b"u" * padding
    out = bytearray()
    for start in range(0, len(text), 5):
        value = 0
        for byte in text[start : start + 5]:
            value = value * 85 + byte - 33
        out += (value & 0xFFFFFFFF).to_bytes(4, "big")
    return bytes(out[: len(out) - padding]) if padding else bytes(out)


def run_length(data: bytes, file: str = "") -> bytes:
    """Decode runs: n < 128 copies n + 1 bytes, n > 128 repeats the next byte 257 - n times, 128 ends.

    Raises:
        LimitError: more than MAX_STREAM_BYTES come out.
    """
    out = bytearray()
    position = 0
    while position < len(data) and data[position] != 128:
        count = data[position]
        if count < 128:
            out += data[position + 1 : position + 2 + count]
            position += 2 + count
        else:
            out += data[position + 1 : position + 2] * (257 - count)
            position += 2
        _check(len(out), file)
    return bytes(out)


def lzw(data: bytes, *, early: bool = True, file: str = "") -> bytes:
    """Decode LZW with codes of 9 to 12 bits, most significant bit first.

    Args:
        data: the codes; what follows an impossible code is not read.
        early: codes grow one code early (PDF's default, ``/EarlyChange 1``).
        file: the file's name, for the error.

    Raises:
        LimitError: more than MAX_STREAM_BYTES come out.
    """
    single = [bytes((byte,)) for byte in range(256)]
    table = [*single, b"", b""]
    out = bytearray()
    before = b""
    bits = width = 0
    size = 9
    for byte in data:
        bits = (bits << 8 | byte) & 0xFFFFF
        width += 8
        if width < size:
            continue
        width -= size
        code = bits >> width & ((1 << size) - 1)
        if code == _END:
            break
        if code == _CLEAR:
            table = [*single, b"", b""]
            before, size = b"", 9
            continue
        if code < len(table):
            entry = table[code]
        elif before and code == len(table):
            entry = before + before[:1]
        else:
            break
        out += entry
        _check(len(out), file)
        if before and len(table) < 4096:
            table.append(before + entry[:1])
        before = entry
        size = min(max((len(table) + early).bit_length(), 9), 12)
    return bytes(out)


def _check(size: int, file: str) -> None:
    """Raise LimitError when a stream has grown too large."""
    if size > MAX_STREAM_BYTES:
        raise limit_error("decoded size of one compressed stream", f"{MAX_STREAM_BYTES // 1_000_000} MB", file=file)
