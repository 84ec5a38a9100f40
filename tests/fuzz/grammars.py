"""The grammars of the fuzzers of work, and how the text that one makes is read."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

from grammar_operators import ILLUSTRATOR, PDF, STRUCTURE, page_of
from grammar_scene import SCENE, WALLS
from grammar_svg import CSS, SVG
from growing import Grammar


@dataclass
class Reading:
    """What was counted while a text was read.

    Attributes:
        steps: by kind, of the budget of work or of the reader's own counters.
        ended: the code of the error that ended it, or ``""``.
    """

    steps: dict[str, int] = field(default_factory=dict)
    ended: str = ""


@dataclass
class Target:
    """A grammar with its reader.

    Attributes:
        name: what it is called.
        grammar: its alternatives by name; ``file`` is the whole.
        read: reads a file, and puts into a Reading what it counts.
        written: makes a file of a text.
    """

    name: str
    grammar: Grammar
    read: Callable[[bytes, Reading], None]
    written: Callable[[str], bytes] = lambda text: text.encode()


def _whole(drawing: Any) -> None:
    """See that a drawing can be written: every number in it is one."""
    json.dumps(drawing.to_json(), allow_nan=False)


def _read_svg(data: bytes, reading: Reading) -> None:
    from importers.svg.reader import Reader
    from importers.svg.source import parse

    source = parse(data.decode(), "")
    reading.steps = source.work.spent
    _whole(Reader(source).read())


def _read_pdf(data: bytes, reading: Reading) -> None:
    from importers.pdf import read_pdf

    _whole(read_pdf(data, "", "all"))


def _read_illustrator(data: bytes, reading: Reading) -> None:
    from importers.illustrator import read_illustrator

    _whole(read_illustrator(data, ""))


def _read_scene(data: bytes, reading: Reading) -> None:
    from wallkit.scene.scene_files import read_scene, scene_to_json

    read = read_scene(data)
    json.dumps(scene_to_json(read.scene, read.until, read.bounces), allow_nan=False)


def _read_walls(data: bytes, reading: Reading) -> None:
    from wallkit.walls.walls_json import dumps, loads

    dumps(loads(data))


READERS = {
    target.name: target
    for target in (
        Target("svg", SVG, _read_svg),
        Target("css", CSS, _read_svg),
        Target("pdf", PDF, _read_pdf, page_of),
        Target("structure", STRUCTURE, _read_pdf, lambda text: text.encode("latin-1")),
        Target("illustrator", ILLUSTRATOR, _read_illustrator, lambda text: text.encode("latin-1")),
        Target("scene", SCENE, _read_scene),
        Target("walls", WALLS, _read_walls),
    )
}
