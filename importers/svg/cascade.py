"""The cascade: presentation attributes, style sheets and ``style`` attributes of one element, put in order."""

from __future__ import annotations

from typing import Any

from importers.svg.notes import Notes
from importers.svg.sheet import Sheet, matches_media
from importers.svg.style import PRESENTATION, Declared, parse_declaration, parse_inline

_NOTHING: Declared = {}


class Cascade:
    """Gives each element its declarations."""

    def __init__(self, root: Any, prefix: str, notes: Notes) -> None:
        texts = []
        for element in root.iter(prefix + "style"):
            kind = (element.get("type") or "text/css").strip().lower()
            media = " ".join((element.get("media") or "").lower().split())
            if kind in ("text/css", "") and matches_media(media):
                texts.append((element, "".join(element.itertext())))
            else:
                notes.count("css-skipped", "info", f"a style sheet for {media or kind} is left out", element)
        self._notes = notes
        self._element = texts[0][0] if texts else root
        self._sheet = Sheet((text for _, text in texts), root, self._report)

    def _report(self, code: str, message: str) -> None:
        self._notes.count(code, "warning", message, self._element, fix="write the style on the elements")

    def declared(self, element: Any) -> Declared:
        """Give the winning declarations of an element: property to parsed value, invalid ones left out."""
        attributes = element.attrib
        found: Declared = {}
        for name, text in attributes.items():
            if name in PRESENTATION:
                value = parse_declaration(name, text, "attribute")
                if value is not None:
                    found[name] = value
                elif name == "transform":
                    message = f"transform={text[:40]!r} is wrong, so none of it is used"
                    self._notes.add("bad-transform", "warning", message, element, attribute="transform")
        style = attributes.get("style")
        if self._sheet.empty and style is None:
            return found or _NOTHING
        rules = [] if self._sheet.empty else self._sheet.declarations(element)
        inline = parse_inline(style) if style is not None else ()
        for wanted in (False, True):
            for source in (rules, inline):
                found.update((name, value) for name, value, important in source if important is wanted)
        return found
