"""Free space: the rooms between walls, the gaps that lead from one to another, and how wide these are.

Triangles between wall vertices, wall edges among them (triangulation.py), are walked by a disc of radius r from
triangle to triangle: it gets over an edge that is longer than 2 r. What is narrow between a vertex and the middle of a
wall is an edge, too, since the foot there is made a vertex (narrow_places.py). So widths are distances between given
vertices and edges, not samples, and gaps between lines are exact to rounding.

Uniting triangles, and a circle in each for the room it has, from the widest way down tells how rooms hang together
(widest_ways.py): where two parts meet for the first time is the narrowest place of the widest way between them. The
part with the smaller roomiest circle is a room behind a gap.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
import shapely
from numpy.typing import NDArray

from wallkit.arguments import ABOVE_0, number, of_type
from wallkit.geometry.arrays import FloatArray, IntArray
from wallkit.geometry.triangulation import Triangulation
from wallkit.walls.as_shapely import check_tolerance
from wallkit.walls.checking.climbing import Segments, climb
from wallkit.walls.checking.exact_widths import exact_edges, nearest_pair
from wallkit.walls.checking.material import Solids
from wallkit.walls.checking.narrow_places import with_feet
from wallkit.walls.checking.part_material import in_material
from wallkit.walls.checking.parts import Parts
from wallkit.walls.checking.room_circles import largest_circles, triangles_at
from wallkit.walls.checking.self_check import diagonal, straight_edges
from wallkit.walls.checking.triangle_circles import TOO_SMALL, triangle_circles
from wallkit.walls.checking.widest_ways import Room, Ways, WaysOut, unite, ways_out
from wallkit.walls.edge_tree import Edges
from wallkit.walls.met_lines import MetLines
from wallkit.walls.walls import Walls, WallsError

MOST_EDGES = 200_000
MOST_SHARPENED = 500  # gaps between arcs that are measured on the arcs themselves, the narrowest
_SEAM = 4e-7  # of the diagonal: what is narrower is closed, but for rounding
_ALIKE = 1e-6  # of the diagonal: what differs by less counts as the same in the order of rooms
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


@dataclass(frozen=True, slots=True, eq=False)
class FreeSpace:
    """Rooms and gaps of walls.

    Attributes:
        gaps: narrowest first.
        closed_rooms: (n, 3) x, y, radius of the roomiest circle of each part that no way leads out of: the roomiest
            first; those as roomy, to a millionth of the drawing's diagonal, by x, then by y.
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
    narrow = number(narrow, "narrow", may_be, error=WallsError, code="bad-argument", least=ABOVE_0)
    edges = straight_edges(walls)
    return free_space_among(walls, edges, MetLines.of(walls, edges), narrow)


def free_space_among(walls: Walls, edges: Edges, met: MetLines, narrow: float = _NARROW) -> FreeSpace:
    """Do what :func:`free_space` does, with the walls' straight edges, and the same lines with where they meet."""
    vertices = edges.vertices
    if not len(edges) or diagonal(vertices) == 0:
        return FreeSpace([], np.empty((0, 3)))
    coarse = None if len(edges) > MOST_EDGES or met.too_many else met.mesh
    if coarse is None:
        return FreeSpace([], np.empty((0, 3)), False)
    mesh = with_feet(coarse)
    least = walls.tolerance or 1e-6 * diagonal(vertices)
    solids, seam = Solids.of(walls, edges), _SEAM * diagonal(vertices)
    faces = Parts.of(mesh, 0.0)
    material = in_material(solids, coarse, met.pieces, met.touches.copy_of, faces.place)[faces.part]
    walls_around = Segments.of(*(mesh.points[mesh.ends[mesh.wall, k]] for k in (0, 1)))
    found, circles = _rooms(mesh, walls_around, ~material, narrow, least)
    if not len(found.gaps) and not len(found.closed_rooms):
        found, circles = _rooms(mesh, walls_around, material, narrow, least)
        found = replace(found, inside=True)
    sealed = [(*gap.room, gap.room_radius) for gap in found.gaps if gap.width <= seam]  # closed, but for rounding
    found = replace(
        found,
        gaps=[gap for gap in found.gaps if gap.width > seam],
        closed_rooms=np.concatenate([found.closed_rooms, np.array(sealed).reshape(-1, 3)]),
        parts=Parts.of(mesh, seam) if (~mesh.wall & (mesh.length <= seam)).any() else faces,
        solids=solids,
    )
    found = _roomier(found, mesh, circles, seam)
    found = replace(found, closed_rooms=_in_order(found.closed_rooms, _ALIKE * diagonal(vertices)))
    return _sharpened(found, walls) if walls.has_arcs else found


def _roomier(found: FreeSpace, mesh: Triangulation, circles: _Circles, seam: float) -> FreeSpace:
    """Give each room its largest circle; out of a closed one gaps up to ``seam`` may lead."""
    rooms = np.array([(*gap.room, gap.room_radius, gap.width) for gap in found.gaps]).reshape(-1, 4)
    rooms = np.concatenate([rooms, np.column_stack([found.closed_rooms, np.full(len(found.closed_rooms), seam)])])
    largest = largest_circles(mesh, circles.walls, circles.radius, circles.place, rooms)
    gaps = [
        replace(gap, room=(x, y), room_radius=radius)
        for gap, (x, y, radius) in zip(found.gaps, largest.tolist(), strict=False)
    ]
    return replace(found, gaps=gaps, closed_rooms=largest[len(gaps) :])


def _in_order(rooms: FloatArray, alike: float) -> FloatArray:
    """Put rooms (n, 3) in order, whatever order triangles have, which hangs on the way round that walls run.

    Where these cross, and so rooms, rounding moves by some 1e-16 of the whole, and climbs end within 1e-8 of a radius:
    far less than ``alike``.
    """
    x, y, radius = np.round(rooms / alike).T
    return rooms[np.lexsort((y, x, -radius))]


def _sharpened(found: FreeSpace, walls: Walls) -> FreeSpace:
    """Measure gaps between the arcs themselves."""
    exact = exact_edges(walls)
    reach = 4 * check_tolerance(walls, walls.tolerance)
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
    edges = straight_edges(walls)
    lines = shapely.multilinestrings(shapely.linestrings(np.stack([edges.a, edges.b], axis=1)))
    taken = shapely.buffer(lines, radius / np.cos(np.pi / 256), quad_segs=64) if radius > 0 else lines.buffer(0)
    low, high = edges.vertices.min(axis=0) - 4 * radius - 1e-9, edges.vertices.max(axis=0) + 4 * radius + 1e-9
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


@dataclass(slots=True, eq=False, repr=False)
class _Circles:
    """Circles in triangles: walls with their tree, (T,) radii and (T, 2) centres."""

    walls: Segments
    radius: FloatArray
    place: FloatArray

    def climb(self, mesh: Triangulation, triangles: IntArray) -> IntArray:
        """Put the summits above the circles of some triangles where they belong, if they are larger than what is.

        Returns:
            For each of the triangles that with its summit, or itself.
        """
        place, radius = climb(self.walls, self.place[triangles])
        at = triangles_at(mesh, place)
        order = np.argsort(radius, kind="stable")
        order = order[at[order] >= 0]
        framed = (mesh.corners[at[order]] >= len(mesh.points) - 4).any(axis=1)  # a climb out of everything
        order = order[~framed & (radius[order] > self.radius[at[order]])]
        self.radius[at[order]], self.place[at[order]] = radius[order], place[order]  # the last is the largest
        higher: IntArray = np.where((at >= 0) & (self.radius[at] > self.radius[triangles]), at, triangles)
        return higher


def _rooms(
    mesh: Triangulation, walls: Segments, where: NDArray[np.bool_], narrow: float, least: float
) -> tuple[FreeSpace, _Circles]:
    """Find rooms among some triangles, which walls part from the others, and the narrowest place on the way out.

    What may be a room is found first, by circles that may be too small by a third; then by those at the summits.
    """
    count = len(mesh.corners)
    circles = _Circles(walls, *triangle_circles(mesh, least, where))
    if not (circles.radius > least).any():  # nothing is a room, however it hangs together
        return FreeSpace([], np.empty((0, 3))), circles
    joined = unite(mesh, Ways.of(mesh, circles.radius, where), circles.radius, TOO_SMALL * narrow, least)
    nodes = [room.node for room in joined.rooms] + joined.closed
    closed = circles.climb(mesh, np.array(nodes, dtype=np.int64) - count)
    if joined.rooms:
        ways = Ways.of(mesh, circles.radius, where)
        joined = unite(mesh, ways, circles.radius, narrow, least)
        closed = np.array(joined.closed, dtype=np.int64) - count
    rooms = np.column_stack([circles.place[closed], circles.radius[closed]])
    if not joined.rooms:
        return FreeSpace([], rooms), circles
    out = ways_out(mesh, ways, joined.used)
    gaps = [_gap(mesh, ways, out, room, circles) for room in joined.rooms]
    return FreeSpace(sorted(gaps, key=lambda gap: gap.width), rooms), circles


def _gap(mesh: Triangulation, ways: Ways, out: WaysOut, room: Room, circles: _Circles) -> Gap:
    """Tell a room's way out as a gap."""
    triangle = room.node - len(mesh.corners)
    x, y = circles.place[triangle].tolist()
    edge = int(ways.edge[room.way])
    edge = edge if edge >= 0 else int(mesh.edge[triangle][mesh.length[mesh.edge[triangle]].argmax()])
    a, b = mesh.points[mesh.ends[edge]].tolist()
    return Gap(
        width=float(ways.width[room.way]),
        a=(a[0], a[1]),
        b=(b[0], b[1]),
        room=(x, y),
        room_radius=float(circles.radius[triangle]),
        outside=room.outside,
        escape=out.narrowest[room.node],
        path=_path(mesh, ways, out, room, circles.place[triangle], edge),
    )


def _path(mesh: Triangulation, ways: Ways, out: WaysOut, room: Room, start: FloatArray, edge: int) -> FloatArray:
    """The way from a room through the middles of edges, until the gap is left behind by three times its width."""
    middle = mesh.points[mesh.ends[edge]].mean(axis=0)
    path, passed, node = [start], False, room.node
    while out.before[node] >= 0:
        way = out.step[node]
        passed, node = passed or way == room.way, out.before[node]
        if ways.edge[way] >= 0:
            path.append(mesh.points[mesh.ends[ways.edge[way]]].mean(axis=0))
            if passed and math.hypot(*(path[-1] - middle)) > 3 * ways.width[room.way]:
                return np.array(path)
    if not passed:
        return np.array([start, middle])
    outer = mesh.edge[node][mesh.outer[mesh.edge[node]]]
    return np.array([*path, mesh.points[mesh.ends[outer[0]]].mean(axis=0)])
