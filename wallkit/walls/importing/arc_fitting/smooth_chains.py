"""Chains: curves strung together where one runs on smoothly into the next, so that arcs may pass over the joints.

A chain is one curve over a parameter u from 0 to its length. Within each of its curves u is even in that curve's
own parameter t, and a curve has a share of u that is about its length, so that points that are evenly spread over u
are so over the chain. A point is relative to the first point of its chain.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from wallkit.geometry.arrays import FloatArray, IntArray, distinct
from wallkit.walls.importing.arc_fitting.curves import ComplexArray, Curves, as_complex, cross, dot, unit
from wallkit.walls.importing.arc_fitting.machine_code import chain_points
from wallkit.walls.importing.segments import Segments

# Curves whose directions differ by less (radians) were drawn as one smooth line and lost the rest when coordinates
# were rounded to a few decimals: real drawings have many joints up to 2e-3, few from there to 0.05.
_SMOOTH = 3e-3


@dataclass(slots=True, eq=False, repr=False)
class Sections:
    """Parts of spans that lie in one curve each, arrays of one length, span by span.

    Attributes:
        rows: the span of each, rising.
        curves: the curve of each.
        low: the curve's own parameter at the start.
        high: the same at the end.
        begins: the section is the first of its span.
        ends: it is the last.
    """

    rows: IntArray
    curves: IntArray
    low: FloatArray
    high: FloatArray
    begins: NDArray[np.bool_]
    ends: NDArray[np.bool_]

    def __len__(self) -> int:
        return len(self.rows)


@dataclass(slots=True, eq=False, repr=False)
class Chains:
    """Many chains of curves of one kind.

    Attributes:
        curves: all curves, chain by chain.
        offsets: (c + 1,) chain c has the curves ``offsets[c]`` to ``offsets[c + 1]``.
        shifts: (n,) first point of each curve, relative to that of its chain.
        starts: (n,) u where each curve starts.
        stops: (n,) u where it stops, the next one's start bit for bit.
        headings: (n,) direction at the first point of each curve; 0 for one that is a point.
        leavings: (n,) direction at the last point.
        machine_code: the fit of these curves, cubics, is for compiled kernels.
    """

    curves: Curves
    offsets: IntArray
    shifts: ComplexArray
    starts: FloatArray
    stops: FloatArray
    headings: ComplexArray
    leavings: ComplexArray
    machine_code: bool = False

    @classmethod
    def of(
        cls,
        curves: Curves,
        tangents: tuple[ComplexArray, ComplexArray],
        origins: ComplexArray,
        joined: NDArray[np.bool_],
        machine_code: bool = False,
    ) -> Chains:
        """String curves together.

        Args:
            curves: the curves.
            tangents: their ``end_tangents``.
            origins: (n,) first point of each.
            joined: (n,) the curve goes on with the chain of the one before it.
            machine_code: the curves are cubics, and compiled kernels are at hand.
        """
        n = len(curves)
        first = np.flatnonzero(~joined)
        offsets = np.append(first, n)
        chain = np.cumsum(~joined) - 1
        # a chain of one curve has the curve's own parameter
        share = np.where(np.diff(offsets)[chain] > 1, curves.lengths, 1.0)
        stops = _running_sums(np.where(share > 0, share, 1.0), offsets)
        starts = np.where(joined, np.roll(stops, 1), 0.0)
        shifts = origins - origins[first][chain]
        return cls(curves, offsets, shifts, starts, stops, *tangents, machine_code)

    def __len__(self) -> int:
        return len(self.offsets) - 1

    @property
    def lengths(self) -> FloatArray:
        """(c,) u at the end of each chain."""
        return self.stops[self.offsets[1:] - 1]

    @property
    def sizes(self) -> FloatArray:
        """(c,) about the extent of each, at most too large, to judge rounding by."""
        size: FloatArray = np.add.reduceat(self.curves.sizes, self.offsets[:-1])
        return size

    def at(self, ids: IntArray, u: FloatArray) -> tuple[ComplexArray, ComplexArray]:
        """Points and directions of chains ``ids`` at ``u``; at a joint the direction is that of the later curve."""
        if self.machine_code:
            return chain_points(self, ids, u)
        curve = self._curve_at(ids, u)
        t = self._own(curve, u)
        place, velocity = self.curves.motion(curve, t[:, None])
        direction = np.where(t == 0, self.headings[curve], unit(velocity[:, 0]))
        return self.shifts[curve] + place[:, 0], direction

    def places_from(
        self, ids: IntArray, u: FloatArray, origin: ComplexArray, along: ComplexArray
    ) -> tuple[FloatArray, FloatArray]:
        """Points of chains ``ids`` (n,) at ``u``, rising in each column, in axes of their own: x and y, (k, n) each."""
        first, last = self._curve_at(ids, u[0]), self._curve_at(ids, u[-1])
        x, y = self._places(first, u, origin, along)
        across = np.flatnonzero(first != last)
        if len(across):
            again = np.tile(across, len(u))
            flat = u[:, across].reshape(1, -1)
            parts = self._places(self._curve_at(ids[again], flat[0]), flat, origin[again], along[again])
            x[:, across], y[:, across] = (part.reshape(len(u), -1) for part in parts)
        return x, y

    def _places(
        self, curve: IntArray, u: FloatArray, origin: ComplexArray, along: ComplexArray
    ) -> tuple[FloatArray, FloatArray]:
        """Points of curves (n,) at their chain's u (k, n)."""
        start = self.starts[curve]
        moved = self.curves.moved(curve, origin - self.shifts[curve], along)
        return moved.places((u - start) / (self.stops[curve] - start))

    def before(self, ids: IntArray, u: FloatArray) -> ComplexArray:
        """Directions of chains ``ids`` at ``u``; at a joint that of the earlier curve."""
        curve = self._curve_at(ids, u)
        joint = (self.starts[curve] == u) & (curve > self.offsets[ids])
        return np.where(joint, self.leavings[curve - 1], self.at(ids, u)[1])

    def sections(self, ids: IntArray, low: FloatArray, high: FloatArray) -> Sections:
        """Cut the spans from ``low`` to ``high`` of chains ``ids`` at the joints."""
        first, last = self._curve_at(ids, low), self._curve_at(ids, high)
        last -= (last > first) & (self.starts[last] == high)
        counts = last - first + 1
        rows = np.repeat(np.arange(len(ids)), counts)
        curve = first[rows] + np.arange(len(rows)) - np.repeat(np.cumsum(counts) - counts, counts)
        start = self._own(curve, np.maximum(low[rows], self.starts[curve]))
        stop = self._own(curve, np.minimum(high[rows], self.stops[curve]))
        return Sections(rows, curve, start, stop, curve == first[rows], curve == last[rows])

    def _own(self, curve: IntArray, u: FloatArray) -> FloatArray:
        """The parameter t of curves at u."""
        start = self.starts[curve]
        t: FloatArray = (u - start) / (self.stops[curve] - start)
        return t

    def _curve_at(self, ids: IntArray, u: FloatArray) -> IntArray:
        """The last curve of each chain that starts at u or before, by bisection."""
        first = self.offsets[ids]
        rows = np.flatnonzero(self.offsets[ids + 1] - first > 1)  # most chains are of one curve
        low, high, u = first[rows], self.offsets[ids[rows] + 1] - 1, u[rows]
        while (low < high).any():
            middle = (low + high + 1) // 2
            there = self.starts[middle] <= u
            low, high = np.where(there, middle, low), np.where(there, high, middle - 1)
        first[rows] = low
        return first


def runs_on(tangents: tuple[ComplexArray, ComplexArray], segments: Segments, at: IntArray) -> NDArray[np.bool_]:
    """Tell which curves go on smoothly from the one before, in the same subpath, with nothing else at the joint.

    Args:
        tangents: of the curves at their ends.
        segments: all subpaths.
        at: (n,) the segment of each curve, rising.
    """
    first, last = tangents
    subpath = np.searchsorted(segments.offsets, at, side="right")
    joined = np.zeros(len(at), dtype=np.bool_)
    joined[1:] = (np.diff(at) == 1) & (np.diff(subpath) == 0)
    joined[1:] &= (dot(last[:-1], first[1:]) > 0) & (np.abs(cross(last[:-1], first[1:])) <= _SMOOTH)
    rows = np.flatnonzero(joined)
    if len(rows):
        joints = as_complex(segments.begins[at[rows]])
        points = np.sort(as_complex(np.concatenate([segments.starts, segments.ends])))
        count = np.searchsorted(points, joints, side="right") - np.searchsorted(points, joints)
        joined[rows] = count == 1
    return joined


def _running_sums(values: FloatArray, offsets: IntArray) -> FloatArray:
    """Sums from the start of each group; each group's are the same whatever stands before it.

    Groups of the same size are summed together: of n values there are at most sqrt(2 n) sizes.
    """
    sums = values.copy()
    counts = np.diff(offsets)
    for size in distinct(counts[counts > 1]).tolist():
        rows = offsets[:-1][counts == size][:, None] + np.arange(size)
        sums[rows] = np.cumsum(values[rows], axis=1)
    return sums
