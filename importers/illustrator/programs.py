"""Programs in PostScript that look like Illustrator's text: their own procedures bear the names of its operators.

cairo, pdftops, Ghostscript, matplotlib, fig2dev, LibreOffice and many more define m, l and c by moveto, lineto and
curveto, and beside them what moves, turns and closes. Read as Illustrator's operators such a file has walls in wrong
places, so it is none: only Illustrator's own language, where nothing moves what is drawn, is read here.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import NamedTuple

from importers.errors import DrawingError
from importers.illustrator.scanner import block_end, braces_end, is_marked
from importers.limits import limit_error

# A name and the procedure that it is to stand for, or another name for what is there already.
_DEFINITION = re.compile(rb"/([^\s\x00()<>\[\]{}/%]{1,40})\s{0,40}(?:(\{)|/?(moveto|lineto|curveto|concat)\b)")
_MAX_DEFINITIONS = 100_000
_BODY = 2000  # bytes of a procedure that are looked at
_BLOCK = re.compile(rb"%%Begin(ProcSet|Resource)\b[^\r\n]{0,200}")
_ADOBE = b"Adobe_"
# What a procedure for a path operator may do without moving anything.
_PLAIN = frozenset(
    b"moveto lineto curveto currentpoint roll copy bind load exch pop newpath m l L c C v V y Y mo li cv".split()
)
_PATH_NAMES = frozenset((b"m", b"l", b"L", b"c", b"C", b"v", b"V", b"y", b"Y"))
_FOREIGN_NAMES = frozenset((b"re", b"cm", b"rlineto", b"rectangle"))  # of other languages with the same m, l and c
_WORD = re.compile(rb"[A-Za-z_][^\s\x00()<>\[\]{}/%]*")
MOVERS = frozenset(b"translate scale rotate concat cm setmatrix initmatrix".split())


class Definitions(NamedTuple):
    """What a file defines outside of Adobe's own procedures.

    Attributes:
        foreign: a name that it gives a meaning that Illustrator does not know, or ``""``.
        movers: names of its own that move, scale or turn what follows.
    """

    foreign: str
    movers: frozenset[bytes]


def find_definitions(data: bytes, start: int, stop: int, file: str = "") -> Definitions:
    """Look through a file's definitions; a text that nobody calls Illustrator's may have none at all.

    Raises:
        LimitError: there are more than any program has.
    """
    marked = is_marked(data, start, stop)
    movers = set()
    for count, (name, body) in enumerate(_definitions(data, start, stop)):
        if count >= _MAX_DEFINITIONS:
            raise limit_error("definitions of a PostScript program", f"{_MAX_DEFINITIONS:,}", file=file)
        words = frozenset(_WORD.findall(body))
        if not marked or name in _FOREIGN_NAMES or (name in _PATH_NAMES and not words <= _PLAIN):
            return Definitions(name.decode("latin-1"), frozenset())
        if words & MOVERS:
            movers.add(name)
    return Definitions("", frozenset(movers))


def _definitions(data: bytes, start: int, stop: int) -> Iterator[tuple[bytes, bytes]]:
    """Go through names and the beginnings of their procedures, those in blocks of Adobe's own left out."""
    blocks = _adobe_blocks(data, start, stop)
    block = next(blocks, None)
    for match in _DEFINITION.finditer(data, start, stop):
        place = match.start()
        while block is not None and block[1] <= place:
            block = next(blocks, None)
        if block is None or place < block[0]:
            following = _DEFINITION.search(data, match.end(), min(stop, match.end() + _BODY))
            end = following.start() if following else min(stop, match.end() + _BODY)
            closed = braces_end(data, match.start(2), end) if match.group(2) else -1
            body = data[match.end() : closed if closed > 0 else end]
            yield match.group(1), body if match.group(2) else match.group(3)


def _adobe_blocks(data: bytes, start: int, stop: int) -> Iterator[tuple[int, int]]:
    """Go through the places where Adobe's own procedures stand."""
    endless: set[bytes] = set()
    position = start
    while match := _BLOCK.search(data, position, stop):
        position = match.end()
        name = match.group(1)
        if _ADOBE in match.group() and name not in endless:
            end = block_end(data, name, position, stop)
            if end > 0:
                yield match.start(), end
                position = end
            else:
                endless.add(name)


def refusal(why: str, file: str) -> DrawingError:
    """Make the error for a program.

    Args:
        why: what makes it one, as the end of a sentence.
        file: its name, for the advice.
    """
    name = file if file not in ("", "-") else "drawing.eps"
    return DrawingError(
        f"the file is a PostScript program: {why}",
        code="postscript-program",
        fix=f"let Ghostscript run it and give the PDF: {convert_command(name)}; or add --via ghostscript",
        file=file,
    )


def convert_command(name: str) -> str:
    """Give the command that turns a PostScript program into a PDF with the same paths."""
    import shlex
    from pathlib import PurePath

    result = PurePath(name).with_suffix(".pdf").name if name.strip("./\\") else "drawing.pdf"
    return f"gs -q -dSAFER -dEPSCrop -sDEVICE=pdfwrite -o {shlex.quote(result)} {shlex.quote(name)}"
