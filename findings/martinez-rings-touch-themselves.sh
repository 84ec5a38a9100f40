#!/usr/bin/env bash
# martinez-polygon-clipping 0.8.1 (npm): what a good engineer guesses and what happens.
#
# Input: a square of 10 by 10 less a diamond whose corners are the middles of its sides; the same square less a triangle that
#   touches the left side from inside; and a square ring with an island that touches the ring's hole in one corner.
# Guess: four triangles; a square with a hole; a ring and an island. So polygon-clipping has them, and GEOS calls them valid.
# What happens: two of the four triangles are one polygon through the point where they touch; the hole is a notch of no width in
#   the outer ring; the island is part of the hole's ring and no polygon of its own. GEOS calls all three a "Ring
#   Self-intersection". The areas are right, what is a wall and what is a hole is not.
set -euo pipefail
cd "$(mktemp -d)"
npm install --silent --no-audit --no-fund --no-save --prefix . martinez-polygon-clipping@0.8.1 polygon-clipping@0.15.7 >/dev/null
python3 -m venv venv
venv/bin/pip install --quiet --disable-pip-version-check shapely==2.1.2 numpy==2.3.5
cat > run.mjs <<'JS'
import { readFileSync } from "node:fs";
import * as martinez from "martinez-polygon-clipping";
import clipping from "polygon-clipping";
const square = (low, high) => [[low, low], [high, low], [high, high], [low, high], [low, low]];
const room = [square(0, 10)], ring = [square(0, 10), square(2, 8).reverse()];
const diamond = [[[0, 5], [5, 0], [10, 5], [5, 10], [0, 5]]];
const tooth = [[[0, 5], [5, 2], [5, 8], [0, 5]]];
const island = [[[2, 2], [5, 4], [4, 5], [2, 2]]];
const version = JSON.parse(readFileSync("node_modules/martinez-polygon-clipping/package.json")).version;
const results = [
  ["diamond", martinez.diff(room, diamond), clipping.difference(room, diamond)],
  ["tooth", martinez.diff(room, tooth), clipping.difference(room, tooth)],
  ["island", martinez.union(ring, island), clipping.union(ring, island)],
];
console.log(JSON.stringify({ version, results }));
JS
venv/bin/python -I - <<'PYTHON'
import json
import subprocess
import sys

import shapely
from shapely.geometry import MultiPolygon

told = json.loads(subprocess.check_output(["node", "run.mjs"]))
print("martinez-polygon-clipping", told["version"])
expected = {"diamond": (3, 4), "tooth": (1, 1), "island": (1, 2)}
changed = False
for name, *both in told["results"]:
    shapes = [MultiPolygon([(polygon[0], polygon[1:]) for polygon in result]) for result in both]
    for package, shape in zip(("martinez", "polygon-clipping"), shapes):
        reason = shapely.is_valid_reason(shape)
        print(f"{name}, {package}: {len(shape.geoms)} polygons, area {shape.area:.1f}, {reason}")
    counts = tuple(len(shape.geoms) for shape in shapes)
    changed |= counts != expected[name] or shapes[0].is_valid or not shapes[1].is_valid
sys.exit(int(changed))  # 1: this has changed
PYTHON
