"""Where a ball starts when nobody says so: the roomiest spot; and many balls: at random around it."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from wallkit.geometry.arrays import FloatArray, IntArray
from wallkit.walls import Walls
from wallkit.walls.checking.material import Solids
from wallkit.walls.checking.self_check import straight_edges
from wallkit.walls.edge_tree import Edges
from wallkit.walls.met_lines import MetLines
from wallkit.walls.sample import flattened
from wallkit.walls.solid import walls_around

MOST_DRAWS = 200
"""So many times places are drawn, more of them than balls each time, before there is said to be no room."""
_FINE_STEP = math.pi / 256  # chords of arcs are then off by at most 2e-5 of the radius
_MANY_RINGS = 500  # of fewer, GEOS finds the faces in no time
_WAYS = 64  # directions that are tried out of a face that may be open
_FACES = 24  # so many of the largest faces are searched for the roomiest spot
_INWARDS = 1e-6  # of the square root of a face's area: so far in, its own edges are not met
MOST_STANDING = 10_000
"""Lines that stand in a face: of so many GEOS makes thin holes within two seconds, and no more are asked of it."""


@dataclass(frozen=True, slots=True)
class Spot:
    """A place with room.

    Attributes:
        x: of its centre.
        y: of its centre.
        room: the distance to the nearest wall.
        face: a polygon of shapely, the face that it is in, without the lines that stand there.
        crowded: these are too many to be taken out of the face, and are in it still.
    """

    x: float
    y: float
    room: float
    face: Any
    crowded: bool = False


@dataclass(eq=False)
class Lines:
    """The walls' lines, arcs as short chords: what is found of them is found once for all searches among them.

    Attributes:
        met: these lines with where they meet.
        spots: faces that were searched, by their id, and the roomiest spot of each.
    """

    met: MetLines
    spots: dict[int, tuple[Any, Spot | None]] = field(default_factory=dict)

    @classmethod
    def of(cls, walls: Walls, met: MetLines | None = None) -> Lines:
        """Take the lines of walls: ``met``, if they are these to the bit; there arcs have longer chords."""
        if met is not None and not walls.has_arcs and met.same_as(walls, turned_too=False):
            return cls(met)
        rings = [flattened(walls, index, _FINE_STEP) for index in range(len(walls))]
        offsets = np.concatenate([[0], np.cumsum([len(ring) for ring in rings])]).astype(np.int64)
        edges = Edges(np.concatenate([np.empty((0, 2)), *rings]), offsets, walls.closed)
        return cls(MetLines.of(walls, edges))

    @cached_property
    def tree(self) -> Any:
        """A tree of the pieces as lines of shapely."""
        import shapely

        return shapely.STRtree(shapely.linestrings(np.stack([self.met.pieces.a, self.met.pieces.b], axis=1)))

    @cached_property
    def bounded(self) -> Any:
        """The bounded faces between the lines.

        By GEOS, which looks among all rings for the one around each hole; of many rings that touch nothing, and are no
        copies, the nesting tells that: a face is what is within a ring, and not within those directly in it. Open lines
        that meet nowhere bound nothing.
        """
        import shapely

        from wallkit.walls.nesting import depths

        edges, touches = self.met.edges, self.met.touches
        met = (touches.crossing_at, touches.overlap_edges, touches.touch_at, touches.cut_edge)
        count = np.diff(edges.offsets)
        if not edges.closed.any() and not any(map(len, met)):
            return np.empty(0, dtype=object)
        if len(count) < _MANY_RINGS or any(map(len, met)) or not edges.closed.all() or count.min() < 3:
            return shapely.get_parts(shapely.polygonize([*self.tree.geometries]))
        rings = shapely.linearrings(edges.vertices, indices=np.repeat(np.arange(len(count)), count))
        inside: list[list[Any]] = [[] for _ in rings]
        for ring, around in zip(rings, depths(edges)[1].tolist(), strict=True):
            if around >= 0:
                inside[around].append(ring)
        return np.array([shapely.polygons(ring, holes or None) for ring, holes in zip(rings, inside, strict=True)])

    @cached_property
    def around(self) -> tuple[list[Any], list[Any]]:
        """What remains of the box around the lines: all of it, and the large ones that are nearly closed."""
        import shapely

        whole = shapely.envelope(shapely.multilinestrings(self.tree.geometries))
        parts = shapely.get_parts(shapely.difference(whole, shapely.union_all(self.bounded)))
        parts = [part for part in parts if part.geom_type == "Polygon" and not part.is_empty]
        return parts, [part for part in sorted(parts, key=shapely.area)[-4:] if _is_nearly_closed(part, self)]


def roomiest(walls: Walls, anywhere: bool = False, lines: Lines | None = None) -> Spot | None:
    """Find the place inside the walls that is farthest from all of them, to 1 % of the distance or better.

    Inside is every bounded face that the walls make; where there are open walls, also what remains of the box
    around them, if most ways out of it end at a wall, or if there is nothing else. Faces of less than half the
    largest one's area do not count: a room with a wide pillar is meant, not the pillar. Nor does what ``walls.solid``
    says is material, unless ``anywhere`` is asked for. The search is shapely's ``maximum_inscribed_circle`` (GEOS,
    after Mapbox's polylabel); where very many lines stand in a face, that of ``crowded_rooms.py``.

    Args:
        walls: any walls.
        anywhere: material counts too.
        lines: of the walls, if they are at hand.

    Returns:
        The spot, or None where no face has room.
    """
    lines = Lines.of(walls) if lines is None else lines
    best: Spot | None = None
    for face in _faces(walls, lines, anywhere):
        # A circle in a face of area A has at most the radius sqrt(A / pi): smaller faces cannot win any more.
        if best and math.sqrt(face.area / math.pi) <= best.room:
            continue
        spot = _spot(face, lines)
        better = spot and (best is None or spot.room > best.room)
        if spot and better and (anywhere or not _in_material(walls, spot)):
            best = spot
    return best


def has_room(walls: Walls, anywhere: bool = False, lines: Lines | None = None) -> bool:
    """Tell whether there is a place that :func:`roomiest` would find, which is asked likewise."""
    lines = Lines.of(walls) if lines is None else lines
    for face in _faces(walls, lines, anywhere):
        if (anywhere or walls.solid is not None) and len(_standing(_within(face), lines)) > MOST_STANDING:
            return True  # somewhere between them
        spot = _spot(face, lines)
        if spot is not None and (anywhere or not _in_material(walls, spot)):
            return True
    return False


def most_room_is_material(walls: Walls, lines: Lines) -> bool:
    """Tell whether the largest face that may be meant as a room is material by what the import has decided."""
    faces = _faces(walls, lines, anywhere=True)
    return bool(faces) and bool(_are_material(walls, straight_edges(walls), np.array(faces[:1]))[0])


def face_around(walls: Walls, x: float, y: float) -> Spot | None:
    """Give the roomiest spot of the face of the walls that a place is in; None where it is in no bounded one."""
    import shapely

    lines = Lines.of(walls)
    faces = [face for face in _faces(walls, lines, anywhere=True) if shapely.contains_xy(face, x, y)]
    return _spot(min(faces, key=shapely.area), lines) if faces else None


def _faces(walls: Walls, lines: Lines, anywhere: bool) -> list[Any]:
    """Give the faces that may be meant as rooms, the largest first; none where walls cross too often."""
    import shapely

    if not len(lines.met.edges) or lines.met.too_many:  # then no place is looked for among them
        return []
    bounded = lines.bounded
    faces = [*bounded] if anywhere else _largest_free(walls, bounded)
    if not walls.closed.all() and (anywhere or walls.solid is None or not walls.solid.room):
        around, nearly = lines.around
        faces += nearly if faces or nearly else around
    faces.sort(key=shapely.area, reverse=True)
    if faces and any(sides == "both" for sides in walls.sides):
        faces = [face for face in faces if face.area >= 0.5 * faces[0].area]
    return faces[:_FACES]


def _largest_free(walls: Walls, faces: Any) -> list[Any]:
    """Give the largest faces that are no material by what the import has decided; all where nobody has.

    Some at a time, twice as many each time: to ask every face of a nest of n walls takes n^2 steps.
    """
    import shapely

    if walls.solid is None:
        return [*faces]
    order = np.argsort(-shapely.area(faces), kind="stable")
    edges, chosen = straight_edges(walls), []
    start, count = 0, 4 * _FACES
    while start < len(order):
        some = faces[order[start : start + count]]
        chosen += [*some[~_are_material(walls, edges, some)]]
        if len(chosen) >= _FACES:
            break
        start, count = start + count, 2 * count
    return chosen


def _are_material(walls: Walls, edges: Edges, faces: Any) -> NDArray[np.bool_]:
    """Tell for each face whether it is material by what the import has decided: by how many walls are around it."""
    import shapely

    around, _ = walls_around(edges, shapely.get_coordinates(shapely.point_on_surface(faces)))
    room = walls.solid is not None and walls.solid.room
    material: NDArray[np.bool_] = (np.bincount(around, minlength=len(faces)) + room) % 2 == 1
    return material


def _is_nearly_closed(face: Any, lines: Lines) -> bool:
    """Tell whether most ways out of a face's roomiest spot end at a wall."""
    import shapely

    spot = _spot(face, lines)
    if spot is None:
        return False
    walls = shapely.multilinestrings(lines.tree.geometries)
    x0, y0, x1, y1 = walls.bounds
    angle = np.arange(_WAYS) * (math.tau / _WAYS)
    ends = (spot.x, spot.y) + 2 * math.hypot(x1 - x0, y1 - y0) * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    ways = shapely.linestrings([[(spot.x, spot.y), end] for end in ends.tolist()])
    shapely.prepare(walls)
    return int(np.count_nonzero(shapely.intersects(walls, ways))) >= 0.8 * _WAYS


def _in_material(walls: Walls, spot: Spot) -> bool:
    """Tell whether a spot is in what only one-sided walls keep balls out of: the smallest ring around it is a solid.

    Two-sided walls keep a ball in as well as out; a room given as a plain ring of numbers has its room there.
    """
    if walls.solid is not None or all(sides == "both" for sides in walls.sides):
        return False
    solids = Solids.of(walls, straight_edges(walls))
    innermost = int(solids.innermost(np.array([[spot.x, spot.y]]))[0])
    return innermost >= 0 and bool(solids.sign[innermost] > 0)


def _spot(face: Any, lines: Lines) -> Spot | None:
    """The roomiest spot of a face, in which some of all lines may lie; each face is searched once."""
    if id(face) not in lines.spots:
        lines.spots[id(face)] = face, _searched(face, lines)  # the face is kept, and so its id
    return lines.spots[id(face)][1]


def _searched(face: Any, lines: Lines) -> Spot | None:
    import shapely

    within = _within(face)
    standing = _standing(within, lines)
    if len(standing) > MOST_STANDING:
        return _spot_in_a_crowd(face, lines)
    size, free = math.sqrt(shapely.area(face)), face
    inner = shapely.intersection(shapely.multilinestrings(lines.tree.geometries[standing]), within)
    if not shapely.is_empty(inner):  # open walls inside: thickened by a hair, they become holes
        thick = shapely.buffer(shapely.get_parts(inner), 1e-6 * size)  # of all at once GEOS takes 100 times as long
        free = shapely.difference(face, shapely.union_all(thick))
        free = max(shapely.get_parts(free), key=shapely.area, default=face)
    if shapely.is_empty(free):
        return None
    line = shapely.maximum_inscribed_circle(free, tolerance=0.005 * size)
    room = float(shapely.length(line))
    if not room > 0:
        return None
    x, y = shapely.get_coordinates(line)[0]
    return Spot(float(x), float(y), room, free)


def _within(face: Any) -> Any:
    """What is within a face, without its own edges."""
    import shapely

    return shapely.buffer(face, -_INWARDS * math.sqrt(shapely.area(face)))


def _standing(within: Any, lines: Lines) -> IntArray:
    """The numbers of the pieces of lines that stand within a face, in rising order."""
    standing: IntArray = np.sort(lines.tree.query(within, predicate="intersects"))
    return standing


def _spot_in_a_crowd(face: Any, lines: Lines) -> Spot | None:
    from wallkit.scene.crowded_rooms import roomiest_circle

    circle = None if lines.met.mesh is None else roomiest_circle(lines.met.mesh, face)
    return None if circle is None else Spot(*circle, face, crowded=True)


def scattered(
    walls: Walls, spot: Spot, count: int, radius: float, random: np.random.Generator, apart: bool = False
) -> FloatArray:
    """Choose (count, 2) places at random, evenly over where a ball fits in the face of a spot.

    Args:
        walls: around the spot.
        spot: in whose face they are.
        count: so many.
        radius: of the balls.
        random: source of chance.
        apart: no two balls overlap: a place that another ball takes is drawn again (random sequential addition, which
            comes to a packing of 0.547 at most: J. Feder 1980, J. Theor. Biol. 87:237).

    Raises:
        SceneError: a ball of that radius fits nowhere there, or so many do not.
    """
    import shapely

    from wallkit.scene.scene import SceneError

    room = room_for(spot, radius)
    shapely.prepare(room)
    x0, y0, x1, y1 = room.bounds
    places = np.empty((0, 2))
    for _ in range(MOST_DRAWS):
        tried = random.uniform((x0, y0), (x1, y1), (2 * count + 64, 2))
        places = np.concatenate([places, tried[shapely.contains_xy(room, tried[:, 0], tried[:, 1])]])
        if apart:
            places = _without_overlaps(places, radius)
        if len(places) >= count:
            return places[:count]
    raise SceneError(
        f"{count} balls of radius {radius:g} that do not overlap were not placed: {len(places)} were",
        code="no-room",
        fix="give fewer of them, or a smaller --radius",
    )


def room_for(spot: Spot, radius: float) -> Any:
    """Give where the centre of a ball fits in the face of a spot: a polygon, or several, of shapely.

    Raises:
        SceneError: a ball of that radius fits nowhere there, or too many lines stand there to tell.
    """
    import shapely

    from wallkit.scene.scene import SceneError

    if spot.crowded:
        why = f"more than {MOST_STANDING:,} lines stand in the room: places for many balls are not looked for"
        fix = "give places (--ball X,Y, --from X,Y), or take fewer layers (--layer)"
        raise SceneError(why, code="no-room", fix=fix)
    x0, y0, x1, y1 = spot.face.bounds
    least = min(radius, x1 - x0)  # of which a ball has no room either; far larger ones overflow in a buffer
    # Around a corner a buffer of 32 chords a quarter is short by 0.03 %, and arcs bow out of the face by _FINE_STEP.
    room = shapely.buffer(spot.face, -1.0005 * least - 2e-5 * max(x1 - x0, y1 - y0), quad_segs=32)
    if shapely.is_empty(room):
        raise SceneError(
            f"a ball of radius {radius:g} has no room",
            code="no-room",
            fix=f"the roomiest spot takes {spot.room:.6g}: give a smaller --radius",
        )
    return room


def _without_overlaps(places: FloatArray, radius: float) -> FloatArray:
    """Leave out each place that is within two radii of one before it that stays."""
    taken: dict[tuple[int, int], list[tuple[float, float]]] = {}
    kept = []
    for x, y in places.tolist():
        column, row = math.floor(x / (2.0 * radius)), math.floor(y / (2.0 * radius))
        near = (taken.get((column + i, row + j), ()) for i in (-1, 0, 1) for j in (-1, 0, 1))
        if all(math.hypot(x - u, y - v) > 2.0 * radius for others in near for u, v in others):
            taken.setdefault((column, row), []).append((x, y))
            kept.append((x, y))
    return np.array(kept).reshape(-1, 2)
