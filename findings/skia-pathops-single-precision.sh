#!/usr/bin/env bash
# skia-pathops 0.9.1: what a good engineer guesses and what happens.
#
# Input: a square of side 0.5 whose corner is at (1000000.1, 0), joined with nothing: only simplify() is called.
# Guess: the same square; the operations may round, but Python's floats go in and come out.
# What happens: coordinates are kept in single precision from the first moveTo on: the corner comes back at
#   1000000.125, and at 100000000.1 the square has no width at all, before any operation. Its area is 0 and nothing is
#   said.
set -euo pipefail
cd "$(mktemp -d)"
python3 -m venv venv
venv/bin/pip install -q skia-pathops==0.9.1
venv/bin/python - <<'PY'
from importlib.metadata import version

import pathops


def square(x):
    path = pathops.Path()
    pen = path.getPen()
    pen.moveTo((x, 0.0))
    for point in ((x + 0.5, 0.0), (x + 0.5, 0.5), (x, 0.5)):
        pen.lineTo(point)
    pen.closePath()
    return path


near, far = square(1000000.1), square(100000000.1)
corner = next(iter(near.segments))[1][0]
print(f"skia-pathops {version('skia-pathops')}: a corner at 1000000.1 is at {corner[0]}; areas {near.area} and {far.area}")
assert corner[0] == 1000000.125 and far.area == 0.0, "this has changed"
PY
