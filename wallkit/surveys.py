"""``survey``: many balls, only totals."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterator
from concurrent.futures import Executor
from contextlib import AbstractContextManager, contextmanager
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from wallkit.clearance import check_starts
from wallkit.kernels.crossing import fly_sensed
from wallkit.kernels.flight import begin_all, end_all, fly_all
from wallkit.kernels.jit import compiled
from wallkit.kernels.lockstep import LANES, MOST_EDGES, ROW_SIZE, SCRATCH, Outcome, Scratch, Start, fly_in_step
from wallkit.kernels.model import LOG_STRIDE, STATE_SIZE, Model
from wallkit.kernels.queue import Queue
from wallkit.kernels.room import all_clear, all_clear_in_cells
from wallkit.kernels.wave_impact import FLOATS
from wallkit.kernels.wave_impact import LANES as WAVE
from wallkit.kernels.wavefront import COUNTS, INTEGERS, WaveScratch, fly_wave
from wallkit.modelling import Modelled
from wallkit.scene import Balls, FloatArray, Scene
from wallkit.sensing import modelled_sensors
from wallkit.simulation import START, initial_states, limits
from wallkit.threads import cores, in_threads

WORTH_A_WAVE = 2 * WAVE
"""Balls from which on a wave pays: it must stay full for a while."""
WORTH_LOCKSTEP = 100
"""Balls from which on lockstep pays: a pass over all lanes takes as long as some hundred bounces one by one."""
LOGGED = 256
"""Contacts of a ball that are kept at a time where sensors are asked for each flight."""
LEAST, MOST = 128, 8192
"""Balls that a thread takes on at once."""
AT_ONCE = 65_536
"""Balls flown in step or as a wave before threads look whether the survey was interrupted."""
Work = Callable[[], NDArray[np.int64]]
Flying = Callable[["Prepared", float, int, Outcome, int], AbstractContextManager[Work]]


@dataclass(eq=False)
class Totals:
    """What is left of a survey.

    Attributes:
        bounces: (n,) int64, of each ball.
        position: (n, 2) where each ball ended.
        velocity: (n, 2) its last velocity.
        time: (n,) when it ended.
        hits: (W,) int64, bounces of all balls by wall.
        ending: (n,) uint8, see :class:`wallkit.run.Ending`.
        crossings: (S, 2) int64, how often balls entered each sensor of the scene, and left it: crossed it against and
            along its outward normal.
    """

    bounces: NDArray[np.int64]
    position: FloatArray
    velocity: FloatArray
    time: FloatArray
    hits: NDArray[np.int64]
    ending: NDArray[np.uint8]
    crossings: NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class Prepared:
    """A scene made ready by :func:`prepare`: checked, in local coordinates, indexed.

    Attributes:
        scene: what it was made of; what is changed in it later is not seen.
        modelled: what the kernels see of it.
        order: (n,) in which the balls are flown, None for as they come.
        sensors: what the kernels see of the sensors, None where there are none.
    """

    scene: Scene
    modelled: Modelled
    order: NDArray[np.int64] | None
    sensors: Model | None = None


def prepare(scene: Scene, *, check: bool = True) -> Prepared:
    """Do once what every ``survey`` of a scene would do first: check it, and index its walls.

    Args:
        scene: walls, balls, and what acts.
        check: look whether a disc overlaps a wall at the start; False where that is known, to save the time.

    Raises:
        SceneError: the scene cannot be simulated.
    """
    return _prepared(scene, Modelled(scene, machine_code=True, fine=True), check=check)


def prepare_again(ready: Prepared, balls: Balls, *, check: bool = True) -> Prepared:
    """Prepare a scene with other balls: what was made of its walls is kept where it serves these, too."""
    scene = replace(ready.scene, balls=balls)
    modelled = ready.modelled.with_balls(balls) or Modelled(scene, machine_code=True, fine=True)
    return _prepared(scene, modelled, check=check)


def _prepared(scene: Scene, modelled: Modelled, *, check: bool) -> Prepared:
    if check and not _surely_clear(scene, modelled):
        check_starts(scene)
    order = None if modelled.model.grid is None else _neighbours_together(np.asarray(scene.balls.position))
    sensors = None
    if scene.sensors is not None and len(scene.sensors):
        sensors = modelled_sensors(scene, scene.sensors, modelled.origin).model
    return Prepared(scene, modelled, order, sensors)


def _surely_clear(scene: Scene, modelled: Modelled) -> bool:
    """Tell whether a quick look shows that no ball overlaps a wall; it does not pay for few balls among few lines."""
    model, radii = modelled.model, modelled.radii
    if model.arcs is not None or (len(radii) < WORTH_LOCKSTEP and model.grid is None):
        return False
    if not radii.any():
        return True
    if model.grid is None:
        origin = tuple(modelled.origin.tolist())
        return bool(compiled(all_clear)(model.lines, model.extent, origin, np.ravel(scene.balls.position), radii))
    position = np.asarray(scene.balls.position) - modelled.origin
    return bool(compiled(all_clear_in_cells)(model.lines, model.extent, *ball_cells(position, radii)))


def ball_cells(position: FloatArray, radii: FloatArray) -> tuple[Any, ...]:
    """Give ``all_clear_in_cells`` what it needs of balls at (n, 2) local positions, and room to work in."""
    x, y = position.T
    box = float(x.min()), float(y.min()), float(x.max() - x.min()), float(y.max() - y.min())
    return np.ravel(position), radii, box, np.zeros(2 * len(x) + 3, dtype=np.int64), np.empty(3 * len(x))


def _neighbours_together(position: FloatArray) -> NDArray[np.int64]:
    """Order places along Morton's curve: a ball then finds the cells it needs where the one before left them."""
    if not len(position):
        return np.empty(0, dtype=np.int64)
    x, y = position[:, 0] - position[:, 0].min(), position[:, 1] - position[:, 1].min()
    per_extent = 1023.0 / (max(float(x.max()), float(y.max())) or 1.0)
    return np.argsort(_spaced((x * per_extent).astype(np.int64)) | _spaced((y * per_extent).astype(np.int64)) << 1)


def _spaced(number: NDArray[np.int64]) -> NDArray[np.int64]:
    """Put a zero before each of ten bits."""
    for shift, mask in ((8, 0x300FF), (4, 0x30F0F), (2, 0x33333), (1, 0x55555)):
        number = (number | number << shift) & mask
    return number


def survey(
    scene: Scene | Prepared,
    until: float | None = None,
    bounces: int | None = None,
    *,
    threads: int | None = None,
    executor: Executor | None = None,
    check: bool = True,
) -> Totals:
    """Fly every ball until a time, a number of bounces, or an ending of its own, and keep only totals.

    Balls do not meet, so each is flown alone; the result is the same, bit for bit, for any number of threads, and
    the same as that of :func:`wallkit.simulate`. Kernels are compiled and release the interpreter's lock.

    Args:
        scene: walls, balls, and what acts; from :func:`prepare`, it is not prepared again.
        until: seconds; None for no end in time.
        bounces: bounces a ball; None for the guard of ``simulate``. At least one of the two must be given.
        threads: how many to use; None for one a core.
        executor: threads of your own to use instead (a ``ThreadPoolExecutor``).
        check: look whether a disc overlaps a wall at the start; False where that is known, to save the time.

    Raises:
        SceneError: neither limit was given, or the scene cannot be simulated.
    """
    limit_time, limit_bounces = limits(until, bounces)
    ready = scene if isinstance(scene, Prepared) else prepare(scene, check=check)
    scene, modelled = ready.scene, ready.modelled
    threads = max(1, min(cores() if threads is None else threads, len(modelled.radii) // LEAST))
    outcome = _room_for(len(modelled.radii))
    fly = _fly_one_by_one if ready.sensors is not None else _way_to_fly(modelled.model, modelled.radii)
    with fly(ready, limit_time, limit_bounces, outcome, threads) as work:
        found = sum(in_threads(work, threads, executor), _nothing_found(ready))
    hits, crossings = found[: len(scene.walls)], found[len(scene.walls) :].reshape(-1, 2)
    return Totals(outcome.bounces, outcome.position, outcome.velocity, outcome.time, hits, outcome.ending, crossings)


def _nothing_found(ready: Prepared) -> NDArray[np.int64]:
    """(W + 2 S,) of 0: bounces by wall, then for each sensor how often it was entered, and left."""
    sensors = ready.scene.sensors if ready.sensors is not None else None
    return np.zeros(len(ready.scene.walls) + 2 * len(sensors or ()), dtype=np.int64)


def _room_for(count: int) -> Outcome:
    return Outcome(
        position=np.empty((count, 2)),
        velocity=np.empty((count, 2)),
        time=np.empty(count),
        bounces=np.empty(count, dtype=np.int64),
        ending=np.empty(count, dtype=np.uint8),
    )


@contextmanager
def _fly_in_step(ready: Prepared, until: float, limit: int, outcome: Outcome, _threads: int) -> Iterator[Work]:
    """Give what a thread does to fly balls in lockstep, until none is left: bounces by wall."""
    model, start, count = ready.modelled.model, _start(ready), len(ready.modelled.radii)
    radius = float(ready.modelled.radii[0]) or None
    counter = np.zeros(1, dtype=np.int64)

    def work() -> NDArray[np.int64]:
        hits = np.zeros(len(ready.scene.walls), dtype=np.int64)
        queue, scratch = Queue(counter, np.zeros(2, dtype=np.int64)), _scratch(len(model.ids))
        for stop in (*range(AT_ONCE, count, AT_ONCE), count):
            compiled(fly_in_step)(model, radius, start, queue, stop, until, limit, hits, outcome, scratch)
        return hits

    try:
        yield work
    finally:
        counter[0] = count  # if this thread was interrupted, the others stop soon


@contextmanager
def _fly_as_waves(ready: Prepared, until: float, limit: int, outcome: Outcome, _threads: int) -> Iterator[Work]:
    """Give what a thread does to fly balls as a wave through the grid, until none is left: bounces by wall."""
    model, start, count = ready.modelled.model, _start(ready), len(ready.modelled.radii)
    radius = float(ready.modelled.radii[0]) or None
    order = np.arange(count) if ready.order is None else ready.order
    counter = np.zeros(1, dtype=np.int64)

    def work() -> NDArray[np.int64]:
        hits = np.zeros(len(ready.scene.walls), dtype=np.int64)
        queue = Queue(counter, np.zeros(2, dtype=np.int64))
        scratch = WaveScratch(np.empty(FLOATS), np.empty(INTEGERS, dtype=np.int64), np.empty(COUNTS, dtype=np.uint32))
        for stop in (*range(AT_ONCE, count, AT_ONCE), count):
            compiled(fly_wave)(model, radius, start, order, queue, stop, until, limit, hits, outcome, scratch)
        return hits

    try:
        yield work
    finally:
        counter[0] = count  # if this thread was interrupted, the others stop soon


def _start(ready: Prepared) -> Start:
    balls, modelled = ready.scene.balls, ready.modelled
    return Start(
        position=np.asarray(balls.position),
        velocity=np.asarray(balls.velocity),
        origin=tuple(modelled.origin.tolist()),
        extent=modelled.model.extent,
        box=modelled.box,
    )


def _scratch(rows: int) -> Scratch:
    return Scratch(
        lanes=np.empty(SCRATCH),
        balls=np.empty(LANES, dtype=np.uint32),
        ended=np.empty(LANES + 1, dtype=np.uint32),
        met=np.empty(LANES, dtype=np.uint32),
        rows=np.zeros((rows, ROW_SIZE)),
    )


@contextmanager
def _fly_one_by_one(ready: Prepared, until: float, limit: int, outcome: Outcome, threads: int) -> Iterator[Work]:
    """Give what a thread does to fly balls one after the other, part by part: bounces by wall, crossings by sensor."""
    modelled = ready.modelled
    order = np.arange(len(modelled.radii)) if ready.order is None else ready.order
    x0, y0 = modelled.origin.tolist()
    left = iter(_parts(len(order), threads))

    def work() -> NDArray[np.int64]:
        found = _nothing_found(ready)
        for part in left:
            balls = order[part]
            radii = modelled.radii[balls]
            states, counts = _begin(ready, balls)
            _fly(ready, radii, states, counts, until, limit, found)
            compiled(end_all)(states, counts, radii, x0, y0, modelled.box, balls, outcome)
        return found

    try:
        yield work
    finally:
        deque(left, maxlen=0)  # if this thread was interrupted, the others find no further part


def _fly(
    ready: Prepared, radii: FloatArray, states: FloatArray, counts: NDArray[np.int64], until: float, limit: int,
    found: NDArray[np.int64],
) -> None:  # fmt: skip
    model, walls = ready.modelled.model, len(ready.scene.walls)
    if ready.sensors is None:
        compiled(fly_all)(model, model.gravity, radii, states, counts, until, limit, found, np.empty(0), 1)
        return
    pull, log = None if model.gravity is None else np.empty(2), np.empty(LOGGED * LOG_STRIDE)
    compiled(fly_sensed)(
        model, model.gravity, pull, ready.sensors, walls, radii, states, counts, until, limit, found, log, LOGGED
    )


def _parts(count: int, threads: int) -> list[slice]:
    """Divide balls into parts, ever smaller ones, so that threads end together."""
    parts, first = [], 0
    while first < count:
        size = min(max((count - first) // (4 * threads), LEAST), MOST)
        parts.append(slice(first, min(first + size, count)))
        first += size
    return parts


def _way_to_fly(model: Model, radii: FloatArray) -> Flying:
    if suits_lockstep(model, radii):
        return _fly_in_step
    return _fly_as_waves if suits_wave(model, radii) else _fly_one_by_one


def suits_wave(model: Model, radii: FloatArray) -> bool:
    """An index, one radius, two-sided walls, and nothing else that acts but restitution."""
    features = (model.gravity, model.damping, model.one_sided)
    if model.grid is None or len(radii) < WORTH_A_WAVE:
        return False
    return all(feature is None for feature in features) and bool((radii == radii[0]).all())


def suits_lockstep(model: Model, radii: FloatArray) -> bool:
    """Few lines and corners, one radius, and nothing else that acts."""
    features = (model.grid, model.arcs, model.gravity, model.damping, model.restitution, model.one_sided)
    lines, corners = int(model.cells[0]["arcs"]), int(model.cells[1]["first"] - model.cells[0]["corners"])
    few = lines <= MOST_EDGES and corners <= 2 * MOST_EDGES
    if len(radii) < WORTH_LOCKSTEP or not few:
        return False
    return all(feature is None for feature in features) and bool((radii == radii[0]).all())


def _begin(ready: Prepared, balls: NDArray[np.int64]) -> tuple[FloatArray, NDArray[np.int64]]:
    position, velocity = np.asarray(ready.scene.balls.position), np.asarray(ready.scene.balls.velocity)
    modelled = ready.modelled
    if modelled.model.gravity is not None:
        states = initial_states(modelled, position[balls], velocity[balls])
        return states, np.tile(np.array(START, dtype=np.int64), (len(states), 1))
    states, counts = np.empty((len(balls), STATE_SIZE)), np.empty((len(balls), len(START)), dtype=np.int64)
    x0, y0 = modelled.origin.tolist()
    compiled(begin_all)(position, velocity, balls, x0, y0, modelled.model.extent, states, counts, START)
    return states, counts
