"""Write a picture under a name whose ending says how: SVG or PNG."""

from __future__ import annotations

from pathlib import Path

from importers.errors import WallkitError
from wallkit.view.canvas import Canvas
from wallkit.view.theme import Theme
from wallkit.write_file import write_whole


class PictureError(WallkitError):
    """A picture cannot be written under that name."""


def write_picture(path: str | Path, canvas: Canvas, theme: Theme = "light") -> None:
    """Write a canvas, whole or not at all, as SVG (``"-"`` too, standard output) or as PNG (twice as fine).

    Raises:
        PictureError: the ending is neither; before anything is drawn.
        FileError: the file cannot be written.
    """
    ending = ".svg" if str(path) == "-" else Path(path).suffix
    write_whole(path, picture_data(ending, canvas, theme, str(path)))


def picture_data(ending: str, canvas: Canvas, theme: Theme = "light", file: str = "") -> str | bytes:
    """Give the picture as ``.svg`` text or ``.png`` bytes."""
    check_picture_ending(ending, file)
    if ending.lower() == ".svg":
        return canvas.to_svg()
    from wallkit.view.raster import png  # late: it brings Pillow

    return png(canvas, theme)


def check_picture_ending(ending: str, file: str = "") -> None:
    """Raise PictureError unless the ending is one of a picture."""
    if ending.lower() not in (".svg", ".png"):
        raise PictureError(
            f"a picture cannot be written as {ending or 'a file without an ending'}",
            code="unknown-ending",
            fix="use an ending of these: .svg, .png",
            file=file,
        )
