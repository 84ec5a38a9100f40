"""Sensors: walls that report a ball and do not bounce it. They change no flight, so they are asked after it."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from wallkit.kernels.damping import free_time, slowed
from wallkit.kernels.flight import normal_of
from wallkit.kernels.model import FREE, NO_HIT
from wallkit.kernels.motion import advance
from wallkit.kernels.pull import first_contact, move
from wallkit.modelling import Modelled
from wallkit.run import CONTACT, Kind, Run
from wallkit.scene import Balls, Scene


def with_crossings(run: Run) -> Run:
    """Add to a run's contacts the crossings of its scene's sensors, in order of time.

    A crossing has the kind ``ENTER`` where the centre goes against the sensor's outward normal (into a closed one) and
    ``EXIT`` where it goes along it; wall and edge are those of the sensor, the velocity is that of the ball, which
    it keeps, and the normal is the outward one.
    """
    if run.scene.sensors is None or not len(run.scene.sensors):
        return run
    none = Balls(np.empty((0, 2)), np.empty((0, 2)))
    modelled = Modelled(replace(run.scene, walls=run.scene.sensors, balls=none, gravity=None))
    walls, edge_in_wall = modelled.index_of_edge(Scene(run.scene.sensors))
    rows = [
        (*row[:-1], walls[row[-1]], edge_in_wall[row[-1]], kind)
        for ball in range(len(run.final))
        for flight in _flights(run, ball)
        for row, kind in _crossings(modelled, ball, *flight)
    ]
    if rows:
        contacts = np.concatenate([run.contacts, np.array(rows, dtype=CONTACT)])
        order = np.lexsort((contacts["ball"], contacts["time"]))
        run = Run(run.scene, contacts[order], run.final, run.ending, run.start)
    return run


def _flights(run: Run, ball: int) -> Iterator[tuple[float, NDArray[np.float64], float, NDArray[np.float64]]]:
    """Give the flights of a ball: (from, state, to, acceleration)."""
    since, state, contact = 0.0, run.start[ball], None
    for following in run.contacts_of(ball):
        yield since, state, float(following["time"]), run.pull_after(contact)
        since, contact = float(following["time"]), following
        state = np.array([following[name] for name in ("x", "y", "vx", "vy")])
    yield since, state, float(run.final[ball]["time"]), run.pull_after(contact)


def _crossings(
    modelled: Modelled, ball: int, since: float, state: NDArray[np.float64], until: float, pull: NDArray[np.float64]
) -> Iterator[tuple[tuple[Any, ...], Kind]]:
    model, (ox, oy) = modelled.lists, modelled.origin.tolist()
    x, y, vx, vy = state.tolist()
    x, y = x - ox, y - oy
    gravity = pull.tolist() if pull.any() else None
    tolerance = 2.0**-47 * max(model.extent, abs(x), abs(y))
    time, lost, last = since, 0.0, NO_HIT
    while vx or vy or gravity:
        energy, remaining = vx * vx + vy * vy, (until - time) - lost
        best = free_time(model.damping, energy, remaining)
        t, feature, _touched = first_contact(
            model, gravity, 0.0, x, y, vx, vy, energy, last, NO_HIT, FREE, tolerance, best
        )
        if feature == NO_HIT:
            return
        passed, kept = slowed(model.damping, energy, t, remaining)
        x, y, vx, vy = move(model, gravity, NO_HIT, FREE, x, y, vx, vy, t)
        vx, vy = kept * vx, kept * vy
        time, lost = advance(time, lost, passed)
        nx, ny, twice, _wall = normal_of(model, feature, x, y)
        unit = (0.5 * twice) ** 0.5
        if model.arcs is not None and model.arc_of_edge[feature] >= 0:
            unit *= model.arcs[model.arc_of_edge[feature]].turn
        nx, ny = nx * unit, ny * unit
        kind = Kind.ENTER if vx * nx + vy * ny < 0.0 else Kind.EXIT
        yield (time + lost, ball, x + ox, y + oy, vx, vy, x + ox, y + oy, nx, ny, feature), kind
        last = feature
