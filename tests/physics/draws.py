"""Draws for tests of surveys on several processes: they must be importable there."""

from __future__ import annotations

import os
from dataclasses import dataclass

import wallkit

PLAIN = wallkit.RandomBalls((2.0, 2.0, 8.0, 4.0), speed=9.0, seed=11)


@dataclass
class Deadly:
    """The balls of ``PLAIN``; but the process ends, as if killed, that draws ball ``deadly``, unless it is ``home``."""

    deadly: int
    home: int

    def __call__(self, first, count):
        if first <= self.deadly < first + count and os.getpid() != self.home:
            os._exit(9)
        return PLAIN(first, count)


@dataclass
class Overlapping:
    """The balls of ``PLAIN``; from ball 500 on discs so large that they overlap the walls."""

    def __call__(self, first, count):
        balls = PLAIN(first, count)
        return wallkit.Balls(balls.position, balls.velocity, 6.0) if first >= 500 else balls
