"""FILE on the command line: a path or standard input, opened as a scene; and the values of options."""

from __future__ import annotations

import math
import sys
from pathlib import Path
from typing import TYPE_CHECKING

from wallkit.scene.opening import OpenedScene, open_scene, read_file
from wallkit.scene.wishes import UsageError, Wishes

if TYPE_CHECKING:
    from collections.abc import Sequence


def read_input(file: str) -> bytes:
    """Read FILE, or standard input for ``-``, up to the limit on input.

    Raises:
        UsageError: there is no such file, or it cannot be read.
    """
    from importers.limits import MAX_INPUT_BYTES, check_input_size

    if file != "-":
        return read_file(file)
    data = sys.stdin.buffer.read(MAX_INPUT_BYTES + 1)
    check_input_size(len(data), file)
    return data


def opened(file: str, wishes: Wishes, data: bytes | None = None) -> OpenedScene:
    """Open FILE, whose bytes may be read already; a scene on standard input finds files in the working folder."""
    data = read_input(file) if data is None else data
    return open_scene(data, wishes, name=file, folder=Path() if file == "-" else Path(file).parent)


def pair(text: str, option: str) -> tuple[float, float]:
    """Read ``X,Y``.

    Raises:
        UsageError: it is not two finite numbers.
    """
    parts = text.split(",")
    try:
        x, y = (float(part) for part in parts)
    except ValueError:
        x = y = math.nan
    if not (math.isfinite(x) and math.isfinite(y)):
        raise UsageError(f"{option} is {text!r}", code="usage", fix="give two numbers with a comma, such as 10,20")
    return x, y


def pair_or_none(text: str | None, option: str) -> tuple[float, float] | None:
    """Read ``X,Y``, if the option was given; see :func:`pair`."""
    return None if text is None else pair(text, option)


def gravity_or_none(text: str | None) -> tuple[float, float] | float | None:
    """Read ``--gravity``, if it was given: GX,GY, or one number that pulls down on the screen.

    Raises:
        UsageError: it is neither.
    """
    if text is None or "," in text:
        return pair_or_none(text, "--gravity")
    try:
        size = float(text)
    except ValueError:
        size = math.nan
    if not math.isfinite(size):
        fix = "give GX,GY, or one number that pulls down, such as 9.81"
        raise UsageError(f"--gravity is {text!r}", code="usage", fix=fix)
    return size


def pairs(texts: Sequence[str] | None, option: str) -> tuple[tuple[float, float], ...]:
    """Read each ``X,Y``."""
    return tuple(pair(text, option) for text in texts or ())
