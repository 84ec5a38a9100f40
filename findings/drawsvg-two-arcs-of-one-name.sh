#!/usr/bin/env bash
# drawsvg 2.4.2: what a good engineer guesses and what happens.
#
# Input: Arc(0, 0, 50, 0, 90) and Path().arc(0, 0, 50, 0, 90), and both from 350 to 10 degrees. The angles are said to rotate
#   from the x axis towards the positive y axis.
# Guess: the same quarter of a circle, 78.54 long, and the same 20 degrees, 17.45 long.
# What happens: Path.arc draws these. Arc draws the other 270 degrees, 235.62 long, and the other 340: it goes against the
#   direction of its angles unless `cw` is given, which is True in the one and False in the other. A quarter of a wall
#   becomes three.
set -euo pipefail
cd "$(mktemp -d)"
python3 -m venv venv
venv/bin/pip install --quiet --disable-pip-version-check drawsvg==2.4.2 svgelements==1.9.6
venv/bin/python -I - <<'PYTHON'
import math
import sys
from importlib.metadata import version

import drawsvg
import svgelements

print("drawsvg", version("drawsvg"))
changed = False
for start, end in ((0, 90), (350, 10)):
    turn = (end - start) % 360
    drawn = [drawsvg.Arc(0, 0, 50, start, end), drawsvg.Path().arc(0, 0, 50, start, end)]
    lengths = [svgelements.Path(shape.args["d"]).length() for shape in drawn]
    print(f"{start} to {end}: Arc {lengths[0]:.2f}, Path.arc {lengths[1]:.2f}; {turn} degrees are {math.radians(turn) * 50:.2f}")
    right = [math.radians(angle) * 50 for angle in (360 - turn, turn)]
    changed |= not all(math.isclose(a, b, rel_tol=1e-6) for a, b in zip(lengths, right))
sys.exit(int(changed))  # 1: this has changed
PYTHON
