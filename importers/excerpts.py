"""Excerpt: the line of a file that a problem points into, cut to what fits a screen, with a caret under the place."""

from __future__ import annotations

WIDTH = 100  # characters of the file shown at most; the rest of a terminal line is for the line number


def excerpt(line: str, column: int) -> str:
    """Give two lines of text: the file's line, shortened around ``column``, and a caret under that column.

    Args:
        line: the whole line, without its end. Tabs become spaces and other control characters become signs that
            a terminal shows as one cell, so that the caret stands right.
        column: from 1; beyond the end it points behind the last character.
    """
    place = min(max(column - 1, 0), len(line))
    start = 0 if len(line) <= WIDTH else max(0, min(place - WIDTH // 2, len(line) - WIDTH))
    cut = "".join(_cell(character) for character in line[start : start + WIDTH])
    before = "…" if start else ""
    after = "…" if start + WIDTH < len(line) else ""
    return f"{before}{cut}{after}\n{' ' * (len(before) + place - start)}^"


def _cell(character: str) -> str:
    if character == "\t":
        return " "
    return character if character.isprintable() else "\N{REPLACEMENT CHARACTER}"
