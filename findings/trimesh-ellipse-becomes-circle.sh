#!/usr/bin/env bash
# trimesh 5.2.0: what a good engineer guesses and what happens.
#
# Input: an SVG with half an ellipse of radii 50 and 25 and its chord, and half a circle of radius 50 under
#   `scale(1 0.5)`, which is the same shape.
# Guess: trimesh.load_path has the half ellipse, as an exact curve or as lines within some tolerance.
# What happens: an arc is kept as three points, and three points are a circle: both become a part of a circle of radius
#   62.5 through the ends and the top. The area is 1743 and not 1963, 11 % less, and nothing is said. A wall read this
#   way is up to 4 units beside the drawn one.
set -euo pipefail
cd "$(mktemp -d)"
python3 -m venv venv
venv/bin/pip install --quiet --disable-pip-version-check trimesh==5.2.0 numpy==2.3.5 svg.path==7.1 lxml==6.0.2 networkx==3.6 \
  shapely==2.1.2 scipy==1.16.3 rtree==1.4.1
venv/bin/python -I - <<'PYTHON'
import io
import math
import sys
from importlib.metadata import version

import trimesh

DRAWINGS = {
    "elliptical arc": '<path d="M0 0A50 25 0 0 1 100 0Z"/>',
    "scaled circle": '<g transform="scale(1 0.5)"><path d="M0 0A50 50 0 0 1 100 0Z"/></g>',
}
print("trimesh", version("trimesh"))
exact = math.pi * 50 * 25 / 2
chord_angle = 2 * math.asin(50 / 62.5)
circle = 62.5**2 / 2 * (chord_angle - math.sin(chord_angle))  # the part of a circle through the same three points
changed = False
for name, body in DRAWINGS.items():
    text = f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 100 100">{body}</svg>'
    path = trimesh.load_path(io.BytesIO(text.encode()), file_type="svg")
    print(f"{name}: area {path.area:.1f}; half an ellipse {exact:.1f}, a part of a circle {circle:.1f}")
    changed |= abs(path.area - circle) > 10
sys.exit(int(changed))  # 1: this has changed
PYTHON
