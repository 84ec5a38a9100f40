"""Read any drawing: what a file is, is told by its content, never by its ending."""

from __future__ import annotations

import hashlib
import os
import sys
from pathlib import Path
from typing import IO, Any

from importers.drawing import Drawing
from importers.errors import DrawingError
from importers.limits import MAX_INPUT_BYTES, MAX_NAME_LETTERS, Unpacker, check_input_size, limit_error
from importers.page_background import note_background
from importers.page_choice import PageChoice, check_page, keep_artboard

_GZIP = b"\x1f\x8b"
_LETTERS_OF_A_LEVEL = 8  # what a group without a name costs
_SAVE = "save it as SVG or as Illustrator 8 from your drawing program"
_TRACE = "it holds pixels, not outlines: trace it in a drawing program and save that as SVG"
# What people give by mistake: how it begins, what it is, what to do.
_OTHERS: tuple[tuple[bytes, str, str], ...] = (
    (b"\x89PNG\r\n", "a PNG picture", _TRACE),
    (b"\xff\xd8\xff", "a JPEG picture", _TRACE),
    (b"GIF8", "a GIF picture", _TRACE),
    (b"BM", "a BMP picture", _TRACE),
    (b"II*\x00", "a TIFF picture", _TRACE),
    (b"MM\x00*", "a TIFF picture", _TRACE),
    (b"8BPS", "a Photoshop picture", _TRACE),
    (b"AC10", "an AutoCAD DWG drawing", _SAVE),
    (b"AutoCAD Binary DXF", "a binary DXF drawing", _SAVE),
    (b"\xd7\xcd\xc6\x9a", "a Windows metafile (WMF)", _SAVE),
    (b"\x01\x00\x00\x00", "a Windows metafile (EMF)", _SAVE),
    (b"FORM", "an IFF file", _SAVE),
    (b"PK\x03\x04", "a ZIP archive", "unpack it and give one of the drawings inside"),
    (b"\x28\xb5\x2f\xfd", "a zstd archive", "unpack it first"),
    (b"BZh", "a bzip2 archive", "unpack it first"),
    (b"\xfd7zXZ", "an xz archive", "unpack it first"),
    (b"{\\rtf", "an RTF text", "save it as plain text"),
    (b"\xd0\xcf\x11\xe0", "an old Microsoft Office file", _SAVE),
    (b"\x7fELF", "a program", "give a drawing"),
    (b"MZ", "a Windows program", "give a drawing"),
)


def read_drawing(source: str | os.PathLike[str] | IO[Any], *, page: PageChoice = None, via: str = "") -> Drawing:
    """Read a drawing: pasted Illustrator text, Illustrator of any version, EPS, PDF or SVG.

    Args:
        source: a path, ``"-"`` for standard input, or a file object, text or binary.
        page: which page or artboard, from 1, or ``"all"``: pages of a PDF then stand side by side. None takes the
            first page of a PDF, and what lies on all artboards of anything else.
        via: ``"ghostscript"`` lets Ghostscript, which must be installed, run PostScript and gives what it draws; it
            is bounded in time and memory and sees no other file. ``""`` runs no program.

    Raises:
        DrawingError: it is not there, cannot be read, has no such page, or is no drawing; the message says what
            it looks like.
        LimitError: it is larger than one of the limits in importers.limits.
    """
    if isinstance(source, str | os.PathLike):
        name = os.fspath(source)
        data = _read_stream(sys.stdin, "-") if name == "-" else _read_path(name)
        return read_drawing_text(data, name, page=page, via=via)
    if not hasattr(source, "read"):
        fix = "give a path or an open file; a text goes to read_drawing_text"
        raise DrawingError(f"source is a {type(source).__name__}", code="unreadable", fix=fix)
    name = getattr(source, "name", "")
    name = name if isinstance(name, str) else ""
    return read_drawing_text(_read_stream(source, name), name, page=page, via=via)


def read_drawing_text(text: str | bytes, file: str = "", *, page: PageChoice = None, via: str = "") -> Drawing:
    """Read a drawing that is at hand as text or bytes.

    Args:
        text: the drawing.
        file: what to call it in messages.
        page: which page or artboard, as for :func:`read_drawing`.
        via: by which program it is read, as for :func:`read_drawing`.

    Raises:
        DrawingError: it is no drawing; the message says what it looks like.
        LimitError: it is larger than one of the limits in importers.limits.
    """
    for name, value, kinds in (("text", text, (str, bytes, bytearray)), ("file", file, (str,))):
        if not isinstance(value, kinds):
            raise DrawingError(f"{name} is a {type(value).__name__}", code="unreadable", fix="give a text")
    if isinstance(text, str):
        text = _to_bytes(text.removeprefix("\ufeff"))
    check_input_size(len(text), file)
    check_page(page, file)
    drawing = _read_via(via, text, file, page) if via else _read_by_any(text, file, page)
    drawing.file = file
    check_names(drawing)
    note_background(drawing)
    drawing.sha256 = hashlib.sha256(text).hexdigest()
    return drawing


def check_names(drawing: Drawing) -> None:
    """Bound what paths say of themselves and of all that is around them, which each of them says anew.

    Raises:
        LimitError: it is more than MAX_NAME_LETTERS.
    """
    letters = 0
    known: dict[int, int] = {}  # of each level, by its id: neighbours share theirs
    for path in drawing.paths:
        letters += len(path.name) + len(path.layer) + len(path.title) + sum(map(len, path.groups))
        for level in path.levels:
            if id(level) not in known:
                known[id(level)] = _LETTERS_OF_A_LEVEL + len(level.name) + len(level.note) + _letters_of(level.tags)
            letters += known[id(level)]
        if letters > MAX_NAME_LETTERS:
            fix = "shorten the names of layers, groups and objects, or take groups apart"
            limit = "letters of names, those of groups and layers counted for each path in them"
            raise limit_error(limit, f"{MAX_NAME_LETTERS:,}", file=drawing.file, line=path.line, fix=fix)


def _letters_of(tags: dict[str, str]) -> int:
    return sum(len(key) + len(value) for key, value in tags.items())


def _read_by_any(data: bytes, file: str, page: PageChoice) -> Drawing:
    """Read by one of our readers, or where none fits by one of another package."""
    try:
        return _read_by_content(data, file, page)
    except DrawingError as error:
        if error.code != "not-a-drawing":
            raise
        from importers.other_packages import read_by_other_packages

        drawing = read_by_other_packages(data, file)
        if drawing is None:
            raise
        return drawing


def _to_bytes(text: str) -> bytes:
    """Encode a text; one that was decoded with surrogateescape gives its bytes back."""
    for errors in ("strict", "surrogateescape"):
        try:
            return text.encode("utf-8", errors)
        except UnicodeEncodeError:
            continue
    return text.encode("utf-8", "replace")


def _read_by_content(data: bytes, file: str, page: PageChoice) -> Drawing:
    from importers.svg import looks_like_svg, read_svg

    if data.startswith(_GZIP):
        data = _unpack(data, file)
    if not data.strip(b"\x00 \t\r\n\f"):
        raise DrawingError("the file is empty", code="empty-file", fix="give a drawing", file=file)
    for start, what, fix in _OTHERS:
        if data.startswith(start):
            raise _not_a_drawing(what, fix, file)
    if looks_like_svg(data):
        return _only(read_svg(data, file), page)
    if b"%PDF-" in data[:1024]:
        from importers.pdf import looks_like_pdf, read_pdf

        if looks_like_pdf(data):
            return read_pdf(data, file, page)
    from importers.illustrator import looks_like_illustrator, read_illustrator

    if looks_like_illustrator(data):
        return _only(read_illustrator(data, file), page)
    raise _unknown(data, file)


def _read_via(via: str, data: bytes, file: str, page: PageChoice) -> Drawing:
    """Read by way of another program."""
    if via != "ghostscript":
        fix = "give ghostscript, or nothing"
        raise DrawingError(f"no reader is called {via!r}", code="no-such-reader", fix=fix, file=file)
    from importers.ghostscript import read_through_ghostscript

    return read_through_ghostscript(data, file, page)


def _only(drawing: Drawing, page: PageChoice) -> Drawing:
    """Give what lies on one artboard of a drawing, when one is asked for."""
    if isinstance(page, int):
        keep_artboard(drawing, page)
    return drawing


def _unknown(data: bytes, file: str) -> DrawingError:
    """Say what a file that no reader takes looks like."""
    head = data[:4096].lstrip(b"\xef\xbb\xbf \t\r\n")
    words = head.split()
    if head.startswith(b"%!"):
        from importers.illustrator.programs import refusal

        return refusal("no program is run to find out what it draws", file)
    if words[:2] == [b"0", b"SECTION"] or words[:1] == [b"999"]:
        return _not_a_drawing("a DXF drawing", _SAVE, file)
    if head[:14].lower() == b"<!doctype html" or head[:5].lower() == b"<html":
        return _not_a_drawing("a web page", "save the drawing itself, not the page that shows it", file)
    if head.startswith(b"<"):
        return _not_a_drawing("an XML or HTML file without an svg element", _SAVE, file)
    if head.startswith((b"{", b"[")):
        return _not_a_drawing("JSON, but not one of wallkit's own formats", "give a drawing", file)
    if b"\x00" in head or sum(byte < 9 for byte in head) > 0:
        return _not_a_drawing("a binary file of no kind that is known", _SAVE, file)
    fix = 'give a drawing; Illustrator text has lines such as "24 803 m" and "69 828 l"'
    return _not_a_drawing("a text without any path", fix, file)


def _not_a_drawing(what: str, fix: str, file: str) -> DrawingError:
    return DrawingError(f"this is {what}", code="not-a-drawing", fix=fix, file=file)


def _unpack(data: bytes, file: str) -> bytes:
    unpacked = Unpacker(file).unpack(data, "gzip")
    if unpacked.damage:
        message = f"the gzipped file is damaged: {unpacked.damage}"
        raise DrawingError(message, code="bad-gzip", fix="copy or download it again", file=file)
    if unpacked.data.startswith(_GZIP):
        raise DrawingError("the file is gzipped twice", code="bad-gzip", fix="unpack it once", file=file)
    return unpacked.data


def _read_path(name: str) -> bytes:
    path = Path(name)
    try:
        if path.is_dir():
            raise DrawingError("this is a folder", code="unreadable", fix="give a file in it", file=name)
        with path.open("rb") as stream:
            return _read_stream(stream, name)
    except FileNotFoundError:
        message = "there is no such file"
        raise DrawingError(message, code="unreadable", fix=_near_names(path), file=name) from None
    except (OSError, ValueError) as error:  # a ValueError is a name with a zero character
        reason = getattr(error, "strerror", None) or str(error)
        fix = "check the name and the permissions"
        raise DrawingError(f"cannot be read: {reason}", code="unreadable", fix=fix, file=name) from None


def _near_names(path: Path) -> str:
    import difflib

    try:
        names = [entry.name for entry in path.parent.iterdir()][:2000]
    except OSError:
        return f"there is no folder {str(path.parent)!r} either" if not path.parent.exists() else "check the name"
    near = difflib.get_close_matches(path.name, names, n=1)
    return f"did you mean {str(path.parent / near[0])!r}?" if near else "check the name"


def _read_stream(stream: IO[Any], file: str) -> bytes:
    """Read all of a stream, but never more than one byte beyond the limit."""
    stream = getattr(stream, "buffer", stream)
    try:
        data = stream.read(MAX_INPUT_BYTES + 1)
    except UnicodeError:
        message = "the stream cannot be decoded"
        raise DrawingError(message, code="bad-encoding", fix="open it in binary mode", file=file) from None
    if isinstance(data, str):
        data = _to_bytes(data)
    check_input_size(len(data), file)
    return bytes(data)
