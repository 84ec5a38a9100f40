#!/usr/bin/env bash
# svg-path-properties 1.3.0: what a good engineer guesses and what happens.
#
# Input: cubic Bezier curves along one line, there and back: control points 0, 1000, -990, 10 and 0, 30, -20, 10.
# Guess: getTotalLength(), made to stand in for the browser's, is right to some digits: 1149.3239 and 30.
# What happens: 1156.1 (0.6 % too long) and 29.806 (0.65 % too short). The speed is put through a fixed rule of 24 points
#   over the whole curve, and where the curve turns on the spot the speed has a kink. A cusp of a drawn curve costs the
#   same: 0,0 10,10 0,10 10,0 is 18.314 long instead of 18.284. What moves along such a path by length jumps.
set -euo pipefail
cd "$(mktemp -d)"
npm install --silent --no-audit --no-fund --no-save --prefix . svg-path-properties@1.3.0 >/dev/null
cat > run.mjs <<'JS'
import { readFileSync } from "node:fs";
import { svgPathProperties } from "svg-path-properties";
console.log("svg-path-properties", JSON.parse(readFileSync("node_modules/svg-path-properties/package.json")).version);
function along(p) { // the length of a curve on a line: the sum of the ways between its turns, in closed form
  const [a, b, c] = [3 * (p[1] - p[0]), 6 * (p[2] - 2 * p[1] + p[0]), 3 * (p[3] - 3 * p[2] + 3 * p[1] - p[0])];
  const at = (t) => p[0] + t * (a + t * (b / 2 + (t * c) / 3));
  const root = Math.sqrt(b * b - 4 * a * c);
  const turns = [(-b - root) / (2 * c), (-b + root) / (2 * c)].filter((t) => t > 0 && t < 1).sort();
  const stops = [0, ...turns, 1].map(at);
  return stops.slice(1).reduce((sum, x, i) => sum + Math.abs(x - stops[i]), 0);
}
for (const [p, told] of [[[0, 1000, -990, 10], 1156.1155], [[0, 30, -20, 10], 29.8063]]) {
  const found = new svgPathProperties(`M${p[0]} 0C${p[1]} 0 ${p[2]} 0 ${p[3]} 0`).getTotalLength();
  console.log(`control points ${p.join(", ")}: ${found.toFixed(4)} instead of ${along(p).toFixed(4)}`);
  if (Math.abs(found - told) > 1e-3) throw new Error("this has changed");
}
JS
node run.mjs
