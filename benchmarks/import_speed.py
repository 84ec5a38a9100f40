"""Reading and import of a large drawing beside another build, and how they grow: ``import_speed.py COMMIT``.

    python benchmarks/import_speed.py COMMIT [--same-environment]
    python benchmarks/import_speed.py --growth

The drawing has 4,900 paths of 24 cubics in as many groups (5.8 MB). Each figure is the processor time of reading it, or
of making walls of what was read, in a process of its own; the median of turns in which both builds run one after the
other. Kernels for the import are compiled before, as a wheel has them. Memory is the most that a process had. With
``--growth`` this build alone reads 1,000 to 1,000,000 segments, the most that are read. The blobs are smooth there, and
lines and arcs may be off by 0.5, since walls of more than 2,000,000 vertices are refused. The slope is that of log time
over log size, and beside it that of the last step.
"""

from __future__ import annotations

import json
import math
import random
import sys
import tempfile
from pathlib import Path

import numpy as np
from builds import ROOT, Build, beside, medians

TURNS = 3
CURVES = 24  # segments of a path, its move counted
WIDE = 0.5  # tolerance
SIZES = (1_000, 10_000, 100_000, 1_000_000)

CHILD = """
import json, resource, sys, time
import wallkit
file, curves, tolerance = sys.argv[1:]
small = '<svg xmlns="http://www.w3.org/2000/svg"><path d="M0,0C1,2 3,4 5,0Z"/></svg>'
wallkit.import_walls(wallkit.read_drawing_text(small), curves="arcs")
start = time.process_time()
drawing = wallkit.read_drawing(file)
read = time.process_time() - start
start = time.process_time()
if curves != "read":
    wallkit.import_walls(drawing, curves=curves, tolerance=float(tolerance) or None)
made = time.process_time() - start
print(json.dumps([read, made, resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024]))
"""

WARM = """
try:
    from wallkit.cli.warm import IMPORTING, warmed
except ImportError:  # a build without such kernels
    pass
else:
    warmed(IMPORTING)
"""


def drawing_of(paths: int, smooth: bool = False) -> str:
    """A square of blobs, each a path of cubics in a group that moves it; of S-shaped curves, or smooth ones."""
    rng = random.Random(1)
    side = math.ceil(math.sqrt(paths))
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {side * 140} {side * 140}">']
    for number in range(paths):
        row, column = divmod(number, side)
        turn = [2 * math.pi * k / CURVES for k in range(CURVES)]
        size = [50 * (1 + 0.2 * rng.random()) for _ in turn]
        points = [
            (column * 140 + 70 + r * math.cos(a), row * 140 + 70 + r * math.sin(a))
            for a, r in zip(turn, size, strict=True)
        ]
        data = "M{:.2f},{:.2f}".format(*points[0])
        before = [points[-1], *points]
        after = [*points[2:], points[0]]
        for (zx, zy), (ax, ay), (bx, by), (cx, cy) in zip(before, points, points[1:], after, strict=False):
            ux, uy, vx, vy = ((bx - zx) / 6, (by - zy) / 6, (cx - ax) / 6, (cy - ay) / 6) if smooth else (1, 1, 1, 1)
            data += f"C{ax + ux:.2f},{ay + uy:.2f} {bx - vx:.2f},{by - vy:.2f} {bx:.2f},{by:.2f}"
        out.append(f'<g transform="translate(0.5,0.25)"><path style="fill:#ccc;stroke:none" d="{data}Z"/></g>')
    return "\n".join([*out, "</svg>"])


def measured(build: Build, file: Path, curves: str, tolerance: float = 0.0) -> tuple[float, float, float]:
    """Seconds of reading, seconds of making walls, megabytes; the tolerance 0 is the usual one."""
    read, made, memory = json.loads(build.seconds(["-c", CHILD, str(file), curves, str(tolerance)])[1])
    return read, made, memory


def compare(commit: str, same_environment: bool) -> None:
    """Print the table beside another build."""
    print("| | this build | that build | times faster | MB | MB there |\n|" + "---|" * 6)
    with tempfile.TemporaryDirectory() as folder, beside(commit, same_environment=same_environment) as builds:
        file = Path(folder) / "map.svg"
        file.write_text(drawing_of(4900))
        for build in builds:
            build.seconds(["-c", WARM])
        for curves, column in (("read", 0), ("lines", 1), ("arcs", 1)):
            turns = [[measured(build, file, curves) for build in builds] for _ in range(TURNS)]
            here, there, ratio = medians([[one[column] for one in turn] for turn in turns])
            memory = [np.median([turn[k][2] for turn in turns]) for k in (0, 1)]
            print(
                f"| {curves} | {here:.2f} s | {there:.2f} s | {ratio:.2f} | {memory[0]:.0f} | {memory[1]:.0f} |",
                flush=True,
            )


def grow() -> None:
    """Print the table by size, with slopes."""
    here = Build(ROOT, sys.executable)
    here.seconds(["-c", WARM])
    print("| segments | read | lines | arcs | MB |\n|" + "---|" * 5)
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "map.svg"
        for size in SIZES:
            file.write_text(drawing_of(size // CURVES, smooth=True))
            lines, arcs = (measured(here, file, curves, WIDE) for curves in ("lines", "arcs"))
            rows.append((lines[0], lines[1], arcs[1]))
            print(f"| {size:,} | " + " | ".join(f"{t:.3f} s" for t in rows[-1]) + f" | {arcs[2]:.0f} |", flush=True)
    slopes = np.polyfit(np.log(SIZES), np.log(rows), 1)[0]
    last = np.log(np.divide(rows[-1], rows[-2])) / math.log(SIZES[-1] / SIZES[-2])
    print(
        "| slope, of the last step | "
        + " | ".join(f"{a:.2f}, {b:.2f}" for a, b in zip(slopes, last, strict=True))
        + " | |"
    )


if __name__ == "__main__":
    words = [word for word in sys.argv[1:] if not word.startswith("--")]
    if "--growth" in sys.argv:
        grow()
    elif words:
        compare(words[0], "--same-environment" in sys.argv)
    else:
        sys.exit(__doc__)
