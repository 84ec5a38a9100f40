"""Time and memory of tangles by size.

    python benchmarks/tangles.py                     # shapes of up to 78,000 edges: import, and check
    python benchmarks/tangles.py COMMIT [NAME...]    # tangles beside another build

Each figure is one process of its own: processor seconds of the import (or check) alone, and the most memory of the
process. COMMIT is checked out into a temporary git worktree, and the same inputs are given to both. The exponent is
that of time between the last two sizes. What takes more than a minute of processor time is ended and shown as ``-``;
``tangled`` is what ended with the free space unknown.
"""

from __future__ import annotations

import json
import math
import os
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
MOST_SECONDS = 60

# name: sizes, whether free space is looked for too, and the polylines of a size n as Python
TANGLES = {
    "ring across a square": ((75, 150, 300), False, "[rng.uniform(0, 1000, (n, 2)), SQUARE], True"),
    "rings of 150": ((5, 10, 20), False, "list(rng.uniform(0, 1000, (n, 150, 2))), True"),
    "open polylines of 20": ((50, 100, 200), False, "list(rng.uniform(0, 1000, (n, 20, 2))), False"),
    "crossing lines, few": ((250, 500, 1000), False, "list(rng.uniform(0, 1000, (n, 2, 2))), False"),
    "crossing lines": ((1750, 3500, 7000), False, "list(rng.uniform(0, 1000, (n, 2, 2))), False"),
    "walks of 100": ((100, 200, 400), False, "list(1000 * rng.random((n, 1, 2)) + walks(n)), False"),
    "identical squares": ((500, 1000, 2000), False, "[SQUARE] * n, True"),
    "crossing lines, check": ((100, 250, 500), True, "list(rng.uniform(0, 1000, (n, 2, 2))), False"),
    "ring across a square, check": ((75, 150, 300), True, "[rng.uniform(0, 1000, (n, 2)), SQUARE], True"),
    "rings of 150, check": ((5, 10, 20), True, "list(rng.uniform(0, 1000, (n, 150, 2))), True"),
    "near lines, check": ((10, 20, 50), True, "[[(0, k / 1000), (9000, k / 1000)] for k in range(n)], False"),
    "nested squares, check": ((20, 40, 80), True, "[np.array(SQUARE) * k / n for k in range(1, n + 1)], True"),
}
# The same for as many as 78,000 edges, import and check
SHAPES = {
    "walks of 100 edges": ((197, 394, 788), "list(1000 * rng.random((n, 1, 2)) + walks(n)), False"),
    "hatch, n by n lines": ((25, 50, 100), "hatch(n), False"),
    "tiles, n by n": (
        (35, 70, 140),
        "[np.array(SQUARE) + (600 * i, 600 * j) for i in range(n) for j in range(n)], True",
    ),
    "dashes, n by n": (
        (70, 140, 280),
        "[[(30 * i, 30 * j), (30 * i + 20, 30 * j)] for i in range(n) for j in range(n)], False",
    ),
    "slanted dashes, n by n": ((70, 140, 280), "slanted(n), False"),
    "polygons over one another": ((100, 200, 400), "polygons(n), True"),
    "lines through a point": ((50, 100, 200), "[(-ray, ray) for ray in around(2 * n)[:n]], False"),
    "a star of n corners": ((50, 100, 200), "[around(n)[np.arange(n) * (n // 2 - 1) % n]], True"),
    "lines on one another": ((100, 200, 400), "[[(0, 0), (800, 0)]] * n, False"),
    "nested squares": ((2500, 5000, 10000), "[np.array(SQUARE) * k / n for k in range(1, n + 1)], True"),
    "identical squares": ((500, 1000, 2000), "[SQUARE] * n, True"),
}

CHILD = """
import json, resource, sys, time
import numpy as np
import importers.drawing as d
try:
    from wallkit.walls.checking.free_space import free_space
    from wallkit.walls.importing.pipeline import import_walls
except ImportError:  # builds from before these had folders of their own
    from wallkit.walls.build import import_walls
    from wallkit.walls.free_space import free_space
try:
    from wallkit.scene.look_over import given_of, look_over
    from wallkit.scene.opening import open_scene
    from wallkit.scene.wishes import Wishes
except ImportError:  # builds from before these had modules of their own
    look_over = None
    from wallkit.starts import roomiest
resource.setrlimit(resource.RLIMIT_CPU, (60, 60))
n, looks, code = int(sys.argv[1]), sys.argv[2] == "True", sys.argv[3]
rng = np.random.default_rng(1)
SQUARE = [(-300, -300), (300, -300), (300, 300), (-300, 300)]
walks = lambda n: np.cumsum(rng.normal(0, 8, (n, 100, 2)), axis=1)
hatch = lambda n: [[(-1, k), (n, k)] for k in range(n)] + [[(k + 0.5, -1), (k + 0.5, n)] for k in range(n)]
def around(n):
    turn = np.arange(n) * 2 * np.pi / n
    return 450 * np.stack([np.cos(turn), np.sin(turn)], axis=1)
def polygons(n):  # 400 of them part the plane into some 15,400 rooms
    for _ in range(n):
        middle, radius = rng.uniform(0, 1000, 2), rng.uniform(50, 198)
        turn = np.sort(rng.uniform(0, 6.28, rng.integers(3, 9)))
        yield np.round(middle + radius * np.stack([np.cos(turn), np.sin(turn)], axis=1), 3)
def slanted(n):
    start = 30 * np.indices((n, n)).reshape(2, -1).T + rng.uniform(0, 8, (n * n, 2))
    return np.stack([start, start + rng.uniform(-14, 14, (n * n, 2))], axis=1)
lines, closed = eval(code)
paths = []
for line in lines:
    points = [("M" if k == 0 else "L", float(x), float(y)) for k, (x, y) in enumerate(line)]
    paths.append(d.DrawnPath([d.Subpath(points, closed)], stroke="#000000"))
drawing = d.Drawing("pt", "up", paths=paths)
start = time.process_time()
known = True
if not looks:
    import_walls(drawing)
elif look_over is not None:  # as check does: whether there is room for a ball, and free space
    known = look_over(given_of(open_scene(drawing, Wishes(put_ball=False))), None).space.complete
else:
    walls = import_walls(drawing)
    roomiest(walls)
    known = free_space(walls).complete
took = time.process_time() - start
print(json.dumps([took, resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024, known]))
"""


def measured(build: Path, n: int, looks: bool, code: str) -> tuple[float, float, bool] | None:
    """Seconds, megabytes, and whether all is known; None where it did not end."""
    command = [sys.executable, "-c", CHILD, str(n), str(looks), code]
    around = os.environ | {"PYTHONPATH": str(build)}
    done = subprocess.run(command, capture_output=True, text=True, cwd=build, env=around, check=False)
    return tuple(json.loads(done.stdout)) if done.returncode == 0 else None


def cell(one: tuple[float, float, bool] | None) -> str:
    """One measurement in words."""
    return "-" if one is None else f"{one[0]:.2f} s {one[1]:.0f} MB{'' if one[2] else ' tangled'}"


def exponent(sizes: tuple[int, ...], found: list[tuple[float, float, bool] | None]) -> str:
    """That of time between the last two sizes."""
    *_, before, last = found
    if before is None or last is None:
        return "-"
    return f"{math.log(last[0] / before[0]) / math.log(sizes[-1] / sizes[-2]):.2f}"


def row(name: str, other: Path) -> str:
    """One line of the table beside another build."""
    sizes, looks, code = TANGLES[name]
    mine = [measured(ROOT, n, looks, code) for n in sizes]
    theirs = measured(other, sizes[-1], looks, code)
    ratio = "-" if not mine[-1] else f"{(theirs[0] if theirs else MOST_SECONDS) / mine[-1][0]:.1f}"
    cells = " | ".join(map(cell, [*mine, theirs]))
    return f"| {name} {sizes} | {cells} | {exponent(sizes, mine)} | {'' if theirs else '> '}{ratio} |"


def beside(commit: str, names: list[str]) -> None:
    """Print the table beside another build."""
    print("| tangle | first | second | third | third, before | exponent | times faster |\n|" + "---|" * 7)
    with tempfile.TemporaryDirectory() as folder:
        other = Path(folder) / "build"
        subprocess.run(["git", "worktree", "add", "-q", "--detach", str(other), commit], cwd=ROOT, check=True)
        try:
            for name in names or TANGLES:
                print(row(name, other), flush=True)
        finally:
            subprocess.run(["git", "worktree", "remove", "--force", str(other)], cwd=ROOT, check=True)


def shapes() -> None:
    """Print the table of shapes by size."""
    print("| shape | | first | second | third | exponent |\n|" + "---|" * 6)
    for name, (sizes, code) in SHAPES.items():
        for what in ("import", "check"):
            found = [measured(ROOT, n, what == "check", code) for n in sizes]
            cells = " | ".join(map(cell, found))
            print(f"| {name} {sizes} | {what} | {cells} | {exponent(sizes, found)} |", flush=True)


if __name__ == "__main__":
    if len(sys.argv) > 1:
        beside(sys.argv[1], sys.argv[2:])
    else:
        shapes()
