"""Godot scenes, what versions 3 and 4 share: a static body for each wall.

A closed wall is a CollisionPolygon2D of ``build_mode`` 1, which collides with its edges as drawn; mode 0 would fill
every ring, rooms and holes too, by a decomposition that may fail. A one-way collision of Godot looks along
the node's own y axis whatever the order of its points: each such edge is a node of its own, turned so that
its up is the outward normal.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from typing import TextIO

import numpy as np

from wallkit.export.level import Level, LevelWall
from wallkit.export.losses import say_friction, say_single_precision
from wallkit.export.names import say_renamed, unique
from wallkit.export.number_text import Rows
from wallkit.geometry.arrays import FloatArray

_FORBIDDEN = '.:@/"%'  # in the name of a node
Line = str | Rows


@dataclass(frozen=True, slots=True)
class Dialect:
    """How a version of Godot writes.

    Attributes:
        version: of the format: 2 or 3.
        vectors: its word for a list of points.
        material: its word for the property of a body that holds its material.
    """

    version: int
    vectors: str
    material: str

    def resource(self, number: int, kind: str) -> str:
        """Begin a resource."""
        name = f'"{kind}_{number}"' if self.version == 3 else str(number)
        return f'[sub_resource type="{kind}" id={name}]'

    def use(self, number: int, kind: str) -> str:
        """Refer to a resource."""
        return f'SubResource("{kind}_{number}")' if self.version == 3 else f"SubResource( {number} )"

    def points(self, key: str, points: FloatArray) -> Rows:
        """Write points as one flat list, the value of ``key``."""
        return Rows("%r, %r", points, before=f"{key} = {self.vectors}(", after=")")

    def notes(self, notes: dict[str, str | float]) -> list[str]:
        """Write metadata, under names that begin with ``wallkit_``."""
        if self.version == 3:
            return [f"metadata/wallkit_{key} = {_value(value)}" for key, value in notes.items()]
        inside = ",\n".join(f'"wallkit_{key}": {_value(value)}' for key, value in notes.items())
        return [f"__meta__ = {{\n{inside}\n}}"]


GODOT4 = Dialect(3, "PackedVector2Array", "physics_material_override")
GODOT3 = Dialect(2, "PoolVector2Array", "physics_material_override")


def write_scene(level: Level, stream: TextIO, dialect: Dialect) -> None:
    """Write a level as a scene of one Node2D with a body for each wall."""
    say_friction(level, "metadata")
    say_single_precision(level, "Godot")
    names = unique((wall.name for wall in level), _FORBIDDEN)
    say_renamed(level.walls, names, "the metadata wallkit_name", level.findings)
    resources = _Resources(dialect)
    nodes: list[Line] = ['[node name="walls" type="Node2D"]', ""]
    for wall, name in zip(level, names, strict=True):
        nodes += _body(wall, name, resources, dialect)
    head = f"[gd_scene load_steps={resources.count + 1} format={dialect.version}]"
    for number, line in enumerate((head, "", *resources.lines, *nodes)):
        stream.write("\n" if number else "")
        if isinstance(line, Rows):
            line.write(stream)
        else:
            stream.write(line)


class _Resources:
    """The scene's own resources, in the order of their numbers."""

    def __init__(self, dialect: Dialect) -> None:
        self.dialect = dialect
        self.lines: list[Line] = []
        self.count = 0
        self._materials: dict[float, str] = {}

    def add(self, kind: str, *properties: Line) -> str:
        """Add a resource and give the reference to it."""
        self.count += 1
        self.lines += [self.dialect.resource(self.count, kind), *properties, ""]
        return self.dialect.use(self.count, kind)

    def material(self, restitution: float) -> str:
        """Give the reference to the one material of a restitution."""
        if restitution not in self._materials:
            self._materials[restitution] = self.add("PhysicsMaterial", "friction = 0.0", f"bounce = {restitution!r}")
        return self._materials[restitution]


def _body(wall: LevelWall, name: str, resources: _Resources, dialect: Dialect) -> list[Line]:
    notes: dict[str, str | float] = {"layer": wall.layer}
    if wall.name != name:
        notes["name"] = wall.name
    if wall.material.tangential_restitution != 1:
        notes["tangential_restitution"] = float(wall.material.tangential_restitution)
    lines: list[Line] = [
        f'[node name={_value(name)} type="StaticBody2D" parent="."]',
        f"{dialect.material} = {resources.material(float(wall.material.restitution))}",
        *dialect.notes(notes),
        "",
    ]
    parent = _value(name)
    if wall.one_way:
        for number, properties in enumerate(_one_way(wall, resources), start=1):
            lines += [f'[node name="edge{number}" type="CollisionShape2D" parent={parent}]', *properties, ""]
    elif wall.closed and len(wall.vertices) > 2:
        lines += [f'[node name="edges" type="CollisionPolygon2D" parent={parent}]', "build_mode = 1"]
        lines += [dialect.points("polygon", wall.vertices), ""]
    else:
        pairs = np.repeat(wall.vertices, 2, axis=0)[1:-1]  # a, b, b, c, c, d
        shape = resources.add("ConcavePolygonShape2D", dialect.points("segments", pairs))
        lines += [f'[node name="edges" type="CollisionShape2D" parent={parent}]', f"shape = {shape}", ""]
    return lines


def _one_way(wall: LevelWall, resources: _Resources) -> Iterable[list[str]]:
    """Give an upright segment for each edge, turned so that its -y is the outward normal (dy, -dx).

    Turned by t the local (0, -1) is (sin t, -cos t), so that t = atan2(dy, dx): the direction of the edge itself.
    """
    following = np.roll(wall.vertices, -1, axis=0) if wall.closed else wall.vertices[1:]
    for (ax, ay), (bx, by) in zip(wall.vertices.tolist(), following.tolist(), strict=False):
        dx, dy = bx - ax, by - ay
        half = math.hypot(dx, dy) / 2
        shape = resources.add("SegmentShape2D", f"a = Vector2({-half!r}, 0.0)", f"b = Vector2({half!r}, 0.0)")
        yield [
            f"position = Vector2({(ax + bx) / 2!r}, {(ay + by) / 2!r})",
            f"rotation = {math.atan2(dy, dx)!r}",
            f"shape = {shape}",
            "one_way_collision = true",
        ]


def _value(value: str | float) -> str:
    if isinstance(value, float):
        return repr(value)
    escaped = value.replace("\\", "\\\\").replace('"', '\\"')
    return f'"{escaped}"'
