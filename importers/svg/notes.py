"""Notes: what a reader leaves out, counted by kind, with the first place of each."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from typing import Any

from importers.limits import good_coordinate
from importers.problems import Problem, Severity
from importers.svg.source import Source

MOST = 200  # problems of one code that are told one by one


@dataclass(slots=True, eq=False, repr=False)
class _Kind:
    severity: Severity
    message: str
    fix: str
    element: Any
    count: int = 0


class Notes:
    """Collects what is to be said about a drawing while it is read."""

    def __init__(self, source: Source) -> None:
        self._source = source
        self._problems: list[Problem] = []
        self._seen: Counter[str] = Counter()
        self._messages: Counter[str] = Counter()  # different ones of each code
        self._kinds: dict[tuple[str, str], _Kind] = {}

    def add(
        self,
        code: str,
        severity: Severity,
        message: str,
        element: Any,
        *,
        fix: str = "",
        attribute: str = "",
        offset: int = 0,
        layer: str = "",
        name: str = "",
        at: tuple[float, float] | None = None,
    ) -> None:
        """Add one problem at an element, or at a character in one of its attributes.

        Beyond MOST of a code they are only counted.
        """
        if self._is_enough(code, severity, element, fix):
            return
        line, column, text = self._source.place(element, attribute, offset)
        x, y = at if at is not None and all(map(good_coordinate, at)) else (None, None)
        self._problems.append(Problem(code, severity, message, fix, layer, name, line, column, x, y, text))

    def add_within(
        self, code: str, severity: Severity, message: str, element: Any, line: int, column: int, words: str
    ) -> None:
        """Add one problem at words within the text of an element, as :meth:`add` does."""
        if self._is_enough(code, severity, element):
            return
        place = self._source.place_within(element, line, column, words)
        self._problems.append(Problem(code, severity, message, "", "", "", place[0], place[1], None, None, place[2]))

    def _is_enough(self, code: str, severity: Severity, element: Any, fix: str = "") -> bool:
        """Tell whether MOST of a code were told before this one, which then is only counted."""
        self._seen[code] += 1
        if self._seen[code] <= MOST:
            return False
        self.count(code, severity, "more of the same", element, fix=fix)
        return True

    def count(
        self, code: str, severity: Severity, message: str, element: Any, *, fix: str = "", number: int = 1
    ) -> None:
        """Count one of a kind; each kind becomes one problem at its first place, its number before the message.

        Beyond MOST different messages of a code they are counted as one kind.
        """
        if (code, message) not in self._kinds:
            self._messages[code] += 1
            if self._messages[code] > MOST:
                message = "more of the same"
        kind = self._kinds.setdefault((code, message), _Kind(severity, message, fix, element))
        kind.count += number

    def problems(self) -> list[Problem]:
        """Give all of them: the single ones in order, then one for each kind."""
        counted = []
        for (code, _), kind in self._kinds.items():
            line, column, text = self._source.place(kind.element)
            message = kind.message if kind.count == 1 else f"{kind.count} times: {kind.message}"
            counted.append(Problem(code, kind.severity, message, kind.fix, "", "", line, column, None, None, text))
        return self._problems + counted
