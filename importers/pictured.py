"""What a notebook shows: the types of the lower floors ask whoever draws; who that is, is told from above.

So a Drawing shows itself without its readers knowing anything of pictures. ``import wallkit`` names the painter.
"""

from __future__ import annotations

from collections.abc import Callable

Painter = Callable[[object], str | None]

_painters: list[Painter] = []


def paint_with(painter: Painter) -> None:
    """Let ``painter`` draw from now on; it gives an SVG document, or None for what it does not know."""
    _painters[:] = [painter]


class Pictured:
    """Something that notebooks show as a picture."""

    __slots__ = ()

    def _repr_svg_(self) -> str | None:
        return _painters[0](self) if _painters else None
