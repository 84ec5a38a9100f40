"""Media queries: what a browser on a bare machine answers, in three values (it holds, it does not, nobody knows)."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import tinycss2

from importers.numbers import NumberError
from importers.svg.units import ROOT_FONT, WINDOW, parse_length, to_px, unreadable

# What the browser says that the tests measure with; in a query without a value, "none" and the like are no.
_WORDS = {
    "prefers-color-scheme": "light",
    "prefers-reduced-motion": "no-preference",
    "prefers-reduced-transparency": "no-preference",
    "prefers-reduced-data": "no-preference",
    "prefers-contrast": "no-preference",
    "forced-colors": "none",
    "inverted-colors": "none",
    "orientation": "landscape",
    "scripting": "enabled",
    "update": "fast",
    "display-mode": "browser",
}
_NO = frozenset(("none", "no-preference"))
_SIZES = {"width": WINDOW[0], "height": WINDOW[1]}
_COMPARE: dict[str, Callable[[float, float], bool]] = {
    "<": lambda a, b: a < b,
    "<=": lambda a, b: a <= b,
    ">": lambda a, b: a > b,
    ">=": lambda a, b: a >= b,
    "=": lambda a, b: a == b,
}

Answer = bool | None


def matches_media(query: str) -> bool:
    """Tell whether a list of media queries holds on the screen that lengths in ``vw`` and ``vh`` assume."""
    if unreadable(query):
        return False
    tokens = [
        token for token in tinycss2.parse_component_value_list(query, skip_comments=True) if token.type != "whitespace"
    ]
    return not tokens or any(_query(one) for one in _split(tokens, ","))


def _split(tokens: list[Any], sign: str) -> list[list[Any]]:
    parts: list[list[Any]] = [[]]
    for token in tokens:
        if token.type == "literal" and token.value == sign:
            parts.append([])
        else:
            parts[-1].append(token)
    return parts


def _word(tokens: list[Any], place: int) -> str:
    return tokens[place].lower_value if place < len(tokens) and tokens[place].type == "ident" else ""


def _query(tokens: list[Any]) -> bool:
    """Answer one query: a medium with conditions, or conditions alone; what is wrong or unknown does not hold."""
    place = 1 if _word(tokens, 0) in ("not", "only") else 0
    medium = _word(tokens, place)
    if not medium:
        return _condition(tokens) is True
    answer: Answer = medium in ("all", "screen")
    if place + 1 < len(tokens):
        rest = tokens[place + 2 :]
        if _word(tokens, place + 1) != "and" or "or" in (_word(rest, i) for i in range(len(rest))):
            return False
        answer = _all((answer, _condition(rest)))
    if _word(tokens, 0) == "not":
        answer = None if answer is None else not answer
    return answer is True


def _condition(tokens: list[Any]) -> Answer:
    """Answer ``(a) and (b)``, ``(a) or (b)`` or ``not (a)``."""
    if _word(tokens, 0) == "not":
        inner = _bracket(tokens[1]) if len(tokens) == 2 else None
        return None if inner is None else not inner
    answers = [_bracket(token) if _word([token], 0) != "not" else None for token in tokens[0::2]]
    between = {_word(tokens, i) for i in range(1, len(tokens), 2)}
    if not tokens or len(tokens) % 2 == 0 or len(between) > 1 or not between <= {"and", "or"}:
        return None
    return _any(answers) if between == {"or"} else _all(answers)


def _all(answers: Any) -> Answer:
    answers = list(answers)
    return False if False in answers else (None if None in answers else True)


def _any(answers: list[Answer]) -> Answer:
    return True if True in answers else (None if None in answers else False)


def _bracket(token: Any) -> Answer:
    """Answer what stands in one pair of brackets: a condition again, or a feature."""
    if token.type != "() block":
        return None
    inside = [inner for inner in token.content if inner.type not in ("whitespace", "comment")]
    if inside and (inside[0].type == "() block" or _word(inside, 0) == "not"):
        return _condition(inside)
    name, value = _word(inside, 0), inside[2:]
    if name and len(inside) > 2 and inside[1].type == "literal" and inside[1].value == ":":
        return _feature(name, value)
    if name and len(inside) == 1:
        return _WORDS[name] not in _NO if name in _WORDS else (True if name in _SIZES else None)
    return _range(inside)


def _feature(name: str, value: list[Any]) -> Answer:
    if name in _WORDS:
        return _word(value, 0) == _WORDS[name] if len(value) == 1 else None
    least, most = name.startswith("min-"), name.startswith("max-")
    size = _SIZES.get(name[4:] if least or most else name)
    wanted = _length(value)
    if size is None or wanted is None:
        return None
    return _COMPARE[">=" if least else "<=" if most else "="](size, wanted)


def _range(tokens: list[Any]) -> Answer:
    """Answer ``width >= 10px`` and ``10px < width <= 20px``."""
    parts: list[list[Any]] = [[]]
    signs: list[str] = []
    for token in tokens:
        if token.type == "literal" and token.value in ("<", ">", "=", "<=", ">="):
            if not parts[-1] and signs and signs[-1] in "<>" and token.value == "=":
                signs[-1] += "="  # "<" and "=" come one by one
                continue
            signs.append(token.value)
            parts.append([])
        else:
            parts[-1].append(token)
    values = [_SIZES.get(_word(part, 0)) if len(part) == 1 and _word(part, 0) else _length(part) for part in parts]
    named = sum(_word(part, 0) in _SIZES for part in parts)
    if None in values or not 1 <= len(signs) <= 2 or named != 1:
        return None
    return all(_COMPARE[sign](values[i], values[i + 1]) for i, sign in enumerate(signs))  # type: ignore[arg-type]


def _length(tokens: list[Any]) -> float | None:
    try:
        terms = parse_length(tinycss2.serialize(tokens).strip(), False)
        return None if terms is None else to_px(terms, 0.0, ROOT_FONT)
    except NumberError:
        return None
