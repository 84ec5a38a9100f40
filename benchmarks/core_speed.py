"""Speed of the bounce core beside a plain event loop in C (``events.c``), both on one thread, in one run.

    python benchmarks/core_speed.py [scene ...]
    python benchmarks/core_speed.py --threads [scene ...]

Each scene has 10,000 balls at 50 units/s for 20 s, discs of radius 5 and points. The C loop flies one ball after the
other through a uniform grid of edges and end points; reading them and making the grid are not counted. Of wallkit
compiling is not; "prepared" is a survey of a prepared scene (``wallkit.prepare``), "whole" one with preparing it and
looking for overlaps at the start. Medians of the ratios of turns, one after the other, in processor time; in each turn
both sides take the best of three goes, so that neither pays for what ran before it.

The two curves are flown as arcs too, set beside the speed in C of the lines: once with the largest error that those
have, once with the one that half of them keep below.

With ``--threads`` there is no C: one thread against one a core, by the clock on the wall, of a prepared scene, for 20 s
and for 200 s (a tenth of the balls with an index). The best of some thirty turns each, taken in turn: other work on the
machine disturbs two threads more than one.
"""

from __future__ import annotations

import math
import os
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
import shapely

import wallkit

SPEED, SECONDS = 50.0, 20.0
TURNS, GOES = 9, 3


def size_of_curve(angle):
    return 200 * (1 + 0.15 * np.cos(3 * angle) + 0.07 * np.sin(5 * angle))


def curve(count):
    angle = 2 * np.pi * np.arange(count) / count
    size = size_of_curve(angle)
    return np.stack([size * np.cos(angle), size * np.sin(angle)], axis=1)


def star():
    angle = 0.1 + np.arange(10) * np.pi / 5
    return np.where(np.arange(10) % 2, 90.0, 200.0)[:, None] * np.stack([np.cos(angle), np.sin(angle)], axis=1)


def rings(name):
    """Outline of the room, then what stands in it."""
    half = 1000 * math.tan(math.radians(1))
    if name == "maze10k":
        rng = np.random.default_rng(3)
        middle, turn = rng.uniform([20, 20], [3980, 2980], (9996, 2)), rng.uniform(0, np.pi, 9996)
        arm = rng.uniform(5, 15, 9996)[:, None] * np.stack([np.cos(turn), np.sin(turn)], axis=1)
        room = np.array([[0.0, 0.0], [4000.0, 0.0], [4000.0, 3000.0], [0.0, 3000.0]])
        return [room, *np.stack([middle - arm, middle + arm], axis=1)]
    return [
        {
            "box": np.array([[0.0, 0.0], [400.0, 0.0], [400.0, 300.0], [0.0, 300.0]]),
            "star": star(),
            "wedge": np.array([[0.0, 0.0], [1000.0, -half], [1000.0, half]]),
            "curve1000": curve(1000),
            "curve10000": curve(10_000),
        }[name]
    ]


def starts(lines, radius, count):
    rng = np.random.default_rng(7)
    walls = shapely.MultiLineString([*lines[1:], np.vstack([lines[0], lines[0][:1]])])
    shapely.prepare(walls)
    room = shapely.Polygon(lines[0])
    low, high = lines[0].min(axis=0), lines[0].max(axis=0)
    found = np.empty((0, 2))
    while len(found) < count:
        tries = shapely.points(rng.uniform(low, high, (4000, 2)))
        clear = shapely.contains(room, tries) & ~shapely.dwithin(walls, tries, radius + 0.05)
        found = np.concatenate([found, shapely.get_coordinates(tries[clear])])
    angle = rng.uniform(0, 2 * np.pi, count)
    return found[:count], SPEED * np.stack([np.cos(angle), np.sin(angle)], axis=1)


def rises(lines):
    """How far the curve is off from each of its lines, in the middle."""
    count = len(lines)
    chord = np.roll(lines, -1, axis=0) - lines
    off = curve(2 * count)[1::2] - lines
    return abs(off[:, 0] * chord[:, 1] - off[:, 1] * chord[:, 0]) / np.hypot(*chord.T)


def as_arcs(tolerance):
    """The curve as arcs that are off by no more than that, fitted to so many cubics that they count as the curve."""
    count = 3000
    angle = 2 * np.pi * np.arange(count + 1) / count
    size = size_of_curve(angle)
    slope = 200 * (-0.45 * np.sin(3 * angle) + 0.35 * np.cos(5 * angle))
    turn = np.exp(1j * angle)
    point, arm = size * turn, (slope + 1j * size) * turn * (2 * np.pi / count / 3)
    numbers = np.stack([point[:-1] + arm[:-1], point[1:] - arm[1:], point[1:]], axis=1)
    curves = " ".join(f"C {a.real} {a.imag} {b.real} {b.imag} {c.real} {c.imag}" for a, b, c in numbers.tolist())
    path = f"M {point[0].real} {point[0].imag} {curves} Z"
    drawing = wallkit.read_drawing_text(f'<svg xmlns="http://www.w3.org/2000/svg"><path d="{path}"/></svg>')
    return wallkit.import_walls(drawing, curves="arcs", tolerance=tolerance)


def input_of_c(lines, position, velocity, radius):
    edges = np.vstack(
        [np.hstack([lines[0], np.roll(lines[0], -1, axis=0)]), *(line.reshape(1, 4) for line in lines[1:])]
    )
    ends = np.unique(edges.reshape(-1, 2), axis=0) if radius > 0 else np.empty((0, 2))
    rows = [row for table in (edges, ends, np.hstack([position, velocity])) for row in table.tolist()]
    text = "\n".join(" ".join(map(repr, row)) for row in rows)
    return f"{len(edges)} {len(ends)} {len(position)} {SECONDS} {radius} 0.5\n{text}\n"


def in_c(program, text):
    """Seconds a bounce of the C loop, the best of as many."""
    bounces, seconds, _sum = subprocess.run([program], input=text, capture_output=True, text=True).stdout.split()
    return float(seconds) / int(bounces)


def in_wallkit(scene):
    """Seconds a bounce of a survey, the best of some goes."""
    took = []
    for _ in range(GOES):
        began = time.process_time()
        totals = wallkit.survey(scene, until=SECONDS, threads=1)
        took.append((time.process_time() - began) / totals.bounces.sum())
    return min(took)


def by_the_wall(scene, until, threads):
    """Seconds of a survey."""
    began = time.perf_counter()
    wallkit.survey(scene, until=until, threads=threads)
    return time.perf_counter() - began


def compare_threads(names):
    cores = os.cpu_count()
    for name, radius, walls, position, velocity in cases(names):
        fewer = len(position) if len(walls.edge_starts) < 100 else len(position) // 10
        for until, count in ((SECONDS, len(position)), (10 * SECONDS, fewer)):
            scene = wallkit.prepare(wallkit.Scene(walls, wallkit.Balls(position[:count], velocity[:count], radius)))
            wallkit.survey(scene, until=0.1)
            turns = [(by_the_wall(scene, until, 1), by_the_wall(scene, until, cores)) for _ in range(30)]
            one, many = (1e3 * min(times) for times in zip(*turns, strict=True))
            print(
                f"{name:11s} r = {radius:g}  {count} balls, {until:g} s: 1 thread {one:.2f} ms, "
                f"{cores} threads {many:.2f} ms, ratio {one / many:.2f}",
                flush=True,
            )


def cases(names):
    for name in names or ["box", "star", "wedge", "curve1000", "curve10000", "maze10k"]:
        lines = rings(name)
        walls = wallkit.Walls.from_polylines(lines, closed=[True] + [False] * (len(lines) - 1))
        for radius in (5.0, 0.0):
            position, velocity = starts(lines, radius if name != "wedge" else 5.0, 10_000)
            yield name, radius, walls, position, velocity


def compare_with_c(names):
    compiler = shutil.which("cc") or shutil.which("gcc")
    if compiler is None:
        sys.exit("this needs a C compiler")
    with tempfile.TemporaryDirectory() as folder:
        program = str(Path(folder) / "events")
        source = str(Path(__file__).with_name("events.c"))
        flags = ["-O3", "-march=native", "-fno-math-errno", "-fno-trapping-math", f"-DGOES={GOES}"]
        subprocess.run([compiler, *flags, source, "-o", program, "-lm"], check=True)
        for name, radius, walls, position, velocity in cases(names):
            text = input_of_c(rings(name), position, velocity, radius)
            compare_walls(f"{name}, {len(walls.edge_starts)} lines", walls, position, velocity, radius, (program, text))
            if name.startswith("curve"):
                off = rises(rings(name)[0])
                for tolerance in (off.max(), np.median(off)):
                    walls = as_arcs(float(tolerance))
                    title = f"{name}, {len(walls.edge_starts)} arcs"
                    compare_walls(title, walls, position, velocity, radius, (program, text))


def compare_walls(title, walls, position, velocity, radius, yardstick):
    scene = wallkit.Scene(walls, wallkit.Balls(position, velocity, radius))
    ready = wallkit.prepare(scene, check=False)
    wallkit.survey(scene, until=0.1, threads=1, check=False)
    turns = np.array([(in_c(*yardstick), in_wallkit(ready), in_wallkit(scene)) for _ in range(TURNS)])
    theirs, prepared, whole = 1e-6 / np.median(turns, axis=0)
    ratio, whole_ratio = np.median(turns[:, :1] / turns[:, 1:], axis=0)
    print(
        f"{title:22s} r = {radius:g}  C {theirs:6.2f} M bounces/s, prepared {prepared:6.2f} (ratio {ratio:.2f}), "
        f"whole {whole:6.2f} (ratio {whole_ratio:.2f})",
        flush=True,
    )


def main():
    names = [word for word in sys.argv[1:] if word != "--threads"]
    compare = compare_threads if "--threads" in sys.argv else compare_with_c
    compare(names)


if __name__ == "__main__":
    main()
