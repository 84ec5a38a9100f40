"""Names as a format allows them: without what it forbids, and different where it asks for that."""

from __future__ import annotations

from collections.abc import Iterable

from wallkit.export.findings import Findings
from wallkit.export.level import LevelWall


def without(text: str, forbidden: str) -> str:
    """Put ``_`` in the place of forbidden characters and of control characters."""
    return "".join("_" if char in forbidden or ord(char) < 32 or ord(char) == 127 else char for char in text)


def unique(names: Iterable[str], forbidden: str = "", fold: bool = False) -> list[str]:
    """Make names different: the second "pin" is "pin 2", an empty one "wall".

    Args:
        names: as drawn.
        forbidden: characters that become ``_``.
        fold: names that differ in case only count as alike.
    """
    taken: set[str] = set()
    following: dict[str, int] = {}
    result = []
    for name in names:
        stem = without(name, forbidden).strip() or "wall"
        made, key = stem, stem.casefold() if fold else stem
        while key in taken:
            following[stem] = following.get(stem, 1) + 1
            made = f"{stem} {following[stem]}"
            key = made.casefold() if fold else made
        taken.add(key)
        result.append(made)
    return result


def say_renamed(walls: list[LevelWall], names: list[str], kept_as: str, findings: Findings) -> None:
    """Say which walls have another name than drawn (one that had none is not renamed)."""
    changed = [wall for wall, name in zip(walls, names, strict=True) if wall.name and wall.name != name]
    findings.note("export-renamed", changed, f"the name had to change; as drawn it is kept as {kept_as}")
