"""Write files whole or not at all: what stands under a name is the old file or the new one, never half of it."""

from __future__ import annotations

import contextlib
import os
import stat
import sys
import tempfile
from pathlib import Path

from importers.errors import WallkitError


class FileError(WallkitError):
    """A file cannot be written; the message names it and says what stands in the way."""


def write_whole(path: str | Path, data: str | bytes) -> None:
    """Write ``data`` under ``path``: to a temporary file beside it first, which is then renamed.

    An interrupt or a full disk leaves the old file as it was and no temporary file behind. A file that exists
    keeps its permissions; a link is followed, so that the link stays one. What is no regular file (``/dev/null``,
    a named pipe) is written to as it is, since a rename would replace it.

    Args:
        path: where to; ``"-"`` is standard output.
        data: text (written as UTF-8, line ends as they are) or bytes.

    Raises:
        FileError: the folder is missing or may not be written to, the name is a folder, or the disk is full.
    """
    content = data.encode("utf-8") if isinstance(data, str) else data
    if str(path) == "-":
        sys.stdout.flush()
        sys.stdout.buffer.write(content)
        sys.stdout.buffer.flush()
        return
    target = Path(os.path.realpath(path))
    try:
        mode = target.stat().st_mode if target.exists() else None
        if mode is not None and not stat.S_ISREG(mode) and not stat.S_ISDIR(mode):
            target.write_bytes(content)
        else:
            _replace(target, content, mode)
    except OSError as error:
        raise FileError(
            f"cannot write {path}: {error.strerror or error}",
            code="cannot-write",
            fix=_fix(target),
        ) from error


def _replace(target: Path, content: bytes, mode: int | None) -> None:
    if target.is_dir():
        raise IsADirectoryError(None, "it is a folder")
    handle, name = tempfile.mkstemp(prefix=f".{target.name[:100]}.", suffix=".part", dir=target.parent)
    try:
        with os.fdopen(handle, "wb") as file:
            file.write(content)
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
