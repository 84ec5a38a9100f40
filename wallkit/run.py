"""Run: every contact, the exact state in between, and how each ball ended."""

from __future__ import annotations

import enum

import numpy as np

CONTACT = np.dtype(
    [
        ("time", np.float64),
        ("ball", np.int32),
        ("x", np.float64),
        ("y", np.float64),
        ("vx", np.float64),
        ("vy", np.float64),
        ("px", np.float64),
        ("py", np.float64),
        ("nx", np.float64),
        ("ny", np.float64),
        ("wall", np.int32),
        ("edge", np.int32),
        ("kind", np.uint8),
    ]
)
"""One contact: time; ball; centre x, y; velocity vx, vy after; contact point px, py; unit normal nx, ny (towards
the ball); wall; edge within that wall, -1 for a corner; kind, see :class:`Kind`. 88 bytes or fewer."""


class Kind(enum.IntEnum):
    """What was touched."""

    EDGE = 0
    VERTEX = 1

    @property
    def label(self) -> str:
        """The word in the CSV."""
        return self.name.lower()


class Ending(enum.IntEnum):
    """How a ball's run ended."""

    TIME_REACHED = 0
    BOUNCE_LIMIT = 1
    LEFT_SCENE = 2
    AT_REST = 3
    COLLAPSE = 4
    AMBIGUOUS_CORNER = 5

    @property
    def label(self) -> str:
        """The words for people and files: "time reached", "left the scene"."""
        return "left the scene" if self is Ending.LEFT_SCENE else self.name.lower().replace("_", " ")
