"""The walk over an SVG document: every element that a browser renders becomes a path of the Drawing.

The walk keeps its own stack, so no depth of groups or chain of references can exhaust Python's.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

from importers.boxes import Box, box_of, box_of_segments
from importers.drawing import Drawing, DrawnPath, Layer, Subpath
from importers.limits import MAX_COORDINATE, MAX_DEPTH, MAX_ELEMENTS, limit_error
from importers.svg.cascade import Cascade
from importers.svg.conditions import chosen, holds
from importers.svg.matrix import IDENTITY, Matrix, mean_scale, multiply, transform, translation
from importers.svg.names import INKSCAPE, SODIPODI, name_of, tags_of
from importers.svg.notes import Notes
from importers.svg.paint import Paints
from importers.svg.placing import element_matrix, has_transform, nested_viewport, root_viewport, use_size
from importers.svg.references import References
from importers.svg.shapes import SHAPES, Lengths, Shape, make_shape
from importers.svg.source import SVG_NS, Source, attributes_of
from importers.svg.style import Declared, Style
from importers.svg.units import Viewport, to_px

_GROUPS = frozenset(("g", "a", "svg", "switch", "use"))
_NEVER = frozenset(("defs", "clipPath", "mask", "pattern", "marker", "symbol"))
_SILENT = frozenset(
    (
        "title",
        "desc",
        "metadata",
        "style",
        "linearGradient",
        "radialGradient",
        "filter",
        "view",
        "cursor",
        "font",
        "font-face",
        "solidcolor",
        "color-profile",
        "hatch",
        "meshgradient",
        "missing-glyph",
        "glyph",
    )
)
# What is seen but has no outlines: the code of its problem, and what to do
_NO_GEOMETRY = {
    "text": ("text-left-out", "to make walls of letters, convert the text to paths before saving"),
    "image": ("image-left-out", "trace the image if its shapes are to be walls"),
    "foreignObject": ("object-left-out", "draw its content as shapes if it is to be walls"),
}


Attributes = dict[str, str]

# Groups with a transform-box inside of groups with one: each level reads its content once more.
_MAX_ASIDE = 8


@dataclass(frozen=True, slots=True)
class Around:
    """What an element has from what is around it."""

    matrix: Matrix
    style: Style
    viewport: Viewport
    layer: str = ""
    groups: tuple[str, ...] = ()
    tags: dict[str, str] | None = None
    hidden: bool = False
    unseen: bool = False  # it, or a group around it, has no opacity
    locked: bool = False
    chain: tuple[Any, ...] = ()  # targets of the `use`s that we are inside of
    depth: int = 0
    outline: str = ""  # name of the innermost `use`, for shapes without one


class Reader:
    """Reads one parsed document into a Drawing."""

    def __init__(self, source: Source) -> None:
        self.source = source
        self.notes = Notes(source)
        self.drawing = Drawing(units="px", y_axis="down", kind="SVG", file=source.file)
        root = source.root
        # without a namespace a browser shows nothing; what was meant is plain, so it is read and reported
        self.prefix = f"{{{SVG_NS}}}" if root.tag != "svg" else ""
        self.cascade = Cascade(root, self.prefix, self.notes)
        self.references = References(root, self.prefix, source.file)
        head = source.text[:4000]
        self.illustrator = "Adobe Illustrator" in head or "ns.adobe.com/AdobeIllustrator" in head
        self.inkscape_layers = bool(root.xpath("//*[@*[local-name()='groupmode']='layer']"))
        self.paints = Paints(self.references.at, self.references.referred, self._stop)
        self.layers: dict[str, Layer] = {}
        self.stack: list[tuple[Any, Around]] = []
        self.boxes: dict[Any, Box | None] = {}
        self.aside = 0
        self.segments = 0
        self.initial = Style()

    def read(self) -> Drawing:
        """Walk the document and give the Drawing."""
        root = self.source.root
        if not self.prefix:
            fix = f'add xmlns="{SVG_NS}" to the svg element'
            self.notes.add("missing-namespace", "warning", "browsers show nothing of this file", root, fix=fix)
        self._enter_root(root)
        self._walk()
        self.references.report(self.notes)
        self.drawing.layers = list(self.layers.values())
        self.drawing.problems += self.notes.problems()
        return self.drawing

    def _walk(self) -> None:
        while self.stack:
            element, around = self.stack.pop()
            self._visit(element, around)

    def _enter_root(self, root: Any) -> None:
        declared = self.cascade.declared(root, attributes_of(root))
        style = self.cascade.inherited(self.initial, declared)
        matrix, viewport, shown = root_viewport(root, declared, style.font)
        if not shown:
            fix = "give the svg element a width, a height and a viewBox above 0"
            message = "the drawing has no size, so browsers show nothing of it; its outlines are in user units"
            self.notes.add("no-size", "warning", message, root, fix=fix)
        hidden = declared.get("display") == "none"
        around = Around(matrix, style, viewport, hidden=hidden, unseen=_without_opacity(declared), tags={})
        self._push_children(root, around)

    def _push_children(self, element: Any, around: Around) -> None:
        if around.depth >= MAX_DEPTH:
            line = self.source.line(element)
            raise limit_error("groups in groups", str(MAX_DEPTH), file=self.source.file, line=line)
        self.stack.extend((child, around) for child in element.iterchildren("*", reversed=True))

    def _visit(self, element: Any, around: Around) -> None:
        tag = element.tag
        if not tag.startswith(self.prefix) or (not self.prefix and tag[0] == "{"):
            self._foreign(element)
            return
        tag = tag[len(self.prefix) :]
        if tag not in SHAPES and tag not in _GROUPS:
            self._skip(tag, element)
            return
        attributes = attributes_of(element)
        if not holds(attributes):
            message = f"<{tag}> is for another language or program"
            self.notes.count("not-chosen", "info", message, element)
        elif tag in SHAPES:
            self._draw(tag, element, attributes, around)
        else:
            self._enter(tag, element, attributes, around)

    def _skip(self, tag: str, element: Any) -> None:
        if tag in _NO_GEOMETRY:
            code, fix = _NO_GEOMETRY[tag]
            self.notes.count(code, "info", f"<{tag}> has no outlines and is left out", element, fix=fix)
        elif tag in _NEVER:
            self.references.kept_back.append(element)
        elif tag in ("script", "animate", "animateTransform", "animateMotion", "animateColor", "set"):
            message = f"<{tag}> is not run: the drawing is read as it is at the start"
            self.notes.count("not-run", "info", message, element)
        elif tag not in _SILENT:
            self.notes.count("unknown-element", "info", f"<{tag}> is unknown to SVG, browsers skip it", element)

    def _foreign(self, element: Any) -> None:
        tag = str(element.tag)
        if tag[0] != "{":
            fix = f'give it the namespace "{SVG_NS}"'
            message = f"<{tag}> is in no namespace, so browsers skip it"
            self.notes.count("unknown-element", "warning", message, element, fix=fix)
        elif not tag.startswith((INKSCAPE, SODIPODI, "{http://ns.adobe.com/", "{&ns_", "{http://www.w3.org/1999/02/")):
            message = f"<{tag.rpartition('}')[2]}> is not SVG and is left out"
            self.notes.count("foreign-element", "info", message, element)

    def _enter(self, tag: str, element: Any, attributes: Attributes, around: Around) -> None:
        """Go into an element that groups others."""
        if tag == "a" and element.getparent().tag == element.tag:
            self.notes.count("not-drawn", "info", "<a> directly in <a> is not shown", element)
            return
        declared = self.cascade.declared(element, attributes, around.chain)
        inside = self._inside(tag, element, attributes, declared, around)
        if tag == "use":
            self._use(element, attributes, declared, inside)
        elif tag == "svg":
            self._nested(element, attributes, inside)
        elif tag == "switch":
            picked = chosen(element, self.prefix)
            for child in element.iterchildren("*"):
                if child is not picked:
                    self.references.not_chosen.append(child)
            if picked is not None:
                self.stack.append((picked, inside))
        else:
            self._push_children(element, inside)

    def _inside(self, tag: str, element: Any, attributes: Attributes, declared: Declared, around: Around) -> Around:
        """Give what the children of a group have around them."""
        style = self.cascade.inherited(around.style, declared)
        matrix = around.matrix
        display = declared.get("display")
        hidden = around.hidden or display == "none" or (display == "contents" and tag in ("svg", "use", "symbol"))
        if has_transform(declared) and display != "contents":
            matrix = multiply(
                matrix,
                element_matrix(
                    declared, style, around.viewport, lambda: self._box_of(tag, element, attributes, around, style)
                ),
            )
        name = name_of(element, attributes, self.illustrator)
        locked = around.locked or attributes.get(SODIPODI + "insensitive") == "true"
        layer, groups = around.layer, around.groups
        if self._is_layer(tag, element, attributes, around):
            layer = name
            found = self.layers.setdefault(name, Layer(name, visible=not hidden, locked=locked))
            found.visible = found.visible or not hidden
        else:
            groups = (*groups, name)
        tags = tags_of(attributes, around.tags or {})
        return replace(
            around,
            matrix=matrix,
            style=style,
            layer=layer,
            groups=groups,
            tags=tags,
            hidden=hidden,
            unseen=around.unseen or _without_opacity(declared),
            locked=locked,
            depth=around.depth + 1,
        )

    def _box_of(self, tag: str, element: Any, attributes: Attributes, around: Around, style: Style) -> Box | None:
        """Give the box of what a group draws, in its own coordinates, by reading its content on the side."""
        key = (element, around.viewport, around.style)
        if key not in self.boxes:
            if self.aside >= _MAX_ASIDE:
                fix = "write the transform without transform-box"
                self.notes.count("box-in-box", "error", "transform-box in transform-box is too deep", element, fix=fix)
                return None
            saved = self.stack, self.drawing, self.notes, self.layers
            self.stack, self.drawing = [], Drawing(units="px", y_axis="down")
            self.notes, self.layers = Notes(self.source), {}
            self.aside += 1
            inside = replace(around, matrix=IDENTITY, style=style, depth=around.depth + 1)
            if tag == "use":
                self._use(element, attributes, {}, inside)
            else:
                self._push_children(element, inside)
            self._walk()
            self.boxes[key] = box_of(self.drawing.paths)
            self.aside -= 1
            self.stack, self.drawing, self.notes, self.layers = saved
        return self.boxes[key]

    def _is_layer(self, tag: str, element: Any, attributes: Attributes, around: Around) -> bool:
        if tag != "g" or around.chain:
            return False
        if self.inkscape_layers:
            return attributes.get(INKSCAPE + "groupmode") == "layer"
        top = element.getparent() is self.source.root
        return top and bool(attributes.get("id") or attributes.get("data-name"))

    def _use(self, element: Any, attributes: Attributes, declared: Declared, inside: Around) -> None:
        target, why = self.references.target(element, inside.chain)
        if target is None:
            self.notes.add(
                "bad-use", "warning", why, element, fix="point href to an id of this file", layer=inside.layer
            )
            return
        lengths = Lengths(attributes, declared, inside.viewport, inside.style.font)
        x, y = lengths.get("x") or 0.0, lengths.get("y") or 0.0
        matrix = multiply(inside.matrix, translation(x, y))
        name = name_of(element, attributes, self.illustrator)
        inside = replace(inside, matrix=matrix, chain=(*inside.chain, target), outline=name or inside.outline)
        tag = target.tag[len(self.prefix) :]
        if inside.depth > MAX_DEPTH:
            raise limit_error("groups in groups", str(MAX_DEPTH), file=self.source.file)
        if tag in ("symbol", "svg"):
            own = attributes_of(target)
            within = self._inside(tag, target, own, self.cascade.declared(target, own, inside.chain), inside)
            self._nested(target, own, within, use_size(tag, lengths))
        elif tag in SHAPES or tag in _GROUPS or tag in _NO_GEOMETRY:
            self.stack.append((target, inside))
        else:
            self.notes.count("bad-use", "info", f"<use> of a <{tag}> draws nothing", element)

    def _nested(
        self,
        element: Any,
        attributes: Attributes,
        inside: Around,
        size: tuple[float | None, float | None] = (None, None),
    ) -> None:
        # browsers take the place and size of an inner svg from its attributes alone
        lengths = Lengths(attributes, {}, inside.viewport, inside.style.font)
        placed = nested_viewport(element, lengths, size)
        if placed is None:
            self.notes.count("nothing-drawn", "info", "<svg> or <symbol> without a size draws nothing", element)
            self._push_children(element, replace(inside, hidden=True))
            return
        matrix, viewport = placed
        self._push_children(element, replace(inside, matrix=multiply(inside.matrix, matrix), viewport=viewport))

    def _draw(self, tag: str, element: Any, attributes: Attributes, around: Around) -> None:
        declared = self.cascade.declared(element, attributes, around.chain)
        style = self.cascade.inherited(around.style, declared)
        hidden = around.hidden or declared.get("display") in ("none", "contents")
        if hidden and self.aside:  # what is not displayed counts for no box
            return
        lengths = Lengths(attributes, declared, around.viewport, style.font)
        shape = make_shape(tag, attributes, lengths)
        matrix = around.matrix
        if has_transform(declared):
            own = [segment for sub in shape.subpaths for segment in sub.segments]
            matrix = multiply(matrix, element_matrix(declared, style, around.viewport, lambda: box_of_segments(own)))
        name = name_of(element, attributes, self.illustrator) or around.outline
        if shape.fault is not None or lengths.invalid or lengths.assumed or not shape.subpaths:
            self._report_shape(tag, element, shape, lengths, around.layer, name, matrix)
        subpaths = [Subpath(transform(sub.segments, matrix), sub.closed) for sub in shape.subpaths]
        if not subpaths:
            return
        self.segments += sum(len(sub.segments) for sub in subpaths)
        if self.segments > MAX_ELEMENTS:
            raise limit_error("segments of all paths", f"{MAX_ELEMENTS:,}", file=self.source.file)
        if not _within(subpaths):
            message = f"<{tag}> reaches beyond {MAX_COORDINATE:g} and is left out"
            self.notes.add("bad-coordinate", "error", message, element, layer=around.layer, name=name)
            return
        fill, stroke, width = None, None, None
        if not (around.unseen or _without_opacity(declared)):
            fill = self.paints.word(style.fill) if style.fill_seen and tag != "line" else None
            stroke, width = self._stroke(style, around.viewport, matrix)
        self.drawing.paths.append(
            DrawnPath(
                subpaths=subpaths,
                name=name,
                layer=around.layer,
                groups=around.groups,
                visible=style.visible and not hidden,
                locked=around.locked or attributes.get(SODIPODI + "insensitive") == "true",
                fill=fill,
                stroke=stroke,
                stroke_width=width,
                fill_rule="evenodd" if style.fill_rule == "evenodd" else "nonzero",
                line=self.source.line(element),
                tags=dict(tags_of(attributes, around.tags or {})),
            )
        )

    def _stroke(self, style: Style, viewport: Viewport, matrix: Matrix) -> tuple[str | None, float | None]:
        """Give the paint and the width of a stroke that is seen; a stroke without width paints nothing."""
        stroke = self.paints.word(style.stroke) if style.stroke_seen else None
        if stroke is None:
            return None, None
        width = to_px(style.stroke_width, viewport.diagonal, style.font) * mean_scale(matrix)
        if not width > 0:
            return None, None
        return stroke, width if width <= MAX_COORDINATE else None

    def _stop(self, stop: Any) -> Declared:
        """Give the declarations of a gradient's stop."""
        return self.cascade.declared(stop, attributes_of(stop))

    def _report_shape(
        self, tag: str, element: Any, shape: Shape, lengths: Lengths, layer: str, name: str, matrix: Matrix
    ) -> None:
        for attribute in lengths.invalid:
            value = str(element.get(attribute))[:40]
            message = f"{attribute}={value!r} is no length and is not used"
            self.notes.add("bad-length", "warning", message, element, attribute=attribute, layer=layer, name=name)
        if lengths.assumed:
            message = f"<{tag}> is measured in a window or a font, which a file does not have"
            fix = "write its lengths in px or mm"
            self.notes.count("assumed-unit", "warning", message, element, fix=fix)
        if shape.fault is not None:
            at = None
            if shape.subpaths:
                end = shape.subpaths[-1].segments[-1][-2:]
                at = transform([("L", *end)], matrix)[0][1:]
            code = "bad-path-data" if shape.attribute == "d" else "bad-points"
            fix = "what stands before it is used" if shape.subpaths else "nothing of it is drawn"
            self.notes.add(
                code,
                "error",
                shape.fault.message,
                element,
                fix=f"{fix}; correct the {shape.attribute} attribute here",
                attribute=shape.attribute,
                offset=shape.fault.offset,
                layer=layer,
                name=name,
                at=at,
            )
        elif not shape.subpaths:
            self.notes.count("nothing-drawn", "info", f"<{tag}> draws nothing: {shape.nothing}", element)


def _without_opacity(declared: Declared) -> bool:
    """Tell whether an element and all in it is fully transparent; what has no box has no opacity of its own."""
    opacity = declared.get("opacity")
    return isinstance(opacity, float) and opacity <= 0 and declared.get("display") != "contents"


def _within(subpaths: list[Subpath]) -> bool:  # every number finite and no larger than coordinates may be
    for sub in subpaths:
        for segment in sub.segments:
            for number in segment[1:]:
                if not -MAX_COORDINATE <= number <= MAX_COORDINATE:
                    return False
    return True
