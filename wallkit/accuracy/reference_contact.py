"""The reference for balls that come to keep to walls under gravity: slide, glide, pivot and rest, in many digits.

It follows the rules that docs/where-is-inside.md states and shares no formula with the kernels. A ball flies, or keeps
to one barrier (see ``contact_guides``); what touches it and moves neither to nor from it decides which:

* it bounces off what it approaches, the wall's restitution telling how, until it approaches nothing that it touches;
* bounces lower than 10 ** (-digits / 2) of the scene are taken to their end: their times and ways are summed up;
* what it moves along and what presses it holds it; a wall along gravity holds it too; nothing else does;
* without speed it slides along the wall on which the pull leads away from what it touches, or rests between two;
* one that starts within ``TOUCHING`` of a wall touches it, and moves along it where it leaves it by no more; a point is
  on the side from which it is pressed, or of a wall along gravity on that to which it moves, and if it moves to
  neither on the outward one of a closed wall, or that to which an open one turns below;
* at the end of an edge the next one around that place, on the ball's side, goes on smoothly, rises (a bounce), or
  falls away: a point leaves, a disc pivots while something presses it on the vertex.
"""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass
from typing import Any, Literal

from wallkit.accuracy.contact_drag import Motion, eased, motion
from wallkit.accuracy.contact_guides import Barrier, Guide, barriers_of, minus
from wallkit.accuracy.contact_joints import Joints
from wallkit.accuracy.contact_search import Search
from wallkit.accuracy.drag_search import DragSearch
from wallkit.accuracy.reference import Real, Reference, Vector, _dot, _reflect
from wallkit.accuracy.sure_digits import PrecisionError
from wallkit.scene.scene import Scene

Kind = Literal["bounce", "slide", "leave", "rest", "end"]
MOST = 100_000
"""Events after which a run is given up."""
TOUCHING = 2.0**-44
"""Of the scene's size, and of a speed: starts are given in doubles."""


@dataclass(frozen=True, slots=True)
class Change:
    """One event: what happened, its time, centre, velocity after, unit normal; wall and edge (-1: a corner)."""

    kind: Kind
    time: Real
    position: Vector
    velocity: Vector
    normal: Vector
    wall: int
    edge: int

    def row(self) -> tuple[float, ...]:
        """Give time, x, y, vx, vy rounded to doubles."""
        return tuple(float(value) for value in (self.time, *self.position, *self.velocity))


class ContactReference:
    """One ball of a scene under gravity.

    Args:
        scene: walls and balls under gravity.
        ball: which ball.
        digits: decimal digits, at least 30.

    Raises:
        PrecisionError: the scene has what is not known here, or no gravity, or digits are too few.
    """

    def __init__(self, scene: Scene, ball: int = 0, digits: int = 40) -> None:
        reference = Reference(dataclasses.replace(scene, rolling_friction=None, drag=None), digits)
        if reference.gravity is None or digits < 30:
            raise PrecisionError("contact states need gravity and 30 digits", code="precision", fix="give both")
        self.mp = mp = reference.mp
        self.gravity: Vector = reference.gravity
        self.reference = reference
        start = scene.balls.take([ball])
        self.position = mp.mpf(float(start.position[0][0])), mp.mpf(float(start.position[0][1]))
        self.velocity = mp.mpf(float(start.velocity[0][0])), mp.mpf(float(start.velocity[0][1]))
        radii = start.radius
        self.radius = mp.mpf(float(radii if isinstance(radii, (int, float)) else radii[0]))
        self.barriers = barriers_of(reference, self.radius)
        self.pull = mp.sqrt(_dot(self.gravity, self.gravity))
        self.rolling = mp.mpf(float(scene.rolling_friction)) / self.pull if scene.rolling_friction else None
        self.size = reference.size
        self.low = self.size * mp.mpf(10) ** (-digits / mp.mpf(2))
        self.tiny = mp.mpf(10) ** (-0.6 * digits)
        self.joints = Joints(reference, self.barriers)
        self.drag = mp.mpf(float(scene.drag)) if scene.drag else None
        parts = reference, self.barriers, self.joints, self.gravity, self.tiny * self.size
        self.search = Search(*parts) if self.drag is None else DragSearch(*parts, drag=self.drag)
        self.touching: dict[int, Barrier] = {}
        self.sides: dict[int, Barrier] = {}  # of obstacles off which the ball has bounced
        self.now = mp.mpf(0)
        self.held: Barrier | None = None
        self.left: tuple[Barrier, Vector] | None = None  # a wall along gravity that a point has run up, and its end
        self.rests = False
        self.changes: list[Change] = []

    def run(self, until: float) -> list[Change]:
        """List what happens until a time, and the state then as the last entry."""
        end = self.mp.mpf(until)
        self._begin()
        for _ in range(MOST):
            if self.rests or self.now >= end:
                break
            if self.held is None:
                self._fly(end)
            else:
                self._go_along(end)
        else:
            raise PrecisionError(f"more than {MOST} events", code="precision", fix="ask for less time")
        self.now = end
        self._note("rest" if self.rests else "end", self.held)
        return self.changes

    def _begin(self) -> None:
        """Put a ball that starts in touch with walls on them, and let them bounce or hold it."""
        found = self.search.near(self.position, TOUCHING * self.size)
        for barrier in [barrier for barrier in found if self._is_on(barrier)]:
            nx, ny = barrier.normal_at(self.mp, self.position)
            off = barrier.gap(self.position)
            if barrier.bend != 0:
                off = off / (2 * barrier.reach)  # of squares; what is left is of the second order
            self.position = self.position[0] - off * nx, self.position[1] - off * ny
            across = self._across(barrier)
            if abs(across) <= TOUCHING * self.mp.sqrt(_dot(self.velocity, self.velocity)):
                self.velocity = self.velocity[0] - across * nx, self.velocity[1] - across * ny
            self.touching[barrier.number] = barrier
        if self.touching:
            self._settle(None)

    def _is_on(self, barrier: Barrier) -> bool:
        """Tell whether a ball that touches a barrier where it starts is on that side of its wall: see above."""
        if self.radius > 0:
            return True
        normal = barrier.normal_at(self.mp, self.position)
        pressed = -_dot(self.gravity, normal)
        if abs(pressed) > TOUCHING * self.pull:
            return bool(pressed > 0)
        across = _dot(self.velocity, normal)
        if abs(across) > TOUCHING * self.mp.sqrt(_dot(self.velocity, self.velocity)):
            return bool(across > 0)
        down = self.gravity[0] / self.pull, self.gravity[1] / self.pull
        return barrier.bend == 0 and self.joints.is_free_side(barrier, down)

    # -- flight

    def _fly(self, end: Real) -> None:
        back = self._time_back()
        if back is not None and self.now + back < end:
            hit = self.search.first(self.position, self.velocity, self.touching, back * (1 - self.tiny))
            if hit is None:
                self._fall_back(back)
                return
        else:
            hit = self.search.first(self.position, self.velocity, self.touching, end - self.now)
        self.left = None
        time = end - self.now if hit is None else hit[0]
        before = self.position
        left, free, second = (1, time, time * time / 2) if self.drag is None else eased(self.mp, self.drag, time)
        gx, gy = self.gravity
        (x, y), (u, v) = self.position, self.velocity
        self.position, self.velocity = (
            (x + u * free + gx * second, y + v * free + gy * second),
            (u * left + gx * free, v * left + gy * free),
        )
        self.now += time
        if hit is None:
            return
        moved = minus(self.position, before)
        if _dot(moved, moved) > (self.tiny * self.size) ** 2:
            self.touching = {}
        self.touching[hit[1].number] = hit[1]
        self._settle(hit[1])

    def _time_back(self) -> Real | None:
        """Time after which a point that has run up over the end of a wall along gravity falls back on it, or None."""
        if self.left is None:
            return None
        speed = self.mp.sqrt(_dot(self.velocity, self.velocity))
        time = 2 * speed / self.pull
        if self.drag is None:
            return time

        def height(time: Real) -> Real:
            _left, free, second = eased(self.mp, self.drag, time)
            return speed * free - self.pull * second

        return self.mp.findroot(height, (time / 2, time), solver="anderson")  # below 0 there, without drag it is 0

    def _fall_back(self, time: Real) -> None:
        """A point falls back as a disc does however small: on the side of the wall on which it was."""
        assert self.left is not None
        barrier, place = self.left
        left, free = (1, time) if self.drag is None else eased(self.mp, self.drag, time)[:2]
        (u, v), (gx, gy) = self.velocity, self.gravity
        self.position, self.velocity, self.left = place, (u * left + gx * free, v * left + gy * free), None
        self.now += time
        self.held, self.touching = barrier, {barrier.number: barrier}
        self._note("slide", barrier)

    # -- what touches the ball

    def _speed_scale(self) -> Real:
        return self.mp.sqrt(_dot(self.velocity, self.velocity) + self.pull * self.size)

    def _settle(self, first: Barrier | None) -> None:
        """Bounce off what is approached, then find what holds the ball, if anything."""
        mp = self.mp
        while True:
            barrier = first if first is not None and self._across(first) < 0 else self._approached()
            first = None
            if barrier is None:
                break
            self._bounce(barrier)
            self._end_bounces(barrier)
            if _dot(self.velocity, self.velocity) <= 2 * self.pull * self.low:
                self.velocity = mp.mpf(0), mp.mpf(0)
                self._touch_all()
                break
        self.held = self._holding()

    def _level(self) -> Real:
        return self.tiny * self._speed_scale()

    def _across(self, barrier: Barrier) -> Real:
        return _dot(self.velocity, barrier.normal_at(self.mp, self.position))

    def _approached(self) -> Barrier | None:
        worst, found = -self._level(), None
        for barrier in self.touching.values():
            across = self._across(barrier)
            if across < worst:
                worst, found = across, barrier
        return found

    def _bounce(self, barrier: Barrier) -> None:
        obstacle = self.reference.obstacles[barrier.obstacle]
        self.sides[barrier.obstacle] = barrier
        normal = barrier.normal_at(self.mp, self.position)
        self.velocity = _reflect(self.velocity, normal, obstacle.restitution, obstacle.tangential)
        self._note("bounce", barrier)

    def _end_bounces(self, barrier: Barrier) -> None:
        """Sum up bounces that are lower than anything else: w after w e, each of the time 2 w / p."""
        mp, obstacle = self.mp, self.reference.obstacles[barrier.obstacle]
        e, f = obstacle.restitution, obstacle.tangential
        normal = barrier.normal_at(mp, self.position)
        w = _dot(self.velocity, normal)
        ahead = (-normal[1], normal[0])
        u = _dot(self.velocity, ahead)
        pressed = barrier.press(mp, self.gravity, self.position, (u * ahead[0], u * ahead[1]))
        if e >= 1 or pressed <= 0 or w <= self._level() or w * w > 2 * pressed * self.low:
            return
        if f >= 1:  # nothing slows it down along the wall in them: it slides, and friction begins when they are over
            if self.rolling is not None:
                time, before = 2 * w / (pressed * (1 - e)), self.velocity
                self.velocity = u * ahead[0], u * ahead[1]
                guide, square = self._guide(barrier)
                slides = motion(mp, guide, self.gravity, square, None, self.drag, time)
                place, velocity = slides.after(time, mp.inf)
                if self._meets_before(barrier, place):
                    self.velocity = before
                    return
                self.position, self.velocity = place, velocity
                self.now += time
                return
            self.velocity = u * ahead[0], u * ahead[1]
            return
        time, way, pull = mp.mpf(0), mp.mpf(0), _dot(self.gravity, ahead)
        while w > self.tiny * self.low:
            t = 2 * w / pressed
            time, way = time + t, way + t * (u + pull * t / 2)
            u, w = f * (u + pull * t), e * w
            pressed = barrier.press(mp, self.gravity, self.position, (u * ahead[0], u * ahead[1]))  # by u, too
        place = self.position[0] + way * ahead[0], self.position[1] + way * ahead[1]
        if self._meets_before(barrier, place):
            return
        self.now += time
        self.position, self.velocity = place, (mp.mpf(0), mp.mpf(0))  # infinitely many bounces leave nothing of it

    def _meets_before(self, barrier: Barrier, place: Vector) -> bool:
        """Tell whether a ball would pass another barrier on the way of its last bounces: then it bounces on, up to it.

        At the other side of a wall its gap is below 0 from the start.
        """
        moved = minus(place, self.position)
        least = -self.tiny * self.size * (1 + self.size)
        for other in self.search.near(self.position, 2 * self.mp.sqrt(_dot(moved, moved)) + self.low):
            if other.obstacle != barrier.obstacle and other.gap(self.position) >= least > other.gap(place):
                return True
        return False

    def _touch_all(self) -> None:
        """A ball without speed touches whatever is nearer than the last bounces were high."""
        touched = {barrier.obstacle for barrier in self.touching.values()}
        near = self.search.near(self.position, 100 * self.low)
        for barrier in sorted(near, key=lambda barrier: barrier.gap(self.position), reverse=True):
            if barrier.obstacle not in touched:  # on the side off which it bounced, else where the gap is above 0
                touched.add(barrier.obstacle)
                own = self.sides.get(barrier.obstacle, barrier)
                self.touching[own.number] = own

    def _holding(self) -> Barrier | None:
        """What presses the ball, or is along gravity; between two, that along which it moves away from the other."""
        pressing = [b for b in self.touching.values() if self._presses(b)]
        standing = _dot(self.velocity, self.velocity) == 0
        if not pressing:
            return None
        if standing:
            free = [barrier for barrier in pressing if not self._blocked(barrier)]
            self.rests, pressing = not free, free or pressing
        barrier = pressing[0]
        if standing and not self.rests:
            self.rests = self._stands(barrier)
        self._note("slide", barrier)
        return barrier

    def _blocked(self, barrier: Barrier) -> bool:
        """Whether the pull along a barrier is into another one that the ball touches."""
        ahead, least = self._pull_along(barrier), -self.tiny * self.pull
        others = (other for other in self.touching.values() if other.obstacle != barrier.obstacle)
        return any(_dot(ahead, other.normal_at(self.mp, self.position)) < least for other in others)

    def _presses(self, barrier: Barrier) -> bool:
        if abs(self._across(barrier)) > self._level():
            return False
        pressed = barrier.press(self.mp, self.gravity, self.position, self.velocity)
        least = self.tiny * self.pull
        return bool(pressed > least or (barrier.bend == 0 and pressed >= -least))

    def _pull_along(self, barrier: Barrier) -> Vector:
        nx, ny = barrier.normal_at(self.mp, self.position)
        along = self.gravity[1] * nx - self.gravity[0] * ny
        return -ny * along, nx * along

    def _stands(self, barrier: Barrier) -> bool:
        pull = self._pull_along(barrier)
        pressed = barrier.press(self.mp, self.gravity, self.position, self.velocity)
        grip = self.reference.scene.walls.materials[self.reference.obstacles[barrier.obstacle].wall].static_friction
        grip = max(grip, self.rolling or 0)
        along = self.mp.sqrt(_dot(pull, pull))
        return bool(along <= self.tiny * self.pull or along <= grip * pressed)

    # -- along a guide

    def _go_along(self, end: Real) -> None:
        mp, held = self.mp, self.held
        assert held is not None
        guide, square = self._guide(held)
        goes = motion(mp, guide, self.gravity, square, self.rolling, self.drag, end - self.now)
        way, event = self._first_event(guide, goes, held)
        then = mp.mpf(0) if event == "turn" or way == mp.inf else goes.square_at(way)
        time = goes.time_to(way, max(then, mp.mpf(0))) if way < mp.inf else mp.inf
        if self.now + time >= end:
            self.position, self.velocity = goes.after(end - self.now, way)
            self.now = end
            return
        self.now += time
        self.position, ahead = guide.at(mp, way)
        speed = mp.sqrt(max(then, mp.mpf(0)))
        self.velocity = speed * ahead[0], speed * ahead[1]
        self._happens(event, held, ahead)

    def _happens(self, event: Any, held: Barrier, ahead: Vector) -> None:
        self.touching = {held.number: held}
        if event == "turn":
            self.rests = self._stands(held)
        elif event == "lift":
            self._note("leave", held)
            self.held = None
        elif event == "end":
            self._pass_on(held, ahead)
        else:
            self.touching[event.number] = event
            self._settle(event)
            if self.held is None:
                self._note("leave", held)

    def _pass_on(self, held: Barrier, ahead: Vector) -> None:
        """At the end of an edge, or of the fan of a vertex."""
        mp = self.mp
        joint = self.joints.next(held, self.position, ahead)
        if joint.kind == "hollow":
            assert joint.barrier is not None
            self.touching[joint.barrier.number] = joint.barrier
            self._settle(joint.barrier)
            return
        following = joint.barrier if joint.kind == "smooth" else joint.vertex
        if joint.barrier is not None and self.radius == 0:  # a disc is at the vertex yet
            self.touching[joint.barrier.number] = joint.barrier
        if joint.vertex is not None:  # of a smooth joint: passed as the edge is, whatever its rounding turns
            self.touching[joint.vertex.number] = joint.vertex
        if following is not None:
            self.touching[following.number] = following
            self._turn_along(following)
            if self._presses(following):
                self.held, self.touching = following, {following.number: following}
                self._note("slide", following)
                return
        self._note("leave", held)
        self.held = None
        pressed = _dot(self.gravity, held.normal_at(mp, self.position))
        along = held.bend == 0 and abs(pressed) <= self.tiny * self.pull
        if self.radius == 0 and along and _dot(self.velocity, self.gravity) < 0:
            self.left = held, self.position

    def _turn_along(self, barrier: Barrier) -> None:
        """A smooth joint keeps the speed; walls drawn in doubles turn there by their rounding."""
        nx, ny = barrier.normal_at(self.mp, self.position)
        speed = self.mp.sqrt(_dot(self.velocity, self.velocity))
        if self.velocity[1] * nx - self.velocity[0] * ny < 0:
            speed = -speed
        self.velocity = -ny * speed, nx * speed

    def _guide(self, held: Barrier) -> tuple[Guide, Real]:
        nx, ny = held.normal_at(self.mp, self.position)
        along = self.velocity[1] * nx - self.velocity[0] * ny
        square = along * along
        if along == 0:
            along = self.gravity[1] * nx - self.gravity[0] * ny
        turn = 1 if along > 0 else -1
        bend = held.bend or 1
        return Guide(held, self.position, (bend * nx, bend * ny), (-turn * ny, turn * nx)), square

    def _first_event(self, guide: Guide, goes: Motion, held: Barrier) -> tuple[Real, Any]:
        mp, least = self.mp, self.tiny
        best: Real = mp.inf
        event: Barrier | str | None = None
        for way, name in goes.events(least):
            if way < best:
                best, event = way, name
        for way in self.joints.ends(guide):
            if way < best:
                best, event = way, "end"
        for other in self.barriers:
            if other.obstacle == held.obstacle:
                continue
            for way in guide.falls(mp, guide.gap_to(other), least):
                if way >= best:
                    break
                place, _ahead = guide.at(mp, way)
                if self.search.on_section(other, place) and not self.joints.passes(held, other, place):
                    best, event = way, other
                    break
        return best, event

    def _note(self, kind: Kind, barrier: Barrier | None) -> None:
        wall, edge, normal = -1, -1, (self.mp.mpf(0), self.mp.mpf(0))
        if barrier is not None:
            obstacle = self.reference.obstacles[barrier.obstacle]
            wall, edge, normal = obstacle.wall, obstacle.edge, barrier.normal_at(self.mp, self.position)
        self.changes.append(Change(kind, self.now, self.position, self.velocity, normal, wall, edge))
