"""PDF drawings, and Illustrator files since version 9: a PDF around Illustrator's own data."""

from __future__ import annotations

import hashlib

from importers.drawing import Drawing
from importers.errors import DrawingError
from importers.findings import Findings
from importers.illustrator import findings as common
from importers.illustrator import kind_of, read_operators, scanner
from importers.limits import check_input_size
from importers.pdf import findings
from importers.pdf.content import PageReader
from importers.pdf.document import Document, Page, find_header, get, is_stream, items, number, word
from importers.pdf.layers import OptionalContent
from importers.pdf.private import read_private
from importers.problems import Problem
from importers.sources import Source

__all__ = ["looks_like_pdf", "read_pdf"]


def looks_like_pdf(data: bytes) -> bool:
    """Tell by the content whether bytes are a PDF, which newer Illustrator files are too."""
    return find_header(data) >= 0


def read_pdf(data: bytes, file: str = "") -> Drawing:
    """Read a PDF's first page, or the drawing as Illustrator itself keeps it in there.

    Illustrator's own data come first: they have what the page has not (hidden layers and objects, names, art
    outside the page), in the coordinates that Illustrator shows. Without them, or when nothing can be read from
    them, it is the page's content: points of the page's own space, y up, before any turning of the page.

    Args:
        data: the file.
        file: its name, for messages.

    Raises:
        DrawingError: it is encrypted, broken, or has no pages.
        LimitError: it is larger or deeper than `importers.limits` allows.
    """
    check_input_size(len(data), file)
    document = Document(data, file)
    try:
        page, pages = document.first_page()
        drawing = _read_page(document, page, file)
        drawing.problems.extend(_page_problems(page, pages))
    finally:
        document.close()
    drawing.sha256 = hashlib.sha256(data).hexdigest()
    return drawing


def _read_page(document: Document, page: Page, file: str) -> Drawing:
    """Read Illustrator's own data of a page, or its content."""
    private = read_private(document, page.dictionary)
    if private is None:
        producer = word(get(document.info, "/Creator")) or word(get(document.info, "/Producer"))
        return _read_content(document, page, file, f"PDF by {producer[:80]}" if producer else "PDF", "")
    source = Source(private.data, has_lines=False)
    start = scanner.art_start(private.data, 0, len(private.data))
    name = kind_of(private.data)
    try:
        drawing = read_operators(source, start, len(private.data), file)
    except DrawingError:
        drawing = Drawing("pt", "up")
    if not drawing.paths and not drawing.layers:
        why = f"Illustrator's own data cannot be read ({private.damage})" if private.damage else ""
        why = why or "there is no drawing in Illustrator's own data"
        return _read_content(document, page, file, f"{name} (page content)", why)
    drawing.kind = f"{name} (PDF with Illustrator's own data)"
    if private.damage:
        notes = Findings()
        notes.add(common.PRIVATE_DAMAGED, None, what=private.damage)
        drawing.problems[:0] = notes.problems(source)
    return drawing


def _read_content(document: Document, page: Page, file: str, kind: str, why: str) -> Drawing:
    """Read a page's content."""
    layers = OptionalContent(document)
    reader = PageReader(document, layers)
    if why:
        reader.findings.add(findings.PAGE_CONTENT, None, what=why)
    contents = page.get("/Contents")
    pieces = []
    for part in [contents] if is_stream(contents) else filter(is_stream, items(contents)):
        data, damage = document.decode(part)
        pieces.append(data)
        if damage:
            reader.findings.add(findings.STREAM, None, what=damage)
    reader.read(b"\n".join(pieces), page.get("/Resources"))
    problems = reader.findings.problems(Source(b"", has_lines=False))
    return Drawing("pt", "up", layers.layers, reader.paths, problems, kind=kind, file=file)


def _page_problems(page: Page, pages: int) -> list[Problem]:
    """Say what the page does that coordinates do not show."""
    notes = Findings()
    unit = number(page.get("/UserUnit"))
    if unit is not None and unit != 1:
        notes.add(findings.USER_UNIT, None, what=f"{unit:g}")
    turn = number(page.get("/Rotate"))
    if turn:
        notes.add(findings.ROTATED, None, what=f"{turn:g}")
    if pages > 1:
        notes.add(common.PAGES, None, count=pages - 1)
    return notes.problems(Source(b"", has_lines=False))
