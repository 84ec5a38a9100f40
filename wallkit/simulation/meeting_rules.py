"""What of a scene has no exact answer where its balls meet: refused by name, before anything flies."""

from __future__ import annotations

from wallkit.scene.scene import Scene, SceneError, check_masses


def check_modelled(scene: Scene) -> None:
    """Refuse what is not modelled where discs meet; see docs/meeting.md.

    Discs that fall see one another move in straight lines, and so do those that nothing pulls. Under gravity all fall:
    what would come to lie on a wall, or on another disc, hops (``wallkit.kernels.meeting.wall_contacts``).

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
