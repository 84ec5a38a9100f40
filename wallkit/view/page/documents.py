"""Documents: what is open on the page, kept by the server so that a question need not carry its walls."""

from __future__ import annotations

import secrets
import threading
from collections import OrderedDict
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from importers.drawing import Drawing
from importers.errors import WallkitError
from importers.problems import Problem
from wallkit.scene import Scene

MOST_DOCUMENTS = 8


@dataclass(frozen=True, slots=True)
class Opened:
    """A file made into a scene.

    Attributes:
        scene: walls, balls and what acts.
        kind: what the file was, for people.
        problems: all that was found on the way.
        drawing: the drawing, where it was one; it can be imported again with other options.
    """

    scene: Scene
    kind: str
    problems: list[Problem]
    drawing: Drawing | None


@dataclass(frozen=True, slots=True)
class Reader:
    """How files become scenes, and findings words: the command line's own ways, so that the page says the same.

    Attributes:
        open: makes a scene of a file's bytes and its name; a scene may name files in the folder, None forbids any.
        again: makes one of a drawing with other options of ``import_walls``.
        describe: gives an error as the command line writes it.
        describe_problem: gives a finding so, with the file's name.
    """

    open: Callable[[bytes, str, Path | None], Opened]
    again: Callable[[Drawing, dict[str, Any]], Opened]
    describe: Callable[[WallkitError], str]
    describe_problem: Callable[[Problem, str], str]


@dataclass(slots=True)
class Document:
    """One open file.

    Attributes:
        name: as the person knows it.
        opened: its scene as imported last.
        options: with which it was imported.
        key: by which the page names it.
    """

    name: str
    opened: Opened
    options: dict[str, Any] = field(default_factory=dict)
    key: str = field(default_factory=lambda: secrets.token_urlsafe(9))


class NotOpenError(WallkitError):
    """The page asked about a document that is not open (any more)."""


class Shelf:
    """The last few documents; the one that was not asked for longest goes first."""

    def __init__(self) -> None:
        self._documents: OrderedDict[str, Document] = OrderedDict()
        self._lock = threading.Lock()

    def put(self, document: Document) -> None:
        """Keep a document."""
        with self._lock:
            self._documents[document.key] = document
            while len(self._documents) > MOST_DOCUMENTS:
                self._documents.popitem(last=False)

    def get(self, key: object) -> Document:
        """Find a document.

        Raises:
            NotOpenError: it is not there.
        """
        with self._lock:
            document = self._documents.get(key) if isinstance(key, str) else None
            if document is None:
                raise NotOpenError("the drawing is not open any more", code="not-open", fix="open the file again")
            self._documents.move_to_end(document.key)
            return document
