"""Inheritance: what an element hands down to its children."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Any

from importers.numbers import finite
from importers.svg.colour import NOTHING
from importers.svg.style import INHERIT, INITIAL, VARIABLES, Declared
from importers.svg.units import ROOT_FONT, Font, Terms, to_px


@dataclass(frozen=True, slots=True)
class Style:
    """What an element hands down to its children.

    Attributes:
        fill: ``"#rrggbb"``, ``url(...)`` with what stands in for it, or None.
        stroke: the same.
        stroke_width: as a length, resolved where it is used.
        fill_rule: ``"nonzero"`` or ``"evenodd"``.
        clip_rule: the same, for shapes in a clipPath.
        fill_seen: the fill has some opacity.
        stroke_seen: the stroke has some opacity.
        color: what ``currentColor`` means, as ``"#rrggbb"`` or ``"none"``.
        visible: ``visibility`` is ``visible``.
        font: for font units.
        variables: custom properties by name, their own ``var()`` resolved.
        line_factor: ``line-height`` as a bare number, which children multiply by their own font size.
    """

    fill: str | None = "#000000"
    stroke: str | None = None
    stroke_width: Terms = ((1.0, "px"),)
    fill_rule: str = "nonzero"
    clip_rule: str = "nonzero"
    fill_seen: bool = True
    stroke_seen: bool = True
    color: str = "#000000"
    visible: bool = True
    font: Font = ROOT_FONT
    line_factor: float | None = None
    variables: dict[str, str] = field(default_factory=dict, compare=False)


def inherit(parent: Style, declared: Declared) -> Style:
    """Give the style of an element from its parent's and its own declarations.

    Raises:
        NumberError: a font size is too large.
    """
    changes: dict[str, Any] = {}
    if VARIABLES in declared:
        changes["variables"] = declared[VARIABLES]
    font = _font(parent, declared, changes)
    if font is not parent.font:
        changes["font"] = font
    if "color" in declared:
        value = declared["color"]
        wide = value in (INHERIT, "currentcolor")
        changes["color"] = parent.color if wide else ("#000000" if value == INITIAL else value)
    colour = changes.get("color", parent.color)
    for name in ("fill", "stroke"):
        if name in declared and declared[name] != INHERIT:
            changes[name] = _used_paint(declared[name], "#000000" if name == "fill" else None, colour)
    for name, seen in (("fill-opacity", "fill_seen"), ("stroke-opacity", "stroke_seen")):
        if declared.get(name, INHERIT) != INHERIT:
            changes[seen] = declared[name] == INITIAL or declared[name] > 0
    if declared.get("stroke-width", INHERIT) != INHERIT:
        value = declared["stroke-width"]
        changes["stroke_width"] = ((1.0, "px"),) if value == INITIAL else value
    for name, rule in (("fill-rule", "fill_rule"), ("clip-rule", "clip_rule")):
        if declared.get(name, INHERIT) != INHERIT:
            changes[rule] = "nonzero" if declared[name] == INITIAL else declared[name]
    if declared.get("visibility", INHERIT) != INHERIT:
        changes["visible"] = declared["visibility"] in ("visible", INITIAL)
    return replace(parent, **changes) if changes else parent


def _used_paint(value: str, initial: str | None, colour: str) -> str | None:
    if value == INITIAL:
        return initial
    if value == "currentcolor":
        value = colour
    if value == NOTHING:
        return None
    if value.lower().startswith("url("):
        return value
    return value if value.startswith("#") else None


def _font(parent: Style, declared: Declared, changes: dict[str, Any]) -> Font:
    font = parent.font
    size = declared.get("font-size", INHERIT)
    if size != INHERIT:
        terms: Terms = ((16.0, "px"),) if size == INITIAL else size
        font = font._replace(size=max(0.0, to_px(terms, parent.font.size, parent.font)))
    height = declared.get("line-height", INHERIT)
    factor = parent.line_factor
    if height in ("normal", INITIAL):
        factor = None
        font = font._replace(line_height=None)
    elif height != INHERIT:
        factor = height[0][0] if len(height) == 1 and height[0][1] == "" else None
        font = font._replace(line_height=to_px(height, font.size, font))
    if factor is not None:
        font = font._replace(line_height=finite(factor * font.size))
    if factor != parent.line_factor:
        changes["line_factor"] = factor
    return font
