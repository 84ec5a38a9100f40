"""Level: walls placed in the units and axes of a target, the one thing that exporters read.

Where the target's y axis points the other way, all is mirrored. A mirror turns left into right, so closed walls
are reversed as well: then the contract of :class:`wallkit.Walls` holds in the target's numbers too (material left
of its edges, outward normal (dy, -dx)), whichever way y looks.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from importers.limits import MAX_COORDINATE
from wallkit.export.findings import Findings
from wallkit.export.number_text import BLOCK
from wallkit.export.options import Box, ExportError, ExportOptions, Point
from wallkit.geometry.arrays import FloatArray, IntArray
from wallkit.geometry.rings import signed_areas
from wallkit.walls.as_shapely import straightened
from wallkit.walls.walls import Material, Sides, Walls

YAxis = Literal["up", "down"]
LARGER_SIDE = 20.0  # m, of a level in an engine that counts in metres
MIN_SPACING = 0.0051  # m: Box2D's linear slop is 0.005


@dataclass(frozen=True, slots=True, eq=False)
class LevelWall:
    """One wall in a target's numbers.

    Attributes:
        number: of the wall among Walls.
        name: as drawn, or ``""``.
        layer: as drawn, or ``""``.
        closed: a ring; it does not repeat its first vertex.
        depth: as in Walls.
        sides: ``"both"`` or ``"outward"``.
        material: of the wall.
        vertices: (n, 2).
        bulges: (n,); zeros where the target knows lines only.
        curve: (m, 3) x, y, bulge of the wall before its arcs became lines; None where it has none.
        place: its first vertex in the drawing.
    """

    number: int
    name: str
    layer: str
    closed: bool
    depth: int
    sides: Sides
    material: Material
    vertices: FloatArray
    bulges: FloatArray
    curve: FloatArray | None
    place: Point

    @property
    def one_way(self) -> bool:
        """It stops only what comes against the outward normals."""
        return self.sides == "outward"


@dataclass(slots=True)
class Level:
    """Walls for a target.

    Attributes:
        walls: in order.
        y_axis: of the target.
        scale: target units per unit of the drawing.
        box: (x_min, y_min, x_max, y_max) of all vertices in the target; zeros without any.
        page: (width, height) of the page in the target, or None.
        options: as given.
        findings: where exporters say what they could not.
        source_file: the drawing's name.
        units: of the drawing, where the scale left them; else ``""``.
    """

    walls: list[LevelWall]
    y_axis: YAxis
    scale: float
    box: Box
    page: Point | None
    options: ExportOptions
    findings: Findings
    source_file: str
    units: str

    def __iter__(self) -> Iterator[LevelWall]:
        return iter(self.walls)

    @property
    def side(self) -> float:
        """The larger side of the box, at least something."""
        return max(self.box[2] - self.box[0], self.box[3] - self.box[1]) or 1.0

    @property
    def is_room(self) -> bool:
        """The outermost closed walls are rooms: material lies outside of them."""
        depths = [wall.depth for wall in self.walls if wall.closed]
        return bool(depths and min(depths) % 2)

    def layers(self) -> dict[str, list[LevelWall]]:
        """Give the walls of each layer, layers in order of their first wall."""
        result: dict[str, list[LevelWall]] = {}
        for wall in self.walls:
            result.setdefault(wall.layer, []).append(wall)
        return result


def build_level(
    walls: Walls, options: ExportOptions, *, y_axis: YAxis = "down", arcs: bool = False, metres: bool = False
) -> Level:
    """Place walls for a target.

    Args:
        walls: any walls.
        options: of the export.
        y_axis: of the target.
        arcs: the target knows arcs; else they become lines within ``options.tolerance``.
        metres: the target counts in metres, and dislikes vertices within 5 mm of each other.

    Returns:
        The level; what had to be changed is in its findings.
    """
    findings = Findings(len(walls))
    rough, rough_offsets = straightened(walls, options.tolerance)
    lines = walls if arcs or not walls.has_arcs else _as_lines(walls, rough, rough_offsets)
    box = _box(rough)
    scale = options.scale or (LARGER_SIDE / (max(box[2] - box[0], box[3] - box[1]) or 1.0) if metres else 1.0)
    frame = _Frame(box, options, scale, walls.y_axis != y_axis)
    placed = frame.place(lines, options.grid)
    curves = frame.place(walls, 0.0) if lines is not walls and not options.grid else None
    made = _walls(walls, placed, curves)
    spacing = options.min_spacing if options.min_spacing is not None else MIN_SPACING if metres else 0.0
    if spacing or options.grid:
        made = _spaced(made, spacing, findings)
    everything = np.concatenate([wall.vertices for wall in made]) if made else np.empty((0, 2))
    page = frame.page and (scale * (frame.page[2] - frame.page[0]), scale * (frame.page[3] - frame.page[1]))
    level = Level(
        made,
        y_axis,
        scale,
        _box(everything),
        page,
        options,
        findings,
        walls.source_file,
        walls.units if scale == 1 else "",
    )
    _say(level, walls, lines, placed, frame.place(lines, 0.0) if options.grid else placed)
    if metres and options.scale is None and made:
        findings.say(
            "export-scale",
            f"1 unit of the drawing is {scale:.6g} m, so that the level is {LARGER_SIDE:g} m large; at 60 steps "
            f"a second Box2D bounces balls of 1 to 120 m/s, here {1 / scale:.4g} to {120 / scale:.4g} units/s",
            "--meters-per-unit sets the size",
        )
    return level


def _as_lines(walls: Walls, vertices: FloatArray, offsets: IntArray) -> Walls:
    return replace(walls, vertices=vertices, offsets=offsets, bulges=np.zeros(len(vertices)))


def _box(points: FloatArray) -> Box:
    if not len(points):
        return 0.0, 0.0, 0.0, 0.0
    x, y = points.T
    return float(x.min()), float(y.min()), float(x.max()), float(y.max())


@dataclass(frozen=True, slots=True)
class _Frame:
    """How points of the drawing become points of the target."""

    box: Box
    options: ExportOptions
    scale: float
    flip: bool

    @property
    def page(self) -> Box | None:
        return self.options.page if self.options.origin == "page" else None

    def origin(self) -> Point:
        """What becomes (0, 0). The corner is that of smallest y, or with a flip that of largest y."""
        if isinstance(self.options.origin, tuple):
            return self.options.origin
        corner = self.box if self.options.origin == "box" else self.page
        if corner is None:
            return 0.0, self.box[3] if self.flip else 0.0
        return corner[0], corner[3] if self.flip else corner[1]

    def place(self, walls: Walls, grid: float) -> Walls:
        """Move, mirror, scale and round; walls keep their number, order and first vertices.

        Raises:
            ExportError: what comes out is larger than coordinates may be.
        """
        x, y = self.origin()
        vertices, bulges = walls.vertices, walls.bulges
        if self.flip:
            turn = walls.closed | np.array([sides == "outward" for sides in walls.sides], dtype=np.bool_)
            vertices, bulges = _reversed(walls, turn)
            vertices, bulges = np.stack([vertices[:, 0] - x, y - vertices[:, 1]], axis=1), 0.0 - bulges
        elif x or y:
            vertices = vertices - [x, y]
        if self.scale != 1:
            with np.errstate(over="ignore"):
                vertices = vertices * self.scale
        if not np.abs(vertices).max(initial=0.0) <= MAX_COORDINATE:
            message = f"the level reaches beyond {MAX_COORDINATE:g}"
            raise ExportError(message, code="bad-option", fix="give a smaller --target-scale, or a nearer --origin")
        if grid:
            vertices = np.round(vertices / grid) * grid + 0.0  # no -0
        return replace(walls, vertices=vertices, bulges=bulges)


def _reversed(walls: Walls, turn: np.ndarray) -> tuple[FloatArray, FloatArray]:
    """Reverse some walls: a closed one keeps its first vertex; bulges go to the new edges, negated."""
    vertices, bulges = walls.vertices.copy(), walls.bulges.copy()
    closed, offsets = walls.closed.tolist(), walls.offsets.tolist()
    for wall in np.flatnonzero(turn).tolist():
        a, b = offsets[wall], offsets[wall + 1]
        kept, last = (a + 1, b) if closed[wall] else (a, b - 1)  # an open wall's last bulge is of no edge
        vertices[kept:b] = walls.vertices[kept:b][::-1]
        bulges[a:last] = 0.0 - walls.bulges[a:last][::-1]
        bulges[last:b] = 0.0 - walls.bulges[last:b]
    return vertices, bulges


def _walls(walls: Walls, placed: Walls, curves: Walls | None) -> list[LevelWall]:
    starts, ends = placed.offsets[:-1].tolist(), placed.offsets[1:].tolist()
    columns = zip(walls.names, walls.layers, walls.closed.tolist(), walls.depth.tolist(), walls.sides, strict=True)
    places = walls.vertices[walls.offsets[:-1]].tolist()
    result = []
    for number, (name, layer, closed, depth, sides) in enumerate(columns):
        a, b = starts[number], ends[number]
        result.append(
            LevelWall(
                number=number,
                name=_sound(name),
                layer=_sound(layer),
                closed=closed,
                depth=depth,
                sides=sides,
                material=walls.materials[number],
                vertices=placed.vertices[a:b],
                bulges=placed.bulges[a:b],
                curve=None if curves is None else _curve(curves, number),
                place=(places[number][0], places[number][1]),
            )
        )
    return result


def _sound(text: str) -> str:
    """Give a text that every file can hold: half a surrogate pair becomes a question mark."""
    return text if text.isascii() else text.encode("utf-8", "replace").decode("utf-8")


def _curve(curves: Walls, number: int) -> FloatArray | None:
    span = slice(int(curves.offsets[number]), int(curves.offsets[number + 1]))
    if not curves.bulges[span].any():
        return None
    return np.column_stack([curves.vertices[span], curves.bulges[span]])


def _spaced(walls: list[LevelWall], spacing: float, findings: Findings) -> list[LevelWall]:
    """Leave out vertices that are too near to the one before; walls of which no edge is left go."""
    kept, merged, gone = [], [], []
    for wall in walls:
        keep = _far_enough(wall.vertices, wall.closed, spacing)
        if len(keep) == len(wall.vertices):
            kept.append(wall)
        elif len(keep) < 2:
            gone.append(wall)
        else:
            merged.append(wall)
            kept.append(replace(wall, vertices=wall.vertices[keep], bulges=wall.bulges[keep]))
    findings.note(
        "export-merged",
        merged,
        f"vertices within {spacing:g} of the one before are left out" if spacing else "equal vertices are one",
        "--min-spacing sets the distance, --target-scale the size" if spacing else "a finer --grid",
    )
    findings.note(
        "export-left-out",
        gone,
        "no edge is left, so the wall is left out",
        "a larger --target-scale, or a finer --grid",
        "warning",
    )
    return kept


def _far_enough(vertices: FloatArray, closed: bool, spacing: float) -> IntArray:
    """List the vertices to keep: each farther than ``spacing`` from the last kept, the ends of open walls first."""
    step = np.hypot(*np.diff(vertices, axis=0).T)
    around = float(np.hypot(*(vertices[-1] - vertices[0]))) if closed else np.inf
    if (not len(step) or step.min() > spacing) and around > spacing:
        return np.arange(len(vertices))
    px, py = vertices[0].tolist()
    keep = [0]
    for start in range(1, len(vertices), BLOCK):
        for index, (x, y) in enumerate(vertices[start : start + BLOCK].tolist(), start=start):
            if math.hypot(x - px, y - py) > spacing:
                keep.append(index)
                px, py = x, y
    last = len(vertices) - 1
    if closed:
        while len(keep) > 1 and np.hypot(*(vertices[keep[-1]] - vertices[0])) <= spacing:
            keep.pop()
    elif keep[-1] != last and len(keep) > 1:
        keep[-1] = last
    return np.array(keep, dtype=np.int64)


def _say(level: Level, walls: Walls, lines: Walls, placed: Walls, exact: Walls) -> None:
    """Say what was changed on the way: arcs that became lines, rounding, and walls off the map."""
    if lines is not walls:
        within = level.options.tolerance or walls.tolerance
        how = f"within {within:g}" if within else "within 1e-4 of the size"
        curved = set(np.flatnonzero(np.add.reduceat(walls.bulges != 0, walls.offsets[:-1])).tolist())
        level.findings.note_where(
            "export-arcs-as-lines",
            level.walls,
            lambda wall: wall.number in curved,
            f"arcs are written as lines {how}",
            "--tolerance sets how near; dxf and svg keep arcs",
        )
    if exact is not placed:
        moved = float(np.abs(exact.vertices - placed.vertices).max(initial=0.0))
        if moved:
            level.findings.say("export-rounded", f"coordinates moved by up to {moved:.3g} onto the grid", "")
    if level.y_axis == "down" and min(level.box[:2]) < 0 and level.options.origin == "page":
        level.findings.note_where(
            "export-outside",
            level.walls,
            lambda wall: bool((wall.vertices < 0).any()),
            "coordinates are negative: left of or above the page",
            "--origin box moves the level to (0, 0)",
        )


def signed_areas_of(walls: Sequence[LevelWall]) -> list[float]:
    """Signed area of each wall, an open one as if closed: positive for a solid, negative for a hole or a room."""
    if not walls:
        return []
    offsets = np.concatenate([[0], np.cumsum([len(wall.vertices) for wall in walls])])
    vertices = np.concatenate([wall.vertices for wall in walls])
    bulges = np.concatenate([wall.bulges for wall in walls])
    areas: list[float] = signed_areas(vertices, bulges, offsets).tolist()
    return areas
