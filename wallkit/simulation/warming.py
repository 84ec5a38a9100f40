"""Warming: compile beforehand, once for a machine, what scenes of one kind need."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from wallkit.scene.scene import Balls, Scene
from wallkit.simulation.modelled import BRUTE_FORCE
from wallkit.simulation.simulate import simulate
from wallkit.simulation.survey import survey
from wallkit.simulation.survey_backends import WORTH_A_WAVE, WORTH_LOCKSTEP
from wallkit.walls import Walls


def plain_scenes() -> list[tuple[str, Scene]]:
    """Give the scenes that people begin with, one of each kind: a name, and a ball between walls, with gravity or not.

    Where walls are many there is an index, which points and discs among few do without.
    """
    room = Walls.from_polylines([[(-9.0, -9.0), (-9.0, 9.0), (9.0, 9.0), (9.0, -9.0)]])
    stadium = Walls.from_polylines([room.vertices], bulges=[[-1.0, 0.0, -1.0, 0.0]])
    angle = np.linspace(0.0, 2.0 * np.pi, 2 * BRUTE_FORCE, endpoint=False)
    ring = Walls.from_polylines([9.0 * np.stack([np.cos(angle), np.sin(angle)], axis=1)])
    kinds = (("few lines", room, 0.0), ("few lines", room, 1.0), ("arcs", stadium, 0.0), ("arcs", stadium, 1.0),
             ("many lines", ring, 0.0), ("many lines", ring, 1.0))  # fmt: skip
    found = []
    for gravity in (None, (0.0, -1.0)):
        for name, walls, radius in kinds:
            what = f"{name}, {'a disc' if radius else 'a point'}{'' if gravity is None else ', gravity'}"
            found.append((what, Scene(walls, Balls([(1.0, 2.0)], [(3.0, 4.0)], radius), gravity=gravity)))
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
    simulate(_with_balls(scene, 1), bounces=1, mode="compiled")
    for count in (1, max(WORTH_A_WAVE, WORTH_LOCKSTEP)):  # one by one, and in lockstep or as a wave
        survey(_with_balls(scene, count), bounces=1)


def _with_balls(scene: Scene, count: int) -> Scene:
    first = np.zeros(count, dtype=np.int64)
    parts = (np.asarray(part)[first] for part in (scene.balls.position, scene.balls.velocity, scene.balls.radius))
    return replace(scene, balls=Balls(*parts))
