"""Fly balls through random closed drawings of lines and arcs until a number of bounces is reached; report any loss.

    python benchmarks/soak.py 1e9
    python benchmarks/soak.py 1e9 --falling
    python benchmarks/soak.py 1e8 --falling --corners

Each drawing is a star-shaped ring, every second one with some edges bowed into arcs; points and discs take turns. A
ball is lost if it ends outside its ring by more than the rounding of coordinates, or leaves the scene. With
``--falling`` balls fall, walls take from them what they like (restitution 0 to 1, along the wall too), half of the
drawings have rolling friction or drag, and balls slide, glide, pivot and rest; their energy must never grow. With
``--corners`` they are thrown at vertices from nearby, some of them exactly; with ``--falling`` half of the discs, small
ones, come from afar to where they touch the beginning of an edge, along that.
"""

from __future__ import annotations

import argparse
import sys
import time
from pathlib import Path

import numpy as np
import shapely

import wallkit
from wallkit.simulation.run import Ending

sys.path.insert(0, str(Path(__file__).parents[1] / "tests" / "physics"))
from outlines import outline

BALLS, BOUNCES = 400, 25_000
DRAGGED = 300  # bounces of a ball with drag, most: each takes thirty times as long as one without
PULL = (0.0, -30.0)
LAST = 5_000.0  # seconds that a falling ball flies at most that loses speed: one that only glides meets nothing
LASTING = 100_000.0  # and one that keeps it


def ring(rng, bowed):
    """Vertices and bulges of a ring about (0, 0), of size 100."""
    count = int(rng.choice([4, 6, 10, 20, 60, 200]))
    angle = 2 * np.pi * (np.arange(count) + 0.8 * rng.random(count)) / count
    points = (100.0 * (1 - 0.6 * rng.random(count)))[:, None] * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    return points, np.where(rng.random(count) < 0.5, rng.uniform(-0.15, 0.15, count), 0.0) if bowed else np.zeros(count)


def acting(rng):
    """What walls take and what acts on falling balls: (material, keywords of a scene)."""
    keep = float(rng.choice([1.0, 1.0, 1.0, 0.8, 0.5, 0.0, rng.random()]))
    along = float(rng.choice([1.0, 1.0, 0.6]))
    slows = rng.choice(["nothing", "nothing", "rolling_friction", "drag"])
    slowing = {} if slows == "nothing" else {str(slows): 0.5 if slows == "rolling_friction" else 0.001}
    return wallkit.Material(keep, along), {"gravity": PULL, **slowing}


def energies(position, velocity, acts):
    """Of each ball, per mass: kinetic and, where it falls, potential."""
    pull = np.array(acts.get("gravity", (0.0, 0.0)))
    return (velocity**2).sum(axis=1) / 2 - position @ pull


def scattered(rng, free):
    """Places anywhere, and velocities of one speed in all directions."""
    tries = rng.uniform(-100, 100, (200 * BALLS, 2))
    position = tries[shapely.contains_xy(free, tries[:, 0], tries[:, 1])][:BALLS]
    angle = rng.uniform(0, 2 * np.pi, len(position))
    return position, 50.0 * np.stack([np.cos(angle), np.sin(angle)], axis=1)


def thrown_at_corners(rng, points, free, pull):
    """Places near vertices, and velocities that bring a ball there, exactly or nearly."""
    corner = points[rng.integers(0, len(points), BALLS)]
    angle = rng.uniform(0, 2 * np.pi, BALLS)
    position = corner + rng.uniform(0.5, 8.0, (BALLS, 1)) * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    there = shapely.contains_xy(free, position[:, 0], position[:, 1])
    position, way = position[there], (corner - position)[there]
    time = np.hypot(*way.T)[:, None] / rng.uniform(5.0, 60.0, (len(way), 1))
    velocity = way / time - np.array(pull) * time / 2
    return position, velocity + rng.choice([0.0, 1e-9, 1e-6, 1e-4, 0.05]) * rng.normal(size=way.shape)


def thrown_along_edges(rng, points, free, radius):
    """Places, and velocities with which falling discs graze a vertex just where they touch the edge after it."""
    first = rng.integers(0, len(points), BALLS)
    edge = np.roll(points, -1, axis=0)[first] - points[first]
    way = edge / np.hypot(*edge.T)[:, None]
    time, speed = rng.uniform(0.1, 1.0, (BALLS, 1)), rng.uniform(5.0, 60.0, (BALLS, 1))
    there = points[first] + radius * np.stack([-way[:, 1], way[:, 0]], axis=1)
    position = there - speed * way * time + np.array(PULL) * time**2 / 2
    inside = shapely.contains_xy(free, position[:, 0], position[:, 1])
    return position[inside], (speed * way - np.array(PULL) * time)[inside]


def fly(rng, number, falling, corners):
    """Fly one drawing: (bounces, lost, drift of the energy, balls that ended in an ambiguous corner)."""
    points, bulges = ring(rng, bowed=number % 2 == 1)
    radius = float(rng.choice([0.0, 0.01, 0.3] if corners else [0.0, 0.3, 1.5])) if number % 4 < 2 else 0.0
    region, missed = outline(points, bulges)
    free = region.buffer(-radius - missed - 1e-6)
    if not region.is_valid or free.is_empty:
        return 0, 0, 0.0, 0
    if corners:
        position, velocity = thrown_at_corners(rng, points, free, PULL if falling else (0.0, 0.0))
        if falling and radius > 0.0:
            more = thrown_along_edges(rng, points, free, radius)
            position, velocity = np.concatenate([position, more[0]]), np.concatenate([velocity, more[1]])
    else:
        position, velocity = scattered(rng, free)
    material, acts = acting(rng) if falling else (wallkit.Material(), {})
    if not len(position):
        return 0, 0, 0.0, 0
    walls = wallkit.Walls.from_polylines([points], bulges=[bulges], material=material)
    scene = wallkit.Scene(walls, wallkit.Balls(position, velocity, radius), **acts)
    keeps = material == wallkit.Material() and not {"drag", "rolling_friction"} & set(acts)
    until = (LASTING if keeps else LAST) if falling else None
    totals = wallkit.survey(scene, until, DRAGGED if "drag" in acts else BOUNCES)
    outside = shapely.distance(region, shapely.points(totals.position)) > missed + 1e-10
    lost = int(np.count_nonzero(outside | (totals.ending == Ending.LEFT_SCENE)))
    grown = energies(totals.position, totals.velocity, acts) - energies(position, velocity, acts)
    drift = (grown if falling else np.abs(grown)).max(initial=0.0) / 1250.0  # of the speed at the start
    return int(totals.bounces.sum()), lost, float(drift), int((totals.ending == Ending.AMBIGUOUS_CORNER).sum())


def main():
    options = argparse.ArgumentParser(description="Look for lost balls.")
    options.add_argument("bounces", nargs="?", type=float, default=1e7)
    options.add_argument("--falling", action="store_true")
    options.add_argument("--corners", action="store_true")
    options.add_argument("--seed", type=int, default=2026)
    given = options.parse_args()
    wanted = int(given.bounces)
    rng = np.random.default_rng(given.seed)
    bounces = lost = corners = number = 0
    drift, began, told = 0.0, time.time(), 0.0
    while bounces < wanted:
        more, gone, drifted, ambiguous = fly(rng, number, given.falling, given.corners)
        bounces, lost, corners, number = bounces + more, lost + gone, corners + ambiguous, number + 1
        drift = max(drift, drifted)
        if time.time() - told > 20 or bounces >= wanted:
            told = time.time()
            print(
                f"{number} drawings, {bounces:,} bounces, {lost} balls lost, drift of the energy {drift:.2g}, "
                f"{corners} ambiguous corners, {told - began:.0f} s",
                flush=True,
            )
    sys.exit(1 if lost else 0)


if __name__ == "__main__":
    main()
