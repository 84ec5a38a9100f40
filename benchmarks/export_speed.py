"""Time and memory of the exports by format: ``python benchmarks/export_speed.py [FORMAT...]``.

Three levels of 100,000 edges: one ring, 1,000 rings of 100, and 1,000 open walls of 100. Each figure is one process of
its own: processor seconds of the export alone, after a small one that imports what it needs, and the most memory that
the export to a file takes above what the process had, in times of the arrays of the walls plus the text.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
LEVELS = ("ring", "rings", "lines")
MOST_SECONDS = 120

CHILD = """
import json, resource, sys, time
from pathlib import Path
import numpy as np
import wallkit
from wallkit.export import export


def circle(count, radius, x=0.0, y=0.0):
    angle = np.linspace(0, 2 * np.pi, count, endpoint=False)
    wave = radius * (1 + 0.3 * np.sin(7 * angle))
    return np.column_stack([x + wave * np.cos(angle), y + wave * np.sin(angle)])


def level(kind, edges):
    if kind == "ring":
        walls = wallkit.Walls.from_polylines([circle(edges, 5000.0)])
    else:
        parts = [circle(100, 10.0, 30 * (k % 32), 30 * (k // 32)) for k in range(edges // 100)]
        walls = wallkit.Walls.from_polylines(parts, kind == "rings")
    walls.y_axis = "down"
    return walls


def peak():
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024


out = Path(sys.argv[3]) / "level"
export(level(sys.argv[2], 1000), out, sys.argv[1], origin="box")
walls = level(sys.argv[2], 100_000)
arrays = sum(a.nbytes for a in (walls.vertices, walls.bulges, walls.offsets, walls.depth, walls.closed))
before, start = peak(), time.process_time()
export(walls, out, sys.argv[1], origin="box")
seconds = time.process_time() - start
size = out.stat().st_size
print(json.dumps([seconds, (peak() - before) / (arrays + size), size / 1e6]))
"""


def measured(name: str, level: str) -> str:
    """Seconds, and memory in times of walls and text."""
    around = os.environ | {"PYTHONPATH": str(ROOT)}
    with tempfile.TemporaryDirectory() as folder:
        command = [sys.executable, "-c", CHILD, name, level, folder]
        try:
            done = subprocess.run(command, capture_output=True, text=True, timeout=MOST_SECONDS, env=around)
        except subprocess.TimeoutExpired:
            return "-"
    if done.returncode:
        return done.stderr.splitlines()[-1][:40]
    seconds, memory, size = json.loads(done.stdout)
    return f"{seconds:.2f} s {memory:.1f}x {size:.1f} MB"


def main(names: list[str]) -> None:
    """Print the table."""
    from wallkit.export import formats

    print(f"{'format':<12}" + "".join(f"{level:<24}" for level in LEVELS))
    for name in names or list(formats()):
        print(f"{name:<12}" + "".join(f"{measured(name, level):<24}" for level in LEVELS), flush=True)


if __name__ == "__main__":
    sys.path.insert(0, str(ROOT))
    main(sys.argv[1:])
