"""matter.js: ``wallkit-level`` JSON with convex pieces; wallkit-matter.mjs beside it adds them to a world."""

from __future__ import annotations

from typing import TextIO

from wallkit.export.level import Level
from wallkit.export.losses import say_friction, say_one_way
from wallkit.export.neutral import write_level


def write(level: Level, stream: TextIO) -> None:
    """Write a level for wallkit-matter.mjs."""
    say_friction(level, "tangentialRestitution")
    say_one_way(level, "oneWay")
    write_level(level, stream, solids=True)
