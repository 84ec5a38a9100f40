"""The target of a check: sensors that a ball's centre crosses, or edges of walls that it hits."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from wallkit.geometry.arrays import FloatArray
from wallkit.levels.targets import disc_of
from wallkit.scene.scene import Scene, SceneError
from wallkit.walls import Walls

MAY_BE = "X,Y,R, the name of a sensor or target, of a wall, or WALL:EDGE for one edge, counted from 0"
_FINE = 1e-6
"""Of the size of a sensor: how far its curves may be off where a ball starts in it or not."""


@dataclass(frozen=True, eq=False)
class Goal:
    """What is to be reached.

    Attributes:
        words: what was asked for.
        sensors: walls of which the first crossing counts, or None.
        edges: numbers of the edges of all walls of which the first bounce counts.
        disc: (x, y, radius), where the sensor is a circle that was given.
    """

    words: str
    sensors: Walls | None = None
    edges: tuple[int, ...] = ()
    disc: tuple[float, float, float] | None = None

    def inside(self, position: FloatArray) -> NDArray[np.bool_]:
        """Tell which of (n, 2) places are in it from the start."""
        if self.disc is not None:
            x, y, radius = self.disc
            within: NDArray[np.bool_] = np.hypot(position[:, 0] - x, position[:, 1] - y) <= radius
            return within
        found = np.zeros(len(position), dtype=np.bool_)
        if self.sensors is None:
            return found
        import shapely

        x0, y0, x1, y1 = self.sensors.box()
        straight = self.sensors.straightened(_FINE * max(x1 - x0, y1 - y0)) if self.sensors.has_arcs else self.sensors
        for wall in straight:
            if wall.closed and len(wall.vertices) > 2:
                found ^= shapely.contains_xy(shapely.polygons(wall.vertices), position[:, 0], position[:, 1])
        return found


def goal_of(scene: Scene, target: str | Sequence[float]) -> Goal:
    """Say what a target is: see ``MAY_BE``.

    Raises:
        SceneError: it is none of these.
    """
    if not isinstance(target, str):
        return _disc(target)
    sensors, walls = scene.sensors, scene.walls
    if sensors is not None:
        chosen = [
            index for index, name in enumerate(sensors.names) if name == target or _called(sensors, index, target)
        ]
        if chosen:
            return Goal(target, sensors=sensors.take(chosen))
    offsets = walls.edge_offsets
    chosen = [index for index, name in enumerate(walls.names) if name == target]
    if chosen:
        edges = [edge for index in chosen for edge in range(offsets[index], offsets[index + 1])]
        return Goal(target, edges=tuple(int(edge) for edge in edges))
    name, _, number = target.rpartition(":")
    if number.isdecimal() and name in walls.names:
        index = walls.names.index(name)
        edge = int(offsets[index]) + int(number)
        if edge < offsets[index + 1]:
            return Goal(target, edges=(edge,))
    names = sorted({name for part in (sensors, walls) if part is not None for name in part.names if name})
    known = ", ".join(map(repr, names[:12])) or "nothing has a name"
    raise SceneError(f"there is no target {target!r}", code="no-target", fix=f"give {MAY_BE}; here: {known}")


def _called(sensors: Walls, index: int, name: str) -> bool:
    """Tell whether a word in the drawing gives a sensor this name: ``target:name``."""
    tags = sensors.origins[index].tags if index < len(sensors.origins) else {}
    return name in (tags.get("target"), tags.get("sensor"))


def _disc(target: Sequence[float]) -> Goal:
    x, y, radius = disc_of(target)
    circle = [(x - radius, y), (x + radius, y)]
    sensors = Walls.from_polylines([circle], bulges=[[1.0, 1.0]])
    return Goal(f"{x:g},{y:g},{radius:g}", sensors=sensors, disc=(x, y, radius))
