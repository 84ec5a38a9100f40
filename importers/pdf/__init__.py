"""PDF drawings, and Illustrator files since version 9: a PDF around Illustrator's own data."""

from __future__ import annotations

import hashlib
from collections.abc import Callable
from dataclasses import replace
from itertools import islice

from importers.drawing import Artboard, Drawing
from importers.errors import DrawingError
from importers.findings import Findings
from importers.illustrator import findings as common
from importers.illustrator import kind_of, read_operators, scanner
from importers.limits import MAX_STREAM_BYTES, check_input_size, good_coordinate, limit_error
from importers.page_choice import PageChoice, check_page, keep_artboard, no_such_page
from importers.pdf import findings
from importers.pdf.annotations import shown_annotations
from importers.pdf.content import PageReader
from importers.pdf.document import Document, Page, find_header, get, is_stream, items, number, word
from importers.pdf.layers import OptionalContent
from importers.pdf.private import read_private
from importers.problems import Problem
from importers.sources import Source

__all__ = ["looks_like_pdf", "read_pdf"]


Origin = Callable[[tuple[float, float, float, float]], tuple[float, float]]

_MAX_STREAMS = 100_000  # that a page's content is cut into


def looks_like_pdf(data: bytes) -> bool:
    """Tell by the content whether bytes are a PDF, which newer Illustrator files are too."""
    return find_header(data) >= 0


def read_pdf(data: bytes, file: str = "", page: PageChoice = None, *, origin: Origin | None = None) -> Drawing:
    """Read a page of a PDF, or the drawing as Illustrator itself keeps it in there.

    Illustrator's own data come first: they have what the page has not (hidden layers and objects, names, art
    outside the page), in the coordinates that Illustrator shows, on all artboards. Without them, or when nothing
    can be read from them, it is the page's content: points of the page's own space, y up, before any turning of
    the page.

    Args:
        data: the file.
        file: its name, for messages.
        page: which page or artboard, from 1; ``"all"`` puts pages side by side, from left to right. None takes the
            first page of a PDF and all artboards of Illustrator's own data.
        origin: tells from a page's box by how much its content is to be moved.

    Raises:
        DrawingError: it is encrypted, broken, has no pages or not that one.
        LimitError: it is larger or deeper than `importers.limits` allows.
    """
    check_input_size(len(data), file)
    check_page(page, file)
    document = Document(data, file)
    try:
        drawing = _read_document(document, page, origin)
    finally:
        document.close()
    drawing.file = file
    drawing.sha256 = hashlib.sha256(data).hexdigest()
    return drawing


def _read_document(document: Document, choice: PageChoice, origin: Origin | None) -> Drawing:
    """Read Illustrator's own data of the first page, or the content of those pages that are asked for."""
    first = next(document.pages(), None)
    if first is None:
        raise DrawingError("the PDF has no pages", code="no-pages", fix="export the drawing again", file=document.file)
    drawing, kind, why = _read_own_data(document, first)
    if drawing is not None:
        if isinstance(choice, int):
            keep_artboard(drawing, choice)
        drawing.problems.extend(_page_problems([first], 1))
        return drawing
    if choice is None or choice == 1:
        pages = [first]
    elif choice == "all":
        pages = [*document.pages()]
    else:
        pages = [*islice(document.pages(), choice - 1, choice)]
        if not pages:
            raise no_such_page(choice, sum(1 for _ in document.pages()), document.file)
    drawing = _read_content(document, pages, why, origin)
    drawing.kind, drawing.page = kind, choice if isinstance(choice, int) else None
    drawing.problems.extend(_page_problems(pages, document.page_count() if choice is None else 1))
    return drawing


def _read_own_data(document: Document, page: Page) -> tuple[Drawing | None, str, str]:
    """Read Illustrator's own data of a page.

    Returns:
        The drawing, or None; then what the file is to be called, and why its own data are not what is read.
    """
    private = read_private(document, page.dictionary)
    if private is None:
        producer = word(get(document.info, "/Creator")) or word(get(document.info, "/Producer"))
        return None, f"PDF by {producer[:80]}" if producer else "PDF", ""
    source = Source(private.data, has_lines=False)
    start = scanner.art_start(private.data, 0, len(private.data))
    name = kind_of(private.data)
    try:
        drawing = read_operators(source, start, len(private.data), document.file)
    except DrawingError:
        drawing = Drawing("pt", "up")
    if not drawing.paths and not drawing.layers:
        why = f"Illustrator's own data cannot be read ({private.damage})" if private.damage else ""
        return None, f"{name} (page content)", why or "there is no drawing in Illustrator's own data"
    drawing.kind = f"{name} (PDF with Illustrator's own data)"
    if private.damage:
        notes = Findings()
        notes.add(common.PRIVATE_DAMAGED, None, what=private.damage)
        drawing.problems[:0] = notes.problems(source)
    return drawing, drawing.kind, ""


def _read_content(document: Document, pages: list[Page], why: str, origin: Origin | None) -> Drawing:
    """Read the content of pages; each after the first begins where the one before it ends on the right."""
    layers = OptionalContent(document)
    reader = PageReader(document, layers)
    if why:
        reader.findings.add(findings.PAGE_CONTENT, None, what=why)
    artboards: list[Artboard] = []
    for index, page in enumerate(pages):
        box = _media_box(page)
        x, y = origin(box) if origin else (0.0, 0.0)
        if artboards:
            x = artboards[-1].x_max - box[0]
        artboards.append(Artboard(f"page {index + 1}", box[0] + x, box[1] + y, box[2] + x, box[3] + y))
        reader.read(_contents(document, page, reader.findings), page.get("/Resources"), index=index, move=(x, y))
        kinds = shown_annotations(document, page.dictionary)
        if kinds:
            reader.findings.add(findings.ANNOTATION, None, what=kinds[0], count=len(kinds))
    problems = reader.findings.problems(Source(b"", has_lines=False))
    drawing = Drawing("pt", "up", layers.layers, reader.paths, problems)
    drawing.artboards = artboards if len(artboards) > 1 else []
    drawing.sheet = replace(artboards[0], x_max=artboards[-1].x_max, y_max=max(board.y_max for board in artboards))
    return drawing


def _contents(document: Document, page: Page, notes: Findings) -> bytes:
    """Put the streams of a page's content together; one that is named often is decoded once."""
    contents = page.get("/Contents")
    decoded: dict[tuple[int, int], bytes] = {}
    pieces: list[bytes] = []
    size = 0
    for part in [contents] if is_stream(contents) else items(contents):
        document.follow("streams of a page's content", _MAX_STREAMS)
        if not is_stream(part):
            continue
        if part.objgen not in decoded:
            decoded[part.objgen], damage = document.decode(part)
            if damage:
                notes.add(findings.STREAM, None, what=damage)
        pieces.append(decoded[part.objgen])
        size += len(pieces[-1])
        if size > MAX_STREAM_BYTES:
            limit = f"{MAX_STREAM_BYTES // 1_000_000} MB"
            raise limit_error("content of a page", limit, file=document.file)
    return b"\n".join(pieces)


def _media_box(page: Page) -> tuple[float, float, float, float]:
    """Give left, bottom, right and top of a page; US letter, as viewers do, for one that says nothing sensible."""
    numbers = [number(part) for part in islice(items(page.get("/MediaBox")), 4)]
    x1, y1, x2, y2 = ([part for part in numbers if part is not None and good_coordinate(part)] + [0.0] * 4)[:4]
    box = min(x1, x2), min(y1, y2), max(x1, x2), max(y1, y2)
    return box if box[0] < box[2] and box[1] < box[3] else (0.0, 0.0, 612.0, 792.0)


def _page_problems(pages: list[Page], count: int) -> list[Problem]:
    """Say what pages do that coordinates do not show."""
    notes = Findings()
    for page in pages:
        unit = number(page.get("/UserUnit"))
        if unit is not None and unit != 1:
            notes.add(findings.USER_UNIT, None, what=f"{unit:g}")
        turn = number(page.get("/Rotate"))
        if turn:
            notes.add(findings.ROTATED, None, what=f"{turn:g}")
    if count > 1:
        notes.add(common.PAGES, None, count=count - 1)
    return notes.problems(Source(b"", has_lines=False))
