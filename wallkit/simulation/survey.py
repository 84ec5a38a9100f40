"""``survey``: many balls, only totals."""

from __future__ import annotations

import concurrent.futures
from collections.abc import Sequence
from concurrent.futures import Executor, ThreadPoolExecutor
from dataclasses import dataclass, replace
from typing import Any, overload

import numpy as np
from numpy.typing import NDArray

from wallkit.arguments import flag, of_type, whole_number
from wallkit.geometry.arrays import FloatArray
from wallkit.kernels.batches.lockstep_lanes import Outcome
from wallkit.scene.scene import Scene, SceneError
from wallkit.simulation.meeting_rules import refuse_meeting
from wallkit.simulation.meeting_survey import fly_together, survey_each
from wallkit.simulation.prepared import PreparedScene, prepare_once
from wallkit.simulation.run import Ending
from wallkit.simulation.simulate import limits
from wallkit.simulation.survey_backends import LEAST, way_to_fly
from wallkit.simulation.threads import cores, in_threads
from wallkit.walls import Walls


@dataclass(eq=False, repr=False)
class SurveyTotals:
    """What is left of a survey.

    Attributes:
        bounces: (n,) int64, of each ball; where two balls meet, one for each of them.
        position: (n, 2) where each ball ended.
        velocity: (n, 2) its last velocity.
        time: (n,) when it ended.
        hits: (W,) int64, bounces of all balls by wall.
        edge_hits: (E,) int64, the same by edge, in the order of all walls' edges, where asked for; else None.
        vertex_hits: (V,) int64, bounces off vertices, which discs alone meet and which are no edge's; likewise.
        ending: (n,) uint8, see :class:`wallkit.simulation.run.Ending`.
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
    edge_hits: NDArray[np.int64] | None = None
    vertex_hits: NDArray[np.int64] | None = None

    def __repr__(self) -> str:
        counts = np.bincount(self.ending, minlength=len(Ending))
        parts = [
            f"{len(self.bounces):,} ball{'' if len(self.bounces) == 1 else 's'}",
            f"{int(self.bounces.sum()):,} bounces in {float(self.time.max(initial=0.0)):.6g} s",
            *(f"{Ending(code).label} {counts[code]:,}" for code in np.argsort(-counts, kind="stable") if counts[code]),
        ]
        return f"<SurveyTotals: {', '.join(parts)}>"


@overload
def survey(
    scene: Scene | PreparedScene,
    until: float | None = None,
    bounces: int | None = None,
    *,
    threads: int | None = None,
    executor: Executor | None = None,
    check: bool = True,
    by_edge: bool = False,
) -> SurveyTotals: ...


@overload
def survey(
    scene: Sequence[Scene | PreparedScene],
    until: float | None = None,
    bounces: int | None = None,
    *,
    threads: int | None = None,
    executor: Executor | None = None,
    check: bool = True,
    by_edge: bool = False,
) -> list[SurveyTotals]: ...


def survey(
    scene: Scene | PreparedScene | Sequence[Scene | PreparedScene],
    until: float | None = None,
    bounces: int | None = None,
    *,
    threads: int | None = None,
    executor: Executor | None = None,
    check: bool = True,
    by_edge: bool = False,
) -> SurveyTotals | list[SurveyTotals]:
    """Fly every ball until a time, a number of bounces, or an ending of its own, and keep only totals.

    Balls that do not meet are flown each alone. Those that meet (``Scene(meeting=True)``) are flown together, on one
    thread; of a list of scenes each is a piece of work for a thread. The result is the same, bit for bit, for any
    number of threads, and the same as that of :func:`wallkit.simulate`. Kernels are compiled and release the
    interpreter's lock.

    Args:
        scene: walls, balls, and what acts; from :func:`prepare`, it is not prepared again. Or a list of such.
        until: seconds; None for no end in time.
        bounces: bounces a ball; None for the guard of ``simulate``. At least one of the two must be given.
        threads: how many to use; None for one a core.
        executor: threads of your own to use instead (a ``concurrent.futures.ThreadPoolExecutor``). The balls' totals
            are written into memory that all threads share, so that processes cannot take their place.
        check: look whether a disc overlaps a wall at the start; False where that is known, to save the time.
        by_edge: count bounces by edge and by vertex too.

    Returns:
        The totals; of a list of scenes a list, in their order.

    Raises:
        SceneError: neither limit was given, an argument is none of what may be, or the scene cannot be simulated.
    """
    end = limits(until, bounces)
    threads = check_threads(threads)
    _check_executor(executor)
    flag(by_edge, "by_edge", error=SceneError, code="bad-argument")
    many: list[Any] = list(scene) if isinstance(scene, list | tuple) else [scene]
    for one in many:
        may_be = "a Scene, or what prepare() made of one, or a list of such"
        of_type(one, "scene", (Scene, PreparedScene), may_be, error=SceneError, code="bad-scene")
    ready = [one if isinstance(one, PreparedScene) else prepare_once(one, *end, check=check) for one in many]
    if not isinstance(scene, list | tuple):
        return _survey_of(ready[0], end, threads, executor, by_edge)

    def alone(one: PreparedScene) -> SurveyTotals:
        return _survey_of(one, end, 1, None, by_edge)

    return survey_each(ready, alone, cores() if threads is None else threads, executor)


def _survey_of(
    ready: PreparedScene, end: tuple[float, int], threads: int | None, executor: Executor | None, by_edge: bool
) -> SurveyTotals:
    """Give the totals of one scene; ``end`` is a time and a number of bounces."""
    limit_time, limit_bounces = end
    if by_edge:
        ready = replace(ready, modelled=ready.modelled.by_edge())
    modelled = ready.modelled
    threads = max(1, min(cores() if threads is None else threads, len(modelled.radii) // LEAST))
    outcome = _room_for(len(modelled.radii))
    if ready.scene.meeting:
        if by_edge:
            refuse_meeting(ready.scene, "a count by edge")
        found = fly_together(ready, limit_time, limit_bounces, outcome)
        return _totals(ready, outcome, found, by_edge)
    with way_to_fly(ready)(ready, limit_time, limit_bounces, outcome, threads) as work:
        found, *others = in_threads(work, threads, executor)
    for other in others:
        found += other
    return _totals(ready, outcome, found, by_edge)


def _totals(ready: PreparedScene, outcome: Outcome, found: NDArray[np.int64], by_edge: bool) -> SurveyTotals:
    walls, tallies = ready.scene.walls, ready.modelled.tallies
    hits, crossings = found[:tallies], found[tallies:].reshape(-1, 2)
    totals = SurveyTotals(
        outcome.bounces, outcome.position, outcome.velocity, outcome.time, hits, outcome.ending, crossings
    )
    if by_edge:
        totals.edge_hits, totals.vertex_hits = hits[: len(walls.edge_starts)], hits[len(walls.edge_starts) :]
        totals.hits = hits_by_wall(walls, totals.edge_hits, totals.vertex_hits)
    return totals


def hits_by_wall(walls: Walls, edge_hits: NDArray[np.int64], vertex_hits: NDArray[np.int64]) -> NDArray[np.int64]:
    """(W,) bounces by wall, of those by edge and by vertex."""
    hits = np.zeros(len(walls), dtype=np.int64)
    np.add.at(hits, np.repeat(np.arange(len(walls)), np.diff(walls.edge_offsets)), edge_hits)
    np.add.at(hits, np.repeat(np.arange(len(walls)), np.diff(walls.offsets)), vertex_hits)
    return hits


def check_threads(threads: int | None) -> int | None:
    """Return how many threads are wanted, None for one a core; refuse anything else."""
    may_be = "a whole number, 1 or more, or None for one a core"
    if threads is None:
        return None
    return whole_number(threads, "threads", may_be, error=SceneError, code="bad-threads", least=1)


def _check_executor(executor: object) -> None:
    """Refuse what does not run in this process: there the work would fill a copy of the totals, and ours stay empty.

    An InterpreterPoolExecutor (Python 3.14) is a ThreadPoolExecutor by its class, and copies all the same.
    """
    if executor is None:
        return
    copies = getattr(concurrent.futures, "InterpreterPoolExecutor", ())
    if isinstance(executor, ThreadPoolExecutor) and not isinstance(executor, copies):
        return
    kind = f"{type(executor).__module__}.{type(executor).__qualname__}"
    raise SceneError(
        f"executor is a {kind}, and a survey needs threads of its own process",
        code="bad-executor",
        fix="give a concurrent.futures.ThreadPoolExecutor, or threads=",
    )


def _room_for(count: int) -> Outcome:
    return Outcome(
        position=np.empty((count, 2)),
        velocity=np.empty((count, 2)),
        time=np.empty(count),
        bounces=np.empty(count, dtype=np.int64),
        ending=np.empty(count, dtype=np.uint8),
    )
