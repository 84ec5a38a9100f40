#!/usr/bin/env bash
# trimesh 5.2.0: what a good engineer guesses and what happens.
#
# Input: an SVG with a rectangle, a circle, an ellipse and a `use` of a path.
# Guess: a reader that knows `rect`, `circle`, `line` and `polygon` knows `ellipse` and `use` too, or says that it does not.
# What happens: rectangle and circle are there, the ellipse and the copy are not, without a word, and the path inside `defs`,
#   which nobody draws, is read where it lies, on the rectangle. Drawing programs write an ellipse for every circle that was
#   squeezed and a `use` for every symbol, so walls are missing, and others appear.
set -euo pipefail
cd "$(mktemp -d)"
python3 -m venv venv
venv/bin/pip install --quiet --disable-pip-version-check trimesh==5.2.0 numpy==2.3.5 svg.path==7.1 lxml==6.0.2 networkx==3.6 \
  shapely==2.1.2 scipy==1.16.3 rtree==1.4.1
venv/bin/python -I - <<'PYTHON'
import io
import sys
import warnings
from importlib.metadata import version

import trimesh

warnings.simplefilter("error")  # a word would be heard
SHAPES = {
    "rect": '<rect x="0" y="0" width="10" height="10"/>',
    "circle": '<circle cx="30" cy="5" r="5"/>',
    "ellipse": '<ellipse cx="50" cy="5" rx="5" ry="4"/>',
    "use": '<defs><path id="p" d="M0 0H10V10H0Z"/></defs><use href="#p" x="70"/>',
}
print("trimesh", version("trimesh"))
text = f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 100 100">{"".join(SHAPES.values())}</svg>'
path = trimesh.load_path(io.BytesIO(text.encode()), file_type="svg")
left = sorted(round(float(polygon.bounds[0])) for polygon in path.polygons_closed)
print("left edges of what is drawn: 0 rect, 25 circle, 45 ellipse, 70 copy of a path")
print("left edges of what is read:", left)
sys.exit(int(left != [0, 0, 25]))  # 1: this has changed
PYTHON
