"""Annotations of a PDF page: drawn over it by viewers, no part of its content, and so left out; how many there are."""

from __future__ import annotations

from typing import Any

from importers.pdf.document import Document, get, is_dictionary, items, number, word

_MAX_ANNOTATIONS = 50_000
_HIDDEN, _NO_VIEW = 2, 32  # bits of /F
# What viewers draw with lines of their own where the file brings no picture of it.
_DRAWN = frozenset(
    ("/Square", "/Circle", "/Line", "/Polygon", "/PolyLine", "/Ink", "/Highlight", "/Underline", "/FreeText", "/Stamp")
)


def shown_annotations(document: Document, page: Any) -> list[str]:
    """List the kinds of the annotations that viewers show on a page, such as ``"Square"``.

    Raises:
        LimitError: there are more than references may be followed.
    """
    found: list[str] = []
    for annotation in items(get(page, "/Annots")):
        document.follow("annotations of a PDF", _MAX_ANNOTATIONS)
        if not is_dictionary(annotation):
            continue
        kind = word(get(annotation, "/Subtype"))
        flags = int(min(max(number(get(annotation, "/F")) or 0.0, 0.0), 1e9))
        pictured = is_dictionary(get(get(annotation, "/AP"), "/N"))
        if not flags & (_HIDDEN | _NO_VIEW) and kind != "/Popup" and (pictured or kind in _DRAWN):
            found.append(kind.removeprefix("/") or "nameless one")
    return found
