"""The scenes of the report and of the horizon's table: small formulas, each hard in a way of its own.

Every scene but the break has one ball at 50 units per second. They are made here rather than read from files so that
the same curve is there as lines of any tolerance and as arcs.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from wallkit.geometry.arrays import FloatArray
from wallkit.geometry.bulge_arcs import circles
from wallkit.scene.scene import Balls, Scene
from wallkit.walls import Walls

SPEED = 50.0
_COS, _SIN = SPEED * math.cos(math.radians(30)), SPEED * math.sin(math.radians(30))


@dataclass(frozen=True, slots=True)
class BuiltIn:
    """A scene of the report.

    Attributes:
        name: one word.
        story: what is hard about it.
        lines: makes the walls as lines, within a tolerance of the curves (0 where there are none).
        arcs: makes them with arcs, within a tolerance; None where there are no curves.
        fitted: arcs only approach the curves; else they are exact, whatever the tolerance.
        position: where the ball starts.
        velocity: how.
        radius: of the ball; the horizon's table runs the same ball as a point too.
    """

    name: str
    story: str
    lines: Callable[[float], Walls]
    arcs: Callable[[float], Walls] | None
    fitted: bool
    position: tuple[float, float]
    velocity: tuple[float, float] = (_COS, _SIN)
    radius: float = 5.0

    def scene(self, tolerance: float = 1e-4, *, lines: bool = False, radius: float | None = None) -> Scene:
        """Give the scene, with arcs unless asked for lines."""
        make = self.lines if lines or self.arcs is None else self.arcs
        return Scene(
            make(tolerance), Balls([self.position], [self.velocity], self.radius if radius is None else radius)
        )


def room(points: FloatArray | list[tuple[float, float]], bulges: list[float] | None = None) -> Walls:
    """Make one closed wall that is a room: clockwise, so that its outward normals point inside."""
    return Walls.from_polylines([np.asarray(points)], bulges=None if bulges is None else [bulges])


def box(width: float = 400.0, height: float = 300.0) -> Walls:
    """Make a rectangular room from the origin."""
    return room([(0, 0), (0, height), (width, height), (width, 0)])


def star(points: int = 5, outer: float = 200.0, inner: float = 90.0) -> Walls:
    """Make a star-shaped room about the origin, turned by 0.1 so that no wall lies along an axis."""
    turns = -np.arange(2 * points) * math.pi / points + 0.1
    return room(_polar(np.where(np.arange(2 * points) % 2 == 0, outer, inner), turns))


def wedge(angle: float, length: float = 1000.0) -> Walls:
    """Make a triangular room whose corner at the origin has the angle (radians), symmetric about the x axis."""
    half = length * math.tan(angle / 2)
    return room([(0.0, 0.0), (length, half), (length, -half)])


def regular(corners: int, radius: float = 200.0) -> Walls:
    """Make a regular polygon as a room about the origin."""
    return room(_polar(np.full(corners, radius), -np.arange(corners) * math.tau / corners))


def circle(
    radius: float, tolerance: float = 0.0, centre: tuple[float, float] = (0.0, 0.0), *, solid: bool = False
) -> Walls:
    """Make a circle, of four arcs or (tolerance > 0) of lines inside it by at most that."""
    turn = 1.0 if solid else -1.0
    if tolerance > 0:
        count = lines_for_turn(math.tau, radius, tolerance)
        points = _polar(np.full(count, radius), turn * np.arange(count) * math.tau / count)
        return room(points + np.asarray(centre))
    points = radius * np.array([(1.0, 0.0), (0.0, turn), (-1.0, 0.0), (0.0, -turn)]) + np.asarray(centre)
    return room(points, [turn * math.tan(math.pi / 8)] * 4)


def stadium(straight: float = 200.0, radius: float = 100.0, tolerance: float = 0.0) -> Walls:
    """Make a stadium about the origin: two straights and two half circles."""
    half = straight / 2
    corners = [(-half, -radius), (-half, radius), (half, radius), (half, -radius)]
    if tolerance <= 0:
        return room(corners, [-1.0, 0.0, -1.0, 0.0])
    count = lines_for_turn(math.pi, radius, tolerance)
    sweep = np.arange(1, count) * math.pi / count
    left = np.stack([-half - radius * np.sin(sweep), -radius * np.cos(sweep)], axis=1)
    points = np.concatenate([[corners[0]], left, [corners[1], corners[2]], -left, [corners[3]]])
    return room(points)


def sinai(side: float = 400.0, radius: float = 100.0, tolerance: float = 0.0) -> Walls:
    """Make a square room about the origin with a round pillar in its middle."""
    half = side / 2
    square = np.array([(-half, -half), (-half, half), (half, half), (half, -half)])
    pillar = circle(radius, tolerance, solid=True)
    return Walls.from_polylines([square, pillar.vertices], bulges=[np.zeros(4), pillar.bulges])


def wavy(tolerance: float) -> Walls:
    """Make the smooth room R(t) = 200 (1 + 0.15 cos 3t + 0.07 sin 5t) of lines.

    Vertices on the curve, equally spaced in t, so many that the sagitta stays below the tolerance: a chord of the
    step h has a sagitta of at most h^2 / 8 max|P''| (Taylor), and |P''| <= |R''| + 2 |R'| + |R|.
    """
    bend = 200 * ((0.15 * 9 + 0.07 * 25) + 2 * (0.15 * 3 + 0.07 * 5) + 1.22)
    count = max(3, math.ceil(math.tau / math.sqrt(8 * tolerance / bend)))
    return room(_wave(-np.arange(count) * math.tau / count))


def wavy_arcs(tolerance: float) -> Walls:
    """Make the same room of arcs, each through three points of the curve, so many that they err by no more.

    The error is of third order in the step, so it is measured with 60 arcs and the step chosen from that, with
    a quarter more arcs since the order holds in the limit only.
    """
    count = max(12, math.ceil(60 * 1.25 * (_arc_error(60) / tolerance) ** (1 / 3)))
    return _wavy_of_arcs(count)


def _wavy_of_arcs(count: int) -> Walls:
    points = _wave(-np.arange(2 * count) * math.tau / (2 * count))
    start, middle, end = points[0::2], points[1::2], np.roll(points[0::2], -1, axis=0)
    return room(start, list(bulge_through(start, middle, end)))


def _arc_error(count: int) -> float:
    """Largest distance of the curve's points at the quarters of each arc's step from that arc."""
    walls = _wavy_of_arcs(count)
    centre, radius = circles(walls.vertices, np.roll(walls.vertices, -1, axis=0), walls.bulges)
    step = math.tau / count
    quarters: FloatArray = -(np.arange(count) + np.array([[0.25], [0.75]])) * step
    return max(float(np.abs(np.hypot(*(_wave(turns) - centre).T) - radius).max()) for turns in quarters)


def maze(rooms: int = 12, size: float = 400.0, seed: int = 3) -> Walls:
    """Make a square room with short two-sided walls at random places, one a cell of a square lattice."""
    random = np.random.default_rng(seed)
    cell = size / rooms
    middles = (np.stack(np.meshgrid(np.arange(rooms), np.arange(rooms)), axis=-1).reshape(-1, 2) + 0.5) * cell
    turns = random.uniform(0, math.pi, len(middles))
    halves = random.uniform(0.1, 0.24, len(middles)) * cell
    shift = halves[:, None] * np.stack([np.cos(turns), np.sin(turns)], axis=1)
    middle_row = np.arange(len(middles)) != rooms * (rooms // 2) + rooms // 2  # the ball starts there
    sticks = [np.array([m - s, m + s]) for m, s, keep in zip(middles, shift, middle_row, strict=True) if keep]
    square = np.array([(0, 0), (0, size), (size, size), (size, 0)], dtype=float)
    return Walls.from_polylines([square, *sticks], closed=[True] + [False] * len(sticks))


def break_of_fifteen() -> Scene:
    """Make a table of 254 by 127 cm without pockets, a cue ball at 7 m/s, and fifteen balls in a rack.

    The balls do not touch: they stand 1 mm apart, each moved by at most 0.25 mm along x and y. So two of them meet at a
    time, and what comes of it is mechanics and not a rule for three that meet at once. Of forty draws it is the one in
    which nothing meets for 50 ms after the twentieth contact of balls: there every time step of the report can be read.
    """
    radius, apart = 2.8575, 2 * 2.8575 + 0.1
    rows = [(row, place - row / 2) for row in range(5) for place in range(row + 1)]
    rack = np.array([(190.5 + row * apart * math.sqrt(0.75), 63.5 + across * apart) for row, across in rows])
    rack += np.random.default_rng(36).uniform(-0.025, 0.025, rack.shape)
    position = np.concatenate([[(65.0, 64.0)], rack])
    velocity = np.zeros_like(position)
    velocity[0] = 700.0, -4.0
    return Scene(room([(0, 0), (0, 127), (254, 127), (254, 0)]), Balls(position, velocity, radius), meeting=True)


def lines_for_turn(angle: float, radius: float, tolerance: float) -> int:
    """Count the chords that an arc of ``angle`` needs: each has the sagitta R (1 - cos(turn / 2)) <= tolerance."""
    return max(2, math.ceil(angle / (2 * math.acos(max(0.0, 1 - tolerance / radius)))))


def _polar(radius: FloatArray, turns: FloatArray) -> FloatArray:
    return np.stack([radius * np.cos(turns), radius * np.sin(turns)], axis=1)


def _wave(turns: FloatArray) -> FloatArray:
    return _polar(200 * (1 + 0.15 * np.cos(3 * turns) + 0.07 * np.sin(5 * turns)), turns)


def bulge_through(start: FloatArray, middle: FloatArray, end: FloatArray) -> FloatArray:
    """Give the bulges of arcs from start to end through a point between; all (n, 2)."""
    # The inscribed angle at the middle point is pi - angle / 2, so angle / 4 = (pi - inscribed) / 2, signed.
    a, b = start - middle, end - middle
    cross, dot = a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0], (a * b).sum(axis=1)
    inscribed = np.arctan2(np.abs(cross), dot)
    bulge: FloatArray = -np.sign(cross) * np.tan((math.pi - inscribed) / 2)
    return bulge


def built_in() -> list[BuiltIn]:
    """List the scenes of the report, in its order."""
    narrow = math.radians(2)
    slanted = (-SPEED * math.cos(0.05), SPEED * math.sin(0.05))
    return [
        BuiltIn("box", "nothing grows but the rounding", lambda _: box(), None, False, (123.0, 87.0)),
        BuiltIn("star", "convex corners spread the balls", lambda _: star(), None, False, (3.0, -7.0)),
        BuiltIn("wedge", "ninety bounces in a corner", lambda _: wedge(narrow), None, False, (900.0, 1.0), slanted),
        BuiltIn("maze", "short walls everywhere", lambda _: maze(), None, False, (216.7, 216.7), radius=2.0),
        BuiltIn("curve", "a smooth room, no two places alike", wavy, wavy_arcs, True, (3.0, -7.0)),
        BuiltIn(
            "stadium",
            "round ends, straight sides, chaos",
            lambda t: stadium(tolerance=t),
            lambda _: stadium(),
            False,
            (3.0, -7.0),
        ),
        BuiltIn(
            "sinai",
            "a round pillar spreads every beam",
            lambda t: sinai(tolerance=t),
            lambda _: sinai(),
            False,
            (-150.0, 20.0),
        ),
    ]
