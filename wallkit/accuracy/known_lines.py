"""Known answers among straight walls: reflection, unfolding, periodic orbits, time reversal."""

from __future__ import annotations

import math
from fractions import Fraction

import numpy as np

from wallkit.accuracy import scenes
from wallkit.accuracy.cases import Verdict, case, counted, fly, measured, nothing
from wallkit.geometry.arrays import FloatArray
from wallkit.walls import Walls

SPEED = 50.0
EPS = 2.0**-53


@case("30 degrees", "a ball of 50 units/s meets a wall at 30 degrees from its normal")
def thirty_degrees() -> Verdict:
    """25 along the wall stays, 43.301... across turns round."""
    vx, vy = SPEED * math.sin(math.radians(30)), -SPEED * math.cos(math.radians(30))
    floor = Walls.from_polylines([[(-1000.0, 0.0), (1000.0, 0.0)]], closed=False)
    contact = fly(floor, (0.0, 100.0), (vx, vy), 5.0, bounces=1).contacts[0]
    error = max(abs(contact["vx"] - 25.0), abs(contact["vy"] - 43.30127018922193))
    return Verdict(
        "25 and 43.30127018922193",
        f"{float(contact['vx'])!r} and {float(contact['vy'])!r}",
        float(error),
        2 * math.ulp(43.3),
        "the velocity given is rounded once, the speed restored once: two units in the last place",
    )


def _unfold(start: float, speed: float, time: float, low: float, high: float) -> float:
    """Where a ball between two mirrors is, exactly: fold(p + v t) in rational numbers."""
    a, b = Fraction(low), Fraction(high)
    place = (Fraction(start) + Fraction(speed) * Fraction(time) - a) % (2 * (b - a))
    return float(a + min(place, 2 * (b - a) - place))


@case("box unfolding", "10,000 bounces of a disc in a box, against mirrors unfolded in rational numbers")
def box_unfolding() -> Verdict:
    """A rectangle unfolds: x(t) = fold(x + v t), with period 2 (W - 2 r)."""
    vx, vy = SPEED * math.cos(math.radians(30)), SPEED * math.sin(math.radians(30))
    contacts = fly(scenes.box(), (123.0, 87.0), (vx, vy), 5.0, bounces=10_000).contacts
    worst = 0.0
    for row in contacts[:: max(1, len(contacts) // 500)]:
        time = float(row["time"])
        worst = max(
            worst,
            abs(_unfold(123.0, vx, time, 5.0, 395.0) - float(row["x"])),
            abs(_unfold(87.0, vy, time, 5.0, 295.0) - float(row["y"])),
        )
    # Each bounce rounds a place (up to 400) and a velocity (up to 50) once or twice; the time, up to T, is
    # rounded to T eps, which the ball turns into SPEED T eps of way. Roundings of the velocity act over T.
    end = float(contacts["time"][-1])
    bound = EPS * (len(contacts) * 2 * 400 + 4 * SPEED * end)
    return nothing("fold(p + v t)", worst, bound, "two roundings of place a bounce, four of speed over the time")


@case("six directions", "an equilateral triangle knows six directions, ever; 10,000 bounces")
def six_directions() -> Verdict:
    """The reflections of the triangle are a group of six elements."""
    contacts = fly(
        scenes.regular(3), (10.0, 7.0), (SPEED * math.cos(0.3), SPEED * math.sin(0.3)), bounces=10_000
    ).contacts
    turns = np.arctan2(contacts["vy"], contacts["vx"])
    # The outward normals are at 60 + 120 k degrees: a bounce takes the direction d to 120 k - 60 - d.
    turned = [math.tau / 3 * k + d for k in range(3) for d in (0.3, -math.pi / 3 - 0.3)]
    reference = np.array(turned)
    apart = np.abs(np.remainder(turns[:, None] - reference[None, :] + math.pi, math.tau) - math.pi)
    # The corners are doubles, so each wall is turned by up to EPS, and each bounce by twice that, the same way.
    bound = 4 * EPS * len(contacts) + 1e-14
    return nothing("6 directions", float(apart.min(axis=1).max()), bound, "each bounce turns by two roundings")


@case("orthic orbit", "the periodic orbit through the feet of the altitudes of an acute triangle")
def orthic_orbit() -> Verdict:
    """The perimeter of Fagnano's orbit is 8 K^2 / (a b c), K the triangle's area."""
    corners = np.array([(0.0, 0.0), (130.0, 210.0), (260.0, 0.0)]) + np.array([(0.0, 0.0), (17.0, 0.0), (0.0, 0.0)])
    feet = _feet(corners)
    middle, aim = (feet[0] + feet[1]) / 2, feet[1] - feet[0]
    run = fly(scenes.room([tuple(c) for c in corners]), middle, SPEED * aim / np.hypot(*aim), bounces=300)
    sides = [float(np.hypot(*(corners[i] - corners[(i + 1) % 3]))) for i in range(3)]
    area = 0.5 * abs(np.linalg.det(np.array([corners[1] - corners[0], corners[2] - corners[0]])))
    perimeter = 8 * area**2 / math.prod(sides)
    times = run.contacts["time"]
    got = float(times[-1] - times[2]) * SPEED / ((len(times) - 3) / 3)
    # The orbit is neutrally stable: an error of place or angle of a few EPS grows like the number of bounces.
    return measured(perimeter, got, 300 * 20 * EPS * perimeter, "linear growth of the start's rounding")


def _feet(corners: FloatArray) -> FloatArray:
    feet = []
    for i in range(3):
        a, b, c = corners[i], corners[(i + 1) % 3], corners[(i + 2) % 3]
        along = (c - b) / np.hypot(*(c - b))
        feet.append(b + ((a - b) @ along) * along)
    return np.array(feet)


@case("time reversal", "1,000 bounces of a star there, and back to the start")
def time_reversal() -> Verdict:
    """A polygon turns nothing but angles: reversed, a point comes home."""
    start, velocity = np.array([3.0, -7.0]), np.array([SPEED * math.cos(0.5), SPEED * math.sin(0.5)])
    walls = scenes.star()
    there = fly(walls, start, velocity, bounces=1001).contacts
    a, b = there[-2], there[-1]
    middle = np.array([(a["x"] + b["x"]) / 2, (a["y"] + b["y"]) / 2])
    back = fly(walls, middle, (-a["vx"], -a["vy"]), bounces=1000).contacts
    first, last = there[0], back[-1]
    home = np.array([last["x"], last["y"]]) + float(first["time"]) * np.array([last["vx"], last["vy"]])
    # There and back: an angle wrong by some EPS a bounce, each over the way that is left: n^2 / 2 bounces of ~100.
    return nothing("the start", float(np.hypot(*(home - start))), 1000**2 * 100 * 4 * EPS, "angles off by EPS a bounce")


@case("zero-length wall", "an edge from a place to itself: an obstacle for a disc, nothing for a point")
def zero_length_wall() -> Verdict:
    """A disc of radius 5 aimed at it turns back at 5; a point flies through."""
    box = [(0.0, 0.0), (0.0, 100.0), (200.0, 100.0), (200.0, 0.0)]
    walls = Walls.from_polylines([box, [(100.0, 50.0), (100.0, 50.0)]], closed=[True, False])
    disc = float(fly(walls, (20.0, 50.0), (10.0, 0.0), 5.0, bounces=1).contacts["x"][0])
    point = float(fly(walls, (20.0, 50.0), (10.0, 0.0), 0.0, bounces=1).contacts["x"][0])
    error = abs(disc - 95.0) + abs(point - 200.0)
    return Verdict("95 and 200", f"{disc:g} and {point:g}", error, 2 * math.ulp(200.0), "one rounding of each place")


@case("duplicate wall", "every wall drawn twice: the same contacts, to the last bit")
def duplicate_wall() -> Verdict:
    """The second copy is met at the same time as the first, and then left alone."""
    corners = scenes.star().vertices
    velocity = (SPEED * math.cos(0.5), SPEED * math.sin(0.5))
    different = 0
    for radius in (0.0, 5.0):
        once = fly(Walls.from_polylines([corners]), (3.0, -7.0), velocity, radius, bounces=500).contacts
        twice = fly(Walls.from_polylines([corners, corners]), (3.0, -7.0), velocity, radius, bounces=500).contacts
        different += int(np.count_nonzero(once["x"] != twice["x"]) + np.count_nonzero(once["y"] != twice["y"]))
        different += int(np.count_nonzero(once["edge"] != twice["edge"]))
    return counted(0, different, "numbers that differ; the same arithmetic on the same walls")
