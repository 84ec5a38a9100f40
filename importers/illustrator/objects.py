"""What stands around the paths of an Illustrator file: paint, marks, groups, layers, and objects that are no paths."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from importers.drawing import DrawnPath, FillRule, Layer, Segment
from importers.findings import Findings, Kind
from importers.illustrator import findings
from importers.illustrator.state import Group, Paint, colour_of
from importers.illustrator.text import decode
from importers.limits import MAX_COORDINATE, MAX_DEPTH, limit_error
from importers.sources import Source

Operands = list[Any]  # numbers as bytes or float, texts and names as Text
Handler = Callable[[Operands], None]
# What moves the axes nowhere.
_IDENTITIES = {
    b"translate": [0.0, 0.0],
    b"scale": [1.0, 1.0],
    b"rotate": [0.0],
    b"concat": [1.0, 0.0, 0.0, 1.0, 0.0, 0.0],
}


@dataclass(frozen=True, slots=True)
class Text:
    """A string operand (its bytes with escapes resolved), or a literal name."""

    raw: bytes


class Objects:
    """The state that the operators around paths set.

    Attributes:
        layers: in the file's order.
        findings: what was left out or could not be read.
        position: byte position of the operator at hand; its reader sets it.
        named: what a name that follows in the file belongs to.
        note: the note that the next objects carry.
        moved_by: what moved, scaled or turned the axes before something was drawn, ``""`` when nothing did.
    """

    def __init__(self, source: Source, encoding: str, file: str) -> None:
        self.source = source
        self.encoding = encoding
        self.file = file
        self.layers: list[Layer] = []
        self.findings = Findings()
        self.position = 0
        self.named: DrawnPath | Group | None = None
        self.note = ""
        self.moved_by = ""
        self._saves = 0  # graphics states that are kept
        self._moved_in = -1  # how many were when the axes were moved; -1: they are where they were
        self._mover = ""
        self._segments: list[Segment] = []  # of the subpath that is being drawn
        self._paint = Paint()
        self._fill_rule: FillRule = "nonzero"  # no part of what `q` keeps: PostScript has no such thing
        self._gradient = False
        self._hidden = False
        self._locked = False
        self._text = False
        self._objects = 0  # depth in `/Kind : ... ;`
        self._group = Group("root")
        self._bare_layer = ""  # a layer's name that came without `Lb`
        self._count = 0  # of segments, paths and groups

    def _flush(self) -> None:
        """End a path that nothing painted; what draws paths knows how."""
        raise NotImplementedError

    def _stop_at(self, limit: str, figure: int) -> None:
        """Raise LimitError for what was hit at the operator at hand."""
        raise limit_error(limit, f"{figure:,}", file=self.file, line=self.source.line(self.position))

    def find(self, kind: Kind, *, what: str = "", position: int | None = None) -> None:
        """Note a finding at the operator at hand, or at `position`."""
        point = self._segments[-1][-2:] if self._segments else None
        place = self.position if position is None else position
        self.findings.add(kind, place, what=what, layer=self._group.layer, at=point)

    def _ignore(self, _operands: Operands) -> None:
        """Do nothing: no geometry depends on it."""

    # --- paint ------------------------------------------------------------------------------------------

    def _set_fill(self, operator: str, operands: Operands) -> None:
        colour = colour_of(operator, [float(operand) for operand in operands if not isinstance(operand, Text)])
        self._paint.fill = colour or self._paint.fill

    def _set_stroke(self, operator: str, operands: Operands) -> None:
        colour = colour_of(operator, [float(operand) for operand in operands if not isinstance(operand, Text)])
        self._paint.stroke = colour or self._paint.stroke

    def _fill_pattern(self, _operands: Operands) -> None:
        self._paint.fill = "pattern"

    def _stroke_pattern(self, _operands: Operands) -> None:
        self._paint.stroke = "pattern"

    def _set_width(self, operands: Operands) -> None:
        (width,) = map(float, operands[-1:])
        if not 0.0 <= width <= MAX_COORDINATE:
            raise ValueError(width)
        self._paint.width = width

    def _set_fill_rule(self, operands: Operands) -> None:
        self._fill_rule = "evenodd" if operands and float(operands[-1]) == 1 else "nonzero"

    def _begin_gradient(self, _operands: Operands) -> None:
        self._gradient = True

    def _end_gradient(self, operands: Operands) -> None:
        """``BB``: 1 strokes what the gradient filled, 2 closes and strokes it."""
        self._gradient = False
        if operands and float(operands[-1]) in (1, 2) and isinstance(self.named, DrawnPath):
            self.named.stroke, self.named.stroke_width = self._paint.stroke, self._paint.width

    # --- marks, groups, layers --------------------------------------------------------------------------

    def _set_locked(self, operands: Operands) -> None:
        self._locked = bool(operands) and float(operands[-1]) == 1

    def _set_hidden(self, operands: Operands) -> None:
        self._hidden = bool(operands) and float(operands[-1]) == 1

    def _open(self, group: Group) -> None:
        """Go into a group, clip group or layer."""
        self._flush()
        if group.depth > MAX_DEPTH:
            self._stop_at("groups and layers in each other", MAX_DEPTH)
        self._group = group
        self._count += 1
        self.named = None

    def _begin_group(self, _operands: Operands) -> None:
        outer = self._group
        hidden, locked = outer.hidden or self._hidden, outer.locked or self._locked
        self._open(Group("u", outer, "", hidden, locked, outer.layer, outer.depth + 1, region=outer.region))

    def _begin_clip(self, _operands: Operands) -> None:
        outer = self._group
        hidden, locked = outer.hidden or self._hidden, outer.locked or self._locked
        paint, depth = self._paint.copy(), outer.depth + 1
        self._open(Group("q", outer, "", hidden, locked, outer.layer, depth, paint, region=outer.region))
        self._save([])

    def _end_group(self, _operands: Operands) -> None:
        self._leave("u", "U")

    def _end_clip(self, _operands: Operands) -> None:
        self._leave("q", "Q")
        self._restore([])

    def _leave(self, kind: str, operator: str) -> None:
        """Go out of the innermost group of a kind, and of what was left open in it."""
        self._flush()
        group: Group | None = self._group
        while group is not None and group.kind != kind:
            # A layer is closed by its own operator only.
            group = group.outer if group.kind != "layer" else None
        if group is None or group.outer is None:
            self.find(findings.UNBALANCED, what=operator)
            return
        self._group = group.outer
        self.named = group
        if group.paint is not None:
            self._paint = group.paint

    def _begin_layer(self, operands: Operands) -> None:
        """``Lb``: visible preview enabled printing ...; later versions add arguments at the end."""
        flags = [float(operand) != 0 for operand in operands[:4] if not isinstance(operand, Text)]
        visible, _preview, enabled, printing = (*flags, True, True, True, True)[:4]
        record = Layer("", visible=visible, locked=not enabled, printing=printing)
        self.layers.append(record)
        outer = self._group
        hidden, locked = outer.hidden or not visible, outer.locked or not enabled
        self._open(Group("layer", outer, "", hidden, locked, "", outer.depth + 1, record=record, region=outer.region))
        self._hidden = self._locked = False

    def _name_layer(self, operands: Operands) -> None:
        """``(name) Ln``: names the layer that `Lb` opened, or one that nothing else says anything of."""
        self._flush()
        texts = [operand for operand in operands if isinstance(operand, Text)]
        name = decode(texts[-1].raw, self.encoding) if texts else ""
        group = self._group
        if group.kind == "layer" and group.record is not None and not group.name:
            group.name = group.layer = group.record.name = name
        elif name != self._bare_layer:
            self._bare_layer = name
            self.layers.append(Layer(name))
            self._count += 1

    def _end_layer(self, _operands: Operands) -> None:
        self._flush()
        group: Group | None = self._group
        while group is not None and group.kind != "layer":
            group = group.outer
        if group is None or group.outer is None:
            self.find(findings.UNBALANCED, what="LB")
            return
        self._group = group.outer
        self._hidden = self._locked = False
        self.named = None

    # --- what is no path --------------------------------------------------------------------------------

    def _leave_out(self, kind: Kind, _operands: Operands) -> None:
        self.find(kind)
        self.named = None

    def _begin_text(self, _operands: Operands) -> None:
        self._flush()
        self._leave_out(findings.TEXT, [])
        self._text = True
        self._save([])

    def _end_text(self, _operands: Operands) -> None:
        self._flush()
        self._text = False
        self.named = None
        self._restore([])

    def _old_text(self, _operands: Operands) -> None:
        """``T``: a text of versions 1 and 88 ends."""
        self._leave_out(findings.TEXT, [])

    def _placed(self, _operands: Operands) -> None:
        """A placed file begins."""
        self._leave_out(findings.PLACED, [])

    def _begin_object(self, operands: Operands) -> None:
        """``/Kind :``: an object of newer versions that is no path; ``;`` ends it."""
        names = [operand.raw for operand in operands if isinstance(operand, Text)]
        if not self._objects and names:
            kind = names[-1].decode("latin-1")[:24]
            if kind == "AI11Text":
                self.find(findings.TEXT)
            else:
                self.findings.add(findings.OBJECT, self.position, what=kind, apart=True, layer=self._group.layer)
        self._objects += 1
        self.named = None

    def _mesh(self, operands: Operands) -> None:
        """``/Mesh X!`` begins a gradient mesh, ``/End X!`` ends it."""
        if Text(b"End") not in operands:
            self.findings.add(findings.OBJECT, self.position, what="Mesh", apart=True, layer=self._group.layer)
        self.named = None

    # --- PostScript's own -------------------------------------------------------------------------------

    def _save(self, _operands: Operands) -> None:
        self._saves += 1

    def _restore(self, _operands: Operands) -> None:
        self._saves = max(self._saves - 1, 0)
        if self._moved_in > self._saves:
            self._moved_in = -1

    def _move_axes(self, name: bytes, operands: Operands) -> None:
        """A program moves, scales or turns what follows: what is drawn so has no place that is known here."""
        if name in _IDENTITIES and [*map(float, operands)] == _IDENTITIES[name]:
            return
        if self._moved_in < 0:
            self._moved_in = self._saves
            self._mover = name[:24].decode("latin-1")

    def _end_object(self, _operands: Operands) -> None:
        self._flush()
        self._objects = max(self._objects - 1, 0)
        self.named = None
