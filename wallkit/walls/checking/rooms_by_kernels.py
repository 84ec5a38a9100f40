"""Free space by compiled kernels, where there are very many triangles: the bits of NumPy, in a fraction of the time."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from wallkit.geometry.arrays import FloatArray, IntArray
from wallkit.geometry.triangulation import Triangulation, triangulate
from wallkit.kernels.compile_aside import at_hand
from wallkit.kernels.jit import compiled
from wallkit.kernels.rooms.nearest_wall import nearest_walls
from wallkit.kernels.rooms.widest_ways import unite, walk_out

_KERNELS_PAY = 1 << 15
"""So many triangles take NumPy, and lists, longer than kernels that have to be loaded."""


def kernels_pay(mesh: Triangulation) -> bool:
    """Tell whether kernels are quicker; where they have to be compiled, another process does that."""
    return len(mesh.corners) >= _KERNELS_PAY and at_hand(look_at_a_few)


def wall_distances(mesh: Triangulation, triangle: IntArray, place: FloatArray) -> FloatArray:
    """Give the distance of each of (n, 2) places, in triangles (n,), from the nearest wall: (n,)."""
    count = len(mesh.corners)
    result, queue, entered = np.empty(len(place)), np.empty(count, dtype=np.int64), np.full(count, -1)
    net = mesh.points, mesh.corners, mesh.neighbours, mesh.edge, mesh.wall
    compiled(nearest_walls)(*net, triangle, place, entered, queue, result)
    return result


def one_by_one(
    kernel: Callable[..., Any], mesh: Triangulation, given: tuple[Any, ...], written: tuple[Any, ...]
) -> Any:
    """Call a kernel with what is given and what it writes; interpreted with lists, quicker than arrays item by item."""
    if kernels_pay(mesh):
        return compiled(kernel)(*given, *written)
    lists = [array.tolist() for array in written]
    result = kernel(*(one.tolist() if isinstance(one, np.ndarray) else one for one in given), *lists)
    for array, one in zip(written, lists, strict=True):
        array[:] = one
    return result


def look_at_a_few() -> None:
    """Ask each kernel about two triangles: the task of their compiling."""
    square = np.array([(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)])
    mesh = triangulate(square, np.roll(square, -1, axis=0))
    assert mesh is not None
    inner = np.flatnonzero((mesh.corners < 4).all(axis=1))
    wall_distances(mesh, inner, mesh.points[mesh.corners[inner]].mean(axis=1))
    none, whole = np.empty(0), np.zeros(1, dtype=np.int64)
    compiled(unite)(whole[:0], whole[:0], none, none, 0.5, 0.0, whole[:0], whole[:0], whole[:0])
    compiled(walk_out)(whole, whole[:0], whole[:0], none, 0, whole[:0], whole[:0], none, whole[:0])
