"""The text of an SVG file: bytes to text, entities that hold elements, the XML tree, and places in the text."""

from __future__ import annotations

import bisect
import codecs
import re
import xml.parsers.expat
from dataclasses import dataclass, field
from typing import Any

from lxml import etree

from importers.errors import DrawingError
from importers.excerpts import excerpt
from importers.limits import MAX_DEPTH, MAX_ELEMENTS, MAX_ENTITIES, MAX_ENTITY_BYTES, MAX_INPUT_BYTES, limit_error

SVG_NS = "http://www.w3.org/2000/svg"

_DECLARED = re.compile(rb"""<\?xml[^>]{0,200}?encoding\s*=\s*["']([A-Za-z0-9._-]{1,40})["']""")
# Start tags of a well-formed text: no "<" is in an attribute's value, so only these can hide one.
_TAGS = re.compile(
    r"<!--.*?-->|<!\[CDATA\[.*?\]\]>|<\?.*?\?>|<!DOCTYPE[^\[>]*(?:\[.*?\]\s*)?>|<(?=[^\s!?/])", re.DOTALL
)
_ATTRIBUTE = re.compile(r"""([^\s=<>/"']+)\s*=\s*("([^"]*)"|'([^']*)')""")
_REFERENCE = re.compile(r"&(#x[0-9a-fA-F]+|#[0-9]+|[^\s;&]+);")
_LONGER = re.compile(_REFERENCE.pattern + r"|\r\n")  # what is one character once it is read
_PREDEFINED = frozenset(("amp", "lt", "gt", "quot", "apos"))
# Python's codecs that no file is written in; some cost the square of the size, some fail whatever is asked
_NOT_OF_FILES = frozenset(
    ("idna", "punycode", "undefined", "unicode-escape", "raw-unicode-escape", "utf-7", "mbcs", "oem")
)
_FEW = 64  # attributes of an element, as people and programs write them
_HUGE = 9_000_000  # libxml2 takes a text of 10 MB only when told that the document is huge


def decode(data: bytes, file: str) -> tuple[str, str]:
    """Decode a file as XML does: byte order mark, else the declaration, else UTF-8 (or UTF-16 by its zeros).

    Returns:
        The text, and what is wrong with its bytes, ``""`` when nothing is. Wrong ones become replacement
        characters: they are mostly in names, and the outlines around them are right.
    """
    for mark, name in (
        (codecs.BOM_UTF8, "utf-8"),
        (codecs.BOM_UTF16_LE, "utf-16-le"),
        (codecs.BOM_UTF16_BE, "utf-16-be"),
    ):
        if data.startswith(mark):
            return _decode(data[len(mark) :], name, file)
    if data[:2] == b"<\x00":
        return _decode(data, "utf-16-le", file)
    if data[:2] == b"\x00<":
        return _decode(data, "utf-16-be", file)
    declared = _DECLARED.match(data.lstrip())
    name = declared[1].decode("ascii").lower() if declared else "utf-8"
    if name.startswith(("utf-16", "utf-32", "ucs-")):  # it was read as single bytes so far, so it is not that
        name = "utf-8"
    return _decode(data, name, file)


def _decode(data: bytes, name: str, file: str) -> tuple[str, str]:
    fix = "save the file as UTF-8"
    try:
        text = codecs.lookup(name)
        if not text._is_text_encoding or text.name in _NOT_OF_FILES:
            raise LookupError(name)
        return data.decode(name), ""
    except LookupError:
        raise DrawingError(f"the encoding {name!r} is not known", code="bad-encoding", fix=fix, file=file) from None
    except UnicodeError as error:
        line = data[: getattr(error, "start", 0)].count(b"\n") + 1
        return data.decode(name, "replace"), f"there are bytes that are not {name}, the first in line {line}"


def attributes_of(element: Any) -> dict[str, str]:
    """Give an element's attributes as a dict, in a time that is linear in their number (lxml's own is not)."""
    if len(element.attrib) <= _FEW:
        return dict(element.items())
    return {str(value.attrname): str(value) for value in element.xpath("@*")}


@dataclass(slots=True)
class Source:
    """A parsed file and where everything in it stands.

    Attributes:
        text: the whole file, decoded.
        root: its outermost element.
        file: its name, for errors.
    """

    text: str
    root: Any
    file: str
    _starts: dict[Any, int] | None = field(default=None)
    _lines: list[int] = field(default_factory=list)

    def line(self, element: Any) -> int | None:
        """Give the line on which the element's start tag begins, from 1."""
        start = self._start(element)
        return self._line_at(start) if start is not None else element.sourceline

    def place(self, element: Any, attribute: str = "", offset: int = 0) -> tuple[int | None, int | None, str]:
        """Give line, column and excerpt of an element, or of a character in the value of one of its attributes.

        Args:
            element: where.
            attribute: name as written, or ``""`` for the element itself.
            offset: index into the attribute's value as the parser gave it.
        """
        start = self._start(element)
        if start is None:
            return element.sourceline, None, ""
        if attribute:
            start = self._value_place(start, attribute, offset)
        line = self._line_at(start)
        begin = self._lines[line - 1]
        end = self.text.find("\n", begin)
        whole = self.text[begin : end if end >= 0 else len(self.text)].rstrip("\r")
        return line, start - begin + 1, excerpt(whole, start - begin + 1)

    def _start(self, element: Any) -> int | None:
        if self._starts is None:
            self._starts = self._find_starts()
        return self._starts.get(element)

    def _find_starts(self) -> dict[Any, int]:
        self._lines = [0, *(match.end() for match in re.finditer("\n", self.text))]
        offsets = [match.start() for match in _TAGS.finditer(self.text) if match.end() == match.start() + 1]
        elements = list(self.root.iter("*"))
        return dict(zip(elements, offsets, strict=True)) if len(elements) == len(offsets) else {}

    def _line_at(self, position: int) -> int:
        return bisect.bisect_right(self._lines, position)

    def _value_place(self, start: int, attribute: str, offset: int) -> int:
        """Find a character of an attribute's value in the file: references there are longer than what they mean."""
        position = start + 1
        while match := _ATTRIBUTE.search(self.text, position):
            if match[1] == attribute or match[1].rpartition(":")[2] == attribute:
                return _raw_place(self.text, match.start(2) + 1, match.end(2) - 1, offset)
            position = match.end()
        return start


def _raw_place(text: str, start: int, end: int, offset: int) -> int:
    """Find the character ``offset`` of a value whose raw text is from start to end.

    References and CR LF are one character of the value; one to an entity of the file is some number of them,
    so what is behind such a one is told to be at its place.
    """
    place = start
    for match in _LONGER.finditer(text, start, end):
        if offset < match.start() - place:
            break
        offset -= match.start() - place
        if match[1] and match[1][0] != "#" and match[1] not in _PREDEFINED:
            return match.start()
        if offset == 0:
            return match.start()
        place, offset = match.end(), offset - 1
    return min(place + offset, end)


def parse(text: str, file: str) -> Source:
    """Parse the text of a file into a tree, within the limits.

    Raises:
        DrawingError: it is not well-formed, or it names something outside of itself.
        LimitError: too many elements, too deep, too many or too long entities.
    """
    entities = _entities(text, file) if "<!DOCTYPE" in text else {}
    markup = {name: value for name, value in entities.items() if "<" in value}
    if markup:
        text = _put_in(text, markup, file)
    if text.count("<") - text.count("</") > MAX_ELEMENTS:
        raise limit_error("elements of a file", f"{MAX_ELEMENTS:,}", file=file)
    data = text.encode("utf-8", "surrogatepass")
    parser = etree.XMLParser(
        encoding="utf-8",
        resolve_entities=False,
        no_network=True,
        load_dtd=False,
        huge_tree=len(data) > _HUGE,
    )
    try:
        root = etree.fromstring(data, parser)
    except etree.XMLSyntaxError as error:
        raise _syntax_error(error, text, file) from None
    return Source(text, root, file)


def _syntax_error(error: Any, text: str, file: str) -> Exception:
    line, column = error.position
    words = str(error.msg or "the file ends too early").split(", line")[0]
    if "Excessive depth" in words:
        return limit_error("groups in groups", str(MAX_DEPTH), file=file, line=line)
    return DrawingError(
        f"not well-formed XML: {words}",
        code="bad-xml",
        fix="repair the file at this place, or save it again from its program",
        file=file,
        line=line or None,
        column=column or None,
    )


class _SeenError(Exception):  # the document type is behind us
    pass


def _entities(text: str, file: str) -> dict[str, str]:
    """Give the internal entities of the document type; refuse what reaches outside or nests."""
    found: dict[str, str] = {}

    def declare(
        name: str, parameter: bool, value: str | None, base: Any, system: str | None, public: str | None, notation: Any
    ) -> None:
        if value is None:
            raise DrawingError(
                f"the entity {name!r} is outside of the file ({system or public}), and nothing outside is read",
                code="external-entity",
                fix="put its text into the file, or delete the declaration",
                file=file,
                line=parser.CurrentLineNumber,
            )
        if len(found) >= MAX_ENTITIES:
            raise limit_error("entities of a document type", str(MAX_ENTITIES), file=file)
        if len(value.encode("utf-8", "surrogatepass")) > MAX_ENTITY_BYTES:
            raise limit_error("bytes of an entity", f"{MAX_ENTITY_BYTES:,}", file=file, line=parser.CurrentLineNumber)
        if _nests(value) or parameter:
            raise limit_error("entities in entities", "no level", file=file, line=parser.CurrentLineNumber)
        found[name] = value

    def stop(*_: Any) -> None:
        raise _SeenError

    parser = xml.parsers.expat.ParserCreate("utf-8")
    parser.EntityDeclHandler = declare
    parser.StartElementHandler = stop
    try:
        parser.Parse(re.sub(r"""^\s*<\?xml[^>]*\?>""", "", text, count=1).encode("utf-8", "surrogatepass"), True)
    except _SeenError:
        pass
    except xml.parsers.expat.ExpatError:
        pass  # libxml2 reads the same text and says where it is wrong
    return found


def _nests(value: str) -> bool:
    return any(m[1][0] != "#" and m[1] not in _PREDEFINED for m in _REFERENCE.finditer(value))


def _put_in(text: str, markup: dict[str, str], file: str) -> str:
    """Replace references to entities that hold elements by their text, as a parser would include it."""
    head = re.search(r"<!DOCTYPE[^\[>]*\[.*?\]\s*>", text, re.DOTALL)
    start = head.end() if head else 0
    size = len(text)
    pattern = re.compile(r"<!--.*?-->|<!\[CDATA\[.*?\]\]>|&(" + "|".join(map(re.escape, markup)) + r");", re.DOTALL)

    def fill(match: re.Match[str]) -> str:
        nonlocal size
        if match[1] is None:
            return match[0]
        size += len(markup[match[1]])
        if size > MAX_INPUT_BYTES:
            raise limit_error("size of the input, entities put in", "64 MiB", file=file)
        return markup[match[1]]

    return text[:start] + pattern.sub(fill, text[start:])
