#!/usr/bin/env bash
# potracer 0.0.4: what a good engineer guesses and what happens.
#
# Input: a picture of 30 by 20 pixels with a filled rectangle from (5, 5) to (25, 15), as an array: 1 in the rectangle and 0 around
#   it (as pypotrace takes it, whose place this package takes); the same as floats and as booleans; and white paper of 255 with a
#   rectangle of 0.
# Guess: one curve each time, the outline of the rectangle, which is 1, True or black.
# What happens: only the last gives it. Numbers are compared with 127.5 whatever their type is, so that an array of ones and zeros
#   is black all over: one curve, around the whole page. Of booleans the False ones are black: two curves, the page and the
#   rectangle as a hole in it. Each time there are closed outlines, and a ball is in another room.
set -euo pipefail
work="$(mktemp -d)"
trap 'rm -rf "$work"' EXIT
cd "$work"
python3 -m venv venv
venv/bin/pip install --quiet --disable-pip-version-check potracer==0.0.4 numpy==2.3.5
venv/bin/python -I - <<'PYTHON'
import sys
from importlib.metadata import version

import numpy as np
from potrace import Bitmap

rectangle = np.zeros((20, 30))
rectangle[5:15, 5:25] = 1
PAGE, RECTANGLE = (0, 0, 30, 20), (5, 5, 25, 15)
PICTURES = {
    "ones, integers": (rectangle.astype(np.uint8), [PAGE]),
    "ones, floats": (rectangle, [PAGE]),
    "booleans": (rectangle > 0.5, [PAGE, RECTANGLE]),
    "0 on paper of 255": ((255 * (1 - rectangle)).astype(np.uint8), [RECTANGLE]),
}


def box(curve):  # of a curve that has corners only
    ends = [(part.end_point.x, part.end_point.y) for part in curve.segments]
    corners = ends + [(part.c.x, part.c.y) for part in curve.segments]
    return (*(round(min(axis)) for axis in zip(*corners)), *(round(max(axis)) for axis in zip(*corners)))


print("potracer", version("potracer"))
changed = False
for name, (picture, expected) in PICTURES.items():
    boxes = [box(curve) for curve in Bitmap(picture).trace()]
    print(f"{name}: {len(boxes)} curves, boxes {boxes}; right [{RECTANGLE}]")
    changed |= boxes != expected
sys.exit(int(changed))  # 1: this has changed
PYTHON
