"""Repair passes on areas: self-crossings, union of solids, slivers. Outcomes as in repair_lines."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import shapely

from wallkit.geometry.arrays import FloatArray, IntArray
from wallkit.geometry.rings import rings_of
from wallkit.walls.checking.widths import is_thin, winding
from wallkit.walls.crossings import find_touches
from wallkit.walls.edge_tree import Edges
from wallkit.walls.nesting import depths
from wallkit.walls.repairing.ends import Repaired
from wallkit.walls.repairing.loose_walls import LooseWall, edges_of, like


def resolve_crossings(lines: list[LooseWall], tolerance: float) -> Repaired:
    """Put the outline of what they enclose in the place of closed lines that cross or run over themselves."""
    edges = edges_of(lines, tolerance)
    touches = find_touches(edges)
    own = touches.crossing_walls[:, 0] == touches.crossing_walls[:, 1]
    pairs = edges.wall[touches.overlap_edges].reshape(-1, 2)
    folded = pairs[:, 0] == pairs[:, 1]
    touching = touches.touch_walls[:, 0] == touches.touch_walls[:, 1]
    bad = {int(w) for w in touches.crossing_walls[own, 0]} | {int(w) for w in pairs[folded, 0]}
    bad |= {int(w) for w in touches.touch_walls[touching, 0]}
    copy_of = touches.copy_of.tolist()
    bad = {wall for wall, line in enumerate(lines) if line.closed and copy_of[wall] in bad}
    result: list[LooseWall] = []
    at = None
    for index, line in enumerate(lines):
        if index not in bad:
            result.append(line)
            continue
        at = line.vertices[0] if at is None else at
        ring = edges.vertices[edges.offsets[index] : edges.offsets[index + 1]]
        result += like(line, _enclosed(ring, line.even_odd))
    words = f"{len(bad)} self-crossing walls became the outline of what they enclose"
    return result, len(bad), 0.0, words, at


def _enclosed(ring: FloatArray, even_odd: bool) -> list[FloatArray]:
    """Rings around the faces of a closed line whose winding number counts as inside."""
    closed = np.concatenate([ring, ring[:1]])
    faces = shapely.get_parts(shapely.polygonize([shapely.node(shapely.linestrings(closed))]))
    if not len(faces):
        return []
    turns = winding(closed, shapely.get_coordinates(shapely.point_on_surface(faces)))
    inside = faces[turns % 2 != 0] if even_odd else faces[turns != 0]
    return rings_around(shapely.union_all(inside)) if len(inside) else []


def rings_around(area: shapely.Geometry) -> list[FloatArray]:
    """All rings of an area, outer ones first in each polygon."""
    rings = []
    for polygon in shapely.get_parts(area):
        if isinstance(polygon, shapely.Polygon) and not polygon.is_empty:
            rings += [shapely.get_coordinates(ring) for ring in (polygon.exterior, *polygon.interiors)]
    return rings


def unite(lines: list[LooseWall], tolerance: float, arena: bool) -> Repaired:
    """Make one solid of those that overlap or share an edge, with the holes that are left of theirs."""
    edges = edges_of(lines, tolerance)
    touches = find_touches(edges)
    depth, _ = depths(edges, touches.crossing_walls)
    depth = depth + (1 if arena else 0)
    shared = edges.wall[touches.overlap_edges].reshape(-1, 2)
    pairs = np.concatenate([touches.crossing_walls, shared])
    closed = np.array([line.closed for line in lines], dtype=np.bool_)
    pairs = pairs[(pairs[:, 0] != pairs[:, 1]) & closed[pairs].all(axis=1)]
    group = _groups(len(lines), pairs)
    together = np.zeros(len(lines), dtype=np.bool_)
    together[pairs.ravel()] = True
    result = [line for index, line in enumerate(lines) if not together[index]]
    count, at = 0, None
    for number in np.unique(group[together]).tolist():
        members = np.flatnonzero((group == number) & together)
        united = _united(edges, members, depth)
        before = sorted(_bytes(edges.vertices[edges.offsets[m] : edges.offsets[m + 1]]) for m in members.tolist())
        if sorted(_bytes(ring[:-1]) for ring in united) == before:
            result += [lines[member] for member in members.tolist()]
            continue
        first = lines[int(members[0])]
        at = first.vertices[0] if at is None else at
        count += len(members)
        result += like(first, united)
    return result, count, 0.0, f"{count} walls that overlap were united", at


def _bytes(ring: FloatArray) -> bytes:
    """A ring as the set of its vertices, for comparison."""
    order = np.lexsort((ring[:, 1], ring[:, 0]))
    return (ring[order] + 0.0).tobytes()


def _groups(count: int, pairs: IntArray) -> IntArray:
    """Connected parts of a graph: the smallest member of each node's part."""
    group = np.arange(count)
    while True:
        low = np.minimum(group[pairs[:, 0]], group[pairs[:, 1]])
        new = group.copy()
        np.minimum.at(new, pairs[:, 0], low)
        np.minimum.at(new, pairs[:, 1], low)
        new = new[new]
        if (new == group).all():
            return group
        group = new


def _united(edges: Edges, members: IntArray, depth: IntArray) -> list[FloatArray]:
    """Solids (even depth) united, holes (odd depth) taken from the solids right around them, from outside in."""
    polygons = rings_of(edges.vertices, edges.offsets)
    area: shapely.Geometry = shapely.Polygon()
    for level in np.unique(depth[members]).tolist():
        rings = polygons[members[depth[members] == level]]
        layer = shapely.union_all(shapely.make_valid(rings[rings != None]))  # noqa: E711  (elementwise)
        if level % 2 == 0:
            area = shapely.union(area, layer)
        elif area.is_empty:  # rooms: what they enclose is free
            return rings_around(layer)
        else:
            area = shapely.difference(area, layer)
    return rings_around(area)


def remove_slivers(lines: list[LooseWall], width: float, tolerance: float) -> Repaired:
    """Drop closed lines that no disc of diameter ``width`` fits into.

    The largest disc in a ring has at least the radius area / perimeter, so only rings below that are looked at.
    """
    if not lines:
        return lines, 0, 0.0, "", None
    edges = edges_of(lines, tolerance)
    area = np.abs(edges.areas)
    perimeter = np.bincount(edges.wall, np.hypot(*(edges.b - edges.a).T), len(lines))
    closed = np.array([line.closed for line in lines], dtype=np.bool_)
    thin = np.flatnonzero(closed & (area <= perimeter * width / 2)).tolist()
    gone = {w for w in thin if is_thin(edges.vertices[edges.offsets[w] : edges.offsets[w + 1]], width)}
    at = lines[min(gone)].vertices[0] if gone else None
    kept = [replace(line) for index, line in enumerate(lines) if index not in gone]
    return kept, len(gone), 0.0, f"{len(gone)} slivers thinner than {width:g} removed", at
