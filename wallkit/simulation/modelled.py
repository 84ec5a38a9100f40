"""From a scene to what the kernels see: local coordinates, flat arrays, an index, None for what is absent."""

from __future__ import annotations

import math
from copy import copy
from typing import Any

import numpy as np
from numpy.typing import NDArray

from wallkit.geometry.arrays import FloatArray, IntArray
from wallkit.kernels.compile_aside import at_hand
from wallkit.kernels.records import CELL, Model, in_lists
from wallkit.kernels.signatures import Told
from wallkit.scene.scene import Balls, Scene, SceneError
from wallkit.simulation.build_grid import build_grid
from wallkit.simulation.damping import damping_of, slowing_of
from wallkit.simulation.edge_records import arcs_of, columns, corners_of, lines_of, no_corners
from wallkit.simulation.expected_flights import expected_flights
from wallkit.simulation.joints import joints_of
from wallkit.walls import Walls

BRUTE_FORCE = 16
"""Up to this many edges looking at all of them beats any index."""
LOADING_PAYS, WAITING_PAYS = 4_000, 40_000
"""Edges and corners that interpreted kernels sort into an index as long as it takes to load compiled ones (a quarter of
a second), and, discs among them, in some four seconds: beyond that it is better to wait for a compiler."""
FAR = 2.0**20
"""Extents from which a ball may come if there is to be an index: the rounding of its place (2^-50 of the way) is then
below a part in 2^30 of the scene. For one from farther away all edges are asked."""
LENGTHS, SPEEDS, FALLING = (1e-60, 1e60), (1e-153, 1e153), (1e-70, 1e70)
"""What the size of the walls may be, a speed (by itself, and times the size), and speed and gravity where there is
gravity, if they are not 0: squares of products of two of them are numbers then, of arcs 2^42 times as large too."""

Box = tuple[float, float, float, float]
Range = tuple[float, float]


class Modelled:
    """A scene as the kernels see it.

    Attributes:
        model: arrays for the compiled kernels.
        origin: (2,) added to local coordinates it gives the scene's.
        radii: (n,) of the balls.
        tallies: how many counts of bounces there are: one a wall; :meth:`by_edge` has one an edge and one a vertex.
        box: (x_min, y_min, x_max, y_max) that no wall reaches beyond, in the scene's coordinates.
        size: the largest coordinate of it, or radius of a ball.
    """

    def __init__(
        self,
        scene: Scene,
        *,
        index: str = "auto",
        machine_code: bool = False,
        limits: tuple[float, float] | None = (0.0, 0),
        origin: FloatArray | None = None,
    ) -> None:
        """Model a scene.

        Args:
            scene: walls, balls, and what acts.
            index: ``"grid"``, ``"none"``, or ``"auto"``: a grid where there are many edges.
            machine_code: whether flights will be compiled anyway; then the index of a small scene is made by compiled
                kernels, too.
            limits: until when, and how many bounces, all balls fly once: the index is as fine as pays for that. None
                where it serves many surveys.
            origin: (2,) of the local coordinates, where they are those of other walls; None for their own.
        """
        around = scene.walls.box()
        self.box = box_around(scene.walls, around)
        self.radii = np.asarray(scene.balls.radius, dtype=np.float64)
        self.tallies = len(scene.walls)
        self.size = check_sizes(scene, self.box)
        self.origin = local_origin(scene.walls.vertices, around) if origin is None else origin
        self.model = self._made(scene, around, index, machine_code, limits)
        self._lists: Model | None = None
        self._told: tuple[Told, Told] | None = None
        self.short_lists: NDArray[np.uint32] | None = None  # what waves have noted of the cells, once they flew

    def _made(
        self,
        scene: Scene,
        around: Box,
        index: str,
        machine_code: bool,
        limits: tuple[float, float] | None,
    ) -> Model:
        walls, radius = scene.walls, float(self.radii.max(initial=0.0))
        edges = len(walls.vertices) - int(np.count_nonzero(~walls.closed))
        arcs_too, discs, sides, gravity = walls.has_arcs, radius > 0.0, _one_sided(scene), _gravity(scene)
        if index == "none" or (index == "auto" and edges <= BRUTE_FORCE):
            machine_code = False
        elif not machine_code:
            machine_code = _machine_code_pays(edges + discs * len(walls.vertices), arcs_too)
        polylines = walls.vertices, walls.offsets, walls.closed, self.origin
        lines, edge_wall, closed_ones, open_ones = lines_of(*polylines, machine_code=machine_code)
        corner_wall = np.repeat(np.arange(len(walls)), np.diff(walls.offsets))
        bulges, arcs = np.empty(0), None
        if arcs_too:
            bulges = walls.bulges[walls.edge_starts]
            arcs = arcs_of(lines, bulges)
        size = max(abs(one - origin) for one, origin in zip(around, 2 * self.origin.tolist(), strict=True))
        # Under gravity the way along a wall is gone cell by cell, and rounded there: its cells list what they did.
        across = sides is not None or gravity is not None
        corners = no_corners()
        if discs:
            least = float(self.radii[self.radii > 0.0].min())
            corners = corners_of(*polylines, lines, arcs, bulges, size, least, across=across, machine_code=machine_code)
        is_line = lines["length"] > 0.0
        kinds = [np.flatnonzero(is_line), np.empty(0, dtype=np.int64), np.flatnonzero(corners.open)]
        if arcs is not None:
            is_arc = arcs["radius"] > 0.0
            kinds[:2] = np.flatnonzero(is_line & ~is_arc), np.flatnonzero(is_arc)
        slowing = slowing_of(scene)
        joints, spokes = (None, None) if gravity is None else joints_of(walls, self.origin, lines)
        ids = np.concatenate([*kinds, np.zeros(1, dtype=np.int64)]).astype(np.uint32)
        model = Model(
            ids=ids,
            cells=_one_cell(*map(len, kinds)),
            grid=None,
            clearings=None,
            lines=lines,
            arcs=arcs,
            corners=corners.records,
            edge_wall=edge_wall,
            corner_wall=corner_wall,
            edge_tally=edge_wall,
            corner_tally=corner_wall,
            restitution=_restitution(scene),
            static_friction=None if gravity is None else _static_friction(scene),
            one_sided=sides,
            fans=corners.fans if sides is not None else None,
            gravity=gravity,
            damping=damping_of(scene),
            extent=size + radius,
            joints=joints,
            spokes=spokes,
            rolling=slowing.rolling,
            drag=slowing.drag,
        )
        many = len(kinds[0]) + len(kinds[1]) > BRUTE_FORCE
        if index != "grid" and not (index == "auto" and many):
            return model
        least = float(self.radii.min(initial=radius))
        if model.one_sided is not None:
            least = 0.0  # a disc may stand across a wall that it came through
        farthest = max(model.extent, _farthest(scene.balls, self.origin))
        if farthest > FAR * model.extent:
            return model
        box = np.array(self.box).reshape(2, 2) - self.origin
        flights = math.inf
        if limits is not None:
            flights = expected_flights(scene, around, closed_ones + 2.0 * open_ones, *limits) / edges
        grid, cells, ids, clearings = build_grid(
            model, corners.fans, box, (least, radius), farthest, machine_code=machine_code, flights=flights
        )
        return model._replace(ids=ids, cells=cells, grid=grid, clearings=clearings)

    def with_balls(self, balls: Balls) -> Modelled | None:
        """Give the same model with other balls; None if it must be made anew, for other radii or from farther away."""
        radii = np.asarray(balls.radius)
        check_balls(balls, self.size, self.model.gravity is not None)
        if not (len(radii) and len(self.radii) and _farthest(balls, self.origin) <= self.model.extent):
            return None
        if (radii.min(), radii.max()) != (self.radii.min(), self.radii.max()):
            return None
        other = copy(self)
        other.radii = radii
        return other

    def by_edge(self) -> Modelled:
        """Give the same model with bounces counted by edge, then by vertex."""
        edges, corners = len(self.model.edge_wall), len(self.model.corner_wall)
        other = copy(self)
        other.model = self.model._replace(edge_tally=np.arange(edges), corner_tally=np.arange(edges, edges + corners))
        other.tallies, other._lists, other._told = edges + corners, None, None
        return other

    @property
    def lists(self) -> Model:
        """The model with lists of Python floats for arrays: several times faster to interpret."""
        if self._lists is None:
            self._lists = in_lists(self.model)
        return self._lists

    @property
    def told(self) -> tuple[Told, Told]:
        """The model and its gravity, as arguments of compiled kernels that are called once a contact."""
        if self._told is None:
            self._told = Told(self.model), Told(self.model.gravity)
        return self._told

    def index_of_edge(self, scene: Scene) -> tuple[IntArray, IntArray]:
        """Give wall and edge within the wall of each edge overall."""
        offsets = scene.walls.edge_offsets
        wall = np.repeat(np.arange(len(scene.walls)), np.diff(offsets))
        return wall, np.arange(len(wall)) - offsets[wall]


def index_at_hand(arcs: bool) -> bool:
    """Tell whether compiled kernels can make an index at once; where not, they are compiled aside from now on."""
    return at_hand(make_small_index, arcs)


def make_small_index(arcs: bool) -> None:
    """Make an index of a triangle by compiled kernels: the task of their compiling."""
    bulges = np.array([0.5 * arcs, 0.0, 0.0])
    walls = Walls.from_polylines([[[0.0, 0.0], [9.0, 0.0], [0.0, 9.0]]], bulges=[bulges])
    Modelled(Scene(walls, Balls([[2.0, 2.0]], [[1.0, 0.0]], radius=1.0)), index="grid", machine_code=True)


def _machine_code_pays(entries: int, arcs: bool) -> bool:
    return entries > WAITING_PAYS or (entries > LOADING_PAYS and index_at_hand(arcs))


def check_sizes(scene: Scene, box: Box) -> float:
    """Refuse what is so large or so small that squares of products of two of it are no numbers any more.

    Args:
        scene: walls, balls, and what acts.
        box: of its walls, see :func:`box_around`.

    Returns:
        The largest coordinate of the box, or radius of a ball.

    Raises:
        SceneError: lengths, speeds, gravity or what slows balls are beyond LENGTHS, SPEEDS and FALLING.
    """
    size = max(*map(abs, box), float(scene.balls.radius.max(initial=0.0)))
    _check_range("the largest coordinate or radius", size, LENGTHS, "draw it in another unit of length")
    for what in ("rolling_friction", "drag"):
        slows = getattr(scene, what)
        if slows is not None:
            _check_range(what.replace("_", " "), slows, (0.0, FALLING[1]), "take another unit of time, or None")
    if scene.gravity is not None:
        _check_range("gravity", float(np.hypot(*np.ravel(scene.gravity))), FALLING, "take another unit of time, or 0")
    check_balls(scene.balls, size, scene.gravity is not None)
    return size


def check_balls(balls: Balls, size: float, falls: bool) -> None:
    """Refuse balls so slow, so fast or, under gravity, so far away that squares of products are no numbers any more.

    Args:
        balls: any number of them.
        size: what :func:`check_sizes` gave for their scene.
        falls: there is gravity.

    Raises:
        SceneError: a coordinate or a speed is beyond LENGTHS, SPEEDS and FALLING.
    """
    if falls:  # else a place is only added to, and a ball may come from anywhere
        farthest = float(np.abs(balls.position).max(initial=0.0))
        _check_range("a ball's coordinate", farthest, (0.0, LENGTHS[1]), "place it nearer to the walls")
    # A speed is its larger component, or up to the root of 2 as much: where twice that may be, no length is worked out.
    x, y = np.abs(columns(np.asarray(balls.velocity, dtype=np.float64)))
    least, most = _extremes(np.maximum(x, y))
    ranges = *_ranges_of_speeds(least, most, size, falls), *_ranges_of_speeds(2.0 * least, 2.0 * most, size, falls)
    if not all(_is_known(number, limits) for _what, number, limits in ranges):
        for what, number, limits in _ranges_of_speeds(*_extremes(np.hypot(x, y)), size, falls):
            _check_range(what, number, limits, "take another unit of time, or 0")


def _farthest(balls: Balls, origin: FloatArray) -> float:
    """Give the largest absolute local coordinate of the balls; 0 without any."""
    farthest = 0.0
    for column, origin_of in zip(np.asarray(balls.position).T, origin.tolist(), strict=True):
        if len(column):
            farthest = max(farthest, abs(float(column.min()) - origin_of), abs(float(column.max()) - origin_of))
    return farthest


def _extremes(speeds: FloatArray) -> tuple[float, float]:
    """Give the least and the most of the speeds that are not 0; 0 for both without any."""
    most = float(speeds.max(initial=0.0))
    least = float(speeds.min(initial=most))
    return least or float(speeds[speeds > 0.0].min(initial=most)), most


def _ranges_of_speeds(least: float, most: float, size: float, falls: bool) -> tuple[tuple[str, float, Range], ...]:
    """List what speeds come to, and which range it must be in."""
    alone, by_size = FALLING if falls else SPEEDS, "a speed times the size of the walls"
    return (
        ("a speed", least, alone),
        ("a speed", most, alone),
        (by_size, least * min(size or 1.0, 1.0), SPEEDS),
        (by_size, most * max(size, 1.0), SPEEDS),
    )


def _is_known(number: float, limits: Range) -> bool:
    return number == 0.0 or limits[0] <= number <= limits[1]


def _check_range(what: str, number: float, limits: Range, fix: str) -> None:
    if not _is_known(number, limits):
        known = f"{what} is {number:g}, and is known to work from {limits[0]:g} to {limits[1]:g}"
        raise SceneError(known, code="beyond-numbers", fix=fix)


def box_around(walls: Walls, box: Box) -> Box:
    """Widen the box around the vertices by what the arcs bow at most: half a chord times the bulge, or the circle."""
    if not walls.has_arcs:
        return box
    x0, y0, x1, y1 = box
    chord = np.hypot(*(walls.vertices[walls.edge_ends] - walls.vertices[walls.edge_starts]).T)
    bulge = np.minimum(np.abs(walls.bulges[walls.edge_starts]), 1e200)  # larger circles are refused all the same
    bow = float((chord * bulge * np.where(bulge > 1.0, 1.0, 0.5)).max(initial=0.0))
    return x0 - bow, y0 - bow, x1 + bow, y1 + bow


def local_origin(vertices: FloatArray, box: Box) -> FloatArray:
    """Choose an origin near the walls: coordinates relative to it are exact, and small far from (0, 0).

    It is a multiple of a power of two several times the scene's size, so that a scene shifted by a larger power
    of two has the same local coordinates, bit for bit. Where a subtraction would round, the origin stays (0, 0).
    ``box`` is that of the vertices.
    """
    origin = np.zeros(2)
    low, high = np.array(box[:2]), np.array(box[2:])
    size = float((high - low).max())
    if size <= 0.0 or not math.isfinite(size):
        return origin
    step = 2.0 ** (math.frexp(size)[1] + 2)
    origin = np.floor(low / step + 0.5) * step
    if not origin.any():
        return np.zeros(2)
    places = columns(vertices)
    local = places - origin[:, None]
    back = places - local  # with the next line Knuth's exact remainder of a subtraction
    lost = (places - (local + back)) + (back - origin[:, None])
    return origin if not np.any(lost) and np.array_equal(local + origin[:, None], places) else np.zeros(2)


def _one_cell(lines: int, arcs: int, corners: int) -> NDArray[Any]:
    """List everything in one cell."""
    end = lines + arcs + corners
    return np.array([(0, lines, lines + arcs, end)], dtype=CELL)


def _restitution(scene: Scene) -> FloatArray | None:
    materials = scene.walls.materials
    same = materials == materials[:1] * len(materials)  # told at once where it is one object, of a million too
    different = materials[:1] if same else {id(m): m for m in materials}.values()
    if all(m.restitution == 1.0 and m.tangential_restitution == 1.0 for m in different):
        return None
    pairs = np.array([(m.restitution, m.tangential_restitution) for m in materials], dtype=np.float64)
    return np.ascontiguousarray(pairs).reshape(-1)


def _static_friction(scene: Scene) -> FloatArray | None:
    friction = np.array([m.static_friction for m in scene.walls.materials], dtype=np.float64)
    return friction if friction.any() else None


def _gravity(scene: Scene) -> FloatArray | None:
    if scene.gravity is None:
        return None
    gravity = np.array(scene.gravity, dtype=np.float64)
    if gravity.shape != (2,) or not np.isfinite(gravity).all():
        raise SceneError(f"gravity is {scene.gravity!r}", code="bad-gravity", fix="give two numbers, GX,GY")
    return gravity if gravity.any() else None


def _one_sided(scene: Scene) -> IntArray | None:
    if scene.walls.sides.count("both") == len(scene.walls):  # three times as quick as to look for the other word
        return None
    return np.array([sides == "outward" for sides in scene.walls.sides], dtype=np.int64)
