"""What people wait for before balls fly, beside another build: ``python benchmarks/first_use.py COMMIT``.

    python benchmarks/first_use.py COMMIT [--same-environment] [NAME ...]
    python benchmarks/first_use.py COMMIT [--same-environment] --wheel WHEEL [NAME ...]

Processor seconds of whole processes, the median of turns in which both builds run one after the other: a survey with an
empty kernel cache (once), the same again, ``simulate`` of a small drawing (with its kernels on the disk; ``small`` has
that alone) and what Python itself takes, ``check`` of 10,000 edges, and surveys of 10,000 edges with the index made in
each call. Others run when they are named, for they take minutes: ``aside`` is what else one may begin with, an aim, a
``World(compile=True)`` and ``simulate``, and ``report`` is ``report --quick``, both with an empty cache; ``pictures``
are PNG files of runs. What that build lacks is measured here alone. With ``--wheel`` this
build is that wheel, installed into a new environment.
"""

from __future__ import annotations

import json
import math
import shutil
import sys
import tempfile
from pathlib import Path

from builds import ROOT, Build, beside, environment, medians

TURNS = 5

SURVEY = """
import sys
import numpy as np
import wallkit
kind, samples = sys.argv[1:]
if kind == "arcs":
    walls, start = wallkit.import_walls(f"{samples}/lagoon.ai", curves="arcs"), (396, 150)
else:
    walls, start = wallkit.Walls.from_polylines([[[0, 0], [0, 300], [400, 300], [400, 0]]]), (200, 150)
angle = np.random.default_rng(1).uniform(0, 2 * np.pi, 20000)
velocity = 50 * np.stack([np.cos(angle), np.sin(angle)], axis=1)
balls = wallkit.Balls(np.tile([start], (20000, 1)), velocity, 2)
wallkit.survey(wallkit.Scene(walls, balls, gravity=(0, -100) if kind == "gravity" else None), until=20.0)
"""

ASIDE = """
import sys
import wallkit
walls = wallkit.Walls.from_polylines([[[0, 0], [0, 300], [400, 300], [400, 0]]])
scene = wallkit.Scene(walls, wallkit.Balls([(200, 150)], [(30, 40)], 2))
if sys.argv[1] == "aim":
    wallkit.aim(scene, (200, 150), (50, 60, 5), bounces=3, radius=2)
elif sys.argv[1] == "world":
    wallkit.World(scene, compile=True).step(10)
else:
    wallkit.simulate(scene, bounces=50)
"""

WHOLE = """
import json, sys, time
sys.path.insert(0, sys.argv[1])
import core_speed
import wallkit
seconds = []
for name in ("curve10000", "maze10k"):
    for _, radius, walls, position, velocity in core_speed.cases([name]):
        scene = wallkit.Scene(walls, wallkit.Balls(position, velocity, radius))
        wallkit.survey(scene, until=20.0, threads=1)
        best = []
        for _ in range(9):
            began = time.process_time()
            wallkit.survey(scene, until=20.0, threads=1)
            best.append(time.process_time() - began)
        seconds.append(min(best))
print(json.dumps(seconds))
"""

PICTURES = """
import json, sys, time
import numpy as np
import wallkit
from wallkit.view.raster import png
from wallkit.view.run_picture import run_canvas
file, start, balls, bounces = json.loads(sys.argv[1])
angle = np.random.default_rng(1).uniform(0, 2 * np.pi, balls)
velocity = 50 * np.stack([np.cos(angle), np.sin(angle)], axis=1)
scene = wallkit.Scene(
    wallkit.import_walls(f"samples/{file}", curves="arcs"), wallkit.Balls(np.tile([start], (balls, 1)), velocity, 4)
)
png(run_canvas(wallkit.simulate(scene, bounces=1)))
run = wallkit.simulate(scene, bounces=bounces)
began = time.process_time()
png(run_canvas(run))
print(time.process_time() - began)
"""

DRAWN = (
    ("room.svg", (190, 200), 1, 50),
    ("room.svg", (190, 200), 1, 2000),
    ("room.svg", (190, 200), 20, 200),
    ("pinball.svg", (250, 300), 5, 100),
    ("lagoon.ai", (396, 150), 300, 40),
)


def row(name: str, turns: list[list[float]]) -> None:
    """Print one line of the table; that build's seconds are NaN where it lacks what is asked."""
    here, there, ratio = medians(turns)
    if math.isnan(there):
        print(f"| {name} | {here:.3g} s | has none | |", flush=True)
        return
    unit, factor = ("s", 1.0) if there >= 0.1 else ("ms", 1e3)
    print(f"| {name} | {here * factor:.3g} {unit} | {there * factor:.3g} {unit} | {ratio:.2f} |", flush=True)


def surveys(builds: tuple[Build, Build]) -> None:
    """First surveys, and the same again from a new process."""
    for kind in ("room", "arcs", "gravity"):
        arguments = ["-c", SURVEY, kind, "samples"]
        row(f"first survey, {kind}", [[build.seconds(arguments)[0] for build in builds]])
        row(f"again, {kind}", [[build.seconds(arguments)[0] for build in builds] for _ in range(TURNS)])


def aside(builds: tuple[Build, Build]) -> None:
    """What else one may begin with, each with a cache of its own."""
    for kind, name in (("aim", "aim"), ("world", "World"), ("simulate", "simulate")):
        has = [build.seconds(["-c", f"import wallkit; print(hasattr(wallkit, {name!r}))"])[1] for build in builds]
        with tempfile.TemporaryDirectory() as folder:
            cache = [str(Path(folder) / str(number)) for number in range(2)]
            turns = [
                [
                    build.seconds(["-c", ASIDE, kind], WALLKIT_CACHE_DIR=cache[k])[0] if "True" in has[k] else math.nan
                    for k, build in enumerate(builds)
                ]
                for _ in range(2)
            ]
            row(f"first {kind}", turns[:1])
            row(f"{kind} again", turns[1:])


def small(builds: tuple[Build, Build]) -> None:
    """Simulate a small drawing, beside what Python takes to start and to import NumPy."""
    simulate = ["-m", "wallkit", "simulate", "samples/room.svg", "--bounces", "50"]
    floor = ["-c", "pass"], ["-c", "import numpy"]
    for name, words in zip(
        ("Python alone", "import numpy", "simulate, a small drawing"), (*floor, simulate), strict=True
    ):
        _again(name, words, builds)


def commands(builds: tuple[Build, Build]) -> None:
    """Commands as people give them."""
    small(builds)
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "blobs.svg"
        file.write_text(_ten_thousand_edges())
        _again("check, 10,000 edges", ["-m", "wallkit", "check", str(file)], builds)


def _again(name: str, words: list[str], builds: tuple[Build, Build]) -> None:
    """Run it once for what is kept on the disk, then in turns."""
    for build in builds:
        build.seconds(words)
    row(name, [[build.seconds(words)[0] for build in builds] for _ in range(TURNS)])


def _ten_thousand_edges() -> str:
    """A room with 992 decagons of different sizes in it."""
    paths = ["M0,0H1000V1000H0Z"]
    for number in range(32 * 31):
        x, y, size = 20 + 30 * (number // 31), 20 + 30 * (number % 31), 8 + 4 * math.sin(number) ** 2
        turns = [math.pi * k / 5 for k in range(10)]
        paths.append("M" + " ".join(f"{x + size * math.cos(a):.4f},{y + size * math.sin(a):.4f}" for a in turns) + "Z")
    shapes = "\n".join(f'<path fill="none" stroke="#000" d="{path}"/>' for path in paths)
    return f'<svg xmlns="http://www.w3.org/2000/svg" width="1000" height="1000">{shapes}</svg>'


def whole(builds: tuple[Build, Build]) -> None:
    """Surveys whose index is made in each call."""
    folder = str(Path(__file__).resolve().parent)
    turns = [[json.loads(build.seconds(["-c", WHOLE, folder])[1]) for build in builds] for _ in range(3)]
    for number, name in enumerate(("curve, discs", "curve, points", "maze, discs", "maze, points")):
        row(f"whole survey, {name}", [[one[number] for one in turn] for turn in turns])


def pictures(builds: tuple[Build, Build]) -> None:
    """Pictures as PNG, of few bounces and of many, and the command that makes one."""
    for drawn in DRAWN:
        file, _, balls, bounces = drawn
        words = ["-c", PICTURES, json.dumps(drawn)]
        turns = [[float(build.seconds(words)[1]) for build in builds] for _ in range(3)]
        row(f"picture of {file}, {balls} x {bounces}", turns)
    with tempfile.TemporaryDirectory() as folder:
        for bounces in ("50", "1000"):
            words = ["-m", "wallkit", "simulate", "samples/room.svg", "--bounces", bounces, "-o", f"{folder}/run.png"]
            row(f"-o run.png, {bounces} bounces", [[build.seconds(words)[0] for build in builds] for _ in range(TURNS)])


def report(builds: tuple[Build, Build]) -> None:
    """The quick report, compiling included."""
    with tempfile.TemporaryDirectory() as folder:
        turns = []
        for build in builds:
            cache = str(Path(folder) / build.folder.name)
            turns.append(build.seconds(["-m", "wallkit", "report", "--quick"], WALLKIT_CACHE_DIR=cache)[0])
        row("report --quick, first", [turns])


PARTS = {
    "surveys": surveys,
    "aside": aside,
    "small": small,
    "commands": commands,
    "whole": whole,
    "pictures": pictures,
    "report": report,
}


def installed(wheel: str, folder: Path) -> Build:
    """Give a wheel as a build: in an environment of its own, beside the samples, with a cache that is empty."""
    here = folder / "installed"
    here.mkdir()
    shutil.copytree(ROOT / "samples", here / "samples")
    return Build(here, environment(folder / "venv", Path(wheel)), {"WALLKIT_CACHE_DIR": str(here / "kernels")})


def main() -> None:
    """Print the table."""
    wheel = sys.argv.pop(sys.argv.index("--wheel") + 1) if "--wheel" in sys.argv else None
    words = [word for word in sys.argv[1:] if not word.startswith("--")]
    if not words:
        sys.exit(__doc__)
    print("| | this build | that build | times faster |\n|" + "---|" * 4)
    with (
        tempfile.TemporaryDirectory() as folder,
        beside(words[0], same_environment="--same-environment" in sys.argv) as (here, there),
    ):
        builds = (installed(wheel, Path(folder)) if wheel else here, there)
        for name in words[1:] or ["surveys", "commands", "whole"]:
            PARTS[name](builds)


if __name__ == "__main__":
    main()
