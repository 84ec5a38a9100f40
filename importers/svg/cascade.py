"""The cascade: presentation attributes, style sheets and ``style`` attributes of one element, put in order."""

from __future__ import annotations

import re
from typing import Any

from importers.limits import limit_error
from importers.problems import Severity
from importers.svg.notes import Notes
from importers.svg.sheet import Sheet, matches_media
from importers.svg.style import (
    PRESENTATION,
    Declared,
    Style,
    inherit,
    parse_any_inline,
    parse_declaration,
    parse_inline,
)

_NOTHING: Declared = {}
MAX_CSS = 1_000_000
# Fonts put into a drawing are larger than all else in it, and say nothing of its outlines.
_FONT_FACE = re.compile(r"@font-face\s*\{[^{}]*\}", re.IGNORECASE)


_NONE: tuple[Declared, Declared] = ({}, {})


def _by_importance(declarations: list[tuple[str, Any, bool]]) -> tuple[Declared, Declared]:
    """Give the normal and the important ones, each with what comes last winning."""
    normal = {name: value for name, value, important in declarations if not important}
    return normal, {name: value for name, value, important in declarations if important}


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
        self._css_left = MAX_CSS
        self._inlines: dict[str, tuple[Declared, Declared]] = {}
        self._styles: dict[tuple[int, tuple[tuple[str, Any], ...]], Style] = {}
        sheets = [_FONT_FACE.sub("", text) for _, text in texts]
        self._charge(sum(map(len, sheets)))
        self._sheet = Sheet(sheets, root, self._report)

    def _charge(self, characters: int) -> None:
        self._css_left -= characters
        if self._css_left < 0:
            raise limit_error("characters of style sheets", f"{MAX_CSS:,}")

    def _inline(self, text: str) -> tuple[Declared, Declared]:
        kept = self._inlines.get(text)
        if kept is None:
            found = parse_inline(text)
            if found is None:
                self._charge(len(text))
                found = parse_any_inline(text)
            kept = self._inlines[text] = _by_importance(found)
        return kept

    def _report(self, code: str, severity: Severity, message: str) -> None:
        fix = "write the style on the elements" if severity == "warning" else ""
        self._notes.count(code, severity, message, self._element, fix=fix)

    def declared(self, element: Any, attributes: dict[str, str], chain: tuple[Any, ...] = ()) -> Declared:
        """Give the winning declarations of an element: property to parsed value, invalid ones left out.

        Args:
            element: in the file.
            attributes: of it.
            chain: the targets of the ``use``s that it is seen through.
        """
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
        rules = (
            _NONE
            if self._sheet.empty
            else _by_importance(self._sheet.declarations(element, chain[-1] if chain else None))
        )
        inline = _NONE if style is None else self._inline(style)
        for declarations in (rules[0], inline[0], rules[1], inline[1]):
            if declarations:
                found.update(declarations)
        return found

    def inherited(self, parent: Style, declared: Declared) -> Style:
        """Give an element's style; neighbours mostly look the same, so what was worked out is kept."""
        if not declared:
            return parent
        key = (id(parent), tuple(declared.items()))  # every parent is kept here or by the walk
        style = self._styles.get(key)
        if style is None:
            style = self._styles[key] = inherit(parent, declared)
        return style
