"""Curves in one form for fitting: points, velocities and accelerations of many curves, as complex numbers.

A point (x, y) is x + i y, relative to its curve's first point, so that a drawing far from the origin costs no
digits. With conj(a) b = a . b + i (a x b), the dot and cross products of plane geometry are one multiplication.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from wallkit.geometry.arrays import FloatArray, IntArray
from wallkit.walls.importing.segments import Arcs

ComplexArray = NDArray[np.complex128]

# A speed below this part of the curve's largest counts as a cusp. The tip that is cut off there is as small as
# the square of it, 1e-16 of the curve: below the rounding of its coordinates.
_CUSP = 1e-8


class Curves(Protocol):
    """Many curves of one kind, each over t from 0 to 1."""

    def __len__(self) -> int: ...

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

    def motion(self, ids: IntArray, t: FloatArray) -> tuple[ComplexArray, ComplexArray]:
        """Points and velocities (first derivatives by t) of curves ``ids`` (n,) at ``t`` (n, k): (n, k) each."""
        ...

    def accelerations(self, ids: IntArray, t: FloatArray) -> ComplexArray:
        """Second derivatives by t: (n, k)."""
        ...

    def end_tangents(self) -> tuple[ComplexArray, ComplexArray]:
        """(n,) directions at the two ends, of length one; 0 for a curve that is a point."""
        ...

    def cusps(self) -> tuple[IntArray, FloatArray]:
        """Where the direction turns back on the spot, inside: curve and t of each, in rising order."""
        ...


def unit(z: ComplexArray) -> ComplexArray:
    """Give numbers of length one; 0 stays 0."""
    size = np.abs(z)
    result: ComplexArray = np.divide(z, size, out=np.zeros_like(z), where=size > 0)
    return result


def dot(a: ComplexArray, b: ComplexArray) -> FloatArray:
    """Scalar product of plane vectors."""
    result: FloatArray = a.real * b.real + a.imag * b.imag
    return result


def cross(a: ComplexArray, b: ComplexArray) -> FloatArray:
    """Positive where b is left of a."""
    result: FloatArray = a.real * b.imag - a.imag * b.real
    return result


def as_complex(points: FloatArray) -> ComplexArray:
    """From (..., 2) to (...)."""
    result: ComplexArray = points[..., 0] + 1j * points[..., 1]
    return result


@dataclass(slots=True)
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

    @property
    def last(self) -> ComplexArray:
        """(n,) the last point of each."""
        return self.control[:, 3]

    @property
    def sizes(self) -> FloatArray:
        """(n,) the largest distance of a control point from the first."""
        size: FloatArray = np.abs(self.control).max(axis=1)
        return size

    @property
    def lengths(self) -> FloatArray:
        """(n,) the mean of chord and control polygon."""
        length: FloatArray = (np.abs(np.diff(self.control, axis=1)).sum(axis=1) + np.abs(self.last)) / 2
        return length

    def _powers(self, ids: IntArray) -> tuple[ComplexArray, ComplexArray, ComplexArray]:
        p = self.control[ids]
        c = 3 * p[:, 1:2]
        b = 3 * (p[:, 2:3] - 2 * p[:, 1:2])
        return p[:, 3:4] - c - b, b, c

    def motion(self, ids: IntArray, t: FloatArray) -> tuple[ComplexArray, ComplexArray]:
        """Points and first derivatives.

        The derivatives by Bernstein's form, which gives the right direction near an end whose arm has no length.
        """
        a, b, c = self._powers(ids)
        s, d = 1 - t, 3 * np.diff(self.control[ids], axis=1)
        velocity = (d[:, 0:1] * s + d[:, 1:2] * (2 * t)) * s + d[:, 2:3] * (t * t)
        return ((a * t + b) * t + c) * t, velocity

    def accelerations(self, ids: IntArray, t: FloatArray) -> ComplexArray:
        """Second derivatives."""
        a, b, _ = self._powers(ids)
        return 6 * a * t + 2 * b

    def end_tangents(self) -> tuple[ComplexArray, ComplexArray]:
        """Direction to the next control point that is somewhere else."""
        p = self.control
        first, last = np.zeros(len(p), dtype=np.complex128), np.zeros(len(p), dtype=np.complex128)
        for near, far in ((1, 2), (2, 1), (3, 0)):
            first = np.where(first == 0, unit(p[:, near] - p[:, 0]), first)
            last = np.where(last == 0, unit(p[:, 3] - p[:, far]), last)
        return first, last

    def cusps(self) -> tuple[IntArray, FloatArray]:
        """Where the velocity vanishes.

        The candidates: the vertex of the quadratic (velocity x acceleration), which has a double root at a cusp;
        and for a curve on a straight line the turning points along it.
        """
        if not len(self):
            return np.empty(0, dtype=np.int64), np.empty(0)
        ids = np.arange(len(self))
        a, b, c = (part[:, 0] for part in self._powers(ids))
        with np.errstate(divide="ignore", invalid="ignore"):
            # velocity x acceleration = 2 (c x b + 3 t (c x a) + 3 t^2 (b x a))
            found = [-cross(c, a) / (2 * cross(b, a))]
        spokes = self.control[:, 1:]
        longest = np.abs(spokes).argmax(axis=1)
        along = unit(spokes[ids, longest])
        found += _roots(3 * dot(along, a), dot(along, b), dot(along, c))
        t = np.stack(found, axis=1)
        # nearer to an end it is that end's: a curve that stands still there has double roots, known to 1e-8
        t = np.where((t > 1e-6) & (t < 1 - 1e-6), t, np.nan)
        size = np.abs(np.diff(self.control, axis=1)).max(axis=1, keepdims=True) * 3
        with np.errstate(invalid="ignore"):
            still = np.abs(self.motion(ids, t)[1]) <= _CUSP * size
        t = np.sort(np.where(still, t, np.nan), axis=1)  # nan goes last
        with np.errstate(invalid="ignore"):
            t[:, 1:][np.diff(t, axis=1) < 1e-7] = np.nan  # the same cusp found twice
        which, column = np.nonzero(~np.isnan(t))
        return which, t[which, column]


def _roots(a: FloatArray, b: FloatArray, c: FloatArray) -> list[FloatArray]:
    """Both roots of a t^2 + 2 b t + c in the form without cancellation; nan or inf where there is none."""
    with np.errstate(divide="ignore", invalid="ignore"):
        q = -(b + np.copysign(np.sqrt(b * b - a * c), b))
        return [q / a, c / q]


@dataclass(slots=True)
class Ellipses:
    """Arcs of ellipses.

    Attributes:
        arcs: in centre form.
    """

    arcs: Arcs

    def __len__(self) -> int:
        return len(self.arcs.turn)

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

    def motion(self, ids: IntArray, t: FloatArray) -> tuple[ComplexArray, ComplexArray]:
        """Points p (cos a - 1) + q sin a with conjugate half axes p (to the start) and q, and first derivatives."""
        p, q, angle, turn = self._turned(ids, t)
        cos, sin = np.cos(angle), np.sin(angle)
        return q * sin - p * (2 * np.sin(angle / 2) ** 2), (q * cos - p * sin) * turn

    def accelerations(self, ids: IntArray, t: FloatArray) -> ComplexArray:
        """Second derivatives."""
        p, q, angle, turn = self._turned(ids, t)
        return (q * np.sin(angle) + p * np.cos(angle)) * -(turn**2)

    def end_tangents(self) -> tuple[ComplexArray, ComplexArray]:
        """Directions at the ends."""
        ends = np.broadcast_to(np.array([0.0, 1.0]), (len(self), 2))
        directions = unit(self.motion(np.arange(len(self)), ends)[1])
        return directions[:, 0], directions[:, 1]

    def cusps(self) -> tuple[IntArray, FloatArray]:
        """The tips of an ellipse that is as thin as a line."""
        long, short = self.arcs.radii
        flat, upright = short <= _CUSP * long, long <= _CUSP * short
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
        return np.array(which, dtype=np.int64), np.array(ts)
