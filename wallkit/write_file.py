"""Write files whole or not at all: what stands under a name is the old file or the new one, never half of it."""

from __future__ import annotations

import contextlib
import io
import os
import stat
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import BinaryIO, TextIO

from importers.errors import WallkitError


class FileError(WallkitError):
    """A file cannot be written; the message names it and says what stands in the way."""


def write_whole(path: str | Path, data: str | bytes) -> None:
    """Write ``data`` under ``path``, whole or not at all; see :func:`open_whole`.

    Args:
        path: where to; ``"-"`` is standard output.
        data: text (written as UTF-8, line ends as they are) or bytes.

    Raises:
        FileError: the folder is missing or may not be written to, the name is a folder, or the disk is full.
    """
    content = data.encode("utf-8") if isinstance(data, str) else data
    with _open(path) as file:
        file.write(content)


@contextlib.contextmanager
def open_whole(path: str | Path) -> Iterator[TextIO]:
    """Open a text file (UTF-8, line ends as they are) that appears under ``path`` when all of it is written.

    It is a temporary file beside it first, which is then renamed: an interrupt, an error or a full disk leaves the old
    file as it was and no temporary file behind. A file that exists keeps its permissions; a link is followed, so that
    the link stays one. What is no regular file (``/dev/null``, a named pipe) is written to as it is, since a rename
    would replace it.

    Args:
        path: where to; ``"-"`` is standard output, which gets all of it at the end.

    Raises:
        FileError: the folder is missing or may not be written to, the name is a folder, or the disk is full.
    """
    with _open(path) as file:
        text = io.TextIOWrapper(file, encoding="utf-8", newline="")
        yield text
        text.flush()
        text.detach()


@contextlib.contextmanager
def _open(path: str | Path) -> Iterator[BinaryIO]:
    if str(path) == "-":
        whole = io.BytesIO()
        yield whole
        sys.stdout.flush()
        sys.stdout.buffer.write(whole.getbuffer())
        sys.stdout.buffer.flush()
        return
    target = Path(os.path.realpath(path))
    try:
        mode = target.stat().st_mode if target.exists() else None
        if mode is not None and not stat.S_ISREG(mode) and not stat.S_ISDIR(mode):
            with target.open("wb") as file:
                yield file
        else:
            with _renamed(target, mode) as file:
                yield file
    except OSError as error:
        raise FileError(
            f"cannot write {path}: {error.strerror or error}",
            code="cannot-write",
            fix=_fix(target),
        ) from error


@contextlib.contextmanager
def _renamed(target: Path, mode: int | None) -> Iterator[BinaryIO]:
    """Open a temporary file beside ``target`` that takes its name and permissions at the end."""
    if target.is_dir():
        raise IsADirectoryError(None, "it is a folder")
    handle, name = tempfile.mkstemp(prefix=f".{target.name[:100]}.", suffix=".part", dir=target.parent)
    try:
        with os.fdopen(handle, "wb") as file:
            yield file
        Path(name).chmod(stat.S_IMODE(mode) if mode is not None else 0o666 & ~_umask())
        Path(name).replace(target)
    except BaseException:
        with contextlib.suppress(OSError):
            Path(name).unlink()
        raise


def _umask() -> int:
    """Tell the process's umask; the only portable way is to set it and set it back."""
    mask = os.umask(0o077)
    os.umask(mask)
    return mask


def _fix(target: Path) -> str:
    if target.is_dir():
        return "give a file name in that folder"
    if not target.parent.is_dir():
        return f"make the folder {target.parent} first"
    return ""
