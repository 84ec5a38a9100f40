"""The promised horizon beside the bounce where a run really departs from one with as many digits as it takes."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from wallkit.accuracy.reference import sure_events
from wallkit.accuracy.scenes import BuiltIn, built_in
from wallkit.geometry.arrays import FloatArray
from wallkit.scene.scene import Balls, Scene
from wallkit.simulation.horizon import predicted_errors, trusted_until

TOLERANCE = 1e-6
DRAWS = 4
NUDGE = 2.0**-40  # far below anything else, and some roundings of the scenes' coordinates


@dataclass(frozen=True, slots=True)
class Departure:
    """One row of the table.

    Attributes:
        name: of the scene.
        radius: of the ball.
        promised: bounces that the horizon calls good to :data:`TOLERANCE`: the least of the draws.
        real: the first contact that is off by more: the earliest of the draws, or None within ``bounces``.
        bounces: how many were looked at.
    """

    name: str
    radius: float
    promised: int
    real: int | None
    bounces: int

    @property
    def ratio(self) -> float | None:
        """How many times further the run really holds; never below 1 if the promise is kept."""
        return None if self.real is None else self.real / max(self.promised, 1)


def true_error(scene: Scene, bounces: int) -> tuple[FloatArray, FloatArray, int]:
    """Hold a run against the reference.

    Returns:
        The error of the place of each contact, its predicted root mean square, and the bounces promised good to
        :data:`TOLERANCE`. Arrays are as long as the shorter of the two runs.
    """
    from wallkit.simulation.simulate import simulate

    events = sure_events(scene, bounces)
    contacts = simulate(scene, bounces=bounces).contacts
    count = min(len(events), len(contacts))
    true = np.array([[float(value) for value in event.position] for event in events[:count]]).reshape(-1, 2)
    error = np.hypot(contacts["x"][:count] - true[:, 0], contacts["y"][:count] - true[:, 1])
    rms, _ = predicted_errors(scene, contacts)
    return error, rms[:count], trusted_until(scene, contacts, tolerance=TOLERANCE).bounces


def departure(scene: BuiltIn, radius: float, bounces: int = 300, draws: int = DRAWS) -> Departure:
    """Compare promise and truth on one scene.

    What the roundings of a run add up to is chance: one run may be lucky by a factor 50. So it is run ``draws``
    times, from starts that differ by some 1e-12, each against a reference of its own; the smallest promise and
    the earliest departure count.
    """
    promises, earliest = [], bounces
    start = scene.position[0]
    for _ in range(draws):
        own = scene.scene(radius=radius)
        own.balls = Balls([(start, scene.position[1])], [scene.velocity], radius)
        error, _rms, promised = true_error(own, min(bounces, round(1.5 * earliest) + 1))
        wrong = np.flatnonzero(error > TOLERANCE)
        promises.append(promised)
        earliest = min(earliest, int(wrong[0]) if len(wrong) else bounces)
        if earliest == bounces:  # nothing departs here, and a nudge will not change that
            break
        start += NUDGE
    return Departure(scene.name, radius, min(promises), earliest if earliest < bounces else None, bounces)


def departures(bounces: int = 300, draws: int = DRAWS) -> Iterator[Departure]:
    """Compare promise and truth on all built-in scenes, for points and discs."""
    for scene in built_in():
        for radius in (0.0, scene.radius):
            yield departure(scene, radius, bounces, draws)
