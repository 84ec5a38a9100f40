"""Solids as convex pieces, for engines that know no others.

The material (even-odd over all closed walls; around a room a frame) is triangulated with every edge of a wall among
its edges, and triangles are merged over their common edges as long as the piece stays convex and small enough (S.
Hertel and K. Mehlhorn, Fast triangulation of simple polygons, 1983: at most four times the fewest possible pieces).
GEOS's triangulation grows with the square of a polygon's size, so larger ones are cut in halves first.
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass
from typing import Any

import numpy as np
import shapely

from wallkit.export.level import Level, LevelWall
from wallkit.export.material_shapes import areas_of, is_ring
from wallkit.export.pieces import Pieces
from wallkit.geometry.arrays import FloatArray, IntArray

MOST_AT_ONCE = 200  # vertices of a polygon that is triangulated as it is
BATCH = 5_000  # vertices whose triangles are in memory at the same time: GEOS takes some 400 bytes for each
MITRE = 5.0  # how far a corner of a thickened wall may stick out, in half thicknesses
# A corner counts as convex when the sine of its angle is above this, far above the rounding (1e-16) of that sine:
# leaving two pieces apart is never wrong.
CONVEX = 1e-9
TINY = 1e-13  # of the level's square: triangles of less are rounding, and engines divide by their area


@dataclass(frozen=True, slots=True)
class Solid:
    """A connected piece of material.

    Attributes:
        wall: whose name, layer and material it has: its outline, or the room that it is around.
        pieces: convex polygons, counter-clockwise in the target's numbers.
    """

    wall: LevelWall
    pieces: Pieces


def solids_of(level: Level) -> list[Solid]:
    """Take a level apart into solids; open walls are thickened, and both is said."""
    found = _material(level)
    thickness = level.options.thickness or 0.005 * level.side
    lines = [wall for wall in level if not is_ring(wall)]
    ways = [np.concatenate([wall.vertices, wall.vertices[:1]]) if wall.closed else wall.vertices for wall in lines]
    drawn = np.array([shapely.LineString(way) for way in ways], dtype=object)
    thick = shapely.buffer(drawn, thickness / 2, cap_style="flat", join_style="mitre", mitre_limit=MITRE)
    parts, whose = shapely.get_parts(thick, return_index=True)
    found += [(part, lines[number]) for part, number in zip(parts, whose.tolist(), strict=True)]
    level.findings.note(
        "export-thickened",
        lines,
        f"an open wall became a solid of thickness {thickness:.3g}",
        "--thickness sets it",
    )
    pieces = convex_pieces([polygon for polygon, _ in found], level.options.max_vertices, TINY * level.side**2)
    return [Solid(wall, own) for (_, wall), own in zip(found, pieces, strict=True) if len(own)]


def _material(level: Level) -> list[tuple[Any, LevelWall]]:
    """Give each polygon of the material with the wall that it belongs to."""
    areas = areas_of(level, level.options.arena_frame or 0.1 * level.side)
    mixed = [wall for area in areas for wall in area.walls[1:] if wall.material != area.walls[0].material]
    level.findings.note(
        "export-material",
        mixed,
        "a solid has one material, that of its outline; this wall is a hole in it with another",
        "split the solid, or set the restitution in the engine",
    )
    return [(area.polygon, area.walls[0]) for area in areas if area.walls]


def convex_pieces(polygons: list[Any], most: int, smallest: float = 0.0) -> list[Pieces]:
    """Cut shapely polygons into convex pieces.

    Args:
        polygons: valid, holes and all.
        most: vertices of a piece, at least 3.
        smallest: area of triangles that are left out.

    Returns:
        For each polygon its pieces, strictly convex, counter-clockwise.
    """
    found: list[list[Pieces]] = [[] for _ in polygons]
    parts, owner = _small_parts(polygons)
    batch = np.cumsum(shapely.get_num_coordinates(parts)) // BATCH
    for number in range(int(batch[-1]) + 1 if len(batch) else 0):
        _add_pieces(found, parts[batch == number], owner[batch == number], most, smallest)
    return [Pieces.joined(own) for own in found]


def _add_pieces(result: list[list[Pieces]], parts: Any, owner: IntArray, most: int, smallest: float) -> None:
    """Triangulate some parts and merge what may be merged; ``result`` has a list for each owner."""
    found, of_part = shapely.get_parts(shapely.constrained_delaunay_triangles(parts), return_index=True)
    corners = shapely.get_coordinates(found).reshape(-1, 4, 2)[:, :3]
    a, b, c = corners[:, 0], corners[:, 1], corners[:, 2]
    area = ((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]) / 2
    large = np.abs(area) > smallest
    corners = np.where((area < 0)[:, None, None], corners[:, ::-1], corners)[large]
    keys = np.ascontiguousarray(corners.reshape(-1, 2)).view(np.complex128).ravel()
    points, which = np.unique(keys, return_inverse=True)
    places = np.stack([points.real, points.imag], axis=1)
    of, loops = _merged(places, which.reshape(-1, 3), owner[of_part[large]], most)
    corners = places[np.array([corner for loop in loops for corner in loop], dtype=np.int64)]
    offsets = np.concatenate([[0], np.cumsum([len(loop) for loop in loops])]).astype(np.int64)
    pieces, owners = Pieces(corners, offsets), np.array(of, dtype=np.int64)
    begins = np.concatenate([[0], np.flatnonzero(np.diff(owners)) + 1, [len(owners)]]).tolist() if of else [0]
    for begin, end in itertools.pairwise(begins):  # pieces of one polygon stand together
        result[of[begin]].append(pieces.cut(begin, end))


def _small_parts(polygons: list[Any]) -> tuple[Any, IntArray]:
    """Cut polygons in halves across their longer side until none has too many vertices; with the polygon of each."""
    waiting = list(enumerate(polygons))
    parts: list[Any] = []
    owner: list[int] = []
    while waiting:
        number, part = waiting.pop()
        if part.geom_type != "Polygon":
            waiting += [(number, piece) for piece in shapely.get_parts(part) if piece.area > 0]
            continue
        size = shapely.get_num_coordinates(part)
        halves = _halves(part) if size > MOST_AT_ONCE else [part]
        if size <= MOST_AT_ONCE or max(shapely.get_num_coordinates(half) for half in halves) >= size:
            parts.append(part)  # small enough, or nothing is won by cutting
            owner.append(number)
        else:
            waiting += [(number, half) for half in halves if not half.is_empty]
    return np.array(parts, dtype=object), np.array(owner, dtype=np.int64)


def _halves(polygon: Any) -> list[Any]:
    points = shapely.get_coordinates(polygon)
    x_min, y_min, x_max, y_max = polygon.bounds
    if x_max - x_min > y_max - y_min:
        middle = float(np.median(points[:, 0]))
        boxes = shapely.box(x_min, y_min, middle, y_max), shapely.box(middle, y_min, x_max, y_max)
    else:
        middle = float(np.median(points[:, 1]))
        boxes = shapely.box(x_min, y_min, x_max, middle), shapely.box(x_min, middle, x_max, y_max)
    return [shapely.intersection(polygon, box) for box in boxes]


def _merged(points: FloatArray, triangles: IntArray, owner: IntArray, most: int) -> tuple[list[int], list[list[int]]]:
    """Merge triangles of one owner over their common edges, the longest edges first; owner and corners of each."""
    loops: list[list[int]] = triangles.tolist()
    home = list(range(len(loops)))  # of each triangle, on the way to the loop that it is in
    place = points.tolist()
    for u, v, left, right in _common_edges(points, triangles, owner):
        one, two = _find(home, left), _find(home, right)
        if one == two or len(loops[one]) + len(loops[two]) - 2 > most:
            continue
        joined = _joined(loops[one], loops[two], u, v, place)
        if joined is not None:
            loops[one], loops[two] = joined, []
            home[two] = one
    left_over = [(number, loop) for number, loop in zip(owner.tolist(), loops, strict=True) if loop]
    return [number for number, _ in left_over], [loop for _, loop in left_over]


def _common_edges(points: FloatArray, triangles: IntArray, of: IntArray) -> list[list[int]]:
    """List edges u to v (v to u in the second) that two triangles of one polygon share, the longest first."""
    u = triangles.ravel()
    v = np.roll(triangles, -1, axis=1).ravel()
    owner = np.repeat(np.arange(len(triangles)), 3)  # the triangle of each edge
    order = np.lexsort((u > v, np.maximum(u, v), np.minimum(u, v)))
    u, v, owner = u[order], v[order], owner[order]
    pair = np.flatnonzero((u[:-1] == v[1:]) & (v[:-1] == u[1:]) & (of[owner[:-1]] == of[owner[1:]]))
    length = np.hypot(*(points[u[pair]] - points[v[pair]]).T)
    pair = pair[np.argsort(-length, kind="stable")]
    edges: list[list[int]] = np.stack([u[pair], v[pair], owner[pair], owner[pair + 1]], axis=1).tolist()
    return edges


def _find(home: list[int], number: int) -> int:
    while home[number] != number:
        home[number] = home[home[number]]
        number = home[number]
    return number


def _joined(one: list[int], two: list[int], u: int, v: int, place: list[list[float]]) -> list[int] | None:
    """Join two loops over the edge u to v of the first; None when the whole would not be convex."""
    i, j = one.index(u), two.index(v)
    after_u, after_v = (j + 1) % len(two), (i + 1) % len(one)
    if one[after_v] != v or two[after_u] != u:  # an earlier merge has used the edge up
        return None
    if not _convex(place[one[i - 1]], place[u], place[two[(j + 2) % len(two)]]):
        return None
    if not _convex(place[two[j - 1]], place[v], place[one[(i + 2) % len(one)]]):
        return None
    turned = two[after_u:] + two[:after_u]  # u ... v
    return one[: i + 1] + turned[1:-1] + one[i + 1 :]


def _convex(a: list[float], b: list[float], c: list[float]) -> bool:
    """Tell whether the way a, b, c turns left, by more than rounding."""
    px, py, qx, qy = b[0] - a[0], b[1] - a[1], c[0] - b[0], c[1] - b[1]
    cross = px * qy - py * qx
    return cross > 0 and cross * cross > CONVEX * CONVEX * (px * px + py * py) * (qx * qx + qy * qy)
