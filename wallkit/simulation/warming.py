"""Warming: compile beforehand, once for a machine, what scenes of one kind need."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from wallkit.scene.scene import Balls, Scene
from wallkit.simulation.horizon import warm_horizon
from wallkit.simulation.modelled import BRUTE_FORCE
from wallkit.simulation.simulate import simulate
from wallkit.simulation.survey import survey
from wallkit.simulation.survey_backends import WORTH_A_WAVE, WORTH_LOCKSTEP
from wallkit.walls import Material, Walls

SQUARE = [(-9.0, -9.0), (-9.0, 9.0), (9.0, 9.0), (9.0, -9.0)]


def plain_scenes() -> list[tuple[str, Scene]]:
    """Give the scenes that people begin with, one of each kind: a name, and a ball between walls where little acts.

    Where walls are many there is an index, which balls among few do without.
    """
    angle = np.linspace(0.0, 2.0 * np.pi, 2 * BRUTE_FORCE, endpoint=False)
    ring = 9.0 * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    shapes = (("few lines", SQUARE, None), ("arcs", SQUARE, [[-1.0, 0.0, -1.0, 0.0]]), ("many lines", ring, None))
    kinds: list[tuple[str, float, float, dict[str, Any]]] = [  # what it is, radius, restitution, what acts
        ("points", 0.0, 1.0, {}),
        ("discs", 1.0, 1.0, {}),
        ("points, gravity", 0.0, 1.0, {"gravity": (0.0, -1.0)}),
        ("discs, gravity", 1.0, 1.0, {"gravity": (0.0, -1.0)}),
        ("restitution", 1.0, 0.9, {}),
    ]
    slowed_or_seen: list[tuple[str, float, float, dict[str, Any]]] = [  # among few lines
        ("rolling friction", 1.0, 1.0, {"rolling_friction": 0.1}),
        ("a sensor", 1.0, 1.0, {"sensors": Walls.from_polylines([[(0.1 * x, 0.1 * y) for x, y in SQUARE]])}),
    ]
    found = []
    for shape, vertices, bulges in shapes:
        for what, radius, restitution, acts in (*kinds, *(slowed_or_seen if shape == "few lines" else ())):
            walls = Walls.from_polylines([vertices], bulges=bulges, material=Material(restitution, restitution))
            found.append((f"{shape}, {what}", Scene(walls, Balls([(1.0, 2.0)], [(3.0, 4.0)], radius), **acts)))
    return found


def warm(scene: Scene) -> None:
    """Compile the kernels that ``simulate`` and ``survey`` use for scenes like this one; those on the disk are loaded.

    A kind of scene is what it has of lines, arcs, many edges, balls with a radius, gravity, friction, restitution,
    one-sided walls and sensors; how many of each, and where, makes no difference.

    Args:
        scene: one with a ball at least; nothing is done without.

    Raises:
        SceneError: the scene cannot be simulated.
    """
    if not len(scene.balls):
        return
    if scene.meeting:  # all its balls, which must not overlap
        simulate(scene, bounces=1, mode="compiled")
        survey(scene, bounces=1)
        return
    warm_horizon(scene, simulate(_with_balls(scene, 1), bounces=1, mode="compiled").contacts)
    for count in (1, max(WORTH_A_WAVE, WORTH_LOCKSTEP)):  # one by one, and in lockstep or as a wave
        survey(_with_balls(scene, count), bounces=1)


def _with_balls(scene: Scene, count: int) -> Scene:
    first = np.zeros(count, dtype=np.int64)
    parts = (np.asarray(part)[first] for part in (scene.balls.position, scene.balls.velocity, scene.balls.radius))
    return replace(scene, balls=Balls(*parts))
