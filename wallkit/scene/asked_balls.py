"""The balls of a scene that is opened: those asked for, those of the file, or one where there is most room."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from wallkit.scene.drawn_scene import ANGLE, SPEED, Drawn
from wallkit.scene.scene import Balls
from wallkit.scene.wishes import UsageError, Wishes
from wallkit.walls import Walls
from wallkit.walls.origins import Marker

if TYPE_CHECKING:
    from wallkit.scene.opening import OpenedScene
    from wallkit.scene.starting_places import Lines, Spot


def walls_and_balls(opened: OpenedScene, drawn: Drawn | None, wishes: Wishes) -> tuple[Walls, Balls]:
    """Give the balls asked for, those in the file, or one where there is most room; the walls turned if it says so."""
    walls, balls, assumed = opened.scene.walls, opened.scene.balls, opened.assumed
    if wishes.ball:
        if wishes.radius is None:
            assumed.append("radius 0: a point (--radius)")
        velocity = _velocity(wishes, assumed)
        return walls, Balls(np.array(wishes.ball), np.tile(velocity, (len(wishes.ball), 1)), wishes.radius or 0.0)
    if wishes.balls is None and len(balls):
        return walls, _changed(balls, drawn, wishes, assumed)
    spawns = [marker for marker in walls.markers if marker.kind == "spawn"]
    if spawns and wishes.balls is None:
        return walls, _at_the_spawn(spawns[0], wishes, assumed)
    if spawns and wishes.balls is not None:
        return walls, _at_spawns(spawns, wishes.balls, wishes, assumed)
    return _at_the_roomiest_spot(opened, wishes)


def _changed(balls: Balls, drawn: Drawn | None, wishes: Wishes, assumed: list[str]) -> Balls:
    """Let wishes say otherwise than the file, and say what the file left open."""
    if wishes.moves:
        velocity = np.tile(_velocity(wishes, assumed), (len(balls), 1))
        balls = replace(balls, velocity=velocity)
    elif drawn is not None and drawn.still:
        assumed += [f"{SPEED:g} units/s (--speed)", f"direction {ANGLE:g} degrees (--angle)"]
    if drawn is not None and drawn.used:
        assumed.append(f"{len(balls)} {'ball' if len(balls) == 1 else 'balls'} drawn on the layer 'balls'")
    return Balls(balls.position, balls.velocity, wishes.radius) if wishes.radius is not None else balls


def _at_the_spawn(spawn: Marker, wishes: Wishes, assumed: list[str]) -> Balls:
    """Give one ball where the drawing says that balls start, as large as the circle that says so."""
    radius = spawn.radius if wishes.radius is None else wishes.radius
    called = f"the spawn {spawn.name!r}" if spawn.name else "the spawn"
    assumed.append(f"one ball of radius {radius:g} at {called}, ({spawn.x:.6g}, {spawn.y:.6g}) (--ball, --radius)")
    return Balls([[spawn.x, spawn.y]], [_velocity(wishes, assumed)], radius)


def _at_spawns(spawns: list[Marker], count: int, wishes: Wishes, assumed: list[str]) -> Balls:
    """Give balls in random directions, at the spawns in turn.

    A ball is as large as the circle of its spawn; one that is asked to be smaller starts anywhere in that circle:
    evenly over the disc of radius R = (circle - ball), at R sqrt(u) for an even u.
    """
    random = np.random.default_rng(wishes.seed)
    turn = np.arange(count) % len(spawns)
    circle = np.array([spawn.radius for spawn in spawns])[turn]
    radius = circle if wishes.radius is None else np.full(count, wishes.radius)
    reach = np.maximum(circle - radius, 0.0) * np.sqrt(random.uniform(size=count))
    around = random.uniform(0.0, math.tau, count)
    middle = np.array([(spawn.x, spawn.y) for spawn in spawns])[turn]
    places = middle + reach[:, None] * np.stack([np.cos(around), np.sin(around)], axis=1)
    where = "the spawn" if len(spawns) == 1 else f"{len(spawns)} spawns in turn"
    assumed.append(f"{count} balls at {where} (seed {wishes.seed})")
    return Balls(places, _random_velocities(count, wishes, random, assumed), radius)


def _random_velocities(count: int, wishes: Wishes, random: np.random.Generator, assumed: list[str]) -> np.ndarray:
    """Give (count, 2) velocities in random directions, or all the one that is asked for."""
    if wishes.velocity is not None or wishes.angle is not None:
        return np.tile(_velocity(wishes, assumed), (count, 1))
    angle = random.uniform(0.0, math.tau, count)
    speed = SPEED if wishes.speed is None else wishes.speed
    return speed * np.stack([np.cos(angle), np.sin(angle)], axis=1)


def _at_the_roomiest_spot(opened: OpenedScene, wishes: Wishes) -> tuple[Walls, Balls]:
    from wallkit.scene.starting_places import Lines, scattered

    opened.found_place = True
    lines = Lines.of(opened.scene.walls, opened.met)
    if not opened.scene.walls.has_arcs:
        opened.met = lines.met
    walls, spot = _with_room(opened.scene.walls, lines, wishes.put_ball)
    if not wishes.put_ball or (spot is None and wishes.may_be_empty):
        return walls, Balls(np.empty((0, 2)), np.empty((0, 2)))
    if spot is None:
        why = "there is no room for a ball inside these walls"
        if lines.met.too_many:
            why = "these walls cross too often to look for room for a ball among them"
        raise UsageError(why, code="no-room", fix="give --ball X,Y")
    assumed, count, radius = opened.assumed, wishes.balls, wishes.radius
    meeting = opened.scene.meeting if wishes.meeting is None else wishes.meeting
    if radius is None:
        radius = _sensible_radius(spot.room) / (1 if count is None else 2)
        if meeting and count is not None:  # discs that meet take a tenth of the room at most
            radius = min(radius, float(f"{math.sqrt(0.1 * spot.face.area / (math.pi * count)):.0e}"))
    if count is None:
        assumed.append(
            f"one ball of radius {radius:g} at the roomiest spot, ({spot.x:.6g}, {spot.y:.6g}) (--ball, --radius)"
        )
        return walls, Balls([[spot.x, spot.y]], [_velocity(wishes, assumed)], radius)
    random = np.random.default_rng(wishes.seed)
    places = scattered(walls, spot, count, radius, random, apart=meeting and radius > 0.0)
    assumed.append(f"{count} balls of radius {radius:g} at random places (seed {wishes.seed}) around the roomiest spot")
    return walls, Balls(places, _random_velocities(count, wishes, random, assumed), radius)


def _with_room(walls: Walls, lines: Lines, put_ball: bool) -> tuple[Walls, Spot | None]:
    """Give the walls, and if a ball is to be put there the spot.

    They are turned inside out where nothing has said what is solid and most of the room is in what would be, or where
    only material has room.
    """
    from wallkit.scene.starting_places import has_room, most_room_is_material, roomiest

    def room(walls: Walls, anywhere: bool) -> tuple[bool, Spot | None]:
        if not put_ball:
            return has_room(walls, anywhere, lines), None
        spot = roomiest(walls, anywhere, lines)
        return spot is not None, spot

    if walls.solid is not None and walls.solid.how == "default" and most_room_is_material(walls, lines):
        walls = _turned(walls, "most of the space is inside them")
    found, spot = room(walls, anywhere=False)
    decided = walls.solid is not None and walls.solid.how in ("balls", "asked", "start")
    if found or decided or (walls.solid is None and "outward" in walls.sides):
        return walls, spot
    found, spot = room(walls, anywhere=True)  # all that is bounded is solid: then it is meant as rooms
    if not found or walls.solid is None:
        return walls, spot
    return _turned(walls, "there is no other place for a ball"), spot


def _turned(walls: Walls, why: str) -> Walls:
    from wallkit.walls.orient import inside_out
    from wallkit.walls.solid import Solid

    assert walls.solid is not None
    return replace(inside_out(walls), solid=Solid(not walls.solid.room, "start", why))


def _sensible_radius(room: float) -> float:
    """Give a twelfth of the room, rounded to one digit, so that the ball is seen and fits through most gaps."""
    return float(f"{room / 12:.0e}")


def _velocity(wishes: Wishes, assumed: list[str]) -> tuple[float, float]:
    if wishes.velocity is not None:
        return wishes.velocity
    speed, angle = wishes.speed, wishes.angle
    if speed is None:
        speed = SPEED
        assumed.append(f"{SPEED:g} units/s (--speed)")
    if angle is None:
        angle = ANGLE
        assumed.append(f"direction {ANGLE:g} degrees (--angle)")
    return speed * math.cos(math.radians(angle)), speed * math.sin(math.radians(angle))
