"""What a ball's centre cannot cross, and how gravity moves one that keeps to it, with any number of digits.

A *barrier* is one side of a line moved out by the ball's radius, one of the two circles beside an arc, or the circle
about a vertex. Its gap is above 0 where the ball may be. The same barrier is the guide of a centre that keeps to it. On
a circle everything that can happen next is told by the angle phi from here alone: squared speed, what presses the ball
on the wall and the gap to any other barrier all have the form

    a + b cos(phi) + c sin(phi),

and the time to get there is an elliptic integral of the first kind, the place after a time a Jacobi function.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from wallkit.accuracy.reference import Real, Reference, Vector, _Arc, _dot, _Line

Wave = tuple[Real, Real, Real]
"""a, b, c of a + b cos(phi) + c sin(phi), or of a + b s + c s^2 on a straight guide."""


@dataclass(frozen=True, slots=True)
class Barrier:
    """What a centre cannot cross: a line (``bend`` 0), or a circle that it is outside (1) or inside (-1).

    Attributes:
        number: its place in the list of all.
        obstacle: of the reference.
        bend: see above.
        anchor: a point of the line, or the middle of the circle.
        normal: of the line, towards the ball; else not used.
        reach: the radius of the circle, or how far the line is moved out.
        radius: of the ball.
    """

    number: int
    obstacle: int
    bend: int
    anchor: Vector
    normal: Vector
    reach: Real
    radius: Real

    def normal_at(self, mp: Any, place: Vector) -> Vector:
        """Unit normal towards the ball, whose centre is there."""
        if self.bend == 0:
            return self.normal
        x, y = minus(place, self.anchor)
        length = self.bend * mp.sqrt(x * x + y * y)
        return x / length, y / length

    def press(self, mp: Any, gravity: Vector, place: Vector, velocity: Vector) -> Real:
        """What presses a ball that moves along the barrier on it, per mass."""
        pressed = -_dot(gravity, self.normal_at(mp, place))
        if self.bend != 0:
            pressed -= self.bend * _dot(velocity, velocity) / self.reach
        return pressed

    def gap(self, place: Vector) -> Real:
        """Zero at a contact and above it where the ball may be: a length, or of a circle the difference of squares."""
        x, y = minus(place, self.anchor)
        if self.bend == 0:
            return x * self.normal[0] + y * self.normal[1] - self.reach
        return self.bend * (x * x + y * y - self.reach * self.reach)

    def rate(self, place: Vector, velocity: Vector) -> Real:
        """Change of the gap in time."""
        if self.bend == 0:
            return _dot(self.normal, velocity)
        return 2 * self.bend * _dot(minus(place, self.anchor), velocity)


@dataclass(frozen=True, slots=True)
class Guide:
    """A barrier from a place on, in the direction in which a ball moves along it: p0 + s t, or e turning towards t."""

    barrier: Barrier
    place: Vector
    out: Vector  # unit, from the middle of the circle to the centre; of a line its normal
    ahead: Vector  # unit

    def at(self, mp: Any, way: Real) -> tuple[Vector, Vector]:
        """Place after a way (a length, or an angle), and the direction there."""
        if self.barrier.bend == 0:
            return (self.place[0] + way * self.ahead[0], self.place[1] + way * self.ahead[1]), self.ahead
        c, s, rho = mp.cos(way), mp.sin(way), self.barrier.reach
        (ex, ey), (tx, ty), (mx, my) = self.out, self.ahead, self.barrier.anchor
        return (mx + rho * (c * ex + s * tx), my + rho * (c * ey + s * ty)), (c * tx - s * ex, c * ty - s * ey)

    def squared_speed(self, gravity: Vector, square: Real) -> Wave:
        """v^2 = v0^2 + 2 g.(p - p0)."""
        if self.barrier.bend == 0:
            return square, 2 * _dot(gravity, self.ahead), 0 * square
        lift = 2 * self.barrier.reach
        along_out = lift * _dot(gravity, self.out)
        return square - along_out, along_out, lift * _dot(gravity, self.ahead)

    def pressing(self, gravity: Vector, square: Real) -> Wave:
        """-g.n less v^2 / rho outside a circle; g.e and v^2 / rho inside it."""
        bend, rho = self.barrier.bend, self.barrier.reach
        if bend == 0:
            return -_dot(gravity, self.barrier.normal), 0 * square, 0 * square
        a, b, c = self.squared_speed(gravity, square)
        pull = _dot(gravity, self.out), _dot(gravity, self.ahead)
        return -bend * a / rho, -bend * (pull[0] + b / rho), -bend * (pull[1] + c / rho)

    def gap_to(self, other: Barrier) -> Wave:
        """The gap to another barrier on the way."""
        own, zero = self.barrier, 0 * self.place[0]
        if own.bend == 0:
            slope = other.rate(self.place, self.ahead)
            return other.gap(self.place), slope, zero + other.bend
        (dx, dy), rho = minus(own.anchor, other.anchor), own.reach
        if other.bend == 0:
            a = dx * other.normal[0] + dy * other.normal[1] - other.reach
            return a, rho * _dot(self.out, other.normal), rho * _dot(self.ahead, other.normal)
        a = dx * dx + dy * dy + rho * rho - other.reach * other.reach
        twice = 2 * rho * other.bend
        return other.bend * a, twice * _dot((dx, dy), self.out), twice * _dot((dx, dy), self.ahead)

    def falls(self, mp: Any, wave: Wave, least: Real) -> Iterator[Real]:
        """Ways ahead at which what has this form falls through zero, ``least`` or farther; least first."""
        a, b, c = wave
        if self.barrier.bend == 0:
            yield from sorted(s for s in quadratic_roots(mp, c, b, a) if s >= least and b + 2 * c * s < 0)
            return
        height = mp.sqrt(b * b + c * c)
        if height <= abs(a):
            return
        # a + height cos(phi - top) falls through zero a quarter and more after its top: at top + acos(-a / height)
        way = (mp.atan2(c, b) + mp.atan2(mp.sqrt((height - a) * (height + a)), -a)) % (2 * mp.pi)
        yield way if way >= least else way + 2 * mp.pi

    def time_to(self, mp: Any, gravity: Vector, square: Real, way: Real, then: Real) -> Real:
        """Time of a way on which the ball does not turn, from v^2 = ``square`` to ``then``."""
        v, w = mp.sqrt(square), mp.sqrt(then)
        if self.barrier.bend == 0:
            return 2 * way / (v + w) if v + w > 0 else mp.inf
        swing = Swing(mp, self, gravity, square)
        return (swing.phase(swing.angle + way, w) - swing.phase(swing.angle, v)) / swing.rate

    def after(self, mp: Any, gravity: Vector, square: Real, time: Real) -> tuple[Vector, Vector]:
        """Place and velocity after a time in which the ball does not turn."""
        v = mp.sqrt(square)
        if self.barrier.bend == 0:
            pull = _dot(gravity, self.ahead)
            place, ahead = self.at(mp, time * (v + pull * time / 2))
            speed = v + pull * time
        else:
            swing = Swing(mp, self, gravity, square)
            way, speed = swing.at(swing.phase(swing.angle, v) + swing.rate * time)
            place, ahead = self.at(mp, way)
        return place, (speed * ahead[0], speed * ahead[1])


class Swing:
    """A pendulum: with the angle a from the bottom, V^2 = A - 4 g rho sin^2(a / 2).

    Where it turns, k^2 = A / (4 g rho) < 1 and sin(a / 2) = k sin(psi), V = sqrt(A) cos(psi), with
    F(psi | k^2) = sqrt(g / rho) t; where it goes round, F(a / 2 | 1 / k^2) = sqrt(A) t / (2 rho).
    """

    def __init__(self, mp: Any, guide: Guide, gravity: Vector, square: Real) -> None:
        self.mp, rho = mp, guide.barrier.reach
        pull = mp.sqrt(_dot(gravity, gravity))
        # e = (cos a) of the way down, and the direction ahead is that in which a grows
        self.angle = mp.atan2(-_dot(gravity, guide.ahead), _dot(gravity, guide.out))
        whole = 4 * pull * rho
        bottom = square + whole * mp.sin(self.angle / 2) ** 2
        self.top = mp.sqrt(bottom)  # the speed at the bottom
        self.turns = bottom < whole
        self.part = bottom / whole if self.turns else whole / bottom
        self.rate = mp.sqrt(pull / rho) if self.turns else self.top / (2 * rho)

    def phase(self, angle: Real, speed: Real) -> Real:
        """F at an angle, at which the ball has a speed."""
        mp = self.mp
        if not self.turns:
            return mp.ellipf(angle / 2, self.part)
        return mp.ellipf(mp.atan2(mp.sin(angle / 2) / mp.sqrt(self.part), speed / self.top), self.part)

    def at(self, phase: Real) -> tuple[Real, Real]:
        """How far ahead (an angle) the ball is at a phase, and its speed."""
        mp, m = self.mp, self.part
        sn, cn, dn = (mp.ellipfun(name, phase, m=m) for name in ("sn", "cn", "dn"))
        if self.turns:
            return 2 * mp.asin(mp.sqrt(m) * sn) - self.angle, self.top * cn
        return 2 * mp.atan2(sn, cn) - self.angle, self.top * dn


def minus(a: Vector, b: Vector) -> Vector:
    """Subtract b from a."""
    return a[0] - b[0], a[1] - b[1]


def quadratic_roots(mp: Any, a: Real, b: Real, c: Real) -> list[Real]:
    """List the real roots of a s^2 + b s + c."""
    if a == 0:
        return [] if b == 0 else [-c / b]
    inside = b * b - 4 * a * c
    if inside < 0:
        return []
    q = -(b + (mp.sqrt(inside) if b >= 0 else -mp.sqrt(inside))) / 2
    return [q / a] + ([c / q] if q != 0 else [])


def barriers_of(reference: Reference, radius: Real) -> list[Barrier]:
    """Every side of every obstacle that a ball of a radius can be at; walls of one side have their outward one."""
    mp, found = reference.mp, []
    for index, obstacle in enumerate(reference.obstacles):
        shape = obstacle.shape
        if isinstance(shape, _Line):
            for which in (1, -1):
                normal = (which * shape.unit_normal[0], which * shape.unit_normal[1])
                found.append((index, 0, shape.start, normal, radius, which))
        elif isinstance(shape, _Arc):
            for bend in (1, -1):
                if shape.radius + bend * radius > 0:
                    which = bend if shape.turns_left else -bend
                    found.append((index, bend, shape.centre, shape.middle, shape.radius + bend * radius, which))
        elif radius > 0:
            found.append((index, 1, shape.place, (mp.mpf(1), mp.mpf(0)), radius, 1))
    kept = [part for part in found if part[5] > 0 or not reference.obstacles[part[0]].outward_only]
    return [Barrier(number, *part[0:5], radius) for number, part in enumerate(kept)]
