#!/usr/bin/env bash
# PyTMX 3.32: what a good engineer guesses and what happens.
#
# Input: a map of Tiled with a triangle and a polyline of two points.
# Guess: `as_points` of an object gives its points, the triangle's three.
# What happens: four points for each: the corners of the box around it, for an ellipse and a lone point as well. The
#   drawn ones are in `points`. Walls built from `as_points` are all rectangles, and the polyline is closed.
set -euo pipefail
cd "$(mktemp -d)"
python3 -m venv venv
venv/bin/pip install -q PyTMX==3.32
cat > map.tmx <<'XML'
<?xml version="1.0" encoding="UTF-8"?>
<map version="1.10" tiledversion="1.11.0" orientation="orthogonal" renderorder="right-down" width="10" height="10"
 tilewidth="16" tileheight="16" infinite="0" nextlayerid="2" nextobjectid="3">
 <objectgroup id="1" name="walls">
  <object id="1" x="100" y="50"><polygon points="0,0 10,0 10,20"/></object>
  <object id="2" x="0" y="0"><polyline points="0,0 10,5"/></object>
 </objectgroup>
</map>
XML
venv/bin/python - <<'PY'
from importlib.metadata import version

import pytmx

triangle, line = pytmx.TiledMap("map.tmx").layernames["walls"]
for name, thing in (("triangle", triangle), ("polyline", line)):
    drawn, told = [*map(tuple, thing.points)], [*map(tuple, thing.as_points)]
    print(f"PyTMX {version('PyTMX')}: {name}: points {drawn}, as_points {told}")
assert (len(triangle.points), len(triangle.as_points)) == (3, 4), "this has changed"
assert (len(line.points), len(line.as_points)) == (2, 4), "this has changed"
PY
