"""SVG reader: a document as a browser renders it, to a Drawing."""

from __future__ import annotations

import hashlib
import re
from typing import TYPE_CHECKING, Any

from importers.collector import collector_paused
from importers.drawing import Drawing
from importers.errors import DrawingError, WallkitError
from importers.problems import Problem

if TYPE_CHECKING:
    from importers.svg.matrix import Matrix
    from importers.svg.source import Source

_SVG_TAG = re.compile(rb"<(?:[A-Za-z_][\w.-]*:)?svg[\s>/]")


def looks_like_svg(data: bytes) -> bool:
    """Tell whether bytes are an SVG document, in any encoding that XML allows (not gzipped)."""
    head = data
    if head[:2] in (b"\xff\xfe", b"\xfe\xff", b"<\x00", b"\x00<"):
        head = head.replace(b"\x00", b"")[2 if head[0] in (0xFE, 0xFF) else 0 :]
    head = head.removeprefix(b"\xef\xbb\xbf").lstrip()
    web_page = head[:14].lower() == b"<!doctype html" or head[:5].lower() == b"<html"
    return head.startswith(b"<") and not web_page and _SVG_TAG.search(head) is not None


def read_svg(data: bytes, file: str = "") -> Drawing:
    """Read an SVG document.

    Args:
        data: the file's bytes, not compressed.
        file: its name, for messages.

    Returns:
        The Drawing in CSS px of the outermost viewport, y down; what was left out is in its problems.

    Raises:
        DrawingError: it is not well-formed XML, not SVG, or reaches outside of itself.
        LimitError: it is larger, deeper or unfolds to more than importers.limits allows.
    """
    try:
        drawing = _read(data, file)
    except WallkitError as error:  # what is deep inside does not know the file's name
        error.file = error.file or file
        raise
    drawing.sha256 = hashlib.sha256(data).hexdigest()
    return drawing


def read_tree(data: bytes, file: str = "") -> tuple[Any, Matrix]:
    """Parse an SVG document for somebody who writes into it.

    Args:
        data: the file's bytes, not compressed.
        file: its name, for messages.

    Returns:
        Its outermost element (of lxml), and the matrix from that one's user units to the px of :func:`read_svg`.

    Raises:
        DrawingError, LimitError: as :func:`read_svg` does.
    """
    from importers.svg.reader import Reader

    source, _ = _parsed(data, file)
    return source.root, Reader(source).enter().matrix


def _parsed(data: bytes, file: str) -> tuple[Source, str]:
    """Parse it, and say what is wrong with its bytes."""
    from importers.svg.source import decode, parse

    text, damage = decode(data, file)
    source = parse(text, file)
    if source.root.tag.rpartition("}")[2] != "svg":
        tag = source.root.tag.rpartition("}")[2]
        fix = "give a file whose outermost element is svg"
        raise DrawingError(f"an XML file of <{tag}>, not SVG", code="not-a-drawing", fix=fix, file=file)
    return source, damage


def _read(data: bytes, file: str) -> Drawing:
    from importers.svg.reader import Reader

    source, damage = _parsed(data, file)
    with collector_paused():
        drawing = Reader(source).read()
    if damage:
        fix = "save the file as UTF-8; names may be wrong, outlines are not"
        drawing.problems.insert(0, Problem("bad-encoding", "warning", damage, fix))
    return drawing
