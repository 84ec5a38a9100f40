"""Illustrator's operator text: versions 1 to 8, EPS, the programs that write the same, and pasted pieces of it."""

from __future__ import annotations

import hashlib
import re

from importers.drawing import Drawing
from importers.errors import DrawingError
from importers.findings import Findings
from importers.illustrator import findings, programs, scanner
from importers.illustrator.artboards import find_artboards
from importers.illustrator.private import PrivatePart, find_private
from importers.illustrator.reader import ArtReader
from importers.illustrator.text import alphabet, decode
from importers.limits import check_input_size
from importers.sources import Source

__all__ = ["looks_like_illustrator", "read_illustrator"]

_CREATOR = re.compile(rb"%%Creator:[ \t]*([^\r\n]{1,200})")
_APP_VERSION = re.compile(rb"%%AI8_CreatorVersion:[ \t]*(\d+)")
_LARGE_CANVAS = re.compile(rb"%AI24_LargeCanvasScale:[ \t]*(\d{1,9})")
_HEADER = 1 << 16  # bytes in which a header ends
_ILLUSTRATOR = re.compile(r"Adobe Illustrator\D*(\d+(?:\.\d+)?)?")


def looks_like_illustrator(data: bytes) -> bool:
    """Tell by the content whether bytes are Illustrator's operators, with a PostScript header or without one."""
    return scanner.is_operator_text(scanner.plain_bytes(data))


def read_illustrator(data: bytes, file: str = "") -> Drawing:
    """Read operator text: a whole file of versions 1 to 8, an EPS, or a piece of one as it comes from pasting.

    Points, y up, coordinates exactly as written. What the file calls hidden, locked, a guide or a clipping path
    is in the drawing and marked so.

    Args:
        data: the file.
        file: its name, for messages.

    Raises:
        DrawingError: it is not Illustrator's text, or a PostScript program with names or axes of its own.
        LimitError: it is larger or deeper than `importers.limits` allows.
    """
    check_input_size(len(data), file)
    sha256 = hashlib.sha256(data).hexdigest()
    data = scanner.plain_bytes(data)
    if not looks_like_illustrator(data):
        raise DrawingError(
            "this is no drawing that Illustrator or a program like it has written",
            code="not-a-drawing",
            fix="give an .ai, .eps, .pdf or .svg file, or text such as: 24 803 m 69 828 l",
            file=file,
        )
    start, stop = scanner.postscript_part(data)
    private = find_private(data, start, stop, file)
    if private is None:
        definitions = programs.find_definitions(data, start, stop, file)
        if definitions.foreign:
            raise programs.refusal(f"it defines {definitions.foreign} in a way of its own, and no program is run", file)
        art_start = scanner.art_start(data, start, stop)
        drawing = read_operators(Source(data), art_start, stop, file, definitions.movers)
        drawing.kind = kind_of(data, start)
    else:
        drawing = _read_private(private, file)
        drawing.kind = f"{kind_of(data, start)} (EPS with Illustrator's own data)"
    drawing.sha256 = sha256
    return drawing


def _read_private(private: PrivatePart, file: str) -> Drawing:
    """Read Illustrator's own data."""
    data, start, stop = private.data, private.start, private.stop
    source = Source(data, has_lines=not private.decoded)
    drawing = read_operators(source, scanner.art_start(data, start, stop), stop, file)
    if private.damage:
        notes = Findings()
        notes.add(findings.PRIVATE_DAMAGED, None, what=private.damage)
        drawing.problems[:0] = notes.problems(source)
    return drawing


def read_operators(source: Source, start: int, stop: int, file: str, movers: frozenset[bytes] = frozenset()) -> Drawing:
    """Read the operators between two positions into a Drawing.

    Args:
        source: the file.
        start: where they begin.
        stop: where they end.
        file: its name, for messages.
        movers: names that the file defines for what moves the axes.

    Raises:
        DrawingError: there are operators, but nothing is drawn with Illustrator's, or what is drawn is moved.
        LimitError: as for :func:`read_illustrator`.
    """
    art = ArtReader(source, start, stop, file, movers).read()
    if art.moved_by:
        raise programs.refusal(f"it moves, scales or turns what it draws ({art.moved_by}), and no program is run", file)
    if art.drew_nothing():
        raise programs.refusal("it has no drawing by Illustrator's own operators in it, and no program is run", file)
    scale = _LARGE_CANVAS.search(source.data, 0, min(start, _HEADER))
    if scale and scale.group(1) != b"1":
        art.findings.add(findings.LARGE_CANVAS, scale.start(), what=scale.group(1).decode())
    artboards = find_artboards(source.data, start)
    problems = art.findings.problems(source)
    return Drawing("pt", "up", art.layers, art.paths, problems, file=file, artboards=artboards)


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
    found = _ILLUSTRATOR.match(name)
    return f"Illustrator {found.group(1) or ''}".strip() if found else f"Illustrator operators by {name}"
