"""Arcs: curves become circular arcs that join without a kink, as few as the tolerance allows, with errors measured.

Every curve is cut at its cusps; what is left between is smooth and gets biarcs (``biarcs``) that start
and end on the curve, as long as the tolerance allows (``cuts``). Where curves of a subpath run on
smoothly into each other, biarcs run over the joints (``smooth_chains``), unless

- something else touches the joint: it stays a vertex, so that what meets in the drawing meets in the walls;
- the curvature jumps there by much: a biarc across would have to be short.

Circles are kept: an elliptic arc with equal radii becomes arcs of that very circle. So does a cubic whose biarc
comes out as one arc within the tolerance, as for a circle written as four cubics.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from importers.drawing import Subpath
from wallkit.geometry.arrays import FloatArray, IntArray
from wallkit.geometry.ellipse_arcs import Arcs
from wallkit.kernels.compile_aside import at_hand
from wallkit.walls.importing.arc_fitting.biarcs import Fit, Spans
from wallkit.walls.importing.arc_fitting.curves import (
    BoolArray,
    ComplexArray,
    Cubics,
    Curves,
    Ellipses,
    as_complex,
    cross,
    length,
)
from wallkit.walls.importing.arc_fitting.cuts import (
    between_cusps,
    even_out,
    fitted,
    halve,
    run_together,
    settled_cuts,
    strung,
)
from wallkit.walls.importing.arc_fitting.smooth_chains import Chains, runs_on
from wallkit.walls.importing.curves_to_lines import Pieces, within_limit
from wallkit.walls.importing.segments import KIND_ARC, KIND_CUBIC, KIND_LINE, Segments, gather

# A curve that is one arc by itself stays that where it turns by more (radians): it was drawn as an arc, and is no
# short piece of something else.
_LEAST_TURN = 0.35
# Times the tolerance: how much the curvature may jump at a joint without a cut, times the square of a span's length.
# 8 to 64 need the same number of arcs within some percent. With much less every joint is a cut, with much more the
# spans around jumps get many and short.
_LARGEST_JUMP = 32.0
_BLOCK = 1 << 14
"""About so many curves are fitted at once: what the work needs for them stays in the cache."""
_KERNELS_PAY = 1 << 14
"""So many cubics take NumPy longer than kernels that have to be loaded; where they have to be compiled, another process
does that and NumPy goes on."""
_SAME_RADII = 1e-9  # relative; a circle after a turn and a scale differs by rounding, 1e-15


@dataclass(slots=True, eq=False, repr=False)
class _Edges:
    """Edges of one kind of segments: segment (rising), end point and bulge of each, and the largest errors."""

    segments: IntArray
    ends: FloatArray
    bulges: FloatArray
    distance: float = 0.0
    turn: float = 0.0


def fit_arcs(segments: Segments, tolerance: float) -> Pieces:
    """Turn every segment into lines and arcs within ``tolerance`` (> 0).

    Arcs are at most half circles (|bulge| <= 1) and join with equal directions inside of segments, and where
    segments that are curves join smoothly. Lines, and curves that are straight, become lines. End points of
    segments stay bit for bit, but for smooth joints that arcs run over.

    Returns:
        Pieces with the largest distance and normal error as measured: at 19 places of every piece (and of each
        part of it that is in one segment) and once more at the top of the parabola through the worst, which
        falls short of the true maximum by less than 1e-3 of it; pieces are held to 0.999 of the tolerance for
        that. All edges of smoothly joined segments count as the last one's.

    Raises:
        LimitError: the result would have more than 2,000,000 vertices.
    """
    cubic_at, arc_at = np.flatnonzero(segments.kinds == KIND_CUBIC), np.flatnonzero(segments.kinds == KIND_ARC)
    round_ = _is_circle(segments.arcs)
    lines = np.flatnonzero(segments.kinds == KIND_LINE)
    parts = [
        _Edges(lines, segments.ends[lines], np.zeros(len(lines))),
        _fit(Cubics.of(segments.cubics), segments, cubic_at, tolerance),
        _circles(segments.arcs.take(round_), arc_at[round_]),
        _fit(Ellipses(segments.arcs.take(~round_)), segments, arc_at[~round_], tolerance),
    ]
    edges = _in_order(parts)
    counts = np.bincount(edges.segments, minlength=len(segments.kinds)).astype(np.int64)
    drawn = counts > 0
    edges.ends[np.cumsum(counts)[drawn] - 1] = segments.ends[drawn]
    return Pieces(counts, edges.ends, edges.bulges, edges.distance, edges.turn)


def _in_order(parts: list[_Edges]) -> _Edges:
    """String edges of all kinds together, segment by segment; those of one kind are in order."""
    parts = [part for part in parts if len(part.segments)] or parts[:1]
    joined = _strung(parts)
    if len(parts) > 1:
        order = np.argsort(joined.segments, kind="stable")
        joined.segments, joined.bulges = joined.segments[order], joined.bulges[order]
        joined.ends = joined.ends.take(order, axis=0)
    return joined


def _strung(parts: list[_Edges]) -> _Edges:
    """String edges together, one part after the other."""
    if len(parts) == 1:
        return parts[0]
    return _Edges(
        np.concatenate([part.segments for part in parts]),
        np.concatenate([part.ends for part in parts]),
        np.concatenate([part.bulges for part in parts]),
        max(part.distance for part in parts),
        max(part.turn for part in parts),
    )


def _is_circle(arcs: Arcs) -> BoolArray:
    first, second = arcs.radii
    result: BoolArray = (np.abs(first - second) <= _SAME_RADII * first) | (arcs.turn == 0)
    return result


def _circles(arcs: Arcs, at: IntArray) -> _Edges:
    """Cut circular arcs into equal parts of at most a half turn; a half turn within rounding is one."""
    counts = np.maximum(np.ceil(np.abs(arcs.turn) / math.pi - 1e-9), 1).astype(np.int64)
    which = np.repeat(np.arange(len(counts)), counts)
    rank = np.arange(len(which)) - np.repeat(np.cumsum(counts) - counts, counts) + 1
    part = arcs.take(which)
    ends = part.points(part.start + part.turn * (rank / counts[which]))
    angle = part.turn / counts[which]
    half_turn = np.abs(np.abs(angle) - math.pi) <= 1e-12  # tan of it comes out as 1 - 1e-16
    bulges = np.where(half_turn, np.sign(angle), np.clip(np.tan(angle / 4), -1.0, 1.0))
    return _Edges(at[which], ends, bulges)


def _fit(curves: Curves, segments: Segments, at: IntArray, tolerance: float) -> _Edges:
    """Fit curves of one kind, whose segments are ``at``, block by block; a chain lies in one block."""
    if not len(curves):
        return _Edges(at, np.empty((0, 2)), np.empty(0))
    tangents = curves.end_tangents()
    smooth = runs_on(tangents, segments, at)
    starts = np.flatnonzero(~smooth)
    blocks = [*starts[np.flatnonzero(np.diff(starts // _BLOCK, prepend=-1))].tolist(), len(curves)]
    parts: list[_Edges] = []
    total = 0
    for first, last in pairwise(blocks):
        rows = np.arange(first, last)
        kernels = isinstance(curves, Cubics) and len(curves) >= _KERNELS_PAY and at_hand(fit_a_few)
        own = tangents[0][rows], tangents[1][rows]
        parts.append(_fit_block(curves.take(rows), own, segments, at[rows], smooth[rows], tolerance, kernels))
        total += len(parts[-1].bulges)
        within_limit(total)
    return _strung(parts)


def _fit_block(
    curves: Curves,
    tangents: tuple[ComplexArray, ComplexArray],
    segments: Segments,
    at: IntArray,
    smooth: BoolArray,
    tolerance: float,
    kernels: bool,
) -> _Edges:
    """Fit curves; the edges of a chain count as its last segment's.

    Args:
        curves: of one kind, the first of them the start of a chain.
        tangents: of them at their ends.
        segments: all subpaths.
        at: (n,) the segment of each curve.
        smooth: (n,) the curve goes on smoothly from the one before.
        tolerance: how far arcs may be off.
        kernels: compiled kernels do what takes longest; for cubics.
    """
    origins = as_complex(segments.begins[at])
    chains = Chains.of(curves, tangents, origins, np.zeros(len(curves), dtype=np.bool_), kernels)
    whole = between_cusps(chains)
    spans, fit = halve(chains, whole, tolerance)
    joined = smooth.copy()
    apart = _arcs_by_themselves(chains, spans)
    joined[1:] &= ~apart[1:] & ~apart[:-1]
    joined &= _bends_on(curves, spans, fit, tolerance)
    if joined.any():
        chains = Chains.of(curves, tangents, origins, joined, kernels)
        stretch = np.cumsum(~(joined[whole.ids] & (whole.low == 0))) - 1
        spans = strung(chains, spans, stretch)
        whole = run_together(strung(chains, whole, stretch))
    spans = even_out(chains, spans, fit, whole, tolerance)
    spans, arcs, fit = settled_cuts(chains, spans, whole, tolerance)
    edge_counts = np.where(arcs.single, 1, 2)
    last = np.cumsum(edge_counts) - 1
    z, bulges = np.empty(last[-1] + 1, dtype=np.complex128), np.empty(last[-1] + 1)
    z[last], bulges[last] = spans.p1, np.where(arcs.single, arcs.bulge0, arcs.bulge1)
    two = ~arcs.single
    z[last[two] - 1], bulges[last[two] - 1] = arcs.joint[two], arcs.bulge0[two]
    ids = np.repeat(spans.ids, edge_counts)
    ends = segments.begins[at[chains.offsets[ids]]] + np.stack([z.real, z.imag], axis=1)
    owner = at[chains.offsets[ids + 1] - 1]
    return _Edges(owner, ends, bulges, float(fit.distance.max()), 2 * math.atan(float(fit.turn.max())))


def fit_a_few() -> None:
    """Fit two cubics by compiled kernels: the task of their compiling."""
    subpath = Subpath([("M", 0, 0), ("C", 40, 0, 80, 20, 100, 100), ("C", 120, 180, 200, 90, 300, 0)], closed=False)
    segments = gather([subpath])
    curves = Cubics.of(segments.cubics)
    smooth = np.array([False, True])
    _fit_block(curves, curves.end_tangents(), segments, np.arange(2), smooth, 0.01, kernels=True)


def _arcs_by_themselves(chains: Chains, spans: Spans) -> BoolArray:
    """Tell which curves, a chain each, are one arc or one line that must not be mixed with their neighbours."""
    arcs = fitted(chains, spans)
    keep = arcs.single & (spans.low == 0) & (spans.high == 1)
    keep &= (arcs.bulge0 == 0) | (4 * np.arctan(np.abs(arcs.bulge0)) >= _LEAST_TURN)
    result = np.zeros(len(chains), dtype=np.bool_)
    result[spans.ids[keep]] = True
    return result


def _bends_on(curves: Curves, spans: Spans, fit: Fit, tolerance: float) -> BoolArray:
    """Tell which curves go on from the one before with a curvature so much the same that a cut there is of no use.

    A jump J of the curvature amid a span of length h adds up to about J h^2 / 128 to how far it is off.
    """
    first = np.flatnonzero(np.diff(spans.ids, prepend=-1))
    last = np.append(first[1:], len(spans)) - 1
    reach = length(spans.p1 - spans.p0) / np.maximum(np.cbrt(fit.distance / tolerance), 0.1)
    ids, ends = np.arange(len(curves)), np.broadcast_to(np.array([0.0, 1.0]), (len(curves), 2))
    velocity = curves.motion(ids, ends)[1]
    with np.errstate(divide="ignore", invalid="ignore"):
        bend = cross(velocity, curves.accelerations(ids, ends)) / length(velocity) ** 3
        jump = np.abs(bend[1:, 0] - bend[:-1, 1])
        even = jump * np.minimum(reach[first[1:]], reach[last[:-1]]) ** 2 <= _LARGEST_JUMP * tolerance
    return np.concatenate([[False], even])
