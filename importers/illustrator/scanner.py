"""The bytes of an Illustrator file: its PostScript part, where its art begins, the shapes of its tokens."""

from __future__ import annotations

import re
import struct

from importers.illustrator.text import MAX_STRING_BYTES, string_end
from importers.limits import MAX_DEPTH

# Operands that are plain numbers, then an operator of one or two letters: nearly all that a file consists of.
# All may be missing, so it never fails, and no number is read twice.
NUMBERS_AND_OPERATOR = re.compile(
    rb"\s{0,200}((?:[-+.\deE]{1,40}\s{1,20}){0,8})(?:([A-Za-z]{1,2}|\*[uU]?)(?=[\s%\[(/]|\Z))?"
)
WHITE = re.compile(rb"[\s\x00]+")
WORD = re.compile(rb"[^\s\x00()<>\[\]{}/%]+")
NUMBER = re.compile(rb"[-+]?+(?:\d++\.?+\d*+|\.\d++)(?:[eE][-+]?+\d++)?+")
COMMENT = re.compile(rb"%[^\r\n]*")
# Lines of dictionaries hidden from PostScript, of which some files have a million; none names an object or ends one.
DULL_LINES = re.compile(
    rb"(?:%_(?!/XMLUID|%%BeginData)(?![^\r\n]*\(AIArtName\))(?:[^\r\n]*[,;:)\d])?[\r\n]++){1,5000}+"
)
LINE_END = re.compile(rb"\r\n|\r|\n")
BRACE = re.compile(rb"[{}%(]")
BEGIN_DATA = re.compile(rb"%(?:_%)?%BeginData:\s*+(\d{1,12})\s*+(\w*+)\s*+(\w*+)")
END_DATA = b"%%EndData"
# Blocks that hold no art wherever they stand: definitions, other people's files, PostScript programs.
BEGIN_BLOCK = re.compile(
    rb"%(?:AI\d+_|%)Begin(Pattern|Gradient|BrushPattern|Symbol|SymbolList|Palette|PluginObject|ArtStyles|ArtStyleList"
    rb"|DocumentData|TextDocument|SVGFilter|Document|ProcSet|Resource|Font|PageSetup|Prolog|Setup|Defaults|Preview"
    rb"|Feature|Encoding|Object|Binary)\b"
)

# A point is set, a layer named, a group opened: how every piece of Illustrator's text begins.
_OPERATORS = re.compile(
    rb"(?:\)\s{0,20}Ln|(?:\A|[\s\x00])(?:[-+.\deE]{1,40}\s{1,20}[-+.\deE]{1,40}\s{1,20}[mlL]|Lb|\*u))(?=\s|\Z)"
)
_ILLUSTRATOR_NOTE = re.compile(rb"(?:\A|[\r\n])%AI\d+_|Adobe_Illustrator|Adobe Illustrator")
_MARK_START = re.compile(rb"(?:\A|[\r\n])%(?:_%)?(?:AI\d+_|%)\Z")
_LOOK = 1 << 20  # bytes that are looked at to tell what a file is

_UTF8 = b"\xef\xbb\xbf"
_UTF16 = (b"\xff\xfe", b"\xfe\xff")
_DOS_EPS = b"\xc5\xd0\xd3\xc6"
_MARKERS = (b"%%EndSetup", b"%%EndProlog")
_PLACED_FILE = b"%%BeginDocument"  # has markers of its own


def find_note(data: bytes, note: bytes, start: int, stop: int) -> int:
    """Find a comment that begins its line; -1 when there is none. Searching bytes beats any regular expression."""
    position = data.find(note, start, stop)
    while position > 0 and data[position - 1] not in b"\r\n" and position != start:
        position = data.find(note, position + len(note), stop)
    return position


def is_operator_text(data: bytes) -> bool:
    """Tell by the content whether bytes are Illustrator's operators, and not just any PostScript or text."""
    start, stop = postscript_part(data)
    if data[start : start + 200].lstrip(b"\xef\xbb\xbf \t\r\n\x00")[:1] == b"<":
        return False
    if is_marked(data, start, stop):
        return True
    begin = art_start(data, start, stop)
    return _OPERATORS.search(data[begin : min(stop, begin + _LOOK)]) is not None


def is_marked(data: bytes, start: int, stop: int) -> bool:
    """Tell whether a file calls itself Illustrator's, or names Illustrator's procedures."""
    return _ILLUSTRATOR_NOTE.search(data, start, min(stop, start + (_LOOK >> 4))) is not None


def plain_bytes(data: bytes) -> bytes:
    """Give text that an editor has saved as UTF-16 as UTF-8; anything else as it is."""
    return data.decode("utf-16", "replace").encode() if data.startswith(_UTF16) else data


def postscript_part(data: bytes) -> tuple[int, int]:
    """Find the PostScript in a file: what the header of a DOS EPS says (it also holds a preview), else all of it.

    Returns:
        Start and stop, as positions in `data`.
    """
    if data.startswith(_DOS_EPS) and len(data) >= 12:
        start, length = struct.unpack_from("<II", data, 4)
        if start < len(data):
            return start, min(start + length, len(data))
        return 12, len(data)
    return (len(_UTF8) if data.startswith(_UTF8) else 0), len(data)


def art_start(data: bytes, start: int, stop: int) -> int:
    """Find where the art begins: after the setup, or the prolog, or at once when there is neither.

    Brushes, patterns and gradients are drawn with the same operators as art, but before this place. Adobe's
    prolog even holds ``%AI5_BeginLayer``, so layers mark nothing.
    """
    placed = find_note(data, _PLACED_FILE, start, stop)
    stop = placed if placed >= 0 else stop
    for marker in _MARKERS:
        position = find_note(data, marker, start, stop)
        if position >= 0:
            return position + len(marker)
    return start


def block_end(data: bytes, name: bytes, start: int, stop: int) -> int:
    """Find where the block `name` ends that began before `start`, blocks of that name within it included.

    Returns:
        The position after its end, or -1 when it has none.
    """
    depth = 1
    position = start
    while depth:
        end = _find_mark(data, b"End" + name, position, stop)
        if end < 0:
            return -1
        depth -= 1
        while (position := _find_mark(data, b"Begin" + name, position, end)) >= 0:
            depth += 1
            position += len(name)
            if depth > MAX_DEPTH:
                return -1
        position = end + 3 + len(name)
    return position


def _find_mark(data: bytes, mark: bytes, start: int, stop: int) -> int:
    """Find a mark such as ``EndPattern`` of a comment such as ``%AI3_EndPattern``; -1 when there is none."""
    position = data.find(mark, start, stop)
    while position >= 0:
        before = data[max(position - 12, 0) : position]
        if _MARK_START.search(before) and not data[position + len(mark) : position + len(mark) + 1].isalnum():
            break
        position = data.find(mark, position + len(mark), stop)
    return position


def braces_end(data: bytes, start: int, stop: int) -> int:
    """Find where the PostScript procedure ends that opens at `start`; -1 when it does not within a megabyte."""
    stop = min(stop, start + _LOOK)
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
            if depth > MAX_DEPTH:
                return -1
    return -1
