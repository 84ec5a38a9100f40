"""Checks of levels with many balls, and what they cost: python benchmarks/check_levels.py

The mushroom's closed form with 40,000 balls, ball by ball; room.svg's outside; checks beside the surveys of the same
balls and limits; two processes beside one. Some minutes.
"""

from __future__ import annotations

import math
import time
from pathlib import Path

import numpy as np

import wallkit
from wallkit.levels.check_counts import Fate
from wallkit.levels.statistics import share_bounds

SAMPLES = Path(__file__).parents[1] / "samples"


def mushroom(balls=40_000, bounces=5000):
    scene = wallkit.open_scene(SAMPLES / "mushroom.svg").scene
    draw = wallkit.RoomBalls.of(scene.walls, speed=1.0, seed=3)
    given = draw(0, balls)
    (x, y), (vx, vy) = (given.position - (320.0, 320.0)).T, given.velocity.T
    island = (y < 0.0) & (np.abs(x * vy - y * vx) > 80.0)
    r, big = 80.0, 300.0
    cap, stem = math.pi * big * big / 2, 160.0 * 220.0
    exact = 2 / math.pi * (math.acos(r / big) - r / big * math.sqrt(1 - (r / big) ** 2)) * cap / (cap + stem)
    wrong, regular, slow = 0, 0, 0
    for first in range(0, balls, 1000):  # so many traps are listed one by one

        def these(begin, count, first=first):
            return draw(first + begin, count)

        part = wallkit.check_level(scene, these, 1000, bounces=bounces, target="mushroom:2")
        trapped = np.zeros(1000, dtype=np.bool_)
        trapped[part.counts.traps["ball"]] = True
        wrong += int(np.count_nonzero(trapped != island[first : first + 1000]))
        regular += part.share(Fate.REGULAR).count
        slow += part.share(Fate.SLOW).count
    low, high = share_bounds(regular, balls)
    print(f"mushroom, {balls:,} balls, {bounces:,} bounces: exact {exact:.8f}, found {regular / balls:.6f} "
          f"({low:.6f} to {high:.6f}), misclassified {wrong}, slow {slow}")  # fmt: skip


def room(balls=20_000, bounces=200):
    scene = wallkit.open_scene(SAMPLES / "room.svg").scene
    draw = wallkit.RoomBalls.of(scene.walls, speed=100.0, radius=6.0, seed=2)
    found = wallkit.check_level(scene, draw, balls, bounces=bounces)
    print("room.svg:", *(problem.message for problem in found.problems()), sep="\n  ")


def processor_seconds(work):
    best = math.inf
    for _ in range(3):
        begun = time.process_time()
        work()
        best = min(best, time.process_time() - begun)
    return best


def cost(name, target, radius, balls=20_000, bounces=2000):
    scene = wallkit.open_scene(SAMPLES / name).scene
    draw = wallkit.RoomBalls.of(scene.walls, speed=50.0, radius=radius, seed=3)
    how = {"bounces": bounces, "workers": 1}
    survey = processor_seconds(lambda: wallkit.count(scene, draw, balls, **how))
    plain = processor_seconds(lambda: wallkit.check_level(scene, draw, balls, **how))
    aimed = processor_seconds(lambda: wallkit.check_level(scene, draw, balls, target=target, **how))
    print(f"{name}: survey {survey:.2f} s, check {plain:.2f} s ({plain / survey:.2f}), "
          f"with a target {aimed:.2f} s ({aimed / survey:.2f})")  # fmt: skip


def processes(balls=200_000, bounces=1000):
    scene = wallkit.open_scene(SAMPLES / "mushroom.svg").scene
    draw = wallkit.RoomBalls.of(scene.walls, speed=50.0, seed=3)
    taken, digests = {}, set()
    for workers in (1, 2, 1, 2):
        begun = time.monotonic()
        counts = wallkit.count(scene, draw, balls, bounces=bounces, executor="processes", workers=workers)
        taken[workers] = min(taken.get(workers, math.inf), time.monotonic() - begun)
        digests.add(counts.digest())
    print(
        f"one process {taken[1]:.1f} s, two {taken[2]:.1f} s: {taken[1] / taken[2]:.2f} times; digests {len(digests)}"
    )


if __name__ == "__main__":
    mushroom()
    room()
    cost("mushroom.svg", "mushroom:2", 0.0)
    cost("pinball.svg", (94.0, 160.0, 30.0), 10.0)
    processes()
