"""What of a scene has no exact answer where its balls meet: refused by name, before anything flies."""

from __future__ import annotations

import numpy as np

from wallkit.scene.scene import Scene, SceneError, check_masses
from wallkit.scene.start_overlaps import clearances

NEAR = 1.0 + 2.0**-20
"""A disc whose gap to a wall is below this part of its radius stands on it."""


def check_modelled(scene: Scene) -> None:
    """Refuse what is not modelled where discs meet; see docs/meeting.md.

    Under gravity two falling discs see one another move in a straight line; one that a wall holds is no such disc. A
    wall holds none that sends every ball back with its whole speed (restitution 1 and more), or swallows it.

    Raises:
        SceneError: it names what acts, and what to leave out.
    """
    check_masses(scene.balls.radius, scene.balls.mass)
    for name in ("rolling_friction", "drag"):
        if getattr(scene, name):
            acts = name.replace("_", " ")
            raise _not_modelled(
                f"balls meet, and {acts} acts: between contacts their relative motion is not straight",
                f"leave out {name}, or meeting",
            )
    if scene.gravity is None or not any(scene.gravity) or not len(scene.walls):
        return
    discs = np.flatnonzero(scene.balls.radius > 0.0)
    for wall, material in enumerate(scene.walls.materials if len(discs) else ()):
        swallows = material.restitution == 0.0 and material.tangential_restitution == 0.0
        if material.restitution < 1.0 and not swallows:
            called = f" ({scene.walls.names[wall]})" if scene.walls.names[wall] else ""
            raise _not_modelled(
                f"balls meet under gravity, and wall {wall}{called} has the restitution {material.restitution:g}: "
                "discs would come to lie on it, and how others meet them there is not modelled",
                "give walls a restitution of 1, or 0 and 0 to swallow balls; or leave out gravity or meeting",
            )
    position, radius = scene.balls.position[discs], scene.balls.radius[discs]
    gap, _edge = clearances(scene.walls, position, radius * NEAR)
    standing = np.flatnonzero(gap <= radius * NEAR)
    if len(standing):
        x, y = position[standing[0]].tolist()
        raise _not_modelled(
            f"balls meet under gravity, and ball {discs[standing[0]]} at ({x:g}, {y:g}) starts in touch with a wall",
            "start it off the wall, or leave out gravity or meeting",
        )


def refuse_meeting(scene: Scene, what: str) -> None:
    """Refuse what knows one ball at a time (``what``, as "a count in chunks") where balls meet.

    Raises:
        SceneError: balls of the scene meet.
    """
    if scene.meeting:
        raise _not_modelled(
            f"balls of this scene meet, and {what} flies each ball alone",
            "survey one scene with all its balls, or leave out meeting",
        )


def _not_modelled(message: str, fix: str) -> SceneError:
    return SceneError(message, code="meeting-not-modelled", fix=fix)
