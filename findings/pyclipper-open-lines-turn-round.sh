#!/usr/bin/env bash
# pyclipper 1.4.0: what a good engineer guesses and what happens.
#
# Input: open lines, cut to a square of 100 by 100: a level one and an upright one in both directions, a line of three points,
#   and one that lies inside as a whole, in both directions.
# Guess: what is left runs in the direction of the line, as with shapely.
# What happens: both level ones come back turned round, the upright ones do not, the line of three points does, and of the two
#   inside one does and one does not. No rule is given. One-way walls and chains, which stop from one side of
#   their direction, then stop from the other one.
set -euo pipefail
cd "$(mktemp -d)"
python3 -m venv venv
venv/bin/pip install --quiet --disable-pip-version-check pyclipper==1.4.0 shapely==2.1.2 numpy==2.3.5
venv/bin/python -I - <<'PYTHON'
import sys
from importlib.metadata import version

import pyclipper
import shapely

SQUARE = [(0, 0), (100, 0), (100, 100), (0, 100)]
LINES = {
    "level, to the right": ([(-50, 50), (150, 50)], True),
    "level, to the left": ([(150, 50), (-50, 50)], True),
    "upwards": ([(50, -50), (50, 150)], False),
    "downwards": ([(50, 150), (50, -50)], False),
    "three points": ([(-50, 50), (50, 60), (150, 20)], True),
    "inside": ([(10, 10), (20, 50), (80, 90)], True),
    "inside, the other way": ([(80, 90), (20, 50), (10, 10)], False),
}


def cut(line):
    clipper = pyclipper.Pyclipper()
    clipper.AddPath(line, pyclipper.PT_SUBJECT, False)
    clipper.AddPath(SQUARE, pyclipper.PT_CLIP, True)
    (piece,) = pyclipper.OpenPathsFromPolyTree(clipper.Execute2(pyclipper.CT_INTERSECTION))
    return [tuple(point) for point in piece]


print("pyclipper", version("pyclipper"))
changed = False
for name, (line, turned) in LINES.items():
    judge = shapely.intersection(shapely.LineString(line), shapely.Polygon(SQUARE))
    right = [(round(x), round(y)) for x, y in judge.coords]
    piece = cut(line)
    print(f"{name}: {piece}, shapely {right}")
    changed |= piece != (right[::-1] if turned else right)
sys.exit(int(changed))  # 1: this has changed
PYTHON
