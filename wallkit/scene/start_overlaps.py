"""Room at the start: which balls overlap a wall, by how much, and where the nearest free spot is."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from wallkit.geometry.arrays import FloatArray, IntArray
from wallkit.geometry.exact_edges import ExactEdges, as_complex
from wallkit.geometry.ragged import spread
from wallkit.scene.scene import Scene, SceneError
from wallkit.walls import Walls

TOUCHING = 2.0**-44
"""An overlap of this part of the scene's size is contact, as rounded."""
DIRECTIONS = 48
RINGS = 60


def check_starts(scene: Scene) -> None:
    """Refuse discs that overlap a two-sided wall where they start; one-sided walls may be come through.

    Raises:
        SceneError: the first of them, with place, depth and wall.
    """
    radius = np.asarray(scene.balls.radius)
    if not np.any(radius > 0.0):
        return
    position = np.asarray(scene.balls.position)
    gap, edge = clearances(scene.walls, position, radius)
    size = _size(scene.walls)
    overlapping = np.flatnonzero(gap < radius - TOUCHING * size)
    if not len(overlapping):
        return
    ball = int(overlapping[0])
    wall = int(np.searchsorted(scene.walls.edge_offsets, edge[ball], side="right") - 1)
    name = f" ({scene.walls.names[wall]})" if scene.walls.names[wall] else ""
    more = f"; {len(overlapping) - 1} more balls overlap" if len(overlapping) > 1 else ""
    raise SceneError(
        f"ball {ball} at ({position[ball, 0]:g}, {position[ball, 1]:g}) overlaps wall {wall}{name} "
        f"by {radius[ball] - gap[ball]:.6g}{more}",
        code="overlap",
        fix="move it, make it smaller, or let it settle on the nearest free spot (settle)",
    )


def check_apart(scene: Scene) -> None:
    """Refuse discs that overlap one another where they start; those that touch, up to rounding, may.

    Raises:
        SceneError: the first two of them, with places and depth.
    """
    discs = np.flatnonzero(scene.balls.radius > 0.0)
    position, radius = scene.balls.position[discs], scene.balls.radius[discs]
    one, two = close_pairs(position, float(radius.max(initial=0.0)))
    gap = np.hypot(*(position[one] - position[two]).T) - (radius[one] + radius[two])
    size = max(_size(scene.walls) if len(scene.walls) else 0.0, float(np.abs(position).max(initial=0.0)))
    overlapping = np.flatnonzero(gap < -TOUCHING * size)
    if not len(overlapping):
        return
    first = overlapping[np.lexsort((discs[two[overlapping]], discs[one[overlapping]]))[0]]
    (x, y), (u, v) = position[one[first]].tolist(), position[two[first]].tolist()
    more = f"; {len(overlapping) - 1} more pairs overlap" if len(overlapping) > 1 else ""
    raise SceneError(
        f"ball {discs[one[first]]} at ({x:g}, {y:g}) and ball {discs[two[first]]} at ({u:g}, {v:g}) overlap "
        f"by {-gap[first]:.6g}{more}",
        code="balls-overlap",
        fix="move them apart, make them smaller, or leave out meeting",
    )


def close_pairs(position: FloatArray, radius: float) -> tuple[IntArray, IntArray]:
    """Pairs (lower, higher) of places that may be within two radii: those in the same cell or in neighbouring ones."""
    if len(position) < 2:
        return np.empty(0, dtype=np.int64), np.empty(0, dtype=np.int64)
    low, extent = position.min(axis=0), float(np.ptp(position, axis=0).max())
    side = max(2.0 * radius * (1.0 + 2.0**-20), extent * 2.0**-24) or 1.0
    column, row = np.floor((position - low) / side).astype(np.int64).T
    stride = int(column.max()) + 3
    key = row * stride + column
    order = np.argsort(key, kind="stable")
    sorted_keys = key[order]
    pairs = []
    for first, last in ((0, 1), (stride - 1, stride + 1)):  # this cell and the next one; three in the row above
        begin = np.searchsorted(sorted_keys, sorted_keys + first)
        end = np.searchsorted(sorted_keys, sorted_keys + last, side="right") - 1
        if first == 0:
            begin = np.arange(len(order)) + 1
        which, rank = spread(begin, end)
        pairs.append(np.sort(np.stack([order[which], order[rank]]), axis=0))
    found = np.concatenate(pairs, axis=1)
    return found[0], found[1]


def settled(scene: Scene) -> Scene:
    """Give the scene with each overlapping disc moved to the nearest free spot.

    The spots looked at lie on rings about the start, ever wider, in ``DIRECTIONS`` directions; the nearest free one is
    then drawn in by bisection until the disc touches.

    Raises:
        SceneError: there is no room for a ball within the size of the scene.
    """
    radius = np.asarray(scene.balls.radius)
    position = np.array(scene.balls.position)
    gap, _edge = clearances(scene.walls, position, radius)
    for ball in np.flatnonzero(gap < radius):
        position[ball] = _nearest_free(scene.walls, position[ball], float(radius[ball]))
    return replace(scene, balls=replace(scene.balls, position=position))


def clearances(walls: Walls, position: FloatArray, reach: FloatArray) -> tuple[FloatArray, IntArray]:
    """Measure the distance from each place to the nearest two-sided wall: (distance, edge); inf and -1 beyond reach."""
    distance = np.full(len(position), np.inf)
    nearest = np.full(len(position), -1, dtype=np.int64)
    sides = np.repeat([s == "both" for s in walls.sides], np.diff(walls.edge_offsets))
    edges = np.flatnonzero(sides)
    if not len(edges) or not len(position):
        return distance, nearest
    place, edge = _near_pairs(walls, edges, position, float(reach.max()))
    d = _distances(walls, edge, position[place])
    near = d <= reach[place]
    place, edge, d = place[near], edge[near], d[near]
    order = np.lexsort((-edge, -d, place))  # the nearest of each place comes last and stays
    distance[place[order]], nearest[place[order]] = d[order], edge[order]
    return distance, nearest


def _near_pairs(walls: Walls, edges: IntArray, position: FloatArray, reach: float) -> tuple[IntArray, IntArray]:
    """List pairs (place, edge) that may be within reach.

    Places are sorted by rows, and along each row; the box of an edge, widened, has one range of them in each row.
    Boxes are widened by a millionth of the places' extent too, far above the rounding of the sorted keys.
    """
    a, b = walls.vertices[walls.edge_starts[edges]], walls.vertices[walls.edge_ends[edges]]
    bulge = np.abs(walls.bulges[walls.edge_starts[edges]])
    bow = np.hypot(*(b - a).T) / 2 * np.maximum(bulge, np.minimum(1.0, bulge))
    corner = np.array([position[:, 0].min(), position[:, 1].min()])
    width, height = float(position[:, 0].max() - corner[0]), float(position[:, 1].max() - corner[1])
    widened = (reach + 2.0**-20 * (width + height) + bow)[:, None]
    low, high = np.minimum(a, b) - widened - corner, np.maximum(a, b) + widened - corner
    beside = (high[:, 0] >= 0.0) & (low[:, 0] <= width) & (high[:, 1] >= 0.0) & (low[:, 1] <= height)
    near = np.flatnonzero(beside)
    low, high = np.clip(low[near], 0.0, (width, height)), np.clip(high[near], 0.0, (width, height))
    step = max(height / math.sqrt(len(position)), 2.0 * reach) or 1.0
    stride = 2.0 * width or 1.0
    keys = stride * np.floor((position[:, 1] - corner[1]) / step) + (position[:, 0] - corner[0])
    order = np.argsort(keys)
    keys = keys[order]
    box, row = spread(*(np.floor(side[:, 1] / step).astype(np.int64) for side in (low, high)))
    slack = 2.0**-22 * width
    first = np.searchsorted(keys, stride * row + low[box, 0] - slack)
    last = np.searchsorted(keys, stride * row + high[box, 0] + slack, side="right") - 1
    pair, rank = spread(first, last)
    return order[rank], edges[near[box[pair]]]


def _distances(walls: Walls, edge: IntArray, place: FloatArray) -> FloatArray:
    """Distance of each place from the edge beside it."""
    start, end = walls.edge_starts[edge], walls.edge_ends[edge]
    return ExactEdges.of(walls.vertices[start], walls.vertices[end], walls.bulges[start]).distance(as_complex(place))


def _nearest_free(walls: Walls, place: FloatArray, radius: float) -> FloatArray:
    size = _size(walls) + radius
    angle = 2 * np.pi * np.arange(DIRECTIONS) / DIRECTIONS
    ways = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    for ring in range(RINGS):
        step = radius / 8 * 1.15**ring
        if step > 2 * size:
            break
        tries = place + step * ways
        gap, _edge = clearances(walls, tries, np.full(DIRECTIONS, radius))
        free = ways[gap >= radius]
        if len(free):
            high = _drawn_in(walls, place, free, step, radius)
            nearest: FloatArray = place + high.min() * free[high.argmin()]
            return nearest
    raise SceneError(
        f"there is no room for a ball of radius {radius:g} near ({place[0]:g}, {place[1]:g})", code="no-room"
    )


def _drawn_in(walls: Walls, place: FloatArray, ways: FloatArray, step: float, radius: float) -> FloatArray:
    """Bisect how far along each way a ball must go to be free; at ``step`` it is."""
    low, high = np.zeros(len(ways)), np.full(len(ways), step)
    for _ in range(60):
        middle = (low + high) / 2
        gap, _edge = clearances(walls, place + middle[:, None] * ways, np.full(len(ways), radius))
        free = gap >= radius
        low, high = np.where(free, low, middle), np.where(free, middle, high)
    return high


def _size(walls: Walls) -> float:
    x0, y0, x1, y1 = walls.box()
    return math.hypot(x1 - x0, y1 - y0)
