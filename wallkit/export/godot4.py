"""Godot 4 scenes (``.tscn``, format 3)."""

from __future__ import annotations

from wallkit.export.godot import GODOT4, write_scene
from wallkit.export.level import Level


def write(level: Level) -> str:
    """Write a level as a scene of Godot 4."""
    return write_scene(level, GODOT4)
