"""Walls: closed and open polylines of lines and arcs with outward normals. The contract is on the class."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import IO, Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from importers.pictured import Pictured
from importers.problems import Problem
from wallkit import arguments
from wallkit.geometry.arrays import FloatArray, IntArray
from wallkit.walls.fields import CHECKS, bulges_of, check_count, each, flags, points_of, several, wrong
from wallkit.walls.fields import Material as Material
from wallkit.walls.fields import Sides as Sides
from wallkit.walls.fields import WallsError as WallsError
from wallkit.walls.origins import NOWHERE
from wallkit.walls.origins import Marker as Marker
from wallkit.walls.origins import Origin as Origin
from wallkit.walls.solid import Solid

ARRAYS = ("vertices", "offsets", "closed", "bulges", "depth", "sides", "materials", "names", "layers", "origins")
"""What there is of each vertex or wall, and not of all walls together."""


@dataclass(frozen=True, slots=True, repr=False, eq=False)
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
    origin: Origin = NOWHERE

    def __repr__(self) -> str:
        words = "closed" if self.closed else "open"
        name = f" {self.name!r}" if self.name else ""
        return f"<Wall{name}: {words}, {_counted(len(self.normals), 'edge')}, depth {self.depth}, sides {self.sides!r}>"


@dataclass(slots=True, eq=False, repr=False)
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
        solid: whether the outermost walls are rooms, how that was decided and why; None for walls given as numbers.
        origins: W origins: the title, groups, colours and tags of each wall.
        markers: named places: spawns and targets.
        sensors: what words of the drawing made sensors, in the same units; None without any. ``open_scene`` moves
            them into the scene.

    Raises:
        WallsError: an array has a wrong shape or a number that is not finite, or a word or a material is none.
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
    solid: Solid | None = None
    origins: tuple[Origin, ...] = ()
    markers: tuple[Marker, ...] = ()
    sensors: Walls | None = None

    def __setattr__(self, name: str, value: Any) -> None:
        if name == "solid" and not (value is None or isinstance(value, Solid)):
            raise wrong("solid", value, "a Solid, or None")
        object.__setattr__(self, name, CHECKS[name](value) if name in CHECKS else value)

    def __post_init__(self) -> None:
        ends = self.offsets[:1].tolist() + self.offsets[-1:].tolist()
        if ends != [0, len(self.vertices)] or (np.diff(self.offsets) < 1).any():
            raise wrong("offsets", self.offsets, f"whole numbers that rise from 0 to the {len(self.vertices)} vertices")
        if not self.origins:
            self.origins = (NOWHERE,) * len(self.closed)
        for name in ("depth", "sides", "materials", "names", "layers", "origins"):
            check_count(name, len(getattr(self, name)), len(self.closed), "walls")
        check_count("closed", len(self.closed), len(self.offsets) - 1, "walls between offsets")
        check_count("bulges", len(self.bulges), len(self.vertices), "vertices")

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
        origins: Sequence[Origin] | None = None,
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
            origins: what is known of each polyline beyond its shape.

        Raises:
            WallsError: a shape is wrong, a number is not finite, or a word or a material is none.
        """
        arrays = [points_of(points, index) for index, points in enumerate(several(polylines, "polylines"))]
        count = len(arrays)
        lengths = [len(points) for points in arrays]
        offsets = np.concatenate([[0], np.cumsum(lengths)]).astype(np.int64)
        vertices = np.concatenate(arrays) if arrays else np.empty((0, 2))
        given = [None] * count if bulges is None else several(bulges, "bulges")
        check_count("bulges", len(given), count, "polylines")
        bulge_arrays = [bulges_of(one, lengths[i], i) for i, one in enumerate(given)]
        return cls(
            vertices=np.ascontiguousarray(vertices, dtype=np.float64),
            offsets=offsets,
            closed=flags(each(closed, count, "closed")),
            bulges=np.concatenate(bulge_arrays) if bulge_arrays else np.empty(0),
            depth=np.zeros(count, dtype=np.int64),
            sides=tuple(each(sides, count, "sides")),
            materials=tuple(each(Material() if material is None else material, count, "material")),
            names=tuple(each(names if names is not None else "", count, "names")),
            layers=tuple(each(layers if layers is not None else "", count, "layers")),
            origins=tuple(each([NOWHERE] * count if origins is None else origins, count, "origins")),
        )

    def __len__(self) -> int:
        return len(self.closed)

    def __iter__(self) -> Iterator[Wall]:
        return (self[index] for index in range(len(self)))

    def __repr__(self) -> str:
        x0, y0, x1, y1 = self.box()
        open_ones, arcs = int(np.count_nonzero(~self.closed)), int(np.count_nonzero(self.bulges))
        parts = [
            _counted(len(self), "wall") + (f" ({open_ones:,} open)" if open_ones else ""),
            _counted(len(self.edge_starts), "edge") + (f" ({_counted(arcs, 'arc')})" if arcs else ""),
            f"{x1 - x0:.6g} x {y1 - y0:.6g} {self.units}".rstrip(),
            f"y {self.y_axis}",
            *([f"from {self.source_file!r}"] if self.source_file else []),
            *([_counted(len(self.problems), "problem")] if self.problems else []),
        ]
        return f"<Walls: {', '.join(parts)}>"

    def __getitem__(self, index: int) -> Wall:
        """Give one wall by its number, from the end where it is negative; an IndexError where there is none."""
        if not isinstance(index, int | np.integer):
            raise wrong("a wall's number", index, f"a whole number from 0 to {len(self) - 1}; several with take()")
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
            origin=self.origins[index],
        )

    def take(self, walls: ArrayLike | slice) -> Walls:
        """Choose walls: their numbers in the order wanted, a mask of W truth values, or a slice.

        Everything else about them stays as it was, depth and problems included.

        Raises:
            WallsError: there is no such wall, or the mask has another length.
        """
        which = arguments.chosen(walls, len(self), "walls", error=WallsError, code="bad-wall")
        lengths = np.diff(self.offsets)[which]
        offsets = np.concatenate([[0], np.cumsum(lengths)]).astype(np.int64)
        vertex = np.arange(offsets[-1]) + np.repeat(self.offsets[which] - offsets[:-1], lengths)
        words = ("sides", "materials", "names", "layers", "origins")
        taken: dict[str, Any] = {name: tuple(getattr(self, name)[index] for index in which.tolist()) for name in words}
        arrays: dict[str, Any] = {name: getattr(self, name)[which] for name in ("closed", "depth")}
        arrays |= {name: getattr(self, name)[vertex] for name in ("vertices", "bulges")}
        return replace(self, offsets=offsets, problems=list(self.problems), **arrays, **taken)

    @property
    def edge_starts(self) -> IntArray:
        """(E,) index into ``vertices`` of each edge's start, walls in order."""
        keep = np.ones(len(self.vertices), dtype=np.bool_)
        keep[self.offsets[1:] - 1] = self.closed  # the last vertex of an open wall begins no edge
        return np.flatnonzero(keep).astype(np.int64, copy=False)

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
    def tags(self) -> tuple[Mapping[str, str], ...]:
        """The words of each wall, by key; see docs/tags.md."""
        return tuple(origin.tags for origin in self.origins)

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
        """Write the walls as JSON, see :func:`wallkit.walls.walls_json.save`."""
        from wallkit.walls.walls_json import save

        arguments.of_type(path, "path", (str, Path), "a path", error=WallsError, code="bad-path")
        save(self, path)

    @staticmethod
    def load(source: str | Path | IO[bytes] | IO[str]) -> Walls:
        """Read walls that :meth:`save` wrote, the same bits; see :func:`wallkit.walls.walls_json.load`."""
        from wallkit.walls.walls_json import load

        if not isinstance(source, str | Path) and not hasattr(source, "read"):
            raise arguments.refused("source", source, "a path or an open file", WallsError, "bad-path")
        return load(source)

    def export(self, path: str | Path, format: str | None = None, **options: Any) -> list[Problem]:
        """Write the walls as a level for an engine or editor, see :func:`wallkit.export.export`."""
        from wallkit.export import export

        arguments.of_type(path, "path", (str, Path), "a path", error=WallsError, code="bad-path")
        return export(self, path, format, **options)

    def to_shapely(self, tolerance: float | None = None) -> Any:
        """Give the material and the open walls as shapely geometry, see :func:`wallkit.walls.as_shapely.to_shapely`."""
        from wallkit.walls.as_shapely import to_shapely

        return to_shapely(self, _distance(tolerance))

    def to_svgpathtools(self) -> list[Any]:
        """Give a ``svgpathtools.Path`` of lines and arcs for each wall, points x + i y in the walls' units and axes."""
        from wallkit.walls.as_paths import to_svgpathtools

        return to_svgpathtools(self)

    def straightened(self, tolerance: float | None = None) -> Walls:
        """Put lines in the place of arcs, within a distance of them.

        Args:
            tolerance: the largest distance between an arc and its lines, in the walls' units; by default the walls'
                own tolerance, or 1e-4 of their size where that is 0.

        Returns:
            Walls of lines only, the same walls in the same order; the distance is added to ``measured_error``.

        Raises:
            WallsError: the tolerance is no number above 0.
        """
        from wallkit.walls.as_shapely import largest_distance, straightened

        within = _distance(tolerance) or largest_distance(self)
        if not self.has_arcs:
            return self
        vertices, offsets = straightened(self, within)
        return replace(
            self,
            vertices=vertices,
            offsets=offsets,
            bulges=np.zeros(len(vertices)),
            tolerance=self.tolerance + within,
            measured_error=self.measured_error + within,
            measured_normal_error=None,
            problems=list(self.problems),
        )

    def box(self) -> tuple[float, float, float, float]:
        """Give (x_min, y_min, x_max, y_max) of the vertices (arcs may bow beyond); zeros without any."""
        if not len(self.vertices):
            return 0.0, 0.0, 0.0, 0.0
        x, y = self.vertices.T  # a column at a time is many times quicker than along an axis of two
        return float(x.min()), float(y.min()), float(x.max()), float(y.max())


def _distance(tolerance: float | None) -> float | None:
    if tolerance is None:
        return None
    may_be = "a finite number above 0, or None"
    return arguments.number(
        tolerance, "tolerance", may_be, error=WallsError, code="bad-tolerance", least=arguments.ABOVE_0
    )


def _normals(a: FloatArray, b: FloatArray) -> FloatArray:
    d = b - a
    length = np.hypot(d[:, 0], d[:, 1])
    outward = np.stack([d[:, 1], -d[:, 0]], axis=1)
    return np.divide(outward, length[:, None], out=np.zeros_like(outward), where=length[:, None] > 0)


def _counted(number: int, word: str) -> str:
    return f"{number:,} {word}{'' if number == 1 else 's'}"
