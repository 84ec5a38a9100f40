"""SVG with the layers of the drawing, by name, as Inkscape and its like show them."""

from __future__ import annotations

from typing import TextIO

from wallkit.export.level import Level
from wallkit.export.svg import write_svg


def write(level: Level, stream: TextIO) -> None:
    """Write a level as SVG with named layers."""
    write_svg(level, stream, layers=True)
