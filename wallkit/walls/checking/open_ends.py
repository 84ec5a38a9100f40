"""Open ends of walls, the lines that lead to them, and what is around them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from wallkit.geometry.arrays import FloatArray, IntArray
from wallkit.geometry.exact_edges import ComplexArray, ExactEdges
from wallkit.geometry.orientation import side
from wallkit.geometry.ragged import slices
from wallkit.walls.checking.exact_widths import exact_edges
from wallkit.walls.checking.meetings import meetings, on_edge
from wallkit.walls.near_boxes import NearBoxes
from wallkit.walls.walls import Walls

BoolArray = NDArray[np.bool_]
_AT_ONCE = 1 << 16  # pairs that are looked at together: bounds the memory

ROUNDING = 1e-14  # of the largest coordinate: an end so near a wall was put onto it
OWN = 4.0  # a wall comes back to itself where the way along it is so many times the distance; else it only bends


def portions(count: int) -> Iterator[slice]:
    """Cut so many pairs into portions that are looked at together; one at least."""
    return slices(count, _AT_ONCE)


@dataclass(slots=True, eq=False, repr=False)
class OpenEnds:
    """Open ends: vertex, the vertex before, wall, edge, and the line that leads to them."""

    vertex: IntArray
    wall: IntArray
    edge: IntArray
    step: IntArray  # 1 where the wall goes on at the next vertex, -1 at the one before
    at: ComplexArray
    line: ExactEdges
    straight: BoolArray
    towards: ComplexArray = field(init=False)

    def __post_init__(self) -> None:
        d = self.line.b - self.line.a
        self.towards = d / np.maximum(np.abs(d), 1e-300)

    def take(self, index: IntArray) -> OpenEnds:
        """Give those at ``index``."""
        return OpenEnds(
            self.vertex[index], self.wall[index], self.edge[index], self.step[index], self.at[index],
            self.line.take(index), self.straight[index],
        )  # fmt: skip


@dataclass(slots=True, eq=False, repr=False)
class Surroundings:
    """Walls with what the search asks of them again and again."""

    walls: Walls
    edges: ExactEdges
    edge_wall: IntArray
    starts: IntArray
    stops: IntArray
    boxes: NearBoxes  # around the edges
    along: FloatArray  # (V,) way along its wall to each vertex
    total: FloatArray  # (W,) length of each wall
    there: float

    @classmethod
    def of(cls, walls: Walls) -> Surroundings:
        """Measure walls and put their boxes into a tree."""
        edges = exact_edges(walls)
        length = np.where(edges.radius > 0, np.abs(edges.angle) * edges.radius, np.abs(edges.b - edges.a))
        bow = np.abs(np.tan(edges.angle / 4)) * np.abs(edges.b - edges.a) / 2
        a, b = walls.vertices[walls.edge_starts], walls.vertices[walls.edge_ends]
        boxes = NearBoxes((np.minimum(a, b) - bow[:, None]).T, (np.maximum(a, b) + bow[:, None]).T)
        wall_of = np.repeat(np.arange(len(walls)), np.diff(walls.offsets))
        step = np.zeros(len(walls.vertices))
        step[walls.edge_starts] = length
        along = np.cumsum(step) - step
        along -= along[walls.offsets[:-1]][wall_of]
        edge_wall = wall_of[walls.edge_starts]
        there = ROUNDING * float(np.abs(walls.vertices).max(initial=0.0))
        total = np.bincount(edge_wall, length, len(walls)).astype(np.float64)
        starts, stops = walls.edge_starts, walls.edge_ends
        return cls(walls, edges, edge_wall, starts, stops, boxes, along, total, there)

    def ends(self) -> OpenEnds:
        """All open ends."""
        walls = self.walls
        open_ = np.flatnonzero(~walls.closed & (np.diff(walls.offsets) > 1))
        first, last = walls.offsets[:-1][open_], walls.offsets[1:][open_] - 1
        edge_at = np.full(len(walls.vertices) + 1, -1)
        edge_at[self.starts] = np.arange(len(self.starts))
        vertex = np.concatenate([first, last])
        edge = np.concatenate([edge_at[first], edge_at[last - 1]])
        step = np.repeat([1, -1], len(open_))
        z = walls.vertices[:, 0] + 1j * walls.vertices[:, 1]
        zero = np.zeros(len(vertex))
        line = ExactEdges(z[vertex + step], z[vertex], zero.astype(np.complex128), zero, zero)
        return OpenEnds(vertex, np.tile(open_, 2), edge, step, z[vertex], line, self.edges.radius[edge] == 0)

    def boxes_meet(self, one: IntArray, two: IntArray) -> BoolArray:
        """Tell of pairs of edges whether their boxes meet, or nearly: within what rounding adds to common points."""
        margin = 1e3 * self.there  # 1e-11: the parts of edges at which points lie are off by some 1e-12
        low, high = self.boxes.low, self.boxes.high
        met = np.empty(len(one), dtype=np.bool_)
        for at in portions(len(one)):
            apart = np.maximum(low[:, one[at]] - high[:, two[at]], low[:, two[at]] - high[:, one[at]])
            met[at] = (apart[0] <= margin) & (apart[1] <= margin)
        return met

    def own_bend(self, ends: OpenEnds, edge: IntArray, distance: FloatArray) -> BoolArray:
        """Where an edge is the end's own, or the wall does no more than bend on its way to it."""
        here = self.along[ends.vertex]
        way = np.minimum(np.abs(here - self.along[self.starts[edge]]), np.abs(here - self.along[self.stops[edge]]))
        own: BoolArray = (self.edge_wall[edge] == ends.wall) & ((ends.edge == edge) | (way <= OWN * distance))
        return own


def put_on(scene: Surroundings, edge: int, at: complex, before: complex, end: complex | None) -> complex:
    """A point on an edge, by rounding on the side that the wall comes from: a touch, not a crossing.

    On a line from ``before`` to ``end`` that is level or upright it stays so.
    """
    one = scene.edges.take(np.array([edge]))
    at = complex(one.nearest(np.array([at]))[0])
    if end is not None:
        at = complex(end.real if end.real == before.real else at.real, end.imag if end.imag == before.imag else at.imag)
    if one.radius[0] > 0 or at == before:
        return at
    a, b, source = (np.array([[z.real, z.imag]]) for z in (one.a[0], one.b[0], before))
    origin = int(side(a, b, source)[0])
    back = (before - at) / abs(before - at) * scene.there / 64
    for k in range(7):
        point: complex = at + (2.0**k - 1) * back
        if int(side(a, b, np.array([[point.real, point.imag]]))[0]) * origin >= 0:
            return point
    return at


def in_the_way(scene: Surroundings, start: ComplexArray, stop: ComplexArray) -> BoolArray:
    """Whether a wall is in the way from start to stop: met farther from both than rounding."""
    zero = np.zeros(len(start))
    ends = np.stack([start.real, stop.real]), np.stack([start.imag, stop.imag])
    low, high = (np.stack([extreme(part, axis=0) for part in ends]) for extreme in (np.min, np.max))
    piece, edge = scene.boxes.query(low, high)
    way = ExactEdges(start[piece], stop[piece], zero.astype(np.complex128)[piece], zero[piece], zero[piece])
    f = scene.edges.take(edge)
    result = np.zeros(len(start), dtype=np.bool_)
    for point in meetings(way, f).T:
        with np.errstate(invalid="ignore"):
            inner = np.minimum(np.abs(point - way.a), np.abs(point - way.b)) > scene.there
            result[piece[inner & on_edge(way, point) & on_edge(f, point)]] = True
    return result
