#!/usr/bin/env bash
# drawsvg 2.4.2: what a good engineer guesses and what happens.
#
# Input: Path().arc(0, 0, 50, 0, 359), and the same to 360 and from 45 to 405 degrees.
# Guess: a circle for the last two, as from arc() of a canvas: a length of 314.16, after 313.29 for the first.
# What happens: the first is right, the others are nothing. A turn is taken modulo 360, so that the flag for the large arc is 0,
#   and the end is the start but for the last bits of a cosine: "A50,50,0,0,1,50.0,-1.2e-14". The text looks like a
#   circle, and there is no wall. Two halves are drawn.
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


def length(*turns):
    path = drawsvg.Path()
    for start, end in turns:
        path.arc(0, 0, 50, start, end)
    text = path.args["d"]
    found = svgelements.Path(text).length()
    print(f"{turns}: length {found:.2f}, {text}")
    return found


near = math.isclose(length((0, 359)), math.radians(359) * 50, rel_tol=1e-6)
halves = math.isclose(length((0, 180), (180, 360)), math.tau * 50, rel_tol=1e-6)
nothing = length((0, 360)) < 1e-6 and length((45, 405)) < 1e-6
sys.exit(int(not (near and halves and nothing)))  # 1: this has changed
PYTHON
