"""Which repairs are asked for: known to every import, while the passes are loaded by those that repair."""

from __future__ import annotations

from dataclasses import dataclass

from wallkit.arguments import flag, number
from wallkit.walls.walls import WallsError


@dataclass(frozen=True, slots=True)
class Repairs:
    """Which passes run; by default only edges without length are dropped.

    Attributes:
        snap: open ends within this of another end or a wall are led there: moved along their own line, or by an
            edge that is added; what sticks out by less is trimmed; 0 leaves them. Snapped ends are joined.
        join: open walls whose ends meet become one.
        drop_duplicates: walls drawn twice, and edges of open walls that lie on another edge, go.
        resolve: closed walls that cross themselves become the outline of what they enclose.
        union: overlapping and touching solids become one.
        min_width: closed walls that no disc of this diameter fits into go; 0 keeps them.
        simplify: vertices go where the wall then moves by at most this; 0 keeps them.

    Raises:
        WallsError: a length is no finite number from 0, or a flag is neither True nor False.
    """

    snap: float = 0.0
    join: bool = False
    drop_duplicates: bool = False
    resolve: bool = False
    union: bool = False
    min_width: float = 0.0
    simplify: float = 0.0

    def __post_init__(self) -> None:
        for name in ("snap", "min_width", "simplify"):
            number(getattr(self, name), name, "a number from 0", error=WallsError, code="bad-option", least=0.0)
        for name in ("join", "drop_duplicates", "resolve", "union"):
            flag(getattr(self, name), name, error=WallsError, code="bad-option")
