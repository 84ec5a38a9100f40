"""How a ball moves with linear drag, dv/dt = g - k v, with any number of digits: in flight and along a guide.

With E = e^(-k t), f = (1 - E) / k and s = (t - f) / k a flight is p + v f + g s, and v E + g f its velocity; so is a
straight guide, with what pulls the ball along in place of g. Along a circle of radius rho, with the angle phi from e
towards t, the angular speed W and b = 1 outside, -1 inside (see ``contact_motions``),

    W' = (g.t cos - g.e sin) / rho + mu b (g.e cos + g.t sin) / rho + mu b W^2 - k W,

which has no closed form. Its Taylor series in time is summed: C' = -S W and S' = C W for cosine and sine make each
coefficient a sum of products of those before. A piece is as long as its last terms are below the digits asked for.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, NamedTuple

from wallkit.accuracy.contact_guides import Guide
from wallkit.accuracy.contact_motions import OnCircle, OnLine, Smooth, root
from wallkit.accuracy.reference import Real, Vector, _dot

PIECE = 0.25
"""Of the time in which a speed, or what pulls the ball, changes by its own size: a piece is no longer."""
LOOKS = 16
"""Parts of a piece in which the sign of what may fall through zero is asked: far more often than it can change."""


def eased(mp: Any, drag: Real, time: Real) -> tuple[Real, Real, Real]:
    """Give E, f and s: s by its series t^2 (1/2 - x/6 + x^2/24 - ...) where x = k t is small, for t - f cancels."""
    x = drag * time
    left, free = mp.exp(-x), -mp.expm1(-x) / drag
    if x > 1:
        return left, free, (time - free) / drag
    term = total = mp.mpf(1) / 2
    n = 3
    while abs(term) > mp.eps * total:
        term *= -x / n
        total, n = total + term, n + 1
    return left, free, time * time * total


@dataclass(frozen=True, slots=True)
class Sliding:
    """A ball on a straight guide, with the constant ``pull`` along it and drag; see ``contact_motions.Smooth``."""

    mp: Any
    guide: Guide
    square: Real
    pull: Real
    drag: Real

    def _at(self, time: Real) -> tuple[Real, Real]:
        """Way and speed after a time."""
        left, free, second = eased(self.mp, self.drag, time)
        speed = self.mp.sqrt(self.square)
        return speed * free + self.pull * second, speed * left + self.pull * free

    def _turns(self) -> Real:
        """When it stands still: v E + P f = 0."""
        if self.pull >= 0:
            return self.mp.inf
        return self.mp.log1p(-self.drag * self.mp.sqrt(self.square) / self.pull) / self.drag

    def events(self, least: Real) -> Iterator[tuple[Real, str]]:
        """See ``Smooth``; nothing on a line changes what presses it."""
        if self.pull < 0:
            yield max(self._at(self._turns())[0], least), "turn"

    def square_at(self, way: Real) -> Real:
        """See ``Smooth``."""
        time = self._when(way)
        return self._at(time)[1] ** 2 if time < self.mp.inf else self.mp.mpf(0)

    def time_to(self, way: Real, then: Real) -> Real:
        """See ``Smooth``."""
        return self._turns() if then == 0 and self.pull < 0 else self._when(way)

    def _when(self, way: Real) -> Real:
        """When it has come by a way; infinite where it never does."""
        mp, last = self.mp, self._turns()
        high = last
        if last == mp.inf:
            if self.pull == 0 and way * self.drag >= mp.sqrt(self.square):
                return mp.inf
            high = mp.mpf(1)
            while self._at(high)[0] < way:
                high *= 2
        if way <= 0:
            return mp.mpf(0)
        if self._at(high)[0] < way:
            return mp.inf

        def late(time: Real) -> tuple[Real, Real]:
            come, speed = self._at(time)
            return come - way, speed

        return root(mp, late, mp.mpf(0), high, high / 2, 64 * mp.eps, rises=True)

    def after(self, time: Real, _most: Real) -> tuple[Vector, Vector]:
        """See ``Smooth``."""
        way, speed = self._at(time)
        place, (x, y) = self.guide.at(self.mp, way)
        return place, (speed * x, speed * y)


class _Piece(NamedTuple):
    """The angle, angular speed and pressing as series in the time since a moment, good for so long."""

    begin: Real
    span: Real
    angle: list[Real]
    speed: list[Real]
    press: list[Real]


class Swinging:
    """A ball on a circle with drag, and rolling friction mu or 0, for at most a time; see ``contact_motions.Smooth``.

    The pieces end where it turns, where nothing presses it any longer, after a whole turn, or after that time.
    """

    def __init__(self, mp: Any, guide: Guide, gravity: Vector, square: Real, mu: Real, drag: Real, most: Real) -> None:
        self.mp, self.guide, self.mu, self.drag = mp, guide, mu, drag
        self.pull = _dot(gravity, guide.out), _dot(gravity, guide.ahead)
        self.terms = int(1.2 * mp.dps) + 8
        self.ended: tuple[Real, Real, str] | None = None  # time, angle, what happens then
        self.pieces: list[_Piece] = []
        angle, speed, now = mp.mpf(0), mp.sqrt(square) / guide.barrier.reach, mp.mpf(0)
        while self.ended is None and now < most and angle < 2 * mp.pi:
            piece = self._piece(now, angle, speed)
            self.pieces.append(piece)
            self._look(piece)
            now, angle, speed = now + piece.span, _at(piece.angle, piece.span), _at(piece.speed, piece.span)

    def _piece(self, now: Real, angle: Real, speed: Real) -> _Piece:
        mp, rho, bend = self.mp, self.guide.barrier.reach, self.guide.barrier.bend
        (ge, gt), mu = self.pull, self.mu * bend
        a, w, c, s = [angle], [speed], [mp.cos(angle)], [mp.sin(angle)]
        cosine, sine = (gt + mu * ge) / rho, (mu * gt - ge) / rho
        squares = []
        for n in range(self.terms):
            squares.append(_product(w, w, n))
            faster = cosine * c[n] + sine * s[n] + mu * squares[n] - self.drag * w[n]
            a.append(w[n] / (n + 1))
            c.append(-_product(s, w, n) / (n + 1))
            s.append(_product(c, w, n) / (n + 1))
            w.append(faster / (n + 1))
        press = [-bend * (ge * c[n] + gt * s[n] + rho * squares[n]) for n in range(self.terms)]
        rate = speed + mp.sqrt((abs(ge) + abs(gt)) / rho) + self.drag
        span = PIECE / rate
        for series in (w[: self.terms], [coefficient / rate for coefficient in press]):
            for n in (self.terms - 1, self.terms - 2):
                if series[n] != 0:
                    span = min(span, (mp.eps * rate / abs(series[n])) ** (mp.mpf(1) / n))
        return _Piece(now, span, a, w[: self.terms], press)

    def _look(self, piece: _Piece) -> None:
        """Note the first of a turn and a lift in a piece: the speed, or what presses it, falls through zero."""
        mp = self.mp
        for name, series in (("turn", piece.speed), ("lift", piece.press)):
            slope = [n * c for n, c in enumerate(series)][1:]

            def value(t: Real, series: list[Real] = series, slope: list[Real] = slope) -> tuple[Real, Real]:
                return _at(series, t), _at(slope, t)

            for part in range(LOOKS):
                low, high = piece.span * part / LOOKS, piece.span * (part + 1) / LOOKS
                if not (_at(series, low) >= 0 > _at(series, high)) or (part == 0 and piece.begin == 0 == series[0]):
                    continue
                time = root(mp, value, low, high, (low + high) / 2, 64 * mp.eps, rises=False)
                if self.ended is None or piece.begin + time < self.ended[0]:
                    self.ended = piece.begin + time, _at(piece.angle, time), name
                break

    def events(self, least: Real) -> Iterator[tuple[Real, str]]:
        """See ``Smooth``."""
        if self.ended is not None and self.ended[1] >= least:
            yield self.ended[1], self.ended[2]

    def square_at(self, way: Real) -> Real:
        """See ``Smooth``."""
        time = self._when(way)
        return self._at(time)[1] ** 2 if time < self.mp.inf else self.mp.mpf(0)

    def time_to(self, way: Real, then: Real) -> Real:
        """See ``Smooth``."""
        return self.ended[0] if self.ended is not None and way == self.ended[1] else self._when(way)

    def _when(self, way: Real) -> Real:
        """When it has come by an angle; infinite where that is beyond the last piece."""
        for piece in self.pieces:
            if _at(piece.angle, piece.span) >= way:

                def late(t: Real, piece: _Piece = piece) -> tuple[Real, Real]:
                    return _at(piece.angle, t) - way, _at(piece.speed, t)

                mp = self.mp
                return piece.begin + root(mp, late, mp.mpf(0), piece.span, piece.span / 2, 64 * mp.eps, rises=True)
        return self.mp.inf

    def _at(self, time: Real) -> tuple[Real, Real]:
        """Angle and speed after a time."""
        piece = next((piece for piece in self.pieces if time <= piece.begin + piece.span), self.pieces[-1])
        since = time - piece.begin
        return _at(piece.angle, since), self.guide.barrier.reach * _at(piece.speed, since)

    def after(self, time: Real, _most: Real) -> tuple[Vector, Vector]:
        """See ``Smooth``."""
        way, speed = self._at(time)
        place, (x, y) = self.guide.at(self.mp, way)
        return place, (speed * x, speed * y)


Motion = Smooth | OnLine | OnCircle | Sliding | Swinging


def motion(
    mp: Any, guide: Guide, gravity: Vector, square: Real, mu: Real | None, drag: Real | None, most: Real
) -> Motion:
    """How a ball goes on along a guide for at most a time, mu its coefficient of rolling friction or None."""
    straight = guide.barrier.bend == 0
    if drag is None:
        if mu is None:
            return Smooth(mp, guide, gravity, square)
        return (OnLine if straight else OnCircle)(mp, guide, gravity, square, mu)
    if not straight:
        return Swinging(mp, guide, gravity, square, mu or mp.mpf(0), drag, most)
    pull = _dot(gravity, guide.ahead) + (mu or 0) * _dot(gravity, guide.barrier.normal)
    return Sliding(mp, guide, square, pull, drag)


def _product(one: list[Real], other: list[Real], n: int) -> Real:
    """The n-th coefficient of the product of two series."""
    return sum((one[k] * other[n - k] for k in range(n + 1)), 0 * one[0])


def _at(series: list[Real], time: Real) -> Real:
    """The sum of a series by Horner's scheme."""
    total = series[-1]
    for c in reversed(series[:-1]):
        total = total * time + c
    return total
