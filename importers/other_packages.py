"""Readers of other packages: entry points of the group ``wallkit.importers``, tried where no reader of ours fits."""

from __future__ import annotations

from importlib.metadata import EntryPoint, entry_points

from importers.drawing import Drawing
from importers.errors import DrawingError, WallkitError

GROUP = "wallkit.importers"


def read_by_other_packages(data: bytes, file: str) -> Drawing | None:
    """Ask each reader, in the order of their names, until one knows the file.

    A reader is a function that takes the bytes and returns a Drawing, or None when it is none of its files.

    Args:
        data: the file's content.
        file: its name, for messages.

    Raises:
        DrawingError: a reader cannot be loaded, fails, or returns something else; the message names it.
    """
    for point in sorted(entry_points(group=GROUP), key=lambda point: point.name):
        drawing = _ask(point, data, file)
        if drawing is not None:
            return drawing
    return None


def _ask(point: EntryPoint, data: bytes, file: str) -> Drawing | None:
    try:
        drawing = point.load()(data)
    except WallkitError:
        raise
    except Exception as error:
        raise _failed(point, f"failed: {type(error).__name__}: {error}", file) from error
    if drawing is None or isinstance(drawing, Drawing):
        return drawing
    raise _failed(point, f"returned {type(drawing).__name__} and no Drawing", file)


def _failed(point: EntryPoint, what: str, file: str) -> DrawingError:
    package = point.dist.name if point.dist else point.value
    fix = f"repair or remove the package {package}"
    return DrawingError(f"the reader {point.name!r} of {package} {what}", code="bad-importer", fix=fix, file=file)
