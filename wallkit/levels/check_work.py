"""The work of a check: balls fly until they reach the target, and what they do else is watched."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from wallkit.geometry.arrays import FloatArray
from wallkit.kernels.batches.lockstep_lanes import Outcome
from wallkit.kernels.flight.ball_state import end_all
from wallkit.kernels.flight.watch import OTHER, REGULAR, REPEATS, ROWS, SLOW, Watch, fly_watched
from wallkit.kernels.jit import compiled
from wallkit.kernels.records import LOG_STRIDE, in_lists
from wallkit.levels.check_counts import LISTED, TRAP, TRAPS, CheckCounts, Fate
from wallkit.levels.goals import Goal
from wallkit.levels.statistics import bins_of
from wallkit.simulation.counts import Counts, ticks_of
from wallkit.simulation.modelled import Modelled
from wallkit.simulation.run import Ending
from wallkit.simulation.sensors import modelled_sensors
from wallkit.simulation.simulate import START, initial_states
from wallkit.simulation.survey import survey
from wallkit.simulation.work import Work
from wallkit.walls import Walls

SQUARES = 64
"""Squares on the longer side of the level."""
COVERING = 1000
"""Balls, those of the lowest numbers, of which every place is counted: that takes as long as flying."""
PATIENCE = 20_000
"""Bounces up to which interpreting takes less than compiling."""
NEVER = 2**61
_LIMITS = (Ending.TIME_REACHED, Ending.BOUNCE_LIMIT)


@dataclass(frozen=True, slots=True)
class Squares:
    """Squares over the box of some walls.

    Attributes:
        x0: where they begin, with y0.
        y0: see x0.
        side: of each.
        columns: how many beside one another.
        rows: how many one above the other.
    """

    x0: float
    y0: float
    side: float
    columns: int
    rows: int

    @staticmethod
    def over(walls: Walls) -> Squares:
        """Cover the box of the walls' edges."""
        x0, y0, x1, y1 = walls.straightened(1e-3 * max(walls.box()[2:])).box() if walls.has_arcs else walls.box()
        side = max(x1 - x0, y1 - y0) / SQUARES or 1.0
        return Squares(x0, y0, side, max(1, math.ceil((x1 - x0) / side)), max(1, math.ceil((y1 - y0) / side)))

    def at(self, position: FloatArray) -> NDArray[np.int64]:
        """Give the square of each of (n, 2) places, the nearest one for those outside."""
        column = np.clip((position[:, 0] - self.x0) / self.side, 0, self.columns - 1).astype(np.int64)
        row = np.clip((position[:, 1] - self.y0) / self.side, 0, self.rows - 1).astype(np.int64)
        return row * self.columns + column


class CheckWork(Work[CheckCounts]):
    """A check: balls come to :class:`CheckCounts`."""

    def __init__(self, scene: Any, draw: Any, until: float | None, bounces: int | None, goal: Goal | None) -> None:
        """Take a scene as ``Work`` does, and what is to be reached, if anything."""
        super().__init__(replace(scene, sensors=None), draw, until, bounces)
        self.goal = goal
        self.squares = Squares.over(scene.walls)

    def words(self) -> tuple[object, ...]:
        """Limits and target."""
        goal = self.goal
        sensors = (
            None
            if goal is None or goal.sensors is None
            else (goal.sensors.vertices.tobytes(), goal.sensors.bulges.tobytes(), goal.sensors.offsets.tobytes())
        )
        return (*super().words(), sensors, () if goal is None else goal.edges)

    def read(self, value: dict[str, Any]) -> CheckCounts:
        """Read counts."""
        return CheckCounts.of_json(value)

    def fly(self, first: int, count: int) -> CheckCounts:
        """Fly balls ``first`` to ``first + count`` on this thread.

        Where nothing is to be reached only the first are watched, for the places they pass; a survey counts the rest.
        """
        watched = count if self.goal is not None else max(0, min(count, COVERING - first))
        parts = [self._watched(first, watched)] if watched else []
        if watched < count:
            parts.append(self._surveyed(first + watched, count - watched))
        return parts[0] if len(parts) == 1 else parts[0] + parts[1]

    def _surveyed(self, first: int, count: int) -> CheckCounts:
        totals = survey(self.prepared(first, count), self.until, self.bounces, threads=1, by_edge=True)
        fate = _fates(np.zeros(count, dtype=np.bool_), totals.ending, np.full(count, SLOW))
        outcome = Outcome(totals.position, totals.velocity, totals.time, totals.bounces, totals.ending)
        return self._gathered(Counts.of(totals), fate, outcome, first, None)

    def _watched(self, first: int, count: int) -> CheckCounts:
        ready = self.prepared(first, count)
        modelled, balls = ready.modelled.by_edge(), ready.scene.balls
        limit = NEVER if self.bounces is None else self.bounces
        until = math.inf if self.until is None else self.until
        watch = self._watch(modelled, balls.position)
        states = initial_states(modelled, balls.position, balls.velocity)
        counts = np.tile(np.array(START, dtype=np.int64), (count, 1))
        hits = np.zeros(modelled.tallies, dtype=np.int64)
        model = modelled.model
        slowed = any(rate is not None for rate in (model.damping, model.rolling, model.drag))
        lasting = int(not slowed and self.goal is not None)
        if count * limit <= PATIENCE:
            _interpret(modelled, lasting, watch, states, counts, first, until, limit, hits)
        else:
            model = modelled.model
            compiled(fly_watched)(
                model, model.gravity, lasting, watch, modelled.radii, states, counts, first + 1, until, limit, hits
            )
        return self._counted(modelled, watch, states, counts, first, hits)

    def _watch(self, modelled: Modelled, position: FloatArray) -> Watch:
        count, tallies, squares, goal = len(position), modelled.tallies, self.squares, self.goal
        target = np.zeros(tallies, dtype=np.uint8)
        time = np.full(count, math.inf)
        sensors = None
        if goal is not None:
            target[list(goal.edges)] = 1
            time[goal.inside(position)] = 0.0
            if goal.sensors is not None:
                sensors = modelled_sensors(self.scene, goal.sensors, modelled.origin).model
        x0, y0 = squares.x0 - modelled.origin[0], squares.y0 - modelled.origin[1]
        cells = squares.columns * squares.rows
        return Watch(
            sensors=sensors,
            pull=None if modelled.model.gravity is None else np.zeros(2),
            target=target,
            aims=int(target.any()),
            cells=(float(x0), float(y0), 1.0 / squares.side, squares.columns, squares.rows),
            visits=np.zeros(cells, dtype=np.int64),
            stamps=np.zeros(cells, dtype=np.int64),
            marks=np.zeros(2 * tallies, dtype=np.int64),
            log=np.zeros(ROWS * LOG_STRIDE),
            covering=COVERING + 1,
            time=time,
            met=np.zeros(count, dtype=np.int64),
            kind=np.full(count, OTHER, dtype=np.int64),
            norm=np.full(count, math.inf),
            period=np.zeros(count, dtype=np.int64),
            word=np.zeros(count, dtype=np.int64),
        )

    def _counted(
        self, modelled: Modelled, watch: Watch, states: FloatArray, counts: NDArray[np.int64], first: int,
        hits: NDArray[np.int64],
    ) -> CheckCounts:  # fmt: skip
        count = len(states)
        outcome = Outcome(
            np.empty((count, 2)), np.empty((count, 2)), np.empty(count), np.empty(count, dtype=np.int64),
            np.empty(count, dtype=np.uint8),
        )  # fmt: skip
        x0, y0 = modelled.origin.tolist()
        compiled(end_all)(states, counts, modelled.radii, x0, y0, modelled.box, np.arange(count), outcome)
        reached = watch.time < math.inf
        outcome.time[reached], outcome.bounces[reached] = watch.time[reached], watch.met[reached]
        edges = len(modelled.model.edge_wall)
        counted = Counts(
            count, int(outcome.bounces.sum()), ticks_of(outcome.time),
            np.bincount(outcome.ending[~reached], minlength=len(Ending)).astype(np.int64),
            hits[:edges], hits[edges:], np.zeros((0, 2), dtype=np.int64),
        )  # fmt: skip
        return self._gathered(counted, _fates(reached, outcome.ending, watch.kind), outcome, first, watch)

    def _gathered(
        self, counts: Counts, fate: NDArray[np.int64], outcome: Outcome, first: int, watch: Watch | None
    ) -> CheckCounts:
        """Gather what became of balls ``first`` and following; without a watch nobody looked where they went."""
        squares = self.squares
        shape, none = (squares.rows, squares.columns), np.zeros((squares.rows, squares.columns), dtype=np.int64)
        slow, reached = np.flatnonzero(fate == Fate.SLOW), fate == Fate.REACHED
        resting = squares.at(outcome.position)[fate == Fate.AT_REST]
        return CheckCounts(
            counts=counts,
            fates=np.bincount(fate, minlength=len(Fate)).astype(np.int64),
            visits=none if watch is None else np.asarray(watch.visits).reshape(shape),
            rests=np.bincount(resting, minlength=none.size).astype(np.int64).reshape(shape),
            times=bins_of(outcome.time[reached]),
            met=bins_of(outcome.bounces[reached].astype(np.float64)),
            least_time=float(outcome.time[slow].min(initial=math.inf)),
            least_bounces=int(outcome.bounces[slow].min(initial=NEVER)),
            first_slow=first + int(slow[0]) if len(slow) else -1,
            traps=_listed(fate, outcome.position, watch, first),
        )


def _interpret(
    modelled: Modelled, lasting: int, watch: Watch, states: FloatArray, counts: NDArray[np.int64], first: int,
    until: float, limit: int, hits: NDArray[np.int64],
) -> None:  # fmt: skip
    """Fly a few balls without waiting for a compiler: with Python's numbers, and the same bits."""
    model, many, numbers = modelled.lists, states.tolist(), counts.tolist()
    lists = watch._replace(
        sensors=in_lists(watch.sensors),
        **{name: getattr(watch, name).tolist() for name in ("time", "norm")},
        pull=in_lists(watch.pull),
        log=memoryview(watch.log),
    )
    radii = modelled.radii.tolist()
    fly_watched(model, model.gravity, lasting, lists, radii, many, numbers, first + 1, until, limit, hits)
    states[:], counts[:], watch.time[:], watch.norm[:] = many, numbers, lists.time, lists.norm


def _fates(reached: NDArray[np.bool_], ending: NDArray[np.uint8], kind: NDArray[np.int64]) -> NDArray[np.int64]:
    """(n,) what became of each ball."""
    fate = np.full(len(reached), Fate.AT_REST, dtype=np.int64)
    fate[ending == Ending.AMBIGUOUS_CORNER] = Fate.UNDECIDED
    for code, what in ((SLOW, Fate.SLOW), (REGULAR, Fate.REGULAR), (REPEATS, Fate.REPEATS)):
        fate[np.isin(ending, _LIMITS) & (kind == code)] = what
    fate[ending == Ending.LEFT_SCENE] = Fate.LEFT
    fate[reached] = Fate.REACHED
    return fate


def _listed(fate: NDArray[np.int64], position: FloatArray, watch: Watch | None, first: int) -> NDArray[Any]:
    chosen = np.flatnonzero(np.isin(fate, TRAPS))[:LISTED]
    traps = np.zeros(len(chosen), dtype=TRAP)
    traps["ball"], traps["fate"] = first + chosen, fate[chosen]
    traps["x"], traps["y"] = position[chosen].T
    traps["norm"] = math.inf
    for name in ("norm", "period", "word") if watch is not None else ():
        traps[name] = getattr(watch, name)[chosen]
    return traps
