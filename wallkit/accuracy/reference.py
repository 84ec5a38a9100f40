"""A second simulator with as many digits as wanted: slow, brute force, and independent of the kernels.

It is what the fast simulator is measured against. It shares no code and no formula with the kernels: every
ball is followed alone, every obstacle is asked for the time of every bounce, in arbitrary precision (mpmath).
The coordinates of walls and balls are taken as the exact numbers that their doubles are.

What counts as a hit: touching *and approaching*. Which side of an edge the ball is on is remembered while it
touches, so that no rounding, however small, has to decide it. Two times that differ by less than
``10 ** (-0.6 digits)`` of the scene's own time are one time: rounding is far below that, and true events that
close together are beyond what these digits can order.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import partial
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from wallkit.accuracy.real_roots import real_roots
from wallkit.accuracy.sure_digits import PrecisionError, agreed
from wallkit.arguments import of_type, whole_number
from wallkit.scene.scene import Scene
from wallkit.walls import Walls

Real = Any  # an mpmath.mpf of the context in use
Vector = tuple[Real, Real]


class Event(NamedTuple):
    """One contact: time, centre, velocity after, unit normal towards the ball; wall and edge (-1: a corner)."""

    time: Real
    position: Vector
    velocity: Vector
    normal: Vector
    wall: int
    edge: int
    vertex: int

    def row(self) -> tuple[float, ...]:
        """Give time, x, y, vx, vy rounded to doubles."""
        return tuple(float(value) for value in (self.time, *self.position, *self.velocity))


@dataclass(frozen=True, slots=True)
class _Line:
    start: Vector
    along: Vector  # end - start
    unit_normal: Vector  # outward
    length2: Real


@dataclass(frozen=True, slots=True)
class _Arc:
    centre: Vector
    radius: Real
    middle: Vector  # unit vector from the centre to the middle of the arc
    cos_half: Real  # cosine of half the angle that the arc spans
    turns_left: bool  # counter-clockwise: the outward normal points away from the centre


@dataclass(frozen=True, slots=True)
class _Vertex:
    place: Vector


@dataclass(frozen=True, slots=True)
class _Obstacle:
    shape: _Line | _Arc | _Vertex
    wall: int
    edge: int
    vertex: int
    outward_only: bool
    restitution: Real
    tangential: Real


class _Hit(NamedTuple):
    time: Real
    normal: Vector
    obstacle: int
    side: int  # +1 the outward side of a line or the outside of a circle, -1 the other


def context(digits: int) -> Any:
    """Give an mpmath context of its own with that many decimal digits."""
    import mpmath  # late: only a reference needs it

    own = mpmath.MPContext()
    own.dps = digits
    return own


class Reference:
    """One scene, ready to be run with a number of digits.

    Gravity is exact too (corners and arcs: real roots of a quartic between its extremes); balls at rest and
    collapse are not recognised: such a run simply goes on until the bounces asked for.

    Args:
        scene: walls and balls; drag and friction are not known here and raise; sensors change nothing.
        digits: decimal digits, at least 16.

    Raises:
        PrecisionError: the scene is none or has what is not known here, or digits are too few.
    """

    def __init__(self, scene: Scene, digits: int = 40) -> None:
        of_type(scene, "scene", Scene, "a Scene", error=PrecisionError, code="bad-scene")
        may_be = "16 or more: fewer are fewer than a double has"
        digits = whole_number(digits, "digits", may_be, error=PrecisionError, code="precision", least=16, most=10**6)
        if scene.drag is not None or scene.rolling_friction is not None:
            raise PrecisionError("drag and friction are not known here", code="precision", fix="take them off")
        if scene.meeting and np.count_nonzero(scene.balls.radius) > 1:
            raise PrecisionError("balls that meet are not known here", code="precision", fix="take one ball")
        self.mp = context(digits)
        self.digits = digits
        self.scene = scene
        self.gravity = self._vector(scene.gravity) if scene.gravity is not None else None
        self.obstacles = list(self._build(scene.walls))
        box = scene.walls.box()
        self.size = max(box[2] - box[0], box[3] - box[1], *(abs(value) for value in box), 1e-300)
        self._centres, self._reaches = _bounding_circles(scene.walls, self.obstacles)

    def events(self, ball: int = 0) -> Iterator[Event]:
        """Yield the contacts of one ball, without end unless it leaves the scene."""
        mp = self.mp
        balls = self.scene.balls
        position = self._vector(np.asarray(balls.position, dtype=np.float64)[ball])
        velocity = self._vector(np.asarray(balls.velocity, dtype=np.float64)[ball])
        radii = np.broadcast_to(np.asarray(balls.radius, dtype=np.float64), (len(np.atleast_2d(balls.position)),))
        radius = mp.mpf(float(radii[ball]))
        now = mp.mpf(0)
        touching: dict[int, int] = {}
        speed = mp.sqrt(_dot(velocity, velocity)) or mp.mpf(1)
        same = mp.mpf(10) ** (-0.6 * self.digits) * self.size / speed
        while True:
            hit = self._first_hit(position, velocity, radius, touching, same)
            if hit is None:
                return
            position, velocity = self._fly(position, velocity, hit.time)
            now += hit.time
            if hit.time > same:
                touching = {}
            touching[hit.obstacle] = hit.side
            obstacle = self.obstacles[hit.obstacle]
            velocity = _reflect(velocity, hit.normal, obstacle.restitution, obstacle.tangential)
            yield Event(now, position, velocity, hit.normal, obstacle.wall, obstacle.edge, obstacle.vertex)

    def run(self, bounces: int, ball: int = 0) -> list[Event]:
        """List the first ``bounces`` contacts of a ball (fewer when it leaves the scene)."""
        found: list[Event] = []
        for event in self.events(ball):
            found.append(event)
            if len(found) >= bounces:
                break
        return found

    def _first_hit(
        self, position: Vector, velocity: Vector, radius: Real, touching: dict[int, int], same: Real
    ) -> _Hit | None:
        best: _Hit | None = None
        for index in self._candidates(position, velocity, radius, touching):
            for time, normal, side in self._hits(index, position, velocity, radius, touching.get(index), same):
                if best is None or time < best.time:
                    best = _Hit(time, normal, int(index), side)
        return best

    def _candidates(
        self, position: Vector, velocity: Vector, radius: Real, touching: dict[int, int]
    ) -> NDArray[np.int64]:
        """Leave out what the straight path misses by far: bounding circles, in doubles, with a wide margin."""
        if self.gravity is not None or len(self.obstacles) < 32:
            return np.arange(len(self.obstacles))
        x, y, vx, vy = float(position[0]), float(position[1]), float(velocity[0]), float(velocity[1])
        speed = math.hypot(vx, vy) or 1.0
        dx, dy = self._centres[:, 0] - x, self._centres[:, 1] - y
        reach = self._reaches + float(radius) + 1e-6 * self.size
        near = (np.abs(dx * vy - dy * vx) <= reach * speed) & (dx * vx + dy * vy >= -reach * speed)
        order = np.flatnonzero(near)
        return order[np.argsort(dx[order] * vx + dy[order] * vy)]

    def _hits(
        self, index: int, position: Vector, velocity: Vector, radius: Real, side: int | None, same: Real
    ) -> Iterator[tuple[Real, Vector, int]]:
        obstacle = self.obstacles[index]
        shape = obstacle.shape
        if isinstance(shape, _Line):
            found = self._line_hits(shape, position, velocity, radius, side, same)
        elif isinstance(shape, _Arc):
            found = self._arc_hits(shape, position, velocity, radius, side, same)
        elif radius > 0:
            found = self._circle_hits(shape.place, radius, position, velocity, side, same, outside=True)
        else:
            return
        for time, normal, which in found:
            outward = which if not isinstance(shape, _Arc) or shape.turns_left else -which
            if not (obstacle.outward_only and outward < 0):
                yield time, normal, which

    def _line_hits(
        self, line: _Line, position: Vector, velocity: Vector, radius: Real, side: int | None, same: Real
    ) -> Iterator[tuple[Real, Vector, int]]:
        zero = self.mp.mpf(0)
        for which in (1, -1) if side is None else (side,):
            normal = (which * line.unit_normal[0], which * line.unit_normal[1])
            offset = (position[0] - line.start[0], position[1] - line.start[1])
            gap = zero if side is not None else _dot(offset, normal) - radius
            push = _dot(self.gravity, normal) if self.gravity is not None else zero
            for time in real_roots(self.mp, [push / 2, _dot(velocity, normal), gap]):
                there, then = self._fly(position, velocity, time)
                approaching = _dot(then, normal) < 0
                if not approaching or time < -same:
                    continue
                along = _dot((there[0] - line.start[0], there[1] - line.start[1]), line.along)
                if 0 <= along <= line.length2:
                    yield max(time, zero), normal, which

    def _arc_hits(
        self, arc: _Arc, position: Vector, velocity: Vector, radius: Real, side: int | None, same: Real
    ) -> Iterator[tuple[Real, Vector, int]]:
        for outside in (True, False):
            reach = arc.radius + radius if outside else arc.radius - radius
            if reach <= 0 or (side is not None and outside != (side > 0) and radius == 0):
                continue  # a ball larger than the arc meets its concave side at the ends alone
            own = side if side is not None and outside == (side > 0) else None
            for time, normal, which in self._circle_hits(
                arc.centre, reach, position, velocity, own, same, outside=outside
            ):
                if which * _dot(normal, arc.middle) >= arc.cos_half:
                    yield time, normal, which

    def _circle_hits(
        self,
        centre: Vector,
        reach: Real,
        position: Vector,
        velocity: Vector,
        side: int | None,
        same: Real,
        *,
        outside: bool,
    ) -> Iterator[tuple[Real, Vector, int]]:
        """|d + v t + g t^2 / 2|^2 = reach^2, at the times when the ball approaches from the side named."""
        offset = (position[0] - centre[0], position[1] - centre[1])
        gap = _dot(offset, offset) - reach * reach
        if side is not None:
            gap = self.mp.mpf(0)  # it touches: so it was computed
        coefficients = [_dot(velocity, velocity), 2 * _dot(offset, velocity), gap]
        if self.gravity is not None:
            g = self.gravity
            coefficients[0] += _dot(offset, g)
            coefficients = [_dot(g, g) / 4, _dot(velocity, g), *coefficients]
        for time in real_roots(self.mp, coefficients):
            if time < -same:
                continue
            there, then = self._fly(position, velocity, time)
            radial = (there[0] - centre[0], there[1] - centre[1])
            rate = _dot(radial, then)
            if (rate < 0) if outside else (rate > 0):
                which = 1 if outside else -1
                length = self.mp.sqrt(_dot(radial, radial))
                yield max(time, self.mp.mpf(0)), (which * radial[0] / length, which * radial[1] / length), which

    def _fly(self, position: Vector, velocity: Vector, time: Real) -> tuple[Vector, Vector]:
        x, y = position[0] + velocity[0] * time, position[1] + velocity[1] * time
        if self.gravity is None:
            return (x, y), velocity
        gx, gy = self.gravity
        half = time * time / 2
        return (x + gx * half, y + gy * half), (velocity[0] + gx * time, velocity[1] + gy * time)

    def _vector(self, pair: Any) -> Vector:
        return self.mp.mpf(float(pair[0])), self.mp.mpf(float(pair[1]))

    def _build(self, walls: Walls) -> Iterator[_Obstacle]:
        starts, ends, edge_offsets = walls.edge_starts, walls.edge_ends, walls.edge_offsets
        for wall in range(len(walls)):
            material = walls.materials[wall]
            common = (
                walls.sides[wall] == "outward",
                self.mp.mpf(material.restitution),
                self.mp.mpf(material.tangential_restitution),
            )
            for edge in range(edge_offsets[wall], edge_offsets[wall + 1]):
                a, b = self._vector(walls.vertices[starts[edge]]), self._vector(walls.vertices[ends[edge]])
                if a != b:
                    shape = self._edge(a, b, float(walls.bulges[starts[edge]]))
                    yield _Obstacle(shape, wall, int(edge - edge_offsets[wall]), -1, *common)
            first = int(walls.offsets[wall])
            for vertex in range(first, int(walls.offsets[wall + 1])):
                yield _Obstacle(_Vertex(self._vector(walls.vertices[vertex])), wall, -1, vertex - first, *common)

    def _edge(self, a: Vector, b: Vector, bulge: float) -> _Line | _Arc:
        mp = self.mp
        along = (b[0] - a[0], b[1] - a[1])
        length = mp.sqrt(_dot(along, along))
        normal = (along[1] / length, -along[0] / length)
        if bulge == 0:
            return _Line(a, along, normal, length * length)
        # With half the chord h = length / 2 and k = |bulge| = tan(angle / 4): the sagitta is k h, the radius
        # h (1 + k^2) / (2 k), and the arc bows to the right of its chord when the bulge is positive.
        k = mp.mpf(bulge)
        radius = length * (1 + k * k) / (4 * abs(k))
        turn = 1 if bulge > 0 else -1
        middle = (turn * normal[0], turn * normal[1])
        sagitta = abs(k) * length / 2
        centre = (
            (a[0] + b[0]) / 2 + middle[0] * (sagitta - radius),
            (a[1] + b[1]) / 2 + middle[1] * (sagitta - radius),
        )
        return _Arc(centre, radius, middle, mp.cos(2 * mp.atan(abs(k))), bulge > 0)


def _dot(a: Vector, b: Vector) -> Real:
    return a[0] * b[0] + a[1] * b[1]


def _reflect(velocity: Vector, normal: Vector, restitution: Real, tangential: Real) -> Vector:
    """Give the velocity after a bounce: v' = T (v - (v.n) n) - R (v.n) n."""
    across = _dot(velocity, normal)
    keep = across * (tangential + restitution)
    return tangential * velocity[0] - keep * normal[0], tangential * velocity[1] - keep * normal[1]


def _bounding_circles(walls: Walls, obstacles: list[_Obstacle]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    centres, reaches = np.zeros((len(obstacles), 2)), np.zeros(len(obstacles))
    for index, obstacle in enumerate(obstacles):
        shape = obstacle.shape
        if isinstance(shape, _Line):
            centres[index] = [float(shape.start[axis] + shape.along[axis] / 2) for axis in (0, 1)]
            reaches[index] = math.sqrt(float(shape.length2)) / 2
        elif isinstance(shape, _Arc):
            # at most a half circle lies within the circle over its chord; more of it is taken whole
            inward = max(0.0, float(shape.cos_half)) * float(shape.radius)
            centres[index] = [float(shape.centre[axis] + shape.middle[axis] * inward) for axis in (0, 1)]
            reaches[index] = math.sqrt(max(0.0, float(shape.radius) ** 2 - inward**2))
        else:
            centres[index] = [float(value) for value in shape.place]
    return centres, reaches * (1 + 1e-12)


def sure_events(scene: Scene, bounces: int, ball: int = 0, *, digits: int = 40, most: int = 10_000) -> list[Event]:
    """Run with more and more digits until two runs agree to 1e-25 of the scene's size on all bounces.

    Args:
        scene: what is run.
        bounces: how many contacts.
        ball: which ball.
        digits: to begin with; doubled each time.
        most: digits at which this gives up.

    Raises:
        PrecisionError: ``most`` digits do not suffice, or an argument is none of what may be.
    """
    of_type(scene, "scene", Scene, "a Scene", error=PrecisionError, code="bad-scene")
    whole = partial(whole_number, may_be="a whole number, 0 or more", error=PrecisionError, code="precision", least=0)
    bounces, most = whole(bounces, "bounces"), whole(most, "most")
    ball = whole(ball, "ball", may_be="the number of a ball", code="bad-ball", most=len(scene.balls) - 1)

    def run(digits: int) -> tuple[list[Event], Real]:
        runner = Reference(scene, digits)
        return runner.run(bounces, ball), runner.size

    return agreed(run, lambda event: (event.wall, event.edge, event.vertex), digits, most, bounces, "bounces")
