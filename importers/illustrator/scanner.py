"""The bytes of an Illustrator file: its PostScript part, where its art begins, the shapes of its tokens."""

from __future__ import annotations

import re
import struct

from importers.illustrator.text import MAX_STRING_BYTES, string_end

# Operands that are plain numbers, then an operator of one or two letters: nearly all that a file consists of.
# The bounds keep a hostile line from being read twice for each of its tokens.
NUMBERS_AND_OPERATOR = re.compile(
    rb"\s{0,200}((?:[-+.\deE]{1,40}\s{1,20}){0,8})([A-Za-z]{1,2}|\*[uU]?)(?=[\s%\[(/]|\Z)"
)
WHITE = re.compile(rb"[\s\x00]+")
WORD = re.compile(rb"[^\s\x00()<>\[\]{}/%]+")
NUMBER = re.compile(rb"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?")
COMMENT = re.compile(rb"%[^\r\n]*")
LINE_END = re.compile(rb"\r\n|\r|\n")
BRACE = re.compile(rb"[{}%(]")
BEGIN_DATA = re.compile(rb"%(?:_%)?%BeginData:\s*(\d{1,12})\s*(\w*)\s*(\w*)")
END_DATA = re.compile(rb"%(?:_%)?%EndData")
# Blocks that hold no art wherever they stand: definitions, other people's files, PostScript programs.
BEGIN_BLOCK = re.compile(
    rb"%(?:AI\d+_|%)Begin_?(Pattern|Gradient|BrushPattern|Symbol|SymbolList|Palette|PluginObject|ArtStyles|ArtStyleList"
    rb"|DocumentData|TextDocument|SVGFilter|Document|ProcSet|Resource|Font|PageSetup|Prolog|Setup|Defaults|Preview"
    rb"|Feature|Encoding|Object|Binary)\b"
)

# A point is set, a layer named, a group opened: how every piece of Illustrator's text begins.
_OPERATORS = re.compile(
    rb"(?:\)\s{0,20}Ln|(?:\A|[\s\x00])(?:[-+.\deE]{1,40}\s{1,20}[-+.\deE]{1,40}\s{1,20}[mlL]|Lb|\*u))(?=\s|\Z)"
)
_ILLUSTRATOR_NOTE = re.compile(rb"(?:\A|[\r\n])%AI\d+_|Adobe_Illustrator|Adobe Illustrator")
_LOOK = 1 << 20  # bytes that are looked at to tell what a file is

_DOS_EPS = b"\xc5\xd0\xd3\xc6"
_MARKERS = tuple(
    re.compile(rb"(?:\A|(?<=[\r\n]))" + marker + rb"(?=[\s\x00]|\Z)") for marker in (rb"%%EndSetup", rb"%%EndProlog")
)
_PLACED_FILE = re.compile(rb"(?<=[\r\n])%%BeginDocument\b")  # has markers of its own


def is_operator_text(data: bytes) -> bool:
    """Tell by the content whether bytes are Illustrator's operators, and not just any PostScript or text."""
    start, stop = postscript_part(data)
    if data[start : start + 200].lstrip(b"\xef\xbb\xbf \t\r\n\x00")[:1] == b"<":
        return False
    if _ILLUSTRATOR_NOTE.search(data, start, min(stop, start + (_LOOK >> 4))):
        return True
    begin = art_start(data, start, stop)
    return _OPERATORS.search(data, begin, min(stop, begin + _LOOK)) is not None


def postscript_part(data: bytes) -> tuple[int, int]:
    """Find the PostScript in a file: all of it, or what the header of a DOS EPS says (a preview picture follows).

    Returns:
        Start and stop, as positions in `data`.
    """
    if data.startswith(_DOS_EPS) and len(data) >= 12:
        start, length = struct.unpack_from("<II", data, 4)
        if start < len(data):
            return start, min(start + length, len(data))
        return 12, len(data)
    return 0, len(data)


def art_start(data: bytes, start: int, stop: int) -> int:
    """Find where the art begins: after the setup, or the prolog, or at once when there is neither.

    Brushes, patterns and gradients are drawn with the same operators as art, but before this place. Adobe's
    prolog even holds ``%AI5_BeginLayer``, so layers mark nothing.
    """
    placed = _PLACED_FILE.search(data, start, stop)
    stop = placed.start() if placed else stop
    for marker in _MARKERS:
        match = marker.search(data, start, stop)
        if match:
            return match.end()
    return start


def block_end(data: bytes, name: bytes, start: int, stop: int) -> int:
    """Find where the block `name` ends that began before `start`, blocks of that name within it included.

    Returns:
        The position after its end, or -1 when it has none.
    """
    depth = 1
    for match in re.compile(rb"(?<=[\r\n])%(?:_%)?(?:AI\d+_|%)(Begin|End)_?" + name + rb"\b").finditer(
        data, start, stop
    ):
        depth += 1 if match.group(1) == b"Begin" else -1
        if depth == 0:
            return match.end()
    return -1


def braces_end(data: bytes, start: int, stop: int) -> int:
    """Find where the PostScript procedure ends that opens at `start`; -1 when it does not."""
    depth = 0
    position = start
    while match := BRACE.search(data, position, stop):
        position = match.end()
        byte = match.group()
        if byte == b"%":
            comment = COMMENT.match(data, match.start(), stop)
            position = comment.end() if comment else stop
        elif byte == b"(":
            end = string_end(data, match.start(), stop)
            position = end if end > 0 else position + MAX_STRING_BYTES
        else:
            depth += 1 if byte == b"{" else -1
            if depth == 0:
                return position
    return -1
