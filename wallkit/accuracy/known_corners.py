"""Known answers in corners: wedges, Galperin's counts of pi, shots at corners and seams, exact hits."""

from __future__ import annotations

import math
from functools import partial

import numpy as np

from wallkit.accuracy import scenes
from wallkit.accuracy.cases import Verdict, add, case, count, counted, fly
from wallkit.geometry.arrays import FloatArray
from wallkit.scene.scene import Balls, Scene
from wallkit.walls import Walls

SPEED = 50.0


def open_wedge(tangent: float, length: float, corner: float = 0.0) -> Walls:
    """Make two lines from (corner, 0), the second with that slope: left open, so that a ball leaves at the end."""
    apex, end = (corner, 0.0), corner + length
    return Walls.from_polylines([[apex, (end, 0.0)], [apex, (end, length * tangent)]], closed=False)


def wedge_bounces(tangent: float) -> int:
    """Count the bounces of a point that enters a wedge parallel to its lower side.

    Unfolded, the path is a straight line at the distance b from the corner and crosses the sides at the
    distances b / sin(k a): the walls are long enough for all but those within a thousandth of being parallel.
    The origin is in the middle of the walls and their length a power of two, so that nothing is lost far out.
    """
    angle = math.atan(tangent)
    rest = max(math.pi / angle - math.floor(math.pi / angle), 1e-3)  # the last crossing is rest * angle from parallel
    length = 1.05 * max(1.0 / math.tan(rest * angle), 1.0 / tangent)
    power = 2.0 ** math.ceil(math.log2(length))
    distance = power / length  # as far from the corner as fits: what is narrow there is as wide as can be
    start = (1.02 * distance / tangent - power / 2, distance)
    return count(open_wedge(tangent, power, -power / 2), start, (-SPEED, 0.0))


def _wedge(degrees: float, expected: int, slack: int) -> Verdict:
    got = wedge_bounces(math.tan(math.radians(degrees)))
    why = "pi / angle is whole: ambiguous by one" if slack else "ceil(pi / angle) - 1"
    return counted(expected, got, why, slack)


for _degrees, _expected, _slack in ((2.0, 90, 1), (7.0, 25, 0), (0.1, 1799, 1), (13.7, 13, 0), (89.0, 2, 0)):
    add(
        f"wedge of {_degrees:g} degrees",
        "corners",
        "a point comes in parallel to one side and leaves after ceil(pi / angle) - 1 bounces",
        partial(_wedge, _degrees, _expected, _slack),
    )


def _galperin(digits: int) -> Verdict:
    expected = int("31415926"[: digits + 1])
    return counted(expected, wedge_bounces(10.0**-digits), "the digits of pi: floor(pi / atan(10^-d))")


for _digits in range(8):
    add(
        f"Galperin, 100^{_digits} : 1",
        "corners",
        "two balls and a wall, as a wedge of atan(sqrt(m / M)): their collisions count the digits of pi",
        partial(_galperin, _digits),
    )


def shots_at_corners(walls: Walls, radius: float, shots: int, seed: int) -> Scene:
    """Aim discs exactly at the vertices of a room about the origin, from near the middle."""
    random = np.random.default_rng(seed)
    start = random.uniform(-20.0, 20.0, (shots, 2))
    target = walls.vertices[random.integers(0, len(walls.vertices), shots)]
    aim = target - start
    return Scene(walls, Balls(start, SPEED * aim / np.hypot(aim[:, 0], aim[:, 1])[:, None], radius))


@case("corner shots", "2,000 discs and 2,000 points aimed at the corners of a star, 200 bounces each")
def corner_shots() -> Verdict:
    """None may be outside afterwards; a point may end in a corner that has no answer, and says so."""
    from shapely import contains_xy

    from wallkit.simulation.survey import survey

    walls = scenes.star()
    outside = 0
    for radius in (5.0, 0.0):
        where = survey(shots_at_corners(walls, radius, 2_000, 11), until=400.0).position
        room = _room(walls, 1e-9)
        outside += int(np.count_nonzero(~contains_xy(room, where[:, 0], where[:, 1])))
    return counted(0, outside, "balls outside after 400 s; none may leave")


def _room(walls: Walls, margin: float) -> object:
    from shapely import Polygon

    return Polygon(walls.vertices).buffer(margin)


@case("seams", "20,000 point rays aimed at the shared corners of 1,000 short walls")
def seams() -> Verdict:
    """Each hits one of the two neighbours, once: none slips between, none is hit by both."""
    from wallkit.simulation.survey import survey

    walls = scenes.regular(1000, 100.0)
    random = np.random.default_rng(5)
    target = walls.vertices[random.integers(0, 1000, 20_000)]
    turn = np.arctan2(target[:, 1], target[:, 0]) + random.uniform(-0.5, 0.5, 20_000)
    aim = np.stack([np.cos(turn), np.sin(turn)], axis=1)
    # from 50 away, at up to 0.5 rad from the normal: after 51 each has bounced once and is on its way back
    totals = survey(Scene(walls, Balls(target - 50.0 * aim, aim)), until=51.0)
    missed = np.hypot(totals.position[:, 0], totals.position[:, 1]) > 100.0
    return counted(0, int(np.count_nonzero(missed | (totals.bounces != 1))), "rays that slipped through, or hit twice")


def _exact_corner(sides: int, straight_back: bool) -> Verdict:
    angle = math.pi / sides
    walls = open_wedge(math.tan(angle), 1024.0) if sides > 2 else _right_angle()
    aim = -np.array([math.cos(0.4 * angle), math.sin(0.4 * angle)])
    run = fly(walls, -100.0 * aim, SPEED * aim, bounces=50)
    final = np.array([run.contacts["vx"][-1], run.contacts["vy"][-1]]) / SPEED if len(run.contacts) else aim
    # A corner of pi / n turns by 2 pi in n bounces: n even, straight back; n odd, mirrored in the bisector.
    expected = -aim if straight_back else _mirrored(-aim, angle)
    error = float(np.hypot(*(final - expected)))
    return Verdict("a limit", f"off by {error:.2g}", error, 1e-9, "the angle as drawn is off by a rounding a bounce")


def _mirrored(aim: FloatArray, angle: float) -> FloatArray:
    bisector = np.array([math.cos(angle / 2), math.sin(angle / 2)])
    mirrored: FloatArray = 2 * (aim @ bisector) * bisector - aim
    return mirrored


def _right_angle() -> Walls:
    return Walls.from_polylines([[(0.0, 0.0), (1024.0, 0.0)], [(0.0, 0.0), (0.0, 1024.0)]], closed=False)


for _sides in (2, 3, 4, 5, 6):
    add(
        f"exact corner hit, 180/{_sides} degrees",
        "corners",
        "a point aimed exactly into a corner whose angle divides 180 degrees has a limit",
        partial(_exact_corner, _sides, _sides % 2 == 0),
    )


@case("exact corner hit, 50 degrees", "a point aimed into a corner of 50 degrees has no answer: it must say so")
def ambiguous_corner() -> Verdict:
    """Two neighbours left and right of it leave in different directions."""
    angle = math.radians(50)
    aim = -np.array([math.cos(0.4 * angle), math.sin(0.4 * angle)])
    walls = open_wedge(math.tan(angle), 1024.0)
    ending = fly(walls, -100.0 * aim, SPEED * aim, bounces=50).ending[0]
    label = getattr(ending, "label", str(ending))
    return Verdict("ambiguous corner", label, float(label != "ambiguous corner"), 0.0, "discontinuous: reported")


@case("thousands at one point", "2,000 walls meet in one place; 400 discs and points aimed at it")
def thousands_at_one_point() -> Verdict:
    """A sun of spokes inside a ring: nothing may pass a spoke or leave the ring, or hang."""
    from wallkit.simulation.survey import survey

    turns = np.arange(2_000) * math.tau / 2_000
    spokes = [np.array([(0.0, 0.0), (math.cos(t), math.sin(t))]) for t in turns]
    ring = scenes.regular(64, 100.0).vertices
    walls = Walls.from_polylines([ring, *spokes], closed=[True] + [False] * len(spokes))
    start = 50.0 * np.stack([np.cos(turns[:400] * 5), np.sin(turns[:400] * 5)], axis=1)
    outside = 0
    for radius in (0.5, 0.0):
        totals = survey(Scene(walls, Balls(start, -start / 50.0 * SPEED, radius)), until=20.0)
        outside += int(np.count_nonzero(~(np.hypot(totals.position[:, 0], totals.position[:, 1]) <= 100.0 + 1e-9)))
        outside += int(np.count_nonzero(totals.bounces == 0)) if radius else 0
    return counted(0, outside, "balls outside the ring, or discs that passed the spokes")
