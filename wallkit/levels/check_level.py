"""``check_level``: many balls fly through a level, and what they find out about it is told with its bounds."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from importers.problems import Problem
from wallkit.arguments import of_type
from wallkit.levels import findings
from wallkit.levels.check_counts import CheckCounts, Fate
from wallkit.levels.check_work import COVERING, CheckWork, Squares
from wallkit.levels.goals import Goal, goal_of
from wallkit.levels.reachable import Reachable, reachable
from wallkit.levels.statistics import bin_edges, never_bound, quantile_ranks, share_bounds
from wallkit.scene.scene import Scene, SceneError
from wallkit.simulation.count import Progress, fly_all_chunks
from wallkit.simulation.meeting_rules import refuse_meeting
from wallkit.simulation.run import Run
from wallkit.simulation.simulate import limits, simulate
from wallkit.simulation.work import Draw, check_draw

PARTS = (0.05, 0.5, 0.95)
"""Quantiles of the time to the target that are told."""
SHOWN = 200
"""Bounces of a ball that is shown."""


@dataclass(frozen=True, slots=True)
class Share:
    """A share of balls: how many of how many, and Clopper and Pearson's 95 % bounds."""

    count: int
    balls: int
    low: float
    high: float

    @staticmethod
    def of(count: int, balls: int) -> Share:
        """Bound a share."""
        return Share(count, balls, *share_bounds(count, balls))

    @property
    def value(self) -> float:
        """The share itself."""
        return self.count / self.balls


@dataclass(frozen=True, slots=True)
class Quantile:
    """A quantile of the time to the target: 95 % sure to be from ``low`` to ``high``; inf: not within the limits."""

    part: float
    low: float
    high: float


@dataclass(eq=False, repr=False)
class LevelCheck:
    """What the balls of a check found out.

    Attributes:
        scene: the level.
        draw: how the balls were drawn; ball i is ``draw(i, 1)``.
        goal: what was to be reached, or None.
        until: the limit in seconds, or None.
        bounce_limit: the limit in bounces a ball, or None.
        counts: all counts.
        squares: the squares in which places were counted.
        reachable: what balls can touch by geometry.
    """

    scene: Scene
    draw: Draw
    goal: Goal | None
    until: float | None
    bounce_limit: int | None
    counts: CheckCounts
    squares: Squares
    reachable: Reachable

    def __repr__(self) -> str:
        fates = enumerate(self.counts.fates.tolist())
        told = [f"{findings.fate_word(self, Fate(code))} {number:,}" for code, number in fates if number]
        return f"<LevelCheck: {self.counts.balls:,} balls, {self.counts.bounces:,} bounces: {', '.join(told)}>"

    @property
    def balls(self) -> int:
        """How many flew."""
        return self.counts.balls

    def share(self, fate: Fate) -> Share:
        """How many balls ended so, with bounds."""
        return Share.of(int(self.counts.fates[fate]), self.balls)

    @property
    def reached(self) -> Share | None:
        """How many balls reached the target; None where there is none."""
        return None if self.goal is None else self.share(Fate.REACHED)

    @property
    def never(self) -> NDArray[np.int64]:
        """Edges that no ball hit."""
        return np.flatnonzero(self.counts.counts.edge_hits == 0)

    @property
    def certain(self) -> NDArray[np.bool_]:
        """For each of :attr:`never`: no ball can, by geometry."""
        out: NDArray[np.bool_] = ~self.reachable.edges[self.never]
        return out

    @property
    def chance(self) -> float:
        """Below which, to 95 %, a ball's chance is of what none of all balls did."""
        return never_bound(self.balls)

    def coverage(self) -> tuple[int, int, int]:
        """Squares that are free, those of them that were visited, and by how many balls."""
        free = self.reachable.squares
        return int(free.sum()), int((free & (self.counts.visits > 0)).sum()), min(self.balls, COVERING)

    def times(self, *, bounces: bool = False) -> list[Quantile]:
        """Quantiles of the time to the target, in seconds or bounces, of all balls.

        Balls that did not reach it count as later than all that did; where the bound comes after the first slow ball
        was given up, which might have reached it meanwhile, it is inf.
        """
        if self.goal is None:
            return []
        codes, numbers = self.counts.met if bounces else self.counts.times
        limit = float(self.counts.least_bounces) if bounces and self.counts.first_slow >= 0 else self.counts.least_time
        below, whole = np.cumsum(numbers), math.ceil if bounces else float

        def value(rank: int, upper: bool) -> float:
            if rank < 1:
                return 0.0
            place = int(np.searchsorted(below, rank))
            if rank > self.balls or place >= len(codes):  # a ball that did not reach it
                last = bin_edges(int(codes[-1]))[0] if len(codes) else 0.0
                return math.inf if upper else float(whole(limit if math.isfinite(limit) else last))
            low, high = bin_edges(int(codes[place]))
            if upper:
                return math.inf if high > limit else float(whole(high) - 1 if bounces else high)
            return float(whole(min(low, limit)))

        ranks = [(part, *quantile_ranks(self.balls, part)) for part in PARTS]
        return [Quantile(part, value(low, False), value(high, True)) for part, low, high in ranks]

    def resting(self) -> list[tuple[float, float, int]]:
        """Places where balls came to rest, (x, y, balls), the most first: squares that touch count as one."""
        return findings.resting(self)

    def traps(self) -> list[findings.Trap]:
        """Kinds of traps among the first that are listed, the most frequent first."""
        return findings.traps(self)

    def problems(self) -> list[Problem]:
        """What is doubtful or worth knowing, as findings; those that are no info count."""
        return findings.problems(self)

    def example(self, ball: int, bounces: int = SHOWN) -> Run:
        """Fly one of the balls again, by its number, and keep its path."""
        scene = Scene(
            self.scene.walls, self.draw(ball, 1), self.scene.gravity, self.scene.rolling_friction, self.scene.drag
        )
        limit = bounces if self.bounce_limit is None else min(bounces, self.bounce_limit)
        return simulate(scene, self.until, limit)

    def to_json(self) -> dict[str, Any]:
        """Give the check as the ``balls`` of the ``wallkit-check`` format; infinite numbers are null."""
        return findings.to_json(self)


def check_level(
    scene: Scene,
    draw: Draw,
    balls: int,
    until: float | None = None,
    bounces: int | None = None,
    *,
    target: str | Sequence[float] | None = None,
    executor: object = "threads",
    workers: int | None = None,
    chunk: int | None = None,
    checkpoint: str | Path | None = None,
    progress: Progress | None = None,
) -> LevelCheck:
    """Fly balls through a level, each until it reaches the target or a limit, and tell what they found out.

    A ball that does not reach the target is trapped if it ended elsewhere; if it moves regularly at the limit: the norm
    of the tangent map over its last 300 bounces, a tenth of them at least on curves, is below 20 a bounce; or if it
    repeats a word of at most 64 edges ten times, with contacts that drift to no end of an edge for 10,000 periods.
    Otherwise it is slow. Places are counted for the first 1,000 balls.

    Args:
        scene: walls and what acts; its balls do not count.
        draw: as for ``count``.
        balls: how many.
        until: as for ``survey``.
        bounces: as for ``survey``.
        target: (x, y, radius) of a circle that a centre comes into; the name of a sensor or target of the scene, that a
            centre crosses; the name of a wall, or ``"WALL:EDGE"`` for one of its edges, that a ball hits; or None.
        executor: as for ``count``, and so are ``workers``, ``chunk``, ``checkpoint`` and ``progress``.
        workers: see executor.
        chunk: see executor.
        checkpoint: see executor.
        progress: see executor.

    Raises:
        SceneError: an argument is none of what may be, or the scene cannot be simulated.
        WallkitError: as for ``count``.
    """
    of_type(scene, "scene", Scene, "a Scene", error=SceneError, code="bad-scene")
    refuse_meeting(scene, "a check by balls")
    limits(until, bounces)
    check_draw(draw)
    goal = None if target is None else goal_of(scene, target)
    work = CheckWork(scene, draw, until, bounces, goal)
    counts = fly_all_chunks(
        work, balls, executor=executor, workers=workers, chunk=chunk, checkpoint=checkpoint, progress=progress
    )
    radius = float(draw(0, 1).radius[0])
    within = reachable(scene.walls, radius, draw, work.squares)
    return LevelCheck(scene, draw, goal, until, bounces, counts, work.squares, within)
