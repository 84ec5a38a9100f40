"""What the balls of a check did, in whole numbers that add up; the first traps one by one."""

from __future__ import annotations

import enum
import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from wallkit.levels.statistics import add_bins
from wallkit.simulation.counts import Counts

LISTED = 1000
"""Traps that are kept one by one: those of the lowest numbers, so that chunks do not matter."""


class Fate(enum.IntEnum):
    """What became of a ball."""

    REACHED = 0
    AT_REST = 1
    """It rests, swings, or has ended in a corner or on a wall that takes all speed."""
    REGULAR = 2
    """It moves regularly at the limit: the tangent map grows like that of an island."""
    REPEATS = 3
    """It goes round and round: a word of edges comes again and again, and will for 10,000 periods more."""
    SLOW = 4
    """None of these, at the limit."""
    LEFT = 5
    """It left the scene."""
    UNDECIDED = 6
    """It met a corner whose outcome depends on which wall comes first."""

    @property
    def label(self) -> str:
        """The words for people and files."""
        return "left the scene" if self is Fate.LEFT else self.name.lower().replace("_", " ")


TRAPS = (Fate.AT_REST, Fate.REGULAR, Fate.REPEATS)
TRAP = np.dtype(
    [("ball", np.int64), ("fate", np.int64), ("x", np.float64), ("y", np.float64), ("norm", np.float64),
     ("period", np.int64), ("word", np.int64)]
)  # fmt: skip
"""A trapped ball: its number, fate and last place, its tangent map's norm a contact (inf: not known), the edges of the
word that it repeats (0: none), and the number of the set of edges that it met last."""
Bins = tuple[NDArray[np.int64], NDArray[np.int64]]


@dataclass(eq=False, repr=False)
class CheckCounts:
    """Counts of a check; two of one level add up to the same in any order.

    Attributes:
        counts: of the survey, up to the target.
        fates: (7,) int64, balls by :class:`Fate`.
        visits: (rows, columns) int64, balls that were in each square.
        rests: (rows, columns) int64, balls that came to rest there.
        times: histogram of the times to the target, see ``statistics.bins_of``.
        met: the same of bounces before it.
        least_time: seconds after which the first slow ball was given up; inf where there is none.
        least_bounces: bounces, likewise; above 2^60 where there is none.
        first_slow: number of the first slow ball, or -1.
        traps: (at most LISTED,) of ``TRAP``, by number.
    """

    counts: Counts
    fates: NDArray[np.int64]
    visits: NDArray[np.int64]
    rests: NDArray[np.int64]
    times: Bins
    met: Bins
    least_time: float
    least_bounces: int
    first_slow: int
    traps: NDArray[Any]

    @property
    def balls(self) -> int:
        """How many flew."""
        return self.counts.balls

    @property
    def bounces(self) -> int:
        """Of all, up to the target."""
        return self.counts.bounces

    def __add__(self, other: CheckCounts) -> CheckCounts:
        traps = np.concatenate([self.traps, other.traps])
        slow = [number for number in (self.first_slow, other.first_slow) if number >= 0]
        return CheckCounts(
            self.counts + other.counts,
            self.fates + other.fates,
            self.visits + other.visits,
            self.rests + other.rests,
            add_bins(self.times, other.times),
            add_bins(self.met, other.met),
            min(self.least_time, other.least_time),
            min(self.least_bounces, other.least_bounces),
            min(slow, default=-1),
            traps[np.argsort(traps["ball"], kind="stable")][:LISTED],
        )

    def digest(self) -> str:
        """64 hexadecimal digits that are equal where all counts are."""
        import hashlib
        import json

        return hashlib.sha256(json.dumps(self.to_json()).encode()).hexdigest()

    def to_json(self) -> dict[str, Any]:
        """Give all counts as numbers and lists; without an infinite number."""
        return {
            "counts": self.counts.to_json(),
            "fates": self.fates.tolist(),
            "visits": self.visits.tolist(),
            "rests": self.rests.tolist(),
            "times": [part.tolist() for part in self.times],
            "met": [part.tolist() for part in self.met],
            "least_time": self.least_time if math.isfinite(self.least_time) else None,
            "least_bounces": self.least_bounces,
            "first_slow": self.first_slow,
            "traps": [[None if value == math.inf else value for value in row] for row in self.traps.tolist()],
        }

    @staticmethod
    def of_json(value: dict[str, Any]) -> CheckCounts:
        """Read what :meth:`to_json` gave."""
        fates, visits, rests = (np.array(value[name], dtype=np.int64) for name in ("fates", "visits", "rests"))
        times, met = (
            (np.array(value[name][0], dtype=np.int64), np.array(value[name][1], dtype=np.int64))
            for name in ("times", "met")
        )
        rows = [tuple(math.inf if one is None else one for one in row) for row in value["traps"]]
        return CheckCounts(
            counts=Counts.of_json(value["counts"]),
            least_time=math.inf if value["least_time"] is None else float(value["least_time"]),
            least_bounces=int(value["least_bounces"]),
            first_slow=int(value["first_slow"]),
            traps=np.array(rows, dtype=TRAP),
            fates=fates,
            visits=visits,
            rests=rests,
            times=times,
            met=met,
        )
