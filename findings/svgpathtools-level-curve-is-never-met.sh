#!/usr/bin/env bash
# svgpathtools 1.8.0: what a good engineer guesses and what happens.
#
# Input: a curve like an arch and another cubic Bezier curve that runs level through it, as drawing programs write a straight
#   piece with handles; and the same one with its ends 0.001 apart in height.
# Guess: CubicBezier.intersect gives two points, as for the Line through the same ends.
# What happens: none for the level curve, two for the tilted one and for the Line. The search compares bounding boxes, and one
#   without height meets no other. Nothing is said.
set -euo pipefail
cd "$(mktemp -d)"
python3 -m venv venv
venv/bin/pip install --quiet --disable-pip-version-check svgpathtools==1.8.0 numpy==2.3.5 scipy==1.16.3
venv/bin/python -I - <<'PYTHON'
import sys
from importlib.metadata import version

from svgpathtools import CubicBezier, Line

print("svgpathtools", version("svgpathtools"))
arch = CubicBezier(0, 10j, 10 + 10j, 10)
others = {
    "line": Line(0 + 5j, 10 + 5j),
    "level curve": CubicBezier(0 + 5j, 3 + 5j, 6 + 5j, 10 + 5j),
    "tilted curve": CubicBezier(0 + 5j, 3 + 5j, 6 + 5j, 10 + 5.001j),
}
counts = {}
for name, other in others.items():
    met = arch.intersect(other)
    counts[name] = len(met)
    print(f"{name}: met at", sorted(round(float(t), 6) for t, _ in met), "of the arch")
sys.exit(int(counts != {"line": 2, "level curve": 0, "tilted curve": 2}))  # 1: this has changed
PYTHON
