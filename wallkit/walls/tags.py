"""Tags: words that the author of a drawing gave an object, a group or a layer, read from labels, notes and data.

A word is ``key``, ``key=value`` or ``key:value``; its key begins with a letter. In a label words stand in brackets or
after ``#``, with spaces, commas or semicolons between them: ``goal [sensor:left, restitution=0.8]``, ``ramp #one-way``.
A note may consist of words alone, or have them in brackets or after ``#``. ``data-key="value"`` is a word as it is.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from functools import lru_cache

Tags = Mapping[str, str]
"""Words by key; the value is ``""`` where there is none."""

MATERIAL_KEYS = ("restitution", "tangential_restitution", "static_friction")
ROLES = ("ignore", "target", "sensor", "spawn", "ball", "wall")
"""What a path is made by such a word; where one level says two, the first here counts."""
KNOWN = (*MATERIAL_KEYS, "one-way", "sides", *ROLES)
ROLE_KEY = "role"
"""``data-role="ball"`` says the same as ``data-ball=""``."""

_MARKED = re.compile(r"\[([^\[\]]*)\]|#([^#\[\]]*)")
_WORD = re.compile(r"([^\W\d_][\w.-]*)(?:[=:](\S*))?")
_BETWEEN = re.compile(r"[\s,;]+")
_NO = frozenset(("false", "no", "off", "0"))
_SPELLINGS = {"one_way": "one-way", "oneway": "one-way", "tangential-restitution": "tangential_restitution"}


@lru_cache(maxsize=4096)
def read_label(label: str) -> tuple[str, tuple[tuple[str, str], ...]]:
    """Part a label into the name and its words; marks that hold anything but words belong to the name.

    Returns:
        The name without the marks that were read, and (key, value) pairs.
    """
    if "#" not in label and "[" not in label:
        return label, ()
    words: list[tuple[str, str]] = []

    def take(match: re.Match[str]) -> str:
        found = _words(match[1] if match[1] is not None else match[2])
        words.extend(found or ())
        return match[0] if found is None else " "

    name = _MARKED.sub(take, label)
    return (" ".join(name.split()) if words else label), tuple(words)


@lru_cache(maxsize=4096)
def read_note(note: str) -> tuple[tuple[str, str], ...]:
    """Give the words of a note: all of it where each is a key with a value or a known one, else those marked."""
    words = _words(note)
    if words is not None and all(value or key in KNOWN for key, value in words):
        return words
    return read_label(note)[1]


def read_data(data: Tags) -> dict[str, str]:
    """Give ``data-*`` attributes as words; a role is the word itself, and ``true`` is no value."""
    words: dict[str, str] = {}
    for key, value in data.items():
        key, value = (value.strip(), "") if key == ROLE_KEY and value.strip() in ROLES else (spelled(key), value)
        words[key] = "" if value.strip().lower() == "true" else value.strip()
    return words


def is_no(value: str) -> bool:
    """Tell whether a value takes a word back: ``one-way=no``."""
    return value.lower() in _NO


def spelled(key: str) -> str:
    """Give a key as wallkit writes it."""
    lower = key.lower()
    known = _SPELLINGS.get(lower, lower)
    return known if known in KNOWN else key


def _words(text: str) -> tuple[tuple[str, str], ...] | None:
    """Read words with spaces, commas or semicolons between them; None where there are none, or anything else."""
    parts = [part for part in _BETWEEN.split(text) if part]
    found = [_WORD.fullmatch(part) for part in parts]
    if not parts or not all(found):
        return None
    return tuple((spelled(match[1]), match[2] or "") for match in found if match)
