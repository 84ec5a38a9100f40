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

from collections.abc import Iterator

import numpy as np

from wallkit.geometry.arrays import FloatArray, IntArray
from wallkit.geometry.ragged import portions
from wallkit.walls.importing.arc_fitting.biarcs import SAME, STRAIGHT, Biarcs, Spans, biarcs, deviations
from wallkit.walls.importing.arc_fitting.curves import length
from wallkit.walls.importing.arc_fitting.machine_code import lean_in_place
from wallkit.walls.importing.arc_fitting.smooth_chains import Chains

_MOST = 0.05  # radians a direction leans at most; what asks for more is no smooth curve yet
_LOOK = np.array([0.1, 0.22, 1 / 3, 0.41, 0.5, 0.59, 2 / 3, 0.78, 0.9])  # fractions of a span
_SWEEPS = 5
_AT_ONCE = 1024  # spans: what the search needs for them stays in the cache
# The largest of some numbers is about their p-norm, which Newton's method makes smallest; as p is no infinity its
# steps are too short, which the second number makes good.
_NORM, _STRIDE = 12.0, 3.0


def lean(chains: Chains, spans: Spans) -> Spans:
    """Turn the directions at the cuts inside of stretches, in place."""
    if chains.machine_code:
        lean_in_place(chains, spans, (SAME, STRAIGHT, _MOST), _LOOK, (_SWEEPS, _NORM, _STRIDE))
        return spans
    left = np.flatnonzero(spans.stretch[1:] == spans.stretch[:-1])
    spans.t1[left] = spans.t0[left + 1] = chains.at(spans.ids[left], spans.high[left])[1]
    _turn(spans, left, _rate(spans, left))
    angle = _all_angles(chains, spans, biarcs(spans))
    _turn(spans, left, angle[left])
    return spans


def _all_angles(chains: Chains, spans: Spans, arcs: Biarcs) -> FloatArray:
    """Find the angles of all spans, a portion at a time."""
    off, along, chord = deviations(chains, spans, arcs, _LOOK)
    start, end = -_response(along) * chord, _response(1 - along) * chord
    angle = np.zeros(len(spans))
    for rows in _portions(spans.stretch):
        angle[rows] = _angles(spans.stretch[rows], *(part[:, rows] for part in (off, start, end)))
    return angle


def _portions(stretch: IntArray) -> Iterator[slice]:
    """Give portions of about _AT_ONCE spans, whole stretches each."""
    offsets = np.append(np.flatnonzero(np.diff(stretch, prepend=-1)), len(stretch))
    return (slice(offsets[first], offsets[stop]) for first, stop in portions(offsets, _AT_ONCE))


def _angles(stretch: IntArray, off: FloatArray, start: FloatArray, end: FloatArray) -> FloatArray:
    """Find the angles that directions at the ends of spans are turned by, (n,), 0 at those of stretches.

    Args:
        stretch: (n,) of each span.
        off: (k, n) how far it is off where it is looked at.
        start: (k, n) how much farther, by its direction at the start turned by 1.
        end: (k, n) the same for the end.
    """
    left = np.flatnonzero(stretch[1:] == stretch[:-1])
    odd = (left - np.searchsorted(stretch, stretch[left])) % 2 == 1
    cuts = [left[~odd], left[odd]]  # no two of one kind have a span in common
    response = [np.concatenate([end.take(cut, axis=1), start.take(cut + 1, axis=1)]) for cut in cuts]
    off, angle = off.copy(), np.zeros(len(stretch))
    for _ in range(_SWEEPS):
        for cut, moved in zip(cuts, response, strict=True):
            both = np.concatenate([off.take(cut, axis=1), off.take(cut + 1, axis=1)])
            step = _evening(both, moved)
            both += moved * step
            off[:, cut], off[:, cut + 1] = both[: len(_LOOK)], both[len(_LOOK) :]
            angle[cut] += step
    return angle


def _turn(spans: Spans, left: IntArray, angle: FloatArray) -> None:
    """Turn the directions at the end of spans ``left``, which are those at the start of the next ones."""
    before, x = spans.t1[left], np.clip(angle, -_MOST, _MOST)
    square = x * x  # Taylor's series, to 1e-20 for angles as small as these
    cos = 1 - square / 2 * (1 - square / 12 * (1 - square / 30 * (1 - square / 56)))
    sin = x * (1 - square / 6 * (1 - square / 20 * (1 - square / 42 * (1 - square / 72))))
    after = cos * before + sin * (1j * before)
    spans.t1[left] = spans.t0[left + 1] = after


def _rate(spans: Spans, left: IntArray) -> FloatArray:
    """Give -k' h^2 / 48 at the ends of spans ``left``: the mean of both sides."""
    arcs = biarcs(spans)
    # the curvatures of the two arcs of a biarc differ by 2 k' h / 3
    rate = (arcs.bend0 - arcs.bend1) * length(spans.p1 - spans.p0) / 32
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
    weighted = off / np.where(largest > 0, largest, 1.0)
    weighted *= weighted
    fourth = weighted * weighted
    fourth *= fourth
    weighted *= fourth  # the power _NORM - 2; pow itself takes ten times as long
    weighted *= response
    bend = _sum(np.multiply(weighted, response, out=fourth))
    weighted *= off
    slope = _sum(weighted)
    step = np.divide(-_STRIDE * slope, (_NORM - 1) * bend, out=np.zeros_like(slope), where=bend > 0)
    after = np.multiply(step, response, out=weighted)
    after += off
    worse = np.abs(after, out=after).max(axis=0) > largest
    result: FloatArray = np.where(worse, step / 5, step)
    return result


def _sum(rows: FloatArray) -> FloatArray:
    """Sum 18 rows as NumPy sums a row of 18: in eight columns, these in pairs, and the last two."""
    eight = rows[:8] + rows[8:16]
    pairs = eight[::2] + eight[1::2]
    four = pairs[::2] + pairs[1::2]
    result: FloatArray = four[0] + four[1] + rows[16] + rows[17]
    return result
