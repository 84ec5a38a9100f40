"""Balls that meet, stepped frame by frame: what ``World`` asks where its scene says ``meeting``."""

from __future__ import annotations

import math
import sys
from typing import Any

import numpy as np
from numpy.typing import NDArray

from wallkit.geometry.arrays import FloatArray
from wallkit.kernels.meeting.records import ROW
from wallkit.scene.scene import Scene, SceneError
from wallkit.simulation.meeting import Meeting
from wallkit.simulation.meeting_run import as_meeting, contacts_of_log
from wallkit.simulation.run import in_order
from wallkit.simulation.simulate import START, Flights


class Together:
    """The balls of a scene in which they meet: discs together, points each alone."""

    def __init__(self, scene: Scene, way: str, mode: Any) -> None:
        if way != "exact":
            raise SceneError(
                f"balls meet, and a frame's contacts are treated the way {way!r}: only 'exact' knows other balls",
                code="meeting-not-modelled",
                fix="take the way 'exact', or leave out meeting",
            )
        if scene.sensors is not None and len(scene.sensors):
            raise SceneError(
                "balls meet in a World with sensors: crossings are told by simulate alone",
                code="meeting-not-modelled",
                fix="leave out the sensors or meeting, or use simulate",
            )
        if scene.drag:
            raise SceneError(
                "balls meet in a World with drag: what is moved by hand has no place on their common clock",
                code="meeting-not-modelled",
                fix="leave out drag or meeting, or use simulate",
            )
        self._meeting = Meeting(scene, START, mode=mode)
        self._flights = Flights(scene, mode=mode)
        self._discs = scene.balls.radius > 0.0
        self._points = np.flatnonzero(~self._discs)
        self._state: tuple[float, FloatArray] = (math.nan, np.empty((0, 4)))

    def go(self, until: float) -> NDArray[Any]:
        """Fly on to a time: the contacts on the way, in order."""
        logs = list(self._meeting.go(until, sys.maxsize))
        rows: list[FloatArray] = []
        owners: list[NDArray[np.int32]] = []
        for ball in self._points.tolist():
            for log in self._flights.fly(ball, until, sys.maxsize):
                rows.append(log)
                owners.append(np.full(len(log), ball, dtype=np.int32))
        return self._contacts(np.concatenate(logs) if logs else np.empty((0, ROW)), rows, owners)

    def _contacts(self, log: FloatArray, rows: list[FloatArray], owners: list[NDArray[np.int32]]) -> NDArray[Any]:
        alone = as_meeting(self._flights.contacts(rows, owners))
        return in_order(np.concatenate([contacts_of_log(self._flights, log), alone]))

    def state(self, time: float) -> FloatArray:
        """(n, 4) places and velocities at the time up to which it has flown."""
        if self._state[0] != time:
            final = self._flights.final()
            state = np.stack([final[name] for name in ("x", "y", "vx", "vy")], axis=1)
            discs, _endings = self._meeting.states(time)
            state[self._discs] = discs[:, 0:4]
            state[self._discs, 0:2] += self._meeting.modelled.origin
            self._state = time, state
        return self._state[1].copy()

    def place(self, ball: int, position: FloatArray, velocity: FloatArray, time: float) -> None:
        """Let a ball go on from elsewhere."""
        if self._discs[ball]:
            self._meeting.place(ball, position - self._meeting.modelled.origin, velocity, time)
        else:
            self._flights.place(ball, position, velocity, time, START.last)
        self._state = (math.nan, np.empty((0, 4)))
