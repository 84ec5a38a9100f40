#!/usr/bin/env bash
# rdp 0.8 (PyPI) and simplify-geometry 0.0.2 (npm): what a good engineer guesses and what happens.
#
# Input: a wall of three points that runs out to x = 100 and back to x = 5, exactly level or with its turn 0.5 higher,
#   simplified with a tolerance of 1.
# Guess: Ramer, Douglas and Peucker's algorithm keeps each dropped point within the tolerance of what is left: the turn
#   stays, 95 units from the line between the ends.
# What happens: both drop it, and what is left is 5 long instead of 195. The distance is measured to the endless line through
#   the two ends, not to the piece between them. shapely, asked for the same, keeps the turn.
set -euo pipefail
cd "$(mktemp -d)"
npm install --silent --no-audit --no-fund --no-save --prefix . simplify-geometry@0.0.2 >/dev/null
python3 -m venv venv
venv/bin/pip install --quiet --disable-pip-version-check rdp==0.8 numpy==2.3.5 shapely==2.1.2
cat > run.js <<'JS'
const simplify = require("simplify-geometry");
console.log(JSON.stringify(JSON.parse(process.argv[2]).map((wall) => simplify(wall, 1))));
JS
venv/bin/python -I -W ignore - <<'PYTHON'
import json
import subprocess
import sys
from importlib.metadata import version

import shapely
from rdp import rdp

print("rdp", version("rdp"), "simplify-geometry", json.load(open("node_modules/simplify-geometry/package.json"))["version"])
walls = [[[0, 0], [100, 0], [5, 0]], [[0, 0], [100, 0.5], [5, 0]]]
others = json.loads(subprocess.check_output(["node", "run.js", json.dumps(walls)]))
changed = False
for wall, other in zip(walls, others):
    line = shapely.LineString(wall)
    judge = shapely.simplify(line, 1)
    for name, kept in (("rdp", rdp(wall, epsilon=1)), ("simplify-geometry", other)):
        away = shapely.hausdorff_distance(line, shapely.LineString(kept))
        print(f"{name}: {wall} -> {kept}, {away:.1f} units away; shapely keeps {len(judge.coords)} points")
        changed |= len(kept) != 2 or away < 90 or len(judge.coords) != 3
sys.exit(int(changed))  # 1: this has changed
PYTHON
