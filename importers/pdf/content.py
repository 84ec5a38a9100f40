"""The reader of page content: its operators to paths, forms within forms by a stack of its own."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass, field, replace
from typing import Any, NamedTuple

from importers.drawing import Layer
from importers.illustrator import findings as common
from importers.illustrator.text import MAX_STRING_BYTES, string_end
from importers.limits import MAX_DECODED_BYTES, MAX_DEPTH, MAX_ELEMENTS, MAX_OPERATORS, limit_error
from importers.pdf import findings
from importers.pdf.document import Document, get, is_stream, items, number, word
from importers.pdf.layers import OptionalContent
from importers.pdf.painting import Handler, Name, Operands, Painter, State
from importers.pdf.state import IDENTITY, Matrix

_BATCH = 20_000
_BYTES_PER_TOKEN = 16  # of strings and of images within the content, whose cost grows with their length
_MAX_OPERANDS = 4096
_FORM_COSTS = 4  # operators' worth of work to go into a form
_NEW_FORM_COSTS = 60  # and to unpack a form and look up what it says of itself, the first time
_MAX_IMAGE_HEAD = 2000  # bytes of an image's dictionary, before its data
# Blanks, numbers, and the operator if one follows: all may be missing, so it never fails and reads no number twice.
_OPERATOR = re.compile(
    rb"[\s\x00]{0,200}((?:[-+.\deE]{1,40}\s{1,20}){0,8})(?:([A-Za-z]{1,3}\d?\*?|['\"])(?=[\s\x00/(\[<%]|\Z))?"
)
_WHITE = re.compile(rb"[\s\x00]+")
_WORD = re.compile(rb"[^\s\x00()<>\[\]{}/%]+")
_NUMBER = re.compile(rb"[-+]?+(?:\d++\.?+\d*+|\.\d++)")
_LINE = re.compile(rb"[^\r\n]*")
_HEX = re.compile(rb"<[^<>]*>")
_NAME_ESCAPE = re.compile(rb"#([0-9A-Fa-f]{2})")
_IMAGE_DATA = re.compile(rb"\bID[\s]")
_IMAGE_END = re.compile(rb"[\s\x00]EI(?=[\s\x00]|\Z)")
_WITHOUT_GEOMETRY = b"j J M d ri i Tc Tw Tz TL Tf Tr Ts Td TD Tm T* BX EX MP DP d0 d1 << >> true false null".split()


class Marked(NamedTuple):
    """What a marked-content sequence is part of, those around it included.

    Attributes:
        layer: the innermost layer.
        hidden: one of the layers is not shown.
    """

    layer: Layer | None
    hidden: bool


_UNMARKED = Marked(None, False)


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
    states: dict[str, State] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class Form:
    """A form: content that may be drawn many times."""

    key: tuple[int, int]
    data: bytes
    resources: Any
    matrix: Matrix
    marked: bool  # it is optional content of its own
    layer: Layer | None
    grouped: bool  # it is drawn as a whole, with the opacity of fills at hand
    box: tuple[float, float, float, float] | None  # two corners, in its own units: nothing of it is seen outside
    spaces: dict[str, str] = field(default_factory=dict)  # of its resources, as far as they were asked for
    states: dict[str, State] = field(default_factory=dict)


class PageReader(Painter):
    """Reads one page's content: the loop over its operators, and forms within forms."""

    def __init__(self, document: Document, layers: OptionalContent) -> None:
        super().__init__(document.file)
        self.document = document
        self.layers = layers
        self._frames: list[Frame] = []
        self._marked: list[Marked] = []  # one for each marked-content sequence that is open
        self._text_shown = False
        self._bytes = 0
        self._forms: dict[tuple[int, int], Form] = {}
        self._drawn: dict[tuple[tuple[int, int], str], Form | str] = {}  # by where and under which name
        self._active: set[tuple[int, int]] = set()  # forms that are being read
        self._handlers: dict[bytes, Handler] = self._make_handlers()

    def _make_handlers(self) -> dict[bytes, Handler]:
        """List what each operator does."""
        handlers: dict[bytes, Handler] = dict.fromkeys(_WITHOUT_GEOMETRY, self._ignore)
        handlers.update(self.path_handlers())
        handlers.update({b"Do": self._draw, b"sh": self._shade})
        handlers.update({b"BMC": self._begin_marked, b"BDC": self._begin_marked, b"EMC": self._end_marked})
        handlers.update({b"BT": self._begin_text, b"ET": self._end_text})
        handlers.update(dict.fromkeys((b"Tj", b"TJ", b"'", b'"'), self._show_text))
        return handlers

    # --- the loop ---------------------------------------------------------------------------------------

    def read(self, contents: bytes, resources: Any, *, index: int = 0, move: tuple[float, float] = (0.0, 0.0)) -> None:
        """Read a page's content.

        Args:
            contents: its bytes.
            resources: what it names.
            index: which of the pages that are read it is.
            move: by how much it is moved.

        Raises:
            LimitError: more segments, forms or nesting than the limits allow.
        """
        self.begin_page(*move)
        self._marked = []
        self._update_layer()
        self._go_into(Frame(contents, resources, key=(-index, 0)))
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
                break  # it never fails
            numbers, operator = match.groups()
            position = match.end()
            if operator is None:
                if numbers:
                    stack += numbers.split()
                    self._operators += 2
                position = self._read_token(data, position, stack)
                if position >= stop:
                    break
                continue
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
            return white.end()
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
        begin = _IMAGE_DATA.search(data, position, position + _MAX_IMAGE_HEAD)
        if begin is None:  # looked at in vain, and looked at again by what follows
            self._operators += _MAX_IMAGE_HEAD // _BYTES_PER_TOKEN
        end = _IMAGE_END.search(data, begin.end() if begin else position)
        return end.end() if end else len(data)

    def _check_counts(self) -> None:
        """Raise LimitError when there is too much of something."""
        if self._count + len(self._segments) + len(self._subpaths) > MAX_ELEMENTS:
            raise limit_error("segments and paths of a drawing", f"{MAX_ELEMENTS:,}", file=self.file)
        if self._operators > MAX_OPERATORS:
            raise limit_error("operators of a drawing", f"{MAX_OPERATORS:,}", file=self.file)

    def _unknown(self, operator: bytes) -> None:
        what = operator[:24].decode("latin-1")
        layer = self._layer.name if self._layer else ""
        self.findings.add(common.UNKNOWN, None, what=what, apart=True, layer=layer)

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
            raise limit_error("marked contents in each other", str(MAX_DEPTH), file=self.file)
        around = self._marked[-1] if self._marked else _UNMARKED
        own = around if layer is None else Marked(layer, around.hidden or not layer.visible)
        self._marked.append(own)
        self._update_layer()

    def _end_marked(self, _operands: Operands) -> None:
        if len(self._marked) > self._frames[-1].marked_depth:
            self._marked.pop()
            self._update_layer()
        else:
            self._find(common.UNBALANCED, "EMC")

    def _update_layer(self) -> None:
        """Take the innermost layer, and whether one around it is hidden."""
        self._layer, self._hidden = self._marked[-1] if self._marked else _UNMARKED

    def _draw(self, operands: Operands) -> None:
        """``Do``: draw a form, or leave a picture out."""
        (name,) = operands[-1:]
        if not isinstance(name, Name):
            raise TypeError(name)
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
            self._operators += _NEW_FORM_COSTS
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
                word(get(get(stream, "/Group"), "/S")) == "/Transparency",
                _four(stream),
            )
        return self._forms[key]

    def _enter_form(self, form: Form) -> None:
        """Go on reading with a form's content."""
        if form.key in self._active:
            self._find(findings.RECURSIVE)
            return
        if len(self._frames) >= MAX_DEPTH:
            raise limit_error("forms in each other", str(MAX_DEPTH), file=self.file)
        self._operators += _FORM_COSTS
        self._keep([])
        if form.marked:
            self._push_marked(form.layer)
        if form.matrix != IDENTITY:
            self._transform([*form.matrix])
        if form.box is not None:
            self._clip_to_box(*form.box)
        if form.grouped:
            graphics = self._graphics
            unseen = graphics.unseen or graphics.fill_alpha <= 0.0
            self._graphics = replace(graphics, unseen=unseen, fill_alpha=1.0, stroke_alpha=1.0)
        self._active.add(form.key)
        self._go_into(
            Frame(
                form.data,
                form.resources,
                key=form.key,
                graphics_depth=len(self._kept),
                marked_depth=len(self._marked),
                marked=form.marked,
                spaces=form.spaces,
                states=form.states,
            )
        )

    def _go_into(self, frame: Frame) -> None:
        """Go on reading in a frame; its bytes count each time."""
        self._bytes += len(frame.data)
        if self._bytes > MAX_DECODED_BYTES:
            limit = "content of a page, forms as often as they are drawn"
            raise limit_error(limit, f"{MAX_DECODED_BYTES // 1_000_000} MB", file=self.file)
        self._frames.append(frame)
        self._look_at(frame)

    def _look_at(self, frame: Frame) -> None:
        """Let the painter look things up in a frame's resources."""
        self.resources, self.spaces, self.states = frame.resources, frame.spaces, frame.states
        self.graphics_depth = frame.graphics_depth

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
            self._look_at(self._frames[-1])

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


def _four(stream: Any) -> tuple[float, float, float, float] | None:
    """Give the box that a form says; None where it says none."""
    numbers = [number(part) for part in items(get(stream, "/BBox"))]
    four = [part for part in numbers if part is not None and math.isfinite(part)]
    return (four[0], four[1], four[2], four[3]) if len(four) == len(numbers) == 4 else None
