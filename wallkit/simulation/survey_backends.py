"""How the balls of a survey are flown: in lockstep, as a wave through the grid, or one by one; by many threads."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager
from typing import Any

import numpy as np
from numpy.typing import NDArray

from wallkit.geometry.arrays import FloatArray
from wallkit.kernels.batches import falling_columns as falling
from wallkit.kernels.batches.ball_queue import Queue
from wallkit.kernels.batches.falling_wave import fly_falling_wave
from wallkit.kernels.batches.lockstep import MOST_EDGES, fly_in_step
from wallkit.kernels.batches.lockstep_lanes import LANES, ROW_SIZE, SCRATCH, Outcome, Scratch, Start
from wallkit.kernels.batches.wave import MET, NEAR_EDGES, WAVES, WaveScratch, fly_wave
from wallkit.kernels.batches.wave_columns import COUNTS, FLOATS, INTEGERS, LISTED, MOVER
from wallkit.kernels.batches.wave_columns import LANES as WAVE
from wallkit.kernels.batches.wave_pairs import SHORT, note_short_lists
from wallkit.kernels.flight.ball_state import begin_all, end_all
from wallkit.kernels.flight.flight import fly_all
from wallkit.kernels.flight.sensors import fly_sensed
from wallkit.kernels.intrinsics import AT_ONCE as AT_ONCE_IDS
from wallkit.kernels.jit import compiled
from wallkit.kernels.records import LOG_STRIDE, STATE_SIZE, Model
from wallkit.simulation.aligned_arrays import on_cache_lines
from wallkit.simulation.modelled import Modelled
from wallkit.simulation.prepared import PreparedScene
from wallkit.simulation.simulate import START, initial_states

WORTH_A_WAVE = 2 * WAVE
"""Balls from which on a wave pays: it must stay full for a while."""
WORTH_LOCKSTEP = 100
"""Balls from which on lockstep pays: a pass over all lanes takes as long as some hundred bounces one by one."""
NEAR_LISTS = 1 << 16
"""So many cells have their short lists, of a cache line for two, near the processor."""
LOGGED = 256
"""Contacts of a ball that are kept at a time where sensors are asked for each flight."""
LEAST, MOST = 128, 8192
"""Balls that a thread takes on at once."""
AT_ONCE = 65_536
"""Balls flown in step or as a wave before threads look whether the survey was interrupted."""
Work = Callable[[], NDArray[np.int64]]
Batch = Callable[[int], Any]
Flying = Callable[[PreparedScene, float, int, Outcome, int], AbstractContextManager[Work]]


def nothing_found(ready: PreparedScene) -> NDArray[np.int64]:
    """(W + 2 S,) of 0: bounces by wall, or edge and vertex; then for each sensor how often it was entered, and left."""
    sensors = ready.scene.sensors if ready.sensors is not None else None
    return np.zeros(ready.modelled.tallies + 2 * len(sensors or ()), dtype=np.int64)


@contextmanager
def _fly_in_step(ready: PreparedScene, until: float, limit: int, outcome: Outcome, _threads: int) -> Iterator[Work]:
    """Give what a thread does to fly balls in lockstep, until none is left: counts of bounces."""
    told, start, radius = ready.modelled.told, _start(ready), _radius(ready)

    def batches(queue: Queue, hits: NDArray[np.int64]) -> Batch:
        scratch = _scratch(len(ready.modelled.model.ids))
        return lambda stop: compiled(fly_in_step)(
            *told, radius, start, queue, stop, until, limit, hits, outcome, scratch
        )

    with _from_one_counter(ready, batches) as work:
        yield work


@contextmanager
def _fly_as_waves(ready: PreparedScene, until: float, limit: int, outcome: Outcome, _threads: int) -> Iterator[Work]:
    """Give what a thread does to fly balls as a wave through the grid, until none is left: counts of bounces."""
    told, start, radius = ready.modelled.told, _start(ready), _radius(ready)
    order = np.arange(len(ready.modelled.radii)) if ready.order is None else ready.order
    lists = _short_lists(ready.modelled)

    def batches(queue: Queue, hits: NDArray[np.int64]) -> Batch:
        scratch = WaveScratch(
            on_cache_lines(WAVES * WAVE, MOVER).reshape(WAVES, WAVE),
            on_cache_lines(WAVES * FLOATS, np.float64).reshape(WAVES, FLOATS),
            on_cache_lines(WAVES * INTEGERS, np.int64).reshape(WAVES, INTEGERS),
            on_cache_lines(WAVES * COUNTS, np.uint32).reshape(WAVES, COUNTS),
            on_cache_lines(WAVES * LISTED, np.uint32).reshape(WAVES, LISTED),
            np.empty(MET, dtype=np.int64),
        )
        return lambda stop: compiled(fly_wave)(
            told[0], lists, radius, start, order, queue, stop, until, limit, hits, outcome, scratch
        )

    with _from_one_counter(ready, batches) as work:
        yield work


def _short_lists(modelled: Modelled) -> NDArray[np.uint32]:
    """What cells list where that is short, see ``note_short_lists``; nothing where that does not pay."""
    if modelled.short_lists is None:
        model, grid = modelled.model, modelled.model.grid
        cells = 0 if grid.packed or model.arcs is not None else grid.columns * grid.rows
        pays = 0 < cells <= NEAR_LISTS and len(model.lines) <= NEAR_EDGES
        lists = on_cache_lines(SHORT * cells + AT_ONCE_IDS if pays else 0, np.uint32)
        if pays:
            compiled(note_short_lists)(model.cells, model.ids, lists)
        modelled.short_lists = lists
    return modelled.short_lists


@contextmanager
def _fly_falling(ready: PreparedScene, until: float, limit: int, outcome: Outcome, _threads: int) -> Iterator[Work]:
    """Give what a thread does to fly balls as a wave under gravity, until none is left: counts of bounces."""
    told, start, radius = ready.modelled.told, _start(ready), _radius(ready)
    order = np.arange(len(ready.modelled.radii)) if ready.order is None else ready.order

    def batches(queue: Queue, hits: NDArray[np.int64]) -> Batch:
        scratch = falling.FallScratch(
            on_cache_lines(WAVE, falling.FALLER),
            on_cache_lines(falling.FLOATS, np.float64),
            on_cache_lines(falling.COUNTS, np.uint32),
            on_cache_lines(falling.LISTED, np.uint32),
            np.empty(WAVE, dtype=np.int64),
            np.empty((WAVE, STATE_SIZE)),
            np.empty((WAVE, len(START)), dtype=np.int64),
            np.empty(0),
        )
        return lambda stop: compiled(fly_falling_wave)(
            *told, radius, start, order, queue, stop, until, limit, hits, outcome, scratch
        )

    with _from_one_counter(ready, batches) as work:
        yield work


@contextmanager
def _from_one_counter(ready: PreparedScene, batches: Callable[[Queue, NDArray[np.int64]], Batch]) -> Iterator[Work]:
    """Give what a thread does that takes its balls from a counter shared by all, batch by batch: counts of bounces."""
    count, counter = len(ready.modelled.radii), np.zeros(1, dtype=np.int64)

    def work() -> NDArray[np.int64]:
        hits = np.zeros(ready.modelled.tallies, dtype=np.int64)
        fly_below = batches(Queue(counter, np.zeros(2, dtype=np.int64)), hits)
        for stop in (*range(AT_ONCE, count, AT_ONCE), count):
            fly_below(stop)
        return hits

    try:
        yield work
    finally:
        counter[0] = count  # if this thread was interrupted, the others stop soon


def _radius(ready: PreparedScene) -> float | None:
    """The one radius of all balls; None for points."""
    return float(ready.modelled.radii[0]) or None


def _start(ready: PreparedScene) -> Start:
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
        lanes=on_cache_lines(SCRATCH, np.float64),
        balls=np.empty(LANES, dtype=np.uint32),
        ended=np.empty(LANES + 1, dtype=np.uint32),
        met=np.empty(LANES, dtype=np.uint32),
        rows=np.zeros((rows, ROW_SIZE)),
        state=np.zeros(STATE_SIZE),
        counts=np.zeros(len(START), dtype=np.int64),
        log=np.empty(0),
    )


@contextmanager
def _fly_one_by_one(ready: PreparedScene, until: float, limit: int, outcome: Outcome, threads: int) -> Iterator[Work]:
    """Give what a thread does to fly balls one after the other, part by part: counts of bounces, then of crossings."""
    modelled = ready.modelled
    order = np.arange(len(modelled.radii)) if ready.order is None else ready.order
    x0, y0 = modelled.origin.tolist()
    left = iter(_parts(len(order), threads))

    def work() -> NDArray[np.int64]:
        found = nothing_found(ready)
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
    ready: PreparedScene, radii: FloatArray, states: FloatArray, counts: NDArray[np.int64], until: float, limit: int,
    found: NDArray[np.int64],
) -> None:  # fmt: skip
    told, tallies = ready.modelled.told, ready.modelled.tallies
    if ready.sensors is None:
        compiled(fly_all)(*told, radii, states, counts, until, limit, found, np.empty(0), 1)
        return
    pull, log = None if ready.modelled.model.gravity is None else np.empty(2), np.empty(LOGGED * LOG_STRIDE)
    compiled(fly_sensed)(*told, pull, ready.sensors, tallies, radii, states, counts, until, limit, found, log, LOGGED)


def _parts(count: int, threads: int) -> list[slice]:
    """Divide balls into parts, ever smaller ones, so that threads end together."""
    parts, first = [], 0
    while first < count:
        size = min(max((count - first) // (4 * threads), LEAST), MOST)
        parts.append(slice(first, min(first + size, count)))
        first += size
    return parts


def way_to_fly(ready: PreparedScene) -> Flying:
    """Choose the fastest way that does all that acts in a scene; all give the same bits."""
    model, radii = ready.modelled.model, ready.modelled.radii
    if ready.sensors is not None:
        return _fly_one_by_one
    if suits_lockstep(model, radii):
        return _fly_in_step
    if suits_wave(model, radii):
        return _fly_as_waves if model.gravity is None else _fly_falling
    return _fly_one_by_one


def suits_wave(model: Model, radii: FloatArray) -> bool:
    """An index, one radius, and no drag under gravity, which bends paths too much."""
    if model.grid is None or model.drag is not None or len(radii) < WORTH_A_WAVE:
        return False
    return bool((radii == radii[0]).all())


def suits_lockstep(model: Model, radii: FloatArray) -> bool:
    """Few lines and corners, and one radius; drag under gravity alone bends paths too much."""
    features = (model.grid, model.arcs, model.drag)
    lines, corners = int(model.cells[0]["arcs"]), int(model.cells[0]["end"] - model.cells[0]["corners"])
    few = lines <= MOST_EDGES and corners <= 2 * MOST_EDGES
    if len(radii) < WORTH_LOCKSTEP or not few:
        return False
    return all(feature is None for feature in features) and bool((radii == radii[0]).all())


def _begin(ready: PreparedScene, balls: NDArray[np.int64]) -> tuple[FloatArray, NDArray[np.int64]]:
    position, velocity = np.asarray(ready.scene.balls.position), np.asarray(ready.scene.balls.velocity)
    modelled = ready.modelled
    if modelled.model.gravity is not None:
        states = initial_states(modelled, position[balls], velocity[balls])
        return states, np.tile(np.array(START, dtype=np.int64), (len(states), 1))
    states, counts = np.empty((len(balls), STATE_SIZE)), np.empty((len(balls), len(START)), dtype=np.int64)
    x0, y0 = modelled.origin.tolist()
    compiled(begin_all)(position, velocity, balls, x0, y0, modelled.model.extent, states, counts, START)
    return states, counts
