"""Runs of scenes whose balls meet: discs together, points each alone, in one list of contacts."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from wallkit.geometry.arrays import FloatArray
from wallkit.kernels.meeting.records import ROW
from wallkit.kernels.records import RUNNING, STATE
from wallkit.scene.scene import Scene
from wallkit.simulation.meeting import PER_DISC, Meeting
from wallkit.simulation.run import FINAL, MEETING_CONTACT, Ending, Run, in_order
from wallkit.simulation.simulate import START, Flights, Mode, is_gone


def simulate_meeting(
    scene: Scene,
    until: float,
    limit: int,
    *,
    mode: Mode = "auto",
    progress: Callable[[float], None] | None = None,
    per_disc: float = PER_DISC,
) -> Run:
    """Fly the balls of a scene in which they meet, until a time, or until one of the discs has made its last bounce.

    Args:
        scene: walls, balls, and what acts; no two discs overlap.
        until: seconds, or inf.
        limit: bounces a ball; the first disc that has made them ends the run of all discs.
        mode: see ``simulate``.
        progress: called now and then with the part done, 0 to 1.
        per_disc: cells a disc; no bit depends on it.
    """
    meeting = Meeting(scene, START, mode=mode, per_disc=per_disc)
    logs = []
    for log in meeting.go(until, limit):
        logs.append(log)
        if progress is not None:
            most = int(meeting.bounces.max(initial=0))
            progress(min(1.0, max(meeting.now / until if until > 0 else 1.0, most / max(limit, 1))))
    final, endings = ends(scene, meeting, until)
    alone, contacts = fly_points(scene, until, limit, mode, final, endings)
    found = contacts_of_log(alone, np.concatenate(logs) if logs else np.empty((0, ROW)))
    contacts = in_order(np.concatenate([found, contacts])) if len(contacts) else in_order(found)
    start = np.hstack([scene.balls.position, scene.balls.velocity])
    return Run(scene, contacts, final, tuple(Ending(code) for code in endings.tolist()), start)


def ends(scene: Scene, meeting: Meeting, until: float) -> tuple[NDArray[Any], NDArray[np.int64]]:
    """(n,) of ``FINAL`` and (n,) endings of the discs where the run of all of them ended."""
    end = meeting.now if meeting.reached == 2 else until
    states, codes = meeting.states(end)
    final, endings = np.zeros(len(scene.balls), dtype=FINAL), np.zeros(len(scene.balls), dtype=np.int64)
    discs = np.flatnonzero(meeting.modelled.radii > 0.0)
    place = states[:, 0:2] + meeting.modelled.origin
    for name, column in zip(("x", "y", "vx", "vy"), (*place.T, *states[:, 2:4].T), strict=True):
        final[name][discs] = column
    final["time"][discs] = states[:, STATE.time] + states[:, STATE.lost]
    moves = np.any(states[:, 2:4] != 0.0, axis=1)
    if math.isinf(end):  # nothing is due any more
        codes = np.where(codes == RUNNING, np.where(moves, Ending.LEFT_SCENE, Ending.AT_REST), codes)
    elif meeting.reached == 2:
        codes = np.where((codes == RUNNING) | (codes == Ending.TIME_REACHED), Ending.BOUNCE_LIMIT, codes)
    gone = is_gone(meeting.modelled.box, place, states[:, 2:4], meeting.modelled.radii[discs])
    endings[discs] = np.where((codes == Ending.TIME_REACHED) & gone, Ending.LEFT_SCENE, codes)
    return final, endings


def fly_points(
    scene: Scene, until: float, limit: int, mode: Mode, final: NDArray[Any], endings: NDArray[np.int64]
) -> tuple[Flights, NDArray[Any]]:
    """Fly the points, which meet nothing: their flights and contacts; their ends are written into those of all."""
    points = np.flatnonzero(scene.balls.radius == 0.0)
    flights = Flights(replace(scene, balls=scene.balls.take(points), meeting=False), mode=mode)
    logs: list[FloatArray] = []
    owners: list[NDArray[np.int32]] = []
    for index in range(len(points)):
        for log in flights.fly(index, until, limit):
            logs.append(log)
            owners.append(np.full(len(log), points[index], dtype=np.int32))
    final[points] = flights.final()
    endings[points] = flights.endings()
    return flights, as_meeting(flights.contacts(logs, owners))


def as_meeting(contacts: NDArray[Any]) -> NDArray[Any]:
    """Give contacts of balls that meet none the columns of those that do."""
    wide = np.zeros(len(contacts), dtype=MEETING_CONTACT)
    for name in contacts.dtype.names or ():
        wide[name] = contacts[name]
    wide["other"] = -1
    return wide


def contacts_of_log(flights: Flights, log: FloatArray) -> NDArray[Any]:
    """Contacts of rows of a log (``wallkit.kernels.meeting.records.ROW``), in the scene's coordinates, as they come."""
    contacts = np.zeros(len(log), dtype=MEETING_CONTACT)
    met = log[:, 12] >= 0.0
    ox, oy = flights.modelled.origin
    columns = ("time", "x", "y", "vx", "vy", "px", "py", "nx", "ny")
    for column, name in enumerate(columns):
        contacts[name] = log[:, column]
    for name, shift in (("x", ox), ("px", ox), ("y", oy), ("py", oy)):
        contacts[name] += shift
    contacts["kind"], contacts["ball"], contacts["other"] = log[:, 10], log[:, 11], log[:, 12]
    contacts["wall"], contacts["edge"] = -1, -1
    at_walls = np.flatnonzero(~met)
    wall, edge = flights.places(log[at_walls, 9].astype(np.int64))
    contacts["wall"][at_walls], contacts["edge"][at_walls] = wall, edge
    for column, name in enumerate(("other_x", "other_y", "other_vx", "other_vy")):
        contacts[name] = log[:, 13 + column]
    contacts["other_x"][met] += ox
    contacts["other_y"][met] += oy
    return contacts
