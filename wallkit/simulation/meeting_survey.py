"""Totals of scenes whose balls meet, and of many scenes at once, each on a thread of its own."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Sequence
from concurrent.futures import Executor
from typing import TYPE_CHECKING

import numpy as np

from wallkit.kernels.batches.lockstep_lanes import Outcome
from wallkit.simulation.meeting import Meeting
from wallkit.simulation.meeting_run import ends, fly_points, simulate_meeting
from wallkit.simulation.prepared import PreparedScene
from wallkit.simulation.run import ContactKind
from wallkit.simulation.sensors import with_crossings
from wallkit.simulation.simulate import START
from wallkit.simulation.threads import in_threads

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from wallkit.simulation.survey import SurveyTotals


def fly_together(ready: PreparedScene, until: float, limit: int, outcome: Outcome) -> NDArray[np.int64]:
    """Fly the balls of a scene in which they meet: (W + 2 S,) bounces by wall, and crossings of the sensors."""
    scene = ready.scene
    crossings = np.zeros((0, 2), dtype=np.int64)
    if ready.sensors is not None and scene.sensors is not None:
        run = with_crossings(simulate_meeting(scene, until, limit, mode="compiled"), "compiled")
        final, endings, bounces = run.final, np.array(run.ending, dtype=np.int64), run.bounces
        walls = run.contacts["wall"][run.contacts["kind"] <= ContactKind.VERTEX]
        hits = np.bincount(walls, minlength=len(scene.walls)).astype(np.int64)
        crossings = np.zeros((len(scene.sensors), 2), dtype=np.int64)
        for column, kind in enumerate((ContactKind.ENTER, ContactKind.EXIT)):
            crossed = run.contacts["wall"][run.contacts["kind"] == kind]
            crossings[:, column] = np.bincount(crossed, minlength=len(scene.sensors))
    else:
        meeting = Meeting(scene, START, mode="compiled", modelled=ready.modelled)
        deque(meeting.go(until, limit, keep=False), maxlen=0)
        final, endings = ends(scene, meeting, until)
        flights, _contacts = fly_points(scene, until, limit, "compiled", final, endings)
        bounces, hits = np.zeros(len(scene.balls), dtype=np.int64), meeting.hits + flights.hits
        bounces[scene.balls.radius > 0.0] = meeting.bounces
        bounces[scene.balls.radius == 0.0] = flights.bounces
    outcome.position[:], outcome.velocity[:] = (
        np.stack([final[u], final[v]], 1) for u, v in (("x", "y"), ("vx", "vy"))
    )
    outcome.time[:], outcome.bounces[:], outcome.ending[:] = final["time"], bounces, endings
    return np.concatenate([hits, crossings.ravel()])


def survey_each(
    scenes: Sequence[PreparedScene],
    one: Callable[[PreparedScene], SurveyTotals],
    threads: int,
    executor: Executor | None,
) -> list[SurveyTotals]:
    """Survey scenes that know nothing of one another, each as one piece of work, on threads that share them out."""
    found: dict[int, SurveyTotals] = {}
    waiting = deque(enumerate(scenes))

    def work() -> None:
        while waiting:
            try:
                index, ready = waiting.popleft()
            except IndexError:
                return
            found[index] = one(ready)

    try:
        in_threads(work, max(1, min(threads, len(scenes))), executor)
    finally:
        waiting.clear()  # if this thread was interrupted, the others stop soon
    return [found[index] for index in range(len(scenes))]
