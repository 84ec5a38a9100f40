"""The walk over an SVG document: every element that a browser renders becomes a path of the Drawing.

The walk keeps its own stack, so no depth of groups or chain of references can exhaust Python's.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from importers.boxes import Box, box_of
from importers.drawing import Drawing, DrawnPath, FillRule, Layer, Level
from importers.limits import MAX_COORDINATE, MAX_DEPTH, MAX_ELEMENTS, limit_error
from importers.numbers import NumberError
from importers.regions import ALL, Region
from importers.subpaths import settle
from importers.svg import left_out
from importers.svg.around import Around, BoxFirst, Reading
from importers.svg.cascade import Cascade
from importers.svg.clipping import Clips
from importers.svg.conditions import chosen, holds
from importers.svg.inheritance import Style
from importers.svg.looks import Look, Looks, Words, without_opacity
from importers.svg.matrix import IDENTITY, Matrix, mean_scale, multiply, transformed, translation
from importers.svg.names import INKSCAPE, SODIPODI, SVG_NS, label_of, name_of, title_of, words_of
from importers.svg.notes import Notes
from importers.svg.pages import pages_of, sheet_of
from importers.svg.paint import Paints
from importers.svg.placing import DEFAULT_SIZE, nested_viewport, root_viewport, use_size
from importers.svg.plain_paths import PlainPaths
from importers.svg.references import References
from importers.svg.shapes import SHAPES, Lengths, Shapes
from importers.svg.source import Source
from importers.svg.style import Declared
from importers.svg.units import Viewport

_GROUPS = frozenset(("g", "a", "svg", "switch", "use"))

_INSENSITIVE, _GROUPMODE = SODIPODI + "insensitive", INKSCAPE + "groupmode"

Attributes = dict[str, str]

# Of a visit to any element, and of following a reference; see limits.Work
_STEPS_OF_A_VISIT = 10
_STEPS_OF_A_USE = 35
# Groups with a transform-box inside of groups with one: each level reads its content once more.
_MAX_ASIDE = 8


class Reader:
    """Reads one parsed document into a Drawing."""

    def __init__(self, source: Source) -> None:
        self.source, self.work = source, source.work
        self.notes = Notes(source)
        self.drawing = Drawing(units="px", y_axis="down", kind="SVG", file=source.file)
        root = source.root
        # without a namespace a browser shows nothing; what was meant is plain, so it is read and reported
        self.prefix = f"{{{SVG_NS}}}" if root.tag != "svg" else ""
        self.cascade = Cascade(root, self.prefix, self.notes, source.work)
        self.references = References(root, self.prefix, source.file, source.work)
        head = source.text[:4000]
        self.illustrator = "Adobe Illustrator" in head or "ns.adobe.com/AdobeIllustrator" in head
        named = "groupmode" in source.text  # in names of attributes nothing stands for anything else
        self.inkscape_layers = named and bool(root.xpath("//*[@*[local-name()='groupmode']='layer']"))
        self.looks = Looks(self.cascade, source.work)
        self.paints = Paints(self.references, self.cascade, source, self.notes)
        self.clips = Clips(self.references, self.cascade, source, self.prefix)
        self.layers: dict[str, Layer] = {}
        self.stack: list[tuple[Any, Around]] = []
        self.shapes = Shapes(source.work, PlainPaths(path.get("d", "") for path in root.iter(self.prefix + "path")))
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
        self.drawing.problems += self.source.problems
        self._push_children(root, self.enter())
        self._walk()
        settle(subpath for path in self.drawing.paths for subpath in path.subpaths)
        self.references.report(self.notes)
        self.drawing.layers = list(self.layers.values())
        self.drawing.problems += self.notes.problems()
        return self.drawing

    def _walk(self) -> None:
        """Visit what is on the stack; boxes that are asked for on the way are read on the side, one by one.

        An element whose box is needed first goes back on the stack, and what was read so far is set aside: boxes in
        boxes are no calls in calls.
        """
        waiting: list[tuple[Any, Reading]] = []
        while self.stack or waiting:
            if not self.stack:
                key, reading = waiting.pop()
                self.boxes[key] = box_of(self.drawing.paths)
                self._go_back(reading)
                continue
            element, around = self.stack.pop()
            self.work.charge("elements", _STEPS_OF_A_VISIT)
            try:
                try:
                    self._visit(element, around)
                except BoxFirst as first:
                    key, reading = self._begin(first)
                    reading.stack.append((element, around))
                    waiting.append((key, reading))
            except NumberError as error:
                self._too_large(element, around, error)

    def _too_large(self, element: Any, around: Around, error: NumberError) -> None:
        """Say that an element and what is in it is left out for a number that is beyond all bounds."""
        tag = str(element.tag).rpartition("}")[2]
        message = f"<{tag}> is left out with all in it: a number there is too large"
        attributes = self.source.attributes(element)
        name = name_of(attributes, title_of(element), self.illustrator) or around.outline
        attribute = error.attribute if error.attribute in attributes else ""
        self.notes.add(
            "bad-number",
            "error",
            message,
            element,
            fix="write a smaller number",
            attribute=attribute,
            offset=error.offset,
            layer=around.layer,
            name=name,
        )

    def enter(self) -> Around:
        """Read the outermost element, and give what its children have around them."""
        root = self.source.root
        declared = self.cascade.declared(root, self.source.attributes(root), self.initial)
        try:
            style = self.cascade.inherited(self.initial, declared)
            matrix, viewport, page = root_viewport(root, declared, style.font)
        except NumberError as error:
            message = "a number of the svg element is too large; the outlines are in user units"
            fix = "write a smaller number"
            place = error.attribute if error.attribute and error.attribute in root.attrib else ""
            self.notes.add("bad-number", "error", message, root, fix=fix, attribute=place, offset=error.offset)
            style, matrix, viewport, page = self.initial, IDENTITY, Viewport(*DEFAULT_SIZE), None
        left_out.note_viewport(root, ("width", "height"), self.notes)
        if page is None:
            fix = "give the svg element a width, a height and a viewBox above 0"
            message = "the drawing has no size, so browsers show nothing of it; its outlines are in user units"
            self.notes.add("no-size", "warning", message, root, fix=fix)
        self.drawing.sheet = sheet_of(root, page)
        self.drawing.artboards = pages_of(root, matrix)
        hidden = declared.get("display") == "none"
        region = ALL if page is None else Region(page)
        around = Around(matrix, style, viewport, page=region, hidden=hidden, unseen=without_opacity(declared))
        return around._replace(clip=self._clip(declared, around, matrix, lambda: None))

    def _push_children(self, element: Any, around: Around) -> None:
        if around.depth >= MAX_DEPTH:
            line = self.source.line(element)
            raise limit_error("groups in groups", str(MAX_DEPTH), file=self.source.file, line=line)
        self.stack.extend([(child, around) for child in element.iterchildren("*", reversed=True)])

    def _visit(self, element: Any, around: Around) -> None:
        tag = element.tag
        if not tag.startswith(self.prefix) or (not self.prefix and tag[0] == "{"):
            left_out.note_foreign(element, self.notes)
            return
        tag = tag[len(self.prefix) :]
        if tag not in SHAPES and tag not in _GROUPS:
            left_out.note_skipped(tag, element, self.notes, self.references)
            return
        attributes = self.source.attributes(element)
        if not holds(attributes):
            message = f"<{tag}> is for another language or program"
            self.notes.count("not-chosen", "info", message, element)
        elif tag in SHAPES:
            self._draw(tag, element, attributes, around)
        else:
            self._enter(tag, element, attributes, around)

    def _enter(self, tag: str, element: Any, attributes: Attributes, around: Around) -> None:
        """Go into an element that groups others."""
        if tag == "a" and element.getparent().tag == element.tag:
            self.notes.count("not-drawn", "info", "<a> directly in <a> is not shown", element)
            return
        look = self.looks.of(element, attributes, around)
        declared, inside = look.declared, self._inside(tag, element, attributes, look, around)
        if tag == "use":
            self._use(element, attributes, declared, inside)
        elif tag == "svg":
            self._nested(element, attributes, declared, inside)
        elif tag == "switch":
            picked = chosen(element, self.prefix)
            for child in element.iterchildren("*"):
                self.work.charge("elements", 1)
                if child is not picked:
                    self.references.not_chosen.setdefault(child)
            if picked is not None:
                self.stack.append((picked, inside))
        else:
            self._push_children(element, inside)

    def _inside(self, tag: str, element: Any, attributes: Attributes, look: Look, around: Around) -> Around:
        """Give what the children of a group have around them."""
        title, note = words_of(element)
        name = name_of(attributes, title, self.illustrator)
        on_layer = self._is_layer(tag, element, attributes, around)
        level: Level | None = None  # what is read on the side has a box, and no words
        if not self.aside:
            level = self.looks.level(attributes, name, note, "layer" if on_layer else "group")
        words = Words(name, level, around.locked or attributes.get(_INSENSITIVE) == "true", on_layer)

        def made() -> Around:
            return self._made_inside(tag, element, attributes, look, words, around)

        return self.looks.inside(around, look, words, made) if tag == "g" else made()

    def _made_inside(
        self, tag: str, element: Any, attributes: Attributes, look: Look, words: Words, around: Around
    ) -> Around:
        """Make it: of the group's look, and of what it says of itself."""
        name, level, locked, on_layer = words
        declared, style, matrix = look.declared, look.style, around.matrix
        display = declared.get("display")
        hidden = around.hidden or display == "none" or (display == "contents" and tag in ("svg", "use", "symbol"))

        def own_box() -> Box | None:
            return self._box_of(tag, element, attributes, around, style)

        if look.moves and display != "contents":
            matrix = multiply(matrix, look.matrix(around, own_box))
        layer, groups, levels, clones = around.layer, around.groups, around.levels, around.clones
        if level is not None and tag == "use":
            clones = (level, *clones)
        elif level is not None:
            levels = (*levels, level)
        if on_layer:
            layer = name
            found = self.layers.setdefault(name, Layer(name, visible=not hidden, locked=locked))
            found.visible = found.visible or not hidden
        else:
            groups = (*groups, name)
        return around._replace(
            matrix=matrix,
            style=style,
            layer=layer,
            groups=groups,
            levels=levels,
            clones=clones,
            clip=self._clip(declared, around, matrix, lambda: self._box_now(own_box)),
            hidden=hidden,
            unseen=around.unseen or look.unseen,
            locked=locked,
            depth=around.depth + 1,
        )

    def _box_of(self, tag: str, element: Any, attributes: Attributes, around: Around, style: Style) -> Box | None:
        """Give the box of what a group draws, in its own coordinates.

        Raises:
            BoxFirst: its content is not read yet.
        """
        key = (element, around.viewport, around.style)
        if key not in self.boxes:
            if self.aside >= _MAX_ASIDE:
                fix = "write the transform without transform-box"
                self.notes.count("box-in-box", "error", "transform-box in transform-box is too deep", element, fix=fix)
                return None
            inside = around._replace(matrix=IDENTITY, style=style, depth=around.depth + 1)
            if tag == "use":
                raise BoxFirst(key, lambda: self._use(element, attributes, {}, inside))
            raise BoxFirst(key, lambda: self._push_children(element, inside))
        return self.boxes[key]

    def _box_now(self, ask: Callable[[], Box | None]) -> Box | None:
        """Give a box in the middle of a visit that cannot be begun again."""
        while True:
            try:
                return ask()
            except BoxFirst as first:
                key, reading = self._begin(first)
                try:
                    self._walk()
                    self.boxes[key] = box_of(self.drawing.paths)
                finally:
                    self._go_back(reading)

    def _begin(self, first: BoxFirst) -> tuple[Any, Reading]:
        """Begin to read what a box is of, or what the box of that needs first: its key, and what was put aside."""
        while True:
            try:
                return first.key, self._put_aside(first.push)
            except BoxFirst as deeper:
                first = deeper

    def _put_aside(self, push: Callable[[], None]) -> Reading:
        """Begin to read on the side what a function puts on the stack: nothing of it is drawn, said or a layer."""
        reading = Reading(self.stack, self.drawing, self.notes, self.layers)
        self.stack, self.drawing = [], Drawing(units="px", y_axis="down")
        self.notes, self.layers = Notes(self.source), {}
        self.aside += 1
        try:
            push()
        except (NumberError, BoxFirst):
            self._go_back(reading)
            raise
        return reading

    def _go_back(self, reading: Reading) -> None:
        """Go on with what was put aside."""
        self.aside -= 1
        self.stack, self.drawing, self.notes, self.layers = reading

    def _aside(self, push: Callable[[], None]) -> list[DrawnPath]:
        """Read on the side, at once, what a function puts on the stack."""
        reading = self._put_aside(push)
        try:
            self._walk()
            return self.drawing.paths
        finally:
            self._go_back(reading)

    def _shapes_aside(self, children: list[Any], matrix: Matrix, style: Style, viewport: Viewport) -> list[DrawnPath]:
        """Give what elements draw by themselves."""
        return self._aside(lambda: self.stack.extend((child, Around(matrix, style, viewport)) for child in children))

    def _clip(self, declared: Declared, around: Around, matrix: Matrix, own_box: Callable[[], Box | None]) -> Region:
        """Give what clips and masks on an element and around it leave of it."""
        if self.aside or not ("clip-path" in declared or "mask" in declared) or declared.get("display") == "contents":
            return around.clip
        own = self.clips.region(declared, around.viewport, own_box, self._shapes_aside)
        return own.through(matrix).within(around.clip)

    def _is_layer(self, tag: str, element: Any, attributes: Attributes, around: Around) -> bool:
        if tag != "g" or around.chain:
            return False
        if self.inkscape_layers:
            return attributes.get(_GROUPMODE) == "layer"
        named = attributes.get("id") or attributes.get("data-name")
        return bool(named) and element.getparent() is self.source.root

    def _use(self, element: Any, attributes: Attributes, declared: Declared, inside: Around) -> None:
        self.work.charge("references", _STEPS_OF_A_USE + len(inside.chain))
        target, why = self.references.target(element, inside.chain)
        if target is None:
            self.notes.add(
                "bad-use", "warning", why, element, fix="point href to an id of this file", layer=inside.layer
            )
            return
        lengths = Lengths(attributes, declared, inside.viewport, inside.style.font)
        x, y = lengths.get("x") or 0.0, lengths.get("y") or 0.0
        tag = target.tag[len(self.prefix) :]
        size = use_size(tag, lengths) if tag in ("symbol", "svg") else (None, None)
        left_out.note_lengths(element, lengths, inside.layer, inside.outline, self.notes)
        matrix = multiply(inside.matrix, translation(x, y))
        name = name_of(attributes, title_of(element), self.illustrator)
        label = inside.label or label_of(attributes)
        chain = (*inside.chain, target)
        inside = inside._replace(matrix=matrix, chain=chain, outline=name or inside.outline, label=label)
        if inside.depth > MAX_DEPTH:
            raise limit_error("groups in groups", str(MAX_DEPTH), file=self.source.file)
        if tag in ("symbol", "svg"):
            own = self.source.attributes(target)
            look = self.looks.of(target, own, inside)
            within = self._inside(tag, target, own, look, inside)
            self._nested(target, own, look.declared, within, size)
        elif tag in SHAPES or tag in _GROUPS or tag in left_out.NO_GEOMETRY:
            self.stack.append((target, inside))
        else:
            self.notes.count("bad-use", "info", f"<use> of a <{tag}> draws nothing", element)

    def _nested(
        self,
        element: Any,
        attributes: Attributes,
        declared: Declared,
        inside: Around,
        size: tuple[float | None, float | None] = (None, None),
    ) -> None:
        # browsers take the place and size of an inner svg from its attributes alone
        lengths = Lengths(attributes, {}, inside.viewport, inside.style.font)
        placed = nested_viewport(element, lengths, size)
        left_out.note_lengths(element, lengths, inside.layer, inside.outline, self.notes)
        left_out.note_viewport(element, (), self.notes)
        if placed is None:
            self.notes.count("nothing-drawn", "info", "<svg> or <symbol> without a size draws nothing", element)
            self._push_children(element, inside._replace(hidden=True))
            return
        matrix, viewport, box = placed
        page = inside.page
        if declared.get("overflow") not in ("visible", "auto"):
            page = Region(box).through(inside.matrix).within(page)
        matrix = multiply(inside.matrix, matrix)
        self._push_children(element, inside._replace(matrix=matrix, viewport=viewport, page=page))

    def _draw(self, tag: str, element: Any, attributes: Attributes, around: Around) -> None:
        look = self.looks.of(element, attributes, around)
        declared, style = look.declared, look.style
        hidden = around.hidden or declared.get("display") in ("none", "contents")
        if hidden and self.aside:  # what is not displayed counts for no box
            return
        lengths = Lengths(attributes, declared, around.viewport, style.font)
        shape = self.shapes.of(tag, element, attributes, lengths, bool(around.chain))
        matrix = around.matrix
        if look.moves:
            matrix = multiply(matrix, look.matrix(around, shape.box))
        title, note = words_of(element)
        own_name = name_of(attributes, title, self.illustrator)
        name = around.label or own_name or around.outline
        if shape.fault is not None or lengths.invalid or lengths.assumed or not shape.subpaths:
            left_out.note_shape(tag, element, shape, lengths, around.layer, name, matrix, self.notes)
        subpaths = [transformed(sub, matrix) for sub in shape.subpaths]
        if not subpaths:
            return
        self.segments += sum(map(len, subpaths))
        if self.segments > MAX_ELEMENTS:
            raise limit_error("segments of all paths", f"{MAX_ELEMENTS:,}", file=self.source.file)
        if not all(sub.within(MAX_COORDINATE) for sub in subpaths):
            if not self.aside:
                message = f"<{tag}> reaches beyond {MAX_COORDINATE:g} and is left out"
                self.notes.add("bad-coordinate", "error", message, element, layer=around.layer, name=name)
            return
        if self.aside:  # its box is all that is asked for, and of a clip what is inside
            rule: FillRule = "evenodd" if style.clip_rule == "evenodd" else "nonzero"
            self.drawing.paths.append(DrawnPath(subpaths, visible=style.visible and not hidden, fill_rule=rule))
            return
        levels = (*around.levels, self.looks.level(attributes, own_name, note, "object"), *around.clones)
        fill, stroke, width = None, None, None
        if not (around.unseen or look.unseen):
            fill = self.paints.word(style.fill) if style.fill_seen and tag != "line" else None
            if style.stroke is not None:
                stroke, width = self.paints.stroke(style, around.viewport, mean_scale(matrix), element)
        drawn = DrawnPath(
            subpaths=subpaths,
            name=name,
            layer=around.layer,
            groups=around.groups,
            visible=style.visible and not hidden,
            locked=around.locked or attributes.get(_INSENSITIVE) == "true",
            fill=fill,
            stroke=stroke,
            stroke_width=width,
            fill_rule="evenodd" if style.fill_rule == "evenodd" else "nonzero",
            line=self.source.line(element),
            tags=self.looks.tags(levels),
            title=title,
            levels=levels,
        )
        self.drawing.paths.append(drawn)
        if drawn.visible:
            clip = around.clip
            if "clip-path" in declared or "mask" in declared:
                clip = self._clip(declared, around, matrix, shape.box)
            left_out.note_unseen(tag, element, drawn, around.page, clip, self.notes)
