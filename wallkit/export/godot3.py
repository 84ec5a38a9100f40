"""Godot 3 scenes (``.tscn``, format 2)."""

from __future__ import annotations

from wallkit.export.godot import GODOT3, write_scene
from wallkit.export.level import Level


def write(level: Level) -> str:
    """Write a level as a scene of Godot 3."""
    return write_scene(level, GODOT3)
