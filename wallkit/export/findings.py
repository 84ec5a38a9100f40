"""What a format could not say, counted by wall: one info problem a code."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

from importers.problems import Problem, Severity

if TYPE_CHECKING:
    from wallkit.export.level import LevelWall

HIGHEST_NAMED = 3  # walls named in a message; the rest is counted


class Findings:
    """Collects problems of one export."""

    def __init__(self, walls: int) -> None:
        self.walls = walls
        self.problems: list[Problem] = []

    def note(
        self, code: str, walls: Sequence[LevelWall], message: str, fix: str = "", severity: Severity = "info"
    ) -> None:
        """Say of some walls what became of them; nothing without any.

        Args:
            code: such as ``"export-arcs-as-lines"``.
            walls: those that it is true of; the problem has the place of the first.
            message: what is the case, as the end of "3 of 16 walls ...".
            fix: what to do about it.
            severity: of the problem.
        """
        if not walls:
            return
        first = walls[0]
        named = [f'"{wall.name}"' for wall in walls[:HIGHEST_NAMED] if wall.name]
        which = f" ({', '.join(named)}{', ...' if len(walls) > len(named) else ''})" if named else ""
        count = f"{len(walls)} of {self.walls} {'wall' if self.walls == 1 else 'walls'}{which}"
        x, y = first.place
        self.problems.append(
            Problem(code, severity, f"{count}: {message}", fix, layer=first.layer, name=first.name, x=x, y=y)
        )

    def note_where(
        self, code: str, walls: Sequence[LevelWall], test: Callable[[LevelWall], bool], message: str, fix: str = ""
    ) -> None:
        """Say the same of those walls that a test is true of."""
        self.note(code, [wall for wall in walls if test(wall)], message, fix)

    def say(self, code: str, message: str, fix: str = "") -> None:
        """Say something of the level as a whole."""
        self.problems.append(Problem(code, "info", message, fix))
