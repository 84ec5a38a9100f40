"""Leaks as problems: where a ball gets out, how wide the gap is, and where it cannot get to."""

from __future__ import annotations

from typing import Any

from importers.problems import Problem
from wallkit.walls.free_space import FreeSpace, Gap
from wallkit.walls.validate import at_least


def reported_gaps(space: FreeSpace, radius: float | None) -> tuple[list[Gap], list[Gap]]:
    """Choose what to tell: leaks, and gaps too narrow for the ball.

    Args:
        space: rooms and gaps.
        radius: of the ball; None asks for every gap that leads outside, whatever passes it.

    Returns:
        Leaks: of all gaps on the way from a room to the outside the narrowest. Gaps that keep a ball out of a
        room that it would fit into; none without a radius.
    """
    leaks = [gap for gap in space.leaks(radius or 0.0) if gap.width <= gap.escape]
    return leaks, [] if radius is None else space.unreachable(radius)


def leak_problems(space: FreeSpace, radius: float | None) -> list[Problem]:
    """Tell leaks and rooms out of reach as problems, narrowest gap first; see :func:`reported_gaps`."""
    leaks, shut = reported_gaps(space, radius)
    problems = [_leak(gap, radius) for gap in leaks] + [_shut(gap, radius or 0.0) for gap in shut]
    if not space.complete:
        message = "the drawing is too large or too tangled to find every gap"
        problems.append(Problem("gaps-not-all-known", "info", message, "take fewer layers, or repair it first"))
    return problems


def _leak(gap: Gap, radius: float | None) -> Problem:
    half = f"{gap.width / 2:.6g}"
    who = f"balls of radius below {half} get" if radius is None else f"a ball of radius {radius:g} gets"
    x, y = middle(gap)
    return Problem(
        code="leak",
        severity="warning",
        message=f"{who} out through a gap {gap.width:.6g} wide, from the room around "
        f"({gap.room[0]:.6g}, {gap.room[1]:.6g})",
        fix=f"close the gap between ({gap.a[0]:.6g}, {gap.a[1]:.6g}) and ({gap.b[0]:.6g}, {gap.b[1]:.6g}) "
        f"(if it is between open ends: --snap {at_least(gap.width)})",
        x=x,
        y=y,
    )


def _shut(gap: Gap, radius: float) -> Problem:
    x, y = middle(gap)
    return Problem(
        code="unreachable",
        severity="warning",
        message=f"a ball of radius {radius:g} fits around ({gap.room[0]:.6g}, {gap.room[1]:.6g}) but cannot get "
        f"there: the way in is {gap.width:.6g} wide",
        fix=f"widen it, or take a radius below {gap.width / 2:.6g}",
        x=x,
        y=y,
    )


def middle(gap: Gap) -> tuple[float, float]:
    """The middle of the opening."""
    return (gap.a[0] + gap.b[0]) / 2, (gap.a[1] + gap.b[1]) / 2


def gap_json(gap: Gap) -> dict[str, Any]:
    """Give a gap as `check --json` has it."""
    return {
        "width": gap.width,
        "a": list(gap.a),
        "b": list(gap.b),
        "room": list(gap.room),
        "room_radius": gap.room_radius,
        "outside": gap.outside,
        "escape": gap.escape,
        "path": gap.path.tolist(),
    }
