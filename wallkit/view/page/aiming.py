"""Aiming on the page: all shots that reach the target which the person chose, in bounds."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from importers.limits import MAX_COORDINATE
from wallkit.scene.scene import Scene
from wallkit.view.page.payload import Table

if TYPE_CHECKING:
    from wallkit.levels.windows import Windows

MOST_BOUNCES, MOST_BEAMS, RESOLUTION = 12, 300_000, 1e-5
"""Of one answer; the resolution is a thousandth of what a hand can aim."""
MOST_WINDOWS = 400
"""In one answer, the widest."""


def windows_of(scene: Scene, target: tuple[float, float, float], bounces: int) -> Windows | None:
    """Find the windows of the scene's first ball; None while what they need is being compiled.

    Raises:
        WallkitError: the ball stands in or on a wall, or there are too many beams.
    """
    from wallkit.levels.aim import aim, machine_code_at_hand

    ball = scene.balls
    start, radius = (float(ball.position[0, 0]), float(ball.position[0, 1])), float(ball.radius[0])
    speed = float(np.hypot(*ball.velocity[0])) or None
    if not machine_code_at_hand(scene, start, target, radius):
        return None
    return aim(scene, start, target, bounces, radius, speed=speed, resolution=RESOLUTION, most_beams=MOST_BEAMS)


def windows_table(windows: Windows) -> Table:
    """Give windows as static/windows.js reads them: the widest, with borders in radians."""
    shown = np.sort(np.argsort(-windows.width, kind="stable")[:MOST_WINDOWS])
    table: Table = {
        "low": windows.low[shown].tolist(),
        "high": windows.high[shown].tolist(),
        "bounces": windows.bounces[shown].tolist(),
        "count": len(windows),
        "total": windows.total,
        "certainty": windows.certainty(),
        "widest": None,
    }
    if (widest := windows.widest) is not None:
        names = [windows.walls.names[wall] or f"wall {wall}" for wall in widest.word]
        table["widest"] = {
            "low": widest.low,
            "high": widest.high,
            "degrees": math.degrees(widest.middle),
            "width": math.degrees(widest.width),
            "off": names,
        }
    return table


def targets_of(scene: Scene) -> list[Table]:
    """List what the level names as targets: name, place and radius."""
    from wallkit.levels.targets import named_targets

    return [
        {"name": name, "x": x, "y": y, "radius": radius}
        for name, discs in named_targets(scene).items()
        for x, y, radius in discs
        if max(abs(x), abs(y), radius) <= MAX_COORDINATE
    ]
