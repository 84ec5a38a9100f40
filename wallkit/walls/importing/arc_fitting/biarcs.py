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

import math
from collections.abc import Iterator
from dataclasses import dataclass, fields
from typing import Any

import numpy as np
from numpy.typing import NDArray

from wallkit.geometry.arrays import FloatArray, IntArray
from wallkit.walls.importing.arc_fitting.curves import (
    BoolArray,
    ComplexArray,
    cross,
    dot,
    length,
    turned_back,
    unit,
)
from wallkit.walls.importing.arc_fitting.machine_code import CloseLook, joined_ends, looked_at, looked_closely
from wallkit.walls.importing.arc_fitting.moved_curves import Moved
from wallkit.walls.importing.arc_fitting.smooth_chains import Chains, Sections

# Directions that are equal within this make the two arcs one. The kink that is left in the middle of nowhere,
# at the piece's ends, is half of it: an order below the 1e-9 that is promised for joints.
SAME = 2e-10
# A whole segment may become one arc that leaves its ends by up to this (radians), if it stays within the
# tolerance: the natural arc of a circle that some program wrote with a few decimals. A quarter circle written as
# a cubic differs in direction from its circle by as much anyway.
_NEARLY_SAME = 1e-3
# Below this a bulge means no more than the rounding of its end points: the edge is a line.
STRAIGHT = 1e-12
# Pieces whose direction differs by more from their arcs are cut further, so that arcs never take short cuts
# through a loop, however large the tolerance.
_LARGEST_TURN = math.tan(0.5 / 2)  # of half the angle, as turns are measured


@dataclass(slots=True, eq=False, repr=False)
class Spans:
    """Pieces of chains, all arrays of one length; points relative to the first point of their chain.

    Attributes:
        ids: the chain.
        stretch: the smooth stretch, between two cusps or ends, that each is a part of.
        low: parameter of the start.
        high: parameter of the end.
        p0: start point.
        p1: end point.
        t0: direction at the start.
        t1: direction at the end.
    """

    ids: IntArray
    stretch: IntArray
    low: FloatArray
    high: FloatArray
    p0: ComplexArray
    p1: ComplexArray
    t0: ComplexArray
    t1: ComplexArray

    def __len__(self) -> int:
        return len(self.ids)

    def take(self, index: NDArray[np.generic]) -> Spans:
        """Give those at ``index``, or where it is true."""
        rows: Any = np.flatnonzero(index) if index.dtype == np.bool_ else index
        return Spans(*(column.take(rows) for column in self.columns))

    @property
    def columns(self) -> tuple[NDArray[Any], ...]:
        """All arrays, in order."""
        return self.ids, self.stretch, self.low, self.high, self.p0, self.p1, self.t0, self.t1

    @staticmethod
    def joined(parts: list[Spans]) -> Spans:
        """String several together."""
        return Spans(*map(np.concatenate, zip(*(part.columns for part in parts), strict=True)))

    def cut(self, chains: Chains, counts: IntArray, at: FloatArray) -> Spans:
        """Cut each into ``counts`` (>= 1) at the parameters ``at``, one after the other."""
        result = self.take(np.repeat(np.arange(len(self)), counts))
        first = np.zeros(len(result), dtype=np.bool_)
        first[np.cumsum(counts) - counts] = True
        later, earlier = np.flatnonzero(~first), np.flatnonzero(~first) - 1
        point, direction = chains.at(result.ids[later], at)
        result.low[later], result.high[earlier] = at, at
        result.p0[later], result.p1[earlier] = point, point
        result.t0[later], result.t1[earlier] = direction, direction
        return result


@dataclass(slots=True, eq=False, repr=False)
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


def biarcs(spans: Spans, loose: BoolArray | None = None, *, machine_code: bool = False) -> Biarcs:
    """Join the ends of each span by arcs.

    Args:
        spans: the pieces; where the chord runs against the directions there is no arc of at most a half
            circle, and ``sound`` is false.
        loose: where one arc is taken even if it leaves the ends a little off the directions there.
        machine_code: let compiled kernels do it.
    """
    limit = np.full(len(spans), SAME) if loose is None else np.where(loose, _NEARLY_SAME, SAME)
    if machine_code:
        ends, bends, bulges, told = joined_ends(spans, limit, STRAIGHT)
        return Biarcs(*ends, *bends, *bulges, *told)
    v, both, across = spans.p1 - spans.p0, spans.t0 + spans.t1, spans.t0 - spans.t1
    ahead, apart, square = dot(v, both), dot(across, across), dot(v, v)
    with np.errstate(divide="ignore", invalid="ignore"):
        arm = square / (ahead + np.sqrt(ahead**2 + apart * square))  # apart = 2 (1 - T0 . T1)
    sound = (ahead > 0) & np.isfinite(arm)
    arm = np.where(sound, arm, 0.0)
    joint = (spans.p0 + spans.p1 + arm * across) / 2
    along = unit(v - arm * both)
    bend0, bulge0 = _from(spans.t0, joint - spans.p0)
    bend1, bulge1 = _from(along, spans.p1 - joint)
    straight = unit(v)
    start, end = turned_back(straight, spans.t0), turned_back(spans.t1, straight)
    single: BoolArray = (sound & (length(start - end) <= limit)) | (v == 0)
    rows = np.flatnonzero(single)
    if len(rows):
        # The mean of the two half angles is that of an arc between the end points: the angle h of the mean direction,
        # tan(h / 2) = sin h / (1 + cos h).
        half, chord = unit(start[rows] + end[rows]), v[rows]
        bulge, size = half.imag / (1 + half.real), length(chord)
        joint[rows], along[rows] = (spans.p0[rows] + spans.p1[rows]) / 2 - 0.5j * chord * bulge, straight[rows]
        bend0[rows] = bend1[rows] = np.divide(2 * half.imag, size, out=np.zeros_like(size), where=size > 0)
        bulge0[rows], bulge1[rows] = bulge, 0.0
    sound &= (np.abs(bulge0) <= 1) & (np.abs(bulge1) <= 1)
    return Biarcs(joint, along, bend0, bend1, _rounded(bulge0), _rounded(bulge1), single, sound)


def flatten(spans: Spans, arcs: Biarcs) -> bool:
    """Make a line, in place, of each span without arcs, too short for a direction; tell whether there was any."""
    v = spans.p1 - spans.p0
    rows = np.flatnonzero(~arcs.sound & (v != 0))
    arcs.joint[rows], arcs.along[rows] = (spans.p0[rows] + spans.p1[rows]) / 2, unit(v[rows])
    for part in (arcs.bend0, arcs.bend1, arcs.bulge0, arcs.bulge1):
        part[rows] = 0.0
    arcs.single[rows] = True
    return len(rows) > 0


def _from(direction: ComplexArray, chord: ComplexArray) -> tuple[FloatArray, FloatArray]:
    """Curvature and bulge of the arc that starts in a direction and has a chord."""
    side, ahead, square = cross(direction, chord), dot(direction, chord), dot(chord, chord)
    there = square > 0
    bend = np.divide(2 * side, square, out=np.zeros_like(side), where=there)
    with np.errstate(divide="ignore", invalid="ignore"):
        bulge = side / (
            np.sqrt(square) + ahead
        )  # tan(h / 2) = sin h / (1 + cos h), h the angle from direction to chord
    return bend, np.where(there & np.isfinite(bulge), bulge, 0.0)


def _rounded(bulge: FloatArray) -> FloatArray:
    return np.where(np.abs(bulge) < STRAIGHT, 0.0, bulge)


@dataclass(slots=True, eq=False, repr=False)
class Fit:
    """How arcs fit their spans.

    Attributes:
        distance: (n,) largest measured distance.
        turn: (n,) largest measured angle between the directions (so between the normals), as the tangent of its half.
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


def look(chains: Chains, spans: Spans, fractions: FloatArray) -> Fit:
    """Join spans by arcs, for cubics by compiled kernels, and measure: see :func:`measure`."""
    distance, turn, sound = looked_at(chains, spans, (SAME, _NEARLY_SAME), STRAIGHT, fractions)
    return Fit(distance, turn, sound & (turn <= _LARGEST_TURN))


def look_closely(chains: Chains, spans: Spans, fractions: FloatArray, margin: float) -> CloseLook:
    """Join spans by arcs, for cubics by compiled kernels, and measure in all sections, a margin away from the ends."""
    return looked_closely(chains, spans, (SAME, _NEARLY_SAME), STRAIGHT, fractions, margin)


MOST_PLACES = 1 << 14  # of sections measured at once, so that the work stays in the cache


def measure(chains: Chains, spans: Spans, arcs: Biarcs, fractions: FloatArray) -> Fit:
    """Measure at fixed fractions of the parameter range of each part of a span that is in one curve."""
    sections = chains.sections(spans.ids, spans.low, spans.high)
    distance, turn = np.zeros(len(sections)), np.zeros(len(sections))
    for rows in portions(len(sections), len(fractions)):
        low = sections.low[rows]
        t = low + (sections.high[rows] - low) * fractions[:, None]
        off, angle = Ruler.of(chains, sections, rows, arcs).offsets(t)
        distance[rows], turn[rows] = np.abs(off).max(axis=0), angle.max(axis=0)
    return largest(sections.rows, distance, turn, arcs.sound)


def portions(count: int, places: int) -> Iterator[slice]:
    """Give portions of so many sections that are looked at in so many places each."""
    step = max(MOST_PLACES // places, 1)
    return (slice(first, first + step) for first in range(0, count, step))


def largest(rows: IntArray, distance: FloatArray, turn: FloatArray, sound: BoolArray) -> Fit:
    """Give the largest distance and turn of each span from those of its sections, ``rows`` the span of each."""
    first = np.flatnonzero(np.diff(rows, prepend=-1))
    if len(first) < len(rows):
        distance, turn = np.maximum.reduceat(distance, first), np.maximum.reduceat(turn, first)
    sound = sound & (turn <= _LARGEST_TURN)
    return Fit(distance, turn, sound)


def deviations(
    chains: Chains, spans: Spans, arcs: Biarcs, fractions: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Signed distances of curve points from the arcs, at fixed fractions of the parameter range.

    Returns:
        The distances (k, n), left of the arcs positive; where on the chord, as a part of it, each point is
        (k, n); the lengths of the chords (n,).
    """
    distance, part = np.empty((len(fractions), len(spans))), np.empty((len(fractions), len(spans)))
    chord = spans.p1 - spans.p0
    square = dot(chord, chord)
    divisor = np.where(square > 0, square, 1.0)
    start, way = turned_back(spans.p0 - arcs.joint, arcs.along), turned_back(chord, arcs.along)
    for rows in portions(len(spans), len(fractions)):
        low = spans.low[rows]
        u = low + (spans.high[rows] - low) * fractions[:, None]
        x, y = chains.places_from(spans.ids[rows], u, arcs.joint[rows], arcs.along[rows])
        distance[:, rows] = _offset(x, y, np.where(x < 0, arcs.bend0[rows], arcs.bend1[rows]))
        x -= start.real[rows]
        y -= start.imag[rows]
        part[:, rows] = (x * way.real[rows] + y * way.imag[rows]) / divisor[rows]
    return distance, part, np.sqrt(square)


@dataclass(slots=True, eq=False, repr=False)
class Ruler:
    """Measures sections of curves against their arcs, (n,) each.

    Attributes:
        curves: the curves in axes with the origin at J and x along the arcs.
        bend0: curvatures of the first arcs.
        bend1: curvatures of the second arcs.
    """

    curves: Moved
    bend0: FloatArray
    bend1: FloatArray

    @classmethod
    def of(cls, chains: Chains, sections: Sections, rows: slice, arcs: Biarcs) -> Ruler:
        """Take some sections of spans that have arcs."""
        curve, span = sections.curves[rows], sections.rows[rows]
        moved = chains.curves.moved(curve, arcs.joint[span] - chains.shifts[curve], arcs.along[span])
        return cls(moved, arcs.bend0[span], arcs.bend1[span])

    def offsets(self, t: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Signed distances (left is positive) at ``t`` (k, n), and tangents of half the angles between directions.

        The arc's direction at the foot is i times its normal there, n - k Q, so 1 - k y + i k x in these axes.
        """
        x, y, vx, vy = self.curves.motion(t)
        bend = np.where(x < 0, self.bend0, self.bend1)
        distance = _offset(x, y, bend)
        y *= bend
        fx = np.subtract(1, y, out=y)
        fy = np.multiply(bend, x, out=x)
        side = fx * vy
        side -= fy * vx
        vx *= fx
        vy *= fy
        vx += vy
        return distance, half_tangent(side, vx)


def half_tangent(side: FloatArray, ahead: FloatArray) -> FloatArray:
    """Tan(h / 2) = sin h / (1 + cos h) of the angle h between vectors, by cross and dot product; 0 where one is 0.

    Beyond a right angle it is (1 - cos h) / sin h, infinite or so for half a turn. What is added to the divisor is
    less than the rounding of anything but 0.
    """
    size = side * side
    size += ahead * ahead
    np.sqrt(size, out=size)
    side = np.abs(side, out=side)
    back = ahead < 0
    over = np.where(back, size - ahead, side)
    size += ahead
    under = np.where(back, side, size)
    under += 1e-300
    with np.errstate(over="ignore"):
        over /= under
    return over


def _offset(x: FloatArray, y: FloatArray, bend: FloatArray) -> FloatArray:
    """Signed distances of points in axes at J along the arcs, ``bend`` the curvature of the arc on their side."""
    f = x * x
    f += y * y
    f *= bend
    f /= 2
    f -= y
    root = 2 * bend
    root *= f
    root += 1
    np.maximum(root, 0.0, out=root)
    np.sqrt(root, out=root)
    root += 1
    f *= -2
    f /= root
    return f
