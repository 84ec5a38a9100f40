"""Flights under gravity against arcs and corners: nearly straight sides keep their balls, roots keep their digits."""

import itertools
import math

import mpmath
import numpy as np
import pytest

from wallkit import Balls, Ending, Material, Scene, Walls, simulate, survey
from wallkit.kernels.impact.arc_fall import fall_arcs
from wallkit.kernels.impact.gravity_impact import fall_corners
from wallkit.kernels.impact.polynomial_roots import NEVER
from wallkit.kernels.records import NO_HIT, Corner, in_lists
from wallkit.simulation.edge_records import arcs_of, lines_of
from wallkit.simulation.run import ContactKind

ROOM = [[0, 0], [0, 280], [400, 280], [400, 0]]


def thrown(walls, radius, count=60, speed=100.0, start=(200.0, 140.0)):
    angle = np.random.default_rng(1).uniform(0, 2 * np.pi, count)
    velocity = speed * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    return Scene(walls, Balls(np.tile(start, (count, 1)), velocity, radius), gravity=(0.0, -100.0))


@pytest.mark.parametrize("bulge", [5e-3, 1e-4, 1e-6, 1e-9, 1e-12])
@pytest.mark.parametrize("bows", [1, -1])
def test_points_stay_in_a_room_whose_sides_are_nearly_straight_arcs(bulge, bows):
    room = Walls.from_polylines([ROOM], bulges=[[bows * bulge] * 4])
    totals = survey(thrown(room, 0.0), until=120.0)
    x, y = totals.position.T
    bow = 200 * bulge + 1e-9  # half a chord times the bulge is how far an arc bows
    assert not np.any(totals.ending == Ending.LEFT_SCENE)
    assert min(x.min(), y.min()) > -bow
    assert max(x.max() - 400, y.max() - 280) < bow


@pytest.mark.parametrize("radius", [0.0, 8.0])
def test_an_arc_that_gets_flatter_goes_over_into_its_chord_without_a_step(radius):
    # a chord is off from its arc by 200 bulge in place and by 2 bulge in direction: a flight of a few bounces, each of
    # which makes an error some three times as large, ends within 1e5 bulge of where it does among lines
    lines = simulate(thrown(Walls.from_polylines([ROOM]), radius, count=12), bounces=5)
    for bulge in (1e-5, 1e-7, 1e-9, 1e-11, 1e-13):
        arcs = simulate(thrown(Walls.from_polylines([ROOM], bulges=[[bulge] * 4]), radius, count=12), bounces=5)
        assert list(arcs.contacts["edge"]) == list(lines.contacts["edge"])
        for name in ("x", "y", "time"):
            assert arcs.contacts[name] == pytest.approx(lines.contacts[name], rel=1e-12, abs=1e5 * bulge)


def test_a_contact_with_a_corner_is_known_to_the_rounding_of_its_place():
    # |e + v t + g t^2 / 2| = r in 40 digits; e, v and g of the size of a drawing. The place is rounded by some 2^-52 of
    # what is summed up in it, and the time by as much over the closing speed: 16 of these are allowed
    rng = np.random.default_rng(3)
    found = 0
    with mpmath.workdps(40):
        while found < 60:
            x, y, vx, vy = (float(v) for v in rng.uniform(-200, 200, 4))
            radius, gravity = float(rng.choice([0.5, 5.0])), -100.0
            t, feature = fall_corners(
                [Corner(0.0, 0.0, 0.0, 0.0)], [0], 0, 1, None, [0], None, radius, x, y, vx, vy, 0.0, gravity,
                None, math.inf, NO_HIT, 1e-9, 0.0, NEVER, math.inf, NO_HIT,
            )  # fmt: skip
            if feature == NO_HIT:
                continue
            found += 1
            at = mpmath.mpf(t)
            px, py = x + vx * at, y + vy * at + mpmath.mpf(gravity) * at * at / 2
            ux, uy = vx, vy + gravity * at
            gap, closing = mpmath.hypot(px, py) - radius, -(px * ux + py * uy) / mpmath.hypot(px, py)
            size = abs(x) + abs(y) + (abs(vx) + abs(vy)) * t + abs(gravity) * t * t
            assert abs(gap) <= 16 * 2.0**-52 * (size + closing * t)


@pytest.mark.parametrize("seed", range(3))
def test_a_window_of_time_leaves_out_no_contact_in_it(seed):
    # any arc and corner asked for all time, and for windows that end or begin at the contact: the same bits
    rng = np.random.default_rng(seed)
    found = 0
    for _ in range(400):
        a, b, place = rng.uniform(-100, 100, (3, 2))
        velocity, radius, bulge = rng.uniform(-60, 60, 2), float(rng.choice([0.0, 3.0])), float(rng.uniform(-3, 3))
        lines = lines_of(np.array([a, b]), np.array([0, 2]), np.array([False]), np.zeros(2)).records
        arcs = in_lists(arcs_of(lines, np.array([bulge])))
        corners = [Corner(*a.tolist(), 0.0, 0.0)]
        flight = *place.tolist(), *velocity.tolist(), 0.0, -50.0

        def ask(now, until, best, radius=radius, arcs=arcs, corners=corners, flight=flight):
            best, feature, _touched = fall_arcs(
                arcs, [0], 0, 1, None, [0], radius, *flight, None, math.inf, NO_HIT, NO_HIT, 1e-10, (0.0, 0.0), now,
                until, best, NO_HIT,
            )  # fmt: skip
            if radius > 0.0:
                best, feature = fall_corners(
                    corners, [0], 0, 1, None, [0], None, radius, *flight, None, math.inf, NO_HIT, 1e-10, now, until,
                    best, feature,
                )  # fmt: skip
            return best, feature

        free = ask(0.0, NEVER, math.inf)
        if free[1] == NO_HIT:
            continue
        found += 1
        for before, after in itertools.product((1.0, 0.5, 0.0), (1.0, 1.5)):
            assert ask(before * free[0], after * free[0], math.inf) == free
        assert ask(0.0, NEVER, math.nextafter(free[0], math.inf)) == free
    assert found > 100


def into_the_tip(seed, restitution, bulge):
    """A point thrown up into the tip of a random tent, below which there is a floor at y = 0: the tip and its run."""
    rng = np.random.default_rng(seed)
    left, opening = rng.uniform(-160.0, -95.0), rng.uniform(20.0, 80.0)
    sides = np.radians([left, max(left + opening, -85.0)])
    tip = np.array([rng.uniform(-3.0, 3.0), rng.uniform(8.0, 12.0)])
    feet = [(tip[0] + tip[1] * math.cos(side) / -math.sin(side), 0.0) for side in sides]
    walls = Walls.from_polylines([[feet[0], tip, feet[1]]], bulges=[[0.0, bulge, 0.0]], material=Material(restitution))
    down = np.stack([np.cos(sides), np.sin(sides)], axis=1).sum(axis=0)
    up = -down / np.hypot(*down) + rng.uniform(-0.01, 0.01, 2)
    return tip, simulate(Scene(walls, Balls([tip - 2.0 * up], [40.0 * up]), gravity=(0.0, -30.0)), until=20.0)


@pytest.mark.parametrize("restitution", [0.0, 0.1])
def test_a_point_that_stops_in_the_tip_of_a_ceiling_falls_straight_down_from_it(restitution):
    # Straight down is within the tip: nothing holds the point there, and it falls h to the floor in sqrt(2 h / g).
    stopped = 0
    for seed in range(60):
        tip, run = into_the_tip(seed, restitution, 0.0)
        contacts = run.contacts
        there = np.flatnonzero(np.hypot(contacts["x"] - tip[0], contacts["y"] - tip[1]) < 1e-8)
        if len(there):
            last, landed = contacts[there[-1] : there[-1] + 2]
            assert landed["x"] == pytest.approx(tip[0], abs=1e-6)
            assert landed["y"] == pytest.approx(0.0, abs=1e-12)
            assert landed["time"] - last["time"] == pytest.approx(math.sqrt(2.0 * tip[1] / 30.0), abs=1e-6)
            stopped += 1
    assert stopped >= 20


@pytest.mark.parametrize("bulge", [-0.1, 0.08])
@pytest.mark.parametrize("restitution", [0.0, 0.1, 0.5])
def test_points_thrown_into_the_tip_of_a_line_and_an_arc_stay_in_the_tent(restitution, bulge):
    for seed in range(60):
        _tip, run = into_the_tip(seed, restitution, bulge)
        assert run.ending[0] != Ending.LEFT_SCENE, seed
        assert run.contacts["y"].min() > -1e-9, seed


@pytest.mark.parametrize("bulge", [0.0, -0.3, 0.3])
def test_a_point_that_runs_along_an_overhang_off_its_end_meets_no_face_that_looks_away(bulge):
    # Restitution 0 sends it along the overhang, 1e-6 before its end: exactly by the corner, from which the room goes
    # on upwards. It flies on as if nothing were there, and comes down to the floor at (10, 0) to (40, 0).
    room = [(0.0, 0.0), (0.0, 10.0), (10.0, 14.0), (20.0, 40.0), (40.0, 40.0), (40.0, 0.0)]
    walls = Walls.from_polylines([room], bulges=[[0.0, bulge / 10, bulge, 0.0, 0.0, 0.0]], material=Material(0.0))
    for back in np.geomspace(1e-9, 1e-3, 40):
        way = np.array([10.0, 4.0]) / math.hypot(10.0, 4.0)
        start = np.array([10.0, 14.0]) - back * way + np.array([0.5, -2.0])
        velocity = 30.0 * (np.array([10.0, 14.0]) - back * way - start) + (0.0, 0.5)
        run = simulate(Scene(walls, Balls([start], [velocity]), gravity=(0.0, -30.0)), until=30.0)
        assert run.ending[0] != Ending.LEFT_SCENE, back
        assert run.contacts["x"].min() > 0.0, back


@pytest.mark.parametrize("mode", ["interpreted", "compiled"])
@pytest.mark.parametrize("arms", [0, 80])  # few edges, and so many that there is an index
def test_a_point_meets_no_corner_though_the_discs_of_its_scene_do(mode, arms):
    # It falls down a side into the corner below, where it hops on the floor: by sqrt(2 h / g), and then by 2 e^k of it.
    x = 50.0 + 2.0 * np.arange(arms)
    lines = [ROOM, *np.stack([np.stack([x, x + 1.0], axis=1), np.full((arms, 2), 20.0)], axis=2)]
    walls = Walls.from_polylines(lines, closed=[True] + [False] * arms, material=Material(0.8, 0.9))
    balls = Balls([[0.0, 280.0], [200.0, 140.0]], [[0.0, 0.0], [3.0, 1.0]], radius=[0.0, 0.5])
    scene = Scene(walls, balls, gravity=(0.0, -100.0))
    run = simulate(scene, bounces=9, mode=mode)
    hops = run.contacts_of(0)
    hops = hops[hops["kind"] == ContactKind.EDGE]
    first = math.sqrt(2 * 280 / 100)
    expected = first * (1 + 2 * np.cumsum([0.0, *0.8 ** np.arange(1, 9)]))
    np.testing.assert_allclose(hops["time"], expected, rtol=1e-14)
    assert (hops["edge"] == 3).all()
    assert not (run.contacts_of(0)["kind"] == ContactKind.VERTEX).any()
    assert survey(scene, bounces=9).position[0].tolist() == run.position(float(hops["time"][-1]))[0].tolist()
