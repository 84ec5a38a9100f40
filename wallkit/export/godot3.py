"""Godot 3 scenes (``.tscn``, format 2)."""

from __future__ import annotations

from typing import TextIO

from wallkit.export.godot import GODOT3, write_scene
from wallkit.export.level import Level


def write(level: Level, stream: TextIO) -> None:
    """Write a level as a scene of Godot 3."""
    write_scene(level, stream, GODOT3)
