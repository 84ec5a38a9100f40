"""World: a scene stepped frame by frame, for game loops; exact within the step, or wrong in the classic ways."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any, Literal, get_args

import numpy as np
from numpy.typing import ArrayLike, NDArray

from importers.limits import limit_error
from wallkit.arguments import flag, floats, number, of_type, refused, whole_number, word
from wallkit.geometry.arrays import FloatArray
from wallkit.kernels.impact.leaving import LEVEL_SPEED
from wallkit.kernels.records import LOG, NO_HIT
from wallkit.scene.scene import Balls, Scene, SceneError
from wallkit.simulation.gliding import guides
from wallkit.simulation.modelled import box_around, check_balls, check_sizes
from wallkit.simulation.motion import Motion
from wallkit.simulation.run import CONTACT, ContactKind
from wallkit.simulation.sensors import sensors_of, together
from wallkit.simulation.simulate import Flights

if TYPE_CHECKING:
    from wallkit.simulation.meeting_world import Together
    from wallkit.simulation.overlapping import Overlapping

MOST_CONTACTS = 100_000
"""Of one ball in one frame: they take a minute or two, and no frame of a game has as many."""
_NO_CONTACTS = np.empty(0, dtype=CONTACT)
_NO_CONTACTS.flags.writeable = False
Way = Literal["exact", "stop", "full-step", "reflect-in-place", "overlap"]


class World:
    """The balls of a scene, moved on by one frame at a time.

    A contact within a frame is treated in one of five ways. With p the place at the frame's start, c the place
    of the contact, v' the velocity after it and dt the frame, the ball is at the frame's end

    * ``"exact"``: where physics puts it: to the contact, then what is left of the step along v', through as many
      contacts as it takes. Contacts are those of :func:`wallkit.simulate`, bit for bit, whatever the frames.
    * ``"stop"``: at c. The rest of the frame is lost, so balls are late: by half a frame a bounce on average.
    * ``"full-step"``: at c + v' dt. The way before the contact is gained; what lies behind c is not looked at, so
      a ball in a corner, or before a close second wall, passes it.
    * ``"reflect-in-place"``: at p + v' dt. Balls turn up to a frame before the wall, and pass others as above.
    * ``"overlap"``: at p + v dt, as if there were no walls; there those that the disc overlaps turn its velocity (see
      :class:`~wallkit.simulation.overlapping.Overlapping`). What is thinner than a frame's way is flown through, and
      by a point everything.

    The last four are what frame-stepping programs do; they are here to be compared with. Frames are
    summed without loss, so that time is as good as a double can be.

    The scene is prepared once, and each ball's next contact is found once and kept, so that a frame without
    contacts costs a comparison. Kernels are interpreted, so that no frame ever waits for a compiler; with
    ``compile=True`` the constructor does the waiting.

    Attributes:
        scene: what is stepped; changing it later has no effect.
        way: how contacts within a frame are treated.
        time: seconds since the start.

    Args:
        scene: walls, balls, and what acts.
        way: see above.
        compile: compile the kernels now; a contact among thousands of walls then takes a third of the time.

    Raises:
        SceneError: the way has no such name, or the scene cannot be simulated.
    """

    def __init__(self, scene: Scene, way: Way = "exact", *, compile: bool = False) -> None:
        of_type(scene, "scene", Scene, "a Scene", error=SceneError, code="bad-scene")
        word(way, "way", get_args(Way), error=SceneError, code="bad-way")
        flag(compile, "compile", error=SceneError, code="bad-argument")
        self.scene = scene
        self.way: Way = way
        self.time = 0.0
        self._lost = 0.0  # what the sum of the frames loses to rounding
        self._stepper: Together | Overlapping | None = None  # what moves the balls where no contact is foreseen here
        if scene.meeting or way == "overlap":
            self._size = check_sizes(scene, box_around(scene.walls, scene.walls.box()))
            self._stepper = _stepper_of(scene, way, compile)
            return
        self._flights = Flights(scene, mode="compiled" if compile else "interpreted")
        self._size = self._flights.modelled.size
        self._motion = Motion.of(scene, self._flights.start.copy())  # after each ball's last contact or change, ...
        self._since = np.zeros(len(self))  # ... when that was, and what was touched
        self._touched = np.full(len(self), NO_HIT, dtype=np.int64)
        self._end = np.full(len(self), math.inf)  # when it rests for good, or is caught
        self._next_time = np.full(len(self), math.inf)
        self._next: list[FloatArray | None] = [None] * len(self)
        self._sensors = sensors_of(scene)
        self._coming: list[tuple[Any, ...] | None] = [None] * len(self)  # next crossing of a sensor before that, ...
        self._later: list[Iterator[tuple[Any, ...]]] = [iter(())] * len(self)  # ... and those after it
        for ball in range(len(self)):
            self._look_ahead(ball)
        self._soonest = float(self._next_time.min(initial=math.inf))

    def __len__(self) -> int:
        return len(self.scene.balls)

    def __repr__(self) -> str:
        return f"<World: {self.way!r} at {self.time:.6g} s, {self.scene!r}>"

    @property
    def position(self) -> FloatArray:
        """(n, 2) centres now."""
        return self._state()[:, 0:2]

    @property
    def velocity(self) -> FloatArray:
        """(n, 2) velocities now."""
        return self._state()[:, 2:4]

    def _state(self) -> FloatArray:
        if self._stepper is not None:
            return self._stepper.state(self.time)
        return self._motion.at(np.arange(len(self)), np.minimum(self.time, self._end) - self._since)

    def step(self, dt: float) -> NDArray[Any]:
        """Move everything on by ``dt`` seconds.

        Returns:
            (k,) of ``run.CONTACT``: the contacts of this frame, and crossings of sensors, in order of time; with the
            columns of the other ball where balls meet.

        Raises:
            SceneError: ``dt`` is negative or not finite.
            LimitError: a ball makes more than 100,000 contacts in this frame; the world is then of no use any more.
        """
        dt = number(dt, "dt", "finite seconds, 0 or more", error=SceneError, code="bad-step", least=0.0)
        whole = dt + self._lost  # Kahan's sum: what one frame loses to rounding the next one gets
        end = self.time + whole
        self._lost = whole - (end - self.time)
        if self._stepper is not None:
            self.time = end
            return self._stepper.go(end)
        if self._soonest > end:
            self.time = end
            return _NO_CONTACTS
        rows: list[FloatArray] = []
        owners: list[int] = []
        crossed: list[tuple[Any, ...]] = []
        for ball in np.flatnonzero(self._next_time <= end).tolist():
            crossed += self._cross(ball, end)
            most = len(rows) + MOST_CONTACTS
            while (row := self._next[ball]) is not None and row[LOG.time] <= end:
                if len(rows) >= most:
                    raise limit_error(
                        "contacts of a ball in one frame", f"{MOST_CONTACTS:,}", fix="take shorter frames"
                    )
                rows.append(row[None])
                owners.append(ball)
                if self.way == "exact":
                    self._accept(ball, row)
                    crossed += self._cross(ball, end)
                else:
                    self._accept_late(ball, row, end, dt)
                    break
        self.time, self._soonest = end, float(self._next_time.min(initial=math.inf))
        contacts = self._flights.contacts(rows, [np.array([ball], dtype=np.int32) for ball in owners])
        return together(contacts, crossed) if crossed else contacts

    def place(self, ball: int, position: ArrayLike | None = None, velocity: ArrayLike | None = None) -> None:
        """Put a ball somewhere else, or give it another velocity, now: a kick, a flipper, a new ball.

        A velocity into the wall that the ball touches is turned at once, without a loss.

        Raises:
            SceneError: there is no such ball, or a place or velocity is not two finite numbers, or beyond what is known
                to work.
        """
        most, may_be = len(self) - 1, f"a whole number from 0 to {len(self) - 1}"
        ball = whole_number(ball, "ball", may_be, error=SceneError, code="bad-ball", least=0, most=most)
        here = self.position[ball] if position is None else _pair(position, "position")
        speed = self.velocity[ball] if velocity is None else _pair(velocity, "velocity")
        check_balls(Balls([here], [speed]), self._size, self.scene.gravity is not None)
        if self._stepper is not None:
            self._stepper.place(ball, here, speed, self.time)
            return
        touched, normal = (NO_HIT, None) if position is not None else self._contact(ball, here)
        if normal is None or touched == NO_HIT:
            self._restart(ball, here, speed, self.time, NO_HIT)
        else:
            away = float(speed @ normal)
            along = abs(away) <= LEVEL_SPEED * float(np.abs(speed).sum()) and float(self._motion.gravity @ normal) < 0.0
            if away < 0.0 and not along:
                speed = speed - 2.0 * away * normal
            self._restart(ball, here, speed, self.time, touched, normal if along else None)
        self._soonest = float(self._next_time.min())

    def _contact(self, ball: int, here: FloatArray) -> tuple[int, FloatArray | None]:
        """What a ball touches now, and the unit normal towards it: what holds it, or what it has just hit."""
        touched, normal = int(self._touched[ball]), self._motion.normal[ball]
        held = self._motion.held[ball] or self._since[ball] == self.time or self.time >= self._end[ball]
        if touched == NO_HIT or not held:
            return NO_HIT, None
        if (bend := float(self._motion.bend[ball])) != 0.0:  # the normal turns as the ball goes round
            turned: FloatArray = normal + (here - self._motion.state[ball, 0:2]) / bend
            normal = turned / np.hypot(*turned)
        return touched, normal

    def _look_ahead(self, ball: int) -> None:
        """Find the ball's next contact; the frames catch up with it later."""
        row = self._next[ball] = self._flights.next_contact(ball)
        end = self._flights.ended(ball) if row is None else None
        self._end[ball] = math.inf if end is None else end
        if self._sensors is not None:
            until = self._end[ball] if row is None else row[LOG.time]
            flight = self._motion, ball, float(self._since[ball]), float(until)
            self._later[ball] = self._sensors.crossings_on(ball, *flight)
            self._coming[ball] = next(self._later[ball], None)
        self._set_next_time(ball)

    def _set_next_time(self, ball: int) -> None:
        """Note when the next contact or crossing is."""
        row, coming = self._next[ball], self._coming[ball]
        self._next_time[ball] = coming[0] if coming else math.inf if row is None else row[LOG.time]

    def _cross(self, ball: int, end: float) -> list[tuple[Any, ...]]:
        """Take from the coming crossings those up to a time."""
        passed = []
        while (crossing := self._coming[ball]) is not None and crossing[0] <= end:
            passed.append(crossing)
            self._coming[ball] = next(self._later[ball], None)
        self._set_next_time(ball)
        return passed

    def _accept(self, ball: int, row: FloatArray) -> None:
        """The frame has reached the contact: from there the ball goes on."""
        place, normal = row[[LOG.x, LOG.y]] + self._flights.modelled.origin, row[[LOG.nx, LOG.ny]]
        self._motion.begin(ball, place, row[[LOG.vx, LOG.vy]])
        self._since[ball], self._touched[ball], self._motion.normal[ball] = row[LOG.time], row[LOG.feature], normal
        if row[LOG.kind] == ContactKind.SLIDE:
            contact = self._flights.contacts([row[None]], [np.array([ball], dtype=np.int32)])
            self._motion.hold(np.array([ball]), normal[None], guides(self.scene.walls, contact))
        self._look_ahead(ball)

    def _accept_late(self, ball: int, row: FloatArray, end: float, dt: float) -> None:
        """Treat the contact as frame-stepping programs do; whatever else was in the frame is not looked at."""
        contact, after = row[[LOG.x, LOG.y]] + self._flights.modelled.origin, row[[LOG.vx, LOG.vy]]
        if self.way == "stop":
            self._motion.normal[ball] = row[[LOG.nx, LOG.ny]]
            self._restart(ball, contact, after, end, int(row[LOG.feature]))
        elif self.way == "full-step":
            self._restart(ball, contact + dt * after, after, end, NO_HIT)
        else:
            self._restart(ball, self.position[ball] + dt * after, after, end, NO_HIT)

    def _restart(
        self,
        ball: int,
        position: FloatArray,
        velocity: FloatArray,
        time: float,
        last: int,
        normal: FloatArray | None = None,
    ) -> None:
        self._flights.place(ball, position, velocity, time, last, normal)
        self._motion.begin(ball, position, velocity)
        self._since[ball], self._touched[ball] = time, last
        self._look_ahead(ball)


def _stepper_of(scene: Scene, way: Way, compile: bool) -> Together | Overlapping:
    """What moves balls that meet, or that are looked at where frames end."""
    if scene.meeting:
        from wallkit.simulation.meeting_world import Together

        return Together(scene, way, "compiled" if compile else "interpreted")
    from wallkit.simulation.overlapping import Overlapping

    return Overlapping(scene)


def _pair(value: ArrayLike, name: str) -> FloatArray:
    may_be = "two finite numbers"
    pair = floats(value, name, may_be, error=SceneError, code="bad-ball")
    if pair.shape != (2,) or not np.isfinite(pair).all():
        raise refused(name, value, may_be, SceneError, "bad-ball")
    return pair
