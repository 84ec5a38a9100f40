"""Overshoots: open ends that stick out a little beyond another wall."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from wallkit.geometry.arrays import FloatArray, IntArray
from wallkit.geometry.exact_edges import ComplexArray
from wallkit.walls.checking.meetings import meetings, on_edge, part_of
from wallkit.walls.checking.open_ends import OpenEnds, Surroundings

_SECTIONS = 8  # edges at the end of a wall that are looked at for what sticks out
_PART = 0.25  # of a wall: what is beyond another wall by more does not stick out, but crosses


@dataclass(slots=True, eq=False, repr=False)
class Overshoots:
    """For each open end how far it sticks out (along the wall; 0 where it does not), and of what.

    Attributes:
        length: (n,) from the end back to the crossing.
        at: (n,) the crossing.
        edge: (n,) the edge that is crossed.
        sections: (n,) whole edges beyond the crossing.
    """

    length: FloatArray
    at: ComplexArray
    edge: IntArray
    sections: IntArray

    def note(self, row: IntArray, length: FloatArray, at: ComplexArray, edge: IntArray, sections: int) -> None:
        """Keep the farthest crossing of each end."""
        order = np.argsort(length, kind="stable")
        row, length, at, edge = row[order], length[order], at[order], edge[order]
        farther = length > self.length[row]
        row = row[farther]
        self.length[row], self.at[row], self.edge[row] = length[farther], at[farther], edge[farther]
        self.sections[row] = sections


def overshoots(
    scene: Surroundings, ends: OpenEnds, rows: IntArray, near: tuple[IntArray, IntArray], reach: float
) -> Overshoots:
    """Find, for the ends in ``rows``, the farthest crossing with another wall within reach along the own wall.

    What is crossed within reach along the wall is within reach of the end: ``near`` has all such pairs of an end and an
    edge.
    """
    apart = scene.edge_wall[near[1]] != ends.wall[near[0]]
    near = near[0][apart], near[1][apart]
    count = len(ends.at)
    zero = np.zeros(count, dtype=np.int64)
    found = Overshoots(np.zeros(count), np.zeros(count, dtype=np.complex128), zero - 1, zero)
    done = np.zeros(len(rows))
    for k in range(_SECTIONS):
        here = ends.take(rows)
        inner = here.vertex + (k + 1) * here.step
        first, last = scene.walls.offsets[here.wall], scene.walls.offsets[here.wall + 1] - 1
        keep = np.flatnonzero((inner >= first) & (inner <= last) & (done < reach))
        rows, done, here = rows[keep], done[keep], here.take(keep)
        if not len(rows):
            break
        edge = here.edge + k * here.step
        done_after = done + np.abs(scene.along[scene.starts[edge]] - scene.along[scene.stops[edge]])
        _cross(scene, ends, here, rows, edge, near, (done, done_after), reach, k, found)
        done = done_after
    return found


def _cross(
    scene: Surroundings,
    ends: OpenEnds,
    here: OpenEnds,
    rows: IntArray,
    edge: IntArray,
    near: tuple[IntArray, IntArray],
    way: tuple[FloatArray, FloatArray],
    reach: float,
    k: int,
    found: Overshoots,
) -> None:
    """Note the crossings of one edge of each end, ``way[0]`` to ``way[1]`` from the end along the wall."""
    place = np.full(len(ends.at), -1)
    place[rows] = np.arange(len(rows))
    source = place[near[0]]
    source, other = source[source >= 0], near[1][source >= 0]
    met = scene.boxes_meet(edge[source], other)
    source, other = source[met], other[met]
    e, f = scene.edges.take(edge[source]), scene.edges.take(other)
    open_end = np.zeros(len(scene.walls.vertices), dtype=np.bool_)
    open_end[ends.vertex] = True
    for point in meetings(e, f).T:
        with np.errstate(invalid="ignore"):
            part = part_of(e, point)
            part = np.where(here.step[source] > 0, part, 1 - part)  # from the end on
            out = way[0][source] + part * (way[1] - way[0])[source]
            good = on_edge(e, point) & on_edge(f, point) & (out > scene.there) & (out <= reach)
            good &= out <= _PART * scene.total[here.wall[source]]
            for vertex, z in ((scene.starts[other], f.a), (scene.stops[other], f.b)):
                good &= ~(open_end[vertex] & (np.abs(point - z) <= scene.there))  # it ends on this wall: no crossing
        found.note(rows[source[good]], out[good], point[good], other[good], k)
