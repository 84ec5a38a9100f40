"""Free space: the rooms between walls, the gaps that lead from one to another, and how wide these are.

Triangles between wall vertices, wall edges among them (triangulation.py), are walked by a disc of radius r from
edge to edge: it gets over an edge that is longer than 2 r. What is narrow between a vertex and the middle of a wall is
an edge, too, since the foot there is made a vertex (narrows.py). So widths are distances between given vertices and
edges, not samples, and gaps between lines are exact to rounding.

A circle in each triangle stands for the room it has; a disc gets there over an edge that is longer than its
diameter. Uniting edges and circles from the widest way down (a maximum spanning tree) tells how rooms hang
together: where two parts meet for the first time is the narrowest place of the widest way between them. The part
with the smaller roomiest circle is a room behind a gap.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
import shapely
from numpy.typing import NDArray

from wallkit.arguments import ABOVE_0, number, of_type
from wallkit.geometry.arrays import FloatArray, IntArray
from wallkit.geometry.conforming_delaunay import SHORTEST, Triangulation, triangulate
from wallkit.walls.as_shapely import straightened
from wallkit.walls.checking.exact_widths import exact_edges, nearest_pair
from wallkit.walls.checking.material import Solids
from wallkit.walls.checking.narrow_places import with_feet
from wallkit.walls.checking.parts import Parts
from wallkit.walls.checking.room_circles import larger_circles
from wallkit.walls.checking.self_check import diagonal
from wallkit.walls.crossings import find_touches
from wallkit.walls.edge_tree import Edges
from wallkit.walls.noding import MOST_CROSSINGS, noded
from wallkit.walls.walls import Walls, WallsError

MOST_EDGES = 200_000
MOST_SHARPENED = 500  # gaps between arcs that are measured on the arcs themselves, the narrowest
_NARROW = 0.5  # a gap is an opening at most this part as wide as the room behind it is


@dataclass(frozen=True, slots=True, eq=False)
class Gap:
    """The narrowest place on the widest way out of a room.

    Attributes:
        width: of the opening; a disc passes when its diameter is below this.
        a: one side of the opening.
        b: the other side.
        room: centre of the roomiest circle of the room behind it.
        room_radius: its radius.
        outside: it leads straight to the outside, and not into a larger room.
        escape: width of the narrowest gap on the whole way from the room to the outside; 0 where there is none.
        path: (n, 2) a polyline from the room through the gap.
    """

    width: float
    a: tuple[float, float]
    b: tuple[float, float]
    room: tuple[float, float]
    room_radius: float
    outside: bool
    escape: float
    path: FloatArray


@dataclass(frozen=True, slots=True)
class FreeSpace:
    """Rooms and gaps of walls.

    Attributes:
        gaps: narrowest first.
        closed_rooms: (n, 3) x, y, radius of the roomiest circle of each part that no way leads out of.
        complete: false when the drawing was too large or too tangled; then nothing is told.
        parts: what walls part from one another; None where there are no walls, or too many.
        solids: where material is, for balls that stand in it; None likewise.
        inside: no room is outside material, so that the rooms are those that the walls enclose.
    """

    gaps: list[Gap]
    closed_rooms: FloatArray
    complete: bool = True
    parts: Parts | None = None
    solids: Solids | None = None
    inside: bool = False

    def leaks(self, radius: float = 0.0) -> list[Gap]:
        """Gaps through which a disc of this radius gets out of a room that it fits into; narrowest first."""
        return [gap for gap in self.gaps if gap.escape > 2 * radius and gap.room_radius > radius]

    def unreachable(self, radius: float) -> list[Gap]:
        """Gaps between rooms too narrow for the disc, which would fit into the room behind."""
        shut = (gap for gap in self.gaps if gap.width <= 2 * radius < 2 * gap.room_radius)
        return [gap for gap in shut if not gap.outside]  # a room shut to the outside is as it should be


def free_space(walls: Walls, narrow: float = _NARROW) -> FreeSpace:
    """Find the rooms and the gaps between them, for discs of any radius at once.

    Where a disc may be: not inside material, which the winding of the walls tells (see ``Walls``). But where all
    that is left is the outside, as with a single outline, the inside of the outline is the room.

    Args:
        walls: any walls; arcs are looked at as lines within a tenth of the tolerance, and the gaps that are found
            are then made exact.
        narrow: an opening is a gap up to this part of the width of the room behind it. Rooms narrower than the
            tolerance are none, nor are gaps below 4e-7 of the drawing's diagonal.

    Raises:
        WallsError: these are no walls, or ``narrow`` is no number above 0.
    """
    of_type(walls, "walls", Walls, "Walls", error=WallsError, code="bad-walls")
    may_be = "a number above 0"
    number(narrow, "narrow", may_be, error=WallsError, code="bad-argument", least=ABOVE_0)
    vertices, offsets = straightened(walls, walls.tolerance / 10 or None)
    edges = Edges(vertices, offsets, walls.closed)
    nothing = not len(edges) or diagonal(vertices) == 0
    pieces = None if nothing or len(edges) > MOST_EDGES else _noded(edges)
    if pieces is None:
        return FreeSpace([], np.empty((0, 3)), nothing)
    a, b = pieces
    coarse = triangulate(a, b)
    mesh = None if coarse is None else with_feet(coarse)
    if mesh is None:
        return FreeSpace([], np.empty((0, 3)), False)
    least = walls.tolerance or 1e-6 * diagonal(vertices)
    found = _rooms(mesh, narrow, least)
    seam = 4 * SHORTEST * diagonal(vertices)
    solids = Solids.of(walls, edges)
    sealed = [(*gap.room, gap.room_radius) for gap in found.gaps if gap.width <= seam]  # closed, but for rounding
    found = replace(
        found,
        gaps=[gap for gap in found.gaps if gap.width > seam],
        closed_rooms=np.concatenate([found.closed_rooms, np.array(sealed).reshape(-1, 3)]),
        parts=Parts.of(mesh, seam),
        solids=solids,
    )
    chosen = _where_free(found, solids, True)
    if not len(chosen.gaps) and not len(chosen.closed_rooms):
        chosen = replace(_where_free(found, solids, False), inside=True)
    chosen = _roomier(chosen, mesh)
    return _sharpened(chosen, walls, vertices) if walls.has_arcs else chosen


def _where_free(found: FreeSpace, solids: Solids, free: bool) -> FreeSpace:
    """Only the rooms and gaps outside material; or, where free is false, those inside."""
    gaps = [gap.room for gap in found.gaps]
    rooms = np.concatenate([np.array(gaps).reshape(-1, 2), found.closed_rooms[:, :2]])
    wanted = solids.contain(rooms) != free
    kept = [gap for gap, chosen in zip(found.gaps, wanted, strict=False) if chosen]
    return replace(found, gaps=kept, closed_rooms=found.closed_rooms[wanted[len(gaps) :]])


def _roomier(found: FreeSpace, mesh: Triangulation) -> FreeSpace:
    """Give each room its largest circle."""
    rooms = np.array([(*gap.room, gap.room_radius, gap.width) for gap in found.gaps]).reshape(-1, 4)
    rooms = np.concatenate([rooms, np.column_stack([found.closed_rooms, np.zeros(len(found.closed_rooms))])])
    circles = larger_circles(mesh, rooms[:, :2], rooms[:, 2], rooms[:, 3])
    gaps = [
        replace(gap, room=(x, y), room_radius=radius)
        for gap, (x, y, radius) in zip(found.gaps, circles.tolist(), strict=False)
    ]
    return replace(found, gaps=gaps, closed_rooms=circles[len(gaps) :])


def _sharpened(found: FreeSpace, walls: Walls, vertices: FloatArray) -> FreeSpace:
    """Measure gaps between the arcs themselves."""
    exact = exact_edges(walls)
    reach = 4 * (walls.tolerance / 10 or 1e-4 * diagonal(vertices))
    gaps = []
    for gap in found.gaps[:MOST_SHARPENED]:
        a, b = nearest_pair(exact, complex(*gap.a), complex(*gap.b), min(reach, 0.4 * gap.width))
        width = abs(a - b)
        escape = width if gap.escape == gap.width else gap.escape
        gaps.append(replace(gap, width=width, escape=escape, a=(a.real, a.imag), b=(b.real, b.imag)))
    gaps += found.gaps[MOST_SHARPENED:]
    return replace(found, gaps=sorted(gaps, key=lambda gap: gap.width))


def eroded(walls: Walls, radius: float) -> list[shapely.Polygon]:
    """Where the centre of a disc may be: the parts of the plane at least ``radius`` from every wall.

    The plane is a box around the walls, wider by four radii. Round corners are polygons of 64 edges a quarter,
    on the safe side (inside) by 8e-5 radii at most.
    """
    vertices, offsets = straightened(walls, walls.tolerance / 10 or None)
    edges = Edges(vertices, offsets, walls.closed)
    lines = shapely.multilinestrings(shapely.linestrings(np.stack([edges.a, edges.b], axis=1)))
    taken = shapely.buffer(lines, radius / np.cos(np.pi / 256), quad_segs=64) if radius > 0 else lines.buffer(0)
    low, high = vertices.min(axis=0) - 4 * radius - 1e-9, vertices.max(axis=0) + 4 * radius + 1e-9
    free = shapely.difference(shapely.box(*low, *high), taken)
    return [part for part in shapely.get_parts(free) if not part.is_empty]


def reached(walls: Walls, radius: float, starts: FloatArray, places: FloatArray) -> NDArray[np.bool_]:
    """Tell which of ``places`` (n, 2) the centre of a disc gets to from any of ``starts`` (m, 2)."""
    result = np.zeros(len(places), dtype=np.bool_)
    for part in eroded(walls, radius):
        shapely.prepare(part)
        if shapely.intersects_xy(part, starts).any():
            result |= shapely.intersects_xy(part, places)
    return result


def _noded(edges: Edges) -> tuple[FloatArray, FloatArray] | None:
    """All edges, cut where they cross or touch, each piece once; None for a tangle: the pieces would be too many."""
    touches = find_touches(edges)
    if not touches.complete or len(touches.crossing_at) > MOST_CROSSINGS:
        return None
    return noded(edges, touches)


@dataclass(slots=True)
class _Turns:
    """Ways from one edge of a triangle to another, how wide, and the two ends of the narrowest spot.

    Nodes are edges by number, and behind them (number of edges + triangle) the circles of triangles.
    """

    one: IntArray
    two: IntArray
    width: FloatArray
    corner: IntArray
    far: FloatArray


def _turns(mesh: Triangulation) -> _Turns:
    """The ways from one edge of a triangle to another, both no walls: as wide as the shorter is long."""
    one, two = mesh.edge.ravel(), np.roll(mesh.edge, -1, axis=1).ravel()
    free = ~mesh.wall[one] & ~mesh.wall[two]
    one, two = one[free], two[free]
    length = np.hypot(*(mesh.points[mesh.ends[:, 1]] - mesh.points[mesh.ends[:, 0]]).T)
    shorter = np.where(length[one] < length[two], one, two)
    return _Turns(one, two, length[shorter], mesh.ends[shorter, 0], mesh.points[mesh.ends[shorter, 1]])


def _centres(mesh: Triangulation) -> FloatArray:
    """Two candidates for each triangle, (2, T, 2): the centre of the circle around it, if inside, and the one in it."""
    p, q, r = (mesh.points[mesh.corners[:, k]] for k in range(3))
    u, v = q - p, r - p
    double = 2 * (u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0])
    uu, vv, ww = (u * u).sum(axis=1), (v * v).sum(axis=1), ((r - q) ** 2).sum(axis=1)
    sides = np.sqrt(np.stack([ww, vv, uu], axis=1))
    inner = (sides[:, :1] * p + sides[:, 1:2] * q + sides[:, 2:] * r) / np.maximum(sides.sum(axis=1), 1e-300)[:, None]
    with np.errstate(divide="ignore", invalid="ignore"):
        around = p + np.stack([v[:, 1] * uu - u[:, 1] * vv, u[:, 0] * vv - v[:, 0] * uu], axis=1) / double[:, None]
    largest = np.sort(np.stack([uu, vv, ww], axis=1), axis=1)
    acute = (largest[:, 2] <= (largest[:, 0] + largest[:, 1]) * (1 + 1e-9)) & np.isfinite(around).all(axis=1)
    return np.stack([np.where(acute[:, None], around, inner), inner])


def _rooms(mesh: Triangulation, narrow: float, least: float) -> FreeSpace:
    """Unite edges and circles from the widest way down; note a gap where a room joins something roomier."""
    edge_count, count = len(mesh.ends), len(mesh.ends) + len(mesh.corners)
    circle, centre = _circles(mesh)
    turns = _with_circles(mesh, _turns(mesh), circle)
    place = np.concatenate([mesh.points[mesh.ends].mean(axis=1), centre])
    size = np.concatenate([np.where(mesh.outer, np.inf, 0.0), circle])
    tree = _spanning_tree(count, turns)
    outside = int(np.flatnonzero(mesh.outer)[0])
    parts = np.arange(count)
    parts[:edge_count][mesh.outer] = outside
    parent, roomy = parts.tolist(), size.tolist()  # of a part's root: the size of its roomiest circle
    best = list(range(count))  # of a part's root: the node with that circle
    notes: list[tuple[int, int, bool]] = []  # way; best node of the smaller room; the larger is the outside
    order = tree[np.argsort(-turns.width[tree], kind="stable")]
    columns = (order, turns.one[order], turns.two[order], turns.width[order])
    for turn, one, two, width in zip(*(column.tolist() for column in columns), strict=True):
        one, two = _find(parent, one), _find(parent, two)
        if one == two:
            continue
        if roomy[one] < roomy[two]:
            one, two = two, one
        if 2 * narrow * roomy[two] >= width > 0 and roomy[two] > least:
            notes.append((turn, best[two], math.isinf(roomy[one])))
        parent[two] = one
    roots = sorted({_find(parent, edge) for edge in np.flatnonzero(~mesh.wall).tolist()})
    closed = np.array([best[root] for root in roots if least < roomy[root] < math.inf], dtype=np.int64)
    gaps = sorted(_gaps(mesh, turns, tree, notes, size, place, outside), key=lambda gap: gap.width)
    return FreeSpace(gaps, np.column_stack([place[closed], size[closed]]))


def _gaps(
    mesh: Triangulation,
    turns: _Turns,
    tree: IntArray,
    notes: list[tuple[int, int, bool]],
    size: FloatArray,
    place: FloatArray,
    outside: int,
) -> list[Gap]:
    """Tell each noted turn as a gap, with the way from its room to the outside along the tree."""
    before, narrowest, step = _ways_out(len(place), turns, tree, np.flatnonzero(mesh.outer), outside)
    gaps = []
    for turn, room, to_outside in notes:
        way, passed = [room], False
        while before[way[-1]] >= 0 and not (passed and _clear(place, way, turns, turn)):
            passed = passed or step[way[-1]] == turn
            way.append(int(before[way[-1]]))
        a, b = mesh.points[turns.corner[turn]], turns.far[turn]
        corners = place[way] if passed else np.stack([place[room], (a + b) / 2])
        gaps.append(
            Gap(
                width=float(turns.width[turn]),
                a=(float(a[0]), float(a[1])),
                b=(float(b[0]), float(b[1])),
                room=(float(place[room, 0]), float(place[room, 1])),
                room_radius=float(size[room]),
                outside=to_outside,
                escape=float(narrowest[room]),
                path=corners,
            )
        )
    return gaps


def _clear(place: FloatArray, way: list[int], turns: _Turns, turn: int) -> bool:
    """The way has left the gap behind by three times its width."""
    off = place[way[-1]] - place[turns.one[turn]]
    return bool(np.hypot(off[0], off[1]) > 3 * turns.width[turn])


def _ways_out(
    nodes: int, turns: _Turns, tree: IntArray, outer: IntArray, outside: int
) -> tuple[IntArray, FloatArray, IntArray]:
    """For each edge: the next edge on the way out (-1 without), the narrowest turn on all of it, the next turn."""
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import breadth_first_order

    others = outer[outer != outside]
    one = np.concatenate([turns.one[tree], np.full(len(others), outside)])
    two = np.concatenate([turns.two[tree], others])
    label = np.concatenate([tree + 1, np.full(len(others), len(turns.one) + 1)]).astype(np.float64)
    graph = coo_matrix((label, (one, two)), shape=(nodes, nodes)).tocsr()
    graph = graph.maximum(graph.T)
    order, before = breadth_first_order(graph, outside, directed=False)
    before = np.where(before < 0, -1, before).astype(np.int64)
    step = np.full(nodes, -1, dtype=np.int64)
    reached = order[1:]
    step[reached] = np.asarray(graph[reached, before[reached]]).ravel().astype(np.int64) - 1
    widths = np.concatenate([turns.width, [np.inf]])
    narrowest = [0.0] * nodes
    narrowest[outside] = math.inf
    for node, last, width in zip(
        reached.tolist(), before[reached].tolist(), widths[step[reached]].tolist(), strict=True
    ):
        narrowest[node] = min(narrowest[last], width)
    return before, np.array(narrowest), step


def _find(parent: list[int], node: int) -> int:
    """The representative of a node, with the path halved on the way."""
    while parent[node] != node:
        parent[node] = parent[parent[node]]
        node = parent[node]
    return node


def _circles(mesh: Triangulation) -> tuple[FloatArray, FloatArray]:
    """Radius and centre of the roomier of each triangle's two circles, (T,) and (T, 2); 0 beside the frame."""
    walls = mesh.ends[mesh.wall]
    tree = shapely.STRtree(shapely.linestrings(np.stack([mesh.points[walls[:, 0]], mesh.points[walls[:, 1]]], axis=1)))
    rows = np.flatnonzero((mesh.corners < len(mesh.points) - 4).all(axis=1))
    size, place = np.zeros(len(mesh.corners)), mesh.points[mesh.corners].mean(axis=1)
    for centre in _centres(mesh):
        # no farther from walls than from the corners, which are on walls: most of the second ones are no better
        nearest = np.min([np.hypot(*(centre[rows] - mesh.points[mesh.corners[rows, k]]).T) for k in range(3)], axis=0)
        rows = rows[nearest > size[rows]]
        points = shapely.points(centre[rows])
        (source, _), distance = tree.query_nearest(points, return_distance=True, all_matches=False)
        larger = distance > size[rows[source]]
        size[rows[source[larger]]] = distance[larger]
        place[rows[source[larger]]] = centre[rows[source[larger]]]
    return size, place


def _with_circles(mesh: Triangulation, turns: _Turns, size: FloatArray) -> _Turns:
    """Add the ways from edges that are no walls to the circles of their triangles."""
    triangle, edge = np.repeat(np.arange(len(mesh.corners)), 3), mesh.edge.ravel()
    free = ~mesh.wall[edge] & (size[triangle] > 0)
    triangle, edge = triangle[free], edge[free]
    a, b = mesh.points[mesh.ends[edge, 0]], mesh.points[mesh.ends[edge, 1]]
    both = np.concatenate
    return _Turns(
        both([turns.one, edge]),
        both([turns.two, len(mesh.ends) + triangle]),
        both([turns.width, np.minimum(np.hypot(*(b - a).T), 2 * size[triangle])]),
        both([turns.corner, mesh.ends[edge, 0]]),
        both([turns.far, b]),
    )


def _spanning_tree(nodes: int, turns: _Turns) -> IntArray:
    """The turns of a maximum spanning forest."""
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import minimum_spanning_tree

    order = np.argsort(-turns.width, kind="stable")
    key = np.minimum(turns.one, turns.two)[order] * nodes + np.maximum(turns.one, turns.two)[order]
    order = order[np.sort(np.unique(key, return_index=True)[1])]  # the widest turn between two edges
    rank = np.arange(1, len(order) + 1, dtype=np.float64)
    graph = coo_matrix((rank, (turns.one[order], turns.two[order])), shape=(nodes, nodes)).tocsr()
    tree = minimum_spanning_tree(graph)
    chosen: IntArray = order[tree.data.astype(np.int64) - 1]
    return chosen
