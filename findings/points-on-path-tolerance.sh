#!/usr/bin/env bash
# points-on-path 0.2.1: what a good engineer guesses and what happens.
#
# Input: half a circle of radius 50 as SVG path data, asked for with a tolerance of 0.001.
# Guess: points within 0.001 of the circle.
# What happens: points up to 0.077 beside it, 77 times the tolerance, and no smaller one helps: arcs are first made into one
#   Bezier curve for each third of a circle, and only the points are held to the tolerance, to those curves.
set -euo pipefail
cd "$(mktemp -d)"
npm install --silent --no-audit --no-fund --no-save --prefix . points-on-path@0.2.1 >/dev/null
cat > run.js <<'JS'
const { pointsOnPath } = require("points-on-path");
console.log("points-on-path", require("points-on-path/package.json").version);
for (const tolerance of [0.001, 0.00001]) {
  const points = pointsOnPath("M0 0A50 50 0 0 1 100 0", tolerance).flat();
  const worst = Math.max(...points.map(([x, y]) => Math.abs(Math.hypot(x - 50, y) - 50)));
  console.log(`tolerance ${tolerance}: ${points.length} points, up to ${worst.toFixed(4)} beside the circle`);
  if (Math.abs(worst - 0.077) > 0.001) throw new Error("this has changed");
}
JS
node run.js
