"""Random scenes under gravity in which balls come to slide, glide, pivot and rest."""

from __future__ import annotations

import dataclasses
import math
from typing import Literal

import numpy as np

from wallkit.geometry.arrays import FloatArray
from wallkit.scene.scene import Balls, Scene
from wallkit.walls import Material, Walls

KINDS = ("ramp", "shelves", "bowl", "pipe", "dome", "room")
PULL = 9.81


def contact_scene(seed: int) -> tuple[str, Scene, float]:
    """Make one scene: (its kind, the scene with one ball, the time until which to run it).

    Args:
        seed: any whole number; the same one makes the same scene.
    """
    random = np.random.default_rng(seed)
    kind = KINDS[seed % len(KINDS)]
    outlines, closed, bulges = {
        "ramp": _ramp, "shelves": _shelves, "bowl": _bowl, "pipe": _pipe, "dome": _dome, "room": _room
    }[kind](random)  # fmt: skip
    walls = Walls.from_polylines(outlines, closed=closed, bulges=bulges, material=[_material(random) for _ in outlines])
    place = random.uniform((-4.0, 6.0), (4.0, 9.0)) if kind != "room" else random.uniform(-1.0, 1.0, 2)
    turn = random.uniform(0.0, math.tau)
    velocity = random.uniform(0.0, 6.0) * np.array([math.cos(turn), math.sin(turn)])
    radius = float(random.choice([0.0, 0.2, 0.5]))
    gravity = (0.0, -PULL) if random.random() < 0.7 else (float(random.uniform(-3.0, 3.0)), -PULL)
    return kind, Scene(walls, Balls([place], [velocity], radius), gravity=gravity), float(random.uniform(2.0, 6.0))


def rolling_scene(seed: int) -> tuple[str, Scene, float]:
    """Make the scene of :func:`contact_scene` with rolling friction, from a hundredth of gravity to more than half."""
    kind, scene, until = contact_scene(seed)
    random = np.random.default_rng([seed, 2])
    part = float(random.choice([0.01, 0.05, 0.2, random.uniform(0.0, 0.6)]))
    return kind, dataclasses.replace(scene, rolling_friction=part * PULL), until


def drag_scene(seed: int) -> tuple[str, Scene, float]:
    """Make the scene of :func:`contact_scene` with drag, in every third with rolling friction too."""
    kind, scene, until = (rolling_scene if seed % 3 == 0 else contact_scene)(seed)
    random = np.random.default_rng([seed, 5])
    drag = float(random.choice([0.001, 0.05, 0.3, random.uniform(0.0, 3.0)]))
    return kind, dataclasses.replace(scene, drag=drag), until


def one_sided_scene(seed: int) -> tuple[str, Scene, float]:
    """Make the scene of :func:`contact_scene` with every other open wall one-sided, from above or from below."""
    kind, scene, until = contact_scene(seed)
    random, walls = np.random.default_rng([seed, 3]), scene.walls
    outlines: list[FloatArray] = []
    bulges: list[FloatArray] = []
    sides: list[Literal["both", "outward"]] = []
    for first, after, closed in zip(walls.offsets[:-1], walls.offsets[1:], walls.closed, strict=True):
        outline, bulge, one = walls.vertices[first:after], walls.bulges[first:after], random.random(2) < 0.5
        if not closed and one[0]:  # the other way round, with the bulge of each edge turned round
            outline, bulge = outline[::-1], np.append(-bulge[-2::-1], 0.0)
        outlines, bulges = [*outlines, outline], [*bulges, bulge]
        sides.append("outward" if not closed and one[1] else "both")
    walls = Walls.from_polylines(outlines, walls.closed.tolist(), bulges=bulges, sides=sides, material=walls.materials)
    return kind, dataclasses.replace(scene, walls=walls), until


def touching_scene(seed: int) -> tuple[str, Scene, float]:
    """Make the scene of :func:`contact_scene` with its ball in touch with an edge, moving along, into or out of it.

    The touch is as good as doubles are. Some discs overlap another wall there, and are refused by whoever runs them.
    """
    kind, scene, until = contact_scene(seed)
    random, walls = np.random.default_rng([seed, 4]), scene.walls
    edge = int(random.integers(len(walls.edge_starts)))
    a, b = walls.vertices[walls.edge_starts[edge]], walls.vertices[walls.edge_ends[edge]]
    half, bulge = 0.5 * (b - a), float(walls.bulges[walls.edge_starts[edge]])
    right, u = np.array([half[1], -half[0]]), random.uniform(-0.9, 0.9)
    foot, normal = 0.5 * (a + b) + u * half, right / np.hypot(*right)
    if bulge != 0.0:  # a point of a circle about the chord's middle less (1 - k^2) / 2 k of the half chord to the left
        centre = 0.5 * (a + b) - (1.0 - bulge * bulge) / (2.0 * bulge) * right
        out = foot + bulge * (1.0 - u * u) * right - centre
        out /= np.hypot(*out)
        foot = centre + np.hypot(*(a - centre)) * out
        normal = out if float(out @ right) > 0.0 else -out
    normal = normal * random.choice([-1.0, 1.0])
    along = np.array([-normal[1], normal[0]])
    speed, lift = random.uniform(-5.0, 5.0) * (random.random() < 0.8), random.choice([0.0, 0.0, -1.0, 1.0])
    velocity = speed * along + lift * random.uniform(0.1, 3.0) * normal
    balls = Balls([foot + float(scene.balls.radius[0]) * normal], [velocity], scene.balls.radius)
    return kind, dataclasses.replace(scene, balls=balls), until


def _material(random: np.random.Generator) -> Material:
    restitution = float(random.choice([0.0, 0.3, 0.5, 0.8, 1.0, random.random()]))
    tangential = float(random.choice([1.0, 1.0, 0.9, random.uniform(0.3, 1.0)]))
    return Material(restitution, tangential, float(random.choice([0.0, 0.0, 0.0, 0.2])))


Drawn = tuple[list[FloatArray], list[bool], list[FloatArray]]


def _drawn(parts: list[tuple[FloatArray, bool, FloatArray]]) -> Drawn:
    return [part[0] for part in parts], [part[1] for part in parts], [part[2] for part in parts]


def _box() -> tuple[FloatArray, bool, FloatArray]:
    return np.array([(-12.0, -6.0), (-12.0, 12.0), (12.0, 12.0), (12.0, -6.0)]), True, np.zeros(4)


def _ramp(random: np.random.Generator) -> Drawn:
    """A polyline of a few pieces, lines and arcs, with joints that rise and joints that fall away."""
    count = int(random.integers(2, 7))
    x = np.linspace(-6.0, 6.0, count) + random.uniform(-0.5, 0.5, count)
    y = random.uniform(0.0, 5.0) * (0.5 - x / 12.0) + random.uniform(-0.7, 0.7, count)
    bulge = np.where(random.random(count) < 0.3, random.uniform(-0.3, 0.3, count), 0.0)
    return _drawn([(np.stack([x, y], axis=1), False, bulge), _box()])


def _shelves(random: np.random.Generator) -> Drawn:
    """Sloped shelves in a box."""
    parts = [_box()]
    for level in np.linspace(4.5, -4.5, int(random.integers(2, 6))):
        middle = np.array([random.uniform(-5.0, 5.0), level])
        along = random.uniform(2.0, 5.0) * np.array([1.0, random.uniform(-0.15, 0.15)])
        parts.append((np.array([middle - along, middle + along]), False, np.zeros(2)))
    return _drawn(parts)


def _bowl(random: np.random.Generator) -> Drawn:
    """A hollow of one or two arcs."""
    wide, deep = random.uniform(4.0, 6.0), random.uniform(0.2, 1.0)
    if random.random() < 0.5:
        return _drawn([(np.array([(-wide, 4.0), (wide, 4.0)]), False, np.array([deep, 0.0])), _box()])
    middle = np.array([random.uniform(-2.0, 2.0), random.uniform(0.0, 2.0)])
    points = np.array([(-wide, 4.0), middle, (wide, 4.0)])
    return _drawn([(points, False, np.array([0.3 * deep, 0.5 * deep, 0.0])), _box()])


def _pipe(random: np.random.Generator) -> Drawn:
    """A half pipe: two straight sides that go over smoothly into an arc, upright or leaning."""
    half = random.uniform(0.6, 1.5)  # half of the angle of the arc
    radius, length = random.uniform(3.0, 5.0), random.uniform(0.5, 4.0)
    if random.random() < 0.3:
        half = math.pi / 2
    s, c = math.sin(half), math.cos(half)
    if half == math.pi / 2:
        c = 0.0
    left, right = np.array([-radius * s, radius * (1.0 - c)]), np.array([radius * s, radius * (1.0 - c)])
    up = length * np.array([c, s])
    points = np.array([left + up * (-1.0, 1.0), left, right, right + up])
    return _drawn([(points, False, np.array([0.0, math.tan(half / 2), 0.0, 0.0])), _box()])


def _dome(random: np.random.Generator) -> Drawn:
    """Backs of arcs, a bump in a floor with smooth or sharp ends, and a closed pillar."""
    wide, bulge = random.uniform(2.0, 5.0), -random.uniform(0.1, 0.9)
    floor = np.array([(-10.0, 0.0), (-wide, 0.3 * random.random()), (wide, 0.3 * random.random()), (10.0, 0.0)])
    middle = np.array([random.uniform(-8.0, 8.0), 5.5])
    angle = np.sort(random.uniform(0.0, math.tau, 4))
    stone = middle + random.uniform(0.5, 1.0) * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    return _drawn(
        [(floor, False, np.array([0.0, bulge, 0.0, 0.0])), (stone, True, random.uniform(0.0, 0.4, 4)), _box()]
    )


def _room(random: np.random.Generator) -> Drawn:
    """A ring of lines and arcs about the origin."""
    count = int(random.integers(4, 9))
    angle = -math.tau * (np.arange(count) + 0.8 * random.random(count)) / count
    far = random.uniform(4.0, 9.0, count)
    points = far[:, None] * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    return _drawn([(points, True, np.where(random.random(count) < 0.5, random.uniform(-0.15, 0.4, count), 0.0))])


HARD = ("gap", "flat", "graze", "room")


def hard_scene(seed: int) -> tuple[str, Scene, float]:
    """Make one scene that is hard for the horizon: (its kind, the scene with one ball, the time until which to run it).

    Gaps hardly wider than the disc, sides that are nearly straight arcs, pillars that are grazed, rooms of lines and
    arcs; restitution 0.9 to 1, long enough for errors to grow.

    Args:
        seed: any whole number; the same one makes the same scene.
    """
    random = np.random.default_rng([seed, 1])
    kind = HARD[int(random.integers(len(HARD)))]
    radius = float(random.choice([0.0, 0.2, 0.5]))
    parts = [_room(random)]
    if kind == "flat":
        outline, closed, bulges = parts[0]
        parts = [(outline, closed, [10.0 ** random.uniform(-9.0, -2.0, len(bulges[0])) * random.choice([-1.0, 1.0])])]
    elif kind == "gap":
        radius = float(random.choice([0.2, 0.5]))
        wide = radius * (1.0 + 10.0 ** random.uniform(-6.0, -1.0))
        sides = [np.array([(side * wide, -2.0), (side * wide * random.uniform(1.0, 1.5), 0.0)]) for side in (-1.0, 1.0)]
        parts.append((sides, [False, False], [np.zeros(2), np.zeros(2)]))
    elif kind == "graze":
        round_ = 0.4 * np.array([(1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0)])
        for middle in random.uniform(-2.5, 2.5, (3, 2)):
            parts.append(([middle + round_], [True], [np.full(4, math.tan(math.pi / 8))]))
    walls = Walls.from_polylines(
        [outline for part in parts for outline in part[0]],
        closed=[closed for part in parts for closed in part[1]],
        bulges=[bulge for part in parts for bulge in part[2]],
        material=Material(float(random.choice([1.0, 1.0, 0.95, 0.9])), 1.0),
    )
    turn = random.uniform(0.0, math.tau)
    velocity = random.uniform(2.0, 10.0) * np.array([math.cos(turn), math.sin(turn)])
    place = np.array([0.0, 1.5]) if kind == "gap" else random.uniform(-1.0, 1.0, 2)
    return kind, Scene(walls, Balls([place], [velocity], radius), gravity=(0.0, -PULL)), 12.0
