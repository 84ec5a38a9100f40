"""Globs on names, from options and scene files: bounded, since strangers write them too."""

from __future__ import annotations

from collections.abc import Iterable
from fnmatch import fnmatchcase

from importers.limits import limit_error

MOST_LETTERS = 256
"""Of a glob: Python looks for the end of each of its brackets anew, and no name in a drawing is that long."""
_LETTERS_OF_A_STEP = 32


def fits(name: str, glob: str) -> bool:
    """Tell whether a name is like a glob; capitals count.

    Raises:
        LimitError: the glob has more than MOST_LETTERS letters.
    """
    if glob == "*":
        return True
    if len(glob) > MOST_LETTERS:
        raise limit_error("letters of a glob", str(MOST_LETTERS), fix="write it shorter, with * for the rest")
    return fnmatchcase(name, glob)


def steps_of(names: Iterable[str]) -> int:
    """Give the steps of work (importers.limits) that it takes to match names with one glob."""
    return sum(2 + len(name) // _LETTERS_OF_A_STEP for name in names)
