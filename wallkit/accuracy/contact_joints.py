"""How edges follow one another at a place, for the reference of contact states: by angle, around the place."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Literal

from wallkit.accuracy.contact_guides import Barrier, Guide, minus
from wallkit.accuracy.reference import Real, Reference, Vector, _Arc, _dot, _Line

SMOOTH = 1e-9
"""A turn of less (radians) is none: walls are drawn in doubles."""


@dataclass(frozen=True, slots=True)
class _End:
    """One end of an edge: its obstacle, its place, and the direction in which the edge leaves that."""

    obstacle: int
    place: Vector
    out: Vector
    last: bool  # of the two of its edge, in the direction of the wall


@dataclass(frozen=True, slots=True)
class Joint:
    """What follows at the end of an edge: its barrier on the ball's side, or None; and the vertex for a disc."""

    kind: Literal["hollow", "smooth", "falls"]
    barrier: Barrier | None
    vertex: Barrier | None


class Joints:
    """All places where edges end."""

    def __init__(self, reference: Reference, barriers: list[Barrier]) -> None:
        self.reference, self.mp, self.barriers = reference, reference.mp, barriers
        self.ends_of: dict[int, list[_End]] = {}
        self.around: dict[Vector, list[_End]] = {}
        walls = reference.scene.walls
        for index, obstacle in enumerate(reference.obstacles):
            if obstacle.edge < 0:
                continue
            edge = int(walls.edge_offsets[obstacle.wall]) + obstacle.edge
            for last, number in ((False, walls.edge_starts[edge]), (True, walls.edge_ends[edge])):
                place = reference._vector(walls.vertices[number])
                end = _End(index, place, self._out(index, place, last), last)
                self.ends_of.setdefault(index, []).append(end)
                self.around.setdefault(place, []).append(end)

    def _out(self, index: int, place: Vector, last: bool) -> Vector:
        shape = self.reference.obstacles[index].shape
        if isinstance(shape, _Line):
            length = self.mp.sqrt(shape.length2)
            along = shape.along[0] / length, shape.along[1] / length
        else:
            assert isinstance(shape, _Arc)
            x, y = minus(place, shape.centre)
            turn = (1 if shape.turns_left else -1) / shape.radius
            along = -turn * y, turn * x
        return (-along[0], -along[1]) if last else along

    def _places(self, barrier: Barrier) -> list[Vector]:
        if barrier.obstacle in self.ends_of:
            return [end.place for end in self.ends_of[barrier.obstacle]]
        return [barrier.anchor]

    def ends(self, guide: Guide) -> Iterator[Real]:
        """Ways ahead at which the edge ends, or the fan of the vertex."""
        mp, held = self.mp, guide.barrier
        shape = self.reference.obstacles[held.obstacle].shape
        if isinstance(shape, _Line):
            for end in self.ends_of[held.obstacle]:
                if _dot(end.out, guide.ahead) < 0:
                    yield max(_dot(minus(end.place, guide.place), guide.ahead), mp.mpf(0))
        elif isinstance(shape, _Arc):
            counter = guide.out[0] * guide.ahead[1] - guide.out[1] * guide.ahead[0] > 0
            for end in self.ends_of[held.obstacle]:
                if end.last == (counter == shape.turns_left):
                    x, y = minus(end.place, shape.centre)
                    way = mp.atan2(_dot((x, y), guide.ahead), _dot((x, y), guide.out)) % (2 * mp.pi)
                    yield way if way < 2 * mp.pi - mp.mpf(10) ** -18 else mp.mpf(0)
        else:
            least = mp.mpf(10) ** (-self.reference.digits // 2)
            for end in self.around[held.anchor]:
                wave = mp.mpf(0), -_dot(guide.out, end.out), -_dot(guide.ahead, end.out)
                yield from guide.falls(mp, wave, least)

    def next(self, held: Barrier, position: Vector, ahead: Vector) -> Joint:
        """What follows where a ball comes to the end of what it keeps to, in a direction."""
        mp = self.mp
        normal = held.normal_at(mp, position)
        if held.obstacle not in self.ends_of:
            end = max(self.around[held.anchor], key=lambda end: _dot(normal, end.out))
            return Joint("smooth", self._barrier(end, normal), held)
        foot = position[0] - held.radius * normal[0], position[1] - held.radius * normal[1]
        end = min(self.ends_of[held.obstacle], key=lambda end: _square(minus(end.place, foot)))
        vertex = self._vertex(end.place)
        turn = 1 if ahead[0] * normal[1] - ahead[1] * normal[0] < 0 else -1  # from back along the edge to the normal
        best, found = 2 * mp.pi, None
        for other in self.around[end.place]:
            if other is end:
                continue
            x, y = -_dot(ahead, other.out), -turn * (ahead[0] * other.out[1] - ahead[1] * other.out[0])
            angle = mp.atan2(y, x) % (2 * mp.pi)
            if angle < best:
                best, found = angle, other
        if found is None:
            return Joint("falls", None, vertex)
        barrier = self._barrier(found, (turn * found.out[1], -turn * found.out[0]))
        if barrier is None or best > mp.pi + SMOOTH:
            return Joint("falls", barrier, vertex)
        return Joint("smooth" if best > mp.pi - SMOOTH else "hollow", barrier, vertex)

    def _barrier(self, end: _End, normal: Vector) -> Barrier | None:
        """The side of an edge that has this normal at its end."""
        for barrier in self.barriers:
            if barrier.obstacle == end.obstacle and _dot(barrier.normal_at(self.mp, end.place), normal) > 0:
                return barrier
        return None

    def _vertex(self, place: Vector) -> Barrier | None:
        for barrier in self.barriers:
            if barrier.obstacle not in self.ends_of and barrier.anchor == place:
                return barrier
        return None

    def is_free_side(self, barrier: Barrier, down: Vector) -> bool:
        """Tell whether a point laid on a line along gravity is on this side of it.

        It is outward of a closed wall, and of an open one where that turns to below the line, if it turns to one side.
        """
        obstacle, shape = self.reference.obstacles[barrier.obstacle], self.reference.obstacles[barrier.obstacle].shape
        assert isinstance(shape, _Line)
        out, index = bool(_dot(barrier.normal, shape.unit_normal) > 0), barrier.obstacle
        while not self.reference.scene.walls.closed[obstacle.wall]:
            end = min(self.ends_of[index], key=lambda end: _dot(end.out, down))
            others = [other for other in self.around[end.place] if other is not end]
            if len(others) != 1:
                break
            turn, following = down[0] * others[0].out[1] - down[1] * others[0].out[0], others[0].obstacle
            if abs(turn) <= SMOOTH and _dot(down, others[0].out) > 0:
                arc, index = self.reference.obstacles[following].shape, following
                if isinstance(arc, _Line):
                    continue
                assert isinstance(arc, _Arc)
                turn = 1 if arc.turns_left != others[0].last else -1
            return bool((turn > 0) == (down[0] * barrier.normal[1] - down[1] * barrier.normal[0] > 0))
        return out

    def is_before(self, vertex: Barrier, place: Vector) -> bool:
        """Tell whether a disc that touches a vertex of a one-sided wall is outside it, and stands across none of it.

        It stands across an edge beside which its centre is, and is behind the wall against the normals of its edges.
        """
        (x, y), normals = minus(place, vertex.anchor), (self.mp.mpf(0), self.mp.mpf(0))
        for end in self.around[vertex.anchor]:
            if x * end.out[0] + y * end.out[1] > SMOOTH * self.reference.size:
                return False
            turn = -1 if end.last else 1  # the outward normal is on the right of the wall's way
            normals = normals[0] + turn * end.out[1], normals[1] - turn * end.out[0]
        return bool(_dot((x, y), normals) >= 0)

    def passes(self, held: Barrier, other: Barrier, position: Vector) -> bool:
        """Tell whether what is met is a joint of the two: what follows there is told by ``next``."""
        places = [place for place in self._places(held) if place in self._places(other)]
        if not places:
            return False
        if other.obstacle not in self.ends_of:
            return True
        normal = other.normal_at(self.mp, position)
        foot = position[0] - other.radius * normal[0], position[1] - other.radius * normal[1]
        near = (SMOOTH * self.reference.size) ** 2
        return any(_square(minus(place, foot)) <= near for place in places)


def _square(a: Vector) -> Real:
    return _dot(a, a)
