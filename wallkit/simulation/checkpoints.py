"""Checkpoints: which balls have flown and what they came to, in a file that is replaced as a whole."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from importers.errors import WallkitError
from wallkit.simulation.work import Part, Work
from wallkit.write_file import write_whole

_FORMAT, _VERSION = "wallkit-checkpoint", 1


class Done:
    """Ranges of balls that have flown: sorted, apart from one another, each from its first ball to before its last."""

    def __init__(self, ranges: list[tuple[int, int]] | None = None) -> None:
        self.ranges: list[tuple[int, int]] = list(ranges or ())

    def add(self, first: int, count: int) -> None:
        """Note some more balls, and join what touches."""
        joined: list[tuple[int, int]] = []
        for start, stop in sorted([*self.ranges, (first, first + count)]):
            if joined and start <= joined[-1][1]:
                joined[-1] = (joined[-1][0], max(stop, joined[-1][1]))
            else:
                joined.append((start, stop))
        self.ranges = joined

    def __len__(self) -> int:
        return sum(stop - start for start, stop in self.ranges)

    def left(self, balls: int, chunk: int) -> Iterator[tuple[int, int]]:
        """Give what of so many balls has not flown: (first, count), at most ``chunk`` each."""
        begin = 0
        for start, stop in [*self.ranges, (balls, balls)]:
            for first in range(begin, start, chunk):
                yield first, min(chunk, start - first)
            begin = stop


def save(path: str | Path, digest: str, done: Done, part: Part) -> None:
    """Write what has flown so far, whole or not at all."""
    value = {"format": _FORMAT, "version": _VERSION, "work": digest, "ranges": done.ranges, "result": part.to_json()}
    write_whole(path, json.dumps(value))


def load(path: str | Path, digest: str, work: Work[Any], balls: int) -> tuple[Done, Any] | None:
    """Read a checkpoint of this very work; None where there is no file yet.

    Raises:
        WallkitError: it cannot be read, is none, belongs to other walls, balls or limits, or more balls have flown.
    """
    file = Path(path)
    if not file.exists():
        return None
    fix = "take another file for this survey, or remove that one"
    try:
        value = json.loads(file.read_bytes())
        if value["format"] != _FORMAT:
            raise ValueError("another format")
        known, done = value["work"], Done([(int(start), int(stop)) for start, stop in value["ranges"]])
        part = work.read(value["result"]) if known == digest else None
    except (OSError, ValueError, KeyError, TypeError, AttributeError, OverflowError) as error:
        what = getattr(error, "strerror", None) or str(error)
        raise WallkitError(f"this is no checkpoint: {what}", code="bad-checkpoint", file=str(path), fix=fix) from error
    if part is None:
        message = "the checkpoint is of another survey: scene, balls, limits or version differ"
        raise WallkitError(message, code="other-checkpoint", file=str(path), fix=fix)
    if done.ranges and done.ranges[-1][1] > balls:
        message = f"in this checkpoint {done.ranges[-1][1]:,} balls have flown, and {balls:,} are asked for"
        raise WallkitError(message, code="other-checkpoint", file=str(path), fix="ask for as many, or more")
    return done, part
