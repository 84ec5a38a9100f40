"""Illustrator's operator text: versions 1 to 8, EPS, the programs that write the same, and pasted pieces of it."""

from __future__ import annotations

import hashlib
import re

from importers.drawing import Drawing
from importers.errors import DrawingError
from importers.illustrator import scanner
from importers.illustrator.reader import ArtReader
from importers.illustrator.text import alphabet, decode
from importers.limits import check_input_size
from importers.sources import Source

__all__ = ["looks_like_illustrator", "read_illustrator"]

_CREATOR = re.compile(rb"%%Creator:[ \t]*([^\r\n]{1,200})")
_APP_VERSION = re.compile(rb"%%AI8_CreatorVersion:[ \t]*(\d+)")
_ILLUSTRATOR = re.compile(r"Adobe Illustrator.*?(\d+(?:\.\d+)?)\s*$")
# A point is set, or a layer named, or a group opened: how every piece of Illustrator text begins.
_OPERATORS = re.compile(
    rb"(?:\A|[\s\x00])(?:[-+.\deE]{1,40}\s{1,20}[-+.\deE]{1,40}\s{1,20}m|\)\s{0,20}Ln|Lb|\*u)(?=\s|\Z)"
)


def looks_like_illustrator(data: bytes) -> bool:
    """Tell by the content whether bytes are Illustrator's operators, with a PostScript header or without one."""
    if data.startswith((b"%!", b"\x04%!", b"\xc5\xd0\xd3\xc6")):
        return True
    head = data[: 1 << 20]
    return head.lstrip()[:1] != b"<" and _OPERATORS.search(head) is not None


def read_illustrator(data: bytes, file: str = "") -> Drawing:
    """Read operator text: a whole file of versions 1 to 8, an EPS, or a piece of one as it comes from pasting.

    Points, y up, coordinates exactly as written. What the file calls hidden, locked, a guide or a clipping path
    is in the drawing and marked so.

    Args:
        data: the file.
        file: its name, for messages.

    Raises:
        DrawingError: there is nothing in it that Illustrator would draw, and nothing that it would write.
        LimitError: it is larger or deeper than `importers.limits` allows.
    """
    check_input_size(len(data), file)
    start, stop = scanner.postscript_part(data)
    if not looks_like_illustrator(data):
        raise DrawingError(
            "this is no drawing that Illustrator or a program like it has written",
            code="not-a-drawing",
            fix="give an .ai, .eps, .pdf or .svg file, or text such as: 24 803 m 69 828 l",
            file=file,
        )
    drawing = read_operators(Source(data), scanner.art_start(data, start, stop), stop, file)
    drawing.kind = kind_of(data, start)
    drawing.sha256 = hashlib.sha256(data).hexdigest()
    return drawing


def read_operators(source: Source, start: int, stop: int, file: str) -> Drawing:
    """Read the operators between two positions into a Drawing."""
    art = ArtReader(source, start, stop, file).read()
    return Drawing("pt", "up", art.layers, art.paths, art.findings.problems(source), file=file)


def kind_of(data: bytes, start: int = 0) -> str:
    """Say what wrote operator text, such as ``"Illustrator 5.5"`` or ``"Illustrator operators by gnuplot"``."""
    head = data[start : start + 8192]
    version = _APP_VERSION.search(head)
    if version:
        return f"Illustrator {version.group(1).decode()}"
    creator = _CREATOR.search(head)
    if not creator:
        return "Illustrator operators"
    name = decode(creator.group(1), alphabet(head))
    found = _ILLUSTRATOR.search(name)
    return f"Illustrator {found.group(1)}" if found else f"Illustrator operators by {name}"
