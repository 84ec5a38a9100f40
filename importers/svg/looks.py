"""Looks: what elements say of their style and transform, worked out once for all that say it in the same place."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any, NamedTuple

from importers.boxes import Box
from importers.drawing import Level, LevelKind
from importers.limits import Work
from importers.svg.around import Around
from importers.svg.cascade import Cascade
from importers.svg.inheritance import Style
from importers.svg.matrix import Matrix
from importers.svg.names import merged, shown_name, tags_of
from importers.svg.placing import element_matrix, has_transform
from importers.svg.style import PRESENTATION, SHORT, Declared

_HEARD = PRESENTATION | {"style"}  # attributes that say something of it
_OF_ITS_OWN = frozenset(("transform-box", "clip-path", "mask"))  # what asks for a box, or cuts a group alone
_MOST = 4096  # looks that are kept at once, which bounds the memory


@dataclass(slots=True, eq=False)
class Look:
    """The look of an element.

    Attributes:
        declared: its declarations.
        style: what comes of them, and of the style around it.
        moves: it has a transform.
        unseen: it and all in it is fully transparent.
    """

    declared: Declared
    style: Style
    moves: bool = field(init=False)
    unseen: bool = field(init=False)
    _matrix: Matrix | None = field(init=False, default=None)
    _place: Any = field(init=False, default=None)  # the viewport that this matrix is for

    def __post_init__(self) -> None:
        self.moves, self.unseen = has_transform(self.declared), without_opacity(self.declared)

    def matrix(self, around: Around, own_box: Callable[[], Box | None]) -> Matrix:
        """Give the matrix of its transform; ``own_box`` as :func:`placing.element_matrix` has it."""
        if "transform-box" in self.declared:
            return element_matrix(self.declared, self.style, around.viewport, own_box)
        if self._matrix is None or self._place is not around.viewport:
            self._matrix = element_matrix(self.declared, self.style, around.viewport, own_box)
            self._place = around.viewport
        return self._matrix


class Words(NamedTuple):
    """What a group says of itself.

    Attributes:
        name: its own.
        level: it, for all in it; None where nobody asks.
        locked: it, or a group around it, is locked.
        on_layer: it is a layer.
    """

    name: str
    level: Level | None
    locked: bool
    on_layer: bool

    @property
    def plain(self) -> bool:
        """It says no more than a name."""
        level = self.level
        return level is not None and not (level.tags or level.note or self.on_layer)


class Looks:
    """Gives elements their looks, and keeps what many say alike."""

    def __init__(self, cascade: Cascade, work: Work) -> None:
        self._cascade, self._work, self._shared = cascade, work, not cascade.has_sheet
        self._known: dict[tuple[Any, ...], Look] = {}
        self._inside: dict[tuple[Any, ...], tuple[Around, Look, Words, Around]] = {}
        self._levels: dict[tuple[LevelKind, str], Level] = {}

    def of(self, element: Any, attributes: dict[str, str], around: Around) -> Look:
        """Give the look of an element.

        Raises:
            NumberError: a font size is too large.
        """
        key = self._key(attributes, around.style)
        look = self._known.get(key) if key is not None else None
        if look is None:
            told = self._cascade.told
            declared = self._cascade.declared(element, attributes, around.style, around.chain)
            look = Look(declared, self._cascade.inherited(around.style, declared))
            if key is not None and self._cascade.told == told:
                if len(self._known) >= _MOST:
                    self._known.clear()
                self._known[key] = look
        return look

    def _key(self, attributes: dict[str, str], around: Style) -> tuple[Any, ...] | None:
        """Give what the look of an element hangs on; None where that is more than its own attributes."""
        if not self._shared:
            return None
        key: list[Any] = [id(around)]  # styles are kept, so the id of one is its own
        for pair in attributes.items():
            if pair[0] in _HEARD:
                if len(pair[1]) >= SHORT and pair[0] != "style":  # it is read anew, and charged for that
                    return None
                key.append(pair)
        return tuple(key)

    def inside(self, around: Around, look: Look, words: Words, make: Callable[[], Around]) -> Around:
        """Give what a group's children have around them, made once for all groups that say the same in one place.

        Args:
            around: what the group has around it.
            look: of the group.
            words: of the group.
            make: makes it.
        """
        if not words.plain or look.declared.keys() & _OF_ITS_OWN:
            return make()
        key = (id(around), id(look), words.name, id(words.level), words.locked)
        known = self._inside.get(key)
        if known is None:
            if len(self._inside) >= _MOST:
                self._inside.clear()
            known = self._inside[key] = around, look, words, make()  # kept, so that their ids are theirs
        return known[-1]

    def level(self, attributes: dict[str, str], name: str, note: str, kind: LevelKind) -> Level:
        """Give what an element says of itself and all in it; those that have a name and no more share theirs."""
        name = shown_name(attributes, name) if name else ""
        tags = tags_of(attributes)
        if tags or note:
            return Level(kind, name, tags, note)
        level = self._levels.get((kind, name))
        if level is None:
            if len(self._levels) >= _MOST:
                self._levels.clear()
            level = self._levels[kind, name] = Level(kind, name)
        return level

    def tags(self, levels: tuple[Level, ...]) -> dict[str, str]:
        """Give the tags of all levels, see :func:`names.merged`."""
        tags = 0
        for level in levels:
            tags += len(level.tags)
        self._work.charge("tags", len(levels) + 4 * tags)
        return merged(levels) if tags else {}


def without_opacity(declared: Declared) -> bool:
    """Tell whether an element and all in it is fully transparent; what has no box has no opacity of its own."""
    opacity = declared.get("opacity")
    return isinstance(opacity, float) and opacity <= 0 and declared.get("display") != "contents"
