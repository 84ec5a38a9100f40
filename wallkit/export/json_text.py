"""JSON with a line for each wall, so that people can look into it and diff it; numbers as repr."""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from wallkit.export.number_text import rows
from wallkit.geometry.arrays import FloatArray

_POINT = '{"x": %r, "y": %r}'
_LISTS = 500  # written at once


class Written(str):
    """A part of the file that is JSON already."""

    __slots__ = ()


def spread(value: Any, depth: int) -> str:
    """Write JSON and a line end: the outer ``depth`` levels one entry a line, what is deeper on one line."""
    return "".join([*_pieces(value, depth, 0), "\n"])


def _pieces(value: Any, depth: int, indent: int) -> Iterator[str]:
    if isinstance(value, Written):
        yield value
        return
    if not isinstance(value, dict | list) or not value:
        yield json.dumps(value, ensure_ascii=False, allow_nan=False)
        return
    before, between, after = "", ", ", ""
    if depth > 0:
        before = "\n" + " " * (indent + 1)
        between, after = "," + before, "\n" + " " * indent
    yield ("{" if isinstance(value, dict) else "[") + before
    for number, one in enumerate(value):
        if number:
            yield between
        if isinstance(value, dict):
            yield json.dumps(one, ensure_ascii=False) + ": "
            one = value[one]
        yield from _pieces(one, depth - 1, indent + 1)
    yield after + ("}" if isinstance(value, dict) else "]")


def point_lists(pieces: Sequence[FloatArray], before: str = "", after: str = "") -> Written:
    """Write many short lists of points, each between two texts."""
    blocks = []
    for start in range(0, len(pieces), _LISTS):
        some = pieces[start : start + _LISTS]
        lists = [f"{before}[{', '.join([_POINT] * len(piece))}]{after}" for piece in some]
        blocks.append(", ".join(lists) % tuple(np.concatenate(some).ravel().tolist()))
    return Written("[" + ", ".join(blocks) + "]")


def points(vertices: FloatArray) -> Written:
    """Write (n, 2) points as JSON has them in most engines: a list of x and y."""
    return Written("[" + rows(_POINT, vertices) + "]")


def point(x: float, y: float) -> dict[str, float]:
    """Give one such point."""
    return {"x": float(x), "y": float(y)}


def numbers(values: FloatArray) -> Written:
    """Write an array: (n,) as a list, (n, k) as a list of lists."""
    template = "%r" if values.ndim == 1 else "[" + ", ".join(["%r"] * values.shape[1]) + "]"
    return Written("[" + rows(template, values) + "]")
