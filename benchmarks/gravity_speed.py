"""Speed of bounces under gravity beside a plain event loop in C (``events.c`` with -DFALLS), on one thread, in one run.

    python benchmarks/gravity_speed.py [scene ...]

The scenes, balls and turns of ``core_speed.py``, of lines, with 1,000 balls that fall at 100 units/s^2 for 10 s.
Compiling is not counted, nor is making a grid. Both sides count their own bounces: among few lines they are the same;
where rounding grows they differ by a hundredth; and of points that fall the C loop loses some through joints.
"""

from __future__ import annotations

import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import core_speed
import numpy as np
from core_speed import GOES, TURNS, cases, in_c, in_wallkit, input_of_c, rings

import wallkit

FALLS, BALLS = 100.0, 1000


def main() -> None:
    compiler = shutil.which("cc") or shutil.which("gcc")
    if compiler is None:
        sys.exit("this needs a C compiler")
    core_speed.SECONDS = 10.0
    with tempfile.TemporaryDirectory() as folder:
        program = str(Path(folder) / "events")
        source = str(Path(__file__).with_name("events.c"))
        flags = ["-O3", "-march=native", "-fno-math-errno", "-fno-trapping-math", f"-DGOES={GOES}", f"-DFALLS={FALLS}"]
        subprocess.run([compiler, *flags, source, "-o", program, "-lm"], check=True)
        for name, radius, walls, position, velocity in cases(sys.argv[1:] or ["box", "star", "curve1000", "maze10k"]):
            compare(name, radius, walls, position[:BALLS], velocity[:BALLS], program)


def compare(name, radius, walls, position, velocity, program) -> None:
    text = input_of_c(rings(name), position, velocity, radius)
    ready = wallkit.prepare(wallkit.Scene(walls, wallkit.Balls(position, velocity, radius), gravity=(0.0, -FALLS)))
    bounces = wallkit.survey(ready, until=core_speed.SECONDS, threads=1).bounces.sum()
    counted = int(subprocess.run([program], input=text, capture_output=True, text=True).stdout.split()[0])
    turns = np.array([(in_c(program, text), in_wallkit(ready)) for _ in range(TURNS)])
    theirs, ours = 1e9 * np.median(turns, axis=0)
    ratio = np.median(turns[:, 0] / turns[:, 1])
    print(
        f"{name:11s} r = {radius:g}  C {theirs:6.0f} ns a bounce ({counted} bounces), wallkit {ours:6.0f} ({bounces}), "
        f"ratio {ratio:.2f}",
        flush=True,
    )


if __name__ == "__main__":
    main()
