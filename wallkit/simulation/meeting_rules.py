"""What of a scene has no exact answer where its balls meet: refused by name, before anything flies."""

from __future__ import annotations

from wallkit.scene.scene import Scene, SceneError, check_masses, falls


def check_modelled(scene: Scene) -> None:
    """Refuse what is not modelled where discs meet; see docs/meeting.md.

    Discs that fall see one another move in straight lines, and so do those that nothing pulls, and those that drag
    slows (``shared_clock``). Under gravity all fall: what would come to lie on a wall, or on another disc, hops
    (``wallkit.kernels.meeting.wall_contacts``).

    Raises:
        SceneError: it names what acts, and what to leave out.
    """
    check_masses(scene.balls.radius, scene.balls.mass)
    if scene.rolling_friction:
        raise _not_modelled(
            "balls meet, and rolling friction acts: between contacts their relative motion is not straight",
            "leave out rolling_friction, or take drag, or leave out meeting",
        )
    if scene.drag and falls(scene):
        raise _not_modelled("balls meet under gravity, and drag acts", "leave out drag, gravity or meeting")


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
