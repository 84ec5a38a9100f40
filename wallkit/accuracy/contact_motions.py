"""How a ball moves along a guide, with any number of digits: without friction, or with rolling friction.

Rolling friction takes mu N from the acceleration along the guide, N what presses the ball on it. On a line that is
another constant. On a circle of radius rho, with the angle phi from a direction e towards t, b = 1 outside and -1
inside, q = v^2 and N = -b (g.e + q / rho) there,

    dq/dphi = 2 rho (g.t + mu b g.e) + 2 mu b q,

linear in q. With l = 2 mu b, P = 2 rho (g.t + mu b g.e) and Q = 2 rho (mu b g.t - g.e) at phi = 0 its solution is

    q = (q0 - A) e^(l phi) + A cos(phi) + B sin(phi),    A = -(Q + l P) / (1 + l^2),    B = (P - l Q) / (1 + l^2),

for B - l A = P and -A - l B = Q. The time is the integral of rho / sqrt(q).
"""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

from wallkit.accuracy.contact_guides import Guide
from wallkit.accuracy.reference import Real, Vector, _dot
from wallkit.accuracy.sure_digits import PrecisionError

Round = tuple[Real, Real, Real]
"""a, b, c of a cos(phi) + b sin(phi) + c e^(l phi)."""


@dataclass(frozen=True, slots=True)
class Smooth:
    """A ball that nothing slows down, from a place on, where its squared speed is ``square``."""

    mp: Any
    guide: Guide
    gravity: Vector
    square: Real

    def events(self, least: Real) -> Iterator[tuple[Real, str]]:
        """Ways ahead, ``least`` or farther, at which it turns round, and at which nothing presses it any longer."""
        for name, wave in (
            ("turn", self.guide.squared_speed(self.gravity, self.square)),
            ("lift", self.guide.pressing(self.gravity, self.square)),
        ):
            for way in self.guide.falls(self.mp, wave, least):
                yield way, name

    def square_at(self, way: Real) -> Real:
        """Squared speed after a way."""
        a, b, c = self.guide.squared_speed(self.gravity, self.square)
        if self.guide.barrier.bend == 0:
            return a + way * (b + way * c)
        return a + b * self.mp.cos(way) + c * self.mp.sin(way)

    def time_to(self, way: Real, then: Real) -> Real:
        """Time of a way on which it does not turn, at whose end its squared speed is ``then``."""
        return self.guide.time_to(self.mp, self.gravity, self.square, way, then)

    def after(self, time: Real, _most: Real) -> tuple[Vector, Vector]:
        """Place and velocity after a time in which it does not turn."""
        return self.guide.after(self.mp, self.gravity, self.square, time)


@dataclass(frozen=True, slots=True)
class OnLine:
    """A ball that rolling friction mu slows down on a straight guide: it has the acceleration a all the time."""

    mp: Any
    guide: Guide
    gravity: Vector
    square: Real
    mu: Real

    def _pull(self) -> Real:
        return _dot(self.gravity, self.guide.ahead) + self.mu * _dot(self.gravity, self.guide.barrier.normal)

    def events(self, least: Real) -> Iterator[tuple[Real, str]]:
        """See ``Smooth``; nothing on a line changes what presses it."""
        pull = self._pull()
        if pull < 0:
            yield max(self.square / (-2 * pull), least), "turn"

    def square_at(self, way: Real) -> Real:
        """See ``Smooth``."""
        return self.square + 2 * self._pull() * way

    def time_to(self, way: Real, then: Real) -> Real:
        """See ``Smooth``."""
        speeds = self.mp.sqrt(self.square) + self.mp.sqrt(then)
        return 2 * way / speeds if speeds > 0 else self.mp.inf

    def after(self, time: Real, _most: Real) -> tuple[Vector, Vector]:
        """See ``Smooth``."""
        speed, pull = self.mp.sqrt(self.square), self._pull()
        place, (x, y) = self.guide.at(self.mp, time * (speed + pull * time / 2))
        return place, ((speed + pull * time) * x, (speed + pull * time) * y)


@dataclass(frozen=True, slots=True)
class OnCircle:
    """A ball that rolling friction mu slows down on a circle; see above."""

    mp: Any
    guide: Guide
    gravity: Vector
    square: Real
    mu: Real

    @property
    def _growth(self) -> Real:
        return 2 * self.mu * self.guide.barrier.bend

    def _forced(self, way: Real) -> tuple[Real, Real]:
        """A and B of the equation above, for angles counted from a way on."""
        mp, rho, grows = self.mp, self.guide.barrier.reach, self._growth
        ge, gt = _dot(self.gravity, self.guide.out), _dot(self.gravity, self.guide.ahead)
        c, s = mp.cos(way), mp.sin(way)
        ge, gt = c * ge + s * gt, c * gt - s * ge
        p, q = 2 * rho * (gt + grows / 2 * ge), 2 * rho * (grows / 2 * gt - ge)
        return -(q + grows * p) / (1 + grows * grows), (p - grows * q) / (1 + grows * grows)

    def _squares(self, way: Real, square: Real) -> Callable[[Real], Real]:
        """Squared speed at an angle from a way on, where it is ``square``, with all digits also where that is 0."""
        mp, grows = self.mp, self._growth
        a, b = self._forced(way)

        def at(angle: Real) -> Real:
            # (q - A) e^(l x) + A cos(x) + B sin(x), without the difference of two numbers near A
            grown = mp.expm1(grows * angle)
            return square * (1 + grown) + a * (-2 * mp.sin(angle / 2) ** 2 - grown) + b * mp.sin(angle)

        return at

    def _waves(self) -> tuple[Round, Round]:
        """Squared speed, and what presses the ball."""
        a, b = self._forced(self.mp.mpf(0))
        rho, bend = self.guide.barrier.reach, self.guide.barrier.bend
        ge, gt = _dot(self.gravity, self.guide.out), _dot(self.gravity, self.guide.ahead)
        return (a, b, self.square - a), (
            -bend * (ge + a / rho), -bend * (gt + b / rho), -bend * (self.square - a) / rho
        )  # fmt: skip

    def events(self, least: Real) -> Iterator[tuple[Real, str]]:
        """See ``Smooth``."""
        if self.square > 0 >= self.square_at(least):
            yield least, "turn"
        for name, wave in zip(("turn", "lift"), self._waves(), strict=True):
            for way in self._falls(wave, least):
                yield way, name

    def _extremes(self, wave: Round, end: Real) -> list[Real]:
        """Angles at which the wave over e^(l phi) has its extremes: (b - l a) cos = (a + l b) sin."""
        a, b, _c = wave
        way = self.mp.atan2(b - self._growth * a, a + self._growth * b) % self.mp.pi
        return [turn for turn in (way, way + self.mp.pi) if turn < end]

    def _falls(self, wave: Round, least: Real) -> Iterator[Real]:
        """The first angle, of a whole turn, at which it falls through zero: between extremes it is monotone."""
        mp, grows = self.mp, self._growth
        a, b, c = wave

        def over(way: Real) -> tuple[Real, Real]:
            cosine, sine, left = mp.cos(way), mp.sin(way), mp.exp(-grows * way)
            slope = left * ((b - grows * a) * cosine - (a + grows * b) * sine)
            return c + left * (a * cosine + b * sine), slope

        stops = [least, *(turn for turn in self._extremes(wave, 2 * mp.pi) if turn > least), 2 * mp.pi]
        for low, high in itertools.pairwise(stops):
            if over(low)[0] > 0 > over(high)[0]:
                yield root(mp, over, low, high, (low + high) / 2, 64 * mp.eps, rises=False)
                return

    def square_at(self, way: Real) -> Real:
        """See ``Smooth``."""
        return self._squares(self.mp.mpf(0), self.square)(way)

    def time_to(self, way: Real, then: Real) -> Real:
        """See ``Smooth``: each half from its own end, where the speed may be 0, cut where the ball is slowest."""
        mp, rho = self.mp, self.guide.barrier.reach
        if way == 0:
            return mp.mpf(0)
        half, slow = way / 2, self._extremes(self._waves()[0], way)
        total = mp.mpf(0)
        for begin, square, turn in ((mp.mpf(0), self.square, 1), (way, then, -1)):
            squares = self._squares(begin, square)
            cuts = sorted(turn * (angle - begin) for angle in slow)
            cuts = [mp.mpf(0), *(cut for cut in cuts if 0 < cut < half), half]
            part, error = mp.quad(lambda x, of=squares, way=turn: rho / mp.sqrt(of(way * x)), cuts, error=True)
            if mp.im(part) != 0 or not error < mp.mpf(10) ** (-mp.mpf(mp.dps) / 2) * (1 + abs(part)):
                raise PrecisionError("a glide's time is not sure", code="precision", fix="ask for more digits")
            total += part
        return total

    def after(self, time: Real, most: Real) -> tuple[Vector, Vector]:
        """See ``Smooth``; the angle, at most ``most``, is sought in the time, first with few digits."""
        mp, rho = self.mp, self.guide.barrier.reach
        squares = self._squares(mp.mpf(0), self.square)

        def late(way: Real) -> tuple[Real, Real]:
            square = max(squares(way), mp.mpf(0))
            return self.time_to(way, square) - time, rho / mp.sqrt(square) if square > 0 else mp.mpf(0)

        with mp.workdps(15):
            way = root(mp, late, mp.mpf(0), most, most / 2, mp.mpf(10) ** -10, rises=True)
        near = way * mp.mpf(10) ** -5
        same = mp.mpf(10) ** (-0.75 * mp.dps)
        way = root(mp, late, max(way - near, mp.mpf(0)), min(way + near, most), way, same, rises=True)
        if not abs(late(way)[0]) < mp.mpf(10) ** (-mp.mpf(mp.dps) / 4):
            raise PrecisionError("a glide's angle is not sure", code="precision", fix="ask for more digits")
        speed = mp.sqrt(squares(way))
        place, (x, y) = self.guide.at(mp, way)
        return place, (speed * x, speed * y)


def root(
    mp: Any, value: Callable[[Real], tuple[Real, Real]], low: Real, high: Real, start: Real, same: Real, *, rises: bool
) -> Real:
    """Where a monotone function is 0 that gives its value and slope: Newton's steps, halving where they leave.

    It ends with a step of Newton's, or a bracket, of ``same`` of the place.
    """
    middle = start
    for _ in range(20 * mp.prec):
        off, slope = value(middle)
        low, high = (low, middle) if (off > 0) == rises else (middle, high)
        following = middle - off / slope if slope != 0 else low
        if low <= following <= high and abs(following - middle) <= same * abs(following):
            return following
        if not low < following < high:
            following = (low + high) / 2
        if high - low <= same * abs(high):
            return following
        middle = following
    return middle
