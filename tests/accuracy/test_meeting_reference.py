"""Discs that meet beside the judge of 40 digits, and what their horizon promises beside where they really part."""

from __future__ import annotations

import math

import numpy as np
import pytest

import wallkit
from wallkit.accuracy.reference_pairs import PairsReference
from wallkit.accuracy.sure_digits import PrecisionError
from wallkit.scene.start_overlaps import clearances

TOLERANCE = 1e-6


def random_room(seed: int, hops: bool = False) -> wallkit.Scene:
    """Two to eight discs, some with masses and restitution, in a room with things in it, some of them round.

    With ``hops`` under gravity that makes them lie down, on walls that take much of their speed.
    """
    random = np.random.default_rng(seed)
    width, height = random.uniform(8, 16, 2)
    outlines = [np.array([(0, 0), (0, height), (width, height), (width, 0)])]
    bulges = [random.uniform(-0.2, 0.2, 4) * (random.random(4) < 0.2)]
    for _ in range(int(random.integers(0, 3))):
        angle = np.sort(random.uniform(0, 2 * math.pi, 3))
        middle = random.uniform((2, 2), (width - 2, height - 2))
        outlines.append(middle + random.uniform(0.3, 1) * np.stack([np.cos(angle), np.sin(angle)], axis=1))
        bulges.append(random.uniform(-1, 1, 3) * (random.random(3) < 0.4))
    gravity = tuple(random.normal(size=2)) if seed % 3 == 0 else None
    lossy = wallkit.Material(*random.uniform(0.8, 1, 2)) if gravity is None and seed % 2 else wallkit.Material()
    if hops:
        gravity, lossy = (random.normal() / 4.0, -3.0), wallkit.Material(*random.uniform((0.0, 0.7), (0.5, 1.0)))
    walls = wallkit.Walls.from_polylines(outlines, bulges=bulges, material=lossy)
    places: list[np.ndarray] = []
    radii: list[float] = []
    for _ in range(int(random.integers(2, 9)) * 30):
        radius = float(random.choice([0.25, 0.4, 0.6]))
        place = random.uniform((radius, radius), (width - radius, height - radius))
        free = clearances(walls, place[None], np.array([9.0]))[0][0] > 1.3 * radius
        if free and all(math.hypot(*(place - other)) > radius + its for other, its in zip(places, radii, strict=True)):
            places.append(place)
            radii.append(radius)
        if len(places) == 8:
            break
    count = len(places)
    balls = wallkit.Balls(places, random.normal(size=(count, 2)), radii, random.uniform(0.5, 4, count))
    e, f = (random.uniform(0.2 if hops else 0.6, 1, 2).tolist()) if hops or seed % 4 == 1 else (1.0, 1.0)
    return wallkit.Scene(walls, balls, gravity, meeting=True, ball_restitution=e, ball_tangential_restitution=f)


def good_and_promised(scene: wallkit.Scene, each: int) -> list[tuple[int, int]]:
    """(contacts really good to ``TOLERANCE``, contacts promised) for each ball, of some ``each`` a ball."""
    events = PairsReference(scene).run(each * len(scene.balls))
    run = wallkit.simulate(scene, until=float(events[-1].time), mode="interpreted")
    promised = run.trusted_until(TOLERANCE)
    found = []
    for ball in range(len(scene.balls)):
        true = [(e.other, e.wall, e.position) for e in events if e.ball == ball]
        both = [(e.time, e.other, e.wall, e.position) for e in events if e.ball == ball]
        both += [(e.time, e.ball, -1, e.other_position) for e in events if e.other == ball]
        true = [row[1:] for row in sorted(both, key=lambda row: row[0])]
        own, good = run.contacts_of(ball), 0
        for (other, wall, place), mine in zip(true, own, strict=False):
            off = math.hypot(float(place[0]) - mine["x"], float(place[1]) - mine["y"])
            if (other, wall) != (mine["other"], mine["wall"]) or not off <= TOLERANCE:
                break
            good += 1
        found.append((good, min(promised[ball].bounces, len(true))))
    return found


@pytest.mark.parametrize("seed", range(30))
def test_no_contact_is_worse_than_the_horizon_promises(seed: int) -> None:
    found = good_and_promised(random_room(seed), 12)
    assert all(promised <= good for good, promised in found)
    assert sum(promised for _good, promised in found) >= 0.3 * sum(good for good, _promised in found)


@pytest.mark.parametrize("seed", range(6))
def test_no_contact_of_discs_that_hop_is_worse_than_promised(seed: int) -> None:
    found = good_and_promised(random_room(seed, hops=True), 40)
    assert all(promised <= good for good, promised in found)
    assert sum(promised for _good, promised in found) >= 0.2 * sum(good for good, _promised in found)


def test_the_judge_hops_as_the_closed_form_says() -> None:
    """From the height 1 with e = 0.01: hops of v = sqrt(2 g r / 4096), 2 v / g each."""
    walls = wallkit.Walls.from_polylines([[(0, 0), (10, 0)]], closed=False, material=wallkit.Material(0.01))
    balls = wallkit.Balls([(5, 1.5), (8, 4)], [(0, 0), (0, 9)], 0.5)
    scene = wallkit.Scene(walls, balls, (0.0, -10.0), meeting=True, ball_restitution=0.5)
    v = math.sqrt(2 * 10 * 0.5 / 4096)
    after = max(0.01 * math.sqrt(20.0), v)
    expected = [math.sqrt(0.2) + (0 if k == 0 else 2 * after / 10 + 2 * v / 10 * (k - 1)) for k in range(20)]
    assert [float(event.time) for event in PairsReference(scene).run(20)] == pytest.approx(expected, rel=1e-14)
    run = wallkit.simulate(scene, until=expected[-1] + 0.001, mode="interpreted")
    assert run.contacts["time"] == pytest.approx(expected, rel=1e-14)


@pytest.mark.parametrize(("digits", "bounces"), [(0, 3), (1, 31), (2, 314)])
def test_the_judge_counts_the_digits_of_pi(digits: int, bounces: int) -> None:
    balls = wallkit.Balls([(2, 0), (4, 0)], [(0, 0), (-1, 0)], 0.5, mass=[1.0, 100.0**digits])
    wall = wallkit.Walls.from_polylines([[(0, -5), (0, 5)]], closed=False)
    assert len(PairsReference(wallkit.Scene(wall, balls, meeting=True)).run(1000)) == bounces


def test_the_judge_passes_on_a_cradle_in_the_stated_order() -> None:
    places = [(1.5, 5.0), (2.5, 5.0), (5.0, 5.0), (6.0, 5.0), (7.0, 5.0)]
    balls = wallkit.Balls(places, [(1, 0), (1, 0), (0, 0), (0, 0), (0, 0)], 0.5)
    scene = wallkit.Scene(wallkit.Walls.from_polylines([[(0, 0), (0, 10)]], closed=False), balls, meeting=True)
    met = [(event.ball, event.other) for event in PairsReference(scene).events()]
    assert met == wallkit.simulate(scene, bounces=50).contacts[["ball", "other"]].tolist()


def test_balls_far_from_what_is_in_doubt_are_trusted_on() -> None:
    # Two discs that pass by 1e-14 on the left decide nothing for the one that goes to and fro on the right.
    walls = wallkit.Walls.from_polylines([[(0, 0), (0, 10), (200, 10), (200, 0)]])
    balls = wallkit.Balls([(20, 5.0), (30, 6.0 + 1e-14), (190, 5)], [(1, 0), (-1, 0), (2, 0)], 0.5)
    run = wallkit.simulate(wallkit.Scene(walls, balls, meeting=True), until=40.0)
    said = run.trusted_until(TOLERANCE)
    assert [horizon.reason for horizon in said[:2]] == ["meeting", "meeting"]
    assert said[2].bounces > 0


def test_what_has_no_judge_is_refused() -> None:
    scene = wallkit.Scene(
        wallkit.Walls.from_polylines([[(0, 0), (0, 9)]], closed=False), wallkit.Balls([(1, 1)], [(1, 1)])
    )
    with pytest.raises(PrecisionError, match="only discs that meet"):
        PairsReference(scene)
