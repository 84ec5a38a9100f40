#!/usr/bin/env bash
# beziers 0.6.0: what a good engineer guesses and what happens.
#
# Input: a square of 10 by 10, and one of 100 by 100, and BezierPath.tidy(), which is told to add extremes, to remove what is
#   irrelevant and to smooth, "so that corners are not smoothed".
# Guess: both stay squares.
# What happens: the large one does. The small one gets a fifth piece, a Bezier curve that leaves a corner, swings out beyond the
#   opposite side and comes back to the same corner, and the area 154 instead of 100: pieces shorter than 20 units are
#   gathered and fitted, and their corners are not looked at until a longer piece comes. A room in metres is a small one.
set -euo pipefail
cd "$(mktemp -d)"
python3 -m venv venv
venv/bin/pip install --quiet --disable-pip-version-check beziers==0.6.0 pyclipper==1.4.0
venv/bin/python -I - <<'PYTHON'
import sys
from importlib.metadata import version

from beziers.cubicbezier import CubicBezier
from beziers.path.geometricshapes import Square

print("beziers", version("beziers"))
results = {}
for side in (10, 100):
    square = Square(side)
    square.tidy()
    pieces = square.asSegments()
    curves = sum(isinstance(piece, CubicBezier) for piece in pieces)
    results[side] = (len(pieces), curves, square.area / side**2)
    print(f"side {side}: {len(pieces)} pieces, {curves} of them curves, area {square.area:.1f} of {side**2}")
    print("  ", square.asSVGPath())
sys.exit(int(results[100] != (4, 0, 1.0) or results[10][:2] != (5, 1) or results[10][2] < 1.4))  # 1: this has changed
PYTHON
