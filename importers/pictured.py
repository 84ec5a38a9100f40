"""What shows itself as a picture: the types of the lower floors ask whoever draws; who that is, is told from above.

So a Drawing shows itself without its readers knowing anything of pictures. ``import wallkit`` names the painter.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from importers.errors import WallkitError

Painter = Callable[[object, dict[str, Any]], str | None]

_painters: list[Painter] = []


def paint_with(painter: Painter) -> None:
    """Let ``painter`` draw from now on; it returns an SVG document, or None for what it does not know."""
    _painters[:] = [painter]


class Pictured:
    """Something that can be drawn: a Drawing, Walls, a Scene or a Run."""

    __slots__ = ()

    def to_svg(self, **options: Any) -> str:
        """Draw it as one SVG document, light or dark as its reader prefers.

        Args:
            **options: for all ``title`` (a line above the picture, ``""``) and ``width`` (in pixels, 720; the height
                follows). For Walls also ``problems`` (marked with numbers; their own by default) and ``normals``
                (True). For a Run also ``colour`` (``"ball"``, ``"time"`` or ``"speed"``; by default the ball where
                there are several, else the time), ``heat`` (False; where the balls spend their time, in place of the
                paths), ``strobe`` (None; show the balls every so many seconds too) and ``problems`` (none).

        Raises:
            WallkitError: an option is not known or has a value that it cannot have, or nobody is there to draw.
        """
        svg = _painters[0](self, options) if _painters else None
        if svg is None:
            raise WallkitError("nobody is there who draws", code="no-painter", fix="import wallkit")
        return svg

    def _repr_svg_(self) -> str | None:
        """Notebooks call this for the last line of a cell."""
        return _painters[0](self, {}) if _painters else None
