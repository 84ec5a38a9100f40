"""Unity: ``wallkit-level`` JSON; WallkitLevel.cs beside it makes an EdgeCollider2D of each wall."""

from __future__ import annotations

from typing import TextIO

from wallkit.export.level import Level
from wallkit.export.losses import say_friction, say_one_way, say_single_precision
from wallkit.export.neutral import write_level


def write(level: Level, stream: TextIO) -> None:
    """Write a level for WallkitLevel.cs."""
    say_friction(level, "tangentialRestitution")
    say_one_way(level, "oneWay")
    say_single_precision(level, "Unity")
    write_level(level, stream)
