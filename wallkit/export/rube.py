"""R.U.B.E. JSON, read by loaders for Box2D in many languages: one static body with a chain for each wall.

R.U.B.E. repeats the first vertex of a loop and gives the vertices before and behind. Up to Box2D 2.3 chains
are two-sided; from 2.4 on they stop on the right of their direction, which is wallkit's outward normal.
"""

from __future__ import annotations

from typing import Any, TextIO

import numpy as np

from wallkit.export.box2d import is_loop, say_box2d
from wallkit.export.json_text import numbers, point, write_json
from wallkit.export.level import Level, LevelWall
from wallkit.export.losses import say_single_precision, say_two_sided


def write(level: Level, stream: TextIO) -> None:
    """Write a level as R.U.B.E. JSON."""
    say_box2d(level, "a custom property", keeps=lambda wall: True)
    say_two_sided(level, "Box2D from 2.4 on")
    say_single_precision(level, "Box2D")
    whole = {
        "gravity": {"x": 0.0, "y": 0.0},
        "allowSleep": True,
        "autoClearForces": True,
        "continuousPhysics": True,
        "subStepping": False,
        "warmStarting": True,
        "positionIterations": 3,
        "velocityIterations": 8,
        "stepsPerSecond": 60,
        "image": [],
        "joint": [],
        "body": [
            {
                "name": "walls",
                "type": 0,
                "angle": 0.0,
                "position": {"x": 0.0, "y": 0.0},
                "linearVelocity": {"x": 0.0, "y": 0.0},
                "angularVelocity": 0.0,
                "fixture": [_fixture(wall) for wall in level],
            }
        ],
    }
    write_json(whole, 5, stream)


def _fixture(wall: LevelWall) -> dict[str, Any]:
    loop = is_loop(wall)
    vertices = np.concatenate([wall.vertices, wall.vertices[:1]]) if loop else wall.vertices
    chain: dict[str, Any] = {"vertices": {"x": numbers(vertices[:, 0]), "y": numbers(vertices[:, 1])}}
    if loop:
        chain |= {"hasPrevVertex": True, "prevVertex": point(*wall.vertices[-1])}
        chain |= {"hasNextVertex": True, "nextVertex": point(*wall.vertices[1])}
    return {
        "name": wall.name,
        "density": 0.0,
        "friction": 0.0,
        "restitution": float(wall.material.restitution),
        "sensor": False,
        "customProperties": [
            {"name": "layer", "string": wall.layer},
            {"name": "one_way", "bool": wall.one_way},
            {"name": "tangential_restitution", "float": float(wall.material.tangential_restitution)},
        ],
        "chain": chain,
    }
