"""Path data: the text of a ``d`` attribute to absolute segments, as far as it is right.

Why not svgpathtools' parser: it raises on the first error where a browser draws what stands before it, it
cannot say where the error is, it raises on arcs of no length, and it takes about twice as long (measured;
benchmarks/ compares them). The tests hold this one against svgpathtools on every
text that both read, so a second reader agrees.

The grammar is SVG 2's, as browsers apply it: a number needs a digit after its point, a comma stands only
between numbers, an arc's flags are one digit each and need nothing around them.
"""

from __future__ import annotations

import itertools
import math
import operator
import re
from typing import NamedTuple

from importers.drawing import Segment, Subpath
from importers.limits import MAX_ELEMENTS, limit_error
from importers.svg.arcs import arc_segments

# Possessive throughout: a number never gives digits back, and the time is linear in the text whatever it holds.
_NUMBER = r"[-+]?+(?:[0-9]++(?:\.[0-9]++)?+|\.[0-9]++)(?:[eE][-+]?+[0-9]++)?+"
_WS = r"[ \t\r\n\f]"
_COMMA = rf"(?:{_WS}*+,?+{_WS}*+)"
NUMBER = re.compile(_NUMBER)
COMMA = re.compile(_COMMA)
# Commands with their numbers, lexically: everything up to the first sign that cannot be there.
_LEXICAL = re.compile(rf"(?:{_WS}*+[MmZzLlHhVvCcSsQqTtAa](?:{_WS}*+{_NUMBER}(?:{_COMMA}{_NUMBER})*+)?+)*+{_WS}*+")
_ARC = re.compile(
    rf"{_COMMA}({_NUMBER}){_COMMA}({_NUMBER}){_COMMA}({_NUMBER}){_COMMA}([01]){_COMMA}([01]){_COMMA}"
    rf"({_NUMBER}){_COMMA}({_NUMBER})"
)
MAX_NUMBERS = 3 * MAX_ELEMENTS
# Letter to command and whether it is relative; command to how many numbers it takes at a time.
_COMMANDS = {letter: (letter.upper(), letter.islower()) for letter in "MmZzLlHhVvCcSsQqTtAa"}
_COUNTS = {"M": 2, "L": 2, "H": 1, "V": 1, "C": 6, "S": 4, "Q": 4, "T": 2, "A": 7}
_TOKEN = re.compile(rf"[MmZzLlHhVvCcSsQqTtAa]|{_NUMBER}")
_FLAGS = {"0": False, "1": True}


class Fault(NamedTuple):
    """Where and why the reading of an attribute stopped.

    Attributes:
        offset: index into the attribute's value.
        message: what is wrong there.
    """

    offset: int
    message: str


def parse_path_data(text: str) -> tuple[list[Subpath], Fault | None]:
    """Read path data up to its end or its first error.

    Args:
        text: the value of ``d``.

    Returns:
        The subpaths (each begins with its ``M``; one that only moves is kept, the caller decides) and the
        fault, None when all of it is right.
    """
    check_length(text)
    match = _LEXICAL.match(text)
    end = match.end() if match else 0
    fault = _lexical_fault(text, end) if end < len(text) else None
    end = _without_broken_number(text, end)
    words = text if end == len(text) else text[:end]
    has_arcs = "a" in words or "A" in words
    if not has_arcs and "e" not in words and "E" not in words:
        tokens = _split(words)
        subpaths, used = _interpret(tokens)
        if used == len(tokens) and not _ends_unfinished(tokens):
            return subpaths, fault
    spans = _arc_spans(words) if has_arcs else [match.span() for match in _TOKEN.finditer(words)]
    tokens = [words[start:stop] for start, stop in spans]
    huge = (i for i, token in enumerate(tokens) if token not in _COMMANDS and math.isinf(float(token)))
    stop = next(huge, len(tokens))
    subpaths, used = _interpret(tokens[:stop])
    if used < len(tokens) or _ends_unfinished(tokens):
        fault = _command_fault(tokens, spans, used, stop, fault)
    return subpaths, fault


def _ends_unfinished(tokens: list[str]) -> bool:
    """Tell whether the last token is a command that lacks its numbers."""
    return bool(tokens) and tokens[-1] in _COMMANDS and tokens[-1] not in "Zz"


def check_length(text: str) -> None:
    """Raise LimitError when a list has more numbers than a drawing of MAX_ELEMENTS segments can need."""
    if len(text) > MAX_NUMBERS and any(True for _ in itertools.islice(NUMBER.finditer(text), MAX_NUMBERS, None)):
        raise limit_error("numbers of one path", f"{MAX_NUMBERS:,}")


def _split(words: str) -> list[str]:
    """Give the tokens of plain path data; numbers run together as ``.5.5`` stay one, which then is no number.

    Python's split is three times as fast as any regular expression, and most drawings need no more.
    """
    for letter in _COMMANDS:
        if letter in words:
            words = words.replace(letter, f" {letter} ")
    return words.replace(",", " ").replace("-", " -").replace("+", " +").split()


def _arc_spans(words: str) -> list[tuple[int, int]]:
    """Give start and stop of each token of a text with arcs, where ``a1 1 0 01.5.5`` has flags 0 and 1."""
    spans: list[tuple[int, int]] = []
    position, arcs = 0, False
    while position < len(words):
        arc = _ARC.match(words, position) if arcs else None
        if arc is not None:
            spans += arc.regs[1:]
            position = arc.end()
            continue
        token = _TOKEN.search(words, position)
        if token is None:
            break
        spans.append(token.span())
        if token[0] in _COMMANDS:
            arcs = token[0] in "aA"
        position = token.end()
    return spans


def _interpret(tokens: list[str]) -> tuple[list[Subpath], int]:
    """Draw commands and their numbers; give the subpaths and how many tokens were used before a fault.

    A relative command adds the current point to its numbers, an absolute one 0. Missing numbers show as a token that is
    none, or no token: a ValueError either way. What failed at once (-1) is not tried so again.
    """
    subpaths: list[Subpath] = []
    segments: list[Segment] = []
    kind, last, relative, is_open, done = "", "", False, False, 0
    x = y = start_x = start_y = bx = by = cx = cy = 0.0
    i, count = 0, len(tokens)
    while i < count:
        if tokens[i] in _COMMANDS:
            if not subpaths and tokens[i] not in "Mm":
                break
            kind, relative = _COMMANDS[tokens[i]]
            i += 1
            if kind == "Z":
                _close(subpaths, is_open, start_x, start_y)
                x, y, last, is_open = start_x, start_y, "", False
                continue
        elif kind == "M":
            kind = "L"
        elif kind == "Z":
            break
        bx, by = (x, y) if relative else (0.0, 0.0)
        if not is_open and kind != "M":
            is_open, segments = True, [("M", x, y)]
            subpaths.append(Subpath(segments, closed=False))
        done = _same_again(segments, tokens, i, relative) if kind == "C" and done >= 0 else min(done, 0)
        if done > 0:
            i, last = i + 7 * done - 1, kind
            _, _, _, cx, cy, x, y = segments[-1]
            continue
        try:
            if kind == "L":
                x, y = float(tokens[i]) + bx, float(tokens[i + 1]) + by
                segments.append(("L", x, y))
            elif kind == "C":
                x1, y1, cx, cy, x, y = map(float, tokens[i : i + 6])
                cx, cy, x, y = cx + bx, cy + by, x + bx, y + by
                segments.append(("C", x1 + bx, y1 + by, cx, cy, x, y))
            elif kind == "M":
                x, y = float(tokens[i]) + bx, float(tokens[i + 1]) + by
                start_x, start_y, is_open, segments = x, y, True, [("M", x, y)]
                subpaths.append(Subpath(segments, closed=False))
            elif kind == "H" or kind == "V":
                number = float(tokens[i])
                x, y = (number + bx, y) if kind == "H" else (x, number + by)
                segments.append(("L", x, y))
            elif kind == "A":
                arc, x, y = _arc(x, y, bx, by, tokens[i : i + 7])
                segments += arc
            else:
                last, cx, cy, x, y = _curve(segments, kind, last, cx, cy, x, y, bx, by, tokens[i : i + _COUNTS[kind]])
        except (ValueError, IndexError, KeyError):
            break
        i += _COUNTS[kind]
        last = last if kind in "SQT" else kind
    return subpaths, i


def _close(subpaths: list[Subpath], is_open: bool, x: float, y: float) -> None:
    """Close the last subpath, or one that is a point."""
    if not is_open:
        subpaths.append(Subpath([("M", x, y)], closed=False))
    subpaths[-1].closed = True


def _same_again(segments: list[Segment], tokens: list[str], i: int, relative: bool) -> int:
    """Draw as many C as follow one another, all their numbers at once; none where one of these is none.

    Args:
        segments: of the subpath, its last point in the last of them; the curves are put behind.
        tokens: all of them.
        i: behind the first letter.
        relative: it is a small one.

    Returns:
        How many were drawn; 0 where the first stands alone, -1 where something of them is no number.
    """
    letter = tokens[i - 1]
    if letter not in ("C", "c") or tokens[i + 6 : i + 7] != [letter]:
        return 0
    count = min(sum(1 for _ in itertools.takewhile(letter.__eq__, tokens[i - 1 :: 7])), (len(tokens) - i + 1) // 7)
    end = i + 7 * count - 1
    try:
        columns = [list(map(float, tokens[i + k : end : 7])) for k in range(6)]
    except ValueError:
        return -1
    if relative:
        begins = [list(itertools.accumulate([at, *columns[4 + k]])) for k, at in enumerate(segments[-1][-2:])]
        columns = [list(map(operator.add, column, begins[k % 2])) for k, column in enumerate(columns)]
    segments += zip(itertools.repeat("C"), *columns)
    return count


def _arc(x0: float, y0: float, bx: float, by: float, tokens: list[str]) -> tuple[list[Segment], float, float]:
    """Draw A from a point: its segments, and the point where it ends.

    Raises:
        ValueError: a number is missing or none; a KeyError or an IndexError: a flag, or the end, is.
    """
    rx, ry, degrees = map(float, tokens[:3])
    large, sweep = _FLAGS[tokens[3]], _FLAGS[tokens[4]]
    x, y = float(tokens[5]) + bx, float(tokens[6]) + by
    return arc_segments(x0, y0, rx, ry, degrees, large, sweep, x, y), x, y


def _curve(
    segments: list[Segment],
    kind: str,
    last: str,
    cx: float,
    cy: float,
    x: float,
    y: float,
    bx: float,
    by: float,
    tokens: list[str],
) -> tuple[str, float, float, float, float]:
    """Draw S, Q or T; give what the next smooth curve goes by: kind, control point, current point.

    The control point that S and T leave out is the last one mirrored at the current point where the last
    segment was a curve of the same degree, else the current point.
    """
    numbers = list(map(float, tokens))
    if len(numbers) != _COUNTS[kind]:
        raise ValueError("numbers are missing")
    x1, y1 = (2 * x - cx, 2 * y - cy) if last == ("C" if kind == "S" else "Q") else (x, y)
    x, y = numbers[-2] + bx, numbers[-1] + by
    if kind == "S":
        cx, cy = numbers[0] + bx, numbers[1] + by
        segments.append(("C", x1, y1, cx, cy, x, y))
        return "C", cx, cy, x, y
    cx, cy = (numbers[0] + bx, numbers[1] + by) if kind == "Q" else (x1, y1)
    segments.append(("Q", cx, cy, x, y))
    return "Q", cx, cy, x, y


def _without_broken_number(text: str, end: int) -> int:
    """Step back over a number that goes on wrongly, as ``20.`` or ``3e+``: browsers use none of it."""
    last = text[max(0, end - 400) : end]
    if end >= len(text) or not last[-1:].isdigit():
        return end
    word = re.split(r"[^0-9.eE+-]|(?<![eE])[+-]", last)[-1].lower()
    exponent = text[end] in "eE" and end + 1 < len(text) and text[end + 1] not in "xm" and "e" not in word
    point = text[end] == "." and "." not in word and "e" not in word
    if not (exponent or point):
        return end
    number = re.search(r"[-+]?(?:[0-9]+(?:\.[0-9]+)?|\.[0-9]+)$", last)
    return end - len(number[0]) if number else end


def _lexical_fault(text: str, end: int) -> Fault:
    rest = text[end:].lstrip(" \t\r\n\f,")
    place = len(text) - len(rest)
    if not rest:
        return Fault(text.rindex(","), "a comma is left over at the end")
    commas = [index for index in range(end, place) if text[index] == ","]
    if commas:  # the first of two is right
        return Fault(commas[min(1, len(commas) - 1)], "a comma is not expected here")
    if end == 0 or not text[:end].strip():
        return Fault(place, f"path data begin with M or m, not with {rest[0]!r}")
    return Fault(place, f"{rest[0]!r} is not expected here")


def _command_fault(
    tokens: list[str], spans: list[tuple[int, int]], used: int, stop: int, lexical: Fault | None
) -> Fault:
    """Say why the reading stopped at a token.

    Args:
        tokens: all of them.
        spans: where they stand.
        used: how many were drawn.
        stop: where the numbers become too large; all of them where none does.
        lexical: the fault behind the tokens, which is why numbers are missing at their end.
    """
    if used < stop and tokens[used] in _COMMANDS and not any(token in "Mm" for token in tokens[:used]):
        return Fault(spans[used][0], f"path data begin with M or m, not with {tokens[used]!r}")
    after = next((i for i in range(used, stop) if tokens[i] in _COMMANDS), stop)
    if after == stop and stop < len(tokens):
        return Fault(spans[stop][0], "the number is too large")
    if after == stop and lexical is not None:
        return lexical
    command = next(token for token in reversed(tokens[:used]) if token in _COMMANDS)
    kind = _COMMANDS[command][0]
    if kind == "Z":
        return Fault(spans[used][0], f"a number after {command}, which takes none")
    for flag, name in ((3, "large-arc flag"), (4, "sweep flag")):
        if kind == "A" and used + flag < after and tokens[used + flag] not in _FLAGS:
            return Fault(spans[used + flag][0], f"the {name} of an arc is 0 or 1")
    needs = "a number" if _COUNTS[kind] == 1 else f"{_COUNTS[kind]} numbers"
    return Fault(spans[after - 1][1], f"{command} takes {needs} at a time, here are {after - used}")
