"""Walls: closed and open polylines of lines and arcs with outward normals. The contract is on the class."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import IO, Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from importers.errors import WallkitError
from importers.pictured import Pictured
from importers.problems import Problem

Sides = Literal["both", "outward"]
FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


class WallsError(WallkitError):
    """Arrays given as walls do not describe walls."""


@dataclass(frozen=True, slots=True)
class Material:
    """How a wall gives a ball back.

    Attributes:
        restitution: 0 to 1, the part of the normal speed that a bounce leaves.
        tangential_restitution: 0 to 1, the same along the wall. 0.9 for both slows a ball down by 10 %.
        static_friction: 0 or more, the coefficient of the friction that holds a ball which stands on the wall under
            gravity: the tangent of the steepest slope on which it stays. One that moves along the wall is not slowed.
    """

    restitution: float = 1.0
    tangential_restitution: float = 1.0
    static_friction: float = 0.0

    def __post_init__(self) -> None:
        for name in ("restitution", "tangential_restitution"):
            value = getattr(self, name)
            if not 0.0 <= value <= 1.0:
                raise WallsError(f"{name} is {value!r}", code="bad-material", fix="give a number from 0 to 1")
        if not 0.0 <= self.static_friction < math.inf:
            raise WallsError(
                f"static_friction is {self.static_friction!r}", code="bad-material", fix="give a number, 0 or more"
            )


@dataclass(frozen=True, slots=True)
class Wall:
    """One wall, as a view into Walls; see there for what the arrays mean."""

    name: str
    layer: str
    closed: bool
    depth: int
    sides: Sides
    material: Material
    vertices: FloatArray
    bulges: FloatArray
    normals: FloatArray


@dataclass(slots=True, eq=False)
class Walls(Pictured):
    """Polylines whose edges are lines or circular arcs, in the units and axes of the drawing.

    The contract, stated once:

    * Wall ``w`` has the vertices ``offsets[w]`` to ``offsets[w + 1]``. A closed wall does not repeat its first
      vertex; its last edge goes back to it. An open wall of n vertices has n - 1 edges.
    * Edge ``i`` of a wall goes from its vertex i to the next. Its bulge is ``bulges`` at that vertex: 0 a line,
      else tan(angle / 4) of a circular arc, positive when the arc turns left (counter-clockwise with y up) from
      start to end, so that it bows to the *right* of its chord. |bulge| <= 1 is at most a half circle.
    * The outward normal of the edge from a to b is (dy, -dx) / |d| with d = b - a: the right of the edge with
      y up. Solid material is left of the edge. So a solid has positive shoelace area and a room (or a hole)
      negative area, whatever way the drawing's y axis points.
    * ``depth`` counts the closed walls around a wall: even depth is a solid's outside (or the outermost ring),
      odd depth a hole. For an open wall it is the number of closed walls around it.
    * ``sides``: ``"both"`` chooses the normal per approach; ``"outward"`` is solid only for a ball that
      comes against the outward normal.

    What is not checked here: that walls do not cross, that nesting is right (``wallkit.walls.nesting``), that
    edges have a length. The simulator is defined for all of these.

    Attributes:
        vertices: (V, 2) float64.
        offsets: (W + 1,) int64, rising, from 0 to V.
        closed: (W,) bool.
        bulges: (V,) float64; at the last vertex of an open wall 0 and unused.
        depth: (W,) int64.
        sides: W words.
        materials: W materials.
        names: W names, ``""`` where there is none.
        layers: W layer names.
        units: as the drawing's.
        y_axis: ``"up"`` or ``"down"``.
        tolerance: the largest distance that was asked for between the walls and the drawn curves; 0 for
            walls that were given as numbers.
        measured_error: the largest distance that was measured between the two.
        measured_normal_error: for arcs, the largest angle in radians between the two normals; None for lines.
        source_file: the drawing's name, or ``""``.
        source_sha256: hex digest of the drawing's bytes, or ``""``.
        problems: what was found on the way from the drawing.
    """

    vertices: FloatArray
    offsets: IntArray
    closed: NDArray[np.bool_]
    bulges: FloatArray
    depth: IntArray
    sides: tuple[Sides, ...]
    materials: tuple[Material, ...]
    names: tuple[str, ...]
    layers: tuple[str, ...]
    units: str = ""
    y_axis: Literal["up", "down"] = "up"
    tolerance: float = 0.0
    measured_error: float = 0.0
    measured_normal_error: float | None = None
    source_file: str = ""
    source_sha256: str = ""
    problems: list[Problem] = field(default_factory=list)

    @classmethod
    def from_polylines(
        cls,
        polylines: Sequence[ArrayLike],
        closed: bool | Sequence[bool] = True,
        *,
        bulges: Sequence[ArrayLike | None] | None = None,
        sides: Sides | Sequence[Sides] = "both",
        material: Material | Sequence[Material] | None = None,
        names: Sequence[str] | None = None,
        layers: Sequence[str] | None = None,
    ) -> Walls:
        """Make walls of arrays of points, kept as they are: no reordering, no repair.

        Args:
            polylines: arrays (n, 2), n >= 2 each (a closed one of two points is a two-sided line).
            closed: one bool, or one a polyline.
            bulges: one array (n,) a polyline, or None for lines.
            sides: one word, or one a polyline.
            material: one material, or one a polyline.
            names: one name a polyline.
            layers: one layer name a polyline.

        Raises:
            WallsError: a shape is wrong or a number is not finite.
        """
        arrays = [_points(points, index) for index, points in enumerate(polylines)]
        count = len(arrays)
        lengths = [len(points) for points in arrays]
        offsets = np.concatenate([[0], np.cumsum(lengths)]).astype(np.int64)
        vertices = np.concatenate(arrays) if arrays else np.empty((0, 2))
        bulge_arrays = [_bulges(bulges[i] if bulges else None, lengths[i], i) for i in range(count)]
        return cls(
            vertices=np.ascontiguousarray(vertices, dtype=np.float64),
            offsets=offsets,
            closed=np.array(_each(closed, count, "closed"), dtype=np.bool_),
            bulges=np.concatenate(bulge_arrays) if bulge_arrays else np.empty(0),
            depth=np.zeros(count, dtype=np.int64),
            sides=tuple(_each(sides, count, "sides")),
            materials=tuple(_each(material or Material(), count, "material")),
            names=tuple(_each(names if names is not None else "", count, "names")),
            layers=tuple(_each(layers if layers is not None else "", count, "layers")),
        )

    def __len__(self) -> int:
        return len(self.closed)

    def __iter__(self) -> Iterator[Wall]:
        return (self[index] for index in range(len(self)))

    def __getitem__(self, index: int) -> Wall:
        if not -len(self) <= index < len(self):
            raise IndexError(f"wall {index} of {len(self)}")
        index %= len(self)
        span = slice(int(self.offsets[index]), int(self.offsets[index + 1]))
        vertices, closed = self.vertices[span], bool(self.closed[index])
        following = np.concatenate([vertices[1:], vertices[:1]]) if closed else vertices[1:]
        return Wall(
            name=self.names[index],
            layer=self.layers[index],
            closed=closed,
            depth=int(self.depth[index]),
            sides=self.sides[index],
            material=self.materials[index],
            vertices=vertices,
            bulges=self.bulges[span],
            normals=_normals(vertices[: len(following)], following),
        )

    @property
    def edge_starts(self) -> IntArray:
        """(E,) index into ``vertices`` of each edge's start, walls in order."""
        keep = np.ones(len(self.vertices), dtype=np.bool_)
        keep[self.offsets[1:][~self.closed] - 1] = False
        return np.flatnonzero(keep).astype(np.int64)

    @property
    def edge_ends(self) -> IntArray:
        """(E,) index into ``vertices`` of each edge's end."""
        following = np.arange(1, len(self.vertices) + 1, dtype=np.int64)
        following[self.offsets[1:] - 1] = self.offsets[:-1]
        return following[self.edge_starts]

    @property
    def edge_offsets(self) -> IntArray:
        """(W + 1,) first edge of each wall: edge ``e`` of wall ``w`` is ``edge_offsets[w] + e`` overall."""
        counts = np.diff(self.offsets) - ~self.closed
        return np.concatenate([[0], np.cumsum(counts)]).astype(np.int64)

    @property
    def normals(self) -> FloatArray:
        """(E, 2) outward unit normals, at the chord for an arc; zero for an edge without length."""
        return _normals(self.vertices[self.edge_starts], self.vertices[self.edge_ends])

    @property
    def has_arcs(self) -> bool:
        """Some edge is an arc."""
        return bool(np.any(self.bulges))

    def __eq__(self, other: object) -> bool:
        """The same walls: every number bit for bit, every word, every problem."""
        if not isinstance(other, Walls):
            return NotImplemented
        mine, others = (tuple(getattr(walls, name) for name in walls.__slots__) for walls in (self, other))
        return all(
            a.tobytes() == b.tobytes() if isinstance(a, np.ndarray) else a == b
            for a, b in zip(mine, others, strict=True)
        )

    __hash__ = None  # type: ignore[assignment]

    def save(self, path: str | Path) -> None:
        """Write the walls as JSON, see :func:`wallkit.walls.files.save`."""
        from wallkit.walls.files import save

        save(self, path)

    @staticmethod
    def load(source: str | Path | IO[bytes] | IO[str]) -> Walls:
        """Read walls that :meth:`save` wrote, the same bits; see :func:`wallkit.walls.files.load`."""
        from wallkit.walls.files import load

        return load(source)

    def to_shapely(self, tolerance: float | None = None) -> Any:
        """Give the material and the open walls as shapely geometry, see :func:`wallkit.walls.shapes.to_shapely`."""
        from wallkit.walls.shapes import to_shapely

        return to_shapely(self, tolerance)

    def box(self) -> tuple[float, float, float, float]:
        """Give (x_min, y_min, x_max, y_max) of the vertices (arcs may bow beyond); zeros without any."""
        if not len(self.vertices):
            return 0.0, 0.0, 0.0, 0.0
        x, y = self.vertices.T  # a column at a time is many times quicker than along an axis of two
        return float(x.min()), float(y.min()), float(x.max()), float(y.max())


def _normals(a: FloatArray, b: FloatArray) -> FloatArray:
    d = b - a
    length = np.hypot(d[:, 0], d[:, 1])
    outward = np.stack([d[:, 1], -d[:, 0]], axis=1)
    return np.divide(outward, length[:, None], out=np.zeros_like(outward), where=length[:, None] > 0)


def _points(points: ArrayLike, index: int) -> FloatArray:
    array = np.asarray(points, dtype=np.float64)
    if array.ndim != 2 or array.shape[1] != 2 or len(array) < 2:
        raise WallsError(
            f"polyline {index} has the shape {array.shape}",
            code="bad-polyline",
            fix="give an (n, 2) array, n >= 2",
        )
    if not np.isfinite(array).all():
        raise WallsError(f"polyline {index} has a coordinate that is not finite", code="bad-polyline")
    return array


def _bulges(bulges: ArrayLike | None, length: int, index: int) -> FloatArray:
    if bulges is None:
        return np.zeros(length)
    array = np.asarray(bulges, dtype=np.float64)
    if array.shape != (length,) or not np.isfinite(array).all():
        raise WallsError(
            f"bulges of polyline {index} have the shape {array.shape}",
            code="bad-bulges",
            fix=f"give {length} finite numbers, one a vertex",
        )
    return array


def _each(value: Any, count: int, name: str) -> list[Any]:  # one value, or one a wall
    if isinstance(value, str | bool | Material):
        return [value] * count
    values = list(value)
    if len(values) != count:
        raise WallsError(f"{name} has {len(values)} entries for {count} polylines", code="bad-count")
    return values
