"""Surveys of more balls than fit in memory: drawn by number, flown in chunks."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace

import numpy as np

from wallkit.scene.scene import Balls, Scene
from wallkit.simulation.prepared import prepare, prepare_again
from wallkit.simulation.survey import Totals, survey


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
    """

    box: tuple[float, float, float, float]
    speed: float = 1.0
    radius: float = 0.0
    seed: int = 0

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
) -> Iterator[Totals]:
    """Survey ``count`` balls in chunks, and give the totals of each: memory does not grow with the number of balls.

    Args:
        scene: walls and what acts; its balls do not count.
        draw: gives the balls from a number on, such as :class:`RandomBalls`.
        count: how many.
        until: as for ``survey``.
        bounces: as for ``survey``.
        threads: as for ``survey``.
        chunk: balls at a time, at some 200 bytes each.
    """
    ready = None
    for first in range(0, count, chunk):
        balls = draw(first, min(chunk, count - first))
        ready = prepare_again(ready, balls) if ready else prepare(replace(scene, balls=balls))
        yield survey(ready, until, bounces, threads=threads)
