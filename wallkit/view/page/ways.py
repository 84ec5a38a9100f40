"""Ways to be wrong on the page: frames beside the exact run, and a second panel with settings of its own."""

from __future__ import annotations

from typing import TYPE_CHECKING, get_args

import numpy as np

from wallkit.geometry.arrays import FloatArray
from wallkit.simulation.run import Run
from wallkit.simulation.ways import WRONG, Stepped, flown_through, partings, sentence, size_of, step_through
from wallkit.simulation.world import Way
from wallkit.view.page.payload import Table, column, duration

if TYPE_CHECKING:
    from collections.abc import Mapping

WAYS: tuple[Way, ...] = get_args(Way)
MOST_FRAMES = 30_000
"""In one answer, of all balls together: about a second's work, and 1 MB to send. Of a longer run the first ones."""
LEAST_DT, MOST_DT = 1e-5, 1e3
OWN = ("way", "dt", "restitution", "tangential_restitution", "gravity")
"""What the second panel may have otherwise than the first."""
LOOKS = 2_000  # times at which two exact panels are compared


def own_settings(body: Mapping[str, object], other: Mapping[str, object]) -> Table:
    """Give the question of the second panel: that of the first, but for what it has of its own."""
    return {**body, "way": None, **{name: other[name] for name in OWN if name in other}}


def stepped_of(run: Run, way: Way, dt: float) -> Stepped:
    """Step the balls of a run to its end, or as far as MOST_FRAMES go."""
    most = max(1, MOST_FRAMES // max(len(run.final), 1))
    return step_through(run.scene, way, dt, min(duration(run), (most - 0.5) * dt))


def stepped_table(run: Run, stepped: Stepped) -> Table:
    """Give frames as static/ways.js reads them, and what is wrong with them."""
    parted, through = partings(run, stepped), flown_through(stepped)
    return {
        "way": stepped.way,
        "dt": stepped.dt,
        "balls": stepped.state.shape[1],
        "time": column(stepped.time, "f8"),
        "place": column(stepped.state[:, :, 0:2], "f8"),
        "parted": [{"ball": p.ball, "time": p.time, "place": p.place, "exact": p.exact} for p in parted],
        "through": [
            {"ball": t.ball, "time": t.time, "place": t.place, "wall": t.wall, "lost": t.lost} for t in through
        ],
        "sentence": sentence(stepped, parted, through),
    }


def panels_part(first: Run, one: Stepped | None, second: Run, two: Stepped | None) -> float | None:
    """Find when the balls of two panels first are apart by more than WRONG of the size; None if never.

    They are compared at the frames of the panel whose frames are longer, where the other one is between two frames that
    is on the straight way from one to the next; two exact panels at LOOKS times.
    """
    until = min(duration(first), duration(second), *(each.time[-1] for each in (one, two) if each is not None))
    coarse = max((each for each in (one, two) if each is not None), key=lambda each: each.dt, default=None)
    times = np.linspace(0.0, until, LOOKS) if coarse is None else coarse.time[coarse.time <= until]
    off = np.hypot(*np.moveaxis(_places(first, one, times) - _places(second, two, times), -1, 0))
    apart = np.flatnonzero((off > WRONG * size_of(first.scene.walls)).any(axis=1))
    return float(times[apart[0]]) if len(apart) else None


def _places(run: Run, stepped: Stepped | None, times: FloatArray) -> FloatArray:
    """(F, n, 2) places in a panel at times."""
    if stepped is None:
        return run.position(times)
    places = stepped.state[:, :, 0:2]
    flat = places.reshape(len(places), -1)
    between = np.stack([np.interp(times, stepped.time, column) for column in flat.T], axis=1)
    return between.reshape(len(times), *places.shape[1:])
