"""Segments: those of many subpaths as arrays, so that what follows runs without a Python loop per edge.

Quadratics are raised to cubics (the same curve). Elliptic arcs go from their end points to centre and axes.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from itertools import chain, groupby

import numpy as np
from numpy.typing import NDArray

from importers.drawing import Subpath
from importers.subpaths import NUMBERS
from wallkit.geometry.arrays import FloatArray, IntArray
from wallkit.geometry.ellipse_arcs import Arcs, centre_form

KIND_LINE, KIND_CUBIC, KIND_ARC = 0, 1, 2


@dataclass(slots=True, eq=False, repr=False)
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
    letters, numbers, sizes = _strung(subpaths)
    last = np.cumsum(_NUMBERS[letters])  # behind each segment's numbers
    points = np.stack([numbers[last - 2], numbers[last - 1]], axis=1)
    first = np.zeros(len(letters), dtype=np.bool_)
    first[np.cumsum(sizes) - sizes] = True
    letters, last = letters[~first], last[~first]
    starts, ends = points[first], points[~first]
    offsets = np.concatenate([[0], np.cumsum(sizes - 1)])
    begins = _begins(starts, offsets, ends)
    kinds = _KINDS[letters]
    factor = np.array([scale, -scale if flip_y else scale])
    arc_at = np.flatnonzero(kinds == KIND_ARC)
    arcs = np.concatenate([begins[arc_at], _columns(numbers, last[arc_at], 7)], axis=1)
    return Segments(
        starts=starts * factor,
        offsets=offsets,
        kinds=kinds,
        ends=ends * factor,
        begins=begins * factor,
        cubics=_cubics(letters, numbers, last, begins) * factor,
        arcs=_scaled(centre_form(arcs), factor),
    )


_KINDS, _NUMBERS = np.zeros(256, dtype=np.int8), np.zeros(256, dtype=np.int64)
for _letter, _kind in (("L", KIND_LINE), ("C", KIND_CUBIC), ("Q", KIND_CUBIC), ("A", KIND_ARC)):
    _KINDS[ord(_letter)] = _kind
for _letter, _count in NUMBERS.items():
    _NUMBERS[ord(_letter)] = _count


def _strung(subpaths: Iterable[Subpath]) -> tuple[NDArray[np.uint8], FloatArray, IntArray]:
    """String subpaths together: the letters and the numbers of all segments, and how many segments each has."""
    letters: list[bytes] = []
    numbers: list[FloatArray] = [np.empty(0)]
    for in_columns, some in groupby(subpaths, lambda sub: sub.in_columns):
        if in_columns:
            columns = [columns for sub in some if (columns := sub.columns) is not None]
            letters += [words for words, _ in columns]
            numbers += [values for _, values in columns]
            continue
        lists = [sub.segments for sub in some]
        letters += ["".join([segment[0] for segment in segments]).encode() for segments in lists]
        flat = chain.from_iterable(segment[1:] for segments in lists for segment in segments)
        numbers.append(np.fromiter(flat, dtype=np.float64))
    sizes = np.fromiter(map(len, letters), dtype=np.int64, count=len(letters))
    return np.frombuffer(b"".join(letters), dtype=np.uint8), np.concatenate(numbers), sizes


def _columns(numbers: FloatArray, last: IntArray, width: int) -> FloatArray:
    """Give the numbers (n, width) of segments, of which those of each end before ``last``."""
    columns: FloatArray = numbers[last[:, None] + np.arange(-width, 0)]
    return columns


def _cubics(letters: NDArray[np.uint8], numbers: FloatArray, last: IntArray, begins: FloatArray) -> FloatArray:
    """Control points (C, 4, 2) of the cubics and quadratics among segments."""
    at = np.flatnonzero(_KINDS[letters] == KIND_CUBIC)
    quadratic = letters[at] == ord("Q")
    cubics = np.empty((len(at), 4, 2))
    cubics[:, 0] = begins[at]
    cubics[~quadratic, 1:] = _columns(numbers, last[at[~quadratic]], 6).reshape(-1, 3, 2)
    if quadratic.any():
        start = cubics[quadratic, 0]
        middle, end = np.split(_columns(numbers, last[at[quadratic]], 4), 2, axis=1)
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
