"""The cascade: presentation attributes, style sheets and ``style`` attributes of one element, put in order."""

from __future__ import annotations

import re
from typing import Any

from importers.limits import LETTERS_OF_A_STEP, Work, limit_error
from importers.problems import Severity
from importers.svg.declarations import Winners, fault_of, place_of, used, winners
from importers.svg.inheritance import Style, inherit
from importers.svg.media import matches_media
from importers.svg.notes import Notes
from importers.svg.sheet import Report, Sheet
from importers.svg.style import (
    INHERITED,
    PRESENTATION,
    SHORT,
    VARIABLES,
    Declared,
    Pending,
    parse_any_inline,
    parse_declaration,
    parse_inline,
    unset,
)
from importers.svg.variables import UnresolvedError, put_in, resolve_all

_NOTHING: Declared = {}
MAX_CSS = 1_000_000
STEPS_OF_A_LETTER = 6  # of CSS that only the slow parser can read
# Fonts put into a drawing are larger than all else in it, and say nothing of its outlines.
_FONT_FACE = re.compile(r"@font-face\s*+\{[^{}]*+\}", re.IGNORECASE)
_NONE = Winners({}, {})


class Cascade:
    """Gives each element its declarations.

    Attributes:
        told: how often these were more than its attributes tell: custom properties, or something to be said.
    """

    def __init__(self, root: Any, prefix: str, notes: Notes, work: Work) -> None:
        texts = []
        self.told = 0
        self._notes, self._work = notes, work
        self._letters = MAX_CSS
        for element in root.iter(prefix + "style"):
            kind = (element.get("type") or "text/css").strip().lower()
            media = " ".join((element.get("media") or "").lower().split())
            self._charge(len(media))
            if kind in ("text/css", "") and matches_media(media):
                texts.append((_FONT_FACE.sub(_only_lines, "".join(element.itertext())), element))
            else:
                notes.count("css-skipped", "info", f"a style sheet for {(media or kind)[:60]} is left out", element)
        self._inlines: dict[str, Winners] = {}
        self._kept: list[Style] = []
        self._styles: dict[tuple[int, tuple[tuple[str, Any], ...]], Style] = {}
        self._charge(sum(len(text) for text, _ in texts))
        self._sheet = Sheet([(text, _reporter(notes, element)) for text, element in texts], root, work)

    @property
    def has_sheet(self) -> bool:
        """There is a style sheet with a rule that may match."""
        return not self._sheet.empty

    def _say(self, code: str, severity: Severity, message: str, element: Any, attribute: str = "", at: int = 0) -> None:
        self.told += 1
        self._notes.add(code, severity, message, element, attribute=attribute, offset=at)

    def _charge(self, letters: int) -> None:
        """Count letters of CSS against their limit, and the steps that the slow parser takes."""
        self._letters -= letters
        if self._letters < 0:
            raise limit_error("characters of style sheets", f"{MAX_CSS:,}")
        self._work.charge("style sheets", STEPS_OF_A_LETTER * letters)

    def _inline(self, text: str) -> Winners:
        kept = self._inlines.get(text)
        if kept is None:
            self._work.charge("style attributes", len(text) // LETTERS_OF_A_STEP)
            found = parse_inline(text)
            if found is None:
                self._charge(len(text))
                found = parse_any_inline(text)
            kept = self._inlines[text] = winners(found)
        return kept

    def declared(
        self, element: Any, attributes: dict[str, str], around: Style, chain: tuple[Any, ...] = ()
    ) -> Declared:
        """Give the winning declarations of an element: property to parsed value, invalid ones left out.

        Args:
            element: in the file.
            attributes: of it.
            around: the style of what is around it, for its custom properties.
            chain: the targets of the ``use``s that it is seen through.
        """
        found = self._presented(element, attributes)
        style = attributes.get("style")
        if not self._sheet.empty or style is not None:
            matched = [] if self._sheet.empty else self._sheet.matches(element, chain[-1] if chain else None)
            inline = _NONE if style is None else self._inline(style)
            for name, (code, severity, message) in inline.faults:
                self._say(code, severity, f"{name} {message}", element, "style", place_of(name, style or ""))
            for rule in (*(one.normal for one in matched), inline.normal):
                found.update(rule)
            for rule in (*(one.important for one in matched), inline.important):
                found.update(rule)
        for name in found:
            if name[:2] == "--" or isinstance(found[name], Pending):
                return self._resolved(element, found, around)
        return found or _NOTHING

    def _presented(self, element: Any, attributes: dict[str, str]) -> Declared:
        """Give the declarations that are attributes."""
        found: Declared = {}
        for name, text in attributes.items():
            if name not in PRESENTATION:
                continue
            if len(text) >= SHORT:
                self._work.charge("long values", len(text))
            value = parse_declaration(name, text, "attribute")
            fault = fault_of(name, value)
            if fault is not None:
                message = f"{name}={text[:40]!r} {fault.message}"
                self._say(fault.code, fault.severity, message, element, name, getattr(value, "offset", 0))
            value = used(value)
            if value is not None:
                found[name] = value
        return found

    def _resolved(self, element: Any, found: Declared, around: Style) -> Declared:
        """Put custom properties in; a declaration that then is invalid is as if it were ``unset``."""
        self.told += 1
        own = {name: text for name, text in found.items() if name[:2] == "--"}
        variables = resolve_all(own, around.variables, self._work) if own else around.variables
        result: Declared = {}
        for name, value in found.items():
            if name in own:
                continue
            if isinstance(value, Pending):
                try:
                    text = put_in(value.text, variables, self._work)
                    value = parse_declaration(name, text, value.origin)
                except UnresolvedError:
                    value = None
                fault = fault_of(name, value)
                if fault is not None:
                    self._say(fault.code, fault.severity, f"{name} {fault.message}", element)
                value = used(value)
                value = unset(name) if value is None or isinstance(value, Pending) else value
            result[name] = value
        if own:
            result[VARIABLES] = variables
        return result

    def inherited(self, parent: Style, declared: Declared) -> Style:
        """Give an element's style; neighbours mostly look the same, so what was worked out is kept.

        Raises:
            NumberError: a font size is too large.
        """
        if not declared:
            return parent
        if VARIABLES in declared:
            self._kept.append(inherit(parent, declared))
            return self._kept[-1]
        # every style is kept, so its id is its own
        key = (id(parent), tuple([item for item in declared.items() if item[0] in INHERITED]))
        style = self._styles.get(key)
        if style is None:
            style = self._styles[key] = inherit(parent, declared)
        return style


def _only_lines(match: re.Match[str]) -> str:
    """Leave of a text its ends of lines, so that all behind it stays on its line."""
    return "\n" * match[0].count("\n")


def _reporter(notes: Notes, element: Any) -> Report:
    """Give what a sheet says things to; it holds no cascade, so that nothing waits for the cycle collector."""

    def report(code: str, severity: Severity, message: str, at: Any = None) -> None:
        if at is not None:
            notes.add_within(code, severity, message, element, at.source_line, at.source_column, at.name)
            return
        fix = "write the style on the elements" if severity == "warning" else ""
        notes.count(code, severity, message, element, fix=fix)

    return report
