"""The text of an SVG file: bytes to text, the XML tree, and places in the text."""

from __future__ import annotations

import bisect
import codecs
import re
from dataclasses import dataclass, field
from typing import Any

from lxml import etree

from importers.errors import DrawingError
from importers.excerpts import WIDTH, excerpt
from importers.limits import LETTERS_OF_A_STEP, MAX_DEPTH, MAX_ELEMENTS, MAX_ENTITIES, Work, limit_error
from importers.problems import Problem
from importers.svg.entities import (
    PREDEFINED,
    REFERENCE,
    declared_entities,
    find_doctype,
    named_references,
    put_in,
)
from importers.svg.prefixes import MOST_PREFIXES, declare, missing_prefix, undeclared

_DECLARED = re.compile(rb"""<\?xml[^>]{0,200}?encoding\s*+=\s*+["']([A-Za-z0-9._-]{1,40})["']""")
# Start tags of a well-formed text: no "<" is in an attribute's value, so only these can hide one.
_TAGS = re.compile(r"<!--.*?-->|<!\[CDATA\[.*?\]\]>|<\?.*?\?>|<(?=[^\s!?/])", re.DOTALL)
# An attribute of a start tag, or what ends the tag
_ATTRIBUTE = re.compile(r"""[^\s=<>/"']++|"[^"]*+"|'[^']*+'|>""")
_START_TAG = re.compile(r"""<(?:[^>"']++|"[^"]*+"|'[^']*+')*+>""")
_LONGER = re.compile(REFERENCE.pattern + r"|\r\n")  # what is one character once it is read
# Python's codecs that no file is written in; some cost the square of the size, some fail whatever is asked
_NOT_OF_FILES = frozenset(
    ("idna", "punycode", "undefined", "unicode-escape", "raw-unicode-escape", "utf-7", "mbcs", "oem")
)
_FEW = 64  # attributes of an element, as people and programs write them
STEPS_OF_A_FUNCTION = 30  # such as rgb() or calc(), in the value of an attribute
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


@dataclass(slots=True, eq=False)
class Source:
    """A parsed file and where everything in it stands.

    Attributes:
        text: the whole file, decoded.
        root: its outermost element.
        file: its name, for errors.
        work: the budget of work that reading it draws on.
        problems: what is wrong with the text itself.
    """

    text: str
    root: Any
    file: str
    work: Work
    problems: list[Problem] = field(default_factory=list)
    _starts: dict[Any, int] | None = field(default=None)
    _lines: list[int] = field(default_factory=list)
    _weighed: set[str] = field(default_factory=set)

    def attributes(self, element: Any) -> dict[str, str]:
        """Give an element's attributes as a dict, in a time that is linear in their number (lxml's own is not)."""
        many = len(element.attrib) > _FEW
        found = {str(value.attrname): str(value) for value in element.xpath("@*")} if many else dict(element.items())
        self.work.charge("attributes", len(found) * (2 if many else 1) + sum(map(len, found.values())) // 256)
        for name, value in found.items():
            if ("(" in value and name != "transform") or name == "transform-origin":
                self._weigh(value)
        return found

    def _weigh(self, value: str) -> None:
        """Charge for a value that only a parser of CSS reads, when it is first met: those are kept."""
        if value not in self._weighed:
            self._weighed.add(value)
            self.work.charge("values of CSS", STEPS_OF_A_FUNCTION * (1 + value.count("(")))

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
        return self.spot(start)

    def place_within(self, element: Any, line: int, column: int, words: str) -> tuple[int | None, int | None, str]:
        """Give the place of words that are said to stand in the text of an element; its own where they do not.

        Args:
            element: whose text begins behind its start tag.
            line: in that text, from 1.
            column: in that line, from 1.
            words: as written.
        """
        start = self._start(element)
        tag = _START_TAG.match(self.text, start) if start is not None else None
        number = self._line_at(tag.end()) + line - 1 if tag else 0
        if tag is None or number > len(self._lines):
            return self.place(element)
        position = (tag.end() if line == 1 else self._lines[number - 1]) + column - 1
        for unread in ("", "<![CDATA["):  # is no part of the text
            if self.text.startswith(words, position + len(unread)):
                return self.spot(position + len(unread))
        return self.place(element)

    def spot(self, position: int) -> tuple[int, int, str]:
        """Give line, column and excerpt of a position in the text."""
        line = self._line_at(position)
        begin = self._lines[line - 1]
        end = self._lines[line] - 1 if line < len(self._lines) else len(self.text)
        first, last = max(begin, position - WIDTH), min(end, position + WIDTH)  # a line may be the whole file
        return line, position - begin + 1, excerpt(self.text[first:last].rstrip("\r"), position - first + 1)

    def _start(self, element: Any) -> int | None:
        if self._starts is None:
            self._starts = self._find_starts()
        return self._starts.get(element)

    def _find_starts(self) -> dict[Any, int]:
        doctype = find_doctype(self.text)
        offsets = [
            match.start()
            for match in _TAGS.finditer(self.text, doctype.stop if doctype else 0)
            if match.end() == match.start() + 1
        ]
        elements = list(self.root.iter("*"))
        return dict(zip(elements, offsets, strict=True)) if len(elements) == len(offsets) else {}

    def _line_at(self, position: int) -> int:
        if not self._lines:
            self._lines = [0, *(match.end() for match in re.finditer("\n", self.text))]
        return bisect.bisect_right(self._lines, position)

    def _value_place(self, start: int, attribute: str, offset: int) -> int:
        """Find a character of an attribute's value in the file: references there are longer than what they mean."""
        name = ""
        for match in _ATTRIBUTE.finditer(self.text, start + 1):
            self.work.charge("places", 1 + len(match[0]) // LETTERS_OF_A_STEP)
            if match[0] == ">":
                break
            if match[0][0] not in "\"'":
                name = match[0]
            elif attribute in (name, name.rpartition(":")[2]):
                return _raw_place(self.text, match.start() + 1, match.end() - 1, offset)
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
        if match[1] and match[1][0] != "#" and match[1] not in PREDEFINED:
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
    doctype = find_doctype(text)
    entities = declared_entities(text, doctype, file) if doctype else {}
    markup = {name: value for name, value in entities.items() if "<" in value}
    if doctype and markup:
        text = put_in(text, doctype.stop, markup, file)
    elements = text.count("<") - text.count("</")
    if elements > MAX_ELEMENTS:
        raise limit_error("elements of a file", f"{MAX_ELEMENTS:,}", file=file)
    root, prefixes = _parse(text, doctype.stop if doctype else 0, file)
    source = Source(text, root, file, Work(file, len(text), elements))
    source.problems += prefixes
    if doctype:
        source.problems += _unknown_entities(source, doctype.stop, entities)
    return source


def _parse(text: str, start: int, file: str) -> tuple[Any, list[Problem]]:
    """Parse the text; a prefix that is not declared is declared on the outermost element, and said.

    Args:
        text: of the file, entities that hold elements put in.
        start: behind the document type.
        file: its name.
    """
    found: dict[str, Problem] = {}
    data = text.encode("utf-8", "surrogatepass")
    while True:
        parser = etree.XMLParser(
            encoding="utf-8",
            resolve_entities=False,
            no_network=True,
            load_dtd=False,
            huge_tree=len(data) > _HUGE,
        )
        try:
            return etree.fromstring(data, parser), list(found.values())
        except etree.XMLSyntaxError as error:
            prefix = missing_prefix(error)
            if prefix is None or prefix in found or len(found) >= MOST_PREFIXES:
                raise _syntax_error(error, text, file) from None
            found[prefix] = undeclared(prefix, *error.position)
            data = declare(text, start, found).encode("utf-8", "surrogatepass")


def _unknown_entities(source: Source, start: int, entities: dict[str, str]) -> list[Problem]:
    """Say which references are to nothing: a file with a document type elsewhere is well-formed with them."""
    first: dict[str, int] = {}
    for match in named_references(source.text, start):
        if match[1] not in entities:
            first.setdefault(match[1][:40], match.start())
    problems = []
    for name, position in list(first.items())[:MAX_ENTITIES]:
        line, column, text = source.spot(position)
        message = f"&{name}; is not declared in the file, so what it stands for is missing"
        fix = "put its text in its place, or declare it in the document type"
        problems.append(Problem("unknown-entity", "error", message, fix, line=line, column=column, excerpt=text))
    return problems


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
