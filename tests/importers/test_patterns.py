"""No regular expression on foreign text goes back over it: repeats that overlap are possessive, or there are none.

A repeat within a repeat, or one beside another that takes the same letters, makes the time of a failing match grow with
a power of the text. Every pattern of the readers is taken apart here, as Python's own parser has it.
"""

import ast
import importlib
import pkgutil
import re
from pathlib import Path
from re import _constants as op
from re import _parser as parser

import pytest

import importers

MANY = 1000  # repeats bounded below this cost no more than this many times their text
LETTERS = [chr(code) for code in range(256)]
SAFE = (op.POSSESSIVE_REPEAT, op.ATOMIC_GROUP)
REPEATS = (op.MAX_REPEAT, op.MIN_REPEAT)


def letters_of(items):
    """The letters that a sequence can begin with, and whether it can be empty."""
    found = set()
    for kind, value in items:
        first, empty = letters_of_one(kind, value)
        found |= first
        if not empty:
            return found, False
    return found, True


def letters_of_one(kind, value):
    if kind is op.LITERAL:
        return {chr(value)}, False
    if kind is op.NOT_LITERAL:
        return set(LETTERS) - {chr(value)}, False
    if kind is op.ANY:
        return set(LETTERS), False
    if kind is op.IN:
        return in_class(value), False
    if kind in (*REPEATS, op.POSSESSIVE_REPEAT):
        first, empty = letters_of(value[2])
        return first, empty or value[0] == 0
    if kind is op.SUBPATTERN:
        return letters_of(value[3])
    if kind is op.ATOMIC_GROUP:
        return letters_of(value)
    if kind is op.BRANCH:
        parts = [letters_of(branch) for branch in value[1]]
        return set().union(*(first for first, _ in parts)), any(empty for _, empty in parts)
    if kind in (op.AT, op.ASSERT, op.ASSERT_NOT):
        return set(), True
    return set(LETTERS), True


def in_class(parts):
    classes = {op.CATEGORY_DIGIT: r"\d", op.CATEGORY_SPACE: r"\s", op.CATEGORY_WORD: r"\w"}
    classes |= {op.CATEGORY_NOT_DIGIT: r"\D", op.CATEGORY_NOT_SPACE: r"\S", op.CATEGORY_NOT_WORD: r"\W"}
    found = set()
    for kind, value in parts:
        if kind is op.LITERAL:
            found.add(chr(value))
        elif kind is op.RANGE:
            found |= {letter for letter in LETTERS if value[0] <= ord(letter) <= value[1]}
        elif kind is op.CATEGORY:
            found |= set(filter(re.compile(classes[value]).match, LETTERS))
    return set(LETTERS) - found if parts[0][0] is op.NEGATE else found


def parts_of(kind, value):
    """The sequences within an item."""
    if kind in (*REPEATS, op.POSSESSIVE_REPEAT):
        return [value[2]]
    if kind is op.SUBPATTERN:
        return [value[3]]
    if kind is op.ATOMIC_GROUP:
        return [value]
    if kind is op.BRANCH:
        return value[1]
    return [value[1]] if kind in (op.ASSERT, op.ASSERT_NOT) else []


def is_long(kind, value):
    return kind in REPEATS and value[1] > MANY


def has_long(items):
    return any(is_long(*item) or any(has_long(part) for part in parts_of(*item)) for item in items)


def flat(items):
    """A sequence with its plain groups opened, so that what stands beside what shows."""
    for kind, value in items:
        if kind is op.SUBPATTERN:
            yield from flat(value[3])
        else:
            yield kind, value


def faults(items):
    """What in a sequence makes a failing match go back over its text."""
    items = list(flat(items))
    for index, (kind, value) in enumerate(items):
        for part in parts_of(kind, value):
            yield from faults(part)
        if not is_long(kind, value):
            continue
        if has_long(value[2]):
            yield "a repeat within a repeat"
        own, _ = letters_of(value[2])
        for beside, inner in items[index + 1 :]:
            if is_long(beside, inner) and own & letters_of(inner[2])[0]:
                yield "a repeat beside another that takes the same letters"
            if not letters_of_one(beside, inner)[1]:
                break


def patterns():
    for module in pkgutil.walk_packages(importers.__path__, "importers."):
        loaded = importlib.import_module(module.name)
        for name, value in vars(loaded).items():
            if isinstance(value, re.Pattern):
                yield f"{module.name}.{name}", value.pattern, value.flags
        for call in ast.walk(ast.parse(Path(loaded.__file__).read_text("utf-8"))):
            named = isinstance(call, ast.Call) and isinstance(call.func, ast.Attribute) and call.func.attr
            if named in ("search", "match", "fullmatch", "split", "sub", "findall", "finditer") and call.args:
                of_re = isinstance(call.func.value, ast.Name) and call.func.value.id == "re"
                if of_re and isinstance(call.args[0], ast.Constant):
                    yield f"{module.name}:{call.lineno}", call.args[0].value, 0


PATTERNS = {name: (pattern, flags) for name, pattern, flags in patterns()}


def faults_of(pattern, flags=0):
    text = pattern.decode("latin-1") if isinstance(pattern, bytes) else pattern
    return list(faults(parser.parse(text, flags & ~re.UNICODE)))


@pytest.mark.parametrize("name", PATTERNS)
def test_no_pattern_of_the_readers_goes_back_over_its_text(name):
    assert faults_of(*PATTERNS[name]) == []


@pytest.mark.parametrize(
    "pattern", [r"(a+)+b", r"\s*(.*)", r"a*[^b]*c", r"(?:a|b+)*c", r"url\(\s*([^)]*?)\s*\)", r"x*y?x*z"]
)
def test_what_goes_back_over_its_text_is_found(pattern):
    assert faults_of(pattern)


@pytest.mark.parametrize("pattern", [r"(a++)+b", r"\s*+(.*)", r"a*b[^b]*c", r"[0-9]+\.[0-9]+", r"(?:ab?){0,9}c*"])
def test_what_never_goes_back_is_not(pattern):
    assert not faults_of(pattern)
