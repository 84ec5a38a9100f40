"""Findings: what a reader leaves out or cannot read, one Problem a kind with its count and its first place."""

from __future__ import annotations

from dataclasses import dataclass

from importers.limits import good_coordinate
from importers.problems import Problem, Severity
from importers.sources import Source

_MAX_APART = 100  # findings, beyond which nobody reads them one by one


@dataclass(frozen=True, slots=True)
class FindingKind:
    """A kind of finding.

    Attributes:
        code: the Problem's code.
        severity: the Problem's severity.
        one: what is the case when it is the case once; ``{what}`` stands for the detail.
        many: the same for several; ``{count}`` stands for their number.
        fix: what to do.
    """

    code: str
    severity: Severity
    one: str
    many: str
    fix: str


@dataclass(slots=True)
class _Entry:
    """One kind's first case and how many there were."""

    kind: FindingKind
    position: int | None
    what: str
    layer: str
    name: str
    x: float | None
    y: float | None
    count: int


class Findings:
    """Collects findings while a file is read; ``problems()`` gives them with their places."""

    def __init__(self) -> None:
        self._entries: dict[tuple[str, str], _Entry] = {}

    def add(
        self,
        kind: FindingKind,
        position: int | None,
        *,
        what: str = "",
        apart: bool = False,
        layer: str = "",
        name: str = "",
        at: tuple[float, float] | None = None,
        count: int = 1,
    ) -> None:
        """Note one case, or several.

        Args:
            kind: its kind.
            position: byte position in the file, or None where there is none to tell.
            what: a detail for the message.
            apart: keep cases with another `what` as findings of their own.
            layer: the layer's name.
            name: the object's name.
            at: place in the drawing.
            count: how many cases it stands for.
        """
        if apart and len(self._entries) > _MAX_APART:
            what = "other"
        key = (kind.code, what if apart else "")
        entry = self._entries.get(key)
        if entry is not None:
            entry.count += count
            return
        x, y = at if at is not None and all(map(good_coordinate, at)) else (None, None)
        self._entries[key] = _Entry(kind, position, what, layer, name, x, y, count)

    def has(self, kind: FindingKind) -> bool:
        """Tell whether there was a case of a kind."""
        return any(entry.kind is kind for entry in self._entries.values())

    def problems(self, source: Source) -> list[Problem]:
        """Give the findings in the order in which they were met first."""
        return [self._problem(entry, source) for entry in self._entries.values()]

    @staticmethod
    def _problem(entry: _Entry, source: Source) -> Problem:
        """Put one kind's cases into words."""
        kind = entry.kind
        text = kind.one if entry.count == 1 else kind.many
        place = None if entry.position is None else source.place(entry.position)
        return Problem(
            code=kind.code,
            severity=kind.severity,
            message=text.format(what=entry.what, count=f"{entry.count:,}"),
            fix=kind.fix,
            layer=entry.layer,
            name=entry.name,
            line=None if place is None else place.line,
            column=None if place is None else place.column,
            x=entry.x,
            y=entry.y,
            excerpt="" if place is None else place.excerpt,
        )
