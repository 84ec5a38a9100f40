"""Style sheets in the file: which declarations the rules of its ``<style>`` elements give to an element."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Any, Protocol

import cssselect2
import tinycss2

from importers.limits import Work
from importers.problems import Severity
from importers.svg.declarations import Winners, fault_of, winners
from importers.svg.media import matches_media
from importers.svg.selectors import NotUnderstoodError, compile_selectors, split_at_commas
from importers.svg.style import Declaration, known_declarations
from importers.svg.units import unreadable


class Report(Protocol):
    """Is told of each thing in a sheet that is not followed, with the declaration of tinycss2 where it is one."""

    def __call__(self, code: str, severity: Severity, message: str, at: Any = None) -> None:
        """Say that something is left out."""


_MOST_LETTERS = 10_000  # of the selectors of a nested rule, with those around it put in


class _Counted:
    """An element as selectors see it, whose attributes are charged for by their length when they are looked at."""

    __slots__ = ("_element", "_weight", "_work", "tag", "text")

    def __init__(self, element: Any, work: Work) -> None:
        self._element, self._work = element, work
        self._weight = 1 + len(element.attrib) // 64
        self.tag, self.text = element.tag, element.text

    def get(self, name: str, default: Any = None) -> Any:
        value = self._element.get(name, default)
        self._work.charge("selectors", self._weight + len(value or "") // 8)
        return value

    @property
    def attrib(self) -> Any:
        self._work.charge("selectors", self._weight)
        return self._element.attrib

    def __iter__(self) -> Iterator[Any]:
        return iter(self._element)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _Counted) and self._element is other._element

    def __hash__(self) -> int:
        return hash(self._element)


class _Element(cssselect2.ElementWrapper):  # type: ignore[misc]
    """cssselect2's view of an element, without its recursion over siblings, and with its work counted."""

    work: Work
    etree_element: Any

    def __init__(self, *arguments: Any, **named: Any) -> None:
        super().__init__(*arguments, **named)
        self.raw = self.etree_element
        if self.parent is not None:
            self.start(self.parent.work)

    def start(self, work: Work) -> None:
        """Take a budget, and charge it for this element."""
        self.work = work
        self.work.charge("selectors", 8)
        self.etree_element = _Counted(self.raw, work)

    @property
    def etree_siblings(self) -> list[Any]:
        if self.parent is not None:
            self.work.charge("selectors", 1 + len(self._siblings) // 16)
        return self._siblings

    @etree_siblings.setter
    def etree_siblings(self, siblings: list[Any]) -> None:
        self._siblings = siblings

    @property
    def ancestors(self) -> Iterator[_Element]:
        element = self.parent
        while element is not None:
            self.work.charge("selectors", 1)
            yield element
            element = element.parent

    @property
    def previous_siblings(self) -> Iterator[_Element]:
        element = self.previous
        while element is not None:
            self.work.charge("selectors", 1)
            yield element
            element = element.previous


class Sheet:
    """The rules of all style sheets of a file, matched against its elements.

    An instance that ``use`` makes is a tree of its own, as in browsers: its elements match by themselves and by
    what is in the instance, not by what is around the original or around the ``use``.
    """

    def __init__(self, texts: Iterable[tuple[str, Report]], root: Any, work: Work) -> None:
        self._matcher = cssselect2.Matcher()
        self._wrappers: dict[Any, dict[Any, _Element]] = {}  # of each tree, by its root
        self._root, self._work = root, work
        self.empty = True
        self._namespaces: dict[str | None, str] = {}
        for text, self._report in texts:
            self._add(text)

    def _add(self, text: str) -> None:
        if unreadable(text):
            self._report("bad-css", "warning", "a style sheet that no parser can take is left out")
            return
        rules = tinycss2.parse_stylesheet(text, skip_comments=True, skip_whitespace=True)
        self._add_rules(rules)

    def _add_rules(self, rules: list[Any]) -> None:
        """Add rules, and those within them, in order.

        A rule within another has the selectors of that one around its own; the stack holds both.
        """
        pending = [(rule, "") for rule in reversed(rules)]
        while pending:
            rule, around = pending.pop()
            inner: list[Any] = []
            if rule.type == "qualified-rule":
                prelude = self._nested(tinycss2.serialize(rule.prelude).strip(), around)
                around = prelude
                inner = self._add_block(rule.content, prelude) if prelude else []
            elif rule.type == "at-rule":
                inner = self._at_rule(rule, around)
            elif rule.type == "error":
                self._report("bad-css", "warning", f"a part of a style sheet cannot be read: {rule.message[:60]}")
            pending += [(one, around) for one in reversed(inner)]

    def _nested(self, prelude: str, around: str) -> str:
        """Give the selectors of a rule within the rule of others: ``&`` stands for those."""
        if not around:
            return prelude
        letters = len(prelude) + (prelude.count("&") + prelude.count(",") + 1) * (len(around) + 6)
        self._work.charge("selectors", min(letters, _MOST_LETTERS))
        if letters > _MOST_LETTERS:
            self._report("css-skipped", "warning", "a rule within a rule whose selectors are too long is left out")
            return ""
        parts = []
        for tokens in split_at_commas(prelude):
            own = tinycss2.serialize(tokens).strip()
            written = "".join(
                f":is({around})" if token.type == "literal" and token.value == "&" else tinycss2.serialize([token])
                for token in tokens
            ).strip()
            parts.append(f":is({around}) {own}" if written == own else written)
        return ", ".join(parts)

    def _at_rule(self, rule: Any, around: str) -> list[Any]:
        """Give the rules within an at-rule that holds; what stands bare in one in a rule is that rule's own."""
        keyword = rule.lower_at_keyword
        if keyword == "media" and rule.content is not None:
            query = " ".join(tinycss2.serialize(rule.prelude).split()).lower()
            if not matches_media(query):
                self._report("css-skipped", "info", f"the rules of @media {query[:60]} are for another medium")
            elif around:
                return self._add_block(rule.content, around)
            else:
                return list(tinycss2.parse_rule_list(rule.content, skip_comments=True, skip_whitespace=True))
        elif keyword == "namespace":
            self._add_namespace(rule)
        elif keyword == "import":
            self._report("css-skipped", "warning", "@import is not followed: no other file is read")
        elif keyword not in ("font-face", "charset", "keyframes", "-webkit-keyframes", "page", "property"):
            self._report("css-skipped", "warning", f"@{keyword[:60]} is left out")
        return []

    def _add_namespace(self, rule: Any) -> None:
        parts = [token for token in rule.prelude if token.type in ("ident", "string", "url")]
        if parts and parts[-1].type != "ident":
            self._namespaces[parts[0].value if len(parts) == 2 else None] = parts[-1].value

    def _add_block(self, content: list[Any], prelude: str) -> list[Any]:
        """Add the declarations of a block for its selectors; give the rules that stand within it."""
        declarations: list[Declaration] = []
        inner = []
        for node in tinycss2.parse_blocks_contents(content, skip_comments=True, skip_whitespace=True):
            if node.type == "declaration":
                known = known_declarations(node, "sheet")
                for name, value, _ in known:
                    fault = fault_of(name, value)
                    if fault is not None:
                        self._report(fault.code, fault.severity, f"{name} {fault.message}", node)
                declarations += known
            elif node.type in ("qualified-rule", "at-rule"):
                inner.append(node)
        found = winners(declarations)
        if found.normal or found.important:
            for selector in self._compile(prelude):
                self._matcher.add_selector(selector, found)
                self.empty = False
        return inner

    def _compile(self, prelude: str) -> list[Any]:
        """Give the selectors of a rule, none where they are not understood."""
        try:
            return compile_selectors(prelude, self._namespaces, self._work)
        except NotUnderstoodError:
            self._report("css-skipped", "warning", f"the selector {prelude[:60]!r} is not understood")
            return []

    def matches(self, element: Any, root: Any) -> list[Winners]:
        """Give the blocks of the rules that match, the weaker before the stronger.

        Args:
            element: in the file.
            root: of the instance that it is seen in; None for the file itself.
        """
        root = self._root if root is None else root
        if root not in self._wrappers:
            whole = _Element.from_xml_root(root)
            whole.start(self._work)
            self._wrappers[root] = {wrapper.raw: wrapper for wrapper in whole.iter_subtree()}
        wrapper = self._wrappers[root].get(element)
        if wrapper is None:
            return []
        matcher = self._matcher
        named = matcher.lower_local_name_selectors.get(wrapper.local_name.lower(), ())
        classes = sum(1 + len(matcher.class_selectors.get(name, ())) for name in wrapper.classes)
        self._work.charge("selectors", 4 + len(matcher.other_selectors) + len(named) + classes)
        found = [match[3] for match in matcher.match(wrapper)]
        self._work.charge("declarations", sum(1 + len(one.normal) + len(one.important) for one in found))
        return found
