"""Conditional processing: ``switch``, ``systemLanguage``, ``requiredExtensions``."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

# The language is that of the browser that the tests measure with: English of any country.
LANGUAGE = "en"

_EXTENSIONS = frozenset(("http://www.w3.org/1999/xhtml", "http://www.w3.org/1998/Math/MathML"))


def holds(attributes: Mapping[str, str]) -> bool:
    """Tell whether the conditions on an element hold; ``requiredFeatures`` no longer counts (SVG 2)."""
    extensions = attributes.get("requiredExtensions")
    if extensions is not None:
        words = extensions.split()
        if not words or not all(word in _EXTENSIONS for word in words):
            return False
    languages = attributes.get("systemLanguage")
    return languages is None or any(_speaks(tag.strip()) for tag in languages.split(","))


def _speaks(tag: str) -> bool:
    return tag.lower().partition("-")[0] == LANGUAGE


def chosen(element: Any, prefix: str) -> Any:
    """Give the child of a ``switch`` that is shown: the first whose conditions hold; None without one."""
    for child in element.iterchildren("*"):
        if child.tag.startswith(prefix) and holds(child.attrib):
            return child
    return None
