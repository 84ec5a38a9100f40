"""How findings and errors are shown to people: place, severity, code, message; the text with a caret; what to do.

The form is that of rustc and ruff::

    room.svg:3:27: error[bad-path-data] a number is missing after "L"
        3 | <path id="a" d="M10 10 L 20"/>
          |                            ^
      = at: (10, 10) on layer "Walls", object "a"
      = help: the path is used up to here; complete the pair

Everything goes to standard error, so that standard output stays data.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Iterable, Sequence
from typing import Any, Literal, TextIO

import typer

from importers.errors import WallkitError
from importers.problems import Problem

# So many findings are shown one by one; of a longer list each code is one group with this many first places.
ONE_BY_ONE = 8
FIRST_PLACES = 3

_ORDER = {"error": 0, "warning": 1, "info": 2}
_STYLES: dict[str, dict[str, Any]] = {
    "error": {"fg": "red", "bold": True},
    "warning": {"fg": "yellow", "bold": True},
    "info": {"fg": "cyan", "bold": True},
    "bold": {"bold": True},
    "dim": {"dim": True},
    "help": {"fg": "cyan"},
}
Style = Literal["error", "warning", "info", "bold", "dim", "help"]


def use_colour(stream: TextIO) -> bool:
    """Tell whether to colour: NO_COLOR forbids, FORCE_COLOR demands, else only a terminal gets it.

    Either variable counts when it is there and not empty (https://no-color.org); NO_COLOR wins.
    """
    if os.environ.get("NO_COLOR"):
        return False
    if os.environ.get("FORCE_COLOR"):
        return True
    return stream.isatty() and os.environ.get("TERM") != "dumb"


def paint(text: str, style: Style, colour: bool) -> str:
    """Give the text in a style of the terminal, or as it is without colour."""
    return typer.style(text, **_STYLES[style]) if colour else text


def plain(text: str) -> str:
    """Make somebody's text (a name, a file name) harmless on a terminal: control characters are spelled out."""
    return "".join(c if c.isprintable() else c.encode("unicode_escape").decode("ascii") for c in text)


def show_error(error: WallkitError, stream: TextIO | None = None) -> None:
    """Write an error that ended the command, in the same form as a finding."""
    stream = stream or sys.stderr
    colour = use_colour(stream)
    place = plain(_place(error.file, error.line, error.column)) or "wallkit"
    lines = [_headline(place, "error", error.code, error.message, colour)]
    if error.fix:
        lines.append(_note("help", error.fix, colour))
    print("\n".join(lines), file=stream)


def show_problems(problems: Sequence[Problem], file: str = "", stream: TextIO | None = None) -> None:
    """Write findings, the severe first; a list longer than ONE_BY_ONE as one group a code. Nothing when empty."""
    if not problems:
        return
    stream = stream or sys.stderr
    colour = use_colour(stream)
    if len(problems) <= ONE_BY_ONE:
        ordered = sorted(problems, key=lambda problem: _ORDER[problem.severity])
        texts = [format_problem(problem, file, colour) for problem in ordered]
    else:
        texts = [_format_group(group, file, colour) for group in _groups(problems)]
    print("\n".join(texts), file=stream)
    print(paint(count_by_severity(problems), "bold", colour), file=stream)


def format_problem(problem: Problem, file: str = "", colour: bool = False) -> str:
    """Give one finding as lines of text, without a line end behind the last."""
    place = plain(_place(file, problem.line, problem.column)) or "drawing"
    lines = [_headline(place, problem.severity, problem.code, problem.message, colour)]
    lines += _excerpt_lines(problem, colour)
    where = _where(problem)
    if where:
        lines.append(_note("at", where, colour))
    if problem.fix:
        lines.append(_note("help", problem.fix, colour))
    return "\n".join(lines)


def count_by_severity(problems: Iterable[Problem]) -> str:
    """Give a count such as ``2 errors, 1 warning, 3 notes``; ``no problems`` without any."""
    words = {"error": "error", "warning": "warning", "info": "note"}
    counts = dict.fromkeys(words, 0)
    for problem in problems:
        counts[problem.severity] += 1
    parts = [f"{count} {words[key]}{'' if count == 1 else 's'}" for key, count in counts.items() if count]
    return ", ".join(parts) or "no problems"


def _groups(problems: Sequence[Problem]) -> list[list[Problem]]:  # by code, severe first, else in order of coming
    groups: dict[tuple[str, str], list[Problem]] = {}
    for problem in problems:
        groups.setdefault((problem.severity, problem.code), []).append(problem)
    return sorted(groups.values(), key=lambda group: _ORDER[group[0].severity])


def _format_group(group: list[Problem], file: str, colour: bool) -> str:
    if len(group) == 1:
        return format_problem(group[0], file, colour)
    first = group[0]
    place = plain(file) or "drawing"
    lines = [_headline(place, first.severity, first.code, f"{len(group)} times; the first: {first.message}", colour)]
    lines += _excerpt_lines(first, colour)
    for problem in group[:FIRST_PLACES]:
        spot = ", ".join(part for part in (_place("line", problem.line, problem.column), _where(problem)) if part)
        if spot != "line":
            lines.append(_note("at", spot.removeprefix("line, "), colour))
    if len(group) > FIRST_PLACES:
        lines.append(_note("at", f"{len(group) - FIRST_PLACES} more", colour))
    if first.fix:
        lines.append(_note("help", first.fix, colour))
    return "\n".join(lines)


def _headline(place: str, severity: str, code: str, message: str, colour: bool) -> str:
    style: Style = severity if severity in ("error", "warning", "info") else "error"  # type: ignore[assignment]
    return f"{paint(place, 'bold', colour)}: {paint(f'{severity}[{code}]', style, colour)} {plain(message)}"


def _note(word: str, text: str, colour: bool) -> str:
    return f"  {paint('=', 'dim', colour)} {paint(word, 'help', colour)}: {plain(text)}"


def _place(file: str, line: int | None, column: int | None) -> str:
    parts = [file, *(str(number) for number in (line, column) if number is not None)]
    return ":".join(part for part in parts if part)


def _where(problem: Problem) -> str:
    parts = []
    if problem.x is not None and problem.y is not None:
        parts.append(f"({problem.x:.6g}, {problem.y:.6g})")
    if problem.layer:
        parts.append(f'on layer "{problem.layer}"')
    if problem.name:
        parts.append(f'object "{problem.name}"')
    return ", ".join(parts)


def _excerpt_lines(problem: Problem, colour: bool) -> list[str]:
    if not problem.excerpt:
        return []
    text, _, caret = problem.excerpt.partition("\n")
    if not caret and problem.column is not None and problem.column <= len(text) + 1:
        caret = " " * (problem.column - 1) + "^"
    gutter = f"{problem.line if problem.line is not None else '':>5}"
    bar = paint("|", "dim", colour)
    lines = [f"{paint(gutter, 'dim', colour)} {bar} {plain(text)}"]
    if caret:
        lines.append(f"{' ' * 5} {bar} {paint(caret, 'error', colour)}")
    return lines
