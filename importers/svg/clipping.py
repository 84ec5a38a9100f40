"""Clips and masks: what the clipPaths of a document leave of the elements that name them."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from importers.boxes import Box
from importers.drawing import DrawnPath
from importers.regions import ALL, UNKNOWN, Region, region_of
from importers.svg.cascade import Cascade
from importers.svg.colour import NOTHING, split_url
from importers.svg.inheritance import Style
from importers.svg.matrix import IDENTITY, Matrix
from importers.svg.placing import element_matrix, has_transform
from importers.svg.references import References
from importers.svg.shapes import SHAPES
from importers.svg.source import Source
from importers.svg.style import Declared
from importers.svg.units import Viewport

# Gives what elements draw: elements in reverse, the matrix, style and viewport around them
ReadAside = Callable[[list[Any], Matrix, Style, Viewport], list[DrawnPath]]

_INITIAL = Style()
_MAX_CLIPS = 16  # clips on clips


class Clips:
    """The clipPaths of a document; each is read once for each viewport that it is used in."""

    def __init__(self, references: References, cascade: Cascade, source: Source, prefix: str) -> None:
        self._references, self._cascade, self._source, self._prefix = references, cascade, source, prefix
        self._regions: dict[tuple[Any, Viewport], Region] = {}
        self._styles: dict[Any, Style] = {}

    def region(
        self, declared: Declared, viewport: Viewport, own_box: Callable[[], Box | None], read: ReadAside
    ) -> Region:
        """Give what a clip and a mask leave of an element, in the coordinates that it is drawn in.

        Args:
            declared: of the element, ``clip-path`` or ``mask`` among them.
            viewport: the nearest, for percentages.
            own_box: gives the box of what the element draws.
            read: gives what elements draw.
        """
        around = ALL if self._referred(declared.get("mask"), "mask") is None else UNKNOWN
        text = declared.get("clip-path", NOTHING)
        clip = self._referred(text, "clipPath")
        if clip is None:  # a shape of CSS such as circle() cuts somewhere
            return UNKNOWN if "(" in text and split_url(text) is None else around
        own = self._clip_region(clip, viewport, read, frozenset())
        if clip.get("clipPathUnits") == "objectBoundingBox":
            left, top, right, bottom = own_box() or (0.0, 0.0, 0.0, 0.0)
            own = own.through((right - left, 0.0, 0.0, bottom - top, left, top))
        return own.within(around)

    def _referred(self, text: str | None, tag: str) -> Any:
        """Give the clipPath or mask that a value names; None without one."""
        address = split_url(text or "")
        found = self._references.at(address[0]) if address else None
        return found if found is not None and found.tag == self._prefix + tag else None

    def _clip_region(self, clip: Any, viewport: Viewport, read: ReadAside, open_now: frozenset[Any]) -> Region:
        """Give the region of a clipPath in the coordinates that it is used in."""
        key = (clip, viewport)
        if key in self._regions:
            return self._regions[key]
        children = list(clip.iterchildren("*", reversed=True))
        if len(open_now) >= _MAX_CLIPS or clip in open_now or any(c.tag == self._prefix + "text" for c in children):
            return UNKNOWN
        around = self._style(clip.getparent())
        declared = self._cascade.declared(clip, self._source.attributes(clip), around)
        style = self._cascade.inherited(around, declared)
        matrix = element_matrix(declared, style, viewport, lambda: None) if has_transform(declared) else IDENTITY
        shown = {self._prefix + tag for tag in (*SHAPES, "use")}
        region = region_of(read([child for child in children if child.tag in shown], matrix, style, viewport))
        outer = self._referred(declared.get("clip-path"), "clipPath")
        if outer is not None:
            region = region.within(self._clip_region(outer, viewport, read, open_now | {clip}))
        self._regions[key] = region
        return region

    def _style(self, element: Any) -> Style:
        """Give what an element hands down where it stands in the file, whoever names what is in it."""
        waiting = []
        while element is not None and element not in self._styles:
            waiting.append(element)
            element = element.getparent()
        style = _INITIAL if element is None else self._styles[element]
        for one in reversed(waiting):
            declared = self._cascade.declared(one, self._source.attributes(one), style)
            style = self._styles[one] = self._cascade.inherited(style, declared)
        return style
