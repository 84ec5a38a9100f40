"""Windows by unfolding: a triangulated room, and the beams from a point in it."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from importers.errors import LimitError
from wallkit.geometry.arrays import FloatArray, IntArray
from wallkit.geometry.constrained_delaunay import Mesh, triangulate
from wallkit.geometry.noded_segments import MOST_MEETINGS, Noded, node
from wallkit.geometry.orientation import side
from wallkit.kernels.beams.beams import DONE, split_beams
from wallkit.kernels.beams.wedges import EVENTS, EXIT, FRAME, NUMBERS, OPEN, SEARCH, Found, Room, Target
from wallkit.kernels.compile_aside import at_hand
from wallkit.kernels.jit import compile_for, compiled
from wallkit.kernels.signatures import kinds_of
from wallkit.levels.obstacles import Obstacles
from wallkit.scene.scene import SceneError

ROWS, LETTERS = 1 << 14, 1 << 22
"""Of what is found, before it is taken out, with so many letters of words at most; wedges that may wait, at first."""
SLICE = 1 << 20
"""Beams between two looks whether the work was interrupted."""
FRAME_SIZE = 0.5
"""Of the diagonal of everything: how far the frame stands from it. Rays that come to the frame have left the room."""


class Unfolded(NamedTuple):
    """What the beams came to, a row each.

    Attributes:
        low: (n,) direction of the right border, radians from -pi to pi.
        high: (n,) that of the left border, above low.
        bounces: (n,) int.
        search: (n,) bool: the directions come to what is not to be unfolded, after so many bounces.
        words: (n, K) obstacles bounced off, in order; -1 behind the last.
        beams: (K + 1,) beams by depth.
        lost: radians that were too narrow to follow.
    """

    low: FloatArray
    high: FloatArray
    bounces: IntArray
    search: Any
    words: IntArray
    beams: IntArray
    lost: float


def unfold(
    obstacles: Obstacles,
    start: tuple[float, float],
    target: tuple[float, float, float],
    bounces: int,
    most_beams: int,
    progress: Callable[[int], None] | None = None,
) -> Unfolded:
    """Find all directions in which a point reaches a disc after at most so many bounces.

    Args:
        obstacles: what stops the point.
        start: where it starts.
        target: centre and radius of the disc; a path ends where it enters it.
        bounces: K.
        most_beams: a limit.
        progress: called now and then with the beams so far.

    Raises:
        SceneError: the start lies on an obstacle.
        LimitError: there are more beams.
    """
    mesh, walls = _mesh(obstacles, start, target)
    room = _room(mesh, walls, obstacles, start)
    aim = Target(target[0] - start[0], target[1] - start[1], target[2])
    found = _found(room, _first_wedges(mesh, room, start), bounces)
    taken: list[tuple[FloatArray, IntArray]] = []
    total = 0
    while True:
        most = min(SLICE, most_beams + 1 - total)
        done = compiled(split_beams)(room, aim, bounces, found, most) == DONE
        rows, total = int(found.counts[0]), int(found.counts[2:].sum())
        taken.append((found.borders[:rows].copy(), found.words[:rows].copy()))
        found.counts[0] = 0
        if total > most_beams:
            raise LimitError(
                f"more than {most_beams:,} beams within {bounces} bounces",
                code="too-many-beams",
                fix="allow fewer bounces, or more beams (most_beams=, --most-beams)",
            )
        if done:
            break
        if progress is not None:
            progress(total)
        if found.counts[1] + 2 * EVENTS > len(found.floats):
            found = found._replace(floats=_twice(found.floats), numbers=_twice(found.numbers))
    borders, words = (np.concatenate(parts) for parts in zip(*taken, strict=True))
    low, high = np.arctan2(borders[:, 1], borders[:, 0]), np.arctan2(borders[:, 3], borders[:, 2])
    high = np.where(high < low, high + 2.0 * np.pi, high)
    known = np.arange(bounces)[None, :] < words[:, 1:2]
    return Unfolded(low, high, words[:, 1], words[:, 0] == SEARCH, np.where(known, words[:, 2:], -1),
                    found.counts[2:], float(found.lost[0]))  # fmt: skip


def unfolding_at_hand() -> bool:
    """Tell whether beams can be followed at once; where not, the kernel is being compiled aside from now on."""
    return at_hand(compile_for, split_beams, *_kinds())


def warm_unfolding() -> None:
    """Compile the kernel that follows beams, or load it."""
    compile_for(split_beams, *_kinds())


def _kinds() -> tuple[Any, ...]:
    none, numbers = np.zeros(3), np.zeros(3, dtype=np.int64)
    room = Room(none, none, numbers, numbers, np.zeros((1, 4)))
    arguments = room, Target(0.0, 0.0, 1.0), 1, _found(room, [], 1), 1
    return kinds_of(arguments)


def _twice(array: Any) -> Any:
    return np.concatenate([array, np.zeros_like(array)])


def _mesh(obstacles: Obstacles, start: tuple[float, float], target: tuple[float, float, float]) -> tuple[Mesh, Noded]:
    """Triangulate the obstacles in a frame; and pair pieces with the obstacles on them.

    Raises:
        LimitError: they are a tangle.
    """
    noded = node(obstacles.a, obstacles.b)
    if noded is None:
        raise LimitError(
            f"the walls meet at more than {MOST_MEETINGS:,} places", code="tangled", fix="see wallkit check: --resolve"
        )
    x, y, r = target
    places = np.concatenate([noded.points, [start, (x - r, y - r), (x + r, y + r)]])
    low, high = places.min(axis=0), places.max(axis=0)
    beyond = FRAME_SIZE * (float(np.hypot(*(high - low))) or 1.0)
    (x0, y0), (x1, y1) = low - beyond, high + beyond
    points = np.concatenate([noded.points, [(x0, y0), (x1, y0), (x1, y1), (x0, y1)]])
    return triangulate(points, noded.pieces), noded


def _room(mesh: Mesh, noded: Noded, obstacles: Obstacles, start: tuple[float, float]) -> Room:
    """Tell the kernels what stops a point at which half-edge, and how it mirrors."""
    own = mesh.points[mesh.corners] - np.array(start)
    wall = np.where(mesh.across < 0, EXIT, OPEN)
    h = np.flatnonzero(mesh.segment >= 0)
    first = 3 * (h // 3)
    along = mesh.points[mesh.corners[first + (h + 2) % 3]] - mesh.points[mesh.corners[first + (h + 1) % 3]]
    order = np.argsort(noded.piece, kind="stable")
    begin = np.searchsorted(noded.piece[order], np.arange(len(noded.pieces) + 1))
    d = obstacles.b - obstacles.a
    for rank in range(
        int(np.diff(begin).max(initial=0))
    ):  # several where obstacles lie on one another: the first stops
        has = begin[mesh.segment[h]] + rank < begin[mesh.segment[h] + 1]
        owner = noded.owner[order[np.minimum(begin[mesh.segment[h]] + rank, len(order) - 1)]]
        from_outside = (along * d[owner]).sum(axis=1) < 0.0  # the triangle is left of its edge, outside right of it
        stops = has & (wall[h] == OPEN) & (from_outside | ~obstacles.one_sided[owner])
        wall[h[stops]] = owner[stops]
    length = np.hypot(*d.T)
    n = np.stack([d[:, 1], -d[:, 0]], axis=1) / np.where(length > 0.0, length, 1.0)[:, None]
    offset = (n * (obstacles.a - np.array(start))).sum(axis=1)
    mirrors = np.column_stack([n, offset, obstacles.twice])
    x, y = np.ascontiguousarray(own[:, 0]), np.ascontiguousarray(own[:, 1])
    return Room(x, y, mesh.across.astype(np.int64), wall.astype(np.int64), np.ascontiguousarray(mirrors))


def _first_wedges(mesh: Mesh, room: Room, start: tuple[float, float]) -> list[int]:
    """Give the half-edges around the start: those of its triangle, or of the two that share the edge it lies on.

    Raises:
        SceneError: it lies on an obstacle.
    """
    corners = mesh.corners.reshape(-1, 3)
    place = np.broadcast_to(np.array(start), (len(corners), 2))
    p = mesh.points
    sides = [side(p[corners[:, (i + 1) % 3]], p[corners[:, (i + 2) % 3]], place) for i in range(3)]
    inside = np.flatnonzero(np.logical_and.reduce([one >= 0 for one in sides]))
    around = [3 * t + i for t in inside.tolist() for i in range(3) if sides[i][t] > 0]
    on = [3 * t + i for t in inside.tolist() for i in range(3) if sides[i][t] == 0]
    if not around or any(room.wall[h] != OPEN or len(inside) > 2 for h in on):
        raise SceneError(
            f"the start ({start[0]:g}, {start[1]:g}) lies on a wall", code="start-on-wall", fix="move it off the wall"
        )
    return around


def _found(room: Room, wedges: list[int], bounces: int) -> Found:
    """Make room for what is found, with the first wedges on the stack."""
    floats, numbers = np.zeros((ROWS, FRAME)), np.zeros((ROWS, NUMBERS), dtype=np.int64)
    for row, h in enumerate(wedges):
        first = 3 * (h // 3)
        right, left = first + (h + 1) % 3, first + (h + 2) % 3
        floats[row] = 1, 0, 0, 1, 0, 0, room.x[left], room.y[left], room.x[right], room.y[right]
        numbers[row] = h, 0, 1
    counts = np.zeros(3 + bounces, dtype=np.int64)
    counts[1:3] = len(wedges)
    rows = min(ROWS, LETTERS // (2 + bounces))
    words = np.zeros((rows, 2 + bounces), dtype=np.int64)
    return Found(counts, np.zeros(1), np.zeros((rows, 4)), words, floats, numbers,
                 np.zeros(bounces + 1, dtype=np.int64), np.zeros((EVENTS + 2, 2)))  # fmt: skip
