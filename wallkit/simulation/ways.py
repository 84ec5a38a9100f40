"""Ways to be wrong, seen: a scene stepped by frames, where it parts from its exact run, and what it flew through."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, get_args

import numpy as np
from numpy.typing import ArrayLike, NDArray

from wallkit.arguments import ABOVE_0, number, of_type, word
from wallkit.geometry.arrays import FloatArray
from wallkit.scene.scene import Scene, SceneError
from wallkit.scene.start_overlaps import TOUCHING
from wallkit.simulation.damping import damping_of, slowing_of
from wallkit.simulation.motion import Motion
from wallkit.simulation.run import ContactKind, Ending, Run
from wallkit.simulation.world import Way, World

if TYPE_CHECKING:
    from collections.abc import Iterator

    from wallkit.simulation.sensors import Sensors
    from wallkit.walls import Walls

WRONG = 0.01
"""A ball is somewhere else when it is off by this part of the scene's size: some seven pixels where that is drawn 700
pixels wide, which the eye sees, and far more than any rounding."""
MOST_FRAMES = 200_000
"""Of all balls together: some ten seconds of work, and a thousand frames a second for three minutes of one ball."""


@dataclass(frozen=True, slots=True, eq=False)
class Stepped:
    """A scene as a program that steps by frames has it.

    Attributes:
        scene: what was stepped.
        way: how contacts within a frame are treated, see :class:`~wallkit.World`.
        dt: seconds that a frame lasts.
        time: (F,) seconds at which frames end; the first is the start, at 0.
        state: (F, n, 4) x, y, vx, vy of each ball then.
        contacts: of all frames, of ``wallkit.CONTACT``.
    """

    scene: Scene
    way: Way
    dt: float
    time: FloatArray
    state: FloatArray
    contacts: NDArray[Any]

    def shown(self, time: ArrayLike) -> FloatArray:
        """States at times of the shape S, as such a program shows them: those of the latest frame. S + (n, 4)."""
        frame = np.searchsorted(self.time, np.asarray(time, dtype=np.float64), side="right") - 1
        states: FloatArray = self.state[np.clip(frame, 0, len(self.time) - 1)]
        return states

    def partings(self, run: Run) -> list[Parting]:
        """Find where balls part from an exact run of the same scene, see :func:`partings`."""
        of_type(run, "run", Run, "a Run", error=SceneError, code="bad-argument")
        return partings(run, self)

    def flown_through(self) -> list[FlownThrough]:
        """Find the first wall that each ball went through, see :func:`flown_through`."""
        return flown_through(self)


@dataclass(frozen=True, slots=True)
class Parting:
    """The first frame at which a ball is somewhere else than its exact run says.

    Attributes:
        ball: its number.
        time: of the frame.
        place: (x, y) of the ball in that frame.
        exact: (x, y) of the exact ball then.
    """

    ball: int
    time: float
    place: tuple[float, float]
    exact: tuple[float, float]

    @property
    def distance(self) -> float:
        """Between the two, in the scene's units."""
        return float(np.hypot(self.place[0] - self.exact[0], self.place[1] - self.exact[1]))


@dataclass(frozen=True, slots=True)
class FlownThrough:
    """The first wall that a ball's centre went through between two frames.

    Attributes:
        ball: its number.
        time: of the frame after it.
        place: (x, y) on the wall.
        wall: its number.
        lost: the ball is outside of the box of all walls at the end.
    """

    ball: int
    time: float
    place: tuple[float, float]
    wall: int
    lost: bool


def step_through(scene: Scene, way: Way, dt: float, until: float) -> Stepped:
    """Step a scene by frames of ``dt`` to the last one that ends by ``until``.

    Args:
        scene: walls, balls, and what acts; sensors are not asked.
        way: how contacts within a frame are treated, see :class:`~wallkit.World`. What acts between contacts acts
            exactly in all of them, so that nothing but the treatment of contacts tells them apart.
        dt: seconds of a frame, above 0.
        until: seconds, 0 or more.

    Raises:
        SceneError: an argument is none of what may be, there are more than :data:`MOST_FRAMES`, or the scene cannot be
            stepped that way (balls that meet are only known to ``"exact"``).
    """
    of_type(scene, "scene", Scene, "a Scene", error=SceneError, code="bad-scene")
    word(way, "way", get_args(Way), error=SceneError, code="bad-way")
    dt = number(dt, "dt", "finite seconds above 0", error=SceneError, code="bad-step", least=ABOVE_0)
    until = number(until, "until", "finite seconds, 0 or more", error=SceneError, code="bad-limit", least=0.0)
    most = MOST_FRAMES // max(len(scene.balls), 1)
    if until / dt >= most:
        raise SceneError(
            f"{until:g} s in frames of {dt:g} s are more than {most:,} frames",
            code="too-many-frames",
            fix="give a longer dt, a shorter run or fewer balls",
        )
    world = World(replace(scene, sensors=None), way)
    time, state, contacts = [0.0], [_state(world)], []
    for _ in range(int(until / dt)):
        contacts.append(world.step(dt))
        time.append(world.time)
        state.append(_state(world))
    found = [part for part in contacts if len(part)]
    joined = np.concatenate(found) if found else world.step(0.0)[:0]
    return Stepped(scene, way, dt, np.array(time), np.array(state), joined)


def _state(world: World) -> FloatArray:
    return np.hstack([world.position, world.velocity])


def partings(run: Run, stepped: Stepped) -> list[Parting]:
    """Find where balls part from their exact run: by more than :data:`WRONG` of the scene's size, at a frame's end.

    A run that ended at a limit of bounces is not looked at beyond that. Balls that never part are left out.
    """
    limit = WRONG * size_of(run.scene.walls)
    exact = _exact_places(run, stepped.time)
    off = np.hypot(*np.moveaxis(stepped.state[:, :, 0:2] - exact, -1, 0))
    known = stepped.time[:, None] <= run.final["time"]
    known |= np.array([ending is Ending.AT_REST for ending in run.ending], dtype=np.bool_) | _flies_off(run)
    apart = known & (off > limit)
    first = apart.argmax(axis=0)
    found = []
    for ball in np.flatnonzero(apart.any(axis=0)).tolist():
        frame = int(first[ball])
        x, y = stepped.state[frame, ball, 0:2].tolist()
        u, v = exact[frame, ball].tolist()
        found.append(Parting(ball, float(stepped.time[frame]), (x, y), (u, v)))
    return found


def _flies_off(run: Run) -> NDArray[np.bool_]:
    """(n,) balls that left the scene, and that nothing slows down: where they are later is known, too."""
    free = damping_of(run.scene) is None and slowing_of(run.scene).drag is None
    return np.array([free and ending is Ending.LEFT_SCENE for ending in run.ending], dtype=np.bool_)


def _exact_places(run: Run, times: FloatArray) -> FloatArray:
    """(F, n, 2) places of a run, of a ball that left the scene beyond its end, too: p + v s + g s^2 / 2."""
    places = run.position(times)
    gravity = np.array(run.scene.gravity or (0.0, 0.0))
    for ball in np.flatnonzero(_flies_off(run)).tolist():
        last = run.final[ball]
        span = np.maximum(times - last["time"], 0.0)[:, None]
        velocity = np.array([last["vx"], last["vy"]])
        places[:, ball] += span * (velocity + 0.5 * span * gravity)
    return places


def last_moment(run: Run) -> float:
    """When there is nothing more to see of a run: its end, or, of what left the scene, one width of that later."""
    size = size_of(run.scene.walls)
    speed = np.hypot(run.final["vx"], run.final["vy"])
    more = np.divide(size, speed, out=np.zeros(len(speed)), where=_flies_off(run) & (speed > 0.0))
    return float((run.final["time"] + more).max(initial=0.0))


def size_of(walls: Walls) -> float:
    """The larger side of the walls' box, 1 where they have none."""
    low_x, low_y, high_x, high_y = walls.straightened().box()  # with what arcs bow beyond their ends
    return max(high_x - low_x, high_y - low_y) or 1.0


def flown_through(stepped: Stepped) -> list[FlownThrough]:
    """Find the first wall that each ball's centre went through; balls that went through none are left out.

    The ways ``"exact"`` and ``"stop"`` put balls only where they get without a wall between. In the others a ball goes
    straight, from its contact (``"full-step"``) or from where the frame began, to where the frame ends: what it crosses
    there it went through. A wall that is solid from outside alone may be left.
    """
    if stepped.way in ("exact", "stop") or not len(stepped.scene.walls):
        return []
    from wallkit.simulation.sensors import Sensors

    scene, found = stepped.scene, []
    points = np.asarray(scene.balls.radius) == 0.0
    straight = Sensors(Scene(scene.walls), scene.walls)
    free = Sensors(scene, scene.walls) if stepped.way == "overlap" and points.any() else None
    x0, y0, x1, y1 = scene.walls.straightened().box()  # with what arcs bow beyond their ends
    for ball in range(len(points)):
        ways = _chords(stepped, straight, ball) if free is None or not points[ball] else _flight(stepped, free, ball)
        if (row := next(ways, None)) is not None:
            frame = min(int(np.searchsorted(stepped.time, row[0])), len(stepped.time) - 1)
            x, y = stepped.state[-1, ball, 0:2].tolist()
            lost = not (x0 <= x <= x1 and y0 <= y <= y1)
            place = float(row[2]), float(row[3])
            found.append(FlownThrough(ball, float(stepped.time[frame]), place, int(row[10]), lost))
    return found


def _flight(stepped: Stepped, asked: Sensors, ball: int) -> Iterator[tuple[Any, ...]]:
    """All walls that a point crosses under the overlap test: it flies as if there were none."""
    motion = Motion.of(stepped.scene, stepped.state[0])
    for row in asked.crossings_on(ball, motion, ball, 0.0, float(stepped.time[-1])):
        if _stops(stepped.scene.walls, row):
            yield row


def _chords(stepped: Stepped, asked: Sensors, ball: int) -> Iterator[tuple[Any, ...]]:
    """All walls strictly between two places one after the other; where frames without contact are free, not of those.

    A place within rounding (:data:`TOUCHING`) of a wall is on it: the ball was turned there, or is turned next.
    """
    own = stepped.contacts[stepped.contacts["ball"] == ball]
    last = np.minimum(np.searchsorted(stepped.time, own["time"]), len(stepped.time) - 1)
    met = dict(zip(last.tolist(), own, strict=True))
    near = TOUCHING * size_of(stepped.scene.walls)
    for frame in range(1, len(stepped.time)) if stepped.way == "overlap" else sorted(met):
        begin, end = stepped.state[frame - 1, ball, 0:2], stepped.state[frame, ball, 0:2]
        if stepped.way == "full-step":
            begin = np.array([met[frame]["x"], met[frame]["y"]])
        length = float(np.hypot(*(end - begin)))
        for row in asked.crossings(ball, 0.0, np.concatenate([begin, end - begin]), 1.0, np.zeros(2)):
            if near < row[0] * length < length - near and _stops(stepped.scene.walls, row):
                yield (float(stepped.time[frame]), *row[1:])


def _stops(walls: Walls, row: tuple[Any, ...]) -> bool:
    """Tell whether a wall is solid for a ball that crosses it so."""
    return bool(row[12] == ContactKind.ENTER or walls.sides[row[10]] == "both")


def sentence(stepped: Stepped, parted: list[Parting], through: list[FlownThrough]) -> str:
    """Say for people when and where balls part from their exact runs, and what they went through."""
    words = [_parted_words(stepped, parted), *([_through_words(stepped, through)] if through else [])]
    return f"{stepped.way} in frames of {stepped.dt:.4g} s: {'; '.join(words)}"


def _parted_words(stepped: Stepped, parted: list[Parting]) -> str:
    balls, units = stepped.state.shape[1], stepped.scene.walls.units or "units"
    if not parted:
        return f"never {100 * WRONG:g} % of the drawing off the exact path, up to {stepped.time[-1]:.6g} s"
    first = min(parted, key=_when)
    x, y = first.place
    where = f"at {first.time:.6g} s at ({x:.6g}, {y:.6g}), {first.distance:.3g} {units} off"
    if balls == 1:
        return f"parts from the exact path {where}"
    return f"{len(parted):,} of {balls:,} balls part from their exact paths, the first (ball {first.ball}) {where}"


def _through_words(stepped: Stepped, through: list[FlownThrough]) -> str:
    first, lost = min(through, key=_when), sum(each.lost for each in through)
    name = stepped.scene.walls.names[first.wall]
    wall = f"wall {first.wall}{f' ({name})' if name else ''} at {first.time:.6g} s"
    if stepped.state.shape[1] == 1:
        return f"goes through {wall}" + (", and is lost" if lost else "")
    return f"{len(through):,} through walls, the first (ball {first.ball}) through {wall}" + (
        f"; {lost:,} lost" if lost else ""
    )


def _when(event: Parting | FlownThrough) -> tuple[float, int]:
    return event.time, event.ball
