"""PostScript strings of Illustrator files: where they end, their escapes, and which alphabet their bytes are in."""

from __future__ import annotations

import re

# PostScript itself allows 65,535 bytes in a string.
MAX_STRING_BYTES = 65_535
_MAX_MARKS = 8_192  # parentheses and backslashes in a string, for the same reason: names are not that odd

_PLAIN = re.compile(rb"[^()\\]*")
_ESCAPE = re.compile(rb"\\(?:([0-7]{1,3})|(\r\n|\r|\n)|(.))", re.DOTALL)
_LETTERS = {b"n": b"\n", b"r": b"\r", b"t": b"\t", b"b": b"\b", b"f": b"\f"}


def string_end(data: bytes, start: int, stop: int) -> int:
    """Find where the string that opens at `start` ends.

    Args:
        data: the file.
        start: position of its opening parenthesis.
        stop: where the part to read ends.

    Returns:
        The position after its closing parenthesis, or -1 when there is none within the bounds above.
    """
    stop = min(stop, start + MAX_STRING_BYTES + 2)
    position = start + 1
    depth = 1
    for _ in range(_MAX_MARKS):
        match = _PLAIN.match(data, position, stop)
        position = match.end() if match else stop
        if position >= stop:
            return -1
        byte = data[position]
        if byte == 0x5C:  # a backslash takes the next byte with it
            position += 2
            continue
        depth += 1 if byte == 0x28 else -1
        position += 1
        if depth == 0:
            return position
    return -1


def unescape(raw: bytes) -> bytes:
    r"""Resolve the escapes of a string's bytes: ``\ooo``, ``\n`` and the like, a line end after ``\``."""
    if b"\\" not in raw:
        return raw

    def resolve(match: re.Match[bytes]) -> bytes:
        octal, line_end, letter = match.groups()
        if octal:
            return bytes([int(octal, 8) & 0xFF])
        return b"" if line_end else _LETTERS.get(letter, letter)

    return _ESCAPE.sub(resolve, raw)


def alphabet(data: bytes) -> str:
    """Decide which alphabet a file's old names are in, from what wrote it.

    Illustrator on a Mac wrote MacRoman and CR line ends, on Windows Latin-1 (with Windows' quotation marks) and
    CRLF. Files that went through other systems have LF: there the bytes themselves must tell (``""``).
    """
    head = data[:4096]
    if b"for Windows" in head:
        return "cp1252"
    if b"Macintosh" in head:
        return "mac_roman"
    feeds, returns = head.count(b"\n"), head.count(b"\r")
    if returns and not feeds:
        return "mac_roman"
    if returns and feeds == head.count(b"\r\n"):
        return "cp1252"
    return ""


def decode(raw: bytes, encoding: str) -> str:
    """Turn a string's bytes (escapes resolved) into text.

    Args:
        raw: the bytes.
        encoding: what :func:`alphabet` said of the file.
    """
    if raw.isascii():
        return _printable(raw.decode("ascii"))
    if raw.startswith((b"\xfe\xff", b"\xff\xfe")):
        return _printable(raw.decode("utf-16", "replace"))
    try:
        # Newer versions write UTF-8; text in the old alphabets is hardly ever valid UTF-8 by accident.
        return _printable(raw.decode("utf-8"))
    except UnicodeDecodeError:
        pass
    if not encoding:
        # Latin-1 has only control codes there; MacRoman has most of its accented letters.
        encoding = "mac_roman" if any(0x80 <= byte <= 0x9F for byte in raw) else "latin-1"
    return _printable(raw.decode(encoding, "replace"))


def _printable(text: str) -> str:
    """Put a space for control characters: a name is one line."""
    return "".join(char if char.isprintable() else " " for char in text).strip()
