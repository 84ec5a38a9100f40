"""Phaser 3 and 4: the JSON of PhysicsEditor, convex pieces, for ``fromPhysicsEditor``.

Phaser puts the centre of mass of the whole at the place that it is given: ``origin`` is that centre, so that
``this.matter.add.fromPhysicsEditor(level.origin.x, level.origin.y, level.walls)`` shows the level where it was
drawn. matter sets the restitution of a static body to 0 when it makes it, whatever the file says: the loader
beside the file sets it afterwards.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from wallkit.export.convex import Solid, solids_of
from wallkit.export.json_text import point_lists, spread
from wallkit.export.level import Level
from wallkit.export.losses import say_friction, say_one_way
from wallkit.geometry.arrays import FloatArray


def write(level: Level) -> str:
    """Write a level for ``fromPhysicsEditor``."""
    say_friction(level)
    say_one_way(level)
    solids = solids_of(level)
    x, y = centre_of_mass([piece for solid in solids for piece in solid.pieces])
    whole = {
        "generator_info": "wallkit export --format phaser; wallkit-phaser.mjs beside it adds the level to a scene",
        "origin": {"x": x, "y": y},
        "walls": {
            "type": "fromPhysicsEditor",
            "label": "walls",
            "isStatic": True,
            "density": 0.001,
            "restitution": 0.0,
            "friction": 0.0,
            "frictionStatic": 0.0,
            "frictionAir": 0.0,
            "collisionFilter": {"group": 0, "category": 1, "mask": 4294967295},
            "fixtures": [_fixture(solid) for solid in solids],
        },
    }
    return spread(whole, 3)


def _fixture(solid: Solid) -> dict[str, Any]:
    return {
        "label": solid.wall.name,
        "isSensor": False,
        "restitution": float(solid.wall.material.restitution),
        "friction": 0.0,
        "vertices": point_lists([piece[::-1] for piece in solid.pieces]),
    }


def centre_of_mass(pieces: list[FloatArray]) -> tuple[float, float]:
    """Centre of all pieces by area, as matter finds it: overlaps count twice."""
    if not pieces:
        return 0.0, 0.0
    counts = np.array([len(piece) for piece in pieces])
    first = np.cumsum(counts) - counts
    vertices = np.concatenate(pieces)
    following = np.arange(1, len(vertices) + 1)
    following[first + counts - 1] = first
    start = np.repeat(vertices[first], counts, axis=0)  # far pieces lose no digits about their own first vertex
    a, b = vertices - start, vertices[following] - start
    cross = a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]
    area = np.add.reduceat(cross, first) / 2
    moment = np.add.reduceat((a + b) * cross[:, None], first, axis=0) / 6 + area[:, None] * vertices[first]
    x, y = (moment.sum(axis=0) / area.sum()).tolist()
    return x, y
