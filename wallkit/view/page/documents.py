"""Documents: what is open on the page. A worker makes and reads them, the server keeps them packed on its shelf."""

from __future__ import annotations

import secrets
import threading
from collections import OrderedDict
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from importers.errors import WallkitError
from importers.problems import Problem
from wallkit.scene.opening import OpenedScene
from wallkit.view.page.questions import Kept
from wallkit.walls.import_options import ImportOptions

MOST_DOCUMENTS = 8


@dataclass(frozen=True, slots=True)
class Reader:
    """How errors and findings become words: the command line's own ways, so that the page says the same.

    Attributes:
        describe: gives an error as the command line writes it.
        describe_problem: gives a finding so, with the file's name.
    """

    describe: Callable[[WallkitError], str]
    describe_problem: Callable[[Problem, str], str]


@dataclass(slots=True)
class Document:
    """One open file.

    Attributes:
        name: as the person knows it.
        opened: its scene as imported last.
        importing: how its drawing was imported then.
        key: by which the page names it.
        edition: changes with each import of it.
        folder: where the files that it names are; None forbids any.
        watched: it is a file of this machine that may be saved again.
        version: counts how often it was read again.
    """

    name: str
    opened: OpenedScene
    importing: ImportOptions
    key: str = field(default_factory=lambda: secrets.token_urlsafe(9))
    edition: str = field(default_factory=lambda: secrets.token_urlsafe(9))
    folder: Path | None = None
    watched: bool = False
    version: int = 0

    def anew(self, opened: OpenedScene, **changes: Any) -> Document:
        """Give the document with another import of it: a new edition under the same key."""
        return replace(self, opened=opened, edition=secrets.token_urlsafe(9), **changes)


class NotOpenError(WallkitError):
    """The page asked about a document that is not open (any more)."""


class Shelf:
    """The last few documents; the one that was not asked for longest goes first."""

    def __init__(self) -> None:
        self._documents: OrderedDict[str, Kept] = OrderedDict()
        self._lock = threading.Lock()

    def put(self, document: Kept) -> None:
        """Keep a document."""
        with self._lock:
            self._documents[document.key] = document
            while len(self._documents) > MOST_DOCUMENTS:
                self._documents.popitem(last=False)

    def get(self, key: object) -> Kept:
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
