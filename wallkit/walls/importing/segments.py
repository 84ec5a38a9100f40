"""Segments: those of many subpaths as arrays, so that what follows runs without a Python loop per edge.

Quadratics are raised to cubics (the same curve). Elliptic arcs go from their end points to centre and axes.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from itertools import chain

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
    first: list[Segment] = []
    segments: list[Segment] = []
    offsets = [0]
    for sub in subpaths:
        first.append(sub.segments[0])
        segments += sub.segments[1:]
        offsets.append(len(segments))
    factor = np.array([scale, -scale if flip_y else scale])
    start_array = _numbers([segment[1:3] for segment in first], 2)
    end_array = _numbers([segment[-2:] for segment in segments], 2)
    offset_array = np.array(offsets, dtype=np.int64)
    begins = _begins(start_array, offset_array, end_array)
    letters = [segment[0] for segment in segments]
    kinds = np.array([_KINDS[letter] for letter in letters], dtype=np.int8)
    arc_at = np.flatnonzero(kinds == KIND_ARC)
    arcs = np.concatenate([begins[arc_at], _numbers([segments[k][1:] for k in arc_at.tolist()], 7)], axis=1)
    return Segments(
        starts=start_array * factor,
        offsets=offset_array,
        kinds=kinds,
        ends=end_array * factor,
        begins=begins * factor,
        cubics=_cubics(segments, letters, begins, np.flatnonzero(kinds == KIND_CUBIC)) * factor,
        arcs=_scaled(centre_form(arcs), factor),
    )


_KINDS = {"L": KIND_LINE, "C": KIND_CUBIC, "Q": KIND_CUBIC, "A": KIND_ARC}


def _numbers(rows: list[tuple[float, ...]], width: int) -> FloatArray:
    """Rows of ``width`` numbers as an array."""
    flat = np.fromiter(chain.from_iterable(rows), dtype=np.float64, count=width * len(rows))
    return flat.reshape(-1, width)


def _cubics(segments: list[Segment], letters: list[str], begins: FloatArray, at: IntArray) -> FloatArray:
    """Control points (C, 4, 2) of the segments ``at``, cubics and quadratics."""
    rows = at.tolist()
    quadratic = np.array([letters[k] == "Q" for k in rows], dtype=np.bool_)
    cubics = np.empty((len(at), 4, 2))
    cubics[:, 0] = begins[at]
    cubics[~quadratic, 1:] = _numbers([segments[k][1:] for k in at[~quadratic].tolist()], 6).reshape(-1, 3, 2)
    if quadratic.any():
        start = cubics[quadratic, 0]
        middle, end = np.split(_numbers([segments[k][1:] for k in at[quadratic].tolist()], 4), 2, axis=1)
        cubics[quadratic, 1:] = np.stack([(start + 2 * middle) / 3, (end + 2 * middle) / 3, end], axis=1)
    return cubics


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


def default_tolerance(segments: Segments, most: float = 0.1) -> float:
    """0.1 % of the diagonal of the box of all end and control points, at most ``most``."""
    points = np.concatenate([segments.starts, segments.ends, segments.cubics.reshape(-1, 2)])
    if not len(points):
        return most
    diagonal = float(np.hypot(*(points.max(axis=0) - points.min(axis=0))))
    return min(most, diagonal / 1000) or most
