"""Questions and replies: what travels between the server and its workers, which share no memory."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from importers.errors import WallkitError
from wallkit.walls.import_options import ImportOptions

JSON = "application/json; charset=utf-8"


@dataclass(frozen=True, slots=True)
class Opening:
    """A file that shall be opened.

    Attributes:
        data: its bytes.
        name: as the person knows it.
        folder: where it finds the files that it names; None forbids any.
        importing: how a drawing in it becomes walls.
    """

    data: bytes
    name: str
    folder: Path | None
    importing: ImportOptions


@dataclass(frozen=True, slots=True)
class Kept:
    """A document as the server keeps it: packed, since the server itself never looks into it.

    Attributes:
        key: by which the page names it.
        edition: changes with each import of it.
        version: counts how often its file was read again.
        packed: the worker's own Document.
    """

    key: str
    edition: str
    version: int
    packed: bytes = field(repr=False)


@dataclass(frozen=True, slots=True)
class Question:
    """One question.

    Attributes:
        name: which of :class:`~wallkit.view.page.answers.Answers`.
        body: the JSON that came with it.
        opening: the file, where one is opened.
        watched: that file may be saved again.
        data: its bytes, where it was saved again.
        edition: of the document that it is about, or ``""``.
        document: that document, for a worker that does not know this edition of it.
    """

    name: str
    body: dict[str, Any] = field(default_factory=dict)
    opening: Opening | None = None
    watched: bool = False
    data: bytes | None = field(default=None, repr=False)
    edition: str = ""
    document: bytes | None = field(default=None, repr=False)


@dataclass(frozen=True, slots=True)
class Reply:
    """One answer.

    Attributes:
        content: the text, or the bytes of a film, that are sent.
        media: its type.
        download: a file's name, where the person shall keep it.
        document: what was opened, or imported again.
        missing: the worker does not know the document; nothing else is said.
        compiling: a process apart compiles what the answer needs; ask again when it may have done so.
        error: what the question is refused with.
        internal: an error that nobody meant, in words.
    """

    content: str | bytes = field(default="", repr=False)
    media: str = JSON
    download: str = ""
    document: Kept | None = None
    missing: bool = False
    compiling: bool = False
    error: WallkitError | None = None
    internal: str = ""
