"""planck.js: the JSON of its Serializer, one static body with a chain for each wall.

A chain with ``isLoop`` must not repeat its first vertex: planck would add an edge without length. Chains are two-sided.
"""

from __future__ import annotations

from typing import Any, TextIO

from wallkit.export.box2d import is_loop, say_box2d
from wallkit.export.json_text import point, points, write_json
from wallkit.export.level import Level, LevelWall


def write(level: Level, stream: TextIO) -> None:
    """Write a level as the list that ``planck.Serializer.fromJson`` reads: world, body, then fixture and shape."""
    say_box2d(level, "userData", keeps=lambda wall: False)
    if level.walls:
        level.findings.say(
            "export-user-data", "names and layers are userData, which planck reads, but leaves out when it saves"
        )
    world = {"gravity": {"x": 0.0, "y": 0.0}, "bodies": [{"refIndex": 1, "refType": "Body"}], "joints": []}
    body = {
        "type": "static",
        "bullet": False,
        "position": {"x": 0.0, "y": 0.0},
        "angle": 0.0,
        "linearVelocity": {"x": 0.0, "y": 0.0},
        "angularVelocity": 0.0,
        "fixtures": [{"refIndex": 2 + 2 * k, "refType": "Fixture"} for k in range(len(level.walls))],
    }
    parts: list[dict[str, Any]] = [world, body]
    for wall in level:
        parts += [_fixture(wall, 3 + 2 * ((len(parts) - 2) // 2)), _chain(wall)]
    write_json(parts, 1, stream)


def _fixture(wall: LevelWall, shape: int) -> dict[str, Any]:
    return {
        "friction": 0.0,
        "restitution": float(wall.material.restitution),
        "density": 0.0,
        "isSensor": False,
        "filterGroupIndex": 0,
        "filterCategoryBits": 1,
        "filterMaskBits": 65535,
        "userData": {
            "name": wall.name,
            "layer": wall.layer,
            "wall": wall.number,
            "tangentialRestitution": float(wall.material.tangential_restitution),
            "oneWay": wall.one_way,
        },
        "shape": {"refIndex": shape, "refType": "Shape"},
    }


def _chain(wall: LevelWall) -> dict[str, Any]:
    vertices, loop = points(wall.vertices), is_loop(wall)
    return {
        "type": "chain",
        "vertices": vertices,
        "isLoop": loop,
        "hasPrevVertex": loop,
        "hasNextVertex": loop,
        "prevVertex": point(*wall.vertices[-1]) if loop else None,
        "nextVertex": point(*wall.vertices[1]) if loop else None,
    }
