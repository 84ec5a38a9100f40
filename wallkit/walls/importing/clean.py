"""Cleaning what was drawn: edges without length, paths of one point, and which outlines are closed."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from wallkit.geometry.arrays import FloatArray, IntArray, distinct
from wallkit.geometry.rings import signed_areas
from wallkit.walls.checking.self_check import at_least
from wallkit.walls.importing.outlines import Outlines, without_vertices
from wallkit.walls.roles import is_one_way


def clean(outlines: Outlines) -> Outlines:
    """Drop edges without length and outlines without any edge, close what is painted closed; each reported.

    The order matters: without zero-length edges the number of vertices tells a point, a line and a ring apart.
    """
    for step in (_drop_zero_length, _drop_points, _open_flat, _close_filled, _report_open):
        outlines = step(outlines)
    return outlines


def _drop_zero_length(outlines: Outlines) -> Outlines:
    """Drop each vertex whose edge has no length; of an outline that is all one point the first stays.

    The closing edge of a path that is drawn back to its start and closed as well is the file's way to write it,
    and not reported.
    """
    empty = _empty_edges(outlines)
    last = outlines.offsets[1:] - 1
    counted = empty.copy()
    counted[last] = False
    per_outline = _sums(counted, outlines)
    problems = []
    for index in np.flatnonzero(per_outline).tolist():
        count, begin = int(per_outline[index]), int(outlines.offsets[index])
        place = outlines.vertices[begin + int(np.argmax(counted[begin:]))]
        words = "1 edge without length" if count == 1 else f"{count} edges without length"
        fix = "nothing to do; the walls are the same without"
        problems.append(outlines.problem(index, "zero-length-edge", "info", f"{words} left out", fix, place))
    pointlike = _sums(empty, outlines) == np.diff(outlines.offsets)
    empty[outlines.offsets[:-1][pointlike]] = False
    result = without_vertices(outlines, empty)
    return replace(result, problems=result.problems + problems)


def _empty_edges(outlines: Outlines) -> NDArray[np.bool_]:
    """Mark the vertices whose edge has no length."""
    following = np.arange(1, len(outlines.vertices) + 1)
    last = outlines.offsets[1:] - 1
    following[last] = outlines.offsets[:-1]
    x, y = outlines.vertices.T
    empty: NDArray[np.bool_] = (x == x[following]) & (y == y[following])
    empty[last[~outlines.closed]] = False
    return empty


def _sums(marks: NDArray[np.bool_], outlines: Outlines) -> IntArray:
    if not len(outlines):
        return np.empty(0, dtype=np.int64)
    return np.add.reduceat(marks.astype(np.int64), outlines.offsets[:-1])


def _drop_points(outlines: Outlines) -> Outlines:
    """Drop outlines of a single point."""
    single = np.diff(outlines.offsets) < 2
    problems = [
        outlines.problem(
            index,
            "one-point-path",
            "warning",
            "a path of a single point has no wall",
            "delete the stray point, or draw a small circle if a ball should hit it",
        )
        for index in np.flatnonzero(single).tolist()
    ]
    kept = outlines.keep(~single)
    return replace(kept, problems=kept.problems + problems)


def _open_flat(outlines: Outlines) -> Outlines:
    """A closed outline of two vertices without area is a line there and back: keep it once, open."""
    flat = outlines.closed & (np.diff(outlines.offsets) == 2)
    flat &= ~_with_area(outlines, flat)
    problems = [
        outlines.problem(
            index,
            "flat-path",
            "warning",
            "a closed path encloses nothing: taken as an open line",
            "draw it with an area, or leave it open",
        )
        for index in np.flatnonzero(flat).tolist()
    ]
    return replace(outlines, closed=outlines.closed & ~flat, problems=outlines.problems + problems)


def _close_filled(outlines: Outlines) -> Outlines:
    """Close filled open outlines that enclose an area, as every viewer paints them."""
    filled = np.array([path.fill is not None for path in outlines.paths], dtype=np.bool_)
    close = ~outlines.closed & filled[outlines.owner] if len(outlines) else outlines.closed
    gaps = _gaps(outlines)
    close = _with_area(outlines, close)
    problems = [
        outlines.problem(
            index,
            "closed-as-filled",
            "info",
            f"an open path is filled: closed by an edge of {gaps[index]:.6g} as it is painted",
            "close the path in the drawing, or remove its fill if it is a line",
        )
        for index in np.flatnonzero(close).tolist()
    ]
    return replace(outlines, closed=outlines.closed | close, problems=outlines.problems + problems)


def _with_area(outlines: Outlines, asked: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Mark those of the outlines that are asked for which enclose an area."""
    some = outlines.keep(asked)
    result = np.zeros(len(outlines), dtype=np.bool_)
    result[asked] = signed_areas(some.vertices, some.bulges, some.offsets) != 0
    return result


NEARLY_CLOSED = 0.1
"""An open path whose gap is a smaller part of its length was probably meant to be closed; a wider one is a line."""


def _report_open(outlines: Outlines) -> Outlines:
    rows = np.flatnonzero(~outlines.closed)
    ends, gaps = outlines.vertices[outlines.offsets[rows + 1] - 1], _gaps(outlines)[rows]
    nearly = gaps < NEARLY_CLOSED * _lengths(outlines.keep(~outlines.closed))
    one_way = {owner: is_one_way(outlines.paths[owner]) for owner in distinct(outlines.owner[rows]).tolist()}
    problems = [
        outlines.problem(
            index,
            "open-path",
            "warning" if meant else "info",
            f"an open path: its ends are {gap:.6g} apart; taken as an open, {_sided(one_way[owner])} wall",
            f"close it in the drawing, or with --snap {at_least(gap)}"
            if meant
            else "nothing to do if it is meant as a line",
            end,
        )
        for index, owner, gap, meant, end in zip(
            rows.tolist(), outlines.owner[rows].tolist(), gaps.tolist(), nearly.tolist(), ends, strict=True
        )
    ]
    return replace(outlines, problems=outlines.problems + problems)


def _gaps(outlines: Outlines) -> FloatArray:
    """How far the last vertex of each outline is from its first: (n,)."""
    first, last = outlines.vertices[outlines.offsets[:-1]], outlines.vertices[outlines.offsets[1:] - 1]
    gaps: FloatArray = np.hypot(*(last - first).T)
    return gaps


def _lengths(outlines: Outlines) -> FloatArray:
    """The way along the vertices of each outline, from the first to the last: (n,)."""
    if not len(outlines):
        return np.empty(0)
    steps = np.zeros(len(outlines.vertices))
    steps[:-1] = np.hypot(*np.diff(outlines.vertices, axis=0).T)
    steps[outlines.offsets[1:] - 1] = 0.0
    lengths: FloatArray = np.add.reduceat(steps, outlines.offsets[:-1])
    return lengths


def _sided(one_way: bool) -> str:
    return "one-sided" if one_way else "two-sided"
