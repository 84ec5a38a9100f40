"""A plain overlap test at the end of each frame, as the simplest games have it: what ``World`` does in that way."""

from __future__ import annotations

import math
from collections.abc import Iterator
from functools import cached_property
from typing import Any

import numpy as np
import shapely
from numpy.typing import NDArray

from wallkit.geometry.arrays import FloatArray
from wallkit.geometry.exact_edges import ExactEdges, as_complex
from wallkit.kernels.flight.motion import reflect
from wallkit.scene.scene import Scene
from wallkit.simulation.motion import Motion
from wallkit.simulation.run import CONTACT, ContactKind
from wallkit.simulation.sensors import sensors_of, together


class Overlapping:
    """The balls of a scene, each moved by a whole frame and looked at where it then is.

    With p and v the place and velocity at the frame's start, g gravity and dt the frame, the ball is at its end at

        q = p + v dt + g dt^2 / 2,    w = v + g dt

    (with friction or drag, where these carry it). A wall overlaps if its nearest point is less than the radius from q;
    its normal n points from there to q, or outwards where the wall is solid from outside alone. Each overlapping wall
    with w.n < 0, the nearest first, turns w by its restitutions. The place stays q. What lay between p and q is not
    looked at, and a point, of radius 0, overlaps nothing.
    """

    def __init__(self, scene: Scene) -> None:
        self._scene = scene
        self._time = 0.0
        self._sensors = sensors_of(scene)
        self._motion = Motion.of(scene, np.hstack([scene.balls.position, scene.balls.velocity]).astype(np.float64))
        self._radius = np.asarray(scene.balls.radius, dtype=np.float64)

    def go(self, until: float) -> NDArray[Any]:
        """Move on by one frame that ends at a time: crossings of sensors, and what turned a ball at the end."""
        balls = np.arange(len(self._radius))
        crossed = [row for ball in balls.tolist() for row in self._crossings(ball, until)]
        dt, self._time = until - self._time, until
        self._motion.state = self._motion.at(balls, np.full(len(balls), dt))
        rows = [row for ball in np.flatnonzero(self._radius > 0.0).tolist() for row in self._turned(ball)]
        contacts = np.array(rows, dtype=CONTACT)
        return together(contacts, crossed) if crossed else contacts

    def state(self, time: float) -> FloatArray:
        """(n, 4) places and velocities at the time up to which it has gone."""
        return self._motion.state.copy()

    def place(self, ball: int, position: FloatArray, velocity: FloatArray, time: float) -> None:
        """Let a ball go on from elsewhere."""
        self._motion.begin(ball, position, velocity)

    def _crossings(self, ball: int, until: float) -> Iterator[tuple[Any, ...]]:
        if self._sensors is not None:
            yield from self._sensors.crossings_on(ball, self._motion, ball, self._time, until)

    def _turned(self, ball: int) -> list[tuple[Any, ...]]:
        x, y, vx, vy = self._motion.state[ball].tolist()
        radius = float(self._radius[ball])
        near = self._tree.query(shapely.box(x - radius, y - radius, x + radius, y + radius))
        edges = self._edges.take(near)
        touched = edges.nearest(np.full(len(near), x + 1j * y))
        away = (x + 1j * y) - touched
        rows = []
        for index in np.argsort(np.abs(away), kind="stable").tolist():
            if abs(away[index]) >= radius:
                break
            edge, point = int(near[index]), touched[index]
            wall = int(self._wall[edge])
            n = self._normal(edge, wall, point, away[index], vx, vy)
            if n == 0 or vx * n.real + vy * n.imag >= 0.0:
                continue
            material = self._scene.walls.materials[wall]
            keep = [material.restitution, material.tangential_restitution]
            vx, vy, _square = reflect(keep, 0, n.real, n.imag, 2.0, vx, vy, vx * vx + vy * vy)
            corner = point in (edges.a[index], edges.b[index])
            kind = ContactKind.VERTEX if corner else ContactKind.EDGE
            which = -1 if corner else edge - int(self._scene.walls.edge_offsets[wall]), kind
            rows.append((self._time, ball, x, y, vx, vy, point.real, point.imag, n.real, n.imag, wall, *which))
        self._motion.state[ball, 2:4] = vx, vy
        return rows

    def _normal(self, edge: int, wall: int, point: complex, away: complex, vx: float, vy: float) -> complex:
        """Unit normal of an overlapping wall; of a two-sided one whose line the centre is on, against the velocity."""
        both = self._scene.walls.sides[wall] == "both"
        if both and away != 0:
            return _unit(away)
        outward: complex = self._outward[edge]
        if (turn := float(self._edges.angle[edge])) != 0.0:  # right of an arc that turns to the left is off its centre
            off = complex(point - self._edges.centre[edge])
            outward = math.copysign(1.0, turn) * _unit(off)
        if both:
            return outward if vx * outward.real + vy * outward.imag < 0.0 else -outward
        return outward if away == 0 or (away * outward.conjugate()).real > 0.0 else 0j

    @cached_property
    def _edges(self) -> ExactEdges:
        walls = self._scene.walls
        start = walls.edge_starts
        return ExactEdges.of(walls.vertices[start], walls.vertices[walls.edge_ends], walls.bulges[start])

    @cached_property
    def _outward(self) -> NDArray[np.complex128]:
        """(E,) outward unit normals of lines."""
        return as_complex(self._scene.walls.normals)

    @cached_property
    def _wall(self) -> NDArray[np.int64]:
        """(E,) the wall of each edge."""
        return np.repeat(np.arange(len(self._scene.walls)), np.diff(self._scene.walls.edge_offsets))

    @cached_property
    def _tree(self) -> Any:
        """The boxes of the edges, of an arc that of its chord widened by its bow."""
        walls = self._scene.walls
        a, b = walls.vertices[walls.edge_starts], walls.vertices[walls.edge_ends]
        bulge = np.abs(walls.bulges[walls.edge_starts])
        # With half the chord h and bulge k the sagitta is h k. An arc beyond a half circle is wider than its chord, by
        # R - h = h (1 - k)^2 / 2 k on each side, which is less than that.
        bow = (np.hypot(*(b - a).T) / 2 * bulge)[:, None]
        low, high = np.minimum(a, b) - bow, np.maximum(a, b) + bow
        return shapely.STRtree(shapely.box(low[:, 0], low[:, 1], high[:, 0], high[:, 1]))


def _unit(z: complex) -> complex:
    """Part by part: what looks along an axis stays exact, which a division of complex numbers does not see to."""
    size = abs(z)
    return complex(z.real / size, z.imag / size)
