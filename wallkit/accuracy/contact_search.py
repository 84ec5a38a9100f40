"""What a falling ball meets first, for the reference of contact states."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from wallkit.accuracy.contact_guides import Barrier, minus
from wallkit.accuracy.contact_joints import Joints
from wallkit.accuracy.real_roots import real_roots
from wallkit.accuracy.reference import Real, Reference, Vector, _Arc, _dot, _Line


class Search:
    """All barriers, and boxes around them in doubles: what a part of a parabola misses by far is not asked."""

    def __init__(
        self, reference: Reference, barriers: list[Barrier], joints: Joints, gravity: Vector, same: Real
    ) -> None:
        self.joints = joints
        self.reference, self.mp, self.barriers, self.gravity = reference, reference.mp, barriers, gravity
        self.same = same
        circles = np.array([self._around(barrier) for barrier in barriers]).reshape(-1, 3)
        reach = circles[:, 2:] + 1e-9 * float(reference.size)
        self.low, self.high = circles[:, :2] - reach, circles[:, :2] + reach
        self.guess = 0.05

    def _around(self, barrier: Barrier) -> tuple[float, float, float]:
        """A circle (x, y, radius) that holds a barrier's section: over its chord, if it is at most half a circle."""
        obstacle, walls = self.reference.obstacles[barrier.obstacle], self.reference.scene.walls
        x, y = barrier.anchor
        if obstacle.edge >= 0:
            edge = int(walls.edge_offsets[obstacle.wall]) + obstacle.edge
            start = walls.edge_starts[edge]
            a, b = walls.vertices[start], walls.vertices[walls.edge_ends[edge]]
            if abs(walls.bulges[start]) <= 1.0:
                half = 0.5 * float(np.hypot(*(b - a)))
                return float(a[0] + b[0]) / 2, float(a[1] + b[1]) / 2, half + float(barrier.radius)
        return float(x), float(y), float(barrier.reach)

    def first(
        self, position: Vector, velocity: Vector, touching: dict[int, Barrier], span: Real
    ) -> tuple[Real, Barrier] | None:
        """Time of the first contact within a time, and with what."""
        gaps: dict[int, tuple[list[Real], list[float]]] = {}
        asked: dict[int, list[Real]] = {}
        begin, end = 0.0, min(self.guess, float(span))
        while True:
            best: tuple[Real, Barrier] | None = None
            for number in self._candidates(position, velocity, begin, end).tolist():
                barrier = self.barriers[number]
                if number not in gaps:
                    gap = self._gap(barrier, position, velocity, touching)
                    gaps[number] = gap, [float(c) for c in gap]
                if number not in asked:
                    if keeps_its_sign(gaps[number][1], begin, end):
                        continue
                    asked[number] = self._times(barrier, gaps[number][0], position, velocity, touching)
                for time in asked[number]:
                    if best is None or time < best[0]:
                        best = time, barrier
            if best is not None and best[0] <= min(self.mp.mpf(end), span):
                self.guess = max(2.0 * float(best[0]), 1e-12)
                return best
            if end >= float(span):
                return None
            begin, end = end, min(2.0 * end + 1e-9, float(span))

    def _candidates(self, position: Vector, velocity: Vector, begin: float, end: float) -> NDArray[np.int64]:
        """Barriers whose box meets that of the parabola between two times: |g| t^2 / 8 off its chord at most."""
        p, v, g = (np.array([float(part[0]), float(part[1])]) for part in (position, velocity, self.gravity))
        one, other = (p + v * t + 0.5 * g * t * t for t in (begin, end))
        sag = float(np.hypot(*g)) * (end - begin) ** 2 / 8
        low, high = np.minimum(one, other) - sag, np.maximum(one, other) + sag
        return np.flatnonzero(((self.low <= high) & (self.high >= low)).all(axis=1))

    def _times(
        self, barrier: Barrier, gap: list[Real], position: Vector, velocity: Vector, touching: dict[int, Barrier]
    ) -> list[Real]:
        """Times at which the gap falls through zero on the section of the barrier that is there."""
        touched = self._touched(barrier, touching)
        found = []
        for time in real_roots(self.mp, gap[::-1]):
            if time < -self.same or (touched and time <= self.same):
                continue
            half = time * time / 2
            place = (
                position[0] + velocity[0] * time + self.gravity[0] * half,
                position[1] + velocity[1] * time + self.gravity[1] * half,
            )
            then = velocity[0] + self.gravity[0] * time, velocity[1] + self.gravity[1] * time
            if barrier.rate(place, then) < 0 and self.on_section(barrier, place):
                found.append(max(time, self.mp.mpf(0)))
        return found

    def _touched(self, barrier: Barrier, touching: dict[int, Barrier]) -> bool:
        """Whether it is touched; for a point the two sides of an edge are one place."""
        if barrier.radius > 0:
            return barrier.number in touching
        return any(other.obstacle == barrier.obstacle for other in touching.values())

    def _gap(self, barrier: Barrier, position: Vector, velocity: Vector, touching: dict[int, Barrier]) -> list[Real]:
        """Coefficients of the gap in time, that of 1 first; of a touched one without what is rounding."""
        g = self.gravity
        if barrier.bend == 0:
            gap = [barrier.gap(position), barrier.rate(position, velocity), _dot(g, barrier.normal) / 2]
        else:
            d, out = minus(position, barrier.anchor), barrier.bend
            gap = [
                barrier.gap(position),
                barrier.rate(position, velocity),
                out * (_dot(velocity, velocity) + _dot(d, g)),
                out * _dot(velocity, g),
                out * _dot(g, g) / 4,
            ]
        if not self._touched(barrier, touching):
            return gap
        square = _dot(velocity, velocity)
        tiny = self.same / self.reference.size
        scale = self.mp.sqrt(square) * (2 * barrier.reach if barrier.bend else 1)
        gap[0] = 0 * gap[0]
        if abs(gap[1]) <= tiny * (scale + self.mp.sqrt(self.mp.sqrt(_dot(g, g)) * self.reference.size)):
            gap[1] = 0 * gap[1]
            if abs(gap[2]) <= tiny * (square + self.mp.sqrt(_dot(g, g)) * max(barrier.reach, 1)):
                gap[2] = 0 * gap[2]
        return gap

    def on_section(self, barrier: Barrier, place: Vector, beyond: Real = 0) -> bool:
        """Tell whether a centre at the barrier is beside the edge, between its ends or a length beyond them."""
        shape: Any = self.reference.obstacles[barrier.obstacle].shape
        if isinstance(shape, _Line):
            slack = beyond * self.mp.sqrt(shape.length2)
            return bool(-slack <= _dot(minus(place, shape.start), shape.along) <= shape.length2 + slack)
        if isinstance(shape, _Arc):
            d = minus(place, shape.centre)
            return bool(_dot(d, shape.middle) >= shape.cos_half * self.mp.sqrt(_dot(d, d)) - beyond)
        return not self.reference.obstacles[barrier.obstacle].outward_only or self.joints.is_before(barrier, place)

    def near(self, place: Vector, distance: Real) -> list[Barrier]:
        """Barriers beside whose section a centre is, no farther from them than a distance."""
        found = []
        for barrier in self.barriers:
            gap = barrier.gap(place)
            if barrier.bend:
                gap /= 2 * barrier.reach
            if abs(gap) <= distance and self.on_section(barrier, place, distance):
                found.append(barrier)
        return found


def keeps_its_sign(coefficients: list[float], begin: float, end: float) -> bool:
    """Tell whether a polynomial, that of 1 first, surely has no zero between two times.

    With t = begin + u (end - begin) and the coefficients d of the powers of u it lies between the least and the
    greatest of its Bernstein coefficients, b_j = sum of C(j, k) / C(n, k) d_k. What doubles lose of these is below
    2^-40 of the sum of |c_k| (|begin| + |end|)^k, which is kept clear of.
    """
    n, span, size = len(coefficients) - 1, end - begin, 0.0
    shifted = coefficients[:]
    for low in range(n):  # Horner's scheme, again and again: the Taylor coefficients at `begin`
        for k in range(n - 1, low - 1, -1):
            shifted[k] += begin * shifted[k + 1]
    for c in reversed(coefficients):
        size = size * (begin + end) + abs(c)
    scaled = [d * span**k for k, d in enumerate(shifted)]
    bounds = [sum(math.comb(j, k) / math.comb(n, k) * scaled[k] for k in range(j + 1)) for j in range(n + 1)]
    return min(bounds) > 2.0**-40 * size or max(bounds) < -(2.0**-40) * size
