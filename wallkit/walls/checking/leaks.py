"""Leaks as problems: where a ball gets out, how wide the gap is, and where it cannot get to."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from importers.problems import Problem
from wallkit.geometry.arrays import FloatArray
from wallkit.walls.checking.free_space import FreeSpace, Gap, reached
from wallkit.walls.checking.self_check import at_least
from wallkit.walls.walls import Walls


@dataclass(frozen=True, slots=True)
class Reach:
    """What is told about gaps, for one ball or for any.

    Attributes:
        radius: of the ball; None where any is meant.
        leaks: of all gaps on the way from a room to the outside the narrowest, where the ball passes.
        shut: gaps that keep the ball out of a room that it would fit into; none without a radius.
        holding: such gaps where the ball starts in the room behind, and cannot leave it.
    """

    radius: float | None
    leaks: list[Gap]
    shut: list[Gap]
    holding: list[Gap]


def reach_of(space: FreeSpace, walls: Walls, radius: float | None, starts: FloatArray) -> Reach:
    """Choose what to tell.

    Args:
        space: rooms and gaps of the walls.
        walls: the walls.
        radius: of the ball; None asks for every gap that leads outside, whatever passes it.
        starts: (n, 2) where balls start; none are needed.
    """
    leaks = [gap for gap in space.leaks(radius or 0.0) if gap.width <= gap.escape]
    shut = [] if radius is None else space.unreachable(radius)
    if not shut or not len(starts) or not radius:
        return Reach(radius, leaks, shut, [])
    held = reached(walls, radius, starts, np.array([gap.room for gap in shut])).tolist()
    pairs = list(zip(shut, held, strict=True))
    return Reach(
        radius, leaks, [gap for gap, is_held in pairs if not is_held], [gap for gap, is_held in pairs if is_held]
    )


def leak_problems(space: FreeSpace, reach: Reach) -> list[Problem]:
    """Tell leaks, rooms out of reach and balls that are shut in as problems, the narrowest gap of each first."""
    radius = reach.radius or 0.0
    problems = [_leak(gap, reach.radius) for gap in reach.leaks]
    problems += [_shut(gap, radius) for gap in reach.shut] + [_holding(gap, radius) for gap in reach.holding]
    if not space.complete:
        message = "the walls are too many, or too close together and tangled, to find rooms and gaps between them"
        problems.append(Problem("tangled", "warning", message, "take fewer layers, or repair it first"))
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


def _holding(gap: Gap, radius: float) -> Problem:
    x, y = middle(gap)
    return Problem(
        code="shut-in",
        severity="warning",
        message=f"a ball of radius {radius:g} that starts in the room around ({gap.room[0]:.6g}, {gap.room[1]:.6g}) "
        f"stays there: the way into the larger room is {gap.width:.6g} wide",
        fix=f"widen it, or take a radius below {gap.width / 2:.6g}; nothing to do if it is meant to stay",
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
