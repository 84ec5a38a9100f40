"""Walls: the type, how curves become edges, nesting, repair, free space and problems."""

from wallkit.walls.walls import Material, Wall, Walls

__all__ = ["Material", "Wall", "Walls"]
