"""Problem: one thing about a drawing that its owner should know, with its place and what to do."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Literal, get_args

Severity = Literal["error", "warning", "info"]


@dataclass(frozen=True, slots=True)
class Problem:
    """One finding. Readers and the wall builder return these; nothing is dropped without one.

    Attributes:
        code: a stable word for programs, such as ``"open-path"``; docs/problems.md lists them all.
        severity: ``"error"`` (something is missing or wrong in the result), ``"warning"`` (the result is
            complete, but probably not what was meant) or ``"info"`` (something was left out by rule).
        message: what is the case, in one sentence.
        fix: what to do about it.
        layer: the layer's name, or ``""``.
        name: the object's name, or ``""``.
        line: line in the file, from 1, or None.
        column: column in that line, from 1, or None.
        x: place in the drawing, in its units and axes, or None.
        y: the same for y.
        excerpt: the line of the file that ``column`` points into and a caret line under it, as
            :func:`importers.excerpts.excerpt` makes them (the bare line will do where it is short); or ``""``.
    """

    code: str
    severity: Severity
    message: str
    fix: str = ""
    layer: str = ""
    name: str = ""
    line: int | None = None
    column: int | None = None
    x: float | None = None
    y: float | None = None
    excerpt: str = ""

    def to_json(self) -> dict[str, Any]:
        """Give the finding as the JSON contracts have it (without the excerpt)."""
        return {
            "code": self.code,
            "severity": self.severity,
            "message": self.message,
            "fix": self.fix,
            "layer": self.layer,
            "name": self.name,
            "line": self.line,
            "column": self.column,
            "x": self.x,
            "y": self.y,
        }

    @staticmethod
    def of_json(entry: Mapping[str, Any]) -> Problem:
        """Read one that :meth:`to_json` wrote, with its excerpt where there is one.

        Raises:
            TypeError: a key is not known, or holds what it cannot.
            ValueError: a place is no finite number.
        """
        found = Problem(**entry)
        texts = (found.code, found.message, found.fix, found.layer, found.name, found.excerpt)
        if not all(isinstance(text, str) for text in texts) or found.severity not in get_args(Severity):
            raise TypeError("a problem has a code, a severity and other texts")
        for place in (found.line, found.column, found.x, found.y):
            if place is not None and not math.isfinite(place):
                raise ValueError(f"the place of a problem is {place}")
        return found
