"""The exact nearest points of lines and arcs, for what was found on the lines put in their place."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from wallkit.geometry.arrays import FloatArray, IntArray
from wallkit.walls.walls import Walls

ComplexArray = NDArray[np.complex128]

_FLAT = 1e-9  # an arc of a smaller bulge bows by less than 1e-9 of its chord and counts as a line here


@dataclass(slots=True)
class ExactEdges:
    """Lines and arcs as complex numbers: end points, and for arcs centre, radius and the angle that is turned by.

    Attributes:
        a: (n,) start points.
        b: (n,) end points.
        centre: (n,) of arcs; 0 for lines.
        radius: (n,) of arcs; 0 for lines.
        angle: (n,) that an arc turns by; 0 for lines.
    """

    a: ComplexArray
    b: ComplexArray
    centre: ComplexArray
    radius: FloatArray
    angle: FloatArray

    @classmethod
    def of(cls, walls: Walls) -> ExactEdges:
        """Take all edges of walls."""
        z = walls.vertices[:, 0] + 1j * walls.vertices[:, 1]
        a, b, bulge = z[walls.edge_starts], z[walls.edge_ends], walls.bulges[walls.edge_starts]
        round_ = np.abs(bulge) > _FLAT
        k = np.where(round_, bulge, 1.0)
        centre = np.where(round_, (a + b) / 2 + 1j * (b - a) * (1 - k * k) / (4 * k), 0)
        radius = np.where(round_, np.abs(b - a) * (1 + k * k) / (4 * np.abs(k)), 0.0)
        return cls(a, b, centre, radius, np.where(round_, 4 * np.arctan(bulge), 0.0))

    def take(self, index: IntArray) -> ExactEdges:
        """Give those at ``index``."""
        return ExactEdges(self.a[index], self.b[index], self.centre[index], self.radius[index], self.angle[index])

    def nearest(self, point: ComplexArray) -> ComplexArray:
        """Give each edge's point nearest to its ``point``."""
        d = self.b - self.a
        square = np.abs(d) ** 2
        part = np.divide(((point - self.a) * d.conj()).real, square, out=np.zeros(len(d)), where=square > 0)
        on_line: ComplexArray = self.a + d * np.clip(part, 0.0, 1.0)
        if not self.radius.any():
            return on_line
        off = point - self.centre
        with np.errstate(divide="ignore", invalid="ignore"):
            on_circle = self.centre + off / np.abs(off) * self.radius
            turned = np.angle(off / (self.a - self.centre))
        turned = np.where(self.angle < 0, -turned, turned) % (2 * np.pi)
        end = np.where(np.abs(point - self.a) <= np.abs(point - self.b), self.a, self.b)
        on_arc = np.where((turned <= np.abs(self.angle)) & (off != 0), on_circle, end)
        result: ComplexArray = np.where(self.radius > 0, on_arc, on_line)
        return result


def nearest_pair(edges: ExactEdges, a: complex, b: complex, reach: float) -> tuple[complex, complex]:
    """Sharpen two points of two walls to the two that are nearest to each other thereabouts.

    Nearest points are ends of edges with their feet on the other edge, or the points of two circles (of a circle
    and a line) on the line through both centres (through the centre, square to the line): all are tried.

    Args:
        edges: all edges.
        a: a point within ``reach`` of one of them.
        b: a point within ``reach`` of another.
        reach: how far the points may move.
    """
    every = np.ones(len(edges.a), dtype=np.complex128)
    near_a = np.flatnonzero(np.abs(edges.nearest(a * every) - a) <= reach)
    near_b = np.flatnonzero(np.abs(edges.nearest(b * every) - b) <= reach)
    one, two = (grid.ravel() for grid in np.meshgrid(near_a, near_b, indexing="ij"))
    one, two = one[one != two], two[one != two]
    e, f = edges.take(one), edges.take(two)
    best, width = (a, b), np.inf
    for seed in _seeds(e, f):
        q = f.nearest(seed)
        p = e.nearest(q)
        here = (np.abs(p - a) <= reach) & (np.abs(q - b) <= reach) & (np.abs(p - q) >= abs(a - b) / 2)
        distance = np.where(here, np.abs(p - q), np.inf)
        if len(distance) and distance.min() < width:
            k = int(distance.argmin())
            best, width = (complex(p[k]), complex(q[k])), float(distance[k])
    return best


def _seeds(e: ExactEdges, f: ExactEdges) -> list[ComplexArray]:
    """Points on or near ``e`` that its nearest point to ``f`` is among, once it is projected to and fro."""
    seeds = [e.a, e.b, e.nearest(f.a), e.nearest(f.b)]
    to_line = 1j * (f.b - f.a)
    towards = np.where(f.radius > 0, f.centre - e.centre, to_line)
    with np.errstate(divide="ignore", invalid="ignore"):
        towards = np.where(towards != 0, towards / np.abs(towards), 1)
    around = (e.centre + side * e.radius * towards for side in (1, -1))
    return seeds + [np.where(e.radius > 0, place, e.nearest(f.centre)) for place in around]
