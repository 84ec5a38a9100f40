"""The largest circle of a room: what a disc gets to through triangles, over edges longer than the way out is wide."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from wallkit.geometry.arrays import FloatArray, IntArray, distinct
from wallkit.geometry.components import components
from wallkit.geometry.triangulation import Triangulation
from wallkit.walls.checking.climbing import Segments, climb

MOST_ROOMS = 16  # the roomiest; the others keep the circle that was found
_STARTS = (
    64  # the roomiest triangles of a room, where it is climbed from, and so many times four that may have more room
)


def largest_circles(
    mesh: Triangulation, walls: Segments, circle: FloatArray, place: FloatArray, rooms: FloatArray
) -> FloatArray:
    """Find the largest circle of each room, climbing from its roomiest triangles.

    Args:
        mesh: triangles with the walls among their edges.
        walls: these walls.
        circle: (T,) radius of a circle in each triangle.
        place: (T, 2) its centre.
        rooms: (n, 4) x, y, radius of a circle in each room, and the width of the widest gap that leads out of it.

    Returns:
        (n, 3) x, y, radius; as given where nothing larger is found.
    """
    result = rooms[:, :3].copy()
    chosen = np.argsort(-rooms[:, 2], kind="stable")[:MOST_ROOMS]
    chosen = chosen[2 * rooms[chosen, 2] > rooms[chosen, 3] * (1 + 1e-9)]  # no centre is on the gap itself then
    home = triangles_at(mesh, rooms[chosen, :2])
    starts = [np.empty(0, dtype=np.int64)]
    parts = {width: joined(mesh, ~mesh.wall & (mesh.length > width)) for width in set(rooms[chosen, 3].tolist())}
    of_room = [parts[width] == parts[width][at] for at, width in zip(home, rooms[chosen, 3].tolist(), strict=True)]
    longest = np.where((mesh.corners < len(mesh.points) - 4).all(axis=1), mesh.length[mesh.edge].max(axis=1), 0.0)
    for inside, radius in zip(of_room, rooms[chosen, 2].tolist(), strict=True):
        roomy = np.where(inside & (circle > radius / 2), circle, 0.0)
        starts.append(climbed_from(roomy, longest, inside, radius, (_STARTS, 4 * _STARTS)))
    room = np.repeat(np.arange(len(chosen)), [len(rows) for rows in starts[1:]])
    summit, radius = climb(walls, place[np.concatenate(starts)])
    at = triangles_at(mesh, summit)
    for row, (number, inside) in enumerate(zip(chosen.tolist(), of_room, strict=True)):
        mine = np.flatnonzero((room == row) & (radius > result[number, 2]) & (at >= 0))
        mine = mine[inside[at[mine]]]
        if len(mine):
            best = mine[radius[mine].argmax()]
            result[number] = *summit[best], radius[best]
    return result


def climbed_from(
    circle: FloatArray, longest: FloatArray, inside: NDArray[np.bool_], radius: float, most: tuple[int, int]
) -> IntArray:
    """Choose triangles from whose circles a larger one may be climbed to.

    Args:
        circle: (T,) radius of a circle in each; 0 for those that are not roomy.
        longest: (T,) their longest sides.
        inside: (T,) those that may have more room than they seem to.
        radius: that of the largest circle so far.
        most: how many of the roomiest are taken, and of the longest.
    """
    roomy = np.flatnonzero(circle)
    roomy = roomy[np.argsort(-circle[roomy], kind="stable")[: most[0]]]
    # no place in a triangle is farther from all corners than 1 / sqrt 3 of the longest side
    wide = np.flatnonzero(inside & (longest > math.sqrt(3) * radius))
    wide = wide[np.argsort(-longest[wide], kind="stable")[: most[1]]]
    return distinct(np.concatenate([roomy, wide]))


def triangles_at(mesh: Triangulation, points: FloatArray) -> IntArray:
    """The triangle that each of (n, 2) points is in; -1 where there is none."""
    result = np.full(len(points), -1, dtype=np.int64)
    if not len(points):
        return result
    source, triangle = mesh.boxes.query(points.T, points.T)
    inside = np.ones(len(source), dtype=np.bool_)
    for k in range(3):
        a, b = (mesh.points[mesh.corners[triangle, side]] for side in (k, k - 1))
        c = points[source]
        inside &= (b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0] <= 0  # right of each side, backwards
    result[source[inside]] = triangle[inside]
    return result


def joined(mesh: Triangulation, passable: NDArray[np.bool_]) -> IntArray:
    """Number the parts that triangles make which hang together over passable edges: (T,) the part of each."""
    one = np.repeat(np.arange(len(mesh.corners)), 3)
    two, over = mesh.neighbours.ravel(), passable[mesh.edge.ravel()]
    over = over & (two > one)
    number: IntArray = np.unique(components(one[over], two[over], len(mesh.corners)), return_inverse=True)[1]
    return number.reshape(-1)
