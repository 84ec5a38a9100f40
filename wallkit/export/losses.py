"""What many formats cannot say, in the same words everywhere."""

from __future__ import annotations

import numpy as np

from wallkit.export.level import Level


def say_friction(level: Level, kept: str = "") -> None:
    """Say that ``tangential_restitution`` has no counterpart: friction is 0, as for 1."""
    where = f"; it is kept as {kept}" if kept else ""
    level.findings.note_where(
        "export-friction",
        level.walls,
        lambda wall: wall.material.tangential_restitution != 1,
        f"a tangential restitution below 1 is no friction and is not written as one: friction is 0{where}",
        "set the friction in the engine",
    )


def say_one_way(level: Level, kept: str = "") -> None:
    """Say that walls with sides ``outward`` stop from both sides."""
    where = f"; it is kept as {kept}" if kept else ""
    level.findings.note_where(
        "export-one-way",
        level.walls,
        lambda wall: wall.one_way,
        f"the wall stops from both sides, not from outside alone{where}",
        "let the game decide by the outward normal",
    )


def say_two_sided(level: Level, engine: str) -> None:
    """Say that closed walls stop from outside alone."""
    level.findings.note_where(
        "export-two-sided",
        level.walls,
        lambda wall: wall.closed and not wall.one_way,
        f"{engine} stops balls from outside the material only; one that starts inside it gets out",
        "for balls inside a ring import with --arena",
    )


def say_single_precision(level: Level, engine: str) -> None:
    """Say how far an engine that keeps 32-bit numbers moves the vertices of the file."""
    moved = [float(np.abs(wall.vertices - wall.vertices.astype(np.float32)).max(initial=0.0)) for wall in level]
    level.findings.note(
        "export-rounded",
        [wall for wall, distance in zip(level, moved, strict=True) if distance],
        f"the file has all digits, but {engine} keeps 32-bit numbers: up to {max(moved, default=0):.1g} away",
    )
