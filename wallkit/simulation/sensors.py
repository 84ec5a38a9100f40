"""Sensors: walls that report a ball and do not bounce it. They change no flight, so they are asked after it."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from wallkit.geometry.arrays import FloatArray, IntArray
from wallkit.kernels.compile_aside import at_hand
from wallkit.kernels.flight.sensors import (
    CROSSING,
    CROSSING_STRIDE,
    crosses_too,
    next_crossing,
    note_crossings,
    outward,
)
from wallkit.kernels.flight.sensors_on_circles import next_crossing_round
from wallkit.kernels.index.grid import home
from wallkit.kernels.jit import compile_for
from wallkit.kernels.records import NO_HIT
from wallkit.kernels.signatures import kinds_of
from wallkit.scene.scene import Balls, Scene, falls
from wallkit.simulation.by_kernels import Kernels
from wallkit.simulation.damping import slowing_of
from wallkit.simulation.gliding import guides
from wallkit.simulation.modelled import Modelled
from wallkit.simulation.motion import Motion
from wallkit.simulation.run import CONTACT, ContactKind, Run, in_order
from wallkit.walls import Walls

WORTH_LOADING, WORTH_COMPILING = 1_000, 30_000
"""Flights from which on compiled kernels pay where they are at hand, and from which on it pays to wait for a compiler:
interpreted ones take some 8 us a flight."""

AT_ONCE = 1 << 15
"""Crossings that are found together: 2 MB."""


def with_crossings(run: Run, mode: str = "auto") -> Run:
    """Add to a run's contacts the crossings of its scene's sensors, in order of time.

    A crossing has the kind ``ENTER`` where the centre goes against the sensor's outward normal (into a closed one) and
    ``EXIT`` where it goes along it; wall and edge are those of the sensor, the velocity is that of the ball, which
    it keeps, and the normal is the outward one.

    Args:
        run: without them.
        mode: as for ``simulate``; all give the same bits.
    """
    sensors = sensors_of(run.scene)
    if sensors is None or not len(run.final):
        return run
    crossed = sensors.crossings_of(run, mode)
    return Run(run.scene, _joined(run.contacts, crossed), run.final, run.ending, run.start) if len(crossed) else run


def together(contacts: NDArray[Any], rows: list[tuple[Any, ...]]) -> NDArray[Any]:
    """Give contacts together with rows of ``CONTACT``, by time."""
    return _joined(contacts, np.array(rows, dtype=CONTACT))


def _joined(contacts: NDArray[Any], crossed: NDArray[Any]) -> NDArray[Any]:
    """Give contacts together with crossings, (k,) of ``CONTACT``, by time."""
    more = np.zeros(len(crossed), dtype=contacts.dtype)
    if "other" in (contacts.dtype.names or ()):
        more["other"] = -1
    for name in CONTACT.names or ():
        more[name] = crossed[name]
    return in_order(np.concatenate([contacts, more]))


def _flights(run: Run) -> tuple[list[Motion], IntArray, FloatArray]:
    """Give what the balls of a run do, and of each flight, ball by ball: (m,) its ball, (m, 2) from when until when."""
    owns = [run.contacts_of(ball) for ball in range(len(run.final))]
    motions = [
        Motion.after(run.scene, start, own, guides(run.scene.walls, own))
        for start, own in zip(run.start, owns, strict=True)
    ]
    ends = zip(owns, run.final["time"].tolist(), strict=True)
    since = np.concatenate([part for own in owns for part in ([0.0], own["time"])])
    until = np.concatenate([part for own, end in ends for part in (own["time"], [end])])
    ball = np.repeat(np.arange(len(owns)), [1 + len(own) for own in owns])
    return motions, ball, np.column_stack([since, until])


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

    def crossings_of(self, run: Run, mode: str) -> NDArray[Any]:
        """Give what the balls of a run cross, (k,) of ``CONTACT``: ball by ball, flight by flight, each in order."""
        motions, ball, spans = _flights(run)
        state, pull, bend = (np.concatenate([getattr(one, of) for one in motions]) for of in ("state", "pull", "bend"))
        flights = np.column_stack([state[:, 0:2] - self._modelled.origin, state[:, 2:4], spans])
        pulled, bent = pull.any(axis=1) | (self._modelled.model.drag is not None), bend != 0.0
        found, numbers = [np.empty(0, dtype=CONTACT)], [np.empty(0, dtype=np.int64)]
        for asked, pulls in ((~pulled & ~bent, None), (pulled & ~bent, pull[pulled & ~bent])):
            if asked.any():
                rows = self._noted(flights[asked], pulls, mode)
                numbers.append(np.flatnonzero(asked)[rows[:, CROSSING.flight].astype(np.int64)])
                found.append(self._contacts(rows, ball[numbers[-1]]))
        for flight in np.flatnonzero(bent).tolist():
            of = int(ball[flight])
            row = flight - int(np.searchsorted(ball, of))
            told = list(self.crossings_on(of, motions[of], row, *spans[flight].tolist()))
            numbers.append(np.full(len(told), flight))
            found.append(np.array(told, dtype=CONTACT))
        crossed: NDArray[Any] = np.concatenate(found)[np.argsort(np.concatenate(numbers), kind="stable")]
        return crossed

    def _noted(self, flights: FloatArray, pulls: FloatArray | None, mode: str) -> FloatArray:
        """Give rows of ``Crossing``, for (m, 6) flights as ``note_crossings`` has them."""
        machine_code = mode == "compiled" or (mode == "auto" and self._compiles(len(flights), pulls is not None))
        kernels, model = Kernels(machine_code), self._modelled.model if machine_code else self._modelled.lists
        given = kernels.given((flights.ravel(), None if pulls is None else pulls.ravel()))
        pull = None if pulls is None else kernels.room(2, np.float64)
        parts, flight, room = [], 0, min(2 * len(flights) + 16, AT_ONCE)
        while flight < len(flights):
            rows, before = kernels.room(room * CROSSING_STRIDE, np.float64), flight
            flight, count = kernels.run(note_crossings, model, pull, *given, flight, rows)
            parts.append(np.array(rows, dtype=np.float64).reshape(room, CROSSING_STRIDE)[:count].copy())
            if flight == before:
                room *= 2  # one flight crosses more than that
        return np.concatenate(parts)

    def _compiles(self, flights: int, pulled: bool) -> bool:
        if not WORTH_LOADING < flights <= WORTH_COMPILING:
            return flights > WORTH_COMPILING
        pull = np.empty(2) if pulled else None
        kinds = kinds_of((self._modelled.model, pull, np.empty(6), pull, 0, np.empty(9)))
        return at_hand(compile_for, note_crossings, *kinds)

    def _contacts(self, rows: FloatArray, ball: IntArray) -> NDArray[Any]:
        """Make ``CONTACT`` of rows of ``Crossing``, and their balls."""
        contacts = np.zeros(len(rows), dtype=CONTACT)
        for name in ("time", "vx", "vy", "nx", "ny"):
            contacts[name] = rows[:, getattr(CROSSING, name)]
        for place, name in enumerate(("x", "y")):
            contacts[name] = contacts[f"p{name}"] = rows[:, getattr(CROSSING, name)] + self._modelled.origin[place]
        edge = rows[:, CROSSING.edge].astype(np.int64)
        enters = contacts["vx"] * contacts["nx"] + contacts["vy"] * contacts["ny"] < 0.0
        contacts["ball"], contacts["wall"], contacts["edge"] = ball, self._wall[edge], self._edge[edge]
        contacts["kind"] = np.where(enters, ContactKind.ENTER, ContactKind.EXIT)
        return contacts

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
