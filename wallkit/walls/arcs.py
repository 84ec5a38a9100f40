"""Arcs: curves become circular arcs that join without a kink, as few as the tolerance allows, with errors measured.

Every curve is cut at its cusps; what is left between is smooth and gets biarcs (:mod:`wallkit.walls.biarcs`) whose
points and directions at the cuts are those of the curve. A biarc over the length h of a curve whose curvature
changes at the rate k' is off by k' h^3 / 324, so that halving the edges costs eight times the distance (order 3).

Cuts are first found by halving, which always ends; then the same number or fewer are placed so that all pieces
are off by the same: the needed share of edges of a piece that is off by e is (e / tolerance)^(1/3), and new cuts
take equal shares. Each round runs over all curves at once.

Circles are kept: an elliptic arc with equal radii becomes arcs of that very circle. So does a cubic whose biarc
comes out as one arc within the tolerance, as for a circle written as four cubics.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from wallkit.walls.biarcs import CHUNK, Biarcs, BoolArray, Fit, Spans, biarcs, measure, offsets, turning_within
from wallkit.walls.curves import Cubics, Curves, Ellipses, unit
from wallkit.walls.flatten import Pieces, within_limit
from wallkit.walls.strokes import ARC, CUBIC, LINE, Arcs, FloatArray, IntArray, Strokes

# Fractions of a span that are looked at while cutting. The error of a biarc is largest near 1/3 and 2/3.
_LOOK = np.array([1, 3, 4, 5, 7, 8, 9, 11]) / 12
_SAFE = 0.99  # of the tolerance; what looking at 8 places may miss
_CLOSE = np.arange(1, 20) / 20
_SURE = 0.999  # the same for the close look at 19 places and the highest between
_DEEPEST = 48  # halvings: the parameter's own rounding is reached
_ROUNDS = 6
_ROUNDING = 1e-14  # of a curve's size: a span as short has no direction to speak of
_SAME_RADII = 1e-9  # relative; a circle after a turn and a scale differs by rounding, 1e-15


@dataclass(slots=True)
class _Edges:
    """Edges of one kind of segments: segment (rising), end point and bulge of each, and the largest errors."""

    segments: IntArray
    ends: FloatArray
    bulges: FloatArray
    distance: float = 0.0
    turn: float = 0.0


def fit_arcs(strokes: Strokes, tolerance: float) -> Pieces:
    """Turn every segment into lines and arcs within ``tolerance`` (> 0); end points stay bit for bit.

    Arcs are at most half circles (|bulge| <= 1) and join inside a segment with equal directions. Lines, and
    curves that are straight, become lines.

    Returns:
        Pieces with the largest distance and normal error as measured: at 19 places of every piece and once
        more at the top of the parabola through the worst, which falls short of the true maximum by less than
        1e-3 of it; pieces are held to 0.999 of the tolerance for that.

    Raises:
        LimitError: the result would have more than 2,000,000 vertices.
    """
    cubic_at, arc_at = np.flatnonzero(strokes.kinds == CUBIC), np.flatnonzero(strokes.kinds == ARC)
    round_ = _is_circle(strokes.arcs)
    lines = np.flatnonzero(strokes.kinds == LINE)
    parts = [
        _Edges(lines, strokes.ends[lines], np.zeros(len(lines))),
        _fit(Cubics.of(strokes.cubics), strokes.cubics[:, 0], cubic_at, tolerance),
        _circles(strokes.arcs.take(round_), arc_at[round_]),
        _fit(
            Ellipses(strokes.arcs.take(~round_)),
            strokes.begins[arc_at[~round_]],
            arc_at[~round_],
            tolerance,
        ),
    ]
    segments = np.concatenate([part.segments for part in parts])
    order = np.argsort(segments, kind="stable")
    counts = np.bincount(segments, minlength=len(strokes.kinds)).astype(np.int64)
    ends = np.concatenate([part.ends for part in parts])[order]
    ends[np.cumsum(counts) - 1] = strokes.ends
    bulges = np.concatenate([part.bulges for part in parts])[order]
    return Pieces(counts, ends, bulges, max(p.distance for p in parts), max(p.turn for p in parts))


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


def _fit(curves: Curves, origins: FloatArray, at: IntArray, tolerance: float) -> _Edges:
    """Fit curves of one kind, whose first points are ``origins`` and whose segments are ``at``."""
    if not len(curves):
        return _Edges(at, np.empty((0, 2)), np.empty(0))
    whole = _between_cusps(curves)
    spans, fit = _halve(curves, whole, tolerance)
    spans = _even_out(curves, spans, fit, whole, tolerance)
    spans, arcs, fit = _settle(curves, spans, tolerance)
    edge_counts = np.where(arcs.single, 1, 2)
    last = np.cumsum(edge_counts) - 1
    z, bulges = np.empty(last[-1] + 1, dtype=np.complex128), np.empty(last[-1] + 1)
    z[last], bulges[last] = spans.p1, np.where(arcs.single, arcs.bulge0, arcs.bulge1)
    two = ~arcs.single
    z[last[two] - 1], bulges[last[two] - 1] = arcs.joint[two], arcs.bulge0[two]
    ids = np.repeat(spans.ids, edge_counts)
    ends = origins[ids] + np.stack([z.real, z.imag], axis=1)
    return _Edges(at[ids], ends, bulges, float(fit.distance.max()), float(fit.turn.max()))


def _between_cusps(curves: Curves) -> Spans:
    """Cut every curve at its cusps; there the direction comes in against the acceleration and leaves along it."""
    which, t = curves.cusps()
    n = len(curves)
    first, last = curves.end_tangents()
    back = unit(curves.accelerations(which, t[:, None])[:, 0])
    point = curves.motion(which, t[:, None])[0][:, 0]
    ids = np.concatenate([np.arange(n), which])
    order = np.lexsort((np.concatenate([np.zeros(n), t]), ids))
    low = np.concatenate([np.zeros(n), t])[order]
    p0 = np.concatenate([np.zeros(n, dtype=np.complex128), point])[order]
    t0 = np.concatenate([first, back])[order]
    order = np.lexsort((np.concatenate([np.ones(n), t]), ids))
    high = np.concatenate([np.ones(n), t])[order]
    p1 = np.concatenate([curves.last, point])[order]
    t1 = np.concatenate([last, -back])[order]
    return Spans(ids[order], low, high, p0, p1, t0, t1)


def _look(curves: Curves, spans: Spans) -> Fit:
    return measure(curves, spans, biarcs(spans, _is_whole(spans)), _LOOK)


def _is_whole(spans: Spans) -> BoolArray:
    whole: BoolArray = (spans.low == 0) & (spans.high == 1)
    return whole


def _wrong(curves: Curves, fit: Fit, spans: Spans, tolerance: float) -> BoolArray:
    """Tell which spans must be cut further: not within the tolerance, unless there is nothing left to cut."""
    still = spans.t0 == 0  # the curve is a point
    short = np.abs(spans.p1 - spans.p0) <= _ROUNDING * curves.sizes[spans.ids]  # or comes back to its start
    wrong: BoolArray = ~(fit.sound & (fit.distance <= tolerance)) & ~still & ~(short & (spans.high - spans.low < 1e-6))
    return wrong


def _halve(curves: Curves, spans: Spans, tolerance: float) -> tuple[Spans, Fit]:
    """Halve until every span fits; in order of curve and parameter."""
    done: list[tuple[Spans, Fit]] = []
    total = 0
    for depth in range(_DEEPEST):
        fit = _look(curves, spans)
        wrong = _wrong(curves, fit, spans, _SAFE * tolerance) & (depth < _DEEPEST - 1)
        done.append((spans.take(~wrong), fit.take(~wrong)))
        if not wrong.any():
            break
        total += len(done[-1][0])
        spans = spans.take(wrong).halved(curves)
        within_limit(total + len(spans))
    return _in_order(done)


def _even_out(curves: Curves, best: Spans, fit: Fit, whole: Spans, tolerance: float) -> Spans:
    """Place fewer cuts by equal shares of the error, stretch by stretch where that works.

    A stretch may be left with a few spans that do not fit yet: halving those costs one more span each, and a
    new division is taken only where it is the better one with that counted in.
    """
    cost = np.bincount(_stretch(whole, best), minlength=len(whole))
    trial, failed = best, np.zeros(len(whole), dtype=np.int64)
    open_ = cost > 1
    for round_ in range(_ROUNDS):
        which = _stretch(whole, trial)
        share = np.maximum(np.cbrt(fit.distance / tolerance), 0.05)
        share = _exact(np.where(fit.sound, share, np.maximum(share, 1.5)))
        wanted = np.ceil(np.bincount(which, share, minlength=len(whole)) - 0.02).astype(np.int64)
        # every number has a second chance, with the better shares; then it is one more, or 2 % of many
        wanted = np.maximum(wanted, failed + (1 + failed // 50) * (round_ % 2 == 0))
        open_ &= wanted < cost
        if not open_.any():
            break
        trial = _recut(curves, trial, share, which, whole, wanted, open_)
        fit = _look(curves, trial)
        which = _stretch(whole, trial)
        wrong = np.bincount(which[_wrong(curves, fit, trial, _SAFE * tolerance)], minlength=len(whole))
        better = open_ & (wanted + wrong < cost)
        best = _replaced(best, _stretch(whole, best), trial, which, better)
        cost = np.where(better, wanted + wrong, cost)
        failed = np.where(wrong > 0, wanted, failed)
        open_ &= wrong > 0
    return best


def _stretch(whole: Spans, spans: Spans) -> IntArray:
    """Which of the stretches between cusps each span belongs to; both in order of curve and parameter."""
    place = np.searchsorted(whole.ids + whole.low, spans.ids + spans.low, side="right") - 1
    return place.astype(np.int64)


def _exact(share: FloatArray) -> FloatArray:
    """Round to 2^-20, so that sums are exact and the cuts of a curve do not depend on the curves before it."""
    return np.rint(np.minimum(share, 1e3) * 2.0**20) / 2.0**20


def _recut(
    curves: Curves, old: Spans, share: FloatArray, which: IntArray, whole: Spans, wanted: IntArray, open_: BoolArray
) -> Spans:
    """Cut the open stretches into ``wanted`` spans of equal shares; within an old span shares grow evenly."""
    rows = np.flatnonzero(open_)
    keep = open_[which]
    old, share = old.take(keep), share[keep]
    which = np.searchsorted(rows, which[keep])
    sums = np.bincount(which, share, minlength=len(rows))
    ends = np.cumsum(share)  # of shares, over all stretches end to end
    before = np.cumsum(sums) - sums
    count = wanted[rows]
    row = np.repeat(np.arange(len(rows)), count - 1)
    rank = np.arange(len(row)) - np.repeat(np.cumsum(count - 1) - (count - 1), count - 1) + 1
    target = before[row] + _exact(sums[row] * rank / count[row])
    first = np.searchsorted(which, np.arange(len(rows)))
    last = np.searchsorted(which, np.arange(len(rows)), side="right") - 1
    at = np.clip(np.searchsorted(ends, target), first[row], last[row])
    part = np.clip(1 - (ends[at] - target) / share[at], 0.0, 1.0)
    cut = old.low[at] + part * (old.high[at] - old.low[at])
    total = int(count.sum())
    start = np.cumsum(count) - count
    low, high = np.empty(total), np.empty(total)
    low[start], high[start + count - 1] = whole.low[rows], whole.high[rows]
    low[start[row] + rank], high[start[row] + rank - 1] = cut, cut
    source = whole.take(np.repeat(rows, count))
    return Spans.between(curves, source, source, low, high)


def _replaced(best: Spans, best_row: IntArray, trial: Spans, trial_row: IntArray, passed: BoolArray) -> Spans:
    joined = Spans.joined([best.take(~passed[best_row]), trial.take(passed[trial_row])])
    return joined.take(np.lexsort((joined.low, joined.ids)))


def _settle(curves: Curves, spans: Spans, tolerance: float) -> tuple[Spans, Biarcs, Fit]:
    """Measure closely, halve what turns out wrong after all, and give the final arcs with their errors."""
    settled: list[tuple[Spans, Fit]] = []
    for depth in range(_DEEPEST):
        fit = _close_look(curves, spans, biarcs(spans, _is_whole(spans)))
        wrong = _wrong(curves, fit, spans, _SURE * tolerance) & (depth < _DEEPEST - 1)
        settled.append((spans.take(~wrong), fit.take(~wrong)))
        if not wrong.any():
            break
        spans = spans.take(wrong).halved(curves)
    spans, fit = _in_order(settled)
    return spans, biarcs(spans, _is_whole(spans)), fit


def _in_order(parts: list[tuple[Spans, Fit]]) -> tuple[Spans, Fit]:
    """String spans and their fits together, by curve and parameter."""
    spans, fit = Spans.joined([part for part, _ in parts]), Fit.joined([part for _, part in parts])
    order = np.lexsort((spans.low, spans.ids))
    return spans.take(order), fit.take(order)


def _close_look(curves: Curves, spans: Spans, arcs: Biarcs) -> Fit:
    """Measure at even places, then once more at the top of the parabola through the worst place and its neighbours."""
    n = len(spans)
    worst = np.zeros(n), np.zeros(n)
    for first in range(0, n, CHUNK):
        rows = slice(first, min(first + CHUNK, n))
        ids, low, width = spans.ids[rows], spans.low[rows, None], (spans.high - spans.low)[rows, None]
        seen = offsets(curves, ids, low + width * _CLOSE, arcs, rows)
        for kind, largest in enumerate(worst):
            values = np.abs(seen[kind])
            top = offsets(curves, ids, low + width * _peak(values)[:, None], arcs, rows)[kind]
            largest[rows] = np.maximum(values.max(axis=1), np.abs(top[:, 0]))
    turn = np.where(spans.t0 == 0, 0.0, worst[1])  # a curve that is a point has no direction
    return Fit(worst[0], turn, turning_within(arcs, turn))


def _peak(values: FloatArray) -> FloatArray:
    """Where in (0, 1) the parabola through the largest value and its neighbours is highest."""
    at = np.clip(values.argmax(axis=1), 1, values.shape[1] - 2)
    row = np.arange(len(values))
    before, middle, after = values[row, at - 1], values[row, at], values[row, at + 1]
    bow = before - 2 * middle + after
    shift = np.divide(before - after, 2 * bow, out=np.zeros_like(bow), where=bow < 0)
    step = _CLOSE[1] - _CLOSE[0]
    result: FloatArray = np.clip(_CLOSE[at] + np.clip(shift, -1, 1) * step, step / 4, 1 - step / 4)
    return result
