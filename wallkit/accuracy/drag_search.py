"""What a falling ball with drag meets first, for the reference of contact states.

Its gap to a barrier is no polynomial, so roots are sought by bounds: in a stretch of time of the half length h about m

    |F(t) - F(m)| <= |F'(m)| h + M h^2 / 2,    |F'(t) - F'(m)| <= M h,

where M bounds |F''| there. A stretch that can hold no root is left out, one in which F' keeps its sign holds one where
the signs at its ends differ, and others are halved. |a| falls with time, so |v| and the way are bounded from m on.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from wallkit.accuracy.contact_drag import eased
from wallkit.accuracy.contact_guides import Barrier, minus
from wallkit.accuracy.contact_motions import root
from wallkit.accuracy.contact_search import Search
from wallkit.accuracy.reference import Real, Vector, _dot


class _Flight(NamedTuple):
    """A flight from a place with a velocity under gravity and drag."""

    mp: Any
    place: Vector
    velocity: Vector
    gravity: Vector
    drag: Real

    def at(self, time: Real) -> tuple[Vector, Vector]:
        left, free, second = eased(self.mp, self.drag, time)
        (x, y), (u, v), (gx, gy) = self.place, self.velocity, self.gravity
        return (x + u * free + gx * second, y + v * free + gy * second), (u * left + gx * free, v * left + gy * free)

    def pulled(self, velocity: Vector) -> Vector:
        return self.gravity[0] - self.drag * velocity[0], self.gravity[1] - self.drag * velocity[1]


class _Gap(NamedTuple):
    """The gap of a flight to a barrier, less what is rounding of its first terms where the ball touches that."""

    flight: _Flight
    barrier: Barrier
    less: tuple[Real, Real, Real]

    def at(self, time: Real) -> tuple[Real, Real]:
        """F and F'."""
        return self._of(*self.flight.at(time), time)

    def _of(self, place: Vector, velocity: Vector, time: Real) -> tuple[Real, Real]:
        none, one, two = self.less
        value = self.barrier.gap(place) - none - time * (one + time * two / 2)
        return value, self.barrier.rate(place, velocity) - one - time * two

    def bound(self, middle: Real, half: Real) -> tuple[Real, Real, Real]:
        """F and F' at the middle of a stretch, and M."""
        mp, (place, velocity) = self.flight.mp, self.flight.at(middle)
        value, slope = self._of(place, velocity, middle)
        pull = mp.sqrt(_dot(a := self.flight.pulled(self.flight.at(middle - half)[1]), a))
        two = abs(self.less[2])
        if self.barrier.bend == 0:
            return value, slope, pull + two
        speed = mp.sqrt(_dot(velocity, velocity)) + pull * half
        w = minus(place, self.barrier.anchor)
        return value, slope, 2 * (speed * speed + (mp.sqrt(_dot(w, w)) + speed * half) * pull) + two

    def falls(self, low: Real, high: Real, least: Real) -> Iterator[Real]:
        """Times at which F falls through zero, in order."""
        middle, half = (low + high) / 2, (high - low) / 2
        value, slope, bend = self.bound(middle, half)
        if half <= 0 or abs(value) > abs(slope) * half + bend * half * half / 2:
            return
        if abs(slope) > bend * half:
            if slope < 0 and self.at(low)[0] > 0 >= self.at(high)[0]:
                yield root(self.flight.mp, self.at, low, high, middle, 64 * self.flight.mp.eps, rises=False)
            return
        if half > least:  # else it touches without a sign
            yield from self.falls(low, middle, least)
            yield from self.falls(middle, high, least)


class DragSearch(Search):
    """See ``Search``; gravity and drag act."""

    def __init__(self, *parts: Any, drag: Real) -> None:
        super().__init__(*parts)
        self.drag = drag

    def first(
        self, position: Vector, velocity: Vector, touching: dict[int, Barrier], span: Real
    ) -> tuple[Real, Barrier] | None:
        """Time of the first contact within a time, and with what."""
        mp = self.mp
        flight = _Flight(mp, position, velocity, self.gravity, self.drag)
        begin, end = mp.mpf(0), min(mp.mpf(self.guess), span)
        while True:
            best: tuple[Real, Barrier] | None = None
            for number in self._near(flight, begin, end).tolist():
                barrier = self.barriers[number]
                for time in self._falls(flight, barrier, touching, begin, end):
                    if (best is None or time < best[0]) and self.on_section(barrier, flight.at(time)[0]):
                        best = time, barrier
                        break
            if best is not None:
                self.guess = max(2.0 * float(best[0]), 1e-12)
                return best
            if end >= span:
                return None
            begin, end = end, min(2 * end + mp.mpf(10) ** -9, span)

    def _near(self, flight: _Flight, begin: Real, end: Real) -> NDArray[np.int64]:
        """Barriers whose box meets that of the flight between two times: |a| t^2 / 8 off its chord at most."""
        (one, then), (other, _) = flight.at(begin), flight.at(end)
        a = flight.pulled(then)
        sag = float(self.mp.sqrt(_dot(a, a)) * (end - begin) ** 2 / 8)
        p, q = np.array([float(c) for c in one]), np.array([float(c) for c in other])
        low, high = np.minimum(p, q) - sag, np.maximum(p, q) + sag
        return np.flatnonzero(((self.low <= high) & (self.high >= low)).all(axis=1))

    def _falls(
        self, flight: _Flight, barrier: Barrier, touching: dict[int, Barrier], begin: Real, end: Real
    ) -> Iterator[Real]:
        """Times between two at which the gap falls through zero; of a touched barrier after it has left that."""
        terms, kept = self._terms(flight, barrier), [self.mp.mpf(0)] * 3
        if self._touched(barrier, touching):
            kept = self._rounding(flight, barrier, terms)
            order = next((n for n in (1, 2) if terms[n] != kept[n]), 3)
            lead = abs(terms[order])
            if lead == 0 or (order == 3 and barrier.bend == 0):
                return  # along a wall that is as straight as its way
            begin = max(begin, self._leads(flight, barrier, order, lead))
        elif begin == 0 and terms[1] < 0 and abs(terms[0]) <= self.same * self._scale(barrier):
            yield self.mp.mpf(0)
        gap = _Gap(flight, barrier, (kept[0], kept[1], kept[2]))
        yield from gap.falls(begin, end, self.same / 1000)

    def _scale(self, barrier: Barrier) -> Real:
        return 2 * barrier.reach if barrier.bend else self.mp.mpf(1)

    def _terms(self, flight: _Flight, barrier: Barrier) -> list[Real]:
        """F, F', F'' and F''' at the start."""
        out, k, v, a = barrier.bend, flight.drag, flight.velocity, flight.pulled(flight.velocity)
        value, rate = barrier.gap(flight.place), barrier.rate(flight.place, v)
        if out == 0:
            second = _dot(a, barrier.normal)
            return [value, rate, second, -k * second]
        w = minus(flight.place, barrier.anchor)
        return [value, rate, 2 * out * (_dot(v, v) + _dot(w, a)), 2 * out * (3 * _dot(v, a) - k * _dot(w, a))]

    def _leads(self, flight: _Flight, barrier: Barrier, order: int, lead: Real) -> Real:
        """Up to when the first term, lead t^n / n!, is surely more than all after it, M t^(n + 1) / (n + 1)!: lead / M.

        M bounds the next derivative for a second, in which |a| falls, |v| grows by |a| and the way by |v|.
        """
        mp, k, w = self.mp, flight.drag, minus(flight.place, barrier.anchor)
        pull = mp.sqrt(_dot(a := flight.pulled(flight.velocity), a))
        if barrier.bend == 0:
            most = pull * k ** (order - 1)
        else:
            speed = mp.sqrt(_dot(flight.velocity, flight.velocity)) + pull
            far = mp.sqrt(_dot(w, w)) + speed
            second, third = speed**2 + far * pull, (3 * speed + k * far) * pull
            fourth = (3 * pull + 4 * k * speed + k * k * far) * pull
            most = 2 * (second, third, fourth)[order - 1]
        return min(lead / most, mp.mpf(1)) if most > 0 else mp.mpf(1)

    def _rounding(self, flight: _Flight, barrier: Barrier, terms: list[Real]) -> list[Real]:
        """What of F, F' and F'' at the start is rounding where the ball touches the barrier: see ``Search._gap``."""
        mp, g = self.mp, self.gravity
        square, tiny = _dot(flight.velocity, flight.velocity), self.same / self.reference.size
        pull, scale = mp.sqrt(_dot(g, g)), mp.sqrt(square) * self._scale(barrier)
        kept = [terms[0], mp.mpf(0), mp.mpf(0)]
        if abs(terms[1]) <= tiny * (scale + mp.sqrt(pull * self.reference.size)):
            kept[1] = terms[1]
            if abs(terms[2]) <= 2 * tiny * (square + pull * max(barrier.reach, 1)):
                kept[2] = terms[2]
        return kept
