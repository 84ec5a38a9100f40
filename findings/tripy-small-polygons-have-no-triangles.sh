#!/usr/bin/env bash
# tripy 1.0.0: what a good engineer guesses and what happens.
#
# Input: a round wall of 200 points, with radius 10, 0.1 and 0.01, and an L of six points, 10, 0.001 and 0.0001 wide: parts of some
#   millimetres in a drawing in metres.
# Guess: earclip gives 198 triangles for each circle and 4 for each L, and their areas add up to the polygon's.
# What happens: the smallest of both get an empty list, and nothing is said. A point counts as inside a triangle when areas differ
#   by less than 1.5e-8, whatever the polygon's size is; in a small polygon each point is inside of each triangle, and no corner
#   can be cut off. The finer a curve is drawn, the sooner it is lost.
set -euo pipefail
work="$(mktemp -d)"
trap 'rm -rf "$work"' EXIT
cd "$work"
python3 -m venv venv
venv/bin/pip install --quiet --disable-pip-version-check tripy==1.0.0
venv/bin/python -I - <<'PYTHON'
import math
import sys
from importlib.metadata import version

import tripy

CIRCLE = [(math.cos(k * math.pi / 100), math.sin(k * math.pi / 100)) for k in range(200)]
L_SHAPE = [(0, 0), (1, 0), (1, 1), (0.5, 1), (0.5, 0.5), (0, 0.5)]
CASES = [("circle", CIRCLE, 10, 198), ("circle", CIRCLE, 0.1, 198), ("circle", CIRCLE, 0.01, 0)]
CASES += [("L", L_SHAPE, 10, 4), ("L", L_SHAPE, 0.001, 4), ("L", L_SHAPE, 0.0001, 0)]
print("tripy", version("tripy"))
changed = False
for name, points, size, expected in CASES:
    triangles = tripy.earclip([(size * x, size * y) for x, y in points])
    area = sum(abs((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])) / 2 for a, b, c in triangles)
    print(f"{name} of size {size}: {len(triangles)} triangles, area {area / size**2:.4f} times the size squared")
    changed |= len(triangles) != expected
sys.exit(int(changed))  # 1: this has changed
PYTHON
