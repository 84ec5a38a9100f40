"""Segments: those of many subpaths as arrays, so that what follows runs without a Python loop per edge.

Quadratics are raised to cubics (the same curve). Elliptic arcs go from their end points to centre and axes.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from importers.drawing import Segment, Subpath
from wallkit.geometry.arrays import FloatArray, IntArray
from wallkit.geometry.ellipse_arcs import Arcs, centre_form

KIND_LINE, KIND_CUBIC, KIND_ARC = 0, 1, 2


@dataclass(slots=True)
class Segments:
    """Subpaths as arrays: subpath ``s`` has the segments ``offsets[s]`` to ``offsets[s + 1]``.

    Attributes:
        starts: (S, 2) where each subpath starts.
        offsets: (S + 1,) int64.
        kinds: (N,) KIND_LINE, KIND_CUBIC or KIND_ARC.
        ends: (N, 2) end point of each segment, bit for bit as in the file.
        begins: (N, 2) start point of each segment.
        cubics: (C, 4, 2) the cubics, in order.
        arcs: the arcs, in order.
    """

    starts: FloatArray
    offsets: IntArray
    kinds: NDArray[np.int8]
    ends: FloatArray
    begins: FloatArray
    cubics: FloatArray
    arcs: Arcs


def gather(subpaths: Iterable[Subpath], scale: float = 1.0, flip_y: bool = False) -> Segments:
    """Collect subpaths into arrays, scaled and mirrored if asked (untouched bit for bit if not)."""
    starts: list[tuple[float, float]] = []
    offsets, kinds, ends = [0], [], []
    cubics: list[tuple[float, ...]] = []
    arcs: list[tuple[float, ...]] = []
    for sub in subpaths:
        x, y = sub.segments[0][1:3]
        starts.append((x, y))
        for segment in sub.segments[1:]:
            kinds.append(_add(segment, x, y, cubics, arcs))
            x, y = segment[-2:]
            ends.append((x, y))
        offsets.append(len(kinds))
    factor = np.array([scale, -scale if flip_y else scale])
    start_array = np.array(starts, dtype=np.float64).reshape(-1, 2) * factor
    end_array = np.array(ends, dtype=np.float64).reshape(-1, 2) * factor
    offset_array = np.array(offsets, dtype=np.int64)
    return Segments(
        starts=start_array,
        offsets=offset_array,
        kinds=np.array(kinds, dtype=np.int8),
        ends=end_array,
        begins=_begins(start_array, offset_array, end_array),
        cubics=np.array(cubics, dtype=np.float64).reshape(-1, 4, 2) * factor,
        arcs=_scaled(centre_form(np.array(arcs, dtype=np.float64).reshape(-1, 9)), factor),
    )


def _add(segment: Segment, x: float, y: float, cubics: list[tuple[float, ...]], arcs: list[tuple[float, ...]]) -> int:
    kind = segment[0]
    if kind == "L":
        return KIND_LINE
    if kind == "C":
        cubics.append((x, y, *segment[1:]))
        return KIND_CUBIC
    if kind == "Q":
        x1, y1, x2, y2 = segment[1:]
        third = (x + 2 * x1) / 3, (y + 2 * y1) / 3, (x2 + 2 * x1) / 3, (y2 + 2 * y1) / 3
        cubics.append((x, y, *third, x2, y2))
        return KIND_CUBIC
    arcs.append((x, y, *segment[1:]))
    return KIND_ARC


def _begins(starts: FloatArray, offsets: IntArray, ends: FloatArray) -> FloatArray:
    begins = np.empty_like(ends)
    begins[1:] = ends[:-1]
    drawn = np.diff(offsets) > 0
    begins[offsets[:-1][drawn]] = starts[drawn]
    return begins


def _scaled(arcs: Arcs, factor: FloatArray) -> Arcs:
    mirrored = factor[0] * factor[1] < 0
    u, v = arcs.u * factor, arcs.v * factor
    if not mirrored:
        return Arcs(arcs.centre * factor, u, v, arcs.start, arcs.turn)
    return Arcs(arcs.centre * factor, u, -v, -arcs.start, -arcs.turn)  # v a quarter turn left of u again


def default_tolerance(strokes: Segments, most: float = 0.1) -> float:
    """0.1 % of the diagonal of the box of all end and control points, at most ``most``."""
    points = np.concatenate([strokes.starts, strokes.ends, strokes.cubics.reshape(-1, 2)])
    if not len(points):
        return most
    diagonal = float(np.hypot(*(points.max(axis=0) - points.min(axis=0))))
    return min(most, diagonal / 1000) or most
