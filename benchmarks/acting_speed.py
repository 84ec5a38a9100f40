"""What friction, drag, one-sided and soft walls cost a bounce, beside the plain flight of the same scene, in one run.

    python benchmarks/acting_speed.py [room lines arcs]

Surveys on one thread, 20 s: a room of four lines with 10,000 balls, and the sample ``lagoon.ai`` as lines and as arcs,
which have an index, with 2,000. Compiling is not counted, nor is making an index. Medians of the ratios of turns, in
each of which both scenes take the best of three goes, one after the other. Bounces are counted scene by scene: balls
that slow down have fewer of them in the same time, and begin and end all the same.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
from core_speed import SECONDS, SPEED, in_wallkit

import wallkit

TURNS = 7
SAMPLES = Path(__file__).resolve().parent.parent / "samples"
ROOM = [[0, 0], [0, 300], [400, 300], [400, 0]]
SOFT = wallkit.Material(0.8, 0.9)


def walls_of(name, sides="both", material=None):
    if name == "room":
        return wallkit.Walls.from_polylines([ROOM], sides=sides, material=material or wallkit.Material())
    walls = wallkit.import_walls(SAMPLES / "lagoon.ai", curves=name, sides=sides)
    if material is None:
        return walls
    return wallkit.Walls.from_polylines(
        [wall.vertices for wall in walls], bulges=[wall.bulges for wall in walls], material=material
    )


def scene_of(name, radius, act):
    count, start = (10_000, (200.0, 150.0)) if name == "room" else (2_000, (396.0, 150.0))
    angle = np.random.default_rng(1).uniform(0, 2 * np.pi, count)
    velocity = SPEED * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    balls = wallkit.Balls(np.tile(start, (count, 1)), velocity, radius)
    slowing = {"friction": {"rolling_friction": 1.0}, "drag": {"drag": 0.01}}.get(act, {})
    walls = walls_of(name, "outward" if act == "one-sided" else "both", SOFT if act == "soft" else None)
    return wallkit.prepare(wallkit.Scene(walls, balls, **slowing))


def main() -> None:
    for name in sys.argv[1:] or ["room", "lines", "arcs"]:
        for radius in (0.0, 5.0 if name == "room" else 2.0):
            plain = scene_of(name, radius, "")
            for act in ("friction", "drag", "one-sided", "soft"):
                other = scene_of(name, radius, act)
                for scene in (plain, other):
                    wallkit.survey(scene, until=SECONDS, threads=1)  # compiled here
                turns = np.array([(in_wallkit(plain), in_wallkit(other)) for _ in range(TURNS)])
                (one, two), ratio = 1e9 * np.median(turns, axis=0), np.median(turns[:, 1] / turns[:, 0])
                print(
                    f"{name:5s} r = {radius:g}  {act:9s} {two:6.1f} ns, plain {one:6.1f}, ratio {ratio:.2f}", flush=True
                )


if __name__ == "__main__":
    main()
