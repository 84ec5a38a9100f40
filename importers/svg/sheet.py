"""Style sheets in the file: which declarations the rules of its ``<style>`` elements give to an element."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator
from typing import Any

import cssselect2
import tinycss2

from importers.limits import limit_error
from importers.problems import Severity
from importers.svg.style import known_declarations
from importers.svg.units import ROOT_FONT, WINDOW, parse_length, to_px, too_nested

# code, severity, what is left out; called once for each thing in a sheet that is not followed
Report = Callable[[str, Severity, str], None]

MAX_STEPS = 5_000_000

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


class _Steps:
    """How much matching has been done; a short selector can ask for more than the age of the universe."""

    def __init__(self) -> None:
        self.left = MAX_STEPS

    def take(self, number: int) -> None:
        self.left -= number
        if self.left < 0:
            raise limit_error("steps of matching style sheets to elements", f"{MAX_STEPS:,}")


class _Element(cssselect2.ElementWrapper):  # type: ignore[misc]
    """cssselect2's view of an element, without its recursion over siblings, and with its work counted."""

    steps: _Steps

    def __init__(self, *arguments: Any, **named: Any) -> None:
        super().__init__(*arguments, **named)
        if self.parent is not None:
            self.steps = self.parent.steps
            self.steps.take(1)
        self._siblings = self.etree_siblings

    @property
    def etree_siblings(self) -> list[Any]:
        if self.parent is not None:
            self.steps.take(1 + len(self._siblings) // 16)
        return self._siblings

    @etree_siblings.setter
    def etree_siblings(self, siblings: list[Any]) -> None:
        self._siblings = siblings

    @property
    def ancestors(self) -> Iterator[_Element]:
        element = self.parent
        while element is not None:
            self.steps.take(1)
            yield element
            element = element.parent

    @property
    def previous_siblings(self) -> Iterator[_Element]:
        element = self.previous
        while element is not None:
            self.steps.take(1)
            yield element
            element = element.previous


class Sheet:
    """The rules of all style sheets of a file, matched against its elements.

    An instance that ``use`` makes is a tree of its own, as in browsers: its elements match by themselves and by
    what is in the instance, not by what is around the original or around the ``use``.
    """

    def __init__(self, texts: Iterable[str], root: Any, report: Report) -> None:
        self._matcher = cssselect2.Matcher()
        self._wrappers: dict[Any, dict[Any, _Element]] = {}  # of each tree, by its root
        self._root = root
        self._steps = _Steps()
        self.empty = True
        self._namespaces: dict[str | None, str] = {}
        for text in texts:
            self._add(text, report)

    def _add(self, text: str, report: Report) -> None:
        if too_nested(text):
            report("bad-css", "warning", "a style sheet with too many brackets in brackets is left out")
            return
        rules = tinycss2.parse_stylesheet(text, skip_comments=True, skip_whitespace=True)
        pending = list(reversed(rules))
        while pending:
            rule = pending.pop()
            if rule.type == "qualified-rule":
                self._add_rule(rule, report)
            elif rule.type == "at-rule":
                pending.extend(reversed(self._at_rule(rule, report)))
            elif rule.type == "error":
                report("bad-css", "warning", f"a part of a style sheet cannot be read: {rule.message}")

    def _at_rule(self, rule: Any, report: Report) -> list[Any]:
        keyword = rule.lower_at_keyword
        if keyword == "media" and rule.content is not None:
            query = " ".join(tinycss2.serialize(rule.prelude).split()).lower()
            if matches_media(query):
                return list(tinycss2.parse_rule_list(rule.content, skip_comments=True, skip_whitespace=True))
            report("css-skipped", "info", f"the rules of @media {query} are for another medium")
        elif keyword == "namespace":
            self._add_namespace(rule)
        elif keyword == "import":
            report("css-skipped", "warning", "@import is not followed: no other file is read")
        elif keyword not in ("font-face", "charset", "keyframes", "-webkit-keyframes", "page"):
            report("css-skipped", "warning", f"@{keyword} is left out")
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
        except (cssselect2.SelectorError, NotImplementedError, SyntaxError, RecursionError, MemoryError, ValueError):
            # cssselect2 writes a Python expression for each selector; a long one is too much for the compiler
            report(
                "css-skipped", "warning", f"the selector {tinycss2.serialize(rule.prelude).strip()!r} is not understood"
            )
            return
        for selector in selectors:
            if selector.pseudo_element is None:
                self._matcher.add_selector(selector, declarations)
                self.empty = False

    def declarations(self, element: Any, root: Any) -> list[tuple[str, Any, bool]]:
        """Give the declarations that match, the weaker before the stronger.

        Args:
            element: in the file.
            root: of the instance that it is seen in; None for the file itself.
        """
        root = self._root if root is None else root
        if root not in self._wrappers:
            whole = _Element.from_xml_root(root)
            whole.steps = self._steps
            self._wrappers[root] = {wrapper.etree_element: wrapper for wrapper in whole.iter_subtree()}
        wrapper = self._wrappers[root].get(element)
        if wrapper is None:
            return []
        matcher = self._matcher
        named = matcher.lower_local_name_selectors.get(wrapper.local_name.lower(), ())
        classes = sum(len(matcher.class_selectors.get(name, ())) for name in wrapper.classes)
        self._steps.take(len(matcher.other_selectors) + len(named) + classes)
        matches = matcher.match(wrapper)
        return [declaration for _, _, _, declarations in matches for declaration in declarations]
