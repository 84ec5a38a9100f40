"""Surveys of more balls than fit in memory: drawn by number, flown in chunks."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace

import numpy as np

from wallkit.arguments import floats, number, of_type, refused, whole_number
from wallkit.scene.scene import Balls, Scene, SceneError
from wallkit.simulation.meeting_rules import refuse_meeting
from wallkit.simulation.prepared import prepare, prepare_again
from wallkit.simulation.simulate import limits
from wallkit.simulation.survey import SurveyTotals, check_threads, survey
from wallkit.simulation.work import check_draw


@dataclass(frozen=True, slots=True)
class RandomBalls:
    """Balls anywhere in a box, in any direction, each drawn from its own number by a counter-based generator.

    Ball i is the same whatever is drawn with it: Philox (Salmon et al., "Parallel random numbers: as easy as 1, 2, 3",
    2011) with the seed as key gives its block number i.

    Attributes:
        box: (x_min, y_min, x_max, y_max) of the centres; a point if it has no size.
        speed: of all, units per second.
        radius: of all.
        seed: any whole number, 0 or more.

    Raises:
        SceneError: the box is none, or a number is out of range.
    """

    box: tuple[float, float, float, float]
    speed: float = 1.0
    radius: float = 0.0
    seed: int = 0

    def __post_init__(self) -> None:
        may_be = "four finite numbers, (x_min, y_min, x_max, y_max)"
        box = floats(self.box, "box", may_be, error=SceneError, code="bad-balls")
        if box.shape != (4,) or not np.isfinite(box).all() or (box[2:] < box[:2]).any():
            raise refused("box", self.box, may_be, SceneError, "bad-balls")
        for name in ("speed", "radius"):
            may_be = "a finite number, 0 or more"
            number(getattr(self, name), name, may_be, error=SceneError, code="bad-balls", least=0.0)
        may_be = "a whole number, 0 or more"
        whole_number(self.seed, "seed", may_be, error=SceneError, code="bad-balls", least=0)

    def __call__(self, first: int, count: int) -> Balls:
        """Draw balls ``first`` to ``first + count``."""
        block = np.random.Generator(np.random.Philox(key=self.seed).advance(first)).random((count, 4))
        x0, y0, x1, y1 = self.box
        angle = 2.0 * math.pi * block[:, 2]
        position = np.array([x0, y0]) + block[:, 0:2] * np.array([x1 - x0, y1 - y0])
        return Balls(position, self.speed * np.stack([np.cos(angle), np.sin(angle)], axis=1), self.radius)


def survey_stream(
    scene: Scene,
    draw: Callable[[int, int], Balls],
    count: int,
    until: float | None = None,
    bounces: int | None = None,
    *,
    threads: int | None = None,
    chunk: int = 100_000,
) -> Iterator[SurveyTotals]:
    """Survey ``count`` balls in chunks, and give the totals of each: memory does not grow with the number of balls.

    Args:
        scene: walls and what acts; its balls do not count.
        draw: gives the balls from a number on, such as :class:`RandomBalls`.
        count: how many.
        until: as for ``survey``.
        bounces: as for ``survey``.
        threads: as for ``survey``.
        chunk: balls at a time, at some 200 bytes each.

    Raises:
        SceneError: at once for an argument that is none of what may be; with the first chunk as ``survey``.
    """
    of_type(scene, "scene", Scene, "a Scene", error=SceneError, code="bad-scene")
    refuse_meeting(scene, "a survey in chunks")
    check_draw(draw)
    may_be = "a whole number, 0 or more"
    count = whole_number(count, "count", may_be, error=SceneError, code="bad-argument", least=0)
    may_be = "a whole number, 1 or more"
    chunk = whole_number(chunk, "chunk", may_be, error=SceneError, code="bad-argument", least=1)
    limits(until, bounces)
    check_threads(threads)
    return _surveyed(scene, draw, count, until, bounces, threads, chunk)


def _surveyed(
    scene: Scene,
    draw: Callable[[int, int], Balls],
    count: int,
    until: float | None,
    bounces: int | None,
    threads: int | None,
    chunk: int,
) -> Iterator[SurveyTotals]:
    ready = None
    for first in range(0, count, chunk):
        balls = draw(first, min(chunk, count - first))
        ready = prepare_again(ready, balls) if ready else prepare(replace(scene, balls=balls))
        yield survey(ready, until, bounces, threads=threads)
