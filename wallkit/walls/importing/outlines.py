"""Outlines: the chosen subpaths as polylines, with what the file says about each; the stage before Walls."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from importers.drawing import DrawnPath
from importers.problems import Problem, Severity
from wallkit.geometry.arrays import FloatArray, IntArray
from wallkit.walls.importing.curves_to_lines import Pieces
from wallkit.walls.importing.segments import Segments
from wallkit.walls.origins import Origin
from wallkit.walls.roles import is_one_way, material_of, said_of, sides_of
from wallkit.walls.walls import Material, Sides, Walls


@dataclass(slots=True, eq=False, repr=False)
class Outlines:
    """Polylines on their way to walls; arrays as in Walls (a closed one does not repeat its first vertex).

    Attributes:
        vertices: (V, 2).
        bulges: (V,).
        offsets: (W + 1,).
        closed: (W,) bool.
        owner: (W,) index into ``paths``.
        paths: the drawn paths.
        problems: what was found so far.
    """

    vertices: FloatArray
    bulges: FloatArray
    offsets: IntArray
    closed: NDArray[np.bool_]
    owner: IntArray
    paths: list[DrawnPath]
    problems: list[Problem] = field(default_factory=list)

    def __len__(self) -> int:
        return len(self.closed)

    def keep(self, wanted: NDArray[np.bool_]) -> Outlines:
        """Give the outlines where ``wanted`` is true."""
        if wanted.all():
            return self
        counts = np.diff(self.offsets)
        rows = np.repeat(wanted, counts)
        return replace(
            self,
            vertices=self.vertices[rows],
            bulges=self.bulges[rows],
            offsets=np.concatenate([[0], np.cumsum(counts[wanted])]),
            closed=self.closed[wanted],
            owner=self.owner[wanted],
        )

    def problem(
        self, index: int, code: str, severity: Severity, message: str, fix: str, at: FloatArray | None = None
    ) -> Problem:
        """Make a problem of outline ``index``, at its first vertex if no place is given."""
        path = self.paths[self.owner[index]]
        place = self.vertices[self.offsets[index]] if at is None else at
        return Problem(
            code=code,
            severity=severity,
            message=message,
            fix=fix,
            layer=path.layer,
            name=path.name,
            line=path.line,
            x=float(place[0]),
            y=float(place[1]),
        )

    def to_walls(self, sides: Sides) -> Walls:
        """Make walls of them, in this order; what words say of one goes before ``sides``, for open ones too."""
        walls = Walls.from_polylines([])
        count = len(self)
        told = [_told(path, sides) for path in self.paths]
        owner = self.owner.tolist()
        return replace(
            walls,
            vertices=np.ascontiguousarray(self.vertices),
            bulges=np.ascontiguousarray(self.bulges),
            offsets=self.offsets.astype(np.int64),
            closed=self.closed,
            depth=np.zeros(count, dtype=np.int64),
            sides=tuple(
                told[i].closed if closed else told[i].open
                for i, closed in zip(owner, self.closed.tolist(), strict=True)
            ),
            materials=tuple(told[i].material for i in owner),
            names=tuple(told[i].name for i in owner),
            layers=tuple(told[i].layer for i in owner),
            origins=tuple(told[i].origin for i in owner),
        )


class _Told(NamedTuple):
    """What all walls of one path share."""

    name: str
    layer: str
    closed: Sides
    open: Sides
    material: Material
    origin: Origin


_PLAIN = Material()


def _told(path: DrawnPath, sides: Sides) -> _Told:
    said = said_of(path)
    tags = said.tags
    own = sides_of(tags) if tags else None
    material = material_of(tags) if tags else _PLAIN
    origin = Origin(path.title, said.groups, path.fill, path.stroke, tags)
    return _Told(said.name, said.layer, own or sides, own or "both", material, origin)


def keep_sides(outlines: Outlines) -> Outlines:
    """Turn open outlines that are solid from one side, for the mirror has put the free side on the other."""
    vertices, bulges = outlines.vertices.copy(), outlines.bulges.copy()
    one_way = [is_one_way(path) for path in outlines.paths]
    for index in np.flatnonzero(~outlines.closed).tolist():
        if one_way[outlines.owner[index]]:
            begin, end = int(outlines.offsets[index]), int(outlines.offsets[index + 1])
            vertices[begin:end] = outlines.vertices[begin:end][::-1]
            bulges[begin : end - 1] = 0.0 - outlines.bulges[begin : end - 1][::-1]
    return replace(outlines, vertices=vertices, bulges=bulges)


def on_grid(outlines: Outlines, grid: float) -> tuple[Outlines, float]:
    """Move vertices to the nearest multiples of ``grid``; a grid of 1 / n gives them as k / n, without an error more.

    Returns:
        The outlines, and how far any point of them moved at most. With its ends an arc is turned, scaled and moved:
        its point at z (0 at a, 1 at b, complex) moves by (1 - z) da + z db, and |1 - z| + |z| <= sqrt(2) up to a half
        circle.
    """
    parts = round(1.0 / grid) if 2.0**-1000 < grid < 1.0 else 0
    whole = bool(parts) and abs(parts * grid - 1.0) <= 2.0**-50
    multiples = outlines.vertices * float(parts) if whole else _quotient(outlines.vertices, grid)
    near = np.round(multiples) / parts if whole else np.round(multiples) * grid
    # beyond 2^52 a double is a whole number, so the vertex is on the grid as well as a double can be
    vertices = np.where(np.abs(multiples) < 2.0**52, near, outlines.vertices)
    moved = float(np.hypot(*(vertices - outlines.vertices).T).max(initial=0.0))
    return replace(outlines, vertices=vertices + 0.0), moved * (math.sqrt(2.0) if outlines.bulges.any() else 1.0)


def _quotient(vertices: FloatArray, grid: float) -> FloatArray:
    with np.errstate(over="ignore"):  # an infinite one is beyond any whole number that matters
        return vertices / grid


def assemble(segments: Segments, pieces: Pieces, paths: list[DrawnPath]) -> Outlines:
    """String the edges of all subpaths together: start points, edge ends, and what closes.

    An outline is closed when the file closes it or when it is drawn back to its very start (the same bits).
    """
    subpaths = [sub for path in paths for sub in path.subpaths]
    owner = np.repeat(np.arange(len(paths)), [len(path.subpaths) for path in paths])
    edges = _sums(pieces.counts, segments.offsets)
    counts = edges + 1
    offsets = np.concatenate([[0], np.cumsum(counts)])
    vertices, bulges = np.empty((offsets[-1], 2)), np.zeros(offsets[-1])
    first = np.zeros(offsets[-1], dtype=np.bool_)
    first[offsets[:-1]] = True
    vertices[first], vertices[~first] = segments.starts, pieces.ends
    last = np.zeros(offsets[-1], dtype=np.bool_)
    last[offsets[1:] - 1] = True
    bulges[~last] = pieces.bulges
    returns = (vertices[offsets[:-1]] == vertices[offsets[1:] - 1]).all(axis=1) & (counts > 2)
    closed = np.array([sub.closed for sub in subpaths], dtype=np.bool_) | returns
    outlines = Outlines(vertices, bulges, offsets, closed, owner, paths)
    drop = np.zeros(offsets[-1], dtype=np.bool_)
    drop[(offsets[1:] - 1)[returns]] = True
    return without_vertices(outlines, drop)


def _sums(values: IntArray, offsets: IntArray) -> IntArray:
    return np.diff(np.concatenate([[0], np.cumsum(values)])[offsets])


def without_vertices(outlines: Outlines, drop: NDArray[np.bool_]) -> Outlines:
    """Take vertices away; the edge before one then ends where its own edge did."""
    if not drop.any():
        return outlines
    gone = np.concatenate([[0], np.cumsum(drop)])
    return replace(
        outlines,
        vertices=outlines.vertices[~drop],
        bulges=outlines.bulges[~drop],
        offsets=outlines.offsets - gone[outlines.offsets],
    )
