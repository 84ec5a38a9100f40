"""Phaser 3 and 4: the JSON of PhysicsEditor, convex pieces, for ``fromPhysicsEditor``.

Phaser puts the centre of mass of the whole at the place that it is given: ``origin`` is that centre, so that
``this.matter.add.fromPhysicsEditor(level.origin.x, level.origin.y, level.walls)`` shows the level where it was
drawn. matter sets the restitution of a static body to 0 when it makes it, whatever the file says: the loader
beside the file sets it afterwards.
"""

from __future__ import annotations

from typing import Any, TextIO

import numpy as np

from wallkit.export.convex import Solid, solids_of
from wallkit.export.json_text import PointLists, write_json
from wallkit.export.level import Level
from wallkit.export.losses import say_friction, say_one_way
from wallkit.export.pieces import Pieces
from wallkit.geometry.arrays import FloatArray

AT_ONCE = 2048  # pieces


def write(level: Level, stream: TextIO) -> None:
    """Write a level for ``fromPhysicsEditor``."""
    say_friction(level)
    say_one_way(level)
    solids = solids_of(level)
    x, y = centre_of_mass(solids)
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
    write_json(whole, 3, stream)


def _fixture(solid: Solid) -> dict[str, Any]:
    return {
        "label": solid.wall.name,
        "isSensor": False,
        "restitution": float(solid.wall.material.restitution),
        "friction": 0.0,
        "vertices": PointLists(solid.pieces, backwards=True),
    }


def centre_of_mass(solids: list[Solid]) -> tuple[float, float]:
    """Centre of all pieces by area, as matter finds it: overlaps count twice."""
    blocks = [_areas_and_moments(block) for solid in solids for block in solid.pieces.blocks(AT_ONCE)]
    if not blocks:
        return 0.0, 0.0
    area = np.concatenate([area for area, _ in blocks])
    x, y = (np.concatenate([moment for _, moment in blocks]).sum(axis=0) / area.sum()).tolist()
    return x, y


def _areas_and_moments(pieces: Pieces) -> tuple[FloatArray, FloatArray]:
    """Give (m,) areas and (m, 2) areas times centres.

    A polygon is the sum of triangles (o, a, b) of area a x b / 2 with the centre (o + a + b) / 3; with its own first
    vertex as o, pieces far from the origin lose no digits.
    """
    first, vertices = pieces.offsets[:-1], pieces.vertices
    following = np.arange(1, len(vertices) + 1)
    following[pieces.offsets[1:] - 1] = first
    start = np.repeat(vertices[first], np.diff(pieces.offsets), axis=0)
    a, b = vertices - start, vertices[following] - start
    cross = a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]
    area: FloatArray = np.add.reduceat(cross, first) / 2
    moment: FloatArray = np.add.reduceat((a + b) * cross[:, None], first, axis=0) / 6 + area[:, None] * vertices[first]
    return area, moment
