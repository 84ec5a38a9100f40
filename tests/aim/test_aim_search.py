"""Aim by search: curves, discs at corners, gravity; beside closed forms, rounded walls and dense fans of shots."""

import math
from dataclasses import replace

import numpy as np
import pytest
from test_aim_unfolding import BOX, confirm, scene
from tracing import by_windows, room

import wallkit
from wallkit.kernels.records import in_lists
from wallkit.levels import obstacles, unfolding
from wallkit.levels import search as searching
from wallkit.levels.search import Shooter
from wallkit.levels.unfolding import unfold


def sinai(curves):
    return wallkit.Scene(wallkit.import_walls("samples/sinai.svg", curves=curves))


def test_the_drawn_arcs_of_sinai():
    """Counts and widths as 60,000 shots have them; by the usual facets a third of the width is wrong."""
    level = sinai("arcs")
    windows = wallkit.aim(level, (507, 132), (541, 254, 10), 3)
    assert windows.by_bounces.tolist() == [1, 4, 9, 22]
    widths = [float(windows.width[windows.bounces == k].sum()) for k in range(4)]
    assert widths == pytest.approx([2 * math.asin(10 / math.hypot(34, 122)), 0.2182, 0.149, 0.153], abs=1e-3)
    assert 0.7 < windows.searched_share < 0.8
    assert windows.resolution[0] == 1e-7
    names = windows.walls.names
    for (
        window
    ) in windows:  # what meets the pillar was searched, what meets the square alone was not, but near the pillar
        assert window.searched or "pillar" not in {names[wall] for wall in window.word}
    assert not all(windows.searched)
    confirm(level, windows)


def test_a_disc_in_a_box_is_a_point_in_a_smaller_one():
    disc = wallkit.aim(scene(BOX), (2, 3), (6.7, 4.1, 0.1), 6, 0.5)
    point = wallkit.aim(scene([[(0.5, 0.5), (9.5, 0.5), (9.5, 6.5), (0.5, 6.5)]]), (2, 3), (6.7, 4.1, 0.1), 6)
    assert disc.searched_share == 0.0
    assert disc.by_bounces.tolist() == point.by_bounces.tolist()
    assert disc.low == pytest.approx(point.low, abs=1e-13)
    assert disc.high == pytest.approx(point.high, abs=1e-13)


def test_a_disc_among_walls_is_a_point_among_rounded_ones():
    """A disc of radius 8 beside an open wall is a point beside a stadium: two lines and two half circles."""
    level = sinai("lines")
    frame = level.walls.take([level.walls.names.index("square")])
    ring = frame.vertices
    (x0, y0), (x1, y1) = ring.min(axis=0), ring.max(axis=0)
    smaller = [(x0 + 8, y0 + 8), (x0 + 8, y1 - 8), (x1 - 8, y1 - 8), (x1 - 8, y0 + 8)]
    a, b = np.array((300.0, 250.0)), np.array((340.0, 330.0))
    n = 8 * np.array((b - a)[::-1] * (1, -1)) / np.hypot(*(b - a))
    walls = wallkit.Walls.from_polylines([ring, [a, b]], closed=[True, False])
    stadium = wallkit.Walls.from_polylines([smaller, [a + n, b + n, b - n, a - n]], bulges=[None, [0.0, 1.0, 0.0, 1.0]])
    given = (507, 132), (541, 254, 10), 3
    disc, point = wallkit.aim(wallkit.Scene(walls), *given, 8), wallkit.aim(wallkit.Scene(stadium), *given)
    assert disc.by_bounces.tolist() == point.by_bounces.tolist()
    assert disc.by_bounces.sum() > 20
    assert disc.low == pytest.approx(point.low, abs=1e-10)
    assert disc.high == pytest.approx(point.high, abs=1e-10)
    assert 0.0 < disc.searched_share < 0.5
    assert any(letter < 0 for window in disc for letter in window.edges)  # off the ends of the wall
    confirm(wallkit.Scene(walls), disc, radius=8)


def test_no_shot_of_a_dense_fan_is_missed_or_wrong():
    """Discs in a room with corners, three bounces: 50,000 shots of the kernel that simulate flies with."""
    rings, start, target = room(2)
    level = scene(rings[:3])  # so few edges are not indexed, as in the test above: the same machine code
    windows = wallkit.aim(level, start, target, 3, 1.0)
    angle = -math.pi + 2 * math.pi * (np.arange(50_000) + 0.5) / 50_000
    flown = Shooter.of(level, start, target, 3, 1.0, 1.0).fly(angle)
    assert (by_windows(windows, angle) == flown.reached).all()
    assert 0.05 < windows.searched_share < 0.95
    confirm(level, windows, radius=1.0)


def test_beams_and_shots_are_the_same_interpreted(monkeypatch):
    """One source: compiled and interpreted kernels give the same bits."""
    level = sinai("arcs")
    shooter = Shooter.of(level, (507, 132), (541, 254, 10), 3, 0.0, 1.0)
    angle = np.linspace(-3, 3, 40)
    fast = shooter.fly(angle)
    rings, start, target = room(0)
    found = obstacles.obstacles_of(scene(rings).walls, 0.0)
    beams = unfold(found, start, target, 2, 10**6)
    monkeypatch.setattr(searching, "compiled", lambda kernel: kernel)
    monkeypatch.setattr(unfolding, "compiled", lambda kernel: kernel)
    shooter.modelled.model = in_lists(shooter.modelled.model)
    for mine, theirs in zip(fast, shooter.fly(angle), strict=True):
        assert mine.tobytes() == theirs.tobytes()
    for mine, theirs in zip(beams, unfold(found, start, target, 2, 10**6), strict=True):
        assert np.asarray(mine).tobytes() == np.asarray(theirs).tobytes()


def interpreted(monkeypatch):
    """Few shots, by interpreted kernels: no other test needs these compiled."""
    flies = Shooter.of

    def of(*given):
        shooter = flies(*given)
        shooter.modelled.model = in_lists(shooter.modelled.model)
        return replace(shooter, sensors=in_lists(shooter.sensors))

    monkeypatch.setattr(searching, "compiled", lambda kernel: kernel)
    monkeypatch.setattr(Shooter, "of", staticmethod(of))
    monkeypatch.setattr(searching, "FIRST_STEP", 2 * math.pi / 180)
    monkeypatch.setattr(searching, "POLISHED", 1e-9)


def test_under_gravity_two_parabolas_reach_a_target(monkeypatch):
    """With v = 10 and g = 10 a shot from the origin comes back to its height at x = 10 sin 2 t: t = asin(0.6) / 2, or
    90 degrees less that."""
    interpreted(monkeypatch)
    floor = wallkit.Walls.from_polylines([[(-30, -0.5), (30, -0.5)]], closed=False)
    windows = wallkit.aim(wallkit.Scene(floor, gravity=(0, -10)), (0, 0), (6, 0, 0.2), 0, speed=10, resolution=1e-3)
    flat = math.asin(0.6) / 2
    assert len(windows) == 2
    assert windows.searched_share == 1.0
    assert [window.middle for window in windows] == pytest.approx([flat, math.pi / 2 - flat], abs=2e-3)
    # how wide: the rim passes r = 0.2 beside the path; that is r / |d place / d t| at the target, to first order
    for window, t in zip(windows, (flat, math.pi / 2 - flat), strict=True):
        time = 6 / (10 * math.cos(t))
        velocity = np.array([10 * math.cos(t), 10 * math.sin(t) - 10 * time])
        moved = 10 * time * np.array([-math.sin(t), math.cos(t)])
        across = abs(moved[0] * velocity[1] - moved[1] * velocity[0]) / np.hypot(*velocity)
        assert window.width == pytest.approx(2 * 0.2 / across, rel=0.02)


def test_rolling_friction_lets_a_ball_fall_short(monkeypatch):
    """With v = 10 and a = 5 it rolls v^2 / (2 a) = 10: to the target at 9, not to the one at 11."""
    interpreted(monkeypatch)
    wall = wallkit.Walls.from_polylines([[(4, -9), (4, 9)]], closed=False)
    level = wallkit.Scene(wall, rolling_friction=5)
    near, far = (wallkit.aim(level, (0, 0), (x, 0, 0.5), 1, speed=10, resolution=1e-3) for x in (-9, -11))
    assert near.by_bounces.tolist() == [1, 0]
    assert len(far) == 0
    assert near.widest.width == pytest.approx(2 * math.asin(0.5 / 9), abs=1e-8)
    back = wallkit.aim(level, (0, 0), (-1, 0, 0.25), 1, speed=10, resolution=1e-3)
    assert back.by_bounces.tolist() == [1, 1]  # the image is at 9
    assert back[0 if back[0].bounces else 1].width == pytest.approx(2 * math.asin(0.25 / 9), abs=1e-8)


def test_the_search_tells_its_limit():
    with pytest.raises(wallkit.LimitError, match="more shots") as told:
        wallkit.aim(sinai("arcs"), (507, 132), (541, 254, 10), 6, most_beams=20_000)
    assert told.value.code == "too-many-shots"


def test_nothing_moves_from_a_dead_wall(monkeypatch):
    """A wall with restitution 0 cannot be unfolded: the ball goes on along it, and everything is searched."""
    interpreted(monkeypatch)
    dead = wallkit.Material(restitution=0.0)
    wall = wallkit.Walls.from_polylines([[(0, -30), (0, 30)]], closed=False, material=dead)
    windows = wallkit.aim(wallkit.Scene(wall), (-3, 0), (0, 12, 0.5), 1, resolution=1e-3)
    assert windows.searched_share == 1.0
    up = next(window for window in windows if window.bounces == 1)  # whatever meets the wall below the target
    assert up.low == pytest.approx(0.0, abs=1e-6)
