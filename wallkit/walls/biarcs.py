"""Biarcs: two circular arcs from one point and direction to another, and how far a curve is from them.

Between the points P0 and P1 with unit tangents T0 and T1, v = P1 - P0, the arm d of equal length at both ends
solves 2 (1 - T0 . T1) d^2 + 2 d v . (T0 + T1) = |v|^2; the arcs meet at J = (P0 + P1 + d (T0 - T1)) / 2 with the
direction of v - d (T0 + T1). (The construction is Bolton's, Computer-Aided Design 7, 1975.) Where both arcs lie on
one circle they are one edge.

Distances. Let Q be a point's place relative to J, n the arcs' left normal at J and k an arc's curvature. With
f = k |Q|^2 / 2 - Q . n the distance to the circle is 2 f / (1 + sqrt(1 + 2 k f)), which holds without loss of
digits from tight arcs to straight lines (k = 0). A point of the curve belongs to the arc on its side of the
normal line through J. As long as curve and arcs differ in direction by less than a right angle, that match runs
along both in order, so that the largest distance over it bounds the distance both ways (it is a Frechet distance).
"""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import NDArray

from wallkit.walls.curves import ComplexArray, Curves, cross, dot, unit
from wallkit.walls.strokes import FloatArray, IntArray

BoolArray = NDArray[np.bool_]

# Directions that are equal within this make the two arcs one. The kink that is left in the middle of nowhere,
# at the piece's ends, is half of it: an order below the 1e-9 that is promised for joints.
_SAME = 2e-10
# A whole segment may become one arc that leaves its ends by up to this (radians), if it stays within the
# tolerance: the natural arc of a circle that some program wrote with a few decimals. A quarter circle written as
# a cubic differs in direction from its circle by as much anyway.
_NEARLY_SAME = 1e-3
# Below this a bulge means no more than the rounding of its end points: the edge is a line.
_STRAIGHT = 1e-12
# Pieces whose direction differs by more from their arcs are cut further, so that arcs never take short cuts
# through a loop, however large the tolerance.
_LARGEST_TURN = 0.5


@dataclass(slots=True)
class Spans:
    """Pieces of curves, all arrays of one length; points relative to the first point of their curve.

    Attributes:
        ids: the curve.
        low: parameter of the start.
        high: parameter of the end.
        p0: start point.
        p1: end point.
        t0: direction at the start.
        t1: direction at the end.
    """

    ids: IntArray
    low: FloatArray
    high: FloatArray
    p0: ComplexArray
    p1: ComplexArray
    t0: ComplexArray
    t1: ComplexArray

    def __len__(self) -> int:
        return len(self.ids)

    def take(self, index: NDArray[np.generic]) -> Spans:
        """Give those at ``index``."""
        return Spans(*(getattr(self, part.name)[index] for part in fields(self)))

    @staticmethod
    def joined(parts: list[Spans]) -> Spans:
        """String several together."""
        names = [part.name for part in fields(Spans)]
        return Spans(*(np.concatenate([getattr(part, name) for part in parts]) for name in names))

    @staticmethod
    def between(curves: Curves, start: Spans, end: Spans, low: FloatArray, high: FloatArray) -> Spans:
        """Cut spans at new parameters; where one is the old end, that end's point and direction are kept.

        Args:
            curves: the curves.
            start: the spans that each new one starts in.
            end: the spans that each new one ends in (of the same curve).
            low: new starts.
            high: new ends.
        """
        p0, t0 = _on_curve(curves, start.ids, low)
        p1, t1 = _on_curve(curves, end.ids, high)
        first, last = low == start.low, high == end.high
        return Spans(
            start.ids,
            low,
            high,
            np.where(first, start.p0, p0),
            np.where(last, end.p1, p1),
            np.where(first, start.t0, t0),
            np.where(last, end.t1, t1),
        )

    def halved(self, curves: Curves) -> Spans:
        """Cut each in two at the middle parameter; the two halves stand next to each other."""
        middle = (self.low + self.high) / 2
        point, direction = _on_curve(curves, self.ids, middle)
        twice = np.repeat(np.arange(len(self)), 2)
        halves = self.take(twice)
        halves.high[0::2], halves.low[1::2] = middle, middle
        halves.p1[0::2], halves.p0[1::2] = point, point
        halves.t1[0::2], halves.t0[1::2] = direction, direction
        return halves


def _on_curve(curves: Curves, ids: IntArray, t: FloatArray) -> tuple[ComplexArray, ComplexArray]:
    place, velocity = curves.motion(ids, t[:, None])
    return place[:, 0], unit(velocity[:, 0])


@dataclass(slots=True)
class Biarcs:
    """The arcs of spans, arrays of one length.

    Attributes:
        joint: J, where the arcs meet; a point of the arc where they are one.
        along: direction at J.
        bend0: curvature of the first arc, positive when it turns left.
        bend1: curvature of the second arc.
        bulge0: bulge of the first arc, or of the one.
        bulge1: bulge of the second arc.
        single: both are one.
        sound: each arc is at most a half circle, and J is between the ends.
    """

    joint: ComplexArray
    along: ComplexArray
    bend0: FloatArray
    bend1: FloatArray
    bulge0: FloatArray
    bulge1: FloatArray
    single: BoolArray
    sound: BoolArray


def biarcs(spans: Spans, loose: BoolArray | None = None) -> Biarcs:
    """Join the ends of each span by arcs.

    Args:
        spans: the pieces; where the chord runs against the directions there is no arc of at most a half
            circle, and ``sound`` is false.
        loose: where one arc is taken even if it leaves the ends a little off the directions there.
    """
    v, both = spans.p1 - spans.p0, spans.t0 + spans.t1
    ahead, apart = dot(v, both), np.abs(spans.t1 - spans.t0) ** 2
    square = v.real**2 + v.imag**2
    with np.errstate(divide="ignore", invalid="ignore"):
        arm = square / (ahead + np.sqrt(ahead**2 + apart * square))  # apart = 2 (1 - T0 . T1)
    sound = (ahead > 0) & np.isfinite(arm)
    arm = np.where(sound, arm, 0.0)
    joint = (spans.p0 + spans.p1 + arm * (spans.t0 - spans.t1)) / 2
    along = unit(v - arm * both)
    bend0, bulge0 = _from(spans.t0, joint - spans.p0)
    bend1, bulge1 = _from(along, spans.p1 - joint)
    single = _one_arc(spans, v, sound, loose) | (v == 0)
    if single.any():
        # the mean of the two half angles is that of an arc between the end points
        half = np.where(v == 0, 0.0, (np.angle(v * spans.t0.conj()) + np.angle(spans.t1 * v.conj())) / 2)
        bulge = np.tan(half / 2)
        middle = (spans.p0 + spans.p1) / 2 - 0.5j * v * bulge
        bend = np.divide(2 * np.sin(half), np.abs(v), out=np.zeros_like(half), where=v != 0)
        joint, along = np.where(single, middle, joint), np.where(single, unit(v), along)
        bend0, bend1 = np.where(single, bend, bend0), np.where(single, bend, bend1)
        bulge0, bulge1 = np.where(single, bulge, bulge0), np.where(single, 0.0, bulge1)
    sound &= (np.abs(bulge0) <= 1) & (np.abs(bulge1) <= 1)
    return Biarcs(joint, along, bend0, bend1, _rounded(bulge0), _rounded(bulge1), single, sound)


def _from(direction: ComplexArray, chord: ComplexArray) -> tuple[FloatArray, FloatArray]:
    """Curvature and bulge of the arc that starts in a direction and has a chord."""
    side, ahead, length = cross(direction, chord), dot(direction, chord), np.abs(chord)
    there = length > 0
    bend = np.divide(2 * side, length**2, out=np.zeros_like(side), where=there)
    with np.errstate(divide="ignore", invalid="ignore"):
        bulge = side / (length + ahead)  # tan(h / 2) = sin h / (1 + cos h), h the angle from direction to chord
    return bend, np.where(there & np.isfinite(bulge), bulge, 0.0)


def _one_arc(spans: Spans, v: ComplexArray, sound: BoolArray, loose: BoolArray | None) -> BoolArray:
    start, end = unit(v) * spans.t0.conj(), spans.t1 * unit(v).conj()
    limit = _SAME if loose is None else np.where(loose, _NEARLY_SAME, _SAME)
    same: BoolArray = sound & (np.abs(start - end) <= limit)
    return same


def _rounded(bulge: FloatArray) -> FloatArray:
    return np.where(np.abs(bulge) < _STRAIGHT, 0.0, bulge)


@dataclass(slots=True)
class Fit:
    """How arcs fit their spans.

    Attributes:
        distance: (n,) largest measured distance.
        turn: (n,) largest measured angle between the directions (so between the normals).
        sound: (n,) the arcs may be used at all.
    """

    distance: FloatArray
    turn: FloatArray
    sound: BoolArray

    def take(self, index: NDArray[np.generic]) -> Fit:
        """Give those at ``index``."""
        return Fit(self.distance[index], self.turn[index], self.sound[index])

    @staticmethod
    def joined(parts: list[Fit]) -> Fit:
        """String several together."""
        return Fit(*(np.concatenate([getattr(part, name.name) for part in parts]) for name in fields(Fit)))


CHUNK = 1 << 15  # spans measured at once, so that the working memory stays near 50 MB


def measure(curves: Curves, spans: Spans, arcs: Biarcs, fractions: FloatArray) -> Fit:
    """Measure at fixed fractions of each span's parameter range."""
    distance, turn = np.zeros(len(spans)), np.zeros(len(spans))
    for first in range(0, len(spans), CHUNK):
        rows = slice(first, first + CHUNK)
        width = (spans.high - spans.low)[rows, None]
        off, angle = offsets(curves, spans.ids[rows], spans.low[rows, None] + width * fractions, arcs, rows)
        distance[rows], turn[rows] = np.abs(off).max(axis=1), angle.max(axis=1)
    return Fit(distance, turn, turning_within(arcs, turn))


def turning_within(arcs: Biarcs, turn: FloatArray) -> BoolArray:
    """Tell where arcs are sound and no direction is off by more than the largest allowed."""
    within: BoolArray = arcs.sound & (turn <= _LARGEST_TURN)
    return within


def offsets(curves: Curves, ids: IntArray, t: FloatArray, arcs: Biarcs, rows: slice) -> tuple[FloatArray, FloatArray]:
    """Signed distances (left is positive) and angles between directions of curve points at t: (n, k) each."""
    place, velocity = curves.motion(ids, t)
    # in axes with the origin at J and x along the arcs: x + i y
    turned = (place - arcs.joint[rows, None]) * arcs.along[rows, None].conj()
    velocity = velocity * arcs.along[rows, None].conj()
    x, y = turned.real, turned.imag
    bend = np.where(x < 0, arcs.bend0[rows, None], arcs.bend1[rows, None])
    f = bend * (x * x + y * y) / 2 - y
    distance = -2 * f / (1 + np.sqrt(np.maximum(1 + 2 * bend * f, 0.0)))
    # The arc's direction at the foot is i times its normal there, n - k Q, so 1 - k y + i k x in these axes.
    fx, fy, vx, vy = 1 - bend * y, bend * x, velocity.real, velocity.imag
    return distance, np.abs(np.arctan2(fx * vy - fy * vx, fx * vx + fy * vy))
