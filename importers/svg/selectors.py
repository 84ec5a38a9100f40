"""Selectors of style sheets: cssselect2 tests their parts, and the ways between the parts are walked here.

cssselect2 writes one Python expression for a whole selector, an ``any(...)`` in another for each blank in it. Python
3.14 compiles what stands in such a call twice, so that forty names in a row would take longer than anybody waits, and
older ones refuse a few hundred; and each step back tries all ancestors anew. Here the elements that a part may stand
for are kept as a set, from the last part to the first: that takes no more than parts times elements on the way.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from typing import Any

import cssselect2
import tinycss2

from importers.limits import Work

STEPS = 60  # of work for a part that is compiled
STEPS_OF_A_LETTER = 12  # of a long one, which is read and written several times
STEPS_OF_A_TEST = 2  # of an element by a chain of parts, besides those of the way
MOST_NESTED = (
    10  # blanks within blanks of ``:is(...)`` and its like: Python 3.14 compiles 2 ** 10 copies of the innermost
)
_NAME = re.compile(r"[.#]?+[A-Za-z_][\w-]*+", re.ASCII)
_NOT_UNDERSTOOD = (
    cssselect2.SelectorError,
    NotImplementedError,
    SyntaxError,
    RecursionError,
    MemoryError,
    ValueError,
)


class NotUnderstoodError(Exception):
    """A selector that is none, or one that this reader does not know."""


def compile_selectors(prelude: str, namespaces: dict[str | None, str], work: Work) -> list[Any]:
    """Give the selectors of a rule, as a ``cssselect2.Matcher`` takes them; those of pseudo-elements are left out.

    Args:
        prelude: text of the selectors, with commas between.
        namespaces: by prefix; None for the default one.
        work: is charged for what is compiled here, and later for what is matched.

    Raises:
        NotUnderstoodError: one of them is not understood.
        LimitError: the work is used up.
    """
    if None not in namespaces and _NAME.fullmatch(prelude):
        return [Simple(prelude)]
    found = [_compiled(tokens, namespaces, work) for tokens in split_at_commas(prelude)]
    steps = len(prelude) // 16
    return [
        parts[0] if len(parts) == 1 and not steps else Chain(parts, combinators, steps, work)
        for parts, combinators in found
        if parts[-1].pseudo_element is None
    ]


def split_at_commas(prelude: str) -> list[list[Any]]:
    """Give the tokens of each selector of a list."""
    parts: list[list[Any]] = [[]]
    for token in tinycss2.parse_component_value_list(prelude, skip_comments=True):
        if token.type == "literal" and token.value == ",":
            parts.append([])
        else:
            parts[-1].append(token)
    return parts


def _compiled(tokens: list[Any], namespaces: dict[str | None, str], work: Work) -> tuple[list[Any], list[str]]:
    """Compile the parts of a selector, and give them with the combinators between."""
    parts, combinators = _parts(tokens)
    tests = []
    for part in parts:
        nested = _nested(part)
        if nested > MOST_NESTED:
            raise NotUnderstoodError
        text = tinycss2.serialize(part)
        work.charge("selectors", max(STEPS << nested, STEPS_OF_A_LETTER * len(text)))
        try:
            (test,) = cssselect2.compile_selector_list(text, namespaces=namespaces)
        except _NOT_UNDERSTOOD as error:
            raise NotUnderstoodError from error
        tests.append(test)
    if any(test.pseudo_element is not None for test in tests[:-1]):
        raise NotUnderstoodError
    return tests, combinators


def _parts(tokens: list[Any]) -> tuple[list[list[Any]], list[str]]:
    """Split a selector at its combinators: a blank, ``>``, ``+`` or ``~``."""
    parts: list[list[Any]] = [[]]
    combinators: list[str] = []
    between = ""  # the combinator since the last part, so far
    for token in tokens:
        if token.type == "whitespace":
            between = between or " "
        elif token.type == "literal" and token.value in (">", "+", "~"):
            if between.strip():
                raise NotUnderstoodError
            between = token.value
        else:
            if between and parts[-1]:
                combinators.append(between)
                parts.append([])
            elif between.strip():
                raise NotUnderstoodError
            between = ""
            parts[-1].append(token)
    if between.strip() or not parts[-1]:
        raise NotUnderstoodError
    return parts, combinators


def _nested(tokens: Iterable[Any]) -> int:
    """Count the combinators within one another, in the arguments of functions, and in those of these."""
    most = 0
    for token in tokens:
        if token.type == "function":
            own, deepest = int(token.lower_name == "has"), 0
            for argument in _arguments(token):
                blanks = sum(one.type == "whitespace" or one == "~" for one in argument)
                deepest = max(deepest, blanks + _nested(argument))
            most = max(most, own + deepest)
    return most


def _arguments(function: Any) -> Iterator[list[Any]]:
    """Give the arguments of a function, without the blanks around them."""
    argument: list[Any] = []
    for token in (*function.arguments, None):
        if token is None or token == ",":
            while argument and argument[-1].type == "whitespace":
                argument.pop()
            yield argument
            argument = []
        elif argument or token.type != "whitespace":
            argument.append(token)


@dataclass(slots=True, eq=False)
class Chain:
    """A selector of parts with combinators between, for ``cssselect2.Matcher``, which looks up its last part.

    Attributes:
        parts: compiled, in the order of the text.
        combinators: what stands behind each but the last.
        steps: of work for each element that is tested.
        work: that is charged.
    """

    parts: list[Any]
    combinators: list[str]
    steps: int
    work: Work

    def __getattr__(self, name: str) -> Any:
        return getattr(self.parts[-1], name)

    @property
    def never_matches(self) -> bool:
        """One of its parts is for no element at all."""
        return any(part.never_matches for part in self.parts)

    @property
    def specificity(self) -> tuple[int, ...]:
        """The sum over the parts."""
        return tuple(map(sum, zip(*(part.specificity for part in self.parts), strict=True)))

    def test(self, element: Any) -> bool:
        """Tell whether an element is what the last part stands for, with others before it as the combinators say."""
        self.work.charge("selectors", STEPS_OF_A_TEST + self.steps)
        if not self.parts[-1].test(element):
            return False
        those = [element]
        for part, combinator in zip(self.parts[-2::-1], reversed(self.combinators), strict=True):
            those = [one for one in _WAYS[combinator](those) if part.test(one)]
            if not those:
                return False
        return True


def _ancestors(elements: list[Any]) -> Iterator[Any]:
    """Each ancestor of the elements once: what is above one that was met before, was met too."""
    met = set()
    for element in elements:
        for one in element.ancestors:
            if id(one) in met:
                break
            met.add(id(one))
            yield one


def _siblings_before(elements: list[Any]) -> Iterator[Any]:
    """Each element before one of these, with the same parent, once."""
    met = set()
    for element in elements:
        for one in element.previous_siblings:
            if id(one) in met:
                break
            met.add(id(one))
            yield one


def _parents(elements: list[Any]) -> Iterable[Any]:
    """The parents, each once."""
    return {id(one.parent): one.parent for one in elements if one.parent is not None}.values()


def _just_before(elements: list[Any]) -> Iterable[Any]:
    """The elements just before these, with the same parent."""
    return [one.previous for one in elements if one.previous is not None]


_WAYS: dict[str, Callable[[list[Any]], Iterable[Any]]] = {
    " ": _ancestors,
    ">": _parents,
    "+": _just_before,
    "~": _siblings_before,
}


class Simple:
    """A selector of one name, class or id; cssselect2's matcher looks those up, so there is nothing left to test."""

    never_matches = requires_lang_attr = False
    pseudo_element = namespace = None

    def __init__(self, text: str) -> None:
        kind, name = (text[0], text[1:]) if text[0] in ".#" else ("", text)
        self.id = name if kind == "#" else None
        self.class_name = name if kind == "." else None
        self.local_name = name if not kind else None
        self.lower_local_name = name.lower() if not kind else None
        self.specificity = (int(kind == "#"), int(kind == "."), int(not kind))

    def test(self, element: Any) -> bool:
        """Tell whether an element with that id, class or lower name matches; names keep their case."""
        return self.local_name is None or bool(element.local_name == self.local_name)
