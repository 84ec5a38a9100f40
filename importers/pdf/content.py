"""The reader of page content: its operators to paths, forms within forms by a stack of its own."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import partial
from typing import Any

from importers import colours
from importers.drawing import DrawnPath, FillRule, Layer, Segment, Subpath
from importers.findings import Findings
from importers.illustrator import findings as common
from importers.illustrator.text import MAX_STRING_BYTES, string_end
from importers.limits import (
    MAX_COORDINATE,
    MAX_DEPTH,
    MAX_ELEMENTS,
    MAX_OPERATORS,
    MAX_REFERENCES,
    limit_error,
)
from importers.pdf import findings
from importers.pdf.document import Document, get, is_stream, items, number, word
from importers.pdf.layers import OptionalContent
from importers.pdf.state import IDENTITY, Graphics, Matrix, multiply

_BATCH = 20_000
_BYTES_PER_TOKEN = 16  # of strings, whose cost grows with their length
_MAX_OPERANDS = 4096
_OPERATOR = re.compile(
    rb"[\s\x00]{0,200}((?:[-+.\deE]{1,40}\s{1,20}){0,8})([A-Za-z]{1,3}\d?\*?|['\"])(?=[\s\x00/(\[<%]|\Z)"
)
_WHITE = re.compile(rb"[\s\x00]+")
_WORD = re.compile(rb"[^\s\x00()<>\[\]{}/%]+")
_NUMBER = re.compile(rb"[-+]?+(?:\d++\.?+\d*+|\.\d++)")
_LINE = re.compile(rb"[^\r\n]*")
_HEX = re.compile(rb"<[^<>]*>")
_NAME_ESCAPE = re.compile(rb"#([0-9A-Fa-f]{2})")
_IMAGE_DATA = re.compile(rb"\bID[\s]")
_IMAGE_END = re.compile(rb"[\s\x00]EI(?=[\s\x00]|\Z)")
_WITHOUT_GEOMETRY = b"j J M d ri i gs Tc Tw Tz TL Tf Tr Ts Td TD Tm T* BX EX MP DP d0 d1 << >> true false null".split()

Operands = list[Any]  # numbers as bytes, names as Name, texts as None
Handler = Callable[[Operands], None]


@dataclass(frozen=True, slots=True)
class Name:
    """A name operand with its slash."""

    text: str


@dataclass(slots=True)
class Frame:
    """A content stream that is being read: the page, or a form on it."""

    data: bytes
    resources: Any
    position: int = 0
    key: tuple[int, int] = (0, 0)
    graphics_depth: int = 0
    marked_depth: int = 0
    marked: bool = False  # the form is optional content of its own
    spaces: dict[str, str] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class Form:
    """A form: content that may be drawn many times."""

    key: tuple[int, int]
    data: bytes
    resources: Any
    matrix: Matrix
    marked: bool  # it is optional content of its own
    layer: Layer | None


class PageReader:
    """Reads one page's content.

    Attributes:
        paths: in the order of drawing.
        findings: what was left out or could not be read.
    """

    def __init__(self, document: Document, layers: OptionalContent) -> None:
        self.document = document
        self.layers = layers
        self.paths: list[DrawnPath] = []
        self.findings = Findings()
        self._graphics = Graphics()
        self._kept: list[Graphics] = []
        self._frames: list[Frame] = []
        self._marked: list[Layer | None] = []  # one for each marked-content sequence that is open
        self._layer: Layer | None = None
        self._hidden = False
        self._segments: list[Segment] = []
        self._subpaths: list[Subpath] = []
        self._reopen: Segment | None = None
        self._spoiled = False
        self._clip = False
        self._text_shown = False
        self._count = 0
        self._operators = 0
        self._references = 0
        self._forms: dict[tuple[int, int], Form] = {}
        self._drawn: dict[tuple[tuple[int, int], str], Form | str] = {}  # by where and under which name
        self._active: set[tuple[int, int]] = set()  # forms that are being read
        self._handlers: dict[bytes, Handler] = self._make_handlers()

    def _make_handlers(self) -> dict[bytes, Handler]:
        """List what each operator does."""
        handlers: dict[bytes, Handler] = dict.fromkeys(_WITHOUT_GEOMETRY, self._ignore)
        handlers.update({b"m": self._move, b"l": self._line, b"c": self._curve, b"v": self._curve_from_point})
        handlers.update({b"y": self._curve_to_point, b"h": self._close, b"re": self._rectangle})
        for name in ("f", "F", "f*", "B", "B*", "b", "b*", "S", "s", "n"):
            handlers[name.encode()] = partial(self._paint, name)
        handlers.update({b"W": self._set_clip, b"W*": self._set_clip, b"q": self._keep, b"Q": self._restore})
        handlers.update({b"cm": self._transform, b"w": self._set_width, b"Do": self._draw, b"sh": self._shade})
        for name, attribute in (("g", "fill"), ("rg", "fill"), ("k", "fill")):
            handlers[name.encode()] = partial(self._set_device_colour, attribute)
            handlers[name.upper().encode()] = partial(self._set_device_colour, "stroke")
        for name in ("sc", "scn"):
            handlers[name.encode()] = partial(self._set_colour, "fill")
            handlers[name.upper().encode()] = partial(self._set_colour, "stroke")
        handlers.update({b"cs": partial(self._set_space, "fill"), b"CS": partial(self._set_space, "stroke")})
        handlers.update({b"BMC": self._begin_marked, b"BDC": self._begin_marked, b"EMC": self._end_marked})
        handlers.update({b"BT": self._begin_text, b"ET": self._end_text})
        handlers.update(dict.fromkeys((b"Tj", b"TJ", b"'", b'"'), self._show_text))
        return handlers

    # --- the loop ---------------------------------------------------------------------------------------

    def read(self, contents: bytes, resources: Any) -> None:
        """Read a page's content.

        Raises:
            LimitError: more segments, forms or nesting than the limits allow.
        """
        self._frames.append(Frame(contents, resources))
        stack: Operands = []
        while self._frames:
            frame = self._frames[-1]
            if frame.position >= len(frame.data):
                self._leave_form()
                stack.clear()
                continue
            self._read_batch(frame, stack)
            self._check_counts()

    def _read_batch(self, frame: Frame, stack: Operands) -> None:
        """Read some thousand tokens, or up to where a form begins."""
        data = frame.data
        stop = len(data)
        match_operator = _OPERATOR.match
        handlers = self._handlers
        position = frame.position
        depth = len(self._frames)
        done = 0
        while done < _BATCH:
            done += 1
            match = match_operator(data, position, stop)
            if match is None:
                position = self._read_token(data, position, stack)
                if position >= stop:
                    break
                continue
            numbers, operator = match.groups()
            position = match.end()
            if operator == b"BI":
                position = self._skip_image(data, position)
                stack.clear()
                continue
            operands: Operands = stack + numbers.split()
            stack.clear()
            handler = handlers.get(operator)
            if handler is None:
                self._unknown(operator)
                continue
            try:
                handler(operands)
            except (ValueError, TypeError):
                self._failed(operator, operands)
            if len(self._frames) != depth:
                break
        frame.position = position
        self._operators += done

    def _read_token(self, data: bytes, position: int, stack: Operands) -> int:
        """Read what is not just numbers and a short operator; give the position after it."""
        white = _WHITE.match(data, position)
        if white:
            position = white.end()
            if position == len(data):
                return position
        self._operators += 1  # read one by one, which costs twice as much
        if len(stack) > _MAX_OPERANDS:
            stack.clear()
        byte = data[position : position + 1]
        if byte == b"%":
            line = _LINE.match(data, position)
            return line.end() if line else len(data)
        if byte == b"(":
            stack.append(None)
            end = string_end(data, position, len(data))
            end = end if end > 0 else position + MAX_STRING_BYTES
            self._operators += (end - position) // _BYTES_PER_TOKEN
            return end
        if byte == b"/":
            name = _WORD.match(data, position + 1)
            text = _NAME_ESCAPE.sub(lambda code: bytes([int(code.group(1), 16)]), name.group()[:200] if name else b"")
            stack.append(Name("/" + text.decode("utf-8", "replace")))
            return name.end() if name else position + 1
        if byte == b"<":
            text_end = _HEX.match(data, position)
            stack.append(None)
            return text_end.end() if text_end else position + 2
        found = _WORD.match(data, position)
        if not found:
            return position + 1
        if _NUMBER.fullmatch(found.group()):
            stack.append(found.group())
        else:
            stack.clear()
            self._unknown(found.group())
        return found.end()

    def _skip_image(self, data: bytes, position: int) -> int:
        """Skip an image within the content; give the position after it."""
        self._find(common.RASTER)
        begin = _IMAGE_DATA.search(data, position, position + 2000)
        end = _IMAGE_END.search(data, begin.end() if begin else position)
        return end.end() if end else len(data)

    def _check_counts(self) -> None:
        """Raise LimitError when there is too much of something."""
        if self._count + len(self._segments) + len(self._subpaths) > MAX_ELEMENTS:
            raise limit_error("segments and paths of a drawing", f"{MAX_ELEMENTS:,}", file=self.document.file)
        if self._operators > MAX_OPERATORS:
            raise limit_error("operators of a drawing", f"{MAX_OPERATORS:,}", file=self.document.file)

    def _find(self, kind: Any, what: str = "") -> None:
        """Note a finding at the place where the content draws."""
        point = self._segments[-1][-2:] if self._segments else None
        self.findings.add(kind, None, what=what, layer=self._layer.name if self._layer else "", at=point)

    def _unknown(self, operator: bytes) -> None:
        self._find(common.UNKNOWN, operator[:24].decode("latin-1"))

    def _failed(self, operator: bytes, operands: Operands) -> None:
        """Deal with operands that an operator could not take; PostScript-like, the last numbers would do."""
        what = operator.decode("latin-1")
        needed = {b"m": 2, b"l": 2, b"v": 4, b"y": 4, b"c": 6, b"re": 4, b"cm": 6}.get(operator)
        if needed is None:
            self._find(common.ATTRIBUTE, what)
            return
        if len(operands) > needed:
            try:
                self._handlers[operator](operands[-needed:])
            except (ValueError, TypeError):
                pass
            else:
                return
        self._find(common.OPERANDS, what)

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
        if not (max(numbers) <= MAX_COORDINATE and min(numbers) >= -MAX_COORDINATE):
            self._spoiled = True
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

    def _set_clip(self, _operands: Operands) -> None:
        self._clip = True

    def _paint(self, operator: str, _operands: Operands) -> None:
        """Paint the path and forget it; ``n`` paints nothing and is how clipping paths end."""
        kind = operator.rstrip("*")
        closing = kind in ("s", "b")
        if self._segments and (closing or len(self._segments) > 1 or not self._subpaths):
            self._subpaths.append(Subpath(self._segments, closed=closing))
        subpaths, spoiled, clip = self._subpaths, self._spoiled, self._clip
        self._segments, self._subpaths, self._reopen = [], [], None
        self._clip = self._spoiled = False
        if not subpaths:
            return
        if spoiled:
            self._find(common.COORDINATE)
            return
        rule: FillRule = "evenodd" if operator.endswith("*") else "nonzero"
        self._add_path(subpaths, kind, rule, clip=clip and kind == "n")

    def _add_path(self, subpaths: list[Subpath], kind: str, rule: FillRule, *, clip: bool) -> None:
        """Put a path into the drawing with the marks that are in force."""
        graphics, layer = self._graphics, self._layer
        strokes = kind in "SsBb"
        self.paths.append(
            DrawnPath(
                subpaths,
                layer=layer.name if layer else "",
                visible=not self._hidden,
                locked=layer.locked if layer else False,
                clip=clip,
                fill=graphics.fill if kind in "fFBb" else None,
                stroke=graphics.stroke if strokes else None,
                stroke_width=graphics.width_on_page() if strokes else None,
                fill_rule=rule,
            )
        )
        self._count += 1 + sum(len(subpath.segments) + 1 for subpath in subpaths)

    # --- state ------------------------------------------------------------------------------------------

    def _keep(self, _operands: Operands) -> None:
        if len(self._kept) >= MAX_DEPTH:
            raise limit_error("graphics states in each other (q)", str(MAX_DEPTH), file=self.document.file)
        self._kept.append(self._graphics)

    def _restore(self, _operands: Operands) -> None:
        if len(self._kept) > self._frames[-1].graphics_depth:
            self._graphics = self._kept.pop()
        else:
            self._find(common.UNBALANCED, "Q")

    def _transform(self, operands: Operands) -> None:
        a, b, c, d, e, f = map(float, operands)
        self._graphics = replace(self._graphics, matrix=multiply((a, b, c, d, e, f), self._graphics.matrix))

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
        frame = self._frames[-1]
        if name.text not in frame.spaces:
            found = get(get(frame.resources, "/ColorSpace"), name.text)
            kind = word(found) or word(next(items(found), None))
            frame.spaces[name.text] = kind or name.text
        space = frame.spaces[name.text]
        colour = "pattern" if space == "/Pattern" else "#000000"
        self._graphics = _repaint(self._graphics, attribute, colour, space)

    def _set_colour(self, attribute: str, operands: Operands) -> None:
        """``sc`` and ``scn``: as many numbers as the colour space has, or a pattern's name."""
        graphics = self._graphics
        space = graphics.fill_space if attribute == "fill" else graphics.stroke_space
        if operands and isinstance(operands[-1], Name):
            colour: str | None = "pattern"
        elif space in ("/Separation", "/DeviceN", "/Indexed"):
            # An ink whose own colour a program would compute: how much of it there is must do.
            colour = colours.gray(1.0 - min(max(map(float, operands), default=0.0), 1.0))
        else:
            colour = colours.from_components([*map(float, operands)])
        if colour is None:
            raise ValueError(operands)
        self._graphics = _repaint(graphics, attribute, colour, space)

    # --- optional content, forms, what is no path -------------------------------------------------------

    def _begin_marked(self, operands: Operands) -> None:
        """``BDC`` with ``/OC`` begins optional content; any other marked content says nothing of layers."""
        layer = None
        names = [operand.text for operand in operands if isinstance(operand, Name)]
        if len(names) >= 2 and names[0] == "/OC":
            properties = get(self._frames[-1].resources, "/Properties")
            layer = self.layers.layer(get(properties, names[1]))
        self._push_marked(layer)

    def _push_marked(self, layer: Layer | None) -> None:
        if len(self._marked) >= MAX_DEPTH:
            raise limit_error("marked contents in each other", str(MAX_DEPTH), file=self.document.file)
        self._marked.append(layer)
        self._update_layer()

    def _end_marked(self, _operands: Operands) -> None:
        if len(self._marked) > self._frames[-1].marked_depth:
            self._marked.pop()
            self._update_layer()
        else:
            self._find(common.UNBALANCED, "EMC")

    def _update_layer(self) -> None:
        """Work out the innermost layer, and whether one around it is hidden."""
        layers = [layer for layer in self._marked if layer is not None]
        self._layer = layers[-1] if layers else None
        self._hidden = not all(layer.visible for layer in layers)

    def _draw(self, operands: Operands) -> None:
        """``Do``: draw a form, or leave a picture out."""
        (name,) = operands[-1:]
        if not isinstance(name, Name):
            raise TypeError(name)
        self._references += 1
        if self._references > MAX_REFERENCES:
            raise limit_error("forms drawn on a page", f"{MAX_REFERENCES:,}", file=self.document.file)
        here = self._frames[-1]
        known = (here.key, name.text)
        if known not in self._drawn:
            found = get(get(here.resources, "/XObject"), name.text)
            kind = word(get(found, "/Subtype")) if is_stream(found) else ""
            self._drawn[known] = self._form(found, here) if kind == "/Form" else kind
        form = self._drawn[known]
        if isinstance(form, Form):
            self._enter_form(form)
        elif form == "/Image":
            self._find(common.RASTER)
        else:
            self._find(findings.MISSING, name.text)

    def _form(self, stream: Any, here: Frame) -> Form:
        """Read what a form says of itself, once."""
        key = stream.objgen
        if key not in self._forms:
            data, damage = self.document.decode(stream)
            if damage:
                self._find(findings.STREAM, damage)
            resources = get(stream, "/Resources")
            content = get(stream, "/OC")
            layer = None if content is None else self.layers.layer(content)
            numbers = [number(part) for part in items(get(stream, "/Matrix"))]
            matrix = [part for part in numbers if part is not None]
            self._forms[key] = Form(
                key,
                data,
                here.resources if resources is None else resources,
                (matrix[0], matrix[1], matrix[2], matrix[3], matrix[4], matrix[5]) if len(matrix) == 6 else IDENTITY,
                content is not None,
                layer,
            )
        return self._forms[key]

    def _enter_form(self, form: Form) -> None:
        """Go on reading with a form's content."""
        if form.key in self._active:
            self._find(findings.RECURSIVE)
            return
        if len(self._frames) >= MAX_DEPTH:
            raise limit_error("forms in each other", str(MAX_DEPTH), file=self.document.file)
        self._keep([])
        if form.marked:
            self._push_marked(form.layer)
        if form.matrix != IDENTITY:
            self._transform([*form.matrix])
        self._active.add(form.key)
        self._frames.append(
            Frame(
                form.data,
                form.resources,
                key=form.key,
                graphics_depth=len(self._kept),
                marked_depth=len(self._marked),
                marked=form.marked,
            )
        )

    def _leave_form(self) -> None:
        """Go back to where the form was drawn."""
        frame = self._frames.pop()
        self._active.discard(frame.key)
        if self._segments or self._subpaths:
            self._paint("n", [])
        if self._frames:
            self._graphics = self._kept[frame.graphics_depth - 1]
            del self._kept[frame.graphics_depth - 1 :]
            del self._marked[frame.marked_depth - frame.marked :]
            self._update_layer()

    def _shade(self, _operands: Operands) -> None:
        self._find(findings.SHADING)

    def _begin_text(self, _operands: Operands) -> None:
        self._text_shown = False

    def _show_text(self, _operands: Operands) -> None:
        self._text_shown = True

    def _end_text(self, _operands: Operands) -> None:
        if self._text_shown:
            self._find(common.TEXT)
        self._text_shown = False


def _repaint(graphics: Graphics, attribute: str, colour: str, space: str) -> Graphics:
    """Give the state with another colour."""
    if attribute == "fill":
        return replace(graphics, fill=colour, fill_space=space)
    return replace(graphics, stroke=colour, stroke_space=space)
