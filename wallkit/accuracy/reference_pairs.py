"""Discs that meet, with as many digits as wanted: all pairs and all walls, asked one by one; no cells, no queue.

It is what the kernels of discs that meet are measured against, and shares no code and no formula with them. Walls are
those of :class:`wallkit.accuracy.reference.Reference`; discs are asked pair by pair.

What counts as a contact of two discs: touching *and approaching*. Times that differ by less than
``10 ** (-0.6 digits)`` of the scene's own time are one time, and a speed below that part of the scene's own is none.
Contacts at one time are made in the order that docs/meeting.md states: by the lower number of a disc, its walls
first, then by the higher number. Under gravity discs hop as it states, too.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from typing import NamedTuple

import numpy as np

from wallkit.accuracy.reference import Real, Reference, Vector, _dot, _reflect
from wallkit.accuracy.sure_digits import PrecisionError, agreed
from wallkit.arguments import of_type
from wallkit.scene.scene import Scene


class Meeting(NamedTuple):
    """One contact: time, ball, centre, velocity after, unit normal towards the ball, wall and edge (-1: a corner).

    ``other`` is the other ball, -1 for a wall (then its place and velocity are those of the ball); with another ball
    wall and edge are -1, and ``ball`` is the lower number.
    """

    time: Real
    ball: int
    other: int
    position: Vector
    velocity: Vector
    normal: Vector
    wall: int
    edge: int
    other_position: Vector
    other_velocity: Vector


@dataclass(slots=True)
class _Disc:
    """State after the last contact, when that was, the walls touched since, the next contact with a wall; or out."""

    position: Vector
    velocity: Vector
    radius: Real
    mass: Real
    since: Real
    touching: dict[int, int] = field(default_factory=dict)
    wall: tuple[Real, Vector, int, int] | None = None
    out: bool = False


class PairsReference:
    """The discs of one scene, ready to be run together with a number of digits.

    Clusters that collapse and balls that come to rest are not recognised: such a run goes on, contact by contact.

    Args:
        scene: walls and discs that meet; points, drag and friction are not known here and raise.
        digits: decimal digits, at least 16.

    Raises:
        PrecisionError: the scene is none or has what is not known here, or digits are too few.
    """

    def __init__(self, scene: Scene, digits: int = 40) -> None:
        of_type(scene, "scene", Scene, "a Scene", error=PrecisionError, code="bad-scene")
        if not scene.meeting or not (scene.balls.radius > 0.0).all():
            raise PrecisionError("only discs that meet are known here", code="precision", fix="leave out the points")
        self.walls = Reference(replace(scene, meeting=False), digits)
        mp = self.mp = self.walls.mp
        self.scene = scene
        self.kept = mp.mpf(scene.ball_restitution), mp.mpf(scene.ball_tangential_restitution)
        self.small = mp.mpf(10) ** (-0.6 * digits)
        speed = float(np.hypot(*scene.balls.velocity.T).max(initial=0.0))
        if scene.gravity is not None:  # what a fall through the scene gives
            speed = max(speed, math.sqrt(math.hypot(*scene.gravity) * self.walls.size))
        self.speed = speed or 1.0
        self.hop = self._hop()
        self.same = self.small * self.walls.size / self.speed

    def _hop(self) -> Real:
        """Speed that lifts the smallest disc by 1/4096 of its radius, from its energy: v v / 2 = |g| r / 4096."""
        pull = self.walls.gravity
        if pull is None:
            return self.mp.mpf(0)
        height = self.mp.mpf(float(self.scene.balls.radius.min())) / 4096
        return self.mp.sqrt(2 * self.mp.sqrt(_dot(pull, pull)) * height)

    def _hopped(self, velocity: Vector, normal: Vector, restitution: Real) -> Vector:
        """Part at the speed of a hop at least, where speed is taken, or where there is none to part with."""
        parting = _dot(velocity, normal)
        if parting >= self.hop or (restitution == 1 and parting > self.small * self.speed):
            return velocity
        more = self.hop - parting
        return velocity[0] + more * normal[0], velocity[1] + more * normal[1]

    def events(self) -> Iterator[Meeting]:
        """Yield the contacts of all discs in order, without end unless nothing meets any more."""
        balls, number = self.scene.balls, self.mp.mpf
        discs = [
            _Disc(
                self.walls._vector(balls.position[k]),
                self.walls._vector(balls.velocity[k]),
                number(float(balls.radius[k])),
                number(float(balls.mass[k])),
                number(0),
            )
            for k in range(len(balls))
        ]
        due: dict[tuple[int, int], Real] = {}
        changed = list(range(len(discs)))
        while True:
            for ball in changed:
                self._look(discs, ball, due)
            if not due:
                return
            earliest = min(due.values())
            low, high = min(key for key, time in due.items() if time - earliest < self.same)
            time = due[low, high]
            if high < 0:
                yield self._at_wall(discs[low], low, time)
                changed = [low]
            else:
                yield self._together(discs[low], discs[high], low, high, time)
                changed = [low, high]
            for key in [key for key in due if low in key or (high >= 0 and high in key)]:
                del due[key]

    def run(self, contacts: int) -> list[Meeting]:
        """List the first contacts, ``contacts`` at most (fewer when nothing meets any more)."""
        return [event for event, _ in zip(self.events(), range(contacts), strict=False)]

    def _look(self, discs: list[_Disc], ball: int, due: dict[tuple[int, int], Real]) -> None:
        """Ask a disc, at its last contact, what it meets next: its wall under (ball, -1), others under (low, high)."""
        disc = discs[ball]
        if disc.out:
            return
        hit = self.walls._first_hit(disc.position, disc.velocity, disc.radius, disc.touching, self.same)
        if hit is not None:
            disc.wall = (hit.time, hit.normal, hit.obstacle, hit.side)
            due[ball, -1] = disc.since + hit.time
        for other in range(len(discs)):
            if other != ball and not discs[other].out and (time := self._touch(disc, discs[other])) is not None:
                due[min(ball, other), max(ball, other)] = time

    def _touch(self, one: _Disc, other: _Disc) -> Real | None:
        """When two discs touch and approach: the distance is least at u = -d.w / w^2, and h before it they touch.

        With m the vector at that time, h^2 = (s^2 - m.m) / w^2.
        """
        begin = max(one.since, other.since)
        (d, w), (e, u) = (self.walls._fly(disc.position, disc.velocity, begin - disc.since) for disc in (one, other))
        d, w = (d[0] - e[0], d[1] - e[1]), (w[0] - u[0], w[1] - u[1])
        square, towards = _dot(w, w), -_dot(d, w)
        reach = one.radius + other.radius
        if towards <= self.small * self.speed * reach:
            return None
        nearest = towards / square
        m = (d[0] + w[0] * nearest, d[1] + w[1] * nearest)
        depth = reach * reach - _dot(m, m)
        if depth < 0:
            return None
        return begin + max(nearest - self.mp.sqrt(depth / square), self.mp.mpf(0))

    def _carry(self, disc: _Disc, time: Real) -> None:
        """Carry a disc to a time; what it touches it touches no longer."""
        span = time - disc.since
        disc.position, disc.velocity = self.walls._fly(disc.position, disc.velocity, span)
        disc.since = time
        if span > self.same:
            disc.touching = {}

    def _at_wall(self, disc: _Disc, ball: int, time: Real) -> Meeting:
        assert disc.wall is not None
        _time, normal, obstacle, side = disc.wall
        self._carry(disc, time)
        disc.touching[obstacle] = side
        wall = self.walls.obstacles[obstacle]
        disc.velocity = _reflect(disc.velocity, normal, wall.restitution, wall.tangential)
        disc.out = wall.restitution == 0 and wall.tangential == 0
        if not disc.out:
            disc.velocity = self._hopped(disc.velocity, normal, wall.restitution)
        return Meeting(
            time, ball, -1, disc.position, disc.velocity, normal, wall.wall, wall.edge, disc.position, disc.velocity
        )

    def _together(self, one: _Disc, other: _Disc, low: int, high: int, time: Real) -> Meeting:
        """Turn what one velocity is relative to the other as at a wall; that of their centre of mass stays."""
        self._carry(one, time)
        self._carry(other, time)
        d = (one.position[0] - other.position[0], one.position[1] - other.position[1])
        length = self.mp.sqrt(_dot(d, d))
        normal = (d[0] / length, d[1] / length)
        whole = one.mass + other.mass
        mean = tuple((one.mass * one.velocity[axis] + other.mass * other.velocity[axis]) / whole for axis in (0, 1))
        apart = (one.velocity[0] - other.velocity[0], one.velocity[1] - other.velocity[1])
        turned = _reflect(apart, normal, *self.kept)
        if self.kept[0] < 1:
            turned = self._hopped(turned, normal, self.kept[0])
        for disc, part in ((one, other.mass / whole), (other, -one.mass / whole)):
            disc.velocity = (mean[0] + part * turned[0], mean[1] + part * turned[1])
        return Meeting(time, low, high, one.position, one.velocity, normal, -1, -1, other.position, other.velocity)


def sure_meetings(scene: Scene, contacts: int, *, digits: int = 40, most: int = 10_000) -> list[Meeting]:
    """Run with more and more digits until two runs agree to 1e-25 of the scene's size on all contacts.

    Args:
        scene: what :class:`PairsReference` takes.
        contacts: how many.
        digits: to begin with; doubled each time.
        most: digits at which this gives up.

    Raises:
        PrecisionError: ``most`` digits do not suffice, or the scene has what is not known here.
    """

    def run(digits: int) -> tuple[list[Meeting], Real]:
        runner = PairsReference(scene, digits)
        return runner.run(contacts), runner.walls.size

    return agreed(run, lambda met: (met.ball, met.other, met.wall, met.edge), digits, most, contacts, "contacts")
