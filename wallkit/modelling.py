"""From a scene to what the kernels see: local coordinates, flat arrays, an index, None for what is absent."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from wallkit.damping import damping_of
from wallkit.indexing import Places, build_grid
from wallkit.kernels.model import ARC, CELL, CORNER, LINE, Arc, Cell, Corner, Line, Model
from wallkit.scene import FloatArray, Scene, SceneError
from wallkit.walls import Walls

IntArray = NDArray[np.int64]
SMOOTH = 2.0**-44
"""Edges that meet at less than this angle (radians) have no corner: see ``scan_disc`` for how they overlap."""
FLAT = 2.0**-44
"""An arc with a smaller bulge is its chord, to rounding."""
BRUTE_FORCE = 16
"""Up to this many edges looking at all of them beats any index."""


class Modelled:
    """A scene as the kernels see it.

    Attributes:
        model: arrays for the compiled kernels.
        origin: (2,) added to local coordinates it gives the scene's.
        radii: (n,) of the balls.
        box: (x_min, y_min, x_max, y_max) that no wall reaches beyond, in the scene's coordinates.
    """

    def __init__(self, scene: Scene, *, index: str = "auto") -> None:
        self.box = _box(scene.walls)
        self.radii = np.asarray(scene.balls.radius, dtype=np.float64)
        self.origin = local_origin(scene.walls.vertices)
        least = float(self.radii.min()) if len(self.radii) else 0.0
        self.model = _model(scene, self.origin, least, float(self.radii.max(initial=0.0)), index)
        self._lists: Model | None = None

    @property
    def lists(self) -> Model:
        """The model with lists of Python floats for arrays: several times faster to interpret."""
        if self._lists is None:
            self._lists = _as_lists(self.model)
        return self._lists

    def index_of_edge(self, scene: Scene) -> tuple[IntArray, IntArray]:
        """Give wall and edge within the wall of each edge overall."""
        offsets = scene.walls.edge_offsets
        wall = np.repeat(np.arange(len(scene.walls)), np.diff(offsets))
        return wall, np.arange(len(wall)) - offsets[wall]


def _box(walls: Walls) -> tuple[float, float, float, float]:
    """Box around the vertices, widened by what the arcs bow at most: half a chord times the bulge, or the circle."""
    x0, y0, x1, y1 = walls.box()
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


def _model(scene: Scene, origin: FloatArray, least: float, radius: float, index: str) -> Model:
    walls = scene.walls
    vertices = walls.vertices - origin
    lines = _lines(vertices[walls.edge_starts], vertices[walls.edge_ends])
    arcs, arc_of_edge, angles = _arcs(lines, walls.bulges[walls.edge_starts])
    wall_of_edge = np.repeat(np.arange(len(walls)), np.diff(walls.edge_offsets)).astype(np.int64)
    line_ids = np.flatnonzero((lines[:, 6] > 0.0) & (arc_of_edge < 0)).astype(np.int64)
    arc_ids = np.flatnonzero(arc_of_edge >= 0).astype(np.int64)
    fans, corners = _fans(walls, vertices, lines, angles)
    corner_ids = np.flatnonzero(fans[:, 1] > SMOOTH).astype(np.int64) if radius > 0.0 else np.empty(0, np.int64)
    one_sided = _one_sided(scene)
    grid, cells, ids = None, *_one_cell(line_ids, arc_ids, corner_ids)
    if index == "grid" or (index == "auto" and len(line_ids) + len(arc_ids) > BRUTE_FORCE):
        least = 0.0 if one_sided is not None else least  # a disc may stand across a wall that it came through
        places = Places(
            lines[line_ids], line_ids, arcs, arc_ids, corners[corner_ids, 0:2], fans[corner_ids], corner_ids
        )
        grid, cells, ids = build_grid(places, (least, radius))
    line_records, arc_records, corner_records = _records(lines, LINE), _records(arcs, ARC), _records(corners, CORNER)
    return Model(
        ids=ids,
        cells=cells,
        grid=grid,
        lines=line_records,
        arcs=arc_records if len(arcs) else None,
        arc_of_edge=arc_of_edge,
        corners=corner_records,
        edge_wall=wall_of_edge,
        corner_wall=np.repeat(np.arange(len(walls)), np.diff(walls.offsets)).astype(np.int64),
        restitution=_restitution(scene),
        one_sided=one_sided,
        gravity=_gravity(scene),
        damping=damping_of(scene),
        extent=float(np.abs(vertices).max(initial=0.0)) + radius,
    )


def _one_cell(lines: IntArray, arcs: IntArray, corners: IntArray) -> tuple[NDArray[Any], NDArray[np.uint32]]:
    """List everything in one cell: (cells, ids)."""
    ids = np.concatenate([lines, arcs, corners, [0]]).astype(np.uint32)
    end = len(ids) - 1
    return np.array([(0, len(lines), end - len(corners), 1), (end, end, end, 1)], dtype=CELL), ids


def _arcs(lines: FloatArray, bulges: FloatArray) -> tuple[FloatArray, IntArray, FloatArray]:
    """Make arcs of edges with a bulge: (columns of ``Arc``, number of each edge's arc or -1, angle of each edge).

    With chord d, its left normal m and bulge b = tan(angle / 4) the centre lies at (a + b) / 2 + m d (1 - b^2) / (4 b)
    and R = d (1 + b^2) / (4 |b|) (as in DXF). An arc that bows less than 2^-44 of its chord is the chord.
    """
    length = lines[:, 6]
    is_arc = (np.abs(bulges) > FLAT) & (length > 0.0)
    number = np.where(is_arc, np.cumsum(is_arc) - 1, -1).astype(np.int64)
    angles = np.where(is_arc, 4.0 * np.arctan(bulges), 0.0)
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
    return np.hstack(columns), number, angles


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


def _fans(walls: Walls, vertices: FloatArray, lines: FloatArray, angles: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Give for each vertex where a disc can touch it: the angles between the normals of its edges, (start, how far).

    Where the wall turns left the fan opens to its right, and the other way round; a free end has half a circle, a
    vertex at an edge without length a whole one.

    Returns:
        The fans (V, 2), and columns of ``Corner``.
    """
    count = len(vertices)
    chord = np.arctan2(lines[:, 4], -lines[:, 5])
    arriving, leaving = np.full(count, np.nan), np.full(count, np.nan)
    arriving[walls.edge_ends], leaving[walls.edge_starts] = chord + angles / 2, chord - angles / 2
    end, start = np.isnan(leaving), np.isnan(arriving)
    turn = np.remainder(leaving - arriving + np.pi, 2 * np.pi) - np.pi
    right = np.where(turn >= 0.0, arriving - np.pi / 2, leaving + np.pi / 2)
    first = np.where(end, arriving - np.pi / 2, np.where(start, leaving + np.pi / 2, right))
    span = np.where(end | start, np.pi, np.abs(turn))
    bare = np.zeros(count, dtype=np.bool_)
    none = lines[:, 6] == 0.0
    bare[walls.edge_starts[none]] = bare[walls.edge_ends[none]] = True
    fans = np.stack([np.where(bare, 0.0, first), np.where(bare, 2 * np.pi, span)], axis=1)
    outward = [np.where(np.isnan(a), 0.0, f(np.nan_to_num(a))) for f in (np.sin, np.cos) for a in (arriving, leaving)]
    return fans, np.stack([vertices[:, 0], vertices[:, 1], outward[0] + outward[1], -outward[2] - outward[3]], axis=1)


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


def _as_lists(model: Model) -> Model:
    def convert(value: Any) -> Any:
        if isinstance(value, np.ndarray):
            if value.dtype.names is not None:
                record: Any = {LINE: Line, ARC: Arc, CORNER: Corner, CELL: Cell}[value.dtype]
                return list(map(record._make, value.tolist()))
            return value.tolist()
        if isinstance(value, tuple):
            return type(value)(*(convert(item) for item in value))
        return value

    return convert(model)  # type: ignore[no-any-return]
