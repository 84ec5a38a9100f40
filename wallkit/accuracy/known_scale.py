"""Known answers far out, tiny, huge, nearly parallel, nearly closed: where doubles are short of digits."""

from __future__ import annotations

import math
from functools import partial

import numpy as np

from wallkit.accuracy import scenes
from wallkit.accuracy.cases import Verdict, add, case, counted, fly, measured, nothing
from wallkit.scene.scene import Balls, Scene
from wallkit.walls import Walls

SPEED = 50.0
_FORWARD = (SPEED * math.cos(0.5), SPEED * math.sin(0.5))


def dyadic_star(bits: int = 16) -> Walls:
    """Make the star with corners rounded to multiples of 2^-bits, so that shifts by 2^30 are exact."""
    return Walls.from_polylines([np.round(scenes.star().vertices * 2**bits) / 2**bits])


def _shifted(radius: float) -> Verdict:
    walls, start = dyadic_star(), np.array([3.0, -7.0])
    shift = np.array([2.0**30, -(2.0**30)])
    far = Walls.from_polylines([walls.vertices + shift])
    here = fly(walls, start, _FORWARD, radius, bounces=1000).contacts
    there = fly(far, start + shift, _FORWARD, radius, bounces=1000).contacts
    different = sum(
        int(np.count_nonzero(here[name] != there[name])) for name in ("time", "vx", "vy", "nx", "ny", "edge")
    )
    different += sum(
        int(np.count_nonzero(here[name] + s != there[name])) for name, s in (("x", shift[0]), ("y", shift[1]))
    )
    return counted(0, different, "numbers that differ: the origin is moved by a power of two, which is exact")


def _scaled(power: int) -> Verdict:
    walls, factor = scenes.star(), 2.0**power
    different = 0
    for radius in (0.0, 5.0):
        here = fly(walls, (3.0, -7.0), _FORWARD, radius, bounces=1000).contacts
        velocity = (_FORWARD[0] * factor, _FORWARD[1] * factor)
        scaled = Walls.from_polylines([walls.vertices * factor])
        there = fly(scaled, (3.0 * factor, -7.0 * factor), velocity, radius * factor, bounces=1000).contacts
        different += int(np.count_nonzero(here["time"] != there["time"]))
        different += sum(int(np.count_nonzero(here[name] * factor != there[name])) for name in ("x", "y", "vx", "vy"))
    return counted(0, different, "numbers that differ: a power of two scales every rounding with it")


for _radius in (0.0, 5.0):
    add(f"shift by 2^30, r = {_radius:g}", "scale", "the star moved by 2^30: the same bits", partial(_shifted, _radius))
for _power in (-40, -20, 20, 40):
    add(f"scale by 2^{_power}", "scale", "star, ball and speed scaled: the same bits, scaled", partial(_scaled, _power))


def _box_at(corner: float, size: float) -> Verdict:
    """Crossing times of a box far from the origin, or tiny, or huge, against size / speed."""
    points = np.array([(0, 0), (0, size), (size, size), (size, 0)], dtype=float) + corner
    start = np.array([corner + size / 4, corner + size / 2])
    contacts = fly(Walls.from_polylines([points]), start, (size, 0.0), 0.0, bounces=101).contacts
    got = float(contacts["time"][-1] - contacts["time"][0])
    # Positions are good to a rounding of the largest coordinate; the walls themselves are no better there.
    why = "a rounding of the coordinate each bounce"
    return measured(100.0, got, 100 * 2 * 2.0**-53 * (1 + abs(corner) / size) + 100 * 2.0**-52, why)


for _corner, _size in ((1e9, 1.0), (0.0, 1e-6), (0.0, 1e9), (-1e6, 1e-3)):
    add(
        f"box of {_size:g} at {_corner:g}",
        "scale",
        "100 crossings in 100 times the size over the speed",
        partial(_box_at, _corner, _size),
    )


@case("near-parallel walls", "two walls 1e-9 rad from parallel: drift that a million bounces would hide")
def near_parallel() -> Verdict:
    """Unfolded, the n-th crossing turns by n angles: the direction after n bounces is known."""
    angle = 1e-9
    walls = Walls.from_polylines(
        [[(-1e6, 0.0), (1e6, 0.0)], [(-1e6, 1.0), (1e6, 1.0 + 2e6 * math.tan(angle))]], closed=False
    )
    contacts = fly(walls, (0.0, 0.5), (0.0, -1.0), bounces=2_000).contacts
    upward = np.abs(np.arctan2(contacts["vx"], np.abs(contacts["vy"])))
    expected = 2 * angle * (np.arange(1, len(contacts) + 1) // 2)
    bound = 2_000 * 4 * 2.0**-53
    return nothing(
        "2 n angle", float(np.abs(upward - expected).max()), bound, "two roundings of the direction a bounce"
    )


@case("nearly closed gap", "a disc before a gap of 2 r (1 - 1e-12) must not pass, before 2 r (1 + 1e-12) it must")
def nearly_closed_gap() -> Verdict:
    """The gap between two corners is the width between two circles of radius r."""
    passed = []
    for excess in (-1e-12, 1e-12):
        half = 5.0 * (1 + excess)
        walls = Walls.from_polylines([[(0.0, half), (0.0, 100.0)], [(0.0, -half), (0.0, -100.0)]], closed=False)
        run = fly(walls, (-50.0, 0.0), (SPEED, 0.0), 5.0, until=3.0)
        passed.append(bool(run.final["x"][0] > 0.0))
    words = " and ".join("passes" if p else "stops" for p in passed)
    return Verdict("stops and passes", words, float(passed != [False, True]), 0.0, "1e-12 r is far above a rounding")


@case("grazing a corner", "discs that pass a corner by 1e-9 r, on either side")
def grazing_corner() -> Verdict:
    """Inside by a depth h the normal turns the disc by 2 asin-sized angles, outside nothing happens."""
    stick = Walls.from_polylines([[(0.0, 0.0), (0.0, -50.0)]], closed=False)
    r, depth = 5.0, 5e-9
    missed = fly(stick, (-40.0, r + depth), (SPEED, 0.0), r, bounces=1).contacts
    hit = fly(stick, (-40.0, r - depth), (SPEED, 0.0), r, bounces=1).contacts
    if len(missed) or not len(hit):
        return Verdict("one hit", f"{len(hit)} and {len(missed)} hits", 1.0, 0.0, "counts")
    # |v.n| / v = sqrt(1 - (1 - h / r)^2) =: c, and the direction turns by 2 asin(c); h is a difference of doubles
    given = r - (r - depth)
    c = math.sqrt((2 - given / r) * given / r)
    turned = math.atan2(float(hit["vy"][0]), float(hit["vx"][0]))
    # the depth is the rounded distance's, 2^-53 r, so its root is off by 2^-53 r / (2 h) of itself, and 8 for care
    return measured(2 * math.asin(c), turned, 8 * 2 * c * 2.0**-53 * r / (2 * depth), "the depth's own rounding")


@case("fast ball", "a million times the size a second: walls are met all the same")
def fast_ball() -> Verdict:
    """Nothing is stepped, so nothing tunnels: exactly as many crossings as the width allows."""
    contacts = fly(scenes.box(1.0, 1.0), (0.5, 0.5), (1e6, 0.0), bounces=10_000).contacts
    expected = (0.5 + 9_999) / 1e6
    bound = 10_000 * 2.0**-53 * expected + 2.0**-52
    return measured(expected, float(contacts["time"][-1]), bound, "a rounding of the time each bounce")


@case("corridor escape", "1,000 points in a maze for 100 s: none may be outside")
def maze_keeps() -> Verdict:
    """No point passes the outer wall."""
    from wallkit.simulation.survey import survey

    random = np.random.default_rng(17)
    turns = random.uniform(0, math.tau, 1_000)
    velocity = SPEED * np.stack([np.cos(turns), np.sin(turns)], axis=1)
    totals = survey(Scene(scenes.maze(), Balls(np.tile([216.7, 216.7], (1_000, 1)), velocity)), until=100.0)
    inside = np.all((totals.position >= -1e-9) & (totals.position <= 400.0 + 1e-9), axis=1)
    return counted(0, int(np.count_nonzero(~inside)), "points outside")
