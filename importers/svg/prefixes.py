"""Namespace prefixes that a file uses and does not declare: read as browsers read them within a web page, and said."""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import Any

from lxml import etree

from importers.problems import Problem
from importers.svg.entities import root_start
from importers.svg.names import INKSCAPE, SODIPODI, SVG_NS

MOST_PREFIXES = 16  # that are declared for a file; the text is parsed once more for each
# What people and programs call the namespaces that mean something to a reader of drawings
_KNOWN = {
    "svg": SVG_NS,
    "xlink": "http://www.w3.org/1999/xlink",
    "inkscape": INKSCAPE[1:-1],
    "sodipodi": SODIPODI[1:-1],
    "rdf": "http://www.w3.org/1999/02/22-rdf-syntax-ns#",
    "cc": "http://creativecommons.org/ns#",
    "dc": "http://purl.org/dc/elements/1.1/",
}
_MESSAGE = re.compile(r"Namespace prefix (\S++) (?:for \S++ )?on ")
_NAME = re.compile(r"<[^\s/>]++")


def missing_prefix(error: Any) -> str | None:
    """Give the prefix that a parser's error is about, None where it is about something else."""
    if error.code != etree.ErrorTypes.NS_ERR_UNDEFINED_NAMESPACE:
        return None
    match = _MESSAGE.match(str(error.msg))
    return match[1] if match else None


def undeclared(prefix: str, line: int, column: int) -> Problem:
    """Make the problem of a prefix that is not declared, at its first use."""
    return Problem(
        "undeclared-prefix",
        "warning",
        f"the prefix {prefix[:40]!r} is not declared, and browsers refuse the file for it unless it is in a web page",
        f'add xmlns:{prefix[:40]}="{_address(prefix)}" to the svg element',
        line=line or None,
        column=column or None,
    )


def declare(text: str, start: int, prefixes: Iterable[str]) -> str:
    """Put declarations of prefixes into the outermost element of a text, whose document type ends at a place."""
    root: Any = _NAME.match(text, root_start(text, start))
    added = "".join(f' xmlns:{prefix}="{_address(prefix)}"' for prefix in prefixes)
    return f"{text[: root.end()]}{added}{text[root.end() :]}"


def _address(prefix: str) -> str:
    return _KNOWN.get(prefix, f"urn:prefix:{prefix}")
