"""Time and memory of tangles by size, beside another build: ``python benchmarks/tangles.py COMMIT [NAME...]``.

Each figure is one process of its own: processor seconds of the import (or check) alone, and the most memory of the
process. COMMIT is checked out into a temporary git worktree, and the same inputs are given to both. The exponent is
that of time between the last two sizes. What takes more than a minute is ended and shown as ``-``.
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
    "near lines, check": ((10, 20, 50), True, "[[(0, k / 1000), (9000, k / 1000)] for k in range(n)], False"),
    "nested squares, check": ((20, 40, 80), True, "[np.array(SQUARE) * k / n for k in range(1, n + 1)], True"),
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
n, looks, code = int(sys.argv[1]), sys.argv[2] == "True", sys.argv[3]
rng = np.random.default_rng(1)
SQUARE = [(-300, -300), (300, -300), (300, 300), (-300, 300)]
walks = lambda n: np.cumsum(rng.normal(0, 8, (n, 100, 2)), axis=1)
lines, closed = eval(code)
paths = []
for line in lines:
    points = [("M" if k == 0 else "L", float(x), float(y)) for k, (x, y) in enumerate(line)]
    paths.append(d.DrawnPath([d.Subpath(points, closed)], stroke="#000000"))
drawing = d.Drawing("pt", "up", paths=paths)
start = time.process_time()
walls = import_walls(drawing)
if looks:
    free_space(walls)
print(json.dumps([time.process_time() - start, resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024]))
"""


def measured(build: Path, n: int, looks: bool, code: str) -> tuple[float, float] | None:
    """Seconds and megabytes; None where it did not end."""
    command = [sys.executable, "-c", CHILD, str(n), str(looks), code]
    try:
        done = subprocess.run(
            command,
            capture_output=True,
            text=True,
            timeout=MOST_SECONDS,
            cwd=build,
            env=os.environ | {"PYTHONPATH": str(build)},
        )
    except subprocess.TimeoutExpired:
        return None
    return tuple(json.loads(done.stdout)) if done.returncode == 0 else None


def row(name: str, other: Path) -> str:
    """One line of the table."""
    sizes, looks, code = TANGLES[name]
    mine = [measured(ROOT, n, looks, code) for n in sizes]
    theirs = measured(other, sizes[-1], looks, code)
    cells = ["-" if one is None else f"{one[0]:.2f} s {one[1]:.0f} MB" for one in [*mine, theirs]]
    exponent = "-"
    if mine[-1] and mine[-2]:
        exponent = f"{math.log(mine[-1][0] / mine[-2][0]) / math.log(sizes[-1] / sizes[-2]):.2f}"
    ratio = "-" if not mine[-1] else f"{(theirs[0] if theirs else MOST_SECONDS) / mine[-1][0]:.1f}"
    return f"| {name} {sizes} | {' | '.join(cells)} | {exponent} | {'' if theirs else '> '}{ratio} |"


def main(commit: str, names: list[str]) -> None:
    """Print the table."""
    print("| tangle | first | second | third | third, before | exponent | times faster |\n|" + "---|" * 7)
    with tempfile.TemporaryDirectory() as folder:
        other = Path(folder) / "build"
        subprocess.run(["git", "worktree", "add", "-q", "--detach", str(other), commit], cwd=ROOT, check=True)
        try:
            for name in names or TANGLES:
                print(row(name, other), flush=True)
        finally:
            subprocess.run(["git", "worktree", "remove", "--force", str(other)], cwd=ROOT, check=True)


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2:])
