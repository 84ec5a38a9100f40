"""Sensors: walls that report a ball and do not bounce it. They change no flight, so they are asked after it."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from wallkit.kernels.flight.sensors import next_crossing, outward
from wallkit.kernels.records import NO_HIT
from wallkit.scene.scene import Balls, Scene
from wallkit.simulation.modelled import Modelled
from wallkit.simulation.run import CONTACT, Kind, Run
from wallkit.walls import Walls


def with_crossings(run: Run) -> Run:
    """Add to a run's contacts the crossings of its scene's sensors, in order of time.

    A crossing has the kind ``ENTER`` where the centre goes against the sensor's outward normal (into a closed one) and
    ``EXIT`` where it goes along it; wall and edge are those of the sensor, the velocity is that of the ball, which
    it keeps, and the normal is the outward one.
    """
    sensors = sensors_of(run.scene)
    if sensors is None:
        return run
    rows = [
        row
        for ball in range(len(run.final))
        for flight in _flights(run, ball)
        for row in sensors.crossings(ball, *flight)
    ]
    return Run(run.scene, in_order(run.contacts, rows), run.final, run.ending, run.start) if rows else run


def in_order(contacts: NDArray[Any], rows: list[tuple[Any, ...]]) -> NDArray[Any]:
    """Give contacts together with rows of ``CONTACT``, by time."""
    contacts = np.concatenate([contacts, np.array(rows, dtype=CONTACT)])
    return contacts[np.lexsort((contacts["ball"], contacts["time"]))]


def _flights(run: Run, ball: int) -> Iterator[tuple[float, NDArray[np.float64], float, NDArray[np.float64]]]:
    """Give the flights of a ball: (from, state, to, acceleration)."""
    since, state, contact = 0.0, run.start[ball], None
    for following in run.contacts_of(ball):
        yield since, state, float(following["time"]), run.pull_after(contact)
        since, contact = float(following["time"]), following
        state = np.array([following[name] for name in ("x", "y", "vx", "vy")])
    yield since, state, float(run.final[ball]["time"]), run.pull_after(contact)


def sensors_of(scene: Scene) -> Sensors | None:
    """The sensors of a scene, ready to be asked; None where it has none."""
    return Sensors(scene, scene.sensors) if scene.sensors is not None and len(scene.sensors) else None


def modelled_sensors(scene: Scene, walls: Walls, origin: NDArray[np.float64] | None = None) -> Modelled:
    """What the kernels see of a scene's sensors; in coordinates local to ``origin``, None for their own."""
    none = Balls(np.empty((0, 2)), np.empty((0, 2)))
    return Modelled(replace(scene, walls=walls, balls=none, gravity=None), origin=origin)


class Sensors:
    """Sensors in the form in which kernels see walls, asked flight by flight."""

    def __init__(self, scene: Scene, walls: Walls) -> None:
        self._modelled = modelled_sensors(scene, walls)
        self._wall, self._edge = self._modelled.index_of_edge(Scene(walls))

    def crossings(
        self, ball: int, since: float, state: NDArray[np.float64], until: float, pull: NDArray[np.float64]
    ) -> Iterator[tuple[Any, ...]]:
        """Give what a ball crosses in one flight, in order: rows of ``CONTACT``.

        Args:
            ball: its number.
            since: when the flight begins.
            state: (4,) x, y, vx, vy then.
            until: when it ends, or inf.
            pull: (2,) acceleration.
        """
        model, (ox, oy) = self._modelled.lists, self._modelled.origin.tolist()
        x, y, vx, vy = state.tolist()
        x, y = x - ox, y - oy
        gravity = pull.tolist() if pull.any() else None
        tolerance = 2.0**-47 * max(model.extent, abs(x), abs(y))
        time, lost, edge = since, 0.0, NO_HIT
        while vx or vy or gravity:
            x, y, vx, vy, time, lost, edge = next_crossing(
                model, gravity, x, y, vx, vy, time, lost, until, edge, tolerance
            )
            if edge == NO_HIT:
                return
            nx, ny = outward(model, edge, x, y)
            kind = Kind.ENTER if vx * nx + vy * ny < 0.0 else Kind.EXIT
            place = (x + ox, y + oy)
            yield time + lost, ball, *place, vx, vy, *place, nx, ny, self._wall[edge], self._edge[edge], kind
