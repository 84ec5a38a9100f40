"""Texts grown from a grammar, for the fuzzers of work: trees whose parts are said again and again.

A grammar is a dict from a name to its alternatives. In an alternative ``{name}`` stands for one of that name's, and
``{name*}`` for some number of times the same one; braces of the text itself are written « and ». The first alternative
of a name is short, and is the one that is taken where the tree is deep enough. In a part that is said often, ``§``
stands for how many times it was said before and ``¤`` for one more: so ids differ, and chains (``--a§:var(--a¤)``) can
grow.
"""

from __future__ import annotations

import random
import re
from dataclasses import dataclass
from typing import Any

MARK = re.compile(r"\{(\w+)(\*?)\}")
TIMES = (0, 1, 1, 1, 2, 3, 8, 30, 120)
DEEPEST = 9
LONGEST = 6_000  # letters of a text that is measured

Grammar = dict[str, list[str]]


@dataclass
class Many:
    """Parts that are said some number of times, and the name that they were made of."""

    name: str
    times: int
    parts: list[Any]


class Grower:
    """Makes trees of a grammar, and neighbours of trees.

    A tree is a text or a Many.
    """

    def __init__(self, grammar: Grammar, seed: int) -> None:
        self.grammar = grammar
        self.random = random.Random(seed)

    def new(self, name: str, times: int = 1, depth: int = 0) -> Many:
        """Make a tree of a name."""
        alternatives = self.grammar[name]
        text = alternatives[0] if depth > DEEPEST else self.random.choice(alternatives)
        parts: list[Any] = []
        end = 0
        for mark in MARK.finditer(text):
            parts.append(_plain(text[end : mark.start()]))
            often = self.random.choice(TIMES) if mark[2] and depth < DEEPEST else 1
            parts.append(self.new(mark[1], often, depth + 1))
            end = mark.end()
        return Many(name, times, [*parts, _plain(text[end:])])

    def changed(self, tree: Many) -> Many:
        """Give a copy of a tree with one or two of its parts made anew, or said more or less often."""
        tree = copy(tree)
        for _ in range(self.random.choice((1, 1, 2))):
            nodes = list(below(tree))
            node = self.random.choice(nodes)
            what = self.random.random()
            if what < 0.45:
                node.times = min(int(node.times * self.random.choice((0.5, 2, 2, 4, 10)) + 0.5), LONGEST)
            elif what < 0.75:
                node.parts = self.new(node.name).parts
            else:  # a part of another place, of the same name
                node.parts = copy(self.random.choice([one for one in nodes if one.name == node.name])).parts
        return tree


def _plain(text: str) -> str:
    """Give a piece between names its braces."""
    return text.replace("«", "{").replace("»", "}")


def copy(tree: Many) -> Many:
    """Give a tree of its own."""
    return Many(tree.name, tree.times, [part if isinstance(part, str) else copy(part) for part in tree.parts])


def below(tree: Many) -> list[Many]:
    """List a tree and all that is in it."""
    found = [tree]
    for node in found:
        found += [part for part in node.parts if isinstance(part, Many)]
    return found


def scaled(tree: Many, factor: int) -> Many:
    """Give a tree in which whatever is said more than twice is said so much more often, but nothing within it."""
    if tree.times > 2:
        return Many(tree.name, tree.times * factor, tree.parts)
    parts = [part if isinstance(part, str) else scaled(part, factor) for part in tree.parts]
    return Many(tree.name, tree.times, parts)


class TooLongError(Exception):
    """A text has more letters than were asked for."""


def written(tree: Many, longest: int = LONGEST) -> str:
    """Write a tree.

    Raises:
        TooLongError: the text would have more than `longest` letters.
    """
    once = "".join(part if isinstance(part, str) else written(part, longest) for part in tree.parts)
    if len(once) * tree.times > longest:
        raise TooLongError
    if "§" not in once and "¤" not in once:
        return once * tree.times
    return "".join(once.replace("§", str(index)).replace("¤", str(index + 1)) for index in range(tree.times))
