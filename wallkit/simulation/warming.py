"""Warming: compile beforehand, once for a machine, what scenes of one kind need."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from wallkit.scene.scene import Balls, Scene
from wallkit.simulation.simulate import simulate
from wallkit.simulation.survey import survey
from wallkit.simulation.survey_backends import WORTH_A_WAVE, WORTH_LOCKSTEP


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
