"""The cases with known answers: what is expected, what came out, and by how much it may differ, with the reason.

The same functions are shown by ``wallkit report --hard`` and asserted by the tests. Each is a plain function
that returns an :class:`Verdict`; the decorator :func:`case` lists it. They live in the modules ``known_*``.
"""

from __future__ import annotations

import importlib
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from wallkit.scene.scene import Balls, Scene
from wallkit.walls import Walls

INTERPRETED = 400_000  # entries that are looked at in less time than a compiler takes

_MODULES = ("known_lines", "known_corners", "known_scale", "known_arcs", "known_motion", "known_statistics")


@dataclass(frozen=True, slots=True)
class Verdict:
    """What a case gave.

    Attributes:
        expected: the known answer, for people.
        got: what came out, for people.
        error: how far apart the two are; 0 for counts that agree.
        tolerance: how far apart they may be.
        why: where the tolerance comes from, or why the answer is exact.
    """

    expected: str
    got: str
    error: float
    tolerance: float
    why: str

    @property
    def holds(self) -> bool:
        """The answer is within the tolerance (NaN is not)."""
        return bool(self.error <= self.tolerance)


@dataclass(frozen=True, slots=True)
class Case:
    """One case with a known answer.

    Attributes:
        name: short, unique.
        group: the module's subject.
        story: what is hard about it, in a phrase.
        slow: takes more than a second or so; left out of the quick suite.
        check: runs it.
    """

    name: str
    group: str
    story: str
    slow: bool
    check: Callable[[], Verdict]

    def timed(self) -> tuple[Verdict, float]:
        """Run it; give the outcome and the seconds it took."""
        begin = time.perf_counter()
        outcome = self.check()
        return outcome, time.perf_counter() - begin


_cases: list[Case] = []


def case(name: str, story: str, *, slow: bool = False) -> Callable[[Callable[..., Verdict]], Callable[..., Verdict]]:
    """List a function of no arguments as a case."""

    def listed(check: Callable[..., Verdict]) -> Callable[..., Verdict]:
        add(name, check.__module__.rsplit("known_", 1)[-1], story, check, slow=slow)
        return check

    return listed


def add(name: str, group: str, story: str, check: Callable[[], Verdict], *, slow: bool = False) -> None:
    """List a case that is made rather than written, such as one of a row of angles."""
    _cases.append(Case(name, group, story, slow, check))


def all_cases() -> list[Case]:
    """List every case, in order."""
    for name in _MODULES:
        importlib.import_module(f"wallkit.accuracy.{name}")
    return list(_cases)


def run_cases(slow: bool = True) -> Iterator[tuple[Case, Verdict, float]]:
    """Run the cases one after the other; yields each with its outcome and seconds."""
    for found in all_cases():
        if slow or not found.slow:
            yield found, *found.timed()


def fly(walls: Walls, position: ArrayLike, velocity: ArrayLike, radius: float = 0.0, **what: Any) -> Any:
    """Simulate one ball; ``what`` is until, bounces and gravity."""
    from wallkit.simulation.simulate import simulate

    gravity = what.pop("gravity", None)
    entries = 2 * len(walls.vertices) + 4
    if what.get("bounces", 10**9) * entries < INTERPRETED:
        what["mode"] = "interpreted"
    scene = Scene(walls, Balls(np.atleast_2d(position), np.atleast_2d(velocity), radius), gravity=gravity)
    return simulate(scene, **what)


def count(walls: Walls, position: ArrayLike, velocity: ArrayLike, radius: float = 0.0, until: float = 1e300) -> int:
    """Count the bounces of one ball without keeping them."""
    from wallkit.simulation.survey import survey

    scene = Scene(walls, Balls(np.atleast_2d(position), np.atleast_2d(velocity), radius))
    return int(survey(scene, until=until, bounces=10**9).bounces[0])


def counted(expected: int, got: int, why: str, slack: int = 0) -> Verdict:
    """Compare two counts."""
    return Verdict(f"{expected:,}", f"{got:,}", float(abs(expected - got)), float(slack), why)


def measured(expected: float, got: float, tolerance: float, why: str) -> Verdict:
    """Compare two numbers."""
    return Verdict(repr(float(expected)), repr(float(got)), abs(float(got) - float(expected)), tolerance, why)


def nothing(what: str, error: float, tolerance: float, why: str) -> Verdict:
    """Compare with zero: the largest deviation of a run from a law."""
    return Verdict(what, f"off by {float(error):.2g}", float(error), tolerance, why)
