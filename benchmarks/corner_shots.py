"""Throw tiny discs exactly at corners, and along edges over their beginnings, and count those that leave their rooms.

    python benchmarks/corner_shots.py 1e6

Rooms are those of ``soak.py``, every third one with arcs; restitution 0 to 1, every fifth one with drag. Radii are
1e-6 to 1e-8 in rooms of 100, where the rounding of a corner's quartic is larger than the disc. Each disc flies for two
seconds, or 60 bounces.
"""

from __future__ import annotations

import argparse
import sys
import time

import numpy as np
import shapely
import soak
from soak import PULL, outline, ring, thrown_along_edges, thrown_at_corners

import wallkit
from wallkit.simulation.run import Ending

RADII = (1e-6, 1e-6, 1e-7, 1e-8)


def shoot(seed, radii):
    """Shots at one room: (how many, bounces, how many were lost)."""
    rng = np.random.default_rng([seed, 77])
    points, bulges = ring(rng, bowed=seed % 3 == 2)
    radius = float(rng.choice(radii))
    region, missed = outline(points, bulges)
    free = region.buffer(-radius - missed - 1e-6)
    if not region.is_valid or free.is_empty:
        return 0, 0, 0
    shots = thrown_at_corners(rng, points, free, PULL), thrown_along_edges(rng, points, free, radius)
    position, velocity = (np.concatenate(part) for part in zip(*shots, strict=True))
    material = wallkit.Material(float(rng.choice([1.0, 0.8, 0.5, 0.0])), float(rng.choice([1.0, 0.6])))
    walls = wallkit.Walls.from_polylines([points], bulges=[bulges], material=material)
    balls = wallkit.Balls(position, velocity, radius)
    scene = wallkit.Scene(walls, balls, gravity=PULL, drag=0.1 if seed % 5 == 4 else None)
    totals = wallkit.survey(scene, until=2.0, bounces=60)
    outside = shapely.distance(region, shapely.points(totals.position)) > missed + 1e-10
    lost = np.flatnonzero(outside | (totals.ending == Ending.LEFT_SCENE))
    for ball in lost:
        print(f"lost: room {seed}, radius {radius:g}, {material}, {position[ball]}, {velocity[ball]}", flush=True)
    return len(position), int(totals.bounces.sum()), len(lost)


def main():
    asked = argparse.ArgumentParser(description="Look for lost discs at corners.")
    asked.add_argument("shots", nargs="?", type=float, default=1e5)
    asked.add_argument("--radii", type=float, nargs="+", default=RADII)
    asked.add_argument("--seed", type=int, default=0)
    asked = asked.parse_args()
    soak.BALLS, begin, sums, seed = 3000, time.process_time(), np.zeros(3, dtype=np.int64), asked.seed
    while sums[0] < asked.shots:
        sums += shoot(seed, asked.radii)
        seed += 1
    shots, bounces, lost = sums
    print(f"{seed} rooms, {shots:,} shots, {bounces:,} bounces, {lost} lost, {time.process_time() - begin:.0f} s")
    sys.exit(1 if lost else 0)


if __name__ == "__main__":
    main()
