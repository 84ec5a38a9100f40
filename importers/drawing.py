"""Drawing: what a vector file holds, as exact segments in absolute coordinates, all transforms applied."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any, Literal

from importers.pictured import Pictured
from importers.problems import Problem
from importers.subpaths import Matrix as Matrix
from importers.subpaths import Segment as Segment
from importers.subpaths import Subpath as Subpath

YAxis = Literal["up", "down"]
FillRule = Literal["nonzero", "evenodd"]


LevelKind = Literal["layer", "group", "object"]


@dataclass(frozen=True, slots=True)
class Level:
    """What one object, or a group or layer around it, says about a path, in the words of its author.

    Attributes:
        kind: what it is; a clone of something is an object.
        name: its label or id, decoded, or ``""``.
        tags: its own ``data-*`` attributes without that prefix.
        note: its description, or ``""``.
    """

    kind: LevelKind
    name: str = ""
    tags: dict[str, str] = field(default_factory=dict)
    note: str = ""


Shape = tuple[list[Subpath], FillRule]


@dataclass(frozen=True, slots=True, eq=False)
class Clip:
    """An area outside of which nothing of a path is seen: what shapes cover together, and the clips around it leave.

    Attributes:
        shapes: subpaths and fill rule of each.
        matrix: from their coordinates to the drawing's: x' = a x + c y + e, y' = b x + d y + f.
        outer: the clip around this one.
    """

    shapes: tuple[Shape, ...]
    matrix: Matrix = (1.0, 0.0, 0.0, 1.0, 0.0, 0.0)
    outer: Clip | None = None


@dataclass(slots=True, repr=False)
class DrawnPath:
    """One painted object of the file: its subpaths share fill, stroke and marks.

    Attributes:
        subpaths: in the file's order.
        name: the object's name (SVG label or id, decoded; Illustrator's object name), or ``""``.
        layer: name of the innermost layer it is on, or ``""``.
        groups: names of the groups around it, outermost first; unnamed groups are ``""``.
        visible: the file's own application would show it.
        locked: it, a group around it or its layer is locked.
        guide: a guide of the drawing program, not art.
        clip: it clips other art and is not painted itself.
        fill: colour as ``"#rrggbb"``, another paint's name (``"pattern"``, ``"gradient"``), None when nothing is
            filled: no paint, or one without any opacity.
        stroke: the same for the outline.
        stroke_width: in the drawing's units, transforms applied (geometric mean of the two scales); None
            when not stroked.
        fill_rule: ``"nonzero"`` or ``"evenodd"``.
        line: line in the file where it begins, from 1; None where lines mean nothing.
        tags: free words the file carries for it (``data-*`` attributes, notes), by name.
        title: what the file calls it to people who look at it (SVG's ``title``), or ``""``.
        clipped: the clip that cuts it, where one does: the path itself is whole; None where nothing cuts it.
        error: how far its subpaths are at most from what the file draws; 0 but where a clip was applied to curves.
        levels: what each of its layers and groups, itself, and the clones that show it say, the nearest last;
            ``()`` where a reader knows no more than ``layer``, ``groups``, ``name`` and ``tags``.
    """

    subpaths: list[Subpath]
    name: str = ""
    layer: str = ""
    groups: tuple[str, ...] = ()
    visible: bool = True
    locked: bool = False
    guide: bool = False
    clip: bool = False
    fill: str | None = None
    stroke: str | None = None
    stroke_width: float | None = None
    fill_rule: FillRule = "nonzero"
    line: int | None = None
    tags: dict[str, str] = field(default_factory=dict)
    title: str = ""
    levels: tuple[Level, ...] = ()
    clipped: Clip | None = None
    error: float = 0.0

    def __repr__(self) -> str:
        name = f" {self.name!r}" if self.name else ""
        layer = f" on layer {self.layer!r}" if self.layer else ""
        paint = f"fill {self.fill}, stroke {self.stroke}"
        return f"<DrawnPath{name}{layer}: {_subpaths(self.subpaths)}, {paint}{'' if self.visible else ', hidden'}>"

    def to_json(self) -> dict[str, Any]:
        """Give the path as the ``wallkit-drawing`` format has it."""
        return {
            "name": self.name,
            "layer": self.layer,
            "groups": list(self.groups),
            "visible": self.visible,
            "locked": self.locked,
            "guide": self.guide,
            "clip": self.clip,
            "fill": self.fill,
            "stroke": self.stroke,
            "stroke_width": self.stroke_width,
            "fill_rule": self.fill_rule,
            "subpaths": [
                {"closed": sub.closed, "segments": [list(segment) for segment in sub.segments]} for sub in self.subpaths
            ],
            "line": self.line,
            "tags": dict(self.tags),
            **({"title": self.title} if self.title else {}),
        }


@dataclass(slots=True)
class Layer:
    """A layer of the file.

    Attributes:
        name: as people see it in their program.
        visible: shown.
        locked: protected from editing.
        printing: printed.
    """

    name: str
    visible: bool = True
    locked: bool = False
    printing: bool = True

    def to_json(self) -> dict[str, Any]:
        """Give the layer as the ``wallkit-drawing`` format has it."""
        return {
            "name": self.name,
            "visible": self.visible,
            "locked": self.locked,
            "printing": self.printing,
        }


@dataclass(frozen=True, slots=True)
class Artboard:
    """A page of the drawing program, in the drawing's units and axes; art may lie outside of it.

    Attributes:
        name: as people see it in their program.
        x_min: its left edge.
        y_min: its edge of smallest y.
        x_max: its right edge.
        y_max: its edge of largest y.
    """

    name: str
    x_min: float
    y_min: float
    x_max: float
    y_max: float

    def to_json(self) -> dict[str, Any]:
        """Give the artboard as the ``wallkit-drawing`` format has it."""
        return {"name": self.name, "box": [self.x_min, self.y_min, self.x_max, self.y_max]}


@dataclass(slots=True, repr=False)
class Drawing(Pictured):
    """A vector file, read: layers, paths with exact segments, and what was left out and why.

    Coordinates are those of the file with all transforms applied: Illustrator and PDF in points, y up, as
    written; SVG in CSS px of the outermost viewport, y down, where a browser shows it.

    Attributes:
        units: ``"pt"`` or ``"px"``.
        y_axis: ``"up"`` or ``"down"``.
        layers: in the file's order (bottom first in SVG, as the file lists them in Illustrator).
        paths: in the file's order, hidden ones included and marked.
        problems: what a reader left out or could not read, with places.
        kind: what the file turned out to be, for people, such as ``"Illustrator 8"`` or ``"SVG"``.
        file: its name as given; ``"-"`` for standard input, ``""`` for text.
        sha256: hex digest of the bytes that were read.
        artboards: where the file names them (Illustrator CS4 and later, Inkscape 1.2 and later).
        sheet: the page that it lies on, where it is known: SVG's viewport, a PDF's page, the artboard that was chosen.
        page: number of the page or artboard that was chosen, from 1; None for all that was read without a choice.
    """

    units: str
    y_axis: YAxis
    layers: list[Layer] = field(default_factory=list)
    paths: list[DrawnPath] = field(default_factory=list)
    problems: list[Problem] = field(default_factory=list)
    kind: str = ""
    file: str = ""
    sha256: str = ""
    artboards: list[Artboard] = field(default_factory=list)
    sheet: Artboard | None = None
    page: int | None = None

    def __repr__(self) -> str:
        parts = [
            " ".join(part for part in (self.kind, repr(self.file) if self.file else "") if part),
            _counted(len(self.layers), "layer") if self.layers else "",
            _counted(len(self.paths), "path"),
            _subpaths([subpath for path in self.paths for subpath in path.subpaths]),
            self.units,
            f"y {self.y_axis}",
            _counted(len(self.problems), "problem") if self.problems else "",
        ]
        return f"<Drawing: {', '.join(filter(None, parts))}>"

    def to_json(self) -> dict[str, Any]:
        """Give the whole as the stable ``wallkit-drawing`` format, version 1."""
        return {
            "format": "wallkit-drawing",
            "version": 1,
            "kind": self.kind,
            "units": self.units,
            "y_axis": self.y_axis,
            "artboards": [artboard.to_json() for artboard in self.artboards],
            **({"sheet": self.sheet.to_json()} if self.sheet is not None else {}),
            "layers": [layer.to_json() for layer in self.layers],
            "paths": [path.to_json() for path in self.paths],
            "problems": [problem.to_json() for problem in self.problems],
        }

    def control_box(self) -> tuple[float, float, float, float] | None:
        """Give (x_min, y_min, x_max, y_max) over all end and control points; None without any.

        An arc counts with its end points only. Hidden paths count: the box is of the file, not of a screen.
        """
        points = [point for path in self.paths for sub in path.subpaths for point in control_points(sub.segments)]
        if not points:
            return None
        xs, ys = zip(*points, strict=True)
        return min(xs), min(ys), max(xs), max(ys)

    def to_svgpathtools(self) -> list[Any]:
        """Give a ``svgpathtools.Path`` for each path, hidden ones included: the same curves, bit for bit.

        Points are complex numbers x + i y in the units and axes of the drawing. A closed subpath has its closing edge.
        ``drawing_from_svgpathtools(paths, units=..., y_axis=...)`` makes the same paths of them again.
        """
        from importers.svg.svgpathtools_paths import svgpathtools_paths  # late: it brings scipy

        return svgpathtools_paths(self.paths)


def _subpaths(subpaths: list[Subpath]) -> str:
    segments = sum(len(subpath) - 1 for subpath in subpaths)
    return f"{_counted(len(subpaths), 'subpath')} with {_counted(segments, 'segment')}"


def _counted(number: int, word: str) -> str:
    return f"{number:,} {word}{'' if number == 1 else 's'}"


def control_points(segments: Sequence[Segment]) -> list[tuple[float, float]]:
    """List end and control points of segments in order (for an arc only its end)."""
    points: list[tuple[float, float]] = []
    for segment in segments:
        numbers = segment[6:] if segment[0] == "A" else segment[1:]
        points.extend(zip(numbers[0::2], numbers[1::2], strict=True))
    return points
