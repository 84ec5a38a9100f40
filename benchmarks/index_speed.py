"""What the index makes of many edges, and of very uneven ones: costs of a bounce as ratios, in one run.

    python benchmarks/index_speed.py [million]

* Tiny edges: in a room of 4,000 by 3,000 stand rings of ten thousand edges in all, of 0.01 in one spot, in ten spots,
  and in spots within spots; first one ring as large as the room allows. Balls start beside the rings, between them
  and a box around them, so that they meet little else.
* Many edges: a maze of short walls of one density, 10,000 to 1,000,000 (with ``million``) of them, 10,000 balls, 20 s.

All on one thread. "Made in" is the time that ``wallkit.prepare`` takes without its look for overlaps.
"""

from __future__ import annotations

import sys
import time

import numpy as np
import shapely

import wallkit

SPEED, SECONDS, BALLS = 50.0, 20.0, 10_000


def ring(centre, radius, count):
    angle = 2 * np.pi * np.arange(count) / count
    return np.asarray(centre) + radius * np.stack([np.cos(angle), np.sin(angle)], axis=1)


def around(centre, radius):
    return np.asarray(centre) + 1.5 * radius * np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]])


def rooms(name):
    """The walls of a scene of rings, and (centre, radius) of each ring beside which balls start."""
    rng = np.random.default_rng(5)
    room = np.array([[0.0, 0.0], [4000.0, 0.0], [4000.0, 3000.0], [0.0, 3000.0]])
    tiny = 0.01 * 10_000 / (2 * np.pi)
    rings = {
        "even": [((2000.0, 1500.0), 900.0)],
        "one spot": [((700.0, 900.0), tiny)],
        "ten spots": [(spot, tiny / 10) for spot in rng.uniform([100, 100], [3900, 2900], (10, 2))],
        "spots in spots": [((700.0 + 2.5 * size, 900.0), size) for size in tiny * 16.0 ** -np.arange(4)],
    }[name]
    each = 10_000 // len(rings)
    return [room, *(ring(*r, each) for r in rings), *(around(*r) for r in rings)], rings


def beside(rings, count):
    """Places between rings and the boxes around them, and velocities that suit the size of each."""
    rng = np.random.default_rng(7)
    centre, radius = (np.array(column) for column in zip(*rings, strict=True))
    which = np.arange(count) % len(rings)
    turn, way = rng.uniform(0, 2 * np.pi, (2, count))
    place = 1.25 * radius[which, None] * np.stack([np.cos(turn), np.sin(turn)], axis=1)
    speed = SPEED * radius[which, None] / 900.0
    return centre[which] + place, speed * np.stack([np.cos(way), np.sin(way)], axis=1)


def maze(count):
    """Short walls of one density in a room as large as they need."""
    rng = np.random.default_rng(3)
    size = np.sqrt(count / 1e4) * np.array([4000.0, 3000.0])
    middle, turn = rng.uniform([20, 20], size - 20, (count - 4, 2)), rng.uniform(0, np.pi, count - 4)
    arm = rng.uniform(5, 15, count - 4)[:, None] * np.stack([np.cos(turn), np.sin(turn)], axis=1)
    room = size * np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
    return [room, *np.stack([middle - arm, middle + arm], axis=1)], size


def free_places(lines, size, radius):
    """Places for the balls of a maze, none of them within reach of a wall, with a velocity each."""
    walls = np.stack(lines[1:])
    tree = shapely.STRtree(shapely.linestrings(walls))
    rng = np.random.default_rng(9)
    found = np.empty((0, 2))
    while len(found) < BALLS:
        tries = rng.uniform([10, 10], size - 10, (BALLS, 2))
        near = tree.query(shapely.points(tries), predicate="dwithin", distance=radius + 0.05)[0]
        found = np.concatenate([found, np.delete(tries, near, axis=0)])
    way = rng.uniform(0, 2 * np.pi, BALLS)
    return found[:BALLS], SPEED * np.stack([np.cos(way), np.sin(way)], axis=1)


def cost(lines, position, velocity, radius, seconds):
    """Nanoseconds a bounce, and milliseconds that preparing takes."""
    walls = wallkit.Walls.from_polylines(lines, closed=[len(line) > 2 for line in lines])
    scene = wallkit.Scene(walls, wallkit.Balls(position, velocity, radius))
    made, took = [], []
    for _ in range(3):
        began = time.process_time()
        ready = wallkit.prepare(scene, check=False)
        made.append(time.process_time() - began)
        began = time.process_time()
        bounces = wallkit.survey(ready, until=seconds, threads=1).bounces.sum()
        took.append((time.process_time() - began) / bounces)
    return 1e9 * min(took), 1e3 * min(made), bounces


def report(name, radius, measured, first):
    nanoseconds, made, bounces = measured
    ratio = f"{nanoseconds / first:5.2f} times the first" if first else ""
    print(
        f"{name:16s} r = {radius:<8g} {nanoseconds:7.0f} ns a bounce ({bounces}), made in {made:7.1f} ms {ratio}",
        flush=True,
    )
    return first or nanoseconds


def main():
    for part in (0.0, 1 / 180):
        first = None
        for name in ("even", "one spot", "ten spots", "spots in spots"):
            lines, rings = rooms(name)
            position, velocity = beside(rings, BALLS)
            radius = part * min(radius for _centre, radius in rings)
            first = report(name, radius, cost(lines, position, velocity, radius, 8 * SECONDS), first)
    counts = [10_000, 100_000] + ([1_000_000] if "million" in sys.argv else [])
    for radius in (0.0, 5.0):
        first = None
        for count in counts:
            lines, size = maze(count)
            measured = cost(lines, *free_places(lines, size, radius), radius, SECONDS)
            first = report(f"maze {count}", radius, measured, first)


if __name__ == "__main__":
    main()
