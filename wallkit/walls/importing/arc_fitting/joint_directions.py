"""Directions that lean: with the directions at their ends turned a little, biarcs are off by a third as much.

A biarc that has the curve's own directions at both ends over a length h is off by k' h^3 / 324, k' the rate of the
curvature. But a joint of two spans may have any direction, the same for both, and no kink comes of it. Let f be the
signed distance of the arcs from the curve. To leading order f'' is k' s less a constant an arc, so that with arcs of
the length d all alike f is k' d^3 times a spline with f''' = 1 and knots one apart. Bernoulli's polynomial
x^3 / 6 - x^2 / 4 + x / 12 is the smallest of these (it swings evenly, to sqrt(3) / 216 on both sides), and it has no
kinks: so no arcs, not even with kinks, do better than k' d^3 sqrt(3) / 216. With d = h / 2 that is k' h^3 / 998. Its
slope at the knots is 1 / 12, so the directions have to lean by k' d^2 / 12 = k' h^2 / 48.

That is where the search for the directions starts. Where k' changes within a few spans they are then turned one by
one, each so that the worse of its two spans gets better. A turn moves the arcs in proportion, so that this takes one
look at the curve.
"""

from __future__ import annotations

import numpy as np

from wallkit.geometry.arrays import FloatArray, IntArray
from wallkit.walls.importing.arc_fitting.biarcs import Spans, biarcs, deviations
from wallkit.walls.importing.arc_fitting.smooth_chains import Chains

_MOST = 0.05  # radians a direction leans at most; what asks for more is no smooth curve yet
_LOOK = np.array([0.1, 0.22, 1 / 3, 0.41, 0.5, 0.59, 2 / 3, 0.78, 0.9])  # fractions of a span
_SWEEPS = 5
# The largest of some numbers is about their p-norm, which Newton's method makes smallest; as p is no infinity its
# steps are too short, which the second number makes good.
_NORM, _STRIDE = 12, 3.0


def lean(chains: Chains, spans: Spans) -> Spans:
    """Turn the directions at the cuts inside of stretches, in place."""
    left = np.flatnonzero(spans.stretch[1:] == spans.stretch[:-1])
    spans.t1[left] = spans.t0[left + 1] = chains.at(spans.ids[left], spans.high[left])[1]
    _turn(spans, left, _rate(spans, left))
    first = np.searchsorted(spans.stretch, spans.stretch[left])
    off, along, length = deviations(chains, spans, biarcs(spans), _LOOK)
    start, end = -_response(along) * length, _response(1 - along) * length
    off, start, end = (np.ascontiguousarray(part.T) for part in (off, start, end))  # sums over rows are the quick ones
    cuts = [left[(left - first) % 2 == parity] for parity in (0, 1)]  # no two of one parity have a span in common
    response = [np.concatenate([end[:, cut], start[:, cut + 1]]) for cut in cuts]
    angle = np.zeros(len(spans))
    for _ in range(_SWEEPS):
        for cut, moved in zip(cuts, response, strict=True):
            both = np.concatenate([off[:, cut], off[:, cut + 1]])
            step = _evening(both, moved)
            both += moved * step
            off[:, cut], off[:, cut + 1] = both[: len(_LOOK)], both[len(_LOOK) :]
            angle[cut] += step
    _turn(spans, left, angle[left])
    return spans


def _turn(spans: Spans, left: IntArray, angle: FloatArray) -> None:
    """Turn the directions at the end of spans ``left``, which are those at the start of the next ones."""
    before = spans.t1[left]
    after = before * np.exp(1j * np.clip(angle, -_MOST, _MOST))  # in place, one alone comes out otherwise than many
    spans.t1[left] = spans.t0[left + 1] = after


def _rate(spans: Spans, left: IntArray) -> FloatArray:
    """Give -k' h^2 / 48 at the ends of spans ``left``: the mean of both sides."""
    arcs = biarcs(spans)
    # the curvatures of the two arcs of a biarc differ by 2 k' h / 3
    rate = (arcs.bend0 - arcs.bend1) * np.abs(spans.p1 - spans.p0) / 32
    rate = np.where(arcs.sound & ~arcs.single, rate, 0.0)
    mean: FloatArray = (rate[left] + rate[left + 1]) / 2
    return mean


def _response(x: FloatArray) -> FloatArray:
    """How far a biarc of length 1 moves at x when it starts in a direction turned by 1: x - 3/2 x^2, (1 - x)^2 / 2."""
    result: FloatArray = np.where(x < 0.5, x - 1.5 * x * x, (1 - x) ** 2 / 2)
    return result


def _evening(off: FloatArray, response: FloatArray) -> FloatArray:
    """The angle that about makes the largest of ``|off + angle * response|`` smallest, column by column: (n,)."""
    largest = np.abs(off).max(axis=0)
    weighted = np.divide(off, largest, out=np.zeros_like(off), where=largest > 0)
    weighted *= weighted
    fourth = weighted * weighted
    weighted *= response * fourth * fourth  # the power _NORM - 2; pow itself takes ten times as long
    bend, slope = _sum(weighted * response), _sum(weighted * off)
    step = np.divide(-_STRIDE * slope, (_NORM - 1) * bend, out=np.zeros_like(slope), where=bend > 0)
    worse = np.abs(off + step * response).max(axis=0) > largest
    result: FloatArray = np.where(worse, step / 5, step)
    return result


def _sum(rows: FloatArray) -> FloatArray:
    """Sum 18 rows as NumPy sums a row of 18: in eight columns, these in pairs, and the last two."""
    eight = rows[:8] + rows[8:16]
    pairs = eight[::2] + eight[1::2]
    four = pairs[::2] + pairs[1::2]
    result: FloatArray = four[0] + four[1] + rows[16] + rows[17]
    return result
