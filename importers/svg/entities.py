"""The document type of an SVG file: its entities, found in one pass over the text that never goes back."""

from __future__ import annotations

import contextlib
import re
import xml.parsers.expat
from collections.abc import Iterator
from typing import Any, NamedTuple

from importers.errors import DrawingError
from importers.limits import MAX_ENTITIES, MAX_ENTITY_BYTES, MAX_INPUT_BYTES, limit_error

PREDEFINED = frozenset(("amp", "lt", "gt", "quot", "apos"))
REFERENCE = re.compile(r"&(#x[0-9a-fA-F]++|#[0-9]++|[^\s;&]++);")
_BLANKS = re.compile(r"\s*+")
# What ends the blocks in which nothing else means anything
_ENDS = {"<!--": "-->", "<![CDATA[": "]]>", "<?": "?>", '"': '"', "'": "'"}
_IN_PROLOG = re.compile(r"<!--|<\?|<!DOCTYPE|<")
_IN_DOCTYPE = re.compile(r"<!--|<\?|[\"'\[\]>]")
_PARAMETER = re.compile(r"%[^\s;%]++;")
_IN_SUBSET = re.compile(r"<!--|<\?|[\"']|" + _PARAMETER.pattern)
_IN_CONTENT = re.compile(r"<!--|<!\[CDATA\[|<\?|" + REFERENCE.pattern)


class Doctype(NamedTuple):
    """Where the document type stands in a text.

    Attributes:
        start: of ``<!DOCTYPE``.
        subset: where its declarations begin, behind ``[``; ``stop`` without any.
        stop: behind its ``>``.
    """

    start: int
    subset: int
    stop: int


def _signs(pattern: re.Pattern[str], text: str, start: int, stop: int) -> Iterator[re.Match[str]]:
    """Give what a pattern finds outside of comments, quotes and the like; those are stepped over once each."""
    position = start
    while match := pattern.search(text, position, stop):
        end = _ENDS.get(match[0])
        if end is None:
            yield match
            position = match.end()
            continue
        closed = text.find(end, match.end(), stop)
        if closed < 0:
            return
        position = closed + len(end)


def find_doctype(text: str) -> Doctype | None:
    """Give the place of the document type; None without one."""
    first = next(_signs(_IN_PROLOG, text, 0, len(text)), None)
    if first is None or first[0] != "<!DOCTYPE":
        return None
    subset, depth = 0, 0
    for sign in _signs(_IN_DOCTYPE, text, first.end(), len(text)):
        if sign[0] == "[":
            depth += 1
            subset = subset or sign.end()
        elif sign[0] == "]":
            depth -= 1
        elif depth <= 0:
            return Doctype(first.start(), subset or sign.end(), sign.end())
    return None


def root_start(text: str, start: int) -> int:
    """Give the place of the outermost element in a well-formed text whose document type ends at ``start``."""
    return next(_signs(_IN_PROLOG, text, start, len(text))).start()


def declared_entities(text: str, doctype: Doctype, file: str) -> dict[str, str]:
    """Give the internal entities of the document type.

    Raises:
        DrawingError: one reaches outside of the file, or stands for declarations that are nowhere.
        LimitError: they are too many or too long, or refer to one another.
    """
    found: dict[str, str] = {}
    parser = xml.parsers.expat.ParserCreate("utf-8")

    def declare(
        name: str, parameter: bool, value: str | None, base: Any, system: str | None, public: str | None, notation: Any
    ) -> None:
        line = parser.CurrentLineNumber
        if value is None:
            raise DrawingError(
                f"the entity {name!r} is outside of the file ({system or public}), and nothing outside is read",
                code="external-entity",
                fix="put its text into the file, or delete the declaration",
                file=file,
                line=line,
            )
        if len(found) >= MAX_ENTITIES:
            raise limit_error("entities of a document type", str(MAX_ENTITIES), file=file)
        if len(value.encode("utf-8", "surrogatepass")) > MAX_ENTITY_BYTES:
            raise limit_error("bytes of an entity", f"{MAX_ENTITY_BYTES:,}", file=file, line=line)
        if parameter or any(is_named(match[1]) for match in REFERENCE.finditer(value)):
            raise limit_error("entities in entities", "no level", file=file, line=line)
        found[name] = value

    parser.EntityDeclHandler = declare
    lines = "\n" * text.count("\n", 0, doctype.start)
    document = f"{lines}{text[doctype.start : doctype.stop]}<svg/>"
    with contextlib.suppress(xml.parsers.expat.ExpatError):  # libxml2 reads the same text and says where it is wrong
        parser.Parse(document.encode("utf-8", "surrogatepass"), True)
    unknown = next(_signs(_IN_SUBSET, text, doctype.subset, doctype.stop), None)
    if unknown is not None:  # what it stands for may declare any entity, so parsers leave out what follows
        raise _undeclared(unknown, text, file)
    return found


def _undeclared(sign: re.Match[str], text: str, file: str) -> DrawingError:
    start = text.rfind("\n", 0, sign.start()) + 1
    return DrawingError(
        f"{sign[0]} stands for declarations that are not in the file, so what its entities mean is not known",
        code="unknown-entity",
        fix=f"delete {sign[0]} from the document type, or put its declarations there",
        file=file,
        line=text.count("\n", 0, sign.start()) + 1,
        column=sign.start() - start + 1,
    )


def is_named(reference: str) -> bool:
    """Tell whether a reference is to an entity that a file must declare."""
    return reference[0] != "#" and reference not in PREDEFINED


def named_references(text: str, start: int) -> Iterator[re.Match[str]]:
    """Give the references to entities of the file itself from a place on, outside of comments and the like."""
    return (match for match in _signs(_IN_CONTENT, text, start, len(text)) if match[1] and is_named(match[1]))


def put_in(text: str, start: int, markup: dict[str, str], file: str) -> str:
    """Replace references to entities that hold elements by their text, as a parser would include it.

    Raises:
        LimitError: what comes out is larger than a file may be.
    """
    pieces: list[str] = [text[:start]]
    size, position = len(text), start
    for match in named_references(text, start):
        value = markup.get(match[1])
        if value is None:
            continue
        size += len(value)
        if size > MAX_INPUT_BYTES:
            raise limit_error("size of the input, entities put in", "64 MiB", file=file)
        pieces += (text[position : match.start()], value)
        position = match.end()
    return "".join((*pieces, text[position:]))
