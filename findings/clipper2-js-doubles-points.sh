#!/usr/bin/env bash
# clipper2-js 1.2.4, beside pyclipr 0.1.8 (Clipper2 itself): what a good engineer guesses and what happens.
#
# Input: two squares side by side, to be united.
# Guess: the outline of the rectangle, its four corners and perhaps the two points where the squares met, each once.
# What happens: twelve points of which six differ, so half of the edges have no length and no direction.
#   Clipper2 itself gives six. A wall made of it has edges without a normal.
set -euo pipefail
cd "$(mktemp -d)"
npm install --silent --no-audit --no-fund --no-save --prefix . clipper2-js@1.2.4 >/dev/null
python3 -m venv venv && venv/bin/pip install -q pyclipr==0.1.8
cat > run.js <<'JS'
const fs = require("fs");
const { Clipper, FillRule, Path64, Paths64, Point64 } = require("clipper2-js");
console.log("clipper2-js", JSON.parse(fs.readFileSync("node_modules/clipper2-js/package.json")).version);
function square(x) {
  const path = new Path64();
  for (const [u, v] of [[0, 0], [10, 0], [10, 10], [0, 10]]) path.push(new Point64(x + u, v));
  const paths = new Paths64();
  paths.push(path);
  return paths;
}
const found = Clipper.Union(square(0), square(10), FillRule.NonZero);
const points = found[0].map((point) => `${point.x},${point.y}`);
console.log(points.length, "points:", points.join(" "));
console.log(new Set(points).size, "that differ");
if (found.length !== 1 || points.length !== 12 || new Set(points).size !== 6) throw new Error("this has changed");
JS
node run.js
cat > run.py <<'PY'
import pyclipr

clipper = pyclipr.Clipper()
clipper.addPath([[0, 0], [10, 0], [10, 10], [0, 10]], pyclipr.Subject)
clipper.addPath([[10, 0], [20, 0], [20, 10], [10, 10]], pyclipr.Clip)
(outline,) = clipper.execute(pyclipr.Union)
print("Clipper2 by pyclipr:", len(outline), "points")
assert len(outline) == len({tuple(point) for point in outline.tolist()}) == 6
PY
venv/bin/python run.py
