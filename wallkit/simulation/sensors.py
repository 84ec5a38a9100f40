"""Sensors: walls that report a ball and do not bounce it. They change no flight, so they are asked after it."""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from wallkit.kernels.flight.sensors import crosses_too, next_crossing, outward
from wallkit.kernels.flight.sensors_on_circles import next_crossing_round
from wallkit.kernels.index.grid import home
from wallkit.kernels.records import NO_HIT
from wallkit.scene.scene import Balls, Scene, falls
from wallkit.simulation.damping import slowing_of
from wallkit.simulation.gliding import guides
from wallkit.simulation.modelled import Modelled
from wallkit.simulation.motion import Motion
from wallkit.simulation.run import CONTACT, ContactKind, Run, in_order
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
        for row in sensors.crossings_on(ball, *flight)
    ]
    return Run(run.scene, together(run.contacts, rows), run.final, run.ending, run.start) if rows else run


def together(contacts: NDArray[Any], rows: list[tuple[Any, ...]]) -> NDArray[Any]:
    """Give contacts together with rows of ``CONTACT``, by time."""
    crossed = np.zeros(len(rows), dtype=contacts.dtype)
    if "other" in (contacts.dtype.names or ()):
        crossed["other"] = -1
    for name, column in zip(CONTACT.names or (), zip(*rows, strict=True), strict=True):
        crossed[name] = column
    return in_order(np.concatenate([contacts, crossed]))


def _flights(run: Run, ball: int) -> Iterator[tuple[Motion, int, float, float]]:
    """Give the flights of a ball: what it does, the row of that, from when and until when."""
    own = run.contacts_of(ball)
    motion = Motion.after(run.scene, run.start[ball], own, guides(run.scene.walls, own))
    times = [0.0, *own["time"].tolist(), float(run.final[ball]["time"])]
    for row, (since, until) in enumerate(itertools.pairwise(times)):
        yield motion, row, since, until


def sensors_of(scene: Scene) -> Sensors | None:
    """The sensors of a scene, ready to be asked; None where it has none."""
    return Sensors(scene, scene.sensors) if scene.sensors is not None and len(scene.sensors) else None


def modelled_sensors(scene: Scene, walls: Walls, origin: NDArray[np.float64] | None = None) -> Modelled:
    """What the kernels see of a scene's sensors; in coordinates local to ``origin``, None for their own."""
    none = replace(scene, walls=walls, balls=Balls(np.empty((0, 2)), np.empty((0, 2))), gravity=None)
    if not falls(scene):
        return Modelled(none, origin=origin)
    # What slows a ball down under gravity they know as its walls do, and gravity as what they are asked with.
    modelled, slowing = Modelled(replace(none, rolling_friction=None, drag=None), origin=origin), slowing_of(scene)
    modelled.model = modelled.model._replace(rolling=slowing.rolling, drag=slowing.drag)
    return modelled


class Sensors:
    """Sensors in the form in which kernels see walls, asked flight by flight."""

    def __init__(self, scene: Scene, walls: Walls) -> None:
        self._modelled = modelled_sensors(scene, walls)
        self._wall, self._edge = self._modelled.index_of_edge(Scene(walls))

    def crossings_on(
        self, ball: int, motion: Motion, row: int, since: float, until: float
    ) -> Iterator[tuple[Any, ...]]:
        """Give what a ball crosses from one contact to the next, in order: rows of ``CONTACT``.

        Args:
            ball: its number.
            motion: what it does,
            row: and which row of that.
            since: when the flight begins.
            until: when it ends, or inf.
        """
        state, bent = motion.state[row].copy(), float(motion.bend[row])
        if bent == 0.0:
            yield from self.crossings(ball, since, state, until, motion.pull[row].copy())
            return
        model, (ox, oy) = self._modelled.lists, self._modelled.origin.tolist()
        (gx, gy), (x, y, vx, vy) = motion.gravity.tolist(), state.tolist()
        out = 1.0 if bent > 0.0 else -1.0
        ex, ey = (out * motion.normal[row]).tolist()
        x, y, v, time, edge = x - ox, y - oy, vy * ex - vx * ey, since, NO_HIT
        while True:
            x, y, ex, ey, v, time, edge = next_crossing_round(
                model, gx, gy, abs(bent), out, x, y, ex, ey, v, time, until, edge
            )
            if edge == NO_HIT:
                return
            yield self._row(ball, time, x, y, -v * ey, v * ex, edge)

    def _row(self, ball: int, time: float, x: float, y: float, vx: float, vy: float, edge: int) -> tuple[Any, ...]:
        nx, ny = outward(self._modelled.lists, edge, x, y)
        kind = ContactKind.ENTER if vx * nx + vy * ny < 0.0 else ContactKind.EXIT
        place = (x + self._modelled.origin[0], y + self._modelled.origin[1])
        return time, ball, *place, vx, vy, *place, nx, ny, self._wall[edge], self._edge[edge], kind

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
        gravity = pull.tolist() if pull.any() or model.drag is not None else None
        tolerance = 2.0**-47 * max(model.extent, abs(x), abs(y))
        time, lost, edge = since, 0.0, NO_HIT
        while vx or vy or gravity:
            x, y, vx, vy, time, lost, edge = next_crossing(
                model, gravity, x, y, vx, vy, time, lost, until, edge, tolerance
            )
            if edge == NO_HIT:
                return
            yield self._row(ball, time + lost, x, y, vx, vy, edge)
            cell = model.cells[home(model, model.grid, x, y)]
            for other in model.ids[cell.first : cell.corners]:
                if crosses_too(model, other, edge, x, y, vx, vy, tolerance):
                    yield self._row(ball, time + lost, x, y, vx, vy, other)
