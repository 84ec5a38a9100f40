"""Aim among straight walls: closed forms, a table measured by another program, and a plain tracer of rays."""

import math

import numpy as np
import pytest
from tracing import by_windows, room, trace

import wallkit

BOX = [[(0, 0), (10, 0), (10, 7), (0, 7)]]
SEEN = (2.0, 3.0), (6.7, 4.1)


def scene(rings, **walls):
    return wallkit.Scene(wallkit.Walls.from_polylines(rings, **walls))


def confirm(level, windows, radius=0.0):
    """The middle of each window, flown, passes the target after as many bounces off the same walls, not before."""
    angle = np.array([window.middle for window in windows])
    velocity = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    balls = wallkit.Balls(np.tile(windows.start, (len(angle), 1)), velocity, radius)
    run = wallkit.simulate(wallkit.Scene(level.walls, balls), bounces=windows.most_bounces + 1)
    x, y, r = windows.target
    for ball, window in enumerate(windows):
        own = run.contacts_of(ball)
        places = np.array([windows.start, *zip(own["x"], own["y"], strict=True)])
        if len(places) < window.bounces + 2:  # it leaves the scene
            places = np.vstack([places, places[-1] + 1e6 * np.array([run.final[ball]["vx"], run.final[ball]["vy"]])])
        p, q = places[:-1], places[1:]
        d = q - p
        part = np.clip(((np.array([x, y]) - p) * d).sum(axis=1) / (d * d).sum(axis=1), 0, 1)
        enters = np.hypot(*(p + part[:, None] * d - (x, y)).T) < r
        assert int(np.argmax(enters)) == window.bounces
        assert enters.any()
        assert tuple(own["wall"][: window.bounces].tolist()) == window.word


@pytest.mark.parametrize("bounces", [0, 1, 2, 5, 10, 20])
def test_a_box_has_one_window_for_each_image_of_the_target(bounces):
    """Images of T = (u, v) stand at (20 i +- u, 14 j +- v); the one after m bounces left and right and n up and down
    has |..| walls in between, so 1 + 2 K (K + 1) come within K bounces, each 2 asin(r / distance) wide."""
    (x, y), (u, v) = SEEN
    r = 1e-4
    windows = wallkit.aim(scene(BOX), (x, y), (u, v, r), bounces)
    assert len(windows) == 1 + 2 * bounces * (bounces + 1)
    images = [
        (m, n, 10 * m + (u if m % 2 == 0 else 10 - u), 7 * n + (v if n % 2 == 0 else 7 - v))
        for m in range(-bounces, bounces + 1)
        for n in range(-bounces, bounces + 1)
        if abs(m) + abs(n) <= bounces
    ]
    widths = [2 * math.asin(r / math.hypot(a - x, b - y)) for _, _, a, b in images]
    assert windows.total == pytest.approx(sum(widths), abs=1e-14 * len(images))  # each border is rounded to 2e-16
    assert np.sort(windows.width) == pytest.approx(np.sort(widths), abs=1e-14)
    assert windows.by_bounces.tolist() == [1] + [4 * k for k in range(1, bounces + 1)]
    assert windows.searched_share == 0.0
    assert not windows.searched.any()


@pytest.mark.parametrize("bounces", [0, 1, 2, 3, 5, 8, 12, 20])
def test_an_equilateral_triangle_tiles_the_plane(bounces):
    triangle = [[(0, 0), (1, 0), (0.5, math.sqrt(3) / 2)]]
    windows = wallkit.aim(scene(triangle), (0.41, 0.23), (0.57, 0.31, 1e-5), bounces)
    assert len(windows) == 1 + 3 * bounces * (bounces + 1) // 2


SAMPLES = {
    "room.svg": ((720, 345), (297, 523), [0, 0, 2, 4, 3, 12], 0.118800510),
    "sinai.svg": ((507, 132), (541, 254), [1, 4, 8, 10, 22, 31, 32], 0.995235461),
    "mushroom.svg": ((321, 180), (84, 269), None, 0.945215001),
    "pinball.svg": ((404, 640), (94, 160), [0, 0, 0, 1, 3, 6], 0.031822641),
    "lagoon.ai": ((396, 150), (598, 275), [0, 9, 14, 24, 33], 0.558948375),
}


@pytest.mark.parametrize("name", SAMPLES)
def test_samples_as_another_program_has_them(name):
    """Counts and sums of a beam tracer that scans all walls; windows of the same walls after one another are one."""
    start, (x, y), counts, total = SAMPLES[name]
    level = wallkit.Scene(wallkit.import_walls(f"samples/{name}"))
    windows = wallkit.aim(level, start, (x, y, 10.0), 6 if counts is None else len(counts) - 1)
    assert len(windows) == (146 if counts is None else sum(counts))
    assert counts is None or windows.by_bounces.tolist() == counts
    assert windows.total == pytest.approx(total, abs=1e-8)
    confirm(level, windows)


def test_the_widest_window_of_the_samples():
    windows = wallkit.aim(wallkit.Scene(wallkit.import_walls("samples/room.svg")), (720, 345), (297, 523, 10), 5)
    assert windows.widest.width == pytest.approx(0.029369420, abs=1e-9)
    assert math.degrees(windows.widest.middle) == pytest.approx(164.848130, abs=1e-6)
    names = windows.walls.names
    assert [names[wall] for wall in windows.widest.word] == ["wall-middle", "piano"]


@pytest.mark.parametrize("seed", range(6))
def test_no_ray_of_a_plain_tracer_is_missed_or_wrong(seed):
    rings, start, target = room(seed)
    level = scene(rings)
    windows = wallkit.aim(level, start, target, 4)
    angle = -math.pi + 2 * math.pi * (np.arange(20_000) + 0.5) / 20_000
    assert (by_windows(windows, angle) == trace(rings, start, target, 4, angle)).all()
    confirm(level, windows)


def test_crossing_walls_and_open_ones_and_a_target_across_a_wall():
    """The rim of the target draws borders on the walls that stand in it."""
    rings = [[(0, 0), (0, 10), (10, 10), (10, 0)], [(3, 2), (8, 7)], [(3, 6), (8, 3)], [(6, -1), (6, 4)]]
    level = scene(rings, closed=[True, False, False, False])
    start, target = (1.3, 4.7), (8.9, 9.4, 1.5)
    windows = wallkit.aim(level, start, target, 5)
    angle = -math.pi + 2 * math.pi * (np.arange(40_000) + 0.5) / 40_000
    told = trace(
        [np.array(ring, dtype=float) for ring in rings], start, target, 5, angle
    )  # open ones go there and back
    assert (by_windows(windows, angle) == told).all()
    confirm(level, windows)


def test_one_sided_walls_are_passed_from_behind():
    """A box that is solid from outside: a shot from within leaves it, one from outside does not get in."""
    box = [[(4, 4), (6, 4), (6, 6), (4, 6)]]  # counter-clockwise: a solid
    level = scene([*BOX, *box], sides=["both", "outward"])
    out = wallkit.aim(level, (5, 5), (9, 3, 0.1), 0)
    assert len(out) == 1
    assert out.widest.width == pytest.approx(2 * math.asin(0.1 / math.hypot(4, 2)), abs=1e-12)
    assert len(wallkit.aim(level, (9, 3), (5, 5, 0.1), 3)) == 0


def test_a_lossy_wall_bends_the_mirror():
    """Off the floor y = 0 with restitution e and f along it, from (0, 1) to (3, 2): the ball falls 1, and rises 2. With
    slope s = vx / vy before it comes to s + 2 s f / e, so s = 3 / (1 + 2 f / e)."""
    material = wallkit.Material(restitution=0.5, tangential_restitution=0.8)
    floor = wallkit.Walls.from_polylines([[(-9, 0), (9, 0)]], closed=False, material=material)
    windows = wallkit.aim(wallkit.Scene(floor), (0, 1), (3, 2, 1e-4), 1)
    assert windows.by_bounces.tolist() == [1, 1]
    (off,) = (window for window in windows if window.bounces == 1)
    slope = 3 / (1 + 2 * 0.8 / 0.5)
    assert math.tan(math.pi / 2 + off.middle) == pytest.approx(slope, abs=1e-8)  # a disc's middle is off by its square
    confirm(wallkit.Scene(floor), windows)


def test_all_directions_reach_a_target_around_the_start():
    windows = wallkit.aim(scene(BOX), (2, 3), (2.5, 3, 1), 2)
    assert len(windows) == 1
    assert windows.total == pytest.approx(2 * math.pi, abs=1e-12)
    assert windows.widest.bounces == 0


def test_without_walls_there_is_the_straight_shot():
    none = wallkit.Walls.from_polylines([])
    windows = wallkit.aim(wallkit.Scene(none), (0, 0), (-5, 0, 1), 9)  # across 180 degrees: one window, not two
    assert len(windows) == 1
    assert windows.widest.width == pytest.approx(2 * math.asin(0.2), abs=1e-15)
    assert abs(windows.widest.middle) == pytest.approx(math.pi, abs=1e-15)


def test_moved_and_turned_levels_have_the_same_windows():
    rings, start, target = room(1)
    here = wallkit.aim(scene(rings), start, target, 4)
    turn = np.array([[math.cos(1), math.sin(1)], [-math.sin(1), math.cos(1)]])
    there = wallkit.aim(
        scene([ring @ turn + (1e4, -3e4) for ring in rings]), start @ turn + (1e4, -3e4),
        (*(np.array(target[:2]) @ turn + (1e4, -3e4)), target[2]), 4,
    )  # fmt: skip
    assert len(here) == len(there)
    assert np.sort(here.width) == pytest.approx(np.sort(there.width), abs=1e-10)  # 3e4 has a rounding of 4e-12, over 10


def test_beams_beyond_the_limit_are_told_not_cut():
    with pytest.raises(wallkit.LimitError, match="beams within 3000 bounces") as told:
        wallkit.aim(scene(BOX), *map(tuple, [(2, 3), (6.7, 4.1, 1e-3)]), 3000, most_beams=1_000_000)
    assert told.value.code == "too-many-beams"
    assert told.value.exit_code == 3


@pytest.mark.parametrize(
    ("changes", "code"),
    [
        ({"start": (5, 0)}, "start-on-wall"),
        ({"start": (10, 7)}, "start-on-wall"),
        ({"start": (1, math.nan)}, "bad-aim"),
        ({"start": 3}, "bad-aim"),
        ({"target": (1, 1)}, "bad-target"),
        ({"target": (1, 1, 0)}, "bad-target"),
        ({"target": "goal"}, "no-target"),
        ({"bounces": -1}, "bad-limit"),
        ({"bounces": 2.5}, "bad-limit"),
        ({"radius": -1}, "bad-balls"),
        ({"radius": 4}, "overlap"),
        ({"speed": 0}, "bad-aim"),
        ({"most_beams": 0}, "bad-limit"),
        ({"scene": BOX}, "bad-scene"),
    ],
)
def test_wrong_arguments_are_told(changes, code):
    given = {"scene": scene(BOX), "start": (2, 3), "target": (6, 4, 0.1), "bounces": 2} | changes
    with pytest.raises(wallkit.WallkitError) as told:
        wallkit.aim(**given)
    assert told.value.code == code
    assert told.value.fix


def test_a_target_is_found_by_its_name():
    circle = {"bulges": [[1.0, 1.0]], "names": ["goal"]}
    sensors = wallkit.Walls.from_polylines([[(6, 4), (7, 4)]], **circle)
    level = wallkit.Scene(scene(BOX).walls, sensors=sensors)
    assert wallkit.aim(level, (2, 3), "goal", 1).target == pytest.approx((6.5, 4, 0.5))
    with pytest.raises(wallkit.SceneError, match="named 'gaol'") as told:
        wallkit.aim(level, (2, 3), "gaol", 1)
    assert "'goal'" in told.value.fix
    two = wallkit.Walls.from_polylines(
        [[(6, 4), (7, 4)], [(1, 1), (2, 1)]], bulges=[[1.0, 1.0]] * 2, names=["goal"] * 2
    )
    with pytest.raises(wallkit.SceneError, match="2 things are named 'goal'"):
        wallkit.aim(wallkit.Scene(level.walls, sensors=two), (2, 3), "goal", 1)


def test_windows_are_a_sequence():
    windows = wallkit.aim(scene(BOX), (2, 3), (6.7, 4.1, 0.1), 1)
    assert len(windows) == len(list(windows)) == len(windows[:]) == 5
    assert windows[-1] == windows[4]
    assert windows[1:3] == (windows[1], windows[2])
    assert "5 windows within 1 bounces" in repr(windows)
    with pytest.raises(IndexError):
        windows[5]
