"""The path machine of a PDF page: what is drawn, placed by the matrix and painted with the state in force."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

from importers import colours
from importers.drawing import DrawnPath, FillRule, Layer, Segment, Subpath
from importers.findings import Findings
from importers.illustrator import findings as common
from importers.limits import MAX_COORDINATE, MAX_DEPTH, limit_error
from importers.pdf import findings
from importers.pdf.document import get, items, number, word
from importers.pdf.state import IDENTITY, Graphics, multiply
from importers.regions import ALL, reach_of, region_of

Operands = list[Any]  # numbers as bytes, names as Name, texts as None
Handler = Callable[[Operands], None]
_CLIP_COSTS = 12  # operators' worth of work
# Opacity of fills, of strokes, line width, and whether there is a soft mask
State = tuple[float | None, float | None, float | None, bool | None]


@dataclass(frozen=True, slots=True)
class Name:
    """A name operand with its slash."""

    text: str


class Painter:
    """Builds paths and keeps the graphics state.

    Attributes:
        file: the file's name, for messages.
        paths: in the order of drawing.
        findings: what was left out or could not be read.
        resources: of the content that is being read; its reader sets them.
        spaces: kinds of its colour spaces, and of its patterns, by name, as far as they were asked for.
        states: opacity of fills and strokes, line width and mask of its sets of attributes, as far as asked for.
        graphics_depth: kept states that this content must leave alone; its reader sets it.
    """

    def __init__(self, file: str) -> None:
        self.file = file
        self.paths: list[DrawnPath] = []
        self.findings = Findings()
        self.resources: Any = None
        self.spaces: dict[str, str] = {}
        self.states: dict[str, State] = {}
        self.graphics_depth = 0
        self._graphics = Graphics()
        self._kept: list[Graphics] = []
        self._layer: Layer | None = None
        self._hidden = False
        self._segments: list[Segment] = []
        self._subpaths: list[Subpath] = []
        self._reopen: Segment | None = None
        self._spoiled = False
        self._clip: FillRule | None = None
        self._count = 0  # of segments and paths
        self._operators = 0  # taken, and what costs as much

    def begin_page(self, right: float, up: float) -> None:
        """Begin anew with plain paint and units, moved by so much."""
        self._graphics = Graphics(matrix=(1.0, 0.0, 0.0, 1.0, right, up))
        self._kept = []

    def path_handlers(self) -> dict[bytes, Handler]:
        """List what each operator for paths, paint and state does."""
        handlers: dict[bytes, Handler] = {}
        handlers.update({b"m": self._move, b"l": self._line, b"c": self._curve, b"v": self._curve_from_point})
        handlers.update({b"y": self._curve_to_point, b"h": self._close, b"re": self._rectangle})
        for name in ("f", "F", "f*", "B", "B*", "b", "b*", "S", "s", "n"):
            handlers[name.encode()] = partial(self._paint, name)
        handlers.update({b"W": partial(self._set_clip, "nonzero"), b"q": self._keep, b"Q": self._restore})
        handlers[b"W*"] = partial(self._set_clip, "evenodd")
        handlers.update({b"cm": self._transform, b"w": self._set_width, b"gs": self._set_state})
        for name, attribute in (("g", "fill"), ("rg", "fill"), ("k", "fill")):
            handlers[name.encode()] = partial(self._set_device_colour, attribute)
            handlers[name.upper().encode()] = partial(self._set_device_colour, "stroke")
        for name in ("sc", "scn"):
            handlers[name.encode()] = partial(self._set_colour, "fill")
            handlers[name.upper().encode()] = partial(self._set_colour, "stroke")
        handlers.update({b"cs": partial(self._set_space, "fill"), b"CS": partial(self._set_space, "stroke")})
        return handlers

    def _find(self, kind: Any, what: str = "", at: tuple[float, float] | None = None) -> None:
        """Note a finding at the place where the content draws, or at another."""
        point = at or (self._segments[-1][-2:] if self._segments else None)
        self.findings.add(kind, None, what=what, layer=self._layer.name if self._layer else "", at=point)

    # --- paths ------------------------------------------------------------------------------------------

    def _ignore(self, _operands: Operands) -> None:
        """Do nothing: no geometry depends on it."""

    def _place(self, operands: Operands) -> list[float]:
        """Give points in the page's units."""
        numbers = [*map(float, operands)]
        if self._graphics.matrix != IDENTITY:
            a, b, c, d, e, f = self._graphics.matrix
            pairs = zip(numbers[0::2], numbers[1::2], strict=True)
            numbers = [part for x, y in pairs for part in (a * x + c * y + e, b * x + d * y + f)]
        # NaN is neither the largest nor the smallest of anything, but it is in the sum.
        good = max(numbers) <= MAX_COORDINATE and min(numbers) >= -MAX_COORDINATE and not math.isnan(sum(numbers))
        self._spoiled = self._spoiled or not good
        return numbers

    def _move(self, operands: Operands) -> None:
        x, y = self._place(operands)
        if len(self._segments) > 1:
            self._subpaths.append(Subpath(self._segments, closed=False))
        self._segments = [("M", x, y)]

    def _line(self, operands: Operands) -> None:
        x, y = self._place(operands)
        if self._segments or self._has_point("l", x, y):
            self._segments.append(("L", x, y))

    def _curve(self, operands: Operands) -> None:
        x1, y1, x2, y2, x, y = self._place(operands)
        if self._segments or self._has_point("c", x, y):
            self._segments.append(("C", x1, y1, x2, y2, x, y))

    def _curve_from_point(self, operands: Operands) -> None:
        x2, y2, x, y = self._place(operands)
        if self._segments or self._has_point("v", x, y):
            self._segments.append(("C", *self._segments[-1][-2:], x2, y2, x, y))

    def _curve_to_point(self, operands: Operands) -> None:
        x1, y1, x, y = self._place(operands)
        if self._segments or self._has_point("y", x, y):
            self._segments.append(("C", x1, y1, x, y, x, y))

    def _has_point(self, operator: str, x: float, y: float) -> bool:
        """Find a current point when no subpath is open; without one, the subpath begins at x, y."""
        if self._reopen is not None:
            self._segments = [self._reopen]
            return True
        self._find(common.NO_POINT, operator)
        self._segments = [("M", x, y)]
        return False

    def _close(self, _operands: Operands) -> None:
        if self._segments:
            self._subpaths.append(Subpath(self._segments, closed=True))
            self._reopen = self._segments[0]
            self._segments = []

    def _rectangle(self, operands: Operands) -> None:
        x, y, width, height = map(float, operands)
        if len(self._segments) > 1:
            self._subpaths.append(Subpath(self._segments, closed=False))
        corners = self._place([x, y, x + width, y, x + width, y + height, x, y + height])
        points = [*zip(corners[0::2], corners[1::2], strict=True)]
        self._segments = [("M", *points[0]), *(("L", *point) for point in points[1:])]
        self._close([])

    def _set_clip(self, rule: FillRule, _operands: Operands) -> None:
        self._clip = rule

    def _clip_to(self, subpaths: list[Subpath], rule: FillRule) -> None:
        """Let nothing be seen outside of a path, until ``Q``; its open subpaths count as closed."""
        self._operators += _CLIP_COSTS
        graphics, own = self._graphics, region_of([DrawnPath(subpaths, fill_rule=rule)])
        if not own.cuts(graphics.region.box):
            return  # a rectangle around all that is seen: programs write the page's over and over
        if graphics.clips < MAX_DEPTH:
            region = own.within(graphics.region)
            self._graphics = replace(graphics, region=region, clips=graphics.clips + 1)
        else:
            self._graphics = replace(graphics, masked=True)

    def _paint(self, operator: str, _operands: Operands) -> None:
        """Paint the path and forget it; ``n`` paints nothing and is how clipping paths end."""
        kind = operator.rstrip("*")
        closing = kind in ("s", "b")
        if self._segments and (closing or len(self._segments) > 1 or not self._subpaths):
            self._subpaths.append(Subpath(self._segments, closed=closing))
        subpaths, spoiled, clip = self._subpaths, self._spoiled, self._clip
        self._segments, self._subpaths, self._reopen = [], [], None
        self._clip, self._spoiled = None, False
        if not subpaths:
            return
        if spoiled:
            self._find(common.COORDINATE)
            return
        rule: FillRule = "evenodd" if operator.endswith("*") else "nonzero"
        self._add_path(subpaths, kind, rule, clip=clip is not None and kind == "n")
        if clip is not None:
            self._clip_to(subpaths, clip)

    def _add_path(self, subpaths: list[Subpath], kind: str, rule: FillRule, *, clip: bool) -> None:
        """Put a path into the drawing with the marks that are in force."""
        graphics, layer = self._graphics, self._layer
        fills = kind in "fFBb" and graphics.fill_seen
        strokes = kind in "SsBb" and graphics.stroke_seen
        path = DrawnPath(
            subpaths,
            layer=layer.name if layer else "",
            visible=not self._hidden,
            locked=layer.locked if layer else False,
            clip=clip,
            fill=graphics.fill if fills else None,
            stroke=graphics.stroke if strokes else None,
            stroke_width=graphics.width_on_page() if strokes else None,
            fill_rule=rule,
        )
        self.paths.append(path)
        if not clip and not self._hidden and (fills or strokes):
            if (fills and graphics.fill_tiled) or (strokes and graphics.stroke_tiled):
                self._find(findings.TILING, at=subpaths[0].segments[0][1:])
            self._look_at_clips(path)
        self._count += 1 + sum(len(subpath.segments) + 1 for subpath in subpaths)

    def _clip_to_box(self, x0: float, y0: float, x1: float, y1: float) -> None:
        """Let nothing be seen outside of a box in the units of the content."""
        spoiled, self._spoiled = self._spoiled, False
        numbers = self._place([x0, y0, x1, y0, x1, y1, x0, y1])
        if not self._spoiled:
            points = [*zip(numbers[0::2], numbers[1::2], strict=True)]
            self._clip_to([Subpath([("M", *points[0]), *(("L", *point) for point in points[1:])], True)], "nonzero")
        self._spoiled = spoiled

    def _look_at_clips(self, path: DrawnPath) -> None:
        """Note the clip that cuts a path, and say so."""
        region, start = self._graphics.region, path.subpaths[0].segments[0][1:]
        if self._graphics.masked:
            self._find(findings.MASK, at=start)
        if region is ALL:
            return
        wide = reach_of(path)
        if wide is None or not region.cuts(wide):
            return
        path.clipped = region.clip
        self._find(common.CLIP, at=start)
        if region.misses(wide):
            self._find(common.OUTSIDE, at=start)

    # --- state ------------------------------------------------------------------------------------------

    def _keep(self, _operands: Operands) -> None:
        if len(self._kept) >= MAX_DEPTH:
            raise limit_error("graphics states in each other (q)", str(MAX_DEPTH), file=self.file)
        self._kept.append(self._graphics)

    def _restore(self, _operands: Operands) -> None:
        if len(self._kept) > self.graphics_depth:
            self._graphics = self._kept.pop()
        else:
            self._find(common.UNBALANCED, "Q")

    def _transform(self, operands: Operands) -> None:
        a, b, c, d, e, f = map(float, operands)
        before = self._graphics.matrix
        matrix = multiply((a, b, c, d, e, f), before)
        if not all(map(math.isfinite, matrix)) and all(map(math.isfinite, before)):
            self._find(findings.NUMBER, "cm", before[4:])
        self._graphics = replace(self._graphics, matrix=matrix)

    def _set_state(self, operands: Operands) -> None:
        """``gs``: of a set of attributes, what decides whether paint is seen, and the line width."""
        (name,) = operands
        if not isinstance(name, Name):
            raise TypeError(name)
        if name.text not in self.states:
            found = get(get(self.resources, "/ExtGState"), name.text)
            mask = get(found, "/SMask")
            numbers = (number(get(found, "/ca")), number(get(found, "/CA")), number(get(found, "/LW")))
            self.states[name.text] = (*numbers, None if mask is None else word(mask) != "/None")
        fill, stroke, width, masked = self.states[name.text]
        graphics = self._graphics
        if masked is not None:
            graphics = replace(graphics, masked=masked)
        if fill is not None:
            graphics = replace(graphics, fill_alpha=fill)
        if stroke is not None:
            graphics = replace(graphics, stroke_alpha=stroke)
        self._graphics = graphics
        if width is not None:
            self._set_width([width])

    def _set_width(self, operands: Operands) -> None:
        (width,) = map(float, operands)
        if not 0.0 <= width <= MAX_COORDINATE:
            raise ValueError(width)
        self._graphics = replace(self._graphics, width=width)

    def _set_device_colour(self, attribute: str, operands: Operands) -> None:
        colour = colours.from_components([*map(float, operands)])
        if colour is None:
            raise ValueError(operands)
        self._graphics = _repaint(self._graphics, attribute, colour, "")

    def _set_space(self, attribute: str, operands: Operands) -> None:
        (name,) = operands
        if not isinstance(name, Name):
            raise TypeError(name)
        if name.text not in self.spaces:
            found = get(get(self.resources, "/ColorSpace"), name.text)
            kind = word(found) or word(next(items(found), None))
            self.spaces[name.text] = kind or name.text
        space = self.spaces[name.text]
        colour = "pattern" if space == "/Pattern" else "#000000"
        self._graphics = _repaint(self._graphics, attribute, colour, space)

    def _set_colour(self, attribute: str, operands: Operands) -> None:
        """``sc`` and ``scn``: as many numbers as the colour space has, or a pattern's name."""
        graphics = self._graphics
        space = graphics.fill_space if attribute == "fill" else graphics.stroke_space
        tiled = False
        if operands and isinstance(operands[-1], Name):
            colour: str | None = "pattern"
            tiled = self._is_tiling(operands[-1])
        elif space in ("/Separation", "/DeviceN", "/Indexed"):
            # An ink whose own colour a program would compute: how much of it there is must do.
            colour = colours.gray(1.0 - min(max(map(float, operands), default=0.0), 1.0))
        else:
            colour = colours.from_components([*map(float, operands)])
        if colour is None:
            raise ValueError(operands)
        self._graphics = _repaint(graphics, attribute, colour, space, tiled)

    def _is_tiling(self, name: Name) -> bool:
        """Tell whether a pattern is made of tiles, which are content of their own; others are shadings."""
        key = f"pattern {name.text}"
        if key not in self.spaces:
            found = get(get(self.resources, "/Pattern"), name.text)
            self.spaces[key] = "tiling" if number(get(found, "/PatternType")) == 1 else "shading"
        return self.spaces[key] == "tiling"


def _repaint(graphics: Graphics, attribute: str, colour: str, space: str, tiled: bool = False) -> Graphics:
    """Give the state with another colour."""
    if attribute == "fill":
        return replace(graphics, fill=colour, fill_space=space, fill_tiled=tiled)
    return replace(graphics, stroke=colour, stroke_space=space, stroke_tiled=tiled)
