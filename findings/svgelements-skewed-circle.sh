#!/usr/bin/env bash
# svgelements 1.9.6: what a good engineer guesses and what happens.
#
# Input: a circle of radius 10 under `skewX(45)`, and an ellipse that is turned by 45 degrees in a group with `scale(2 1)`, as
#   drawing programs write what was turned and then stretched; and the same ellipse under both the other way round.
# Guess: the boxes of the shapes that a browser draws: x from -14.14 to 14.14 and y from -10 to 10 for the circle.
# What happens: x from -10 to 10 and y from -14.14 to 14.14 for the circle. The turned ellipse is 114.0 by 63.2 instead of 116.6 by
#   58.3; with the scale inside of the turn it is right. An ellipse is kept as its centre and the ends of two radii; both ends
#   are moved by the matrix, and then no longer lie on the axes of the new ellipse, but are taken as if they did. Curves under the
#   same matrices are right.
set -euo pipefail
work="$(mktemp -d)"
trap 'rm -rf "$work"' EXIT
cd "$work"
python3 -m venv venv
venv/bin/pip install --quiet --disable-pip-version-check svgelements==1.9.6
venv/bin/python -I - <<'PYTHON'
import io
import math
import sys
from importlib.metadata import version

from svgelements import SVG, Path, Shape

DRAWINGS = {
    "circle, skewed": ('<circle r="10" transform="skewX(45)"/>', (1, 0, 1, 1), (10, 10), True),
    "ellipse, turned, in a scaled group": (
        '<g transform="scale(2 1)"><ellipse rx="40" ry="10" transform="rotate(45)"/></g>',
        (2 * math.cos(math.pi / 4), math.sin(math.pi / 4), -2 * math.sin(math.pi / 4), math.cos(math.pi / 4)),
        (40, 10),
        True,
    ),
    "ellipse, scaled, in a turned group": (
        '<g transform="rotate(45)"><ellipse rx="40" ry="10" transform="scale(2 1)"/></g>',
        (2 * math.cos(math.pi / 4), 2 * math.sin(math.pi / 4), -math.sin(math.pi / 4), math.cos(math.pi / 4)),
        (40, 10),
        False,
    ),
}
print("svgelements", version("svgelements"))
changed = False
for name, (body, (a, b, c, d), (rx, ry), wrong) in DRAWINGS.items():
    right = (2 * math.hypot(a * rx, c * ry), 2 * math.hypot(b * rx, d * ry))  # the sizes of the image of an ellipse
    drawing = SVG.parse(io.StringIO(f'<svg xmlns="http://www.w3.org/2000/svg">{body}</svg>'))
    (shape,) = (element for element in drawing.elements() if isinstance(element, Shape))
    left, top, end, bottom = Path(shape).bbox()
    told = (end - left, bottom - top)
    print(f"{name}: {told[0]:.1f} by {told[1]:.1f}, drawn {right[0]:.1f} by {right[1]:.1f}")
    changed |= (max(abs(told[0] - right[0]), abs(told[1] - right[1])) > 1) != wrong
sys.exit(int(changed))  # 1: this has changed
PYTHON
