"""Curves in one form for fitting: points, velocities and accelerations of many curves, as complex numbers.

A point (x, y) is x + i y, relative to its curve's first point, so that a drawing far from the origin costs no
digits. Complex numbers are added and scaled here, but multiplied as real ones: NumPy's product of two complex numbers,
and their absolute value, have other last digits on other processors.

What is measured at many places of many curves is measured in real numbers (``moved_curves``).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from wallkit.geometry.arrays import FloatArray, IntArray
from wallkit.geometry.ellipse_arcs import Arcs
from wallkit.walls.importing.arc_fitting.moved_curves import Moved, MovedCubics, MovedEllipses

ComplexArray = NDArray[np.complex128]
BoolArray = NDArray[np.bool_]

# Of a curve's size: places on it are known to some eps of that (2e-16), so that a part as short as this has no
# direction to speak of.
ROUNDING = 1e-14
_FLAT = 1e-8  # half axes in this ratio make an ellipse a line: what its tips turn in is the square of it, 1e-16


@dataclass(slots=True, eq=False, repr=False)
class Cusps:
    """Places inside of curves where these come to a stop, arrays of one length.

    Attributes:
        ids: the curve of each.
        t: its parameter there.
        coming: direction just before.
        leaving: direction just after: the opposite one, but where the curve stops and goes on.
    """

    ids: IntArray
    t: FloatArray
    coming: ComplexArray
    leaving: ComplexArray


class Curves(Protocol):
    """Many curves of one kind, each over t from 0 to 1."""

    def __len__(self) -> int: ...

    def take(self, index: NDArray[np.generic]) -> Curves:
        """Give those at ``index``."""
        ...

    @property
    def last(self) -> ComplexArray:
        """(n,) the last point of each."""
        ...

    @property
    def sizes(self) -> FloatArray:
        """(n,) about the extent of each, to judge rounding by."""
        ...

    @property
    def lengths(self) -> FloatArray:
        """(n,) about the length of each, good enough to compare curves."""
        ...

    def places(self, ids: IntArray, t: FloatArray) -> ComplexArray:
        """Points of curves ``ids`` (n,) at ``t`` (n, k): (n, k)."""
        ...

    def motion(self, ids: IntArray, t: FloatArray) -> tuple[ComplexArray, ComplexArray]:
        """Points and velocities (first derivatives by t) of curves ``ids`` (n,) at ``t`` (n, k): (n, k) each."""
        ...

    def moved(self, ids: IntArray, origin: ComplexArray, along: ComplexArray) -> Moved:
        """Curves ``ids`` (n,) in axes at ``origin`` (n,), seen from their first points, the x axis ``along`` (n,)."""
        ...

    def accelerations(self, ids: IntArray, t: FloatArray) -> ComplexArray:
        """Second derivatives by t: (n, k)."""
        ...

    def end_tangents(self) -> tuple[ComplexArray, ComplexArray]:
        """(n,) directions at the two ends, of length one; 0 for a curve that is a point."""
        ...

    def cusps(self) -> Cusps:
        """Where the curve comes to a stop, inside, in rising order."""
        ...


def length(z: ComplexArray) -> FloatArray:
    """Absolute values."""
    x, y = z.real, z.imag
    result: FloatArray = np.sqrt(x * x + y * y)
    return result


def unit(z: ComplexArray) -> ComplexArray:
    """Give numbers of length one; 0 stays 0."""
    size = length(z)
    there = size > 0
    result = np.zeros_like(z)
    np.divide(z.real, size, out=result.real, where=there)
    np.divide(z.imag, size, out=result.imag, where=there)
    return result


def turned_back(a: ComplexArray, b: ComplexArray) -> ComplexArray:
    """Give a conj(b), which is a in axes along b where b has length one."""
    result = np.empty(np.broadcast_shapes(a.shape, b.shape), dtype=np.complex128)
    result.real, result.imag = dot(b, a), cross(b, a)
    return result


def dot(a: ComplexArray, b: ComplexArray) -> FloatArray:
    """Scalar product of plane vectors."""
    result: FloatArray = a.real * b.real + a.imag * b.imag
    return result


def cross(a: ComplexArray, b: ComplexArray) -> FloatArray:
    """Positive where b is left of a."""
    result: FloatArray = a.real * b.imag - a.imag * b.real
    return result


def leading(velocity: ComplexArray, acceleration: ComplexArray, jerk: ComplexArray, least: FloatArray) -> IntArray:
    """Tell which derivative has the direction of a cubic motion v + a h + j h^2 / 2 once it is ``least`` away.

    The velocity has it until the others can have undone it: a h + j h^2 / 2 = v (all of them lengths), so that
    h = 2 v / (a + sqrt(a^2 + 2 j v)), after the way v h - a h^2 / 2 - j h^3 / 6. From standing the acceleration has it
    until h = 2 a / j, after the way a h^2 / 2 - j h^3 / 6 = 2 a^3 / (3 j^2). On a straight line the second is the
    way between two turning points.

    Returns:
        0 for the velocity, 1 for the acceleration, 2 for the jerk; 0 where the velocity is not a number.
    """
    v, a, j = length(velocity), length(acceleration), length(jerk)
    rate = a + np.sqrt(a * a + 2 * j * v)
    h = np.divide(2 * v, rate, out=np.where(v > 0, np.inf, 0.0), where=rate > 0)
    with np.errstate(invalid="ignore"):  # inf where nothing undoes the velocity
        stopped = h * (v - h * (a / 2 + j * h / 6)) <= least
    result: IntArray = np.where(stopped, np.where(2 * a**3 <= 3 * j * j * least, 2, 1), 0)
    return result


def as_complex(points: FloatArray) -> ComplexArray:
    """From (..., 2) to (...)."""
    result: ComplexArray = points[..., 0] + 1j * points[..., 1]
    return result


@dataclass(slots=True, eq=False, repr=False)
class Cubics:
    """Cubic Bezier curves, as polynomials c t + b t^2 + a t^3 from their first points.

    Attributes:
        control: (n, 4) control points, the first of them 0.
    """

    control: ComplexArray

    @classmethod
    def of(cls, cubics: FloatArray) -> Cubics:
        """Take (n, 4, 2) control points."""
        control = as_complex(cubics)
        return cls(control - control[:, :1])

    def __len__(self) -> int:
        return len(self.control)

    def take(self, index: NDArray[np.generic]) -> Cubics:
        """Give those at ``index``."""
        return Cubics(self.control[index])

    @property
    def last(self) -> ComplexArray:
        """(n,) the last point of each."""
        return self.control[:, 3]

    @property
    def sizes(self) -> FloatArray:
        """(n,) the largest distance of a control point from the first."""
        size: FloatArray = length(self.control).max(axis=1)
        return size

    @property
    def lengths(self) -> FloatArray:
        """(n,) the mean of chord and control polygon."""
        result: FloatArray = (length(np.diff(self.control, axis=1)).sum(axis=1) + length(self.last)) / 2
        return result

    def _powers(self, ids: IntArray) -> tuple[ComplexArray, ComplexArray, ComplexArray]:
        p = self.control[ids]
        c = 3 * p[:, 1:2]
        b = 3 * (p[:, 2:3] - 2 * p[:, 1:2])
        return p[:, 3:4] - c - b, b, c

    def places(self, ids: IntArray, t: FloatArray) -> ComplexArray:
        """Points."""
        place = np.empty(t.shape, dtype=np.complex128)
        a, b, c = self._powers(ids)
        for part in (np.real, np.imag):  # real numbers take a third of the time
            sum_ = part(a) * t
            sum_ += part(b)
            sum_ *= t
            sum_ += part(c)
            np.multiply(sum_, t, out=part(place))
        return place

    def motion(self, ids: IntArray, t: FloatArray) -> tuple[ComplexArray, ComplexArray]:
        """Points and first derivatives.

        The derivatives by Bernstein's form, which gives the right direction near an end whose arm has no length.
        """
        velocity = np.empty(t.shape, dtype=np.complex128)
        d = 3 * np.diff(self.control[ids], axis=1)
        s, double, square = 1 - t, 2 * t, t * t
        for part in (np.real, np.imag):
            first, second, third = (part(d[:, k : k + 1]) for k in range(3))
            sum_ = first * s
            sum_ += second * double
            sum_ *= s
            np.add(sum_, third * square, out=part(velocity))
        return self.places(ids, t), velocity

    def moved(self, ids: IntArray, origin: ComplexArray, along: ComplexArray) -> Moved:
        """Give cubics in axes of their own."""
        p = turned_back(self.control[ids].T, along)[1:]
        start = turned_back(origin, along)
        return MovedCubics.of(-start, p)

    def accelerations(self, ids: IntArray, t: FloatArray) -> ComplexArray:
        """Second derivatives."""
        a, b, _ = self._powers(ids)
        return 6 * a * t + 2 * b

    def _leading(self, ids: IntArray, t: FloatArray) -> IntArray:
        """Tell which derivative has the direction just beside t (n, k): (n, k)."""
        jerk = 6 * self._powers(ids)[0]
        least = ROUNDING * self.sizes[ids, None]
        return leading(self.motion(ids, t)[1], self.accelerations(ids, t), jerk, least)

    def end_tangents(self) -> tuple[ComplexArray, ComplexArray]:
        """Direction to the next control point, but for arms too short to matter beyond the rounding of places."""
        p = self.control
        order = self._leading(np.arange(len(p)), np.broadcast_to(np.array([0.0, 1.0]), (len(p), 2)))
        first, last = np.zeros(len(p), dtype=np.complex128), np.zeros(len(p), dtype=np.complex128)
        for rank, (near, far) in enumerate(((1, 2), (2, 1), (3, 0))):
            first = np.where((first == 0) & (order[:, 0] <= rank), unit(p[:, near] - p[:, 0]), first)
            last = np.where((last == 0) & (order[:, 1] <= rank), unit(p[:, 3] - p[:, far]), last)
        return first, last

    def cusps(self) -> Cusps:
        """Where the velocity vanishes, but for what the rounding of places hides.

        It turns back there against the acceleration. Where that vanishes as well, the curve is a straight line and
        goes on in the direction of the third derivative; two turning points with no way between them are the same.
        """
        ids = np.arange(len(self))
        a, _, _ = self._powers(ids)
        t = self._standing()
        order = self._leading(ids, t)
        on = order[:, -1] == 2  # the middle of two turning points: these are the same place
        t[:, :-1][on] = np.nan
        t = np.where((order > 0) & ~self._at_ends(t), t, np.nan)
        t = np.sort(t, axis=1)  # nan goes last
        with np.errstate(invalid="ignore"):
            t[:, 1:][np.diff(t, axis=1) < 1e-7] = np.nan  # the same cusp found twice
        which, column = np.nonzero(~np.isnan(t))
        found = t[which, column]
        back, onward = unit(self.accelerations(which, found[:, None])[:, 0]), unit(a[which, 0])
        return Cusps(which, found, np.where(on[which], onward, -back), np.where(on[which], onward, back))

    def _standing(self) -> FloatArray:
        """Where the velocity may vanish (n, 4), nan for none.

        The vertex of the quadratic (velocity x acceleration), which has a double root at a cusp; and for a curve on
        a straight line the turning points along it, and last the middle of these.
        """
        ids = np.arange(len(self))
        a, b, c = (part[:, 0] for part in self._powers(ids))
        spokes = self.control[:, 1:]
        along = unit(spokes[ids, length(spokes).argmax(axis=1)])
        with np.errstate(divide="ignore", invalid="ignore"):
            # velocity x acceleration = 2 (c x b + 3 t (c x a) + 3 t^2 (b x a))
            vertex = -cross(c, a) / (2 * cross(b, a))
            middle = -dot(along, b) / (3 * dot(along, a))
        turning = _roots(3 * dot(along, a), dot(along, b), dot(along, c))
        t = np.stack([vertex, *turning, middle], axis=1)
        return np.where((t > 0) & (t < 1), t, np.nan)

    def _at_ends(self, t: FloatArray) -> BoolArray:
        """Tell where the whole way from t (n, k) to one of the ends is lost in rounding.

        A cubic whose velocity vanishes at t cannot come back both there and half way to the end.
        """
        ids, least = np.arange(len(self)), ROUNDING * self.sizes[:, None]
        here, low, high = (self.motion(ids, place)[0] for place in (t, t / 2, (t + 1) / 2))
        last = self.last[:, None]
        start = np.maximum(length(here), length(low)) <= least
        result: BoolArray = start | (np.maximum(length(here - last), length(high - last)) <= least)
        return result


def _roots(a: FloatArray, b: FloatArray, c: FloatArray) -> list[FloatArray]:
    """Both roots of a t^2 + 2 b t + c in the form without cancellation; nan or inf where there is none."""
    with np.errstate(divide="ignore", invalid="ignore"):
        q = -(b + np.copysign(np.sqrt(b * b - a * c), b))
        return [q / a, c / q]


@dataclass(slots=True, eq=False)
class Ellipses:
    """Arcs of ellipses.

    Attributes:
        arcs: in centre form.
    """

    arcs: Arcs

    def __len__(self) -> int:
        return len(self.arcs.turn)

    def take(self, index: NDArray[np.generic]) -> Ellipses:
        """Give those at ``index``."""
        return Ellipses(self.arcs.take(index))

    @property
    def last(self) -> ComplexArray:
        """(n,) the last point of each."""
        return self.motion(np.arange(len(self)), np.ones((len(self), 1)))[0][:, 0]

    @property
    def sizes(self) -> FloatArray:
        """(n,) the larger half axis."""
        size: FloatArray = np.maximum(*self.arcs.radii)
        return size

    @property
    def lengths(self) -> FloatArray:
        """(n,) the turn times the quadratic mean of the half axes."""
        length: FloatArray = np.abs(self.arcs.turn) * np.hypot(*self.arcs.radii) / math.sqrt(2)
        return length

    def _turned(self, ids: IntArray, t: FloatArray) -> tuple[ComplexArray, ComplexArray, FloatArray, FloatArray]:
        """The half axes turned to the start, and angle and turn from there."""
        u, v = as_complex(self.arcs.u[ids]), as_complex(self.arcs.v[ids])
        cos, sin = np.cos(self.arcs.start[ids]), np.sin(self.arcs.start[ids])
        turn = self.arcs.turn[ids, None]
        return (u * cos + v * sin)[:, None], (v * cos - u * sin)[:, None], turn * t, turn

    def places(self, ids: IntArray, t: FloatArray) -> ComplexArray:
        """Points."""
        return self.motion(ids, t)[0]

    def motion(self, ids: IntArray, t: FloatArray) -> tuple[ComplexArray, ComplexArray]:
        """Points p (cos a - 1) + q sin a with conjugate half axes p (to the start) and q, and first derivatives."""
        p, q, angle, turn = self._turned(ids, t)
        cos, sin = np.cos(angle), np.sin(angle)
        return q * sin - p * (2 * np.sin(angle / 2) ** 2), (q * cos - p * sin) * turn

    def moved(self, ids: IntArray, origin: ComplexArray, along: ComplexArray) -> Moved:
        """Give arcs in axes of their own."""
        p, q, _, turn = self._turned(ids, np.zeros((len(ids), 1)))
        start, p, q = (turned_back(z, along) for z in (-origin, p[:, 0], q[:, 0]))
        return MovedEllipses(start, p, q, turn[:, 0])

    def accelerations(self, ids: IntArray, t: FloatArray) -> ComplexArray:
        """Second derivatives."""
        p, q, angle, turn = self._turned(ids, t)
        return (q * np.sin(angle) + p * np.cos(angle)) * -(turn**2)

    def end_tangents(self) -> tuple[ComplexArray, ComplexArray]:
        """Directions at the ends."""
        ends = np.broadcast_to(np.array([0.0, 1.0]), (len(self), 2))
        directions = unit(self.motion(np.arange(len(self)), ends)[1])
        return directions[:, 0], directions[:, 1]

    def cusps(self) -> Cusps:
        """The tips of an ellipse that is as thin as a line."""
        long, short = self.arcs.radii
        flat, upright = short <= _FLAT * long, long <= _FLAT * short
        which, ts = [], []
        for row in np.flatnonzero(flat | upright).tolist():
            start, turn = float(self.arcs.start[row]), float(self.arcs.turn[row])
            if turn == 0:
                continue
            tip = 0.0 if flat[row] else math.pi / 2
            low, high = sorted((start, start + turn))
            tips = tip + math.pi * np.arange(math.ceil((low - tip) / math.pi), math.floor((high - tip) / math.pi) + 1)
            t = np.sort((tips - start) / turn)
            t = t[(t > 1e-9) & (t < 1 - 1e-9)]
            which += [row] * len(t)
            ts += t.tolist()
        ids, at = np.array(which, dtype=np.int64), np.array(ts)
        back = unit(self.accelerations(ids, at[:, None])[:, 0])
        return Cusps(ids, at, -back, back)
