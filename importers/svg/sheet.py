"""Style sheets in the file: which declarations the rules of its ``<style>`` elements give to an element."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable
from typing import Any

import cssselect2
import tinycss2

from importers.svg.style import known_declarations
from importers.svg.units import ROOT_FONT, WINDOW, parse_length, to_px

# code, what is left out; called once for each thing in a sheet that is not followed
Report = Callable[[str, str], None]

_FEATURE = re.compile(r"\((min-|max-)?(width|height):\s*([^()]+)\)")
# What headless browsers answer, as far as drawings ask
_TRUE = frozenset(
    (
        "all",
        "screen",
        "only screen",
        "only all",
        "not print",
        "(prefers-color-scheme: light)",
        "(orientation: landscape)",
        "(prefers-reduced-motion: no-preference)",
        "(scripting: enabled)",
    )
)


def matches_media(query: str) -> bool:
    """Tell whether a media query holds on the screen that lengths in ``vw`` and ``vh`` assume; doubt is no."""
    if not query.strip():
        return True
    return any(all(_holds(part) for part in one.strip().split(" and ")) for one in query.split(","))


def _holds(part: str) -> bool:
    match = _FEATURE.fullmatch(part.strip())
    if match is None:
        return part.strip() in _TRUE
    terms = parse_length(match[3].strip(), False)
    if terms is None:
        return False
    size, wanted = WINDOW[0 if match[2] == "width" else 1], to_px(terms, 0.0, ROOT_FONT)
    return size >= wanted if match[1] == "min-" else (size <= wanted if match[1] == "max-" else size == wanted)


class Sheet:
    """The rules of all style sheets of a file, matched against its elements.

    Elements are matched where they stand in the file: an instance that ``use`` makes has the rules of its
    original, as in browsers.
    """

    def __init__(self, texts: Iterable[str], root: Any, report: Report) -> None:
        self._matcher = cssselect2.Matcher()
        self._wrappers: dict[Any, Any] | None = None
        self._root = root
        self.empty = True
        self._namespaces: dict[str | None, str] = {}
        for text in texts:
            self._add(text, report)

    def _add(self, text: str, report: Report) -> None:
        rules = tinycss2.parse_stylesheet(text, skip_comments=True, skip_whitespace=True)
        pending = list(reversed(rules))
        while pending:
            rule = pending.pop()
            if rule.type == "qualified-rule":
                self._add_rule(rule, report)
            elif rule.type == "at-rule":
                pending.extend(reversed(self._at_rule(rule, report)))
            elif rule.type == "error":
                report("bad-css", f"a part of a style sheet cannot be read: {rule.message}")

    def _at_rule(self, rule: Any, report: Report) -> list[Any]:
        keyword = rule.lower_at_keyword
        if keyword == "media" and rule.content is not None:
            query = " ".join(tinycss2.serialize(rule.prelude).split()).lower()
            if matches_media(query):
                return list(tinycss2.parse_rule_list(rule.content, skip_comments=True, skip_whitespace=True))
            report("css-skipped", f"the rules of @media {query} are left out")
        elif keyword == "namespace":
            self._add_namespace(rule)
        elif keyword == "import":
            report("css-skipped", "@import is not followed: no other file is read")
        elif keyword not in ("font-face", "charset", "keyframes", "-webkit-keyframes", "page"):
            report("css-skipped", f"@{keyword} is left out")
        return []

    def _add_namespace(self, rule: Any) -> None:
        parts = [token for token in rule.prelude if token.type in ("ident", "string", "url")]
        if parts and parts[-1].type != "ident":
            self._namespaces[parts[0].value if len(parts) == 2 else None] = parts[-1].value

    def _add_rule(self, rule: Any, report: Report) -> None:
        declarations = []
        for node in tinycss2.parse_blocks_contents(rule.content, skip_comments=True, skip_whitespace=True):
            if node.type == "declaration":
                declarations += known_declarations(node, "sheet")
        if not declarations:
            return
        try:
            selectors = cssselect2.compile_selector_list(rule.prelude, namespaces=self._namespaces)
        except (cssselect2.SelectorError, NotImplementedError):
            report("css-skipped", f"the selector {tinycss2.serialize(rule.prelude).strip()!r} is not understood")
            return
        for selector in selectors:
            if selector.pseudo_element is None:
                self._matcher.add_selector(selector, declarations)
                self.empty = False

    def declarations(self, element: Any) -> list[tuple[str, Any, bool]]:
        """Give the declarations that match, the weaker before the stronger."""
        if self._wrappers is None:
            wrapped = cssselect2.ElementWrapper.from_xml_root(self._root)
            self._wrappers = {wrapper.etree_element: wrapper for wrapper in wrapped.iter_subtree()}
        wrapper = self._wrappers.get(element)
        matches = self._matcher.match(wrapper) if wrapper is not None else []
        return [declaration for _, _, _, declarations in matches for declaration in declarations]
