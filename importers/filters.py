"""The stream filters of PostScript and PDF besides Flate, each bounded: ASCII85, ASCIIHex, LZW and RunLength.

Old PDF files have LZW, EPS files by Illustrator have their own data in ASCII85; pikepdf decodes these too, but
without a bound on what comes out.
"""

from __future__ import annotations

import numpy as np

from importers.limits import MAX_STREAM_BYTES, limit_error

_NOT_ASCII85 = bytes(byte for byte in range(256) if not 33 <= byte <= 117 and byte != 0x7A)
_ASCII85_PIECE = 5 << 18
_POWERS_OF_85 = np.array([85**4, 85**3, 85**2, 85, 1], np.uint64)
_NOT_HEX = bytes(byte for byte in range(256) if byte not in b"0123456789ABCDEFabcdef")
_CLEAR, _END = 256, 257


def ascii_hex(data: bytes) -> bytes:
    """Decode pairs of hex digits up to ``>``; a missing last digit is 0."""
    digits = data.partition(b">")[0].translate(None, _NOT_HEX)
    return bytes.fromhex((digits + b"0" * (len(digits) % 2)).decode("ascii"))


def ascii85(data: bytes, file: str = "") -> bytes:
    """Decode groups of five letters to four bytes up to ``~>``; letters that are none are skipped.

    Raises:
        LimitError: more than MAX_STREAM_BYTES come out.
    """
    text = data.partition(b"~")[0].translate(None, _NOT_ASCII85)
    _check(len(text) * 4 // 5 + text.count(b"z") * 4, file)
    text = text.replace(b"z", b"!!!!!")
    padding = -len(text) % 5
    text += b"u" * padding
    out = bytearray()
    for start in range(0, len(text), _ASCII85_PIECE):
        letters = np.frombuffer(text, np.uint8, min(_ASCII85_PIECE, len(text) - start), start).reshape(-1, 5)
        values = (letters.astype(np.uint64) - np.uint64(33)) @ _POWERS_OF_85
        out += values.astype(">u4").tobytes()
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
