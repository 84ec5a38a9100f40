#!/usr/bin/env bash
# beziers 0.6.0: what a good engineer guesses and what happens.
#
# Input: a square from -5 to 5, a circle of radius 10, and points far to the left and to the right of them, some of them level
#   with a side of the square or with the circle's top, bottom or middle.
# Guess: pointIsInside is False for all of them.
# What happens: it is True for the points level with a side, with the top, with the bottom, or (to the left) with the middle: 295
#   units beside the square is inside. Where the ray to the side runs through nodes, an odd number of them is counted. A point
#   of any other height is right, so random tests pass; balls in a drawing stand at round numbers, as nodes do.
set -euo pipefail
cd "$(mktemp -d)"
python3 -m venv venv
venv/bin/pip install --quiet --disable-pip-version-check beziers==0.6.0 pyclipper==1.4.0 shapely==2.1.2 numpy==2.3.5
venv/bin/python -I - <<'PYTHON'
import contextlib
import io
import sys
from importlib.metadata import version

import shapely
from beziers.path.geometricshapes import Circle, Square
from beziers.point import Point

print("beziers", version("beziers"))
square = shapely.box(-5, -5, 5, 5)
disc = shapely.Point(0, 0).buffer(10, quad_segs=64)
LEVEL = [("square", x, y) for x, y in ((-300, 5), (-10, -5), (10, 5))] + [("circle", -20, y) for y in (0, 10, -10)]
OTHER = [("square", x, y) for x, y in ((0, 0), (-10, 1), (300, 4))] + [("circle", x, y) for x, y in ((3, 2), (-20, 1), (20, 3))]


def inside(name, x, y):
    shape = Square(10) if name == "square" else Circle(10)
    with contextlib.redirect_stdout(io.StringIO()):  # it prints a line on points
        return bool(shape.pointIsInside(Point(x, y)))


changed = False
for places, surprising in ((LEVEL, True), (OTHER, False)):
    for name, x, y in places:
        right = bool(shapely.contains_xy(square if name == "square" else disc, x, y))
        told = inside(name, x, y)
        print(f"{name}, ({x}, {y}): inside {told}, shapely {right}")
        changed |= (told != right) != surprising
sys.exit(int(changed))  # 1: this has changed
PYTHON
