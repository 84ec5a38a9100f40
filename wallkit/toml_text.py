"""TOML of strangers: Python's own parser behind a bound on what costs it the square of the text."""

from __future__ import annotations

import re
import tomllib
from typing import Any

from importers.limits import limit_error

# For each name of a dotted key the parser walks there from the first one, and keeps what it met
MOST_NAMES = 32
_NAME = r"""(?:[\w-]++|"[^"\n]*+"|'[^'\n]*+')"""
_LONG_KEY = re.compile(rf"(?<![\w-])(?:{_NAME}[ \t]*+\.[ \t]*+){{{MOST_NAMES}}}")


def parse_toml(text: str, file: str = "") -> dict[str, Any]:
    """Parse a TOML text.

    Args:
        text: the whole text.
        file: its name, for errors.

    Raises:
        LimitError: MOST_NAMES names and more with dots between.
        tomllib.TOMLDecodeError: it is no TOML; a ValueError of another kind is a whole number with too many digits.
        RecursionError: it is nested too deeply.
    """
    long_key = _LONG_KEY.search(text)
    if long_key is not None:
        line = text.count("\n", 0, long_key.start()) + 1
        raise limit_error("names with dots between in a key", str(MOST_NAMES), file=file, line=line)
    return tomllib.loads(text)
