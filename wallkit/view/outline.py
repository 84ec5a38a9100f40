"""Walls as paths in pixels: arcs stay arcs, and every fill is told by nesting, not by winding."""

from __future__ import annotations

import math

import numpy as np

from wallkit.geometry.arrays import FloatArray
from wallkit.geometry.bulge_arcs import radius_of
from wallkit.view.canvas import Command
from wallkit.view.frame import Frame
from wallkit.walls import Material, Walls
from wallkit.walls.checking.self_check import straight_edges
from wallkit.walls.orient import is_arena
from wallkit.walls.solid import walls_around


def wall_path(walls: Walls, index: int, frame: Frame) -> list[Command]:
    """Give one wall as path commands; of more than 1,000 lines, vertices within half a pixel are drawn as one."""
    span = slice(walls.offsets[index], walls.offsets[index + 1])
    points, bulges, closed = frame.points(walls.vertices[span]), walls.bulges[span].tolist(), walls.closed[index]
    if len(points) > 1000 and not any(bulges):
        cells = np.round(2 * points)
        apart = np.concatenate([[True], (cells[1:] != cells[:-1]).any(axis=1)])
        apart[-1] = True
        points, bulges = points[apart], [0.0] * int(apart.sum())
    ends = np.roll(points, -1, axis=0)
    edges = [_edge(a, b, bulge, frame.up) for a, b, bulge in zip(points, ends, bulges, strict=True)]
    start: Command = ("M", *points[0])
    if not closed:
        return [start, *edges[:-1]]
    return [start, *(edges if bulges[-1] else edges[:-1]), ("Z",)]  # Z draws the last line itself


def _edge(a: FloatArray, b: FloatArray, bulge: float, up: bool) -> Command:
    if bulge == 0.0:
        return ("L", *b)
    # A left turn in the drawing stays one on the screen (sweep 0) when the y axis is turned over, and is clockwise
    # there (sweep 1) when it is not.
    radius = radius_of(math.hypot(*(b - a)), bulge)
    return ("A", radius, radius, 0, int(abs(bulge) > 1.0), int((bulge > 0.0) != up), *b)


def solid_areas(walls: Walls, free: FloatArray) -> list[tuple[Material, list[int], bool]]:
    """Tell what is filled: groups of closed walls, each filled even-odd with one material.

    Material is where the number of closed walls around is odd; or even, where the outermost walls are rooms. The
    import has decided that (``walls.solid``). For walls given as numbers the balls say it: they start where they can
    fly; where they do not agree, or there is none, the winding of the largest wall does.

    Args:
        walls: the walls.
        free: (n, 2) places that should not be material; most of them decide.

    Returns:
        (material, wall indices, whether the frame's edge belongs to it as the outermost ring).
    """
    closed = np.flatnonzero(walls.closed)
    if not len(closed):
        return []
    turned = _is_room(walls, free)
    if len({walls.materials[index] for index in closed}) == 1:
        return [(walls.materials[closed[0]], [int(index) for index in closed], turned)]
    return _areas_by_material(walls, turned)


def _is_room(walls: Walls, free: FloatArray) -> bool:
    """Tell whether the outermost walls are rooms."""
    if walls.solid is not None:
        return walls.solid.room
    around, _wall = walls_around(straight_edges(walls), free)
    inside = int(np.count_nonzero(np.bincount(around, minlength=len(free)) % 2))
    return is_arena(walls) if 2 * inside == len(free) else 2 * inside > len(free)


def _areas_by_material(walls: Walls, turned: bool) -> list[tuple[Material, list[int], bool]]:
    """Nest walls by their first vertices; ``walls.depth`` is not used, for walls made of arrays do not carry it.

    Only a larger wall can be around a smaller one. A first vertex that lies exactly on another wall may be counted
    either way, a matter of colour only.
    """
    edges = straight_edges(walls)
    size = np.abs(edges.areas)
    inner, outer = walls_around(edges, walls.vertices[walls.offsets[:-1]])
    larger = size[inner] < size[outer]
    inner, outer = inner[larger], outer[larger]
    depth = np.bincount(inner, minlength=len(walls))
    holes: dict[int, list[int]] = {}
    next_to = walls.closed[inner] & (depth[inner] == depth[outer] + 1)
    for hole, ring in zip(inner[next_to].tolist(), outer[next_to].tolist(), strict=True):
        holes.setdefault(ring, []).append(hole)
    closed = np.flatnonzero(walls.closed)
    areas: list[tuple[Material, list[int], bool]] = []
    if turned:  # each outermost room is cut out of the frame; they share the first one's material
        rooms = closed[depth[closed] == 0].tolist()
        areas.append((walls.materials[rooms[0]], rooms, True))
    areas += [
        (walls.materials[index], [index, *holes.get(index, [])], False)
        for index in closed.tolist()
        if int(depth[index]) % 2 == int(turned)
    ]
    return areas


def tick_places(walls: Walls, frame: Frame, spacing: float = 26.0) -> list[tuple[float, float, float, float, bool]]:
    """Choose where normals are shown: at edges' middles, at least about ``spacing`` pixels apart along a wall.

    An arc shows one about every two spacings, each with the normal that it has there; a wall shorter than two
    spacings shows none, where it is one of many.

    Returns:
        (x, y, nx, ny, both sides) in pixels, n of length one.
    """
    places: list[tuple[float, float, float, float, bool]] = []
    starts, ends = frame.points(walls.vertices[walls.edge_starts]), frame.points(walls.vertices[walls.edge_ends])
    lengths = np.hypot(*(ends - starts).T)
    normals = walls.normals * np.array([1.0, -1.0 if frame.up else 1.0])
    bulges = walls.bulges[walls.edge_starts]
    offsets = walls.edge_offsets
    for index in range(len(walls)):
        both = not walls.closed[index] and walls.sides[index] == "both"
        walked, last = 0.0, -spacing
        if len(walls) > 12 and lengths[offsets[index] : offsets[index + 1]].sum() < 2 * spacing:
            continue
        for edge in range(offsets[index], offsets[index + 1]):
            length = float(lengths[edge])
            middle = walked + length / 2
            if length > 0 and middle - last >= min(spacing, max(length, spacing / 2)):
                last = middle
                places += [(*at, both) for at in _ticks(starts[edge], ends[edge], normals[edge], bulges[edge], spacing)]
            walked += length
    return places


def _ticks(
    a: FloatArray, b: FloatArray, normal: FloatArray, bulge: float, spacing: float
) -> list[tuple[float, float, float, float]]:
    """Give places and normals along one edge: its middle, or several on a long arc."""
    if bulge == 0.0:
        return [(*((a + b) / 2), *normal)]
    chord = float(np.hypot(*(b - a)))
    angle = 4.0 * math.atan(abs(bulge))
    radius = radius_of(chord, bulge)
    count = max(1, int(radius * angle / (2 * spacing)))
    # From the centre, the arc's middle lies along the normal for a positive bulge and against it for a negative one.
    side = math.copysign(1.0, bulge)
    centre = (a + b) / 2 + normal * (bulge * chord / 2 - side * radius)
    ticks = []
    for turn in (angle * ((k + 0.5) / count - 0.5) for k in range(count)):
        cos, sin = math.cos(turn), math.sin(turn)
        direction = np.array([cos * normal[0] - sin * normal[1], sin * normal[0] + cos * normal[1]])
        ticks.append((*(centre + side * radius * direction), *direction))
    return ticks
