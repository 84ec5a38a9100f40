"""Which parts of the plane are material: walked from the outside through the walls, each told as it is passed."""

from __future__ import annotations

import heapq
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from wallkit.geometry.arrays import FloatArray, IntArray
from wallkit.geometry.triangulation import Triangulation
from wallkit.walls.checking.material import Solids
from wallkit.walls.checking.room_circles import joined, triangles_at
from wallkit.walls.noding import Pieces


class _Doors(NamedTuple):
    """Ways from part to part through a piece of walls, by parts: those from part p are first[p] to first[p + 1]."""

    first: list[int]
    into: list[int]
    walls: list[tuple[int, ...]]


def in_material(
    solids: Solids, mesh: Triangulation, pieces: Pieces, copy_of: IntArray, points: FloatArray
) -> NDArray[np.bool_]:
    """Tell which of (n, 2) points, on no wall, lie in material: as ``solids.contain``, in n log n for any nesting.

    A step through a piece of walls leads out of, or into, each closed wall that lies on it an odd number of times,
    and no other. So one walk over all parts, each entered once and left the way that it was entered, knows what is
    around it without asking every wall there.

    Args:
        solids: of the walls.
        mesh: triangles of the pieces.
        pieces: of the walls.
        copy_of: (W,) the first wall with the same edges.
        points: the places.
    """
    if not solids.sign.any():  # only closed walls hold material
        return np.zeros(len(points), dtype=np.bool_)
    edge = _edges_of(mesh, pieces)
    if len(points) == 0 or (edge < 0).any():  # pieces that came to nothing: ask each wall
        return solids.contain(points)
    part = joined(mesh, ~mesh.wall)
    outside = int(part[np.flatnonzero(mesh.outer[mesh.edge].any(axis=1))[0]])
    material = _walked(solids, copy_of, _doors(mesh, part, edge, pieces, solids.sign != 0), outside)
    triangle = triangles_at(mesh, points)
    result: NDArray[np.bool_] = material[np.where(triangle >= 0, part[triangle], outside)]
    return result


def _edges_of(mesh: Triangulation, pieces: Pieces) -> IntArray:
    """The edge of the mesh that each piece is: (n,); -1 where none has both its ends, to the bit."""
    known = mesh.points[:-4, 0] + 1j * mesh.points[:-4, 1]
    order = np.argsort(known, kind="stable")
    ends = np.stack([part[:, 0] + 1j * part[:, 1] for part in (pieces.a, pieces.b)])
    at = order[np.minimum(np.searchsorted(known, ends, sorter=order), len(known) - 1)]
    count = len(mesh.points)
    keys = mesh.ends.min(axis=1) * count + mesh.ends.max(axis=1)  # which rise
    asked = at.min(axis=0) * count + at.max(axis=0)
    edge = np.minimum(np.searchsorted(keys, asked), len(keys) - 1)
    there = (keys[edge] == asked) & (known[at] == ends).all(axis=0) & mesh.wall[edge]
    result: IntArray = np.where(there, edge, -1)
    return result


def _doors(mesh: Triangulation, part: IntArray, edge: IntArray, pieces: Pieces, closed: NDArray[np.bool_]) -> _Doors:
    """The ways through walls, one from a part to each next to it."""
    kept = closed[pieces.wall]
    keys, times = np.unique(edge[pieces.piece[kept]] * len(closed) + pieces.wall[kept], return_counts=True)
    on, wall = np.divmod(keys[times % 2 == 1], len(closed))
    begin, end = (np.searchsorted(on, np.arange(len(mesh.ends)), side) for side in ("left", "right"))
    one, two = np.repeat(part, 3), part[mesh.neighbours.ravel()]
    passed = mesh.edge.ravel()
    some = np.flatnonzero((mesh.neighbours.ravel() >= 0) & mesh.wall[passed] & (one != two))
    count = int(part.max()) + 1
    some = some[np.unique(one[some] * count + two[some], return_index=True)[1]]  # sorted by the first part
    names = wall.tolist()
    spans = zip(begin[passed[some]].tolist(), end[passed[some]].tolist(), strict=True)
    first: list[int] = np.searchsorted(one[some], np.arange(count + 1)).tolist()
    return _Doors(first, two[some].tolist(), [tuple(names[low:high]) for low, high in spans])


def _walked(solids: Solids, copy_of: IntArray, doors: _Doors, outside: int) -> NDArray[np.bool_]:
    """Walk through all parts, depth first: (P,) which of them are material."""
    sign: list[int] = np.bincount(copy_of, solids.sign, len(copy_of)).astype(np.int64).tolist()
    last = np.zeros(len(copy_of), dtype=np.int64)
    last[copy_of] = np.arange(len(copy_of))  # of walls as large it says what is beyond
    beyond, size, rank = (solids.sign[last] < 0).tolist(), solids.size.tolist(), last.tolist()
    inside, level = [False] * len(sign), 0
    largest: list[tuple[float, int, int]] = []  # of the walls around, among others that were around before
    material, seen = np.zeros(len(doors.first) - 1, dtype=np.bool_), [False] * (len(doors.first) - 1)
    seen[outside] = True
    stack: list[tuple[int, tuple[int, ...]]] = [(outside, ())]
    while stack:
        part, walls = stack.pop()
        for wall in walls:
            inside[wall] = not inside[wall]
            level += sign[wall] if inside[wall] else -sign[wall]
            if inside[wall]:
                heapq.heappush(largest, (-size[wall], -rank[wall], wall))
        if part < 0:  # back on the other side
            continue
        while largest and not inside[largest[0][2]]:
            heapq.heappop(largest)
        material[part] = level > 0 if level else beyond[largest[0][2]] if largest else solids.around
        for way in range(doors.first[part], doors.first[part + 1]):
            into = doors.into[way]
            if not seen[into]:
                seen[into] = True
                stack += [(-1, doors.walls[way]), (into, doors.walls[way])]
    return material
