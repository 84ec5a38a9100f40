"""Wishes: what is asked of a scene beyond its file, by options of a command, fields of the page or a program."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from importers.errors import WallkitError
from wallkit import arguments
from wallkit.walls.import_options import ImportOptions, as_option

USUAL = ImportOptions(curves="arcs")
"""How a drawing is imported to be simulated, unless somebody says otherwise."""


class UsageError(WallkitError):
    """Wishes that do not go together, or a value that is none."""


@dataclass(frozen=True, slots=True)
class Wishes:
    """What is asked of a scene; None is what is not asked.

    Attributes:
        ball: places (x, y) of balls, instead of those in the file.
        velocity: (vx, vy) of every ball.
        speed: units per second, of every ball.
        angle: degrees from the x axis towards the y axis of the drawing.
        radius: of every ball.
        balls: so many balls at random places.
        seed: of that randomness.
        gravity: (gx, gy), or one number: it pulls down on the screen.
        restitution: of every wall.
        tangential_restitution: the same along the wall.
        friction: deceleration of a rolling ball, units per second squared.
        drag: rate k of dv/dt = -k v, per second.
        meeting: discs meet one another.
        ball_restitution: part of the speed along the line of centres that a contact of two discs leaves.
        until: end in seconds.
        bounces: end in bounces a ball.
        importing: how a drawing becomes walls; over what a scene file says of its drawing.
        may_be_empty: a scene without a ball is fine, where there is no room for one.
        put_ball: where no ball is given, one is put where there is most room. Without that the scene has none, and
            whether there is room for one still decides what is solid where nothing else does.
    """

    ball: tuple[tuple[float, float], ...] = ()
    velocity: tuple[float, float] | None = None
    speed: float | None = None
    angle: float | None = None
    radius: float | None = None
    balls: int | None = None
    seed: int = 0
    gravity: tuple[float, float] | float | None = None
    restitution: float | None = None
    tangential_restitution: float | None = None
    friction: float | None = None
    drag: float | None = None
    meeting: bool | None = None
    ball_restitution: float | None = None
    until: float | None = None
    bounces: int | None = None
    importing: ImportOptions = USUAL
    may_be_empty: bool = False
    put_ball: bool = True

    def __post_init__(self) -> None:
        for name, check in _WISHES.items():
            if (value := getattr(self, name)) is not None:
                object.__setattr__(self, name, check(value, as_option(name)))
        if self.ball and self.balls is not None:
            raise UsageError("--ball and --balls do not go together", code="usage", fix="give places or a number")
        if self.velocity is not None and (self.speed is not None or self.angle is not None):
            raise UsageError("--velocity and --speed or --angle do not go together", code="usage", fix="give one way")

    @property
    def moves(self) -> bool:
        """A velocity is asked for, or a part of one."""
        return not (self.velocity is None and self.speed is None and self.angle is None)


def _number(least: float = -math.inf, most: float = math.inf) -> Callable[[Any, str], float]:
    above = "" if least == -math.inf else f" from {least:g}"
    may_be = f"a finite number{above}" + ("" if most == math.inf else f" to {most:g}")
    return lambda value, name: arguments.number(
        value, name, may_be, error=UsageError, code="usage", least=least, most=most
    )


def _whole(least: int) -> Callable[[Any, str], int]:
    may_be = f"a whole number, {least} or more"
    return lambda value, name: arguments.whole_number(value, name, may_be, error=UsageError, code="usage", least=least)


def _pair(value: Any, name: str) -> tuple[float, float]:
    may_be = "two finite numbers"
    pair = arguments.floats(value, name, may_be, error=UsageError, code="usage")
    if pair.shape != (2,) or not np.isfinite(pair).all():
        raise arguments.refused(name, value, may_be, UsageError, "usage")
    return float(pair[0]), float(pair[1])


def _gravity(value: Any, name: str) -> tuple[float, float] | float:
    return _number()(value, name) if isinstance(value, int | float) else _pair(value, name)


def _places(value: Any, name: str) -> tuple[tuple[float, float], ...]:
    arguments.of_type(value, name, (tuple, list, np.ndarray), "a list of (x, y)", error=UsageError, code="usage")
    return tuple(_pair(place, name) for place in value)


def _importing(value: Any, name: str) -> ImportOptions:
    arguments.of_type(value, name, ImportOptions, "ImportOptions", error=UsageError, code="usage")
    options: ImportOptions = value
    return options


_WISHES: dict[str, Callable[[Any, str], Any]] = {
    "ball": _places,
    "velocity": _pair,
    "speed": _number(),
    "angle": _number(),
    "radius": _number(least=0.0),
    "balls": _whole(1),
    "seed": _whole(0),
    "gravity": _gravity,
    "restitution": _number(0.0, 1.0),
    "tangential_restitution": _number(0.0, 1.0),
    "friction": _number(least=0.0),
    "drag": _number(least=0.0),
    "meeting": lambda value, name: arguments.flag(value, name, error=UsageError, code="usage"),
    "ball_restitution": _number(0.0, 1.0),
    "until": _number(least=0.0),
    "bounces": _whole(0),
    "importing": _importing,
    "may_be_empty": lambda value, name: arguments.flag(value, name, error=UsageError, code="usage"),
    "put_ball": lambda value, name: arguments.flag(value, name, error=UsageError, code="usage"),
}
