"""What an Illustrator file has said so far: paint, marks, groups, layers."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from importers import colours
from importers.drawing import Layer
from importers.regions import ALL, Region


@dataclass(slots=True)
class Paint:
    """The paint that the next path gets; ``q`` keeps a copy and ``Q`` brings it back."""

    fill: str = "#000000"
    stroke: str = "#000000"
    width: float = 1.0

    def copy(self) -> Paint:
        """Give a copy for ``q``."""
        return Paint(self.fill, self.stroke, self.width)


@dataclass(slots=True)
class Group:
    """A group, clip group or layer that is open, or was.

    Attributes:
        kind: ``"u"``, ``"q"``, ``"layer"`` or ``"root"`` (what is around everything).
        outer: the group around it.
        name: its name; in the file it follows the group.
        hidden: it or one around it is hidden.
        locked: it or one around it is locked.
        layer: name of the innermost layer around it.
        depth: how many are around it.
        paint: what ``Q`` brings back.
        record: the drawing's entry of a layer.
        region: what clips in it and around it leave.
    """

    kind: str
    outer: Group | None = None
    name: str = ""
    hidden: bool = False
    locked: bool = False
    layer: str = ""
    depth: int = 0
    paint: Paint | None = None
    record: Layer | None = None
    region: Region = ALL

    def names(self) -> tuple[str, ...]:
        """Give the names of the groups up to this one, outermost first, layers not among them."""
        names: list[str] = []
        group: Group | None = self
        while group is not None:
            if group.kind in "uq":
                names.append(group.name)
            group = group.outer
        return tuple(reversed(names))


def colour_of(operator: str, operands: Sequence[float]) -> str | None:
    """Give the colour that an operator of Illustrator sets.

    Args:
        operator: ``g k x Xa Xx Xk``, or the same for strokes in upper case as Illustrator writes it.
        operands: its numbers; names of spot colours are left out.

    Returns:
        ``"#rrggbb"``, or None when there are not enough numbers.
    """
    count = len(operands)
    kind = operator.lower()
    if kind == "g":
        return colours.gray(operands[-1]) if count else None
    if kind == "k":
        return colours.cmyk(*operands[-4:]) if count >= 4 else None
    if kind == "xa":  # three numbers, or four of ink before them
        return colours.rgb(*operands[-3:]) if count >= 3 else None
    if kind == "x":  # ink and how much of it is left white
        return _tinted(colours.cmyk(*operands[:4]), operands[4]) if count >= 5 else None
    if kind == "xx" and count in (6, 9):  # ink or ink and light, tint, which of both
        return _spot(operands[:-2], operands[-2])
    if kind == "xk" and count >= 9:
        return _spot(operands[:7], operands[7])
    return None


def _spot(components: Sequence[float], tint: float) -> str:
    """Give a spot colour from 4 numbers of ink, or those and 3 of light."""
    base = colours.rgb(*components[4:7]) if len(components) >= 7 else colours.cmyk(*components[:4])
    return _tinted(base, tint)


def _tinted(base: str, tint: float) -> str:
    """Mix a colour with white: tint 0 is the colour itself, 1 is white."""
    tint = min(max(tint, 0.0), 1.0)
    parts = (int(base[index : index + 2], 16) / 255 for index in (1, 3, 5))
    return colours.rgb(*(part + (1.0 - part) * tint for part in parts))
