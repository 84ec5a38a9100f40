"""What stops a ball's centre, as segments: walls, moved out by the ball's radius; curves within bands of facets."""

from __future__ import annotations

import math
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from wallkit.geometry.arrays import FloatArray, IntArray
from wallkit.geometry.bulge_arcs import circles
from wallkit.simulation.edge_records import end_normals, lines_of
from wallkit.walls import Walls

FACET = 0.1
"""Radians of an arc that one facet spans, at most: it is off by 0.13 % of the radius."""


class Obstacles(NamedTuple):
    """Segments that stop a centre.

    Attributes:
        a: (n, 2) where they begin.
        b: (n, 2) where they end.
        edge: (n,) the edge of the walls that each belongs to, by its number over all; of a vertex, the edge that begins
            or ends there.
        one_sided: (n,) bool: stops what comes to its right side alone.
        twice: (n,) 1 + f / e of its material, see ``wallkit.kernels.beams.wedges.Mirror``; 0 for a facet: what comes to
            it is to be searched.
    """

    a: FloatArray
    b: FloatArray
    edge: IntArray
    one_sided: NDArray[np.bool_]
    twice: FloatArray


class _Pieces:
    """Obstacles as they come."""

    def __init__(self) -> None:
        self.rows: list[tuple[FloatArray, FloatArray, int, bool, float]] = []

    def line(self, a: FloatArray, b: FloatArray, edge: int, one_sided: bool, twice: float) -> None:
        """Add a segment."""
        self.rows.append((a, b, edge, one_sided, twice))

    def chain(self, points: FloatArray, edge: int) -> None:
        """Add facets through points."""
        for a, b in pairwise(points):
            if (a != b).any():
                self.rows.append((a, b, edge, False, 0.0))

    def obstacles(self) -> Obstacles:
        """Give all of them."""
        if not self.rows:
            none = np.empty((0, 2))
            return Obstacles(none, none, np.empty(0, np.int64), np.empty(0, np.bool_), np.empty(0))
        a, b, edge, one_sided, twice = zip(*self.rows, strict=True)
        return Obstacles(np.array(a), np.array(b), np.array(edge, np.int64), np.array(one_sided), np.array(twice))


def obstacles_of(walls: Walls, radius: float) -> Obstacles:
    """List what stops the centre of a ball.

    A point is stopped by the edges. A disc is stopped by the edges moved out by its radius, to both sides, or to the
    outward one alone; by arcs around vertices; by arcs beside arcs. An arc stands as a band of facets between its
    chords and its tangents, each on the side from which a centre comes.

    Args:
        walls: their materials may not have a restitution of 0.
        radius: of the ball.
    """
    starts, ends = walls.edge_starts, walls.edge_ends
    a, b, bulge = walls.vertices[starts], walls.vertices[ends], walls.bulges[starts]
    lines = lines_of(walls.vertices, walls.offsets, walls.closed, np.zeros(2)).records
    bulge = np.where(lines["length"] > 0.0, bulge, 0.0)
    at_end, at_start = (np.ascontiguousarray(normals.T) for normals in end_normals(lines, bulge))
    centre, around = circles(a, b, bulge)
    pieces, offsets = _Pieces(), walls.edge_offsets.tolist()
    for wall, material in enumerate(walls.materials):
        outward = walls.sides[wall] == "outward"
        twice = 1.0 + material.tangential_restitution / material.restitution
        edges = [e for e in range(offsets[wall], offsets[wall + 1]) if lines["length"][e] > 0.0]
        for e in edges:
            if bulge[e] != 0.0:
                _arc(pieces, e, (a[e], b[e]), (at_start[e], at_end[e]), centre[e], float(around[e]), bulge[e], radius,
                     outward)  # fmt: skip
                continue
            for sign in (1.0, -1.0)[: 1 if outward or radius == 0.0 else 2]:
                off = sign * radius * at_end[e]
                pieces.line(a[e] + off, b[e] + off, e, outward, twice)
        if radius > 0.0 and edges:
            _vertices(pieces, edges, b, a, at_end, at_start, radius, bool(walls.closed[wall]))
    return pieces.obstacles()


def _arc(
    pieces: _Pieces,
    edge: int,
    ends: tuple[FloatArray, FloatArray],
    normals: tuple[FloatArray, FloatArray],
    centre: FloatArray,
    around: float,
    bulge: float,
    radius: float,
    outward: bool,
) -> None:
    """Add the facets of an arc on the sides from which a centre may come.

    With a positive bulge the outward normal points away from the circle's centre. Outside of the circle tangents come
    before the arc, inside chords do. A ball that does not fit into the circle meets the ends first.
    """
    out = 1.0 if bulge > 0.0 else -1.0
    angle = 4.0 * math.atan(bulge)
    for sign in (1.0, -1.0)[: 1 if outward else 2]:
        size = around + sign * out * radius
        if size > 0.0:
            first, last = (ends[i] + sign * radius * normals[i] for i in (0, 1))
            pieces.chain(_facets(centre, first, last, size, angle, tangent=sign * out > 0.0), edge)


def _facets(
    centre: FloatArray, first: FloatArray, last: FloatArray, size: float, angle: float, *, tangent: bool
) -> FloatArray:
    """Points of a polyline from the first to the last point of an arc that turns by an angle: chords or tangents.

    Tangents touch the arc at equal steps and meet half-way between, at the radius over the cosine of half a step. The
    first and the last step are half ones, from the arc's ends.
    """
    count = max(1, math.ceil(abs(angle) / FACET))
    from_angle = math.atan2(*(first - centre)[::-1])
    if tangent:
        turn, size = (np.arange(count) + 0.5) * (angle / count), size / math.cos(0.5 * angle / count)
    else:
        turn = np.arange(1, count) * (angle / count)
    turn = turn + from_angle
    inner = centre + size * np.stack([np.cos(turn), np.sin(turn)], axis=1)
    return np.concatenate([first[None], inner, last[None]])


def _vertices(
    pieces: _Pieces,
    edges: list[int],
    stop: FloatArray,
    begin: FloatArray,
    at_end: FloatArray,
    at_start: FloatArray,
    radius: float,
    closed: bool,
) -> None:
    """Join the moved edges of one wall at its vertices: by an arc where they part, else straight, which is within.

    Where the wall turns left its normals turn left too, and the edges moved to its right part. A free end has half a
    circle, from the right side of its edge to the left.
    """
    following = edges[1:] + edges[:1] if closed else edges[1:]
    for one, other in zip(edges, following, strict=False):
        v, n, m = stop[one], at_end[one], at_start[other]
        turn = math.atan2(n[0] * m[1] - n[1] * m[0], float(n @ m))
        for sign in (1.0, -1.0):
            first, last = v + sign * radius * n, v + sign * radius * m
            if sign * turn > 0.0:
                pieces.chain(_facets(v, first, last, radius, turn, tangent=True), one)
            else:
                pieces.chain(np.stack([first, last]), one)
    if not closed:
        for v, n, e in (
            (stop[edges[-1]], at_end[edges[-1]], edges[-1]),
            (begin[edges[0]], -at_start[edges[0]], edges[0]),
        ):
            pieces.chain(_facets(v, v + radius * n, v - radius * n, radius, math.pi, tangent=True), e)
