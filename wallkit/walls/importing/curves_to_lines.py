"""Flattening: curves become lines that stay within a stated distance, a bound that is proven and an error measured.

For a cubic piece with chord from P0 to P3 let d1, d2 be the signed distances of P1, P2 from the chord's line.
The curve's own distance is f(t) = 3 t (1-t) ((1-t) d1 + t d2), whose largest value has a closed form. It is the
distance to the chord itself when P1 and P2 project onto the chord, because then (convex hull) all of the curve
does. Otherwise distance to a segment is convex, so f(t) <= 3 t (1-t) m <= 3/4 m, m the larger distance of P1, P2
to the segment. The curve's projection covers the chord, so the bound holds from lines to curve as well.

For an elliptic arc cut into equal angles the ellipse is the affine image of a circle, so the distance is at most
R (1 - cos(step / 2)), R the larger half axis.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from importers.limits import MAX_VERTICES, limit_error
from wallkit.geometry.arrays import FloatArray, IntArray
from wallkit.geometry.cubics import by_columns, chord_bound, chosen, cut_between, evaluate, extreme_parameters, split
from wallkit.geometry.ellipse_arcs import Arcs
from wallkit.geometry.ragged import numbered
from wallkit.geometry.segments import segment_distance
from wallkit.kernels.compile_aside import at_hand
from wallkit.kernels.fitting.chords import DEEPEST
from wallkit.walls.importing.chords_by_kernels import fewest_cuts, halving_counts, measured_chords
from wallkit.walls.importing.segments import KIND_ARC, KIND_CUBIC, Segments

_KERNELS_PAY = 1 << 13
"""So many cubics take NumPy longer than kernels that have to be loaded; where they have to be compiled, another process
does that and NumPy goes on."""
_BLOCK = 4096  # cubics at once: what is made of them stays in the cache


@dataclass(slots=True, eq=False, repr=False)
class Pieces:
    """Edges of many segments: segment ``i`` has ``counts[i]`` edges; none where those of a later one cover it.

    Attributes:
        counts: (N,) int64.
        ends: (sum of counts, 2) end point of each edge, in order.
        bulges: (sum of counts,) bulge of each edge.
        error: the largest measured distance between a segment and its edges.
        normal_error: the largest measured angle between their normals in radians; None for lines.
    """

    counts: IntArray
    ends: FloatArray
    bulges: FloatArray
    error: float
    normal_error: float | None = None


def flatten(segments: Segments, tolerance: float) -> Pieces:
    """Turn every segment into lines within ``tolerance`` (> 0); end points of segments stay bit for bit.

    Raises:
        LimitError: the result would have more than 2,000,000 vertices.
    """
    cubics = _cubic_chords(segments.cubics, tolerance)
    arc_id, arc_t = _arc_cuts(segments.arcs, tolerance)
    counts = np.ones(len(segments.kinds), dtype=np.int64)
    cubic_at, arc_at = np.flatnonzero(segments.kinds == KIND_CUBIC), np.flatnonzero(segments.kinds == KIND_ARC)
    counts[cubic_at] += cubics.counts
    counts[arc_at] += np.bincount(arc_id, minlength=len(arc_at))
    within_limit(int(counts.sum()) + len(segments.starts))
    arcs = segments.arcs.take(arc_id)
    ends = place(
        counts,
        segments.ends,
        (cubic_at, np.repeat(np.arange(len(cubic_at)), cubics.counts), cubics.points),
        (arc_at, arc_id, arcs.points(arcs.start + arcs.turn * arc_t)),
    )
    error = max(cubics.error, _arc_error(segments.arcs, arc_id, arc_t))
    return Pieces(counts, ends, np.zeros(len(ends)), error)


def within_limit(vertices: int) -> None:
    """Refuse more vertices than the stated limit."""
    if vertices > MAX_VERTICES:
        fix = "ask for a larger tolerance, fewer layers, or curves as arcs"
        raise limit_error("vertices of all walls together", f"{MAX_VERTICES:,}", fix=fix)


def place(counts: IntArray, ends: FloatArray, *inner: tuple[IntArray, IntArray, FloatArray]) -> FloatArray:
    """Interleave the inner points of segments with the segments' end points.

    Args:
        counts: edges a segment.
        ends: end point of each segment.
        inner: groups of (segment of each curve, curve of each inner point in rising order, the points).
    """
    last = np.cumsum(counts) - 1
    out = np.empty((int(counts.sum()), 2))
    out[last] = ends
    for segment_of, curve_of, points in inner:
        if not len(points):
            continue
        first = np.searchsorted(curve_of, np.arange(len(segment_of)))
        segment = segment_of[curve_of]
        out[last[segment] - counts[segment] + 1 + np.arange(len(points)) - first[curve_of]] = points
    return out


@dataclass(slots=True, eq=False, repr=False)
class _Chords:
    """Chords of cubics: (n,) how many cuts each has, (m, 2) the points there, and how far they are off at most."""

    counts: IntArray
    points: FloatArray
    error: float


def _cubic_chords(cubics: FloatArray, tolerance: float) -> _Chords:
    """Cut cubics and measure: the fewest cuts of halving, equal shares and equal steps."""
    if not len(cubics):
        return _Chords(np.empty(0, dtype=np.int64), np.empty((0, 2)), 0.0)
    kernels = len(cubics) >= _KERNELS_PAY and at_hand(flatten_a_few)
    return _chords(cubics, tolerance, kernels)


def _chords(cubics: FloatArray, tolerance: float, kernels: bool) -> _Chords:
    block = _block_by_kernels if kernels else _block_by_numpy
    parts, total = [], 0
    for begin in range(0, len(cubics), _BLOCK):
        parts.append(block(cubics[begin : begin + _BLOCK], tolerance))
        total += len(parts[-1][1])
        within_limit(total)
    counts, cuts, points, far = (np.concatenate(column) for column in zip(*parts, strict=True))
    return _Chords(counts, points, _worst(cubics, counts, cuts, far))


_Block = tuple[IntArray, FloatArray, FloatArray, FloatArray]
"""Of some cubics: how many cuts each has, all cuts, the points there, and how far each piece is from its chord."""


def _block_by_kernels(cubics: FloatArray, tolerance: float) -> _Block:
    halvings, total = halving_counts(cubics, tolerance, MAX_VERTICES)
    within_limit(total)
    counts, cuts = fewest_cuts(cubics, tolerance, halvings, _SAMPLES, _ROWS)
    return counts, cuts, *measured_chords(cubics, counts, cuts, _MEASURED_AT)


def flatten_a_few() -> None:
    """Flatten two cubics by kernels: the task of their compiling."""
    cubics = np.array([[(0, 0), (40, 0), (80, 20), (100, 100)], [(0, 0), (30, 0), (-30, 0), (0, 0)]], dtype=np.float64)
    _chords(cubics, 0.01, kernels=True)


def _block_by_numpy(cubics: FloatArray, tolerance: float) -> _Block:
    cubics = by_columns(cubics)
    ids, cuts = _block_cuts(cubics, tolerance)
    counts = np.bincount(ids, minlength=len(cubics))
    return counts, cuts, evaluate(chosen(cubics, ids), cuts), _off(cubics, ids, cuts, counts)


def _block_cuts(cubics: FloatArray, tolerance: float) -> tuple[IntArray, FloatArray]:
    ids, ts = _halving(cubics, tolerance)
    for cuts in (_even_cuts, _wang_cuts):
        more_ids, more_ts, taken = cuts(cubics, np.bincount(ids, minlength=len(cubics)), tolerance)
        keep = ~taken[ids]
        ids, ts = np.concatenate([ids[keep], more_ids]), np.concatenate([ts[keep], more_ts])
    order = np.lexsort((ts, ids))
    return ids[order], ts[order]


def _wang_cuts(cubics: FloatArray, best: IntArray, tolerance: float) -> tuple[IntArray, FloatArray, NDArray[np.bool_]]:
    """Wang's proven bound: n = ceil(sqrt(6 M / (8 tolerance))) equal steps, M the largest second difference."""
    second = np.diff(cubics, n=2, axis=1)
    largest = np.hypot(second[..., 0], second[..., 1]).max(axis=1, initial=0.0)
    count = np.maximum(np.ceil(np.sqrt(0.75 * largest / tolerance)), 1)
    taken = count - 1 < best
    rows = np.flatnonzero(taken)
    which, rank = numbered(count[rows].astype(np.int64) - 1)
    return rows[which], (rank + 1) / count[rows][which], taken


def _halving(cubics: FloatArray, tolerance: float) -> tuple[IntArray, FloatArray]:
    """Halve every cubic until the bound holds for each piece."""
    ids, piece = np.arange(len(cubics)), cubics
    low, width = np.zeros(len(cubics)), 1.0
    cut_ids: list[IntArray] = []
    cut_ts: list[FloatArray] = []
    total = 0
    for _ in range(DEEPEST):
        wrong = np.flatnonzero(chord_bound(piece) > tolerance)
        if not len(wrong):
            break
        ids, piece, low, width = ids[wrong], chosen(piece, wrong), low[wrong], width / 2
        total += len(ids)
        within_limit(total)
        cut_ids.append(ids)
        cut_ts.append(low + width)
        left, right = split(piece)
        ids, piece, low = np.tile(ids, 2), np.concatenate([left, right]), np.concatenate([low, low + width])
    if not cut_ids:
        return np.empty(0, dtype=np.int64), np.empty(0)
    return np.concatenate(cut_ids), np.concatenate(cut_ts)


# Where the density is sampled, and how many edges by halving make it worth while: between samples it counts as
# even, which near a cusp takes many. Equal shares are only kept where the bound proves them.
_SAMPLES = ((33, 2), (513, 24))
_ROWS = 1024  # cubics sampled at once


def _even_cuts(
    cubics: FloatArray, halved: IntArray, tolerance: float
) -> tuple[IntArray, FloatArray, NDArray[np.bool_]]:
    """Cut at equal shares of the integral of sqrt(|P' x P''| / |P'|) dt, the density of the best polyline.

    A chord over dt is off by |P' x P''| dt^2 / (8 |P'|) to leading order, so n = total / sqrt(8 tolerance).
    Kept for a curve only where every piece passes the bound and there are fewer than by halving.

    Returns:
        Curve of each cut, its t, and which curves are taken.
    """
    taken = np.zeros(len(cubics), dtype=np.bool_)
    found: list[tuple[IntArray, FloatArray]] = [(np.empty(0, dtype=np.int64), np.empty(0))]
    for samples, worth in _SAMPLES:
        rows = np.flatnonzero((halved >= worth) & ~taken)
        for begin in range(0, len(rows), _ROWS):
            found += _even_rows(cubics, rows[begin : begin + _ROWS], halved, tolerance, samples, taken)
    return np.concatenate([ids for ids, _ in found]), np.concatenate([ts for _, ts in found]), taken


def _even_rows(
    cubics: FloatArray, rows: IntArray, halved: IntArray, tolerance: float, samples: int, taken: NDArray[np.bool_]
) -> list[tuple[IntArray, FloatArray]]:
    """Try the predicted number of pieces and a few more; mark the rows of curves that are taken."""
    t, share = _shares(chosen(cubics, rows), samples)
    wanted = np.ceil(share[:, -1] / math.sqrt(8 * tolerance)).astype(np.int64)
    found = []
    for extra in range(5):
        count = np.maximum(wanted + extra * np.maximum(wanted // 64, 1), 1)
        trial = np.flatnonzero(~taken[rows] & (count <= halved[rows]))
        if not len(trial):
            break
        which, cuts = _invert(t, share[trial], count[trial])
        passed = _passes(chosen(cubics, rows[trial]), which, cuts, count[trial], tolerance)
        taken[rows[trial[passed]]] = True
        keep = passed[which]
        found.append((rows[trial[which[keep]]], cuts[keep]))
    return found


def _shares(cubics: FloatArray, samples: int) -> tuple[FloatArray, FloatArray]:
    """Sample parameters (k,) and the running integral of the density at them: (n, k)."""
    t = np.linspace(0.0, 1.0, samples)
    middle = (t[1:] + t[:-1]) / 2
    d = 3 * np.diff(cubics, axis=1)
    dd = 2 * np.diff(d, axis=1)
    s = 1 - middle
    first = d[:, 0, :, None] * s**2 + 2 * d[:, 1, :, None] * s * middle + d[:, 2, :, None] * middle**2
    second = dd[:, 0, :, None] * s + dd[:, 1, :, None] * middle
    cross = np.abs(first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0])
    speed = np.hypot(first[:, 0], first[:, 1])
    density = np.sqrt(np.divide(cross, speed, out=np.zeros_like(cross), where=speed > 0))
    density += 1e-3 * density.max(axis=1, keepdims=True)  # so that the integral rises everywhere
    share = np.concatenate([np.zeros((len(cubics), 1)), np.cumsum(density, axis=1)], axis=1) / (samples - 1)
    return t, share


def _invert(t: FloatArray, share: FloatArray, count: IntArray) -> tuple[IntArray, FloatArray]:
    """Inner parameters that cut each row's integral into ``count`` equal shares."""
    which, rank = numbered(count - 1)
    rank += 1
    span = share[:, -1].max() * 2 + 1  # rows end to end on one axis, so that one search serves all
    flat = (share + span * np.arange(len(share))[:, None]).ravel()
    target = share[which, -1] * rank / count[which] + span * which
    at = np.searchsorted(flat, target, side="right") - 1
    row_at = np.clip(at - which * len(t), 0, len(t) - 2)
    low = share[which, row_at]
    part = (share[which, -1] * rank / count[which] - low) / np.maximum(share[which, row_at + 1] - low, 1e-300)
    return which, t[row_at] + np.clip(part, 0.0, 1.0) * (t[1] - t[0])


def _passes(
    cubics: FloatArray, which: IntArray, cuts: FloatArray, count: IntArray, tolerance: float
) -> NDArray[np.bool_]:
    ids = np.repeat(np.arange(len(count)), count)
    low, high = bounds_of(which, cuts, count)
    bound = chord_bound(cut_between(chosen(cubics, ids), low, high))
    failures = np.bincount(ids[bound > tolerance], minlength=len(count))
    passed: NDArray[np.bool_] = failures == 0
    return passed


def bounds_of(which: IntArray, cuts: FloatArray, count: IntArray) -> tuple[FloatArray, FloatArray]:
    """From inner parameters by row (rising) to the two ends of every piece; ``count`` pieces a row."""
    total = int(count.sum())
    first = np.cumsum(count) - count
    low, high = np.zeros(total), np.ones(total)
    rank = numbered(count - 1)[1]
    low[first[which] + rank + 1] = cuts
    high[first[which] + rank] = cuts
    return low, high


def _arc_cuts(arcs: Arcs, tolerance: float) -> tuple[IntArray, FloatArray]:
    """Inner positions of all arcs, as a part of the turn: equal angles, never more than a quarter turn."""
    radius = np.maximum(*arcs.radii)
    with np.errstate(divide="ignore"):
        step = 2 * np.arccos(np.maximum(1 - tolerance / radius, math.cos(math.pi / 4)))
    step = np.where(step > 0, step, np.sqrt(8 * tolerance / np.maximum(radius, 1e-300)))  # 1 - tiny rounded to 1
    count = np.maximum(np.ceil(np.abs(arcs.turn) / step * (1 - 1e-12)), 1)
    within_limit(int(min(count.sum(), 2 * MAX_VERTICES)))
    count = count.astype(np.int64)
    which, rank = numbered(count - 1)
    return which, (rank + 1) / count[which]


_MEASURED_AT = np.linspace(0.0, 1.0, 17)[1:-1]
_MEASURED_AGAIN = 16  # so many of the worst pieces are looked at closely


def _off(cubics: FloatArray, which: IntArray, cuts: FloatArray, counts: IntArray) -> FloatArray:
    """Measure the largest distance of each piece from its chord, at the extremes and between."""
    ids = np.repeat(np.arange(len(cubics)), counts + 1)
    low, high = bounds_of(which, cuts, counts + 1)
    far = np.empty(len(ids))
    for begin in range(0, len(ids), _BLOCK):
        rows = slice(begin, begin + _BLOCK)
        far[rows] = _farthest(cut_between(chosen(cubics, ids[rows]), low[rows], high[rows]))
    return far


def _worst(cubics: FloatArray, counts: IntArray, cuts: FloatArray, far: FloatArray) -> float:
    """The largest distance of a piece from its chord, once the worst of ``far`` have been looked at closely."""
    again = np.argsort(far)[-_MEASURED_AGAIN:]
    last = np.cumsum(counts + 1) - 1  # piece of each cubic
    ids = np.searchsorted(last, again)
    low, high = np.zeros(len(again)), np.ones(len(again))  # before piece p of cubic c are p - c cuts
    inner = again < last[ids]
    high[inner] = cuts[(again - ids)[inner]]
    inner = again > last[ids] - counts[ids]
    low[inner] = cuts[(again - ids)[inner] - 1]
    return max(float(far.max()), *map(_peak, cut_between(cubics[ids], low, high)))


def _farthest(piece: FloatArray) -> FloatArray:
    """The largest distance of each piece from its chord, of those that are looked at: (n,).

    Where the inner control points project onto the chord so does the curve (convex hull), and its extremes are it.
    """
    a, b = piece[:, 0], piece[:, 3]
    x, y = b[:, 0] - a[:, 0], b[:, 1] - a[:, 1]
    arms = [(piece[:, i, 0] - a[:, 0], piece[:, i, 1] - a[:, 1]) for i in (1, 2)]
    farthest = np.zeros(len(piece))
    for t in extreme_parameters(*(x * v - y * u for u, v in arms)):
        np.maximum(farthest, segment_distance(evaluate(piece, t), a, b), out=farthest)
    along, square = [x * u + y * v for u, v in arms], x * x + y * y
    beyond = np.flatnonzero((np.minimum(*along) < 0) | (np.maximum(*along) > square))
    hooks, a, b = piece[beyond], a[beyond], b[beyond]
    for t in _MEASURED_AT:
        distance = segment_distance(evaluate(hooks, np.full(len(hooks), t)), a, b)
        farthest[beyond] = np.maximum(farthest[beyond], distance)
    return farthest


def _peak(cubic: FloatArray) -> float:
    """Look closely, and then around the farthest place still closer: a hook beyond the chord's end peaks elsewhere."""
    low, high, farthest = 0.0, 1.0, 0.0
    for _ in range(2):  # of 2048 parts, then of 2048 of two of these: the last miss is 1e-12 of the peak's width
        t = np.linspace(low, high, 2049)
        distance = segment_distance(evaluate(np.broadcast_to(cubic, (len(t), 4, 2)), t), cubic[0], cubic[3])
        at = int(distance.argmax())
        farthest = max(farthest, float(distance[at]))
        low, high = t[max(at - 1, 0)], t[min(at + 1, 2048)]
    return farthest


def _arc_error(arcs: Arcs, which: IntArray, parts: FloatArray) -> float:
    """Measure the largest distance from the arcs to their chords.

    The tangent is parallel to the chord at the middle angle, so that is where an arc of at most half a turn
    is farthest away.
    """
    if not len(arcs.turn):
        return 0.0
    count = np.bincount(which, minlength=len(arcs.turn)) + 1
    arcs = arcs.take(np.repeat(np.arange(len(count)), count))
    low, high = bounds_of(which, parts, count)
    a, b = arcs.points(arcs.start + arcs.turn * low), arcs.points(arcs.start + arcs.turn * high)
    return float(segment_distance(arcs.points(arcs.start + arcs.turn * (low + high) / 2), a, b).max())
