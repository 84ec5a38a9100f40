"""Export: walls as the level that an engine, an editor or another program reads. Sees walls, never scenes.

``Walls.export(path)`` and ``wallkit export`` come here; docs/exports.md has the table of what each format keeps.
"""

from __future__ import annotations

import io
from pathlib import Path
from typing import Any, TextIO

from importers.collector import collector_paused
from importers.errors import WallkitError
from importers.problems import Problem
from wallkit.export.formats import Format, find_format, formats
from wallkit.export.level import Level, LevelWall, build_level
from wallkit.export.options import ExportError, ExportOptions
from wallkit.walls.walls import Walls
from wallkit.write_file import open_whole, write_whole

__all__ = [
    "ExportError",
    "ExportOptions",
    "Format",
    "Level",
    "LevelWall",
    "build_level",
    "export",
    "export_text",
    "find_format",
    "formats",
    "loader_of",
    "write_to",
]


def export(walls: Walls, path: str | Path, format: str | None = None, **options: Any) -> list[Problem]:
    """Write walls as a level under ``path``, whole or not at all, and beside it the loader that some engines need.

    Args:
        walls: any walls.
        path: where to; ``"-"`` is standard output, then without a loader.
        format: a name from :func:`formats`; None asks the ending of ``path``.
        **options: fields of :class:`ExportOptions`.

    Returns:
        What the format cannot say, as info problems ``export-...``, each counted by wall.

    Raises:
        ExportError: the format, an option or a package for it is missing or wrong.
        FileError: the file cannot be written.
    """
    chosen = find_format(path, format)
    with open_whole(path) as stream:
        problems = write_to(stream, walls, chosen, ExportOptions.of(options))
    if chosen.loader and str(path) != "-":
        write_whole(Path(path).parent / chosen.loader, loader_of(chosen))
    return problems


def export_text(walls: Walls, chosen: Format, options: ExportOptions) -> tuple[str, list[Problem]]:
    """Give the text of an export and what it could not say; see :func:`export`."""
    stream = io.StringIO()
    problems = write_to(stream, walls, chosen, options)
    return stream.getvalue(), problems


def write_to(stream: TextIO, walls: Walls, chosen: Format, options: ExportOptions) -> list[Problem]:
    """Write an export to a text stream, part by part, and give what it could not say; see :func:`export`."""
    if chosen.entry_point is not None:
        whole = io.StringIO()
        problems = _asked(chosen, walls, whole, options)
        stream.write(whole.getvalue())  # an OSError in that package is not one of this stream
        return problems
    with collector_paused():
        level = build_level(walls, options, y_axis=chosen.y_axis, arcs=chosen.arcs, metres=chosen.metres)
        chosen.write(level, stream)
    return level.findings.problems


def _asked(chosen: Format, walls: Walls, stream: io.StringIO, options: ExportOptions) -> list[Problem]:
    """Let another package write, and say so when it fails."""
    function = chosen.foreign()
    try:
        return list(function(walls, stream, options))
    except WallkitError:
        raise
    except Exception as error:
        raise ExportError(
            f"the format {chosen.name!r} of {chosen.title} failed: {type(error).__name__}: {error}",
            code="bad-exporter",
            fix="repair or remove that package",
        ) from error


def loader_of(chosen: Format) -> str:
    """Give the text of the file that an engine needs beside the level; it is the same for every level."""
    return (Path(__file__).parent / "loaders" / chosen.loader).read_text(encoding="utf-8") if chosen.loader else ""
