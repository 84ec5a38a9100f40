"""Segments of path data (lines, Bezier curves, elliptic arcs) as short chords, for what is looked at."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from wallkit.geometry.arrays import FloatArray
from wallkit.geometry.ellipse_arcs import centre_form

_CURVE = 24  # chords a Bezier curve, half as many as an arc of a drawing


def chords(start: FloatArray, kind: str, numbers: tuple[float, ...]) -> FloatArray:
    """Sample one segment of path data (L, Q, C or A, absolute) from ``start``, its end included and start not."""
    return np.asarray(_sampled(kind, np.array([start]), np.array([numbers], dtype=np.float64))[0])


def polylines(commands: Sequence[tuple[Any, ...]]) -> list[FloatArray]:
    """Give each subpath as (n, 2) points, curves and arcs cut into chords; a closed one ends where it began.

    Args:
        commands: absolute path data, of which each subpath begins with M; Z at most at its end.
    """
    if not commands:
        return []
    letters = "".join([command[0] for command in commands])
    if letters == "M" + "L" * (len(letters) - 1):
        return [np.array([command[1:] for command in commands], dtype=np.float64)]
    kinds = np.array(list(letters))
    begins = np.flatnonzero(kinds == "M")
    opened = begins[np.cumsum(kinds == "M") - 1]  # the M that each command belongs to
    ends = np.array([command[-2:] if len(command) > 2 else (0.0, 0.0) for command in commands], dtype=np.float64)
    closing = np.flatnonzero(kinds == "Z")
    ends[closing] = ends[opened[closing]]
    sampled: list[tuple[np.ndarray[Any, Any], FloatArray]] = []
    counts = np.ones(len(commands), dtype=np.int64)
    for kind in ("Q", "C", "A"):
        found = np.flatnonzero(kinds == kind)
        if len(found):
            numbers = np.array([commands[index][1:] for index in found.tolist()], dtype=np.float64)
            points = _sampled(kind, ends[found - 1], numbers)
            counts[found] = points.shape[1]
            sampled.append((found, points))
    last = np.cumsum(counts)
    every = np.empty((int(last[-1]), 2))
    every[last - 1] = ends
    for found, points in sampled:
        every[(last - counts)[found][:, None] + np.arange(points.shape[1])] = points
    return np.split(every, (last - counts)[begins[1:]])


def _sampled(kind: str, start: FloatArray, numbers: FloatArray) -> FloatArray:
    """Sample n segments of one kind: (n, m, 2), the ends included and the starts not.

    Args:
        kind: L, Q, C or A.
        start: (n, 2).
        numbers: (n, k) what follows the letter.
    """
    t: FloatArray = np.linspace(0.0, 1.0, _CURVE + 1)[1:, None]
    start, end = start[:, None], numbers[:, None, -2:]
    if kind == "Q":
        return np.asarray((1 - t) ** 2 * start + 2 * t * (1 - t) * numbers[:, None, :2] + t * t * end)
    if kind == "C":
        first, second = numbers[:, None, :2], numbers[:, None, 2:4]
        outer = (1 - t) ** 3 * start + t**3 * end
        return np.asarray(outer + 3 * t * (1 - t) ** 2 * first + 3 * t * t * (1 - t) * second)
    if kind == "A":
        return _arcs(start[:, 0], numbers)
    return end


def _arcs(start: FloatArray, numbers: FloatArray) -> FloatArray:
    """Sample elliptic arcs in end-point form, ends included; all at their ends where they have no radius: a line."""
    part = np.linspace(0.0, 1.0, 2 * _CURVE + 1)[1:]
    points = np.repeat(numbers[:, None, -2:], len(part), axis=1)
    round_ = np.flatnonzero((numbers[:, 0] != 0.0) & (numbers[:, 1] != 0.0))
    arc = centre_form(np.hstack([start, numbers])[round_])
    angle = (arc.start + arc.turn * part[:, None]).T
    which = np.repeat(np.arange(len(round_)), len(part))
    points[round_] = arc.take(which).points(angle.ravel()).reshape(len(round_), len(part), 2)
    points[round_, -1] = numbers[round_, -2:]
    return points
