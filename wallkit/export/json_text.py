"""JSON with a line for each wall, so that people can look into it and diff it; numbers as repr."""

from __future__ import annotations

import json
from dataclasses import dataclass
from typing import Any, TextIO

import numpy as np

from wallkit.export.number_text import Rows
from wallkit.export.pieces import Pieces
from wallkit.geometry.arrays import FloatArray

_POINT = '{"x": %r, "y": %r}'
_LISTS = 500  # written at once


@dataclass(frozen=True, slots=True)
class PointLists:
    """Many short lists of points, each between two texts.

    Attributes:
        pieces: the points of each list.
        before: text before each list.
        after: text behind each.
        backwards: the last point of each list is written first.
    """

    pieces: Pieces
    before: str = ""
    after: str = ""
    backwards: bool = False

    def write(self, stream: TextIO) -> None:
        """Write all of it as a JSON list."""
        stream.write("[")
        for number, some in enumerate(self.pieces.blocks(_LISTS)):
            lists = [
                f"{self.before}[{', '.join([_POINT] * count)}]{self.after}" for count in np.diff(some.offsets).tolist()
            ]
            points = some.turned().vertices if self.backwards else some.vertices
            stream.write(", " if number else "")
            stream.write(", ".join(lists) % tuple(points.ravel().tolist()))
        stream.write("]")


def write_json(value: Any, depth: int, stream: TextIO) -> None:
    """Write JSON and a line end: the outer ``depth`` levels one entry a line, what is deeper on one line."""
    _write(value, depth, 0, stream)
    stream.write("\n")


def _write(value: Any, depth: int, indent: int, stream: TextIO) -> None:
    if isinstance(value, Rows | PointLists):
        value.write(stream)
        return
    if not isinstance(value, dict | list) or not value:
        stream.write(json.dumps(value, ensure_ascii=False, allow_nan=False))
        return
    before, between, after = "", ", ", ""
    if depth > 0:
        before = "\n" + " " * (indent + 1)
        between, after = "," + before, "\n" + " " * indent
    stream.write(("{" if isinstance(value, dict) else "[") + before)
    for number, one in enumerate(value):
        if number:
            stream.write(between)
        if isinstance(value, dict):
            stream.write(json.dumps(one, ensure_ascii=False) + ": ")
            one = value[one]
        _write(one, depth - 1, indent + 1, stream)
    stream.write(after + ("}" if isinstance(value, dict) else "]"))


def points(vertices: FloatArray) -> Rows:
    """Write (n, 2) points as JSON has them in most engines: a list of x and y."""
    return Rows(_POINT, vertices, before="[", after="]")


def point(x: float, y: float) -> dict[str, float]:
    """Give one such point."""
    return {"x": float(x), "y": float(y)}


def numbers(values: FloatArray) -> Rows:
    """Write an array: (n,) as a list, (n, k) as a list of lists."""
    template = "%r" if values.ndim == 1 else "[" + ", ".join(["%r"] * values.shape[1]) + "]"
    return Rows(template, values, before="[", after="]")
