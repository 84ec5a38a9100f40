"""SVG with the layers of the drawing, by name, as Inkscape and its like show them."""

from __future__ import annotations

from wallkit.export.level import Level
from wallkit.export.svg import write_svg


def write(level: Level) -> str:
    """Write a level as SVG with named layers."""
    return write_svg(level, layers=True)
