"""Known answers of what acts: restitution, collapse, gravity, rest."""

from __future__ import annotations

import math
from functools import partial

import numpy as np

from wallkit.accuracy import scenes
from wallkit.accuracy.cases import Verdict, add, case, fly, measured, nothing
from wallkit.walls import Material, Walls

SPEED = 50.0
EPS = 2.0**-53


@case("restitution 0.9 and 0.9", "slow down by 10 % a bounce: the speed after n bounces is 0.9^n of the first")
def slow_down() -> Verdict:
    """Both parts of the velocity shrink alike."""
    walls = Walls.from_polylines([scenes.star().vertices], material=Material(0.9, 0.9))
    contacts = fly(walls, (3.0, -7.0), (SPEED * math.cos(0.5), SPEED * math.sin(0.5)), 5.0, bounces=100).contacts
    speed = np.hypot(contacts["vx"], contacts["vy"])
    expected = SPEED * 0.9 ** np.arange(1, len(contacts) + 1)
    error = float(np.abs(speed / expected - 1).max()) if len(contacts) == 100 else math.inf
    return nothing("50 * 0.9^n", error, 100 * 8 * EPS, "a few roundings a bounce")


def _collapse(degrees: float, ratio: float, collapses: bool, radius: float) -> Verdict:
    """In a wedge of angle a, infinitely many bounces in finite time if e <= (1 - sin a) / (1 + sin a)."""
    angle = math.radians(degrees)
    limit = (1 - math.sin(angle)) / (1 + math.sin(angle))
    material = Material(restitution=limit * ratio)
    end = (1000.0 * math.cos(angle), 1000.0 * math.sin(angle))
    walls = Walls.from_polylines([[(0.0, 0.0), (1000.0, 0.0)], [(0.0, 0.0), end]], closed=False, material=material)
    middle = (100.0 * math.cos(angle / 2), 100.0 * math.sin(angle / 2))
    turn = math.pi + angle / 2 + 0.2 * angle
    run = fly(walls, middle, (SPEED * math.cos(turn), SPEED * math.sin(turn)), radius, bounces=100_000)
    label = getattr(run.ending[0], "label", str(run.ending[0]))
    wanted = "collapse" if collapses else "left the scene"
    return Verdict(wanted, label, float(label != wanted), 0.0, f"e is {ratio:g} times {limit:.4g}")


for _degrees in (10.0, 30.0, 60.0):
    for _radius in (0.0, 1.0):
        add(
            f"collapse in {_degrees:g} degrees, r = {_radius:g}",
            "motion",
            "just inside the condition a ball never leaves the wedge, and is told so",
            partial(_collapse, _degrees, 0.9, True, _radius),
        )


def drop(restitution: float, height: float = 1.0, gravity: float = 9.81) -> Verdict:
    """A dropped ball rests at T = sqrt(2 h / g) (1 + e) / (1 - e)."""
    floor = Walls.from_polylines([[(-1.0, 0.0), (1.0, 0.0)]], closed=False, material=Material(restitution=restitution))
    run = fly(floor, (0.0, height), (0.0, 0.0), gravity=(0.0, -gravity), until=200.0)
    expected = math.sqrt(2 * height / gravity) * (1 + restitution) / (1 - restitution)
    label = getattr(run.ending[0], "label", str(run.ending[0]))
    if label != "at rest":
        return Verdict(f"{expected:.12g} s, at rest", label, math.inf, 0.0, "how it ended")
    # Each bounce loses its part of speed with a rounding or two; after n they have grown to n EPS of what is
    # left, sum over n of n e^n = e / (1 - e)^2 of the first flight.
    bound = expected * EPS * (8 + 4 / (1 - restitution) ** 2)
    return measured(expected, float(run.final["time"][0]), bound, "roundings of the speed, summed over the bounces")


for _restitution in (0.5, 0.9, 0.99):
    add(
        f"dropped ball, e = {_restitution:g}",
        "motion",
        "infinitely many bounces, and at rest in finite time",
        partial(drop, _restitution),
    )


@case("bouncing for ever", "1,000 bounces under gravity without loss: the height comes back each time")
def for_ever() -> Verdict:
    """Energy v^2 / 2 + g y is conserved."""
    floor = Walls.from_polylines([[(-1e6, 0.0), (1e6, 0.0)]], closed=False)
    contacts = fly(floor, (0.0, 2.0), (1.0, 0.0), 0.25, gravity=(0.0, -9.81), bounces=1000).contacts
    energy = (contacts["vx"] ** 2 + contacts["vy"] ** 2) / 2 + 9.81 * contacts["y"]
    first = 0.5 + 9.81 * 2.0
    error = float(np.abs(energy - first).max()) if len(contacts) == 1000 else math.inf
    return nothing("energy", error, 1000 * 8 * EPS * first, "a few roundings a bounce")


@case("throw", "a point thrown at 45 degrees lands at v^2 / g")
def throw() -> Verdict:
    """Range v^2 sin(2 a) / g; the velocity given is rounded, and that is what is thrown."""
    floor = Walls.from_polylines([[(-1.0, 0.0), (1000.0, 0.0)]], closed=False)
    v = SPEED / math.sqrt(2)
    contacts = fly(floor, (0.0, 0.0), (v, v), gravity=(0.0, -9.81), bounces=1).contacts
    expected = 2 * v * v / 9.81
    got = float(contacts["x"][0]) if len(contacts) else math.inf
    return measured(expected, got, 8 * math.ulp(expected), "four operations")
