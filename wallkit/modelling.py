"""From a scene to what the kernels see: local coordinates, flat arrays, an index, None for what is absent."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from wallkit.damping import damping_of
from wallkit.indexing import build_grid
from wallkit.kernels.model import ARC, CELL, CORNER, FAN, LINE, Corner, Fan, Line, Model, in_lists
from wallkit.scene import FloatArray, Scene, SceneError
from wallkit.walls import Walls

IntArray = NDArray[np.int64]
SMOOTH = 2.0**-44
"""Edges that meet at less than this angle (radians) have no corner: see ``scan_disc`` for how they overlap."""
FLAT = 2.0**-44
"""An arc with a smaller bulge is its chord, to rounding."""
BRUTE_FORCE = 16
"""Up to this many edges looking at all of them beats any index."""

_NO_CORNERS = np.empty((0, len(Fan._fields))), np.empty((0, len(Corner._fields)))


class Modelled:
    """A scene as the kernels see it.

    Attributes:
        model: arrays for the compiled kernels.
        origin: (2,) added to local coordinates it gives the scene's.
        radii: (n,) of the balls.
        box: (x_min, y_min, x_max, y_max) that no wall reaches beyond, in the scene's coordinates.
    """

    def __init__(self, scene: Scene, *, index: str = "auto", machine_code: bool = False) -> None:
        """Model a scene.

        Args:
            scene: walls, balls, and what acts.
            index: ``"grid"``, ``"none"``, or ``"auto"``: a grid where there are many edges.
            machine_code: whether flights will be compiled anyway; then the index is made by compiled kernels too.
        """
        self.box = _box(scene.walls)
        self.radii = np.asarray(scene.balls.radius, dtype=np.float64)
        self.origin = local_origin(scene.walls.vertices)
        self.model = self._made(scene, index, machine_code)
        self._lists: Model | None = None

    def _made(self, scene: Scene, index: str, machine_code: bool) -> Model:
        walls, radius = scene.walls, float(self.radii.max(initial=0.0))
        vertices, starts, ends = walls.vertices - self.origin, walls.edge_starts, walls.edge_ends
        lines, bulges = _lines(vertices[starts], vertices[ends]), walls.bulges[starts]
        arcs, arc_of_edge = _arcs(lines, bulges)
        fans, corners = _fans(vertices, lines, bulges, starts, ends) if radius > 0.0 else _NO_CORNERS
        kinds = _ids(lines, arc_of_edge, fans)
        ids = np.concatenate([*kinds, np.zeros(1, dtype=np.uint32)])
        model = Model(
            ids=ids,
            cells=_one_cell(*map(len, kinds)),
            grid=None,
            lines=_records(lines, LINE),
            arcs=_records(arcs, ARC) if len(arcs) else None,
            arc_of_edge=arc_of_edge,
            corners=_records(corners, CORNER),
            edge_wall=np.repeat(np.arange(len(walls)), np.diff(walls.edge_offsets)),
            corner_wall=np.repeat(np.arange(len(walls)), np.diff(walls.offsets)),
            restitution=_restitution(scene),
            one_sided=_one_sided(scene),
            gravity=_gravity(scene),
            damping=damping_of(scene),
            extent=float(np.abs(vertices).max(initial=0.0)) + radius,
        )
        many = len(kinds[0]) + len(kinds[1]) > BRUTE_FORCE
        if index != "grid" and not (index == "auto" and many):
            return model
        least = float(self.radii.min(initial=radius))
        if model.one_sided is not None:
            least = 0.0  # a disc may stand across a wall that it came through
        farthest = float(np.abs(np.asarray(scene.balls.position) - self.origin).max(initial=model.extent))
        box = np.array(self.box).reshape(2, 2) - self.origin
        grid, cells, ids = build_grid(
            model, _records(fans, FAN), box, (least, radius), farthest, machine_code=machine_code
        )
        return model._replace(ids=ids, cells=cells, grid=grid)

    @property
    def lists(self) -> Model:
        """The model with lists of Python floats for arrays: several times faster to interpret."""
        if self._lists is None:
            self._lists = in_lists(self.model)
        return self._lists

    def index_of_edge(self, scene: Scene) -> tuple[IntArray, IntArray]:
        """Give wall and edge within the wall of each edge overall."""
        offsets = scene.walls.edge_offsets
        wall = np.repeat(np.arange(len(scene.walls)), np.diff(offsets))
        return wall, np.arange(len(wall)) - offsets[wall]


def _box(walls: Walls) -> tuple[float, float, float, float]:
    """Box around the vertices, widened by what the arcs bow at most: half a chord times the bulge, or the circle."""
    x0, y0, x1, y1 = walls.box()
    if not walls.has_arcs:
        return x0, y0, x1, y1
    chord = np.hypot(*(walls.vertices[walls.edge_ends] - walls.vertices[walls.edge_starts]).T)
    bulge = np.abs(walls.bulges[walls.edge_starts])
    bow = float((chord * bulge * np.where(bulge > 1.0, 1.0, 0.5)).max(initial=0.0))
    return x0 - bow, y0 - bow, x1 + bow, y1 + bow


def local_origin(vertices: FloatArray) -> FloatArray:
    """Choose an origin near the walls: coordinates relative to it are exact, and small far from (0, 0).

    It is a multiple of a power of two several times the scene's size, so that a scene shifted by a larger power
    of two has the same local coordinates, bit for bit. Where a subtraction would round, the origin stays (0, 0).
    """
    origin = np.zeros(2)
    if len(vertices) == 0:
        return origin
    low, high = vertices.min(axis=0), vertices.max(axis=0)
    size = float((high - low).max())
    if size <= 0.0 or not math.isfinite(size):
        return origin
    step = 2.0 ** (math.frexp(size)[1] + 2)
    origin = np.floor(low / step + 0.5) * step
    local = vertices - origin
    back = vertices - local  # with the next line Knuth's exact remainder of a subtraction
    lost = (vertices - (local + back)) + (back - origin)
    return origin if not np.any(lost) and np.array_equal(local + origin, vertices) else np.zeros(2)


def _ids(lines: FloatArray, arc_of_edge: IntArray, fans: FloatArray) -> list[NDArray[np.uint32]]:
    """Give edges that are lines, edges that are arcs, and vertices at which a disc can touch."""
    opened = (fans[:, 0] != fans[:, 2]) | (fans[:, 1] != fans[:, 3]) | (fans[:, 4] != 0.0)
    return [
        np.flatnonzero(which).astype(np.uint32)
        for which in ((lines[:, 6] > 0.0) & (arc_of_edge < 0), arc_of_edge >= 0, opened)
    ]


def _one_cell(lines: int, arcs: int, corners: int) -> NDArray[Any]:
    """List everything in one cell."""
    end = lines + arcs + corners
    return np.array([(0, lines, lines + arcs, 1), (end, end, end, 1)], dtype=CELL)


def _arcs(lines: FloatArray, bulges: FloatArray) -> tuple[FloatArray, IntArray]:
    """Make arcs of edges with a bulge: (columns of ``Arc``, number of each edge's arc or -1).

    With chord d, its left normal m and bulge b = tan(angle / 4) the centre lies at (a + b) / 2 + m d (1 - b^2) / (4 b)
    and R = d (1 + b^2) / (4 |b|) (as in DXF). An arc that bows less than 2^-44 of its chord is the chord.
    """
    length = lines[:, 6]
    is_arc = (np.abs(bulges) > FLAT) & (length > 0.0)
    number = np.where(is_arc, np.cumsum(is_arc) - 1, -1).astype(np.int64)
    chord, b = lines[is_arc], bulges[is_arc]
    start, end = chord[:, 0:2], chord[:, 2:4]
    off = (chord[:, 6] * (1.0 - b * b) / (4.0 * b))[:, None]
    to_centre = (end - start) / 2 - off * chord[:, 4:6]
    from_centre = -to_centre, (end - start) / 2 + off * chord[:, 4:6]
    left = (b > 0.0)[:, None]
    columns = [
        np.where(left, start, end),
        np.where(left, end, start),
        np.where(left, from_centre[0], from_centre[1]),
        np.where(left, from_centre[1], from_centre[0]),
        (chord[:, 6] * (1.0 + b * b) / (4.0 * np.abs(b)))[:, None],
        np.sign(b)[:, None],
        (np.abs(b) > 1.0)[:, None].astype(np.float64),
    ]
    return np.hstack(columns), number


def _lines(start: FloatArray, end: FloatArray) -> FloatArray:
    d = end - start
    length = np.sqrt(d[:, 0] * d[:, 0] + d[:, 1] * d[:, 1])
    lines = np.zeros((len(d), len(Line._fields)))
    lines[:, 0:2], lines[:, 2:4], lines[:, 6] = start, end, length
    has = length > 0.0
    lines[has, 4] = d[has, 1] / length[has]
    lines[has, 5] = -d[has, 0] / length[has]
    lines[has, 7] = 2.0 / (lines[has, 4] ** 2 + lines[has, 5] ** 2)
    return lines


def _fans(
    vertices: FloatArray, lines: FloatArray, bulges: FloatArray, starts: IntArray, ends: IntArray
) -> tuple[FloatArray, FloatArray]:
    """Give for each vertex where a disc can touch it: from one normal of its edges to the other.

    Where the wall turns left the fan opens to its right, and the other way round; a free end has half a circle, a
    vertex at an edge without length all of it, a smooth one nothing (from the same direction to the same).

    Returns:
        Columns of ``Fan`` (V, 5), and of ``Corner`` (V, 4).
    """
    arriving, leaving = np.zeros((2, len(vertices), 2))
    arriving[ends], leaving[starts] = _end_normals(lines, bulges)
    corners = np.hstack([vertices, arriving + leaving])
    first, last = np.ones((2, len(vertices)), dtype=np.bool_)
    first[ends], last[starts] = False, False
    arriving[first], leaving[last] = -leaving[first], -arriving[last]
    cross = arriving[:, 0] * leaving[:, 1] - arriving[:, 1] * leaving[:, 0]
    dot = arriving[:, 0] * leaving[:, 0] + arriving[:, 1] * leaving[:, 1]
    left, smooth = (cross >= 0.0)[:, None], (np.abs(cross) <= SMOOTH) & (dot > 0.0)
    fans = np.zeros((len(vertices), len(Fan._fields)))
    fans[:, 0:2], fans[:, 2:4] = np.where(left, arriving, -leaving), np.where(left, leaving, -arriving)
    fans[smooth] = 1.0, 0.0, 1.0, 0.0, 0.0
    none = lines[:, 6] == 0.0
    fans[np.concatenate([starts[none], ends[none]])] = 1.0, 0.0, 1.0, 0.0, 1.0
    return fans, corners


def _end_normals(lines: FloatArray, bulges: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Give the outward normals at the end and at the start of each edge: an arc's are its chord's, turned."""
    normals = lines[:, 4:6]
    if not bulges.any():
        return normals, normals
    b = np.where(np.abs(bulges) > FLAT, bulges, 0.0)[:, None]  # tan of half the angle between arc and chord
    along, across = (1.0 - b * b) / (1.0 + b * b) * normals, 2.0 * b / (1.0 + b * b) * normals
    turned = np.stack([-across[:, 1], across[:, 0]], axis=1)
    return along + turned, along - turned


def _restitution(scene: Scene) -> FloatArray | None:
    materials = scene.walls.materials
    different = {id(m): m for m in materials}.values()  # by identity: to hash ten thousand takes long
    if all(m.restitution == 1.0 and m.tangential_restitution == 1.0 for m in different):
        return None
    pairs = np.array([(m.restitution, m.tangential_restitution) for m in materials], dtype=np.float64)
    return np.ascontiguousarray(pairs).reshape(-1)


def _gravity(scene: Scene) -> FloatArray | None:
    if scene.gravity is None:
        return None
    gravity = np.array(scene.gravity, dtype=np.float64)
    if gravity.shape != (2,) or not np.isfinite(gravity).all():
        raise SceneError(f"gravity is {scene.gravity!r}", code="bad-gravity", fix="give two numbers, GX,GY")
    return gravity if gravity.any() else None


def _one_sided(scene: Scene) -> IntArray | None:
    if "outward" not in scene.walls.sides:
        return None
    return np.array([sides == "outward" for sides in scene.walls.sides], dtype=np.int64)


def _records(columns: FloatArray, dtype: np.dtype[Any]) -> NDArray[Any]:
    return np.ascontiguousarray(columns).view(dtype).reshape(-1)
