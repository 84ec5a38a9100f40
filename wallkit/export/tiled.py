"""Tiled maps, what TMJ and TMX share: an object layer for each layer, an object for each wall.

Object ``type`` and version 1.10: 1.9 alone called it ``class``, and 1.12's additions break older readers.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from wallkit.export.level import Level, LevelWall
from wallkit.export.losses import say_friction, say_one_way
from wallkit.export.number_text import Rows
from wallkit.geometry.arrays import FloatArray

VERSION = "1.10"
TILE = 32  # px; a map must have tiles, and only its size in tiles is seen

Value = str | float | bool


@dataclass(frozen=True, slots=True, eq=False)
class TiledObject:
    """One object: a polygon or polyline about its own place.

    Attributes:
        number: its id, from 1.
        name: of the wall.
        x: place of its first vertex.
        y: the same.
        closed: a polygon.
        points: (n, 2) relative to its place.
        properties: custom properties by name.
    """

    number: int
    name: str
    x: float
    y: float
    closed: bool
    points: FloatArray
    properties: dict[str, Value]


@dataclass(frozen=True, slots=True)
class TiledMap:
    """A map of object layers.

    Attributes:
        columns: its width in tiles.
        rows: its height in tiles.
        layers: name and objects of each.
        objects: how many in all.
    """

    columns: int
    rows: int
    layers: list[tuple[str, list[TiledObject]]]
    objects: int


def tiled_map(level: Level) -> TiledMap:
    """Make a map that is large enough for all walls and the page."""
    say_friction(level, "the property tangential_restitution")
    say_one_way(level, "the property one_way")
    width, height = level.page or (level.box[2], level.box[3])
    layers = [(name or "walls", [_object(wall) for wall in walls]) for name, walls in level.layers().items()]
    return TiledMap(max(1, math.ceil(width / TILE)), max(1, math.ceil(height / TILE)), layers, level.findings.walls)


def _object(wall: LevelWall) -> TiledObject:
    x, y = wall.vertices[0].tolist()
    return TiledObject(
        wall.number + 1, wall.name, x, y, wall.closed, wall.vertices - wall.vertices[0], _properties(wall)
    )


def _properties(wall: LevelWall) -> dict[str, Value]:
    properties: dict[str, Value] = {
        "restitution": float(wall.material.restitution),
        "tangential_restitution": float(wall.material.tangential_restitution),
        "one_way": wall.one_way,
    }
    if wall.curve is not None:  # the wall before its arcs became lines: x,y,bulge of each vertex, on the map
        properties["arcs"] = str(Rows("%r,%r,%r", wall.curve, " "))
    return properties


def type_of(value: Value) -> str:
    """Tiled's word for the type of a property."""
    return "bool" if isinstance(value, bool) else "float" if isinstance(value, float) else "string"
