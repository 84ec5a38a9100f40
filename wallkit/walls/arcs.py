"""Curves as circular arcs: tangent-continuous biarcs within a tolerance; circles exactly, straight as lines.

A biarc over a piece of length h is off by a multiple of |dk/ds| h^3 (k the curvature), so the number of edges
grows with the cube root of 1 / tolerance, where lines need the square root. Pieces are found by halving and, where
that gives fewer, by equal shares of the integral of |dk/ds|^(1/3) ds. Each is checked against the exact curve at
many points, and once more at many more points at the end; what fails is halved.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from wallkit.walls.biarcs import Biarcs, cross, deviation, dot, join
from wallkit.walls.flatten import Pieces, evaluate, numbered, segment_distance, within_limit
from wallkit.walls.strokes import ARC, CUBIC, Arcs, FloatArray, IntArray, Strokes

_DEEPEST = 40
_LOOK = (np.arange(13) + 0.5) / 13  # where a piece is checked while searching
_LOOK_CLOSER = np.linspace(0.0, 1.0, 66)[1:-1]  # and at the end
_SPARE = 0.97  # part of the tolerance to search with: between the places looked at a peak is at most that much higher
_SAMPLES = 65  # of the density
_SHARE = 5.4  # error = |dk/ds| h^3 / _SHARE^3 for a biarc of equal tangent lengths on a spiral, measured
_SKEW = 0.5  # rad: a hook smaller than the tolerance may be cut off, but a piece must not point elsewhere
_ROUND = 1e-9  # radii that differ by less, relatively, are one radius
_STRAIGHT = 1e-4  # rad: a cubic that leaves its chord by less, and by less than 1 % of the tolerance, is a line

Points = Callable[[IntArray, FloatArray], tuple[FloatArray, FloatArray]]


@dataclass(slots=True)
class _Cut:
    """Pieces of curves: the curve, where it begins and ends on it, sorted."""

    curve: IntArray
    low: FloatArray
    high: FloatArray

    def take(self, index: NDArray[np.generic]) -> _Cut:
        return _Cut(self.curve[index], self.low[index], self.high[index])

    def sorted(self) -> _Cut:
        return self.take(np.lexsort((self.low, self.curve)))

    def halves(self) -> _Cut:
        middle = (self.low + self.high) / 2
        both = np.concatenate
        return _Cut(both([self.curve] * 2), both([self.low, middle]), both([middle, self.high]))

    def __add__(self, other: _Cut) -> _Cut:
        return _Cut(*(np.concatenate([getattr(self, n), getattr(other, n)]) for n in ("curve", "low", "high")))


@dataclass(slots=True)
class _Edges:
    """What curves became: edges per curve, end points, bulges, the largest errors."""

    counts: IntArray
    ends: FloatArray
    bulges: FloatArray
    error: float = 0.0
    normal_error: float = 0.0


def fit_arcs(strokes: Strokes, tolerance: float) -> Pieces:
    """Turn every segment into lines and circular arcs within ``tolerance`` (> 0); end points stay bit for bit.

    Raises:
        LimitError: the result would have more than 2,000,000 vertices.
    """
    circular = _circular(strokes.arcs)
    groups = [
        (np.flatnonzero(strokes.kinds == CUBIC), _fit_cubics(strokes.cubics, tolerance)),
        (np.flatnonzero(strokes.kinds == ARC)[circular], _circles(strokes.arcs.take(circular))),
        (np.flatnonzero(strokes.kinds == ARC)[~circular], _fit_ellipses(strokes.arcs.take(~circular), tolerance)),
    ]
    counts = np.ones(len(strokes.kinds), dtype=np.int64)
    for segments, edges in groups:
        counts[segments] = edges.counts
    within_limit(int(counts.sum()) + len(strokes.starts))
    ends, bulges = np.empty((int(counts.sum()), 2)), np.zeros(int(counts.sum()))
    last = np.cumsum(counts) - 1
    for segments, edges in groups:
        which, rank = numbered(edges.counts)
        at = last[segments[which]] - edges.counts[which] + 1 + rank
        ends[at], bulges[at] = edges.ends, edges.bulges
    ends[last] = strokes.ends
    error, normal_error = (max(getattr(e, name) for _, e in groups) for name in ("error", "normal_error"))
    return Pieces(counts, ends, bulges, error, normal_error)


def _circular(arcs: Arcs) -> NDArray[np.bool_]:
    one, two = arcs.radii
    return np.abs(one - two) <= _ROUND * np.maximum(one, two)


def _circles(arcs: Arcs) -> _Edges:
    """Circular arcs, at most half a circle an edge, exactly."""
    counts = np.maximum(np.ceil(np.abs(arcs.turn) / math.pi * (1 - 1e-12)), 1).astype(np.int64)
    which, rank = numbered(counts)
    part = arcs.turn[which] / counts[which]
    bulges = np.clip(np.tan(part / 4), -1.0, 1.0)
    bulges[np.abs(np.abs(part) - math.pi) < 1e-12] = np.sign(bulges[np.abs(np.abs(part) - math.pi) < 1e-12])
    return _Edges(counts, arcs.take(which).points(arcs.start[which] + part * (rank + 1)), bulges)


def _fit_ellipses(arcs: Arcs, tolerance: float) -> _Edges:
    """Elliptic arcs as biarcs."""

    def points(curve: IntArray, t: FloatArray) -> tuple[FloatArray, FloatArray]:
        angle = arcs.start[curve] + arcs.turn[curve] * t
        cos, sin = np.cos(angle)[..., None], np.sin(angle)[..., None]
        direction = np.sign(arcs.turn[curve])[..., None] * (arcs.v[curve] * cos - arcs.u[curve] * sin)
        return arcs.centre[curve] + arcs.u[curve] * cos + arcs.v[curve] * sin, _unit(direction)

    return _fit(points, len(arcs.turn), tolerance)


def _fit_cubics(cubics: FloatArray, tolerance: float) -> _Edges:
    """Straight cubics as lines (with the points where they turn back), the others as biarcs."""
    straight = _straight(cubics, tolerance)
    bent = np.flatnonzero(~straight)
    curves = _fit(_cubic_points(cubics[bent]), len(bent), tolerance)
    lines = _straight_lines(cubics[straight])
    counts = np.empty(len(cubics), dtype=np.int64)
    counts[bent], counts[straight] = curves.counts, lines.counts
    own = np.repeat(~straight, counts)
    ends, bulges = np.empty((len(own), 2)), np.zeros(len(own))
    ends[own], ends[~own], bulges[own] = curves.ends, lines.ends, curves.bulges
    return _Edges(counts, ends, bulges, max(curves.error, lines.error), max(curves.normal_error, lines.normal_error))


def _cubic_points(cubics: FloatArray) -> Points:
    """Points and unit tangents of cubics.

    At an end whose control point lies on it the derivative vanishes; the tangent then is the direction towards
    the next control point that does not.
    """
    size = np.abs(np.diff(cubics, axis=1)).max(axis=(1, 2)) if len(cubics) else np.empty(0)
    starts, stops = _end_direction(cubics, size), -_end_direction(cubics[:, ::-1], size)

    def points(curve: IntArray, t: FloatArray) -> tuple[FloatArray, FloatArray]:
        flat, at = np.broadcast_to(curve, t.shape).ravel(), t.ravel()
        c, s, w = cubics[flat], (1 - at)[:, None], at[:, None]
        d = np.diff(c, axis=1)
        direction = d[:, 0] * s * s + 2 * d[:, 1] * s * w + d[:, 2] * w * w
        lost = np.abs(direction).max(axis=1) <= 1e-9 * size[flat] if len(flat) else np.empty(0, dtype=np.bool_)
        direction[lost] = np.where((at < 0.5)[:, None], starts[flat], stops[flat])[lost]
        return evaluate(c, at).reshape(*t.shape, 2), _unit(direction).reshape(*t.shape, 2)

    return points


def _end_direction(cubics: FloatArray, size: FloatArray) -> FloatArray:
    direction = np.zeros((len(cubics), 2))
    for control in (3, 2, 1):
        arm = cubics[:, control] - cubics[:, 0]
        usable = np.abs(arm).max(axis=1) > 1e-9 * size
        direction[usable] = arm[usable]
    return direction


def _unit(vector: FloatArray) -> FloatArray:
    length = np.hypot(vector[..., 0], vector[..., 1])[..., None]
    unit: FloatArray = vector / np.where(length > 0, length, 1.0)
    return unit


def _straight(cubics: FloatArray, tolerance: float) -> NDArray[np.bool_]:
    """All four control points on one line, but for what no one could see."""
    if not len(cubics):
        return np.empty(0, dtype=np.bool_)
    ends = cubics[:, 3] - cubics[:, 0]
    arms = cubics[:, 1:] - cubics[:, :1]
    longest = np.take_along_axis(arms, np.abs(arms).max(axis=2).argmax(axis=1)[:, None, None], axis=1)[:, 0]
    length = np.hypot(longest[:, 0], longest[:, 1])
    off = np.abs(cross(longest[:, None], arms)).max(axis=1) / np.where(length > 0, length, 1.0)
    reach = np.hypot(ends[:, 0], ends[:, 1])
    exactly = off <= 1e-12 * length
    straight: NDArray[np.bool_] = exactly | (
        (off <= 0.01 * tolerance) & (off <= _STRAIGHT * reach) & (dot(ends, longest) > 0)
    )
    return straight


def _straight_lines(cubics: FloatArray) -> _Edges:
    """Lines through the extremes of straight cubics: where the speed along the longest arm is 0."""
    if not len(cubics):
        return _Edges(np.empty(0, dtype=np.int64), np.empty((0, 2)), np.empty(0))
    arms = cubics[:, 1:] - cubics[:, :1]
    longest = np.take_along_axis(arms, np.abs(arms).max(axis=2).argmax(axis=1)[:, None, None], axis=1)
    d = dot(np.diff(cubics, axis=1), _unit(longest))
    a, b, c = d[:, 0] - 2 * d[:, 1] + d[:, 2], d[:, 1] - d[:, 0], d[:, 0]
    inside = b * b - a * c
    q = -(b + np.copysign(np.sqrt(np.maximum(inside, 0.0)), b))
    with np.errstate(divide="ignore", invalid="ignore"):
        roots = np.sort(np.stack([q / a, c / q], axis=1), axis=1)
    roots = np.where((roots > 1e-9) & (roots < 1 - 1e-9) & (inside > 0)[:, None], roots, np.nan)
    all_t = np.concatenate([roots, np.ones((len(cubics), 1))], axis=1)
    kept = np.isfinite(all_t)
    which, _ = np.nonzero(kept)
    ends = evaluate(cubics[which], all_t[kept])
    off = float((np.abs(cross(_unit(longest), arms)).max(axis=1) * 0.75).max())
    reach = np.hypot(*(cubics[:, 3] - cubics[:, 0]).T)
    angle = np.abs(cross(_unit(longest), arms)).max(axis=1) / np.where(reach > 0, reach, 1.0)
    return _Edges(kept.sum(axis=1), ends, np.zeros(len(ends)), off, float(3 * angle.max()))


def _fit(points: Points, count: int, tolerance: float) -> _Edges:
    """Biarcs over ``count`` curves given as points and tangents of (curve, t)."""
    whole = _Cut(np.arange(count), np.zeros(count), np.ones(count))
    halved = _halve(points, whole, tolerance * _SPARE, _LOOK)
    even = _even(points, np.bincount(halved.curve, minlength=count), tolerance * _SPARE)
    taken = np.zeros(count, dtype=np.bool_)
    taken[even.curve] = True
    cut = _halve(points, halved.take(~taken[halved.curve]) + even, tolerance, _LOOK_CLOSER).sorted()
    biarcs = _biarcs(points, cut)
    distance, angle = _deviations(points, cut, biarcs, _LOOK_CLOSER)
    single = _one_arc(biarcs)
    edges = np.where(single, 1, 2)
    which, rank = numbered(edges)
    ends = np.where((rank + 1 == edges[which])[:, None], biarcs.q[which], biarcs.joint[which])
    bulges = np.where(single[which], _whole_bulge(biarcs)[which], biarcs.bulge[which, rank])
    counts = np.bincount(cut.curve, edges, count).astype(np.int64)
    return _Edges(counts, ends, bulges, float(distance.max(initial=0.0)), float(angle.max(initial=0.0)))


def _biarcs(points: Points, cut: _Cut) -> Biarcs:
    """The biarc over each piece; a straight line where there is none."""
    (p, s), (q, t) = points(cut.curve, cut.low), points(cut.curve, cut.high)
    found = join(p, s, q, t)
    none = ~found.good
    found.joint[none] = (p[none] + q[none]) / 2
    found.bulge[none] = 0.0
    return found


def _deviations(points: Points, cut: _Cut, biarcs: Biarcs, look: FloatArray) -> tuple[FloatArray, FloatArray]:
    """The largest distance and tangent angle of each piece, looked at in portions that bound the memory."""
    worst = np.zeros((2, len(cut.curve)))
    for begin in range(0, len(cut.curve), 20_000):
        rows = np.arange(begin, min(begin + 20_000, len(cut.curve)))
        t = cut.low[rows, None] + (cut.high - cut.low)[rows, None] * look
        some = Biarcs(*(getattr(biarcs, name)[rows] for name in ("p", "s", "q", "t", "joint", "bulge", "good")))
        place, tangent = points(np.broadcast_to(cut.curve[rows, None], t.shape), t)
        distance, angle = deviation(some, place, tangent)
        line = ~some.good
        chord = (some.q - some.p)[line, None]
        distance[line] = segment_distance(place[line], some.p[line, None], some.q[line, None])
        angle[line] = np.abs(np.arctan2(cross(chord, tangent[line]), dot(chord, tangent[line])))
        worst[:, rows] = distance.max(axis=1), angle.max(axis=1)
    return worst[0], worst[1]


def _halve(points: Points, cut: _Cut, tolerance: float, look: FloatArray) -> _Cut:
    """Halve pieces until each is within tolerance."""
    done = cut.take(np.empty(0, dtype=np.int64))
    for _ in range(_DEEPEST):
        good = _good(points, cut, tolerance, look)
        done += cut.take(good)
        cut = cut.take(~good)
        if not len(cut.curve):
            break
        within_limit(2 * (len(done.curve) + len(cut.curve)))
        cut = cut.halves()
    return done + cut


def _good(points: Points, cut: _Cut, tolerance: float, look: FloatArray) -> NDArray[np.bool_]:
    """Within tolerance; where there is no biarc, only pieces so short that a line is."""
    if not len(cut.curve):
        return np.empty(0, dtype=np.bool_)
    biarcs = _biarcs(points, cut)
    distance, angle = _deviations(points, cut, biarcs, look)
    short = np.hypot(*(biarcs.q - biarcs.p).T) <= tolerance / 2
    good: NDArray[np.bool_] = (distance <= tolerance) & ((biarcs.good & (angle <= _SKEW)) | short)
    return good


def _even(points: Points, halved: IntArray, tolerance: float) -> _Cut:
    """Cut at equal shares of the density where every piece is good and there are fewer than by halving."""
    found = _Cut(np.empty(0, dtype=np.int64), np.empty(0), np.empty(0))
    rows = np.flatnonzero(halved >= 2)
    if not len(rows):
        return found
    t, share = _shares(points, rows)
    wanted = np.maximum(np.ceil(share[:, -1] / (_SHARE * np.cbrt(tolerance))), 1).astype(np.int64)
    waiting = np.ones(len(rows), dtype=np.bool_)
    for extra in range(5):
        count = wanted + extra * np.maximum(wanted // 16, 1)
        trial = np.flatnonzero(waiting & (count < halved[rows]))
        if not len(trial):
            break
        cut = _equal_parts(rows[trial], t, share[trial], count[trial])
        good = _good(points, cut, tolerance, _LOOK)
        bad = np.zeros(len(halved), dtype=np.bool_)
        bad[cut.curve[~good]] = True
        found += cut.take(~bad[cut.curve])
        waiting[trial[~bad[rows[trial]]]] = False
    return found


def _shares(points: Points, rows: IntArray) -> tuple[FloatArray, FloatArray]:
    """Parameters (k,) and the running integral of |dk/ds|^(1/3) ds there, (n, k), from turns between samples."""
    t = np.linspace(0.0, 1.0, _SAMPLES)
    place, tangent = points(
        np.broadcast_to(rows[:, None], (len(rows), len(t))), np.broadcast_to(t, (len(rows), len(t)))
    )
    step = np.hypot(*np.moveaxis(np.diff(place, axis=1), 2, 0))
    step = np.maximum(step, 1e-12 * step.sum(axis=1, keepdims=True) + 1e-300)
    angle = np.arctan2(cross(tangent[:, :-1], tangent[:, 1:]), dot(tangent[:, :-1], tangent[:, 1:]))
    curvature = angle / step
    change = np.abs(np.diff(curvature, axis=1)) / ((step[:, 1:] + step[:, :-1]) / 2)
    change = np.concatenate([change[:, :1], (change[:, 1:] + change[:, :-1]) / 2, change[:, -1:]], axis=1)
    density = np.cbrt(change) * step
    density += 1e-3 * density.max(axis=1, keepdims=True) + 1e-300
    return t, np.concatenate([np.zeros((len(rows), 1)), np.cumsum(density, axis=1)], axis=1)


def _equal_parts(rows: IntArray, t: FloatArray, share: FloatArray, count: IntArray) -> _Cut:
    """Cut each row's curve into ``count`` pieces of equal shares."""
    which, rank = numbered(count + 1)
    scaled = share / share[:, -1:]
    flat = (scaled + 2.0 * np.arange(len(rows))[:, None]).ravel()
    target = rank / count[which]
    at = np.clip(np.searchsorted(flat, target + 2.0 * which, side="right") - 1 - which * len(t), 0, len(t) - 2)
    low = scaled[which, at]
    part = (target - low) / np.maximum(scaled[which, at + 1] - low, 1e-300)
    cuts = t[at] + np.clip(part, 0.0, 1.0) * (t[1] - t[0])
    cuts[rank == 0], cuts[rank == count[which]] = 0.0, 1.0
    begins = rank < count[which]
    return _Cut(rows[which[begins]], cuts[begins], cuts[np.flatnonzero(begins) + 1])


def _one_arc(biarcs: Biarcs) -> NDArray[np.bool_]:
    """Both arcs on one circle (the tangents at both ends make the same angle with the chord), or a line."""
    chord = biarcs.q - biarcs.p
    start = np.arctan2(cross(biarcs.s, chord), dot(biarcs.s, chord))
    end = np.arctan2(cross(chord, biarcs.t), dot(chord, biarcs.t))
    single: NDArray[np.bool_] = biarcs.good & (np.abs(start - end) <= 1e-9) & (np.abs(start) <= np.pi / 2)
    return single | ~biarcs.good  # a line has no joint either


def _whole_bulge(biarcs: Biarcs) -> FloatArray:
    """The bulge of both arcs as one: tan of the sum of their quarter angles."""
    one, two = biarcs.bulge.T
    whole: FloatArray = np.clip((one + two) / np.maximum(1 - one * two, 1e-300), -1.0, 1.0)
    return whole
