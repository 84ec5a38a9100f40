"""What the walk through an SVG carries along: what an element has around it, and readings that are put aside."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

from importers.drawing import Drawing, Layer, Level
from importers.regions import ALL, Region
from importers.svg.inheritance import Style
from importers.svg.matrix import Matrix
from importers.svg.notes import Notes
from importers.svg.units import Viewport


class Around(NamedTuple):
    """What an element has from what is around it."""

    matrix: Matrix
    style: Style
    viewport: Viewport
    layer: str = ""
    groups: tuple[str, ...] = ()
    levels: tuple[Level, ...] = ()  # of layers and groups, the nearest last
    clones: tuple[Level, ...] = ()  # of the `use`s that we are inside of, the outermost last: it goes before all else
    hidden: bool = False
    page: Region = ALL  # what the picture and the viewports in it show
    clip: Region = ALL  # what clips and masks leave
    unseen: bool = False  # it, or a group around it, has no opacity
    locked: bool = False
    chain: tuple[Any, ...] = ()  # targets of the `use`s that we are inside of
    depth: int = 0
    outline: str = ""  # name of the innermost `use`, for shapes without one
    label: str = ""  # label of the outermost `use` that has one, for all shapes in it


class BoxFirst(Exception):  # noqa: N818 - no error: what is to be done first
    """A visit needs a box of what is not read yet; ``push`` puts that on the stack, ``key`` is the box's."""

    def __init__(self, key: Any, push: Callable[[], None]) -> None:
        super().__init__()
        self.key = key
        self.push = push


class Reading(NamedTuple):
    """A reading that is put aside: what is still to be visited, and what came of the rest."""

    stack: list[tuple[Any, Around]]
    drawing: Drawing
    notes: Notes
    layers: dict[str, Layer]
