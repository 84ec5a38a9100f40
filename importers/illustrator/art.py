"""The machine behind Illustrator's operators: paths, paint, groups and layers; a method an operator, no recursion.

The path machine is PostScript's: a path is built from a current point, painted by one operator, and gone. What
Illustrator adds (groups, layers, locks, hidden objects, notes, names after the object) is state around it.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import partial

from importers.drawing import DrawnPath, Segment, Subpath
from importers.illustrator import findings
from importers.illustrator.objects import Handler, Objects, Operands, Text
from importers.illustrator.programs import MOVERS
from importers.illustrator.state import Group
from importers.limits import MAX_COORDINATE, MAX_ELEMENTS, MAX_OPERATORS, good_coordinate, limit_error
from importers.regions import ALL, Region, reach_of, region_of
from importers.sources import Source

__all__ = ["Art", "Operands", "Text"]

# How many numbers each path operator takes.
PATH_OPERANDS = {
    **dict.fromkeys((b"m", b"l", b"L"), 2),
    **dict.fromkeys((b"v", b"V", b"y", b"Y"), 4),
    **dict.fromkeys((b"c", b"C"), 6),
}
# What sets attributes that no wall depends on, and PostScript's own housekeeping: no word about these.
_WITHOUT_GEOMETRY = (
    b"O R D d i j J M Ap Ar An AE Ae As Xd XD XW Xy XT Xt Xs XS Np Xz XZ XN Xn Bn Bd BD Bm Bc Bh Bs Pb PB Pc "
    b"Pn Xm XP Tr Tf Tz Tt TA TC TW Ti Ta Tq Tl Tx TX TV Tv TK TS Tk TG Tg Th Ts TY Xb XB XQ TE TZ Tj TI Tb "
    b"Td z a e o r t Z E TP XF XG XH Xh Xi Xq Xg Xr Xv XV LB2 Lc X= X+ X# , / showpage "
    b"annotatepage def bind load store begin end pop get put exec dict initialize terminate "
    b"userdict systemdict dup exch clear cleartomark mark currentdict cvx cvn closefile true false null "
).split()


@dataclass(slots=True)
class Compound:
    """A compound path that is open: its members so far, shown and hidden, and their last paint."""

    begin: int
    depth: int = 1
    shown: list[Subpath] = field(default_factory=list)
    hidden: list[Subpath] = field(default_factory=list)
    operator: str = "N"
    clip: bool = False
    guide: bool = False


class Art(Objects):
    """What the operators of one file have drawn so far.

    Attributes:
        paths: in the file's order; their groups are filled in by :meth:`finish`.
        handlers: what each operator does.

    Args:
        source: the file.
        encoding: the alphabet of its names.
        file: its name, for messages.
        movers: names of its own for what moves, scales or turns what follows.
    """

    def __init__(self, source: Source, encoding: str, file: str = "", movers: frozenset[bytes] = frozenset()) -> None:
        super().__init__(source, encoding, file)
        self.paths: list[DrawnPath] = []
        self._movers = movers
        self._subpaths: list[Subpath] = []  # of the path that is being drawn, without the subpath that is
        self._begin = 0  # position of that path's first point
        self._reopen: Segment | None = None  # where drawing goes on after `h`
        self._cut = False  # the rest of the subpath is skipped: one of its operators could not be read
        self._spoiled = False  # a coordinate of the path is none
        self._clip = False
        self._compound: Compound | None = None
        self._grouped: list[Group] = []  # the group of each path, since groups get their names last
        self.handlers: dict[bytes, Handler] = self._make_handlers()

    def _make_handlers(self) -> dict[bytes, Handler]:
        """List what each operator does."""
        handlers: dict[bytes, Handler] = dict.fromkeys(_WITHOUT_GEOMETRY, self._ignore)
        handlers.update({b"m": self._move, b"l": self._line, b"L": self._line, b"c": self._curve, b"C": self._curve})
        handlers.update(dict.fromkeys((b"v", b"V"), self._curve_from_point))
        handlers.update(dict.fromkeys((b"y", b"Y"), self._curve_to_point))
        handlers.update({b"h": self._close, b"H": self._ignore, b"W": self._set_clip, b"*": self._guide})
        handlers.update({name.encode(): partial(self._paint_path, name) for name in "nNfFsSbB"})
        for name in ("g", "k", "x", "Xa", "Xx", "Xk"):
            handlers[name.encode()] = partial(self._set_fill, name)
        for name in ("G", "K", "X", "XA", "XX", "XK"):
            handlers[name.encode()] = partial(self._set_stroke, name)
        handlers.update({b"p": self._fill_pattern, b"P": self._stroke_pattern, b"w": self._set_width})
        handlers.update({b"XR": self._set_fill_rule, b"Bb": self._begin_gradient, b"Bg": self._ignore})
        handlers.update({b"BB": self._end_gradient, b"A": self._set_locked, b"Xw": self._set_hidden})
        handlers.update({b"u": self._begin_group, b"U": self._end_group, b"q": self._begin_clip, b"Q": self._end_clip})
        handlers.update({b"*u": self._begin_compound, b"*U": self._end_compound})
        handlers.update({b"Lb": self._begin_layer, b"Ln": self._name_layer, b"LB": self._end_layer})
        handlers.update({b"To": self._begin_text, b"Tp": self._ignore, b"TO": self._end_text, b"T": self._old_text})
        handlers.update({b"XI": partial(self._leave_out, findings.RASTER), b"`": self._placed, b"~": self._ignore})
        handlers.update({b":": self._begin_object, b";": self._end_object, b"X!": self._mesh})
        handlers.update(
            {b"gsave": self._save, b"save": self._save, b"grestore": self._restore, b"restore": self._restore}
        )
        handlers.update({name: partial(self._move_axes, name) for name in (*MOVERS, *self._movers)})
        return handlers

    # --- what the reader calls --------------------------------------------------------------------------

    def check_count(self, operators: int) -> None:
        """Raise LimitError when there are too many segments, paths, groups and layers, or operators so far."""
        many = self._count + len(self._segments) + len(self._subpaths)
        if many > MAX_ELEMENTS:
            self._stop_at("segments, paths and groups of a drawing", MAX_ELEMENTS)
        if operators > MAX_OPERATORS:
            self._stop_at("operators of a drawing", MAX_OPERATORS)

    def failed(self, operator: bytes, operands: Operands) -> None:
        """Deal with operands that an operator could not take."""
        what = operator.decode("latin-1")
        needed = PATH_OPERANDS.get(operator)
        if needed is None:
            self.find(findings.ATTRIBUTE, what=what)
            return
        if len(operands) > needed:
            # Something before it left numbers over; PostScript too takes the last ones.
            try:
                self.handlers[operator](operands[-needed:])
            except (ValueError, TypeError):
                pass
            else:
                return
        self.find(findings.OPERANDS, what=what)
        if self._segments:
            self._subpaths.append(Subpath(self._segments, closed=False))
            self._segments = []
        self._reopen = None
        self._cut = operator != b"m"

    def unknown(self, operator: bytes) -> None:
        """Note an operator that is none of the format's."""
        self.named = None
        if operator.startswith(b"Adobe_"):
            return  # a set of procedures, which files name whether they hold it or not
        what = operator[:24].decode("latin-1")
        self.findings.add(findings.UNKNOWN, self.position, what=what, apart=True, layer=self._group.layer)

    def set_name(self, name: str) -> None:
        """Name the object that just ended."""
        named = self.named
        if named is None:
            return
        named.name = name
        if isinstance(named, DrawnPath) and name.startswith("<Slice>"):
            named.guide = True  # where a picture is cut for the web

    def drew_nothing(self) -> bool:
        """Tell whether there were operators, but none that draws: a program of another kind."""
        return not self.paths and self.findings.has(findings.UNKNOWN)

    def finish(self) -> None:
        """End the file: close what is open, give each path the names of its groups.

        Raises:
            LimitError: so many paths in so deep groups that their names alone are too many.
        """
        self._flush()
        if self._compound is not None:
            self._compound.depth = 1
            self._end_compound([])
        names: dict[int, tuple[str, ...]] = {}
        shared: dict[tuple[str, ...], tuple[str, ...]] = {}
        total = 0
        for path, group in zip(self.paths, self._grouped, strict=True):
            found = names.get(id(group))
            if found is None:
                found = group.names()
                if found not in shared:
                    shared[found] = found
                    total += len(found)
                found = names[id(group)] = shared[found]
                if total > 4 * MAX_ELEMENTS:
                    raise limit_error("names of groups around paths", f"{4 * MAX_ELEMENTS:,}", file=self.file)
            path.groups = found

    # --- drawing ----------------------------------------------------------------------------------------

    def _move(self, operands: Operands) -> None:
        x, y = map(float, operands)
        if len(self._segments) > 1:
            self._subpaths.append(Subpath(self._segments, closed=False))
        elif not self._subpaths:
            self._begin = self.position
        if not (-MAX_COORDINATE <= x <= MAX_COORDINATE and -MAX_COORDINATE <= y <= MAX_COORDINATE):
            self._spoiled = True
        self._cut = False
        self._segments = [("M", x, y)]

    def _line(self, operands: Operands) -> None:
        x, y = map(float, operands)
        if not (-MAX_COORDINATE <= x <= MAX_COORDINATE and -MAX_COORDINATE <= y <= MAX_COORDINATE):
            self._spoiled = True
        if self._segments or self._has_point("l", x, y):
            self._segments.append(("L", x, y))

    def _curve(self, operands: Operands) -> None:
        x1, y1, x2, y2, x, y = map(float, operands)
        if not (
            -MAX_COORDINATE <= x1 <= MAX_COORDINATE
            and -MAX_COORDINATE <= y1 <= MAX_COORDINATE
            and -MAX_COORDINATE <= x2 <= MAX_COORDINATE
            and -MAX_COORDINATE <= y2 <= MAX_COORDINATE
            and -MAX_COORDINATE <= x <= MAX_COORDINATE
            and -MAX_COORDINATE <= y <= MAX_COORDINATE
        ):
            self._spoiled = True
        if self._segments or self._has_point("c", x, y):
            self._segments.append(("C", x1, y1, x2, y2, x, y))

    def _curve_from_point(self, operands: Operands) -> None:
        """``v``: the first control point is the current point."""
        x2, y2, x, y = map(float, operands)
        if self._segments or self._has_point("v", x, y):
            self._curve([*self._segments[-1][-2:], x2, y2, x, y])

    def _curve_to_point(self, operands: Operands) -> None:
        """``y``: the second control point is the end."""
        x1, y1, x, y = map(float, operands)
        self._curve([x1, y1, x, y, x, y])

    def _has_point(self, operator: str, x: float, y: float) -> bool:
        """Find a current point when no subpath is open; without one, the subpath begins at x, y."""
        if self._cut:
            return False
        if not self._subpaths:
            self._begin = self.position
        if self._reopen is not None:
            self._segments = [self._reopen]
            return True
        self.find(findings.NO_POINT, what=operator)
        self._spoiled = self._spoiled or not (good_coordinate(x) and good_coordinate(y))
        self._segments = [("M", x, y)]
        return False

    def _close(self, _operands: Operands) -> None:
        if self._segments:
            self._subpaths.append(Subpath(self._segments, closed=True))
            self._reopen = self._segments[0]
            self._segments = []

    # --- painting ---------------------------------------------------------------------------------------

    def _paint_path(self, operator: str, _operands: Operands) -> None:
        """``n f s b`` close the subpath first, ``N F S B`` leave it open."""
        if self._segments:
            self._subpaths.append(Subpath(self._segments, closed=operator.islower()))
        elif not self._subpaths:
            self._cut = self._clip = False
            return
        self._take_path(operator)

    def _guide(self, _operands: Operands) -> None:
        """``(N) *``: the path is a guide."""
        if self._segments:
            self._subpaths.append(Subpath(self._segments, closed=False))
        self._take_path("N", guide=True)

    def _set_clip(self, _operands: Operands) -> None:
        self._clip = True

    def _take_path(self, operator: str, *, guide: bool = False) -> None:
        """End the path that is being drawn: into the drawing, or into the compound path around it."""
        subpaths, spoiled, clip = self._subpaths, self._spoiled, self._clip and operator in "nN"
        self._segments, self._subpaths, self._reopen = [], [], None
        self._cut = self._spoiled = self._clip = False
        if not subpaths:
            return
        if spoiled:
            self.find(findings.COORDINATE, position=self._begin)
            return
        compound = self._compound
        if compound is None:
            self._add_path(subpaths, operator, self._begin, hidden=self._hidden, clip=clip, guide=guide)
            return
        (compound.hidden if self._hidden else compound.shown).extend(subpaths)
        compound.operator, compound.clip, compound.guide = operator, clip, guide
        self._count += sum(len(subpath.segments) + 1 for subpath in subpaths)
        self.named = None

    def _add_path(
        self, subpaths: list[Subpath], operator: str, begin: int, *, hidden: bool, clip: bool, guide: bool
    ) -> None:
        """Put a path into the drawing with the marks that are in force."""
        group, paint, kind = self._group, self._paint, operator.lower()
        fills, strokes = kind in "fb", kind in "sb"
        framed = self._text or self._objects > 0
        if self._moved_in >= 0 and not framed:
            self.moved_by = self.moved_by or self._mover
        path = DrawnPath(
            subpaths,
            layer=group.layer or self._bare_layer,
            visible=not (hidden or group.hidden or framed),
            locked=self._locked or group.locked,
            guide=guide,
            clip=clip,
            fill=("gradient" if self._gradient else paint.fill) if fills else None,
            stroke=paint.stroke if strokes else None,
            stroke_width=paint.width if strokes else None,
            fill_rule=self._fill_rule,
            line=self.source.line(begin),
        )
        if self.note:
            path.tags["note"] = self.note
        if framed:
            path.tags["text"] = "frame"
        self.paths.append(path)
        self._grouped.append(group)
        if clip:
            group.region = region_of([path]).within(group.region)
        elif path.visible and not guide and group.region is not ALL and (fills or strokes):
            self._look_at_clips(path, group.region, begin)
        self.named = path
        self._count += 1 + sum(len(subpath.segments) + 1 for subpath in subpaths)

    def _look_at_clips(self, path: DrawnPath, region: Region, begin: int) -> None:
        """Note the clip that cuts a path, and say so."""
        wide = reach_of(path)
        if wide is None or not region.cuts(wide):
            return
        path.clipped = region.clip
        kinds = [findings.CLIP, findings.OUTSIDE] if region.misses(wide) else [findings.CLIP]
        for kind in kinds:
            self.findings.add(kind, begin, layer=path.layer, at=path.subpaths[0].segments[0][1:])

    def _flush(self) -> None:
        """End a path that nothing painted (pasted text): each of its subpaths is one."""
        if len(self._segments) > 1 or (self._segments and not self._subpaths):
            self._subpaths.append(Subpath(self._segments, closed=False))
        self._segments = []
        if not self._subpaths:
            return
        if self._compound is not None or self._spoiled or len(self._subpaths) == 1:
            self._take_path("N")
            return
        subpaths = self._subpaths
        for subpath in subpaths:
            self._subpaths = [subpath]
            self._take_path("N")

    def _begin_compound(self, _operands: Operands) -> None:
        self._flush()
        if self._compound is None:
            self._compound = Compound(self.position)
        else:
            self._compound.depth += 1

    def _end_compound(self, _operands: Operands) -> None:
        """``*U``: all members are one path, painted by the last paint operator."""
        self._flush()
        compound = self._compound
        if compound is None:
            self.find(findings.UNBALANCED, what="*U")
            return
        compound.depth -= 1
        if compound.depth:
            return
        self._compound = None
        marks = {"clip": compound.clip, "guide": compound.guide}
        # Hidden members stay apart: they are no part of what is seen.
        if compound.hidden:
            self._add_path(compound.hidden, compound.operator, compound.begin, hidden=True, **marks)
        if compound.shown:
            self._add_path(compound.shown, compound.operator, compound.begin, hidden=False, **marks)
