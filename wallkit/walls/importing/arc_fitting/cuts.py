"""Where to cut: as few spans of smooth curves as their biarcs allow, all off by about the same.

Cuts are first found by halving each curve, which always ends. Then the same number or fewer are placed over whole
chains so that all spans are off by the same: the needed share of spans of a piece that is off by e is
(e / tolerance)^(1/3), and new cuts take equal shares. Each round runs over all curves at once.

The directions at the new cuts lean (``joint_directions``); where a stretch ends they are those of the curve.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from wallkit.geometry.arrays import FloatArray, IntArray
from wallkit.geometry.ragged import numbered
from wallkit.walls.importing.arc_fitting.biarcs import (
    Biarcs,
    Fit,
    Ruler,
    Spans,
    biarcs,
    flatten,
    half_tangent,
    largest,
    look,
    look_closely,
    measure,
    portions,
)
from wallkit.walls.importing.arc_fitting.curves import ROUNDING, BoolArray, cross, dot, length
from wallkit.walls.importing.arc_fitting.joint_directions import lean
from wallkit.walls.importing.arc_fitting.machine_code import raise_to, shared_out
from wallkit.walls.importing.arc_fitting.smooth_chains import Chains, Sections
from wallkit.walls.importing.curves_to_lines import within_limit

# Fractions of a span that are looked at while cutting. The error of a biarc is largest near 1/3 and 2/3, with
# directions that lean near 0.1, 0.4, 0.6 and 0.9.
_LOOK = np.array([0.1, 0.25, 1 / 3, 0.4, 0.6, 2 / 3, 0.75, 0.9])
_SAFE = 0.99  # of the tolerance; what looking at 8 places may miss
_EVEN = np.arange(19) / 18  # from 1/20 of a span to 19/20
_MARGIN, _AGAIN = 1 / 20, 1 / 80  # of a section, between the ends of its span and where it is looked at, and again
_SURE = 0.999  # the same for the close look at 19 places and the highest between
_DEEPEST = 48  # halvings: the parameter's own rounding is reached
_ROUNDS = 8
_ROUGH = 2.0  # times the tolerance: cuts that leave a span as far off after three rounds will not even out
_CUT_ANEW = 2  # rounds of the close look that do so; then halving, which always ends
_GENTLE = 1.2  # times the tolerance: errors up to it come down by a few more spans evenly spread
_LEANING = 0.8  # what leaning makes of the number of spans, 0.69, and some for the ends of stretches


def between_cusps(chains: Chains) -> Spans:
    """Cut every curve at its cusps."""
    curves = chains.curves
    cusps = curves.cusps()
    which, t = cusps.ids, cusps.t
    n = len(curves)
    first, last = chains.headings, chains.leavings
    point = curves.motion(which, t[:, None])[0][:, 0]
    ids = np.concatenate([np.arange(n), which])
    order = _by_parameter(ids, np.concatenate([np.zeros(n), t]))
    low = np.concatenate([np.zeros(n), t])[order]
    p0 = np.concatenate([np.zeros(n, dtype=np.complex128), point])[order]
    t0 = np.concatenate([first, cusps.leaving])[order]
    order = _by_parameter(ids, np.concatenate([np.ones(n), t]))
    high = np.concatenate([np.ones(n), t])[order]
    p1 = np.concatenate([curves.last, point])[order]
    t1 = np.concatenate([last, cusps.coming])[order]
    return Spans(ids[order], np.arange(len(ids)), low, high, p0, p1, t0, t1)


def strung(chains: Chains, spans: Spans, stretch: IntArray) -> Spans:
    """Give spans of single curves as spans of the chains that these are in now.

    Args:
        chains: the chains.
        spans: spans of chains of one curve each.
        stretch: for each of their stretches, that which it is a part of now.
    """
    curve = spans.ids
    start, stop, shift = chains.starts[curve], chains.stops[curve], chains.shifts[curve]
    result = Spans(
        np.searchsorted(chains.offsets, curve, side="right") - 1,
        stretch[spans.stretch],
        np.where(spans.low == 0, start, start + spans.low * (stop - start)),
        np.where(spans.high == 1, stop, start + spans.high * (stop - start)),
        spans.p0 + shift,
        spans.p1 + shift,
        spans.t0,
        spans.t1.copy(),
    )
    inner = np.flatnonzero(result.stretch[1:] == result.stretch[:-1])
    result.p1[inner], result.t1[inner] = result.p0[inner + 1], result.t0[inner + 1]
    return result


def run_together(stretches: Spans) -> Spans:
    """Give one span for each stretch, from its first part's start to its last part's end."""
    first = np.flatnonzero(np.diff(stretches.stretch, prepend=-1))
    last = np.append(first[1:], len(stretches)) - 1
    result, end = stretches.take(first), stretches.take(last)
    result.high, result.p1, result.t1 = end.high, end.p1, end.t1
    return result


def fitted(chains: Chains, spans: Spans) -> Biarcs:
    """Give the arcs of spans; a curve that is a chain and a span by itself may become one arc more easily."""
    alone = (spans.low == 0) & (spans.high == chains.lengths[spans.ids])
    loose = alone & (np.diff(chains.offsets)[spans.ids] == 1)
    return biarcs(spans, loose, machine_code=chains.machine_code)


def _look(chains: Chains, spans: Spans) -> Fit:
    if chains.machine_code:
        return look(chains, spans, _LOOK)
    return measure(chains, spans, fitted(chains, spans), _LOOK)


def _wrong(chains: Chains, fit: Fit, spans: Spans, tolerance: float) -> BoolArray:
    """Tell which spans must be cut further: not within the tolerance, unless there is nothing left to cut."""
    still = spans.t0 == 0  # the curve is a point
    wrong: BoolArray = ~(fit.sound & (fit.distance <= tolerance)) & ~still
    narrow = np.flatnonzero(wrong & (spans.high - spans.low < 1e-6 * chains.lengths[spans.ids]))
    if len(narrow):  # it ends, where it comes back to its start or is as short as rounding
        short = length(spans.p1[narrow] - spans.p0[narrow]) <= ROUNDING * chains.sizes[spans.ids[narrow]]
        wrong[narrow[short]] = False
    return wrong


def halve(chains: Chains, spans: Spans, tolerance: float) -> tuple[Spans, Fit]:
    """Halve until every span fits; in order of chain and parameter."""
    done: list[tuple[Spans, Fit]] = []
    total = 0
    for depth in range(_DEEPEST):
        fit = _look(chains, spans)
        wrong = _wrong(chains, fit, spans, _SAFE * tolerance) & (depth < _DEEPEST - 1)
        done.append((spans.take(~wrong), fit.take(~wrong)))
        if not wrong.any():
            break
        total += len(done[-1][0])
        spans = _halved(chains, spans.take(wrong))
        within_limit(total + len(spans))
    return _in_order(done)


def _halved(chains: Chains, spans: Spans) -> Spans:
    """Cut each in two at the middle parameter; the two halves stand next to each other."""
    return spans.cut(chains, np.full(len(spans), 2), (spans.low + spans.high) / 2)


def even_out(chains: Chains, best: Spans, fit: Fit, whole: Spans, tolerance: float) -> Spans:
    """Place fewer cuts by equal shares of the error, stretch by stretch where that works.

    A stretch may be left with a few spans that do not fit yet: halving those costs one more span each, and a
    new division is taken only where it is the better one with that counted in.
    """
    count = len(whole)
    cost = np.bincount(best.stretch, minlength=count)
    trial, failed = best, np.zeros(count, dtype=np.int64)
    trials, best_of = [best], np.zeros(count, dtype=np.int64)
    open_ = cost > 1
    for round_ in range(_ROUNDS):
        share = _share(fit, tolerance)
        needed = np.bincount(trial.stretch, share, minlength=count)
        # the first shares are of directions that do not lean yet, and at the two ends they never do
        needed = needed if round_ else np.minimum(needed, _LEANING * needed + 0.5)
        # as many as there are already, or more, are not tried: a tolerance near rounding may ask for any number
        wanted = np.maximum(np.minimum(np.ceil(needed - 0.02), cost), 1).astype(np.int64)
        # every number has a second chance, with the better shares; then it is one more, or 2 % of many
        wanted = np.maximum(wanted, failed + (1 + failed // 50) * (round_ % 2 == 0))
        open_ &= wanted < cost
        if not open_.any():
            break
        trial = lean(chains, _recut(chains, trial, share, whole, wanted, open_))
        fit = _look(chains, trial)
        wrong = np.bincount(trial.stretch[_wrong(chains, fit, trial, _SAFE * tolerance)], minlength=count)
        better = open_ & (wanted + wrong < cost)
        best_of[better] = len(trials)
        trials.append(trial)
        cost = np.where(better, wanted + wrong, cost)
        failed = np.where(wrong > 0, wanted, 0)
        if round_ > 1:
            open_[trial.stretch[fit.distance > _ROUGH * tolerance]] = False
    return _strung_by_parameter([trial.take(best_of[trial.stretch] == number) for number, trial in enumerate(trials)])


def _share(fit: Fit, tolerance: float) -> FloatArray:
    """How many spans within the tolerance each takes.

    In steps of 2^-20, so that sums are exact and the cuts of a curve do not depend on the curves before it.
    """
    share = np.clip(np.cbrt(fit.distance / tolerance), 0.01, 1e3)
    return _exact(np.where(fit.sound, share, np.maximum(share, 1.5)))


def _exact(share: FloatArray) -> FloatArray:
    return np.rint(share * 2.0**20) / 2.0**20


def _recut(chains: Chains, old: Spans, share: FloatArray, whole: Spans, wanted: IntArray, open_: BoolArray) -> Spans:
    """Cut the open stretches into ``wanted`` spans of equal shares; within an old span shares grow evenly.

    The directions at the new cuts are to be found by :func:`lean`.
    """
    rows = np.flatnonzero(open_)
    if chains.machine_code:
        return shared_out(chains, old, share, whole.take(rows), wanted[rows])
    keep = open_[old.stretch]
    old, share = old.take(keep), share[keep]
    which = np.searchsorted(rows, old.stretch)
    sums = np.bincount(which, share, minlength=len(rows))
    ends = np.cumsum(share)  # of shares, over all stretches end to end
    before = np.cumsum(sums) - sums
    count = wanted[rows]
    row, rank = numbered(count - 1)
    target = before[row] + _exact(sums[row] * (rank + 1) / count[row])
    first = np.searchsorted(which, np.arange(len(rows)))
    last = np.searchsorted(which, np.arange(len(rows)), side="right") - 1
    at = np.clip(np.searchsorted(ends, target), first[row], last[row])
    part = np.clip(1 - (ends[at] - target) / share[at], 0.0, 1.0)
    return whole.take(rows).cut(chains, count, old.low[at] + part * (old.high[at] - old.low[at]))


def _strung_by_parameter(parts: list[Spans]) -> Spans:
    """String spans together, by chain and parameter."""
    parts = [part for part in parts if len(part)]
    if len(parts) == 1:
        return parts[0]  # they are in order
    joined = Spans.joined(parts)
    return joined.take(_by_parameter(joined.ids, joined.low))


def _by_parameter(ids: IntArray, low: FloatArray) -> IntArray:
    """Give the order by chain and parameter.

    Complex numbers are in order of their real parts, then of the imaginary ones, and a stable sort merges runs that are
    in order, as what is strung together here is: lexsort would sort by the parameter first, of all chains at once.
    """
    key = np.empty(len(ids), dtype=np.complex128)
    key.real, key.imag = ids, low
    return np.argsort(key, kind="stable")


def settled_cuts(chains: Chains, spans: Spans, whole: Spans, tolerance: float) -> tuple[Spans, Biarcs, Fit]:
    """Measure closely, cut more finely what turns out wrong after all, and give the final arcs with their errors."""
    settled: list[tuple[Spans, Fit]] = []
    for depth in range(_DEEPEST):
        fit = _close_look(chains, spans)
        wrong = _wrong(chains, fit, spans, _SURE * tolerance) & (depth < _DEEPEST - 1)
        open_ = wrong
        if depth < _CUT_ANEW:  # the directions around what is cut have to be found anew
            open_ = np.isin(spans.stretch, spans.stretch[wrong])
        settled.append((spans.take(~open_), fit.take(~open_)))
        if not wrong.any():
            break
        if depth < _CUT_ANEW:
            spans = _cut_anew(chains, spans.take(open_), fit.take(open_), wrong[open_], whole, tolerance)
        else:
            spans = _halved(chains, spans.take(wrong))
    spans, fit = _in_order(settled)
    arcs = fitted(chains, spans)
    if flatten(spans, arcs):
        fit = _close_look(chains, spans, arcs)
    return spans, arcs, replace(fit, turn=np.maximum(fit.turn, _turned(chains, spans)))


def _turned(chains: Chains, spans: Spans) -> FloatArray:
    """The turns from the curve's directions to those at the ends of spans, of which the look sees nothing."""
    left = np.flatnonzero(spans.stretch[1:] == spans.stretch[:-1])
    ids, u, direction = spans.ids[left], spans.high[left], spans.t1[left]
    turn = np.zeros(len(spans))
    for curve in (chains.before(ids, u), chains.at(ids, u)[1]):
        turn[left] = np.maximum(turn[left], half_tangent(cross(direction, curve), dot(direction, curve)))
    return turn


def _cut_anew(chains: Chains, spans: Spans, fit: Fit, wrong: BoolArray, whole: Spans, tolerance: float) -> Spans:
    """Share stretches out among one span more, or 2 % of many, where that will do; halve what is wrong elsewhere."""
    count = np.bincount(spans.stretch, minlength=len(whole))
    gentle = count > 0
    gentle[spans.stretch[fit.distance > _GENTLE * tolerance]] = False
    rest = ~gentle[spans.stretch]
    middle = (spans.low + spans.high) / 2
    parts = [spans.take(rest).cut(chains, 1 + wrong[rest], middle[rest & wrong])]
    if gentle.any():
        wanted = count + np.maximum(count // 50, 1)
        parts.append(_recut(chains, spans, _share(fit, tolerance), whole, wanted, gentle))
    return lean(chains, _strung_by_parameter(parts))


def _in_order(parts: list[tuple[Spans, Fit]]) -> tuple[Spans, Fit]:
    """String spans and their fits together, by chain and parameter."""
    spans, fit = Spans.joined([part for part, _ in parts]), Fit.joined([part for _, part in parts])
    order = _by_parameter(spans.ids, spans.low)
    return spans.take(order), fit.take(order)


def _close_look(chains: Chains, spans: Spans, arcs: Biarcs | None = None) -> Fit:
    """Measure at even places, then once more at the top of the parabola through the worst place and its neighbours.

    Args:
        chains: the chains.
        spans: of them.
        arcs: theirs, where these are not :func:`fitted` ones.
    """
    if chains.machine_code and arcs is None:
        rows, sound, worst = _kernels_look(chains, spans)
    else:
        arcs = fitted(chains, spans) if arcs is None else arcs
        sections = chains.sections(spans.ids, spans.low, spans.high)
        worst = np.zeros((2, len(sections)))
        for some in portions(len(sections), len(_EVEN)):
            worst[:, some] = _look_closely(chains, sections, some, arcs)
        rows, sound = sections.rows, arcs.sound
    turn = np.where(spans.t0[rows] == 0, 0.0, worst[1])  # a curve that is a point has no direction
    return largest(rows, worst[0], turn, sound)


def _look_closely(chains: Chains, sections: Sections, rows: slice, arcs: Biarcs) -> FloatArray:
    """Largest distance and turn (2, n) of some sections."""
    ruler = Ruler.of(chains, sections, rows, arcs)
    low, high = _inside(sections, rows)
    off, angle = ruler.offsets(low + (high - low) * _EVEN[:, None])
    peaks = [_peak(np.abs(off, out=off)), _peak(angle, np.arctan)]
    place = np.clip(low + (high - low) * np.stack([place for place, _ in peaks]), *_inside(sections, rows, _AGAIN))
    off, angle = ruler.offsets(place)
    return np.stack([np.maximum(peaks[0][1], np.abs(off[0])), np.maximum(peaks[1][1], angle[1])])


def _kernels_look(chains: Chains, spans: Spans) -> tuple[IntArray, BoolArray, FloatArray]:
    """The same by compiled kernels: the span of each section, which arcs are sound, and what is worst (2, m).

    arctan is NumPy's here too.
    """
    close = look_closely(chains, spans, _EVEN, _MARGIN)
    rows, _, low, high, first, last = close.sections
    away = (high - low) * _AGAIN
    begins, ends = np.diff(rows, prepend=-1) != 0, np.diff(rows, append=-1) != 0
    tops = np.stack([_top(close.at[0], *close.around[0]), _top(close.at[1], *np.arctan(close.around[1]))])
    places = np.clip(first + (last - first) * tops, low + away * begins, high - away * ends)
    raise_to(chains, close, places)
    return rows, close.sound, close.worst


def _inside(sections: Sections, rows: slice, margin: float = _MARGIN) -> tuple[FloatArray, FloatArray]:
    """Where to look first and last: a margin away from the span's own ends, but at joints of curves."""
    low, high = sections.low[rows], sections.high[rows]
    away = (high - low) * margin
    return low + away * sections.begins[rows], high - away * sections.ends[rows]


def _peak(values: FloatArray, meant: Callable[[FloatArray], FloatArray] = np.asarray) -> tuple[FloatArray, FloatArray]:
    """Where the parabola through the largest value of each column and its neighbours peaks, and that value: (n,) each.

    The first row is at 0, the last at 1. The parabola is through what the values mean, which rises with them.
    """
    largest = values.max(axis=0)
    at = np.clip((values == largest).argmax(axis=0), 1, len(values) - 2)
    column = np.arange(values.shape[1])
    return _top(at, *(meant(values[at + step, column]) for step in (-1, 0, 1))), largest


def _top(at: IntArray, before: FloatArray, middle: FloatArray, after: FloatArray) -> FloatArray:
    """Where parabolas through three values each peak, whose middle ones are at ``_EVEN[at]``: (n,)."""
    bow = before - 2 * middle + after
    shift = np.divide(before - after, 2 * bow, out=np.zeros_like(bow), where=bow < 0)
    top: FloatArray = _EVEN[at] + np.clip(shift, -1, 1) * _EVEN[1]
    return top
