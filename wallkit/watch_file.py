"""Watching files: has what they hold changed, and has the program that writes them finished?

Drawing programs save by writing in place, or by a new file that is renamed over the old one; either may show half a
file, or none, for a moment. So a change counts when two looks in a row see the same, and when the content is another
one. A look costs a ``stat``; the content is only read where that differs. Whoever writes for a watcher writes by rename
(:func:`wallkit.write_file.write_whole`).
"""

from __future__ import annotations

import hashlib
import json
import os
from collections.abc import Callable, Sequence
from pathlib import Path

from importers.errors import WallkitError
from wallkit.toml_text import parse_toml

EVERY = 0.2
"""Seconds between two looks: a change is seen after 0.4 at most."""

Stamp = tuple[int, int, int] | None
Look = Callable[[Path], Stamp]


def stamp_of(path: Path) -> Stamp:
    """Give size, time of change in nanoseconds and number of a file; None where there is none."""
    try:
        found = os.stat(path)  # noqa: PTH116  (Path.stat would be the same)
    except OSError:
        return None
    return found.st_size, found.st_mtime_ns, found.st_ino


def content_of(path: Path) -> bytes | None:
    """Give the digest of a file's content; None where it cannot be read."""
    try:
        return hashlib.sha256(path.read_bytes()).digest()
    except OSError:
        return None


class Watch:
    """A file, and the files that it names, looked at again and again.

    Args:
        file: a drawing, walls or a scene.
        look: gives the stamp of a path.
        digest: gives the digest of its content.
    """

    def __init__(
        self, file: str | Path, look: Look = stamp_of, digest: Callable[[Path], bytes | None] = content_of
    ) -> None:
        self.file = Path(file)
        self._look, self._digest = look, digest
        self._paths = watched_paths(self.file)
        self._seen = self._stamps()
        self._settled = self._seen
        self._content = self._digests()

    def changed(self) -> bool:
        """Look once: tell whether all files are there and at rest, and hold something else than when last told."""
        before, self._seen = self._seen, self._stamps()
        if self._seen == self._settled or self._seen != before or None in self._seen:
            return False
        self._settled = self._seen
        content = self._digests()
        if content == self._content:
            return False
        self._paths = watched_paths(self.file)  # a scene may name another drawing now
        self._seen = self._settled = self._stamps()
        self._content = self._digests()
        return True

    def _stamps(self) -> list[Stamp]:
        return [self._look(path) for path in self._paths]

    def _digests(self) -> list[bytes | None]:
        return [self._digest(path) for path in self._paths]


def watched_paths(file: Path) -> Sequence[Path]:
    """List a file and, where it is a scene, the drawing or walls that it names."""
    try:
        data = file.read_bytes()
        text = data.decode("utf-8-sig")
        table = json.loads(text) if text.lstrip().startswith("{") else parse_toml(text)
    except (OSError, ValueError, RecursionError, WallkitError):
        return [file]
    named = [table.get(key) for key in ("drawing", "walls")] if isinstance(table, dict) else []
    return [file, *(file.parent / name for name in named if isinstance(name, str) and name)]
